// Triangles of the blocks of a tree (curvature_tree_blocks.cpp): cells of a grid, as they are.
#pragma once
#include "judge_detail.hpp"

#include <functional>

namespace freiform {

// What has to be known around blocks.
struct BlockOutline {
    std::vector<Vec<2>> points;
    // Sides of triangles that no other block has: what encloses all blocks by the odd-even rule. The corners
    // of leaves that lie there are ends of them.
    std::vector<std::array<int, 2>> sides;
    std::vector<char> needs_foot, plain;  // of points: as Filler::keep_feet
    // Corners of the other leaves, and of the cells of blocks for which no bound was found.
    std::vector<CurvatureTree::Corner> corners;
};

struct BlockMesh {
    BlockOutline outline;
    std::vector<Vec<2>> points;  // inside of the outline; their numbers follow those of the points on it
    // Counter-clockwise; every one is within a cell of its block.
    std::vector<std::array<int, 3>> triangles;
    double bound = 0;  // of the distance, of all triangles
};

// What else there is to do, called once each: `before` while the outline is found, `around` with the outline
// while triangles inside of it are made; one after the other unless `is_shared`: all threads may be used.
struct BesideBlocks {
    std::function<void()> before;
    std::function<void(const BlockOutline&)> around;
};
// Blocks near places to `avoid` are left out.
BlockMesh mesh_blocks(const CurvatureTree& tree, const Judge& judge, double tolerance, bool is_shared,
                      std::span<const Vec<2>> avoid, const BesideBlocks& beside);

}  // namespace freiform
