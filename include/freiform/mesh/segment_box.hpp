// Polygons in the parameter plane against boxes and points.
#pragma once
#include <freiform/core/interval.hpp>

#include <array>
#include <span>

namespace freiform {

// Does the segment meet the box? Conservative: says yes for near misses too.
bool meets(const Box<2>& box, const Vec<2>& p, const Vec<2>& q);

// Odd-even rule. REQUIRES a point that is away from all segments (no box that holds it meets one).
bool is_inside(const Vec<2>& x, std::span<const Vec<2>> polygon,
               std::span<const std::array<int, 2>> segments);

}  // namespace freiform
