// Parameter curves of edges on surfaces.
#pragma once
#include "step_chart.hpp"

#include <freiform/core/result.hpp>

namespace freiform::step {

struct Trace {
    CurveGeometry<2> curve;
    double gap = 0;       // the largest distance from the edge that was seen
    bool fitted = false;  // a spline that follows the edge, and not a curve of closed form
};

// The curve over `on` whose image on the surface follows `c` with the same parameter, as near as the surface
// comes to it, plus `accuracy`. It is continuous where parameters are periodic. Refuses where it runs through
// a pole or fold and a polygon of nearest points is further off than `rough`.
Result<Trace> trace(const Chart& chart, const CurveGeometry<3>& c, Interval on, double accuracy,
                    double rough);

// Where the surface shrinks to a point or folds, slopes mean nothing: a polygon of nearest points, if it is
// nowhere further from the edge than `rough`.
std::optional<Trace> polygon_of_feet(const Chart& chart, const CurveGeometry<3>& c, Interval on,
                                     double rough);

CurveGeometry<2> shifted(const CurveGeometry<2>& curve, const Vec<2>& by);

}  // namespace freiform::step
