// Surfaces that are told with other parameters, for the sake of a face.
#include "step_shape.hpp"

#include <freiform/core/constants.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace freiform::step {

std::optional<FoundSphere> sphere_of(const Chart& chart, double tolerance) {
    constexpr double kMoved = 64;
    constexpr double kSphere = 1e-3;  // of the tolerance: what is so near to a sphere is one, and told
    if (const auto* spline = std::get_if<Surface<Hom<3>>>(&chart.surface()))
        return chart.poles().empty() ? std::nullopt : freiform::sphere_of(*spline, kSphere * tolerance);
    const auto* s = std::get_if<Revolution>(&chart.surface());
    const auto* circle = s != nullptr ? std::get_if<Conic<3>>(&s->profile) : nullptr;
    if (circle == nullptr || circle->kind != ConicKind::ellipse) return std::nullopt;
    FoundSphere found{circle->centre, norm(circle->x), 0};
    if (s->kind == SurfaceKind::sphere) return found;
    const Vec<3> from = circle->centre - s->origin, axis = unit(s->axis);
    // A point of the circle is so far from the sphere about its centre, which moves as the circle turns.
    found.off = 1.01 * (2 * norm(from - dot(from, axis) * axis) + std::abs(norm(circle->y) - found.radius) +
                        std::abs(dot(circle->x, circle->y)) / found.radius);
    if (!(found.off <= kSphere * tolerance) ||
        std::abs(dot(unit(cross(circle->x, circle->y)), axis)) * found.radius > kSphere * tolerance)
        return std::nullopt;
    found.off += kMoved * kUnitRoundoff * (max_abs(circle->centre) + found.radius);
    return found;
}

// A sphere with its poles elsewhere: as far as possible from the edges. An edge that runs through a
// pole has no continuous parameter curve; the same sphere with another axis has one for it. Also of other
// surfaces that are spheres, the normals of which may look inwards.
std::optional<ShapeReader::OtherSphere> ShapeReader::other_poles(const Chart& chart,
                                                                 const std::vector<int>& used) const {
    constexpr int kSamples = 48, kDirections = 400;
    const auto sphere = sphere_of(chart, tolerance_);
    if (!sphere) return std::nullopt;
    const Vec<2> middle{{chart.whole()[0].middle(), chart.whole()[1].middle()}};
    const auto j = jet<1>(chart.surface(), middle.c);
    const bool inwards = dot(cross(j.d[1], j.d[2]), j.d[0] - sphere->centre) < 0;
    std::vector<Vec<3>> on;
    for (const int edge : used) {
        const Edge& e = out_.model.edges[std::size_t(edge)];
        if (!e.curve) continue;
        for (int i = 0; i <= kSamples; ++i)
            on.push_back(unit(jet<0>(*e.curve, e.range.lo + e.range.length() * i / kSamples).value() -
                              sphere->centre));
    }
    Vec<3> best{};
    double widest = -1;
    for (int i = 0; i < kDirections; ++i) {  // spread over half a sphere by the golden angle
        const double h = (i + 0.5) / kDirections, turn = i * std::numbers::pi * (3 - std::sqrt(5.0));
        const double r = std::sqrt(1 - h * h);
        const Vec<3> z{{r * std::cos(turn), r * std::sin(turn), h}};
        double near = 2;
        for (const Vec<3>& p : on) near = std::min(near, 1 - std::abs(dot(p, z)));
        if (near > widest) widest = near, best = z;
    }
    const Vec<3> beside{{std::abs(best[0]) < 0.6 ? 1.0 : 0.0, std::abs(best[0]) < 0.6 ? 0.0 : 1.0, 0}};
    const Vec<3> x = unit(beside - dot(beside, best) * best);
    return OtherSphere{
        Revolution{Conic<3>{ConicKind::ellipse, sphere->centre, sphere->radius * x, sphere->radius * best},
                   sphere->centre, best, SurfaceKind::sphere},
        inwards, sphere->off};
}

// A circle that turns about a line through it passes every place twice, with either normal; charts keep to
// one half of it. The other one, if the edges of the face that lie on the circle itself, where it begins to
// turn, all lie there.
std::optional<SurfaceGeometry> ShapeReader::other_half(const Chart& chart,
                                                       const std::vector<int>& used) const {
    const auto* s = std::get_if<Revolution>(&chart.surface());
    const auto* circle = s != nullptr ? std::get_if<Conic<3>>(&s->profile) : nullptr;
    const Interval half = chart.whole()[1];
    if (circle == nullptr || s->kind != SurfaceKind::general || circle->kind != ConicKind::ellipse ||
        !(half.length() < kTwoPi))
        return std::nullopt;
    bool there = false;
    for (const int edge : used) {
        const Edge& e = out_.model.edges[std::size_t(edge)];
        if (!e.curve) continue;
        double at = 0, beside = 0;
        for (const double part : {0.0, 0.25, 0.75, 1.0, 0.5}) {  // the middle last
            double off = 0;
            at = parameter_of(*circle, jet<0>(*e.curve, e.range.lo + part * e.range.length()).value(), off);
            beside = std::max(beside, off);
        }
        if (!(beside <= tolerance_)) continue;
        if (std::abs(std::remainder(at - half.middle(), kTwoPi)) < half.length() / 2) return std::nullopt;
        there = true;
    }
    if (!there) return std::nullopt;
    return Revolution{Conic<3>{ConicKind::ellipse, circle->centre, -circle->x, -circle->y}, s->origin,
                      s->axis, s->kind};
}

}  // namespace freiform::step
