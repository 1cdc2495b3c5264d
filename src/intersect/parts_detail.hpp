// Parts of curves and surfaces by their control points, halved where a search asks for it; halves are kept.
//
// Notation: `on` are parameters of the Bezier piece, [0, 1]; a part's own parameters run over [0, 1], too.
// Scaled by powers of two, so that the coordinates of both objects are at most 1.
//
// Accuracy. A mean of two numbers has one rounding; n of them in a row, of numbers that averaging does not
// enlarge, n u max. Of rational parts the projected point is off by (e + |x| e) / w and a quotient's
// rounding.
//
// Derivatives over a part: of polynomials they are averages of n (P_i+1 - P_i). Of X / W, with the
// middle c of the part: (X / W)' = (X - c W)' / W - (X / W - c) W' / W; the first summand is an
// average of n (d_i+1 - d_i) / W, d = X - c W, and the second is small of second order.
#pragma once
#include "arc_pieces_detail.hpp"

namespace freiform::detail {

template <std::size_t N, int D>
struct Part {
    Vec<D> lo, hi;  // box of the control points
    std::array<double, N> from{}, width{};
    double error = 0;      // of each coordinate of the control points
    double raw_error = 0;  // of each number that they are projected from
    double least_weight = 1;
    int first = 0;  // control point
    int piece = 0, left = -1;
    double extent() const {
        double e = 0;
        for (int k = 0; k < D; ++k) e = std::max(e, hi[k] - lo[k]);
        return e;
    }
};

template <std::size_t N, class P>
class PartTree {
public:
    static constexpr std::size_t kParams = N;
    static constexpr int D = Space<P>::kDim;
    static constexpr bool kRational = Space<P>::kRational;
    using Point = Vec<D>;

    void reset(const ArcPieces<N, P>& source, int exponent) {
        source_ = &source;
        degree_ = source.degree;
        block_ = source.block();
        const int light = -source.exponents.weight, small = light - exponent;
        const double w = std::scalbn(1.0, light), x = std::scalbn(1.0, small);
        // Tiny numbers are brought to 1 by powers of two that are no doubles.
        const auto times = [](double v, double factor, int power) {
            return std::isfinite(factor) ? v * factor : std::scalbn(v, power);
        };
        points_.resize(source.points.size());
        std::transform(source.points.begin(), source.points.end(), points_.begin(), [&](P p) {
            for (int k = 0; k < P::kCoords; ++k) p[k] = k < D ? times(p[k], x, small) : times(p[k], w, light);
            return p;
        });
        hull_.clear();
        parts_.clear();
        for (int i = 0; i < source.pieces(); ++i) {
            Part<N, D> part;
            part.width.fill(1);
            part.raw_error =
                std::max(times(source.error[std::size_t(i)], x, small),
                         kRational ? times(source.weight_error[std::size_t(i)], w, light) : 0.0) +
                0x1p-1060;
            part.first = i * block_;
            part.piece = i;
            finish(part);
            parts_.push_back(part);
        }
        scratch_.resize(std::size_t(block_));
    }

    const ArcPieces<N, P>& source() const { return *source_; }
    const Part<N, D>& operator[](int i) const { return parts_[std::size_t(i)]; }
    int pieces() const { return source_->pieces(); }
    int block() const { return block_; }
    const P* coefficients(int i) const { return points_.data() + (*this)[i].first; }
    const Point* hull(int i) const { return points_or_hull() + (*this)[i].first; }

    // The mean derivative along an axis: the chord, of surfaces that of the middle rows.
    Point chord(int i, int axis) const {
        const Point* p = hull(i);
        if constexpr (N == 1) {
            return p[block_ - 1] - p[0];
        } else {
            const int n = degree_[0], m = degree_[1], w = m + 1;
            return axis == 0 ? 0.5 * (p[n * w] - p[0] + p[n * w + m] - p[m])
                             : 0.5 * (p[m] - p[0] + p[n * w + m] - p[n * w]);
        }
    }
    // Calls f(d) for vectors whose averages are all derivatives along an axis up to the result, a bound for
    // each coordinate.
    template <class F>
    double slopes(int i, int axis, F&& f) const {
        const int n = degree_[std::size_t(axis)];
        const int step = N == 2 && axis == 0 ? degree_[N - 1] + 1 : 1;
        const Part<N, D>& part = (*this)[i];
        if constexpr (!kRational) {
            each_leg(axis, [&](int k) {
                f(n * (points_[std::size_t(part.first + k + step)] - points_[std::size_t(part.first + k)]));
            });
            return n * (2.02 * part.error + 4 * kUnitRoundoff);
        } else {
            const P* b = coefficients(i);
            Point c = 0.5 * (part.lo + part.hi);
            double w_lo = kInfinity, w_hi = 0, reach = 0, dw = 0, dn = 0;
            for (int k = 0; k < block_; ++k)
                w_lo = std::min(w_lo, b[k].weight()), w_hi = std::max(w_hi, b[k].weight());
            for (int k = 0; k < D; ++k) reach = std::max(reach, 0.5 * (part.hi[k] - part.lo[k]));
            const double w_mid = 0.5 * (w_lo + w_hi), room = w_lo - part.raw_error;
            if (!(room > 0)) return kInfinity;
            each_leg(axis, [&](int k) {
                Point d;
                const double wd = b[k + step].weight() - b[k].weight();
                for (int x = 0; x < D; ++x) d[x] = n / w_mid * ((b[k + step][x] - b[k][x]) - c[x] * wd);
                dw = std::max(dw, n * std::abs(wd));
                dn = std::max(dn, max_abs(d));
                f(d);
            });
            const double rounding = (part.raw_error + 2 * kUnitRoundoff) * 4.04 * n;
            return 1.01 * (dn * (w_hi - w_lo + 2 * part.raw_error) / (2 * room) +
                           (reach + part.error) * (dw + rounding) / room + rounding * 2 / room);
        }
    }

    // Value, derivatives and the error of each coordinate of the value, at parameters of a piece.
    double at(int piece, const double* t, Point& value, Point* derivative) const {
        std::copy_n(coefficients(piece), block_, scratch_.data());
        P d[N];
        if constexpr (N == 2) {
            // Rows first: values and derivatives along the second axis.
            const int w = degree_[1] + 1;
            P across[2];
            for (int r = 0; r <= degree_[0]; ++r) {
                P* row = scratch_.data() + r * w;
                collapse(row, degree_[1], 1, t[1], across[1]);
                if (w > 1) row[1] = across[1];
            }
            P ignored{};
            P* slope = scratch_.data() + 1;
            if (w > 1) {
                collapse(slope, degree_[0], w, t[0], ignored);
                d[1] = slope[0];
            } else {
                d[1] = P{};
            }
            collapse(scratch_.data(), degree_[0], w, t[0], d[0]);
        } else {
            collapse(scratch_.data(), degree_[0], 1, t[0], d[0]);
        }
        return projected(piece, t, scratch_[0], d, value, derivative);
    }

    // Halves, along the axis with the longer chord. False: parameters can not be halved any more.
    bool halve(int i) {
        if ((*this)[i].left >= 0) return true;
        const Part<N, D> whole = (*this)[i];
        int axis = 0;
        if constexpr (N == 2) axis = span_of(i, 1) > span_of(i, 0) ? 1 : 0;
        if (whole.width[std::size_t(axis)] <= 0x1p-40) return false;
        Part<N, D> left = whole, right = whole;
        left.width[std::size_t(axis)] *= 0.5;
        right.width[std::size_t(axis)] *= 0.5;
        right.from[std::size_t(axis)] += right.width[std::size_t(axis)];
        left.first = int(points_.size());
        right.first = left.first + block_;
        points_.resize(points_.size() + std::size_t(2 * block_));
        const P* from = points_.data() + whole.first;
        P *l = points_.data() + left.first, *r = points_.data() + right.first;
        std::copy_n(from, block_, r);
        const int n = degree_[std::size_t(axis)];
        if constexpr (N == 1) {
            cut(l, r, n, 1);
        } else {
            const int w = degree_[1] + 1;
            if (axis == 0)
                for (int k = 0; k < w; ++k) cut(l + k, r + k, n, w);
            else
                for (int k = 0; k <= degree_[0]; ++k) cut(l + k * w, r + k * w, n, 1);
        }
        left.raw_error = right.raw_error = 1.01 * (whole.raw_error + n * kUnitRoundoff);
        finish(left);
        finish(right);
        parts_[std::size_t(i)].left = int(parts_.size());
        parts_.push_back(left);
        parts_.push_back(right);
        return true;
    }

private:
    const Point* points_or_hull() const {
        if constexpr (kRational)
            return hull_.data();
        else
            return points_.data();
    }
    template <class F>
    void each_leg(int axis, F&& f) const {
        if constexpr (N == 1) {
            for (int k = 0; k < degree_[0]; ++k) f(k);
        } else {
            const int w = degree_[1] + 1;
            for (int r = 0; r <= degree_[0] - (axis == 0); ++r)
                for (int k = 0; k < w - (axis == 1); ++k) f(r * w + k);
        }
    }
    // The longest leg along an axis, times the degree.
    double span_of(int i, int axis) const {
        double most = 0;
        slopes(i, axis, [&](const Point& d) { most = std::max(most, max_abs(d)); });
        return most;
    }
    static void cut(P* left, P* right, int n, int stride) {
        left[0] = right[0];
        for (int r = 1; r <= n; ++r) {
            for (int k = 0; k <= n - r; ++k)
                right[k * stride] = 0.5 * (right[k * stride] + right[(k + 1) * stride]);
            left[r * stride] = right[0];
        }
    }
    // The value comes to b[0]. Small degrees are written out by the compiler.
    static void collapse(P* b, int n, int stride, double t, P& derivative) {
        if (n == 3 && stride == 1)
            steps(b, std::integral_constant<int, 3>(), std::integral_constant<int, 1>(), t, derivative);
        else
            steps(b, n, stride, t, derivative);
    }
    template <class Degree, class Stride>
    static void steps(P* b, Degree n, Stride stride, double t, P& derivative) {
        derivative = P{};
        const double s = 1 - t;
        for (int r = 1; r <= n; ++r) {
            if (r == n) derivative = double(n) * (b[stride] - b[0]);
            for (int k = 0; k <= n - r; ++k) {
                P &p = b[k * stride], &q = b[(k + 1) * stride];
                for (int c = 0; c < P::kCoords; ++c) p[c] = s * p[c] + t * q[c];
            }
        }
    }
    double projected(int piece, const double* t, const P& x, const P* d, Point& value,
                     Point* derivative) const {
        int degrees = 0;
        double stretch = 1;  // outside of [0, 1] numbers may grow
        for (std::size_t k = 0; k < N; ++k) {
            degrees += degree_[k];
            if (t[k] >= 0 && t[k] <= 1) continue;
            const double out = std::max(-t[k], t[k] - 1);
            for (int i = 0; i < degree_[k]; ++i) stretch *= 1 + 2 * out;
        }
        const double raw =
            stretch * (1.01 * (*this)[piece].raw_error + 1.01 * 3 * degrees * kUnitRoundoff + 0x1p-1060);
        if constexpr (!kRational) {
            value = x;
            for (std::size_t k = 0; k < N; ++k) derivative[k] = d[k];
            return raw;
        } else {
            const double w = x.weight();
            if (!(w > 2 * raw)) return kInfinity;
            for (int k = 0; k < D; ++k) value[k] = x[k] / w;
            for (std::size_t a = 0; a < N; ++a)
                for (int k = 0; k < D; ++k) derivative[a][k] = (d[a][k] - value[k] * d[a].weight()) / w;
            return 1.01 * (raw * (1 + max_abs(value)) / (w - raw) + 2 * kUnitRoundoff * max_abs(value));
        }
    }
    void finish(Part<N, D>& part) {
        part.lo = Box<D>::filled(kInfinity), part.hi = Box<D>::filled(-kInfinity);
        part.error = 1.01 * part.raw_error;
        if constexpr (kRational) {
            hull_.resize(points_.size());
            double least = kInfinity, most = 0;
            for (int k = 0; k < block_; ++k) {
                const P& p = points_[std::size_t(part.first + k)];
                const Point q = Space<P>::project(p);
                hull_[std::size_t(part.first + k)] = q;
                least = std::min(least, p.weight());
                most = std::max(most, max_abs(q));
            }
            part.least_weight = least;
            part.error = least > 2 * part.raw_error
                             ? 1.01 * (part.raw_error * (1 + most) / (least - part.raw_error) +
                                       2 * kUnitRoundoff * most)
                             : kInfinity;
        }
        const auto* h = points_or_hull();
        for (int k = 0; k < block_; ++k)
            for (int c = 0; c < D; ++c) {
                const double x = h[part.first + k][c];
                part.lo[c] = std::min(part.lo[c], x);
                part.hi[c] = std::max(part.hi[c], x);
            }
    }

    const ArcPieces<N, P>* source_ = nullptr;
    std::array<int, N> degree_{};
    int block_ = 0;
    std::vector<P> points_;
    std::vector<Point> hull_;
    std::vector<Part<N, D>> parts_;
    mutable std::vector<P> scratch_;
};

}  // namespace freiform::detail
