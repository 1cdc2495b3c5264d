#include "random.hpp"
#include "shapes.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/intersect/surface_surface.hpp>
#include <freiform/make/quadric.hpp>

#include <gtest/gtest.h>

namespace freiform::test {
namespace {

FoundFrame axis_at(const Vec<3>& origin, const Vec<3>& axis = {{0, 0, 1}}) {
    return must(frame_about(origin, axis));
}
Surface<Hom<3>> pipe(const Vec<3>& centre, double r, double half) {
    return must(cylinder(axis_at(centre), r, {-half, half})).surface;
}
Surface<Hom<3>> board(const Vec<3>& o, const Vec<3>& u, const Vec<3>& v) {
    const auto b = must(BSplineBasis::bezier(1, {0, 1}));
    return to_rational(
        must(Surface<Vec<3>>::make({b, b}, Net<2, Vec<3>>({2, 2}, {o, o + v, o + u, o + u + v}))));
}
template <class S>
S times(const S& s, double factor) {
    auto net = s.net();
    for (auto& p : net.flat())
        for (int k = 0; k < 3; ++k) p[k] *= factor;
    return must(S::make(s.bases(), net));
}

// The one tangent branch, near both surfaces as its bounds say.
template <class A, class B>
SurfaceBranch one_tangent(const A& a, const B& b, double tolerance) {
    const auto found = must(intersect(a, b, SurfaceIntersectOptions{.tolerance = tolerance}));
    EXPECT_TRUE(found.undecided.empty());
    EXPECT_EQ(found.nodes.size(), 1u);
    if (found.branches.size() != 1 || found.nodes.size() != 1) {
        ADD_FAILURE() << found.branches.size() << " branches, " << found.nodes.size() << " nodes";
        return found.branches.at(0);
    }
    EXPECT_EQ(found.nodes[0].kind, SurfaceNodeKind::tangent);
    const SurfaceBranch& t = found.branches[0];
    EXPECT_EQ(t.kind, SurfaceBranchKind::tangent);
    EXPECT_EQ(t.node, 0);
    EXPECT_LE(t.bound(), tolerance);
    const Interval on = t.curve.domain()[0];
    for (int i = 0; i <= 500; ++i) {
        const double x = i == 500 ? on.hi : on.lo + on.length() * i / 500,
                     slack = 1e-14 * max_abs(t.curve(x));
        const Vec<3> p = a(Param<2>(t.at_a(x).c)), q = b(Param<2>(t.at_b(x).c));
        EXPECT_LE(norm(t.curve(x) - p), t.bound_a + slack);
        EXPECT_LE(norm(t.curve(x) - q), t.bound_b + slack);
        EXPECT_LE(norm(p - q), t.gap() + slack);
    }
    return t;
}
double arc_length(const SurfaceBranch& b) {
    const Interval on = b.curve.domain()[0];
    double sum = 0;
    for (int i = 0; i < 2000; ++i)
        sum += norm(b.curve(on.lo + on.length() * (i + 1) / 2000) - b.curve(on.lo + on.length() * i / 2000));
    return sum;
}
template <class A, class B>
void expect_length(const A& a, const B& b, double tolerance, double length, bool closed) {
    for (const bool swapped : {false, true}) {
        const SurfaceBranch t = swapped ? one_tangent(b, a, tolerance) : one_tangent(a, b, tolerance);
        EXPECT_EQ(t.closed, closed);
        EXPECT_NEAR(arc_length(t), length, 1e-3 * length);
        for (const int end : t.ends) EXPECT_EQ(end, kAtBorder);
    }
}

TEST(SurfaceTangents, a_plane_touches_a_cylinder_along_its_height_on_the_seam_and_off_it) {
    for (const double x : {1.0, -1.0})
        expect_length(pipe({}, 1, 2), board({{x, -2, -2.5}}, {{0, 4.1, 0}}, {{0, 0, 5.2}}), 5e-4, 4, false);
    const Vec<3> n{{0.6, 0.8, 0}}, side{{-0.8, 0.6, 0}};
    expect_length(pipe({}, 1, 2), board(n - 1.5 * side - Vec<3>{{0, 0, 1}}, 3 * side, {{0, 0, 2.25}}), 5e-4,
                  2.25, false);
}

TEST(SurfaceTangents, cylinders_touch_along_a_line_outside_and_inside) {
    expect_length(pipe({}, 1, 2), pipe({{2.5, 0, 0.25}}, 1.5, 2), 1e-4, 3.75, false);
    expect_length(pipe({}, 1, 2), pipe({{0.3, 0.4, 0.25}}, 0.5, 1), 1e-4, 2, false);
}

TEST(SurfaceTangents, a_ball_touches_the_cylinder_around_it_in_a_circle_over_seams) {
    expect_length(must(sphere(axis_at({}), 1)).surface, pipe({}, 1, 2), 1e-3, kTwoPi, true);
    expect_length(must(sphere(axis_at({}, {{1, 2, 3}}), 1)).surface, pipe({}, 1, 2), 1e-3, kTwoPi, true);
}

TEST(SurfaceTangents, a_torus_lies_on_a_plane_in_a_circle) {
    expect_length(must(torus(axis_at({}), 2, 0.5)).surface,
                  board({{-3, -3.1, 0.5}}, {{6.2, 0, 0}}, {{0, 6.3, 0}}), 1e-3, 2 * kTwoPi, true);
}

TEST(SurfaceTangents, surfaces_a_little_apart_are_tangent_within_their_gap_and_no_more) {
    const auto tube = pipe({}, 1, 2);
    const auto beside = [](double d) { return board({{1 + d, -2, -2.5}}, {{0, 4.1, 0}}, {{0, 0, 5.2}}); };
    EXPECT_GE(one_tangent(tube, beside(-0x1p-40), 1e-4).gap(), 0x1p-40);
    EXPECT_TRUE(must(intersect(tube, beside(0x1p-20), {.tolerance = 1e-4})).nodes.empty());
    const auto apart = must(intersect(tube, beside(1e-3), {.tolerance = 1e-4}));
    EXPECT_TRUE(apart.branches.empty() && apart.nodes.empty());
    // A little inside: two lines, no tangent.
    const auto two = must(intersect(tube, beside(-1e-2), {.tolerance = 1e-4}));
    ASSERT_EQ(two.branches.size(), 2u);
    for (const SurfaceBranch& b : two.branches) EXPECT_EQ(b.kind, SurfaceBranchKind::crossing);
}

TEST(SurfaceTangents, reversed_parameters_and_powers_of_two_change_nothing_else) {
    const auto ball = must(sphere(axis_at({}, {{1, 2, 3}}), 1)).surface;
    const auto tube = pipe({}, 1, 2);
    const SurfaceBranch one = one_tangent(ball, tube, 0x1p-10);
    EXPECT_NEAR(arc_length(one_tangent(reverse(ball, 0), reverse(tube, 1), 0x1p-10)), arc_length(one), 1e-3);
    for (const double factor : {0x1p200, 0x1p-200}) {
        const SurfaceBranch big = one_tangent(times(ball, factor), times(tube, factor), factor * 0x1p-10);
        ASSERT_EQ(big.curve.net().flat().size(), one.curve.net().flat().size());
        for (std::size_t i = 0; i < one.curve.net().flat().size(); ++i)
            EXPECT_EQ(factor * one.curve.net().flat()[i], big.curve.net().flat()[i]);
        EXPECT_EQ(factor * one.bound(), big.bound());
    }
}

// Where a fan touches a plane the bottom of the valley stayed at the same place for two thousand steps, and a
// curve with all of them as knots is none: the program ended.
TEST(SurfaceTangents, valleys_that_end_inside_have_no_pieces_without_length) {
    const auto p = *BSplineBasis::bezier(6), one = *BSplineBasis::bezier(4),
               q = *BSplineBasis::make(
                   6, {0, 0, 0, 0, 0, 0, 0, .05, .05, .05, .05, .05, .05, 1, 1, 1, 1, 1, 1, 1}),
               two = *BSplineBasis::make(4, {0, 0, 0, 0, 0, .85, 1, 1, 1, 1, 1});
    std::vector<Hom<3>> plane, fan;
    for (int i = 0; i < 7; ++i)
        for (int k = 0; k < 13; ++k) plane.push_back({{double(i), double(k), 0, 1}});
    constexpr double kAside[5][5][3] = {{{1, -1, -1}, {-1, 1, 0}, {-1, 1, 0}, {0, 0, 1}, {0, 0, -2}},
                                        {{0, 0, 2}, {-1, -1, 1}, {-1, 0, -2}, {-1, 0, -2}, {-1, 1, 1}},
                                        {{0, 0, -1}, {0, 0, 0}, {-1, -1, 0}, {0, 0, 0}, {0, 1, 1}},
                                        {{-1, 0, 0}, {0, 0, 1}, {0, 0, -1}, {-1, 0, 1}, {0, 0, 0}},
                                        {{1, 0, -1}, {0, 1, -1}, {-1, 0, 1}, {0, 0, 1}, {0, 1, 1}}};
    for (int i = 0; i < 5; ++i) {
        fan.push_back({{0, 0, 0, 1}});
        for (int k = 0; k < 5; ++k) {
            const double* d = kAside[i][k];
            fan.push_back({{i + 0.01 * d[0], k + 1 + 0.01 * d[1], 0.01 * d[2], 1}});
        }
    }
    const auto a = *Surface<Hom<3>>::make({p, q}, Net<2, Hom<3>>({7, 13}, plane)),
               b = *Surface<Hom<3>>::make({one, two}, Net<2, Hom<3>>({5, 6}, fan));
    for (const double tolerance : {1e-4, 3e-5, 1.3e-5}) {
        const auto found = must(intersect(a, b, SurfaceIntersectOptions{.tolerance = tolerance}));
        EXPECT_FALSE(found.branches.empty());
        for (const SurfaceBranch& s : found.branches) EXPECT_LE(s.bound(), tolerance);
    }
}

}  // namespace
}  // namespace freiform::test
