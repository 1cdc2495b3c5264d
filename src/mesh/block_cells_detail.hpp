// Triangles of the cells of a block.
#pragma once
#include "block_judge_detail.hpp"

#include <functional>
#include <span>

namespace freiform {

// How cells are cut.
struct CellWays {
    std::vector<char> rising;      // of parts, row by row: the diagonal is that from the lower corner
    CurvatureTree::Halves part{};  // how often the sides of a part are halved
    int parts_in_row = 1;
    bool from_centre = false;  // those with more points around them than corners; else from a corner inside

    std::size_t part_of(int i, int j) const {
        return std::size_t((i >> part[0]) * parts_in_row + (j >> part[1]));
    }
};

// Calls visit(i, j, around) for each cell at the border. `step`: which of the points along the border of the
// block, counter-clockwise from the lower corner, each cell there begins with, and their number. `around`:
// the places of those around the cell there, counter-clockwise from its lower corner; of corners inside of
// the block, row by row, -1 less their number.
template <class Visit>
void each_border_cell(const BlockGrid& grid, std::span<const int> step, Visit&& visit) {
    const int nu = grid.cells(0), nv = grid.cells(1);
    std::vector<int> around;
    for (int i = 0; i < nu; ++i)
        for (int j = 0; j < nv; ++j) {
            if (i > 0 && j > 0 && i + 1 < nu && j + 1 < nv) continue;
            const std::array<std::array<int, 2>, 4> corner{{{i, j}, {i + 1, j}, {i + 1, j + 1}, {i, j + 1}}};
            const bool on_border[4] = {j == 0, i + 1 == nu, j + 1 == nv, i == 0};
            around.clear();
            for (std::size_t k = 0; k < 4; ++k) {
                const auto [a, b] = corner[k];
                if (grid.is_inner(a, b)) {
                    around.push_back(-1 - ((a - 1) * (nv - 1) + b - 1));
                    continue;
                }
                const std::size_t at = grid.along_border(a, b);
                const int from = step[at], to = on_border[k] ? step[at + 1] : from + 1;
                for (int p = from; p < to; ++p) around.push_back(p);
            }
            visit(i, j, std::span<const int>(around));
        }
}

// `border`: the points of that; points inside have numbers from `first_inner` on, and `add_point` makes one
// of the centre of a cell.
void add_cells(const BlockGrid& grid, std::span<const int> border, std::span<const int> step, int first_inner,
               const CellWays& ways, const std::function<int(int i, int j)>& add_centre,
               std::vector<std::array<int, 3>>& triangles);

}  // namespace freiform
