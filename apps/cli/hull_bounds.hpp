// bounds --oriented and --hull.
#pragma once
#include "input.hpp"

namespace freiform::cli {

struct HullsAsked {
    bool oriented = false;
    std::optional<double> hull;      // tolerance
    std::optional<double> accuracy;  // of the oriented boxes; 1e-7 of the size
};

// For each object; hulls in space also as a mesh, where -o names one.
Result<void> answer_hulls(Context& context, const Input& input, const HullsAsked& asked);

}  // namespace freiform::cli
