// Lines on the faces of a model, for pictures: isolines, outlines against a direction, normals. They are
// found on a mesh of the model (model/tessellate.hpp), which trims them, and lie as near to the faces as it
// does.
#pragma once
#include <freiform/mesh/triangle_mesh.hpp>
#include <freiform/model/model.hpp>

namespace freiform {

struct SurfaceLine {
    int face = -1;
    std::vector<Vec<3>> points;  // the last is the first where the line is closed
};

// The parameters in `on` that isolines of this axis are drawn for: `count` of them at equal steps, ends
// excluded; without a count the inner breaks of splines, thinned out or filled up to between 4 and 24, and
// none for what is not a spline or bilinear.
std::vector<double> isoline_levels(const SurfaceGeometry& surface, int axis, const Interval& on,
                                   std::optional<int> count);

// Of every face of the mesh in both directions, over the box of its parameters; on the triangles, so within
// the bound of the tessellation of the true isolines.
std::vector<SurfaceLine> isolines(const Model& model, const TriangleMesh& mesh, std::optional<int> count);

// Where the faces turn away from the direction `eye` (of length 1): zeros of n . eye on the sides of the
// triangles, found on the surface itself by bisection; points of the surface, and between them chords of
// triangles' size. What an outline does inside one triangle is not seen.
std::vector<SurfaceLine> silhouettes(const Model& model, const TriangleMesh& mesh, const Vec<3>& eye);

// Places at `count` times `count` equal steps of the parameters, on the triangles, where the face is not
// trimmed away, with the interpolated normals of the mesh.
struct SurfaceNormal {
    int face = -1;
    Vec<3> foot{}, normal{};
};
std::vector<SurfaceNormal> surface_normals(const TriangleMesh& mesh, int count);

}  // namespace freiform
