// How a path is filled and stroked, in the words of SVG.
#pragma once
#include <vector>

namespace freiform {

enum class FillRule { nonzero, evenodd };
enum class LineCap { butt, round, square };
enum class LineJoin { miter, miter_clip, round, bevel, arcs };

// Lengths in the units of the picture: what a transform does to them is counted in.
struct StrokeStyle {
    double width = 1, miter_limit = 4;
    LineCap cap = LineCap::butt;
    LineJoin join = LineJoin::miter;
    std::vector<double> dashes;  // none: a solid line; otherwise an even number of them
    double dash_offset = 0;
};

}  // namespace freiform
