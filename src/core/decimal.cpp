#include <freiform/core/decimal.hpp>
#include <freiform/core/text.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstdlib>
#include <limits>

namespace freiform {
namespace {

bool is_digit(char c) { return c >= '0' && c <= '9'; }

// What a text says as long as it is that of a number: its first digits, and the power of ten of the last one.
struct Literal {
    std::uint64_t digits = 0;  // at most 19; of the others only the power is kept
    double power = 0;
    std::size_t length = 0;
    bool negative = false, cut = false;
};

Literal literal_of(std::string_view s) {
    Literal l;
    std::size_t i = 0;
    l.negative = s.starts_with('-');
    if (l.negative) ++i;
    bool any = false;
    const auto take = [&](bool behind_point) {
        for (; i < s.size() && is_digit(s[i]); ++i, any = true) {
            const bool room = l.digits < std::numeric_limits<std::uint64_t>::max() / 10 - 1;
            if (room) l.digits = 10 * l.digits + std::uint64_t(s[i] - '0');
            l.cut |= !room;
            l.power += double(!room) - double(behind_point);
        }
    };
    take(false);
    if (i < s.size() && s[i] == '.') ++i, take(true);
    if (!any) return {};
    l.length = i;
    if (i == s.size() || (s[i] != 'e' && s[i] != 'E')) return l;
    ++i;
    const bool down = i < s.size() && s[i] == '-';
    if (i < s.size() && (s[i] == '-' || s[i] == '+')) ++i;
    double power = 0;
    for (; i < s.size() && is_digit(s[i]); ++i) {
        power = std::min(10 * power + (s[i] - '0'), 1e15);
        l.length = i + 1;
    }
    l.power += down ? -power : power;
    return l;
}

#ifdef __wasm__
// What pages have themselves: in the libraries of C and C++ it takes as much to load as twenty commands.
#define FF_IMPORT(name) __attribute__((import_module("freiform"), import_name(name)))
// x.toExponential() as ASCII, at most 24 characters; its length.
FF_IMPORT("digits") extern "C" std::size_t ff_page_digits(double x, char* to);
// Number(text).
FF_IMPORT("number") extern "C" double ff_page_number(const char* text, std::size_t size);
#undef FF_IMPORT

std::size_t digits_of(double x, char* to, std::size_t) { return ff_page_digits(x, to); }
#else
std::size_t digits_of(double x, char* to, std::size_t room) {
    return std::size_t(std::to_chars(to, to + room, x, std::chars_format::scientific).ptr - to);
}
#endif

}  // namespace

Decimal shortest_decimal(double x) {
    Decimal d;
    d.negative = std::signbit(x);
    if (x == 0) return d;
    std::array<char, 32> buffer{};  // "1.2345678901234567e-308"
    const std::string_view s(buffer.data(), digits_of(std::abs(x), buffer.data(), buffer.size()));
    const std::size_t e = s.find('e');
    for (const char c : s.substr(0, e))
        if (is_digit(c)) d.digits[std::size_t(d.size++)] = c;
    for (const char c : s.substr(e + 2)) d.exponent = 10 * d.exponent + (c - '0');
    d.exponent = (s[e + 1] == '-' ? -d.exponent : d.exponent) + 1;
    return d;
}

Decimal rounded(Decimal d, int digits) {
    if (d.size <= digits) return d;
    const bool half = d.size == digits + 1 && d.digits[std::size_t(digits)] == '5';
    bool up =
        half ? (d.digits[std::size_t(digits) - 1] - '0') % 2 == 1 : d.digits[std::size_t(digits)] >= '5';
    d.size = digits;
    while (up && d.size > 0) {
        char& last = d.digits[std::size_t(d.size) - 1];
        up = last == '9';
        if (up)
            --d.size;
        else
            ++last;
    }
    if (d.size == 0) d.digits[0] = '1', d.size = 1, ++d.exponent;
    while (d.digits[std::size_t(d.size) - 1] == '0') --d.size;
    return d;
}

void append_fixed(std::string& s, const Decimal& d) {
    const std::string_view digits = d.size == 0 ? "0" : d.text();
    const int before = d.size == 0 ? 1 : d.exponent, n = int(digits.size());
    if (d.negative) s += '-';
    if (before <= 0)
        s.append("0.").append(std::size_t(-before), '0').append(digits);
    else if (before < n)
        s.append(digits.substr(0, std::size_t(before)))
            .append(1, '.')
            .append(digits.substr(std::size_t(before)));
    else
        s.append(digits).append(std::size_t(before - n), '0');
}

void append_scientific(std::string& s, const Decimal& d) {
    const std::string_view digits = d.size == 0 ? "0" : d.text();
    const int power = d.size == 0 ? 0 : d.exponent - 1;
    if (d.negative) s += '-';
    s += digits[0];
    if (d.size > 1) s.append(1, '.').append(digits.substr(1));
    s += power < 0 ? "e-" : "e+";
    if (std::abs(power) < 10) s += '0';
    append_text(s, std::abs(power));
}

std::string rounded_text(double x, int digits) {
    if (!std::isfinite(x)) return text(x);
    const Decimal d = rounded(shortest_decimal(x), digits);
    std::string s;
    if (d.exponent > digits || d.exponent <= -4)
        append_scientific(s, d);
    else
        append_fixed(s, d);
    return s;
}

#ifdef __wasm__
ScannedReal scan_real(std::string_view s) {
    const Literal l = literal_of(s);
    if (l.length == 0) return {};
    // Where digits and power of ten are doubles, one operation rounds once [Clinger 1990].
    constexpr double kExact = 22;
    if (l.cut || l.digits > std::uint64_t(1) << 53 || std::abs(l.power) > kExact)
        return {ff_page_number(s.data(), l.length), l.length};
    double ten = 1;
    for (double i = std::abs(l.power); i > 0; --i) ten *= 10;
    const double x = l.power < 0 ? double(l.digits) / ten : double(l.digits) * ten;
    return {l.negative ? -x : x, l.length};
}
#else
ScannedReal scan_real(std::string_view s) {
    const std::string_view unsigned_part = s.substr(s.starts_with('-'));
    if (unsigned_part.empty() || !(is_digit(unsigned_part[0]) || unsigned_part[0] == '.')) return {};
    double x = 0;
    const auto [end, error] = std::from_chars(s.data(), s.data() + s.size(), x);
    if (error == std::errc::result_out_of_range) {
        // The exponent is beyond 300 or below -300 then: 19 digits do not matter.
        const Literal l = literal_of(s);
        x = l.digits > 0 && l.power > 0 ? std::numeric_limits<double>::infinity() : 0;
        x = l.negative ? -x : x;
    }
    return {x, std::size_t(end - s.data())};
}
#endif

}  // namespace freiform
