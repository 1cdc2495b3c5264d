// Where a spline needs its knots.
#pragma once
#include <freiform/spline/patch.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace freiform::detail {

// |jump| of the derivative of order p at every inner break (closed: the last one is the seam's).
template <int D>
std::vector<double> jumps(const Curve<Vec<D>>& curve, const std::vector<double>& breaks) {
    const int p = curve.basis().degree();
    std::vector<Vec<D>> top;
    for (std::size_t i = 0; i + 1 < breaks.size(); ++i)
        top.push_back(curve.derivatives(breaks[i] + (breaks[i + 1] - breaks[i]) / 2, p)[std::size_t(p)]);
    std::vector<double> out;
    for (std::size_t i = 0; i + 1 < top.size(); ++i) out.push_back(norm(top[i + 1] - top[i]));
    if (curve.basis().is_closed()) out.push_back(norm(top.front() - top.back()));
    return out;
}

// Inner knots for `spans` spans on which the error of a better curve would be the same everywhere. The error
// of a spline on a span of length h is about h^(p+1) |f^(p+1)|, so spans are to have equal parts of the
// integral of |f^(p+1)|^(1/(p+1)). The derivative is taken from the jumps of the one below, a step function
// [deBoor 1978, ch. XII: NEWNOT]; a twentieth of the mean is added everywhere, so that no span grows without
// limit where the curve seems to be a polynomial.
template <int D>
std::vector<double> equidistributed(const Curve<Vec<D>>& curve, int spans) {
    const auto breaks = curve.basis().breaks();
    const auto jump = jumps(curve, breaks);
    const bool closed = curve.basis().is_closed();
    const std::size_t n = breaks.size() - 1;
    const double power = 1.0 / (curve.basis().degree() + 1);
    const auto length = [&](std::size_t i) { return breaks[i + 1] - breaks[i]; };
    double largest = 0;
    for (double j : jump) largest = std::max(largest, j);
    std::vector<double> part(n, 0.0);
    double total = 0;
    for (std::size_t i = 0; i < n; ++i) {
        double slope = 0;
        const auto add = [&](std::size_t j, std::size_t a, std::size_t b) {
            if (largest > 0) slope += jump[j] / largest / (length(a) + length(b));
        };
        if (i > 0) add(i - 1, i - 1, i);
        if (i + 1 < n) add(i, i, i + 1);
        if (closed && n > 1 && i == 0) add(n - 1, n - 1, 0);
        if (closed && n > 1 && i + 1 == n) add(n - 1, n - 1, 0);
        part[i] = std::pow(slope, power) * length(i);
        total += part[i];
    }
    const double range = breaks.back() - breaks.front(), floor = total > 0 ? 0.05 * total / range : 1;
    double sum = 0;
    for (std::size_t i = 0; i < n; ++i) sum += part[i] += floor * length(i);
    std::vector<double> inner;
    double below = 0;
    std::size_t i = 0;
    for (int k = 1; k < spans; ++k) {
        const double goal = sum * k / spans;
        while (i + 1 < n && below + part[i] < goal) below += part[i++];
        inner.push_back(breaks[i] + length(i) * std::clamp((goal - below) / part[i], 0.0, 1.0));
    }
    return inner;
}

}  // namespace freiform::detail
