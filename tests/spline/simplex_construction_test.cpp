#include "support/random.hpp"
#include "support/reference.hpp"
#include "support/triangle.hpp"

#include <freiform/spline/simplex_construction.hpp>

#include <gtest/gtest.h>

namespace freiform {
namespace {

using test::must;
using test::Random;
using test::random_triangle;
using test::Rational;

std::vector<Param<2>> places(Random& random) {
    std::vector<Param<2>> all{{0, 0}, {1, 0}, {0, 1}, {0.5, 0.5}, {0.7, 0.3}, {0.1, 0.9}, {-0.5, 2}};
    for (int i = 0; i < 4; ++i) all.push_back({random.real(0, 0.5), random.real(0, 0.5)});
    return all;
}

// Row R29: every point of every level is the blossom of the parameter, r times, and of corners, in exact
// arithmetic, to a proven bound.
template <class P>
void expect_levels(Random& random, int n, double& worst) {
    const auto s = random_triangle<P>(random, n);
    for (const auto& u : places(random)) {
        const auto c = must(de_casteljau(s, u));
        auto exact = test::exact_net(s);
        for (int r = 0; r <= n; ++r) {
            ASSERT_EQ(c.level(r).size(), exact.size());
            for (std::size_t i = 0; i < exact.size(); ++i)
                for (int d = 0; d < P::kCoords; ++d) {
                    const double off = test::gap(c.level(r)[i][d], exact[i][std::size_t(d)]);
                    ASSERT_LE(off, c.bound());
                    if (c.bound() > 0) worst = std::max(worst, off / c.bound());
                }
            if (r < n) exact = test::exact_step(exact, n - r, u);
        }
        if (SimplexPatch<2, P>::contains(u)) {
            EXPECT_EQ(project(c.point()), s(u)) << "the same steps as evaluation";
        }
    }
}

TEST(R29, de_casteljau_with_all_nets_is_exact_up_to_its_bound) {
    Random random(291);
    double worst = 0;
    for (int n : {0, 1, 2, 3, 5, 8, 25}) {
        expect_levels<Vec<3>>(random, n, worst);
        expect_levels<Hom<2>>(random, n, worst);
    }
    std::printf("  largest observed / bound %.3f\n", worst);
    EXPECT_GT(worst, 0.05);
}

TEST(TriangleConstruction, its_faces_are_the_nets_of_the_three_parts) {
    Random random(292);
    for (int n : {1, 2, 4, 7}) {
        const auto s = random_triangle<Hom<3>>(random, n);
        const Param<2> u{0.25, 0.3};
        const auto c = must(de_casteljau(s, u));
        const auto parts = split_at(s, u);
        for (int corner = 0; corner < 3; ++corner) {
            const auto part = c.part(corner);
            for (std::size_t i = 0; i < part.coefficients().size(); ++i)
                ASSERT_LT(norm(part.coefficients()[i] - parts[std::size_t(corner)].coefficients()[i]), 1e-14);
        }
    }
}

TEST(TriangleConstruction, points_outside_are_extrapolated_and_nonsense_is_refused) {
    Random random(293);
    const auto s = random_triangle<Vec<2>>(random, 3);
    EXPECT_TRUE(de_casteljau(s, {2, 2}).has_value());
    EXPECT_EQ(de_casteljau(s, {std::nan(""), 0}).error().kind, RefusalKind::nonfinite);
    EXPECT_EQ(de_casteljau(s, {1e300, 1e300}).error().kind, RefusalKind::ill_conditioned);
}

TEST(Blossom, is_symmetric_affine_and_has_the_coefficients_at_corners) {
    Random random(294);
    for (int n : {1, 2, 3, 6}) {
        const auto s = random_triangle<Vec<3>>(random, n);
        std::vector<Param<2>> a;
        for (int i = 0; i < n; ++i) a.push_back({random.real(-1, 1), random.real(-1, 1)});
        const Vec<3> f = blossom(s, std::span<const Param<2>>(a));
        std::reverse(a.begin(), a.end());
        EXPECT_LT(test::distance(blossom(s, std::span<const Param<2>>(a)), f), 1e-12);
        // Affine in the first argument.
        const Param<2> x{0.3, 0.1}, y{-0.2, 0.8};
        const auto with = [&](const Param<2>& first) {
            auto b = a;
            b[0] = first;
            return blossom(s, std::span<const Param<2>>(b));
        };
        EXPECT_LT(test::distance(with({0.25 * x[0] + 0.75 * y[0], 0.25 * x[1] + 0.75 * y[1]}),
                                 0.25 * with(x) + 0.75 * with(y)),
                  1e-12);
        for (int j = 0; j <= n; ++j)
            for (int k = 0; j + k <= n; ++k) {
                std::vector<Param<2>> corners(std::size_t(n - j - k), {0, 0});
                corners.insert(corners.end(), std::size_t(j), {1, 0});
                corners.insert(corners.end(), std::size_t(k), {0, 1});
                EXPECT_EQ(blossom(s, std::span<const Param<2>>(corners)), s.coefficient(j, k));
            }
        const std::vector<Param<2>> same(std::size_t(n), x);
        EXPECT_LT(test::distance(blossom(s, std::span<const Param<2>>(same)), s(x)), 1e-14);
    }
}

TEST(R29, bernstein_polynomials_of_a_triangle_are_positive_and_add_up_to_one) {
    Random random(295);
    for (int n : {1, 3, 6}) {
        const std::size_t count = std::size_t((n + 1) * (n + 2) / 2);
        for (int round = 0; round < 5; ++round) {
            const double v = random.real(0, 0.9);
            const Param<2> u{random.real(0, 1 - v), v};
            double sum = 0;
            for (std::size_t i = 0; i < count; ++i) {
                std::vector<Vec<1>> b(count);
                b[i][0] = 1;
                const double value = must(SimplexPatch<2, Vec<1>>::make(n, b))(u)[0];
                EXPECT_GT(value, 0);
                sum += value;
            }
            EXPECT_NEAR(sum, 1, 1e-14);
        }
    }
}

TEST(DirectionalDerivative, is_the_limit_of_differences_and_linear_in_each_direction) {
    Random random(296);
    const auto s = random_triangle<Hom<3>>(random, 4);
    const Param<2> u{0.3, 0.25};
    const Vec<2> d{{0.5, -1}}, e{{2, 0.25}};
    const auto of = [&](const Param<2>& at, std::vector<Vec<2>> along) {
        return derivative(s, at, std::span<const Vec<2>>(along));
    };
    EXPECT_LT(test::distance(of(u, {}), s(u)), 1e-14);
    const double h = 0x1p-16;
    const Param<2> a{u[0] - h * e[0], u[1] - h * e[1]}, b{u[0] + h * e[0], u[1] + h * e[1]};
    EXPECT_LT(test::distance((0.5 / h) * (of(b, {d}) - of(a, {d})), of(u, {d, e})),
              1e-5 * (1 + norm(of(u, {d, e}))));
    EXPECT_LT(test::distance(of(u, {d, e}), of(u, {e, d})), 1e-11);
    EXPECT_LT(test::distance(of(u, {d + 2 * e}), of(u, {d}) + 2 * of(u, {e})), 1e-12);
    EXPECT_EQ(of(u, {{{1, 0}}}), s.jet<1>(u)(1, 0));
}

}  // namespace
}  // namespace freiform
