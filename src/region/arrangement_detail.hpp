// What arcs cut each other into: edges between places, and on which sides of them the regions lie.
#pragma once
#include "meetings_detail.hpp"

namespace freiform::detail {

// A part of an arc between two places. Edges that are the same curve within rounding are a bundle, which
// goes by its first edge.
struct RegionEdge {
    std::size_t arc = 0;
    std::size_t number = 0;  // along its arc
    Interval on;
    int from = 0, to = 0;    // places
    std::size_t bundle = 0;  // index of its first edge
    int sign = 1;            // -1: runs against it
    // Of the first edge of a bundle: how much the winding numbers of both operands are greater on its left.
    std::array<int, 2> jump{};
    double gap = 0;  // within which its bundle is the same curve
    bool is_first(std::size_t own_index) const { return bundle == own_index; }
};

struct Arrangement {
    std::vector<RegionArc> arcs;
    ArcTree tree;
    std::vector<RegionEdge> edges;
    std::vector<Vec<2>> places;
    std::vector<std::vector<std::size_t>> members;  // of each bundle, at the index of its first edge
    double scale = 0;                               // largest coordinate
    double moved = 0;  // bound: from a place to all that belongs to it, and gaps of bundles
};

// Two lengths. What is smaller than `smallest`, or than rounding, is drawn together; arcs that run along each
// other no farther apart than `accuracy` may be called the same.
struct Nearness {
    double smallest = 0, accuracy = 0;
};
Result<Arrangement> arrange(std::vector<RegionArc> arcs, const Nearness& near, const RegionOptions& options);

// Winding numbers of both operands on both sides of a bundle.
struct EdgeSides {
    bool known = false;
    std::array<int, 2> left{}, right{};
};
// Of all bundles with a jump, at the index of the first edge. Refuses (ill_conditioned).
Result<std::vector<EdgeSides>> sides_of(const Arrangement& arrangement);

// Loops from the edges that `keep` names: +1 as it runs, -1 against, 0 not. At each place as many must
// begin as end.
Result<Path> loops_of(const Arrangement& arrangement, std::span<const int> keep);

}  // namespace freiform::detail
