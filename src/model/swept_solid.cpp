// Prisms and solids of revolution: walls are analytic extrusions or revolutions. region_sweep.cpp puts them
// together.
//
// Lines and arcs of circles are edges by their lengths and angles, and their walls planes, cylinders, cones,
// spheres and tori, as other programs know them; arcs that follow each other on one circle are one edge.
//
// Why not splines as walls (make/sweep.hpp): a circle as rational arcs has parameters that are no angles, so
// that the walls' parameter curves would have to be approximated.
#include "elementary_curve_detail.hpp"
#include "region_sweep_detail.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/core/visit.hpp>
#include <freiform/make/revolve.hpp>
#include <freiform/spline/in_space.hpp>
#include <freiform/trim/trimmed_surface.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace freiform {

namespace {

constexpr double kTurn = 2 * std::numbers::pi;
constexpr double kLevel = 0x1p-44;  // of a direction: across the axis

Curve<Vec<2>> bezier(std::span<const Vec<2>> points) {
    return Curve<Vec<2>>::trusted({*BSplineBasis::bezier(int(points.size()) - 1)},
                                  Net<1, Vec<2>>({int(points.size())}, {points.begin(), points.end()}));
}

CurveGeometry<2> geometry_of(const PathSegment& s) {
    const std::span<const Vec<2>> points(s.points.data(), std::size_t(s.degree) + 1);
    if (s.degree != 2 || s.weight == 1) return bezier(points);
    return Curve<Hom<2>>::trusted(
        {*BSplineBasis::bezier(2)},
        Net<1, Hom<2>>({3},
                       {weighted(points[0], 1.0), weighted(points[1], s.weight), weighted(points[2], 1.0)}));
}

// x -> turn(x) + offset in space.
struct Motion {
    Vec<3> origin{}, axis{};  // turned about this by `angle`
    double angle = 0;
    Vec<3> by{};

    Vec<3> turned(const Vec<3>& d) const {
        if (angle == 0) return d;
        const Vec<3> along = dot(axis, d) * axis;
        return along + std::cos(angle) * (d - along) + std::sin(angle) * cross(axis, d);
    }
    Vec<3> operator()(const Vec<3>& p) const {
        return angle == 0 ? p + by : origin + turned(p - origin) + by;
    }
    Hom<3> operator()(const Hom<3>& p) const { return weighted((*this)(project(p)), p.weight()); }
};

CurveGeometry<3> moved(const CurveGeometry<2>& curve, const Motion& motion) {
    return visit_one(
        [&](const auto& c) -> CurveGeometry<3> {
            if constexpr (requires { c.net(); }) {
                auto s = in_space(c);
                if (motion.angle == 0 && motion.by == Vec<3>{}) return s;
                auto net = s.net();
                for (auto& p : net.flat()) p = motion(p);
                return std::remove_cvref_t<decltype(s)>::trusted(s.bases(), std::move(net));
            } else if constexpr (requires { c.direction; }) {
                return Line<3>{motion(in_space(c.origin)), motion.turned(in_space(c.direction))};
            } else {
                return Conic<3>{c.kind, motion(in_space(c.centre)), motion.turned(in_space(c.x)),
                                motion.turned(in_space(c.y))};
            }
        },
        curve);
}

struct Sweep {
    Vec<3> by{};  // of a prism; zero for a revolution
    Vec<3> origin{}, axis{};
    double angle = 0;
    bool reversed = false;  // the sweep goes to the other side of the region's left-hand walls
    double touches = 0;     // nothing: points no farther from the axis are on it

    bool turns() const { return angle != 0; }
    bool full() const { return angle == kTurn; }
    // How far p is to the right of the axis.
    double beside_axis(const Vec<2>& p) const {
        return (p[0] - origin[0]) * axis[1] - (p[1] - origin[1]) * axis[0];
    }
    std::optional<double> on_axis(const Vec<2>& p) const {
        if (!(std::abs(beside_axis(p)) <= touches)) return std::nullopt;
        const double along = (p[0] - origin[0]) * axis[0] + (p[1] - origin[1]) * axis[1];
        return reversed ? -along : along;
    }
    Motion far() const { return turns() ? Motion{origin, axis, angle, {}} : Motion{{}, {}, 0, by}; }
    Interval range() const { return {0, turns() ? angle : norm(by)}; }
    Vec<3> up() const { return turns() ? axis : unit(by); }

    CurveGeometry<3> rail(const Vec<3>& p) const {
        if (!turns()) return Line<3>{p, up()};
        const Vec<3> along = dot(axis, p - origin) * axis, x = p - origin - along;
        return Conic<3>{ConicKind::ellipse, origin + along, x, cross(axis, x)};
    }
    SurfaceKind turned_kind(const Vec<2>& centre, double radius) const {
        const double out = std::abs(beside_axis(centre));
        if (out <= touches) return SurfaceKind::sphere;
        return out - radius > touches ? SurfaceKind::torus : SurfaceKind::general;
    }
    // Of lines and circles elementary surfaces, if they run the way that these have.
    SurfaceGeometry wall(CurveGeometry<3> profile) const {
        const auto* line = std::get_if<Line<3>>(&profile);
        const auto* circle = std::get_if<Conic<3>>(&profile);
        SurfaceKind kind = SurfaceKind::general;
        if (!turns()) {
            if (line) kind = SurfaceKind::plane;
            if (circle && by[0] == 0 && by[1] == 0) kind = SurfaceKind::cylinder;
            return Extrusion{std::move(profile), up(), kind};
        }
        if (line) kind = SurfaceKind::cone;
        if (circle) kind = turned_kind({{circle->centre[0], circle->centre[1]}}, norm(circle->x));
        SurfaceGeometry made = revolution(std::move(profile), origin, axis);
        if (auto* r = std::get_if<Revolution>(&made)) r->kind = kind;
        return made;
    }

    bool is_level(const detail::PlaneLine& l) const {
        const Vec<2> way = unit(l.end - l.start);
        return turns() && std::abs(way[0] * axis[0] + way[1] * axis[1]) <= kLevel;
    }

    // Lines run upwards, or outwards where they are level, circles counter-clockwise seen from above, or from
    // the axis outwards and upwards.
    using Flat = detail::SweptCurve::Flat;
    Flat flat_of(const detail::PlaneLine& l) const {
        const Vec<2> way = unit(l.end - l.start);
        const bool against = is_level(l) ? std::abs(beside_axis(l.end)) < std::abs(beside_axis(l.start))
                                         : turns() && way[0] * axis[0] + way[1] * axis[1] < 0;
        return {Line<2>{against ? l.end : l.start, against ? -1.0 * way : way},
                {0, norm(l.end - l.start)},
                against};
    }
    Flat flat_of(const detail::PlaneArc& a) const {
        const double whole = std::abs(a.sweep);
        if (!turns()) {
            const bool against = (a.sweep < 0) != (by[2] < 0);
            const Vec<2> x = (against ? a.end : a.start) - a.centre, y{{-x[1], x[0]}};
            return {Conic<2>{ConicKind::ellipse, a.centre, x, by[2] < 0 ? -1.0 * y : y}, {0, whole}, against};
        }
        const Vec<2> y{{a.radius * axis[0], a.radius * axis[1]}}, right{{y[1], -y[0]}},
            x = reversed ? -1.0 * right : right;
        const bool against = (a.sweep < 0) != reversed;  // x to y is counter-clockwise, unless on the left
        const Vec<2> first = (against ? a.end : a.start) - a.centre;
        const double from = std::atan2(dot(first, y), dot(first, x));
        return {Conic<2>{ConicKind::ellipse, a.centre, x, y}, {from, from + whole}, against};
    }
    detail::SweptCurve curve(const CurveGeometry<2>& c) const {
        const Vec<3> p = in_space(jet<0>(c, domain(c)[0].lo).value());
        auto elementary = detail::elementary_of(c);
        // Arcs whose circles cross the axis are splines: what they sweep ends in the poles, and readers know.
        if (const auto* arc = std::get_if<detail::PlaneArc>(&elementary);
            arc && turns() && turned_kind(arc->centre, arc->radius) == SurfaceKind::general)
            elementary = {};
        const Flat flat = visit_one(
            [&](const auto& e) {
                if constexpr (requires { flat_of(e); })
                    return flat_of(e);
                else
                    return Flat{c, domain(c)[0]};
            },
            elementary);
        detail::SweptCurve out{wall(moved(flat.curve, {})),
                               moved(flat.curve, {}),
                               moved(flat.curve, far()),
                               rail(p),
                               p,
                               far()(p),
                               0,
                               flat};
        if (const auto* l = std::get_if<detail::PlaneLine>(&elementary); l && is_level(*l)) {
            const Vec<3> from = in_space(l->start) - origin, along = dot(axis, from) * axis,
                         way = in_space(std::get<Line<2>>(flat.curve).direction);
            out.wall = Extrusion{Line<3>{origin + along, way}, cross(axis, way), SurfaceKind::plane};
            const double a = std::abs(beside_axis(l->start)), b = std::abs(beside_axis(l->end));
            out.level = {std::min(a, b), std::max(a, b)};
        }
        return out;
    }
    SurfaceGeometry cap(bool at_far) const {
        const Vec<3> x{{1, 0, 0}}, y{{0, 1, 0}};
        return at_far
                   ? Extrusion{Line<3>{far()(Vec<3>{}), far().turned(x)}, far().turned(y), SurfaceKind::plane}
                   : Extrusion{Line<3>{{}, x}, y, SurfaceKind::plane};
    }
    Result<Model> of(const RegionLoops& region) const {
        detail::RegionSweep how{[this](const CurveGeometry<2>& c) { return curve(c); },
                                [this](bool at_far) { return cap(at_far); },
                                range(),
                                turns(),
                                full(),
                                reversed};
        if (turns()) how.on_axis = [this](const Vec<2>& p) { return on_axis(p); };
        RegionLoops loops;
        for (const auto& loop : region)
            loops.push_back(
                detail::with_joined_arcs(loop, [&](const Vec<2>& p) { return turns() && on_axis(p); }));
        return detail::sweep_region(loops, how);
    }
};

bool is_finite(const Vec<3>& v) { return std::isfinite(v[0]) && std::isfinite(v[1]) && std::isfinite(v[2]); }

}  // namespace

RegionLoops loops_of(const Path& path) {
    RegionLoops out;
    for (const Subpath& s : path.subpaths) {
        std::vector<CurveGeometry<2>> loop;
        const auto add = [&](const PathSegment& segment) {
            for (int i = 1; i <= segment.degree; ++i)
                if (segment.points[std::size_t(i)] != segment.front())
                    return loop.push_back(geometry_of(segment));
        };
        for (const PathSegment& segment : s.segments) add(segment);
        if (!s.segments.empty() && s.segments.back().back() != s.start)
            add({1, {s.segments.back().back(), s.start}, 1});
        if (!loop.empty()) out.push_back(std::move(loop));
    }
    return out;
}

Result<Model> prism(const RegionLoops& region, const Vec<3>& by) {
    if (!is_finite(by) || by[2] == 0)
        return refuse(
            RefusalKind::invalid, "by",
            text("a vector that leaves the plane z = 0, not (", by[0], ", ", by[1], ", ", by[2], ")"));
    Sweep sweep;
    sweep.by = by, sweep.reversed = by[2] < 0;
    return sweep.of(region);
}

Result<Model> solid_of_revolution(const RegionLoops& region, const Axis& axis, double angle) {
    const double length = norm(axis.direction);
    if (!is_finite(axis.origin) || !is_finite(axis.direction) || axis.origin[2] != 0 ||
        axis.direction[2] != 0 || !(length > 0))
        return refuse(RefusalKind::invalid, "axis", "a point and a direction in the plane z = 0");
    if (!(angle > 0 && angle <= kTurn))
        return refuse(RefusalKind::invalid, "angle",
                      text("more than 0 and at most ", kTurn, ", not ", angle));
    Sweep sweep;
    sweep.origin = axis.origin, sweep.axis = (1 / length) * axis.direction, sweep.angle = angle;
    double reach = 0;
    const auto from_axis = [&](const Vec<2>& p) {
        return Vec<2>{{p[0] - axis.origin[0], p[1] - axis.origin[1]}};
    };
    if (auto ok = detail::each_point(
            region, [&](const Vec<2>& p) { reach = std::max(reach, max_abs(from_axis(p))); });
        !ok)
        return std::unexpected(ok.error());
    // Twice the area of the triangle of axis and point; its rounding is far below what is taken for touching.
    sweep.touches = TrimmedSurface::kSlack * reach;
    double least = kInfinity, most = -kInfinity;  // of what is not on the axis
    for (std::size_t l = 0; l < region.size(); ++l)
        for (std::size_t c = 0; c < region[l].size(); ++c) {
            const auto net = detail::spline_of(region[l][c]).net;
            int on_axis = 0, ends = 0;
            for (std::size_t i = 0; i < net.size(); ++i) {
                const double s = sweep.beside_axis(project(net[i]));
                if (std::abs(s) <= sweep.touches)
                    ++on_axis, ends += i == 0 || i + 1 == net.size();
                else
                    least = std::min(least, s), most = std::max(most, s);
            }
            if (on_axis > ends && on_axis < int(net.size()))
                return refuse(RefusalKind::unsupported, text("loops[", l, "][", c, "]"),
                              "has control points on the axis between its ends; cut it there");
        }
    if (least < 0 && most > 0)
        return refuse(RefusalKind::unsupported, "axis",
                      text("the region is on both sides of the axis: its control points are from ", least,
                           " to ", most, " to the right of it"));
    if (!(least <= most)) return refuse(RefusalKind::no_answer, "loops", "all of the region is on the axis");
    sweep.reversed = most < 0;
    return sweep.of(region);
}

}  // namespace freiform
