// Pairs of plane Bezier curves for tests of intersections.
#pragma once
#include "bezier.hpp"

#include <freiform/intersect/curve_curve.hpp>

#include <gtest/gtest.h>

namespace freiform::test {

using Plane = Curve<Vec<2>>;
inline Plane plane_bezier(std::vector<Vec<2>> points, Interval on = {0, 1}) {
    return bezier(std::move(points), on);
}

// The cubic (x, T(x)) of nine crossings with its mirror image: T a Chebyshev polynomial, 5/4 times.
inline Plane wave() {
    return plane_bezier({{{-1, -1.25}}, {{-0.3125, 6.25}}, {{0.3125, -6.25}}, {{1, 1.25}}});
}
// Every control point mapped by f.
template <class F>
Plane mapped(const Plane& c, F&& f) {
    std::vector<Vec<2>> net;
    for (const Vec<2>& p : c.net().flat()) net.push_back(f(p));
    const int n = int(net.size());
    return must(Plane::make({c.basis()}, Net<1, Vec<2>>({n}, std::move(net))));
}
inline Plane mirrored(const Plane& c) {
    return mapped(c, [](const Vec<2>& p) { return Vec<2>{{p[1], p[0]}}; });
}

using PlaneAnswer = Intersections<2, 2>;
inline PlaneAnswer meet(const Plane& a, const Plane& b, double accuracy = 0) {
    return must(intersect(a, b, {.accuracy = accuracy}));
}

}  // namespace freiform::test
