// How smoothly curves meet: the order of parametric (C) and of geometric (G) continuity of a joint, the size
// of every jump with a bound of its error, and the change of parameter that makes a G^k joint C^k.
//
//   C^k: the derivatives up to order k agree. G^k: those by arc length agree, that is, a change of parameter
//   phi of the second curve with phi' > 0 makes the joint C^k. G^1: the same tangent direction and sense.
//   G^2: the same curvature vector as well; in space with it the binormal. G^3: also torsion and the
//   derivative of curvature.
//
// Rational curves are judged by their points, not by their homogeneous coefficients.
#pragma once
#include <freiform/core/bounded.hpp>
#include <freiform/spline/edge.hpp>
#include <freiform/spline/patch.hpp>

#include <optional>
#include <span>
#include <vector>

namespace freiform {

// |exact size - size| <= bound, where "exact" is for every set of coefficients that rounds to the given ones
// (see ContinuityOptions::roundings).
struct Jump {
    double size = 0, bound = 0;
};

struct ContinuityOptions {
    // Orders 0 .. orders of G are looked at, and of C as far as the lower degree if that is more. 0..25.
    int orders = 3;
    // A distance in model units, >= 0. A jump counts as none if its effect is at most this: a jump j of the
    // derivative of order k moves a point by j h^k / k! in h, and h is the shorter of the neighbouring pieces
    // (C: in parameters, G: in length). 0: only what the bound of the jump explains.
    double tolerance = 0;
    // Besides, allowed by themselves: an angle in radians, jumps of the curvature vector in 1/length and of
    // the third derivative by arc length in 1/length^2. >= 0.
    double angle = 0, curvature = 0, third = 0;
    // Every coordinate counts as known up to this many roundings (2^-53) of the largest such coordinate of
    // its piece; 0: the coefficients are exact numbers. Coefficients that were computed to the last bit
    // (next_c, next_g) need 1, points that were read and interpolated once or twice a few.
    double roundings = 4;
};

// The geometry of one side of a joint. Signed curvature in the plane (left turns > 0), else >= 0.
struct SideGeometry {
    std::vector<double> tangent;       // unit vector; empty where there is none
    std::optional<Bounded> curvature;  // 1/length; where it has a limit
    std::optional<Bounded>
        curvature_rate;              // by arc length, 1/length^2; in the plane, else where curvature != 0
    std::optional<Bounded> torsion;  // 1/length; in space, where the curvature is certainly not 0
    std::vector<double> binormal;    // unit vector, likewise
};

struct Continuity {
    std::vector<double> point;  // where the first curve ends
    // c[k]: size of the jump of the derivative of order k; unit length / parameter^k.
    std::vector<Jump> c;
    // g[0]: distance; g[1]: angle between the tangents in radians, pi where they are opposite; g[k]: size of
    // the jump of the derivative of order k by arc length, 1/length^(k-1). At a joint without tangent g ends
    // with g[0], and where `unbounded` is set, before that order.
    std::vector<Jump> g;
    // The highest order such that all jumps up to it count as none; -1: not even C0. At most c.size() - 1 and
    // g.size() - 1: a joint may be smoother than was looked at.
    int c_order = -1, g_order = -1;
    // A first derivative is 0 (as far as is known) on one side: a cusp, or a piece that starts with a double
    // coefficient. Then tangents and derivatives by arc length are limits, C^k does not imply G^k, and bounds
    // hold with the derivatives that are 0 as far as is known taken for 0.
    bool singular = false;
    // At a singular joint: the order k of the first derivative by arc length that has no limit on one of the
    // sides (2: the curvature is infinite), so that the joint is certainly not G^k. 0: none was found.
    int unbounded = 0;
    // The tangents are parallel with opposite sense, as far as is known: a G0 joint that turns back.
    bool opposed = false;
    SideGeometry before, after;    // to the orders looked at
    std::optional<Jump> binormal;  // angle in radians; in space, where both curvatures are certainly not 0
    // phi[k]: derivative of order k of the change of parameter at the joint that matches arc length:
    // second(phi(t)) meets first(t) with C^k for every k <= g_order. phi[0] is the parameter of the second
    // curve there. Empty where the joint is singular.
    std::vector<double> phi;
    std::vector<double> phi_bound;  // of the error of phi[k]

    // c[c_order + 1] or g[g_order + 1]; nothing where all jumps that were looked at count as none.
    std::optional<Jump> first_c_jump() const;
    std::optional<Jump> first_g_jump() const;
};

// A curve at one of its parameters, seen from one side: its derivatives there with bounds. What joints are
// made of; curves of the same dimension, polynomial or rational, can be compared.
struct CurveSide {
    int dimension = 0, degree = 0;
    double parameter = 0;              // on the curve as it is run through
    double other_end = 0;              // of the domain; where `parameter` would be, run through backwards
    double span = 0;                   // length of the piece in parameters
    double reach = 0;                  // estimate of the length of the piece (8 points), model units
    std::vector<double> origin;        // a point nearby
    int orders = 0;                    // of C that are looked at
    std::vector<Bounded> derivatives;  // [order * dimension + coordinate]; of order 0: less `origin`
};
// Orders 0 .. max(options.orders, degree), and more where the first derivative is 0, of the curve on the
// piece before or after the parameter `at`. REQUIRES at inside the domain, not at its lower end (before) or
// upper end (after).
template <class P>
CurveSide side_before(const Curve<P>& curve, double at, const ContinuityOptions& options);
template <class P>
CurveSide side_after(const Curve<P>& curve, double at, const ContinuityOptions& options);
// The same side of the curve run through backwards, its parameter lo + hi - t.
CurveSide reversed(CurveSide side);
// The side that leads away from an end of the curve, run through backwards from the upper end; and the side
// that arrives there. Refuse closed curves, which have no end.
template <class P>
Result<CurveSide> leaving(const Curve<P>& curve, End end, const ContinuityOptions& options);
template <class P>
Result<CurveSide> arriving(const Curve<P>& curve, End end, const ContinuityOptions& options);

// Refuses sides of different dimensions, options that are negative or not finite, and (ill_conditioned,
// naming the order) derivatives beyond the largest double.
Result<Continuity> continuity(const CurveSide& before, const CurveSide& after,
                              const ContinuityOptions& options = {});

// The joint from the end of `first` to the start of `second`.
//   auto j = joint(a, b); if (j) use(j->g_order, j->phi);
template <class P, class Q>
requires(Space<P>::kDim == Space<Q>::kDim) Result<Continuity> joint(const Curve<P>& first,
                                                                    const Curve<Q>& second,
                                                                    const ContinuityOptions& options = {}) {
    const auto a = arriving(first, End::end, options);
    if (!a) return refuse_within("first", a.error());
    const auto b = leaving(second, End::start, options);
    if (!b) return refuse_within("second", b.error());
    return continuity(*a, *b, options);
}

struct KnotContinuity {
    double at = 0;         // the knot; of the seam of a closed curve the lower end of the domain
    int multiplicity = 0;  // m. Without looking at coefficients: C^(degree - m), if m <= degree
    bool seam = false;
    // Both sides are one and the same polynomial (rational curves: numerator and weight are), as far as is
    // known: knots like this can be removed.
    bool removable = false;
    Continuity joint;
};
// Every knot inside the domain, in order. Then the seam: of a closed basis, or the joint of the last end with
// the first where an open curve comes back to its start (within tolerance and rounding).
template <class P>
Result<std::vector<KnotContinuity>> continuity(const Curve<P>& curve, const ContinuityOptions& options = {});

// A knot of a curve, surface or volume along one axis, judged by coefficients: only the order of C.
struct KnotLine {
    double at = 0;
    int multiplicity = 0;
    bool seam = false;
    // c[k], k = 0 .. degree: the largest coefficient of the jump of the derivative of order k by this
    // parameter, which no jump along the whole line exceeds. Unit length / parameter^k. Of a rational patch
    // numerator A and weight w are looked at, each a spline, as (|jump of A| + r |jump of w|) / min w, with A
    // and r, the radius of the net, measured from one of its points.
    std::vector<Jump> c;
    int c_order = -1;  // of a rational patch: at least this
};
// Of the options `tolerance` and `roundings` are used. REQUIRES axis < N.
template <std::size_t N, class P>
Result<std::vector<KnotLine>> knot_lines(const Patch<N, P>& patch, int axis,
                                         const ContinuityOptions& options = {});

// What joints between curves of a drawing need of one of them.
struct CurveEnds {
    CurveSide start,
        end;  // the sides inside the curve, as it is run through; without dimension: takes no part
};
// A closed curve takes no part.
template <class P>
CurveEnds ends_of(const Curve<P>& curve, const ContinuityOptions& options = {});

// Two ends that meet, of different curves or of one. Curves are counted as in the list. As far as the ends
// allow, the end of the first meets the start of the second; a curve that meets with the wrong end is run
// through backwards.
struct Meeting {
    std::size_t first = 0, second = 0;
    End first_end = End::end, second_end = End::start;
    double distance = 0;
};
// All pairs of ends that are at most `gap` apart, in the order of the list; where more than two ends meet,
// every pair. Curves of different dimensions do not meet. Refuses (limit) more than `most` pairs. Cost: O(n
// log n) and the pairs whose first coordinates are that close.
Result<std::vector<Meeting>> meetings(std::span<const CurveEnds> curves, double gap,
                                      std::size_t most = 1'000'000);

struct CurveJoint {
    Meeting meeting;
    Continuity joint;
};
// The meetings with their continuity. `gap` is for finding; whether a joint is C0 depends on the options,
// which `ends_of` must have been given as well.
Result<std::vector<CurveJoint>> joints(std::span<const CurveEnds> curves, double gap,
                                       const ContinuityOptions& options = {}, std::size_t most = 1'000'000);

// The curve with another parameter: curve(phi(t)), t from `from` on. The points are the same, up to
// rounding; the derivatives of phi at the start are given, so that with those that `joint` finds the curve
// joins its predecessor with C^k: phi[0] is not looked at, phi[1] > 0.
//
// Polynomial phi of the order k = phi.size() - 1, or k + 1 where that one does not rise as far as the end of
// the curve. k = 1: any spline, the degree stays. k >= 2: one Bezier piece, the degree is multiplied. Refuses
// (unsupported) degrees beyond kMaxDegree and splines of several pieces.
//   auto smooth = reparametrised(second, std::span(j->phi).first(3), first.domain()[0].hi);
template <class P>
Result<Curve<P>> reparametrised(const Curve<P>& curve, std::span<const double> phi, double from);
// phi linear over linear, with phi' and phi'' given: C^2 for any spline that is not closed, and the degree
// stays, but the result is rational. Refuses (no_answer) where phi would have its pole before the end of the
// curve.
template <class P>
Result<Curve<Hom<Space<P>::kDim>>> reparametrised_rationally(const Curve<P>& curve, double rate,
                                                             double second, double from);

}  // namespace freiform
