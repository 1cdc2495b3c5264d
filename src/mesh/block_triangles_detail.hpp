// Triangles of blocks and leaves, once it is known what points they have on their sides.
#pragma once
#include "block_cells_detail.hpp"
#include "leaf_triangles_detail.hpp"

namespace freiform {

// Numbers of points along the border, counter-clockwise from the lower corner of the box. `step`: where each
// cell along it begins; sides follow each other.
struct MeshedBlock {
    BlockGrid grid;
    CurvatureTree::Block of_tree;
    CellWays ways;
    bool needs_foot = false;
    std::vector<int> border = {}, step = {};
};

// A block of one cell. Small, as there are many.
struct MeshedLeaf {
    std::uint32_t block;  // of the tree
    std::uint16_t count = 0;
    bool is_plain = false;
    bool has_centre = false;         // and its triangles meet there
    std::array<int, 4> corner = {};  // numbers of points
    const int* border = nullptr;     // `count` of them, counter-clockwise from the lower corner
    // Of its own triangles, where all points have feet, and where none has.
    double bound = kInfinity, flat = kInfinity;
    int centre = -1;  // in the mesh, if it has one
    std::size_t triangles() const { return std::size_t(count) - (has_centre ? 0 : 2); }
};
inline std::span<const int> border_of(const MeshedLeaf& l) { return {l.border, l.count}; }
inline Vec<2> middle_of(const Box<2>& b) { return {{b.side(0).middle(), b.side(1).middle()}}; }

class BlockTriangles {
public:
    struct Work {
        std::vector<Vec<2>> places = {};
        std::vector<std::array<int, 3>> found = {};  // by places in a border, after which comes the centre
    };

    BlockTriangles(const CurvatureTree& tree, const Judge& judge, double tolerance,
                   std::span<const Vec<2>> points)
        : tree_(tree), judge_(judge), tolerance_(tolerance), points_(points) {}

    // Finds triangles that keep the tolerance, and what they keep; without feet, if there are none else.
    void settle(MeshedLeaf& l, const JudgedBlock& judged, Work& work) const;
    void find(const MeshedLeaf& l, Work& work) const;
    // What triangles from centres keep at the border of the block; infinite above the tolerance.
    double bound_from_centres(const MeshedBlock& b) const;

private:
    // Infinite above the tolerance.
    double judged(const MeshedLeaf& l, Work& work) const;
    double judged(const Bending& bends, int node, const std::array<Vec<2>, 3>& corner, int plain) const;

    const CurvatureTree& tree_;
    const Judge& judge_;
    double tolerance_;
    std::span<const Vec<2>> points_;
};

}  // namespace freiform
