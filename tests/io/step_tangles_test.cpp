// Boundaries that run into themselves where edges lie beside the surface, holes that touch what is around
// them, parameter curves whose pieces have bounded derivatives, and every file that was once a finding.
#include "io/step_geometry.hpp"
#include "io/step_trace.hpp"

#include <freiform/io/file.hpp>
#include <freiform/io/step_read.hpp>
#include <freiform/model/tessellate.hpp>

#include <algorithm>
#include <filesystem>
#include <numbers>
#include <support/corpus.hpp>
#include <support/random.hpp>
#include <support/refusal.hpp>
#include <support/solids.hpp>

namespace freiform::test {
namespace {

std::string tangle_file(double tolerance, std::string_view data) {
    return text("ISO-10303-21;\nHEADER;FILE_SCHEMA(('AUTOMOTIVE_DESIGN'));ENDSEC;\nDATA;\n",
                "#1=(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT((#3))"
                "GLOBAL_UNIT_ASSIGNED_CONTEXT((#2))REPRESENTATION_CONTEXT('',''));\n"
                "#2=(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT(.MILLI.,.METRE.));\n"
                "#3=UNCERTAINTY_MEASURE_WITH_UNIT(LENGTH_MEASURE(",
                tolerance,
                "),#2,'','');\n#5=AXIS2_PLACEMENT_3D('',#6,$,$);\n#6=CARTESIAN_POINT('',(0.,0.,0.));\n"
                "#8=SHAPE_REPRESENTATION('',(#10),#1);\n#10=SHELL_BASED_SURFACE_MODEL('',(#11));\n",
                data, "ENDSEC;\nEND-ISO-10303-21;\n");
}

std::string point_at(int i, double x, double y, double z) {
    return text("#", i, "=CARTESIAN_POINT('',(", x, ",", y, ",", z, "));\n");
}

// Straight edges around a polygon in z = 0: the loop #`loop`; vertices #loop+1.., edges behind them.
std::string straight_loop(int loop, const std::vector<Vec<2>>& corners) {
    const int n = int(corners.size());
    std::string s, uses;
    for (int i = 0; i < n; ++i) {
        const Vec<2> a = corners[std::size_t(i)], b = corners[std::size_t((i + 1) % n)];
        const int v = loop + 1 + i, at = loop + 20 + 8 * i;
        s += text(point_at(at, a[0], a[1], 0), "#", v, "=VERTEX_POINT('',#", at, ");\n#", at + 1,
                  "=LINE('',#", at, ",#", at + 2, ");\n#", at + 2, "=VECTOR('',#", at + 3, ",1.);\n#", at + 3,
                  "=DIRECTION('',(", b[0] - a[0], ",", b[1] - a[1], ",0.));\n#", at + 4, "=EDGE_CURVE('',#",
                  v, ",#", loop + 1 + (i + 1) % n, ",#", at + 1, ",.T.);\n#", at + 5,
                  "=ORIENTED_EDGE('',*,*,#", at + 4, ",.T.);\n");
        uses += text(i > 0 ? "," : "", "#", at + 5);
    }
    return text(s, "#", loop, "=EDGE_LOOP('',(", uses, "));\n");
}

double meshed_area(const Model& m, double tolerance) {
    const auto t = must(tessellate(m, {.tolerance = tolerance}));
    EXPECT_TRUE(t.refused.empty()) << t.refused[0].reason.message;
    double sum = 0;
    for (const auto& f : t.mesh.triangles) {
        const auto at = [&](int k) {
            return t.mesh.points[std::size_t(t.mesh.vertices[std::size_t(k)].point)];
        };
        sum += norm(cross(at(f[1]) - at(f[0]), at(f[2]) - at(f[0]))) / 2;
    }
    return sum;
}

std::ptrdiff_t times_told(const Model& m, std::string_view what) {
    return std::count_if(m.approximations.begin(), m.approximations.end(),
                         [&](const Approximation& a) { return a.what.find(what) != std::string::npos; });
}

// A triangle on the unit square as a spline; its corners at x = `x` lie beside the square. The nearest points
// of two of its edges share a piece of the side x = 0.
std::string beside_a_side(double x, double tolerance) {
    return tangle_file(tolerance,
                       text("#11=OPEN_SHELL('',(#12));\n#12=ADVANCED_FACE('',(#13),#20,.T.);\n#13=FACE_OUTER_"
                            "BOUND('',#100,.T.);\n",
                            "#20=B_SPLINE_SURFACE_WITH_KNOTS('',1,1,((#21,#22),(#23,#24)),.UNSPECIFIED.,.F.,."
                            "F.,.F.,(2,2),(2,2),"
                            "(0.,1.),(0.,1.),.UNSPECIFIED.);\n",
                            point_at(21, 0, 0, 0), point_at(22, 0, 1, 0), point_at(23, 1, 0, 0),
                            point_at(24, 1, 1, 0), straight_loop(100, {{{x, 0.1}}, {{1, 0.9}}, {{x, 1}}})));
}

TEST(StepTangles,
     edges_beside_the_end_of_a_surface_that_cover_each_other_are_followed_less_closely_and_told) {
    const Model m = must(read_step(beside_a_side(-0.001, 0.01)));
    ASSERT_EQ(m.faces.size(), 1u) << (m.refused.empty() ? "" : m.refused[0].message);
    EXPECT_EQ(times_told(m, "runs into itself where edges lie beside the surface"), 1);
    EXPECT_NEAR(meshed_area(m, 1e-3), 0.45, 2e-3);
    for (const Edge& e : m.edges) EXPECT_LE(e.tolerance, 0.01) << "no worse than the file says";
    // On the square nothing is changed.
    const Model on = must(read_step(beside_a_side(0, 0.01)));
    EXPECT_EQ(times_told(on, "runs into itself"), 0);
    EXPECT_NEAR(meshed_area(on, 1e-3), 0.45, 1e-12);
}

// The unit square as a spline; its side from (0, 0) to (1, 0) is a curve that first runs past the corner and
// back, by `past` at its beginning.
std::string past_a_corner(double past) {
    const auto edge = [](int i, int from, int to, int curve) {
        return text("#", 100 + i, "=ORIENTED_EDGE('',*,*,#", 110 + i, ",.T.);\n#", 110 + i,
                    "=EDGE_CURVE('',#", 120 + from, ",#", 120 + to, ",#", curve, ",.T.);\n#", 120 + i,
                    "=VERTEX_POINT('',#", 21 + i, ");\n#", 130 + i, "=POLYLINE('',(#", 21 + from, ",#",
                    21 + to, "));\n");
    };
    return tangle_file(
        1e-4, text("#11=OPEN_SHELL('',(#12));\n#12=ADVANCED_FACE('',(#13),#20,.T.);\n",
                   "#13=FACE_OUTER_BOUND('',#14,.T.);\n#14=EDGE_LOOP('',(#100,#101,#102,#103));\n",
                   "#20=B_SPLINE_SURFACE_WITH_KNOTS('',1,1,((#21,#24),(#22,#23)),.UNSPECIFIED.,.F.,.F.,.F.,"
                   "(2,2),(2,2),(0.,1.),(0.,1.),.UNSPECIFIED.);\n",
                   point_at(21, 0, 0, 0), point_at(22, 1, 0, 0), point_at(23, 1, 1, 0), point_at(24, 0, 1, 0),
                   edge(0, 0, 1, 30), edge(1, 1, 2, 131), edge(2, 2, 3, 132), edge(3, 3, 0, 133),
                   "#30=B_SPLINE_CURVE_WITH_KNOTS('',3,(#21,#31,#32,#22),.UNSPECIFIED.,.F.,.F.,(4,4),(0.,1.),"
                   ".UNSPECIFIED.);\n",
                   point_at(31, -past, -past / 50, 0), point_at(32, 2.0 / 3, 0, 0),
                   // Far away, so that the tolerance can pass for one.
                   "#40=VERTEX_POINT('',#41);\n", point_at(41, 100, 0, 0)));
}

TEST(StepTangles, edges_that_run_past_a_corner_of_the_surface_and_back_are_followed_less_closely_and_told) {
    for (const double past : {0.015, 0.02}) {
        const Model m = must(read_step(past_a_corner(past)));
        ASSERT_EQ(m.faces.size(), 1u) << (m.refused.empty() ? "" : m.refused[0].message);
        EXPECT_EQ(times_told(m, "#12 ADVANCED_FACE: its boundary runs into itself"), 1);
        for (const double tolerance : {1e-1, 1e-2, 1e-3, 1e-5})
            EXPECT_NEAR(meshed_area(m, tolerance), 1, 2e-3);
        for (const Edge& e : m.edges) EXPECT_LE(e.tolerance, 2 * 16e-4) << "which is told, with a bound";
        for (const Approximation& a : m.approximations) EXPECT_TRUE(a.bound) << a.what;
    }
    // One that does not turn back is followed as it is.
    EXPECT_EQ(times_told(must(read_step(past_a_corner(-0.02))), "runs into itself"), 0);
}

// A disc of radius 2 with a wall above its rim, and a square hole with a corner at (x, 2).
std::string touched_disc(double x) {
    return tangle_file(
        1e-4,
        text("#11=OPEN_SHELL('',(#12,#40));\n#12=ADVANCED_FACE('',(#13,#14),#15,.T.);\n#15=PLANE('',#5);\n",
             "#13=FACE_BOUND('',#16,.T.);\n#14=FACE_BOUND('',#100,.T.);\n#16=EDGE_LOOP('',(#17));\n",
             "#17=ORIENTED_EDGE('',*,*,#18,.T.);\n#18=EDGE_CURVE('',#19,#19,#20,.T.);\n#19=VERTEX_POINT('',#"
             "21);\n",
             point_at(21, 2, 0, 0), "#20=CIRCLE('',#5,2.);\n",
             straight_loop(100, {{{x, 2}}, {{1, 1}}, {{0, 0}}, {{-1, 1}}}),
             "#40=ADVANCED_FACE('',(#41,#42),#43,.T.);\n#43=CYLINDRICAL_SURFACE('',#5,2.);\n",
             "#41=FACE_BOUND('',#44,.T.);\n#42=FACE_BOUND('',#45,.T.);\n#44=EDGE_LOOP('',(#46));\n",
             "#46=ORIENTED_EDGE('',*,*,#18,.T.);\n#45=EDGE_LOOP('',(#47));\n#47=ORIENTED_EDGE('',*,*,#48,.F.)"
             ";\n",
             "#48=EDGE_CURVE('',#49,#49,#50,.T.);\n#49=VERTEX_POINT('',#51);\n", point_at(51, 2, 0, 3),
             "#50=CIRCLE('',#52,2.);\n#52=AXIS2_PLACEMENT_3D('',#53,$,$);\n", point_at(53, 0, 0, 3)));
}

TEST(StepTangles, an_edge_that_a_vertex_of_another_loop_touches_is_cut_there_in_all_its_faces_and_told) {
    const Model m = must(read_step(touched_disc(0)));
    ASSERT_EQ(m.faces.size(), 2u);
    EXPECT_EQ(times_told(m, "one of 2 parts of an edge that another loop of its face touches"), 1);
    const ModelSummary s = summary(m);
    EXPECT_EQ(s.edges, 2 + 4 + 1 + 1) << "two parts of the rim, the hole, the upper rim, a seam";
    EXPECT_EQ(s.open_edges, 5) << "the hole and the upper rim";
    EXPECT_NEAR(meshed_area(m, 1e-5), 4 * std::numbers::pi - 2 + 12 * std::numbers::pi, 1e-3);
    // Where the hole keeps away there is nothing to cut.
    const Model apart = must(read_step(touched_disc(-0.3)));
    EXPECT_EQ(summary(apart).edges, 1 + 4 + 1 + 1);
}

// A piece of a cylinder whose upper edge is a spline with a knot beside the place where its parameter curve
// begins to be made.
TEST(StepTangles, parameter_curves_have_no_piece_as_short_as_rounding) {
    constexpr double kLength = 0.0211161248213826;
    for (const int ulps : {0, 1, -1, 2, -3}) {
        double knot = 0.46875 * kLength;
        for (int i = 0; i < std::abs(ulps); ++i) knot = std::nextafter(knot, ulps > 0 ? 1.0 : 0.0);
        std::string s =
            "#11=OPEN_SHELL('',(#12));\n#12=ADVANCED_FACE('',(#13),#14,.T.);\n#13=FACE_OUTER_BOUND('',#15,.T."
            ");\n"
            "#14=CYLINDRICAL_SURFACE('',#5,2.);\n#15=EDGE_LOOP('',(#16,#17,#18,#19));\n"
            "#16=ORIENTED_EDGE('',*,*,#20,.T.);\n#17=ORIENTED_EDGE('',*,*,#21,.T.);\n"
            "#18=ORIENTED_EDGE('',*,*,#22,.T.);\n#19=ORIENTED_EDGE('',*,*,#23,.F.);\n"
            "#20=EDGE_CURVE('',#30,#31,#40,.T.);\n#21=EDGE_CURVE('',#31,#32,#41,.T.);\n"
            "#22=EDGE_CURVE('',#32,#33,#42,.T.);\n#23=EDGE_CURVE('',#30,#33,#43,.T.);\n"
            "#30=VERTEX_POINT('',#50);\n#31=VERTEX_POINT('',#51);\n#32=VERTEX_POINT('',#52);\n"
            "#33=VERTEX_POINT('',#53);\n#40=CIRCLE('',#5,2.);\n#41=LINE('',#51,#44);\n#43=LINE('',#50,#44);\n"
            "#44=VECTOR('',#45,1.);\n#45=DIRECTION('',(0.,0.,1.));\n";
        s += text(point_at(50, 2, 0, 0), point_at(51, 0, 2, 0), point_at(52, 0, 2, 1), point_at(53, 2, 0, 1));
        s += text(
            point_at(60, 0.5, 2.05, 1.1), point_at(61, 1.2, 1.7, 1.3), point_at(62, 1.9, 0.8, 1.1),
            "#42=B_SPLINE_CURVE_WITH_KNOTS('',3,(#52,#60,#61,#62,#53),.UNSPECIFIED.,.F.,.F.,(4,1,4),(0.,",
            knot, ",", kLength, "),.UNSPECIFIED.);\n");
        const Model m = must(read_step(tangle_file(1e-3, s)));
        ASSERT_EQ(m.faces.size(), 1u) << (m.refused.empty() ? "" : m.refused[0].message);
        int splines = 0;
        for (const Coedge& c : m.faces[0].loops[0].coedges) {
            const auto* curve = std::get_if<Curve<Vec<2>>>(&c.curve);
            if (curve == nullptr) continue;
            ++splines;
            const auto breaks = curve->basis().breaks();
            for (std::size_t i = 0; i + 1 < breaks.size(); ++i)
                EXPECT_GT(breaks[i + 1] - breaks[i], 1e-8 * kLength) << ulps;
        }
        EXPECT_EQ(splines, 1);
        EXPECT_LT(summary(m).box.diagonal(), 10) << ulps;
    }
}

// Files with faces that were refused once: fillets that end beside their surface, a hole that touches its
// rim, edges that wander near a pole; and one whose box had no end.
TEST(StepTangles, faces_of_real_files_whose_boundaries_ran_into_themselves_are_meshed) {
    for (const char* name : {"step/bug27693_cornetta-step.stp", "step/ec_turbine-A.stp",
                             "step/bug28414_bug_toroidal_surface.stp", "step/trj7_b1-ec-214.stp"}) {
        FF_CORPUS_OR_SKIP(path, name);
        const Model m = must(read_step(must(read_file(path.string(), 1 << 26))));
        EXPECT_TRUE(m.refused.empty()) << name << m.refused[0].message;
        const double size = summary(m).box.diagonal();
        EXPECT_LT(size, 1000) << name;
        const auto t = must(tessellate(m, {.tolerance = 1e-3 * size}));
        for (const auto& r : t.refused) ADD_FAILURE() << name << ": " << r.face << ": " << r.reason.message;
        if (summary(m).open_edges == 0) EXPECT_EQ(t.topology.open_edges, 0) << name;
    }
}

// Edges that lie on their surface where it folds, so that the nearest point from a place before leads to
// another part of it, and vertices on both sides of where a closed spline begins.
TEST(StepFindings, edges_on_folds_and_past_the_ends_of_closed_splines_are_followed) {
    for (const char* name :
         {"folded_face.stp", "beyond_the_seam.stp", "folded_profile.stp", "flat_extrusion.stp"}) {
        SCOPED_TRACE(name);
        const auto path = std::filesystem::path(FREIFORM_SOURCE_DIR) / "tests/data/step" / name;
        const Model m = must(read_step(must(read_file(path.string(), 1 << 20))));
        ASSERT_EQ(m.faces.size(), 1u);
        EXPECT_TRUE(m.refused.empty());
        for (const Edge& e : m.edges) EXPECT_LE(e.tolerance, 1e-6);
        const auto t = must(tessellate(m, {.tolerance = 1e-3 * summary(m).box.diagonal()}));
        EXPECT_TRUE(t.refused.empty());
        EXPECT_LE(t.boundary_gap, 1e-6);
    }
}

// A closed surface may be cut along both seams, by a loop that runs the wrong way: its holes are inside all
// the same.
TEST(StepFindings, holes_lie_inside_a_boundary_that_goes_around_all_of_a_surface) {
    const auto path = std::filesystem::path(FREIFORM_SOURCE_DIR) / "tests/data/step/torus_with_holes.stp";
    const Model m = must(read_step(must(read_file(path.string(), 1 << 20))));
    ASSERT_EQ(m.faces.size(), 1u);
    ASSERT_EQ(m.faces[0].loops.size(), 3u);
    for (const Loop& l : m.faces[0].loops)
        for (const Coedge& c : l.coedges) {
            const Interval range = m.edges[std::size_t(c.edge)].range;
            for (int i = 0; i <= 16; ++i) {
                const Vec<2> uv = jet<0>(c.curve, range.lo + range.length() * i / 16).value();
                for (int d = 0; d < 2; ++d) {
                    EXPECT_GE(uv[d], -1e-9);
                    EXPECT_LE(uv[d], kTwoPi + 1e-9);
                }
            }
        }
}

// What parabolas and hyperbolas make shrinks to a point where they meet the axis, though they go on beyond.
TEST(StepFindings, revolutions_of_open_conics_end_where_they_meet_the_axis) {
    struct Solid {
        const char* name;
        double volume, area;
    };
    for (const Solid& x :
         {Solid{"paraboloid.stp", 1118.766, 613.384}, Solid{"hyperboloid.stp", 46.03278, 104.6634}}) {
        SCOPED_TRACE(x.name);
        const auto path = std::filesystem::path(FREIFORM_SOURCE_DIR) / "tests/data/step" / x.name;
        const Model m = must(read_step(must(read_file(path.string(), 1 << 20))));
        EXPECT_TRUE(m.refused.empty());
        for (const Edge& e : m.edges) EXPECT_LE(e.tolerance, 1e-5);
        const double tolerance = 1e-3 * summary(m).box.diagonal();
        const auto t = must(tessellate(m, {.tolerance = tolerance}));
        EXPECT_TRUE(t.refused.empty());
        EXPECT_EQ(t.topology.open_edges, 0);
        EXPECT_LE(t.boundary_gap, 1e-5);
        EXPECT_NEAR(signed_volume(t.mesh), x.volume, x.area * tolerance);
    }
}

// Of a curve that runs beside itself the parameter of a point is that of the turn that it is on.
TEST(StepFindings, points_of_a_curve_that_nearly_meets_itself_have_their_own_parameter) {
    std::vector<Vec<3>> points;
    for (int i = 0; i < 60; ++i) {
        const double turn = 2.2 * kTwoPi * i / 59, r = 1 + 3e-3 * turn / kTwoPi;
        points.push_back({{r * std::cos(turn), r * std::sin(turn), 0}});
    }
    const auto spiral =
        must(Curve<Vec<3>>::make({must(BSplineBasis::clamped_uniform(3, 60))}, Net<1, Vec<3>>({60}, points)));
    const Interval on = spiral.domain()[0];
    for (int i = 0; i <= 1000; ++i) {
        const double t = on.lo + on.length() * i / 1000;
        double off = 1;
        EXPECT_NEAR(step::parameter_of(CurveGeometry<3>(spiral), spiral(t), off), t, 1e-6) << i;
        EXPECT_LE(off, 1e-9);
    }
}

// Each was once read wrongly or not in time. What is in it must be a model that can be meshed, or a refusal.
TEST(StepFindings, every_file_that_was_one_is_read_or_refused_and_meshed) {
    int files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(std::filesystem::path(FREIFORM_SOURCE_DIR) /
                                                                 "tests/data/step")) {
        SCOPED_TRACE(entry.path().filename().string());
        ++files;
        const auto m =
            read_step(must(read_file(entry.path().string(), 1 << 26)), {.memory_bytes = 100 << 20});
        if (!m) {
            EXPECT_FALSE(m.error().message.empty());
            continue;
        }
        for (const Refusal& r : m->refused) EXPECT_FALSE(r.message.empty());
        for (const Approximation& a : m->approximations)
            if (a.where.starts_with("edges["))
                EXPECT_LT(std::size_t(std::atoi(a.where.c_str() + 6)), m->edges.size()) << a.what;
        EXPECT_TRUE(std::isfinite(summary(*m).box.diagonal()) || m->faces.empty());
        const auto t =
            tessellate(*m, {.tolerance = 1e-2 * summary(*m).box.diagonal(), .max_triangles = 1'000'000});
        if (!t) EXPECT_FALSE(t.error().message.empty());
    }
    EXPECT_GE(files, 1);
}

// A ribbon along a narrow V with a round tip, and an edge that cuts the tip inside: the nearest point jumps
// from one leg to the other, where steps from the one before stay on the first; whether or not a curve in
// parameters, at another speed, says where it goes on.
TEST(StepTangles, edges_go_on_where_nearest_points_jump) {
    using namespace step;
    const auto along = [](double tip) {
        return std::vector<Vec<3>>{
            {{0, 0, 0}}, {{0.95, 1.9, 0}}, {{1, tip, 0}}, {{1.05, 1.9, 0}}, {{2, 0, 0}}};
    };
    const BSplineBasis legs = *BSplineBasis::make(3, {0, 0, 0, 0, 0.5, 1, 1, 1, 1});
    Net<2, Vec<3>> net({2, 5});
    for (std::size_t i = 0; i < 5; ++i)
        for (std::size_t side = 0; side < 2; ++side)
            net.flat()[5 * side + i] = along(2)[i] + Vec<3>{{0, 0, double(side)}};
    const SurfaceGeometry ribbon = must(Surface<Vec<3>>::make({*BSplineBasis::bezier(1), legs}, net));
    const Chart chart(ribbon, 1e-9);
    const CurveGeometry<3> edge = must(Curve<Vec<3>>::make({legs}, Net<1, Vec<3>>({5}, along(1.8))));
    const CurveGeometry<3> image = must(Curve<Vec<3>>::make(
        {*BSplineBasis::bezier(2)}, Net<1, Vec<3>>({3}, {{{0, 0, 0}}, {{0, 0.4, 0}}, {{0, 1, 0}}})));
    const auto farthest = [&](const CurveGeometry<2>& c) {
        double most = 0;
        for (int i = 0; i <= 200; ++i)
            most = std::max(
                most, norm(chart.point(jet<0>(c, i / 200.0).value()) - jet<0>(edge, i / 200.0).value()));
        return most;
    };
    for (const bool said : {true, false}) {
        const auto images = said ? std::span(&image, 1) : std::span<const CurveGeometry<3>>();
        const auto t = must(trace(chart, edge, {0, 1}, 1e-6, 1e-3, images));
        EXPECT_LT(farthest(t.curve), 0.15) << said;
        EXPECT_LT(t.gap, 0.15) << said;
        const Vec<2> end = jet<0>(t.curve, 1).value();
        EXPECT_NEAR(end[1], 1, 1e-6) << said;
    }
}

// An edge across a crease where the surface has no tangent plane, (u, (2 v - 1)^3, (2 v - 1)^2): what is
// followed there is off, and what the file says, though it is no better than its tolerance, is nearer. Only a
// part of it belongs to the edge.
TEST(StepTangles, what_the_file_says_is_taken_where_it_is_nearer_than_what_is_found) {
    using namespace step;
    Net<2, Vec<3>> net({2, 4});
    for (std::size_t i = 0; i < 4; ++i) {
        constexpr double kCube[] = {-1, 1, -1, 1}, kSquare[] = {1, -1.0 / 3, -1.0 / 3, 1};
        for (std::size_t side = 0; side < 2; ++side)
            net.flat()[4 * side + i] = {{double(side), kCube[i], kSquare[i]}};
    }
    const SurfaceGeometry crease =
        must(Surface<Vec<3>>::make({*BSplineBasis::bezier(1), *BSplineBasis::bezier(3)}, net));
    const Chart chart(crease, 1e-9);
    const CurveGeometry<3> edge = must(Curve<Vec<3>>::make(
        {*BSplineBasis::bezier(3)},
        Net<1, Vec<3>>({4}, {{{0, -1, 1}}, {{0, 1, -1.0 / 3}}, {{1.0 / 3, -1, -1.0 / 3}}, {{1, 1, 1}}})));
    const auto image = [](double beyond) -> CurveGeometry<3> {
        return must(Curve<Vec<3>>::make({*BSplineBasis::make(2, {-beyond, -beyond, -beyond, 1, 1, 1})},
                                        Net<1, Vec<3>>({3}, {{{beyond * beyond, -beyond, 0}},
                                                             {{-beyond + 1e-5, (1 - beyond) / 2, 0}},
                                                             {{1, 1, 0}}})));
    };
    const auto found = trace(chart, edge, {0, 1}, 1e-8, 1e-2);
    EXPECT_TRUE(!found || found->gap > 3e-5);
    for (const double beyond : {0.0, 0.25}) {
        const CurveGeometry<3> said = image(beyond);
        const auto t = must(trace(chart, edge, {0, 1}, 1e-8, 1e-2, std::span(&said, 1)));
        EXPECT_TRUE(t.told) << beyond;
        EXPECT_LE(t.gap, 1e-5) << beyond;
        EXPECT_EQ(domain(t.curve)[0], (Interval{0, 1})) << beyond;
    }
}

}  // namespace
}  // namespace freiform::test
