// Curves run through at unit speed.
#pragma once
#include <freiform/query/length.hpp>

namespace freiform {

// A quintic spline over [0, length.value] that follows a curve at (nearly) unit speed.
template <int D>
struct ArcLengthCurve {
    Curve<Vec<D>> curve;
    // |curve(s) - c(t(s))| <= bound for all s, t(s) the exact inverse of the arc length; rounding included.
    double bound = 0;
    // |speed - 1| <= speed_bound, the speed that of `curve` in exact arithmetic. 1 or more where the given
    // curve has a cusp, which it passes in steps shorter than the tolerance.
    double speed_bound = 0;
    Measure length;
};

// The parametrisation of a curve by its arc length, within `tolerance` (model units). Tangent and curvature
// vector of the result are those of the given curve at its breaks, so it is C2 up to rounding wherever the
// given one has a continuous curvature vector. Refuses (invalid) tolerances that are not positive and finite,
// (no_answer) curves that jump or have no length, (ill_conditioned) tolerances below what rounding allows,
// (limit) more than max_pieces pieces.
//   auto even = by_arc_length(curve, 1e-6);
template <class P>
Result<ArcLengthCurve<Space<P>::kDim>> by_arc_length(const Curve<P>& curve, double tolerance,
                                                     int max_pieces = 1'000'000);

}  // namespace freiform
