// Regions of the plane that closed curves of a file bound, and the solids that they sweep.
#pragma once
#include "solids.hpp"

#include <freiform/model/swept_solid.hpp>

namespace freiform::cli {

// Each chosen object is a loop: a plane curve whose end is its start, cut at its corners. Refuses others.
struct PlaneRegion {
    RegionLoops loops;
    std::string unit;
};
Result<PlaneRegion> read_region(const Context& context, const std::string& file, const std::string& object);

// The model that was made of the region, as the output wants it. `file` is for refusals; `said`: more numbers
// for the report.
Result<void> emit_swept(const Context& context, const SolidOutput& output, const std::string& file,
                        const std::string& unit, Result<Model> model,
                        std::span<const std::pair<std::string, double>> said = {});

}  // namespace freiform::cli
