// Where two surfaces meet: every branch, none missed, as splines.
#pragma once
#include <freiform/intersect/contact.hpp>
#include <freiform/spline/geometry.hpp>

#include <string_view>
#include <vector>

namespace freiform {

struct SurfaceIntersectOptions {
    double tolerance = 0;       // a distance; positive
    int max_pairs = 2'000'000;  // a backstop: pairs of parts of both surfaces that are looked at
};

// What a branch ends at, beside a node (>= 0).
inline constexpr int kAtBorder = -1;      // of one of the surfaces
inline constexpr int kAtUnresolved = -2;  // one of the boxes of which nothing is known

enum class SurfaceBranchKind {
    crossing,  // at an angle
    tangent,  // the surfaces are within `gap` of each other along it, and have the same tangent plane: as far
              // as rounding tells they touch, or meet twice next to it, or nearly meet
};
std::string_view name_of(SurfaceBranchKind kind);

// One branch. The curves run over the same interval, [0, length] roughly: a(at_a(t)) and b(at_b(t)) are near
// curve(t).
struct SurfaceBranch {
    Curve<Vec<3>> curve;       // cubic; C^1 where the surfaces are
    Curve<Vec<2>> at_a, at_b;  // parameters of both surfaces; they jump where a seam is crossed
    bool closed = false;       // ends where it begins
    std::array<int, 2> ends{kAtBorder, kAtBorder};
    // No point curve(t) is farther from a(at_a(t)), and so from the first surface; from the second one.
    double bound_a = 0, bound_b = 0;
    SurfaceBranchKind kind = SurfaceBranchKind::crossing;
    int node = -1;  // in the cells of which a tangent one runs
    double bound() const { return std::max(bound_a, bound_b); }
    double gap() const { return bound_a + bound_b; }  // bound: from a(at_a(t)) to b(at_b(t))
};

enum class SurfaceNodeKind {
    touch,     // the surfaces touch: nothing, one point, or a loop, all within the box
    crossing,  // branches cross, or pass each other by, within the box
    // They are the same over `overlaps`; or whole pieces have the same control points; or both are parts of
    // one sphere, with other poles.
    overlap,
    tangent,  // they touch along tangent branches, as far as is known
    along,    // the surfaces run along each other within the tolerance, and no more is known
};
std::string_view name_of(SurfaceNodeKind kind);

// The surfaces are the same but for their parameters, over two regions: loops of corners, joined by segments,
// counter-clockwise in A; corner i of both is one place.
struct SurfaceOverlap {
    std::vector<Vec<2>> loop_a, loop_b;
    double gap = 0;  // bound: no point of either region is farther from the other one
    // The corners give the map between the parameters: it is affine. Otherwise it goes along angles of
    // rational splines.
    bool is_affine = true;
};

// Parameters of both surfaces where they are so near to each other, and so parallel, that the tolerance does
// not tell how they meet.
struct SurfaceNode {
    SurfaceNodeKind kind = SurfaceNodeKind::along;
    std::array<Interval, 2> box_a{}, box_b{};  // over the seam of a closed surface: all of its period
    std::array<double, 2> at_a{}, at_b{};      // where they are nearest, or parallel, as an estimate
    Vec<3> point{};                            // of the first surface there
    // bound: how far the points of both at these parameters are from each other; at least that of `overlaps`
    double gap = 0;
    int arms = 0;                                // branches that end there
    std::vector<std::array<Interval, 4>> cells;  // (u, v, s, t): what `box` is the hull of
    std::vector<SurfaceOverlap> overlaps;        // of kind overlap
};

struct SurfaceIntersection {
    std::vector<SurfaceBranch> branches;
    std::vector<SurfaceNode> nodes;
    // Parameters of both of which nothing is known: the budget ended. Many boxes are one around all.
    std::vector<std::array<Interval, 4>> undecided;
};

// The intersection of two surfaces. Outside of the branches, the cells of nodes and what is undecided they do
// not meet, and that is proven, rounding included.
//
// Branches are found by proof, small closed ones like others, and none twice. Where the surfaces touch within
// the tolerance at a point, or overlap, there is a node instead, and branches end there. Where they touch
// along a curve, that is a tangent branch, in a node whose cells are up to 2^-7 of the smaller surface wide,
// or the root of the tolerance; what else there is in these cells is not known. Branches go on over the seam
// of a closed surface (also of one that is closed because its first and last control points are the same),
// and end at the border of one of them.
//
// Refuses tolerances that are not positive.
//   const auto found = intersect(a, b, SurfaceIntersectOptions{.tolerance = 1e-6});
template <class P, class Q>
requires(Space<P>::kDim == 3 &&
         Space<Q>::kDim == 3) Result<SurfaceIntersection> intersect(const Surface<P>& a, const Surface<Q>& b,
                                                                    const SurfaceIntersectOptions& options);

// A box of the parameters of any surface that models are made of: angles at most one turn.
struct SurfacePart {
    SurfaceGeometry surface;
    std::array<Interval, 2> on{};
};
struct PartIntersection : SurfaceIntersection {
    // Analytic surfaces and offsets are searched as splines: bounds of how far these are from the surfaces,
    // so that where they are proven to be apart, the surfaces may meet if they are nearer than this.
    std::array<double, 2> search_bound{};
};

// The same for surfaces of models, in their own parameters; bounds of branches are those of the surfaces
// themselves. Splines that are near offsets of splines are at most a 32nd of the tolerance away. Refuses
// (unsupported) other offsets, and what offset_spline refuses; (invalid) boxes that are not bounded, and
// tolerances that are not positive.
Result<PartIntersection> intersect(const SurfacePart& a, const SurfacePart& b,
                                   const SurfaceIntersectOptions& options);

// Contains the part. Refuses what `intersect` refuses of it.
Result<Box<3>> box_of_part(const SurfacePart& part);

}  // namespace freiform
