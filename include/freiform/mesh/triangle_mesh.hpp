// Triangle meshes. Points are shared by all faces that meet in them, so that a closed model gives a closed
// mesh; vertices add what differs from face to face: normal and parameters.
#pragma once
#include <freiform/core/colour.hpp>
#include <freiform/core/result.hpp>
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
    // The first 2 * quads triangles are pairs (a, b, c), (a, c, d): what formats with quads write as a b c d.
    int quads = 0;
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

// Refuses numbers that are not finite, indices that lead outside, colours outside [0, 1], quads that are no
// pairs, and parts that do not cover the triangles one after the other. A mesh without any part is allowed.
Result<void> validate(const TriangleMesh& mesh);

// Unit normal of the plane of one triangle, counter-clockwise; zero if the triangle has no area in double
// precision. REQUIRES a mesh that `validate` accepts.
Vec<3> triangle_normal(const TriangleMesh& mesh, std::size_t triangle);

// An edge joins two points, whichever vertices or parts the triangles use there.
struct MeshEdge {
    int a = 0, b = 0;                      // points, a < b
    int forward = 0, backward = 0;         // triangles that run from a to b, from b to a
    std::array<int, 2> triangles{-1, -1};  // the first two of them
};

// All edges, sorted by (a, b); those of triangles with two equal point indices are left out.
// Linear time but for points with very many edges. REQUIRES a mesh that `validate` accepts.
std::vector<MeshEdge> edges(const TriangleMesh& mesh);

// What the connectivity (equal point indices, not equal coordinates) says.
struct MeshTopology {
    int open_edges = 0;            // used by one triangle
    int non_manifold_edges = 0;    // used by more than two
    int misoriented_edges = 0;     // used by two triangles in the same direction
    int degenerate_triangles = 0;  // two equal points, or an area that is exactly zero
};
// The smallest angle of each triangle, in radians; 0 without area. Estimates: in double precision. REQUIRES a
// mesh that `validate` accepts.
std::vector<double> smallest_angles(const TriangleMesh& mesh);

// REQUIRES a mesh that `validate` accepts.
MeshTopology topology(const TriangleMesh& mesh);

}  // namespace freiform
