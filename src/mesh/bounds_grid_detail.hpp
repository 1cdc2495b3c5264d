// Bounds over equal cells of a box: about what a tree says of some place in it, found without a walk.
#pragma once
#include <freiform/core/constants.hpp>
#include <freiform/core/interval.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <optional>
#include <vector>

namespace freiform {

// A place in a part is in a cell that this part is noted in: the cell of a place grows with its parameters,
// rounded as they may be.
class BoundsGrid {
public:
    using Bounds = std::array<double, 4>;

    BoundsGrid() = default;
    // With about as many cells as there are parts of this size.
    BoundsGrid(const Box<2>& whole, const Vec<2>& part) : whole_(whole) {
        for (int d = 0; d < 2; ++d) {
            const double size = whole.hi[d] - whole.lo[d], count = std::min(size / part[d], kMostCells);
            count_[std::size_t(d)] = count >= 1 ? int(count) : 1;
            scale_[d] = count / size < kInfinity ? count_[std::size_t(d)] / size : 0;
        }
        cells_.resize(std::size_t(count_[0]) * std::size_t(count_[1]));
    }
    void include(const Box<2>& part, const Bounds& bounds) {
        each_cell(range_of(part), [&](Bounds& cell) {
            for (std::size_t k = 0; k < cell.size(); ++k) cell[k] = std::max(cell[k], bounds[k]);
        });
    }
    // Of all parts that the box meets, and some beside them; nothing where the box is not inside, or looking
    // would take longer than a walk.
    std::optional<Bounds> over(const Box<2>& box) const {
        if (cells_.empty() || !whole_.contains(box.lo) || !whole_.contains(box.hi)) return std::nullopt;
        const Range r = range_of(box);
        if ((r.hi[0] - r.lo[0] + 1) * (r.hi[1] - r.lo[1] + 1) > kMostLookedAt) return std::nullopt;
        Bounds out{};
        for (int i = r.lo[0]; i <= r.hi[0]; ++i)
            for (int j = r.lo[1]; j <= r.hi[1]; ++j) {
                const Bounds& cell = cells_[place(i, j)];
                for (std::size_t k = 0; k < out.size(); ++k) out[k] = std::max(out[k], cell[k]);
            }
        return out;
    }

private:
    static constexpr double kMostCells = 512;  // along an axis
    static constexpr int kMostLookedAt = 24;
    struct Range {
        int lo[2], hi[2];
    };
    int cell_of(double x, std::size_t d) const {
        return std::clamp(int((x - whole_.lo[int(d)]) * scale_[int(d)]), 0, count_[d] - 1);
    }
    Range range_of(const Box<2>& box) const {
        Range r;
        for (std::size_t d = 0; d < 2; ++d)
            r.lo[d] = cell_of(box.lo[int(d)], d), r.hi[d] = cell_of(box.hi[int(d)], d);
        return r;
    }
    std::size_t place(int i, int j) const { return std::size_t(i) * std::size_t(count_[1]) + std::size_t(j); }
    template <class F>
    void each_cell(const Range& r, F&& f) {
        for (int i = r.lo[0]; i <= r.hi[0]; ++i)
            for (int j = r.lo[1]; j <= r.hi[1]; ++j) f(cells_[place(i, j)]);
    }

    Box<2> whole_;
    std::array<int, 2> count_{};
    Vec<2> scale_{};
    std::vector<Bounds> cells_;
};

}  // namespace freiform
