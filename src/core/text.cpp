#include <freiform/core/decimal.hpp>
#include <freiform/core/text.hpp>

#include <charconv>
#include <cmath>
#include <concepts>

namespace freiform {
namespace {

#ifdef __wasm__
// As std::to_chars writes it: without a power of ten where that is not longer, whole numbers to the last
// digit.
std::string text_of(const Decimal& d, double x) {
    std::string plain = fixed_text(d), with_power = scientific_text(d);
    if (plain.size() > with_power.size()) return with_power;
    if (d.exponent <= d.size) return plain;
    const std::string_view sign = d.negative ? "-" : "";
    const double size = std::abs(x),
                 last = std::fmod(size, 1e11);  // 11 digits; those before them are exact, too
    if (size < 9e18) return text(sign, std::llround(size));
    return text(sign, std::llround((size - last) / 1e11),
                text(100'000'000'000 + std::llround(last)).substr(1));
}

std::string text_of(double x) {
    if (std::isnan(x)) return std::signbit(x) ? "-nan" : "nan";
    if (std::isinf(x)) return x < 0 ? "-inf" : "inf";
    return text_of(shortest_decimal(x), x);
}

// The fewest digits of its value that read back to it.
std::string text_of(float x) {
    if (!std::isfinite(x)) return text_of(double(x));
    const Decimal all = shortest_decimal(double(x));
    Decimal d = rounded(all, 1);
    for (int digits = 2; float(scan_real(scientific_text(d)).value) != x; ++digits) d = rounded(all, digits);
    return text_of(d, double(x));
}

void append_number(std::string& s, std::floating_point auto x) { s += text_of(x); }
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
