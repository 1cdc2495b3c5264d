#include "support/random.hpp"

#include <freiform/basis/named.hpp>

#include <gtest/gtest.h>

namespace freiform {
namespace {

double bernstein(int n, int i, double u) {
    double c = 1;
    for (int k = 0; k < i; ++k) c = c * (n - k) / (k + 1);
    return c * std::pow(u, i) * std::pow(1 - u, n - i);
}

TEST(R03, every_named_matrix_is_data_and_the_segment_is_G_M_T) {
    for (const NamedMatrix& m : kNamedMatrices) {
        EXPECT_FALSE(m.name.empty());
        EXPECT_FALSE(m.author.empty());
    }
    // G (2 x 4) M T of a Bezier segment, written out, against its Bernstein sum.
    const Matrix<2, 4> g{{{0, 1, 3, 4}, {0, 2, 2, 0}}};
    const auto q = product(g, kBezier);
    for (double t : {0.0, 0.25, 0.5, 1.0})
        for (std::size_t d = 0; d < 2; ++d) {
            double sum = 0, expected = 0;
            for (std::size_t k = 0; k < 4; ++k) sum += q[d][k] * powers(t)[k];
            for (std::size_t k = 0; k < 4; ++k) expected += g[d][k] * bernstein(3, int(k), t);
            EXPECT_NEAR(sum, expected, 1e-15);
        }
}

TEST(R04, hermite_matrix_and_its_four_polynomials) {
    static_assert(kHermite == Matrix4{{{2, -3, 0, 1}, {-2, 3, 0, 0}, {1, -2, 1, 0}, {1, -1, 0, 0}}});
    for (double t : {0.0, 0.125, 0.5, 0.75, 1.0}) {
        const auto b = basis_functions(kHermite, powers(t));
        EXPECT_EQ(b[0], 2 * t * t * t - 3 * t * t + 1);
        EXPECT_EQ(b[1], -2 * t * t * t + 3 * t * t);
        EXPECT_EQ(b[2], t * t * t - 2 * t * t + t);
        EXPECT_EQ(b[3], t * t * t - t * t);
    }
    // Points and tangents at the ends: the functionals of the scheme give the identity.
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_EQ(basis_functions(kHermite, powers(0))[i], i == 0);
        EXPECT_EQ(basis_functions(kHermite, powers(1))[i], i == 1);
        EXPECT_EQ(basis_functions(kHermite, power_derivatives(0))[i], i == 2);
        EXPECT_EQ(basis_functions(kHermite, power_derivatives(1))[i], i == 3);
    }
}

TEST(R05, bezier_matrix_is_that_of_hermite_after_three_times_the_differences) {
    static_assert(kHermiteFromBezier == Matrix4{{{1, 0, -3, 0}, {0, 0, 3, 0}, {0, 0, 0, -3}, {0, 1, 0, 3}}});
    static_assert(kBezier == Matrix4{{{-1, 3, -3, 1}, {3, -6, 3, 0}, {-3, 3, 0, 0}, {1, 0, 0, 0}}});
    static_assert(kBezier == product(kHermiteFromBezier, kHermite));
    const Matrix<1, 4> g{{{5, 7, 11, 13}}};
    EXPECT_EQ(product(g, kHermiteFromBezier), (Matrix<1, 4>{{{5, 13, 3 * (7 - 5), 3 * (13 - 11)}}}));
}

TEST(R11, uniform_cubic_b_spline_matrix) {
    static_assert(kSixUniformBSpline ==
                  Matrix4{{{-1, 3, -3, 1}, {3, -6, 0, 4}, {-3, 3, 3, 1}, {1, 0, 0, 0}}});
    for (std::size_t i = 0; i < 4; ++i)
        for (std::size_t k = 0; k < 4; ++k) EXPECT_EQ(kUniformBSpline[i][k], kSixUniformBSpline[i][k] / 6);
}

TEST(R16, cubic_halves_and_the_columns_of_uniform_subdivision) {
    static_assert(scaled(8, kBezierLeftHalf) ==
                  Matrix4{{{8, 4, 2, 1}, {0, 4, 4, 3}, {0, 0, 2, 3}, {0, 0, 0, 1}}});
    static_assert(scaled(8, kBezierRightHalf) ==
                  Matrix4{{{1, 0, 0, 0}, {3, 2, 0, 0}, {3, 4, 4, 0}, {1, 2, 4, 8}}});
    const auto columns = transposed(scaled(8, kUniformBSplineHalves));
    EXPECT_EQ(columns,
              (Matrix<5, 4>{{{4, 4, 0, 0}, {1, 6, 1, 0}, {0, 4, 4, 0}, {0, 1, 6, 1}, {0, 0, 4, 4}}}));
    // M_B applied to the halves is M_B with t / 2 and (1 + t) / 2 for t.
    for (double t : {0.0, 0.25, 1.0})
        for (std::size_t i = 0; i < 4; ++i) {
            EXPECT_EQ(basis_functions(product(kBezierLeftHalf, kBezier), powers(t))[i],
                      basis_functions(kBezier, powers(t / 2))[i]);
            EXPECT_EQ(basis_functions(product(kBezierRightHalf, kBezier), powers(t))[i],
                      basis_functions(kBezier, powers((1 + t) / 2))[i]);
        }
}

TEST(NamedMatrices, of_affine_schemes_have_functions_with_the_sum_1) {
    test::Random random(31);
    for (int k = 0; k < 50; ++k) {
        const TensionContinuityBias a{random.real(-1, 1), random.real(-1, 1), random.real(-1, 1)},
            b{random.real(-1, 1), random.real(-1, 1), random.real(-1, 1)};
        const double t = random.real(0, 1);
        for (const Matrix4& m : {kBezier, kCatmullRom, kUniformBSpline, cardinal_matrix(a.tension),
                                 kochanek_bartels_matrix(a, b)}) {
            double sum = 0;
            for (double x : basis_functions(m, powers(t))) sum += x;
            EXPECT_NEAR(sum, 1, 1e-14);
        }
    }
}

TEST(NamedMatrices, kochanek_bartels_has_the_tangents_of_its_authors) {
    test::Random random(32);
    for (int k = 0; k < 50; ++k) {
        const TensionContinuityBias a{random.real(-1, 1), random.real(-1, 1), random.real(-1, 1)},
            b{random.real(-1, 1), random.real(-1, 1), random.real(-1, 1)};
        const double p[4] = {random.real(-1, 1), random.real(-1, 1), random.real(-1, 1), random.real(-1, 1)};
        const auto value = [&](const std::array<double, 4>& powers_of_t) {
            const auto f = basis_functions(kochanek_bartels_matrix(a, b), powers_of_t);
            return f[0] * p[0] + f[1] * p[1] + f[2] * p[2] + f[3] * p[3];
        };
        EXPECT_NEAR(value(powers(0)), p[1], 1e-14);
        EXPECT_NEAR(value(powers(1)), p[2], 1e-14);
        EXPECT_NEAR(value(power_derivatives(0)),
                    (1 - a.tension) * (1 + a.bias) * (1 + a.continuity) / 2 * (p[1] - p[0]) +
                        (1 - a.tension) * (1 - a.bias) * (1 - a.continuity) / 2 * (p[2] - p[1]),
                    1e-13);
        EXPECT_NEAR(value(power_derivatives(1)),
                    (1 - b.tension) * (1 + b.bias) * (1 - b.continuity) / 2 * (p[2] - p[1]) +
                        (1 - b.tension) * (1 - b.bias) * (1 + b.continuity) / 2 * (p[3] - p[2]),
                    1e-13);
    }
}

}  // namespace
}  // namespace freiform
