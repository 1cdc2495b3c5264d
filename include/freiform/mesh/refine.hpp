// More vertices on the same triangles, for what varies over them.
#pragma once
#include <freiform/mesh/triangle_mesh.hpp>

namespace freiform {

// Halves sides longer than `longest` until none is left or another round could give more than
// `max_triangles`. New points lie on the old triangles, so the mesh stays the same set of points up to
// rounding, and closed where it was; parameters and normals are interpolated (normals to length 1). `rounds`
// are done at least, however short the sides are, within `max_triangles`. REQUIRES a mesh that `validate`
// accepts, longest > 0.
TriangleMesh refined(const TriangleMesh& mesh, double longest, std::size_t max_triangles, int rounds = 0);

}  // namespace freiform
