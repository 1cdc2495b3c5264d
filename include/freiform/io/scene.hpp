// All that a document holds of faces, as one model: what tessellation and drawing start from.
#pragma once
#include <freiform/shape.hpp>

namespace freiform {

// Surfaces become faces that share equal boundaries (model/assemble.hpp), trimmed surfaces faces with loops,
// models are taken over. Surfaces with two coordinates lie in the plane z = 0. What has no faces (curves,
// volumes, surfaces of one or four coordinates) is listed in Model::refused. `objects`: indices; all if
// empty. Refuses (no_answer) documents without any face.
Result<Model> scene_of(const Document& document, std::span<const std::size_t> objects = {});

struct Scene {
    Model model;
    std::vector<std::size_t> object_of_face;  // an index into Document::objects for each face
};
// The same, and whose the faces are.
Result<Scene> scene_with_owners(const Document& document, std::span<const std::size_t> objects = {});

// Control points of surfaces and triangles and the lines between them, in space; of trimmed surfaces and
// of faces of models those of the whole spline surface.
struct ControlNet {
    std::size_t object = 0;
    std::vector<std::vector<Vec<3>>> lines;
    std::vector<Vec<3>> points;
    std::vector<double> weights;  // one for each point
};
std::vector<ControlNet> control_nets(const Document& document, std::span<const std::size_t> objects = {});

}  // namespace freiform
