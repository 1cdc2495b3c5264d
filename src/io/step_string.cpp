// Strings of STEP files. The basic alphabet is ASCII; what else occurs is an escape, or the bytes themselves:
// UTF-8 (edition 3), or else ISO 8859-1, which older programs write against the standard. What is written
// here is ASCII with escapes, which every edition has.
#include "step_part21.hpp"

#include <freiform/core/utf8.hpp>

#include <optional>

namespace freiform::step {

namespace {

void append_utf8(std::string& out, std::uint32_t c) {
    if (c > 0x10ffff || (c >= 0xd800 && c < 0xe000)) c = 0xfffd;
    if (c < 0x80) {
        out += char(c);
    } else if (c < 0x800) {
        out += char(0xc0 | (c >> 6));
        out += char(0x80 | (c & 63));
    } else if (c < 0x10000) {
        out += char(0xe0 | (c >> 12));
        out += char(0x80 | ((c >> 6) & 63));
        out += char(0x80 | (c & 63));
    } else {
        out += char(0xf0 | (c >> 18));
        out += char(0x80 | ((c >> 12) & 63));
        out += char(0x80 | ((c >> 6) & 63));
        out += char(0x80 | (c & 63));
    }
}

std::optional<std::uint32_t> hexadecimal(std::string_view digits, std::size_t count) {
    if (digits.size() < count) return std::nullopt;
    std::uint32_t x = 0;
    for (const char c : digits.substr(0, count)) {
        const int d = c >= '0' && c <= '9'   ? c - '0'
                      : c >= 'A' && c <= 'F' ? c - 'A' + 10
                      : c >= 'a' && c <= 'f' ? c - 'a' + 10
                                             : -1;
        if (d < 0) return std::nullopt;
        x = x * 16 + std::uint32_t(d);
    }
    return x;
}

// \X2\ or \X4\ with `digits` for each character, up to \X0\. How many bytes it takes.
std::size_t wide(std::string_view s, std::size_t digits, std::string& out) {
    std::size_t i = 4;
    while (const auto c = hexadecimal(s.substr(i), digits)) {
        i += digits;
        const bool high = digits == 4 && *c >= 0xd800 && *c < 0xdc00;  // the first half of a surrogate pair
        const auto low = high ? hexadecimal(s.substr(i), digits) : std::nullopt;
        if (low && *low >= 0xdc00 && *low < 0xe000) {
            append_utf8(out, 0x10000 + ((*c - 0xd800) << 10) + (*low - 0xdc00));
            i += digits;
        } else {
            append_utf8(out, *c);
        }
    }
    return s.substr(i).starts_with("\\X0\\") ? i + 4 : i;
}

// The character that begins with the n bytes, which are UTF-8; or a byte that is not, as ISO 8859-1.
std::uint32_t character(std::string_view s, std::size_t n) {
    const auto first = std::uint32_t((unsigned char)(s[0]));
    if (n < 2) return first;
    std::uint32_t c = first & (0x7fu >> n);
    for (std::size_t i = 1; i < n; ++i) c = (c << 6) | ((unsigned char)(s[i]) & 63u);
    return c;
}

void append_hexadecimal(std::string& out, std::uint32_t x, int digits) {
    for (int k = digits - 1; k >= 0; --k) out += "0123456789ABCDEF"[(x >> (4 * k)) & 15];
}

}  // namespace

std::string decoded(std::string_view s) {
    std::string out;
    out.reserve(s.size());
    for (std::size_t i = 0; i < s.size();) {
        const std::string_view rest = s.substr(i);
        if (rest.starts_with("''") || rest.starts_with("\\\\")) {
            out += rest[0];
            i += 2;
        } else if (rest.starts_with("\\X2\\")) {
            i += wide(rest, 4, out);
        } else if (rest.starts_with("\\X4\\")) {
            i += wide(rest, 8, out);
        } else if (const auto c = rest.starts_with("\\X\\") ? hexadecimal(rest.substr(3), 2) : std::nullopt) {
            append_utf8(out, *c);
            i += 5;
        } else if (rest.starts_with("\\S\\") && rest.size() > 3) {
            append_utf8(out, 128u + (unsigned char)(rest[3]) % 128u);
            i += 4;
        } else if (rest.starts_with("\\P") && rest.size() > 3 && rest[3] == '\\') {
            i += 4;
        } else if (rest[0] == '\r' || rest[0] == '\n') {
            ++i;
        } else if (const std::size_t n = utf8_length(rest); n > 0) {
            out += rest.substr(0, n);
            i += n;
        } else {
            append_utf8(out, (unsigned char)(rest[0]));
            ++i;
        }
    }
    return out;
}

std::string encoded(std::string_view s) {
    std::string out;
    int digits = 0;  // of each character of \X2\ or \X4\, as long as one is open
    const auto want = [&](int d) {
        if (digits == d) return;
        if (digits > 0) out += "\\X0\\";
        if (d > 0) out += d == 4 ? "\\X2\\" : "\\X4\\";
        digits = d;
    };
    for (std::size_t i = 0; i < s.size();) {
        const std::size_t n = utf8_length(s.substr(i));
        const std::uint32_t c = character(s.substr(i), n);
        i += n > 0 ? n : 1;
        want(c < 0x80 ? 0 : c < 0x10000 ? 4 : 8);
        if (digits > 0) {
            append_hexadecimal(out, c, digits);
        } else if (c < ' ' || c > '~') {
            out += "\\X\\";
            append_hexadecimal(out, c, 2);
        } else {
            if (c == '\'' || c == '\\') out += char(c);
            out += char(c);
        }
    }
    want(0);
    return out;
}

}  // namespace freiform::step
