// Paths with fewer segments.
#pragma once
#include <freiform/path/path.hpp>

namespace freiform {

struct SimplifyOptions {
    double tolerance = 0;  // a distance, > 0
    double corner = 0.1;   // radians: where the direction turns by more, a point stays, and is sharp
};

struct SimplifiedPath {
    Path path;
    // Every point of the result is within this distance of the path, and the other way round, in the order in
    // which both are run through (Frechet). <= tolerance.
    double bound = 0;
    std::size_t before = 0, after = 0;  // segments
};

// Runs of segments without a corner become one cubic each, as long ones as the tolerance allows, with the
// directions of the path at their ends (where it turns a little, the mean of both), so what had no corner has
// none. What no cubic replaces stays as it is, bit for bit. Ends of subpaths and corners stay where they are.
// Lines that go on in the same direction become one. Refuses (invalid) tolerances that are not positive,
// (nonfinite) numbers that are not finite. Method: least squares with end tangents [Schneider 1990], then a
// proof.
Result<SimplifiedPath> simplified(const Path& path, const SimplifyOptions& options);

}  // namespace freiform
