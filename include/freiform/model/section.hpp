// Plane sections of solid models and trimmed faces: lines that go over the edges of faces, and close where
// the model is closed.
#pragma once
#include <freiform/intersect/section.hpp>
#include <freiform/model/tessellate.hpp>

namespace freiform {

struct ModelSectionLine {
    std::vector<Vec<3>> points;  // the last is the first where the line is closed
    std::vector<int> faces;      // of the model, one for each segment
    bool closed = false;
    // Of the polygon, if it is closed: positive where the material is inside, negative around holes, for a
    // model whose normals point outwards.
    double area = 0;
};

struct ModelSection {
    std::vector<ModelSectionLine> lines;
    double bound = 0;        // no point of a line is farther from the surface of its segment's face
    double plane_bound = 0;  // nor from the plane
    double area = 0;         // the sum of the areas
    // Faces of which nothing is known, with the reason: lines end at them.
    std::vector<RefusedFace> refused;
};

// The section of a watertight mesh within `options.tolerance` of the model (model/tessellate.hpp), so closed
// models have closed lines only. Faces that lie in the plane count as on the side of its normal. What the
// mesh does not reach is not there: places where the model comes over the plane by less than `bound`; and
// where faces are nearly parallel to the plane the true line may be farther off along them than `bound`.
//
// Refuses what tessellate() refuses, planes without normal, and those with numbers that are not finite.
//   const auto cut = section(model, {{0, 0, 1}, -2.0}, {.tolerance = 0.01});   // z = 2
Result<ModelSection> section(const Model& model, const Plane& plane, const TessellateOptions& options);

}  // namespace freiform
