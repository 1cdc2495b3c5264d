#include "support/random.hpp"
#include "support/reference.hpp"

#include <freiform/poly/determinant.hpp>
#include <freiform/query/implicit.hpp>

#include <gtest/gtest.h>

namespace freiform {
namespace {

using test::must;
using test::Random;
using test::Rational;

template <class P>
Curve<P, Bernstein> bernstein_curve(std::vector<P> net) {
    const int n = int(net.size());
    return must(Curve<P, Bernstein>::make({must(Bernstein::make(n - 1))}, Net<1, P>({n}, std::move(net))));
}
Implicit implicit_of(std::vector<Vec<2>> net) {
    return must(Implicit::make(bernstein_curve(std::move(net))));
}

// The independent form: F at (x, y) as Sylvester's resultant of x W - X and y W - Y in powers of t, by
// Gaussian elimination in rationals.
Rational sylvester(const std::vector<Hom<2>>& net, const Rational& x, const Rational& y) {
    const int n = int(net.size()) - 1;
    std::vector<Rational> f(std::size_t(n) + 1, Rational(0)), g = f;
    for (int i = 0; i <= n; ++i)
        for (int k = i; k <= n; ++k) {  // C(n,i) t^i (1-t)^(n-i)
            const Rational b = Rational(binomial(n, i) * binomial(n - i, k - i)) * ((k - i) % 2 ? -1 : 1);
            const Hom<2>& h = net[std::size_t(i)];
            f[std::size_t(k)] += b * (x * Rational(h[2]) - Rational(h[0]));
            g[std::size_t(k)] += b * (y * Rational(h[2]) - Rational(h[1]));
        }
    const std::size_t m = 2 * std::size_t(n);
    std::vector<std::vector<Rational>> s(m, std::vector<Rational>(m, Rational(0)));
    for (std::size_t r = 0; r < std::size_t(n); ++r)
        for (std::size_t k = 0; k <= std::size_t(n); ++k) {
            s[r][r + k] = f[std::size_t(n) - k];
            s[r + std::size_t(n)][r + k] = g[std::size_t(n) - k];
        }
    Rational det = 1;
    for (std::size_t c = 0; c < m; ++c) {
        std::size_t p = c;
        while (p < m && s[p][c] == 0) ++p;
        if (p == m) return 0;
        if (p != c) std::swap(s[p], s[c]), det = -det;
        det *= s[c][c];
        for (std::size_t r = c + 1; r < m; ++r) {
            if (s[r][c] == 0) continue;
            const Rational q = s[r][c] / s[c][c];
            for (std::size_t k = c; k < m; ++k) s[r][k] -= q * s[c][k];
        }
    }
    return det;
}

double coefficient(const std::vector<Implicit::Term>& terms, int x, int y) {
    for (const auto& t : terms)
        if (t.x == x && t.y == y) return t.coefficient.value;
    return NAN;
}

// Row R01, literally: the implicit form of known curves.
TEST(R01, implicit_form_of_a_parabola_a_circle_and_a_cuspidal_cubic) {
    // y = x^2: control points (0, 0), (1/2, 0), (1, 1).
    auto terms = must(implicit_of({{{0, 0}}, {{0.5, 0}}, {{1, 1}}}).terms());
    const double k = coefficient(terms, 2, 0);
    for (const auto& t : terms)
        EXPECT_EQ(t.coefficient.value, t.x == 2 && t.y == 0   ? k
                                       : t.x == 0 && t.y == 1 ? -k
                                                              : 0)
            << t.x << t.y;
    // The unit circle: (1 - t^2, 2 t) / (1 + t^2): weights 1, 1, 2.
    const auto circle =
        must(Implicit::make(bernstein_curve<Hom<2>>({{{1, 0, 1}}, {{1, 1, 1}}, {{0, 2, 2}}})));
    terms = must(circle.terms());
    const double r = coefficient(terms, 2, 0);
    EXPECT_NE(r, 0);
    EXPECT_EQ(coefficient(terms, 0, 2), r);
    EXPECT_EQ(coefficient(terms, 0, 0), -r);
    EXPECT_EQ(coefficient(terms, 1, 1), 0);
    // As near to the circle as doubles get: the sign is that of the exact x^2 + y^2 - 1.
    const int outside = circle.sign({{3, 1}});
    for (double y : {-0.7999999999999999, -0.8, -0.8000000000000002}) {
        const Rational off = Rational(0.6) * Rational(0.6) + Rational(y) * Rational(y) - 1;
        EXPECT_EQ(circle.sign({{0.6, y}}), off > 0 ? outside : -outside);
    }
    EXPECT_EQ(circle.sign({{0, -1}}), 0);
    EXPECT_EQ(circle.sign({{0.3, 0.1}}), -circle.sign({{3, 1}}));
    // (t^2, t^3): y^2 = x^3.
    const auto cusp = implicit_of({{{0, 0}}, {{0, 0}}, {{1.0 / 3, 0}}, {{1, 1}}});
    EXPECT_EQ(cusp.degree(), 3);
    EXPECT_EQ(cusp.traces(), 1);
    terms = must(cusp.terms());
    EXPECT_NEAR(coefficient(terms, 3, 0) / coefficient(terms, 0, 2), -1, 1e-15);
}

TEST(Implicit, agrees_with_sylvesters_resultant_in_exact_arithmetic) {
    Random random(31);
    for (int n = 1; n <= kMaxImplicitDegree; ++n) {
        std::vector<Hom<2>> net;
        for (int i = 0; i <= n; ++i) net.push_back(test::random_coefficient<Hom<2>>(random));
        const auto f = must(Implicit::make(bernstein_curve(net)));
        EXPECT_EQ(f.degree(), n);
        EXPECT_EQ(f.traces(), 1);
        EXPECT_EQ(f.scale()[0] * 0 + f.scale()[1] * 0, 0);
        Rational first = 0;
        for (int k = 0; k < 3; ++k) {
            const Vec<2> p{{random.real(-1, 1), random.real(-1, 1)}};
            const Rational truth = sylvester(net, p[0], p[1]);
            const Bounded value = f(p);
            EXPECT_TRUE(value.excludes_zero()) << n;
            // One factor for all points: the quotient with the first one, within the bounds.
            if (k == 0) first = truth / Rational(value.value);
            const double want = Rational(truth / first).convert_to<double>();
            EXPECT_NEAR(value.value, want, 1e-9 * std::abs(want)) << n;
            EXPECT_EQ(f.sign(p) * (first > 0 ? 1 : -1), truth > 0 ? 1 : -1);
        }
    }
}

// Points of the curve are roots exactly: parameters and curves for which points are doubles.
TEST(Implicit, vanishes_on_the_curve_exactly_and_changes_its_sign_across_it) {
    Random random(32);
    for (int n = 1; n <= 6; ++n) {
        std::vector<Vec<2>> net;
        for (int i = 0; i <= n; ++i)
            net.push_back({{double(random.integer(-64, 64)), double(random.integer(-64, 64))}});
        const auto curve = bernstein_curve(net);
        const auto f = must(Implicit::make(curve));
        for (int s = 0; s <= 8; ++s) {
            const auto exact = test::value_of<Rational>(curve, s / 8.0);
            const Vec<2> p{{exact[0].convert_to<double>(), exact[1].convert_to<double>()}};
            ASSERT_EQ(Rational(p[0]), exact[0]);
            EXPECT_EQ(f.sign(p), 0);
            const Bounded v = f(p);
            EXPECT_LE(std::abs(v.value), v.bound);
            const Vec<2> d = curve.jet<1>(s / 8.0).d[1];
            const Vec<2> side = 0x1p-30 * Vec<2>{{-d[1], d[0]}};
            if (max_abs(d) > 1) EXPECT_EQ(f.sign(p + side), -f.sign(p - side)) << n << " " << s;
        }
    }
}

TEST(Implicit, bounds_of_values_and_coefficients_hold) {
    Random random(33);
    for (int n = 1; n <= 5; ++n)
        for (int k = 0; k < 4; ++k) {
            std::vector<Hom<2>> net;
            const double shift = k == 3 ? 100 : 0;
            for (int i = 0; i <= n; ++i) net.push_back(test::random_coefficient<Hom<2>>(random, 1, shift));
            const auto f = must(Implicit::make(bernstein_curve(net)));
            const auto terms = must(f.terms());
            EXPECT_EQ(terms.size(), std::size_t((n + 1) * (n + 2) / 2));
            // At curve points the polynomial is 0 in exact arithmetic; what is left is the error of
            // coefficients.
            const auto curve = bernstein_curve(net);
            for (double t : {0.125, 0.5, 0.75}) {
                const auto p = test::value_of<Rational>(curve, t);
                Rational sum = 0, allowed = 0;
                for (const auto& term : terms) {
                    Rational m = 1;
                    for (int i = 0; i < term.x; ++i) m *= p[0];
                    for (int i = 0; i < term.y; ++i) m *= p[1];
                    sum += m * Rational(term.coefficient.value);
                    allowed += abs(m) * Rational(term.coefficient.bound);
                }
                EXPECT_LE(abs(sum), allowed);
                EXPECT_GT(abs(sum) * 1000000, allowed) << n;  // the bound is not idle
            }
        }
}

TEST(Implicit, sees_through_elevation_and_double_tracing) {
    // A cubic, elevated by two without rounding: multiples of 20.
    std::vector<Vec<2>> net{{{0, 0}}, {{20, 60}}, {{80, 40}}, {{100, -20}}};
    const auto cubic = implicit_of(net);
    for (int n = 3; n < 5; ++n) {
        std::vector<Vec<2>> up;
        for (int i = 0; i <= n + 1; ++i) {
            Vec<2> p{};
            for (int c = 0; c < 2; ++c)
                p[c] = ((i > 0 ? i * net[std::size_t(i) - 1][c] : 0) +
                        (i <= n ? (n + 1 - i) * net[std::size_t(i)][c] : 0)) /
                       (n + 1);
            up.push_back(p);
        }
        net = up;
    }
    const auto f = implicit_of(net);
    EXPECT_EQ(f.degree(), 3);
    EXPECT_EQ(f.traces(), 1);
    const auto a = must(cubic.terms()), b = must(f.terms());
    for (std::size_t i = 0; i < a.size(); ++i)
        EXPECT_NEAR(a[i].coefficient.value * b.back().coefficient.value,
                    b[i].coefficient.value * a.back().coefficient.value, 1e-10);
    // (s^2, s^4) with s = 2 t - 1 runs there and back.
    const auto twice = implicit_of({{{1, 1}}, {{0, -1}}, {{-1.0 / 3, 1}}, {{0, -1}}, {{1, 1}}});
    EXPECT_EQ(twice.degree(), 4);
    EXPECT_EQ(implicit_of({{{3, 3}}, {{0, -3}}, {{-1, 3}}, {{0, -3}}, {{3, 3}}}).traces(), 2);
    // A line as a cubic is its cube.
    const auto line = implicit_of({{{0, 0}}, {{1, 1}}, {{5, 5}}, {{3, 3}}});
    EXPECT_EQ(line.traces(), 3);
    EXPECT_EQ(line.sign({{7, 7}}), 0);
    EXPECT_EQ(line.sign({{7, 6}}), -line.sign({{6, 7}}));
    EXPECT_EQ(Implicit::make(bernstein_curve<Vec<2>>({{{1, 2}}, {{1, 2}}, {{1, 2}}})).error().kind,
              RefusalKind::no_answer);
    EXPECT_EQ(Implicit::make(bernstein_curve<Vec<2>>(std::vector<Vec<2>>(10))).error().kind,
              RefusalKind::unsupported);
    EXPECT_FALSE(Implicit::make(bernstein_curve<Vec<2>>({{{1, 2}}})));
}

TEST(Implicit, scales_with_powers_of_two) {
    const std::vector<Hom<2>> net{{{0.1, 0.7, 1}}, {{1.3, 2.1, 0.8}}, {{3, -1, 1.5}}, {{4, 0.2, 1}}};
    const auto one = must(Implicit::make(bernstein_curve(net)));
    for (int e : {-300, 300}) {
        std::vector<Hom<2>> other = net;
        for (auto& h : other) h = {{std::ldexp(h[0], e), std::ldexp(h[1], e), h[2]}};
        const auto f = must(Implicit::make(bernstein_curve(other)));
        for (double x : {0.5, 1.0, 2.5}) {
            const Vec<2> p{{x, 0.75}};
            EXPECT_EQ(one(p), f(std::exp2(e) * p));
            EXPECT_EQ(one.sign(p), f.sign(std::exp2(e) * p));
        }
    }
    EXPECT_EQ(must(Implicit::make(bernstein_curve(net))).sign({{1e300, 1e-300}}), one.sign({{1e200, 0}}));
}

TEST(Determinant, is_that_of_leibniz) {
    const std::vector<double> m{2, -1, 0, 3, 1, 4, 5, 7, -2, 6, 1, 0, 3, 3, -4, 8};
    EXPECT_EQ(determinant<double>(m, 0, 4), 1);
    EXPECT_EQ(determinant<double>(m, 2, 4), 2 * 4 - -1 * 1);
    EXPECT_EQ(determinant<double>(m, 3, 4), 2 * (4 * 1 - 5 * 6) + 1 * (1 * 1 - 5 * -2));
    const std::vector<double> permuted{0, 1, 0, 0, 0, 1, 1, 0, 0};
    EXPECT_EQ(determinant<double>(permuted, 3, 3), 1);
}

}  // namespace
}  // namespace freiform
