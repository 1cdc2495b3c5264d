// Parts of curves. A file trims a curve by vertices. Where a spline passes a point twice, because it closes,
// runs round more than once or crosses itself, these do not say which part of it is meant; so the part is
// written wherever it is not all of the spline.
//
// Turns of surfaces. Readers go on with a closed spline where a face lies across its ends (step_unwind.cpp).
// A file gets one turn again, as it had, and those who read it will do the same; parameter curves, which run
// beyond that turn, are left out.
//
// Why not the part of the surface that the face covers? Where the face goes around it, its seam need not be a
// parameter line, and the part would be more than a turn again.
#include "step_written.hpp"

#include "step_geometry.hpp"

#include <freiform/core/visit.hpp>
#include <freiform/make/image_curve.hpp>
#include <freiform/spline/in_space.hpp>

#include <algorithm>

namespace freiform::detail {

std::optional<CurveGeometry<3>> lifted(const CurveGeometry<2>& curve, const SurfaceGeometry& s) {
    const auto* plane = std::get_if<Extrusion>(&s);
    const auto* spline = std::get_if<Surface<Vec<3>>>(&s);
    bool linear = plane && std::holds_alternative<Line<3>>(plane->profile);
    if (spline && spline->net().flat().size() == 4 && spline->basis(0).degree() == 1 &&
        spline->basis(1).degree() == 1) {
        const auto p = spline->net().flat();
        linear = p[3] - p[1] == p[2] - p[0];
    }
    if (!linear) return std::nullopt;
    return visit_one(
        [&](const auto& c) -> std::optional<CurveGeometry<3>> {
            if constexpr (requires { c.net(); }) {
                const auto at = [&](const Vec<2>& uv) { return jet<0>(s, uv.c).value(); };
                auto net = in_space(c).net();
                for (std::size_t i = 0; i < c.net().flat().size(); ++i) {
                    const auto& q = c.net().flat()[i];
                    if constexpr (requires { q.weight(); })
                        net.flat()[i] = weighted(at(project(q)), q.weight());
                    else
                        net.flat()[i] = at(q);
                }
                return decltype(in_space(c))::trusted(c.bases(), std::move(net));
            }
            return std::nullopt;
        },
        curve);
}

CurveGeometry<3> part_of(const Edge& e) {
    const bool is_spline = visit_one(
        [](const auto& c) {
            return requires { c.net(); };
        },
        *e.curve);
    if (!is_spline || domain(*e.curve)[0] == e.range) return *e.curve;
    return space_spline(*e.curve, e.range).value_or(*e.curve);
}

std::optional<SurfaceGeometry> one_turn(const Model& m, const Face& f) {
    double close = f.tolerance;
    for (const Loop& l : f.loops)
        for (const Coedge& c : l.coedges) close = std::max(close, m.edges[std::size_t(c.edge)].tolerance);
    SurfaceGeometry once = f.surface;
    if (!step::rewind(once, close)) return std::nullopt;
    return once;
}

}  // namespace freiform::detail
