// Intersections of two surfaces for which it is known where they are the same.
#pragma once
#include "same_map_detail.hpp"

namespace freiform::detail {

// `shape`: the same surface, for its derivatives. REQUIRES a positive tolerance. Overlaps of nodes are left
// out: which maps belong to a node is in `maps_of_nodes`.
struct SplineIntersection {
    SurfaceIntersection found;
    std::vector<std::vector<int>> maps_of_nodes;
};
SplineIntersection intersect_splines(const Surface<Hom<3>>& a, const Surface<Hom<3>>& b,
                                     const SurfaceGeometry& shape_a, const SurfaceGeometry& shape_b,
                                     const SurfaceIntersectOptions& options, const Sameness& same);
// R and M(R) of the maps of each node; without maps, that of two planes.
void add_overlaps(SplineIntersection& to, std::span<const SameMap> maps,
                  const std::array<const PartSpline*, 2>& parts, double tolerance);

}  // namespace freiform::detail
