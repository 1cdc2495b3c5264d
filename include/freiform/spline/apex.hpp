// Cones and cylinders: surfaces whose straight parameter lines meet in one point, which may be at infinity.
#pragma once
#include <freiform/spline/geometry.hpp>

#include <optional>

namespace freiform {

// S(u, v) = P + (v - at) c(u) but for `slip`, a distance: for one point P, the apex, and some curve c, for
// all v of the domain; where `at` is infinite, S(u, v) = c(u) + v d. With u and v exchanged where `ruled` is
// 0.
struct Apex {
    int ruled = 1;  // the axis whose parameter lines are straight
    double at = 0;  // its parameter in the apex
    double slip = 0;
    // Whether it is nothing beside a tolerance.
    bool is_true_to(double tolerance) const { return slip <= 0x1p-8 * tolerance; }
};

// Of splines with two rows of control points that are scaled copies of each other, and of revolutions of
// lines that meet their axis, or nearly do, for their slip. Nothing for others.
std::optional<Apex> apex_of(const SurfaceGeometry& surface);

}  // namespace freiform
