// A double together with a bound of its error: arithmetic whose rounding is counted as it happens.
//
// Idea: running error analysis. Of every operation the rounding error itself is computed (it is a double: the
// remainder of an addition, of a product, of a division), so operations that are exact add nothing, and an
// expression whose data are exact and whose steps round nothing has the bound 0. Guarantee: if |a - value| <=
// bound holds for the operands, it holds for the result, underflow included. The bound is infinite where a
// division by something that may be 0 was tried. Accuracy of the bound itself: it is computed from sums and
// products of numbers >= 0, at most a dozen roundings, and enlarged by 2^-48 for them. Scaling by powers of
// two scales value and bound alike, away from underflow. References: [Higham 2002, 3.3].
#pragma once
#include <freiform/core/vec.hpp>

#include <array>
#include <cmath>
#include <limits>

namespace freiform {

struct Bounded {
    double value = 0;
    double bound = 0;  // |value - exact| <= bound; infinite or NaN: nothing is known

    constexpr Bounded() = default;
    constexpr Bounded(double v, double b = 0) : value(v), bound(b) {}

    // Exactly 0, with no doubt.
    constexpr bool is_zero() const { return value == 0 && bound == 0; }
    // Is the exact number certainly not 0?
    constexpr bool excludes_zero() const { return value > bound || -value > bound; }
    bool is_finite() const { return std::isfinite(value) && std::isfinite(bound); }
    friend constexpr bool operator==(const Bounded&, const Bounded&) = default;
};

namespace detail {
// A bound of the exact value of what was computed as x >= 0.
inline double above(double x) { return x == 0 ? 0 : x * (1 + 0x1p-48) + 0x1p-1070; }
inline constexpr double kSmall = 0x1p-960;  // below, remainders of products are themselves rounded
}  // namespace detail

inline Bounded operator+(const Bounded& a, const Bounded& b) {
    const double v = a.value + b.value, part = v - a.value;
    const double rest = std::abs((a.value - (v - part)) + (b.value - part));  // exact: sums do not underflow
    return {v, detail::above(a.bound + b.bound + rest)};
}
constexpr Bounded operator-(const Bounded& a) { return {-a.value, a.bound}; }
inline Bounded operator-(const Bounded& a, const Bounded& b) { return a + -b; }
inline Bounded operator*(const Bounded& a, const Bounded& b) {
    if (a.is_zero() || b.is_zero()) return {};
    const double v = a.value * b.value;
    double bound = std::abs(std::fma(a.value, b.value, -v));
    if (a.bound != 0 || b.bound != 0)
        bound += std::abs(a.value) * b.bound + std::abs(b.value) * a.bound + a.bound * b.bound + 0x1p-1070;
    if (std::abs(v) < detail::kSmall) bound += 0x1p-1070;
    return {v, detail::above(bound)};
}
inline Bounded operator/(const Bounded& a, const Bounded& b) {
    if (a.is_zero()) return {};
    const double room = std::abs(b.value) - b.bound;
    if (!(room > 0)) return {a.value, std::numeric_limits<double>::infinity()};
    // |A / B - q| = |A - q B| / |B|, and |B| >= room.
    const double q = a.value / b.value;
    double rest = std::abs(std::fma(-q, b.value, a.value)) + a.bound;
    if (b.bound != 0) rest += std::abs(q) * b.bound + 0x1p-1070;
    if (std::abs(a.value) < detail::kSmall || std::abs(q) < detail::kSmall) rest += 0x1p-1070;
    const double bound = rest == 0 ? 0 : rest / (room * (1 - 0x1p-50)) + 0x1p-1070;
    return {q, std::abs(q) < detail::kSmall ? detail::above(bound) + 0x1p-1070 : detail::above(bound)};
}
inline Bounded& operator+=(Bounded& a, const Bounded& b) { return a = a + b; }
inline Bounded& operator-=(Bounded& a, const Bounded& b) { return a = a - b; }
inline Bounded& operator*=(Bounded& a, const Bounded& b) { return a = a * b; }
inline Bounded& operator/=(Bounded& a, const Bounded& b) { return a = a / b; }

inline Bounded abs(const Bounded& a) { return {std::abs(a.value), a.bound}; }
// Of a number that is >= 0.
inline Bounded sqrt(const Bounded& a) {
    if (a.is_zero()) return {};
    if (!(a.value > 0)) return {0, detail::above(std::sqrt(a.bound + std::abs(a.value)))};
    // |sqrt(A) - s| = |A - s^2| / (sqrt(A) + s)
    const double s = std::sqrt(a.value), low = a.value - a.bound;
    double rest = std::abs(std::fma(-s, s, a.value)) + a.bound;
    if (a.value < detail::kSmall) rest += 0x1p-1070;
    return {s, detail::above(rest / (s + (low > 0 ? std::sqrt(low) : 0)))};
}

template <int D>
using BoundedVec = std::array<Bounded, std::size_t(D)>;

template <std::size_t D>
Bounded dot(const std::array<Bounded, D>& a, const std::array<Bounded, D>& b) {
    Bounded s;
    for (std::size_t i = 0; i < D; ++i) s += a[i] * b[i];
    return s;
}
inline BoundedVec<3> cross(const BoundedVec<3>& a, const BoundedVec<3>& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

}  // namespace freiform
