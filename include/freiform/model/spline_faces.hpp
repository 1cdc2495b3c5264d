// The faces of models as trimmed spline surfaces, for what knows no others.
#pragma once
#include <freiform/model/model.hpp>
#include <freiform/trim/trimmed_surface.hpp>

namespace freiform {

// The same face: splines stay as they are; of extrusions and flat faces the part over what the loops cover,
// with the same parameters; revolutions and conics as rational quadratics on [0, 1], where the place of an
// angle is another. All are exact up to the rounding of control points. Loops are what the coedges say, run
// through in their direction; degenerate ones too, which are lines in the parameters. Refuses (unsupported)
// offset surfaces, extrusions of hyperbolas, and loops that run across the angle of such a surface otherwise
// than along its parameter lines: no rational curve is their image; and what TrimmedSurface::make refuses.
Result<TrimmedSurface> spline_face(const Model& model, std::size_t face);

}  // namespace freiform
