// Bounds of second derivatives over equal cells of a box: about what a tree says, found without a walk.
#pragma once
#include "curvature_detail.hpp"

#include <freiform/core/box.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <optional>
#include <vector>

namespace freiform {

class CurvatureGrid {
public:
    CurvatureGrid() = default;
    // About as many cells as there are parts of this size.
    CurvatureGrid(const Box<2>& whole, const Vec<2>& part) : whole_(whole) {
        for (int d = 0; d < 2; ++d) {
            const double size = whole.hi[d] - whole.lo[d], count = std::min(size / part[d], kMostCells);
            count_[std::size_t(d)] = count >= 1 ? std::bit_floor(unsigned(count)) : 1;
            scale_[d] = count_[std::size_t(d)] / size;
        }
        cells_.resize(std::size_t(count_[0]) * count_[1]);
    }
    void include(const Box<2>& part, const Curvature& c) {
        each_cell(part, [&](Cell& cell) {
            cell.uu = std::max(cell.uu, c.uu), cell.uv = std::max(cell.uv, c.uv),
            cell.vv = std::max(cell.vv, c.vv);
        });
    }
    // Of all parts that the box meets, and some beside it. Nothing where that would take long.
    std::optional<Curvature> over(const Box<2>& box) { ... }
};

}  // namespace freiform
