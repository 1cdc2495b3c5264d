// Bounds of derivatives of lines and conics, of what profiles sweep, and of offsets.
//
// Offsets: O = S + d n, n = m / |m|, m = S_u x S_v. L is a lower bound of |m| on the box: |m| at its middle
// less the variation by m_u, m_v; |n_a| <= |m_a| / L to begin with. Better, since n_a is tangent and n_a .
// S_b = -n . S_ab, and a tangent vector t is at most (|t . S_u| |S_v| + |t . S_v| |S_u|) / |m| long:
//     |n_a| <= (|n . S_au| |S_v| + |n . S_av| |S_u|) / L,    |n . S_ab| <= |n0 . S_ab| + e |S_ab|
// for the normal n0 in the middle and e >= |n - n0|. Likewise n_ab, whose part across is -n_a . n_b, and
// n_ab . S_c = -(n_a . S_bc + n_b . S_ac + n . S_abc). Along a vector w of length 1, e >= |w - n|:
//     |w . n_a| <= e |n_a|,    |w . n_ab| <= |n_a| |n_b| + e |n_ab|.
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
#include <utility>

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

// The unit normal of a surface over a box: at its middle, and bounds of its derivatives; `all` are those of
// the surface. Infinite where the normal may vanish.
struct NormalBounds {
    NormalBounds(const DerivativeQuery<2, 3>& surface, const std::array<Interval, 2>& box);
    // Of |n - the normal|, or of what stands the other way.
    double beside(const Vec<3>& n) const {
        return std::min(norm(n - middle), norm(n + middle)) + first[0] * half[0] + first[1] * half[1] + slip;
    }
    DerivativeBounds<2> all;
    Vec<3> middle{};
    double slip = kInfinity;  // the rounding of `middle`, and more
    double least = 0;         // of |S_u x S_v|
    double half[2], first[2] = {kInfinity, kInfinity}, second[3] = {kInfinity, kInfinity, kInfinity};
};

inline NormalBounds::NormalBounds(const DerivativeQuery<2, 3>& surface, const std::array<Interval, 2>& box)
    : half{box[0].length() / 2, box[1].length() / 2} {
    const auto at = jet<1>(surface.geometry(), {box[0].middle(), box[1].middle()});
    const Vec<3> across = cross(at.d[1], at.d[2]);
    const bool regular = norm(across) > 0;
    middle = regular ? unit(across) : Vec<3>{{0, 0, 1}};
    const auto [whole, along] = surface.both(middle, box, 3);
    all = whole;
    const auto &S = all.d, &A = along.d;
    const double m[2] = {S[3] * S[2] + S[1] * S[4], S[4] * S[2] + S[1] * S[5]};
    // First derivatives are rounded as values divided by the thinnest piece are, for each degree.
    const double value = 64 * surface.value_error(box);
    const double rounding = value / surface.thinnest_piece(0) * S[2] +
                            value / surface.thinnest_piece(1) * S[1] + 64 * kUnitRoundoff * S[1] * S[2];
    least = norm(across) - rounding - m[0] * half[0] - m[1] * half[1];
    if (!regular || !(least > 0)) return;
    slip = 2 * rounding / least + 64 * kUnitRoundoff;
    for (int a = 0; a < 2; ++a) first[a] = m[a] / least;
    const double grow = 1 + 64 * kUnitRoundoff;
    const auto seen = [&](std::size_t k) { return A[k] + beside(middle) * S[k]; };
    // In the tangent plane, from its parts along S_u and S_v.
    const auto from_parts = [&](double u, double v) { return grow * (u * S[2] + v * S[1]) / least; };
    for (int round = 0; round < 2; ++round) {
        const double uu = seen(3), uv = seen(4), vv = seen(5);
        first[0] = std::min(first[0], from_parts(uu, uv));
        first[1] = std::min(first[1], from_parts(uv, vv));
    }
    for (std::size_t k = 0; k < 3; ++k) {
        const std::size_t a = k == 2, b = k >= 1;
        const auto part = [&](std::size_t c) {
            return first[a] * S[3 + b + c] + first[b] * S[3 + a + c] + seen(6 + a + b + c);
        };
        second[k] = first[a] * first[b] + from_parts(part(0), part(1));
    }
}

inline DerivativeBounds<2> bounds_of(const OffsetSurface& o, const NormalBounds& n) {
    const auto& s = n.all.d;
    DerivativeBounds<2> out;
    out.d.fill(kInfinity);
    if (!std::isfinite(n.first[0])) return out;
    const double d = std::abs(o.distance), grow = 1 + 64 * kUnitRoundoff;
    out.d[0] = s[0] + 2 * d;
    for (std::size_t a = 0; a < 2; ++a) out.d[1 + a] = grow * (s[1 + a] + d * n.first[a]);
    for (std::size_t k = 0; k < 3; ++k) out.d[3 + k] = grow * (s[3 + k] + d * n.second[k]);
    return out;
}

inline DerivativeBounds<2> bounds_along(const OffsetSurface& o, const Vec<3>& w,
                                        const DerivativeQuery<2, 3>& base, const NormalBounds& n,
                                        const std::array<Interval, 2>& box) {
    DerivativeBounds<2> out = bounds_of(o, n);
    if (!std::isfinite(n.first[0])) return out;
    const auto s = base.along(w, box, 2);
    const double d = std::abs(o.distance), grow = 1 + 64 * kUnitRoundoff, beside = n.beside(w);
    for (std::size_t a = 0; a < 2; ++a)
        out.d[1 + a] = std::min(out.d[1 + a], grow * (s.d[1 + a] + d * beside * n.first[a]));
    for (std::size_t k = 0; k < 3; ++k)
        out.d[3 + k] =
            std::min(out.d[3 + k],
                     grow * (s.d[3 + k] + d * (n.first[k == 2] * n.first[k >= 1] + beside * n.second[k])));
    return out;
}

// Of all, and along w.
inline std::pair<DerivativeBounds<2>, DerivativeBounds<2>> bounds_of_both(
    const OffsetSurface& o, const Vec<3>& w, const DerivativeQuery<2, 3>& base,
    const std::array<Interval, 2>& box) {
    const NormalBounds n(base, box);
    return {bounds_of(o, n), bounds_along(o, w, base, n, box)};
}
inline DerivativeBounds<2> bounds_of(const OffsetSurface& o, const DerivativeQuery<2, 3>& base,
                                     const std::array<Interval, 2>& box) {
    return bounds_of(o, NormalBounds(base, box));
}

}  // namespace freiform::detail
