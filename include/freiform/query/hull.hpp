// Convex hulls of control points. A Bezier curve lies in the hull of its control points, a B-spline curve of
// degree p over one span in the hull of the p + 1 that matter there.
#pragma once
#include <freiform/spline/patch.hpp>

#include <span>
#include <vector>

namespace freiform {

// The corners of the convex hull, counter-clockwise, as indices into `points`, from the leftmost (of those
// the lowest) on. No three are on one line: decided exactly. One or two indices where all points are equal or
// on one line; none without points. Refuses points that are not finite. Cost: n log n.
Result<std::vector<int>> convex_hull(std::span<const Vec<2>> points);

// A part of the domain of a curve and the coefficients first .. first + degree (modulo the number of
// coefficients, of a closed curve) whose hull contains the curve there, exactly.
struct LocalHull {
    Interval on;
    int first = 0;
};
std::vector<LocalHull> local_hulls(const BSplineBasis& basis);

}  // namespace freiform
