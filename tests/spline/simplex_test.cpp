#include "support/random.hpp"
#include "support/reference.hpp"
#include "support/triangle.hpp"

#include <freiform/spline/simplex.hpp>

#include <cmath>
#include <gtest/gtest.h>
#include <limits>

namespace freiform {
namespace {

using test::must;
using test::Random;
using test::random_triangle;
using test::Rational;

static_assert(Parametric<SimplexPatch<2, Vec<3>>, 2> && Parametric<SimplexPatch<2, Hom<3>>, 2>);

std::vector<Param<2>> parameters(Random& random, int between) {
    std::vector<Param<2>> all{{0, 0}, {1, 0}, {0, 1}, {0.5, 0.5}, {0, 0.3}, {0.7, 0}, {0.7, 0.3}, {0.1, 0.9}};
    for (int i = 0; i < between; ++i) {
        const double u = random.real(0, 1);
        all.push_back({u, random.real(0, 1 - u)});
    }
    return all;
}

// The definition, term by term, differentiated a times by u and b times by v, as exact numbers.
template <class P>
std::vector<Rational> homogeneous(const SimplexPatch<2, P>& s, const Param<2>& at, int a, int b) {
    const int n = s.degree();
    const Rational u(at[0]), v(at[1]), t(1 - u - v);
    const auto falling = [](int m, int k) {
        Rational f(1);
        for (int i = 0; i < k; ++i) f *= m - i;
        return f;
    };
    const auto power = [](const Rational& x, int k) {
        Rational p(1);
        for (int i = 0; i < k; ++i) p *= x;
        return p;
    };
    // d^m/dx^m of x^k.
    const auto monomial = [&](const Rational& x, int k, int m) {
        return m > k ? Rational(0) : falling(k, m) * power(x, k - m);
    };
    std::vector<Rational> sum(std::size_t(P::kCoords), Rational(0));
    for (int j = 0; j <= n; ++j)
        for (int k = 0; j + k <= n; ++k) {
            const int i = n - j - k;
            Rational w(0);
            for (int c = 0; c <= a; ++c)      // of the a derivatives by u, c fall on t
                for (int d = 0; d <= b; ++d)  // and d of those by v
                    w += Rational(binomial(a, c)) * Rational(binomial(b, d)) * ((c + d) % 2 ? -1 : 1) *
                         monomial(t, i, c + d) * monomial(u, j, a - c) * monomial(v, k, b - d);
            w *= Rational(binomial(n, j)) * Rational(binomial(n - j, k));
            for (int c = 0; c < P::kCoords; ++c) sum[std::size_t(c)] += w * Rational(s.coefficient(j, k)[c]);
        }
    return sum;
}

template <class P>
double largest_ratio(int n) {
    Random random(std::uint64_t(40 + n));
    double worst = 0;
    for (int round = 0; round < 2; ++round) {
        const auto s = random_triangle<P>(random, n);
        for (const auto& u : parameters(random, n > 9 ? 2 : 8)) {
            const auto exact = homogeneous(s, u, 0, 0);
            for (int c = 0; c < Space<P>::kDim; ++c) {
                const Rational x = Space<P>::kRational ? Rational(exact[std::size_t(c)] / exact.back())
                                                       : exact[std::size_t(c)];
                worst = std::max(worst, test::gap(s(u)[c], x) / s.value_error_bound());
            }
        }
    }
    return worst;
}

TEST(SimplexPatch, values_are_within_the_bound_of_exact_arithmetic) {
    std::printf("  largest observed / bound, polynomial and rational:\n");
    double over_all = 0;
    for (int n : {1, 2, 3, 4, 5, 6, 7, 8, 9, 15, 25}) {
        const double a = largest_ratio<Vec<3>>(n), b = largest_ratio<Hom<3>>(n);
        std::printf("  %2d  %.3f  %.3f\n", n, a, b);
        EXPECT_LE(a, 1);
        EXPECT_LE(b, 1);
        over_all = std::max({over_all, a, b});
    }
    EXPECT_GE(over_all, 0.05);
}

TEST(SimplexPatch, partials_agree_with_exact_arithmetic) {
    Random random(41);
    for (int n : {0, 1, 2, 3, 5}) {
        const auto s = random_triangle<Vec<3>>(random, n);
        for (const auto& u : parameters(random, 4)) {
            const auto all = s.derivatives(u, n + 1);
            for (const auto& o : jet_orders<2>(n + 1)) {
                const auto exact = homogeneous(s, u, o[0], o[1]);
                for (int c = 0; c < 3; ++c)
                    ASSERT_LT(test::gap(all[jet_slot(o)][c], exact[std::size_t(c)]), 1e-11);
            }
        }
    }
}

TEST(SimplexPatch, rational_partials_are_limits_of_differences) {
    Random random(42);
    for (int n : {1, 2, 4}) {
        const auto s = random_triangle<Hom<2>>(random, n);
        for (int k = 0; k < 5; ++k) {
            const Param<2> at{random.real(0.1, 0.4), random.real(0.1, 0.4)};
            const auto j = s.jet<3>(at);
            const double h = 0x1p-17;
            for (std::size_t axis = 0; axis < 2; ++axis) {
                Param<2> a = at, b = at;
                a[axis] -= h;
                b[axis] += h;
                const auto ja = s.jet<2>(a), jb = s.jet<2>(b);
                for (const auto& o : jet_orders<2>(2)) {
                    Index<2> up = o;
                    ++up[axis];
                    ASSERT_LT(norm((1 / (b[axis] - a[axis])) * (jb(o) - ja(o)) - j(up)),
                              1e-4 * (1 + norm(j(up))));
                }
            }
        }
    }
}

TEST(SimplexPatch, constants_stay_and_affine_maps_commute) {
    Random random(43);
    for (int n = 0; n <= 25; n += 5) {
        auto s = random_triangle<Vec<2>>(random, n);
        std::vector<Vec<2>> ones(s.coefficients().size(), Vec<2>{{1, -3}}), moved;
        for (const auto& p : s.coefficients()) moved.push_back({{2 * p[0] - p[1] + 5, p[0] + 3 * p[1]}});
        const auto one = must(SimplexPatch<2, Vec<2>>::make(n, ones)),
                   t = must(SimplexPatch<2, Vec<2>>::make(n, moved));
        for (const auto& u : parameters(random, 10)) {
            EXPECT_LT(test::distance(one(u), Vec<2>{{1, -3}}), 1e-14);
            const auto x = s(u);
            EXPECT_LT(test::distance(t(u), Vec<2>{{2 * x[0] - x[1] + 5, x[0] + 3 * x[1]}}), 1e-13);
        }
    }
}

TEST(SimplexPatch, corners_and_edges_are_where_the_drawing_says) {
    Random random(44);
    const auto s = random_triangle<Hom<3>>(random, 4);
    EXPECT_EQ(s(0, 0), project(s.coefficients()[0]));
    EXPECT_EQ(s(1, 0), project(s.coefficient(4, 0)));
    EXPECT_EQ(s(0, 1), project(s.coefficients().back()));
    EXPECT_EQ(s.slot(2, 0), 3u);
    EXPECT_EQ(s.slot(1, 1), 4u);
    for (double t : {0.0, 0.25, 0.6, 1.0}) {
        EXPECT_LT(test::distance(boundary(s, 0)(t), s(1 - t, t)), 1e-14);
        EXPECT_LT(test::distance(boundary(s, 1)(t), s(0, 1 - t)), 1e-14);
        EXPECT_LT(test::distance(boundary(s, 2)(t), s(t, 0)), 1e-14);
    }
}

template <class P>
void expect_identities(Random& random, int n) {
    const auto s = random_triangle<P>(random, n);
    const auto us = parameters(random, 10);
    if (n < kMaxDegree) {
        const auto up = must(elevate(s));
        for (const auto& u : us) ASSERT_LT(test::distance(up(u), s(u)), 1e-13);
    } else {
        EXPECT_EQ(elevate(s).error().kind, RefusalKind::unsupported);
    }
    const auto expect_part = [&](const SimplexPatch<2, P>& part, const std::array<Param<2>, 3>& corner) {
        for (const auto& t : us) {
            Param<2> u{};
            for (std::size_t d = 0; d < 2; ++d)
                u[d] = (1 - t[0] - t[1]) * corner[0][d] + t[0] * corner[1][d] + t[1] * corner[2][d];
            ASSERT_LT(test::distance(part(t), s(u)), 1e-12);
        }
    };
    constexpr Param<2> c1{0, 0}, c2{1, 0}, c3{0, 1}, m12{0.5, 0}, m31{0, 0.5}, m23{0.5, 0.5};
    const Param<2> x{random.real(0, 0.5), random.real(0, 0.5)}, y{random.real(0, 0.5), 0.25};
    const auto three = split_at(s, x);
    expect_part(three[0], {x, c2, c3});
    expect_part(three[1], {c1, x, c3});
    expect_part(three[2], {c1, c2, x});
    const auto four = split_in_four(s);
    expect_part(four[0], {c1, m12, m31});
    expect_part(four[1], {m12, c2, m23});
    expect_part(four[2], {m31, m23, c3});
    expect_part(four[3], {m23, m31, m12});
    // Neighbours have the same coefficients along the edge between them, to the bit.
    const auto inner = boundary(four[3], 0).net(), outer = boundary(four[0], 0).net();
    for (int a = 0; a <= n; ++a) ASSERT_EQ(inner.flat()[std::size_t(a)], outer.flat()[std::size_t(n - a)]);
    expect_part(restrict_to(s, {x, y, c3}), {x, y, c3});
}

TEST(SimplexPatch, elevation_and_subdivision_leave_the_map_unchanged) {
    Random random(45);
    for (int n : {0, 1, 2, 3, 5, 9, 25}) {
        expect_identities<Vec<3>>(random, n);
        expect_identities<Hom<2>>(random, n);
    }
}

TEST(SimplexPatch, scaling_by_powers_of_two_scales_to_the_bit) {
    Random random(46);
    const auto s = random_triangle<Hom<3>>(random, 5);
    for (int k = -900; k <= 900; k += 300) {
        std::vector<Hom<3>> b(s.coefficients().begin(), s.coefficients().end());
        for (auto& p : b)
            for (int c = 0; c < 3; ++c) p[c] = std::scalbn(p[c], k);
        const auto t = must(SimplexPatch<2, Hom<3>>::make(5, b));
        EXPECT_EQ(t.value_error_bound(), std::scalbn(s.value_error_bound(), k));
        for (const auto& u : parameters(random, 5)) {
            for (int c = 0; c < 3; ++c) ASSERT_EQ(t(u)[c], std::scalbn(s(u)[c], k));
            if (std::abs(k) <= 300) {
                ASSERT_EQ(must(normal(t, u)), must(normal(s, u)));
            }
        }
    }
}

TEST(SimplexPatch, the_normal_of_an_octant_is_its_point) {
    // f = (u, v, 1 - u - v) has the normal (1, 1, 1) / sqrt 3; the tangents of a collapsed triangle have
    // none.
    const auto flat = must(SimplexPatch<2, Vec<3>>::make(1, {{{0, 0, 1}}, {{1, 0, 0}}, {{0, 1, 0}}}));
    EXPECT_LT(test::distance(must(normal(flat, {0.2, 0.3})), (1 / std::sqrt(3.0)) * Vec<3>{{1, 1, 1}}),
              1e-15);
    const auto line =
        must(SimplexPatch<2, Vec<3>>::make(1, {{{0.1, 0.2, 0.3}}, {{0.2, 0.4, 0.6}}, {{0.7, 1.4, 2.1}}}));
    const auto none = normal(line, {0.2, 0.3});
    ASSERT_FALSE(none.has_value());
    EXPECT_EQ(none.error().kind, RefusalKind::ill_conditioned);
    EXPECT_EQ(normal(flat, {0.8, 0.3}).error().kind, RefusalKind::out_of_domain);
}

TEST(SimplexPatch, refuses_what_is_no_triangle_and_parameters_outside) {
    using S = SimplexPatch<2, Hom<1>>;
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const auto where = [](int n, std::vector<Hom<1>> b) {
        const auto r = S::make(n, std::move(b));
        return r ? std::string("accepted") : text(name_of(r.error().kind), " ", r.error().where);
    };
    const Hom<1> one{{1, 1}};
    EXPECT_EQ(where(1, {one, one, one}), "accepted");
    EXPECT_EQ(where(0, {one}), "accepted");
    EXPECT_EQ(where(-1, {}), "invalid degree");
    EXPECT_EQ(where(26, std::vector(378, one)), "unsupported degree");
    EXPECT_EQ(where(2, {one, one, one}), "invalid points");
    EXPECT_EQ(where(1, {one, {{nan, 1}}, one}), "nonfinite points[1]");
    EXPECT_EQ(where(1, {one, one, {{1, 0}}}), "invalid weights[2]");
    const auto s = must(S::make(1, {one, one, one}));
    Param<2> at[] = {{0.25, 0.5}, {0.25, 0.5}, {0.25, 0.5}};
    Vec<1> out[3];
    Jet<2, 1, Vec<1>> jets[3];
    EXPECT_TRUE(s.evaluate(at, out).has_value());
    at[2] = {0.5, 0.75};
    EXPECT_EQ(s.evaluate(at, out).error().where, "at[2]");
    EXPECT_EQ(s.evaluate<1>(at, jets).error().kind, RefusalKind::out_of_domain);
    at[1] = {0, nan};
    EXPECT_EQ(s.evaluate(at, out).error().where, "at[1][1]");
    EXPECT_EQ(s.evaluate<1>(at, jets).error().kind, RefusalKind::nonfinite);
    // Six times the third difference of coefficients near the largest double.
    std::vector<Vec<1>> steep(10, Vec<1>{{0x1p1022}});
    for (std::size_t i = 0; i < 10; i += 2) steep[i][0] *= -1;
    const auto t = must(SimplexPatch<2, Vec<1>>::make(3, steep));
    Jet<2, 3, Vec<1>> high[1];
    EXPECT_EQ(t.evaluate<3>(std::span(at, 1), high).error().kind, RefusalKind::ill_conditioned);
}

}  // namespace
}  // namespace freiform
