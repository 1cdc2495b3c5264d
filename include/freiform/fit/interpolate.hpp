// Splines through points: curves through sequences, surfaces and volumes through grids, of any degree.
//
// The spline of degree p through m points has p - 1 continuous derivatives. Odd degrees have their knots at
// the parameters of the points, even degrees half-way between. What else is asked, (p - 1) / 2 conditions at
// each end (p / 2 for even p), is a choice:
//
//     natural      derivatives of order p / 2 + 1, p / 2 + 2, ... vanish there: f'' of a cubic. Odd p: the
//                  curve that bends least, in the sense of the integral of derivative (p + 1) / 2, squared
//     clamped      derivatives of order 1, 2, ... are given
//     not_a_knot   no knots next to the ends instead; reproduces polynomials of degree p; needs p + 1 points
//     periodic     the curve closes with all its derivatives
#pragma once
#include <freiform/fit/parameters.hpp>
#include <freiform/spline/patch.hpp>

#include <span>
#include <vector>

namespace freiform {

enum class SplineEnds { natural, clamped, not_a_knot, periodic };
std::string_view name_of(SplineEnds ends);

// How to interpolate along one axis.
struct AxisSpline {
    int degree = 3;
    SplineEnds ends = SplineEnds::natural;
    std::span<const double> at;  // increasing, one for each point; periodic: one more, the end of the period
};

template <std::size_t N, int D>
struct Interpolant {
    Patch<N, Vec<D>> patch;
    // No point is farther than this from the patch at its parameters: the residual, rounding included.
    double bound = 0;
    // Of the system, in the maximum norm: how much larger a change of the curve may be than that of a point,
    // roughly. Exact up to rounding for not_a_knot and periodic ends.
    double condition_estimate = 0;
};

// Through a grid of points. Along a clamped axis the net has k = degree / 2 layers of derivatives before the
// points, of order k .. 1, and k behind them, of order 1 .. k (of surfaces: cross derivatives and twists
// where two such axes meet). Time and memory are linear in the number of points.
//   auto s = interpolate<2, 3>(grid, {AxisSpline{3, SplineEnds::natural, u}, {3, SplineEnds::periodic, v}});
template <std::size_t N, int D>
Result<Interpolant<N, D>> interpolate(const Net<N, Vec<D>>& points, const std::array<AxisSpline, N>& axes);

// A curve. Clamped: `start` and `end` hold the derivatives of order 1, 2, .., degree / 2, by parameter.
//   auto c = interpolate<3>(points, {3, SplineEnds::clamped, at}, {&v0, 1}, {&v1, 1});
template <int D>
Result<Interpolant<1, D>> interpolate(std::span<const Vec<D>> points, const AxisSpline& axis,
                                      std::span<const Vec<D>> start = {}, std::span<const Vec<D>> end = {});

// A value (order 0) or a derivative that a curve is to have at a parameter.
template <int D>
struct Datum {
    double at = 0;
    int order = 0;
    Vec<D> value{};
};

// The spline on the given basis with these values and derivatives, as many as the basis has functions, in any
// order (Hermite-Birkhoff interpolation). Refuses, naming data[i], what contradicts the condition of
// Schoenberg and Whitney that every function has a datum of its own where it is not zero. The bound is for
// the values only; derivatives are met up to rounding.
template <int D>
Result<Interpolant<1, D>> interpolate(const BSplineBasis& basis, std::span<const Datum<D>> data);

// Knots for data at these sites, sorted, each repeated as often as it has data (at most degree + 1 times):
// means of `degree` neighbouring sites, which satisfies the condition above. REQUIRES degree >= 1.
Result<BSplineBasis> averaged_basis(int degree, std::span<const double> sites);

}  // namespace freiform
