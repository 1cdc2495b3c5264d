// Triangles of the blocks of a tree (curvature_tree_blocks.cpp): cells of a grid, as they are.
#pragma once
#include "judge_detail.hpp"

namespace freiform {

struct BlockMesh {
    std::vector<Vec<2>> points;  // those on the outline first
    // Counter-clockwise; every one is within a cell of its block.
    std::vector<std::array<int, 3>> triangles;
    // Sides of triangles that no other block has: what encloses all blocks by the odd-even rule. The corners
    // of leaves that lie there are ends of them.
    std::vector<std::array<int, 2>> outline;
    int on_outline = 0;
    std::vector<char> needs_foot, plain;  // of points on the outline: as Filler::keep_feet
    double bound = 0;                     // of the distance, of all triangles
    // Corners of the other leaves, and of the cells of blocks for which no bound was found.
    std::vector<CurvatureTree::Corner> corners;
};

// Blocks near places to `avoid` are left out. `is_shared`: all threads may be used.
BlockMesh mesh_blocks(const CurvatureTree& tree, const Judge& judge, double tolerance, bool is_shared,
                      std::span<const Vec<2>> avoid = {});

}  // namespace freiform
