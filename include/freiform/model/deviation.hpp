// How far a triangle mesh and a model are apart: measured, and bounded, from the two alone. Nothing that the
// mesh may say about its origin is used, so meshes of any program can be judged.
#pragma once
#include <freiform/mesh/triangle_mesh.hpp>
#include <freiform/model/model.hpp>

#include <functional>

namespace freiform {

struct DeviationOptions {
    // A distance in model units >= 0: bounds need not be made smaller than it (nor than 2^-36 of the size). A
    // mesh that is claimed to be within a tolerance is decided soonest when this is the tolerance.
    double enough = 0;
    // Work: parts of faces that are looked at, in all. When it is used up, bounds are what they are then.
    std::size_t max_parts = 1'000'000;
    std::function<bool(double)> progress = {};  // as TessellateOptions::progress
};

struct FaceDeviation {
    int face = -1;
    std::string name;
    // The largest distance found from a point of the face to the mesh: no bound from above, but of a place.
    double measured = 0;
    Vec<3> at{};  // that place, on the face
    // No point of the face is farther than this from the mesh: a bound, rounding included; infinite where
    // none was found.
    double bound = 0;
};

struct MeshDeviation {
    std::vector<FaceDeviation> faces;  // those that could be looked at, in order
    std::vector<Refusal> refused;      // the others
    double measured = 0, bound = 0;    // the largest of all faces, from the model to the mesh
    int worst = -1;                    // index into `faces` of the largest measured
    // From the mesh to the model: the largest distance of a sample on the mesh from the nearest face, and
    // where it is. It may be too large by `accuracy`, and where the mesh goes beyond the boundary of a face
    // too small by `overhang`: faces are taken as triangles, as many as max_parts allows. An estimate:
    // between the samples it can be larger.
    double mesh_measured = 0, accuracy = 0, overhang = 0;
    Vec<3> mesh_at{};
    std::size_t parts = 0;  // that were looked at
};

// Both directions together measure the Hausdorff distance. The answer does not depend on the number of
// threads. Refuses (invalid) meshes without triangles and models without faces, (limit) when progress says
// no. REQUIRES a mesh that `validate` accepts, in the units of the model.
Result<MeshDeviation> deviation(const Model& model, const TriangleMesh& mesh,
                                const DeviationOptions& options);

// The distance of each point from the model: estimates within `accuracy` where max_parts suffice.
Result<std::vector<double>> distances_from_model(const Model& model, std::span<const Vec<3>> points,
                                                 double accuracy, std::size_t max_parts = 1'000'000);

}  // namespace freiform
