// Places of a curve where something special happens: inflections, cusps, extrema, vertices. All of them.
#pragma once
#include <freiform/spline/patch.hpp>

#include <string_view>
#include <vector>

namespace freiform {

enum class FeatureKind {
    inflection,  // the curvature changes its sign (plane)
    flat,        // the curvature is zero, but its sign does not change (plane); or is zero (space)
    straight,    // over the interval `at`
    cusp,        // the derivative is zero, also at an end
    maximum,
    minimum,     // of a coordinate along a direction, or of the curvature
    stationary,  // its derivative is zero, but it goes on rising or falling
    constant,    // over the interval `at`
    possible,    // within rounding it may be there or not
};
std::string_view name_of(FeatureKind kind);

template <int D>
struct Feature {
    FeatureKind kind = FeatureKind::possible;
    Interval at;           // of the parameter; lo == hi: it is this number
    Vec<D> point{};        // of the curve, in the middle of `at`
    double bound = 0;      // from `point` to the points of the curve over `at`, at most
    bool at_knot = false;  // curvature or slope jumps there from one sign to the other, without a zero
};

// Inflections, maxima and minima are named by the signs on both sides of `at`; if rounding leaves more room,
// an odd number of them may be there. In each of these functions parameters are known so well that `bound` <=
// accuracy + rounding, except where kind is possible. Bezier curves, and splines made of them, are decided
// exactly (`possible` does not occur); on other splines, whose pieces have to be computed, what touches zero
// stays `possible`. Refuses a negative accuracy, and (unsupported) questions that lead to polynomials above
// kMaxRootDegree: vertices of curves of degree above 25, of rational ones above 13.

// Plane (D = 2): where the curvature changes its sign or is zero. Space (D = 3): where it is zero. Cusps are
// not inflections.
template <class P>
requires(Space<P>::kDim == 2 ||
         Space<P>::kDim == 3) Result<std::vector<Feature<Space<P>::kDim>>> inflections(const Curve<P>& curve,
                                                                                       double accuracy);

template <class P>
requires(Space<P>::kDim >= 2) Result<std::vector<Feature<Space<P>::kDim>>> cusps(const Curve<P>& curve,
                                                                                 double accuracy);

// The extrema of direction . C(t) inside the domain: those at the ends of an open curve are not listed.
template <class P>
Result<std::vector<Feature<Space<P>::kDim>>> extrema(const Curve<P>& curve, const PointOf<P>& direction,
                                                     double accuracy);

// Extrema of the signed curvature of a plane curve.
template <class P>
requires(Space<P>::kDim == 2) Result<std::vector<Feature<2>>> vertices(const Curve<P>& curve,
                                                                       double accuracy);

}  // namespace freiform
