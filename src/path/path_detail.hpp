// What the files about paths share.
#pragma once
#include <freiform/path/path.hpp>

namespace freiform::detail {

// The segment as cubics within the tolerance; nothing where that takes too many.
std::vector<PathSegment> cubics_of(const PathSegment& segment, double tolerance);

}  // namespace freiform::detail
