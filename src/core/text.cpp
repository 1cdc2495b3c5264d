#include <freiform/core/decimal.hpp>
#include <freiform/core/text.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <concepts>

namespace freiform {
namespace {

#ifdef __wasm__
// As std::to_chars writes it: without a power of ten where that is not longer, whole numbers to the last
// digit.
void append_decimal(std::string& s, const Decimal& d, double x) {
    const int power = std::abs(d.exponent - 1);
    const int plain = d.exponent <= 0 ? 2 - d.exponent + d.size
                                      : std::max(d.exponent, d.size + (d.exponent < d.size)),
              with_power = d.size + (d.size > 1) + (power < 100 ? 4 : 5);
    if (d.size > 0 && plain > with_power) return append_scientific(s, d);
    if (d.exponent <= d.size) return append_fixed(s, d);
    const double size = std::abs(x),
                 last = std::fmod(size, 1e11);  // 11 digits; those before them are exact, too
    if (d.negative) s += '-';
    if (size < 9e18) return append_text(s, std::llround(size));
    append_text(s, std::llround((size - last) / 1e11));
    s += text(100'000'000'000 + std::llround(last)).substr(1);
}

void append_number(std::string& s, double x) {
    if (std::isfinite(x))
        append_decimal(s, shortest_decimal(x), x);
    else
        s.append(std::signbit(x) ? "-" : "").append(std::isnan(x) ? "nan" : "inf");
}

// The fewest digits of its value that read back to it: at most nine, mostly eight.
void append_number(std::string& s, float x) {
    if (!std::isfinite(x)) return append_number(s, double(x));
    const Decimal all = shortest_decimal(double(x));
    Decimal d = rounded(all, 9);
    while (d.size > 1) {
        const Decimal shorter = rounded(all, d.size - 1);
        std::string tried;
        append_scientific(tried, shorter);
        if (float(scan_real(tried).value) != x) break;
        d = shorter;
    }
    append_decimal(s, d, double(x));
}
#else
void append_number(std::string& s, std::floating_point auto x) {
    char buffer[40];
    s.append(buffer, std::to_chars(buffer, buffer + sizeof buffer, x).ptr);
}
#endif

void append_number(std::string& s, std::integral auto x) {
    char buffer[24];
    s.append(buffer, std::to_chars(buffer, buffer + sizeof buffer, x).ptr);
}

}  // namespace

void append_text(std::string& s, const TextPart& part) {
    switch (part.kind_) {
        case TextPart::Kind::characters:
            s += part.characters_;
            break;
        case TextPart::Kind::character:
            s += part.character_;
            break;
        case TextPart::Kind::integer:
            append_number(s, part.integer_);
            break;
        case TextPart::Kind::natural:
            append_number(s, part.natural_);
            break;
        case TextPart::Kind::real:
            append_number(s, part.real_);
            break;
        case TextPart::Kind::single:
            append_number(s, part.single_);
            break;
    }
}

std::string joined(std::span<const TextPart> parts) {
    std::string s;
    for (const TextPart& part : parts) append_text(s, part);
    return s;
}

}  // namespace freiform
