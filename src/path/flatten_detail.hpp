// What the methods of flattening share: how far a Bezier block may be from a segment.
//
// Notation: segment a + x e / |e|, 0 <= x <= |e|; a block has coefficients b_i with weights w_i > 0, d_i =
// b_i - a, split into x_i along the segment and q_i across it; K = p (p - 1) / 8.
//
// Two bounds, of which the smaller one is taken:
//  - The distance from a segment is a convex function, and the block lies in the convex hull of the b_i: the
//    largest distance of a b_i.
//  - Across the segment the curve is N / W with N = sum B_i w_i (q_i - q_0) relative to q_0. Linear
//    interpolation between the ends of N is off by at most max |N''| / 8 <= K max |second difference of N_i|,
//    the same for W. The quotient of the two linear functions runs from q_0 to q_p along a segment, so
//        |N/W - N_lin/W_lin| <= (|N - N_lin| + |q_p - q_0| |W - W_lin|) / W
//    and the distance across is at most max(|q_0|, |q_p|) plus that. What sticks out beyond the ends of the
//    segment is at most the largest overshoot of an x_i. On short parts this is twice as good for quadratic
//    curves, and tends to the true distance for all.
// Halving a block and taking the larger of the parts makes both tend to the true distance quadratically.
//
// The other direction: the projection of a part of the curve to the line of its segment is continuous and
// runs from one end of it to the other, so every point of the segment has a point of the curve above it,
// within the same bound.
//
// Rounding: a difference 1, x_i and q_i at most 2 D + 4 roundings relative to |d|, second differences 4
// terms: below 16 u max|d| and 100 u K max|d| w_max / w_min. The coefficients themselves: Chain::error.
#pragma once
#include <freiform/core/constants.hpp>
#include <freiform/path/flatten.hpp>
#include <freiform/spline/chain.hpp>

namespace freiform::detail {

template <int D>
struct Segment {
    Vec<D> a{}, direction{};
    double length = 0;

    Segment(const Vec<D>& from, const Vec<D>& to) : a(from), length(norm(to - from)) {
        direction = unit(to - from);
    }
};

inline double root_of_squares(double a, double b) { return std::sqrt(a * a + b * b); }

// Distance of x from the segment.
template <int D>
double distance(const Vec<D>& x, const Segment<D>& s) {
    const Vec<D> d = x - s.a;
    const double along = dot(d, s.direction);
    const double over = std::max({0.0, -along, along - s.length});
    return root_of_squares(norm(d - along * s.direction), over);
}

// Upper bound of the distance between the block and the segment, rounding of the formula included.
template <class P>
double distance_bound(std::span<const P> b, const Segment<Space<P>::kDim>& s) {
    constexpr int D = Space<P>::kDim;
    const int p = int(b.size()) - 1;
    const double k = p * (p - 1) / 8.0;
    Vec<D> n[kMaxDegree + 1], first{}, last{};
    double hull = 0, over = 0, far = 0, weight_min = Space<P>::weight(b[0]), weight_max = weight_min;
    for (int i = 0; i <= p; ++i) {
        const Vec<D> d = project(b[std::size_t(i)]) - s.a;
        const double along = dot(d, s.direction), w = Space<P>::weight(b[std::size_t(i)]);
        const Vec<D> q = d - along * s.direction;
        const double beyond = std::max({0.0, -along, along - s.length}), across = dot(q, q);
        hull = std::max(hull, across + beyond * beyond);
        over = std::max(over, beyond);
        far = std::max(far, dot(d, d));
        if (i == 0) first = q;
        last = q;
        n[i] = q;
        if constexpr (Space<P>::kRational) n[i] = w * (q - first);
        weight_min = std::min(weight_min, w);
        weight_max = std::max(weight_max, w);
    }
    hull = std::sqrt(hull);
    far = std::sqrt(far);
    double bend = 0, weight_bend = 0;
    for (int i = 0; i + 2 <= p; ++i) {
        const Vec<D> second = (n[i + 2] - n[i + 1]) - (n[i + 1] - n[i]);
        bend = std::max(bend, dot(second, second));
        if constexpr (Space<P>::kRational) {
            const auto at = std::size_t(i);
            weight_bend = std::max(weight_bend, std::abs((b[at + 2].weight() - b[at + 1].weight()) -
                                                         (b[at + 1].weight() - b[at].weight())));
        }
    }
    double across = k * std::sqrt(bend);
    if constexpr (Space<P>::kRational) across += norm(last - first) * k * weight_bend;
    across = across / weight_min + 100 * kUnitRoundoff * k * far * (weight_max / weight_min);
    across += std::sqrt(std::max(dot(first, first), dot(last, last)));
    const double tight = root_of_squares(across, over);
    const double bound = hull < tight ? hull : tight;  // a NaN in `tight` loses
    return (bound + 16 * kUnitRoundoff * far) * (1 + 16 * kUnitRoundoff);
}

// The same for functions of one parameter: |b(u) - l(u)| with l linear from l0 to l1. In Bernstein form of
// degree p + 1, W l and N have the coefficients ((p + 1 - j) .. + j ..) / (p + 1), so their difference has
//     E_j = ((p + 1 - j) (A_j - w_j l0) + j (A_{j-1} - w_{j-1} l1)) / (p + 1).
template <class P>
double difference_bound(std::span<const P> b, const PointOf<P>& l0, const PointOf<P>& l1) {
    constexpr int D = Space<P>::kDim;
    const int p = int(b.size()) - 1;
    Vec<D> e[kMaxDegree + 2];
    double hull = 0, far = 0, weight_min = Space<P>::weight(b[0]), weight_max = weight_min;
    for (int j = 0; j <= p + 1; ++j) {
        if (j <= p) {
            const P& a = b[std::size_t(j)];
            const double w = Space<P>::weight(a);
            for (int c = 0; c < D; ++c) e[j][c] = double(p + 1 - j) / (p + 1) * (a[c] - w * l0[c]);
            weight_min = std::min(weight_min, w);
            weight_max = std::max(weight_max, w);
            far = std::max(far, max_abs(project(a)));
        }
        if (j > 0) {
            const P& a = b[std::size_t(j) - 1];
            for (int c = 0; c < D; ++c) e[j][c] += double(j) / (p + 1) * (a[c] - Space<P>::weight(a) * l1[c]);
        }
        hull = std::max(hull, norm(e[j]));
    }
    far = std::max({far, max_abs(l0), max_abs(l1)});
    double bend = 0;
    for (int j = 0; j + 2 <= p + 1; ++j) bend = std::max(bend, norm(e[j] - 2 * e[j + 1] + e[j + 2]));
    const double k = (p + 1) * p / 8.0;
    const double tight = std::max(norm(e[0]), norm(e[p + 1])) + k * bend;
    return (std::min(hull, tight) + 64 * kUnitRoundoff * (1 + k) * far * weight_max) / weight_min *
           (1 + 16 * kUnitRoundoff);
}

// b becomes the left half, right the right half: p roundings.
template <class P>
void halve(std::span<P> b, std::span<P> right) {
    const std::size_t n = b.size();
    for (std::size_t r = 0; r < n; ++r) {
        right[n - 1 - r] = b[n - 1];
        for (std::size_t i = n - 1; i > r; --i) b[i] = 0.5 * b[i - 1] + 0.5 * b[i];
    }
}

// Bound of |c''| over the whole of a block of width 1 in its parameter, and how it is used: linear
// interpolation on a step h is off by at most h^2 / 8 of it.
template <class P>
double second_derivative(std::span<const P> b);

// The count of equal steps for which linear interpolation of the piece is within `tolerance` > 0.
inline double steps_for(double second, double tolerance) {
    return std::max(1.0, std::ceil(std::sqrt(second / (8 * tolerance)) * (1 + 8 * kUnitRoundoff)));
}

Result<void> check_options(const FlattenOptions& options);

template <class P>
Result<Polyline<Space<P>::kDim>> flatten_adaptive(const Chain<P>& chain, double tolerance, std::size_t most);
template <class P>
Result<Polyline<Space<P>::kDim>> flatten_uniform(const Chain<P>& chain, const FlattenOptions& options,
                                                 double tolerance);
template <class P>
Result<Polyline<Space<P>::kDim>> flatten_halving(const Chain<P>& chain, const FlattenOptions& options,
                                                 double tolerance);

// Of the tolerance in divided units nothing is left after the rounding of what is computed from the pieces.
template <class P>
std::unexpected<Refusal> below_rounding(const Chain<P>& chain, double tolerance, double least) {
    return refuse(RefusalKind::ill_conditioned, "tolerance",
                  text(std::scalbn(tolerance, chain.exponent()),
                       " is below the rounding of the curve's coordinates; the smallest that can be proven "
                       "is about ",
                       std::scalbn(least, chain.exponent())));
}

// A number of segments that suffices for every method.
template <class P>
double sufficient_segments(const Chain<P>& chain, double tolerance) {
    double sum = 0;
    for (int i = 0; i < chain.pieces(); ++i)
        sum += steps_for(second_derivative<P>(chain.piece(i)), tolerance);
    return sum;
}
template <class P>
std::unexpected<Refusal> too_many(const Chain<P>& chain, double tolerance, std::size_t most) {
    return refuse(RefusalKind::limit, "max_segments",
                  text("more than ", most, " segments are needed; ", sufficient_segments(chain, tolerance),
                       " suffice"));
}

}  // namespace freiform::detail
