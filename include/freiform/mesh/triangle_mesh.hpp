// Triangle meshes. Points are shared by all faces that meet in them, so that a closed model gives a closed
// mesh; vertices add what differs from face to face: normal and parameters.
#pragma once
#include <freiform/core/colour.hpp>
#include <freiform/core/vec.hpp>

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace freiform {

struct MeshVertex {
    int point = 0;    // index into TriangleMesh::points
    Vec<3> normal{};  // unit length, outward where the model has an outside; zero where there is none
    Vec<2> uv{};      // parameters on the surface of the face
};

// The triangles of one face of the model: [first, first + count) of TriangleMesh::triangles. Parts follow
// each other without gap or overlap; the vertices of different parts are different.
struct MeshPart {
    std::string name;
    std::optional<Colour> colour;
    int first = 0, count = 0;
    int face = -1;  // index of the face in the model it came from
};

struct TriangleMesh {
    std::vector<Vec<3>> points;
    std::vector<MeshVertex> vertices;
    std::vector<std::array<int, 3>> triangles;  // indices into vertices, counter-clockwise seen from outside
    std::vector<MeshPart> parts;
    std::string unit;  // of the coordinates: "mm", "m", "inch", ...; empty if unknown

    std::array<int, 3> points_of(std::size_t triangle) const {
        const auto& t = triangles[triangle];
        return {vertices[std::size_t(t[0])].point, vertices[std::size_t(t[1])].point,
                vertices[std::size_t(t[2])].point};
    }
};

// What the connectivity (equal point indices, not equal coordinates) says.
struct MeshTopology {
    int open_edges = 0;            // used by one triangle
    int non_manifold_edges = 0;    // used by more than two
    int misoriented_edges = 0;     // used by two triangles in the same direction
    int degenerate_triangles = 0;  // two equal points, or an area that is exactly zero
};
MeshTopology topology(const TriangleMesh& mesh);

}  // namespace freiform
