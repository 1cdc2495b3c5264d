// Paths as chains of circular arcs and lines, as near as a pen of some width asks for.
#pragma once
#include "arcs_detail.hpp"

#include <freiform/core/bounded.hpp>

#include <vector>

namespace freiform::detail {

// From a to b with the unit tangents ta, tb; curvature > 0 turns to the left, 0 is a line.
struct ArcPiece {
    Vec<2> a, b, ta, tb;
    double curvature = 0;
    Vec<2> centre;

    Vec<2> normal_a() const { return {{-ta[1], ta[0]}}; }
    Vec<2> normal_b() const { return {{-tb[1], tb[0]}}; }
};

// How a piece follows the one before.
enum class PieceJoint {
    smooth,  // with the same tangent
    round,   // a cusp inside of a segment
    turn,    // a sharp bend inside of a segment, by less than a right angle
    corner,  // between segments
};

struct ArcChain {
    std::vector<ArcPiece> pieces;
    std::vector<PieceJoint> before;  // of each piece; of the first one only if closed
    // At corners, for each piece: the curvatures of the segments that end and begin there, to the left. 0
    // where it is infinite.
    std::vector<std::array<Bounded, 2>> bends;
    bool closed = false;
    // For every point of the pen at a place of the path there is one of the pen at a place of the chain
    // within this distance, and the other way round.
    double bound = 0;
};

// Of a subpath with some length. Refuses (limit, ill_conditioned).
Result<ArcChain> arc_chain(const Subpath& subpath, double half_width, double tolerance);

}  // namespace freiform::detail
