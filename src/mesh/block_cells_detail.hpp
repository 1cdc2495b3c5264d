// Triangles of the cells of a block.
#pragma once
#include "block_judge_detail.hpp"

#include <span>

namespace freiform {

// `border`: points along the border of the block, counter-clockwise from the lower corner; `step`: which of
// them each cell there begins with, and their number. Points inside have numbers from `first_inner` on, row
// by row. Cells at the border are fans from their corner inside, if they have one, others two triangles.
void add_cells(const BlockGrid& grid, std::span<const int> border, std::span<const int> step, int first_inner,
               std::vector<std::array<int, 3>>& triangles);

}  // namespace freiform
