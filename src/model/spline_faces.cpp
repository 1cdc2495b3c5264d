// Idea. A rational quadratic arc runs through its angle unevenly: with the half angle h of a piece, the angle
// a from its start is reached where tan(a / 2) = t sin h / (1 - t + t cos h), so at
//
//     t = tan(a / 2) / (sin h + tan(a / 2) (1 - cos h)).
//
// Parameter lines stay parameter lines under this map of one axis; what else runs across the angle has no
// rational image. Axes that are not angles keep their parameters, and so do curves on surfaces of two such.
//
// Where a tolerance is given, a loop that crosses the angle is followed by Hermite's cubics c through places
// of the image q(t) = (map(p(t))), with its slopes, between breaks of p and the joints of arcs; more of them
// until it is proven (edge_gap) that the written surface along c is no farther from the edge than the given
// one along p is proven to be, and the tolerance. Errors fall with the fourth power of the steps. Neighbours
// follow the same edge.
//
// Cost: linear in the control points; a proof for each loop that is followed.
// Why not always: the numbers of other loops are exact, and without a tolerance nothing says how near is
// enough.
#include <freiform/core/constants.hpp>
#include <freiform/core/sort.hpp>
#include <freiform/core/visit.hpp>
#include <freiform/make/conic.hpp>
#include <freiform/make/image_curve.hpp>
#include <freiform/make/revolve.hpp>
#include <freiform/model/edge_gap.hpp>
#include <freiform/model/spline_faces.hpp>
#include <freiform/spline/in_space.hpp>

#include <algorithm>
#include <cmath>

namespace freiform {

namespace {

using SplineSurface = std::variant<Surface<Vec<3>>, Surface<Hom<3>>>;

// Where a parameter of the face is in the spline: at itself, or an angle among arcs of equal angle.
struct AxisMap {
    Interval on{};
    int arcs = 0;  // 0: at itself

    double operator()(double u) const {
        if (arcs == 0) return u;
        const double step = on.length() / arcs;
        const int k = std::clamp(int((u - on.lo) / step), 0, arcs - 1);
        const double half = step / 2, tan = std::tan((u - on.lo - k * step) / 2);
        const double t = tan / (std::sin(half) + tan * (1 - std::cos(half)));
        return (k + std::clamp(t, 0.0, 1.0)) / arcs;
    }
    // Continuous: arcs meet with equal speed.
    double slope(double u) const {
        if (arcs == 0) return 1;
        const double step = on.length() / arcs;
        const int k = std::clamp(int((u - on.lo) / step), 0, arcs - 1);
        const double half = step / 2, tan = std::tan((u - on.lo - k * step) / 2);
        const double down = std::sin(half) + tan * (1 - std::cos(half));
        return (1 + tan * tan) * std::sin(half) / (2 * down * down) / arcs;
    }
};

int spans_of(const BSplineBasis& basis) { return int(basis.breaks().size()) - 1; }

struct MappedSurface {
    SplineSurface surface;
    std::array<AxisMap, 2> map;
};

struct MappedCurve {
    CurveGeometry<3> curve;
    AxisMap map;
};

// A profile over what is used of it.
Result<MappedCurve> profile_of(const CurveGeometry<3>& given, Interval used) {
    const auto* conic = std::get_if<Conic<3>>(&given);
    if (conic && conic->kind == ConicKind::hyperbola)
        return refuse(RefusalKind::unsupported, "", "a surface of a hyperbola");
    const bool spline = !conic && !std::holds_alternative<Line<3>>(given);
    auto curve = space_spline(given, spline ? domain(given)[0] : used);
    if (!curve) return std::unexpected(curve.error());
    if (!conic) return MappedCurve{*std::move(curve), {}};
    auto& arc = std::get<Curve<Hom<3>>>(*curve);
    if (conic->kind == ConicKind::ellipse) return MappedCurve{arc, {used, spans_of(arc.basis())}};
    const auto basis = BSplineBasis::bezier(2, used);  // a parabola has one piece, linear in its parameter
    if (!basis) return std::unexpected(basis.error());
    return MappedCurve{Curve<Hom<3>>::trusted({*basis}, arc.net()), {}};
}

template <class F>
Result<MappedSurface> with_spline(const CurveGeometry<3>& curve, F&& f) {
    return visit_one(
        [&](const auto& c) -> Result<MappedSurface> {
            if constexpr (requires { c.net(); })
                return f(c);
            else
                return refuse(RefusalKind::unsupported, "", "a curve that is no spline");
        },
        curve);
}

Result<MappedSurface> spline_of(const Extrusion& s, const Box<2>& used) {
    const auto profile = profile_of(s.profile, used.side(0));
    if (!profile) return std::unexpected(profile.error());
    return with_spline(profile->curve, [&]<class P>(const Curve<P>& c) -> Result<MappedSurface> {
        std::vector<P> points;
        for (const P& p : c.net().flat())
            for (const double v : {used.lo[1], used.hi[1]})
                if constexpr (Space<P>::kRational)
                    points.push_back(weighted(project(p) + v * s.direction, p.weight()));
                else
                    points.push_back(p + v * s.direction);
        const auto across = BSplineBasis::bezier(1, used.side(1));
        if (!across) return std::unexpected(across.error());
        auto made = Surface<P>::make({c.basis(), *across}, Net<2, P>({int(points.size()) / 2, 2}, points));
        if (!made) return std::unexpected(made.error());
        return MappedSurface{*std::move(made), {profile->map, {}}};
    });
}

Vec<3> turned_about(const Vec<3>& axis, double angle, const Vec<3>& v) {
    return std::cos(angle) * v + std::sin(angle) * cross(axis, v) +
           (dot(axis, v) * (1 - std::cos(angle))) * axis;
}

Result<MappedSurface> spline_of(const Revolution& s, const Box<2>& used) {
    const auto profile = profile_of(s.profile, used.side(1));
    if (!profile) return std::unexpected(profile.error());
    const Interval u = used.side(0);
    return with_spline(profile->curve, [&]<class P>(const Curve<P>& c) -> Result<MappedSurface> {
        std::vector<P> points;
        for (const P& p : c.net().flat()) {
            const Vec<3> at =
                u.lo == 0 ? project(p) : s.origin + turned_about(s.axis, u.lo, project(p) - s.origin);
            if constexpr (Space<P>::kRational)
                points.push_back(weighted(at, p.weight()));
            else
                points.push_back(at);
        }
        const auto start = Curve<P>::trusted(c.bases(), Net<1, P>({int(points.size())}, points));
        auto made = revolve(start, Axis{s.origin, s.axis}, std::min(u.length(), kTwoPi), Seam::open);
        if (!made) return std::unexpected(made.error());
        const AxisMap angle{u, spans_of(made->surface.basis(0))};
        return MappedSurface{std::move(made->surface), {angle, profile->map}};
    });
}

Result<MappedSurface> spline_of(const OffsetSurface&, const Box<2>&) {
    return refuse(RefusalKind::unsupported, "", "an offset surface");
}
template <class P>
Result<MappedSurface> spline_of(const Surface<P>& s, const Box<2>&) {
    return MappedSurface{s, {}};
}

// The curve where the spline has it.
Result<CurveGeometry<2>> mapped(const CurveGeometry<2>& curve, const std::array<AxisMap, 2>& map) {
    if (map[0].arcs == 0 && map[1].arcs == 0) return curve;
    return visit_one(
        [&](const auto& c) -> Result<CurveGeometry<2>> {
            if constexpr (requires { c.net(); }) {
                const Vec<2> from = project(c.net().flat().front()), to = project(c.net().flat().back());
                bool along[2] = {true, true};
                for (const auto& p : c.net().flat())
                    for (int i = 0; i < 2; ++i)
                        along[i] =
                            along[i] && std::abs(project(p)[i] - from[i]) <= 0x1p-40 * max_abs(to - from);
                if (along[0] || along[1]) {
                    const auto at = [&](const Vec<2>& p) { return Vec<2>{{map[0](p[0]), map[1](p[1])}}; };
                    return Curve<Vec<2>>::trusted({*BSplineBasis::bezier(1)},
                                                  Net<1, Vec<2>>({2}, {at(from), at(to)}));
                }
            }
            return refuse(
                RefusalKind::unsupported, "",
                "a loop that crosses the angle of a surface of revolution or of a conic has no rational "
                "image, only one within a tolerance; STEP and IGES files keep it");
        },
        curve);
}

constexpr int kPlacesBetween = 16;  // where joints of arcs are looked for
constexpr int kMostCubics = 4096;   // a backstop

// The ends of the range, breaks of the curve, and where it crosses the joints of arcs.
std::vector<double> steps_of(const CurveGeometry<2>& curve, Interval on, const std::array<AxisMap, 2>& map) {
    std::vector<double> t{on.lo, on.hi};
    visit_one(
        [&](const auto& c) {
            if constexpr (requires { c.net(); })
                for (const double b : c.basis().breaks())
                    if (on.lo < b && b < on.hi) t.push_back(b);
        },
        curve);
    sort(t.begin(), t.end());
    std::vector<double> joints;
    for (int axis = 0; axis < 2; ++axis)
        for (int k = 1; k < map[std::size_t(axis)].arcs; ++k) {
            const AxisMap& m = map[std::size_t(axis)];
            const double joint = m.on.lo + m.on.length() * k / m.arcs;
            const auto beyond = [&](double at) { return jet<0>(curve, at).value()[axis] > joint; };
            for (std::size_t i = 0; i + 1 < t.size(); ++i)
                for (int j = 0; j < kPlacesBetween; ++j) {
                    const double step = (t[i + 1] - t[i]) / kPlacesBetween;
                    Interval within{t[i] + j * step, t[i] + (j + 1) * step};
                    const bool before = beyond(within.lo);
                    if (before == beyond(within.hi)) continue;
                    for (int halving = 0; halving < 50; ++halving)
                        (beyond(within.middle()) == before ? within.lo : within.hi) = within.middle();
                    joints.push_back(within.middle());
                }
        }
    t.insert(t.end(), joints.begin(), joints.end());
    sort(t.begin(), t.end());
    const double same = 0x1p-30 * on.length();
    std::erase_if(t, [&, last = -kInfinity](double x) mutable {
        const bool again = x - last <= same && x < on.hi;
        if (!again) last = x;
        return again;
    });
    return t;
}

// Hermite's cubics of the image over `parts` parts of every step.
CurveGeometry<2> cubics_along(const CurveGeometry<2>& curve, const std::array<AxisMap, 2>& map,
                              const std::vector<double>& steps, int parts) {
    const auto at = [&](double t, bool before, Interval on) {
        const auto j = jet<1>(curve, before ? clamped(std::nextafter(t, -kInfinity), on) : t);
        const Vec<2> p = j(0), d = j(1);
        return std::pair{Vec<2>{{map[0](p[0]), map[1](p[1])}},
                         Vec<2>{{map[0].slope(p[0]) * d[0], map[1].slope(p[1]) * d[1]}}};
    };
    std::vector<double> knots{steps.front()};
    std::vector<Vec<2>> net;
    for (std::size_t i = 0; i + 1 < steps.size(); ++i)
        for (int k = 0; k < parts; ++k) {
            const double width = (steps[i + 1] - steps[i]) / parts;
            const double lo = steps[i] + k * width, hi = k + 1 == parts ? steps[i + 1] : lo + width;
            const auto [p, dp] = at(lo, false, {lo, hi});
            const auto [q, dq] = at(hi, true, {lo, hi});
            if (net.empty()) net.push_back(p);
            net.push_back(net.back() + ((hi - lo) / 3) * dp);
            net.push_back(q - ((hi - lo) / 3) * dq);
            net.push_back(q);
            knots.insert(knots.end(), 3, lo);
        }
    knots.insert(knots.end(), 4, steps.back());
    const int size = int(net.size());
    return Curve<Vec<2>>::trusted({*BSplineBasis::make(3, std::move(knots))},
                                  Net<1, Vec<2>>({size}, std::move(net)));
}

struct Across {
    const SurfaceGeometry& given;
    const MappedSurface& made;
    double tolerance = 0;
    double bound = 0;  // of all loops so far
};

// The coedge's curve where the spline has it, within the tolerance.
Result<CurveGeometry<2>> followed_across(const Coedge& c, const Edge& e, Across& how) {
    if (!e.curve)
        return refuse(RefusalKind::unsupported, "",
                      "a loop that crosses an angle, without a curve in space that it could follow");
    const SurfaceGeometry spline =
        visit_one([](const auto& s) { return SurfaceGeometry(s); }, how.made.surface);
    const DerivativeQuery<2, 3> before(how.given), after(spline);
    const EdgeGapOptions fine{.target = how.tolerance / 8};
    const double own = edge_gap(before, c.curve, *e.curve, e.range, fine).bound;
    const auto steps = steps_of(c.curve, e.range, how.made.map);
    double reached = kInfinity;
    for (int parts = 1; parts * int(steps.size()) <= kMostCubics; parts *= 2) {
        auto curve = cubics_along(c.curve, how.made.map, steps, parts);
        reached = edge_gap(after, curve, *e.curve, e.range, fine).bound;
        if (!(reached <= own + how.tolerance)) continue;
        how.bound = std::max(how.bound, reached);
        return curve;
    }
    return refuse(RefusalKind::not_converged, "",
                  text("a loop that crosses an angle follows its edge only within ", reached));
}

Result<CurveGeometry<2>> in_direction(Result<CurveGeometry<2>> curve, bool reversed) {
    if (!curve || !reversed) return curve;
    return visit_one(
        [](const auto& x) -> Result<CurveGeometry<2>> {
            if constexpr (requires { x.net(); })
                return reverse(x, 0);
            else
                return x;
        },
        *curve);
}

Result<SplineFace> converted(const Model& model, std::size_t face, double tolerance) {
    const Face& f = model.faces[face];
    Box<2> used;
    for (const Loop& l : f.loops)
        for (const Coedge& c : l.coedges) {
            const auto curve = parameter_spline(c.curve, model.edges[std::size_t(c.edge)].range);
            if (!curve) return std::unexpected(curve.error());
            visit_one(
                [&](const auto& x) {
                    if constexpr (requires { x.net(); })
                        for (const auto& p : x.net().flat()) used.add(project(p));
                },
                *curve);
        }
    if (f.loops.empty()) return refuse(RefusalKind::unsupported, "loops", "a face without boundary");
    auto made = visit_one([&](const auto& s) { return spline_of(s, used); }, f.surface);
    if (!made) return std::unexpected(made.error());
    Across across{f.surface, *made, tolerance};
    std::vector<std::vector<CurveGeometry<2>>> loops;
    for (const Loop& l : f.loops) {
        auto& loop = loops.emplace_back();
        for (const Coedge& c : l.coedges) {
            const Edge& e = model.edges[std::size_t(c.edge)];
            auto there = mapped(*parameter_spline(c.curve, e.range), made->map);
            if (!there && tolerance > 0) there = followed_across(c, e, across);
            auto curve = in_direction(std::move(there), c.reversed);
            if (!curve) return std::unexpected(curve.error());
            loop.push_back(*std::move(curve));
        }
    }
    auto trimmed = TrimmedSurface::make(made->surface, std::move(loops));
    if (!trimmed) return std::unexpected(trimmed.error());
    return SplineFace{*std::move(trimmed), across.bound};
}

}  // namespace

Result<TrimmedSurface> spline_face(const Model& model, std::size_t face) {
    auto made = converted(model, face, 0);
    if (!made) return std::unexpected(made.error());
    return std::move(made->face);
}

Result<SplineFace> spline_face_within(const Model& model, std::size_t face, double tolerance) {
    if (!(tolerance > 0 && std::isfinite(tolerance)))
        return refuse(RefusalKind::invalid, "tolerance", text(tolerance, " is not a positive number"));
    return converted(model, face, tolerance);
}

}  // namespace freiform
