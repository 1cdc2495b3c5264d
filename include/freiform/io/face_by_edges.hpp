// Faces of which nothing but the edges is known, as in files without parameter curves.
#pragma once
#include <freiform/model/model.hpp>

#include <span>
#include <vector>

namespace freiform {

struct EdgeUse {
    int edge = -1;  // of the model
    bool reversed = false;
};

// The face on the surface with these loops, each edge of which begins at the vertex where the one before it
// ends; the face lies on their left. Its parameter curves follow the edges; at poles, and where loops wind
// around the surface, it gets degenerate edges and seams, which go into the model. `tolerance`: points nearer
// than this are one, and so far off edges may be; or a part of the size of the face. Refuses (invalid,
// unsupported, ill_conditioned) edges without a curve or further beside the surface, and boundaries that do
// not close or touch themselves; then the model is as it was.
Result<Face> face_by_edges(Model& model, const SurfaceGeometry& surface,
                           std::span<const std::vector<EdgeUse>> loops, double tolerance);

}  // namespace freiform
