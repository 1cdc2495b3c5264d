// Which side of a closed surface is outside: essay in outward.cpp.
#pragma once
#include <freiform/mesh/triangle_mesh.hpp>
#include <freiform/model/model.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace freiform {

// A point of a face, and the normal there, of the orientation of the face; without one, where it lies on the
// surface.
struct FacePoint {
    int face = -1;
    Vec<3> at{};
    const Vec<3>* normal = nullptr;
    Vec<2> uv{};
};

// For each face 1 if its normal points out of what its faces enclose, -1 if into it; 0 where they enclose
// nothing, or where that is not certain.
std::vector<int> outward_sides(const Model& model, std::span<const FacePoint> points);
// For each triangle, of the normals of its vertices. `points`: those of the mesh, of about size 1.
std::vector<int> outward_sides(const TriangleMesh& mesh, std::span<const Vec<3>> points,
                               std::span<const MeshEdge> edges);

// As the fourth byte of a colour, which shaders read.
inline std::uint8_t outward_byte(int side) { return std::uint8_t(128 + 127 * side); }

}  // namespace freiform
