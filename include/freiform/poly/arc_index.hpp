// How a Bezier arc of the plane goes round a point: exact, and the sum over a closed curve is four times its
// winding number.
#pragma once
#include <freiform/core/vec.hpp>

#include <span>

namespace freiform {

struct ArcIndex {
    bool through = false;  // the arc contains the point; then `quarters` says nothing
    // Crossings of the horizontal line through the point, each counted twice: +2 for those that go round it
    // counter-clockwise (upwards on its right side, downwards on its left side), -2 for the others; ends of
    // the arc on that line count half.
    int quarters = 0;
};

// Of the arc with the Bernstein coefficients (x_i, y_i) / w_i, i = 0..n, in homogeneous form: x_i and y_i
// have been multiplied by the weight already. `w` empty: all weights are 1. Weights are positive. What is
// exact are the doubles given. REQUIRES finite numbers, equal sizes of at least 1.
//
// Cost: some comparisons where the point is outside the box of the control points; n^2 operations for each of
// about log2(size / distance) halvings where it is near the arc; integers, milliseconds at degree 10, where
// double precision cannot tell it from the arc.
//   int sum = 0; for (arc : loop) sum += arc_index(arc.x, arc.y, arc.w, q).quarters;   // winding number: sum
//   / 4
ArcIndex arc_index(std::span<const double> x, std::span<const double> y, std::span<const double> w,
                   const Vec<2>& q);

// 1: q is inside the ellipse centre + cos(t) x + sin(t) y, 0: on it, -1: outside; exact for the doubles
// given. REQUIRES finite numbers, x and y not parallel.
int ellipse_side(const Vec<2>& centre, const Vec<2>& x, const Vec<2>& y, const Vec<2>& q);

}  // namespace freiform
