// See blocks.cpp for the whole.
#include "block_cells_detail.hpp"

#include <algorithm>

namespace freiform {

namespace {

using Triangles = std::vector<std::array<int, 3>>;

void add_halves(const std::array<int, 4>& corner, bool rising, Triangles& out) {
    const std::size_t k = rising ? 0 : 1;
    out.push_back({corner[k], corner[k + 1], corner[k + 2]});
    out.push_back({corner[k], corner[k + 2], corner[(k + 3) % 4]});
}

void add_around(int centre, std::span<const int> around, Triangles& out) {
    for (std::size_t k = 0; k < around.size(); ++k)
        out.push_back({around[k], around[(k + 1) % around.size()], centre});
}

// Those from `from`: a fan, but for the last corner if it is `many` == 2 that are inside.
void add_fan(std::vector<int> around, std::size_t from, std::size_t many, Triangles& out) {
    std::rotate(around.begin(), around.begin() + std::ptrdiff_t(from), around.end());
    const std::size_t last = around.size() - 1, turn = many == 2 ? last / 2 : last;
    const auto add = [&](std::size_t a, std::size_t b, std::size_t c) {
        out.push_back({around[a], around[b], around[c]});
    };
    for (std::size_t k = 1; k < turn; ++k) add(0, k, k + 1);
    if (many == 2) add(0, turn, last);
    for (std::size_t k = turn; k + 1 < last; ++k) add(k, k + 1, last);
}

}  // namespace

void add_cells(const BlockGrid& grid, std::span<const int> border, std::span<const int> step, int first_inner,
               const CellWays& ways, const std::function<int(int i, int j)>& add_centre,
               std::vector<std::array<int, 3>>& triangles) {
    const int nu = grid.cells(0), nv = grid.cells(1);
    for (int i = 1; i + 1 < nu; ++i)
        for (int j = 1; j + 1 < nv; ++j) {
            const int a = first_inner + (i - 1) * (nv - 1) + j - 1, b = a + nv - 1;
            add_halves({a, b, b + 1, a + 1}, ways.rising[ways.part_of(i, j)], triangles);
        }
    each_border_cell(grid, step, [&](int i, int j, std::span<const int> places) {
        std::vector<int> around(places.size());
        std::size_t first = 0, many = 0;
        for (std::size_t k = 0, n = places.size(); k < n; ++k) {
            const bool is_inner = places[k] < 0;
            around[k] = is_inner ? first_inner - 1 - places[k] : border[std::size_t(places[k])];
            if (!is_inner) continue;
            ++many;
            if (many == 1 || places[(k + n - 1) % n] < 0) first = k;
        }
        if (around.size() == 4)
            add_halves({around[0], around[1], around[2], around[3]}, ways.rising[ways.part_of(i, j)],
                       triangles);
        else if (ways.from_centre)
            add_around(add_centre(i, j), around, triangles);
        else
            add_fan(std::move(around), first, many, triangles);
    });
}

}  // namespace freiform
