// Joints of the faces of a model along its edges, as the continuity command writes them.
#pragma once
#include <freiform/io/document.hpp>
#include <freiform/io/json.hpp>
#include <freiform/model/edge_continuity.hpp>

namespace freiform::cli {

struct ModelJoints {
    std::size_t object = 0;
    EdgeContinuityOptions options;
    std::vector<EdgeContinuity> joints;  // worst first
};

// Angles given in degrees, as everywhere at the command line. Without a gap 1e-6, without a curvature 1e-2
// over the diagonal of the model; without an angle 0.1 degrees.
Result<ModelJoints> joints_of(const Model& model, std::size_t object, std::optional<double> gap,
                              std::optional<double> angle, std::optional<double> curvature);

void write_joints(json::Writer& w, const ModelJoints& all);
std::string joints_text(const Document& d, const ModelJoints& all);

}  // namespace freiform::cli
