// One large free-form face, whole ("hills") or with 25 round holes ("hills-with-holes"): models of the
// comparison of tessellation that no file is needed for.
#pragma once
#include "evaluation_inputs.hpp"

#include <array>
#include <optional>
#include <string_view>

namespace freiform::bench {

struct HillsFace {
    struct Hole {
        double u, v, radius;
    };
    SurfaceInput surface = hills();
    std::vector<Hole> holes;
};
inline std::optional<HillsFace> hills_face(std::string_view name) {
    if (!name.starts_with("hills")) return std::nullopt;
    HillsFace face;
    for (int i = 0; i < 25 && name == "hills-with-holes"; ++i)
        face.holes.push_back({0.1 + 0.2 * (i / 5), 0.1 + 0.2 * (i % 5), 0.06});
    return face;
}

}  // namespace freiform::bench
