// The exact sign of the orientation of four points.
//
// Idea. As in predicates.cpp: doubles and a bound of their rounding settle nearly all; else the determinant
// of the differences in numbers that do not round.
//
// Accuracy. Differences from d, each with one factor (1 + e), |e| <= u = 2^-53; products of three of them and
// the sums of six such terms carry at most 8 factors in all, so the error is at most ((1 + u)^8 - 1) P < 8.1
// u P, P the sum of the sizes of the six terms, and the computed P' is at least P (1 - u)^8: 10 u P' exceeds
// the error. Underflow: each inner product loses at most 2^-1075, times a difference that is at most the
// largest, L; each outer one 2^-1075: 6 (L + 1) 2^-1075 in all, which is below u P' where P' > 2^-1000 (L +
// 1).
//
// Why not expansions: degenerate quadruples are rare in hulls of curved shapes, the only callers.
#include <freiform/core/constants.hpp>
#include <freiform/poly/determinant.hpp>
#include <freiform/poly/exact.hpp>
#include <freiform/poly/predicates.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace freiform {

int orient3d(const Vec<3>& a, const Vec<3>& b, const Vec<3>& c, const Vec<3>& d) {
    const Vec<3> x = a - d, y = b - d, z = c - d;
    double sum = 0, size = 0;
    for (int i = 0; i < 3; ++i) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        const double p = y[j] * z[k], q = y[k] * z[j];
        sum += x[i] * (p - q);
        size += std::abs(x[i]) * (std::abs(p) + std::abs(q));
    }
    for (int i = 0; i < 3; ++i)  // in a plane across a coordinate axis
        if (x[i] == 0 && y[i] == 0 && z[i] == 0) return 0;
    const double largest = std::max({max_abs(x), max_abs(y), max_abs(z)});
    if (size > 0x1p-1000 * (largest + 1) && std::abs(sum) > 10 * kUnitRoundoff * size)  // false for NaN
        return sum > 0 ? 1 : -1;
    if (!is_finite(a) || !is_finite(b) || !is_finite(c) || !is_finite(d)) return 0;
    std::array<Exact, 9> m;
    for (std::size_t i = 0; i < 3; ++i) {
        m[i] = Exact(a[int(i)]) - Exact(d[int(i)]);
        m[3 + i] = Exact(b[int(i)]) - Exact(d[int(i)]);
        m[6 + i] = Exact(c[int(i)]) - Exact(d[int(i)]);
    }
    return determinant<Exact>(m, 3, 3).sign();
}

}  // namespace freiform
