// Bounds over equal cells of a box: about what a tree says of some place in it, found without a walk.
#pragma once
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
    bool is_empty() const { return cells_.empty(); }
    // With about as many cells as there are parts of this size.
    BoundsGrid(const Box<2>& whole, const Vec<2>& part);
    void include(const Box<2>& part, const Bounds& bounds) {
        include(part, 0, 1, [&] { return bounds; });
    }
    // In the cells of one of so many groups alone, so that threads can share them; `bounds` is asked if there
    // are any.
    template <class F>
    void include(const Box<2>& part, int group, int groups, F&& bounds) {
        Range r = range_of(part);
        r.lo[0] = std::max(r.lo[0], count_[0] * group / groups);
        r.hi[0] = std::min(r.hi[0], count_[0] * (group + 1) / groups - 1);
        if (r.lo[0] > r.hi[0]) return;
        const Cell known = above(bounds());
        for (int i = r.lo[0]; i <= r.hi[0]; ++i)
            for (int j = r.lo[1]; j <= r.hi[1]; ++j) include(cells_[place(i, j)], known);
    }
    // Of all parts that the box meets, and some beside them; nothing where the box is not inside, or looking
    // would take longer than a walk.
    std::optional<Bounds> over(const Box<2>& box) const;

private:
    static constexpr double kMostCells = 512;  // along an axis
    static constexpr int kMostLookedAt = 24;
    struct Range {
        int lo[2], hi[2];
    };
    int cell_of(double x, std::size_t d) const;
    Range range_of(const Box<2>& box) const;
    using Cell = std::array<float, 4>;  // half the memory, which most of the time goes to
    // Not less than these. REQUIRES that they are not negative.
    static Cell above(const Bounds& bounds);
    static void include(Cell& all, const Cell& bounds) {
        for (std::size_t k = 0; k < all.size(); ++k) all[k] = bounds[k] > all[k] ? bounds[k] : all[k];
    }
    std::size_t place(int i, int j) const { return std::size_t(i) * std::size_t(count_[1]) + std::size_t(j); }

    Box<2> whole_;
    std::array<int, 2> count_{};
    Vec<2> scale_{};
    std::vector<Cell> cells_;
};

}  // namespace freiform
