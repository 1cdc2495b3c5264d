// Curves and surfaces in another place; reversed curves; parameters of points.
//
// Parameters stay what they are: directions of lines and extrusions scale along, so that every parameter
// curve of a face fits the moved face, too. A mirror turns the other way about a mirrored axis; the axis of a
// revolution is mirrored and reversed.
#include "step_geometry.hpp"
#include "step_trace.hpp"

#include <freiform/core/visit.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace freiform::step {

bool Motion::is_identity() const {
    return scale == 1 && to.o == Vec<3>{} && to.x == Vec<3>{{1, 0, 0}} && to.y == Vec<3>{{0, 1, 0}} &&
           to.z == Vec<3>{{0, 0, 1}};
}

Motion operator*(const Motion& a, const Motion& b) {
    Motion m;
    m.to.o = a.point(b.to.o);
    m.to.x = a.turned(b.to.x), m.to.y = a.turned(b.to.y), m.to.z = a.turned(b.to.z);
    m.scale = a.scale * b.scale;
    m.mirrored = a.mirrored != b.mirrored;
    return m;
}

Motion motion_to(const Placement& p) { return {p, 1, dot(cross(p.x, p.y), p.z) < 0}; }

Motion motion_from(const Placement& p) {
    Motion m;
    m.to.x = {{p.x[0], p.y[0], p.z[0]}};
    m.to.y = {{p.x[1], p.y[1], p.z[1]}};
    m.to.z = {{p.x[2], p.y[2], p.z[2]}};
    m.to.o = -m.turned(p.o);
    m.mirrored = dot(cross(p.x, p.y), p.z) < 0;
    return m;
}

namespace {

template <std::size_t N, class P>
Patch<N, P> moved_patch(const Patch<N, P>& s, const Motion& by) {
    Net<N, P> net = s.net();
    for (P& p : net.flat()) {
        if constexpr (Space<P>::kRational) {
            const Vec<3> x = by.direction({{p[0], p[1], p[2]}}) + p.weight() * by.to.o;
            p = P{{x[0], x[1], x[2], p.weight()}};
        } else {
            p = by.point(p);
        }
    }
    return Patch<N, P>::trusted(s.bases(), std::move(net));
}

}  // namespace

CurveGeometry<3> moved(const CurveGeometry<3>& curve, const Motion& by) {
    return visit_one(
        [&](const auto& c) -> CurveGeometry<3> {
            using C = std::remove_cvref_t<decltype(c)>;
            if constexpr (std::same_as<C, Line<3>>)
                return Line<3>{by.point(c.origin), by.direction(c.direction)};
            else if constexpr (std::same_as<C, Conic<3>>)
                return Conic<3>{c.kind, by.point(c.centre), by.direction(c.x), by.direction(c.y)};
            else
                return moved_patch(c, by);
        },
        curve);
}

SurfaceGeometry moved(const SurfaceGeometry& surface, const Motion& by) {
    if (const auto* s = std::get_if<Extrusion>(&surface))
        return Extrusion{moved(s->profile, by), by.direction(s->direction), s->kind};
    if (const auto* s = std::get_if<Revolution>(&surface))
        return Revolution{moved(s->profile, by), by.point(s->origin),
                          by.mirrored ? -by.turned(s->axis) : by.turned(s->axis), s->kind};
    if (const auto* s = std::get_if<OffsetSurface>(&surface))
        return OffsetSurface{std::make_shared<const SurfaceGeometry>(moved(*s->base, by)),
                             (by.mirrored ? -by.scale : by.scale) * s->distance};
    if (const auto* s = std::get_if<Surface<Vec<3>>>(&surface)) return moved_patch(*s, by);
    return moved_patch(std::get<Surface<Hom<3>>>(surface), by);
}

CurveGeometry<3> reversed(const CurveGeometry<3>& curve) {
    return visit_one(
        [](const auto& c) -> CurveGeometry<3> {
            using C = std::remove_cvref_t<decltype(c)>;
            if constexpr (std::same_as<C, Line<3>>)
                return Line<3>{c.origin, -c.direction};
            else if constexpr (std::same_as<C, Conic<3>>)
                return Conic<3>{c.kind, c.centre, c.x, -c.y};
            else
                return reverse(c, 0);
        },
        curve);
}

namespace {

double on_conic(const Conic<3>& c, const Vec<3>& p) {
    // Coordinates in the plane of the conic, whose axes need not be orthogonal.
    const Vec<3> d = p - c.centre;
    const double xx = dot(c.x, c.x), xy = dot(c.x, c.y), yy = dot(c.y, c.y), det = xx * yy - xy * xy;
    if (!(det > 0)) return 0;
    const double px = dot(d, c.x), py = dot(d, c.y);
    const double a = (px * yy - py * xy) / det, b = (py * xx - px * xy) / det;
    return c.kind == ConicKind::ellipse     ? std::atan2(b, a)
           : c.kind == ConicKind::hyperbola ? std::asinh(b)
                                            : b;
}

// Newton's method from the best few of some samples that are nearer than their neighbours: where a curve
// comes near itself, the nearest sample may belong to the other part. From the other end, too, where an end
// is nearest: of a closed curve that may be the side on which p is.
template <class C>
double on_spline(const C& c, const Vec<3>& p) {
    const std::vector<double> breaks = c.basis().breaks();
    const int each = std::clamp(2000 / int(breaks.size()), 1, 4 + 2 * c.basis().degree());
    std::vector<double> at, off;
    for (std::size_t i = 0; i < breaks.size(); ++i)
        for (int k = 0; k < (i + 1 < breaks.size() ? each : 1); ++k) {
            at.push_back(k == 0 ? breaks[i] : breaks[i] + (breaks[i + 1] - breaks[i]) * k / each);
            off.push_back(norm(c(at.back()) - p));
        }
    std::array<std::size_t, 3> starts{};  // nearest first
    std::size_t found = 0;
    for (std::size_t i = 0; i < at.size(); ++i) {
        if ((i > 0 && off[i - 1] < off[i]) || (i + 1 < at.size() && off[i + 1] <= off[i])) continue;
        std::size_t k = std::min(found, starts.size() - 1);
        if (found == starts.size() && !(off[i] < off[starts[k]])) continue;
        found = std::min(found + 1, starts.size());
        for (; k > 0 && off[i] < off[starts[k - 1]]; --k) starts[k] = starts[k - 1];
        starts[k] = i;
    }
    double best = at[starts[0]], least = off[starts[0]];
    const Interval on = c.domain()[0];
    const auto from = [&](double t) {
        for (int i = 0; i < 20; ++i) {
            const auto j = c.template jet<2>(t);
            const Vec<3> r = j.d[0] - p;
            const double slope = dot(r, j.d[1]), full = dot(j.d[1], j.d[1]) + dot(r, j.d[2]),
                         simple = dot(j.d[1], j.d[1]);
            const double by = full > 0.1 * simple ? full : simple;
            if (!(by > 0)) break;
            const double next = clamped(t - slope / by, on);
            if (next == t) break;
            t = next;
            if (const double d = norm(c(t) - p); d < least) least = d, best = t;
        }
    };
    for (std::size_t k = 0; k < found; ++k) from(at[starts[k]]);
    if (best == on.lo || best == on.hi) from(best == on.lo ? on.hi : on.lo);
    return best;
}

}  // namespace

double parameter_of(const CurveGeometry<3>& curve, const Vec<3>& p, double& distance) {
    const double t = visit_one(
        [&](const auto& c) {
            using C = std::remove_cvref_t<decltype(c)>;
            if constexpr (std::same_as<C, Line<3>>)
                return dot(p - c.origin, c.direction) / dot(c.direction, c.direction);
            else if constexpr (std::same_as<C, Conic<3>>)
                return on_conic(c, p);
            else
                return on_spline(c, p);
        },
        curve);
    distance = norm(jet<0>(curve, t).value() - p);
    return t;
}

}  // namespace freiform::step
