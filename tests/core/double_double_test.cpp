#include "support/random.hpp"

#include <freiform/core/double_double.hpp>

#include <boost/multiprecision/cpp_int.hpp>
#include <gtest/gtest.h>

namespace freiform {
namespace {

using boost::multiprecision::cpp_rational;
using test::Random;

// Numbers of all sizes; some with few bits, so that operations are exact now and then.
double operand(Random& random, int range) {
    const double m = random.chance(0.3) ? random.integer(-8, 8) : random.real(-2, 2);
    return std::scalbn(m, random.integer(-range, range));
}

TEST(DoubleDouble, operations_have_twice_the_precision) {
    Random random(2);
    const cpp_rational tiny = cpp_rational(std::ldexp(1.0, -100));
    for (int round = 0; round < 2000; ++round) {
        const DoubleDouble a = DoubleDouble(operand(random, 20)) +
                               DoubleDouble(operand(random, 20)) * DoubleDouble(0x1p-60),
                           b = DoubleDouble(operand(random, 20)) +
                               DoubleDouble(operand(random, 20)) * DoubleDouble(0x1p-60);
        const auto exact = [](const DoubleDouble& x) { return cpp_rational(x.hi) + cpp_rational(x.lo); };
        const cpp_rational x = exact(a), y = exact(b);
        EXPECT_LE(abs(exact(a + b) - (x + y)), tiny * abs(x + y));
        EXPECT_LE(abs(exact(a - b) - (x - y)), tiny * abs(x - y));
        EXPECT_LE(abs(exact(a * b) - x * y), tiny * abs(x * y));
        if (y != 0) EXPECT_LE(abs(exact(a / b) - x / y), tiny * abs(x / y));
    }
}

}  // namespace
}  // namespace freiform
