// Curves of the plane that are lines and arcs of circles, as what they are.
#pragma once
#include <freiform/model/swept_solid.hpp>

#include <functional>
#include <optional>
#include <variant>

namespace freiform::detail {

struct PlaneLine {
    Vec<2> start{}, end{};
};
struct PlaneArc {
    Vec<2> centre{}, start{}, end{};
    double radius = 0, sweep = 0;  // the angle from start to end, counter-clockwise; at most a full turn
    double slip = 0;               // the curve is about so far from the arc: rounding
};
using ElementaryCurve = std::variant<std::monostate, PlaneLine, PlaneArc>;

struct PlaneSpline {
    const BSplineBasis* basis = nullptr;  // none: the curve is no spline
    std::vector<Hom<2>> net;
};
PlaneSpline spline_of(const CurveGeometry<2>& curve);

// Of a spline with two control points, or of rational arcs of one circle, quadratic Bezier curves each. Arcs
// of less than about a degree are left as they are: there rounding says little about the circle.
ElementaryCurve elementary_of(const CurveGeometry<2>& curve);

// The loop with arcs that follow each other on one circle as one curve; not across points that are to be
// kept.
std::vector<CurveGeometry<2>> with_joined_arcs(std::vector<CurveGeometry<2>> loop,
                                               const std::function<bool(const Vec<2>&)>& keep);

}  // namespace freiform::detail
