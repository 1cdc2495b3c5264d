// Curves and surfaces of Open CASCADE as ours: the same map, with the same parameters. Nothing is
// approximated; what has no exact counterpart is a refusal that names the type.
#pragma once
#include <freiform/spline/geometry.hpp>

#include <Geom2d_Curve.hxx>
#include <Geom_Curve.hxx>
#include <Geom_Surface.hxx>
#include <gp_Pln.hxx>

namespace freiform::occt {

// `range`: the parameters that are needed of a periodic spline, which is unwound to an open one.
Result<CurveGeometry<3>> curve(const Handle(Geom_Curve) & c, Interval range);
Result<CurveGeometry<2>> curve(const Handle(Geom2d_Curve) & c, Interval range);
Result<SurfaceGeometry> surface(const Handle(Geom_Surface) & s, const std::array<Interval, 2>& range);

// The curve seen along the normal of the plane, in the parameters of the plane: exact, as an orthogonal
// projection to a plane maps lines, conics and splines to such.
CurveGeometry<2> in_plane(const CurveGeometry<3>& c, const gp_Pln& plane);

// The curve over [from.lo, from.hi] moved to the parameters [to.lo, to.hi]. Refuses conics whose parameter
// would have to run at another speed.
Result<CurveGeometry<2>> reparametrised(const CurveGeometry<2>& c, Interval from, Interval to);

// The curve with a domain that holds `range`, where it lacks less than a millionth of its length: the
// outermost knots are moved. Returns by how much at most a parameter moved (0: nothing was done).
template <int D>
double stretch_to(CurveGeometry<D>& c, Interval range);

}  // namespace freiform::occt
