// See blocks.cpp for the whole.
#include "block_cells_detail.hpp"

namespace freiform {

namespace {

struct Cells {
    const BlockGrid& grid;
    std::span<const int> border, step;
    int first_inner;
    std::vector<std::array<int, 3>>& triangles;
    std::vector<int> around = {};  // work space

    int inner(int i, int j) const { return first_inner + (i - 1) * (grid.cells(1) - 1) + j - 1; }

    // From a corner inside the block, counter-clockwise; if two are, the other one comes last.
    void add_at_border(int i, int j) {
        const std::array<std::array<int, 2>, 4> corner{{{i, j}, {i + 1, j}, {i + 1, j + 1}, {i, j + 1}}};
        const bool on_border[4] = {j == 0, i + 1 == grid.cells(0), j + 1 == grid.cells(1), i == 0};
        const auto is_inner = [&](std::size_t k) {
            return grid.is_inner(corner[k % 4][0], corner[k % 4][1]);
        };
        std::size_t first = 0, many = 0;
        for (std::size_t k = 0; k < 4; ++k)
            if (is_inner(k)) {
                ++many;
                if (many == 1 || is_inner(k + 3)) first = k;
            }
        around.clear();
        for (std::size_t n = 0; n < 4; ++n) {
            const std::size_t k = (first + n) % 4;
            const auto [a, b] = corner[k];
            if (grid.is_inner(a, b)) {
                around.push_back(inner(a, b));
                continue;
            }
            const std::size_t at = grid.along_border(a, b);
            const int from = step[at], to = on_border[k] ? step[at + 1] : from + 1;
            for (int p = from; p < to; ++p) around.push_back(border[std::size_t(p)]);
        }
        const std::size_t last = around.size() - 1, turn = many == 2 ? last / 2 : last;
        const auto add = [&](std::size_t a, std::size_t b, std::size_t c) {
            triangles.push_back({around[a], around[b], around[c]});
        };
        for (std::size_t k = 1; k < turn; ++k) add(0, k, k + 1);
        if (many == 2) add(0, turn, last);
        for (std::size_t k = turn; k + 1 < last; ++k) add(k, k + 1, last);
    }
};

}  // namespace

void add_cells(const BlockGrid& grid, std::span<const int> border, std::span<const int> step, int first_inner,
               std::vector<std::array<int, 3>>& triangles) {
    Cells cells{grid, border, step, first_inner, triangles};
    const int nu = grid.cells(0), nv = grid.cells(1);
    for (int i = 0; i < nu; ++i)
        for (int j = 0; j < nv; ++j)
            if (i > 0 && j > 0 && i + 1 < nu && j + 1 < nv) {
                const int a = cells.inner(i, j), b = cells.inner(i + 1, j), c = cells.inner(i + 1, j + 1),
                          d = cells.inner(i, j + 1);
                triangles.push_back({a, b, c});
                triangles.push_back({a, c, d});
            } else {
                cells.add_at_border(i, j);
            }
}

}  // namespace freiform
