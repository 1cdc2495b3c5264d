#include "support/random.hpp"

#include <freiform/poly/exact.hpp>

#include <boost/multiprecision/cpp_int.hpp>
#include <gtest/gtest.h>

namespace freiform {
namespace {

using Rational = boost::multiprecision::cpp_rational;

TEST(Exact, agrees_with_rationals) {
    test::Random random(41);
    for (int k = 0; k < 200; ++k) {
        Exact x(1);
        Rational r = 1;
        for (int i = 0; i < 12; ++i) {
            const double a = random.chance(0.1) ? 0 : std::ldexp(random.real(-1, 1), random.integer(-60, 60));
            const int what = random.integer(0, 2);
            x = what == 0 ? x + Exact(a) : what == 1 ? x - Exact(a) : x * Exact(a);
            r = what == 0   ? Rational(r + Rational(a))
                : what == 1 ? Rational(r - Rational(a))
                            : Rational(r * Rational(a));
            EXPECT_EQ(x.sign(), r.sign());
            const double want = r.convert_to<double>();
            EXPECT_NEAR(x.rounded(), want, std::abs(want) * 0x1p-52);
            if (r != 0) EXPECT_EQ(x.exponent(), x.scaled(-3000).exponent() + 3000);
        }
        EXPECT_EQ((x - x).sign(), 0);
        EXPECT_TRUE(x * Exact(2) == x + x);
    }
    EXPECT_EQ((Exact(1e300) + Exact(1e-300) - Exact(1e300)).rounded(), 1e-300);
    EXPECT_EQ(Exact(1).exponent(), 1);
    EXPECT_EQ(Exact(-0.0).sign(), 0);
    EXPECT_EQ(Exact(0x1p-1074).rounded(), 0x1p-1074);
}

}  // namespace
}  // namespace freiform
