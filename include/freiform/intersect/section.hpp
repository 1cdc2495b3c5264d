// Where a surface meets a plane: every branch, none missed, as splines.
#pragma once
#include <freiform/intersect/contact.hpp>
#include <freiform/spline/patch.hpp>

#include <string_view>
#include <vector>

namespace freiform {

// All x with normal . x + offset = 0. The length of the normal does not matter.
struct Plane {
    Vec<3> normal{};
    double offset = 0;
};

struct SectionOptions {
    double tolerance = 0;    // a distance; positive
    int max_cells = 100000;  // a backstop: parts of the parameter domain that are halved
};

// What a branch ends at, beside a node (>= 0).
inline constexpr int kAtBoundary = -1;  // of the surface, or a line along which it tears or lies in the plane
inline constexpr int kAtUndecided = -2;  // one of the boxes of which nothing is known

// One branch. Both curves run over the same interval, [0, length] roughly: surface(at(t)) is near curve(t).
struct SectionBranch {
    Curve<Vec<3>> curve;  // cubic; C^1 where the surface is
    Curve<Vec<2>> at;     // parameters of the surface; jumps where a seam is crossed
    bool closed = false;  // ends where it begins, with the same tangent
    std::array<int, 2> ends{kAtBoundary, kAtBoundary};
    double surface_bound = 0;  // no point of the curve is farther from the surface
    double plane_bound = 0;    // nor from the plane
    // No point of the curve is farther from the true branch, nor the other way round. Up to the tolerance;
    // more where rounding does not allow it, beside nodes.
    double bound = 0;
};

enum class SectionNodeKind {
    touch,     // the surface touches the plane: nothing, one point, or one loop, all within the box
    crossing,  // two branches cross, or pass each other by, within the box: the surface has a saddle there
    unclear,   // branches end, or touch a side of the surface, or more: rounding does not tell
};
std::string_view name_of(SectionNodeKind kind);

struct SectionNode {
    SectionNodeKind kind = SectionNodeKind::unclear;
    std::array<Interval, 2> box{};  // parameters; over the seam of a closed surface beyond the domain
    Vec<3> point{};                 // of the surface, in its middle
    double gap = 0;                 // bound: how far points of the surface over the box are from the plane
    int arms = 0;                   // branches that end there
};

struct Section {
    std::vector<SectionBranch> branches;
    std::vector<SectionNode> nodes;
    std::vector<std::array<Interval, 2>> overlaps;   // the surface lies in the plane, exactly
    std::vector<std::array<Interval, 2>> undecided;  // the budget ended
    double tolerance_reached() const {
        double most = 0;
        for (const SectionBranch& b : branches) most = std::max(most, b.bound);
        return most;
    }
};

// The section of a surface by a plane. Outside of the branches, the boxes of nodes, overlaps and what is
// undecided the surface does not meet the plane, rounding included: for the net as it is given, the exact
// scalar products with the normal, and the exact plane.
//
// Small closed branches are found like others. A branch ends at the boundary of the surface or at a node; at
// the seam of a closed surface it goes on (also of one that is closed because its first and last control
// points are the same). Sides of the surface that lie in the plane, and knot lines along which it touches it,
// are branches; a side that is a point is not. Where it only lies in the plane within rounding there is a
// node, or undecided boxes.
//
// Time: for each branch some multiple of (length / tolerance)^(1/3), and bounded by backstops.
//
// Refuses tolerances that are not positive, planes without normal or with numbers that are not finite.
//   const auto cut = section(surface, {{0, 0, 1}, -2.0}, {.tolerance = 1e-6});   // z = 2
template <class P>
requires(Space<P>::kDim == 3) Result<Section> section(const Surface<P>& surface, const Plane& plane,
                                                      const SectionOptions& options);

}  // namespace freiform
