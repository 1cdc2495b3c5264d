// Where splines have kinks, and how large they are.
#pragma once
#include <freiform/core/constants.hpp>
#include <freiform/spline/derivative_bounds.hpp>

#include <algorithm>
#include <cmath>
#include <vector>

namespace freiform {

// One line of the differences between two rational pieces: A^, w, and the jumps of their derivatives.
template <int D>
struct JumpLine {
    Vec<D> point{}, jump{};
    double weight = 0, weight_jump = 0;
};

// The largest coefficient of w [A^_d] - A^ [w_d], of degree 2 q along the other axis: a product of
// polynomials in Bernstein form.
template <int D>
double largest_of_product(const std::vector<JumpLine<D>>& lines) {
    const int q = int(lines.size()) - 1;
    const auto choose = [](int n, int k) {  // exact up to n = 50
        double c = 1;
        for (int i = 1; i <= k; ++i) c = c * (n - k + i) / i;
        return c;
    };
    double most = 0;
    for (int m = 0; m <= 2 * q; ++m) {
        Vec<D> sum{};
        for (int i = std::max(0, m - q); i <= std::min(m, q); ++i) {
            const auto &a = lines[std::size_t(i)], &b = lines[std::size_t(m - i)];
            sum += (choose(q, i) * choose(q, m - i) / choose(2 * q, m)) *
                   (a.weight * b.jump - b.weight_jump * a.point);
        }
        most = std::max(most, norm(sum));
    }
    return most;
}

// Bound of the jump of c_d between two neighbouring Bezier pieces, from the jumps of numerator and weight:
// c_d = (A^_d - w_d (c - c0)) / w on both sides, with A^ and w continuous. For two parameters also as the
// quotient (w [A^_d] - A^ [w_d]) / w^2, in which the jumps of a rational circle cancel.
//
// Accuracy. [A^_d] is off by `slip` (the rounding of coefficients, times p / h on both sides), [w_d] by
// `weight_slip`, A^ by 4 u of the largest coefficient; a coefficient of the product is a mean of q + 1 terms
// at most, each with some ten roundings.
template <std::size_t N, class P>
double jump_between(const BezierPieces<N, P>& pieces, Index<N> left, int axis) {
    constexpr int D = Space<P>::kDim;
    const std::size_t d = std::size_t(axis);
    Index<N> right = left;
    ++right[d];
    const auto l = pieces.net(left), r = pieces.net(right);
    const int p = pieces.degree(axis);
    const double hl = pieces.box(left)[d].length(), hr = pieces.box(right)[d].length();
    if (p == 0) return kInfinity;
    const PointOf<P> c0 = project(r(Index<N>{}));
    std::vector<JumpLine<D>> lines;
    double radius = 0, jump = 0, weight_jump = 0, weight_min = kInfinity, largest = 0;
    bool torn = false;
    each_fibre(axis, l.extent, [&](const Index<N>& at) {
        const auto a = l.fibre(axis, at), b = r.fibre(axis, at);
        const double wl = Space<P>::weight(a[p]), wr = Space<P>::weight(b[0]);
        const double step =
            (Space<P>::weight(b[1]) - wr) * (p / hr) - (wl - Space<P>::weight(a[p - 1])) * (p / hl);
        Vec<D> diff, offset;
        for (int i = 0; i < D; ++i) {
            const auto hat = [&](const P& q) { return q[i] - Space<P>::weight(q) * c0[i]; };
            diff[i] = (hat(b[1]) - hat(b[0])) * (p / hr) - (hat(a[p]) - hat(a[p - 1])) * (p / hl);
            offset[i] = hat(b[0]);
            largest = std::max({largest, std::abs(a[p][i]), std::abs(b[0][i])});
        }
        if (Space<P>::kRational && N <= 2) lines.push_back({offset, diff, wr, step});
        radius = std::max(radius, norm(offset) / wr);
        jump = std::max(jump, norm(diff));
        weight_jump = std::max(weight_jump, std::abs(step));
        weight_min = std::min({weight_min, wl, wr});
        torn = torn ||
               max_abs(a[p] - b[0]) > 64 * (p + 1) * kUnitRoundoff * std::max(max_abs(a[p]), max_abs(b[0]));
    });
    if (torn) return kInfinity;
    const double slip = 64 * (p + 1) * kUnitRoundoff * largest * p * (1 / hl + 1 / hr);
    const double crude =
        (jump + weight_jump * radius + slip * (1 + (Space<P>::kRational ? 1 : 0))) / weight_min;
    const double grow = 1 + 64 * kUnitRoundoff;
    if (lines.empty()) return crude * grow;
    double weight_max = 0, reach = 0;
    for (const auto& line : lines)
        weight_max = std::max(weight_max, line.weight), reach = std::max(reach, norm(line.point));
    const double weight_slip = 64 * (p + 1) * kUnitRoundoff * weight_max * p * (1 / hl + 1 / hr);
    const double rounding = weight_max * slip + reach * weight_slip +
                            8 * kUnitRoundoff * largest * (weight_jump + weight_slip) +
                            16 * (int(lines.size()) + 2) * kUnitRoundoff *
                                (weight_max * (jump + slip) + reach * (weight_jump + weight_slip));
    return std::min(crude, (largest_of_product<D>(lines) + 2 * rounding) / (weight_min * weight_min)) * grow;
}

template <std::size_t N, class P>
std::vector<Kink> kinks_of(const Patch<N, P>& patch, const BezierPieces<N, P>& pieces, int axis) {
    std::vector<Kink> kinks;
    const auto& breaks = pieces.breaks(axis);
    for (int k = 1; k + 1 < int(breaks.size()); ++k) {
        if (patch.basis(axis).multiplicity(breaks[std::size_t(k)]) < patch.basis(axis).degree()) continue;
        Kink kink{breaks[std::size_t(k)], 0};
        each_fibre(axis, pieces.extent(), [&](Index<N> at) {
            at[std::size_t(axis)] = k - 1;
            kink.jump = std::max(kink.jump, jump_between(pieces, at, axis));
        });
        kinks.push_back(kink);
    }
    return kinks;
}

}  // namespace freiform
