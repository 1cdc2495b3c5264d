// Surfaces whose parameter lines across are scaled copies of each other: cones, cylinders and spheres.
#pragma once
#include <freiform/core/constants.hpp>
#include <freiform/spline/geometry.hpp>

#include <optional>

namespace freiform {

// S(u, v) = P + (v - at) c(u) but for `slip`, a distance: for one point P, the apex, and some curve c, for
// all v of the domain; where `at` is infinite, S(u, v) = c(u) + v d. With u and v exchanged where `ruled` is
// 0.
// Spheres: S is within `slip` of the sphere of this radius that a half circle sweeps, turned by the angle u;
// `outwards` is the direction from the axis to that half of the circle where radii are counted positive.
struct Apex {
    int ruled = 1;  // the axis whose parameter lines are straight, or the circles through the poles
    double at = 0;  // its parameter in the apex
    double slip = 0;
    double radius = 0;  // of a sphere; 0: a cone or cylinder
    Vec<3> outwards{};
    Interval part{-kInfinity, kInfinity};  // of the parameter `ruled`, where `slip` holds
    // Whether the slip is nothing beside a tolerance, and that little beside the radius.
    bool is_true_to(double tolerance) const {
        return slip <= 0x1p-8 * tolerance && !(radius > 0 && tolerance > radius / 8);
    }
};

// Of splines whose rows of control points are scaled copies of each other, evenly along lines, of revolutions
// of lines that meet their axis, or nearly do, for their slip, and of circles about points of it. In a part,
// if one is given, of lines that are nearly parallel to it: their slip holds there and half as far again to
// either side. Nothing for others.
std::optional<Apex> apex_of(const SurfaceGeometry& surface, const Box<2>& part = {});

}  // namespace freiform
