#include "poly/roots_detail.hpp"

#include <freiform/poly/roots.hpp>

#include <chrono>
#include <cstdio>
#include <gtest/gtest.h>
#include <support/random.hpp>
#include <support/sturm.hpp>

namespace freiform::test {
namespace {

using Doubles = std::vector<double>;

// Bernstein coefficients of a product.
Doubles product(const Doubles& a, const Doubles& b) {
    const std::size_t m = a.size() - 1, n = b.size() - 1;
    Doubles c(m + n + 1);
    const auto choose = [](std::size_t p, std::size_t q) {
        double r = 1;
        for (std::size_t i = 1; i <= q; ++i) r = r * double(p - q + i) / double(i);
        return r;
    };
    for (std::size_t i = 0; i <= m; ++i)
        for (std::size_t j = 0; j <= n; ++j)
            c[i + j] += choose(m, i) * choose(n, j) / choose(m + n, i + j) * a[i] * b[j];
    return c;
}
// scale (t - x), and powers of it
Doubles linear(double x, double scale = 1) { return {-x * scale, (1 - x) * scale}; }
Doubles power(const Doubles& a, int k) {
    Doubles p{1};
    for (int i = 0; i < k; ++i) p = product(p, a);
    return p;
}
Doubles product(std::initializer_list<Doubles> all) {
    Doubles p{1};
    for (const Doubles& a : all) p = product(p, a);
    return p;
}

// The answer holds exactly: every root is in one interval, every interval has what it says.
void expect_right(const Doubles& parts, int terms, const RealRoots& found, double width) {
    const Polynomial p = power_form(parts, terms);
    if (p.empty()) {
        EXPECT_EQ(found.kind, RootsKind::zero);
        return;
    }
    ASSERT_EQ(found.kind, RootsKind::isolated);
    const RootCount exact(p);
    int distinct = 0, all = 0;
    double last = -1;
    for (const Root& r : found.roots) {
        ASSERT_LE(last, r.at.lo);
        ASSERT_LE(r.at.lo, r.at.hi);
        last = r.at.hi;
        ASSERT_EQ(r.least, r.most);
        all += r.most;
        ++distinct;
        if (r.at.lo == r.at.hi) {
            EXPECT_EQ(exact.multiplicity_at(r.at.lo), r.most);
            EXPECT_TRUE(r.is_one);
        } else if (r.is_one) {
            EXPECT_LE(r.at.length(), std::max(width, std::nextafter(r.at.hi, 2) - r.at.hi)) << r.at.lo;
            const bool end = exact.multiplicity_at(r.at.hi) > 0;
            EXPECT_EQ(exact.distinct(r.at.lo, r.at.hi) - end, 1);
            EXPECT_EQ(exact.with_multiplicity(r.at.lo, r.at.hi) - exact.multiplicity_at(r.at.hi), r.most);
            EXPECT_EQ(r.before, sign_at(p, r.at.lo) == 0 ? r.before : sign_at(p, r.at.lo));
            EXPECT_EQ(r.after, sign_at(p, r.at.hi) == 0 ? r.after : sign_at(p, r.at.hi));
        } else {
            EXPECT_LE(r.at.length(), kRootResolution);
            EXPECT_EQ(exact.with_multiplicity(r.at.lo, r.at.hi), r.most);
            distinct += exact.distinct(r.at.lo, r.at.hi) - 1;
        }
    }
    const int at_zero = exact.multiplicity_at(0);
    EXPECT_EQ(exact.with_multiplicity(0, 1) + at_zero, all);
    EXPECT_EQ(exact.distinct(0, 1) + (at_zero > 0), distinct);
}

void check(const Doubles& c, double width = 1e-12) {
    SCOPED_TRACE(testing::PrintToString(c));
    expect_right(c, 1, must(real_roots(c, width)), width);
}

TEST(Roots, of_ten_thousand_random_polynomials_agree_with_sturm) {
    Random random(101);
    int count = 0, deepest[3] = {0, 0, 0};
    for (int k = 0; k < 10000; ++k) {
        const int n = random.integer(1, k % 100 == 0 ? 16 : 5);
        Doubles c;
        // Small whole numbers meet in multiple roots and in roots at the ends.
        const bool whole = k % 4 != 0;
        for (int i = 0; i <= n; ++i) c.push_back(whole ? random.integer(-3, 3) : random.real(-1, 1));
        const double width = k % 3 == 0 ? 0 : 1e-10;
        const RealRoots found = must(real_roots(c, width));
        SCOPED_TRACE(testing::PrintToString(c));
        expect_right(c, 1, found, width);
        if (HasFatalFailure()) return;
        count += int(found.roots.size());
        ++deepest[int(found.deepest)];
    }
    std::printf("%d roots; decided in doubles %d, double-double %d, integers %d\n", count, deepest[0],
                deepest[1], deepest[2]);
    EXPECT_GT(count, 5000);
    EXPECT_LT(deepest[1] + deepest[2], 2500);
}

TEST(Roots, of_nasty_polynomials_agree_with_sturm) {
    Random random(102);
    int cases = 0;
    const auto nasty = [&](const Doubles& c) {
        check(c);
        ++cases;
    };
    for (int k = 0; k < 20; ++k) {
        const double x = random.integer(1, 63) / 64.0, y = random.integer(1, 63) / 64.0;
        nasty(product({linear(x), linear(x), linear(y)}));            // touches
        nasty(product({power(linear(x), 3), linear(y)}));             // crosses flatly
        nasty(product({linear(0), power(linear(1), 2), linear(y)}));  // at the ends
        nasty(product({linear(x), linear(x + 1e-12), linear(y)}));    // nearly touches
        nasty(product({linear(x), linear(x), Doubles{1, 1.5}, Doubles{2, 1}}));
        Doubles near = power(linear(x), 2);  // misses by 1e-12, and crosses twice
        for (double& c : near) c += k % 2 == 0 ? 1e-12 : -1e-12;
        nasty(near);
        for (double& c : near) c += k % 2 == 0 ? -2e-12 : 2e-12;
        nasty(near);
        nasty(product({linear(random.real(0, 1)), linear(random.real(0, 1)), linear(random.real(0, 1)),
                       linear(random.real(0, 1)), linear(random.real(0, 1))}));
        const double z = random.real(0.1, 0.9);  // a cluster of four
        nasty(product({linear(z), linear(z + 1e-9), linear(z - 1e-9), linear(z + 3e-9)}));
        nasty(power(linear(x, 1e-30), random.integer(4, 7)));  // flat
    }
    EXPECT_GE(cases, 200);
}

TEST(Roots, of_wilkinson_mignotte_and_high_degrees_agree_with_sturm) {
    Doubles wilkinson{1};
    for (int i = 1; i <= 16; ++i) wilkinson = product(wilkinson, linear(i / 17.0));
    check(wilkinson);
    // x^n - 2 (a x - 1)^2 with x = t / (1 - t): two roots very near to 1 / a.
    for (const int n : {8, 14, 20}) {
        Doubles c(std::size_t(n) + 1);
        const double a = 40;
        double choose = 1;
        for (int i = 0; i <= n; ++i) {
            const double s = i == 0 ? -2 : i == 1 ? 4 * a : i == 2 ? -2 * a * a : i == n ? 1 : 0;
            c[std::size_t(i)] = s / choose;
            choose = choose * (n - i) / (i + 1);
        }
        check(c);
    }
    check(power(linear(0.5), 25));
    check(product({power(linear(0.25), 5), power(linear(0.5), 4), power(linear(0.75), 3)}));
    Random random(103);
    for (int k = 0; k < 2; ++k) {
        Doubles c;
        for (int i = 0; i <= 40; ++i) c.push_back(random.real(-1, 1));
        check(c);
    }
}

TEST(Roots, at_degree_75_are_found_where_they_were_put) {
    // (8 t - k) for k = 1 .. 7, each 25 / 7 times or so, times polynomials without roots.
    Doubles c{1};
    for (int i = 0; i < 25; ++i) c = product(c, linear((1 + i % 7) / 8.0, 8));
    for (int i = 0; i < 25; ++i) c = product(c, Doubles{1, 0.5, 1});
    ASSERT_EQ(c.size(), 76u);
    const RealRoots found = must(real_roots(c, 1e-9, 1e-13));  // the product was rounded
    int least = 0, most = 0;
    for (const Root& r : found.roots) least += r.least, most += r.most;
    EXPECT_GE(most, 25);
    EXPECT_LE(least, 25);
    for (int k = 1; k <= 7; ++k) {
        bool has = false;
        for (const Root& r : found.roots) has = has || r.at.contains(k / 8.0);
        EXPECT_TRUE(has) << k;
    }
}

TEST(Roots, of_sums_are_those_of_the_exact_sums) {
    Random random(104);
    for (int k = 0; k < 500; ++k) {
        const int n = random.integer(1, 4), terms = random.integer(2, 6);
        Doubles parts;
        for (int i = 0; i < (n + 1) * terms; ++i)
            parts.push_back(std::scalbn(random.integer(-2, 2), -20 * (i % terms)));
        if (k % 5 == 0)  // sums that cancel
            for (int j = 0; j < terms; ++j)
                parts[std::size_t(j)] = j % 2 == 0 && j + 1 < terms ? 1 : j % 2 ? -1 : 0;
        SCOPED_TRACE(testing::PrintToString(parts));
        expect_right(parts, terms, must(real_roots_of_sums(parts, terms, 1e-12)), 1e-12);
    }
}

TEST(Roots, of_uncertain_coefficients_hold_for_all_polynomials_within_the_error) {
    Random random(105);
    int possible = 0;
    for (int k = 0; k < 400; ++k) {
        const double x = random.real(0.1, 0.9);
        Doubles c = k % 2 == 0 ? product({linear(x), linear(x), linear(random.real(-1, 2))})
                               : product({linear(random.real(0, 1)), linear(random.real(0, 1)), linear(x)});
        const double error = std::exp2(random.real(-40, -12));
        const RealRoots found = must(real_roots(c, 1e-12, error));
        for (int trial = 0; trial < 5; ++trial) {
            Doubles d = c;
            for (double& y : d) y += random.integer(-1, 1) * error;
            const RootCount exact(power_form(d));
            int all = 0;
            for (const Root& r : found.roots) {
                const int at_lo = exact.multiplicity_at(r.at.lo);
                const int n = exact.with_multiplicity(r.at.lo, r.at.hi) + at_lo;
                EXPECT_LE(r.least, n);
                EXPECT_LE(n, r.most);
                all += n;
            }
            EXPECT_EQ(all, exact.with_multiplicity(0, 1) + exact.multiplicity_at(0));
        }
        for (const Root& r : found.roots) possible += !r.is_certain();
    }
    EXPECT_GT(possible, 50);
}

TEST(Roots, that_touch_within_the_error_are_possible_and_not_certain) {
    const RealRoots found = must(real_roots(Doubles{0.25, -0.25, 0.25}, 1e-12, 1e-9));  // (t - 1/2)^2
    ASSERT_EQ(found.roots.size(), 1u);
    const Root& r = found.roots[0];
    EXPECT_TRUE(r.at.contains(0.5));
    EXPECT_LT(r.at.length(), 3e-4);
    EXPECT_EQ(r.least, 0);
    EXPECT_EQ(r.most, 2);
    EXPECT_EQ(r.before, 1);
    EXPECT_EQ(r.after, 1);
}

TEST(Roots, of_zero_and_of_polynomials_that_may_be_zero_are_reported_as_such) {
    EXPECT_EQ(must(real_roots(Doubles{0, 0, 0}, 1e-9)).kind, RootsKind::zero);
    EXPECT_EQ(must(real_roots(Doubles{1e-9, -1e-9}, 1e-9, 1e-8)).kind, RootsKind::possibly_zero);
    EXPECT_EQ(must(real_roots_of_sums(Doubles{1, -1, 0.5, -0.5}, 2, 1e-9)).kind, RootsKind::zero);
    EXPECT_EQ(must(real_roots(Doubles{0.0}, 1e-9)).kind, RootsKind::zero);
    EXPECT_TRUE(must(real_roots(Doubles{2.0}, 1e-9)).roots.empty());
}

TEST(Roots, are_the_same_after_scaling_by_powers_of_two) {
    const Doubles c{1, -2, 1.5, -0.3, 0.7};
    const RealRoots once = must(real_roots(c, 1e-13));
    for (const int e : {-1060, -900, -3, 900}) {
        Doubles scaled;
        for (const double x : c) scaled.push_back(std::scalbn(x, e));
        if (e == -1060) {  // 0.3 and 0.7 lose bits there
            check(scaled);
            continue;
        }
        EXPECT_EQ(must(real_roots(scaled, 1e-13)).roots, once.roots);
    }
    check({0x1p-1074, -0x1p1000, 1, -0x1p-500, 0x1p900});
}

TEST(Roots, refuse_what_is_no_question) {
    EXPECT_EQ(real_roots(Doubles{}, 0.1).error().kind, RefusalKind::invalid);
    EXPECT_EQ(real_roots(Doubles{1, NAN}, 0.1).error().where, "coefficients[1]");
    EXPECT_EQ(real_roots(Doubles{1, 2}, -1).error().where, "width");
    EXPECT_EQ(real_roots(Doubles{1, 2}, 0, -1).error().where, "error");
    EXPECT_EQ(real_roots(Doubles(102, 1.0), 0).error().kind, RefusalKind::unsupported);
    EXPECT_EQ(real_roots_of_sums(Doubles{1, 2, 3}, 2, 0).error().kind, RefusalKind::invalid);
}

TEST(Integer, arithmetic_agrees_with_a_library) {
    Random random(106);
    using detail::Integer;
    const auto make = [&](int limbs, Whole& reference) {
        Integer x;
        reference = 0;
        for (int i = 0; i < limbs; ++i) {
            const int kind = random.integer(0, 3);
            const std::uint32_t limb = kind == 0   ? 0
                                       : kind == 1 ? 0xffffffffu
                                                   : std::uint32_t(random.integer(0, 0x7fffffff)) * 2u + 1u;
            x = detail::shifted_left(x, 32) + detail::integer(limb);
            reference = (reference << 32) + limb;
        }
        if (random.chance(0.5)) x = detail::negated(x), reference = -reference;
        return x;
    };
    const auto same = [](const Integer& x, const Whole& y) {
        Whole z = 0;
        for (std::size_t i = x.limb.size(); i-- > 0;) z = (z << 32) + x.limb[i];
        return (x.negative ? Whole(-z) : z) == y && (x.limb.empty() ? !x.negative : x.limb.back() != 0);
    };
    for (int k = 0; k < 3000; ++k) {
        Whole a, b;
        const Integer x = make(random.integer(0, 7), a), y = make(random.integer(0, 5), b);
        ASSERT_TRUE(same(x + y, a + b));
        ASSERT_TRUE(same(x - y, a - b));
        ASSERT_TRUE(same(x * y, a * b));
        ASSERT_TRUE(same(detail::gcd(x, y), gcd(a, b)));
        if (b == 0) continue;
        const auto d = detail::divided(x, y);
        ASSERT_TRUE(same(d.quotient, a / b)) << a << " / " << b;
        ASSERT_TRUE(same(d.remainder, a % b)) << a << " % " << b;
    }
}

TEST(Roots, of_a_cubic_take_about_a_microsecond) {
    Random random(107);
    std::vector<std::array<double, 4>> all(20000);
    for (auto& c : all)
        for (double& x : c) x = random.real(-1, 1);
    std::size_t count = 0;
    const auto begin = std::chrono::steady_clock::now();
    for (const auto& c : all) count += must(real_roots(c, 1e-12)).roots.size();
    const double ns =
        std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - begin).count();
    std::printf("%.0f ns per cubic, %zu roots\n", ns / double(all.size()), count);
    EXPECT_GT(count, 10000u);
}

}  // namespace
}  // namespace freiform::test
