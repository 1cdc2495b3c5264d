// The direction that pictures are drawn from.
#pragma once
#include <freiform/core/result.hpp>

#include <string_view>

namespace freiform {

// Where the eye is, seen from the model: azimuth from the x axis towards the y axis, elevation above the x-y
// plane; radians. The z axis points up in the picture (the y axis where the view is along z and azimuth
// -pi/2).
struct View {
    double azimuth = -0.7853981633974483, elevation = 0.6154797086703874;
};

// iso (the default above), front (the eye at -y), back, left (at -x), right, top, bottom, or
// "AZIMUTH,ELEVATION" in degrees.
Result<View> parse_view(std::string_view text);

}  // namespace freiform
