// How smoothly surfaces meet along a line: the order of parametric (C) and of geometric (G) continuity of a
// joint of two tensor patches, and the largest jump of each order along it, found with a proven bound.
//
//   C^k: the derivatives across the line up to order k agree at corresponding points, parameters as they are.
//   G^0: the lines agree. G^1: so do the tangent planes, and the second surface goes on where the first one
//   ends. G^2: so do the second fundamental forms. With G^1 these differ at most in the curvature of the
//   normal section orthogonal to the line [Pegna & Wolter 1992], so this one curvature is compared.
//
// Points correspond where their parameters along the line do, by the affine map of one edge to the other (the
// edge may be run through backwards). Edges that are one curve with different parameters in between are
// compared as they are parametrised. Rational surfaces are judged by their points. The vocabulary and the
// options are those of curves: continuity.hpp.
#pragma once
#include <freiform/query/continuity.hpp>

#include <array>

namespace freiform {

// A surface along one of its iso-lines, seen from one side: the line with its derivatives across, in Bezier
// pieces along it. What joints are made of.
struct SurfaceSide {
    struct Piece {
        Bounded from, to;  // its part of the line, as fractions of the whole
        Interval on;       // its parameters
        // [order * (dimension + 1) + coordinate]: Bernstein coefficients; coordinates times weight, measured
        // from `origin`, last the weight (a polynomial side: 1).
        std::vector<std::vector<Bounded>> derivative;
    };
    int dimension = 0, orders = 0;
    bool is_rational = false;
    double parameter = 0;        // of the line
    double span = 0, reach = 0;  // across: length of the piece in parameters; in model units (estimate)
    double length = 0;           // of the polygon of the line's control points; 0: a pole
    double uncertainty = 0;      // of the fractions: what parameters are granted
    std::vector<double> origin;
    std::vector<Piece> pieces;
};
// Derivatives across of orders 0 .. max(2, options.orders), on the piece before or after the parameter `at`
// of `axis`. REQUIRES at inside the domain, not at its lower end (before) or upper end (after).
template <class P>
SurfaceSide side_before(const Surface<P>& s, int axis, double at, const ContinuityOptions& options);
template <class P>
SurfaceSide side_after(const Surface<P>& s, int axis, double at, const ContinuityOptions& options);
// The part of the line between two of its parameters, `on.lo` before `on.hi` as the line runs; those count as
// known up to `grant` where they are not its ends. REQUIRES that they are on the line and more than 2 `grant`
// apart.
SurfaceSide part_of(const SurfaceSide& side, const Interval& on, double grant);
SurfaceSide reversed_across(SurfaceSide side);  // the parameter of `axis` run through backwards
SurfaceSide reversed_along(SurfaceSide side);   // the line run through backwards
// The side that arrives at an edge from the inside. Refuses axes that are closed, which have no edge.
template <class P>
Result<SurfaceSide> arriving(const Surface<P>& s, SurfaceEdge edge, const ContinuityOptions& options);

// The largest jump along a line: |exact largest - size| <= bound, and `size` is (up to its bound) what is
// found at the parameter `at` of the line of the first surface.
struct LargestJump {
    double size = 0, bound = 0, at = 0;
};

struct SurfaceContinuity {
    std::vector<LargestJump> c;  // [k]: of the derivative of order k across, length / parameter^k
    // [0]: distance; [1]: angle of the tangent planes in radians, pi where the second surface turns back;
    // [2]: curvature, 1 / length. g ends with [0] where surfaces have neither two nor three coordinates and
    // where tangent planes have no answer anywhere, and with [1] where G^1 does not hold. In the plane, where
    // tangent planes are one, [1] and [2] are 0 unless the second surface folds back.
    std::vector<LargestJump> g;
    int c_order = -1, g_order = -1;  // the highest order with all jumps up to it none; -1: not even C0
    bool opposed = false;            // somewhere the second surface turns back, as far as is known
    // Parameters of the line where the normal of one side is 0 as far as is known (poles): left out of g[1]
    // and g[2].
    std::vector<Interval> singular;

    std::optional<LargestJump> first_c_jump() const;
    std::optional<LargestJump> first_g_jump() const;
};

// A jump counts as none if size <= bound + what is allowed, as for curves. The bound is at most a thousandth
// of the jump, or what rounding and the grant of `roundings` leave, or (rare) what a budget of subdivisions
// allows. Refuses sides of different dimensions, options that are negative or not finite, and
// (ill_conditioned) numbers beyond the largest double.
Result<SurfaceContinuity> continuity(const SurfaceSide& before, const SurfaceSide& after,
                                     const ContinuityOptions& options = {});

// The joint of two edges; `against`: the second edge is run through against the first.
//   auto j = joint(a, {0, End::end}, b, {0, End::start}); if (j) use(j->g_order, j->first_g_jump());
template <class P, class Q>
requires(Space<P>::kDim ==
         Space<Q>::kDim) Result<SurfaceContinuity> joint(const Surface<P>& first, SurfaceEdge first_edge,
                                                         const Surface<Q>& second, SurfaceEdge second_edge,
                                                         bool against = false,
                                                         const ContinuityOptions& options = {}) {
    const auto a = arriving(first, first_edge, options);
    if (!a) return refuse_within("first", a.error());
    auto b = arriving(second, second_edge, options);
    if (!b) return refuse_within("second", b.error());
    SurfaceSide side = reversed_across(*std::move(b));
    return continuity(*a, against ? reversed_along(std::move(side)) : side, options);
}

struct LineContinuity {
    double at = 0;  // the knot; of a seam the lower end of the domain
    int multiplicity = 0;
    bool seam = false;
    SurfaceContinuity joint;
};
// Every knot line of one axis inside the domain, in order; then the seam, of a closed axis or where the two
// edges of an open one meet. REQUIRES axis 0 or 1.
template <class P>
Result<std::vector<LineContinuity>> continuity(const Surface<P>& s, int axis,
                                               const ContinuityOptions& options = {});

// What joints between surfaces of a document need of one of them: the sides arriving at its edges, in the
// order u start, u end, v start, v end. A side without pieces takes no part: closed axes, edges that are a
// point.
using SurfaceEdges = std::array<SurfaceSide, 4>;
template <class P>
SurfaceEdges edges_of(const Surface<P>& s, const ContinuityOptions& options = {});
constexpr SurfaceEdge edge_at(std::size_t i) { return {int(i / 2), i % 2 == 0 ? End::start : End::end}; }

struct SurfaceMeeting {
    std::size_t first = 0, second = 0;
    SurfaceEdge first_edge, second_edge;
    bool against = false;
    double distance = 0;  // the largest at 9 places (estimate)
    // The parts of both lines that meet, in their parameters, each from lo to hi; the whole lines, or what
    // one has of the other where an edge ends inside another (T-joints).
    Interval first_on, second_on;
    bool whole = true;
    double grant[2] = {0, 0};  // parameters of parts are known up to this
};
struct SurfaceJoint {
    SurfaceMeeting meeting;
    SurfaceContinuity joint;
};
// All pairs of edges, of different surfaces or of one, of which a part is common that is longer than `gap`
// and lies within it at 9 places: both whole edges, one as a part of the other, or an end of each. Ends are
// found on the other edge by a search on a grid that Newton's method refines; where an edge comes near to the
// same end several times, the nearest place counts. Points in between correspond by the affine map of the
// parameters. `roundings` as in ContinuityOptions. In the order of the list. Refuses (limit) more than `most`
// pairs. Cost: O(n log n) and the pairs whose boxes are that close.
Result<std::vector<SurfaceMeeting>> meetings(std::span<const SurfaceEdges> surfaces, double gap,
                                             double roundings = 4, std::size_t most = 1'000'000);
// The meetings with their continuity. `gap` is for finding; whether a joint is C0 depends on the options.
Result<std::vector<SurfaceJoint>> joints(std::span<const SurfaceEdges> surfaces, double gap,
                                         const ContinuityOptions& options = {}, std::size_t most = 1'000'000);

}  // namespace freiform
