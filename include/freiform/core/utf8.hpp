// UTF-8, one character at a time.
#pragma once
#include <freiform/core/text.hpp>

#include <string>
#include <string_view>

namespace freiform {

// Bytes of the character that `s` begins with; 0 if that is not UTF-8 (too short, too long, a surrogate,
// above U+10FFFF) or `s` is empty.
inline std::size_t utf8_length(std::string_view s) {
    if (s.empty()) return 0;
    const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(s[i]); };
    const unsigned c = byte(0);
    if (c < 0x80) return 1;
    const std::size_t n = c >= 0xF0 ? 4 : c >= 0xE0 ? 3 : 2;
    if (c < 0xC2 || c > 0xF4 || s.size() < n) return 0;
    for (std::size_t i = 1; i < n; ++i)
        if ((byte(i) & 0xC0) != 0x80) return 0;
    const unsigned second = byte(1);
    if ((c == 0xE0 && second < 0xA0) || (c == 0xED && second >= 0xA0) || (c == 0xF0 && second < 0x90) ||
        (c == 0xF4 && second >= 0x90))
        return 0;
    return n;
}

// The character that `s`, not empty, begins with, for messages, which are UTF-8: in quotes, or the number of
// the byte if it is no character, or none that can be seen.
inline std::string shown_character(std::string_view s) {
    const std::size_t n = utf8_length(s);
    const auto c = static_cast<unsigned char>(s[0]);
    return n > 0 && c > 32 && c != 127 ? text("'", s.substr(0, n), "'") : text("byte ", int(c));
}

}  // namespace freiform
