// Composite curves where one curve is needed: profiles of surfaces, and what is trimmed, offset or moved.

#include <algorithm>
#include <cmath>
#include <support/solids.hpp>
#include <support/step_items.hpp>
#include <support/step_measures.hpp>

namespace freiform::test {
namespace {

// A row #20 of three segments from (0, 0): along x to (2, 0), a quarter of a circle about (2, 1) to (3, 1),
// and up to (3, 4), by a line that is given downwards. #28 moves by (0, 0, 2).
constexpr std::string_view kRow =
    "#20=COMPOSITE_CURVE('',(#41,#42,#43),.F.);\n#41=COMPOSITE_CURVE_SEGMENT(.CONTINUOUS.,.T.,#51);\n"
    "#42=COMPOSITE_CURVE_SEGMENT(.CONTINUOUS.,.T.,#52);\n#43=COMPOSITE_CURVE_SEGMENT(.CONTINUOUS.,.F.,#53);\n"
    "#51=TRIMMED_CURVE('',#61,(PARAMETER_VALUE(0.)),(PARAMETER_VALUE(2.)),.T.,.PARAMETER.);\n"
    "#52=TRIMMED_CURVE('',#62,(PARAMETER_VALUE(-1.5707963267948966)),(PARAMETER_VALUE(0.)),.T.,.PARAMETER.);"
    "\n"
    "#53=B_SPLINE_CURVE_WITH_KNOTS('',1,(#64,#65),.UNSPECIFIED.,.F.,.F.,(2,2),(0.,3.),.UNSPECIFIED.);\n"
    "#61=LINE('',#6,#66);\n#66=VECTOR('',#22,1.);\n#62=CIRCLE('',#63,1.);\n"
    "#63=AXIS2_PLACEMENT_3D('',#67,$,$);\n#67=CARTESIAN_POINT('',(2.,1.,0.));\n"
    "#64=CARTESIAN_POINT('',(3.,4.,0.));\n#65=CARTESIAN_POINT('',(3.,1.,0.));\n"
    "#28=CARTESIAN_TRANSFORMATION_OPERATOR_3D('','',$,$,#29,1.,$);\n#29=CARTESIAN_POINT('',(0.,0.,2.));\n"
    "#69=VECTOR('',#21,1.);\n";
// A row of lines alone: (0, 0) to (1, 2) to (3, 1) by a polyline, then to (5, -1); parameters 0 to 2, then 3.
constexpr std::string_view kLines =
    "#20=COMPOSITE_CURVE('',(#41,#42),.F.);\n#41=COMPOSITE_CURVE_SEGMENT(.CONTINUOUS.,.T.,#51);\n"
    "#42=COMPOSITE_CURVE_SEGMENT(.CONTINUOUS.,.F.,#52);\n#51=POLYLINE('',(#30,#31,#33));\n"
    "#52=POLYLINE('',(#35,#33));\n#69=VECTOR('',#21,1.);\n";
constexpr double kLength = 2 + kPi / 2 + 3;

// A face on the surface #70 around the row at both ends: below, up, the row as it is moved by #28, down.
std::string wall(std::string_view surface, std::string_view row = kRow) {
    return item_file(
        "#10", text("#10=SHELL_BASED_SURFACE_MODEL('',(#11));\n#11=OPEN_SHELL('',(#12));\n"
                    "#12=ADVANCED_FACE('',(#13),#70,.T.);\n#13=FACE_OUTER_BOUND('',#14,.T.);\n"
                    "#14=EDGE_LOOP('',(#81,#82,#83,#84));\n#81=ORIENTED_EDGE('',*,*,#91,.T.);\n"
                    "#82=ORIENTED_EDGE('',*,*,#92,.T.);\n#83=ORIENTED_EDGE('',*,*,#93,.F.);\n"
                    "#84=ORIENTED_EDGE('',*,*,#94,.F.);\n#91=EDGE_CURVE('',#101,#102,#20,.T.);\n"
                    "#92=EDGE_CURVE('',#102,#104,#111,.T.);\n#93=EDGE_CURVE('',#103,#104,#110,.T.);\n"
                    "#94=EDGE_CURVE('',#101,#103,#112,.T.);\n#110=CURVE_REPLICA('',#20,#28);\n"
                    "#111=LINE('',#64,#69);\n#112=LINE('',#6,#69);\n#101=VERTEX_POINT('',#6);\n"
                    "#102=VERTEX_POINT('',#64);\n#103=VERTEX_POINT('',#29);\n#104=VERTEX_POINT('',#105);\n"
                    "#105=CARTESIAN_POINT('',(3.,4.,2.));\n#70=",
                    surface, ";\n", row));
}
constexpr std::string_view kUp = "SURFACE_OF_LINEAR_EXTRUSION('',#20,#69)";

TEST(StepProfile, walls_along_a_row_have_its_length) {
    const Model m = must(read_step(wall(kUp)));
    ASSERT_EQ(m.faces.size(), 1u) << (m.refused.empty() ? "" : m.refused[0].message);
    EXPECT_TRUE(m.refused.empty());
    // The edge below is one for each segment; the one above is the row moved, as one curve.
    EXPECT_EQ(m.edges.size(), 6u);
    EXPECT_NEAR(area_of(m, 1e-6), 2 * kLength, 1e-5);
    EXPECT_EQ(times_told(m, "#20 COMPOSITE_CURVE: a spline near it stands for it"), 1);
    for (const Approximation& a : m.approximations)
        EXPECT_LE(a.bound.value_or(1), a.what.starts_with("#20") ? 1e-10 : 1e-4) << a.what;
}

TEST(StepProfile, the_row_is_followed_by_the_spline_that_stands_for_it) {
    const Model m = items_model(
        "#10", text("#10=GEOMETRIC_CURVE_SET('',(#19));\n#19=CURVE_REPLICA('',#20,#28);\n", kRow));
    ASSERT_EQ(m.edges.size(), 1u);
    const Edge& e = m.edges[0];
    const Curve<Hom<3>>& c = std::get<Curve<Hom<3>>>(*e.curve);
    EXPECT_EQ(c.basis().degree(), 2);
    EXPECT_EQ(e.range, (Interval{0, 2 + kPi / 2 + 3}));
    for (int k = 0; k <= 300; ++k) {
        const double t = e.range.hi * k / 300;
        const Vec<3> p = point_at(e, t), centre{{2, 1, 2}};
        if (t <= 2)
            expect_near(p, {{t, 0, 2}});
        else if (t >= 2 + kPi / 2)
            expect_near(p, {{3, 1 + (t - 2 - kPi / 2), 2}});
        else
            EXPECT_NEAR(norm(p - centre), 1, 1e-14) << t;
    }
}

TEST(StepProfile, parameters_are_those_of_the_segments_added_up) {
    // Of lines alone the row is exact, and so are trims.
    const Model m =
        items_model("#10", text("#10=GEOMETRIC_SET('',(#15));\n"
                                "#15=RECTANGULAR_TRIMMED_SURFACE('',#70,0.5,2.5,0.,3.,.T.,.T.);\n#70=",
                                kUp, ";\n", kLines));
    ASSERT_EQ(m.faces.size(), 1u);
    EXPECT_TRUE(m.approximations.empty());
    EXPECT_NEAR(area_of(m, 1e-6), 3 * (std::sqrt(5) / 2 + std::sqrt(5) + std::sqrt(2)), 1e-9);
    const Edge part =
        only_curve(text("#20=TRIMMED_CURVE('',#19,(PARAMETER_VALUE(0.5)),(PARAMETER_VALUE(2.5)),"
                        ".T.,.PARAMETER.);\n#19",
                        kLines.substr(3)));
    EXPECT_EQ(part.range, (Interval{0.5, 2.5}));
    expect_near(point_at(part, 0.5), {{0.5, 1, 0}});
    expect_near(point_at(part, 2.5), {{4, 0, 0}});
}

// A corner inside of a face is seen as one: each side of it has its normals, at points that both share.
TEST(StepProfile, both_sides_of_a_corner_have_their_normals) {
    const Model m =
        items_model("#10", text("#10=GEOMETRIC_SET('',(#15));\n"
                                "#15=RECTANGULAR_TRIMMED_SURFACE('',#70,0.5,2.5,0.,3.,.T.,.T.);\n#70=",
                                kUp, ";\n", kLines));
    const auto t = must(tessellate(m, {.tolerance = 1e-3, .max_edge = 0.5}));
    EXPECT_GT(t.mesh.triangles.size(), 100u);
    EXPECT_GT(t.mesh.vertices.size(), t.mesh.points.size());
    std::vector<char> used(t.mesh.vertices.size());
    for (const auto& corners : t.mesh.triangles) {
        const auto at = [&](std::size_t k) -> const MeshVertex& {
            return t.mesh.vertices[std::size_t(corners[k])];
        };
        const auto point = [&](std::size_t k) { return t.mesh.points[std::size_t(at(k).point)]; };
        const Vec<3> flat = unit(cross(point(1) - point(0), point(2) - point(0)));
        for (std::size_t k = 0; k < 3; ++k) {
            EXPECT_NEAR(norm(at(k).normal - flat), 0, 1e-9);
            used[std::size_t(corners[k])] = 1;
        }
    }
    EXPECT_EQ(std::ranges::count(used, 0), 0);
}

TEST(StepProfile, angles_inside_of_conics_are_not_parameters_of_the_spline) {
    const auto trimmed = [](std::string_view from, std::string_view how) {
        return read_step(
            item_file("#10", text("#10=GEOMETRIC_CURVE_SET('',(#15));\n#15=TRIMMED_CURVE('',#20,", from,
                                  ",(#64,PARAMETER_VALUE(6.57)),.T.,", how,
                                  ");\n"
                                  "#18=CARTESIAN_POINT('',(2.6,0.2,0.));\n",
                                  kRow)));
    };
    expect_refusal(trimmed("(PARAMETER_VALUE(2.5))", ".PARAMETER."), RefusalKind::unsupported,
                   "#15 TRIMMED_CURVE", "is trimmed by a parameter of a composite curve with conics");
    const Model m = must(trimmed("(#18,PARAMETER_VALUE(2.5))", ".PARAMETER."));
    ASSERT_EQ(m.edges.size(), 1u);
    EXPECT_NEAR(norm(point_at(m.edges[0], m.edges[0].range.lo) - Vec<3>{{2.6, 0.2, 0}}), 0, 1e-12);
    expect_refusal(
        read_step(item_file("#10", text("#10=GEOMETRIC_SET('',(#15));\n"
                                        "#15=RECTANGULAR_TRIMMED_SURFACE('',#70,0.5,2.5,0.,3.,.T.,.T.);\n"
                                        "#70=",
                                        kUp, ";\n", kRow))),
        RefusalKind::unsupported, "#15 RECTANGULAR_TRIMMED_SURFACE",
        "is trimmed by parameters of a composite curve with conics");
}

// Around the x axis: two discs' rims, a cone between.
TEST(StepProfile, rows_are_turned_about_axes) {
    const Model m = items_model(
        "#10", text("#10=GEOMETRIC_SET('',(#15));\n"
                    "#15=RECTANGULAR_TRIMMED_SURFACE('',#70,0.,6.283185307179586,0.,3.,.T.,.T.);\n"
                    "#70=SURFACE_OF_REVOLUTION('',#20,#71);\n#71=AXIS1_PLACEMENT('',#72,#22);\n"
                    "#72=CARTESIAN_POINT('',(0.,-1.5,0.));\n",
                    kLines));
    ASSERT_EQ(m.faces.size(), 1u);
    // Frustums: pi (r + R) times the slant.
    const double area =
        kPi * ((1.5 + 3.5) * std::sqrt(5) + (3.5 + 2.5) * std::sqrt(5) + (2.5 + 0.5) * std::sqrt(8));
    EXPECT_NEAR(area_of(m, 1e-4), area, 1e-2);
    // Beside the corners of the row all of the error is asked for, elsewhere what is seen along normals: some
    // 1,700 triangles are enough for three cones within 1e-4, 350,000 were made when normals were not asked.
    const auto triangles = [&](double tolerance) {
        return double(must(tessellate(m, {.tolerance = tolerance})).mesh.triangles.size());
    };
    const double many = triangles(1e-4);
    EXPECT_LE(many, 70'000);
    EXPECT_LE(triangles(1e-5), 6 * many);
}

TEST(StepProfile, gaps_within_the_tolerance_are_closed_and_wider_ones_refused) {
    const auto with_gap = [](std::string_view y) {
        std::string row(kRow);
        const std::string_view end = "#65=CARTESIAN_POINT('',(3.,1.,";
        row.replace(row.find(end), end.size(), text("#65=CARTESIAN_POINT('',(3.,", y, ","));
        return read_step(wall(kUp, row));
    };
    const Model m = must(with_gap("1.00005"));
    ASSERT_EQ(m.faces.size(), 1u) << m.refused[0].message;
    const auto row = std::ranges::find_if(
        m.approximations, [](const Approximation& a) { return a.what.starts_with("#20 COMP"); });
    ASSERT_NE(row, m.approximations.end());
    EXPECT_GE(*row->bound, 5e-5 * (1 - 1e-9));
    EXPECT_LE(*row->bound, 5.1e-5);
    const auto wide = with_gap("1.001");
    const auto& why = wide ? wide->refused.at(0) : wide.error();
    EXPECT_NE(text(why.where, " ", why.message).find("#43 COMPOSITE_CURVE_SEGMENT: begins 0.00"),
              std::string::npos)
        << why.message;
}

// A short arc and a short line far from what they are given by: what rounding moves is no less for that.
TEST(StepProfile, bounds_are_of_the_numbers_that_curves_are_made_of) {
    const auto bound = [](std::string_view curve) {
        const Model m = items_model(
            "#10",
            text("#10=GEOMETRIC_CURVE_SET('',(#15));\n#15=CURVE_REPLICA('',#20,#28);\n"
                 "#28=CARTESIAN_TRANSFORMATION_OPERATOR_3D('','',$,$,#6,1.,$);\n"
                 "#20=COMPOSITE_CURVE('',(#41),.F.);\n#41=COMPOSITE_CURVE_SEGMENT(.CONTINUOUS.,.T.,#51);\n"
                 "#67=CARTESIAN_POINT('',(1.E9,0.,0.));\n#63=AXIS2_PLACEMENT_3D('',#67,#21,#22);\n"
                 "#66=VECTOR('',#22,1.);\n#51=TRIMMED_CURVE('',",
                 curve));
        EXPECT_EQ(m.approximations.size(), 1u);
        return m.approximations.empty() ? 0.0 : m.approximations[0].bound.value_or(0);
    };
    EXPECT_GE(bound("#62,(PARAMETER_VALUE(3.1415926525)),(PARAMETER_VALUE(3.1415926545)),.T.,.PARAMETER.);\n"
                    "#62=CIRCLE('',#63,1.E9);\n"),
              1e9 * 0x1p-53);
    EXPECT_GE(bound("#61,(PARAMETER_VALUE(-1000000000.)),(PARAMETER_VALUE(-999999998.7)),.T.,.PARAMETER.);\n"
                    "#61=LINE('',#67,#66);\n"),
              1e9 * 0x1p-53);
}

TEST(StepProfile, what_contains_itself_is_refused) {
    const auto refused = [](std::string_view rows, RefusalKind kind, std::string_view what) {
        const auto m = read_step(item_file(
            "#10", text("#10=GEOMETRIC_SET('',(#40));\n#40=", kUp, ";\n#69=VECTOR('',#21,1.);\n", rows)));
        expect_refusal(m, kind, "#40 SURFACE_OF_LINEAR_EXTRUSION", what);
    };
    refused("#20=COMPOSITE_CURVE('',(#71,#71),.F.);\n#71=COMPOSITE_CURVE_SEGMENT(.CONTINUOUS.,.T.,#20);\n",
            RefusalKind::invalid, "#20 COMPOSITE_CURVE: is a curve that is a part of itself");
    for (const int many : {1, 2}) {  // in each other a hundred times; forty times, each twice the one before
        std::string rows =
            "#20=COMPOSITE_CURVE('',(#70),.F.);\n#70=COMPOSITE_CURVE_SEGMENT(.CONTINUOUS.,.T.,#1000);\n"
            "#90=POLYLINE('',(#30,#32));\n#91=TRIMMED_CURVE('',#90,(#30),(#32),.T.,.CARTESIAN.);\n";
        const int count = many == 1 ? 30'000 : 19;
        for (int k = 0; k < count; ++k)
            rows += text("#", 1000 + k, "=COMPOSITE_CURVE('',(#", 100'000 + k,
                         many == 2 ? text(",#", 200'000 + k) : "", "),.F.);\n#", 100'000 + k,
                         "=COMPOSITE_CURVE_SEGMENT(.CONTINUOUS.,.T.,#", k + 1 == count ? 91 : 1001 + k,
                         ");\n#", 200'000 + k, "=COMPOSITE_CURVE_SEGMENT(.CONTINUOUS.,.F.,#",
                         k + 1 == count ? 91 : 1001 + k, ");\n");
        refused(rows, RefusalKind::limit,
                many == 1 ? "is a composite curve in more than 20 others"
                          : "contains itself, or has more segments");
    }
}

// A segment of a sphere that a whole circle makes, about a line through it: every place of the surface is
// passed twice. What the segment begins with is either half of the circle.
TEST(StepProfile, of_a_circle_about_its_diameter_the_half_is_meant_where_the_edges_are) {
    constexpr double kTurn = 1;
    for (const double side : {1.0, -1.0})
        for (const double x : {0.6, 0.8}) {
            const double y = std::sqrt(1 - x * x), c = std::cos(kTurn), s = std::sin(kTurn);
            const Model m = must(read_step(flat_file(text(
                "#8=SHAPE_REPRESENTATION('',(#10),#1);\n#10=SHELL_BASED_SURFACE_MODEL('',(#11));\n"
                "#11=OPEN_SHELL('',(#12));\n#12=ADVANCED_FACE('',(#13),#20,.T.);\n"
                "#13=FACE_OUTER_BOUND('',#14,.T.);\n#14=EDGE_LOOP('',(#15,#16));\n"
                "#15=ORIENTED_EDGE('',*,*,#18,.T.);\n#16=ORIENTED_EDGE('',*,*,#17,.F.);\n"
                "#17=EDGE_CURVE('',#30,#31,#32,.T.);\n#18=EDGE_CURVE('',#30,#31,#33,.T.);\n"
                "#20=SURFACE_OF_REVOLUTION('',#21,#22);\n#21=CIRCLE('',#5,1.);\n"
                "#22=AXIS1_PLACEMENT('',#6,#23);\n#23=DIRECTION('',(",
                x, ",", y, ",0.));\n#30=VERTEX_POINT('',#40);\n#31=VERTEX_POINT('',#41);\n",
                "#32=CIRCLE('',#34,1.);\n#33=CIRCLE('',#35,1.);\n#34=AXIS2_PLACEMENT_3D('',#6,#36,#37);\n"
                "#35=AXIS2_PLACEMENT_3D('',#6,#38,#37);\n#36=DIRECTION('',(0.,0.,1.));\n#37=DIRECTION('',(",
                side * x, ",", side * y, ",0.));\n#38=DIRECTION('',(", s * y, ",", -s * x, ",", c,
                "));\n#40=CARTESIAN_POINT('',(", side * x, ",", side * y, ",0.));\n#41=CARTESIAN_POINT('',(",
                -side * x, ",", -side * y, ",0.));\n"))));
            ASSERT_EQ(m.faces.size(), 1u);
            EXPECT_NEAR(area_of(m), 2 * kTurn, 1e-3) << side << " " << x;
        }
}

}  // namespace
}  // namespace freiform::test
