#include "support/random.hpp"

#include <freiform/core/bounded.hpp>

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <boost/multiprecision/cpp_int.hpp>
#include <gtest/gtest.h>
#include <random>

namespace freiform {
namespace {

using boost::multiprecision::cpp_rational;
using test::Random;

using Wide = boost::multiprecision::number<
    boost::multiprecision::cpp_bin_float<400, boost::multiprecision::digit_base_2>>;

// A number, what is known of it, and where in its bound it really lies.
struct Known {
    Bounded known;
    Wide exact;
};

Known random_known(std::mt19937& rng) {
    const double value = std::ldexp(double(int(rng() % 2001) - 1000) / 7, int(rng() % 40) - 20);
    const double bound = rng() % 3 == 0 ? 0 : std::abs(value) * std::ldexp(1, -int(rng() % 60));
    const double at = double(int(rng() % 201) - 100) / 100;
    return {{value, bound}, Wide(value) + Wide(bound) * Wide(at)};
}

bool holds(const Bounded& b, const Wide& exact) { return abs(Wide(b.value) - exact) <= Wide(b.bound); }

TEST(Bounded, every_operation_keeps_the_exact_number_inside) {
    std::mt19937 rng(11);
    for (int i = 0; i < 20000; ++i) {
        const Known a = random_known(rng), b = random_known(rng);
        EXPECT_TRUE(holds(a.known + b.known, a.exact + b.exact));
        EXPECT_TRUE(holds(a.known - b.known, a.exact - b.exact));
        EXPECT_TRUE(holds(a.known * b.known, a.exact * b.exact));
        if (b.known.excludes_zero()) EXPECT_TRUE(holds(a.known / b.known, a.exact / b.exact));
        if (a.exact >= 0) EXPECT_TRUE(holds(sqrt(a.known), sqrt(a.exact)));
    }
}

TEST(Bounded, the_bound_of_exact_arguments_is_about_half_a_unit_in_the_last_place) {
    const Bounded third = Bounded(1) / Bounded(3);
    EXPECT_GT(third.bound, 0);
    EXPECT_LT(third.bound, 0x1.1p-54);
    EXPECT_LT((Bounded(0.1) * Bounded(0.2)).bound, 0x1.1p-53 * 0.0201);
    EXPECT_LT(sqrt(Bounded(2)).bound, 0x1.1p-53 * 1.42);
}

TEST(Bounded, a_divisor_that_may_be_zero_leaves_nothing_known) {
    EXPECT_EQ((Bounded(1) / Bounded(1e-9, 1e-9)).bound, std::numeric_limits<double>::infinity());
    EXPECT_FALSE(Bounded(1e-9, 1e-9).excludes_zero());
    EXPECT_TRUE(Bounded(-1e-9, 0.5e-9).excludes_zero());
    EXPECT_FALSE(Bounded(1, NAN).excludes_zero());
}

TEST(Bounded, holds_where_results_underflow) {
    const Bounded tiny(0x1p-1060), r = tiny * Bounded(0x1.8p-15);
    EXPECT_TRUE(holds(r, Wide(0x1p-1060) * Wide(0x1.8p-15)));
    EXPECT_TRUE(holds(tiny * tiny, Wide(0x1p-1060) * Wide(0x1p-1060)));
    EXPECT_TRUE(holds(tiny / Bounded(3e10), Wide(0x1p-1060) / Wide(3e10)));
}

// Numbers of all sizes; some with few bits, so that operations are exact now and then.
double number(Random& random, int range) {
    const double m = random.chance(0.3) ? random.integer(-8, 8) : random.real(-2, 2);
    return std::scalbn(m, random.integer(-range, range));
}

TEST(Bounded, holds_over_the_whole_range_of_double) {
    Random random(1);
    for (int round = 0; round < 3000; ++round) {
        const int range = round % 3 == 0 ? 530 : 4;
        const Bounded a(number(random, range), random.chance(0.5) ? 0 : std::abs(number(random, range)));
        const Bounded b(number(random, range), random.chance(0.5) ? 0 : std::abs(number(random, range)));
        // Any numbers inside the operands' bounds.
        const cpp_rational x = cpp_rational(a.value) +
                               cpp_rational(random.real(-1, 1)) * cpp_rational(a.bound),
                           y = cpp_rational(b.value) +
                               cpp_rational(random.real(-1, 1)) * cpp_rational(b.bound);
        const auto expect = [&](const Bounded& got, const cpp_rational& exact, const char* what) {
            if (!got.is_finite()) return;
            EXPECT_LE(abs(cpp_rational(got.value) - exact), cpp_rational(got.bound))
                << what << " " << a.value << " " << b.value;
        };
        expect(a + b, x + y, "+");
        expect(a - b, x - y, "-");
        expect(a * b, x * y, "*");
        if (y != 0 && b.excludes_zero()) expect(a / b, x / y, "/");
        if (x >= 0) {
            const Bounded s = sqrt(a);
            const cpp_rational low = cpp_rational(s.value) - cpp_rational(s.bound),
                               high = cpp_rational(s.value) + cpp_rational(s.bound);
            EXPECT_GE(high * high, x) << a.value;
            if (low > 0) EXPECT_LE(low * low, x) << a.value;
        }
    }
}

TEST(Bounded, a_divisor_of_tiny_uncertainty_leaves_the_quotient_uncertain) {
    // |q| times the bound of the divisor is far below the smallest double.
    const Bounded q = Bounded(0x1p-500) / Bounded(0x1p200, 0x1p-400);
    EXPECT_EQ(q.value, 0x1p-700);
    EXPECT_GT(q.bound, 0);
}

TEST(Bounded, exact_operations_add_nothing) {
    const Bounded three(3), quarter(0.25);
    for (const Bounded& x :
         {three + quarter, three - quarter, three * quarter, three / quarter, sqrt(quarter)})
        EXPECT_EQ(x.bound, 0);
    EXPECT_GT((Bounded(1) / three).bound, 0);
    EXPECT_LT((Bounded(1) / three).bound, 0x1p-54);
    EXPECT_EQ((Bounded(0) * Bounded(1, 7)).bound, 0);
    EXPECT_EQ((three / Bounded(1, 1)).bound, std::numeric_limits<double>::infinity());
    EXPECT_FALSE(Bounded(1, 1).excludes_zero());
    EXPECT_TRUE(Bounded(1, 0.99).excludes_zero());
}

}  // namespace
}  // namespace freiform
