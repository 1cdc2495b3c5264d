// A part of the boundary of a face, as a chord and a bound of how far the boundary leaves it.
#pragma once
#include <freiform/model/model.hpp>
#include <freiform/spline/derivative_bounds.hpp>

#include <array>

namespace freiform {

// How far places may be apart whose parameters are, with bounds of first derivatives, which may be infinite.
double moved(const DerivativeBounds<2>& d, const Vec<2>& by);
// A bound of that over a box, where `known` is one; offsets are no farther from their base than they say,
// whatever is known of their normals.
double moved_at_most(double known, const SurfaceGeometry& surface, const DerivativeQuery<2, 3>& query,
                     const std::array<Interval, 2>& box, const Vec<2>& by);

struct FaceRim {
    int owner = -1;                  // for the caller
    const Coedge* coedge = nullptr;  // none: a jump between two
    const DerivativeQuery<1, 2>* curve = nullptr;
    Interval on;               // of the parameter of the edge
    std::array<Vec<2>, 2> uv;  // the ends, moved into the domain of the surface
    std::array<Vec<3>, 2> end;
    double error = 0;  // bound, rounding included; may be infinite

    // Of the parameter curve of a coedge; `curve`: prepared from it.
    static FaceRim over(const Face& face, const DerivativeQuery<2, 3>& surface, const Coedge* coedge,
                        const DerivativeQuery<1, 2>* curve, Interval on);
    // A straight line in the parameter plane, between points of the domain.
    static FaceRim jump(const Face& face, const DerivativeQuery<2, 3>& surface, const Vec<2>& from,
                        const Vec<2>& to);

private:
    void bound(const Face& face, const DerivativeQuery<2, 3>& surface);
};

}  // namespace freiform
