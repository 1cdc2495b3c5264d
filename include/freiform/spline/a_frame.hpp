// Joined Bezier pieces and B-splines: A-frames, de Boor points of a C2 cubic Bezier spline, and knots of the
// lowest multiplicity that the joints allow.
//
//            apex                 b_{n-2}, b_{n-1}, b_n = c_0, c_1, c_2 are the Bezier points at a joint; the
//            pieces /  \                 are as long (in parameters) as h and k. Twice differentiable there
//            means that the
//     b_{n-1}----c_1              two legs meet:
//          / b_n  \                   b_{n-1} + k/h (b_{n-1} - b_{n-2}) = apex = c_1 + h/k (c_1 - c_2)
//     b_{n-2}     c_2             and that b_n divides b_{n-1} c_1 as h : k. Of a cubic, the apex is a de
//     Boor point.
#pragma once
#include <freiform/spline/refine.hpp>

namespace freiform {

// One A-frame. To draw it: the legs from_left[0], from_left[1], apex and apex, from_right[1], from_right[0];
// the crossbar from_left[1], joint, from_right[1]; every point through project().
template <Coefficient P>
struct AFrame {
    double at = 0;                // parameter of the joint
    std::array<P, 2> from_left;   // b_{n-2}, b_{n-1}
    std::array<P, 2> from_right;  // c_2, c_1
    P joint;                      // b_n
    P left_apex, right_apex;      // the two sides of the equation
    P apex;                       // their mean
    double gap = 0;               // |left_apex - right_apex|: 0 if C2, up to rounding (Hom: homogeneous)
};

// The A-frames at the inner breaks of a curve of degree >= 2 (of a closed one also at its seam, first), as it
// is evaluated left and right of them. Refuses degrees below 2.
template <Coefficient P>
Result<std::vector<AFrame<P>>> a_frames(const Curve<P>& curve);

// The cubic B-spline of the Bezier points 3 i .. 3 i + 3 of pieces on [breaks[i], breaks[i + 1]]: clamped,
// simple inner knots, control points b_0, b_1, the apices, b_{3l-1}, b_{3l}; every piece depends on four of
// them. No point is farther than `bound` from the given pieces at the same parameter, rounding included:
// small exactly if they are C2. `removed` counts the knots that were saved against triple ones. Refuses, by
// index, counts that disagree, breaks that do not increase, numbers that are not finite. Back:
// decompose(curve).
template <Coefficient P>
Result<Reduced<1, P>> de_boor_points(std::span<const P> bezier, std::span<const double> breaks);

// One curve of Bezier pieces of the same degree, each with degree + 1 coefficients of its own (a joint is
// given twice): inner knots have the lowest multiplicity for which the proven distance to the pieces stays <=
// tolerance, a distance in model units. So with m knots left at a joint the pieces are C^(degree - m) there
// within the tolerance. The tolerance has to leave room for the bound of the rounding, a few hundred
// roundings of the largest coordinate; 0 leaves degree + 1 knots, or degree where neighbours end and begin
// with the same coefficient.
template <Coefficient P>
Result<Reduced<1, P>> join_pieces(std::span<const P> coefficients, int degree, std::span<const double> breaks,
                                  double tolerance);

}  // namespace freiform
