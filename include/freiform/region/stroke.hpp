// Strokes as regions, and regions made larger or smaller.
#pragma once
#include <freiform/region/boolean.hpp>

namespace freiform {

// What the pen of SVG covers: the line of the width across the path, moved along it, with joins at the
// corners and caps at the ends; the whole as loops with winding number 1 inside. Curves become arcs of
// circles, so that both sides of the outline are arcs of circles and lines. Where a segment turns round in a
// cusp of its own the pen turns round, too (a round join). Dashes begin at the start of each subpath; in a
// closed one a dash goes on over the start. Subpaths and dashes without length are dots with caps: a disc, a
// square along the axes, or nothing.
//
// `bound` <= tolerance: every point of the region is within it of a point that the pen covers, and the other
// way round. (Dashes begin and end where they should up to an eighth of the tolerance along the path; the pen
// is that between those places.)
//
// Joins `arcs` go on with the curvature of the outer edges until these meet, as SVG 2 says, miter-clip
// where they do not. What rounding does to the tip is in the bound: much, where the edges almost touch.
//
// Refuses (invalid) a width, a miter limit, dashes or a tolerance that make no sense, and what region_of
// refuses; (limit) more than 100,000 arcs, or more than 100,000 dashes; (ill_conditioned) a tolerance that
// rounding exceeds, and joins `arcs` where it leaves open what they look like by more than a quarter of it:
// say, an edge that bends as much as the pen, within rounding, which is one with a tip or a round one.
//   auto outline = stroked(path, {.width = 2, .cap = LineCap::round}, {.tolerance = 1e-3});
Result<Region> stroked(const Path& path, const StrokeStyle& style, const RegionOptions& options);

// The points that are nearer to the region than `distance`, or if that is negative, those of the region
// that are farther than |distance| from its boundary. Where the boundary has a corner, other joins than round
// fill more (outside of it for positive distances, inside of it for negative ones).
struct OffsetStyle {
    double distance = 0;
    LineJoin join = LineJoin::round;
    double miter_limit = 4;
};
Result<Region> grown(const Filled& region, const OffsetStyle& style, const RegionOptions& options);

// The dashes of a path, each an open subpath (a closed one where the pattern has no gaps in it). Lengths
// along the path are within `accuracy` of those asked for.
Result<Path> dashed(const Path& path, const StrokeStyle& style, double accuracy);

}  // namespace freiform
