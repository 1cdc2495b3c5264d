// Where the parameters of a surface are periodic, and where it shrinks to a point.
#include "step_chart.hpp"
#include "step_geometry.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/core/visit.hpp>
#include <freiform/spline/hull_box.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace freiform::step {

namespace {

constexpr double kSingularCrossing = 1e-10;

// Ends this part of the way between them apart, or further, are not meant to meet: what is as small as the
// tolerance of the file closes nowhere.
constexpr double kSidesApart = 1e-3;
// Nor is a side a point that is not much shorter than the surface is wide elsewhere.
constexpr double kShrunk = 0.1;
// Of the size of a profile: its last digits leave an end that is on the axis so far beside it.
constexpr double kOnAxis = 1e-4;

// Those of a t^2 + b t + c, where they touch one between; `scale`: what a is small against. What there is not
// is not finite.
std::array<double, 2> roots(double a, double b, double c, double scale) {
    if (!(std::abs(a) > kSingularCrossing * scale)) return {-c / b, kInfinity};
    const double square = b * b - 4 * a * c;
    if (!(square > kSingularCrossing * b * b)) return {-b / (2 * a), kInfinity};
    const double q = -0.5 * (b + std::copysign(std::sqrt(square), b));
    return {q / a, c / q};
}

// Where the radial coordinate of a conic in the plane of the axis vanishes: C + A cos v + B sin v, likewise
// with cosh and sinh, or C + A v^2 + B v.
struct AxisCrossing {
    bool any = false;
    double middle = 0, half = 0;    // of ellipses: positive between middle - half and middle + half
    std::array<double, 2> roots{};  // of others
};
AxisCrossing crossing(const Revolution& s, const Conic<3>& c, double close) {
    const Vec<3> out = across(c.centre - s.origin, s.axis), x = across(c.x, s.axis), y = across(c.y, s.axis);
    Vec<3> e = norm(x) >= norm(y) ? x : y;
    if (norm(out) > norm(e)) e = out;
    e = unit(e);
    if (norm(out - dot(out, e) * e) + norm(x - dot(x, e) * e) + norm(y - dot(y, e) * e) > close) return {};
    const double a = dot(x, e), b = dot(y, e), k = dot(out, e), h = std::hypot(a, b);
    if (c.kind == ConicKind::parabola) return {true, 0, 0, roots(a, b, k, norm(c.x))};
    if (c.kind == ConicKind::hyperbola) {
        const auto t = roots(a + b, 2 * k, a - b, h);
        return {true, 0, 0, {std::log(t[0]), std::log(t[1])}};
    }
    if (std::abs(k) > h + close) return {};
    return {true, std::atan2(b, a), std::acos(std::clamp(-k / h, -1.0, 1.0)), {}};
}

}  // namespace

void Chart::profile_traits(const CurveGeometry<3>& profile, int axis) {
    const auto k = std::size_t(axis);
    if (const auto* c = std::get_if<Conic<3>>(&profile)) {
        period_[k] = c->kind == ConicKind::ellipse ? kTwoPi : 0;
    } else if (!std::holds_alternative<Line<3>>(profile)) {
        spline_[k] = true;
        const Interval on = whole_[k];
        const Vec<3> first = jet<0>(profile, on.lo).value();
        const double apart = norm(first - jet<0>(profile, on.hi).value());
        double way = 0;
        visit_one(
            [&](const auto& p) {
                if constexpr (requires { p.net(); })
                    for (const Vec<3>& x : points(p)) way = std::max(way, norm(x - first));
            },
            profile);
        if (apart <= kSidesApart * way) apart_[k] = apart;
        if (apart_[k] <= seam_) period_[k] = on.length();
    }
}

void Chart::poles_of(const Revolution& s, double close) {
    const auto add = [&](double v, double near) {
        if (!std::isfinite(v)) return;
        const Vec<3> p = jet<0>(s.profile, v).value();
        if (norm(across(p - s.origin, s.axis)) <= near)
            poles_.push_back({1, v, s.origin + dot(p - s.origin, s.axis) * s.axis});
    };
    if (const auto* l = std::get_if<Line<3>>(&s.profile)) {
        const Vec<3> d = across(l->direction, s.axis), o = across(l->origin - s.origin, s.axis);
        if (dot(d, d) > 0) add(-dot(o, d) / dot(d, d), close);
    } else if (const auto* c = std::get_if<Conic<3>>(&s.profile)) {
        AxisCrossing at = crossing(s, *c, close);
        if (!at.any) return;
        if (c->kind == ConicKind::ellipse) {
            whole_[1] = {at.middle - at.half, at.middle + at.half};
            at.roots = {whole_[1].lo, whole_[1].hi};
        }
        for (const double v : at.roots) add(v, close);
    } else {
        const auto box = hull_box(s.profile, {whole_[1]});
        const double near = std::max(close, box ? kOnAxis * box->diagonal() : 0.0);
        add(whole_[1].lo, near);
        add(whole_[1].hi, near);
    }
}

// Splines: opposite sides that agree, sides that are one point.
void Chart::poles_of_sides(double stated) {
    visit_one(
        [&](const auto& s) {
            if constexpr (requires { s.net(); }) {
                const auto all = points(s);
                const auto row = std::size_t(s.net().extent()[1]);
                Box<3> box;
                for (const Vec<3>& p : all) box.add(p);
                const double close = std::min(stated, kSidesApart * box.diagonal());
                std::array<double, 2> way{};
                for (std::size_t i = 0; i < all.size(); ++i) {
                    way[0] = std::max(way[0], norm(all[i] - all[i % row]));
                    way[1] = std::max(way[1], norm(all[i] - all[i - i % row]));
                }
                for (std::size_t k = 0; k < 2; ++k) {
                    const int axis = int(k);
                    const auto lo = boundary(s, axis, 0), hi = boundary(s, axis, 1);
                    const auto a = points(lo), b = points(hi);
                    const auto lo_weights = weights(lo), hi_weights = weights(hi);
                    double apart = 0, uneven = 0, extent = 0;
                    for (std::size_t i = 0; i < a.size(); ++i) {
                        apart = std::max(apart, norm(a[i] - b[i]));
                        extent = std::max(extent, norm(a[i] - a[0]));
                        const double both = hi_weights[0] / lo_weights[0];
                        uneven = std::max(uneven, std::abs(hi_weights[i] / (both * lo_weights[i]) - 1));
                    }
                    // Other weights move a point towards control points, by as much as they differ, but for a
                    // factor of all.
                    apart += 4 * uneven * extent;
                    if (apart <= kSidesApart * std::min(way[k], box.diagonal())) apart_[k] = apart;
                    if (apart_[k] <= seam_) period_[k] = s.basis(axis).domain().length();
                    for (const auto* side : {&a, &b}) {
                        double size = 0;
                        for (const Vec<3>& p : *side) size = std::max(size, norm(p - side->front()));
                        const Interval on = s.basis(axis).domain();
                        if (size <= std::min(close, kShrunk * way[1 - k]))
                            poles_.push_back({axis, side == &a ? on.lo : on.hi, side->front()});
                    }
                }
            }
        },
        std::holds_alternative<OffsetSurface>(*s_) ? *std::get<OffsetSurface>(*s_).base : *s_);
}

bool Chart::has_pole_across(const CurveGeometry<2>& curve, Interval on) const {
    for (const Pole& p : poles_) {
        const double turn = period(p.axis);
        double least = 0, most = 0;
        for (int i = 0; i <= 8; ++i) {
            double off = jet<0>(curve, on.lo + on.length() * i / 8).value()[p.axis] - p.at;
            if (turn > 0) off -= std::round(off / turn) * turn;
            if (std::abs(off) > 0.4 * turn && turn > 0) continue;
            least = std::min(least, off), most = std::max(most, off);
        }
        const double small = 1e-5 * (most - least);
        if (least < -small && most > small) return true;
    }
    return false;
}

}  // namespace freiform::step
