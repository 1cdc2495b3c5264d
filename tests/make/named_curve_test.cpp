#include "support/random.hpp"

#include <freiform/make/named_curve.hpp>
#include <freiform/spline/bezier.hpp>

#include <gtest/gtest.h>
#include <limits>

namespace freiform {
namespace {

using test::must;
using test::Random;
using V2 = Vec<2>;

// sum_i M_i(t) g_i.
template <class P>
P by_matrix(const Matrix4& m, const P* g, const std::array<double, 4>& powers_of_t) {
    const auto f = basis_functions(m, powers_of_t);
    P sum{};
    for (int i = 0; i < 4; ++i) sum += f[std::size_t(i)] * g[i];
    return sum;
}

template <class P>
std::vector<P> random_points(Random& random, int n) {
    const auto net = test::random_net<1, P>(random, {n}, 1, 0, 0.1);
    return {net.flat().begin(), net.flat().end()};
}

TEST(R02, polynomial_curve_is_C_T_and_its_tangent_C_times_3t2_2t_1_0) {
    // C is 2 x 4; columns belong to t^3, t^2, t, 1.
    const std::vector<V2> c{{{1, -2}}, {{3, 0}}, {{-1, 4}}, {{5, 6}}};
    const auto q = must(polynomial(std::span(c)));
    for (double t : {0.0, 0.25, 0.5, 0.875, 1.0}) {
        const auto j = q.curve.jet<1>(t);
        for (int d = 0; d < 2; ++d) {
            EXPECT_NEAR(j.d[0][d], c[0][d] * t * t * t + c[1][d] * t * t + c[2][d] * t + c[3][d], 1e-14);
            EXPECT_NEAR(j.d[1][d], c[0][d] * 3 * t * t + c[1][d] * 2 * t + c[2][d], 1e-13);
        }
    }
}

template <class P>
void check_polynomials(Random& random) {
    for (int n = 0; n <= kMaxDegree; n += n < 8 ? 1 : 5) {
        const auto c = random_points<P>(random, n + 1);
        std::vector<P> columns = c;
        if constexpr (Space<P>::kRational)  // a weight that stays positive
            for (int i = 0; i <= n; ++i)
                columns[std::size_t(i)][P::kCoords - 1] = i == n ? 2.0 : 1.0 / (n + 1);
        const auto q = must(polynomial(std::span<const P>(columns), {0, 0.75}));
        for (double t : {0.0, 0.3, 0.75}) {
            P sum{};
            for (const P& x : columns) sum = t * sum + x;
            ASSERT_LE(norm(q.curve(t) - project(sum)), 1e-13 * (n + 1));
        }
        // and back
        const auto back = must(to_basis(q.curve, 0.2, must(PolynomialBasis::monomial(n))));
        for (std::size_t i = 0; i < columns.size(); ++i)
            for (int d = 0; d < P::kCoords; ++d)
                ASSERT_NEAR(back.coefficients[i][d], columns[i][d], 4e-16 * q.condition + 1e-15);
    }
}

TEST(Polynomial, of_any_degree_and_dimension_and_back) {
    Random random(71);
    check_polynomials<Vec<1>>(random);
    check_polynomials<Vec<3>>(random);
    check_polynomials<Hom<2>>(random);
}

TEST(R04, joining_with_k_times_the_tangent_is_G1) {
    const V2 p1{{0, 0}}, p4{{3, 1}}, p7{{5, -2}}, r1{{1, 4}}, r4{{2, -1}}, r7{{0, -3}};
    const auto a = must(hermite(p1, p4, r1, r4));
    for (double k : {0.5, 1.0, 3.0}) {
        const auto b = must(hermite(p4, p7, k * r4, r7));
        EXPECT_EQ(a(1.0), b(0.0));
        const V2 left = a.jet<1>(1.0).d[1], right = b.jet<1>(0.0).d[1];
        EXPECT_NEAR(cross(left, right), 0, 1e-14);
        EXPECT_NEAR(norm(right), k * norm(left), 1e-14);
        EXPECT_GT(dot(left, right), 0);
    }
    // Q = G M T
    const V2 g[] = {p1, p4, r1, r4};
    for (double t : {0.0, 0.25, 0.75, 1.0})
        EXPECT_LE(norm(a(t) - by_matrix(kHermite, g, powers(t))), 1e-15 * 8);
}

TEST(R05, bezier_points_of_a_hermite_segment) {
    const auto a = must(hermite(V2{{0, 0}}, V2{{4, 0}}, V2{{3, 6}}, V2{{3, -6}}));
    EXPECT_EQ(points(a), (std::vector<V2>{{{0, 0}}, {{1, 2}}, {{3, 2}}, {{4, 0}}}));
}

template <class P>
void check_segments(Random& random) {
    for (int n : {4, 5, 9}) {
        const auto p = random_points<P>(random, n);
        std::vector<TensionContinuityBias> s;
        for (int i = 0; i < n; ++i) s.push_back({random.real(-1, 1), random.real(-1, 1), random.real(-1, 1)});
        for (Ring ring : {Ring::open, Ring::closed}) {
            const bool closed = ring == Ring::closed;
            const auto kb = kochanek_bartels<P>(p, s, ring);
            if (Space<P>::kRational && !kb) continue;  // a weight became negative
            const auto curve = must(kb);
            const auto catmull = must(catmull_rom<P>(p, ring));
            EXPECT_EQ(curve.domain()[0], (Interval{0, double(closed ? n : n - 3)}));
            EXPECT_EQ(catmull.basis().multiplicity(1), n == 4 && !closed ? 4 : 2);
            for (int k = 0; k < (closed ? n : n - 3); ++k) {
                P g[4];
                const int first = closed ? k + n - 1 : k;
                for (int i = 0; i < 4; ++i) g[i] = p[std::size_t((first + i) % n)];
                const auto m =
                    kochanek_bartels_matrix(s[std::size_t((first + 1) % n)], s[std::size_t((first + 2) % n)]);
                for (double t : {0.0, 0.25, 0.6, 0.9}) {
                    EXPECT_LE(norm(curve(k + t) - project(by_matrix(m, g, powers(t)))), 1e-14) << n << k;
                    EXPECT_LE(norm(catmull(k + t) - project(by_matrix(kCatmullRom, g, powers(t)))), 1e-14);
                }
            }
        }
    }
}

TEST(R03, named_splines_through_points_are_G_M_T_in_every_segment) {
    Random random(72);
    check_segments<Vec<1>>(random);
    check_segments<Vec<3>>(random);
    check_segments<Hom<2>>(random);
}

TEST(R11, m_plus_1_control_points_give_m_minus_2_segments_from_t3_on) {
    Random random(73);
    for (int m : {3, 4, 9}) {
        const auto p = random_points<V2>(random, m + 1);
        const auto c = must(uniform_b_spline(std::span<const V2>(p)));
        EXPECT_EQ(int(c.basis().breaks().size()) - 1, m - 2);
        EXPECT_EQ(c.basis().knot(3), 0);
        for (int k = 0; k < m - 2; ++k)
            for (double t : {0.0, 0.25, 0.5, 0.9})
                EXPECT_LE(norm(c(k + t) - by_matrix(kUniformBSpline, &p[std::size_t(k)], powers(t))),
                          1e-15 * 4);
    }
}

TEST(R11, doubled_and_tripled_control_points) {
    const V2 p[] = {{{0, 0}}, {{1, 3}}, {{4, 2}}, {{6, -1}}};
    // Doubled: the joint lies on the line through a neighbour and the doubled point, at 1/6.
    const V2 doubled[] = {p[0], p[1], p[1], p[2], p[3]};
    const auto d = must(uniform_b_spline(std::span<const V2>(doubled)));
    EXPECT_LE(norm(d(1.0) - (1 / 6. * p[2] + 5 / 6. * p[1])), 1e-15 * 8);
    // Tripled: interpolated; the pieces before and behind are straight; C2 with zero derivatives, not G1.
    const V2 tripled[] = {p[0], p[1], p[1], p[1], p[2], p[3]};
    const auto t = must(uniform_b_spline(std::span<const V2>(tripled)));
    EXPECT_LE(norm(t(1.0) - p[1]), 1e-15 * 8);
    for (double u : {0.1, 0.5, 0.8}) {
        EXPECT_NEAR(cross(t(u) - p[1], p[0] - p[1]), 0, 1e-14);
        EXPECT_NEAR(cross(t(1 + u) - p[1], p[2] - p[1]), 0, 1e-14);
    }
    for (double side : {std::nextafter(1.0, 0.0), 1.0}) {
        const auto j = t.jet<2>(side);
        EXPECT_LE(norm(j.d[1]), 1e-14);
        EXPECT_LE(norm(j.d[2]), 1e-13);
    }
    const V2 before = unit(t.jet<1>(1 - 1e-3).d[1]), behind = unit(t.jet<1>(1 + 1e-3).d[1]);
    EXPECT_GT(std::abs(cross(before, behind)), 0.5);
}

TEST(R12, cox_de_boor_with_the_knots_of_the_text_and_triple_knots_interpolate_without_straight_pieces) {
    const auto b = must(BSplineBasis::make(2, {0, 0, 0, 1, 1, 2, 3, 3, 3, 4}));
    for (double u : {0.0, 0.5, 1.0, 1.5, 2.25, 3.0}) {
        double w[3], sum = 0;
        weights(b, u, 0, w);
        for (double x : w) {
            EXPECT_GE(x, 0);
            sum += x;
        }
        EXPECT_NEAR(sum, 1, 1e-15);
    }
    Random random(74);
    const auto cubic = must(BSplineBasis::make(3, {0, 0, 0, 0, 1, 1, 1, 2, 3, 3, 3, 3}));
    const auto p = random_points<V2>(random, cubic.size());
    const auto c = must(Curve<V2>::make({cubic}, must(Net<1, V2>::make({cubic.size()}, p))));
    EXPECT_EQ(c(0.0), p.front());
    EXPECT_LE(norm(c(1.0) - p[3]), 1e-15);
    EXPECT_LE(norm(c(3.0) - p.back()), 1e-15);
    for (double u : {0.5, 1.5})  // curved pieces on both sides
        EXPECT_GT(std::abs(cross(c.jet<2>(u).d[1], c.jet<2>(u).d[2])), 1e-3);
}

TEST(R06, bernstein_polynomials_of_any_degree) {
    for (int n = 1; n <= kMaxDegree; ++n) {
        const auto b = must(PolynomialBasis::bernstein(n)), lower = must(PolynomialBasis::bernstein(n - 1));
        for (double u : {0.0, 0.125, 0.375, 0.5, 0.9, 1.0}) {
            const auto f = b.values(u), g = b.values(1 - u), down = lower.values(u);
            double sum = 0;
            for (int i = 0; i <= n; ++i) {
                const auto at = [&](const std::vector<double>& v, int k) {
                    return k < 0 || k >= int(v.size()) ? 0 : v[std::size_t(k)];
                };
                EXPECT_GE(f[std::size_t(i)], 0);
                EXPECT_NEAR(f[std::size_t(i)], at(g, n - i), 1e-15);
                EXPECT_NEAR(f[std::size_t(i)], u * at(down, i - 1) + (1 - u) * at(down, i), 1e-15);
                sum += f[std::size_t(i)];
            }
            EXPECT_NEAR(sum, 1, 1e-14);
        }
        for (int i = 1; i < n; ++i) {  // the maximum is at i / n
            const double top = b.values(double(i) / n)[std::size_t(i)];
            EXPECT_GT(top, b.values(double(i) / n - 0.01)[std::size_t(i)]);
            EXPECT_GT(top, b.values(double(i) / n + 0.01)[std::size_t(i)]);
        }
    }
}

TEST(R06, derivatives_of_a_bezier_curve_are_bernstein_sums_of_differences) {
    Random random(75);
    for (int n = 2; n <= 9; ++n) {
        const auto b = random_points<Vec<3>>(random, n + 1);
        const auto c =
            must(from_basis(must(PolynomialBasis::bernstein(n)), std::span<const Vec<3>>(b))).curve;
        const auto one = must(PolynomialBasis::bernstein(n - 1)),
                   two = must(PolynomialBasis::bernstein(n - 2));
        for (double u : {0.0, 0.3, 1.0}) {
            Vec<3> first{}, second{};
            for (std::size_t i = 0; i < std::size_t(n); ++i)
                first += n * one.values(u)[i] * (b[i + 1] - b[i]);
            for (std::size_t i = 0; i + 1 < std::size_t(n); ++i)
                second += n * (n - 1) * two.values(u)[i] * (b[i + 2] - 2 * b[i + 1] + b[i]);
            EXPECT_LE(norm(c.jet<2>(u).d[1] - first), 1e-13);
            EXPECT_LE(norm(c.jet<2>(u).d[2] - second), 1e-12);
        }
    }
}

TEST(InterpolatingPolynomial, passes_through_its_points) {
    Random random(76);
    for (int n : {2, 3, 5, 9}) {
        const auto p = random_points<Vec<3>>(random, n);
        std::vector<double> nodes;
        for (int i = 0; i < n; ++i) nodes.push_back(std::cos(3.1 * (i + 0.5) / n));
        const auto q = must(interpolating_polynomial<Vec<3>>(p, nodes));
        for (int i = 0; i < n; ++i)
            EXPECT_LE(norm(q.curve(nodes[std::size_t(i)]) - p[std::size_t(i)]), 1e-13);
        // Newton's form of the same: divided differences from the values.
        const auto newton = must(convert_coefficients<Vec<3>>(must(PolynomialBasis::lagrange(nodes)),
                                                              must(PolynomialBasis::newton(nodes)), p));
        const Vec<3> difference = (1 / (nodes[1] - nodes[0])) * (p[1] - p[0]);
        EXPECT_EQ(newton.coefficients[0], p[0]);
        EXPECT_LE(norm(newton.coefficients[1] - difference), 1e-14);
    }
}

TEST(NamedCurves, refuse_bad_input_by_name_and_index) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const std::vector<V2> p{{{0, 0}}, {{1, 0}}, {{1, 1}}, {{0, nan}}};
    const auto four = std::span<const V2>(p), two = four.first(2);
    EXPECT_EQ(catmull_rom(four).error().where, "points[3]");
    EXPECT_EQ(catmull_rom(two).error().where, "points");
    EXPECT_EQ(cardinal(two, nan).error().where, "tension");
    EXPECT_EQ(uniform_b_spline(two).error().where, "points");
    EXPECT_EQ(uniform_b_spline(two, 99).error().where, "degree");
    EXPECT_EQ(hermite_spline(two, four).error().where, "tangents");
    EXPECT_EQ(hermite_spline(four.first(1), four.first(1)).error().where, "points");
    const std::vector<double> t{1, 1};
    EXPECT_EQ(hermite_spline(two, two, t).error().where, "parameters[1]");
    EXPECT_EQ(interpolating_polynomial(two, std::span<const double>(t)).error().where, "lagrange[1]");
    EXPECT_EQ(polynomial(std::span<const V2>()).error().where, "columns");
    EXPECT_EQ(from_basis(must(PolynomialBasis::monomial(3)), two).error().where, "coefficients");
    EXPECT_EQ(hermite(V2{{0, 0}}, V2{{1e308, 0}}, V2{{0, 0}}, V2{{-1.7e308, 0}}).error().where, "tangents");
}

}  // namespace
}  // namespace freiform
