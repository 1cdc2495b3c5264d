// Solids of STEP files that are said by what sweeps them, beside their volumes, which are known.
#include <freiform/io/step.hpp>

#include <cmath>
#include <support/solids.hpp>
#include <support/step_items.hpp>
#include <support/step_measures.hpp>

namespace freiform::test {
namespace {

// The triangle #60 (0, 0), (4, 0), (0, 3) of the frame #50, which stands askew at (5, 6, 7), with a round
// hole of radius 1/2 about (1, 1); #59 is the normal of its plane.
constexpr std::string_view kProfile =
    "#50=AXIS2_PLACEMENT_3D('',#51,#59,#53);\n#51=CARTESIAN_POINT('',(5.,6.,7.));\n"
    "#59=DIRECTION('',(0.,-0.6,0.8));\n#53=DIRECTION('',(1.,0.,0.));\n#54=PLANE('',#50);\n"
    "#60=CURVE_BOUNDED_SURFACE('',#54,(#70,#61),.F.);\n#61=OUTER_BOUNDARY_CURVE('',(#62,#63),.F.);\n"
    "#62=COMPOSITE_CURVE_SEGMENT(.CONTINUOUS.,.T.,#64);\n#63=COMPOSITE_CURVE_SEGMENT(.CONTINUOUS.,.F.,#65);\n"
    "#64=POLYLINE('',(#51,#66,#67));\n#65=POLYLINE('',(#51,#67));\n"
    "#66=CARTESIAN_POINT('',(9.,6.,7.));\n#67=CARTESIAN_POINT('',(5.,8.4,8.8));\n"
    "#70=BOUNDARY_CURVE('',(#71),.F.);\n#71=COMPOSITE_CURVE_SEGMENT(.CONTINUOUS.,.T.,#72);\n"
    "#72=CIRCLE('',#73,0.5);\n#73=AXIS2_PLACEMENT_3D('',#74,#59,#53);\n"
    "#74=CARTESIAN_POINT('',(6.,6.8,7.6));\n";
constexpr double kArea = 6 - kPi / 4;

Model swept(std::string_view solid, std::string_view more = kProfile) {
    return items_model("#10", text("#10=", solid, ";\n", more));
}
void expect_volume(const Model& m, double volume, double tolerance = 1e-3) {
    const auto t = must(tessellate(m, {.tolerance = tolerance}));
    EXPECT_TRUE(t.refused.empty()) << t.refused[0].reason.message;
    EXPECT_EQ(topology(t.mesh).open_edges, 0);
    EXPECT_LE(t.boundary_gap, 1e-13);
    EXPECT_NEAR(signed_volume(t.mesh), volume, tolerance * area_of(m, tolerance));
}
// Of the mesh within `kNear`.
constexpr double kNear = 1e-3;
Box<3> box_of(const Model& m) {
    Box<3> box;
    for (const Vec<3>& p : must(tessellate(m, {.tolerance = kNear})).mesh.points) box.add(p);
    return box;
}
// Of a convex solid around the centre.
void expect_outward(const Model& m, const Vec<3>& centre) {
    for (const Face& f : m.faces) {
        const Coedge& c = f.loops.at(0).coedges.at(0);
        const Vec<2> at = jet<0>(c.curve, m.edges[std::size_t(c.edge)].range.middle()).value();
        const auto j = jet<1>(f.surface, {at[0], at[1]});
        const Vec<3> n = cross(j(1, 0), j(0, 1));
        EXPECT_GT((f.reversed ? -1 : 1) * dot(n, j.value() - centre), 0);
    }
}
// Nothing but the first reason why an item is not there.
void expect_refused(std::string_view solid, RefusalKind kind, std::string_view message,
                    std::string_view more = kProfile) {
    const auto m = read_step(item_file("#10", text("#10=", solid, ";\n", more)));
    ASSERT_FALSE(m.has_value()) << solid;
    EXPECT_EQ(name_of(m.error().kind), name_of(kind)) << m.error().message;
    EXPECT_NE(m.error().message.find(message), std::string::npos) << m.error().message;
}

TEST(StepSwept, an_area_is_extruded_whatever_the_direction) {
    const Model m = swept("EXTRUDED_AREA_SOLID('prism',#60,#59,2.5)");
    expect_volume(m, 2.5 * kArea);
    // Three walls, a hole and two ends; the hole is a cylinder, all else is plane.
    EXPECT_EQ(m.faces.size(), 6u);
    EXPECT_EQ(std::ranges::count_if(m.faces, [](const Face& f) { return kind_name(f.surface) == "plane"; }),
              5);
    EXPECT_EQ(
        std::ranges::count_if(m.faces, [](const Face& f) { return kind_name(f.surface) == "cylinder"; }), 1);
    ASSERT_EQ(m.bodies.size(), 1u);
    EXPECT_TRUE(m.bodies[0].solid);
    EXPECT_EQ(m.bodies[0].name, "prism");
    for (const Approximation& a : m.approximations) ADD_FAILURE() << a.where << a.what;
    // Along z, to the other side, and askew: the height above the plane counts.
    expect_volume(swept("EXTRUDED_AREA_SOLID('',#60,#21,2.5)"), 2.5 * 0.8 * kArea);
    expect_volume(swept("EXTRUDED_AREA_SOLID('',#60,#24,2.5)"), 2.5 * 0.6 * kArea);
    const Box<3> box = box_of(m);
    EXPECT_NEAR(box.lo[0], 5, kNear);
    EXPECT_NEAR(box.hi[2], 8.8 + 2, kNear);
}

TEST(StepSwept, profiles_beside_their_plane_are_told_with_their_distance) {
    std::string lifted(kProfile);
    lifted.replace(lifted.find("(6.,6.8,7.6)"), 12, "(6.,6.7994,7.6008)");
    const Model m = swept("EXTRUDED_AREA_SOLID('prism',#60,#59,2.5)", lifted);
    expect_volume(m, 2.5 * kArea);
    ASSERT_EQ(m.approximations.size(), 2u);
    EXPECT_EQ(m.approximations[0].where, "#60 CURVE_BOUNDED_SURFACE");
    EXPECT_EQ(times_told(m, "beside #60 CURVE_BOUNDED_SURFACE"), 1);
    EXPECT_EQ(m.approximations[1].what, "#10 EXTRUDED_AREA_SOLID: a solid near it stands for it");
    EXPECT_NEAR(m.approximations[1].bound.value_or(0), 1e-3, 1e-9);
}

TEST(StepSwept, faces_are_extruded_and_turned) {
    // The unit square #12 of z = 0, beside the axis x = -1, or at it.
    const auto square = [](std::string_view item, std::string_view more, std::size_t told = 0) {
        std::string s = polygon_file({{0, 0}, {1, 0}, {1, 1}, {0, 1}}, more);
        s.replace(s.find("(#10),#1)"), 9, "(#80),#1)");
        s.insert(s.find("ENDSEC;\nEND-ISO"), text("#80=", item, ";\n"));
        const Model m = must(read_step(s));
        EXPECT_TRUE(m.refused.empty()) << m.refused[0].message;
        EXPECT_EQ(m.approximations.size(), told);
        return m;
    };
    constexpr std::string_view kAxis =
        "#90=DIRECTION('',(0.,0.,-1.));\n#91=AXIS1_PLACEMENT('',#92,#93);\n#93=DIRECTION('',(0.,1.,0.));\n"
        "#92=CARTESIAN_POINT('',(-1.,7.,0.));\n#94=AXIS1_PLACEMENT('',#6,#93);\n"
        "#95=AXIS1_PLACEMENT('',#96,#93);\n#96=CARTESIAN_POINT('',(-30.,0.,0.));\n";
    expect_volume(square("EXTRUDED_FACE_SOLID('',#12,#90,3.)", kAxis), 3);
    expect_volume(square("REVOLVED_FACE_SOLID('',#12,#91,6.283185307179586)", kAxis), 3 * kPi);
    expect_volume(square("REVOLVED_FACE_SOLID('',#12,#91,1.)", kAxis), 1.5);
    // A turn of the digits that files have is a turn; what that misses is too little to be told.
    const Model whole = square("REVOLVED_FACE_SOLID('',#12,#94,6.2831853071)", kAxis);
    expect_volume(whole, kPi);
    EXPECT_EQ(whole.faces.size(), 3u);
    // One with fewer, which is more than a turn.
    const Model more = square("REVOLVED_FACE_SOLID('',#12,#95,6.28319)", kAxis, 1);
    expect_volume(more, 61 * kPi);
    EXPECT_EQ(more.faces.size(), 4u);
    // Counter-clockwise about +y: from x to -z.
    const Box<3> box = box_of(square("REVOLVED_FACE_SOLID('',#12,#91,1.)", kAxis));
    EXPECT_NEAR(box.lo[2], -2 * std::sin(1.0), kNear);
    EXPECT_NEAR(box.hi[2], 0, kNear);
}

TEST(StepSwept, discs_along_lines_and_circles_are_exact) {
    constexpr std::string_view kCurves =
        "#40=LINE('',#31,#41);\n#41=VECTOR('',#24,2.);\n#42=CIRCLE('',#23,4.);\n"
        "#43=TRIMMED_CURVE('',#40,(PARAMETER_VALUE(1.)),(PARAMETER_VALUE(3.)),.T.,.PARAMETER.);\n"
        "#44=TRIMMED_CURVE('',#42,(PARAMETER_VALUE(1.)),(PARAMETER_VALUE(4.)),.T.,.PARAMETER.);\n"
        "#45=TRIMMED_CURVE('',#42,(PARAMETER_VALUE(4.)),(PARAMETER_VALUE(1.)),.F.,.PARAMETER.);\n"
        "#46=COMPOSITE_CURVE('',(#47),.F.);\n#47=COMPOSITE_CURVE_SEGMENT(.CONTINUOUS.,.T.,#44);\n";
    const auto disc = [&](std::string_view fields) {
        return swept(text("SWEPT_DISK_SOLID('',", fields, ")"), kCurves);
    };
    const double ring = kPi * (1 - 0.25);
    expect_volume(disc("#40,1.,0.5,1.,2.5"), 3 * ring);
    expect_volume(disc("#40,1.,$,1.,2.5"), 3 * kPi);
    expect_volume(disc("#42,1.,0.5,0.,6.283185307179586"), 8 * kPi * ring);
    expect_volume(disc("#42,1.,$,1.,2."), 4 * kPi);
    // Parameters of the curve that was trimmed, and such that count from its start.
    for (const std::string_view part : {"1.5,2.5", "0.,1.", "1.,2."})
        expect_volume(disc(text("#43,1.,$,", part)), 2 * kPi);
    EXPECT_NEAR(box_of(disc("#43,1.,$,1.5,2.5")).lo[1], 2 + 3, kNear);
    EXPECT_NEAR(box_of(disc("#43,1.,$,0.,1.")).lo[1], 2 + 2, kNear);
    EXPECT_TRUE(disc("#43,1.,$,0.,1.").approximations.empty());
    for (const std::string_view c : {"#44", "#45", "#46"}) {
        expect_volume(disc(text(c, ",1.,$,$,$")), 4 * 3 * kPi);
        expect_volume(disc(text(c, ",1.,$,0.,3.")), 4 * 3 * kPi);
    }
    // A whole circle has all parameters, a part of it those that it has: others are told.
    const Model across = disc("#42,1.,$,5.,7.5");
    expect_volume(across, 4 * 2.5 * kPi);
    EXPECT_TRUE(across.approximations.empty());
    const Model beyond = disc("#44,1.,$,3.,5.");
    expect_volume(beyond, 4 * 3 * kPi);
    EXPECT_EQ(times_told(beyond, "its directrix has no parameters from 3 to 5; all of it is swept"), 1);
    // Against the circle the first radian is its last one.
    EXPECT_LT(box_of(disc("#45,1.,$,0.,1.")).lo[0], -4.9);
    EXPECT_LT(box_of(disc("#45,1.,$,1.,2.")).lo[0], -4.9);
    EXPECT_GT(box_of(disc("#44,1.,$,0.,1.")).lo[0], -3);
    // Lengths for parameters: all of it, and so it is said.
    const Model m = disc("#43,1.,0.5,0.,4.");
    expect_volume(m, 4 * ring);
    EXPECT_EQ(times_told(m, "its directrix has no parameters from 0 to 4; all of it is swept"), 1);
}

// A line from (2, 0, 3) up to z = 7, a quarter of a circle of radius 2, a line to x = 9.
constexpr std::string_view kRow =
    "#40=COMPOSITE_CURVE('',(#41,#42,#43),.F.);\n#41=COMPOSITE_CURVE_SEGMENT(.CONTINUOUS.,.T.,#44);\n"
    "#42=COMPOSITE_CURVE_SEGMENT(.CONTINUOUS.,.F.,#45);\n#43=COMPOSITE_CURVE_SEGMENT(.CONTINUOUS.,.T.,#46);\n"
    "#44=POLYLINE('',(#51,#52));\n#51=CARTESIAN_POINT('',(2.,0.,3.));\n"
    "#52=CARTESIAN_POINT('',(2.,0.,7.));\n#46=POLYLINE('',(#53,#54));\n"
    "#53=CARTESIAN_POINT('',(4.,0.,9.));\n#54=CARTESIAN_POINT('',(9.,0.,9.));\n"
    "#45=TRIMMED_CURVE('',#55,(PARAMETER_VALUE(0.)),(PARAMETER_VALUE(1.5707963267949)),.T.,.PARAMETER.);\n"
    "#55=CIRCLE('',#56,2.);\n#56=AXIS2_PLACEMENT_3D('',#57,#58,#59);\n"
    "#57=CARTESIAN_POINT('',(4.,0.,7.));\n#58=DIRECTION('',(0.,-1.,0.));\n#59=DIRECTION('',(0.,0.,1.));\n";

TEST(StepSwept, discs_along_rows_of_lines_and_arcs_are_exact) {
    const auto disc = [&](std::string_view fields, std::string_view row = kRow) {
        return swept(text("SWEPT_DISK_SOLID('pipe',", fields, ")"), row);
    };
    const double length = 4 + kPi + 5;
    const Model m = disc("#40,1.,0.5,$,$");
    expect_volume(m, length * kPi * 0.75);
    EXPECT_TRUE(m.approximations.empty());
    EXPECT_EQ(m.faces.size(), 8u);
    EXPECT_EQ(m.bodies.at(0).name, "pipe");
    const Box<3> box = box_of(m);
    EXPECT_LT(norm(box.lo - Vec<3>{{1, -1, 3}}), kNear);
    EXPECT_LT(norm(box.hi - Vec<3>{{9, 1, 10}}), kNear);
    // Other programs know its walls.
    const Model back = must(read_step(must(write_step({"mm", {{"", m}}}))));
    const auto kinds = [&](std::string_view kind) {
        return std::ranges::count_if(back.faces, [&](const Face& f) { return kind_name(f.surface) == kind; });
    };
    EXPECT_EQ(kinds("torus"), 2);
    EXPECT_EQ(kinds("cylinder"), 4);
    expect_volume(back, length * kPi * 0.75);
    // Parameters of all of it are those of its parts, one after the other; others are told.
    EXPECT_TRUE(disc(text("#40,1.,$,0.,", 1 + kPi / 2 + 1)).approximations.empty());
    EXPECT_TRUE(disc("#40,1.,$,0.,3.").approximations.empty());
    EXPECT_EQ(times_told(disc("#40,1.,$,0.5,2."), "is asked for from 0.5 to 2; all of it is swept"), 1);
    std::string corner(kRow);
    corner.replace(corner.find("(9.,0.,9.)"), 10, "(9.,0.,5.)");
    expect_refused("SWEPT_DISK_SOLID('',#40,1.,$,$)", RefusalKind::invalid, "its directrix[1]", corner);
    expect_refused("SWEPT_DISK_SOLID('',#40,2.,$,$)", RefusalKind::unsupported, "bends with the radius 2",
                   kRow);
}

TEST(StepSwept, discs_along_splines_are_near_within_what_is_told) {
    const Model m = swept("SWEPT_DISK_SOLID('',#40,0.2,0.1,0.,1.)",
                          "#40=B_SPLINE_CURVE_WITH_KNOTS('',2,(#30,#31,#34),.UNSPECIFIED.,.F.,.F.,(3,3),(0.,"
                          "1.),.UNSPECIFIED.);\n");
    ASSERT_EQ(m.approximations.size(), 1u);
    EXPECT_EQ(m.approximations[0].what, "#10 SWEPT_DISK_SOLID: a solid near it stands for it");
    EXPECT_LE(m.approximations[0].bound.value_or(1), 1e-4);
    // The length by quadrature; by the rule of Guldin the ring sweeps as much as along a line.
    double length = 0;
    const int n = 10000;
    for (int i = 0; i < n; ++i) {
        const double t = (i + 0.5) / n;
        length += std::hypot(2 * (1 - t) * 1 + 2 * t * 3, 2 * (1 - t) * 2 - 2 * t * 2) / n;
    }
    const auto t = must(tessellate(m, {.tolerance = kNear}));
    EXPECT_EQ(topology(t.mesh).open_edges, 0);
    EXPECT_NEAR(signed_volume(t.mesh), length * kPi * (0.04 - 0.01), kNear * area_of(m, kNear));
    // The middle of its ends is on the curve.
    EXPECT_NEAR(box_of(m).lo[0], -0.2 * 2 / std::sqrt(5.0), 1e-3);
}

TEST(StepSwept, primitives_are_solids) {
    constexpr std::string_view kPlaces =
        "#40=AXIS2_PLACEMENT_3D('',#32,#22,#24);\n#41=AXIS1_PLACEMENT('',#32,#22);\n#11=BLOCK('',#40,2.,3.,4."
        ");\n";
    const auto of = [&](std::string_view solid) { return swept(solid, kPlaces); };
    const Model block = of("BLOCK('b',#40,2.,3.,4.)");
    expect_volume(block, 24);
    EXPECT_EQ(block.bodies.at(0).name, "b");
    // x of the block is y, its y is z, its z is x.
    const Box<3> box = box_of(block);
    expect_near(box.lo, {{2, 0, 0}});
    expect_near(box.hi, {{6, 2, 3}});
    expect_outward(block, {{4, 1, 1.5}});
    expect_volume(of("CSG_SOLID('',#11)"), 24);
    expect_volume(of("RIGHT_ANGULAR_WEDGE('',#40,2.,3.,4.,1.)"), (2 + 1) / 2.0 * 3 * 4);
    expect_volume(of("RIGHT_ANGULAR_WEDGE('',#40,2.,3.,4.,0.)"), 12);
    expect_volume(of("RIGHT_CIRCULAR_CYLINDER('',#41,3.,2.)"), 12 * kPi);
    const Box<3> cylinder = box_of(of("RIGHT_CIRCULAR_CYLINDER('',#41,3.,2.)"));
    EXPECT_NEAR(cylinder.lo[0], 2, kNear);
    EXPECT_NEAR(cylinder.hi[0], 5, kNear);
    const double r = 1 + 2 * std::tan(0.5);
    expect_volume(of("RIGHT_CIRCULAR_CONE('',#41,2.,1.,0.5)"), 2 * kPi / 3 * (1 + r + r * r));
    expect_outward(of("RIGHT_CIRCULAR_CONE('',#41,2.,1.,0.5)"), {{3, 0, 0}});
    expect_volume(of("RIGHT_CIRCULAR_CONE('',#41,2.,0.,0.5)"), 8 * kPi / 3 * std::pow(std::tan(0.5), 2));
    EXPECT_NEAR(box_of(of("RIGHT_CIRCULAR_CONE('',#41,2.,0.,0.5)")).lo[0], 2, kNear);
    expect_volume(of("SPHERE('',1.5,#31)"), 4.5 * kPi);
    expect_volume(of("TORUS('',#41,3.,1.)"), 6 * kPi * kPi);
    // A torus about x.
    const Box<3> torus = box_of(of("TORUS('',#41,3.,1.)"));
    EXPECT_NEAR(torus.lo[0], 1, kNear);
    EXPECT_NEAR(torus.hi[2], 4, kNear);
}

TEST(StepSwept, what_sweeps_nothing_is_refused_with_its_reason) {
    const auto invalid = [](std::string_view solid, std::string_view message,
                            std::string_view more = kProfile) {
        expect_refused(solid, RefusalKind::invalid, message, more);
    };
    invalid("EXTRUDED_AREA_SOLID('',#60,#59,0.)", "has the depth 0");
    invalid("EXTRUDED_AREA_SOLID('',#60,#22,1.)", "its direction: a vector that leaves the plane");
    invalid("REVOLVED_AREA_SOLID('',#60,#80,1.)", "plane",
            text(kProfile, "#80=AXIS1_PLACEMENT('',#51,#59);\n"));
    expect_refused(
        "REVOLVED_AREA_SOLID('',#60,#80,1.)", RefusalKind::unsupported, "axis",
        text(kProfile, "#80=AXIS1_PLACEMENT('',#81,#53);\n#81=CARTESIAN_POINT('',(5.,6.4,7.3));\n"));
    expect_refused("EXTRUDED_AREA_SOLID('',#80,#21,1.)", RefusalKind::unsupported,
                   "only plane faces are swept", "#80=SPHERICAL_SURFACE('',#23,2.);\n");
    invalid("SWEPT_DISK_SOLID('',#40,1.,1.,0.,1.)", "has the radii 1 and 1", "#40=LINE('',#31,#41);\n");
    invalid("SWEPT_DISK_SOLID('',#40,1.,$,1.,0.)", "is swept from 1 to 0",
            "#40=LINE('',#31,#41);\n#41=VECTOR('',#24,2.);\n");
    invalid("SWEPT_DISK_SOLID('',#40,1.,$,$,$)", "has a directrix without an end",
            "#40=LINE('',#31,#41);\n#41=VECTOR('',#24,2.);\n");
    invalid("BLOCK('',#23,1.,-1.,1.)", "has the y -1");
    invalid("RIGHT_CIRCULAR_CONE('',#80,2.,1.,1.6)", "has the semi-angle 1.6",
            "#80=AXIS1_PLACEMENT('',#6,#21);\n");
    expect_refused("TORUS('',#80,1.,2.)", RefusalKind::unsupported, "axis",
                   "#80=AXIS1_PLACEMENT('',#6,#21);\n");
    expect_refused("CSG_SOLID('',$)", RefusalKind::unreadable, "root");
    expect_refused("CSG_SOLID('',#80)", RefusalKind::unsupported, "is a CSG solid",
                   "#80=BOOLEAN_RESULT('',.UNION.,#81,#81);\n#81=SPHERE('',1.,#6);\n");
}

}  // namespace
}  // namespace freiform::test
