// Idea. What a boundary needs to know of a surface is little: periods, poles, and the parameters of points.
// For elementary surfaces all of it has a closed form. For others a grid of points, made once, gives a guess
// that Newton's method improves.
//
// Method. Newton's method for the nearest point: with J = (S_u, S_v) and r = target - S the step solves
// J^T J d = J^T r, which converges fast as r is small at the solution. At the end of a spline a step that
// would leave it goes along the end instead.
#include "step_chart.hpp"

#include "step_geometry.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/core/visit.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace freiform::step {

namespace {

constexpr double kSingular = 1e-10;
constexpr double kHeld = 1e-7;    // of a domain, by which a step has to leave it
constexpr int kMostSamples = 40;  // of a grid, along each axis

// Solves J^T J d = J^T r. False where the directions of the parameters are all but parallel.
bool solve(const Vec<3>& su, const Vec<3>& sv, const Vec<3>& r, Vec<2>& d) {
    const double a = dot(su, su), b = dot(su, sv), c = dot(sv, sv), det = a * c - b * b;
    if (!(det > kSingular * a * c)) return false;
    const double p = dot(su, r), q = dot(sv, r);
    d = {{(c * p - b * q) / det, (a * q - b * p) / det}};
    return true;
}

std::vector<double> samples_of(const SurfaceGeometry& s, int axis, const Interval& on) {
    std::vector<double> places;
    visit_one(
        [&](const auto& g) {
            if constexpr (requires { g.net(); })
                places = g.basis(axis).breaks();
            else if constexpr (requires { g.profile; })
                visit_one(
                    [&](const auto& c) {
                        if constexpr (requires { c.net(); }) places = c.basis().breaks();
                    },
                    g.profile);
        },
        s);
    const bool of_profile = std::holds_alternative<Extrusion>(s) ? axis == 0 : axis == 1;
    const bool is_patch =
        std::holds_alternative<Surface<Vec<3>>>(s) || std::holds_alternative<Surface<Hom<3>>>(s);
    if (places.empty() || (!is_patch && !of_profile)) places = {on.lo, on.hi};
    const int spans = int(places.size()) - 1, each = std::max(1, (kMostSamples + spans - 1) / spans);
    std::vector<double> out;
    const int stride = std::max(1, spans / kMostSamples);
    for (int i = 0; i < spans; i += stride)
        for (int k = 0; k < std::min(each, 12); ++k)
            out.push_back(places[std::size_t(i)] +
                          (places[std::size_t(i) + 1] - places[std::size_t(i)]) * k / std::min(each, 12));
    out.push_back(places.back());
    return out;
}

}  // namespace

Chart::Chart(const SurfaceGeometry& surface, double close, double seam)
    : s_(&surface), close_(close), seam_(std::max(close, seam)) {
    const SurfaceGeometry* s = s_;
    if (const auto* o = std::get_if<OffsetSurface>(s)) s = o->base.get();
    whole_ = domain(*s);
    if (const auto* e = std::get_if<Extrusion>(s)) {
        profile_traits(e->profile, 0);
    } else if (const auto* r = std::get_if<Revolution>(s)) {
        period_[0] = kTwoPi;
        profile_traits(r->profile, 1);
        poles_of(*r, close);
    } else {
        spline_ = {true, true};
        poles_of_sides(close);
    }
    if (s != s_)  // the offset of a pole need not be one
        std::erase_if(poles_, [&](const Pole& p) {
            Vec<2> a{{whole_[0].lo, whole_[1].lo}}, b{{whole_[0].middle(), whole_[1].middle()}};
            a[p.axis] = b[p.axis] = p.at;
            return !(norm(point(a) - point(b)) <= close);
        });
}

Vec<2> Chart::wrapped(Vec<2> uv) const {
    for (int k = 0; k < 2; ++k) {
        const auto i = std::size_t(k);
        if (!spline_[i] || whole_[i].contains(uv[k])) continue;
        if (period_[i] > 0 && std::isfinite(uv[k]))
            uv[k] -= std::floor((uv[k] - whole_[i].lo) / period_[i]) * period_[i];
        uv[k] = clamped(uv[k], whole_[i]);
    }
    return uv;
}

Vec<2> Chart::inside(Vec<2> uv) const {
    for (int k = 0; k < 2; ++k)
        if (spline_[std::size_t(k)] && period_[std::size_t(k)] == 0)
            uv[k] = clamped(uv[k], whole_[std::size_t(k)]);
    return uv;
}

Foot Chart::foot(const Vec<3>& target, const Vec<3>& motion, const Vec<2>& guess) const {
    Foot best;
    Vec<2> at = inside(guess);
    best.at = at;
    best.distance = kInfinity;
    for (int i = 0; i < 12; ++i) {
        const auto j = jet<1>(*s_, wrapped(at).c);
        const Vec<3> r = target - j.d[0];
        const double distance = norm(r);
        if (!std::isfinite(distance)) break;
        Vec<2> slope{}, step{};
        const bool at_pole = std::any_of(poles_.begin(), poles_.end(), [&](const Pole& p) {
            return norm(j.d[0] - p.point) <= 1e-4 * close_;
        });
        const bool regular =
            !at_pole && solve(j.d[1], j.d[2], motion, slope) && solve(j.d[1], j.d[2], r, step);
        // Held at the end of a spline: it moves along that end only.
        for (int k = 0; k < 2 && regular; ++k) {
            const auto axis = std::size_t(k);
            const Interval& on = whole_[axis];
            if (!spline_[axis] || period_[axis] > 0 || std::abs(step[k]) <= kHeld * on.length()) continue;
            if (!(at[k] == on.lo && step[k] < 0) && !(at[k] == on.hi && step[k] > 0)) continue;
            const Vec<3>& along = j.d[std::size_t(2 - k)];
            slope[k] = 0;
            slope[1 - k] = dot(along, motion) / dot(along, along);
        }
        const bool settled = !(distance < 0.99 * best.distance);
        if (distance < best.distance) best = {at, slope, distance, regular};
        if (!regular || (settled && i > 1)) break;
        if (distance == 0) break;
        Vec<2> next = at + step;
        for (int k = 0; k < 2; ++k) {
            const auto axis = std::size_t(k);
            if (!spline_[axis] || period_[axis] > 0) continue;
            const Interval& on = whole_[axis];
            if (on.contains(next[k])) continue;
            if ((at[k] == on.lo && step[k] < 0) || (at[k] == on.hi && step[k] > 0)) {
                const Vec<3>& along = j.d[std::size_t(2 - k)];  // go along the end
                next[1 - k] = at[1 - k] + dot(along, r) / dot(along, along);
            }
            next[k] = clamped(next[k], on);
        }
        at = inside(next);
    }
    return best;
}

// The method of Levenberg and Marquardt, the parameters measured by how much each moves the point.
Vec<2> Chart::damped_foot(const Vec<3>& target, const Vec<2>& guess) const {
    Vec<2> at = inside(guess);
    double damping = 1e-3, distance = norm(target - point(at));
    for (int i = 0; i < 30 && distance > 0; ++i) {
        const auto j = jet<1>(*s_, wrapped(at).c);
        const Vec<3> r = target - j.d[0];
        const double a = dot(j.d[1], j.d[1]) * (1 + damping), b = dot(j.d[1], j.d[2]),
                     c = dot(j.d[2], j.d[2]) * (1 + damping), det = a * c - b * b;
        const double p = dot(j.d[1], r), q = dot(j.d[2], r);
        if (!(det > 0)) break;
        const Vec<2> step{{(c * p - b * q) / det, (a * q - b * p) / det}}, next = inside(at + step);
        const double there = norm(target - point(next));
        if (there < distance) {
            const bool settled = there > (1 - 1e-9) * distance;
            at = next, distance = there, damping = std::max(damping / 8, 1e-12);
            if (settled) break;
        } else {
            damping *= 10;
            if (damping > 1e9) break;
        }
    }
    return at;
}

std::optional<Vec<2>> Chart::closed_form(const Vec<3>& p) const {
    const SurfaceGeometry* s = s_;
    if (const auto* o = std::get_if<OffsetSurface>(s)) s = o->base.get();
    if (const auto* e = std::get_if<Extrusion>(s)) {
        const auto* l = std::get_if<Line<3>>(&e->profile);
        const auto* c = std::get_if<Conic<3>>(&e->profile);
        if (!l && !c) return std::nullopt;
        // p - origin = a X + b Y + v D
        const Vec<3> x = l ? l->direction : c->x, y = l ? cross(l->direction, e->direction) : c->y,
                     d = e->direction;
        const Vec<3> r = p - (l ? l->origin : c->centre), n = cross(x, y);
        const double det = dot(n, d);
        if (det == 0) return std::nullopt;
        const double a = dot(cross(y, d), r) / det, b = dot(cross(d, x), r) / det, v = dot(n, r) / det;
        return Vec<2>{{l                                 ? a
                       : c->kind == ConicKind::ellipse   ? std::atan2(b, a)
                       : c->kind == ConicKind::hyperbola ? std::asinh(b)
                                                         : b,
                       v}};
    }
    const auto* r = std::get_if<Revolution>(s);
    if (!r) return std::nullopt;
    const auto* l = std::get_if<Line<3>>(&r->profile);
    const auto* c = std::get_if<Conic<3>>(&r->profile);
    if (!l && !c) return std::nullopt;
    // Both half-planes of the axis through p, turned back to the profile.
    const Vec<3> q = p - r->origin;
    const Vec<3> seen = across(q, r->axis),
                 at_profile = across((l ? l->origin : c->centre) - r->origin, r->axis);
    // Of a circle that meets the axis it is the half that the chart keeps to.
    Vec<3> e = c && whole_[1].length() < kTwoPi
                   ? across(jet<0>(r->profile, whole_[1].middle()).value() - r->origin, r->axis)
                   : at_profile;
    for (const Vec<3>& d : {l ? l->direction : c->x, c ? c->y : Vec<3>{}})
        if (const Vec<3> f = across(d, r->axis); norm(f) > 1e3 * norm(e) || norm(e) == 0) e = f;
    if (norm(e) == 0) return std::nullopt;
    e = unit(e);
    const Vec<3> side = cross(r->axis, e);
    Vec<2> best{};
    double least = kInfinity;
    for (const double sign : {1.0, -1.0}) {
        const double u = std::atan2(sign * dot(seen, side), sign * dot(seen, e));
        const Vec<3> x = r->origin + dot(q, r->axis) * r->axis + (sign * norm(seen)) * e;
        double off = 0;
        const double v = parameter_of(r->profile, x, off);
        const Vec<2> at{{u, v}};
        const double distance = norm(jet<0>(*s, at.c).value() - p);
        // The half-plane of the profile itself wins, but for a good reason.
        if (distance < least - 1e-7 * (norm(q) + norm(at_profile))) least = distance, best = at;
    }
    return best;
}

std::unique_ptr<Chart::Grid> Chart::make_grid() const {
    std::array<Interval, 2> on = whole_;
    for (std::size_t k = 0; k < 2; ++k)
        if (!std::isfinite(on[k].length())) on[k] = {-8, 8};
    const auto us = samples_of(*s_, 0, on[0]), vs = samples_of(*s_, 1, on[1]);
    auto out = std::make_unique<Grid>(Grid{{}, vs.size()});
    out->samples.reserve(us.size() * vs.size());
    for (const double u : us)
        for (const double v : vs) out->samples.push_back({{{u, v}}, jet<0>(*s_, {u, v}).value()});
    return out;
}

Vec<2> Chart::locate(const Vec<3>& p) const {
    if (const auto at = closed_form(p)) return *at;
    const auto& [grid, columns] = grid_.get([&] { return make_grid(); });
    const auto* e = std::get_if<Extrusion>(s_);
    std::vector<std::pair<double, Vec<2>>> seen;
    for (const Sample& s : grid) {
        Vec<2> at = s.at;
        double d = norm(s.point - p);
        if (e) {  // along the direction of an extrusion the nearest point has a closed form
            const Vec<3> r = p - s.point;
            const double v = dot(r, e->direction) / dot(e->direction, e->direction);
            d = at[1] == grid.front().at[1] ? norm(r - v * e->direction) : kInfinity;
            at[1] += v;
        }
        seen.push_back({d, at});
    }
    // The best few samples, and the best of those that are nearer than those beside them: the turns of a
    // thread may be nearer to each other than samples are.
    std::array<std::pair<double, Vec<2>>, 8> best;
    best.fill({kInfinity, Vec<2>{}});
    const auto keep = [&](std::size_t first, const std::pair<double, Vec<2>>& sample) {
        if (!(sample.first < best[first + 3].first)) return;
        best[first + 3] = sample;
        for (std::size_t k = first + 3; k > first && best[k].first < best[k - 1].first; --k)
            std::swap(best[k], best[k - 1]);
    };
    for (std::size_t i = 0; i < seen.size(); ++i) {
        const auto is_farther = [&](std::size_t k) {
            return k >= seen.size() || !(seen[k].first < seen[i].first);
        };
        const std::size_t along = i % columns;
        keep(0, seen[i]);
        if ((along == 0 || is_farther(i - 1)) && (along + 1 == columns || is_farther(i + 1)) &&
            is_farther(i - columns) && is_farther(i + columns))
            keep(4, seen[i]);
    }
    Foot nearest;
    nearest.distance = kInfinity;
    for (const auto& [d, at] : best) {
        if (!(d < kInfinity)) continue;
        const Foot f = foot(p, {}, at);
        if (f.distance < nearest.distance) nearest = f;
        if (nearest.distance <= 1e-12 * (norm(p) + 1e-300)) break;
    }
    return nearest.at;
}

std::optional<CurveGeometry<3>> Chart::iso(int axis, double at) const {
    if (const auto* e = std::get_if<Extrusion>(s_)) {
        if (axis == 0) return Line<3>{jet<0>(e->profile, wrapped({{at, 0}})[0]).value(), e->direction};
        return moved(e->profile, {{at * e->direction}});
    }
    if (const auto* r = std::get_if<Revolution>(s_)) {
        if (axis == 1) {
            const Vec<3> p = jet<0>(r->profile, wrapped({{0, at}})[1]).value(), d = p - r->origin;
            const Vec<3> along = dot(d, r->axis) * r->axis;
            return Conic<3>{ConicKind::ellipse, r->origin + along, d - along, cross(r->axis, d - along)};
        }
        const auto turned = [&](const Vec<3>& d) {
            const Vec<3> along = dot(d, r->axis) * r->axis, out = d - along;
            return along + std::cos(at) * out + std::sin(at) * cross(r->axis, out);
        };
        return moved(r->profile, {{r->origin - turned(r->origin), turned({{1, 0, 0}}), turned({{0, 1, 0}}),
                                   turned({{0, 0, 1}})}});
    }
    return visit_one(
        [&](const auto& s) -> std::optional<CurveGeometry<3>> {
            if constexpr (requires { s.net(); })
                return freiform::iso(s, axis, wrapped({{at, at}})[axis]);
            else
                return std::nullopt;
        },
        *s_);
}

}  // namespace freiform::step
