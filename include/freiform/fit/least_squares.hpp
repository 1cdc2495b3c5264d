// The curve on given knots that comes closest to points, in the sense of least squares.
#pragma once
#include <freiform/fit/interpolate.hpp>

namespace freiform {

// How well a fit does. Distances in model units.
struct FitReport {
    double bound = 0;  // no point is farther than this from the curve; rounding included
    double polyline_bound =
        0;                  // and no place of the curve is farther than this from the polygon of the points
    double kept_bound = 0;  // no value that was to be kept is missed by more than this
    double rms_error = 0;   // root of the mean square distance of points from their places on the curve
    int iterations = 0;     // least-squares problems that were solved
};

template <int D>
struct Fitted {
    Curve<Vec<D>> curve;
    std::vector<double> at;  // the parameter of each point; the bounds compare with the curve there
    FitReport report;
};

struct LeastSquaresOptions {
    std::span<const double> weights = {};  // of the squared distance of each point; positive; none: all 1
    // This many times the integral of the squared derivative of this order is added to the sum of squares.
    // The factor depends on the scale of the parameters to the power 2 order - 1.
    double smoothing = 0;
    int smoothing_order = 2;
};

// Minimises sum_i w_i |f(at_i) - Q_i|^2 + smoothing int |f^(order)|^2 over the splines of the basis that have
// the values and derivatives `kept` exactly (up to rounding; values at clamped ends to the bit). `at` does
// not decrease and lies in the domain; of a closed basis, in one period. Refuses, naming knots[i], functions
// without enough points to determine them (if there is no smoothing), and more conditions than the basis
// allows or that contradict each other.
//   auto f = least_squares<2>(basis, points, at, {}, {.smoothing = 1e-3});
template <int D>
Result<Fitted<D>> least_squares(const BSplineBasis& basis, std::span<const Vec<D>> points,
                                std::span<const double> at, std::span<const Datum<D>> kept = {},
                                const LeastSquaresOptions& options = {});

// The surface on given knots that comes closest to a grid of points at a grid of parameters.
template <int D>
struct FittedSurface {
    Surface<Vec<D>> surface;
    double bound = 0;  // no point is farther than this from the surface; rounding included
    double rms_error = 0;
};
template <int D>
Result<FittedSurface<D>> least_squares(const std::array<BSplineBasis, 2>& bases, const Net<2, Vec<D>>& points,
                                       const std::array<std::span<const double>, 2>& at);

}  // namespace freiform
