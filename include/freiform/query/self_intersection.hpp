// Where a curve meets itself: every place, none missed.
#pragma once
#include <freiform/spline/patch.hpp>

#include <array>
#include <span>
#include <string_view>
#include <vector>

namespace freiform {

enum class SelfContact {
    crossing,  // C(s) = C(t) for exactly one pair of s in `first`, t in `second`; at an angle
    meeting,   // C(s) = C(t) for s, t = `at`, exactly; whether elsewhere in `first` and `second` is not known
    near,      // |C(s) - C(t)| <= `distance` for s, t = `at`; whether it is 0 somewhere is not known
    cusp,      // `first` reaches `second`: a cusp, or a loop so small that it is not told from one
    unresolved,  // max_pairs were looked at, and nothing is known
};
std::string_view name_of(SelfContact kind);

template <int D>
struct SelfIntersection {
    SelfContact kind = SelfContact::unresolved;
    Interval first, second;  // first is left of second, or reaches it (at a cusp)
    Vec<D> point{};
    double bound = 0;  // from `point` to all points of the curve over `first` and `second`, at most
    // meeting: parameters that meet; near: parameters where the curve comes within `distance` of itself; else
    // those in the middle of `first` and `second`.
    std::array<double, 2> at{};
    double distance = 0;  // near: rounding included; else 0

    // Does the curve certainly meet itself there?
    bool is_certain() const { return kind == SelfContact::crossing || kind == SelfContact::meeting; }
};

// All pairs of parameters s < t with C(s) = C(t), ordered by `first`. Outside the answers there is none, and
// that is proven, rounding included. That the end of a closed curve meets its beginning, and a piece the next
// one, is not listed; that an open curve ends where it began is.
//
// Plane curves, and curves in space whose control points lie in one plane exactly: where the curve crosses
// itself at an angle, the answer is `crossing` and `bound` <= accuracy + rounding. Where it touches itself,
// and in space, almost any change of the coefficients makes it pass by: that it meets itself is then an
// answer only where exact arithmetic shows it, at parameters where the coefficients of the Bezier piece are
// given numbers; else the answer says how near the curve comes. `max_pairs` pairs of pieces are looked at.
// Refuses an accuracy that is not above 0.
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
