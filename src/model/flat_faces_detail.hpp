// Faces of splines that lie in a plane, as planes: flat_faces.cpp.
#pragma once
#include <freiform/model/tessellate.hpp>

#include <optional>
#include <vector>

namespace freiform {

struct FlatFace {
    const Face* given = nullptr;  // as the model has it
    // The given face is no farther from what stands for it than `apart` and what its parameter curves are off
    // its edges; that is at most `gap` at the places looked at, and what more it may be is in `apart`.
    double apart = 0, gap = 0;
};

struct FlatFaces {
    std::vector<std::optional<FlatFace>> faces;  // one for each of the model
    // The model with planes in place of these, the same in all else; nothing where there are none. Edges and
    // coedges keep their places.
    std::optional<Model> standing;
};

// None unless they are asked for. The model must outlive the answer.
FlatFaces flat_faces(const Model& model, const TessellateOptions& how);

}  // namespace freiform
