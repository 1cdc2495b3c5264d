// Curves of STEP files that have no counterpart, or are given in the parameters of a surface alone; shapes
// that are not read.
#include <freiform/io/step_read.hpp>
#include <freiform/model/tessellate.hpp>

#include <cmath>
#include <support/random.hpp>
#include <support/refusal.hpp>
#include <support/solids.hpp>
#include <support/step_measures.hpp>
#include <support/step_polygons.hpp>

namespace freiform::test {
namespace {

// One curve, #20, in a set: #21 is the direction of z, #22 that of x, #23 the frame at the origin.
std::string curve_file(std::string_view more) {
    return flat_file(
        text("#8=SHAPE_REPRESENTATION('',(#10),#1);\n#10=GEOMETRIC_CURVE_SET('',(#20));\n"
             "#21=DIRECTION('',(0.,0.,1.));\n#22=DIRECTION('',(1.,0.,0.));\n"
             "#23=AXIS2_PLACEMENT_3D('',#6,#21,#22);\n",
             more));
}

constexpr std::string_view kParabola =
    "#30=B_SPLINE_CURVE_WITH_KNOTS('',2,(#31,#32,#33),.UNSPECIFIED.,.F.,.F.,(3,3),(0.,1.),.UNSPECIFIED.);\n"
    "#31=CARTESIAN_POINT('',(0.,0.,0.));\n#32=CARTESIAN_POINT('',(1.,2.,0.));\n"
    "#33=CARTESIAN_POINT('',(2.,0.,0.));\n";

TEST(StepCurves, offsets_of_lines_and_circles_are_such_again) {
    // A trimmed line along x; its offset by 2 lies along z x x = y.
    const Model line = must(read_step(
        curve_file("#20=OFFSET_CURVE_3D('',#24,2.,.F.,#21);\n"
                   "#24=TRIMMED_CURVE('',#25,(PARAMETER_VALUE(0.)),(PARAMETER_VALUE(3.)),.T.,.PARAMETER.);\n"
                   "#25=LINE('',#6,#26);\n#26=VECTOR('',#22,1.);\n")));
    ASSERT_EQ(line.edges.size(), 1u);
    EXPECT_EQ(line.vertices.at(0).point, (Vec<3>{{0, 2, 0}}));
    EXPECT_EQ(line.vertices.at(1).point, (Vec<3>{{3, 2, 0}}));
    EXPECT_TRUE(line.approximations.empty());
    // Against the line, it lies on its other side.
    const Model back = must(read_step(
        curve_file("#20=OFFSET_CURVE_3D('',#24,2.,.F.,#21);\n"
                   "#24=TRIMMED_CURVE('',#25,(PARAMETER_VALUE(3.)),(PARAMETER_VALUE(0.)),.F.,.PARAMETER.);\n"
                   "#25=LINE('',#6,#26);\n#26=VECTOR('',#22,1.);\n")));
    EXPECT_EQ(back.vertices.at(0).point[1], -2);
    // About z, V x T points to the middle of a circle.
    const Model circle =
        must(read_step(curve_file("#20=OFFSET_CURVE_3D('',#24,2.,.F.,#21);\n#24=CIRCLE('',#23,5.);\n")));
    ASSERT_EQ(circle.edges.size(), 1u);
    EXPECT_EQ(kind_name(*circle.edges[0].curve), "circle");
    EXPECT_NEAR(norm(circle.vertices.at(0).point - Vec<3>{{3, 0, 0}}), 0, 1e-14);
    EXPECT_TRUE(circle.approximations.empty());
}

TEST(StepCurves, offsets_of_splines_are_splines_within_the_bound_that_is_told) {
    const Model m =
        must(read_step(curve_file(text("#20=OFFSET_CURVE_3D('',#30,0.25,.F.,#21);\n", kParabola))));
    ASSERT_EQ(m.edges.size(), 1u);
    ASSERT_EQ(m.approximations.size(), 1u);
    EXPECT_EQ(m.approximations[0].what, "#20 OFFSET_CURVE_3D: a spline near it stands for it");
    ASSERT_TRUE(m.approximations[0].bound);
    const double bound = *m.approximations[0].bound;
    EXPECT_LT(bound, 1e-5);
    EXPECT_GT(bound, 0);
    for (int k = 0; k <= 1000; ++k) {
        const double t = k / 1000.0;
        const Vec<3> c{{2 * t, 4 * t * (1 - t), 0}}, d{{2, 4 - 8 * t, 0}};
        const Vec<3> exact = c + (0.25 / norm(d)) * cross(Vec<3>{{0, 0, 1}}, d);
        EXPECT_LE(norm(jet<0>(*m.edges[0].curve, t).value() - exact), bound);
    }
    // A replica twice as large is off by twice as much.
    const Model twice = must(read_step(
        curve_file(text("#20=CURVE_REPLICA('',#29,#28);\n#29=OFFSET_CURVE_3D('',#30,0.25,.F.,#21);\n",
                        "#28=CARTESIAN_TRANSFORMATION_OPERATOR_3D('','',$,$,#6,2.,$);\n", kParabola))));
    ASSERT_EQ(twice.approximations.size(), 1u);
    EXPECT_EQ(twice.approximations[0].bound, 2 * bound);
    // What it bounds is off by as much: the side of a wall.
    const Model wall = must(
        read_step(flat_file(text("#8=SHAPE_REPRESENTATION('',(#10),#1);\n#10=GEOMETRIC_SET('',(#40));\n"
                                 "#40=RECTANGULAR_TRIMMED_SURFACE('',#41,0.,1.,0.,1.,.T.,.T.);\n"
                                 "#41=SURFACE_OF_LINEAR_EXTRUSION('',#20,#42);\n#42=VECTOR('',#21,1.);\n"
                                 "#21=DIRECTION('',(0.,0.,1.));\n#20=OFFSET_CURVE_3D('',#30,0.25,.F.,#21);\n",
                                 kParabola))));
    ASSERT_EQ(wall.faces.size(), 1u);
    ASSERT_EQ(wall.approximations.size(), 1u);
    EXPECT_EQ(wall.approximations[0].bound, bound);
}

TEST(StepCurves, offsets_that_no_bound_holds_for_are_refused_with_their_number) {
    const auto refused = [](std::string_view more, RefusalKind kind, std::string_view where,
                            std::string_view what) {
        expect_refusal(read_step(curve_file(text(kParabola, more))), kind, where, what);
    };
    // A corner, where the offset jumps.
    refused("#20=OFFSET_CURVE_3D('',#34,1.,.F.,#21);\n#34=POLYLINE('',(#31,#32,#33));\n",
            RefusalKind::ill_conditioned, "#20 OFFSET_CURVE_3D", "proven to be near");
    refused("#20=OFFSET_CURVE_3D('',#24,2.,.F.,#22);\n#24=LINE('',#6,#26);\n#26=VECTOR('',#22,1.);\n",
            RefusalKind::invalid, "#20 OFFSET_CURVE_3D", "along itself");
    refused("#20=OFFSET_CURVE_3D('',#24,5.,.F.,#21);\n#24=CIRCLE('',#23,5.);\n", RefusalKind::invalid,
            "#20 OFFSET_CURVE_3D", "");
    refused("#20=OFFSET_CURVE_3D('',#24,5.,.F.,#21);\n#24=PARABOLA('',#23,5.);\n", RefusalKind::unsupported,
            "#20 OFFSET_CURVE_3D", "without end");
    refused("#20=OFFSET_CURVE_3D('',#24,1.,.F.,#21);\n#24=OFFSET_CURVE_3D('',#30,0.1,.F.,#21);\n",
            RefusalKind::unsupported, "#20 OFFSET_CURVE_3D", "taken as a spline");
    refused("#20=OFFSET_CURVE_3D('',#20,1.,.F.,#21);\n", RefusalKind::invalid, "#20 OFFSET_CURVE_3D",
            "refers to itself");
}

// A face between four edges on the cylinder of radius 2 about z, from u = 0 to a quarter and z = 0 to 1, each
// given by its parameters alone; angles are in degrees, or in radians.
std::string tile_file(bool degrees, bool left_out, std::string_view top = "") {
    const double q = degrees ? 90 : kPi / 2;
    std::string s = text(
        "#8=SHAPE_REPRESENTATION('',(#10),#41);\n#10=SHELL_BASED_SURFACE_MODEL('',(#11));\n"
        "#41=(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT((#3))"
        "GLOBAL_UNIT_ASSIGNED_CONTEXT((#2,#42))REPRESENTATION_CONTEXT('',''));\n"
        "#42=(CONVERSION_BASED_UNIT('DEGREE',#43)NAMED_UNIT(*)PLANE_ANGLE_UNIT());\n"
        "#43=PLANE_ANGLE_MEASURE_WITH_UNIT(PLANE_ANGLE_MEASURE(0.017453292519943295),#44);\n"
        "#44=(NAMED_UNIT(*)PLANE_ANGLE_UNIT()SI_UNIT($,.RADIAN.));\n"
        "#11=OPEN_SHELL('',(#12));\n#12=ADVANCED_FACE('',(#13),#20,.T.);\n"
        "#13=FACE_OUTER_BOUND('',#14,.T.);\n#14=EDGE_LOOP('',(#500,#501,#502,#503));\n"
        "#20=CYLINDRICAL_SURFACE('',#5,2.);\n");
    const double corners[4][2] = {{0, 0}, {q, 0}, {q, 1}, {0, 1}};
    for (int i = 0; i < 4; ++i) {
        const double *a = corners[i], *b = corners[(i + 1) % 4];
        const double angle = a[0] > 0 ? kPi / 2 : 0;
        s += text("#", 100 + i, "=CARTESIAN_POINT('',(", 2 * std::cos(angle), ",", 2 * std::sin(angle), ",",
                  a[1], "));\n#", 200 + i, "=VERTEX_POINT('',#", 100 + i, ");\n#", 400 + i,
                  "=EDGE_CURVE('',#", 200 + i, ",#", 200 + (i + 1) % 4, ",#", left_out ? 350 + i : 300 + i,
                  ",.T.);\n#", 500 + i, "=ORIENTED_EDGE('',*,*,#", 400 + i, ",.T.);\n#", 350 + i,
                  "=SURFACE_CURVE('',$,(#", 300 + i, "),.PCURVE_S1.);\n#", 300 + i, "=PCURVE('',#20,#",
                  600 + i, ");\n#", 600 + i, "=DEFINITIONAL_REPRESENTATION('',(#", 700 + i, "),#1);\n");
        if (i == 2 && !top.empty()) {
            s += top;
            continue;
        }
        s += text("#", 700 + i, "=LINE('',#", 710 + i, ",#", 720 + i, ");\n#", 710 + i,
                  "=CARTESIAN_POINT('',(", a[0], ",", a[1], "));\n#", 720 + i, "=VECTOR('',#", 730 + i,
                  ",1.);\n#", 730 + i, "=DIRECTION('',(", b[0] - a[0], ",", b[1] - a[1], "));\n");
    }
    return flat_file(s);
}

TEST(StepCurves, edges_along_parameters_are_lines_and_circles) {
    for (const bool degrees : {true, false})
        for (const bool left_out : {true, false}) {
            const Model m = must(read_step(tile_file(degrees, left_out)));
            EXPECT_TRUE(m.refused.empty()) << m.refused[0].where << ": " << m.refused[0].message;
            ASSERT_EQ(m.edges.size(), 4u);
            for (int i = 0; i < 4; ++i)
                EXPECT_EQ(kind_name(*m.edges[std::size_t(i)].curve), i % 2 ? "line" : "circle");
            EXPECT_TRUE(m.approximations.empty());
            const auto t = must(tessellate(m, {.tolerance = 1e-4}));
            double area = 0;
            for (const auto& k : t.mesh.triangles) {
                const auto at = [&](std::size_t n) {
                    return t.mesh.points[std::size_t(t.mesh.vertices[std::size_t(k[n])].point)];
                };
                area += norm(cross(at(1) - at(0), at(2) - at(0))) / 2;
            }
            EXPECT_NEAR(area, kPi, 1e-3);
        }
}

TEST(StepCurves, other_curves_on_surfaces_are_splines_within_the_bound_that_is_told) {
    // The upper edge as a parabola of the parameters: u = 90 (1 - t), v = 1 + t (1 - t).
    const Model m = must(read_step(
        tile_file(true, true,
                  "#702=B_SPLINE_CURVE_WITH_KNOTS('',2,(#801,#802,#803),.UNSPECIFIED.,.F.,.F.,(3,3),(0.,1.),"
                  ".UNSPECIFIED.);\n#801=CARTESIAN_POINT('',(90.,1.));\n#802=CARTESIAN_POINT('',(45.,1.5));\n"
                  "#803=CARTESIAN_POINT('',(0.,1.));\n")));
    EXPECT_TRUE(m.refused.empty());
    ASSERT_EQ(m.edges.size(), 4u);
    const Approximation* told = nullptr;
    for (const Approximation& a : m.approximations)
        if (a.what == "#302 PCURVE: a spline near it stands for it") told = &a;
    ASSERT_NE(told, nullptr);
    ASSERT_TRUE(told->bound);
    EXPECT_LT(*told->bound, 1e-6);
    for (int k = 0; k <= 100; ++k) {
        const double t = k / 100.0, u = kPi / 2 * (1 - t);
        const Vec<3> exact{{2 * std::cos(u), 2 * std::sin(u), 1 + t * (1 - t)}};
        EXPECT_LE(norm(jet<0>(*m.edges[2].curve, t).value() - exact), *told->bound);
    }
}

TEST(StepCurves, curves_in_parameters_that_miss_their_vertices_are_refused_with_their_number) {
    const Model m = must(read_step(tile_file(true, false,
                                             "#702=LINE('',#801,#802);\n#801=CARTESIAN_POINT('',(90.,1.7));\n"
                                             "#802=VECTOR('',#803,1.);\n#803=DIRECTION('',(-1.,0.));\n")));
    EXPECT_TRUE(m.faces.empty());
    ASSERT_EQ(m.refused.size(), 1u);
    EXPECT_EQ(m.refused[0].where, "#12 ADVANCED_FACE");
    EXPECT_NE(m.refused[0].message.find("#302 PCURVE: passes 0.7"), std::string::npos)
        << m.refused[0].message;
}

// A file with lines #20 and #30, and more.
Result<Model> read_lines(std::string_view more) {
    return read_step(
        flat_file(text("#8=SHAPE_REPRESENTATION('',(#10),#1);\n#21=DIRECTION('',(0.,0.,1.));\n"
                       "#22=VECTOR('',#21,1.);\n#23=LINE('',#6,#22);\n"
                       "#20=TRIMMED_CURVE('',#23,(PARAMETER_VALUE(0.)),(PARAMETER_VALUE(1.)),"
                       ".T.,.PARAMETER.);\n"
                       "#30=TRIMMED_CURVE('',#23,(PARAMETER_VALUE(2.)),(PARAMETER_VALUE(3.)),"
                       ".T.,.PARAMETER.);\n",
                       more)));
}

TEST(StepShapes, sets_in_themselves_are_named_once_and_the_rest_of_them_is_read_once) {
    for (const char* sets : {"#10=GEOMETRIC_CURVE_SET('',(#20,#10,#10,#30));\n",
                             "#10=GEOMETRIC_CURVE_SET('',(#11,#30));\n"
                             "#11=GEOMETRIC_SET('',(#10,#20,#10));\n"}) {
        const Model m = must(read_lines(sets));
        EXPECT_EQ(m.edges.size(), 2u) << sets;
        ASSERT_EQ(m.refused.size(), 1u) << sets;
        EXPECT_EQ(m.refused[0].where, "#10 GEOMETRIC_CURVE_SET");
        EXPECT_EQ(m.refused[0].message, "contains itself");
    }
    // In one set twice is not in itself.
    const Model twice =
        must(read_lines("#10=GEOMETRIC_CURVE_SET('',(#11,#30,#11));\n#11=GEOMETRIC_SET('',(#20));\n"));
    EXPECT_EQ(twice.edges.size(), 3u);
    EXPECT_TRUE(twice.refused.empty());
}

// Its other rows and what comes after it in the set are there.
TEST(StepShapes, damaged_rows_of_composite_surfaces_are_refused_and_the_rest_is_read) {
    const Model m = must(
        read_lines("#10=GEOMETRIC_SET('',(#40,#20));\n#40=RECTANGULAR_COMPOSITE_SURFACE('',((#41),(.T.)));\n"
                   "#41=SURFACE_PATCH(#43,.CONTINUOUS.,.CONTINUOUS.,.T.,.T.);\n"
                   "#43=RECTANGULAR_TRIMMED_SURFACE('',#7,0.,1.,0.,2.,.T.,.T.);\n"));
    EXPECT_EQ(m.faces.size(), 1u);
    ASSERT_FALSE(m.refused.empty());
    EXPECT_NE(m.refused[0].where.find("#40"), std::string::npos) << m.refused[0].where;
}

TEST(StepShapes, sets_that_double_from_one_to_the_next_are_refused_when_they_are_many) {
    std::string sets;
    for (int i = 0; i < 60; ++i)
        sets += text("#", i == 0 ? 10 : 100 + i, "=GEOMETRIC_SET('',(#", 101 + i, ",#", 101 + i, "));\n");
    sets += "#160=GEOMETRIC_SET('',(#20));\n";
    const Model m = must(read_lines(sets));
    EXPECT_LT(m.edges.size(), sets.size());
    ASSERT_EQ(m.refused.size(), 1u);
    EXPECT_EQ(m.refused[0].kind, RefusalKind::limit);
    EXPECT_EQ(m.refused[0].where, "#10 GEOMETRIC_SET");
}

TEST(StepShapes, solids_of_other_kinds_are_refused_with_their_number_and_kind) {
    const auto refused = [](std::string_view item, std::string_view kind) {
        const std::string_view name = item.substr(0, item.find('('));
        const auto m = read_step(flat_file(text("#8=SHAPE_REPRESENTATION('',(#10),#1);\n#10=", item, ";\n")));
        expect_refusal(m, RefusalKind::unsupported, text("#10 ", name), kind);
        EXPECT_NE(m.error().message.find("which is not read"), std::string::npos);
    };
    for (const std::string_view swept : {"SURFACE_CURVE_SWEPT_AREA_SOLID('',#7,#6,0.,1.,#7)",
                                         "SURFACE_CURVE_SWEPT_FACE_SOLID('',#7,#6,0.,1.,#7)",
                                         "EXTRUDED_FACE_SOLID_WITH_DRAFT_ANGLE('',#7,#6,3.,0.1)"})
        refused(swept, "a swept solid");
    for (const std::string_view csg :
         {"CSG_SOLID('',#5)", "BOOLEAN_RESULT('',.UNION.,#5,#5)", "ELLIPSOID('',#5,1.,2.,3.)",
          "HALF_SPACE_SOLID('',#7,.T.)", "TETRAHEDRON('',(#6))"})
        refused(csg, "a CSG solid");
    refused("TRIMMED_VOLUME('',#5,0.,1.,0.,1.,0.,1.,.T.,.T.,.T.)", "a volume");
    // Beside shapes that are read, they are told.
    const auto beside =
        read_step(polygon_file({{0, 0}, {3, 0}, {3, 2}},
                               "#60=SHAPE_REPRESENTATION('',(#61),#1);\n#61=ELLIPSOID('',#5,1.,2.,3.);\n"));
    ASSERT_TRUE(beside) << beside.error().message;
    EXPECT_EQ(beside->faces.size(), 1u);
    ASSERT_EQ(beside->refused.size(), 1u);
    EXPECT_EQ(beside->refused[0].where, "#61 ELLIPSOID");
}

// A winding stair of planks, 3.6 to the turn: from the middle of one the corners of the next turns are nearer
// than its own.
TEST(StepCurves, are_found_on_the_turn_of_a_thread_that_they_are_on) {
    constexpr int kCorners = 41, kPlank = 20;
    const auto at = [](int corner, double radius, double part) {
        const double a = corner * kPi / 1.8, b = a + kPi / 1.8;
        return Vec<3>{{radius * ((1 - part) * std::cos(a) + part * std::cos(b)),
                       radius * ((1 - part) * std::sin(a) + part * std::sin(b)), (corner + part) / 7.2}};
    };
    const auto point = [](int number, const Vec<3>& p) {
        return text("#", number, "=CARTESIAN_POINT('',(", p[0], ",", p[1], ",", p[2], "));\n");
    };
    std::string rows[2], counts, knots,
        s = "#8=SHAPE_REPRESENTATION('',(#10),#1);\n#10=SHELL_BASED_SURFACE_MODEL('',(#11));\n"
            "#11=OPEN_SHELL('',(#12));\n#12=ADVANCED_FACE('',(#13),#9,.T.);\n#13=FACE_OUTER_BOUND('',#14,.T.)"
            ";\n"
            "#14=EDGE_LOOP('',(#20,#21,#22,#23));\n";
    for (int i = 0; i < kCorners; ++i) {
        for (int k = 0; k < 2; ++k) {
            s += point(100 + 2 * i + k, at(i, 1 + 0.2 * k, 0));
            rows[k] += text(i > 0 ? "," : "", "#", 100 + 2 * i + k);
        }
        counts += text(i > 0 ? "," : "", i % (kCorners - 1) == 0 ? 2 : 1),
            knots += text(i > 0 ? "," : "", i, ".");
    }
    s += text("#9=B_SPLINE_SURFACE_WITH_KNOTS('',1,1,((", rows[0], "),(", rows[1],
              ")),.UNSPECIFIED.,.F.,.F.,.F.,(2,2),(", counts, "),(0.,1.),(", knots, "),.UNSPECIFIED.);\n");
    const Vec<3> corner[] = {at(kPlank, 1.05, 0.42), at(kPlank, 1.15, 0.42), at(kPlank, 1.15, 0.49),
                             at(kPlank, 1.05, 0.49)};
    for (int k = 0; k < 4; ++k) {
        const int next = (k + 1) % 4;
        const Vec<3> d = corner[next] - corner[k];
        s += point(30 + k, corner[k]) +
             text("#", 40 + k, "=VERTEX_POINT('',#", 30 + k, ");\n#", 50 + k, "=DIRECTION('',(", d[0], ",",
                  d[1], ",", d[2], "));\n#", 60 + k, "=VECTOR('',#", 50 + k, ",1.);\n#", 70 + k, "=LINE('',#",
                  30 + k, ",#", 60 + k, ");\n#", 80 + k, "=EDGE_CURVE('',#", 40 + k, ",#", 40 + next, ",#",
                  70 + k, ",.T.);\n#", 20 + k, "=ORIENTED_EDGE('',*,*,#", 80 + k, ",.T.);\n");
    }
    const Model m = must(read_step(flat_file(s)));
    ASSERT_TRUE(m.refused.empty()) << m.refused[0].where << " " << m.refused[0].message;
    EXPECT_NEAR(area_of(m), 0.0076, 1e-4);
}

}  // namespace
}  // namespace freiform::test
