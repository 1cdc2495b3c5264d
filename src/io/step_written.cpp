// Parts of curves. A file trims a curve by vertices. Where a spline passes a point twice, because it closes,
// runs round more than once or crosses itself, these do not say which part of it is meant; so the part is
// written wherever it is not all of the spline.
//
// Turns of surfaces. Readers go on with a closed spline where a face lies across its ends (step_unwind.cpp).
// A file gets one turn again, as it had, and those who read it will do the same; parameter curves, which run
// beyond that turn, are left out.
//
// Seams. Where a face winds around its surface, readers join its loops along an edge that is no parameter
// line if their vertices are not opposite each other (step_seams.cpp): nothing says what its curve in space
// is. Without it there are two loops again, as in the file that was read, and whoever reads them will join
// them. From the use of an edge on, such a loop goes on behind its other use: that is a permutation of the
// coedges, each cycle of which is a loop.
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

std::vector<Loop> without_seams(const Model& m, const Face& f, std::vector<int>& left_out) {
    std::vector<Loop> out, poles;
    for (const Loop& l : f.loops) {
        const std::size_t n = l.coedges.size();
        std::vector<std::size_t> other(n, n);  // the other use of a seam; n: no seam
        for (std::size_t i = 0; i < n; ++i) {
            const Coedge& c = l.coedges[i];
            const Edge& e = m.edges[std::size_t(c.edge)];
            for (std::size_t j = 0; j < n && !e.curve && !e.degenerate; ++j)
                if (l.coedges[j].edge == c.edge && l.coedges[j].reversed != c.reversed) other[i] = j;
            if (other[i] < n) left_out.push_back(c.edge);
        }
        std::vector<char> done(n, 0);
        for (std::size_t i = 0; i < n; ++i) {
            Loop part;
            bool is_pole = true;
            for (std::size_t k = i; !done[k]; k = ((other[k] < n ? other[k] : k) + 1) % n) {
                done[k] = 1;
                if (other[k] < n) continue;
                part.coedges.push_back(l.coedges[k]);
                is_pole = is_pole && m.edges[std::size_t(l.coedges[k].edge)].degenerate;
            }
            if (!part.coedges.empty()) (is_pole ? poles : out).push_back(std::move(part));
        }
    }
    if (out.empty()) out.swap(poles);
    return out;
}

}  // namespace freiform::detail
