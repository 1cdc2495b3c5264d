
#include "polygon_face.hpp"
#include "random.hpp"
#include "refusal.hpp"
#include "solids.hpp"

#include <freiform/model/intersect.hpp>
#include <freiform/model/rescale.hpp>
#include <freiform/region/boolean.hpp>

#include <functional>
#include <gtest/gtest.h>

namespace freiform::test {
namespace {

double arc_length(const Curve<Vec<3>>& c) {
    const Interval on = c.domain()[0];
    double sum = 0;
    for (int i = 0; i < 2000; ++i)
        sum += norm(c(on.lo + on.length() * (i + 1) / 2000) - c(on.lo + on.length() * i / 2000));
    return sum;
}
double arc_length(const ModelIntersection& m) {
    double sum = 0;
    for (const FaceBranch& b : m.branches) sum += arc_length(b.curve);
    return sum;
}

// Every branch is near both surfaces at its parameters, as its bounds say.
ModelIntersection faces_met(const Model& a, const Model& b, double tolerance) {
    const auto found = must(intersect(a, b, SurfaceIntersectOptions{.tolerance = tolerance}));
    EXPECT_TRUE(found.open.empty()) << (found.open.empty() || !found.open[0].reason
                                            ? ""
                                            : found.open[0].reason->message);
    EXPECT_LT(found.search_bound, 1e-2 * tolerance);
    for (const FaceBranch& f : found.branches) {
        EXPECT_LE(f.bound(), tolerance);
        const Interval on = f.curve.domain()[0];
        EXPECT_EQ(f.at_a.domain()[0], on);
        EXPECT_EQ(f.at_b.domain()[0], on);
        const SurfaceGeometry &s = a.faces[std::size_t(f.faces[0])].surface,
                              &t = b.faces[std::size_t(f.faces[1])].surface;
        for (int i = 0; i <= 100; ++i) {
            const double x = i == 100 ? on.hi : on.lo + on.length() * i / 100;
            const Vec<3> p = f.curve(x);
            const double slack = 1e-14 * max_abs(p);
            EXPECT_LE(norm(p - jet<0>(s, f.at_a(x).c).value()), f.bound_a + slack);
            EXPECT_LE(norm(p - jet<0>(t, f.at_b(x).c).value()), f.bound_b + slack);
        }
    }
    return found;
}

// The plane z = height + slope x over [-2, 2]^2, with a round hole, or without.
Model plate(double height, std::optional<Vec<2>> hole, double radius, double slope = 0) {
    const double lo = height - 2 * slope, hi = height + 2 * slope;
    const auto basis = must(BSplineBasis::bezier(1, {-2, 2}));
    const auto flat = must(Surface<Vec<3>>::make(
        {basis, basis},
        Net<2, Vec<3>>({2, 2}, {{{-2, -2, lo}}, {{-2, 2, lo}}, {{2, -2, hi}}, {{2, 2, hi}}})));
    std::vector<std::vector<CurveGeometry<2>>> loops(1);
    const Vec<2> corner[] = {{{-2, -2}}, {{2, -2}}, {{2, 2}}, {{-2, 2}}};
    for (int i = 0; i < 4; ++i)
        loops[0].push_back(must(Curve<Vec<2>>::make({must(BSplineBasis::bezier(1, {0, 1}))},
                                                    Net<1, Vec<2>>({2}, {corner[i], corner[(i + 1) % 4]}))));
    if (hole) loops.push_back({Conic<2>{ConicKind::ellipse, *hole, {{radius, 0}}, {{0, radius}}}});
    ModelBuilder builder;
    EXPECT_TRUE(builder.add_trimmed(flat, loops));
    return must(std::move(builder).finish());
}

TEST(ModelIntersect, a_ball_and_a_tube_meet_in_circles_over_their_seams) {
    const auto found = faces_met(sphere({{0, 0, 1}}, 1.25), frustum(1, 1, 2), 1e-7);
    ASSERT_EQ(found.branches.size(), 4u);  // two with the wall, one with each disc
    for (const FaceBranch& b : found.branches) EXPECT_TRUE(b.closed);
    EXPECT_TRUE(found.nodes.empty());
    EXPECT_NEAR(arc_length(found), 7 * kPi, 1e-4);
}

TEST(ModelIntersect, a_hole_cuts_a_third_of_a_circle) {
    const Model tube = frustum(1, 1, 2), plane = plate(1, Vec<2>{{1, 0}}, 1);
    for (const bool swapped : {false, true}) {
        const auto found = swapped ? faces_met(plane, tube, 1e-7) : faces_met(tube, plane, 1e-7);
        ASSERT_EQ(found.branches.size(), 1u);
        const FaceBranch& b = found.branches[0];
        EXPECT_FALSE(b.closed);
        EXPECT_NEAR(arc_length(b.curve), kPi * 4 / 3, 1e-5);
        for (std::size_t e = 0; e < 2; ++e) {
            EXPECT_EQ(b.ends[e], kAtTrim);
            EXPECT_EQ(b.trims[e].side, swapped ? 0 : 1);
            EXPECT_EQ(b.trims[e].loop, 1);
            const Vec<3> p = b.curve(e == 0 ? b.curve.domain()[0].lo : b.curve.domain()[0].hi);
            EXPECT_NEAR(p[0], 0.5, 1e-6);
            EXPECT_NEAR(std::abs(p[1]), std::sqrt(0.75), 1e-6);
        }
    }
}

TEST(ModelIntersect, what_is_in_the_hole_does_not_meet) {
    const auto found = faces_met(frustum(1, 1, 2), plate(1, Vec<2>{{0, 0}}, 1.5), 1e-6);
    EXPECT_TRUE(found.branches.empty());
    EXPECT_TRUE(found.nodes.empty());
}

TEST(ModelIntersect, an_apex_is_met_on_the_side_where_the_face_is) {
    // z = 1 - r: the cone of height 1 meets the cylinder of radius 1/2 in one circle, and has no other half.
    const auto found = faces_met(frustum(1, 0, 1), frustum(0.5, 0.5, 3), 1e-7);
    double at_wall = 0;
    for (const FaceBranch& b : found.branches)
        if (b.faces == std::array{0, 0}) at_wall += arc_length(b.curve);
    EXPECT_NEAR(at_wall, kPi, 1e-5);
}

// Over the rim of a tube: an arc on the wall and a chord on the disc, the wall's seam crossed or not.
TEST(ModelIntersect, branches_are_joined_over_edges) {
    for (const double slope : {1.0, -1.0})
        for (const bool swapped : {false, true}) {
            const Model tube = frustum(1, 1, 2), plane = plate(1.5, {}, 0, slope);
            const auto found = swapped ? faces_met(plane, tube, 1e-7) : faces_met(tube, plane, 1e-7);
            ASSERT_EQ(found.chains.size(), 1u);
            const BranchChain& c = found.chains[0];
            EXPECT_TRUE(c.closed);
            EXPECT_LE(c.gap, 1e-6);
            ASSERT_EQ(c.links.size(), found.branches.size());
            EXPECT_GE(c.links.size(), 2u);
            for (std::size_t i = 0; i < c.links.size(); ++i) {
                const auto end = [&](const ChainLink& l, bool last) {
                    const Curve<Vec<3>>& curve = found.branches[std::size_t(l.branch)].curve;
                    return curve(last != l.reversed ? curve.domain()[0].hi : curve.domain()[0].lo);
                };
                EXPECT_LE(norm(end(c.links[i], true) - end(c.links[(i + 1) % c.links.size()], false)), c.gap);
            }
        }
    const auto found = faces_met(sphere({{0, 0, 1}}, 1.25), frustum(1, 1, 2), 1e-7);
    ASSERT_EQ(found.chains.size(), 4u);
    for (const BranchChain& c : found.chains) EXPECT_TRUE(c.closed && c.links.size() == 1);
    const auto open = faces_met(plate(0, {}, 0, 1), plate(0, {}, 0, 0), 1e-7);
    ASSERT_EQ(open.chains.size(), 1u);
    EXPECT_FALSE(open.chains[0].closed);
}

double area_of_regions(const ModelIntersection& m, std::array<int, 2> faces) {
    double sum = 0;
    for (const FaceNode& n : m.nodes)
        if (n.faces == faces)
            for (const FaceOverlap& o : n.regions) {
                EXPECT_LE(o.bound, 1e-6);
                EXPECT_LE(o.gap, 1e-6);
                EXPECT_NEAR(std::abs(signed_area(o.at_b).value), signed_area(o.at_a).value, 1e-6);
                sum += signed_area(o.at_a).value;
            }
    return sum;
}

TEST(ModelIntersect, overlaps_are_clipped_by_the_loops_of_both_faces) {
    const auto two =
        must(intersect(plate(1, Vec<2>{{0, 0}}, 1), plate(1, Vec<2>{{1, 0}}, 1), {.tolerance = 1e-6}));
    const double lens = 2 * kPi / 3 - std::sqrt(0.75);
    EXPECT_NEAR(area_of_regions(two, {0, 0}), 16 - 2 * kPi + lens, 1e-5);
    // One hole in the other: what is left has the larger one only.
    const auto ring =
        must(intersect(plate(1, Vec<2>{{0, 0}}, 1), plate(1, Vec<2>{{0.1, 0}}, 0.5), {.tolerance = 1e-6}));
    EXPECT_NEAR(area_of_regions(ring, {0, 0}), 16 - kPi, 1e-5);
    // Walls and discs: turned about their axis, the same.
    const auto tubes = must(intersect(frustum(1, 1, 1), frustum(1, 1, 1), {.tolerance = 1e-6}));
    EXPECT_NEAR(area_of_regions(tubes, {0, 0}), 2 * kPi, 1e-5);
    EXPECT_NEAR(area_of_regions(tubes, {1, 1}), kPi, 1e-5);
    // The rims, each of a wall and a disc, both ways round: they run along the loops of both.
    EXPECT_TRUE(tubes.open.empty());
    ASSERT_EQ(tubes.branches.size(), 4u);
    for (const FaceBranch& b : tubes.branches) {
        EXPECT_TRUE(b.along_trim[0] && b.along_trim[1]);
        EXPECT_NEAR(arc_length(b.curve), 2 * kPi, 1e-4);
    }
    // The disc fills the hole: they share a border, and nothing else.
    const auto filled = must(intersect(frustum(1, 1, 1), plate(1, Vec<2>{{0, 0}}, 1), {.tolerance = 1e-6}));
    for (const FaceNode& n : filled.nodes) EXPECT_NE(n.kind, SurfaceNodeKind::overlap);
    EXPECT_EQ(area_of_regions(filled, {2, 0}), 0);
}

TEST(ModelIntersect, powers_of_two_scale_the_answer) {
    const Model tube = frustum(1, 1, 2), plane = plate(1, Vec<2>{{1, 0}}, 1);
    const auto one = faces_met(tube, plane, 0x1p-20);
    for (const int exponent : {200, -200}) {
        const double factor = std::scalbn(1.0, exponent);
        const auto scaled = must(intersect(must(rescaled(tube, exponent)), must(rescaled(plane, exponent)),
                                           {.tolerance = factor * 0x1p-20}));
        ASSERT_EQ(scaled.branches.size(), one.branches.size());
        for (std::size_t i = 0; i < one.branches.size(); ++i) {
            EXPECT_NEAR(arc_length(scaled.branches[i].curve) / factor, arc_length(one.branches[i].curve),
                        1e-9);
            EXPECT_EQ(scaled.branches[i].ends, one.branches[i].ends);
        }
    }
}

TEST(ModelIntersect, refuses_tolerances_that_are_no_lengths_and_leaves_offsets_open) {
    const Model ball = sphere({}, 1);
    for (const double t : {0.0, -1.0, std::nan("")})
        expect_refusal(intersect(ball, ball, {.tolerance = t}), RefusalKind::invalid, "tolerance");
    Model offset = ball;
    offset.faces[0].surface = OffsetSurface{std::make_shared<SurfaceGeometry>(offset.faces[0].surface), 0.5};
    const auto found = must(intersect(ball, offset, {.tolerance = 1e-6}));
    ASSERT_EQ(found.open.size(), 1u);
    EXPECT_EQ(found.open[0].reason->kind, RefusalKind::unsupported);
    EXPECT_EQ(found.open[0].faces, (std::array{0, 0}));
}

// A quarter of a cylinder of radius 2 as a rational spline, moved outwards by 1/2, meets a plane across its
// axis in an arc of radius 5/2, and one along it in a line.
TEST(ModelIntersect, offsets_of_splines_meet_planes_where_they_are) {
    const double w = std::sqrt(0.5), r = 2.5;
    std::vector<Hom<3>> net;
    for (const auto& [x, y, weight] : {std::tuple{2.0, 0.0, 1.0}, {2.0, 2.0, w}, {0.0, 2.0, 1.0}})
        for (const double z : {0.0, 3.0}) net.push_back(weighted(Vec<3>{{x, y, z}}, weight));
    const SurfaceGeometry base = *Surface<Hom<3>>::make({*BSplineBasis::bezier(2), *BSplineBasis::bezier(1)},
                                                        Net<2, Hom<3>>({3, 2}, net));
    const SurfaceGeometry s = OffsetSurface{std::make_shared<SurfaceGeometry>(base), r - 2};
    const Model wall = polygon_face(s, Box<2>{{{0, 0}}, {{1, 1}}});
    const auto plane = [](const Vec<3>& o, const Vec<3>& u, const Vec<3>& v) {
        const SurfaceGeometry flat = Extrusion{Line<3>{o, u}, v, SurfaceKind::plane};
        return polygon_face(flat, Box<2>{{{-9, -9}}, {{9, 9}}});
    };
    for (const double tolerance : {1e-3, 1e-6}) {
        const auto arc =
            must(intersect(wall, plane({{0, 0, 1}}, {{1, 0, 0}}, {{0, 1, 0}}), {.tolerance = tolerance}));
        EXPECT_TRUE(arc.open.empty());
        EXPECT_GT(arc.search_bound, 1e-12);
        EXPECT_LE(arc.search_bound, tolerance / 16);
        ASSERT_EQ(arc.branches.size(), 1u);
        EXPECT_NEAR(arc_length(arc.branches[0].curve), r * std::numbers::pi / 2, 8 * tolerance);
        const auto on = arc.branches[0].curve.domain()[0];
        for (int i = 0; i <= 50; ++i) {
            const Vec<3> p = arc.branches[0].curve(on.lo + on.length() * i / 50);
            EXPECT_NEAR(std::hypot(p[0], p[1]), r, tolerance);
            EXPECT_NEAR(p[2], 1, tolerance);
        }
        const auto line =
            must(intersect(plane({{0, 1.5, 0}}, {{1, 0, 0}}, {{0, 0, 1}}), wall, {.tolerance = tolerance}));
        ASSERT_EQ(line.branches.size(), 1u);
        EXPECT_NEAR(line.branches[0].curve(line.branches[0].curve.domain()[0].lo)[0], 2, tolerance);
    }
    // Beyond the base there is the offset alone.
    EXPECT_EQ(must(intersect(wall, plane({{2.3, 0, 0}}, {{0, 1, 0}}, {{0, 0, 1}}), {.tolerance = 1e-3}))
                  .branches.size(),
              1u);
    EXPECT_TRUE(must(intersect(wall, plane({{0, 0, 3.5}}, {{1, 0, 0}}, {{0, 1, 0}}), {.tolerance = 1e-3}))
                    .branches.empty());
}

// Of hyperbolas and parabolas, over several of their pieces.
TEST(ModelIntersect, faces_of_open_conics_meet_planes_where_equations_say) {
    const Conic<3> branch{ConicKind::hyperbola, {{0.5, 0, 0}}, {{1, 0, 0}}, {{0, 0, 0.5}}},
        bow{ConicKind::parabola, {{0, 0, -1}}, {{0, 0, 0.5}}, {{1, 0, 0}}};
    const Vec<3> n = unit(Vec<3>{{0.2, 0.1, 1}});
    const double at = 0.3;
    const auto plane = [&](double beside) {
        const Vec<3> u = unit(cross(n, Vec<3>{{0, 1, 0}}));
        const SurfaceGeometry s = Extrusion{Line<3>{at * n, u}, cross(n, u), SurfaceKind::plane};
        return polygon_face(s, Box<2>{{{-beside, -beside}}, {{beside, beside}}});
    };
    struct Case {
        SurfaceGeometry surface;
        Box<2> on;
        std::function<double(const Vec<3>&)> off;
        std::size_t branches;
    };
    const auto about = [](const Vec<3>& x) { return std::hypot(x[0], x[1]); };
    const Case cases[] = {{Revolution{branch, {}, {{0, 0, 1}}},
                           {{{0.2, -3}}, {{6, 2.5}}},
                           [&](const Vec<3>& x) { return about(x) - 0.5 - std::sqrt(1 + 4 * x[2] * x[2]); },
                           1},
                          {Revolution{bow, {}, {{0, 0, 1}}},
                           {{{0.1, 0.2}}, {{6.1, 3}}},
                           [&](const Vec<3>& x) { return x[2] + 1 - about(x) * about(x) / 2; },
                           1},
                          {Extrusion{bow, {{0, 1, 0}}},
                           {{{-3, -1}}, {{3, 1}}},
                           [](const Vec<3>& x) { return x[2] + 1 - x[0] * x[0] / 2; },
                           2},
                          {Extrusion{branch, {{0, 1, 0}}},
                           {{{-4, -1}}, {{3.5, 1}}},
                           [](const Vec<3>& x) { return x[0] - 0.5 - std::sqrt(1 + 4 * x[2] * x[2]); },
                           1}};
    for (const Case& c : cases) {
        const auto found = faces_met(polygon_face(c.surface, c.on), plane(20), 1e-6);
        EXPECT_TRUE(found.nodes.empty());
        ASSERT_EQ(found.branches.size(), c.branches);
        for (const FaceBranch& b : found.branches) {
            const Interval on = b.curve.domain()[0];
            for (int i = 0; i <= 100; ++i) {
                const double t = i == 100 ? on.hi : on.lo + on.length() * i / 100;
                const Vec<3> x = jet<0>(CurveGeometry<3>(b.curve), t).value();
                EXPECT_NEAR(c.off(x), 0, 2e-5);
                EXPECT_NEAR(dot(n, x) - at, 0, 1e-6);
            }
        }
    }
}

}  // namespace
}  // namespace freiform::test
