// Polygons that are simple beyond doubt.
#pragma once
#include <freiform/core/interval.hpp>
#include <freiform/mesh/triangulate.hpp>

namespace freiform {

// True only if exactly two segments end at each point and segments have nothing in common but these ends, so
// that Triangulation::attempt has nothing to object to, provided that no two points are equal. False is no
// answer. REQUIRES indices in range.
bool are_simple_polygons(std::span<const Vec<2>> points, std::span<const Triangulation::Segment> segments);

}  // namespace freiform
