// Cubic pieces of branches: halves, derivatives, and what is known of a surface along one in its parameters.
#pragma once
#include <freiform/core/constants.hpp>
#include <freiform/core/interval.hpp>
#include <freiform/spline/derivative_bounds.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace freiform::detail {

template <class V>
using CubicArc = std::array<V, 4>;
template <class V>
std::array<CubicArc<V>, 2> arc_halves(const CubicArc<V>& b) {
    const V a01 = 0.5 * (b[0] + b[1]), a12 = 0.5 * (b[1] + b[2]), a23 = 0.5 * (b[2] + b[3]);
    const V a = 0.5 * (a01 + a12), c = 0.5 * (a12 + a23), m = 0.5 * (a + c);
    return {CubicArc<V>{b[0], a01, a, m}, {m, c, a23, b[3]}};
}
// Of second derivatives; of the third one.
template <class V>
double bend_of_arc(const CubicArc<V>& b) {
    return 6 * std::max(norm(b[2] - 2 * b[1] + b[0]), norm(b[3] - 2 * b[2] + b[1]));
}
template <class V>
double twist_of_arc(const CubicArc<V>& b) {
    return 6 * norm((b[3] - b[0]) - 3 * (b[2] - b[1]));
}

// Bounds of a piece of parameters: a box, derivatives, and how far rounding moves it.
struct ArcSpeeds {
    std::array<Interval, 2> box{};
    std::array<double, 2> speed{}, bend{}, twist{}, slack{};
};
// Nothing: it leaves the domain.
inline std::optional<ArcSpeeds> speeds_of(const CubicArc<Vec<2>>& q, const std::array<Interval, 2>& domain) {
    ArcSpeeds out;
    auto& [box, speed, bend, twist, slack] = out;
    for (int k = 0; k < 2; ++k) {
        const std::size_t a = std::size_t(k);
        box[a] = {q[0][k], q[0][k]};
        for (const Vec<2>& p : q) box[a] = hull(box[a], {p[k], p[k]});
        slack[a] = 8 * kUnitRoundoff * std::max(std::abs(domain[a].lo), std::abs(domain[a].hi));
        if (box[a].lo < domain[a].lo - slack[a] || box[a].hi > domain[a].hi + slack[a]) return std::nullopt;
        box[a] = {clamped(box[a].lo - slack[a], domain[a]), clamped(box[a].hi + slack[a], domain[a])};
        for (std::size_t i = 0; i < 3; ++i)
            speed[a] = std::max(speed[a], 3 * std::abs(q[i + 1][k] - q[i][k]));
        for (std::size_t i = 0; i < 2; ++i)
            bend[a] = std::max(bend[a], 6 * std::abs(q[i + 2][k] - 2 * q[i + 1][k] + q[i][k]));
        twist[a] = 6 * std::abs((q[3][k] - q[0][k]) - 3 * (q[2][k] - q[1][k])) + 64 * slack[a];
        speed[a] += 8 * slack[a], bend[a] += 32 * slack[a];
    }
    return out;
}
// Of the third derivative of S o q, d bounding those of S.
inline double third_of_arc(const DerivativeBounds<2>& d, const ArcSpeeds& s) {
    const double u = s.speed[0], v = s.speed[1];
    return d(3, 0) * u * u * u + 3 * d(2, 1) * u * u * v + 3 * d(1, 2) * u * v * v + d(0, 3) * v * v * v +
           3 * (d(2, 0) * u * s.bend[0] + d(1, 1) * (u * s.bend[1] + v * s.bend[0]) +
                d(0, 2) * v * s.bend[1]) +
           d(1, 0) * s.twist[0] + d(0, 1) * s.twist[1];
}

// The length of the interval, from t on, of a piece between two points with unit tangents: as on a circle, if
// the tangents are no noise; as the knots will have it, and at least what makes a difference to t.
inline double arc_interval(const Vec<3>& a, const Vec<3>& b, const Vec<3>& at_a, const Vec<3>& at_b, double t,
                           double tolerance) {
    const double chord = norm(b - a), half = 0.5 * std::acos(std::clamp(dot(at_a, at_b), -1.0, 1.0));
    double length = half > 1e-4 && half < 1.2 ? chord * 2 * std::tan(half / 2) / std::sin(half) : chord;
    if (!(length > 0x1p-40 * t)) length = std::max(0x1p-40 * t, tolerance);
    return (t + length) - t;
}

}  // namespace freiform::detail
