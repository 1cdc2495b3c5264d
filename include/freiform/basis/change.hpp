// Changes of a B-spline basis: a new basis together with the map that carries coefficients to it. Each is
// written once, for one parameter; curves, surfaces and volumes, polynomial and rational, apply it along an
// axis.
#pragma once
#include <freiform/basis/band_map.hpp>

#include <span>

namespace freiform {

template <Basis B>
struct Change {
    B basis;
    BandMap map;
};

// Rounding. A new coefficient is a convex combination of old ones; what is computed differs from it, in each
// coordinate, by at most this times the largest absolute coordinate of the old ones (away from underflow):
// insertion, restriction and decomposition into Bezier pieces of degree p; elevation from degree p. Argument
// in change.cpp.
inline constexpr double refinement_error(int p) { return 1.01 * (6 * p + 1) * 0x1p-53; }
inline constexpr double elevation_error(int p) { return 1.01 * (7 * p + 4) * 0x1p-53; }

// Insert the knots `more` (sorted, inside the domain; together with the old ones of multiplicity <= p + 1).
// The function does not change. Oslo algorithm: every new coefficient is a blossom of the old spline.
Result<Change<BSplineBasis>> insert_knots(const BSplineBasis& old, std::span<const double> more);

// The same function with degree p + 1. Refused beyond kMaxDegree.
Result<Change<BSplineBasis>> elevate(const BSplineBasis& old);

// The part of the function on [on.lo, on.hi], inside the domain, clamped at both ends. A closed basis is
// opened; restricted to its whole domain it is cut at the seam.
Result<Change<BSplineBasis>> restrict_to(const BSplineBasis& old, Interval on);

// The function run through backwards: new(lo + hi - u) = old(u), up to the rounding of the inner knots.
// Distinct knots stay distinct.
Change<BSplineBasis> reverse(const BSplineBasis& old);

// The derivative; of degree p - 1. REQUIRES degree >= 1. Open also for a closed basis with a knot of
// multiplicity p, where the derivative jumps. Only for polynomial coefficients: the derivative of a rational
// function is not the quotient of derivatives.
Change<BSplineBasis> differentiate(const BSplineBasis& old);

// Every piece between breaks in Bezier form: all knots get multiplicity p + 1, so that piece i has the
// coefficients i (p + 1) .. i (p + 1) + p, all of its own.
Change<BSplineBasis> to_bezier(const BSplineBasis& old);

}  // namespace freiform
