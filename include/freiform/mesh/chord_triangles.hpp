// How fine the boundary of a face has to be for the triangles beside it.
#pragma once
#include <freiform/core/interval.hpp>
#include <freiform/spline/apex.hpp>
#include <freiform/spline/derivative_bounds.hpp>

namespace freiform {

// A straight side of the boundary of a face, between two places of the parameter plane; `over` bounds
// derivatives in a box that holds it. `apex`: where the face is taken as a cone (FaceDemands).
struct BoundarySide {
    const DerivativeQuery<2, 3>& surface;
    Box<2> box;
    DerivativeBounds<2> over;
    Vec<2> from, to;
    std::optional<Apex> apex;

    // What a triangle with this side as longest side is off by at most, all of its error counted: what makes
    // mesh_face succeed.
    double error_beside() const;
    // Of a cone: how far, in both parameters, the side is from that which triangles stand for (cone_face.cpp)
    // at most; the latter is within error_beside() of the chord in space. Nothing if they are the same.
    std::optional<Vec<2>> bow() const;
};

// Of the surface, if a face in this box is to be taken as a cone: on one side of the apex, and with fewer
// triangles then: not where it is hardly curved for its size, as in a plane.
std::optional<Apex> apex_for(const SurfaceGeometry& surface, const Box<2>& face);

}  // namespace freiform
