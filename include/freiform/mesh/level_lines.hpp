// Lines on a mesh where a function of its vertices has a value: isolines of parameters, outlines, fields.
#pragma once
#include <freiform/mesh/triangle_mesh.hpp>

#include <span>

namespace freiform {

// The place (1 - t) a + t b on the side of a triangle between two vertices.
struct EdgePlace {
    int a = 0, b = 0;  // vertices, a < b
    double t = 0;      // in [0, 1]
};

struct LevelLine {
    int part = -1;  // of the mesh; 0 where it has none
    std::vector<EdgePlace> places;
    bool closed = false;  // the last place is the first
};

// Where the function that is linear on every triangle and has `values` (one per vertex, finite) at the
// vertices is `level`: polylines along which the larger values lie on the left, seen from outside. A vertex
// that has the value itself counts as above, so lines never branch, and a part that is nowhere below has
// none. Vertices tell parts apart: a line ends at the border of its part. Linear time but for chaining by a
// hash of sides. REQUIRES a mesh that `validate` accepts.
std::vector<LevelLine> level_lines(const TriangleMesh& mesh, std::span<const double> values, double level);
// The same for parts [first, last) alone.
std::vector<LevelLine> level_lines(const TriangleMesh& mesh, int part, std::span<const double> values,
                                   double level);

// Sides that a drawing shows: open ones, those between parts, and those where the surface has a crease.
struct OutlineEdge {
    int a = 0, b = 0;     // points
    bool smooth = false;  // between two parts without a crease
    std::array<int, 2> parts{-1, -1};
};
// A crease is where the normals of the two triangles' vertices differ by more than `angle` (radians) at an
// end. Within a part the vertices must differ, and have the same parameters there, or it be so at both ends:
// beside a pole, such as the apex of a cone, every triangle has a vertex with a normal of its own.
std::vector<OutlineEdge> outline_edges(const TriangleMesh& mesh, double angle);

// Outline edges of one kind and one pair of parts as polylines of points, broken where they branch.
struct Outline {
    bool smooth = false;
    std::array<int, 2> parts{-1, -1};
    std::vector<int> points;  // the last is the first where it is closed
};
std::vector<Outline> outlines(const TriangleMesh& mesh, double angle);

}  // namespace freiform
