// What the files about paths share.
#pragma once
#include <freiform/path/path.hpp>

namespace freiform::detail {

// The segment as cubics within the tolerance, or the least one above it that rounding allows.
std::vector<PathSegment> cubics_of(const PathSegment& segment, double tolerance);

}  // namespace freiform::detail
