// nearest, of solid models and trimmed surfaces.
#pragma once
#include "input.hpp"

namespace freiform::cli {

struct ModelsAsked {
    double accuracy = 0;
    bool with_sign = false;
    // One of them, instead of the nearest point: the farthest; the faces within a radius; so many faces.
    bool farthest = false;
    std::optional<double> radius;
    std::optional<int> count;
};

// And what stands beside them; refuses objects beside them that are not in space, with the place.
Result<void> nearest_of_models(const Context& context, const Input& input,
                               const std::vector<std::vector<double>>& rows, const ModelsAsked& asked);

}  // namespace freiform::cli
