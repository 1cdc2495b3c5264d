// Loops that bound a region: whether they close without crossing, and how they are turned and nested.
//
// A loop is what InsideQuery takes: a chain of splines, the end of each at the start of the next, or one
// ellipse.
#pragma once
#include <freiform/trim/inside.hpp>

namespace freiform {

enum class LoopContactKind {
    touch,      // before and after it each loop is on the same side of the other: they do not cross there, or
                // an even number of times, all within what it is known by
    undecided,  // what lies beside it is too near to tell: loops that run along each other all the way,
                // spikes
};

// Two places of the loops that meet, or may: `loop[0] == loop[1]` where a loop meets itself.
struct LoopContact {
    std::array<std::size_t, 2> loop{}, curve{};  // loops[loop[k]][curve[k]], k = 0 before 1
    Vec<2> point{};
    double bound = 0;  // from `point` to both curves where they meet, at most
    LoopContactKind kind = LoopContactKind::undecided;
    friend bool operator==(const LoopContact&, const LoopContact&) = default;
};
// loops[0][2] and loops[1][0] at (0.5, 0.25)
std::string to_text(const LoopContact& contact);

struct LoopTolerance {
    double gap = 0;       // ends of neighbouring curves may be so far apart
    double accuracy = 0;  // > 0: crossings are known so well, and contacts told from passing by
};

// Refuses, with the place, loops that InsideQuery refuses and loops that cross themselves or each other: at
// an angle, in a vertex, at a tangent, along a common stretch, in any way that makes a loop go round some
// point twice, or round two points in different directions. Such a refusal is never wrong: it holds for all
// curves within `gap` of the given ones at their ends. What is returned are all other places where loops
// meet, or where it is not certain that they do not: where they touch, run along each other, or pass within
// `accuracy`. Nowhere else do they meet. Refuses (limit) loops that are so much on top of each other that
// looking at all pairs of pieces would take too long.
//   auto contacts = check_loops(loops, {0, 1e-9});   // empty: simple and disjoint, proven
Result<std::vector<LoopContact>> check_loops(std::span<const std::vector<CurveGeometry<2>>> loops,
                                             const LoopTolerance& tolerance);

struct OrientedLoops {
    std::vector<std::vector<CurveGeometry<2>>> loops;
    std::vector<int> depth;             // in so many other loops each one lies
    std::vector<std::size_t> reversed;  // which were turned round, in increasing order
};

// Loops in none or an even number of others become counter-clockwise, those in an odd number clockwise, so
// that the region of the odd-even rule is on their left side and the winding number is 1 in it and 0
// elsewhere. The order of the loops stays; a loop that is turned has its curves in reverse order, each run
// through backwards. Refuses what check_loops refuses, loops that enclose nothing, and (no_answer) loops of
// which it is not certain on which side of each other they are.
Result<OrientedLoops> orient_loops(std::vector<std::vector<CurveGeometry<2>>> loops,
                                   const LoopTolerance& tolerance);

}  // namespace freiform
