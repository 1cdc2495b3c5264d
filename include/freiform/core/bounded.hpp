// Numbers that carry a bound of their error, and arithmetic that keeps it valid: the shortest way from a
// formula to an answer with a proven bound.
//
// Every operation takes the distance of the arguments from the numbers they stand for, its own rounding
// (2^-53 of the result, 2^-1074 where that underflows), and the rounding of the bound itself into account. A
// bound that is infinite or NaN says that nothing is known.
#pragma once
#include <freiform/core/vec.hpp>

#include <array>
#include <cmath>
#include <limits>

namespace freiform {

struct Bounded {
    double value = 0;
    double bound = 0;  // |value - exact| <= bound

    constexpr Bounded() = default;
    constexpr Bounded(double v, double b = 0) : value(v), bound(b) {}

    // Is the exact number certainly not 0?
    constexpr bool excludes_zero() const { return value > bound || -value > bound; }
    friend constexpr bool operator==(const Bounded&, const Bounded&) = default;
};

namespace bounded_detail {
inline constexpr double kUnit = 0x1p-53, kTiny = 0x1p-1074;
// A bound from its parts: each sum of the parts has been rounded a few times, `result` once.
constexpr double widened(double parts, double result) {
    return (parts + (result < 0 ? -result : result) * kUnit) * (1 + 16 * kUnit) + kTiny;
}
constexpr double abs(double x) { return x < 0 ? -x : x; }
}  // namespace bounded_detail

constexpr Bounded operator-(const Bounded& a) { return {-a.value, a.bound}; }
constexpr Bounded operator+(const Bounded& a, const Bounded& b) {
    const double r = a.value + b.value;
    return {r, bounded_detail::widened(a.bound + b.bound, r)};
}
constexpr Bounded operator-(const Bounded& a, const Bounded& b) { return a + -b; }
constexpr Bounded operator*(const Bounded& a, const Bounded& b) {
    using bounded_detail::abs;
    const double r = a.value * b.value;
    const double parts = abs(a.value) * b.bound + abs(b.value) * a.bound + a.bound * b.bound;
    return {r, bounded_detail::widened(parts + 3 * bounded_detail::kTiny, r)};
}
// Infinite bound where the divisor may be 0.
constexpr Bounded operator/(const Bounded& a, const Bounded& b) {
    using bounded_detail::abs;
    if (!b.excludes_zero()) return {a.value, std::numeric_limits<double>::infinity()};
    const double r = a.value / b.value;
    // |A/B - a/b| <= (|A - a| + |a/b| |B - b|) / |B|, and |B| >= |b| - bound, rounded twice.
    const double least = (abs(b.value) - b.bound) * (1 - 4 * bounded_detail::kUnit);
    const double parts =
        (a.bound + (abs(r) * (1 + 2 * bounded_detail::kUnit) + bounded_detail::kTiny) * b.bound) / least;
    return {r, bounded_detail::widened(parts * (1 + 8 * bounded_detail::kUnit), r)};
}

// Of a number that is not negative; what rounding has brought below 0 counts as 0.
inline Bounded sqrt(const Bounded& a) {
    const double r = a.value > 0 ? std::sqrt(a.value) : 0;
    // |sqrt X - sqrt x| = |X - x| / (sqrt X + sqrt x) is at most both of these.
    const double apart = std::sqrt(a.bound) * (1 + 4 * bounded_detail::kUnit);
    const double parts = r > 0 ? std::min(a.bound / r, apart) : apart;
    return {r, bounded_detail::widened(parts, r)};
}

template <int D>
using BoundedVec = std::array<Bounded, std::size_t(D)>;

template <std::size_t D>
Bounded dot(const std::array<Bounded, D>& a, const std::array<Bounded, D>& b) {
    Bounded s;
    for (std::size_t i = 0; i < D; ++i) s = s + a[i] * b[i];
    return s;
}
inline BoundedVec<3> cross(const BoundedVec<3>& a, const BoundedVec<3>& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

}  // namespace freiform
