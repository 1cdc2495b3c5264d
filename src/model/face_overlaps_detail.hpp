// Overlaps of faces, clipped by their loops.
#pragma once
#include "face_loops_detail.hpp"

#include <freiform/model/intersect.hpp>

namespace freiform {

// Nothing where no more than a border is in both. REQUIRES an overlap whose map is affine.
Result<std::optional<FaceOverlap>> face_overlap(const std::array<const FaceLoops*, 2>& loops,
                                                const SurfaceOverlap& overlap, double tolerance);

}  // namespace freiform
