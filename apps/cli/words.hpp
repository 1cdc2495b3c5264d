// What reports have in common: times, and numbers for words.
#pragma once
#include <chrono>
#include <cmath>

namespace freiform::cli {

// Seconds of a clock that only goes forward.
inline double now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

// Two digits, upwards: for words, not for counting on.
inline double rounded_up(double x) {
    if (!(x > 0 && std::isfinite(x))) return x;
    const int exponent = int(std::floor(std::log10(x))) - 1;
    const double power = std::pow(10.0, std::abs(exponent));
    return exponent < 0 ? std::ceil(x * power) / power : std::ceil(x / power) * power;
}

}  // namespace freiform::cli
