// A curve in the parameter domain of a surface as a curve in space.
#pragma once
#include <freiform/spline/geometry.hpp>

namespace freiform {

// The parameter curve over a part of its domain as a spline with the same points: lines and splines at the
// same parameters, conics as rational quadratics on [0, 1]. Refuses what restrict_to and conic_arc refuse.
Result<CurveGeometry<2>> parameter_spline(const CurveGeometry<2>& curve, Interval on);
// The same of a curve in space.
Result<CurveGeometry<3>> space_spline(const CurveGeometry<3>& curve, Interval on);

// t -> S(c(t)), at the parameters of c: piecewise of degree d (p + q) with d the degree of c, p and q those
// of the surface (d p or d q where it runs along a parameter line), connected, with knots where c has them
// and where it crosses a knot of the surface. Off by the rounding of its control points, for which no bound
// is claimed. What leaves the domain of the surface continues its outermost pieces. REQUIRES splines that are
// not closed. Refuses (unsupported) degrees above kMaxImageDegree and curves that jump.
//   auto edge = image_curve(surface, *parameter_spline(coedge.curve, edge.range));
inline constexpr int kMaxImageDegree = 25;
Result<CurveGeometry<3>> image_curve(const SurfaceGeometry& surface, const CurveGeometry<2>& curve);

}  // namespace freiform
