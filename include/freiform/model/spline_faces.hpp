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

struct SplineFace {
    TrimmedSurface face;
    // Of loops that cross an angle, in space: |face.surface(written(t)) - edge.curve(t)| is nowhere above
    // this, a bound; 0 without such loops.
    double bound = 0;
};
// The same, but loops that cross an angle are followed by cubics, no farther from their edges than the
// model's own curves are proven to be and `tolerance` (a distance in model units, > 0). Refuses (unsupported)
// those whose edges have no curve in space, (not_converged) what does not come near enough.
Result<SplineFace> spline_face_within(const Model& model, std::size_t face, double tolerance);

}  // namespace freiform
