// How fine the boundary of a face has to be for the triangles beside it.
#pragma once
#include <freiform/core/interval.hpp>
#include <freiform/spline/derivative_bounds.hpp>

namespace freiform {

// What a triangle with this side of the boundary as longest side is off by at most, all of its error counted:
// what makes mesh_face succeed. `chord`: the side in the parameter plane; `box` holds it, and `over` bounds
// derivatives there.
double error_beside(const DerivativeQuery<2, 3>& surface, const Box<2>& box, const DerivativeBounds<2>& over,
                    const Vec<2>& chord);

}  // namespace freiform
