// Blocks as the kernels take them.
#include "block_detail.hpp"

#include <algorithm>

namespace freiform {

namespace {

// outer x inner tuples of `count` numbers, one after the other to rows of `to_step` numbers.
void copy_tuples(const double* from, std::ptrdiff_t outer_step, std::ptrdiff_t inner_step, int outer,
                 int inner, int count, double* to, int to_step) {
    for (int r = 0; r < outer; ++r, from += outer_step, to += to_step) {
        const double* p = from;
        double* q = to;
        for (int c = 0; c < inner; ++c, p += inner_step) q = std::copy_n(p, count, q);
        std::fill(q, to + to_step, 0.0);
    }
}

// The same to planes of `outer` rows of `to_step` numbers.
void copy_apart(const double* from, std::ptrdiff_t outer_step, std::ptrdiff_t inner_step, int outer,
                int inner, int count, double* to, int to_step) {
    const std::size_t plane = std::size_t(outer) * std::size_t(to_step);
    for (int r = 0; r < outer; ++r, from += outer_step, to += to_step) {
        const double* p = from;
        for (int c = 0; c < inner; ++c, p += inner_step)
            for (int i = 0; i < count; ++i) to[std::size_t(i) * plane + std::size_t(c)] = p[i];
        for (int i = 0; i < count; ++i)
            for (int c = inner; c < to_step; ++c) to[std::size_t(i) * plane + std::size_t(c)] = 0;
    }
}

}  // namespace

void BezierBlock::make_room() {
    const auto size = [](int a, int b) { return std::size_t(a) * std::size_t(kernel::lanes_of(b)); };
    const int n = shape_.planes(), rows = shape_.rows, columns = shape_.columns;
    area_ = std::max({size(columns, rows * n), size(rows, columns * n),
                      std::size_t(n) * std::max(size(rows, columns), size(columns, rows))});
    numbers_ = room_.of(3 * area_);
}

void BezierBlock::restrict(int axis, double lo, double hi) {
    // Each in half of the room that differences need later.
    double* const to = numbers_ + (axis == 1 ? 2 : 1) * area_;
    const int n = shape_.planes(), count = axis == 1 ? shape_.columns : shape_.rows,
              other = axis == 1 ? shape_.rows : shape_.columns, step = kernel::lanes_of(other * n);
    std::ptrdiff_t &along = axis == 1 ? v_ : u_, &beside = axis == 1 ? u_ : v_;
    if (n == 4) {
        kernel::block_kernels().restrict_quadruples({from_, along, beside, count, other}, to, hi, lo);
    } else {
        copy_tuples(from_, along, beside, count, other, n, to, step);
        kernel::block_kernels().restrict(to, count, step, hi, lo);
    }
    from_ = to, along = step, beside = n;
}

void BezierBlock::arrange() {
    if (shape_.planes() == 4)
        kernel::block_kernels().arrange_quadruples({from_, u_, v_, shape_.rows, shape_.columns}, numbers_);
    else
        copy_apart(from_, u_, v_, shape_.rows, shape_.columns, shape_.planes(), numbers_, shape_.lanes());
}

void BezierBlock::exchange_axes() {
    const kernel::BlockShape old = shape_;
    std::copy_n(numbers_, std::size_t(old.planes()) * old.plane(), room());
    std::swap(shape_.rows, shape_.columns);
    for (int i = 0; i < old.planes(); ++i)
        copy_apart(room() + std::size_t(i) * old.plane(), 1, old.lanes(), shape_.rows, shape_.columns, 1,
                   numbers_ + std::size_t(i) * shape_.plane(), shape_.lanes());
}

}  // namespace freiform
