// Bounds of derivatives of lines and conics, of what profiles sweep, and of offsets.
//
// Offsets: O = S + d n with n = m / |m|, m = S_u x S_v:   |n_a| <= |m_a| / L,  |n_ab|
// <= |m_ab| / L + 3 |m_a| |m_b| / L^2, L a lower bound of |m| on the box: |m| at its middle less the
// variation by m_u, m_v.
//
// Along n: for a revolution with u = u0 + s, and w = n_across turned back by u0,
//     n . S_i = w_i . (cos s q_j + sin s (axis x q_j)) for i > 0, q_j the j-th derivative of the profile
//     across the axis,
// w_i a quarter turn of w for each order; i = 0 has the profile's own n . P_j, turned back, and (cos s - 1) w
// . q_j.
#pragma once
#include <freiform/core/constants.hpp>
#include <freiform/spline/derivative_bounds.hpp>

#include <algorithm>
#include <cmath>

namespace freiform::detail {

template <int D>
DerivativeBounds<1> bounds_of(const Line<D>& line, Interval on) {
    return {{norm(line.direction) * on.length() / 2, norm(line.direction), 0, 0}};
}

template <int D>
DerivativeBounds<1> bounds_of(const Conic<D>& c, Interval on) {
    const double xx = dot(c.x, c.x), yy = dot(c.y, c.y), xy = dot(c.x, c.y),
                 t = std::max(std::abs(on.lo), std::abs(on.hi));
    const double grow = 1 + 64 * kUnitRoundoff;
    DerivativeBounds<1> out;
    if (c.kind == ConicKind::ellipse) {  // the larger semi-axis: the larger singular value of (x y)
        const double s = grow * std::sqrt((xx + yy + std::hypot(xx - yy, 2 * xy)) / 2);
        out.d = {s, s, s, s};
    } else if (c.kind == ConicKind::hyperbola) {  // any derivative, from the middle outwards by the next one
        const double s = std::cosh(t) * (std::sqrt(xx) + std::sqrt(yy)), m = on.middle(),
                     half = on.length() / 2;
        const double even = norm(std::cosh(m) * c.x + std::sinh(m) * c.y) + half * s;
        const double odd = norm(std::sinh(m) * c.x + std::cosh(m) * c.y) + half * s;
        out.d = {s, std::min(s, odd) * grow, std::min(s, even) * grow, std::min(s, odd) * grow};
    } else {
        out.d = {0, grow * (2 * t * std::sqrt(xx) + std::sqrt(yy)), grow * 2 * std::sqrt(xx), 0};
    }
    out.d[0] = std::min(out.d[0] > 0 ? out.d[0] : kInfinity, out.d[1] * on.length() / 2);
    return out;
}

inline DerivativeBounds<2> bounds_of(const Extrusion& e, const DerivativeQuery<1, 3>& profile,
                                     const std::array<Interval, 2>& box, int order) {
    const auto c = profile({box[0]}, order);
    DerivativeBounds<2> out;
    for (int i = 0; i <= order; ++i) out.d[jet_slot(Index<2>{i, 0})] = c.d[std::size_t(i)];
    out.d[2] = norm(e.direction);
    out.d[0] += out.d[2] * box[1].length() / 2;
    return out;
}

// Partial (i, j): the j-th derivative of the profile, turned; for i > 0 only its part across the axis counts,
// which is bounded from the middle of the interval outwards.
inline DerivativeBounds<2> bounds_of(const Revolution& r, const DerivativeQuery<1, 3>& profile,
                                     const std::array<Interval, 2>& box, int order) {
    const auto c = profile({box[1]}, std::min(order + 1, kBoundOrder));
    auto at = jet<3>(r.profile, box[1].middle());
    at.d[0] -= r.origin;
    const double half = box[1].length() / 2, grow = 1 + 64 * kUnitRoundoff;
    const double slip =
        value_error_bound(r.profile, {box[1]}) + 8 * kUnitRoundoff * (max_abs(r.origin) + norm(at.d[0]));
    DerivativeBounds<2> out;
    for (int j = 0; j <= order; ++j) {
        double across = c.d[std::size_t(j)];
        if (j < kBoundOrder) {
            const double here = norm(cross(r.axis, at.d[std::size_t(j)])) + half * c.d[std::size_t(j) + 1] +
                                (j == 0 ? slip : 0);
            across = j == 0 ? here : std::min(across, here);
        }
        for (int i = 0; i + j <= order; ++i)
            out.d[jet_slot(Index<2>{i, j})] = grow * (i == 0 ? c.d[std::size_t(j)] : across);
    }
    out.d[0] = out.d[1] * box[0].length() / 2 + c.d[0];
    return out;
}

// n . C^(k)(m + s) = cos s (n . C^(k)(m)) + sin s (n . C^(k+1)(m)) of an ellipse about its centre.
template <int D>
DerivativeBounds<1> bounds_along(const Conic<D>& c, const Vec<D>& n, Interval on) {
    DerivativeBounds<1> out = bounds_of(c, on);
    if (c.kind != ConicKind::ellipse) return out;
    const double x = dot(n, c.x), y = dot(n, c.y), m = on.middle(), turn = std::min(1.0, on.length() / 2);
    const double slip = 16 * kUnitRoundoff * (norm(c.x) + norm(c.y));
    const double even = std::abs(std::cos(m) * x + std::sin(m) * y) + slip;
    const double odd = std::abs(std::cos(m) * y - std::sin(m) * x) + slip;
    for (std::size_t k = 1; k < 4; ++k)
        out.d[k] =
            std::min(out.d[k], (k == 2 ? even + turn * odd : odd + turn * even) * (1 + 64 * kUnitRoundoff));
    return out;
}
template <int D>
DerivativeBounds<1> bounds_along(const Line<D>& line, const Vec<D>& n, Interval on) {
    DerivativeBounds<1> out = bounds_of(line, on);
    out.d[1] = std::abs(dot(n, line.direction)) + 8 * kUnitRoundoff * norm(line.direction);
    return out;
}

inline DerivativeBounds<2> bounds_along(const Extrusion& e, const Vec<3>& n,
                                        const DerivativeQuery<1, 3>& profile,
                                        const std::array<Interval, 2>& box, int order) {
    const auto c = profile.along(n, {box[0]}, order);
    DerivativeBounds<2> out;
    for (int i = 0; i <= order; ++i) out.d[jet_slot(Index<2>{i, 0})] = c.d[std::size_t(i)];
    out.d[2] = std::abs(dot(n, e.direction)) + 8 * kUnitRoundoff * norm(e.direction);
    out.d[0] += out.d[2] * box[1].length() / 2;
    return out;
}

inline DerivativeBounds<2> bounds_along(const Revolution& r, const Vec<3>& n,
                                        const DerivativeQuery<1, 3>& profile,
                                        const std::array<Interval, 2>& box, int order,
                                        const DerivativeBounds<2>& full) {
    const double u = box[0].middle(), half = box[0].length() / 2, turn = std::min(1.0, half);
    const double less = std::min(2.0, half * half / 2);
    const Vec<3> straight = dot(n, r.axis) * r.axis, out_of = n - straight;
    const Vec<3> w = std::cos(u) * out_of - std::sin(u) * cross(r.axis, out_of), turned = -cross(r.axis, w);
    const auto a = profile.along(w, {box[1]}, order), b = profile.along(turned, {box[1]}, order),
               c = profile.along(straight + w, {box[1]}, order);
    const Vec<3> middle = jet<0>(r.profile, box[1].middle()).value() - r.origin;
    const auto of = [&](const DerivativeBounds<1>& d, const Vec<3>& along, int j) {
        return j > 0 ? d.d[std::size_t(j)] : std::abs(dot(along, middle)) + d.d[1] * (box[1].length() / 2);
    };
    // Rounding of w, turned and the middle: a few units of the last place of what they are multiplied by.
    const double slip =
        3 * value_error_bound(r.profile, {box[1]}) + 64 * kUnitRoundoff * (max_abs(r.origin) + norm(middle));
    DerivativeBounds<2> out;
    for (int i = 0; i <= order; ++i)
        for (int j = 0; i + j <= order; ++j) {
            const std::size_t slot = jet_slot(Index<2>{i, j});
            const double even = of(a, w, j), odd = of(b, turned, j);
            const double most = i == 0       ? of(c, straight + w, j) + less * even + turn * odd
                                : i % 2 == 0 ? even + turn * odd
                                             : odd + turn * even;
            out.d[slot] =
                std::min(full.d[slot], most + 64 * kUnitRoundoff * full.d[slot] + (j == 0 ? slip : 0));
        }
    out.d[0] = full.d[0];
    return out;
}

inline DerivativeBounds<2> bounds_of(const OffsetSurface& o, const DerivativeQuery<2, 3>& base,
                                     const std::array<Interval, 2>& box) {
    const auto s = base(box, 3);
    const auto& S = s.d;
    const double mu = S[3] * S[2] + S[1] * S[4], mv = S[4] * S[2] + S[1] * S[5];
    const double second[3] = {S[6] * S[2] + 2 * S[3] * S[4] + S[1] * S[7],
                              S[7] * S[2] + S[3] * S[5] + S[1] * S[8],
                              S[8] * S[2] + 2 * S[4] * S[5] + S[1] * S[9]};
    const auto at = jet<1>(*o.base, {box[0].middle(), box[1].middle()});
    const double least =
        norm(cross(at.d[1], at.d[2])) * (1 - 1e-12) - mu * box[0].length() / 2 - mv * box[1].length() / 2;
    DerivativeBounds<2> out;
    out.d.fill(kInfinity);
    if (!(least > 0)) return out;
    const double d = std::abs(o.distance), m[2] = {mu, mv}, grow = 1 + 64 * kUnitRoundoff;
    out.d[0] = S[0] + 2 * d;
    for (int a = 0; a < 2; ++a) out.d[std::size_t(1 + a)] = grow * (S[std::size_t(1 + a)] + d * m[a] / least);
    for (int k = 0; k < 3; ++k)
        out.d[std::size_t(3 + k)] =
            grow *
            (S[std::size_t(3 + k)] + d * (second[k] / least + 3 * m[k == 2] * m[k >= 1] / (least * least)));
    return out;
}

}  // namespace freiform::detail
