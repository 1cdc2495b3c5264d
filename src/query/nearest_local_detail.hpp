// F = |x - q|^2 W^2 - T W^2 on a part of a piece, made from the coefficients there and not from F on the
// whole.
//
// Idea. Halving F keeps its rounding, u M with M of the size of the piece, however small a part becomes:
// squares of distances below that, and parts whose weights are far below the heaviest, drown in it. Here R =
// N - q' W and W are restricted to the part first. Their rounding is u times what they are made of, R is as
// small as the part is near, and products of R round by u |R|^2.
//
// Notation: nearest_search.cpp. b(i) >= 0: weights of the restriction, w = max |W| on the part,
// S = max (|N_i| / W_i) + |q'|.
//
// Accuracy. R_i: 2 u (|N_i| + |q'| W_i). A restriction of degree p takes p steps (1 - t) a + t b, 3 roundings
// each. So with g = 1.01 (3 sum p_d + 3) u the error of a coefficient of R is at most
//     g sum b(i) (|N_i| + |q'| W_i) <= g sum b(i) W_i S <= d = g w S,
// and W is right up to its g-fold. Products: | |R + e|^2 - |R|^2 | <= 2 |R| d + d^2; T W^2: 3 g T w^2.
// Everything after that rounds as in nearest_search.cpp, with max(|R|^2, T w^2) in place of M.
#pragma once
#include "query/nearest_foot_detail.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/spline/jet.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

namespace freiform::detail {

// Along the middle axis of [outer][p + 1][inner], on [lo, hi]: p + 1 coefficients again, or one if lo == hi.
inline std::vector<double> restricted_along(const std::vector<double>& a, std::size_t outer, std::size_t p,
                                            std::size_t inner, double lo, double hi) {
    const std::size_t m = lo == hi ? 0 : p;
    std::vector<double> out(outer * (m + 1) * inner);
    double at_lo[kMostTaps], at_hi[kMostTaps];
    const auto step = [](double* c, std::size_t count, double t) {
        for (std::size_t i = 0; i < count; ++i) c[i] = (1 - t) * c[i] + t * c[i + 1];
    };
    for (std::size_t o = 0; o < outer; ++o)
        for (std::size_t at = 0; at < inner; ++at) {
            for (std::size_t i = 0; i <= p; ++i) at_lo[i] = a[(o * (p + 1) + i) * inner + at];
            // Coefficient k: the blossom of hi, k times, and lo.
            for (std::size_t k = p + 1; k-- > 0; step(at_lo, k, lo)) {
                if (k > m) continue;
                std::copy_n(at_lo, k + 1, at_hi);
                for (std::size_t left = k; left > 0; --left) step(at_hi, left, hi);
                out[(o * (m + 1) + k) * inner + at] = at_hi[0];
            }
        }
    return out;
}

// |R|^2 - T W^2 of degree 2 m_d from the coefficients (R, W) of degree m_d, which are overwritten.
template <int D>
void square_form(std::vector<double>& r, const std::array<std::size_t, kMostParams>& m, double t,
                 double* out) {
    constexpr std::size_t kStride = D + 1;
    // Coefficients times binomials: the products of two polynomials are sums without weights.
    const auto binomials = [&](std::size_t i, std::size_t by) {
        double product = 1;
        for (std::size_t axis = kMostParams; axis-- > 0; i /= by * m[axis] + 1)
            product *= binomial(int(by * m[axis]), int(i % (by * m[axis] + 1)));
        return product;
    };
    for (std::size_t i = 0; i < r.size(); ++i) r[i] *= binomials(i / kStride, 1);
    const std::size_t n1 = m[1] + 1, n2 = m[2] + 1, count = (2 * m[0] + 1) * (2 * m[1] + 1) * (2 * m[2] + 1);
    const auto doubled = [&](std::size_t i) {  // where coefficient i lies among those of degree 2 m_d
        return (i / (n1 * n2) * (2 * m[1] + 1) + i / n2 % n1) * (2 * m[2] + 1) + i % n2;
    };
    std::fill_n(out, count, 0.0);
    for (std::size_t i = 0; i < r.size() / kStride; ++i)
        for (std::size_t j = 0; j <= i; ++j) {
            const double *x = r.data() + i * kStride, *y = r.data() + j * kStride;
            double dot = -t * (x[D] * y[D]);
            for (std::size_t k = 0; k < std::size_t(D); ++k) dot += x[k] * y[k];
            out[doubled(i) + doubled(j)] += i == j ? dot : 2 * dot;
        }
    for (std::size_t i = 0; i < count; ++i) out[i] /= binomials(i, 2);
}

struct LocalForm {
    double magnitude = 0;               // max(|R|^2, T w^2)
    double offset = 0;                  // bound: of the error of F that comes with R and W
    double lightest = 0, heaviest = 0;  // bounds of W on the part
};

// Writes F on [lo, hi], of degree 2 degree[d] along the axis d, where degree[d] == 0 if lo[d] == hi[d].
template <int D>
LocalForm local_form(const SeenPiece<D>& seen, const NearestTree::Parameters& lo,
                     const NearestTree::Parameters& hi, const std::array<int, kMostParams>& degree, double t,
                     double* out) {
    constexpr std::size_t kStride = D + 1;
    const NearestTree::Piece& piece = *seen.piece;
    std::vector<double> r(seen.coefficients, seen.coefficients + piece.control_points() * kStride);
    double off = 0, spread = 0;
    for (std::size_t k = 0; k < std::size_t(D); ++k) off += seen.local[k] * seen.local[k];
    for (std::size_t i = 0; i < r.size(); i += kStride) {
        double square = 0;
        for (std::size_t k = 0; k < std::size_t(D); ++k) {
            square += r[i + k] * r[i + k];
            r[i + k] -= seen.local[k] * r[i + D];
        }
        spread = std::max(spread, std::sqrt(square) / r[i + D]);
    }
    std::array<std::size_t, kMostParams> m{};
    std::size_t outer = 1, inner = r.size(), degrees = 0;
    for (std::size_t d = 0; d < std::size_t(piece.params); ++d) {
        const std::size_t p = std::size_t(piece.degree[d]);
        inner /= p + 1;
        r = restricted_along(r, outer, p, inner, lo[d], degree[d] == 0 ? lo[d] : hi[d]);
        m[d] = std::size_t(degree[d]);
        outer *= m[d] + 1;
        degrees += p;
    }
    double most = 0, heavy = 0, light = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < r.size(); i += kStride) {
        double square = 0;
        for (std::size_t k = 0; k < std::size_t(D); ++k) square += r[i + k] * r[i + k];
        most = std::max(most, square);
        heavy = std::max(heavy, r[i + D]);
        light = std::min(light, r[i + D]);
    }
    const double g = 1.01 * (3 * double(degrees) + 3) * kUnitRoundoff;
    const double d = g * heavy * (1 + 2 * g) * (spread + std::sqrt(off)) * (1 + 8 * kUnitRoundoff);
    most *= 1 + 8 * kUnitRoundoff;
    const double square = heavy * heavy * (1 + 4 * g);
    square_form<D>(r, m, t, out);
    return {std::max(most, t * square), 2 * std::sqrt(most) * d + d * d + 3 * g * t * square,
            light * (1 - 2 * g), heavy * (1 + 2 * g)};
}

}  // namespace freiform::detail
