#include "support/random.hpp"
#include "support/reference.hpp"

#include <freiform/spline/construction.hpp>

#include <gtest/gtest.h>
#include <limits>

namespace freiform {
namespace {

using test::must;
using test::Random;
using test::Rational;

TEST(R15, de_casteljau_of_a_cubic_at_one_half_has_these_intermediate_points) {
    const std::vector<Vec<2>> b{{{0, 0}}, {{0, 8}}, {{8, 8}}, {{8, 0}}};
    const auto c = must(de_casteljau(std::span(b), 0.5));
    EXPECT_EQ(c(1, 0), (Vec<2>{{0, 4}}));
    EXPECT_EQ(c(1, 1), (Vec<2>{{4, 8}}));
    EXPECT_EQ(c(1, 2), (Vec<2>{{8, 4}}));
    EXPECT_EQ(c(2, 0), (Vec<2>{{2, 6}}));
    EXPECT_EQ(c(2, 1), (Vec<2>{{6, 6}}));
    EXPECT_EQ(c.point(), (Vec<2>{{4, 6}}));
    EXPECT_EQ(c.left(), (std::vector<Vec<2>>{{{0, 0}}, {{0, 4}}, {{2, 6}}, {{4, 6}}}));
    EXPECT_EQ(c.right(), (std::vector<Vec<2>>{{{4, 6}}, {{6, 6}}, {{8, 4}}, {{8, 0}}}));
    EXPECT_EQ(c.level(0).size(), 4u);
    EXPECT_EQ(c.flat().size(), 10u);
}

// The worked example of the lecture: (-1, 1), (0, -1), (1, 1) at 1/2.
TEST(R15, de_casteljau_of_the_parabola_of_the_text_ends_at_the_origin) {
    const std::vector<Vec<2>> b{{{-1, 1}}, {{0, -1}}, {{1, 1}}};
    const auto c = must(de_casteljau(std::span(b), 0.5));
    EXPECT_EQ(c(1, 0), (Vec<2>{{-0.5, 0}}));
    EXPECT_EQ(c(1, 1), (Vec<2>{{0.5, 0}}));
    EXPECT_EQ(c.point(), (Vec<2>{{0, 0}}));
}

TEST(R15, of_a_rational_curve_is_done_in_homogeneous_coordinates) {
    const double w = std::sqrt(0.5);
    const std::vector<Hom<2>> arc{{{1, 0, 1}}, {{w, w, w}}, {{0, 1, 1}}};
    for (double t : {0.0, 0.25, 0.5, 1.0})
        EXPECT_NEAR(norm(project(must(de_casteljau(std::span(arc), t)).point())), 1, 1e-15);
}

// Every point of every level, and the bound, against exact arithmetic; parameters also outside the domain.
template <class P>
void check_all_points(Random& random, double& worst) {
    for (int p : {0, 1, 2, 3, 5, 8, 11})
        for (int k = 0; k < 3; ++k) {
            const auto patch = test::random_patch_on<1, P>(
                random, {test::random_basis(random, p, {test::Ends(k % (p == 0 ? 2 : 3)), 3, false, false})});
            const BSplineBasis& basis = patch.basis();
            const double u = random.real(basis.domain().lo - 0.1, basis.domain().hi + 0.1);
            const auto c = must(de_boor(patch, u));
            const int span = c.first() + p;
            using Exact = std::array<Rational, std::size_t(P::kCoords)>;
            std::vector<Exact> level(std::size_t(p) + 1);
            for (std::size_t i = 0; i <= std::size_t(p); ++i)
                for (int d = 0; d < P::kCoords; ++d)
                    level[i][std::size_t(d)] =
                        patch.net().flat()[(std::size_t(c.first()) + i) % std::size_t(basis.size())][d];
            for (int r = 0; r <= p; ++r) {
                if (r > 0)
                    for (int i = 0; i <= p - r; ++i) {
                        const Rational tl = basis.knot(span - p + i + r), tr = basis.knot(span + i + 1);
                        const Rational a = (Rational(c.parameter()) - tl) / (tr - tl);
                        for (std::size_t d = 0; d < std::size_t(P::kCoords); ++d)
                            level[std::size_t(i)][d] =
                                (1 - a) * level[std::size_t(i)][d] + a * level[std::size_t(i) + 1][d];
                    }
                for (int i = 0; i <= p - r; ++i)
                    for (int d = 0; d < P::kCoords; ++d) {
                        const double error = test::gap(c(r, i)[d], level[std::size_t(i)][std::size_t(d)]);
                        ASSERT_LE(error, c.bound()) << "degree " << p << " level " << r;
                        worst = std::max(worst, error / c.bound());
                    }
            }
        }
}

TEST(Construction, has_every_intermediate_point_within_its_bound) {
    Random random(51);
    double worst = 0;
    check_all_points<Vec<1>>(random, worst);
    check_all_points<Vec<3>>(random, worst);
    check_all_points<Hom<2>>(random, worst);
    check_all_points<Hom<4>>(random, worst);
    std::printf("construction: observed error / bound = %.3g\n", worst);
    EXPECT_GT(worst, 0.001);
}

TEST(Construction, ends_on_the_curve_and_splits_it) {
    Random random(52);
    for (int p = 1; p <= 9; ++p) {
        const auto basis = must(Bernstein::make(p, {-1, 2}));
        const auto net = test::random_net<1, Vec<3>>(random, {p + 1});
        const auto curve = must(Curve<Vec<3>, Bernstein>::make({basis}, net));
        const double u = random.real(-1, 2);
        const auto c = must(de_boor(curve, u));
        EXPECT_LE(norm(c.point() - curve(u)), 1e-14 * (p + 1));
        const auto left = must(Curve<Vec<3>, Bernstein>::make({must(Bernstein::make(p, {-1, u}))},
                                                              must(Net<1, Vec<3>>::make({p + 1}, c.left()))));
        const auto right = must(Curve<Vec<3>, Bernstein>::make(
            {must(Bernstein::make(p, {u, 2}))}, must(Net<1, Vec<3>>::make({p + 1}, c.right()))));
        for (int k = 0; k <= 8; ++k) {
            const double x = -1 + 3 * (k / 8.0);
            EXPECT_LE(norm((x < u ? left : right)(x)-curve(x)), 1e-13 * (p + 1));
        }
    }
}

TEST(Construction, refuses_what_is_not_finite_and_degrees_that_are_none) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    std::vector<Vec<1>> b{{{0}}, {{nan}}};
    EXPECT_EQ(de_casteljau(std::span<const Vec<1>>(b), 0.5).error().where, "points[1]");
    b[1][0] = 1;
    EXPECT_EQ(de_casteljau(std::span<const Vec<1>>(b), nan).error().kind, RefusalKind::nonfinite);
    EXPECT_FALSE(de_casteljau(std::span<const Vec<1>>(), 0.5).has_value());
    b[1][0] = 1e300;
    EXPECT_EQ(de_casteljau(std::span<const Vec<1>>(b), 1e300).error().kind, RefusalKind::ill_conditioned);
}

// R23: repeated bilinear interpolation, literally.
TEST(R23, bilinear_interpolation_repeated_makes_these_nets) {
    Random random(61);
    for (const int n : {1, 2, 3, 5}) {
        const auto b = test::random_net<2, Vec<3>>(random, {n + 1, n + 1});
        const double u = random.real(0, 1), v = random.real(0, 1);
        const auto c = must(de_casteljau(b, {u, v}));
        Net<2, Vec<3>> level = b;
        for (int r = 1; r <= n; ++r) {
            Net<2, Vec<3>> next({n - r + 1, n - r + 1});
            each_index(next.extent(), [&](const Index<2>& at) {
                const int i = at[0], j = at[1];
                const auto p = [&](int k, int l) { return level.view()({k, l}); };
                next.view()(at) = (1 - u) * (1 - v) * p(i, j) + u * (1 - v) * p(i + 1, j) +
                                  (1 - u) * v * p(i, j + 1) + u * v * p(i + 1, j + 1);
            });
            level = next;
            const auto made = c.level({r, r});
            ASSERT_EQ(made.extent, level.extent());
            each_index(made.extent, [&](const Index<2>& at) {
                EXPECT_LT(norm(made(at) - level.view()(at)), 1e-15 * 8 * n);
            });
        }
        EXPECT_LT(norm(c.point() - level.view()({0, 0})), 1e-15 * 8 * n);
    }
}

// Level (r, s): r steps along u and s along v, in whatever order.
TEST(Construction, of_a_surface_has_the_constructions_of_its_curves) {
    Random random(62);
    const auto s = test::random_patch_on<2, Hom<3>>(
        random, {test::random_basis(random, 3, {test::Ends(0), 3, false, false}),
                 test::random_basis(random, 2, {test::Ends(2), 3, false, false})});
    const double u = s.domain()[0].middle(), v = s.domain()[1].middle();
    const auto c = must(de_boor(s, {u, v}));
    const auto along_v = must(de_boor(iso(s, 0, u), v)), along_u = must(de_boor(iso(s, 1, v), u));
    for (int r = 0; r <= 2; ++r)
        for (int i = 0; i <= 2 - r; ++i) EXPECT_LT(max_abs(c({3, r}, {0, i}) - along_v(r, i)), 1e-14);
    for (int r = 0; r <= 3; ++r)
        for (int i = 0; i <= 3 - r; ++i) EXPECT_LT(max_abs(c({r, 2}, {i, 0}) - along_u(r, i)), 1e-14);
    EXPECT_LT(norm(project(c.point()) - s(u, v)), 1e-14);
    EXPECT_LT(c.bound(), 1e-13);
}

TEST(R23, a_surface_is_cut_in_u_in_v_and_in_both) {
    Random random(63);
    const auto b = test::random_net<2, Vec<3>>(random, {4, 3});
    const auto bases = std::array{must(BSplineBasis::bezier(3)), must(BSplineBasis::bezier(2))};
    const auto s = must(Surface<Vec<3>>::make(bases, b));
    const double u = 0.375, v = 0.75;
    const auto c = must(de_casteljau(b, {u, v}));
    const auto along_u = must(de_casteljau(b, {u, 1})), along_v = must(de_casteljau(b, {0, v}));
    for (const int k : {0, 1})
        for (const int l : {0, 1}) {
            const auto quarter = must(Surface<Vec<3>>::make(bases, c.part({k, l})));
            const auto half_u = must(Surface<Vec<3>>::make(bases, along_u.part({k, 0}))),
                       half_v = must(Surface<Vec<3>>::make(bases, along_v.part({1, l})));
            for (const double x : {0.0, 0.3, 1.0})
                for (const double y : {0.0, 0.6, 1.0}) {
                    const double at_u = k == 0 ? u * x : u + (1 - u) * x,
                                 at_v = l == 0 ? v * y : v + (1 - v) * y;
                    EXPECT_LT(norm(quarter(x, y) - s(at_u, at_v)), 1e-14);
                    EXPECT_LT(norm(half_u(x, y) - s(at_u, y)), 1e-14);
                    EXPECT_LT(norm(half_v(x, y) - s(x, at_v)), 1e-14);
                }
        }
}

// The bound along both axes, against exact arithmetic.
TEST(Construction, of_a_surface_keeps_its_bound) {
    Random random(64);
    double worst = 0;
    for (int round = 0; round < 20; ++round) {
        const auto b = test::random_net<2, Vec<1>>(random, {5, 4});
        const double u = random.real(-0.2, 1.2), v = random.real(-0.2, 1.2);
        const auto c = must(de_casteljau(b, {u, v}));
        for (int r = 0; r <= 4; ++r)
            for (int q = 0; q <= 3; ++q) {
                const auto made = c.level({r, q});
                each_index(made.extent, [&](const Index<2>& at) {
                    Rational sum = 0;  // Bernstein polynomials of degree r and q of the window at `at`
                    for (int i = 0; i <= r; ++i)
                        for (int j = 0; j <= q; ++j) {
                            Rational f = Rational(binomial(r, i) * binomial(q, j)) *
                                         Rational(b.view()({at[0] + i, at[1] + j})[0]);
                            for (int k = 0; k < r; ++k) f *= k < i ? Rational(u) : 1 - Rational(u);
                            for (int k = 0; k < q; ++k) f *= k < j ? Rational(v) : 1 - Rational(v);
                            sum += f;
                        }
                    const double error = test::gap(made(at)[0], sum);
                    ASSERT_LE(error, c.bound());
                    worst = std::max(worst, error / c.bound());
                });
            }
    }
    std::printf("construction of surfaces: observed error / bound = %.3g\n", worst);
    EXPECT_GT(worst, 0.001);
}

TEST(Construction, of_many_parameters_refuses_more_points_than_memory_should_take) {
    const auto basis = must(Bernstein::make(25));
    const auto v = must(Volume<Vec<3>, Bernstein>::make({basis, basis, basis}, Net<3, Vec<3>>({26, 26, 26})));
    EXPECT_EQ(de_boor(v, {0.5, 0.5, 0.5}).error().kind, RefusalKind::limit);
}

}  // namespace
}  // namespace freiform
