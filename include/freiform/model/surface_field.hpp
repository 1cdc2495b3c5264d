// Curvatures and errors of a model at the vertices of its mesh, for pictures.
#pragma once
#include <freiform/mesh/triangle_mesh.hpp>
#include <freiform/model/model.hpp>

namespace freiform {

// Curvatures in the sense of query/surface_curvature.hpp, for the normal of the mesh (outward where the model
// has an outside): a sphere of radius r has mean curvature -1/r. error: the distance between a point of the
// mesh and the nearest point of the surface that is found from its parameters, so never less than that from
// the surface; 0 at the vertices that the tessellation put on the surface (mesh/refine.hpp adds others).
enum class SurfaceField { gauss, mean, greatest, least, error };

struct FieldValues {
    std::vector<double> values;  // one per vertex of the mesh; NaN where there is none
    // Vertices where the surface has no curvatures (a pole, an apex): those of a point a thousandth of a
    // triangle beside were taken; or, `missing`, there were none either.
    int beside = 0, missing = 0;
};

// Estimates: derivatives in double precision. REQUIRES a mesh of the model.
FieldValues surface_field(const Model& model, const TriangleMesh& mesh, SurfaceField field);

// The interval that holds the values but for a twentieth, by area, at either end; of the mean over each
// triangle. Empty (lo > hi) if there is no value.
Interval usual_range(const TriangleMesh& mesh, std::span<const double> values);

}  // namespace freiform
