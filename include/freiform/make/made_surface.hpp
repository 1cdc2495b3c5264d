// What the constructions of surfaces return.
#pragma once
#include <freiform/spline/in_space.hpp>

namespace freiform {

template <class P>
struct MadeSurface {
    Surface<P> surface;
    double bound = 0;  // distance of every point from that of the exact surface at the same parameters
};

}  // namespace freiform
