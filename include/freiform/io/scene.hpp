// All that a document holds of faces, as one model: what tessellation and drawing start from.
#pragma once
#include <freiform/shape.hpp>

namespace freiform {

// Surfaces become faces that share equal boundaries (model/assemble.hpp), trimmed surfaces faces with loops,
// models are taken over. Surfaces with two coordinates lie in the plane z = 0. What has no faces (curves,
// volumes, surfaces of one or four coordinates) is listed in Model::refused. `objects`: indices; all if
// empty. Refuses (no_answer) documents without any face.
Result<Model> scene_of(const Document& document, std::span<const std::size_t> objects = {});

}  // namespace freiform
