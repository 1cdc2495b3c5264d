// Text from parts, independent of the locale; doubles in the shortest form that reads back to the same bits.
#pragma once
#include <charconv>
#include <concepts>
#include <string>
#include <string_view>

namespace freiform {

inline void append_text(std::string& s, std::string_view part) { s += part; }
inline void append_text(std::string& s, char part) { s += part; }
template <class T>
requires(std::integral<T> || std::floating_point<T>) &&
    (!std::same_as<T, char>)void append_text(std::string& s, T number) {
    if constexpr (std::same_as<T, bool>) {
        s += number ? "true" : "false";
    } else {
        char buffer[40];
        const auto end = std::to_chars(buffer, buffer + sizeof buffer, number).ptr;
        s.append(buffer, end);
    }
}

template <class... Parts>
std::string text(const Parts&... parts) {
    std::string s;
    (append_text(s, parts), ...);
    return s;
}

}  // namespace freiform
