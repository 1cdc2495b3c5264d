// Which blocks of a tree keep the tolerance as they are.
#pragma once
#include "judge_detail.hpp"

#include <freiform/core/constants.hpp>

#include <algorithm>

namespace freiform {

constexpr double kCellRounding = 1 + 1e-12;  // of what judges cells

// The cells of a block.
struct BlockGrid {
    BlockGrid(const Box<2>& box, const CurvatureTree::Halves& halves)
        : lines{halved(box.side(0), halves[0]), halved(box.side(1), halves[1])} {}

    std::array<std::vector<double>, 2> lines;

    int cells(int axis) const { return int(lines[std::size_t(axis)].size()) - 1; }
    Vec<2> at(int i, int j) const { return {{lines[0][std::size_t(i)], lines[1][std::size_t(j)]}}; }
    Vec<2> centre(int i, int j) const {
        const auto middle = [](const std::vector<double>& x, int k) {
            return Interval{x[std::size_t(k)], x[std::size_t(k) + 1]}.middle();
        };
        return {{middle(lines[0], i), middle(lines[1], j)}};
    }
    Vec<2> largest_cell() const {
        Vec<2> out{};
        for (int d = 0; d < 2; ++d)
            for (std::size_t k = 0; k + 1 < lines[std::size_t(d)].size(); ++k)
                out[d] = std::max(out[d], lines[std::size_t(d)][k + 1] - lines[std::size_t(d)][k]);
        return out;
    }
    bool is_inner(int i, int j) const { return i > 0 && j > 0 && i < cells(0) && j < cells(1); }
    // Counter-clockwise from (0, 0).
    template <class Visit>
    void each_border_point(Visit&& visit) const {
        const int nu = cells(0), nv = cells(1);
        for (int i = 0; i < nu; ++i) visit(at(i, 0));
        for (int j = 0; j < nv; ++j) visit(at(nu, j));
        for (int i = nu; i > 0; --i) visit(at(i, nv));
        for (int j = nv; j > 0; --j) visit(at(0, j));
    }
    // Which of these (i, j) is.
    std::size_t along_border(int i, int j) const {
        const int nu = cells(0), nv = cells(1);
        const int k = j == 0 ? i : i == nu ? nu + j : j == nv ? 2 * nu + nv - i : 2 * (nu + nv) - j;
        return std::size_t(k);
    }
};

// Bounds, where all points have feet, and some have none; of leaves alone also where all are plain. Those of
// halves are of cells that are cut by the better diagonal. Infinite above the tolerance.
struct JudgedBlock {
    double usual = kInfinity, footless = kInfinity, flat = kInfinity, halves = kInfinity,
           flat_halves = kInfinity;
};

// Of leaves whose halves do, `usual` is left out: usual_of_leaf is asked for where there are more triangles.
JudgedBlock judged_block(const CurvatureTree& tree, const Judge& judge, double tolerance,
                         const CurvatureTree::Block& block);
double usual_of_leaf(const CurvatureTree& tree, const Judge& judge, double tolerance,
                     const CurvatureTree::Block& leaf);

}  // namespace freiform
