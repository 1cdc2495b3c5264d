// A Bezier block of a curve or surface, restricted to a part of it, and bounds of its derivatives.
#pragma once
#include "room_detail.hpp"

#include <freiform/spline/derivative_bounds.hpp>

#include <kernel/blocks.hpp>
#include <span>

namespace freiform {

// Coefficients of whatever kind and number of parameters, as plain numbers: those of a curve lie along v.
// What is loaded must stay until it is arranged.
class BezierBlock {
public:
    // `planes` numbers each, of which the last is the weight of rational ones.
    template <std::size_t N, class P>
    void load(const NetView<N, const P>& net) {
        shape_ = {N == 1 ? 1 : net.extent[0], net.extent[N - 1], Space<P>::kDim, Space<P>::kRational};
        from_ = net.data->c.data();
        u_ = N == 1 ? 0 : net.stride[0] * P::kCoords, v_ = net.stride[N - 1] * P::kCoords;
        make_room();
    }
    // To the part [lo, hi] of [0, 1] along u or v, each at most once, v (axis 1) first: the part up to hi and
    // of this the part from lo on.
    void restrict(int axis, double lo, double hi);
    // After this the numbers are there, in planes.
    void arrange();
    void exchange_axes();

    const kernel::BlockShape& shape() const { return shape_; }
    const double* numbers() const { return numbers_; }
    double number(int plane, int row, int column) const {
        return numbers_[std::size_t(plane) * shape_.plane() + std::size_t(row * shape_.lanes() + column)];
    }
    double weight(int row, int column) const { return shape_.rational ? number(shape_.dim, row, column) : 1; }
    double* room() { return numbers_ + area_; }  // as much as kernel::BlockTask asks for

private:
    void make_room();

    Room<double, 1100> room_;
    kernel::BlockShape shape_;
    const double* from_ = nullptr;
    std::ptrdiff_t u_ = 0, v_ = 0;
    double* numbers_ = nullptr;
    std::size_t area_ = 0;
};

inline constexpr std::size_t kBlockSlots = jet_size(2, kBoundOrder);
using BlockBounds = std::array<double, kBlockSlots>;  // in graded order, of curves those along v

// What to ask of a block. Directions have length 1; coordinates along them are bounded by themselves.
struct BlockDemands {
    std::array<double, 2> width{1, 1};
    int order = 2;
    double size = 0;  // coefficients are off by as much as if they were of this size
    bool all = true;
    std::span<const Vec<4>> directions{};  // at most kernel::kBlockDirections
};
struct BlockAnswer {
    BlockBounds all{};
    std::array<BlockBounds, kernel::kBlockDirections> along{};
};
// REQUIRES that the block is arranged. May exchange its axes.
BlockAnswer bounds_of_block(BezierBlock& block, const BlockDemands& demands);

// Bounds as of QuadraticFit for a block of a surface, which is this part ([0, 1] along each axis) of the box
// of m. REQUIRES that the block is arranged.
void include_rest(const BezierBlock& block, const std::array<Interval, 2>& part, const Vec<3>& n,
                  QuadraticFit& fit);

template <std::size_t N>
DerivativeBounds<N> of_block(const BlockBounds& b) {
    DerivativeBounds<N> out;
    for (std::size_t i = 0; i < out.d.size(); ++i) out.d[i] = b[N == 1 ? jet_slot(Index<2>{0, int(i)}) : i];
    return out;
}

}  // namespace freiform
