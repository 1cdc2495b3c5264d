// A display colour: sRGB-encoded components and opacity, each in [0, 1].
#pragma once

namespace freiform {

struct Colour {
    double r = 0, g = 0, b = 0, a = 1;
    friend bool operator==(const Colour&, const Colour&) = default;
};

}  // namespace freiform
