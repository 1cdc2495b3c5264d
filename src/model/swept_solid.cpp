// Idea. Each loop becomes a ring of walls, on surfaces that sweep its curves: analytic extrusions or
// revolutions, whose parameters are those of the curve and of the sweep, so that every parameter curve is a
// straight line. The flat faces have the region's own coordinates as parameters; there the loops themselves
// are the parameter curves.
//
//          after ---- far curve ----> next      wall of one curve: u along it and v along the sweep (prism),
//            ^                          ^       or v along it and u the angle (revolution)
//          rail                       rail      rails: the lines, or circular arcs, that vertices sweep
//            |                          |
//          start ---- curve --------> next
//
// Orientation. orient_loops puts the region on the left of each loop. A prism's wall c(u) + v by has the
// normal c' x by; for by upwards that points to the right of c, outwards. A wall of revolution has (axis x r)
// x c', which points to the right of c where the region is on the right of the axis. The other cases are
// reversed.
//
// Parts. Loops of even depth bound a part, with the loops one deeper inside them as holes. Loops do not
// cross, so one point of a hole tells in which: of several that contain it the one next to it has the right
// depth.
//
// Why not splines as walls (make/sweep.hpp): a circle as rational arcs has parameters that are no angles, so
// that the walls' parameter curves would have to be approximated.
#include <freiform/core/constants.hpp>
#include <freiform/model/swept_solid.hpp>
#include <freiform/spline/in_space.hpp>
#include <freiform/trim/loops.hpp>
#include <freiform/trim/trimmed_surface.hpp>

#include <algorithm>
#include <numbers>

namespace freiform {

namespace {

constexpr double kTurn = 2 * std::numbers::pi;

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
    return std::visit(
        [&](const auto& c) -> CurveGeometry<3> {
            if constexpr (requires { c.net(); }) {
                auto s = in_space(c);
                if (motion.angle == 0 && motion.by == Vec<3>{}) return s;
                auto net = s.net();
                for (auto& p : net.flat()) p = motion(p);
                return std::remove_cvref_t<decltype(s)>::trusted(s.bases(), std::move(net));
            } else {
                return Line<3>{};
            }
        },
        curve);
}

Line<2> from_to(Interval on, const Vec<2>& from, const Vec<2>& to) {
    const Vec<2> direction = (1 / on.length()) * (to - from);
    return {from - on.lo * direction, direction};
}

struct Sweep {
    Vec<3> by{};  // of a prism; zero for a revolution
    Vec<3> origin{}, axis{};
    double angle = 0;
    bool reversed = false;  // the sweep goes to the other side of the region's left-hand walls

    bool turns() const { return angle != 0; }
    bool full() const { return angle == kTurn; }
    Motion far() const { return turns() ? Motion{origin, axis, angle, {}} : Motion{{}, {}, 0, by}; }
    Interval range() const { return turns() ? Interval{0, angle} : Interval{0, 1}; }

    CurveGeometry<3> rail(const Vec<3>& p) const {
        if (!turns()) return Line<3>{p, by};
        const Vec<3> along = dot(axis, p - origin) * axis, x = p - origin - along;
        return Conic<3>{ConicKind::ellipse, origin + along, x, cross(axis, x)};
    }
    SurfaceGeometry wall(CurveGeometry<3> profile) const {
        if (!turns()) return Extrusion{std::move(profile), by};
        return Revolution{std::move(profile), origin, axis};
    }
    // In the parameters of a wall: the curve's own parameter t, and s of the sweep.
    Vec<2> at(double t, double s) const { return turns() ? Vec<2>{{s, t}} : Vec<2>{{t, s}}; }
};

class Sweeper {
public:
    Sweeper(const Sweep& sweep, const OrientedLoops& loops, double gap)
        : sweep_(sweep), loops_(loops), gap_(gap) {}

    Result<Model> model() {
        for (const auto& loop : loops_.loops) walls(loop);
        for (std::size_t l = 0; l < loops_.loops.size(); ++l)
            if (loops_.depth[l] % 2 == 0)
                if (auto ok = part(l); !ok) return std::unexpected(ok.error());
        return make_model(std::move(model_));
    }

private:
    struct Ring {  // of one loop: edges of its curves at both ends of the sweep, and its walls
        std::vector<int> near, far, faces;
    };

    int add(Edge edge) {
        model_.edges.push_back(std::move(edge));
        return int(model_.edges.size()) - 1;
    }

    void walls(const std::vector<CurveGeometry<2>>& loop) {
        const Motion far = sweep_.far();
        const int n = int(loop.size()), first = int(model_.vertices.size());
        const int step = sweep_.full() ? 1 : 2;  // vertices for each start of a curve
        Ring ring;
        std::vector<int> rails;
        for (const auto& c : loop) {
            const Vec<3> p = in_space(jet<0>(c, domain(c)[0].lo).value());
            const int v = int(model_.vertices.size());
            model_.vertices.push_back({p, 0});
            if (step == 2) model_.vertices.push_back({far(p), 0});
            rails.push_back(add({sweep_.rail(p), false, sweep_.range(), v, v + step - 1, 0, ""}));
        }
        for (int i = 0; i < n; ++i) {
            const auto& c = loop[std::size_t(i)];
            const int a = first + i * step, b = first + (i + 1) % n * step;
            ring.near.push_back(add({moved(c, {}), false, domain(c)[0], a, b, 0, ""}));
            ring.far.push_back(sweep_.full()
                                   ? ring.near.back()
                                   : add({moved(c, far), false, domain(c)[0], a + 1, b + 1, 0, ""}));
        }
        for (int i = 0; i < n; ++i) {
            const Interval t = domain(loop[std::size_t(i)])[0], s = sweep_.range();
            const auto along = [&](double at_s) {
                return from_to(t, sweep_.at(t.lo, at_s), sweep_.at(t.hi, at_s));
            };
            const auto across = [&](double at_t) {
                return from_to(s, sweep_.at(at_t, s.lo), sweep_.at(at_t, s.hi));
            };
            const std::size_t k = std::size_t(i);
            Loop around{{{ring.near[k], false, along(s.lo)},
                         {rails[(k + 1) % rails.size()], false, across(t.hi)},
                         {ring.far[k], true, along(s.hi)},
                         {rails[k], true, across(t.lo)}}};
            if (sweep_.turns()) {  // (s, t) are (u, v): the same way round is the other way
                std::ranges::reverse(around.coedges);
                for (Coedge& e : around.coedges) e.reversed = !e.reversed;
            }
            Face face;
            face.surface = sweep_.wall(moved(loop[k], {}));
            face.reversed = sweep_.reversed;
            face.loops = {std::move(around)};
            ring.faces.push_back(int(model_.faces.size()));
            model_.faces.push_back(std::move(face));
        }
        rings_.push_back(std::move(ring));
    }

    // A flat face over the loops, at the near or the far end.
    int cap(const std::vector<std::size_t>& loops, bool at_far) {
        const Motion far = sweep_.far();
        const Vec<3> x{{1, 0, 0}}, y{{0, 1, 0}};
        Face face;
        face.surface =
            at_far ? Extrusion{Line<3>{far(Vec<3>{}), far.turned(x)}, far.turned(y), SurfaceKind::plane}
                   : Extrusion{Line<3>{{}, x}, y, SurfaceKind::plane};
        // Upwards is outwards at the far end of a prism, and at the near end of a turn to the right of the
        // axis.
        face.reversed = (at_far == sweep_.turns()) != sweep_.reversed;
        for (const std::size_t l : loops) {
            Loop around;
            for (std::size_t i = 0; i < loops_.loops[l].size(); ++i)
                around.coedges.push_back(
                    {(at_far ? rings_[l].far : rings_[l].near)[i], false, loops_.loops[l][i]});
            face.loops.push_back(std::move(around));
        }
        model_.faces.push_back(std::move(face));
        return int(model_.faces.size()) - 1;
    }

    int shell(const std::vector<std::size_t>& loops, std::initializer_list<int> caps) {
        Shell s;
        s.closed = true;
        for (const std::size_t l : loops)
            for (const int f : rings_[l].faces) s.faces.push_back({f, false});
        for (const int f : caps) s.faces.push_back({f, false});
        model_.shells.push_back(std::move(s));
        return int(model_.shells.size()) - 1;
    }

    Result<void> part(std::size_t outer) {
        const auto inside = InsideQuery::make(std::span(&loops_.loops[outer], 1), gap_);
        if (!inside) return std::unexpected(inside.error());
        std::vector<std::size_t> loops{outer};
        for (std::size_t l = 0; l < loops_.loops.size(); ++l) {
            if (loops_.depth[l] != loops_.depth[outer] + 1) continue;
            const CurveGeometry<2>& c = loops_.loops[l][0];
            if (inside->at(jet<0>(c, domain(c)[0].middle()).value()).place == Place::inside)
                loops.push_back(l);
        }
        Body body;
        body.solid = true;
        if (sweep_.full())
            for (const std::size_t l : loops) body.shells.push_back(shell({l}, {}));
        else
            body.shells = {shell(loops, {cap(loops, false), cap(loops, true)})};
        model_.bodies.push_back(std::move(body));
        return {};
    }

    Sweep sweep_;
    const OrientedLoops& loops_;
    double gap_;
    std::vector<Ring> rings_;
    Model model_;
};

// Of all control points. Refuses curves that are no splines.
template <class F>
Result<void> each_point(const RegionLoops& region, F&& f) {
    for (std::size_t l = 0; l < region.size(); ++l)
        for (std::size_t c = 0; c < region[l].size(); ++c) {
            const bool spline = std::visit(
                [&](const auto& curve) {
                    if constexpr (requires { curve.net(); }) {
                        for (const auto& p : curve.net().flat()) f(project(p));
                        return true;
                    }
                    return false;
                },
                region[l][c]);
            if (!spline)
                return refuse(RefusalKind::unsupported, text("loops[", l, "][", c, "]"),
                              "is no spline; write ellipses as rational ones");
        }
    return {};
}

Result<Model> swept(const RegionLoops& region, const Sweep& sweep) {
    Box<2> box;
    if (auto ok = each_point(region, [&](const Vec<2>& p) { box.add(p); }); !ok)
        return std::unexpected(ok.error());
    if (box.is_empty()) return refuse(RefusalKind::no_answer, "loops", "there is no region");
    const double gap = TrimmedSurface::kSlack * box.diagonal();
    const auto loops = orient_loops(region, {gap, gap});
    if (!loops) return std::unexpected(loops.error());
    return Sweeper(sweep, *loops, gap).model();
}

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
    return swept(region, sweep);
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
    // Twice the area of the triangle of axis and point; its rounding is far below what is taken for touching.
    double least = kInfinity, most = -kInfinity, reach = 0;
    const auto side = [&](const Vec<2>& p) {
        const Vec<2> d{{p[0] - axis.origin[0], p[1] - axis.origin[1]}};
        const double s = d[0] * sweep.axis[1] - d[1] * sweep.axis[0];
        least = std::min(least, s), most = std::max(most, s), reach = std::max(reach, max_abs(d));
    };
    if (auto ok = each_point(region, side); !ok) return std::unexpected(ok.error());
    const double touches = TrimmedSurface::kSlack * reach;
    if (!(least > touches || most < -touches))
        return refuse(RefusalKind::unsupported, "axis",
                      text("the region reaches the axis: its control points are from ", least, " to ", most,
                           " to the right of it"));
    sweep.reversed = most < 0;
    return swept(region, sweep);
}

}  // namespace freiform
