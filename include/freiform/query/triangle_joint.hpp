// How well two triangular patches meet along an edge: distances, tangent planes, derivatives, each with a
// bound for the whole edge.
#pragma once
#include <freiform/spline/simplex.hpp>

namespace freiform {

// The largest of some deviation along an edge: at most `bound`, rounding included; `found` is the largest
// that was met at the places looked at, an estimate that is up to rounding not above the true one.
struct Deviation {
    double found = 0, bound = 0;
};

struct TriangleJoint {
    Deviation position;  // distance of the points at the same place of both edges
    Deviation angle;     // between the normals there, in radians; pi where a normal may vanish
};

// Edge `edge_a` of `a` against `edge_b` of `b`, which runs the other way, as neighbours of one orientation
// do. G^1 within rounding: both bounds are as small as rounding is.
template <class P>
requires(Space<P>::kDim == 3) Result<TriangleJoint> triangle_joint(const SimplexPatch<2, P>& a, int edge_a,
                                                                   const SimplexPatch<2, P>& b, int edge_b);

// C^1 over a plane of parameters in which `a` has its triangle and the opposite corner of `b` is at `apex`:
// how much the derivatives from the beginning of the edge of `a` towards `apex` differ; length / parameter.
// Where positions agree, 0 means C^1.
template <class P>
requires(Space<P>::kDim == 3) Result<Deviation> c1_deviation(const SimplexPatch<2, P>& a, int edge_a,
                                                             const SimplexPatch<2, P>& b, int edge_b,
                                                             const Param<2>& apex);

}  // namespace freiform
