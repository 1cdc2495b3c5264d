// The smallest curve found that comes within a tolerance of points in order.
#pragma once
#include <freiform/fit/least_squares.hpp>

namespace freiform {

struct ApproximateOptions {
    double tolerance = 0;  // a distance; positive
    int degree = 3;
    bool closed = false;  // the curve closes with all its derivatives but the last
    Spacing spacing = Spacing::chordal;
    bool move_parameters = true;  // to where the curve is nearest; in their order, ends and kept points stay
    double smoothing = 0;         // as in LeastSquaresOptions
    int smoothing_order = 2;
};

// What the curve is to have at the parameter of a point, exactly: a value (order 0) or a derivative.
template <int D>
struct KeptPoint {
    int point = 0;
    int order = 0;
    Vec<D> value{};
};

// A curve of the degree with simple knots, no farther than the tolerance from any of the points: the `bound`
// of the report is below it. Points that are equal to their neighbours share a parameter. The search is
// greedy: that no smaller curve exists is not claimed. Refuses with no_answer, and the distance reached,
// where even as many coefficients as points do not suffice (the tolerance is below rounding, points are on
// top of each other, or the conditions are in the way).
//   auto f = approximate<2>(points, {.tolerance = 0.01});
template <int D>
Result<Fitted<D>> approximate(std::span<const Vec<D>> points, const ApproximateOptions& options,
                              std::span<const KeptPoint<D>> kept = {});

}  // namespace freiform
