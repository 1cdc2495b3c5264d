#include "support/bezier.hpp"

#include <freiform/query/surface_continuity.hpp>

#include <gtest/gtest.h>
#include <numbers>

namespace freiform {
namespace {

using test::must;
using test::Random;

constexpr SurfaceEdge kLeft{0, End::start}, kRight{0, End::end}, kFront{1, End::start}, kBack{1, End::end};

// Something like a graph over [0, 3] x [0, 3], with parameters from 0 to 2.
template <class P>
Surface<P> random_graph(Random& random, int p, int q) {
    Net<2, P> net({p + 1, q + 1});
    for (int i = 0; i <= p; ++i)
        for (int j = 0; j <= q; ++j) {
            Vec<Space<P>::kDim> x;
            x[0] = 3.0 * i / p + random.real(-0.2, 0.2), x[1] = 3.0 * j / q + random.real(-0.2, 0.2);
            if constexpr (Space<P>::kDim > 2) x[2] = random.real(-1, 1);
            net.view()({i, j}) = Space<P>::lift(x, random.real(0.8, 1.25));
        }
    return must(Surface<P>::make(
        {must(BSplineBasis::bezier(p, {0, 2})), must(BSplineBasis::bezier(q, {0, 2}))}, std::move(net)));
}
template <class P>
Surface<P> axes_swapped(const Surface<P>& s) {
    const auto [n, m] = s.net().extent();
    Net<2, P> net({m, n});
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < m; ++j) net.view()({j, i}) = s.net().view()({i, j});
    return must(Surface<P>::make({s.basis(1), s.basis(0)}, std::move(net)));
}
template <class P>
Surface<P> part(const Surface<P>& s, Interval u, Interval v) {
    return must(restrict_to(must(restrict_to(s, 0, u)), 1, v));
}
ContinuityOptions roundings(double n) {
    ContinuityOptions o;
    o.roundings = n;
    return o;
}

template <class P>
class TJoints : public testing::Test {};
using Kinds = testing::Types<Vec<3>, Hom<3>>;
TYPED_TEST_SUITE(TJoints, Kinds);

// One polynomial in three parts: the edge of one is shared by the two others, whichever way they run.
TYPED_TEST(TJoints, of_parts_of_one_surface_have_every_order) {
    Random random(41);
    for (const double cut : {0.75, 0.7317, 4.0 / 3}) {
        const auto whole = random_graph<TypeParam>(random, 3, 2);
        const auto left = part(whole, {0, 1}, {0, 2}), low = part(whole, {1, 2}, {0, cut}),
                   high = part(whole, {1, 2}, {cut, 2});
        const std::vector<SurfaceEdges> all{edges_of(left, roundings(32)),
                                            edges_of(reverse(low, 1), roundings(32)),
                                            edges_of(axes_swapped(high), roundings(32))};
        const auto found = must(joints(all, 1e-9, roundings(32)));
        ASSERT_EQ(found.size(), 3u) << cut;
        for (const SurfaceJoint& j : found) {
            EXPECT_EQ(j.joint.c_order, 3) << cut << " " << j.meeting.first << j.meeting.second;
            EXPECT_EQ(j.joint.g_order, 2) << cut << " " << j.meeting.first << j.meeting.second;
        }
        const SurfaceMeeting &a = found[0].meeting, &b = found[1].meeting, &c = found[2].meeting;
        EXPECT_EQ(a.first_edge, kRight);
        EXPECT_EQ(a.second_edge, kLeft);
        EXPECT_TRUE(a.against);
        EXPECT_FALSE(a.whole);
        EXPECT_EQ(a.first_on.lo, 0);
        EXPECT_NEAR(a.first_on.hi, cut, 1e-14);
        EXPECT_EQ(a.second_on, (Interval{0, cut}));
        EXPECT_EQ(b.second_edge, kFront);
        EXPECT_FALSE(b.against);
        EXPECT_NEAR(b.first_on.lo, cut, 1e-14);
        EXPECT_EQ(b.first_on.hi, 2);
        EXPECT_TRUE(c.whole);
        EXPECT_TRUE(must(meetings(all, 0, 4)).size() <= 3);
    }
}

TEST(R31, bricks_that_are_staggered_share_the_middle_of_their_edges) {
    Random random(42);
    const auto whole = random_graph<Vec<3>>(random, 2, 3);
    const auto a = part(whole, {0, 1}, {0.6, 2}), b = part(whole, {1, 2}, {0, 1.1});
    const auto found = must(joints(std::vector{edges_of(b), edges_of(a)}, 1e-9, roundings(32)));
    ASSERT_EQ(found.size(), 1u);
    const SurfaceMeeting& m = found[0].meeting;
    EXPECT_EQ(m.first_edge, kLeft);
    EXPECT_EQ(m.second_edge, kRight);
    EXPECT_NEAR(m.first_on.lo, 0.6, 1e-14);
    EXPECT_EQ(m.first_on.hi, 1.1);
    EXPECT_EQ(m.second_on.lo, 0.6);
    EXPECT_NEAR(m.second_on.hi, 1.1, 1e-14);
    EXPECT_EQ(found[0].joint.g_order, 2);
}

// A neighbour of half the edge that bulges off it: the largest distance, and where it is.
TEST(R31, the_largest_gap_of_a_t_joint_is_found_with_its_place) {
    const auto flat = [](Interval u, Interval v, double bulge) {
        Net<2, Vec<3>> net({2, 3});
        for (int i = 0; i < 2; ++i)
            for (int j = 0; j < 3; ++j)
                net.view()({i, j}) = {{i ? u.hi : u.lo, v.lo + v.length() * j / 2, j == 1 ? bulge : 0}};
        return must(
            Surface<Vec<3>>::make({must(BSplineBasis::bezier(1)), must(BSplineBasis::bezier(2))}, net));
    };
    const auto left = flat({0, 1}, {0, 4}, 0), right = flat({1, 2}, {1, 3}, 0.125);
    const std::vector<SurfaceEdges> all{edges_of(left), edges_of(right)};
    const auto found = must(joints(all, 0.1));
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].meeting.first_on, (Interval{0.25, 0.75}));
    EXPECT_EQ(found[0].joint.g_order, -1);
    // z = 2 s (1 - s) / 8, at most 1/16, in the middle of both.
    EXPECT_NEAR(found[0].joint.g[0].size, 0.0625, found[0].joint.g[0].bound + 1e-15);
    EXPECT_NEAR(found[0].joint.g[0].at, 0.5, 0.01);
    EXPECT_NEAR(found[0].meeting.distance, 0.0625, 1e-15);
    EXPECT_TRUE(must(meetings(all, 0.0624)).empty());
    // They only touch in a corner, or pass within less than the gap along a piece shorter than that.
    const auto corner = flat({1, 2}, {4, 5}, 0), sliver = flat({1, 2}, {3.95, 5}, 0);
    EXPECT_TRUE(must(meetings(std::vector{edges_of(left), edges_of(corner)}, 0.01)).empty());
    EXPECT_TRUE(must(meetings(std::vector{edges_of(left), edges_of(sliver)}, 0.1)).empty());
    EXPECT_EQ(must(meetings(std::vector{edges_of(left), edges_of(sliver)}, 0.01)).size(), 1u);
}

// A part of a side is the side of a part, knots inside and beside the cuts included.
TEST(R31, parts_of_sides_are_sides_of_parts) {
    Random random(43);
    const auto spline = test::random_patch_on<2, Hom<3>>(
        random, {must(BSplineBasis::bezier(2)),
                 must(BSplineBasis::make(3, {0, 0, 0, 0, 0.3, 0.5, 0.5, 0.8, 1, 1, 1, 1}))});
    for (const Interval on : {Interval{0, 0.5}, {0.3, 1}, {0.1, 0.9}, {0.35, 0.45}, {0.3, 0.8}}) {
        const auto whole = must(arriving(spline, kRight, roundings(0)));
        const auto cut = must(arriving(must(restrict_to(spline, 1, on)), kRight, roundings(32)));
        const SurfaceSide side = part_of(whole, on, 0);
        EXPECT_EQ(side.pieces.size(), cut.pieces.size()) << on.lo;
        EXPECT_EQ(side.pieces.front().on.lo, on.lo);
        EXPECT_EQ(side.pieces.back().on.hi, on.hi);
        const auto same = must(continuity(side, cut, roundings(32)));
        EXPECT_EQ(same.c_order, 3) << on.lo;
        EXPECT_LT(same.c[0].size, 1e-14);
        // What is granted to the ends moves points by the speed there, and the bound says so.
        const SurfaceSide vague = part_of(whole, on, 1e-6);
        const auto loose = must(continuity(vague, cut, roundings(32)));
        EXPECT_GT(loose.c[0].bound, 1e-7);
        EXPECT_LT(loose.c[0].bound, 1e-3);
        const SurfaceSide shifted = part_of(whole, {on.lo + 5e-7 * (on.lo == 0), on.hi - 5e-7}, 0);
        EXPECT_LE(must(continuity(shifted, vague, roundings(0))).c[0].size, loose.c[0].bound * 2);
    }
}

// In the plane all tangent planes agree: G2 unless a surface folds back over the other.
TYPED_TEST(TJoints, of_plane_surfaces_are_smooth_unless_one_folds_back) {
    using P = std::conditional_t<Space<TypeParam>::kRational, Hom<2>, Vec<2>>;
    Random random(44);
    const auto a = random_graph<P>(random, 3, 3);
    const auto next = [&](double way) {
        Net<2, P> net({2, 4});
        for (int j = 0; j < 4; ++j) {
            const P& p = a.net().view()({3, j});
            net.view()({0, j}) = p;
            net.view()({1, j}) = Space<P>::lift(project(p) + Vec<2>{{way, random.real(-0.2, 0.2)}}, 1);
        }
        return must(Surface<P>::make({must(BSplineBasis::bezier(1)), a.basis(1)}, std::move(net)));
    };
    const auto on = must(joint(a, kRight, next(1), kLeft)), back = must(joint(a, kRight, next(-1), kLeft));
    EXPECT_EQ(on.g_order, 2);
    EXPECT_EQ(on.c_order, 0);
    EXPECT_FALSE(on.opposed);
    ASSERT_EQ(on.g.size(), 3u);
    EXPECT_EQ(on.g[1].size, 0);
    EXPECT_EQ(on.g[2].size, 0);
    EXPECT_EQ(back.g_order, 0);
    EXPECT_TRUE(back.opposed);
    EXPECT_NEAR(back.g[1].size, std::numbers::pi, 1e-12);
    const auto halves =
        must(joints(std::vector{edges_of(part(a, {0, 1}, {0, 2})), edges_of(part(a, {1, 2}, {0, 1.5}))}, 1e-9,
                    roundings(32)));
    ASSERT_EQ(halves.size(), 1u);
    EXPECT_EQ(halves[0].joint.c_order, 3);
    EXPECT_EQ(halves[0].joint.g_order, 2);
}

}  // namespace
}  // namespace freiform
