// Steps between sRGB, light and Oklab.
#pragma once
#include <freiform/colour/colour_map.hpp>

#include <array>
#include <cmath>

namespace freiform::detail {

inline double linear_light(double c) { return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4); }
inline double encoded_light(double c) {
    return c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1 / 2.4) - 0.055;
}

// Components of linear light; outside [0, 1] where sRGB does not have the colour [Ottosson 2020].
inline std::array<double, 3> light_of(const Oklab& c) {
    const auto cube = [](double x) { return x * x * x; };
    const double l = cube(c.L + 0.3963377774 * c.a + 0.2158037573 * c.b);
    const double m = cube(c.L - 0.1055613458 * c.a - 0.0638541728 * c.b);
    const double s = cube(c.L - 0.0894841775 * c.a - 1.2914855480 * c.b);
    return {4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
            -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
            -0.0041960863 * l - 0.7034186147 * m + 1.7076147010 * s};
}

}  // namespace freiform::detail
