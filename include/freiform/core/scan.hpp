// Numbers from text written by people or programs: without locale, to the last bit.
#pragma once
#include <freiform/core/decimal.hpp>

#include <charconv>
#include <cmath>
#include <concepts>
#include <optional>
#include <string_view>

namespace freiform {

constexpr bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\r'; }

constexpr std::string_view trimmed(std::string_view s) {
    while (!s.empty() && is_blank(s.front())) s.remove_prefix(1);
    while (!s.empty() && is_blank(s.back())) s.remove_suffix(1);
    return s;
}

// The text up to `separator`, which is removed from `rest` together with it.
constexpr std::string_view next_part(std::string_view& rest, char separator) {
    const std::size_t end = rest.find(separator);
    const std::string_view part = rest.substr(0, end);
    rest = end == std::string_view::npos ? std::string_view() : rest.substr(end + 1);
    return part;
}

// The next word, between blanks; empty at the end.
constexpr std::string_view next_word(std::string_view& rest) {
    rest = trimmed(rest);
    std::size_t n = 0;
    while (n < rest.size() && !is_blank(rest[n])) ++n;
    const std::string_view word = rest.substr(0, n);
    rest.remove_prefix(n);
    return word;
}

// All of `s` as a finite number (or a whole one), with or without a plus sign; nothing if it is anything
// else. What is too small for a double is 0.
template <class T>
std::optional<T> scan_number(std::string_view s) {
    if (s.starts_with('+') && !s.starts_with("+-")) s.remove_prefix(1);
    if constexpr (std::floating_point<T>) {
        const ScannedReal all = scan_real(s);
        if (s.empty() || all.length != s.size() || !std::isfinite(all.value)) return std::nullopt;
        return T(all.value);
    } else {
        T x{};
        const auto [end, error] = std::from_chars(s.data(), s.data() + s.size(), x);
        if (error != std::errc() || end != s.data() + s.size()) return std::nullopt;
        return x;
    }
}

}  // namespace freiform
