// The zero set of a piecewise polynomial function of two parameters: its branches, cell by cell.
#pragma once
#include "level_cells_detail.hpp"

namespace freiform::detail {

// A chain of cells with one arc each. at[i] and at[i + 1] are where the branch enters and leaves cells[i];
// the places continue over the seam of a cyclic axis, those of the cell are at + shift[i].
struct LevelBranch {
    std::vector<int> cells;
    std::vector<Place> at, shift;
    bool closed = false;
    std::array<int, 2> node{-1, -1};  // that it begins and ends at; -1: at the boundary
};

struct LevelNode {
    std::array<Interval, 2> box{};
    double value = 0;  // bound of |f| in the box
    int arms = 0;      // branches that end here
    // +1, -1: the determinant of second derivatives has this sign all over a convex neighbourhood, so that
    // there is no second critical point.
    int bending = 0;
};

// A side of a piece along which the function is 0.
struct LevelSide {
    int axis = 0;    // across it
    int line = 0;    // its place along that axis
    Interval along;  // places of the other axis
};

struct LevelSet {
    std::vector<LevelCell> cells;
    std::vector<LevelBranch> branches;
    std::vector<LevelNode> nodes;
    std::vector<LevelSide> sides;
    std::vector<std::array<Interval, 2>> flat;       // the function is zero
    std::vector<std::array<Interval, 2>> undecided;  // the budget ended
};

struct LevelOptions {
    std::array<bool, 2> cyclic{};
    std::array<std::vector<int>, 2> tears;  // lines over which the function is not continuous
    int max_cells = 0;
};

// Outside of the cells of branches, the boxes of nodes and of what is undecided, and of sides and flat boxes
// themselves, the function is not 0. In each cell of a branch its zeros are one arc.
LevelSet level_set(const ArcPieces<2, Vec<1>>& f, const LevelOptions& options);

}  // namespace freiform::detail
