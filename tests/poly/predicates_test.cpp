#include "poly/predicates_detail.hpp"

#include <freiform/core/text.hpp>
#include <freiform/poly/predicates.hpp>

#include <boost/multiprecision/cpp_int.hpp>
#include <gtest/gtest.h>
#include <limits>
#include <random>

namespace freiform {
namespace {

using boost::multiprecision::cpp_int;

// The reference: the same determinants in another library's integers.
template <std::size_t N>
int exact_sign(const detail::PlanePoints<N>& p) {
    int least = 5000;
    for (const auto& q : p)
        for (const double x : q.c)
            if (x != 0) least = std::min(least, std::max(std::ilogb(x), -1022) - 52);
    const auto whole = [&](double x) {
        if (x == 0) return cpp_int(0);
        const int e = std::max(std::ilogb(x), -1022) - 52;
        return cpp_int(static_cast<long long>(std::scalbn(x, -e))) * (cpp_int(1) << (e - least));
    };
    std::array<std::array<cpp_int, 2>, N - 1> v;
    for (std::size_t i = 0; i + 1 < N; ++i)
        for (std::size_t k = 0; k < 2; ++k) v[i][k] = whole(p[i].c[k]) - whole(p[N - 1].c[k]);
    const auto minor = [&](int i, int j) -> cpp_int { return v[i][0] * v[j][1] - v[i][1] * v[j][0]; };
    if constexpr (N == 3) {
        return minor(0, 1).sign();
    } else {
        const auto lift = [&](int i) -> cpp_int { return v[i][0] * v[i][0] + v[i][1] * v[i][1]; };
        const cpp_int d = lift(0) * minor(1, 2) + lift(1) * minor(2, 0) + lift(2) * minor(0, 1);
        return d.sign();
    }
}

template <std::size_t N>
int sign(const detail::PlanePoints<N>& p) {
    if constexpr (N == 3) return orient2d(p[0], p[1], p[2]);
    if constexpr (N == 4) return in_circle(p[0], p[1], p[2], p[3]);
}

struct Tally {
    int filter = 0, expansion = 0, integer = 0, zero = 0, wrong = 0;
};

// Holds the predicate, and each stage that has an answer, against the reference.
template <std::size_t N>
void check(const detail::PlanePoints<N>& p, Tally& tally) {
    const int want = exact_sign(p);
    const auto filtered = detail::filtered_sign(p), expanded = detail::expansion_sign(p);
    ++(filtered ? tally.filter : expanded ? tally.expansion : tally.integer);
    tally.zero += want == 0;
    tally.wrong += sign(p) != want || (filtered && *filtered != want) || (expanded && *expanded != want) ||
                   detail::integer_sign(p) != want;
}

void print(const char* what, const Tally& t) {
    std::printf("  %-44s filter %6d  expansions %6d  integers %6d  (zero %6d)\n", what, t.filter, t.expansion,
                t.integer, t.zero);
}

double nudged(double x, int steps) {
    for (; steps > 0; --steps) x = std::nextafter(x, std::numeric_limits<double>::infinity());
    for (; steps < 0; ++steps) x = std::nextafter(x, -std::numeric_limits<double>::infinity());
    return x;
}

// Generators of hard cases. `range` is the spread of exponents, around `centre`.
struct Cases {
    std::mt19937_64 random;
    int integer(int lo, int hi) { return lo + int(random() % std::uint64_t(hi - lo + 1)); }
    double mantissa() { return double(std::int64_t(random()) >> 11); }
    double any(int centre, int range) {
        return std::scalbn(mantissa(), centre + integer(-range, range) - 52);
    }
    template <std::size_t N>
    detail::PlanePoints<N> scattered(int centre, int range) {
        detail::PlanePoints<N> p;
        for (auto& q : p) q = {{any(centre, range), any(centre, range)}};
        return p;
    }
    template <std::size_t N>
    detail::PlanePoints<N> grid(int size, int exponent) {
        detail::PlanePoints<N> p;
        for (auto& q : p)
            q = {{std::scalbn(double(integer(-size, size)), exponent),
                  std::scalbn(double(integer(-size, size)), exponent)}};
        return p;
    }
    // Three points of a line, or four of a circle, rounded, and moved by a few units in the last place.
    template <std::size_t N>
    detail::PlanePoints<N> nearly_degenerate(int exponent) {
        detail::PlanePoints<N> p;
        const double x = mantissa() / 0x1p52, y = mantissa() / 0x1p52, turn = mantissa() / 0x1p50;
        for (auto& q : p) {
            const double t = mantissa() / 0x1p51;
            q = N == 3 ? Vec<2>{{x + t * std::cos(turn), y + t * std::sin(turn)}}
                       : Vec<2>{{x + turn * std::cos(t), y + turn * std::sin(t)}};
            for (double& c : q.c) c = std::scalbn(nudged(c, integer(-2, 2)), exponent);
        }
        return p;
    }
};

template <std::size_t N>
int wrong_answers(int n, const char* name) {
    Cases cases{std::mt19937_64(N)};
    int wrong = 0;
    const auto tally = [&](const char* what, auto make, int count) {
        Tally t;
        for (int i = 0; i < count; ++i) check<N>(make(), t);
        print(what, t);
        wrong += t.wrong;
    };
    std::printf("%s\n", name);
    tally(
        "scattered", [&] { return cases.scattered<N>(0, 2); }, n);
    tally(
        "scattered, exponents +-20", [&] { return cases.scattered<N>(0, 20); }, n);
    tally(
        "scattered, exponents +-1000", [&] { return cases.scattered<N>(0, 1000); }, n / 8);
    tally(
        "scattered about 2^1000", [&] { return cases.scattered<N>(1000, 20); }, n);
    tally(
        "scattered about 2^-1000 (subnormal too)", [&] { return cases.scattered<N>(-1000, 60); }, n);
    tally(
        "grid", [&] { return cases.grid<N>(5, 0); }, n);
    for (const int size : {1000, 2047, 4095, 1 << 20, 1 << 26, 1 << 28})
        tally(
            text("grid of ", size).c_str(), [&] { return cases.grid<N>(size, -20); }, n / 2);
    tally(
        "grid of step 2^-1074", [&] { return cases.grid<N>(5, -1074); }, n);
    tally(
        "grid of step 2^1000", [&] { return cases.grid<N>(5, 1000); }, n);
    tally(
        "nearly degenerate", [&] { return cases.nearly_degenerate<N>(0); }, n);
    tally(
        "nearly degenerate, 2^900", [&] { return cases.nearly_degenerate<N>(900); }, n);
    tally(
        "nearly degenerate, 2^-1040", [&] { return cases.nearly_degenerate<N>(-1040); }, n);
    // One coordinate far away from the others in size, at the two edges of the exactness windows.
    for (const int apart : {400, 466, 467, 900, 960, 961, 1500})
        tally(
            text("one coordinate 2^-", apart).c_str(),
            [&] {
                auto p = cases.nearly_degenerate<N>(1000);
                p[std::size_t(cases.integer(0, int(N) - 1))][cases.integer(0, 1)] =
                    cases.any(1000 - apart, 3);
                return p;
            },
            n / 16);
    return wrong;
}

TEST(Predicates, orient2d_is_never_wrong) { EXPECT_EQ(wrong_answers<3>(24000, "orient2d"), 0); }
TEST(Predicates, corners_of_rectangles_are_on_a_circle_and_nothing_beside_them_is) {
    const double x[2] = {0.1, 0.7}, y[2] = {-3.3, 1e-5};
    std::array<Vec<2>, 4> p{{{{x[0], y[0]}}, {{x[1], y[0]}}, {{x[1], y[1]}}, {{x[0], y[1]}}}};
    std::array<int, 4> order{0, 1, 2, 3};
    do {
        const auto at = [&](std::size_t i) { return p[std::size_t(order[i])]; };
        EXPECT_EQ(in_circle(at(0), at(1), at(2), at(3)), 0);
        for (int k = 0; k < 2; ++k)  // two pairs are equal in one coordinate, and one pair in the other
            for (const double to : {-9.0, 9.0}) {
                Vec<2> q = at(3);
                q[k] = std::nextafter(q[k], to);
                const int s = in_circle(at(0), at(1), at(2), q);
                EXPECT_NE(s, 0);
                EXPECT_EQ(s, detail::integer_sign({at(0), at(1), at(2), q}));
            }
    } while (std::next_permutation(order.begin(), order.end()));
}

TEST(Predicates, short_differences_from_anywhere_are_signed_without_expansions) {
    Cases cases{std::mt19937_64(7)};
    for (int i = 0; i < 20000; ++i) {
        // Half of them on one circle: images of a point under the symmetries of the grid.
        const Vec<2> from{{cases.integer(-500, 500) * 0x1p-10, cases.integer(-500, 500) * 0x1p-10}};
        auto p = cases.grid<4>(900, -20);
        if (i % 2) {
            const double x = p[0][0], y = p[0][1];
            p = {{{{x, y}}, {{-y, x}}, {{y, x}}, {{-x, y}}}};
        }
        for (Vec<2>& q : p) q += from;
        ASSERT_TRUE(detail::filtered_sign(p));
        ASSERT_EQ(*detail::filtered_sign(p), exact_sign(p));
        const detail::PlanePoints<3> line{p[0], 0.5 * (p[0] + p[1]), p[1]};
        ASSERT_TRUE(detail::filtered_sign(line));
        ASSERT_EQ(*detail::filtered_sign(line), 0);
    }
}

TEST(Predicates, in_circle_is_never_wrong) { EXPECT_EQ(wrong_answers<4>(8000, "in_circle"), 0); }

// Rotating the points keeps the sign, swapping two reverses it.
TEST(Predicates, signs_follow_permutations) {
    Cases cases{std::mt19937_64(5)};
    for (int i = 0; i < 20000; ++i) {
        const auto [a, b, c] = i % 2 ? cases.nearly_degenerate<3>(0) : cases.scattered<3>(0, 1000);
        const int s = orient2d(a, b, c);
        ASSERT_EQ(orient2d(b, c, a), s);
        ASSERT_EQ(orient2d(b, a, c), -s);
    }
    for (int i = 0; i < 5000; ++i) {
        const auto [a, b, c, d] = i % 2 ? cases.nearly_degenerate<4>(0) : cases.scattered<4>(0, 300);
        const int s = in_circle(a, b, c, d);
        ASSERT_EQ(in_circle(b, c, a, d), s);
        ASSERT_EQ(in_circle(b, a, c, d), -s);
        ASSERT_EQ(in_circle(b, c, d, a), -s);
    }
}

TEST(Predicates, named_hard_cases) {
    const double tiny = std::numeric_limits<double>::denorm_min(), huge = std::numeric_limits<double>::max();
    EXPECT_EQ(orient2d({{0, 0}}, {{1e300, 1e-300}}, {{1e300, 0}}), -1);
    EXPECT_EQ(orient2d({{-huge, -huge}}, {{huge, huge}}, {{0, tiny}}), 1);
    EXPECT_EQ(orient2d({{-huge, -huge}}, {{huge, huge}}, {{tiny, 0}}), -1);
    EXPECT_EQ(orient2d({{-huge, -huge}}, {{huge, huge}}, {{tiny, tiny}}), 0);
    EXPECT_EQ(in_circle({{-huge, 0}}, {{huge, 0}}, {{0, huge}}, {{0, -huge}}), 0);
    EXPECT_EQ(in_circle({{-huge, 0}}, {{huge, 0}}, {{0, huge}}, {{tiny, -huge}}), -1);
    EXPECT_EQ(in_circle({{-huge, 0}}, {{huge, 0}}, {{0, huge}}, {{tiny, tiny}}), 1);
    EXPECT_EQ(in_circle({{0, 0}}, {{tiny, 0}}, {{tiny, tiny}}, {{0, tiny}}), 0);
}

TEST(Predicates, coordinates_that_are_not_finite_answer_zero) {
    const double inf = std::numeric_limits<double>::infinity(),
                 nan = std::numeric_limits<double>::quiet_NaN();
    for (const double x : {inf, -inf, nan})
        for (int i = 0; i < 8; ++i) {
            detail::PlanePoints<4> p{{{{0, 0}}, {{1, 0}}, {{1, 1}}, {{0, 2}}}};
            p[std::size_t(i / 2)][i % 2] = x;
            EXPECT_EQ(in_circle(p[0], p[1], p[2], p[3]), 0);
            if (i >= 6) continue;
            EXPECT_EQ(orient2d(p[0], p[1], p[2]), 0);
            EXPECT_FALSE(is_between(p[0], p[1], p[2]));
        }
}

TEST(Predicates, is_between_means_the_open_segment) {
    const Vec<2> a{{1, 1}}, b{{4, 7}};
    EXPECT_TRUE(is_between(a, b, {{2, 3}}));
    EXPECT_TRUE(is_between(b, a, {{2, 3}}));
    EXPECT_FALSE(is_between(a, b, {{2, nudged(3, 1)}}));
    EXPECT_FALSE(is_between(a, b, a));
    EXPECT_FALSE(is_between(a, b, b));
    EXPECT_FALSE(is_between(a, b, {{5, 9}}));
    EXPECT_FALSE(is_between(a, a, a));
    EXPECT_TRUE(is_between({{3, -1}}, {{3, 1}}, {{3, 0}}));
    EXPECT_FALSE(is_between({{3, -1}}, {{3, 1}}, {{3, 2}}));
}

TEST(Predicates, segments_cross_in_their_interiors_only) {
    const Vec<2> a{{0, 0}}, b{{4, 4}};
    EXPECT_TRUE(segments_cross(a, b, {{0, 4}}, {{4, 0}}));
    EXPECT_FALSE(segments_cross(a, b, {{0, 4}}, {{2, 2}}));  // an end of the second on the first
    EXPECT_FALSE(segments_cross(a, b, b, {{4, 0}}));         // a common end
    EXPECT_FALSE(segments_cross(a, b, {{1, 1}}, {{5, 5}}));  // overlap
    EXPECT_FALSE(segments_cross(a, b, {{0, 9}}, {{9, 0}}));  // line crosses, segment does not
    EXPECT_TRUE(segments_cross(a, b, {{1, nudged(1, 1)}}, {{1, nudged(1, -1)}}));
}

}  // namespace
}  // namespace freiform
