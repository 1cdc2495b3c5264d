// How fine the boundary of a face has to be for the triangles beside it.
#pragma once
#include <freiform/core/interval.hpp>
#include <freiform/spline/derivative_bounds.hpp>

namespace freiform {

// What a triangle with this side of the boundary as longest side is off by, about: no bound, but what makes
// mesh_face succeed. `chord`: the side in the parameter plane; `box` holds it, and `over` bounds derivatives
// there. Not made better than `enough`. `wary`: by all of the derivatives, not by what is seen along normals.
double error_beside(const DerivativeQuery<2, 3>& surface, const Box<2>& box, const DerivativeBounds<2>& over,
                    const Vec<2>& chord, double enough, bool wary);

// Whether mesh_face begins by judging the surface by what is seen along its normals: it has no kinks.
bool sees_normals(const DerivativeQuery<2, 3>& surface);

}  // namespace freiform
