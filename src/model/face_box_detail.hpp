// Boxes of faces of a model.
#pragma once
#include <freiform/model/model.hpp>

#include <optional>

namespace freiform {

// Contains the face. `known`: what is in the box of the model anyway, such as the edges; where the face is
// inside it, its own box is of no interest and may be as large. Nothing if no box can be given.
std::optional<Box<3>> box_of_face(const Face& face, const std::vector<Edge>& edges, const Box<3>& known);

}  // namespace freiform
