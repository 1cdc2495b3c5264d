// How far the normals of a surface turn: bounds, not samples.
#pragma once
#include <freiform/core/interval.hpp>
#include <freiform/spline/derivative_bounds.hpp>

#include <array>
#include <numbers>

namespace freiform {

// All unit normals (in the sense of S_u x S_v) over a box are within `angle` (radians) of `axis`: a bound,
// rounding included; pi where none was found (poles, kinks inside the box that are more than rounding,
// normals that turn too much).
struct NormalCone {
    Vec<3> axis{};
    double angle = std::numbers::pi;
};
NormalCone normal_cone(const DerivativeQuery<2, 3>& surface, const Box<2>& box);

// Whether small boxes in the box have cones of at most `angle`, so far as two of them say: far from the
// origin rounding hides what normals do over lengths that matter.
bool has_narrow_cones(const DerivativeQuery<2, 3>& surface, const Box<2>& box, double angle);

// Of the angle (radians, up to pi) between the normal of the triangle in space and any normal of the surface
// over the triangle in the parameter plane: a bound, rounding included. Corners in the same order;
// counter-clockwise in the parameter plane. Pi where nothing is proven, as for triangles without area.
double normal_angle_bound(const DerivativeQuery<2, 3>& surface, const std::array<Vec<2>, 3>& uv,
                          const std::array<Vec<3>, 3>& corners);

}  // namespace freiform
