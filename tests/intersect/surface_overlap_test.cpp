#include "intersect/same_map_detail.hpp"
#include "random.hpp"
#include "shapes.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/intersect/surface_surface.hpp>
#include <freiform/make/quadric.hpp>

#include <gtest/gtest.h>

namespace freiform::test {
namespace {

double area_of(const std::vector<Vec<2>>& loop) {
    double sum = 0;
    for (std::size_t i = 0; i < loop.size(); ++i) sum += cross(loop[i], loop[(i + 1) % loop.size()]) / 2;
    return sum;
}

// The one overlap, with its corners at the same places of both, within its gap.
template <class A, class B>
SurfaceOverlap one_overlap(const A& a, const B& b, double tolerance) {
    const auto found = must(intersect(a, b, SurfaceIntersectOptions{.tolerance = tolerance}));
    EXPECT_TRUE(found.branches.empty());
    EXPECT_TRUE(found.undecided.empty());
    EXPECT_EQ(found.nodes.size(), 1u);
    if (found.nodes.size() != 1 || found.nodes[0].overlaps.size() != 1) {
        ADD_FAILURE() << "not one overlap";
        return {};
    }
    const SurfaceNode& n = found.nodes[0];
    EXPECT_EQ(n.kind, SurfaceNodeKind::overlap);
    EXPECT_LT(n.cells.size(), 2000u);
    const SurfaceOverlap o = n.overlaps[0];
    EXPECT_LE(o.gap, tolerance);
    EXPECT_GT(area_of(o.loop_a), 0);
    EXPECT_EQ(o.loop_a.size(), o.loop_b.size());
    for (std::size_t i = 0; i < o.loop_a.size(); ++i)
        EXPECT_LE(norm(a(Param<2>(o.loop_a[i].c)) - b(Param<2>(o.loop_b[i].c))), o.gap);
    return o;
}
template <class P>
Surface<P> exchanged(const Surface<P>& s) {
    const auto n = s.net().extent();
    std::vector<P> net;
    for (int j = 0; j < n[1]; ++j)
        for (int i = 0; i < n[0]; ++i) net.push_back(s.net().view()({i, j}));
    return must(Surface<P>::make({s.basis(1), s.basis(0)}, Net<2, P>({n[1], n[0]}, net)));
}
template <class P>
Surface<P> cut(const Surface<P>& s, Interval u, Interval v) {
    return must(restrict_to(must(restrict_to(s, 0, u)), 1, v));
}
Surface<Vec<3>> parallelogram(const Vec<3>& o, const Vec<3>& u, const Vec<3>& v) {
    const auto b = must(BSplineBasis::bezier(1, {0, 1}));
    return must(Surface<Vec<3>>::make({b, b}, Net<2, Vec<3>>({2, 2}, {o, o + v, o + u, o + u + v})));
}

TEST(SurfaceOverlaps, parts_in_other_parametrisations_are_named_with_their_corners) {
    std::mt19937 rng(20261123);
    const auto whole = landscape(rng, 3, 6, 0.2);
    const Interval u{0.2, 0.7}, v{0.1, 0.9};
    const auto part = cut(whole, u, v);
    const auto raised = must(elevate(must(elevate(part, 0)), 1, 2));
    const auto inserted = must(insert_knots(part, 1, std::vector<double>{0.3, 0.35, 0.35}));
    for (const Surface<Vec<3>>& other : {part, raised, inserted, reverse(part, 0), reverse(part, 1),
                                         exchanged(part), exchanged(reverse(raised, 1))}) {
        const auto o = one_overlap(whole, other, 1e-7), back = one_overlap(other, whole, 1e-7);
        Box<2> box;
        for (const Vec<2>& x : o.loop_a) box.add(x);
        EXPECT_NEAR(box.lo[0], u.lo, 1e-12);
        EXPECT_NEAR(box.hi[0], u.hi, 1e-12);
        EXPECT_NEAR(box.lo[1], v.lo, 1e-12);
        EXPECT_NEAR(box.hi[1], v.hi, 1e-12);
        EXPECT_LT(o.gap, 1e-11);
        EXPECT_NEAR(area_of(o.loop_a), std::abs(area_of(back.loop_b)), 1e-12);
    }
}

TEST(SurfaceOverlaps, parts_that_reach_over_each_other_share_a_rectangle) {
    std::mt19937 rng(4);
    const auto whole = landscape(rng, 3, 7, 0.2);
    const auto a = cut(whole, {0, 0.6}, {0.2, 1}), b = cut(whole, {0.4, 1}, {0, 0.7});
    EXPECT_NEAR(area_of(one_overlap(a, b, 1e-6).loop_a), 0.2 * 0.5, 1e-11);
}

TEST(SurfaceOverlaps, surfaces_a_tenth_of_the_tolerance_apart_overlap_within_that) {
    std::mt19937 rng(5);
    const auto a = landscape(rng, 3, 6, 0.2);
    std::vector<Vec<3>> net(a.net().flat().begin(), a.net().flat().end());
    for (Vec<3>& p : net) p[2] += 1e-7;
    const auto b = must(Surface<Vec<3>>::make(a.bases(), Net<2, Vec<3>>(a.net().extent(), net)));
    const auto o = one_overlap(a, b, 1e-6);
    EXPECT_GE(o.gap, 1e-7);
    EXPECT_NEAR(area_of(o.loop_a), 9, 1e-12);
}

TEST(SurfaceOverlaps, parallelograms_of_one_plane_share_a_polygon_at_any_angle) {
    const auto a = parallelogram({}, {{1, 0, 0.5}}, {{0, 1, 0}});
    // The square on its corner about (1/2, 1/2), with the half diagonal 3/5: all corners of both stick out.
    const auto b = parallelogram({{-0.1, 0.5, -0.05}}, {{0.6, -0.6, 0.3}}, {{0.6, 0.6, 0.3}});
    const auto o = one_overlap(a, b, 1e-6);
    EXPECT_EQ(o.loop_a.size(), 8u);
    EXPECT_NEAR(area_of(o.loop_a), 2 * 0.36 - 4 * 0.01, 1e-12);
}

// The same cylinder from other angles on, a part higher: two rectangles beside the seam.
TEST(SurfaceOverlaps, a_cylinder_with_its_seam_elsewhere_has_a_rectangle_on_both_sides) {
    const Conic<3> rim{ConicKind::ellipse, {{1, 0, 0}}, {{2, 0, 0}}, {{0, 2, 0}}};
    const SurfacePart a{Extrusion{rim, {{0, 0, 1}}, SurfaceKind::cylinder}, {Interval{0, kTwoPi}, {0, 2}}};
    const SurfacePart b{Extrusion{rim, {{0, 0, 2}}, SurfaceKind::cylinder},
                        {Interval{1, 1 + kTwoPi}, {0.5, 2}}};
    const auto found = must(intersect(a, b, SurfaceIntersectOptions{.tolerance = 1e-7}));
    EXPECT_TRUE(found.branches.empty());
    ASSERT_EQ(found.nodes.size(), 1u);
    ASSERT_EQ(found.nodes[0].overlaps.size(), 2u);
    double area = 0;
    for (const SurfaceOverlap& o : found.nodes[0].overlaps) {
        area += area_of(o.loop_a);
        EXPECT_LT(o.gap, 1e-11);
        for (std::size_t i = 0; i < 4; ++i)
            EXPECT_LT(
                norm(jet<0>(a.surface, o.loop_a[i].c).value() - jet<0>(b.surface, o.loop_b[i].c).value()),
                1e-13);
    }
    EXPECT_NEAR(area, kTwoPi * 1, 1e-12);
}

// Rational splines whose parameters are no angles: turned about the axis, upside down, a part, and with the
// parameters of each piece moved by a projective map.
TEST(SurfaceOverlaps, rational_splines_with_their_seams_elsewhere_share_a_rectangle_on_every_side) {
    const Vec<3> o{}, z{{0, 0, 1}};
    const auto frame = [&](const Vec<3>& axis, const Vec<3>& toward) {
        return must(frame_about(o, axis, toward));
    };
    const auto at_z = frame(z, {{1, 0, 0}}), turned = frame(z, {{3, 1, 0}}),
               over = frame(-1.0 * z, {{1, 5, 0}});
    const auto even = must(cylinder(at_z, 1, {-2, 2})).surface;
    auto net = even.net();  // (1, c, 1) -> (1, 2 c, 4) from piece to piece
    for (int i = 0; i < net.extent()[0]; ++i)
        for (std::size_t j = 0; j < 2; ++j)
            for (int k = 0; k < 4; ++k) net.flat()[2 * std::size_t(i) + j][k] *= std::scalbn(1.0, i);
    const auto uneven = must(Surface<Hom<3>>::make(even.bases(), net));
    const struct {
        Surface<Hom<3>> a, b;
        std::size_t rectangles;
        double share;  // of the parameters of A
    } cases[] = {
        {must(cylinder(at_z, 1, {-2, 2})).surface, must(cylinder(turned, 1, {-1, 3})).surface, 2, 0.75},
        {must(cylinder(at_z, 1, {-2, 2})).surface, must(cylinder(over, 1, {-1, 3})).surface, 2, 0.75},
        {must(cylinder(at_z, 1, {-2, 2})).surface, must(cylinder(turned, 1, {-2, 2}, Turn{{0, 1}})).surface,
         1, 0},
        {uneven, must(cylinder(turned, 1, {-1, 3})).surface, 2, 0.75},
        {must(cone(at_z, 2, 1, {0, 1})).surface, must(cone(turned, 2, 1, {0, 1})).surface, 2, 1},
        {must(sphere(at_z, 1)).surface, must(sphere(turned, 1)).surface, 2, 1},
        {must(torus(at_z, 3, 1)).surface, must(torus(over, 3, 1)).surface, 2, 1},
    };
    for (const auto& c : cases) {
        const auto found = must(intersect(c.a, c.b, SurfaceIntersectOptions{.tolerance = 1e-5}));
        EXPECT_TRUE(found.branches.empty());
        EXPECT_TRUE(found.undecided.empty());
        ASSERT_EQ(found.nodes.size(), 1u);
        EXPECT_EQ(found.nodes[0].kind, SurfaceNodeKind::overlap);
        ASSERT_EQ(found.nodes[0].overlaps.size(), c.rectangles);
        double area = 0;
        for (const SurfaceOverlap& p : found.nodes[0].overlaps) {
            EXPECT_LT(p.gap, 1e-11);
            area += area_of(p.loop_a);
            for (std::size_t i = 0; i < 4; ++i)
                EXPECT_LT(norm(c.a(Param<2>(p.loop_a[i].c)) - c.b(Param<2>(p.loop_b[i].c))), 1e-14);
            // Within, where all the cells are.
            const Vec<3> x = c.a(Param<2>((0.5 * (p.loop_a[0] + p.loop_a[2])).c));
            EXPECT_TRUE(std::ranges::any_of(found.nodes[0].cells, [&](const auto& cell) {
                return norm(c.b(Param<2>{cell[2].middle(), cell[3].middle()}) - x) < 1;
            }));
        }
        const auto on = c.a.domain();
        if (c.share > 0) EXPECT_NEAR(area, c.share * on[0].length() * on[1].length(), 1e-11);
    }
}

// No map takes the lines of latitude of one to those of the other.
TEST(SurfaceOverlaps, spheres_with_other_poles_overlap_and_those_of_another_size_do_not) {
    const auto ball = [](const Vec<3>& axis, double r) {
        return must(sphere(must(frame_about({{1, 2, 3}}, axis)), r)).surface;
    };
    const auto a = ball({{0, 0, 1}}, 1);
    const auto found = must(intersect(a, ball({{1, 2, 3}}, 1), SurfaceIntersectOptions{.tolerance = 1e-6}));
    EXPECT_TRUE(found.branches.empty());
    EXPECT_TRUE(found.undecided.empty());
    ASSERT_EQ(found.nodes.size(), 1u);
    EXPECT_EQ(found.nodes[0].kind, SurfaceNodeKind::overlap);
    EXPECT_LE(found.nodes[0].gap, 1e-6);
    const auto apart =
        must(intersect(a, ball({{1, 2, 3}}, 1 + 1e-4), SurfaceIntersectOptions{.tolerance = 1e-6}));
    for (const SurfaceNode& n : apart.nodes) EXPECT_NE(n.kind, SurfaceNodeKind::overlap);
}

class OneSphere : public testing::Test {
protected:
    static Surface<Hom<3>> ball(const Vec<3>& centre, double r, const Vec<3>& axis = {{1, 2, 3}}) {
        return must(sphere(must(frame_about(centre, axis)), r)).surface;
    }
    static Surface<Hom<3>> with(const Surface<Hom<3>>& s, std::size_t i, const Hom<3>& p) {
        auto net = s.net();
        net.flat()[i] = p;
        return must(Surface<Hom<3>>::make(s.bases(), net));
    }
    static bool both_ways(const Surface<Hom<3>>& a, const Surface<Hom<3>>& b, double tolerance) {
        const bool forth = detail::are_one_sphere(a, b, tolerance);
        EXPECT_EQ(forth, detail::are_one_sphere(b, a, tolerance));
        return forth;
    }
    static constexpr double kTolerance = 1e-6;
};

// Twice the distance, divided by the square of the least weight: a tenth of the tolerance is near enough, all
// of it is not.
TEST_F(OneSphere, is_told_within_the_tolerance_and_never_beyond_it) {
    for (const Vec<3>& centre : {Vec<3>{}, Vec<3>{{40, -20, 10}}}) {
        const auto a = ball(centre, 2, {{0, 0, 1}});
        EXPECT_TRUE(both_ways(a, ball(centre, 2), kTolerance));
        for (const double d : {-0.1, 0.1}) {
            EXPECT_TRUE(both_ways(a, ball(centre, 2 + d * kTolerance), kTolerance)) << d;
            EXPECT_TRUE(both_ways(a, ball(centre + Vec<3>{{0, d * kTolerance, 0}}, 2), kTolerance)) << d;
        }
        for (const double d : {-1.05, 1.05, 20.0}) {
            EXPECT_FALSE(both_ways(a, ball(centre, 2 + d * kTolerance), kTolerance)) << d;
            EXPECT_FALSE(both_ways(a, ball(centre + Vec<3>{{0, d * kTolerance, 0}}, 2), kTolerance)) << d;
        }
    }
}

// A control point that only the middle of one surface knows; all corners stay.
TEST_F(OneSphere, is_refused_where_only_the_inside_of_one_surface_leaves_it) {
    const auto a = ball({}, 1, {{0, 0, 1}}), b = ball({}, 1);
    const std::size_t row = std::size_t(b.net().extent()[1]), i = row + row / 2;
    const Hom<3> p = b.net().flat()[i];
    EXPECT_TRUE(both_ways(a, with(b, i, p), kTolerance));
    for (const double by : {1 + 1e-4, 1 - 1e-4}) {
        const auto moved = with(b, i, weighted(by * project(p), p.weight()));
        EXPECT_FALSE(both_ways(a, moved, kTolerance));
        EXPECT_TRUE(both_ways(a, moved, 1e-3));
    }
}

// Homogeneous coefficients say the same if all are multiplied.
TEST_F(OneSphere, does_not_depend_on_a_factor_of_all_weights) {
    const auto a = ball({}, 1, {{0, 0, 1}});
    for (const double factor : {0x1p-12, 0x1p12}) {
        for (const double r : {1.0, 1 + 1e-3}) {
            const auto b = ball({}, r);
            auto net = b.net();
            for (Hom<3>& p : net.flat()) p = factor * p;
            const auto same = must(Surface<Hom<3>>::make(b.bases(), net));
            EXPECT_EQ(both_ways(a, same, kTolerance), r == 1) << factor;
        }
    }
}

// What rounding leaves open is no proof; neither is a plane, on which any sphere is large enough.
TEST_F(OneSphere, is_not_told_below_rounding_nor_of_what_is_no_sphere) {
    const auto a = ball({{1e3, 0, 0}}, 1, {{0, 0, 1}}), b = ball({{1e3, 0, 0}}, 1);
    EXPECT_TRUE(both_ways(a, b, 1e-6));
    EXPECT_FALSE(both_ways(a, b, 1e-10));
    const auto pipe = must(cylinder(must(frame_about({}, {{0, 0, 1}})), 1, {-1, 1})).surface;
    EXPECT_FALSE(both_ways(pipe, pipe, 1e-3));
    EXPECT_FALSE(both_ways(ball({}, 1), pipe, 1e-3));
    const auto line = must(BSplineBasis::bezier(1));
    const auto flat = must(Surface<Hom<3>>::make(
        {line, line},
        Net<2, Hom<3>>({2, 2}, {weighted(Vec<3>{{0, 0, 0}}, 1), weighted(Vec<3>{{0, 1, 0}}, 1),
                                weighted(Vec<3>{{1, 0, 0}}, 1), weighted(Vec<3>{{1, 1, 0}}, 1)})));
    EXPECT_FALSE(detail::are_one_sphere(flat, flat, 1e-3));
}

TEST(SurfaceOverlaps, powers_of_two_scale_them) {
    std::mt19937 rng(6);
    const auto a = landscape(rng, 3, 5, 0.2);
    const auto b = cut(a, {0.25, 0.75}, {0, 0.5});
    const auto scaled = [](const Surface<Vec<3>>& s, double factor) {
        std::vector<Vec<3>> net(s.net().flat().begin(), s.net().flat().end());
        for (Vec<3>& p : net) p *= factor;
        return must(Surface<Vec<3>>::make(s.bases(), Net<2, Vec<3>>(s.net().extent(), net)));
    };
    const auto one = one_overlap(a, b, 0x1p-20);
    for (const double factor : {0x1p200, 0x1p-200}) {
        const auto o = one_overlap(scaled(a, factor), scaled(b, factor), factor * 0x1p-20);
        EXPECT_EQ(o.loop_a, one.loop_a);
        EXPECT_EQ(o.loop_b, one.loop_b);
        EXPECT_EQ(o.gap, factor * one.gap);
    }
}

}  // namespace
}  // namespace freiform::test
