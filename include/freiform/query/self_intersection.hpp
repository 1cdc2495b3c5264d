// Where a curve meets itself: every place, none missed.
#pragma once
#include <freiform/spline/patch.hpp>

#include <span>
#include <vector>

namespace freiform {

template <int D>
struct SelfIntersection {
    // True: the curve crosses itself exactly once with one parameter in `first` and the other in `second`.
    // False: it may meet itself there, or come very near, or not be told from a cusp.
    bool is_certain = false;
    Interval first, second;  // first is left of second, or reaches it (at a cusp)
    Vec<D> point{};
    double bound = 0;  // from `point` to all points of the curve over `first` and `second`, at most
};

// All pairs of parameters s < t with C(s) = C(t), ordered by `first`. Outside the answers there is none, and
// that is proven, rounding included. That the end of a closed curve meets its beginning, and a piece the next
// one, is not listed; an open curve may end where it began, then that is listed as uncertain. Plane: where
// the curve crosses itself at an angle, the answer is certain and `bound` <= accuracy + rounding; where it
// touches itself, or has a cusp, it is not. Space: answers are uncertain always, since almost all curves pass
// by themselves; they say where the distance may be zero, within about `accuracy`. `max_pairs` pairs of
// pieces are looked at; what is left open then is listed as uncertain. Refuses an accuracy that is not above
// 0.
//   const auto loops = self_intersections(curve, 1e-9);
template <class P>
requires(Space<P>::kDim == 2 || Space<P>::kDim == 3)
    Result<std::vector<SelfIntersection<Space<P>::kDim>>> self_intersections(const Curve<P>& curve,
                                                                             double accuracy,
                                                                             int max_pairs = 200000);

// The same of several closed chains at once, each with itself and with the others. They are one curve that
// jumps between them (knots of multiplicity degree + 1); over each interval of `closed` it comes back to
// where it began, which is not listed. What is certain is so for all coefficients of Bezier piece i that are
// off by at most errors[i]. Refuses (limit) where more than max_pairs pairs of pieces are on top of each
// other. REQUIRES an error for each piece.
Result<std::vector<SelfIntersection<2>>> self_intersections(const Curve<Hom<2>>& chains,
                                                            std::span<const Interval> closed,
                                                            std::span<const double> errors, double accuracy,
                                                            int max_pairs);

}  // namespace freiform
