// Where a curve crosses or touches a line, plane, or point of the line: every place, none missed.
#pragma once
#include <freiform/spline/patch.hpp>

#include <string_view>
#include <vector>

namespace freiform {

enum class CrossingKind {
    crossing,  // from one side to the other
    tangent,   // touches and stays on its side
    end,       // an end of an open curve lies on it
    overlap,   // the curve lies in it, over an interval
    jump,      // the curve jumps from one side to the other, at a knot of multiplicity degree + 1
    possible,  // within rounding the curve may touch, cross twice, or miss it
};
std::string_view name_of(CrossingKind kind);

template <int D>
struct Crossing {
    CrossingKind kind = CrossingKind::crossing;
    // Of the parameter. lo == hi: it is this number. kind overlap: the whole interval lies in the plane.
    Interval at;
    // Contacts in `at`, with multiplicity: 1 where curve and plane cross at an angle, 2 where they touch, 3
    // where the curve inflects through its tangent. If they differ, it is not known. Overlaps: both 0.
    int least = 1, most = 1;
    Vec<D> point{};    // of the curve, at the middle of `at`
    double bound = 0;  // from `point` to the points of the curve over `at`, at most
};

// All parameters t with normal . C(t) + offset = 0, in increasing order: crossings with a line (D = 2: a, b,
// c of a x + b y + c = 0), a plane (D = 3), a value (D = 1). Parameters are known so well that `bound` <=
// accuracy (a length; 0: as well as doubles can say), except where kind is possible and between knots of
// splines in which rounding leaves more. On Bezier curves, and splines made of them (inner knots of
// multiplicity degree), the answer is exact: no kind is `possible`, multiplicities are those of the numbers
// given. Refuses numbers that are not finite, a normal that is zero, and a negative accuracy.
//   const auto hits = crossings(curve, {{0.0, 1.0}}, -2.0, 1e-9);   // with y = 2
template <class P>
Result<std::vector<Crossing<Space<P>::kDim>>> crossings(const Curve<P>& curve, const PointOf<P>& normal,
                                                        double offset, double accuracy);

}  // namespace freiform
