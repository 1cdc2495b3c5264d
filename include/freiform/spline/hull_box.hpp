// Boxes of control points.
#pragma once
#include <freiform/core/interval.hpp>
#include <freiform/spline/geometry.hpp>

#include <optional>

namespace freiform {

// Contains the curve or surface over these parameters, rounding included: the box of the control points of
// the pieces that meet them, of splines (weights are positive), and the box of what an extrusion, a
// revolution (the whole turn) or an offset makes of the box of its profile or base. It does not depend on how
// fast parameters move, as bounds from derivatives do, so it is the better one where knots are crowded, and
// the worse one over small parts of long pieces. Nothing for conics, which have no control points.
template <int D>
std::optional<Box<D>> hull_box(const CurveGeometry<D>& curve, const std::array<Interval, 1>& on);
std::optional<Box<3>> hull_box(const SurfaceGeometry& surface, const std::array<Interval, 2>& on);

}  // namespace freiform
