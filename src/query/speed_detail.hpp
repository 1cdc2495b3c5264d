// The integral of the speed |c'| over a part of a Bezier piece, with a proven bound. The essay is in
// length.cpp.
#pragma once
#include "query/gauss_detail.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/query/length.hpp>
#include <freiform/spline/chain.hpp>

namespace freiform::detail {

inline constexpr int kMostHodograph = 2 * kMaxDegree - 2;  // degree of the hodograph of a rational piece

// The speed |H| / W^2 on a part of a piece of length `width` in its local parameter, which runs over [0, 1].
template <int D>
struct SpeedBlock {
    std::array<Vec<D>, kMostHodograph + 1> h;
    std::array<Vec<1>, kMaxDegree + 1> w;
    int m = 0, p = 0;  // degrees; p = 0: polynomial, W = 1
    double width = 1;
    double h_slip = 0;  // of a coefficient of H, Euclidean
    double w_slip = 0;  // of a coefficient of W, relative

    double largest() const {
        double most = 0;
        for (int i = 0; i <= m; ++i) most = std::max(most, dot(h[std::size_t(i)], h[std::size_t(i)]));
        return std::sqrt(most) * (1 + 4 * kUnitRoundoff);
    }
    Interval weights() const {
        if (p == 0) return {1, 1};
        Interval r{w[0][0], w[0][0]};
        for (int i = 1; i <= p; ++i) r = hull(r, {w[std::size_t(i)][0], w[std::size_t(i)][0]});
        return {r.lo * (1 - 2 * w_slip), r.hi * (1 + 2 * w_slip)};
    }
    // The part on [0, y].
    SpeedBlock left(double y) const {
        SpeedBlock b = *this;
        const double v = largest();
        keep_left(Fibre<Vec<D>>{b.h.data(), m + 1, 1}, y);
        b.h_slip += 3.03 * m * kUnitRoundoff * v;
        if (p > 0) keep_left(Fibre<Vec<1>>{b.w.data(), p + 1, 1}, y), b.w_slip += 3.03 * p * kUnitRoundoff;
        b.width = width * y;
        return b;
    }
    // A part that contains [x0, x1] and begins at most 2 u x0 before it, as in Chain::cut_left.
    SpeedBlock part(double x0, double x1) const {
        SpeedBlock b = x1 < 1 ? left(x1) : *this;
        if (x0 > 0) {
            const double y = std::nextafter(x0 / x1, 0.0);
            b.h_slip += 3.03 * m * kUnitRoundoff * largest();
            keep_right(Fibre<Vec<D>>{b.h.data(), m + 1, 1}, y);
            if (p > 0)
                keep_right(Fibre<Vec<1>>{b.w.data(), p + 1, 1}, y), b.w_slip += 3.03 * p * kUnitRoundoff;
        }
        b.width = width * (x1 - x0);
        return b;
    }
    // Becomes the left half and returns the right one.
    SpeedBlock split() {
        SpeedBlock right;
        h_slip += 1.01 * m * kUnitRoundoff * largest();
        if (p > 0) w_slip += 1.01 * p * kUnitRoundoff;
        width /= 2;
        right.m = m, right.p = p, right.width = width, right.h_slip = h_slip, right.w_slip = w_slip;
        for (int r = 0; r <= m; ++r) {
            right.h[std::size_t(m - r)] = h[std::size_t(m)];
            for (int i = m; i > r; --i)
                h[std::size_t(i)] = 0.5 * h[std::size_t(i) - 1] + 0.5 * h[std::size_t(i)];
        }
        for (int r = 0; r <= p && p > 0; ++r) {
            right.w[std::size_t(p - r)] = w[std::size_t(p)];
            for (int i = p; i > r; --i)
                w[std::size_t(i)] = 0.5 * w[std::size_t(i) - 1] + 0.5 * w[std::size_t(i)];
        }
        return right;
    }
    Vec<D> hodograph(double y) const { return horner(h, m, y); }
    double weight(double y) const { return p == 0 ? 1 : horner(w, p, y)[0]; }
    double speed(double y) const {
        const Vec<D> v = hodograph(y);
        const double below = weight(y);
        return std::sqrt(dot(v, v)) / (below * below);
    }

private:
    // Horner's scheme in Bernstein form: at most 3 m + 4 roundings of convex terms.
    template <class V, std::size_t N>
    static V horner(const std::array<V, N>& b, int m, double t) {
        if (m == 0) return b[0];
        const double s = 1 - t;
        V sum = s * b[0];
        double power = 1, choose = 1;
        for (int i = 1; i < m; ++i) {
            power *= t;
            choose = choose * (m - i + 1) / i;
            sum = s * (sum + (power * choose) * b[std::size_t(i)]);
        }
        return sum + (power * t) * b[std::size_t(m)];
    }
};

// The speed of piece i of a chain.
template <class P>
SpeedBlock<Space<P>::kDim> speed_of(const Chain<P>& chain, int i);

// An interval that contains the integral over the block: from the length of the mean and the mean of the
// lengths of the coefficients.
template <int D>
Measure crude_length(const SpeedBlock<D>& b);

// By Gauss-Legendre quadrature, with the smallest rule whose truncation is proven to be at most `wanted` (or
// as small as rounding of the coefficients lets it be); an infinite bound if there is none. What rounding
// adds is in the bound and not asked about.
template <int D>
Measure gauss_length(const SpeedBlock<D>& b, double wanted);

}  // namespace freiform::detail
