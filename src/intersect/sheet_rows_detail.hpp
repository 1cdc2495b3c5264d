// Sums over the control points of one Bezier piece of a sheet (sheet_detail.hpp): values, halves,
// restrictions and boxes of derivatives. Of pairs of bicubic surfaces, the commonest, about a third of the
// time went here, so for these the degrees are constants; the same text does for all others.
#pragma once
#include "sheet_detail.hpp"

#include <type_traits>

namespace freiform::detail {

// f(n, m) with the degrees; as constants where both are 3, the commonest, so that loops over them unroll.
template <class F>
auto with_degrees(const std::array<int, 2>& degree, F&& f) {
    using Cubic = std::integral_constant<int, 3>;
    if (degree[0] == 3 && degree[1] == 3) return f(Cubic{}, Cubic{});
    return f(degree[0], degree[1]);
}

// Values and derivatives of the Bernstein polynomials of degree n.
struct BernsteinRow {
    std::array<double, kMaxDegree + 1> b, d;
    BernsteinRow(std::integral_constant<int, 3>, double t) {
        const double s = 1 - t, ss = s * s, st = 2 * s * t, tt = t * t;
        b[0] = s * ss, b[1] = 3 * t * ss, b[2] = 3 * s * tt, b[3] = t * tt;
        d[0] = -3 * ss, d[1] = 3 * (ss - st), d[2] = 3 * (st - tt), d[3] = 3 * tt;
    }
    BernsteinRow(int n, double t) {
        const double s = 1 - t;
        b[0] = 1;
        for (int r = 1; r <= n; ++r) {
            if (r == n)
                for (int i = 0; i <= n; ++i)
                    d[std::size_t(i)] =
                        n * ((i > 0 ? b[std::size_t(i) - 1] : 0) - (i < n ? b[std::size_t(i)] : 0));
            double carry = 0;
            for (std::size_t i = 0; i < std::size_t(r); ++i) {
                const double x = b[i];
                b[i] = carry + s * x;
                carry = t * x;
            }
            b[std::size_t(r)] = carry;
        }
        if (n == 0) d[0] = 0;
    }
};

// Four coordinates, two at once: what every processor has.
struct Four {
    using Two [[gnu::vector_size(16)]] = double;
    Two lo{}, hi{};
    void add(double by, const Hom<3>& p) { lo += by * Two{p.c[0], p.c[1]}, hi += by * Two{p.c[2], p.c[3]}; }
    void add(double by, const Four& x) { lo += by * x.lo, hi += by * x.hi; }
    double operator[](std::size_t k) const { return k < 2 ? lo[k] : hi[k - 2]; }
};

// Halves of one row of control points: `left` begins as a copy.
inline void halve_row(Hom<3>* left, Hom<3>* right, int n, int stride) {
    for (int i = 0; i <= n; ++i) right[i * stride] = left[i * stride];
    for (int r = 1; r <= n; ++r) {
        for (int k = 0; k <= n - r; ++k)
            right[k * stride] = 0.5 * (right[k * stride] + right[(k + 1) * stride]);
        left[r * stride] = right[0];
    }
}
// The same at another place: three roundings for each step.
inline void divide_row(Hom<3>* left, Hom<3>* right, int n, int stride, double t) {
    for (int i = 0; i <= n; ++i) right[i * stride] = left[i * stride];
    for (int r = 1; r <= n; ++r) {
        for (int k = 0; k <= n - r; ++k)
            right[k * stride] = (1 - t) * right[k * stride] + t * right[(k + 1) * stride];
        left[r * stride] = right[0];
    }
}

// The row over [lo, hi] of [0, 1], or beyond.
template <class Degree>
void restrict_row(Hom<3>* p, Degree degree, int stride, Interval on) {
    const int n = degree;
    const auto blend = [&](int i, int j, double t) {
        for (int c = 0; c < 4; ++c) p[i * stride][c] = (1 - t) * p[i * stride][c] + t * p[j * stride][c];
    };
    if (on.hi != 1) {
        for (int r = 1; r <= n; ++r)
            for (int i = n; i >= r; --i) {
                for (int c = 0; c < 4; ++c)
                    p[i * stride][c] = (1 - on.hi) * p[(i - 1) * stride][c] + on.hi * p[i * stride][c];
            }
    }
    if (on.lo != 0) {
        const double t = on.lo / on.hi;
        for (int r = 1; r <= n; ++r)
            for (int i = 0; i <= n - r; ++i) blend(i, i + 1, t);
    }
}

// Of one axis, from control points within the middle m and reach; the weights are within w.
template <std::size_t axis, class N, class M>
SlopeBox slope_box(const Hom<3>* net, N n, M m, const Vec<3>& middle, const Vec<3>& reach, Interval w,
                   double width, double rounding) {
    SlopeBox own;
    const int stride = m + 1, step = axis == 0 ? stride : 1, degree = axis == 0 ? int(n) : int(m);
    const double w_mid = w.middle(), factor = degree / (w_mid * width);
    double dw = 0;
    for (int r = 0; r <= n - (axis == 0); ++r)
        for (int s = 0; s <= m - (axis == 1); ++s) {
            const Hom<3>&p = net[r * stride + s], &q = net[r * stride + s + step];
            const double dv = q.weight() - p.weight();
            dw = std::max(dw, std::abs(dv));
            for (int k = 0; k < 3; ++k) {
                const double d = factor * ((q[k] - p[k]) - middle[k] * dv);
                own.lo[k] = std::min(own.lo[k], d), own.hi[k] = std::max(own.hi[k], d);
            }
        }
    if (degree == 0) own.lo = own.hi = Vec<3>{};
    const double varies = w.length() / (2 * w.lo);
    for (int k = 0; k < 3; ++k) {
        const double more = 1.01 * (varies * std::max(std::abs(own.lo[k]), std::abs(own.hi[k])) +
                                    reach[k] * dw * factor * w_mid / w.lo + degree * rounding / width);
        own.lo[k] -= more, own.hi[k] += more;
    }
    return own;
}

}  // namespace freiform::detail
