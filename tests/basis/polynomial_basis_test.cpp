#include "support/random.hpp"
#include "support/reference.hpp"

#include <freiform/basis/named.hpp>
#include <freiform/basis/polynomial_basis.hpp>

#include <gtest/gtest.h>

namespace freiform {
namespace {

using test::must;
using test::Random;
using test::Rational;
using Poly = std::vector<Rational>;  // lowest power first
using Exact = std::vector<Poly>;     // rows

Poly times(const Poly& a, const Poly& b) {
    Poly c(a.size() + b.size() - 1);
    for (std::size_t i = 0; i < a.size(); ++i)
        for (std::size_t j = 0; j < b.size(); ++j) c[i + j] += a[i] * b[j];
    return c;
}
Poly linear(const Rational& root, const Rational& width) { return {-root / width, 1 / width}; }

// x of a x = b.
Exact solved(Exact a, Exact b) {
    const std::size_t n = a.size();
    for (std::size_t k = 0; k < n; ++k) {
        std::size_t pivot = k;
        while (a[pivot][k] == 0) ++pivot;
        std::swap(a[k], a[pivot]);
        std::swap(b[k], b[pivot]);
        for (std::size_t i = 0; i < n; ++i) {
            if (i == k || a[i][k] == 0) continue;
            const Rational f = a[i][k] / a[k][k];
            for (std::size_t j = k; j < n; ++j)
                if (a[k][j] != 0) a[i][j] -= f * a[k][j];
            for (std::size_t j = 0; j < b[k].size(); ++j)
                if (b[k][j] != 0) b[i][j] -= f * b[k][j];
        }
    }
    for (std::size_t i = 0; i < n; ++i)
        for (Rational& x : b[i]) x /= a[i][i];
    return b;
}
Exact identity(std::size_t n) {
    Exact m(n, Poly(n));
    for (std::size_t i = 0; i < n; ++i) m[i][i] = 1;
    return m;
}
Exact product(const Exact& a, const Exact& b) {
    Exact m(a.size(), Poly(b[0].size()));
    for (std::size_t i = 0; i < a.size(); ++i)
        for (std::size_t k = 0; k < b.size(); ++k)
            if (a[i][k] != 0)
                for (std::size_t j = 0; j < b[k].size(); ++j)
                    if (b[k][j] != 0) m[i][j] += a[i][k] * b[k][j];
    return m;
}
Rational norm_of(const Exact& a) {
    Rational most = 0;
    for (const Poly& row : a) {
        Rational sum = 0;
        for (const Rational& x : row) sum += abs(x);
        most = std::max(most, sum);
    }
    return most;
}

// Column j: function j of the basis in powers of t, by the textbook formulas.
Exact functions_of(const PolynomialBasis& b) {
    const std::size_t n = std::size_t(b.size());
    const auto x = b.numbers();
    std::vector<Poly> f(n, Poly{1});
    switch (b.scheme()) {
        case Scheme::monomial:
            for (std::size_t j = n - 1; j-- > 0;) f[j] = times(f[j + 1], {-Rational(x[0]), 1});
            break;
        case Scheme::newton:
            for (std::size_t j = 1; j < n; ++j) f[j] = times(f[j - 1], {-Rational(x[j - 1]), 1});
            break;
        case Scheme::lagrange:
            for (std::size_t j = 0; j < n; ++j)
                for (std::size_t k = 0; k < n; ++k)
                    if (k != j) f[j] = times(f[j], linear(x[k], Rational(x[j]) - x[k]));
            break;
        case Scheme::bernstein:
        case Scheme::b_spline: {
            // Cox - de Boor on polynomials, on the span [t_p, t_{p+1}].
            const std::size_t p = n - 1;
            f.assign(2 * p + 1, Poly{0});
            f[p] = {1};
            for (std::size_t k = 1; k <= p; ++k)
                for (std::size_t i = 0; i + k < 2 * p + 1; ++i) {
                    Poly sum(k + 1);
                    const auto add = [&](const Poly& g, const Poly& factor) {
                        const Poly h = times(g, factor);
                        for (std::size_t m = 0; m < h.size(); ++m) sum[m] += h[m];
                    };
                    if (x[i + k] != x[i]) add(f[i], linear(x[i], Rational(x[i + k]) - x[i]));
                    if (x[i + k + 1] != x[i + 1])
                        add(f[i + 1], linear(x[i + k + 1], Rational(x[i + 1]) - x[i + k + 1]));
                    f[i] = sum;
                }
            f.resize(n);
            break;
        }
        case Scheme::hermite: {
            Exact l(n, Poly(n));
            for (std::size_t i = 0; i < n; ++i)
                for (std::size_t k = i / 2; k < n; ++k) {
                    l[i][k] = 1;
                    for (std::size_t d = k; d > k - i / 2; --d) l[i][k] *= d;
                    for (std::size_t d = i / 2; d < k; ++d) l[i][k] *= Rational(x[i % 2]);
                }
            return solved(l, identity(n));
        }
    }
    Exact m(n, Poly(n));
    for (std::size_t j = 0; j < n; ++j)
        for (std::size_t k = 0; k < f[j].size(); ++k) m[k][j] = f[j][k];
    return m;
}

std::vector<PolynomialBasis> all_bases(int n) {
    std::vector<PolynomialBasis> all{must(PolynomialBasis::monomial(n)), must(PolynomialBasis::bernstein(n)),
                                     must(PolynomialBasis::lagrange(equidistant(n + 1, {0, n / 4.0}))),
                                     must(PolynomialBasis::newton(equidistant(n + 1, {-n / 8.0, n / 8.0}))),
                                     must(PolynomialBasis::uniform_b_spline(n))};
    std::vector<double> knots(std::size_t(n) + 1, -0.25);
    for (int i = 0; i < n; ++i) knots.push_back(0.25 * (i + 1));
    knots.insert(knots.end(), std::size_t(n) + 1, 0.25 * (n + 1));
    all.push_back(must(PolynomialBasis::b_spline(must(BSplineBasis::make(n, knots)), n + n / 2)));
    if (n % 2 == 1) all.push_back(must(PolynomialBasis::hermite(n, {0, 2})));
    return all;
}

TEST(R07, the_cubic_changes_are_the_named_matrices) {
    const auto monomial = must(PolynomialBasis::monomial(3)), bernstein = must(PolynomialBasis::bernstein(3)),
               hermite = must(PolynomialBasis::hermite(3)),
               spline = must(PolynomialBasis::uniform_b_spline(3));
    const auto expect = [](const PolynomialBasis& from, const PolynomialBasis& to, const Matrix4& m) {
        // Functions: F = M T. Coefficients go with M^T.
        const auto a = must(change_basis(from, to));
        for (int i = 0; i < 4; ++i)
            for (int j = 0; j < 4; ++j) EXPECT_EQ(a(i, j), m[std::size_t(j)][std::size_t(i)]) << i << j;
    };
    expect(bernstein, monomial, kBezier);
    expect(hermite, monomial, kHermite);
    expect(bernstein, hermite, kHermiteFromBezier);
    expect(spline, monomial, kUniformBSpline);
}

TEST(R07, if_functions_go_with_M_coefficients_go_with_its_transpose) {
    Random random(61);
    for (int n : {1, 2, 3, 4, 5, 7, 10}) {
        const auto all = all_bases(n);
        for (const auto& from : all)
            for (const auto& to : all) {
                const auto a = must(change_basis(from, to));
                const double t = random.real(0, 1);
                const auto f = from.values(t), g = to.values(t);
                std::vector<double> c;
                for (int i = 0; i <= n; ++i) c.push_back(random.real(-1, 1));
                const auto d = must(convert_coefficients(from, to, c, 1));
                double left = 0, right = 0, size = 0;
                for (int j = 0; j <= n; ++j) {
                    double sum = 0, terms = 0;
                    for (int i = 0; i <= n; ++i) {
                        sum += a(i, j) * g[std::size_t(i)];
                        terms += std::abs(a(i, j) * g[std::size_t(i)]);
                    }
                    ASSERT_NEAR(f[std::size_t(j)], sum, 2e-14 * (1 + terms))
                        << name_of(from.scheme()) << " " << name_of(to.scheme()) << n << " " << j;
                    left += c[std::size_t(j)] * f[std::size_t(j)];
                    right += d.values[std::size_t(j)].value * g[std::size_t(j)];
                    size += std::abs(d.values[std::size_t(j)].value * g[std::size_t(j)]);
                }
                ASSERT_NEAR(left, right, 1e-13 * (1 + size));
            }
    }
}

struct Worst {
    double entries = 0, losses = 0, conversions = 0,
           condition = 0;  // observed / bound; the largest condition
};

void compare(const PolynomialBasis& from, const PolynomialBasis& to, Random& random, bool with_condition,
             Worst& worst) {
    const int n = from.degree();
    const auto a = must(change_basis(from, to));
    const Exact vf = functions_of(from), vt = functions_of(to), exact = solved(vt, vf);
    Poly c;
    std::vector<double> given;
    for (int i = 0; i <= n; ++i) given.push_back(random.real(-1, 1)), c.push_back(given.back());
    const Exact image = product(exact, [&] {
        Exact column;
        for (const Rational& x : c) column.push_back({x});
        return column;
    }());
    Net<1, Vec<1>> net({n + 1});
    double most = 0;
    for (int i = 0; i <= n; ++i)
        net.flat()[std::size_t(i)][0] = given[std::size_t(i)],
        most = std::max(most, std::abs(given[std::size_t(i)]));
    const auto mapped = along(0, a.map(), net);
    const auto precise = must(convert_coefficients(from, to, given, 1));
    double reached = 0;
    for (std::size_t i = 0; i <= std::size_t(n); ++i)
        reached = std::max(reached, std::abs(image[i][0].convert_to<double>()));
    for (std::size_t i = 0; i <= std::size_t(n); ++i) {
        for (std::size_t j = 0; j <= std::size_t(n); ++j) {
            const double error = test::gap(a(int(i), int(j)), exact[i][j]),
                         bound = a.error[i * std::size_t(n + 1) + j];
            ASSERT_LE(error, bound) << name_of(from.scheme()) << " to " << name_of(to.scheme()) << n;
            ASSERT_LE(bound, 1.2e-16 * std::abs(a(int(i), int(j))) + 1e-90);
            if (error > 0) worst.entries = std::max(worst.entries, error / bound);
        }
        const double error = test::gap(mapped.flat()[i][0], image[i][0]);
        ASSERT_LE(error, a.absolute_loss * most);
        ASSERT_LE(error, a.relative_loss * reached);
        worst.losses = std::max(worst.losses, error / (a.absolute_loss * most));
        const double once = test::gap(precise.values[i].value, image[i][0]);
        ASSERT_LE(once, precise.values[i].bound);
        ASSERT_LE(precise.values[i].bound, 1.2e-16 * std::abs(precise.values[i].value) + 1e-90);
        if (once > 0) worst.conversions = std::max(worst.conversions, once / precise.values[i].bound);
    }
    worst.condition = std::max(worst.condition, a.condition);
    if (with_condition) {
        const Rational condition = norm_of(exact) * norm_of(solved(vf, vt));
        ASSERT_GE(Rational(a.condition), condition);
        ASSERT_LE(Rational(a.condition), condition * Rational(1 + 1e-9));
    }
}

// Degrees 1 .. 25; at degree 3 every ordered pair of kinds.
TEST(ChangeBasis, is_exact_within_the_bounds_of_its_entries) {
    Random random(62);
    Worst worst;
    for (int n = 1; n <= kMaxDegree; ++n) {
        const auto all = all_bases(n);
        for (std::size_t k = 0; k < all.size(); ++k) {
            if (n > 6 && k % 4 != std::size_t(n) % 4) continue;
            for (std::size_t l = 0; l < all.size(); ++l)
                if (n == 3 || l == (k + std::size_t(n) + std::size_t(n) / 7) % all.size())
                    compare(all[k], all[l], random, n <= 6 || (n == kMaxDegree && k == 1), worst);
        }
    }
    std::printf(
        "change_basis: observed/bound: entries %.17g, map() %.3g, conversion %.17g; condition up to %.3g\n",
        worst.entries, worst.losses, worst.conversions, worst.condition);
    EXPECT_GT(worst.entries, 0.5);
    EXPECT_LT(worst.entries, 1);
    EXPECT_LT(worst.conversions, 1);
    EXPECT_GT(worst.losses, 1e-4);
    EXPECT_GT(worst.condition, 1e15);
}

TEST(ChangeBasis, says_how_bad_monomials_of_high_degree_are) {
    double before = 0;
    for (int n = 1; n <= kMaxDegree; ++n) {
        const auto a =
            must(change_basis(must(PolynomialBasis::bernstein(n)), must(PolynomialBasis::monomial(n))));
        // Every further degree costs a good half of a digit more.
        EXPECT_GT(a.condition, 2 * before);
        EXPECT_LE(a.absolute_loss, a.relative_loss);
        EXPECT_GE(a.relative_loss, 0x1p-53 * a.condition / 4);
        before = a.condition;
    }
    EXPECT_GT(before, 1e11);
}

TEST(ChangeBasis, there_and_back_is_the_identity_where_the_numbers_are_exact) {
    for (int n = 1; n <= 13; ++n) {
        const auto b = must(PolynomialBasis::bernstein(n)), m = must(PolynomialBasis::monomial(n));
        const auto a = must(change_basis(b, m));
        for (double e : a.error) EXPECT_EQ(e, 0);  // integers
        std::vector<double> c(std::size_t(n) + 1, 0.0);
        c[std::size_t(n) / 2] = 1;
        const auto there = must(convert_coefficients(b, m, c, 1));
        std::vector<double> d;
        for (const Bounded& x : there.values) d.push_back(x.value);
        const auto back = must(convert_coefficients(m, b, d, 1));
        for (std::size_t i = 0; i < c.size(); ++i) EXPECT_EQ(back.values[i].value, c[i]);
    }
}

TEST(ChangeBasis, works_far_from_the_origin_and_with_repeated_newton_nodes) {
    const Interval on{1e6, 1e6 + 0.5};
    const auto b = must(PolynomialBasis::bernstein(12, on));
    const auto near = must(change_basis(b, must(PolynomialBasis::monomial(12, on.lo))));
    const auto far = must(change_basis(b, must(PolynomialBasis::monomial(12))));
    EXPECT_LT(near.condition, 1e12);
    EXPECT_GT(far.condition, 1e80);
    EXPECT_GT(far.relative_loss, 1);
    // Newton with all nodes equal are the monomials in the opposite order.
    const auto taylor = must(change_basis(must(PolynomialBasis::newton(std::vector<double>(13, on.lo))),
                                          must(PolynomialBasis::monomial(12, on.lo))));
    for (int i = 0; i <= 12; ++i)
        for (int j = 0; j <= 12; ++j) EXPECT_EQ(taylor(i, j), i + j == 12);
}

TEST(PolynomialBasis, refuses_what_is_no_basis_and_says_why) {
    const double inf = std::numeric_limits<double>::infinity();
    EXPECT_EQ(PolynomialBasis::monomial(26).error().kind, RefusalKind::unsupported);
    EXPECT_EQ(PolynomialBasis::bernstein(-1).error().where, "degree");
    EXPECT_EQ(PolynomialBasis::hermite(4).error().kind, RefusalKind::unsupported);
    EXPECT_EQ(PolynomialBasis::hermite(3, {1, 1}).error().where, "interval");
    EXPECT_EQ(PolynomialBasis::lagrange({0, 1, 0}).error().where, "lagrange[2]");
    EXPECT_EQ(PolynomialBasis::newton({0, inf}).error().where, "newton[1]");
    EXPECT_EQ(PolynomialBasis::lagrange({}).error().where, "degree");
    const auto knots = must(BSplineBasis::make(2, {0, 0, 0, 1, 1, 2, 2, 2}));
    EXPECT_EQ(PolynomialBasis::b_spline(knots, 3).error().where, "span");
    EXPECT_EQ(PolynomialBasis::b_spline(knots, 9).error().where, "span");
    EXPECT_EQ(
        change_basis(must(PolynomialBasis::monomial(2)), must(PolynomialBasis::monomial(3))).error().where,
        "degree");
    const auto huge = must(PolynomialBasis::monomial(25, 1e300)), small = must(PolynomialBasis::monomial(25));
    EXPECT_EQ(change_basis(huge, small).error().kind, RefusalKind::ill_conditioned);
    const std::vector<double> bad{1, inf, 2};
    EXPECT_EQ(
        convert_coefficients(must(PolynomialBasis::monomial(2)), must(PolynomialBasis::bernstein(2)), bad, 1)
            .error()
            .where,
        "coefficients[1]");
}

}  // namespace
}  // namespace freiform
