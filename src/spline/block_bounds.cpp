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
// Of a coordinate n . S along a vector n of length 1: the numbers n . A^_a are those of the differences A^_a,
// so one table serves both. They are off by at most 2 times what coordinates of A^_a are off by, as no more
// than four of them are added, and by 8 u |A^_a| from the products. Of the coordinates themselves nothing is
// added.
//
// References: [Farin 2002, 5.3], [PT97, 4.2], [Filip Magedson Markot 1986].
#include "block_detail.hpp"
#include "leibniz_detail.hpp"

#include <freiform/core/constants.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace freiform {

namespace {

constexpr std::size_t kMostBernstein = kMaxDegree + 1, kHalfStride = kernel::lanes_of(kMaxDegree + 1);

static_assert(kBoundOrder == kernel::kBlockOrder && kBoundOrder == kLowOrder);

// The Bernstein polynomials of each degree at 1/2.
constexpr auto kAtHalf = [] {
    std::array<std::array<double, kHalfStride>, kMostBernstein> b{};
    b[0][0] = 1;
    for (std::size_t n = 1; n < b.size(); ++n)
        for (std::size_t i = 0; i <= n; ++i)
            b[n][i] = ((i > 0 ? b[n - 1][i - 1] : 0) + (i < n ? b[n - 1][i] : 0)) / 2;
    return b;
}();

// Whether weights change along u, along v, by more than restriction to a part rounds them.
std::array<bool, 2> weights_vary(const BezierBlock& block) {
    std::array<bool, 2> out{};
    const int rows = block.shape().rows, columns = block.shape().columns;
    const double part = 8 * (rows + columns) * kUnitRoundoff;
    for (int r = 0; r < rows; ++r)
        for (int c = 0; c < columns; ++c) {
            const double w = block.weight(r, c), alike = part * w;
            out[0] |= std::abs(w - block.weight(0, c)) > alike;
            out[1] |= std::abs(w - block.weight(r, 0)) > alike;
        }
    return out;
}

BlockBounds with_axes_exchanged(const BlockBounds& b) {
    BlockBounds out{};
    for (int i = 0; i <= kBoundOrder; ++i)
        for (int j = 0; i + j <= kBoundOrder; ++j) out[slot_of(i, j)] = b[slot_of(j, i)];
    return out;
}

// Of the block (M = 4) or of one of its coordinates (M = 1), about c0: largest differences, and derivatives
// of the numerator in the middle.
template <std::size_t M>
struct Sizes {
    double radius = 0, slip = 0;
    double products = 0;  // rounding of n . x, divided by |x|
    BlockBounds most, ruled;
    std::array<std::array<double, M>, jet_size(2, kBoundOrder - 1)> middle;
};

// The coordinate that a direction is; -1: none.
int axis_of(const Vec<4>& direction) {
    for (int i = 0; i < 4; ++i) {
        Vec<4> axis;
        axis[i] = 1;
        if (direction == axis) return i;
    }
    return -1;
}

class BlockBounder {
public:
    BlockBounder(BezierBlock& block, const BlockDemands& demands, bool ruled);
    BlockAnswer run();

private:
    double careful_radius() const;
    void find_weights();
    template <std::size_t M>
    void find_derivatives(Sizes<M>& of, int direction) const;
    template <std::size_t M>
    double by_rulings(const Sizes<M>& of, const BlockBounds& out, int i, int j) const;
    template <std::size_t M>
    BlockBounds bounds(Sizes<M>& of) const;

    BezierBlock& block_;
    const BlockDemands& demands_;
    const kernel::BlockShape shape_;
    const bool ruled_, curve_;
    const int top_;
    double steps_ = 8, weight_slip_ = 0;
    kernel::BlockTask task_;
    kernel::BlockFound found_;
    double falling_[2][kBoundOrder + 1];  // p (p - 1) .. / width^k along each axis
    BlockBounds weight_, weight_middle_;
};

BlockBounder::BlockBounder(BezierBlock& block, const BlockDemands& demands, bool ruled)
    : block_(block),
      demands_(demands),
      shape_(block.shape()),
      ruled_(ruled),
      curve_(shape_.rows == 1),
      top_(shape_.rational ? std::min(demands.order + 1, kBoundOrder) : demands.order) {
    const int sizes[2] = {shape_.rows, shape_.columns};
    for (std::size_t d = 0; d < 2; ++d) {
        steps_ += 12 * (sizes[d] - 1);
        falling_[d][0] = 1;
        for (int k = 0; k < top_; ++k)
            falling_[d][k + 1] = falling_[d][k] * (double(sizes[d] - 1 - k) / demands.width[d]);
    }
    task_.shape = shape_;
    task_.numbers = block.numbers();
    task_.room = block.room();
    const int row = shape_.rows / 2, column = shape_.columns / 2;
    for (int i = 0; i < shape_.dim; ++i)
        task_.centre[i] = block.number(i, row, column) / block.weight(row, column);
    task_.top = top_;
    task_.directions = int(demands.directions.size());
    for (std::size_t k = 0; k < demands.directions.size(); ++k)
        for (int i = 0; i < 4; ++i) task_.direction[k][i] = demands.directions[k][i];
    task_.at_half = kAtHalf[0].data();
    task_.half_stride = kHalfStride;
    task_.ruled = ruled;
}

// Where squares are too small or too large.
double BlockBounder::careful_radius() const {
    double radius = 0;
    for (int r = 0; r < shape_.rows; ++r)
        for (int c = 0; c < shape_.columns; ++c) {
            Vec<4> x;
            const double w = block_.weight(r, c);
            for (int i = 0; i < shape_.dim; ++i) x[i] = block_.number(i, r, c) - w * task_.centre[i];
            radius = std::max(radius, norm(x) / w);
        }
    return radius;
}

void BlockBounder::find_weights() {
    weight_slip_ = steps_ * kUnitRoundoff * found_.most_weight;
    each_derivative<0>(curve_, top_, [&]<int I, int J>() {
        const bool there = I < shape_.rows && J < shape_.columns;
        const double factor = falling_[0][I] * falling_[1][J];
        constexpr std::size_t slot = slot_of(I, J);
        weight_[slot] =
            std::abs(factor) * ((there ? found_.of[I][J].most[1] : 0) + double(1 << (I + J)) * weight_slip_);
        if (I + J < top_) weight_middle_[slot] = there ? factor * found_.of[I][J].middle[shape_.dim] : 0;
    });
}

// direction -1: of all coordinates.
template <std::size_t M>
void BlockBounder::find_derivatives(Sizes<M>& of, int direction) const {
    each_derivative<0>(curve_, top_, [&]<int I, int J>() {
        constexpr std::size_t slot = slot_of(I, J);
        const bool there = I < shape_.rows && J < shape_.columns,
                   with_middle = shape_.rational && I + J < top_;
        const auto& difference = found_.of[I][J];
        const double size = there ? std::sqrt(difference.most[0]) * (1 + 8 * kUnitRoundoff) : 0;
        if constexpr (M == 1)
            of.most[slot] = there ? difference.most[2 + direction] + of.products * size : 0;
        else
            of.most[slot] = size;
        if constexpr (J > 0)
            if (ruled_) {
                // By the weights of their own columns: what these differ by is in `own` of by_rulings().
                const double all = there ? std::sqrt(difference.ruled[0]) : 0;
                of.ruled[slot] =
                    (M == 1 && there ? difference.ruled[1 + direction] + of.products * all : all) *
                    (1 + 16 * kUnitRoundoff);
            }
        if constexpr (I + J < kBoundOrder)
            if (with_middle) {
                const double factor = falling_[0][I] * falling_[1][J];
                std::array<double, M> middle{};
                if (there && M == 1)
                    for (int k = 0; k < shape_.dim; ++k)
                        middle[0] += task_.direction[direction][k] * difference.middle[k];
                else if (there)
                    for (std::size_t k = 0; k < M; ++k)
                        middle[k] = int(k) < shape_.dim ? difference.middle[k] : 0;
                for (double& x : middle) x *= factor;
                of.middle[slot] = middle;
            }
    });
}

// The numerator of a derivative with i, j > 0: w S_ij = E_ij - sum C w_k0 S_{i-k,j} - w_i0 (S_0j - c_j) -
// terms with w_kl, l > 0, which are rounding; E_ij = A_ij - w_i0 c_j, c_j near S_0j.
template <std::size_t M>
double BlockBounder::by_rulings(const Sizes<M>& of, const BlockBounds& out, int i, int j) const {
    const double by_v = falling_[1][j], factor = falling_[0][i] * falling_[1][j];
    if (!(by_v > 0)) return kInfinity;
    const std::size_t of_j = slot_of(0, j);
    Vec<4> c0;
    for (int k = 0; k < shape_.dim; ++k) c0[k] = task_.centre[k];
    // A is taken about c0 in thought; c_j is a multiple of a weight. All with the rounding of differences.
    const double own = of.slip + norm(c0) * weight_slip_ + (out[of_j] / by_v) * weight_slip_;
    double most = std::abs(factor) * (of.ruled[slot_of(i, j)] + double(1 << (i + j)) * 4 * own);
    double from_middle = by_v * (of.ruled[of_j] + 16 * own / found_.least_weight);
    for (int l = 1; l <= j; ++l)
        from_middle += kChoose[j][l] * weight_[slot_of(0, l)] * out[slot_of(0, j - l)] / found_.least_weight;
    for (int k = 1; k <= i; ++k)
        most += kChoose[i][k] * weight_[slot_of(k, 0)] * (k < i ? out[slot_of(i - k, j)] : from_middle);
    for (int k = 0; k <= i; ++k)
        for (int l = 1; l <= j; ++l)
            most += kChoose[i][k] * kChoose[j][l] * weight_[slot_of(k, l)] * out[slot_of(i - k, j - l)];
    return most;
}

template <std::size_t M>
BlockBounds BlockBounder::bounds(Sizes<M>& of) const {
    BlockBounds out{};
    out[0] = of.radius;
    if (!shape_.rational) {
        each_derivative<1>(curve_, top_, [&]<int I, int J>() {
            const double factor = falling_[0][I] * falling_[1][J];
            if (factor > 0)  // otherwise the order is above the degree: exactly zero
                out[slot_of(I, J)] = std::abs(factor) *
                                     (of.most[slot_of(I, J)] + double(1 << (I + J)) * 2 * of.slip) *
                                     (1 + 64 * kUnitRoundoff);
        });
        return out;
    }
    const double divide =
                     1 / (found_.least_weight * (1 - 16 * steps_ * kUnitRoundoff)) * (1 + 4 * kUnitRoundoff),
                 invert = 1 / weight_middle_[0];
    for (double& x : of.middle[0]) x *= invert;
    each_derivative<1>(curve_, top_, [&]<int I, int J>() {
        constexpr std::size_t slot = slot_of(I, J);
        const double factor = falling_[0][I] * falling_[1][J];
        double most = std::abs(factor) * (of.most[slot] + double(1 << (I + J)) * 2 * of.slip);
        for (const LeibnizTerm& t : kLeibniz<2, I, J>) most += t.choose * weight_[t.part] * out[t.rest];
        if constexpr (I > 0 && J > 0)
            if (ruled_) most = std::min(most, by_rulings(of, out, I, J));
        out[slot] = most * divide * (1 + 64 * kUnitRoundoff);
        if constexpr (I + J < kBoundOrder)
            if (I + J < top_) {
                std::array<double, M> middle = of.middle[slot];
                for (const LeibnizTerm& t : kLeibniz<2, I, J>) {
                    const double share = t.choose * weight_middle_[t.part];
                    for (std::size_t k = 0; k < M; ++k) middle[k] -= share * of.middle[t.rest][k];
                }
                for (std::size_t k = 0; k < M; ++k) of.middle[slot][k] = middle[k] * invert;
            }
    });
    // The triangle inequality lost the signs; from the middle outwards they are kept.
    const auto from_middle = [&]<int I, int J>() {
        constexpr std::size_t slot = slot_of(I, J);
        const double crude = out[slot];
        Vec<int(M)> middle;
        for (std::size_t k = 0; k < M; ++k) middle[int(k)] = of.middle[slot][k];
        double here = norm(middle) + demands_.width[1] / 2 * out[slot_of(I, J + 1)];
        if (!curve_) here += demands_.width[0] / 2 * out[slot_of(I + 1, J)];
        // Rounding of the value in the middle: at most that of the terms that `crude` adds up.
        here += 64 * steps_ * kUnitRoundoff * crude;
        out[slot] = std::min(crude, here * (1 + 64 * kUnitRoundoff));
    };
    if (top_ > 2) each_of_order<2>(curve_, from_middle);
    if (top_ > 1) each_of_order<1>(curve_, from_middle);
    for (std::size_t slot = jet_size(2, demands_.order); slot < out.size(); ++slot) out[slot] = 0;
    return out;
}

BlockAnswer BlockBounder::run() {
    kernel::block_kernels().differences(task_, found_);
    if (shape_.rational) find_weights();
    double largest = demands_.size;
    for (int i = 0; i < shape_.dim; ++i) largest = std::max(largest, found_.largest[i]);
    const bool careful = !(found_.farthest > 1e-280 && found_.farthest < 1e280 &&
                           found_.least_weight > 1e-140 && found_.most_weight < 1e140);
    const double radius = careful ? careful_radius() : std::sqrt(found_.square) * (1 + 8 * kUnitRoundoff);
    const double rounding = steps_ * kUnitRoundoff;
    BlockAnswer out;
    if (demands_.all) {
        Sizes<4> all;
        all.slip = rounding * largest;
        all.radius = radius + 2 * all.slip / found_.least_weight;
        find_derivatives(all, -1);
        out.all = bounds(all);
    }
    for (std::size_t k = 0; k < demands_.directions.size(); ++k) {
        Sizes<1> along;
        const int axis = axis_of(demands_.directions[k]);
        along.slip = rounding * (axis < 0 ? 2 * largest : found_.largest[axis]);
        along.products = axis < 0 ? 8 * kUnitRoundoff : 0;
        along.radius =
            careful ? radius : found_.across[k] * (1 + 8 * kUnitRoundoff) + along.products * radius;
        along.radius += 2 * along.slip / found_.least_weight;
        find_derivatives(along, int(k));
        out.along[k] = bounds(along);
    }
    return out;
}

}  // namespace

BlockAnswer bounds_of_block(BezierBlock& block, const BlockDemands& demands) {
    bool ruled = false;
    if (block.shape().rational && block.shape().rows > 1) {
        const auto change = weights_vary(block);
        if (change[1] && !change[0]) {
            block.exchange_axes();
            BlockDemands exchanged = demands;
            std::swap(exchanged.width[0], exchanged.width[1]);
            BlockAnswer out = BlockBounder(block, exchanged, demands.order > 1).run();
            out.all = with_axes_exchanged(out.all);
            for (auto& along : out.along) along = with_axes_exchanged(along);
            return out;
        }
        ruled = change[0] && !change[1] && demands.order > 1;
    }
    return BlockBounder(block, demands, ruled).run();
}

template <std::size_t N, class P>
DerivativeBounds<N> derivative_bounds(const NetView<N, const P>& net, const std::array<double, N>& width,
                                      int order, double size) {
    BezierBlock block;
    block.load(net);
    block.arrange();
    BlockDemands demands;
    demands.width = {width[0], width[N - 1]};
    demands.order = order;
    demands.size = size;
    return of_block<N>(bounds_of_block(block, demands).all);
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
