// Seams: of surfaces that do not quite close, in any order, around holes, and those that are none.
#include <freiform/io/file.hpp>
#include <freiform/io/step_read.hpp>
#include <freiform/model/tessellate.hpp>

#include <algorithm>
#include <filesystem>
#include <numbers>
#include <support/random.hpp>
#include <support/refusal.hpp>
#include <support/step_measures.hpp>
#include <support/step_polygons.hpp>

namespace freiform::test {
namespace {

// A square tube of planes, as one spline whose last side ends `open` beside the first; rational, with weights
// that have lost digits, if `uneven`.
std::string open_tube(double open, bool uneven) {
    std::string s = text(
        "#8=SHAPE_REPRESENTATION('',(#10),#1);\n#10=SHELL_BASED_SURFACE_MODEL('',(#11));\n"
        "#11=OPEN_SHELL('',(#12));\n#12=ADVANCED_FACE('',(#13),#9,.T.);\n"
        "#13=FACE_OUTER_BOUND('',#14,.T.);\n#14=EDGE_LOOP('',(#500,#501,#502,#503));\n"
        "#20=DIRECTION('',(0.,0.,1.));\n#21=VECTOR('',#20,1.);\n");
    const double x[] = {0, 2, 2, 0, 0}, y[] = {0, 0, 2, 2, open};
    for (int k = 0; k < 2; ++k)
        for (int i = 0; i < 5; ++i)
            s += text("#", 100 + 10 * k + i, "=CARTESIAN_POINT('',(", x[i], ",", y[i], ",", k, ".));\n");
    const char* around = "(2,1,1,1,2),";
    std::string points, weights;
    for (int i = 0; i < 5; ++i) {
        points += text(i ? "," : "", "(#", 100 + i, ",#", 110 + i, ")");
        weights += text(i ? "," : "", "(1.,", uneven && i == 4 ? "1.000000001)" : "1.)");
    }
    s += uneven ? text("#9=(BOUNDED_SURFACE()B_SPLINE_SURFACE(1,1,(", points,
                       "),.UNSPECIFIED.,.F.,.F.,.F.)B_SPLINE_SURFACE_WITH_KNOTS(", around,
                       "(2,2),(0.,1.,2.,3.,4.),(0.,1.),.UNSPECIFIED.)GEOMETRIC_REPRESENTATION_ITEM()"
                       "RATIONAL_B_SPLINE_SURFACE((",
                       weights, "))REPRESENTATION_ITEM('')SURFACE());\n")
                : text("#9=B_SPLINE_SURFACE_WITH_KNOTS('',1,1,(", points, "),.UNSPECIFIED.,.F.,.F.,.F.,",
                       around, "(2,2),(0.,1.,2.,3.,4.),(0.,1.),.UNSPECIFIED.);\n");
    for (int k = 0; k < 2; ++k)
        s += text("#", 200 + k, "=VERTEX_POINT('',#", 100 + 10 * k, ");\n#", 300 + k,
                  "=B_SPLINE_CURVE_WITH_KNOTS('',1,(#", 100 + 10 * k, ",#", 101 + 10 * k, ",#", 102 + 10 * k,
                  ",#", 103 + 10 * k, ",#", 104 + 10 * k, "),.UNSPECIFIED.,.F.,.F.,", around,
                  "(0.,1.,2.,3.,4.),.UNSPECIFIED.);\n#", 400 + k, "=EDGE_CURVE('',#", 200 + k, ",#", 200 + k,
                  ",#", 300 + k, ",.T.);\n");
    s += "#302=LINE('',#100,#21);\n#402=EDGE_CURVE('',#200,#201,#302,.T.);\n"
         "#500=ORIENTED_EDGE('',*,*,#400,.T.);\n#501=ORIENTED_EDGE('',*,*,#402,.T.);\n"
         "#502=ORIENTED_EDGE('',*,*,#401,.F.);\n#503=ORIENTED_EDGE('',*,*,#402,.F.);\n";
    return flat_file(s);
}

TEST(StepSeams, seams_of_splines_that_do_not_quite_close_are_seams) {
    for (const bool uneven : {false, true})
        for (const double open : {0.0, 5e-5, 1e-3}) {
            SCOPED_TRACE(text(open, uneven));
            const Model m = must(read_step(open_tube(open, uneven)));
            ASSERT_EQ(m.faces.size(), 1u) << m.refused[0].message;
            EXPECT_TRUE(m.refused.empty()) << m.refused[0].message;
            EXPECT_EQ(summary(m).seams, 1);
            EXPECT_NEAR(area_of(m, 1e-3), 8, 2 * open + 1e-9);
            EXPECT_EQ(
                times_told(m, "#12 ADVANCED_FACE: its surface does not close at its seam, by up to 0.001"),
                open > 1e-4);
            const auto t = must(tessellate(m, {.tolerance = 1e-3}));
            EXPECT_EQ(t.topology.open_edges, 8);
            EXPECT_LE(t.boundary_gap, 1.001 * open + 1e-12);
        }
    // Sides that are farther apart than that are two sides.
    const Model wide = must(read_step(open_tube(0.05, false)));
    EXPECT_EQ(must(tessellate(wide, {.tolerance = 1e-3})).refused.size(), 1u);
}

// Slopes at the end of an edge that lies on the seam are those of the side that the edge is on: with those of
// the other one it would be followed along the crease.
TEST(StepSeams, edges_that_begin_at_a_creased_seam_leave_it_on_their_side) {
    const std::filesystem::path path =
        std::filesystem::path(FREIFORM_SOURCE_DIR) / "tests/data/step/creased_seam.stp";
    const Model m = must(read_step(must(read_file(path.string(), 1 << 20))));
    ASSERT_EQ(m.faces.size(), 1u) << m.refused[0].message;
    EXPECT_TRUE(m.refused.empty()) << m.refused[0].message;
    const auto t = must(tessellate(m, {.tolerance = 1e-3}));
    EXPECT_LE(t.boundary_gap, 1e-7);
    // Integrated by scipy; without the window across the seam 11.3886.
    EXPECT_NEAR(area_of(m, 1e-3), 11.263, 0.01);
}

// A tube of radius 1 without a seam, from z = 0 to a rim that is 2 high on one side and `low` on the other; a
// step of the rim is above the vertex of the lower circle. The loop of the rim begins with its edge `first`.
std::string stepped_tube(double low, int first) {
    std::string s =
        "#9=CYLINDRICAL_SURFACE('',#5,1.);\n#8=SHAPE_REPRESENTATION('',(#10),#1);\n"
        "#10=SHELL_BASED_SURFACE_MODEL('',(#11));\n#11=OPEN_SHELL('',(#12));\n"
        "#12=ADVANCED_FACE('',(#13,#15),#9,.T.);\n#13=FACE_BOUND('',#14,.T.);\n#14=EDGE_LOOP('',(#500));\n"
        "#15=FACE_BOUND('',#16,.T.);\n#20=DIRECTION('',(0.,0.,1.));\n#21=VECTOR('',#20,1.);\n";
    const double x[] = {1, 1, -1, -1, 1}, z[] = {0, 2, 2, low, low};
    for (int i = 0; i < 5; ++i)
        s += text("#", 100 + i, "=CARTESIAN_POINT('',(", x[i], ",0.,", z[i], "));\n#", 200 + i,
                  "=VERTEX_POINT('',#", 100 + i, ");\n#", 600 + i, "=CARTESIAN_POINT('',(0.,0.,", z[i],
                  "));\n#", 700 + i, "=AXIS2_PLACEMENT_3D('',#", 600 + i, ",$,$);\n");
    const struct {
        int from, to;
        const char* along;  // the loop
    } edges[] = {{0, 0, ".T."}, {1, 2, ".F."}, {3, 2, ".T."}, {3, 4, ".F."}, {4, 1, ".F."}};
    for (int i = 0; i < 5; ++i) {
        const auto [from, to, along] = edges[i];
        s += i == 2 || i == 4 ? text("#", 300 + i, "=LINE('',#", 100 + from, ",#21);\n")
                              : text("#", 300 + i, "=CIRCLE('',#", 700 + from, ",1.);\n");
        s += text("#", 400 + i, "=EDGE_CURVE('',#", 200 + from, ",#", 200 + to, ",#", 300 + i, ",.T.);\n#",
                  500 + i, "=ORIENTED_EDGE('',*,*,#", 400 + i, ",", along, ");\n");
    }
    s += "#16=EDGE_LOOP('',(";
    for (int i = 0; i < 4; ++i) s += text(i > 0 ? ",#" : "#", 501 + (first + 3 * i) % 4);
    return flat_file(s += "));\n");
}

TEST(StepSeams, seams_end_at_the_first_corner_above_where_they_begin) {
    for (const double low : {0.5, 1.5, 3.0})
        for (int first = 0; first < 4; ++first) {
            const Model m = must(read_step(stepped_tube(low, first)));
            ASSERT_EQ(m.faces.size(), 1u) << m.refused[0].message;
            EXPECT_EQ(summary(m).seams, 1);
            EXPECT_NEAR(area_of(m, 1e-3), std::numbers::pi * (2 + low), 0.01) << low << " " << first;
        }
}

struct Window {
    double half, from, to;  // u from -half to half, v
};

// A torus of radii 5 and 1 with windows across its seam u = 0, and one loop around the face. `uses` names the
// parts of the loop: the seam p is v = 0, the seams s0, s1, .. are u = 0 below, between and above the
// windows, -p and -s0 run back; l0 and r0 are the left and the right half of a window, clockwise.
std::string windowed_torus(const std::vector<Window>& windows, std::initializer_list<std::string_view> uses) {
    std::vector<Vec<2>> corners{{{0, 0}}};
    struct Side {
        int from, to;
        bool meridian, back;
    };
    std::vector<Side> sides{{0, 0, false, false}};
    std::vector<std::pair<std::string, std::vector<int>>> parts{{"p", {0}}};
    int below = 0;
    for (std::size_t w = 0; w <= windows.size(); ++w) {
        const int first = int(corners.size());
        parts.push_back({text("s", w), {int(sides.size())}});
        sides.push_back({below, w < windows.size() ? first : 0, true, false});
        if (w == windows.size()) break;
        const auto [half, from, to] = windows[w];
        for (const Vec<2>& c :
             {Vec<2>{{0, from}}, {{-half, from}}, {{-half, to}}, {{0, to}}, {{half, to}}, {{half, from}}})
            corners.push_back(c);
        for (const char* half_of : {"l", "r"}) {
            parts.push_back({text(half_of, w), {}});
            for (int k = 0; k < 3; ++k) {
                const int at = k + (*half_of == 'r' ? 3 : 0);
                parts.back().second.push_back(int(sides.size()));
                sides.push_back({first + at, first + (at + 1) % 6, k == 1, at == 0 || at >= 4});
            }
        }
        below = first + 3;
    }
    std::string s =
        "#9=TOROIDAL_SURFACE('',#5,5.,1.);\n#8=SHAPE_REPRESENTATION('',(#10),#1);\n"
        "#10=SHELL_BASED_SURFACE_MODEL('',(#11));\n#11=OPEN_SHELL('',(#12));\n"
        "#12=ADVANCED_FACE('',(#13),#9,.T.);\n#13=FACE_BOUND('',#14,.T.);\n"
        "#20=DIRECTION('',(0.,0.,1.));\n#14=EDGE_LOOP('',(";
    const char* comma = "#";
    for (std::string_view use : uses) {
        const bool back = use.starts_with('-');
        if (back) use.remove_prefix(1);
        for (const int i : std::ranges::find(parts, use, [](const auto& part) { return part.first; })->second)
            s += text(comma, 500 + 2 * i + back), comma = ",#";
    }
    s += "));\n";
    for (std::size_t i = 0; i < corners.size(); ++i) {
        const auto [u, v] = std::pair(corners[i][0], corners[i][1]);
        s += text("#", 100 + i, "=CARTESIAN_POINT('',(", (5 + std::cos(v)) * std::cos(u), ",",
                  (5 + std::cos(v)) * std::sin(u), ",", std::sin(v), "));\n#", 200 + i, "=VERTEX_POINT('',#",
                  100 + i, ");\n");
    }
    for (std::size_t i = 0; i < sides.size(); ++i) {
        const auto [from, to, meridian, back] = sides[i];
        const double u = corners[std::size_t(from)][0], v = corners[std::size_t(from)][1];
        // Along a meridian v grows with the angle from (cos u, sin u, 0) to z; along a parallel u about z.
        if (meridian)
            s += text("#", 600 + i, "=CARTESIAN_POINT('',(", 5 * std::cos(u), ",", 5 * std::sin(u),
                      ",0.));\n#", 700 + i, "=DIRECTION('',(", std::sin(u), ",", -std::cos(u), ",0.));\n#",
                      800 + i, "=DIRECTION('',(", std::cos(u), ",", std::sin(u), ",0.));\n#", 900 + i,
                      "=AXIS2_PLACEMENT_3D('',#", 600 + i, ",#", 700 + i, ",#", 800 + i, ");\n#", 300 + i,
                      "=CIRCLE('',#", 900 + i, ",1.);\n");
        else
            s += text("#", 600 + i, "=CARTESIAN_POINT('',(0.,0.,", std::sin(v), "));\n#", 900 + i,
                      "=AXIS2_PLACEMENT_3D('',#", 600 + i, ",#20,$);\n#", 300 + i, "=CIRCLE('',#", 900 + i,
                      ",", 5 + std::cos(v), ");\n");
        s += text("#", 400 + i, "=EDGE_CURVE('',#", 200 + from, ",#", 200 + to, ",#", 300 + i,
                  back ? ",.F.);\n#" : ",.T.);\n#", 500 + 2 * i, "=ORIENTED_EDGE('',*,*,#", 400 + i,
                  ",.T.);\n#", 501 + 2 * i, "=ORIENTED_EDGE('',*,*,#", 400 + i, ",.F.);\n");
    }
    return flat_file(s);
}

void expect_windows(const std::vector<Window>& windows, std::initializer_list<std::string_view> uses) {
    std::string order;
    for (const std::string_view use : uses) order += text(use, " ");
    SCOPED_TRACE(order);
    double area = 20 * std::numbers::pi * std::numbers::pi;
    for (const Window& w : windows)
        area -= 2 * w.half * (5 * (w.to - w.from) + std::sin(w.to) - std::sin(w.from));
    const Model m = must(read_step(windowed_torus(windows, uses)));
    ASSERT_EQ(m.faces.size(), 1u) << m.refused[0].message;
    EXPECT_TRUE(m.refused.empty()) << m.refused[0].message;
    EXPECT_EQ(summary(m).open_edges, 6 * int(windows.size()));
    EXPECT_EQ(topology(must(tessellate(m, {.tolerance = 1e-3})).mesh).misoriented_edges, 0);
    EXPECT_NEAR(area_of(m, 1e-3), area, 0.1);
}

TEST(StepSeams, seams_of_a_torus_may_follow_each_other_in_any_order_that_their_vertices_allow) {
    const std::vector<Window> one{{0.3, 2, 3}};
    expect_windows(one, {"-s0", "p", "s0", "l0", "s1", "-p", "-s1", "r0"});
    expect_windows(one, {"-s0", "p", "-p", "s0", "l0", "s1", "-s1", "r0"});
    expect_windows(one, {"-s0", "-p", "p", "s0", "l0", "s1", "-s1", "r0"});
    expect_windows(one, {"-s0", "-p", "s0", "l0", "s1", "p", "-s1", "r0"});
    expect_windows(one, {"l0", "s1", "-s1", "r0", "-s0", "p", "-p", "s0"});
    // Windows that are bridged by a seam, and leave no circle around the torus in either direction.
    const std::vector<Window> two{{2.9, 0.5, 2}, {3.1, 2.2, 5.9}};
    expect_windows(two, {"-s0", "p", "s0", "l0", "s1", "l1", "s2", "-p", "-s2", "r1", "-s1", "r0"});
    expect_windows(two, {"-s0", "p", "-p", "s0", "l0", "s1", "l1", "s2", "-s2", "r1", "-s1", "r0"});
    expect_windows(two, {"-s0", "s0", "l0", "s1", "l1", "s2", "p", "-p", "-s2", "r1", "-s1", "r0"});
}

TEST(StepSeams, slits_in_closed_surfaces_enclose_nothing) {
    expect_windows({}, {"p", "s0", "-p", "-s0"});
    expect_windows({}, {"p", "-p", "s0", "-s0"});
    expect_windows({}, {"p", "-p"});
    for (const auto& uses :
         {std::initializer_list<std::string_view>{"s0", "-s0"}, {"-s0", "s0"}, {"p", "-p", "s0", "-s0"}})
        EXPECT_NEAR(area_of(must(read_step(windowed_torus({{0.3, 2, 3}}, uses))), 1e-3),
                    20 * std::numbers::pi * std::numbers::pi, 0.1);
}

// A tube of radius 1 from z = 0 to z = 3 with a window between the angles -half and half, and z from 1 to 2,
// above the vertices of its circles; with a seam through the window, or none.
std::string windowed_tube(double half, bool seam) {
    std::string s =
        "#9=CYLINDRICAL_SURFACE('',#5,1.);\n#8=SHAPE_REPRESENTATION('',(#10),#1);\n"
        "#10=SHELL_BASED_SURFACE_MODEL('',(#11));\n#11=OPEN_SHELL('',(#12));\n"
        "#20=DIRECTION('',(0.,0.,1.));\n#21=VECTOR('',#20,1.);\n#17=FACE_BOUND('',#18,.T.);\n"
        "#18=EDGE_LOOP('',(#505,#504,#513,#512));\n#13=FACE_BOUND('',#14,.T.);\n#15=FACE_BOUND('',#16,.T.);\n"
        "#16=EDGE_LOOP('',(#511));\n";
    s += seam ? "#12=ADVANCED_FACE('',(#13,#17),#9,.T.);\n#14=EDGE_LOOP('',(#500,#506,#511,#516));\n"
              : "#12=ADVANCED_FACE('',(#13,#15,#17),#9,.T.);\n#14=EDGE_LOOP('',(#500));\n";
    const double angle[] = {0, 0, -half, half, half, -half}, z[] = {0, 3, 1, 1, 2, 2};
    for (int i = 0; i < 6; ++i)
        s += text("#", 100 + i, "=CARTESIAN_POINT('',(", std::cos(angle[i]), ",", std::sin(angle[i]), ",",
                  z[i], "));\n#", 200 + i, "=VERTEX_POINT('',#", 100 + i, ");\n#", 600 + i,
                  "=CARTESIAN_POINT('',(0.,0.,", z[i], "));\n#", 700 + i, "=AXIS2_PLACEMENT_3D('',#", 600 + i,
                  ",$,$);\n");
    // Circles, the lower and upper side of the window, its right and left one, the seam.
    const int from[] = {0, 1, 2, 3, 5, 2, 0}, to[] = {0, 1, 3, 4, 4, 5, 1};
    for (int i = 0; i < 7; ++i) {
        s += z[from[i]] != z[to[i]] ? text("#", 300 + i, "=LINE('',#", 100 + from[i], ",#21);\n")
                                    : text("#", 300 + i, "=CIRCLE('',#", 700 + from[i], ",1.);\n");
        s += text("#", 400 + i, "=EDGE_CURVE('',#", 200 + from[i], ",#", 200 + to[i], ",#", 300 + i,
                  ",.T.);\n#", 500 + i, "=ORIENTED_EDGE('',*,*,#", 400 + i, ",.T.);\n#", 510 + i,
                  "=ORIENTED_EDGE('',*,*,#", 400 + i, ",.F.);\n");
    }
    return flat_file(s);
}

// The upper half of a unit sphere with a window between the angles -half and half, and the latitudes 0.3 and
// 0.8, above the only vertex of its rim.
std::string windowed_dome(double half) {
    std::string s =
        "#9=SPHERICAL_SURFACE('',#5,1.);\n#8=SHAPE_REPRESENTATION('',(#10),#1);\n"
        "#10=SHELL_BASED_SURFACE_MODEL('',(#11));\n#11=OPEN_SHELL('',(#12));\n"
        "#12=ADVANCED_FACE('',(#13,#17),#9,.T.);\n#13=FACE_BOUND('',#14,.T.);\n#14=EDGE_LOOP('',(#500));\n"
        "#17=FACE_BOUND('',#18,.T.);\n#18=EDGE_LOOP('',(#504,#513,#512,#501));\n";
    const double u[] = {0, -half, half, half, -half}, v[] = {0, 0.3, 0.3, 0.8, 0.8};
    for (int i = 0; i < 5; ++i) {
        const double x = std::cos(u[i]), y = std::sin(u[i]), z = std::sin(v[i]);
        s += text("#", 100 + i, "=CARTESIAN_POINT('',(", std::cos(v[i]) * x, ",", std::cos(v[i]) * y, ",", z,
                  "));\n#", 200 + i, "=VERTEX_POINT('',#", 100 + i, ");\n#", 600 + i,
                  "=CARTESIAN_POINT('',(0.,0.,", z, "));\n#", 700 + i, "=AXIS2_PLACEMENT_3D('',#", 600 + i,
                  ",$,$);\n#", 800 + i, "=DIRECTION('',(", y, ",", -x, ",0.));\n#", 820 + i,
                  "=DIRECTION('',(", x, ",", y, ",0.));\n#", 840 + i, "=AXIS2_PLACEMENT_3D('',#600,#",
                  800 + i, ",#", 820 + i, ");\n");
    }
    // The rim; of the window the left side, the upper one, the right and the lower one.
    const int from[] = {0, 1, 4, 2, 1}, to[] = {0, 4, 3, 3, 2};
    for (int i = 0; i < 5; ++i) {
        const bool meridian = i % 2 == 1;
        s += text("#", 300 + i, "=CIRCLE('',#", (meridian ? 840 : 700) + from[i], ",",
                  meridian ? 1 : std::cos(v[from[i]]), ");\n#", 400 + i, "=EDGE_CURVE('',#", 200 + from[i],
                  ",#", 200 + to[i], ",#", 300 + i, ",.T.);\n#", 500 + i, "=ORIENTED_EDGE('',*,*,#", 400 + i,
                  ",.T.);\n#", 510 + i, "=ORIENTED_EDGE('',*,*,#", 400 + i, ",.F.);\n");
    }
    return flat_file(s);
}

TEST(StepSeams, seams_to_poles_go_around_holes) {
    for (const double half : {0.3, 1.5, 3.0}) {
        const Model m = must(read_step(windowed_dome(half)));
        ASSERT_EQ(m.faces.size(), 1u) << m.refused[0].message;
        EXPECT_TRUE(m.refused.empty()) << m.refused[0].message;
        EXPECT_EQ(must(tessellate(m, {.tolerance = 0.01})).topology.non_manifold_edges, 0);
        EXPECT_NEAR(area_of(m, 1e-3), 2 * std::numbers::pi - 2 * half * (std::sin(0.8) - std::sin(0.3)), 0.02)
            << half;
    }
}

// A tube whose ends are waves with one vertex each: no straight line between these is on it.
TEST(StepSeams, seams_go_between_waves) {
    constexpr int kPoints = 120;
    std::string s =
        "#9=CYLINDRICAL_SURFACE('',#5,1.);\n#8=SHAPE_REPRESENTATION('',(#10),#1);\n"
        "#10=SHELL_BASED_SURFACE_MODEL('',(#11));\n#11=OPEN_SHELL('',(#12));\n"
        "#12=ADVANCED_FACE('',(#13,#15),#9,.T.);\n#13=FACE_BOUND('',#14,.T.);\n#15=FACE_BOUND('',#16,.T.);\n"
        "#14=EDGE_LOOP('',(#40));\n#16=EDGE_LOOP('',(#41));\n"
        "#40=ORIENTED_EDGE('',*,*,#42,.T.);\n#41=ORIENTED_EDGE('',*,*,#43,.F.);\n";
    for (const int end : {0, 1}) {
        const double from = end == 0 ? 0.0 : 2.5;
        // Where the lower one falls and the upper one rises, so that each is beside the vertex of the other.
        std::string points, knots = "(3,", breaks = "(0.,";
        std::vector<Vec<3>> net;
        for (int i = 0; i <= kPoints; ++i) {
            const double t = 2 * std::numbers::pi * i / kPoints, u = from + t;
            const double slope[] = {-std::sin(u), std::cos(u), 2 * std::cos(2 * t)};
            const Vec<3> p{{std::cos(u), std::sin(u), 2.5 * end + std::sin(2 * t)}};
            const double h = 2 * std::numbers::pi / kPoints / 3;
            const Vec<3> d{{h * slope[0], h * slope[1], h * slope[2]}};
            if (i > 0) net.push_back(p - d);
            if (i == 0 || i == kPoints) net.push_back(p);
            if (i < kPoints) net.push_back(p + d);
            if (i > 0 && i < kPoints) knots += "2,", breaks += text(i, ".,");
        }
        knots = "(4," + knots.substr(3) + "4)", breaks += text(kPoints, ".)");
        const char* comma = "";
        for (std::size_t i = 0; i < net.size(); ++i) {
            const std::size_t id = 1000 + 1000 * std::size_t(end) + i;
            s += text("#", id, "=CARTESIAN_POINT('',(", net[i][0], ",", net[i][1], ",", net[i][2], "));\n");
            points += text(comma, "#", id), comma = ",";
        }
        s +=
            text("#", 44 + end, "=B_SPLINE_CURVE_WITH_KNOTS('',3,(", points, "),.UNSPECIFIED.,.T.,.F.,",
                 knots, ",", breaks, ",.UNSPECIFIED.);\n#", 46 + end, "=VERTEX_POINT('',#", 1000 + 1000 * end,
                 ");\n#", 42 + end, "=EDGE_CURVE('',#", 46 + end, ",#", 46 + end, ",#", 44 + end, ",.T.);\n");
    }
    const Model m = must(read_step(flat_file(s)));
    ASSERT_EQ(m.faces.size(), 1u) << m.refused[0].message;
    EXPECT_TRUE(m.refused.empty()) << m.refused[0].message;
    EXPECT_NEAR(area_of(m, 1e-3), 5 * std::numbers::pi, 0.02);
}

TEST(StepSeams, seams_go_around_holes_that_lie_across_all_their_ways) {
    for (const double half : {0.3, 1.5, 3.0})
        for (const bool seam : {false, true}) {
            const Model m = must(read_step(windowed_tube(half, seam)));
            ASSERT_EQ(m.faces.size(), 1u) << m.refused[0].message;
            EXPECT_EQ(m.faces[0].loops.size(), 2u);
            EXPECT_TRUE(m.refused.empty()) << m.refused[0].message;
            EXPECT_NEAR(area_of(m, 1e-3), 6 * std::numbers::pi - 2 * half, 0.02) << half << seam;
            EXPECT_EQ(must(tessellate(m, {.tolerance = 0.05})).topology.non_manifold_edges, 0);
        }
}

}  // namespace
}  // namespace freiform::test
