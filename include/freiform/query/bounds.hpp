// Tight boxes of curves, surfaces, volumes and triangles, and how far something reaches in a direction.
#pragma once
#include <freiform/spline/patch.hpp>
#include <freiform/spline/simplex.hpp>

namespace freiform {

template <int D>
struct TightBox {
    Box<D> box;        // contains the object, rounding included
    double slack = 0;  // bound: some point of the object is at most this far from each side of `box`
};

// The box of the object with `slack` <= accuracy (a length), as far as rounding and `max_pieces` allow: the
// answer says what was reached. Accuracy 0 asks for all that rounding allows, about 1e-15 of the coordinates.
// Pieces are halved where an extremum is, so the cost grows with log(1 / accuracy) for an extremum in a point
// and like accuracy^-1/2 for one along a line of a surface. Refuses accuracies that are negative or NaN.
//   const auto b = tight_box(curve, 1e-9);   // b->box.lo, b->slack
template <std::size_t N, class P>
Result<TightBox<Space<P>::kDim>> tight_box(const Patch<N, P>& patch, double accuracy, int max_pieces = 20000);
template <class P>
Result<TightBox<Space<P>::kDim>> tight_box(const SimplexPatch<2, P>& patch, double accuracy,
                                           int max_pieces = 20000);

// The values of direction . x over the object: an interval that contains them, each end within `slack` of
// one of them. Lengths are multiplied by |direction|.
struct Extent {
    Interval range;
    double slack = 0;
};
template <std::size_t N, class P>
Result<Extent> extent_along(const Patch<N, P>& patch, const PointOf<P>& direction, double accuracy,
                            int max_pieces = 20000);

}  // namespace freiform
