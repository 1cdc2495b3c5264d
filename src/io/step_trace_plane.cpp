// Parameter curves on planes: edges in other coordinates.
#include "step_trace.hpp"

#include <freiform/core/visit.hpp>

#include <algorithm>
#include <cmath>

namespace freiform::step {

// The gap is a bound, in exact arithmetic: the distance from a plane is convex, so that of the control
// points bounds that of a spline.
std::optional<Trace> trace_on_plane(const SurfaceGeometry& surface, const CurveGeometry<3>& c, Interval on) {
    const auto* s = std::get_if<Extrusion>(&surface);
    const auto* l = s != nullptr ? std::get_if<Line<3>>(&s->profile) : nullptr;
    if (l == nullptr) return std::nullopt;
    const Vec<3> x = l->direction, y = s->direction, n = unit(cross(x, y));
    const bool square = std::abs(dot(x, y)) <= 1e-15 * norm(x) * norm(y);
    const Vec<3> gu = square ? (1 / dot(x, x)) * x : (1 / dot(x, cross(y, n))) * cross(y, n);
    const Vec<3> gv = square ? (1 / dot(y, y)) * y : (1 / dot(y, cross(n, x))) * cross(n, x);
    const auto direction = [&](const Vec<3>& d) { return Vec<2>{{dot(d, gu), dot(d, gv)}}; };
    const auto point = [&](const Vec<3>& p) { return direction(p - l->origin); };
    const auto height = [&](const Vec<3>& p) { return std::abs(dot(p - l->origin, n)); };
    Trace out;
    visit_one(
        [&](const auto& g) {
            using G = std::remove_cvref_t<decltype(g)>;
            if constexpr (std::same_as<G, Line<3>>) {
                out.curve = Line<2>{point(g.origin), direction(g.direction)};
                out.gap = std::max(height(jet<0>(c, on.lo).value()), height(jet<0>(c, on.hi).value()));
            } else if constexpr (std::same_as<G, Conic<3>>) {
                out.curve = Conic<2>{g.kind, point(g.centre), direction(g.x), direction(g.y)};
                if (g.kind == ConicKind::ellipse)
                    out.gap = height(g.centre) + std::hypot(dot(g.x, n), dot(g.y, n));
                else
                    for (int i = 0; i <= 8; ++i)
                        out.gap = std::max(out.gap, height(jet<0>(c, on.lo + on.length() * i / 8).value()));
            } else if constexpr (std::same_as<G, Curve<Vec<3>>>) {
                Net<1, Vec<2>> net(g.net().extent());
                for (std::size_t i = 0; i < net.flat().size(); ++i) net.flat()[i] = point(g.net().flat()[i]);
                out.curve = Curve<Vec<2>>::trusted(g.bases(), std::move(net));
                for (const auto& p : g.net().flat()) out.gap = std::max(out.gap, height(p));
            } else {
                Net<1, Hom<2>> net(g.net().extent());
                for (std::size_t i = 0; i < net.flat().size(); ++i) {
                    const Hom<3>& h = g.net().flat()[i];
                    net.flat()[i] = weighted(point(project(h)), h.weight());
                    out.gap = std::max(out.gap, height(project(h)));
                }
                out.curve = Curve<Hom<2>>::trusted(g.bases(), std::move(net));
            }
        },
        c);
    return out;
}

}  // namespace freiform::step
