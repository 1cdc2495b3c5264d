// Boundaries that files get wrong by a little: what is mended is told, and nothing else is mended.
#include <freiform/io/file.hpp>
#include <freiform/io/step_read.hpp>
#include <freiform/model/tessellate.hpp>

#include <algorithm>
#include <numbers>
#include <support/corpus.hpp>
#include <support/random.hpp>
#include <support/refusal.hpp>
#include <support/step_measures.hpp>
#include <support/step_polygons.hpp>

namespace freiform::test {
namespace {

TEST(StepLoops, edges_that_are_nearly_nothing_are_left_out_and_told) {
    // The fourth edge is 2e-8 long and runs back; the tolerance is 1e-4.
    const Model m = must(read_step(polygon_file({{0, 0}, {3, 0}, {3, 2}, {0, 2}, {2e-8, 2}})));
    ASSERT_TRUE(m.refused.empty()) << m.refused[0].message;
    EXPECT_EQ(summary(m).edges, 4);
    EXPECT_EQ(times_told(m, "#403 EDGE_CURVE is shorter than a thousandth"), 1);
    EXPECT_EQ(times_told(m, "#204 VERTEX_POINT is taken for #203 VERTEX_POINT, 2e-08 from it"), 1);
    for (const Approximation& a : m.approximations) {
        ASSERT_TRUE(a.bound) << a.what;
        EXPECT_GE(*a.bound, 2e-8);
        EXPECT_LT(*a.bound, 2.001e-8);
    }
    EXPECT_NEAR(area_of(m, 1e-3), 6, 1e-6);
    // One of the size of the tolerance is there.
    const Model wide = must(read_step(polygon_file({{0, 0}, {3, 0}, {3, 2}, {1e-4, 2}, {0, 1.9999}})));
    EXPECT_EQ(summary(wide).edges, 5);
    EXPECT_EQ(times_told(wide, "shorter"), 0);
}

// Lengths whose squares are beyond all numbers: parameters of the boundary are none.
TEST(StepLoops, boundaries_whose_parameters_are_no_numbers_are_refused) {
    const Model m = must(read_step(flat_file(
        "#10=SHELL_BASED_SURFACE_MODEL('',(#11));\n#11=OPEN_SHELL('',(#12,#50));\n"
        "#12=ADVANCED_FACE('',(#13),#20,.T.);\n#13=FACE_BOUND('',#14,.T.);\n#14=EDGE_LOOP('',(#15,#16));\n"
        "#15=ORIENTED_EDGE('',*,*,#17,.T.);\n#16=ORIENTED_EDGE('',*,*,#17,.F.);\n"
        "#17=EDGE_CURVE('',#18,#19,#30,.T.);\n#18=VERTEX_POINT('',#31);\n#19=VERTEX_POINT('',#32);\n"
        "#20=SURFACE_OF_REVOLUTION('',#21,#25);\n#21=ELLIPSE('',#22,5.8E135,4.);\n"
        "#22=AXIS2_PLACEMENT_3D('',#33,#23,#24);\n#23=DIRECTION('',(0.,-16.,-2.3E136));\n"
        "#24=DIRECTION('',(0.,5.8E135,-4.));\n#25=AXIS1_PLACEMENT('',#33,#26);\n#26=DIRECTION('',(0.,0.,1.));"
        "\n"
        "#27=DIRECTION('',(0.,-1.,0.));\n#28=DIRECTION('',(0.,0.,-1.));\n"
        "#29=AXIS2_PLACEMENT_3D('',#33,#27,#28);\n#30=CIRCLE('',#29,4.);\n"
        "#31=CARTESIAN_POINT('',(1.,2.,-1.));\n#32=CARTESIAN_POINT('',(1.,2.,7.));\n"
        "#33=CARTESIAN_POINT('',(1.,2.,3.));\n#50=PLANE('',#29);\n#60=SHAPE_REPRESENTATION('',(#10),#1);"
        "\n")));
    ASSERT_EQ(m.refused.size(), 2u);
    EXPECT_EQ(m.refused[0].where, "#12 ADVANCED_FACE");
    EXPECT_NE(m.refused[0].message.find("winds around"), std::string::npos) << m.refused[0].message;
}

TEST(StepLoops, edges_around_one_vertex_whose_spline_ends_beside_its_beginning_run_along_all_of_it) {
    // A square of lines as one spline, whose end is 1e-3 below its beginning; the tolerance is 1e-4.
    const auto file = [](std::string_view end, std::string_view use = ".T.") {
        return flat_file(
            text("#10=SHELL_BASED_SURFACE_MODEL('',(#11));\n#11=OPEN_SHELL('',(#12));\n"
                 "#12=ADVANCED_FACE('',(#13),#7,.T.);\n#13=FACE_OUTER_BOUND('',#14,.T.);\n"
                 "#8=SHAPE_REPRESENTATION('',(#10),#1);\n#14=EDGE_LOOP('',(#15));\n"
                 "#15=ORIENTED_EDGE('',*,*,#16,",
                 use, ");\n#16=EDGE_CURVE('',#17,#17,#18,", use,
                 ");\n"
                 "#17=VERTEX_POINT('',#20);\n#18=B_SPLINE_CURVE_WITH_KNOTS('',1,(#20,#21,#22,#23,",
                 end,
                 "),.UNSPECIFIED.,.F.,.F.,(2,1,1,1,2),(0.,1.,2.,3.,4.),.UNSPECIFIED.);\n"
                 "#20=CARTESIAN_POINT('',(0.,0.,0.));\n#21=CARTESIAN_POINT('',(2.,0.,0.));\n"
                 "#22=CARTESIAN_POINT('',(2.,2.,0.));\n#23=CARTESIAN_POINT('',(0.,2.,0.));\n"
                 "#24=CARTESIAN_POINT('',(0.,0.001,0.));\n#25=CARTESIAN_POINT('',(0.,1.,0.));\n"));
    };
    for (const char* use : {".T.", ".F."}) {
        const Model m = must(read_step(file("#24", use)));
        ASSERT_TRUE(m.refused.empty()) << m.refused[0].message;
        ASSERT_EQ(summary(m).edges, 1);
        EXPECT_EQ(m.edges[0].range, (Interval{0, 4}));
        EXPECT_EQ(times_told(m, "#16 EDGE_CURVE ends 0.001 from its vertex"), 1);
        EXPECT_NEAR(m.vertices[0].tolerance, 1e-3, 1e-12);
        EXPECT_NEAR(area_of(m, 1e-3), 4, 1e-3);
    }
    // One that ends half a side away is not closed: nothing of it may get lost in silence.
    const auto far = read_step(file("#25"));
    ASSERT_FALSE(far);
    EXPECT_NE(far.error().message.find(
                  "#16 EDGE_CURVE: begins and ends at one vertex, but its curve is 1 from closing"),
              std::string::npos)
        << far.error().message;
}

// A tiny curve of one vertex that does not close is that vertex; a longer one contradicts it.
TEST(StepLoops, open_curves_between_a_vertex_and_itself_are_that_if_they_are_tiny) {
    const auto file = [](std::string_view x) {
        return replaced(
            polygon_file(
                {{0, 0}, {3, 0}, {3, 2}, {0, 2}},
                text("#960=ORIENTED_EDGE('',*,*,#961,.T.);\n#961=EDGE_CURVE('',#201,#201,#962,.T.);\n"
                     "#962=B_SPLINE_CURVE_WITH_KNOTS('',1,(#101,#963),.UNSPECIFIED.,.F.,.F.,(2,2),"
                     "(0.,1.),.UNSPECIFIED.);\n#963=CARTESIAN_POINT('',(",
                     x, ",0.,0.));\n")),
            "(#500,", "(#500,#960,");
    };
    const Model m = must(read_step(file("3.0002")));
    ASSERT_TRUE(m.refused.empty()) << m.refused[0].message;
    EXPECT_EQ(m.edges.size(), 4u);
    EXPECT_EQ(times_told(m, "#961 EDGE_CURVE begins and ends at one vertex, and is taken for that"), 1);
    EXPECT_NEAR(area_of(m, 1e-3), 6, 1e-9);
    const auto longer = read_step(file("3.002"));
    ASSERT_TRUE(!longer || longer->faces.empty());
    EXPECT_NE((longer ? longer->refused.at(0) : longer.error()).message.find("from closing"),
              std::string::npos);
}

TEST(StepLoops, vertices_that_loops_take_for_one_are_told_with_their_numbers_and_how_far_they_are_apart) {
    const auto apart = [](std::string_view x) {
        std::string s =
            polygon_file({{0, 0}, {3, 0}, {3, 2}, {0, 2}},
                         text("#950=VERTEX_POINT('',#951);\n#951=CARTESIAN_POINT('',(", x, ",0.,0.));\n"));
        const std::string_view edge = "EDGE_CURVE('',#200,#201,";
        return must(read_step(s.replace(s.find(edge), edge.size(), "EDGE_CURVE('',#200,#950,")));
    };
    const Model m = apart("3.00001");
    EXPECT_EQ(m.faces.size(), 1u);
    EXPECT_EQ(summary(m).vertices, 4);
    ASSERT_EQ(m.approximations.size(), 1u);
    const std::string& what = m.approximations[0].what;
    EXPECT_TRUE(what.starts_with("#201 VERTEX_POINT is taken for #950 VERTEX_POINT, 1.00") ||
                what.starts_with("#950 VERTEX_POINT is taken for #201 VERTEX_POINT, 1.00"))
        << what;
    ASSERT_TRUE(m.approximations[0].bound);
    EXPECT_GE(*m.approximations[0].bound, 3.00001 - 3);
    EXPECT_LT(*m.approximations[0].bound, 1.1e-5);
    // Two names of one place are nothing to tell.
    EXPECT_TRUE(apart("3.").approximations.empty());
}

TEST(StepLoops, segments_of_a_boundary_that_run_the_wrong_way_are_turned_and_told) {
    const auto file = [](const char* third) {
        std::string s =
            "#8=SHAPE_REPRESENTATION('',(#9),#1);\n#9=GEOMETRIC_SET('',(#10));\n"
            "#10=CURVE_BOUNDED_SURFACE('',#7,(#11),.F.);\n"
            "#11=OUTER_BOUNDARY_CURVE('',(#500,#501,#502,#503),.F.);\n";
        constexpr Corner kAt[] = {{0, 0}, {3, 0}, {3, 2}, {0, 2}};
        for (int i = 0; i < 4; ++i) {
            const Corner a = kAt[i], b = kAt[(i + 1) % 4];
            s +=
                text("#", 100 + i, "=CARTESIAN_POINT('',(", a.x, ",", a.y, ",0.));\n#", 300 + i,
                     "=POLYLINE('',(#", 100 + i, ",#", 100 + (i + 1) % 4, "));\n#", 500 + i,
                     "=COMPOSITE_CURVE_SEGMENT(.CONTINUOUS.,", i == 2 ? third : ".T.", ",#", 300 + i, ");\n");
            (void)b;
        }
        return flat_file(s);
    };
    const Model good = must(read_step(file(".T."))), turned = must(read_step(file(".F.")));
    ASSERT_EQ(good.faces.size(), 1u);
    ASSERT_EQ(turned.faces.size(), 1u) << (turned.refused.empty() ? "" : turned.refused[0].message);
    EXPECT_EQ(times_told(good, "taken the other way"), 0);
    EXPECT_EQ(times_told(turned, "#502 COMPOSITE_CURVE_SEGMENT runs against its boundary"), 1);
    EXPECT_NEAR(area_of(good), 6, 1e-9);
    EXPECT_NEAR(area_of(turned), 6, 1e-9);
}

TEST(StepLoops, edges_that_run_against_both_their_neighbours_are_turned_and_told) {
    const std::vector<Corner> corners{{0, 0}, {3, 0}, {3, 2}, {1, 2}, {0, 1}};
    const auto file = [&](const std::vector<int>& turned) {
        std::string s = polygon_file(corners);
        for (const int i : turned)  // the flag of its use
            s.replace(s.find(text(",#", 400 + i, ",.T.")) + 6, 3, ".F.");
        return s;
    };
    EXPECT_EQ(times_told(must(read_step(file({}))), "against"), 0);
    for (const auto& turned : {std::vector{1}, {4}, {0}, {2, 3}, {0, 4}, {0, 2, 4}}) {
        const Model m = must(read_step(file(turned)));
        ASSERT_EQ(m.faces.size(), 1u) << turned[0] << (m.refused.empty() ? "" : m.refused[0].message);
        EXPECT_NEAR(area_of(m), 5.5, 1e-9);
        EXPECT_EQ(times_told(m, "runs against its neighbours"), int(turned.size()));
        EXPECT_EQ(times_told(m, text("#", 500 + turned[0], " ORIENTED_EDGE")), 1);
    }
    // All of them: the loop in its own sense; nothing else about it is doubtful.
    EXPECT_EQ(times_told(must(read_step(file({0, 1, 2, 3, 4}))), "runs against its neighbours"), 5);
    // A boundary with a gap has no sense that closes it.
    std::string open = file({1});
    open.replace(open.find("#502,"), 5, "");
    const Model gap = must(read_step(open));
    ASSERT_EQ(gap.refused.size(), 1u);
    EXPECT_NE(gap.refused[0].message.find("is not closed"), std::string::npos) << gap.refused[0].message;
}

// Profiles whose ends are nearer to each other than the tolerance of the file, one of them because all of it
// is: that does not go around.
TEST(StepLoops, surfaces_as_narrow_as_the_tolerance_do_not_close) {
    const auto file = [](double width, bool of_points) {
        const auto at = [&](int i, double x, double z) {
            return text("#", i, "=CARTESIAN_POINT('',(", x, ",0.,", z, "));\n");
        };
        std::string s = at(100, 0, 0.9) + at(101, width / 2, 1) + at(102, -width / 2, 1) +
                        at(103, width / 2, 0) + at(104, -width / 2, 0);
        s +=
            of_points
                ? "#9=B_SPLINE_SURFACE_WITH_KNOTS('',1,1,((#103,#101),(#104,#102)),.UNSPECIFIED.,.F.,.F.,.F.,"
                  "(2,2),(2,2),(0.,1.),(0.,1.),.UNSPECIFIED.);\n"
                : "#9=SURFACE_OF_LINEAR_EXTRUSION('',#80,#81);\n";
        s += "#80=B_SPLINE_CURVE_WITH_KNOTS('',1,(#103,#104),.UNSPECIFIED.,.F.,.F.,(2,2),(0.,1.),."
             "UNSPECIFIED.);\n"
             "#81=VECTOR('',#82,1.);\n#82=DIRECTION('',(0.,0.,1.));\n"
             "#8=SHAPE_REPRESENTATION('',(#10),#1);\n#10=SHELL_BASED_SURFACE_MODEL('',(#11));\n"
             "#11=OPEN_SHELL('',(#12));\n#12=ADVANCED_FACE('',(#13),#9,.T.);\n#13=FACE_BOUND('',#14,.T.);\n"
             "#14=EDGE_LOOP('',(#500,#501,#502));\n";
        for (int i = 0; i < 3; ++i) {
            const int k = (i + 1) % 3;
            s += text("#", 200 + i, "=VERTEX_POINT('',#", 100 + i, ");\n#", 300 + i,
                      "=B_SPLINE_CURVE_WITH_KNOTS('',1,(#", 100 + i, ",#", 100 + k,
                      "),.UNSPECIFIED.,.F.,.F.,(2,2),(0.,1.),.UNSPECIFIED.);\n#", 400 + i, "=EDGE_CURVE('',#",
                      200 + i, ",#", 200 + k, ",#", 300 + i, ",.T.);\n#", 500 + i, "=ORIENTED_EDGE('',*,*,#",
                      400 + i, ",.T.);\n");
        }
        return flat_file(s);
    };
    for (const bool of_points : {false, true})
        for (const double width : {0.3, 1e-5, 1e-6}) {
            const Model m = must(read_step(file(width, of_points)));
            ASSERT_EQ(m.faces.size(), 1u) << width << (m.refused.empty() ? "" : m.refused[0].message);
            const auto t = must(tessellate(m, {.tolerance = 0.01}));
            ASSERT_TRUE(t.refused.empty()) << width << t.refused[0].reason.message;
            EXPECT_EQ(t.mesh.triangles.size(), 1u);
        }
}

// A strip 1.8 long and 1.5e-6 wide, of a file with the tolerance 2e-6, whose short sides are two edges each.
TEST(StepLoops, the_short_sides_of_a_strip_as_narrow_as_the_tolerance_are_no_poles) {
    const Model m = must(
        read_step(must(read_file(text(FREIFORM_SOURCE_DIR, "/tests/data/step/narrow_strip.stp"), 1 << 20))));
    ASSERT_EQ(m.faces.size(), 1u) << m.refused[0].message;
    EXPECT_EQ(summary(m).edges, 6);
    EXPECT_EQ(summary(m).degenerate_edges, 0);
    EXPECT_NEAR(area_of(m, 1e-3), 1.79999894 * 1.466471987e-6, 1e-9);
}

// A sphere of radius 2 with the part below or above a circle, and a seam from there to a pole.
std::string cap_file(bool south, bool circle_forward) {
    const char* z = south ? "-2." : "2.";
    return flat_file(text(
        "#8=SHAPE_REPRESENTATION('',(#10),#1);\n#10=SHELL_BASED_SURFACE_MODEL('',(#11));\n"
        "#11=OPEN_SHELL('',(#12));\n#12=ADVANCED_FACE('',(#13),#9,.T.);\n#13=FACE_BOUND('',#14,.T.);\n"
        "#9=SPHERICAL_SURFACE('',#5,2.);\n#14=EDGE_LOOP('',(#15,#16,#17));\n#15=ORIENTED_EDGE('',*,*,#20,",
        circle_forward ? ".T." : ".F.",
        ");\n#16=ORIENTED_EDGE('',*,*,#21,.T.);\n#17=ORIENTED_EDGE('',*,*,#21,.F.);\n"
        "#20=EDGE_CURVE('',#30,#30,#40,.T.);\n#21=EDGE_CURVE('',#30,#31,#41,",
        south ? ".F." : ".T.",
        ");\n#30=VERTEX_POINT('',#32);\n#31=VERTEX_POINT('',#33);\n#32=CARTESIAN_POINT('',(2.,0.,0.));\n"
        "#33=CARTESIAN_POINT('',(0.,0.,",
        z,
        "));\n#40=CIRCLE('',#5,2.);\n#41=CIRCLE('',#42,2.);\n"
        "#42=AXIS2_PLACEMENT_3D('',#6,#43,#44);\n#43=DIRECTION('',(0.,-1.,0.));\n"
        "#44=DIRECTION('',(1.,0.,0.));\n"));
}

TEST(StepLoops, what_a_loop_with_a_seam_to_a_pole_encloses_is_on_the_side_of_the_pole) {
    for (const bool south : {false, true})
        for (const bool forward : {false, true}) {
            const Model m = must(read_step(cap_file(south, forward)));
            ASSERT_EQ(m.faces.size(), 1u) << (m.refused.empty() ? "" : m.refused[0].message);
            EXPECT_EQ(times_told(m, "the wrong way around"), forward == south ? 1 : 0) << south << forward;
            Box<3> box;
            for (const Vec<3>& p : must(tessellate(m, {.tolerance = 1e-2})).mesh.points) box.add(p);
            EXPECT_NEAR(south ? box.lo[2] : box.hi[2], south ? -2 : 2, 1e-12);
            EXPECT_NEAR(south ? box.hi[2] : box.lo[2], 0, 1e-12);
        }
}

// An octant of a sphere of radius 2, one of whose sides passes over the pole, a third of the way along it.
TEST(StepLoops, edges_that_pass_over_a_pole_get_other_poles) {
    constexpr double kPi = std::numbers::pi;
    const double c = std::cos(kPi / 3), s = std::sin(kPi / 3);
    const std::array<Vec<3>, 3> corner{{{{c, 0, s}}, {{-s, 0, c}}, {{0, 1, 0}}}};
    std::string f =
        "#8=SHAPE_REPRESENTATION('',(#10),#1);\n#10=SHELL_BASED_SURFACE_MODEL('',(#11));\n"
        "#11=OPEN_SHELL('',(#12));\n#12=ADVANCED_FACE('',(#13),#9,.T.);\n#13=FACE_BOUND('',#14,.T.);\n"
        "#9=SPHERICAL_SURFACE('',#5,2.);\n#14=EDGE_LOOP('',(#20,#21,#22));\n";
    const auto triple = [](const Vec<3>& p) { return text("('',(", p[0], ",", p[1], ",", p[2], "));\n"); };
    for (std::size_t i = 0; i < 3; ++i) {
        // From the next corner to this one: counter-clockwise about the third.
        const std::size_t next = (i + 1) % 3;
        f += text("#", 20 + i, "=ORIENTED_EDGE('',*,*,#", 30 + i, ",.T.);\n#", 30 + i, "=EDGE_CURVE('',#",
                  40 + next, ",#", 40 + i, ",#", 50 + i, ",.T.);\n#", 40 + i, "=VERTEX_POINT('',#", 60 + i,
                  ");\n#", 60 + i, "=CARTESIAN_POINT", triple(2.0 * corner[i]), "#", 50 + i, "=CIRCLE('',#",
                  70 + i, ",2.);\n#", 70 + i, "=AXIS2_PLACEMENT_3D('',#6,#", 80 + i, ",#", 90 + next, ");\n#",
                  80 + i, "=DIRECTION", triple(cross(corner[next], corner[i])), "#", 90 + i, "=DIRECTION",
                  triple(corner[i]));
    }
    f.replace(f.find("(#20,#21,#22)"), 13, "(#22,#21,#20)");
    const Model m = must(read_step(flat_file(f)));
    ASSERT_EQ(m.faces.size(), 1u) << (m.refused.empty() ? "" : m.refused[0].message);
    EXPECT_NEAR(area_of(m, 1e-4), 2 * kPi, 1e-3);
    EXPECT_EQ(summary(m).degenerate_edges, 0);
}

// A lens between the parabolas y = +-x (1 - x), whose other two sides are both the corner at the origin.
TEST(StepLoops, two_sides_that_are_one_point_are_both_in_the_loop) {
    const Model m = must(read_step(flat_file(
        "#8=SHAPE_REPRESENTATION('',(#10),#1);\n#10=SHELL_BASED_SURFACE_MODEL('',(#11));\n"
        "#11=OPEN_SHELL('',(#12));\n#12=ADVANCED_FACE('',(#13),#9,.T.);\n#13=FACE_BOUND('',#14,.T.);\n"
        "#14=EDGE_LOOP('',(#15,#16));\n#15=ORIENTED_EDGE('',*,*,#20,.F.);\n"
        "#16=ORIENTED_EDGE('',*,*,#21,.T.);\n#20=EDGE_CURVE('',#30,#31,#40,.T.);\n"
        "#21=EDGE_CURVE('',#30,#31,#41,.T.);\n#30=VERTEX_POINT('',#6);\n#31=VERTEX_POINT('',#53);\n"
        "#40=BEZIER_CURVE('',2,(#6,#51,#53),.UNSPECIFIED.,.F.,.F.);\n"
        "#41=BEZIER_CURVE('',2,(#6,#52,#53),.UNSPECIFIED.,.F.,.F.);\n#50=CARTESIAN_POINT('',(0.25,0.,0.));\n"
        "#51=CARTESIAN_POINT('',(0.5,0.5,0.));\n#52=CARTESIAN_POINT('',(0.5,-0.5,0.));\n"
        "#53=CARTESIAN_POINT('',(1.,0.,0.));\n"
        "#9=BEZIER_SURFACE('',2,2,((#6,#6,#6),(#6,#50,#52),(#6,#51,#53)),.UNSPECIFIED.,.F.,.F.,.F.);\n")));
    ASSERT_EQ(m.faces.size(), 1u) << (m.refused.empty() ? "" : m.refused[0].message);
    EXPECT_EQ(summary(m).degenerate_edges, 2);
    EXPECT_NEAR(area_of(m, 1e-5), 1.0 / 3, 1e-4);
}

// A quarter of a sphere of radius 9 as a rational spline with numbers of ten digits; two edges begin at its
// pole.
TEST(StepLoops, edges_that_begin_at_the_pole_of_a_spline_keep_to_their_meridians) {
    const Model m = must(
        read_step(must(read_file(text(FREIFORM_SOURCE_DIR, "/tests/data/step/quarter_dome.stp"), 1 << 20))));
    ASSERT_EQ(m.faces.size(), 1u) << m.refused[0].message;
    EXPECT_NEAR(area_of(m, 1e-3), 81 * std::numbers::pi, 0.1);
    for (const Edge& e : m.edges) EXPECT_LT(e.tolerance, 1e-7);
}

// Files whose faces were refused once: edges at poles, over them and at folds, segments that run backwards,
// seams across keyseats, edges of half a nanometre.
// One face each, of known area: two lines to the apex of a cone whose vertex lies beside it, within the
// tolerance; spheres that circles bound which pass a pole within 0.084 and 0.0055 of the radius; a closed
// spline torus with a hole over one of its seams; a sphere with holes that no meridian passes between; a
// circle that is turned about its diameter, which an edge passes at a pole.
TEST(StepLoops, faces_beside_poles_and_over_seams_have_their_area) {
    const std::pair<std::string_view, double> files[] = {
        {"vertex_beside_apex", 19.9339163356},     {"circle_beside_pole", 97264.3461265},
        {"circle_near_pole", 23.6996022194},       {"hole_over_seams", 22.6667767662},
        {"holes_across_meridians", 0.79836562745}, {"turned_circle_with_hole", 3.7332649361},
        {"spline_sphere_cap", 278.38231949067},    {"spline_sphere_lune", 0.058070326256},
        {"spline_sphere_ring", 1.2853364591715}};
    for (const auto& [name, area] : files) {
        const Model m = must(read_step(
            must(read_file(text(FREIFORM_SOURCE_DIR, "/tests/data/step/", name, ".stp"), 1 << 20))));
        ASSERT_EQ(m.faces.size(), 1u) << name << ": " << m.refused[0].message;
        EXPECT_NEAR(area_of(m, 1e-4 * std::sqrt(area)), area, 1e-3 * area) << name;
        for (const Approximation& a : m.approximations) EXPECT_LT(*a.bound, 1e-4 * std::sqrt(area)) << name;
    }
}

TEST(StepLoops, faces_of_real_files_are_read_and_can_be_meshed) {
    for (const char* name :
         {"step/bug24595_281390.stp", "step/plate_mode_samples_creo.stp", "step/t4mec.stp",
          "step/trj10_b2-oc-214.stp", "step_micro/ap203_shared_periodic_boundary_split.stp",
          "step_micro/ap214_degenerate_torus_endpoint.stp", "step_micro/ap214_periodic_face_branch.stp",
          "step_micro/ap214_two_side_singular_corner.stp"}) {
        FF_CORPUS_OR_SKIP(path, name);
        const Model m = must(read_step(must(read_file(path.string(), 1 << 26))));
        for (const Refusal& r : m.refused) EXPECT_EQ(r.where, "file") << name << r.message;
        const auto t = must(tessellate(m, {.tolerance = 1e-3 * summary(m).box.diagonal()}));
        EXPECT_TRUE(t.refused.empty()) << name << ": " << t.refused[0].reason.message;
        if (summary(m).open_edges == 0) EXPECT_EQ(t.topology.open_edges, 0) << name;
    }
}

}  // namespace
}  // namespace freiform::test
