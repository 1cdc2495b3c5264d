// Idea. A rational quadratic arc runs through its angle unevenly: with the half angle h of a piece, the angle
// a from its start is reached where tan(a / 2) = t sin h / (1 - t + t cos h), so at
//
//     t = tan(a / 2) / (sin h + tan(a / 2) (1 - cos h)).
//
// Parameter lines stay parameter lines under this map of one axis; what else runs across the angle has no
// rational image. Axes that are not angles keep their parameters, and so do curves on surfaces of two such.
//
// Cost: linear in the control points.
// Why not an approximation of loops that cross the angle: neighbours would then need the same one, and no
// tolerance has been given.
#include <freiform/core/constants.hpp>
#include <freiform/make/conic.hpp>
#include <freiform/make/image_curve.hpp>
#include <freiform/make/revolve.hpp>
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
    return std::visit(
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
    return std::visit(
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
                "image; STEP and IGES files keep it");
        },
        curve);
}

Result<CurveGeometry<2>> in_direction(const Coedge& c, const Edge& e) {
    auto curve = parameter_spline(c.curve, e.range);
    if (!curve || !c.reversed) return curve;
    return std::visit(
        [](const auto& x) -> Result<CurveGeometry<2>> {
            if constexpr (requires { x.net(); })
                return reverse(x, 0);
            else
                return x;
        },
        *curve);
}

}  // namespace

Result<TrimmedSurface> spline_face(const Model& model, std::size_t face) {
    const Face& f = model.faces[face];
    Box<2> used;
    std::vector<std::vector<CurveGeometry<2>>> loops;
    for (const Loop& l : f.loops) {
        auto& loop = loops.emplace_back();
        for (const Coedge& c : l.coedges) {
            auto curve = in_direction(c, model.edges[std::size_t(c.edge)]);
            if (!curve) return std::unexpected(curve.error());
            std::visit(
                [&](const auto& x) {
                    if constexpr (requires { x.net(); })
                        for (const auto& p : x.net().flat()) used.add(project(p));
                },
                *curve);
            loop.push_back(*std::move(curve));
        }
    }
    if (loops.empty()) return refuse(RefusalKind::unsupported, "loops", "a face without boundary");
    auto made = std::visit([&](const auto& s) { return spline_of(s, used); }, f.surface);
    if (!made) return std::unexpected(made.error());
    for (auto& loop : loops)
        for (auto& curve : loop) {
            auto there = mapped(curve, made->map);
            if (!there) return std::unexpected(there.error());
            curve = *std::move(there);
        }
    return TrimmedSurface::make(std::move(made->surface), std::move(loops));
}

}  // namespace freiform
