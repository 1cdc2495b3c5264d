// Grids for faces that are rectangles of parameters, whose edges get points where the lines end: essay in
// matched_grids.cpp.
#pragma once
#include "edge_mesh_detail.hpp"

#include <freiform/mesh/face_mesh.hpp>

namespace freiform {

// Lines for each face that has them; edges of these faces are given other points, which keep their demands.
// REQUIRES discretised edges; faces with a refusal are left out. Nothing beyond `max_cells`.
std::optional<std::vector<std::optional<GridLines>>> matched_grids(
    const Model& model, std::span<const std::unique_ptr<DerivativeQuery<2, 3>>> surfaces, EdgeMesher& edges,
    const EdgeDemands& on_edges, const FaceDemands& on_faces, std::span<const std::optional<Refusal>> refused,
    double max_cells);

}  // namespace freiform
