// Curves that are said by a surface and a curve in its parameters, as curves in space.
#pragma once
#include <freiform/core/result.hpp>
#include <freiform/spline/geometry.hpp>

namespace freiform::step {

struct Lift {
    Curve<Vec<3>> curve;
    double bound = 0;  // of the distance between points of the same parameter, proven, rounding included
};

// The spline over `on` that has points and slopes of surface(c(t)) at its knots. As near as `target`, or as
// two hundred pieces bring it; `bound` says which, for the effort of `samples` places. Refuses
// (ill_conditioned) where none up to `most` is proven: where the surface tears or, being an offset, is
// singular. REQUIRES that `on` is finite and not empty.
Result<Lift> lift(const SurfaceGeometry& surface, const CurveGeometry<2>& c, Interval on, double target,
                  double most, int samples = 4000);

}  // namespace freiform::step
