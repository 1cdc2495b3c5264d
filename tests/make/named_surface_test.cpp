#include "support/random.hpp"

#include <freiform/make/named_curve.hpp>
#include <freiform/make/named_surface.hpp>

#include <gtest/gtest.h>

namespace freiform {
namespace {

using test::must;
using test::Random;
using Geometry = std::array<std::array<Vec<3>, 4>, 4>;

Geometry random_geometry(Random& random) {
    Geometry g;
    for (auto& row : g)
        for (Vec<3>& x : row)
            for (int c = 0; c < 3; ++c) x[c] = random.real(-1, 1);
    return g;
}

// R21: Q(s, t) = T^T M^T G M S, for every pair of named matrices.
TEST(R21, every_pair_of_matrices_gives_the_surface_of_the_product) {
    Random random(1);
    for (const NamedMatrix& mu : kNamedMatrices)
        for (const NamedMatrix& mv : kNamedMatrices) {
            const Geometry g = random_geometry(random);
            const auto s = must(bicubic(g, mu.matrix, mv.matrix));
            for (const double u : {0.0, 0.3, 0.75, 1.0})
                for (const double v : {0.0, 0.4, 1.0}) {
                    const auto f = basis_functions(mu.matrix, powers(u)),
                               h = basis_functions(mv.matrix, powers(v));
                    Vec<3> q{};
                    for (std::size_t i = 0; i < 4; ++i)
                        for (std::size_t j = 0; j < 4; ++j) q += (f[i] * h[j]) * g[i][j];
                    EXPECT_LT(norm(s(u, v) - q), 1e-14) << mu.name << " " << mv.name;
                }
        }
}

TEST(R21, bezier_geometry_is_the_net_and_hermite_geometry_has_tangents_and_twists) {
    Random random(2);
    const Geometry g = random_geometry(random);
    const auto bezier = must(bicubic(g, kBezier, kBezier));
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j) EXPECT_EQ(bezier.net().view()({i, j}), g[std::size_t(i)][std::size_t(j)]);
    const auto s = must(bicubic(g, kHermite, kHermite));
    for (const int i : {0, 1})
        for (const int j : {0, 1}) {
            const auto jet = s.jet<2>({double(i), double(j)});
            const std::size_t a = std::size_t(i), b = std::size_t(j);
            EXPECT_LT(norm(jet(0, 0) - g[a][b]), 1e-15);
            EXPECT_LT(norm(jet(1, 0) - g[a + 2][b]), 1e-14);
            EXPECT_LT(norm(jet(0, 1) - g[a][b + 2]), 1e-14);
            EXPECT_LT(norm(jet(1, 1) - g[a + 2][b + 2]), 1e-13);
        }
}

// R22: fix u, get the control points of the v-curve.
TEST(R22, a_patch_is_a_curve_of_curves) {
    Random random(3);
    const Geometry g = random_geometry(random);
    const auto s = must(bicubic(g, kCatmullRom, kBezier));
    for (const double u : {0.0, 0.2, 0.9}) {
        const auto points = curve_of_curves(g, kCatmullRom, u);
        const auto curve = iso(s, 0, u);
        for (std::size_t j = 0; j < 4; ++j) EXPECT_LT(norm(curve.net().flat()[j] - points[j]), 1e-15);
        for (const double v : {0.1, 0.5}) EXPECT_LT(norm(curve(v) - s(u, v)), 1e-15);
    }
    // At the start of a Catmull-Rom segment its second point.
    EXPECT_EQ(curve_of_curves(g, kCatmullRom, 0), g[1]);
}

TEST(R21, geometry_that_is_not_finite_is_refused_by_place) {
    Random random(4);
    Geometry g = random_geometry(random);
    g[2][3][1] = INFINITY;
    EXPECT_EQ(bicubic(g, kBezier, kBezier).error().where, "geometry[2][3]");
}

// The matrix of the row: row i holds function i of the basis in powers, highest first, written out by hand.
struct Written {
    PolynomialBasis basis;
    std::vector<std::vector<double>> rows;
};
std::vector<Written> written_schemes() {
    std::vector<Written> all;
    all.push_back(
        {must(PolynomialBasis::hermite(3)), {{2, -3, 0, 1}, {-2, 3, 0, 0}, {1, -2, 1, 0}, {1, -1, 0, 0}}});
    all.push_back({must(PolynomialBasis::bernstein(2)), {{1, -2, 1}, {-2, 2, 0}, {1, 0, 0}}});
    all.push_back({must(PolynomialBasis::uniform_b_spline(2)), {{.5, -1, .5}, {-1, 1, .5}, {.5, 0, 0}}});
    all.push_back({must(PolynomialBasis::lagrange({0, 0.5, 1})), {{2, -3, 1}, {-4, 4, 0}, {2, -1, 0}}});
    all.push_back({must(PolynomialBasis::newton({0, 1, 0.25})), {{0, 0, 1}, {0, 1, 0}, {1, -1, 0}}});
    all.push_back({must(PolynomialBasis::monomial(4)),
                   {{1, 0, 0, 0, 0}, {0, 1, 0, 0, 0}, {0, 0, 1, 0, 0}, {0, 0, 0, 1, 0}, {0, 0, 0, 0, 1}}});
    all.push_back({must(PolynomialBasis::bernstein(1)), {{-1, 1}, {1, 0}}});
    return all;
}
Vec<3> random_point(Random& random) {
    Vec<3> p;
    for (int c = 0; c < 3; ++c) p[c] = random.real(-1, 1);
    return p;
}
Net<2, Vec<3>> random_net(Random& random, int m, int n) {
    Net<2, Vec<3>> g({m, n});
    for (Vec<3>& p : g.flat()) p = random_point(random);
    return g;
}

// R22: Q = T_u M_u G M_v^T T_v^T for any two schemes of any two degrees.
TEST(R22, any_two_schemes_of_any_two_degrees_give_the_surface_of_the_product) {
    Random random(11);
    for (const Written& a : written_schemes())
        for (const Written& b : written_schemes()) {
            const auto g = random_net(random, a.basis.size(), b.basis.size());
            const auto s = must(from_bases<2, Vec<3>>({a.basis, b.basis}, g));
            EXPECT_LT(s.bound, 1e-14);
            const auto value = [](const std::vector<double>& row, double t) {
                double sum = 0;
                for (const double c : row) sum = sum * t + c;
                return sum;
            };
            for (const double u : {0.0, 0.3, 1.0})
                for (const double v : {0.0, 0.625, 1.0}) {
                    Vec<3> q{};
                    for (int i = 0; i < a.basis.size(); ++i)
                        for (int j = 0; j < b.basis.size(); ++j)
                            q += value(a.rows[std::size_t(i)], u) * value(b.rows[std::size_t(j)], v) *
                                 g.view()({i, j});
                    EXPECT_LT(norm(s.patch(u, v) - q), 2e-14)
                        << name_of(a.basis.scheme()) << " " << name_of(b.basis.scheme());
                }
        }
}

TEST(R22, the_curve_along_v_has_the_coefficients_of_the_curves_along_u) {
    Random random(12);
    const auto a = must(PolynomialBasis::newton({0, 0.25, 0.5, 1})), b = must(PolynomialBasis::hermite(5));
    const auto g = random_net(random, 4, 6);
    const auto s = must(from_bases<2, Vec<3>>({a, b}, g));
    for (const double u : {0.0, 0.375, 1.0}) {
        const auto f = a.values(u);
        const auto found = must(to_basis(iso(s.patch, 0, u), 0.5, b));
        for (int j = 0; j < 6; ++j) {
            Vec<3> sum{};
            for (int i = 0; i < 4; ++i) sum += f[std::size_t(i)] * g.view()({i, j});
            // A fifth-degree basis multiplies the rounding of the net by up to 60.
            EXPECT_LT(norm(found.coefficients[std::size_t(j)] - sum), 1e-12) << j;
        }
    }
}

// Ill-conditioned on both axes (1e8 each): one rounding at the end, none between.
TEST(FromBases, nothing_is_lost_between_the_axes) {
    const auto lagrange = must(PolynomialBasis::lagrange(equidistant(16, {0, 1})));
    const auto monomial = must(PolynomialBasis::monomial(15));
    // Highest powers first: the constant is the last.
    Net<2, Vec<1>> constant({16, 16});
    constant.view()({15, 15})[0] = 3;
    const auto c = must(from_bases<2, Vec<1>>({monomial, monomial}, constant));
    for (const Vec<1>& p : c.patch.net().flat()) EXPECT_EQ(p[0], 3);
    // Values f(u) g(v), whole numbers: the net is the product of those of f and g, each rounded once.
    Random random(14);
    std::vector<Vec<1>> f(16), g(16);
    Net<2, Vec<1>> values({16, 16});
    for (Vec<1>& x : f) x[0] = random.integer(-1000, 1000);
    for (Vec<1>& x : g) x[0] = random.integer(-1000, 1000);
    for (int i = 0; i < 16; ++i)
        for (int j = 0; j < 16; ++j) values.view()({i, j})[0] = f[std::size_t(i)][0] * g[std::size_t(j)][0];
    const auto s = must(from_bases<2, Vec<1>>({lagrange, lagrange}, values));
    const auto p = must(from_basis(lagrange, std::span<const Vec<1>>(f))),
               q = must(from_basis(lagrange, std::span<const Vec<1>>(g)));
    for (int i = 0; i < 16; ++i)
        for (int j = 0; j < 16; ++j) {
            const double exact =
                p.curve.net().flat()[std::size_t(i)][0] * q.curve.net().flat()[std::size_t(j)][0];
            EXPECT_NEAR(s.patch.net().view()({i, j})[0], exact, 0x1p-51 * std::abs(exact));
        }
    EXPECT_GT(s.condition, 1e8);
}

TEST(FromBases, a_volume_of_three_schemes_on_a_box) {
    Random random(13);
    const std::array bases{must(PolynomialBasis::hermite(3, {-1, 2})),
                           must(PolynomialBasis::lagrange({0, 2, 3})), must(PolynomialBasis::monomial(1, 5))};
    Net<3, Vec<3>> g({4, 3, 2});
    for (Vec<3>& p : g.flat()) p = random_point(random);
    const std::array<Interval, 3> on{{{-1, 2}, {0, 3}, {4, 6}}};
    const auto s = must(from_bases(bases, g, on));
    EXPECT_EQ(s.patch.domain(), on);
    const auto f0 = bases[0].values(0.5), f1 = bases[1].values(1.25), f2 = bases[2].values(4.75);
    Vec<3> q{};
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 3; ++j)
            for (int k = 0; k < 2; ++k)
                q += f0[std::size_t(i)] * f1[std::size_t(j)] * f2[std::size_t(k)] * g.view()({i, j, k});
    EXPECT_LT(norm(s.patch(0.5, 1.25, 4.75) - q), 1e-14);
}

TEST(FromBases, refusals_name_the_place) {
    const auto b = must(PolynomialBasis::bernstein(2));
    EXPECT_EQ((from_bases<2, Vec<3>>({b, b}, Net<2, Vec<3>>({3, 2})).error().where), "coefficients");
    EXPECT_TRUE((from_bases<2, Vec<3>>({b, b}, Net<2, Vec<3>>({3, 3}), {{{0, 1}, {2, 2}}}).error().where)
                    .starts_with("on[1]"));
    Net<2, Vec<3>> g({3, 3});
    g.view()({1, 2})[1] = NAN;
    EXPECT_EQ((from_bases<2, Vec<3>>({b, b}, g).error().where), "coefficients[5]");
}

}  // namespace
}  // namespace freiform
