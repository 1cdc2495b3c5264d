// Regions of the plane that paths bound: union, intersection, difference, exclusion.
#pragma once
#include <freiform/core/result.hpp>
#include <freiform/path/path.hpp>
#include <freiform/path/style.hpp>

#include <string_view>

namespace freiform {

enum class RegionOperation {
    union_of,      // in one of them, or both
    intersection,  // in both
    difference,    // in the first and not in the second
    exclusion,     // in exactly one of them
};
std::string_view name_of(RegionOperation operation);  // "union", "intersection", "difference", "exclusion"

// What a path fills. Open subpaths are closed by a line. Weights are positive.
struct Filled {
    const Path& path;
    FillRule rule = FillRule::nonzero;
};

struct RegionOptions {
    // A distance, positive. What is smaller may be drawn together to a point: places where arcs meet, touch,
    // or come so near to each other that rounding does not tell.
    double tolerance = 0;
    // A backstop: pairs of segments that simple tests do not tell apart; 100 times as many pairs of boxes, of
    // segments or of runs of them, are looked at.
    std::size_t max_pairs = 5'000'000;
};

struct Region {
    // Closed loops; the winding number is 1 inside and 0 outside, so both fill rules mean the same: outer
    // loops are counter-clockwise (y up), holes clockwise. Segments are segments of the input, whole (then
    // their control points are the given numbers), reversed, or cut.
    Path path;
    // Every segment is within this distance of the part of the input that it stands for, and whether a point
    // is inside is right for every point that is farther than this from all segments of the input. Rounding
    // included; <= tolerance.
    double bound = 0;
};

// Refuses, with the place: (nonfinite), (unsupported) weights that are not positive, (invalid) a tolerance
// that is not positive, (ill_conditioned) paths that run along each other too near to be told apart but
// farther apart than the tolerance, or a tolerance below the rounding of the coordinates; (limit) more pairs
// than max_pairs. Scaling everything by a power of two scales the answer, bit for bit.
//   auto moon = combine({disc}, {other}, RegionOperation::difference, {.tolerance = 1e-9});
Result<Region> combine(const Filled& a, const Filled& b, RegionOperation operation,
                       const RegionOptions& options);

// The region of one path, as loops that do not cross themselves or each other.
Result<Region> region_of(const Filled& a, const RegionOptions& options);

// The integral of the winding number, which for the path of a Region is the area. Subpaths that are open are
// closed by a line. |value - exact| <= bound. REQUIRES finite numbers, positive weights.
struct PathArea {
    double value = 0, bound = 0;
};
PathArea signed_area(const Path& path);

}  // namespace freiform
