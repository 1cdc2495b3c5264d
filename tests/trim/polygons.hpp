// Loops for tests.
#pragma once
#include <freiform/trim/trimmed_surface.hpp>

#include <utility>
#include <vector>

namespace freiform::test {

using Loop = std::vector<CurveGeometry<2>>;
using Loops = std::vector<Loop>;

inline CurveGeometry<2> plane_bezier(std::vector<Vec<2>> points) {
    const int n = int(points.size());
    return *Curve<Vec<2>>::make({*BSplineBasis::bezier(n - 1)}, Net<1, Vec<2>>({n}, std::move(points)));
}

inline Loop polygon(const std::vector<Vec<2>>& p) {
    Loop loop;
    for (std::size_t i = 0; i < p.size(); ++i) loop.push_back(plane_bezier({p[i], p[(i + 1) % p.size()]}));
    return loop;
}

inline Loop box(double x0, double y0, double x1, double y1) {
    return polygon({{{x0, y0}}, {{x1, y0}}, {{x1, y1}}, {{x0, y1}}});
}

inline Loop ellipse(Vec<2> centre, Vec<2> x, Vec<2> y) {
    return {Conic<2>{ConicKind::ellipse, centre, x, y}};
}

}  // namespace freiform::test
