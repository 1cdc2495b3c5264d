// Bounds of derivatives from control points.
//
// Idea: a derivative of a Bezier block is a Bezier block of differences, and a block lies in the convex hull
// of its coefficients; so the largest difference bounds the derivative. Restricting the block to a smaller
// box (de Casteljau) makes the bound as tight as wanted, quadratically in the size of the box. Notation: A
// numerator, w weight, c = A / w the point, c0 any fixed point near the block, A^ = A - c0 w. Then A^ / w = c
// - c0, |c - c0| <= r = max |A^_i| / w_i, and by Leibniz, for a > 0,
//     c_a = (A^_a - sum_{0 < b < a} C(a, b) w_b c_{a-b} - w_a (c - c0)) / w,
// so |c_a| <= (|A^_a| + sum C(a, b) |w_b| |c_{a-b}| + |w_a| r) / w_min. Without the shift to c0 the bound
// would depend on the distance from the origin. Accuracy: differences carry the rounding of Bezier extraction
// and restriction. Each coefficient of the block is off by at most e = (sum_d 12 p_d + 8) u max|A_i| (see
// patch_detail.hpp), a difference of order k by 2^k e; this is added, so that the bound holds for the exact
// block.
//
// Weights that do not depend on v, as of cylinders and cones: S_v = A_v / w is a block with the same weights,
// and is taken about a vector c0 of its own, so that S_uv, .. are small where S_v hardly changes: |S_uv| by
// the formula above would be twice |w_u| |S_v| / w, however short the block is. What weights may depend on v
// by rounding is in the terms that |w_v|, .. stand in.
//
// Differences of an order come from those of the order before: one subtraction each. Rounding of the
// subtractions is within the 2^k e above, of which twice as much is added.
//
// References: [Farin 2002, 5.3], [PT97, 4.2], [Filip Magedson Markot 1986].
#include "room_detail.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/spline/derivative_bounds.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace freiform {

namespace {

constexpr int kMostBernstein = kMaxDegree + 1;

// C(a, b) for the orders of derivatives, and the Bernstein polynomials of each degree at 1/2.
constexpr double kChoose[4][4] = {{1, 0, 0, 0}, {1, 1, 0, 0}, {1, 2, 1, 0}, {1, 3, 3, 1}};
static_assert(kBoundOrder == 3);
constexpr auto kAtHalf = [] {
    std::array<std::array<double, kMostBernstein>, kMostBernstein> b{};
    b[0][0] = 1;
    for (std::size_t n = 1; n < b.size(); ++n)
        for (std::size_t i = 0; i <= n; ++i)
            b[n][i] = ((i > 0 ? b[n - 1][i - 1] : 0) + (i < n ? b[n - 1][i] : 0)) / 2;
    return b;
}();

template <std::size_t N>
constexpr std::size_t slot_of(int i, int j) {
    return N == 1 ? std::size_t(i) : std::size_t((i + j) * (i + j + 1) / 2 + j);
}
static_assert(slot_of<2>(2, 0) == jet_slot(Index<2>{2, 0}) && slot_of<2>(1, 2) == jet_slot(Index<2>{1, 2}) &&
              slot_of<1>(3, 0) == jet_slot(Index<1>{3}));

// The net of differences of one order, of the numerator about c0 and of the weight: the largest of them, and
// of rational blocks the values in the middle of the block.
template <int D>
struct Differences {
    double most = 0, weight_most = 0;
    Vec<D> middle{};
    double weight_middle = 0;
};

// Calls f(coefficient) for each, row by row.
template <std::size_t N, class P, class F>
void each_entry(const NetView<N, const P>& net, F&& f) {
    const int rows = N == 1 ? 1 : net.extent[0], columns = net.extent[N - 1];
    for (int r = 0; r < rows; ++r) {
        const P* p = net.data + r * net.stride[0];
        for (int k = 0; k < columns; ++k, p += net.stride[N - 1]) f(*p);
    }
}

// All differences up to order `top`, each from the one before: one subtraction for each number. Curves are
// blocks of one column.
template <std::size_t N, class P>
class DifferenceTable {
public:
    static constexpr int D = Space<P>::kDim;
    static constexpr bool kRational = Space<P>::kRational;

    DifferenceTable(const NetView<N, const P>& net, const PointOf<P>& c0, int top)
        : rows_(net.extent[0]), columns_(N == 1 ? 1 : net.extent[N - 1]) {
        const std::size_t count = std::size_t(rows_) * std::size_t(columns_);
        Room<Entry, 128> room;
        Entry* const down = room.of(2 * count);
        Entry* const work = down + count;
        Entry* to = down;
        each_entry(net, [&](const P& p) {
            const double w = Space<P>::weight(p);
            for (int i = 0; i < D; ++i) (*to)[std::size_t(i)] = p[i] - w * c0[i];
            if constexpr (kRational) (*to)[D] = w;
            ++to;
        });
        for (int i = 0; i <= top && i < rows_; ++i) {
            const int rows = rows_ - i;
            if (i > 0) subtract(down, rows * columns_, columns_);
            std::copy_n(down, rows * columns_, work);
            for (int j = 0; i + j <= top && j < columns_; ++j) {
                if (j > 0)
                    for (int r = 0; r < rows; ++r) subtract(work + r * columns_, columns_ - j, 1);
                found_[slot_of<N>(i, j)] = seen(work, rows, columns_ - j);
            }
        }
    }

    const Differences<D>& operator[](std::size_t slot) const { return found_[slot]; }

private:
    using Entry = std::array<double, std::size_t(D + (kRational ? 1 : 0))>;

    static void subtract(Entry* e, int n, int step) {
        for (int k = 0; k < n; ++k)
            for (std::size_t c = 0; c < e[0].size(); ++c) e[k][c] = e[k + step][c] - e[k][c];
    }
    Differences<D> seen(const Entry* e, int rows, int columns) const {
        Differences<D> out;
        double most = 0;
        Entry middle{};
        for (int r = 0; r < rows; ++r) {
            Entry row{};
            for (int k = 0; k < columns; ++k) {
                const Entry& x = e[r * columns_ + k];
                double square = 0;
                for (std::size_t c = 0; c < std::size_t(D); ++c) square += x[c] * x[c];
                most = most < square ? square : most;
                if constexpr (kRational) {
                    const double w = std::abs(x[D]);
                    out.weight_most = out.weight_most < w ? w : out.weight_most;
                    const double share = kAtHalf[std::size_t(columns - 1)][std::size_t(k)];
                    for (std::size_t c = 0; c < x.size(); ++c) row[c] += share * x[c];
                }
            }
            if constexpr (kRational) {
                const double share = kAtHalf[std::size_t(rows - 1)][std::size_t(r)];
                for (std::size_t c = 0; c < row.size(); ++c) middle[c] += share * row[c];
            }
        }
        if constexpr (kRational) {
            for (int c = 0; c < D; ++c) out.middle[c] = middle[std::size_t(c)];
            out.weight_middle = middle[D];
        }
        out.most = std::sqrt(most) * (1 + 8 * kUnitRoundoff);
        return out;
    }

    int rows_, columns_;
    std::array<Differences<D>, jet_size(N, kBoundOrder)> found_{};
};

}  // namespace

namespace {

// Of A_v, A_vv, .. about multiples of the weights, which are those of the first column: differences along u.
// found[slot of (i, j)] for j > 0; (0, j): the largest quotient by the weight.
template <class P>
std::array<double, jet_size(2, kBoundOrder)> ruled_differences(const NetView<2, const P>& net, int top) {
    constexpr int D = Space<P>::kDim;
    std::array<double, jet_size(2, kBoundOrder)> found{};
    const int rows = net.extent[0], columns = net.extent[1];
    const std::size_t count = std::size_t(rows) * std::size_t(columns);
    Room<Vec<D>, 128> room;
    Vec<D>* const across = room.of(2 * count);
    Vec<D>* const e = across + count;
    const auto weight = [&](int r) { return Space<P>::weight(net({r, 0})); };
    const auto at = [&](int r, int c) { return std::size_t(r * columns + c); };
    for (int r = 0; r < rows; ++r)
        for (int c = 0; c < columns; ++c)
            for (int i = 0; i < D; ++i) across[at(r, c)][i] = net({r, c})[i];
    for (int j = 1; j <= top && j < columns; ++j) {
        for (int r = 0; r < rows; ++r)
            for (int c = 0; c < columns - j; ++c) across[at(r, c)] = across[at(r, c + 1)] - across[at(r, c)];
        const Vec<D> c0 = (1 / weight(rows / 2)) * across[at(rows / 2, (columns - j) / 2)];
        for (int r = 0; r < rows; ++r)
            for (int c = 0; c < columns - j; ++c) e[at(r, c)] = across[at(r, c)] - weight(r) * c0;
        for (int i = 0; i + j <= top && i < rows; ++i) {
            double& most = found[slot_of<2>(i, j)];
            for (int r = 0; r < rows - i; ++r)
                for (int c = 0; c < columns - j; ++c) {
                    if (i > 0) e[at(r, c)] = e[at(r + 1, c)] - e[at(r, c)];
                    most = std::max(most, norm(e[at(r, c)]) / (i == 0 ? weight(r) : 1));
                }
            most *= 1 + 8 * kUnitRoundoff;
        }
    }
    return found;
}

// Whether weights change along u, along v, by more than restriction to a part rounds them.
template <class P>
std::array<bool, 2> weights_change(const NetView<2, const P>& net) {
    std::array<bool, 2> out{};
    const double part = 8 * (net.extent[0] + net.extent[1]) * kUnitRoundoff;
    const auto weight = [&](int r, int c) {
        return Space<P>::weight(net.data[r * net.stride[0] + c * net.stride[1]]);
    };
    for (int r = 0; r < net.extent[0]; ++r)
        for (int c = 0; c < net.extent[1]; ++c) {
            const double w = weight(r, c), alike = part * w;
            out[0] |= std::abs(w - weight(0, c)) > alike;
            out[1] |= std::abs(w - weight(r, 0)) > alike;
        }
    return out;
}

DerivativeBounds<2> with_axes_exchanged(const DerivativeBounds<2>& b) {
    DerivativeBounds<2> out;
    for (int i = 0; i <= kBoundOrder; ++i)
        for (int j = 0; i + j <= kBoundOrder; ++j) out.d[slot_of<2>(i, j)] = b.d[slot_of<2>(j, i)];
    return out;
}

}  // namespace

template <std::size_t N, class P>
DerivativeBounds<N> derivative_bounds(const NetView<N, const P>& net, const std::array<double, N>& width,
                                      int order, double size) {
    constexpr int D = Space<P>::kDim;
    constexpr bool kRational = Space<P>::kRational;
    bool ruled = false;
    if constexpr (N == 2 && kRational) {
        const auto change = weights_change(net);
        if (change[1] && !change[0])
            return with_axes_exchanged(derivative_bounds<2, P>(
                {net.data, {net.extent[1], net.extent[0]}, {net.stride[1], net.stride[0]}},
                {width[1], width[0]}, order, size));
        ruled = change[0] && !change[1] && order > 1;
    }
    double steps = 8, largest = size, weight_min = kInfinity, weight_max = 0;
    Index<N> centre{};
    for (std::size_t d = 0; d < N; ++d) {
        steps += 12 * (net.extent[d] - 1);
        centre[d] = net.extent[d] / 2;
    }
    const PointOf<P> c0 = project(net(centre));
    double farthest = 0, square = 0;  // from c0: of the numerator, of the points themselves
    each_entry(net, [&](const P& p) {
        const double w = Space<P>::weight(p);
        weight_min = w < weight_min ? w : weight_min;
        weight_max = w > weight_max ? w : weight_max;
        double sum = 0;
        for (int i = 0; i < D; ++i) {
            const double shifted = p[i] - w * c0[i], a = std::abs(p[i]);
            sum += shifted * shifted;
            largest = a > largest ? a : largest;
        }
        farthest = sum > farthest ? sum : farthest;
        const double part = kRational ? sum / (w * w) : sum;
        square = part > square ? part : square;
    });
    double radius = std::sqrt(square) * (1 + 8 * kUnitRoundoff);
    if (!(farthest > 1e-280 && farthest < 1e280 && weight_min > 1e-140 && weight_max < 1e140)) {
        radius = 0;  // squares are too small or too large
        each_entry(net, [&](const P& p) {
            const double w = Space<P>::weight(p);
            Vec<D> shifted;
            for (int i = 0; i < D; ++i) shifted[i] = p[i] - w * c0[i];
            radius = std::max(radius, norm(shifted) / w);
        });
    }
    const double slip = steps * kUnitRoundoff * largest,
                 weight_slip = Space<P>::kRational ? steps * kUnitRoundoff * weight_max : 0;
    radius += 2 * slip / weight_min;

    DerivativeBounds<N> out;
    std::array<double, jet_size(N, kBoundOrder)> weight{}, weight_middle{};
    std::array<Vec<D>, jet_size(N, kBoundOrder)> middle{};
    out.d[0] = radius;
    const int top = kRational ? std::min(order + 1, kBoundOrder) : order, across = N == 1 ? 0 : top;
    const DifferenceTable<N, P> found(net, c0, top);
    std::array<double, jet_size(2, kBoundOrder)> found_ruled{};
    if constexpr (N == 2 && kRational)
        if (ruled) found_ruled = ruled_differences(net, top);
    // p (p - 1) .. / width^k along each axis.
    std::array<std::array<double, kBoundOrder + 1>, N> falling{};
    for (std::size_t d = 0; d < N; ++d) {
        falling[d][0] = 1;
        for (int k = 0; k < top; ++k)
            falling[d][std::size_t(k) + 1] =
                falling[d][std::size_t(k)] * (double(net.extent[d] - 1 - k) / width[d]);
    }
    // The numerator of a derivative with i, j > 0: w S_ij = E_ij - sum C w_k0 S_{i-k,j} - w_i0 (S_0j - c_j) -
    // terms with w_kl, l > 0, which are rounding; E_ij = A_ij - w_i0 c_j, c_j near S_0j.
    const auto by_rulings = [&](int i, int j, double factor, double rounding) {
        const std::size_t of_j = slot_of<N>(0, N == 1 ? 0 : j);
        const double by_v = falling[N - 1][std::size_t(j)];
        if (!(by_v > 0)) return kInfinity;
        // A is taken about c0 in thought; c_j is a multiple of a weight. All with the rounding of
        // differences.
        const double own = slip + norm(c0) * weight_slip + (out.d[of_j] / by_v) * weight_slip;
        double most = std::abs(factor) * (found_ruled[slot_of<N>(i, j)] + rounding * 4 * own);
        double from_middle = by_v * (found_ruled[of_j] + 16 * own / weight_min);
        for (int l = 1; l <= j; ++l)
            from_middle +=
                kChoose[j][l] * weight[slot_of<N>(0, l)] * out.d[slot_of<N>(0, j - l)] / weight_min;
        for (int k = 1; k <= i; ++k)
            most += kChoose[i][k] * weight[slot_of<N>(k, 0)] *
                    (k < i ? out.d[slot_of<N>(i - k, j)] : from_middle);
        for (int k = 0; k <= i; ++k)
            for (int l = 1; l <= j; ++l)
                most += kChoose[i][k] * kChoose[j][l] * weight[slot_of<N>(k, l)] *
                        out.d[slot_of<N>(i - k, j - l)];
        return most;
    };
    const double divisor = weight_min * (1 - 16 * steps * kUnitRoundoff);
    double invert = 1;  // of the weight in the middle
    for (int sum = kRational ? 0 : 1; sum <= top; ++sum)
        for (int j = 0; j <= std::min(sum, across); ++j) {
            const int i = sum - j;
            const double factor = falling[0][std::size_t(i)] * falling[N - 1][std::size_t(N == 1 ? 0 : j)];
            if (!(factor > 0) && !kRational) continue;  // order above the degree: exactly zero
            const std::size_t slot = slot_of<N>(i, j);
            const double rounding = double(1 << sum);
            double most = std::abs(factor) * (found[slot].most + rounding * 2 * slip);
            if constexpr (kRational) {
                weight[slot] = std::abs(factor) * (found[slot].weight_most + rounding * weight_slip);
                weight_middle[slot] = factor * found[slot].weight_middle;
                middle[slot] = factor * found[slot].middle;
                for (int k = 0; k <= i; ++k)
                    for (int l = k == 0 ? 1 : 0; l <= j; ++l) {
                        const double choose = kChoose[i][k] * kChoose[j][l];
                        const std::size_t part = slot_of<N>(k, l), rest = slot_of<N>(i - k, j - l);
                        most += choose * weight[part] * out.d[rest];
                        middle[slot] -= (choose * weight_middle[part]) * middle[rest];
                    }
                if (ruled && i > 0 && j > 0) most = std::min(most, by_rulings(i, j, factor, rounding));
                most /= divisor;
                if (sum == 0) invert = 1 / weight_middle[0];
                middle[slot] *= invert;
            }
            if (sum > 0) out.d[slot] = most * (1 + 64 * kUnitRoundoff);
        }
    if constexpr (kRational) {
        // The triangle inequality lost the signs; from the middle outwards they are kept.
        const DerivativeBounds<N> crude = out;
        for (int sum = top - 1; sum >= 1; --sum)
            for (int j = 0; j <= std::min(sum, across); ++j) {
                const int i = sum - j;
                const std::size_t slot = slot_of<N>(i, j);
                double here = norm(middle[slot]) + width[0] / 2 * out.d[slot_of<N>(i + 1, j)];
                if constexpr (N == 2) here += width[1] / 2 * out.d[slot_of<N>(i, j + 1)];
                // Rounding of the value in the middle: at most that of the terms that `crude` adds up.
                here += 64 * steps * kUnitRoundoff * crude.d[slot];
                out.d[slot] = std::min(crude.d[slot], here * (1 + 64 * kUnitRoundoff));
            }
        for (std::size_t slot = jet_size(N, order); slot < out.d.size(); ++slot) out.d[slot] = 0;
    }
    return out;
}

#define FF_INSTANTIATE(P)                                                                                    \
    template DerivativeBounds<1> derivative_bounds(const NetView<1, const P>&, const std::array<double, 1>&, \
                                                   int, double);
FF_INSTANTIATE(Vec<1>)
FF_INSTANTIATE(Hom<1>)
FF_INSTANTIATE(Vec<2>)
FF_INSTANTIATE(Hom<2>)
FF_INSTANTIATE(Vec<3>)
FF_INSTANTIATE(Hom<3>)
FF_INSTANTIATE(Vec<4>)
FF_INSTANTIATE(Hom<4>)
#undef FF_INSTANTIATE
#define FF_INSTANTIATE(P)                                                                                    \
    template DerivativeBounds<2> derivative_bounds(const NetView<2, const P>&, const std::array<double, 2>&, \
                                                   int, double);
FF_INSTANTIATE(Vec<1>)
FF_INSTANTIATE(Hom<1>)
FF_INSTANTIATE(Vec<3>)
FF_INSTANTIATE(Hom<3>)
#undef FF_INSTANTIATE

}  // namespace freiform
