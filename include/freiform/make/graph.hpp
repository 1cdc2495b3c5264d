// The graph of a function as a curve.
#pragma once
#include <freiform/spline/patch.hpp>

#include <span>

namespace freiform {

struct Graph {
    Curve<Vec<2>> curve;  // curve(x) = (x, f(x)); its parameter is x
    double bound = 0;     // distance of curve(x), calculated exactly, from (x, f(x))
};

// The graph of f(x) = a[0] + a[1] x + .. + a[n] x^n over [on.lo, on.hi] as one Bezier piece: its control
// points are evenly spaced in x. Refuses numbers that are not finite, no coefficients, degrees above
// kMaxDegree, an empty interval.
//   auto parabola = graph(std::array{0.0, 0.0, 1.0}, {-1, 1});     // y = x^2
Result<Graph> graph(std::span<const double> a, Interval on);

}  // namespace freiform
