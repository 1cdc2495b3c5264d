// What the files about paths share.
#pragma once
#include <freiform/path/path.hpp>

namespace freiform::detail {

// The segment as cubics within the tolerance, or the least one above it that rounding allows.
std::vector<PathSegment> cubics_of(const PathSegment& segment, double tolerance);

// A bound of the distance at equal parameters on [0, 1], of a rational Bezier curve from a cubic; rounding
// included.
double distance_bound(const std::vector<Hom<2>>& p, const std::array<Vec<2>, 4>& q);

}  // namespace freiform::detail
