// Names for the ends of curves and the edges of surfaces.
#pragma once

namespace freiform {

enum class End { start, end };

// The edge of a surface where parameter `axis` is at the start or the end of its domain.
struct SurfaceEdge {
    int axis = 0;
    End end = End::start;
    friend bool operator==(const SurfaceEdge&, const SurfaceEdge&) = default;
};

}  // namespace freiform
