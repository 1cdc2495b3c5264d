// Integers of any length, for the last stage of decisions that must not be wrong. Slow, and obviously right.
#pragma once
#include <cstdint>
#include <vector>

namespace freiform::detail {

// (-1)^negative * sum of limb[i] * 2^(32 i); the last limb is not zero, and zero has none.
struct Integer {
    bool negative = false;
    std::vector<std::uint32_t> limb;

    int sign() const { return limb.empty() ? 0 : negative ? -1 : 1; }
    friend bool operator==(const Integer&, const Integer&) = default;
};

// m * 2^shift; shift >= 0.
Integer shifted(std::int64_t m, int shift);
inline Integer integer(std::int64_t m) { return shifted(m, 0); }

Integer operator+(const Integer& a, const Integer& b);
Integer operator-(const Integer& a, const Integer& b);
Integer operator*(const Integer& a, const Integer& b);
Integer negated(Integer a);
Integer shifted_left(const Integer& a, int bits);
// Rounded towards zero. REQUIRES bits <= the number of zero bits below the lowest one that is set, for an
// exact result.
Integer shifted_right(const Integer& a, int bits);
// The quotient towards zero and what remains. REQUIRES b not zero.
struct Division {
    Integer quotient, remainder;
};
Division divided(const Integer& a, const Integer& b);
// The greatest common divisor; not negative; gcd(0, 0) = 0.
Integer gcd(Integer a, Integer b);

int bit_length(const Integer& a);                                // of |a|; 0 of 0
int trailing_zeros(const Integer& a);                            // of |a|; 0 of 0
std::uint32_t residue(const Integer& a, std::uint32_t modulus);  // in [0, modulus)
// |a| = f * 2^exponent, f in [1/2, 1) rounded towards zero, with the sign; 0 and 0 of 0.
struct Leading {
    double fraction = 0;
    int exponent = 0;
};
Leading leading(const Integer& a);

// x as m * 2^exponent with a whole number |m| < 2^53.
struct Parts {
    std::int64_t m;
    int exponent;
};
Parts parts_of(double x);

}  // namespace freiform::detail
