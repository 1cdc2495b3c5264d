// The edges of a mesh, one after the other, where no list of them is needed.
#pragma once
#include <freiform/mesh/triangle_mesh.hpp>

#include <functional>

namespace freiform {

// In the order of their points.
void each_edge(const TriangleMesh& mesh, const std::function<void(const MeshEdge&)>& visit);

}  // namespace freiform
