// Decimal numbers as text and back, independent of the locale.
#pragma once
#include <array>
#include <cstddef>
#include <string>
#include <string_view>

namespace freiform {

// 0.DIGITS x 10^exponent; neither the first digit nor the last is 0, and zero has none.
struct Decimal {
    std::array<char, 17> digits{};
    int size = 0, exponent = 0;
    bool negative = false;
    std::string_view text() const { return {digits.data(), std::size_t(size)}; }
};

// The one with the fewest digits that reads back to the same bits, of those the closest. REQUIRES x finite
Decimal shortest_decimal(double x);

// To at most `digits` digits, a half to the even one. REQUIRES digits >= 1
Decimal rounded(Decimal d, int digits);

// Without a power of ten: "0.00012".
void append_fixed(std::string& s, const Decimal& d);
// With one: "1.2e-04".
void append_scientific(std::string& s, const Decimal& d);

// To so many significant digits, with a power of ten from 10^digits on and below 0.0001.
std::string rounded_text(double x, int digits);

// The number that a text begins with, to the last bit: what is too large is an infinity, what is too small 0.
// Its length is 0 where the text begins with none; words for infinities, and a plus sign, begin none.
struct ScannedReal {
    double value = 0;
    std::size_t length = 0;
};
ScannedReal scan_real(std::string_view text);

}  // namespace freiform
