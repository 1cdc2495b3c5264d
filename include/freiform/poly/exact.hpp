// Numbers that sums, differences and products do not round: m 2^e with an integer m of any length. Every
// finite double is one. For the last stage of decisions that doubles leave open; slow.
#pragma once
#include <cstdint>
#include <vector>

namespace freiform {

class Exact {
public:
    Exact() = default;
    // REQUIRES a finite x.
    Exact(double x);

    int sign() const { return limb_.empty() ? 0 : negative_ ? -1 : 1; }
    // Rounded towards zero to 53 bits; 0 or infinity where it leaves the range of double.
    double rounded() const;
    // The e with 2^(e - 1) <= |x| < 2^e; 0 for 0.
    int exponent() const;
    // Times 2^e.
    Exact scaled(int e) const;

    friend Exact operator+(const Exact& a, const Exact& b);
    friend Exact operator-(const Exact& a, const Exact& b);
    friend Exact operator*(const Exact& a, const Exact& b);
    friend bool operator==(const Exact& a, const Exact& b) { return (a - b).sign() == 0; }

private:
    bool negative_ = false;
    int exponent_ = 0;
    std::vector<std::uint32_t> limb_;  // of |m|, the lowest first; no zero at the end
};

}  // namespace freiform
