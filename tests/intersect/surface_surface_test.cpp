#include "random.hpp"
#include "refusal.hpp"
#include "sanitizer.hpp"
#include "shapes.hpp"

#include <freiform/intersect/section.hpp>
#include <freiform/intersect/surface_surface.hpp>
#include <freiform/make/quadric.hpp>

#include <gtest/gtest.h>
#include <numbers>

namespace freiform::test {
namespace {

constexpr double kTau = 2 * std::numbers::pi;

template <class F>
double length_over(Interval on, F&& f) {
    double sum = 0;
    for (int i = 0; i < 2000; ++i)
        sum += norm(f(on.lo + on.length() * (i + 1) / 2000) - f(on.lo + on.length() * i / 2000));
    return sum;
}
double length_of(const SurfaceBranch& b) {
    return length_over(b.curve.domain()[0], [&](double t) { return b.curve(t); });
}
double length_of(const SurfaceIntersection& s) {
    double sum = 0;
    for (const SurfaceBranch& b : s.branches) sum += length_of(b);
    return sum;
}
int closed_in(const SurfaceIntersection& s) {
    return int(std::ranges::count_if(s.branches, [](const SurfaceBranch& b) { return b.closed; }));
}

template <class P>
void expect_near(const Surface<P>& s, const SurfaceBranch& b, const Curve<Vec<2>>& at, double bound) {
    const Interval on = b.curve.domain()[0];
    ASSERT_EQ(at.domain()[0], on);
    const auto domain = s.domain();
    double scale = 0;
    for (const Vec<3>& p : points(s)) scale = std::max(scale, max_abs(p));
    for (int i = 0; i <= 300; ++i) {
        const double t = i == 300 ? on.hi : on.lo + on.length() * i / 300;
        const Vec<2> u = at(t);
        for (int k = 0; k < 2; ++k) {
            const Interval d = domain[std::size_t(k)];
            ASSERT_GE(u[k], d.lo - 1e-14 * d.length());
            ASSERT_LE(u[k], d.hi + 1e-14 * d.length());
        }
        const Param<2> inside{clamped(u[0], domain[0]), clamped(u[1], domain[1])};
        ASSERT_LE(norm(b.curve(t) - s(inside)), bound + 1e-15 * scale) << t << " of " << on.hi;
    }
    if (b.closed) EXPECT_LT(norm(b.curve(on.lo) - b.curve(on.hi)), 1e-12 * scale);
}
template <class P, class Q>
SurfaceIntersection met(const Surface<P>& a, const Surface<Q>& b, double tolerance) {
    const auto found = must(intersect(a, b, SurfaceIntersectOptions{.tolerance = tolerance}));
    EXPECT_TRUE(found.undecided.empty());
    for (const SurfaceBranch& branch : found.branches) {
        expect_near(a, branch, branch.at_a, branch.bound_a);
        expect_near(b, branch, branch.at_b, branch.bound_b);
        EXPECT_LE(branch.bound(), tolerance);
        for (const int end : branch.ends) EXPECT_NE(end, kAtUnresolved);
    }
    return found;
}

FoundFrame frame_at(const Vec<3>& origin, const Vec<3>& axis = {{0, 0, 1}}) {
    return must(frame_about(origin, axis));
}
Surface<Hom<3>> ball(const Vec<3>& centre, double r, const Vec<3>& axis = {{0, 0, 1}}) {
    return must(sphere(frame_at(centre, axis), r)).surface;
}
Surface<Hom<3>> tube(const Vec<3>& centre, const Vec<3>& axis, double r, double half) {
    return must(cylinder(frame_at(centre, axis), r, {-half, half})).surface;
}
// Over [-1, 1]^2; z = f at the nodes of a quadratic interpolant that is exact for f of degree 2 in x and y.
template <class F>
Surface<Vec<3>> quadratic(F&& f) {
    const auto basis = must(BSplineBasis::bezier(2, {0, 1}));
    std::vector<Vec<3>> c;
    const auto middle = [](double a, double m, double b) { return 2 * m - (a + b) / 2; };
    const auto row = [&](double x) {
        return std::array{f(x, -1.0), middle(f(x, -1.0), f(x, 0.0), f(x, 1.0)), f(x, 1.0)};
    };
    const auto lo = row(-1), at = row(0), hi = row(1);
    for (int i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j)
            c.push_back({{i - 1.0, double(j) - 1,
                          i == 0   ? lo[j]
                          : i == 2 ? hi[j]
                                   : middle(lo[j], at[j], hi[j])}});
    return must(Surface<Vec<3>>::make({basis, basis}, Net<2, Vec<3>>({3, 3}, c)));
}
Surface<Vec<3>> flat(double x0, double x1, double y0, double y1) {
    const auto basis = must(BSplineBasis::bezier(1, {0, 1}));
    return must(Surface<Vec<3>>::make(
        {basis, basis},
        Net<2, Vec<3>>({2, 2}, {{{x0, y0, 0}}, {{x0, y1, 0}}, {{x1, y0, 0}}, {{x1, y1, 0}}})));
}
template <class P>
Surface<P> scaled_by(const Surface<P>& s, double factor) {
    std::vector<P> c(s.net().flat().begin(), s.net().flat().end());
    for (P& p : c)
        for (int k = 0; k < 3; ++k) p[k] *= factor;
    return must(Surface<P>::make(s.bases(), Net<2, P>(s.net().extent(), c)));
}

// Over one grid of parameters both surfaces are landscapes, and meet over the zeros of the difference of
// their heights, which section() finds by other means.
TEST(SurfaceSurface, landscapes_meet_over_the_zeros_of_their_difference) {
    std::mt19937 rng(20261122);
    int loops = 0;
    for (int n = 0; n < 3; ++n) {
        const auto a = landscape(rng, 3, 4 + n, 0.2), b = landscape(rng, 3, 4 + n, 0.2);
        std::vector<Vec<3>> c(a.net().flat().begin(), a.net().flat().end());
        for (std::size_t i = 0; i < c.size(); ++i) c[i][2] -= b.net().flat()[i][2];
        const auto difference = must(Surface<Vec<3>>::make(a.bases(), Net<2, Vec<3>>(a.net().extent(), c)));
        const auto found = met(a, b, 1e-6);
        const auto zeros = must(section(difference, {{{0, 0, 1}}, 0}, {.tolerance = 1e-5}));
        ASSERT_EQ(found.branches.size(), zeros.branches.size()) << n;
        EXPECT_TRUE(found.nodes.empty());
        double length = 0, expected = 0;
        int closed = 0;
        for (const SectionBranch& z : zeros.branches) {
            expected += length_over(z.curve.domain()[0], [&](double t) { return z.curve(t); });
            closed += z.closed;
        }
        for (const SurfaceBranch& f : found.branches)
            length += length_over(f.curve.domain()[0], [&](double t) {
                Vec<3> p = f.curve(t);
                p[2] = 0;
                return p;
            });
        EXPECT_EQ(closed_in(found), closed);
        EXPECT_NEAR(length, expected, 1e-5 * expected + 1e-5);
        loops += closed;
    }
    EXPECT_GT(loops, 0);
}

TEST(SurfaceSurface, spheres_meet_in_a_circle_over_seams) {
    const auto found = met(ball({{0, 0, 0}}, 1), ball({{1, 0.25, 0.125}}, 1.25, {{1, 2, 3}}), 1e-7);
    ASSERT_EQ(found.branches.size(), 1u);
    EXPECT_TRUE(found.branches[0].closed);
    EXPECT_TRUE(found.nodes.empty());
    const double d = norm(Vec<3>{{1, 0.25, 0.125}}), x = (d * d + 1 - 1.25 * 1.25) / (2 * d);
    EXPECT_NEAR(length_of(found), kTau * std::sqrt(1 - x * x), 1e-4);
}

// Both circles cross both seams at the same place.
TEST(SurfaceSurface, seams_at_one_place_are_both_stepped_over) {
    const auto found = met(ball({{0, 0, 0}}, 1.25), tube({{0, 0, 0}}, {{0, 0, 1}}, 1, 3), 1e-6);
    ASSERT_EQ(found.branches.size(), 2u);
    for (const SurfaceBranch& b : found.branches) {
        EXPECT_TRUE(b.closed);
        EXPECT_NEAR(length_of(b), kTau, 1e-4);
    }
}

TEST(SurfaceSurface, a_loop_a_thousandth_wide_is_found) {
    const auto bowl = quadratic([](double x, double y) {
        return 0.5 * ((x - 0.31) * (x - 0.31) + (y - 0.17) * (y - 0.17) - 2.5e-7);
    });
    const auto found = met(bowl, flat(-1, 1, -1, 1), 1e-6);
    ASSERT_EQ(found.branches.size(), 1u);
    EXPECT_TRUE(found.branches[0].closed);
    EXPECT_NEAR(length_of(found), kTau * 5e-4, 1e-5);
}

TEST(SurfaceSurface, touching_spheres_have_a_touching_point) {
    const auto found = met(ball({{0, 0, 0}}, 1), ball({{1.2, 1.6, 0}}, 1, {{1, 2, 3}}), 1e-6);
    EXPECT_TRUE(found.branches.empty());
    ASSERT_EQ(found.nodes.size(), 1u);
    EXPECT_EQ(found.nodes[0].kind, SurfaceNodeKind::touch);
    EXPECT_LT(norm(found.nodes[0].point - Vec<3>{{0.6, 0.8, 0}}), 1e-6);
    EXPECT_LT(found.nodes[0].gap, 1e-12);
}

TEST(SurfaceSurface, cylinders_of_one_radius_cross_at_two_points) {
    const auto found =
        met(tube({{0, 0, 0}}, {{0, 0, 1}}, 1, 3), tube({{0, 0, 0}}, {{0.8, 0, 0.6}}, 1, 3), 1e-6);
    ASSERT_EQ(found.nodes.size(), 2u);
    for (const SurfaceNode& n : found.nodes) {
        EXPECT_EQ(n.kind, SurfaceNodeKind::crossing);
        EXPECT_EQ(n.arms, 4);
        EXPECT_NEAR(std::abs(n.point[1]), 1, 1e-6);
    }
    EXPECT_EQ(found.branches.size(), 4u);
}

TEST(SurfaceSurface, the_order_of_the_surfaces_does_not_matter) {
    std::mt19937 rng(7);
    const auto a = landscape(rng, 3, 7, 0.2), b = landscape(rng, 3, 6, 0.2);
    const auto ab = met(a, b, 1e-6), ba = met(b, a, 1e-6);
    EXPECT_EQ(ab.branches.size(), ba.branches.size());
    EXPECT_EQ(closed_in(ab), closed_in(ba));
    EXPECT_NEAR(length_of(ab), length_of(ba), 1e-5);
    EXPECT_GT(length_of(ab), 0.5);
}

TEST(SurfaceSurface, powers_of_two_scale_the_answer) {
    std::mt19937 rng(8);
    const auto a = landscape(rng, 3, 6, 0.2), b = landscape(rng, 3, 5, 0.2);
    const auto one = met(a, b, 0x1p-20), big = met(scaled_by(a, 0x1p40), scaled_by(b, 0x1p40), 0x1p20);
    ASSERT_EQ(one.branches.size(), big.branches.size());
    ASSERT_FALSE(one.branches.empty());
    for (std::size_t i = 0; i < one.branches.size(); ++i) {
        const auto &p = one.branches[i].curve.net().flat(), &q = big.branches[i].curve.net().flat();
        ASSERT_EQ(p.size(), q.size());
        for (std::size_t k = 0; k < p.size(); ++k) EXPECT_EQ(0x1p40 * p[k], q[k]);
        EXPECT_EQ(0x1p40 * one.branches[i].bound(), big.branches[i].bound());
    }
}

TEST(SurfaceSurface, a_budget_that_ends_leaves_boxes) {
    std::mt19937 rng(9);
    const auto a = landscape(rng, 3, 7, 0.2), b = landscape(rng, 3, 7, 0.2);
    const auto found = must(intersect(a, b, SurfaceIntersectOptions{.tolerance = 1e-6, .max_pairs = 200}));
    EXPECT_FALSE(found.undecided.empty());
}

TEST(SurfaceSurface, refuses_tolerances_that_are_no_lengths) {
    const auto a = flat(0, 1, 0, 1);
    for (const double t : {0.0, -1.0, std::nan(""), HUGE_VAL})
        expect_refusal(intersect(a, a, SurfaceIntersectOptions{.tolerance = t}), RefusalKind::invalid,
                       "tolerance");
}

TEST(SurfaceSurface, surfaces_that_are_apart_have_nothing_in_common) {
    const auto found = met(ball({{0, 0, 0}}, 1), ball({{0, 0, 0.25}}, 0.5), 1e-6);
    EXPECT_TRUE(found.branches.empty());
    EXPECT_TRUE(found.nodes.empty());
}

}  // namespace
}  // namespace freiform::test
