// The integral of the winding number of a path, by Green's formula.
//
// Idea. Twice the area is the sum of cross(p, q) over the chords pq, and of what each segment adds beside its
// chord, with c_ij = cross(p_i - p_0, p_j - p_0):
//     quadratic, weights 1, w, 1     g(w) c_12,    g(1) = 2/3
//     cubic                          (3 c_12 + 3 c_13 + 6 c_23) / 10
//
// Conics. An arc is the affine image of one of the unit circle with the half angle a, cos a = w; beside its
// chord lies a - sin a cos a of sin^3 a / cos a for the triangle. With x = sin^2 a = 1 - w^2, negative for
// hyperbolas:
//     g = w f(x),   f = (asin sqrt x - sqrt(x (1 - x))) / x^(3/2)
//                     = sum_{k>=1} C(2k, k) 4^-k 4k / (4k^2 - 1) x^(k-1)
// (for x < 0 with the hyperbolic functions). The series is taken for |x| <= 1/4: 26 terms leave 4^-26.
//
// Cubics. The integral of cross(C - p_0, C') by the integrals of products of Bernstein polynomials.
//
// Accuracy. Sums and products in double-double: 2^-95 of the sum of magnitudes. What is rounded to doubles is
// f(x), to 64 u (the closed form loses a factor of at most 8 by cancellation for |x| > 1/4, its functions are
// off by 2 u), and the result.
#include "arcs_detail.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/core/double_double.hpp>

#include <cmath>

namespace freiform {

namespace {

struct Sum {
    DoubleDouble value;
    double magnitude = 0, off = 0;
};

DoubleDouble exact_cross(const Vec<2>& o, const Vec<2>& a, const Vec<2>& b) {
    const auto minus = [](double x, double y) { return DoubleDouble(x) - DoubleDouble(y); };
    return minus(a[0], o[0]) * minus(b[1], o[1]) - minus(a[1], o[1]) * minus(b[0], o[0]);
}

double conic_factor(double w) {
    const double x = (1 - w) * (1 + w);
    if (std::abs(x) <= 0.25) {
        double sum = 0, term = 0.5, power = 1;  // C(2k, k) 4^-k, x^(k - 1)
        for (int k = 1; k <= 26; ++k) {
            sum += term * (4.0 * k) / (4.0 * k * k - 1) * power;
            term *= (2.0 * k + 1) / (2.0 * k + 2), power *= x;
        }
        return w * sum;
    }
    const double s = std::sqrt(std::abs(x));
    const double f = x > 0 ? (std::atan2(s, w) - s * w) / (s * s * s) : (s * w - std::asinh(s)) / (s * s * s);
    return w * f;
}

void add(Sum& sum, const DoubleDouble& term, double relative_error = 0) {
    sum.value += term;
    sum.magnitude += std::abs(term.hi);
    sum.off += relative_error * std::abs(term.hi);
}

// Twice the area between the segment and its chord.
void add_beside_chord(Sum& sum, const PathSegment& s) {
    const auto& p = s.points;
    if (s.degree == 2) {
        const double g = s.weight == 1 ? 0 : conic_factor(s.weight);
        const DoubleDouble c = exact_cross(p[0], p[1], p[2]);
        if (s.weight == 1)
            add(sum, DoubleDouble(2) * c / DoubleDouble(3));
        else
            add(sum, DoubleDouble(g) * c, 64 * kUnitRoundoff);
    }
    if (s.degree == 3) {
        const DoubleDouble c12 = exact_cross(p[0], p[1], p[2]), c13 = exact_cross(p[0], p[1], p[3]),
                           c23 = exact_cross(p[0], p[2], p[3]);
        add(sum, DoubleDouble(3) * c12 / DoubleDouble(10));
        add(sum, DoubleDouble(3) * c13 / DoubleDouble(10));
        add(sum, DoubleDouble(6) * c23 / DoubleDouble(10));
    }
}

}  // namespace

PathArea signed_area(const Path& path) {
    Sum sum;
    for (const Subpath& s : path.subpaths) {
        for (std::size_t k = 0; k < s.segments.size(); ++k) {
            add_beside_chord(sum, s.segments[k]);
            // The fan of chords from the start; the last one closes it.
            if (k > 0) add(sum, exact_cross(s.start, s.segments[k].front(), s.segments[k].back()));
        }
    }
    const double value = 0.5 * sum.value.rounded();
    return {value, 0.5 * (sum.off + 0x1p-90 * sum.magnitude) + kUnitRoundoff * std::abs(value)};
}

}  // namespace freiform
