// From coedges to polygons.
//
// Where two coedges meet in a vertex their parameter curves need not meet exactly. If the surface moves less
// than the tolerances of the vertex, the edges and the face (or the gap is rounding) and the jump is short
// against the segments beside it, the end is moved onto the next start, and the move counts as gap. If the
// jump is long but the surface stands still along it (a pole that the file has no edge for), a segment joins
// the two. Anything else is an open loop. Loops that have a vertex in common get one place for it likewise.
#include "face_boundary_detail.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace freiform {

namespace {

constexpr double kNoPole = 1e-4;       // of the box of the loop in the parameter plane
constexpr double kOnLine = 0x1p-40;    // of the domain: rounding
constexpr double kNearLine = 0x1p-28;  // of the domain: of the digits that files have
constexpr double kSamePlace = 1e-9;    // of the box of the face: one vertex, not two sides of a seam
constexpr double kNearPlace = 1e-6;    // likewise, where the model is not more accurate

struct Run {
    std::vector<Vec<2>> uv;
    std::vector<int> points;
    std::vector<BoundaryOfFace::Source> sources;  // one fewer
};

// Parameter curves may leave the domain by rounding, or run a rounding, of doubles or of the digits of a
// file, beside its end or a line where second derivatives jump: then they are on it, if that moves them by no
// more than the tolerance of the edge (the gap counts it). Else what lies across would count for all along
// the line, and points beside one line would leave triangles that no point makes better.
Vec<2> settled(Vec<2> uv, const std::array<Interval, 2>& on, const DerivativeQuery<2, 3>& surface,
               double tolerance) {
    uv = clamped(uv, on);
    for (int d = 0; d < 2; ++d) {
        const auto lines = surface.bends(d);
        if (lines.empty()) continue;
        const double length = lines.back() - lines.front(), room = kNearLine * length;
        const auto after = std::lower_bound(lines.begin(), lines.end(), uv[d] - room);
        if (after == lines.end() || !(*after <= uv[d] + room)) continue;
        const double by = std::abs(*after - uv[d]);
        if (by <= kOnLine * length ||
            norm(jet<1>(surface.geometry(), uv.c).d[std::size_t(d + 1)]) * by <= tolerance)
            uv[d] = *after;
    }
    return uv;
}

// `tolerance`: of the edge.
Run run_of(const Coedge& coedge, double tolerance, const DerivativeQuery<2, 3>& surface,
           const EdgeMesh& mesh) {
    Run run;
    const auto on = limits(surface.geometry());
    const int n = int(mesh.parameters.size());
    Vec<2> before{};  // where the last point was, unsettled
    for (int k = 0; k < n; ++k) {
        const int i = coedge.reversed ? n - 1 - k : k;
        if (!mesh.kept.contains(mesh.parameters[std::size_t(i)])) continue;
        const Vec<2> given = clamped(jet<0>(coedge.curve, mesh.parameters[std::size_t(i)]).value(), on);
        Vec<2> uv = settled(given, on, surface, tolerance);
        // Two points of an edge do not settle in one place: the one that moves less does.
        if (!run.uv.empty() && uv == run.uv.back()) {
            if (max_abs(uv - given) > max_abs(uv - before))
                uv = given;
            else
                run.uv.back() = before;
        }
        before = given;
        run.uv.push_back(uv);
        run.points.push_back(mesh.points[std::size_t(i)]);
        run.sources.push_back({coedge.edge, coedge.reversed ? i - 1 : i});
    }
    run.sources.pop_back();
    return run;
}

double length_in(const Vec<2>& d, const Vec<2>& size) {
    return std::max(size[0] > 0 ? std::abs(d[0]) / size[0] : 0, size[1] > 0 ? std::abs(d[1]) / size[1] : 0);
}

// How far the surface moves at most between two parameters.
double moved_between(const DerivativeQuery<2, 3>& surface, const Vec<2>& a, const Vec<2>& b) {
    Box<2> around;
    around.add(a);
    around.add(b);
    const auto s = surface({around.side(0), around.side(1)}, 1);
    return s(1, 0) * std::abs(b[0] - a[0]) + s(0, 1) * std::abs(b[1] - a[1]);
}

// Loops that touch in a vertex have it at the same place of the parameter plane but for rounding, or for what
// the model says of its accuracy there. How far that moves them at most.
double unite(FaceBoundary& polygon, const DerivativeQuery<2, 3>& surface, double tolerance) {
    Box<2> box;
    for (const Vec<2>& p : polygon.uv) box.add(p);
    std::map<int, std::vector<int>> corners_at;
    double most = 0;
    for (std::size_t i = 0; i < polygon.uv.size(); ++i) {
        auto& others = corners_at[polygon.point[i]];
        for (const int k : others) {
            const Vec<2> there = polygon.uv[std::size_t(k)], jump = polygon.uv[i] - there;
            if (jump == Vec<2>{}) break;
            const double length = length_in(jump, box.hi - box.lo);
            if (!(length < kNearPlace)) continue;
            const double moved = moved_between(surface, polygon.uv[i], there);
            if (!(length < kSamePlace || moved <= tolerance)) continue;
            most = std::max(most, moved);
            polygon.uv[i] = there;
            break;
        }
        others.push_back(int(i));
    }
    return most;
}

}  // namespace

Result<BoundaryOfFace> boundary_of(const Model& model, int face, const EdgeMesher& edges,
                                   const DerivativeQuery<2, 3>& surface, std::span<const Vec<3>> mesh_points,
                                   double tolerance, double rounding) {
    const Face& f = model.faces[std::size_t(face)];
    BoundaryOfFace out;
    for (std::size_t l = 0; l < f.loops.size(); ++l) {
        const auto& coedges = f.loops[l].coedges;
        std::vector<Run> runs;
        Box<2> box;
        for (const Coedge& c : coedges) {
            // No edge is more accurate than both its ends.
            const Edge& e = model.edges[std::size_t(c.edge)];
            const double at_ends = std::min(model.vertices[std::size_t(e.start)].tolerance,
                                            model.vertices[std::size_t(e.end)].tolerance);
            runs.push_back(run_of(c, std::max(e.tolerance, at_ends), surface, edges.mesh(c.edge)));
            for (const Vec<2>& p : runs.back().uv) box.add(p);
        }
        // A pole that has no length in the parameter plane either is left to the joint of its neighbours, and
        // so is an edge that is to be a point.
        std::vector<int> kept;
        for (std::size_t c = 0; c < coedges.size(); ++c) {
            Box<2> own;
            for (const Vec<2>& p : runs[c].uv) own.add(p);
            out.gap = std::max(out.gap, edges.mesh(coedges[c].edge).moved);
            if (edges.mesh(coedges[c].edge).collapsed) continue;
            if (!model.edges[std::size_t(coedges[c].edge)].degenerate ||
                length_in(own.hi - own.lo, box.hi - box.lo) > kNoPole)
                kept.push_back(int(c));
        }
        const int first = int(out.polygon.uv.size());
        for (std::size_t k = 0; k < kept.size(); ++k) {
            const std::size_t c = std::size_t(kept[k]), after = std::size_t(kept[(k + 1) % kept.size()]);
            Run& run = runs[c];
            Run& next = runs[after];
            const std::string where = text("loops[", l, "][", c, "]");
            if (run.points.back() != next.points.front())
                return refuse(RefusalKind::invalid, where,
                              "does not end at the vertex where the next edge of the loop begins");
            const Vec<2> jump = next.uv.front() - run.uv.back();
            bool join = false;
            if (jump != Vec<2>{}) {
                const double moved = moved_between(surface, run.uv.back(), next.uv.front());
                const auto tolerance_of = [&](const Coedge& use) {
                    const Edge& e = model.edges[std::size_t(use.edge)];
                    return std::max({e.tolerance, model.vertices[std::size_t(e.start)].tolerance,
                                     model.vertices[std::size_t(e.end)].tolerance});
                };
                const double allowed = 4 * std::max({tolerance_of(coedges[c]), tolerance_of(coedges[after]),
                                                     f.tolerance, tolerance / 4, rounding});
                const Vec<2> size = box.hi - box.lo;
                const double near = std::min(length_in(run.uv.back() - run.uv[run.uv.size() - 2], size),
                                             length_in(next.uv[1] - next.uv.front(), size));
                if (!(moved <= allowed))
                    return refuse(RefusalKind::invalid, where,
                                  text("the loop is open in the parameter plane: (", run.uv.back()[0], ", ",
                                       run.uv.back()[1], ") -> (", next.uv.front()[0], ", ",
                                       next.uv.front()[1], "), up to ", moved, " apart in space"));
                join = length_in(jump, size) > near / 4 && moved <= std::max(tolerance / 4, rounding);
                // Where one of them settled on its neighbour in the other run, that place is taken.
                const bool taken = next.uv.front() == run.uv[run.uv.size() - 2];
                if (taken) next.uv.front() = run.uv.back();
                if (taken || run.uv.back() == next.uv[1]) join = false;
                out.gap = std::max(out.gap, moved);
            }
            for (std::size_t i = 0; i + 1 < run.uv.size() + (join ? 1 : 0); ++i) {
                out.polygon.uv.push_back(run.uv[i]);
                out.polygon.point.push_back(run.points[i]);
                out.sources.push_back(i < run.sources.size() ? run.sources[i] : BoundaryOfFace::Source{});
            }
            if (k + 1 == kept.size()) out.polygon.uv[std::size_t(first)] = next.uv.front();
        }
        const int end = int(out.polygon.uv.size());
        for (int i = first; i < end; ++i) out.polygon.segments.push_back({i, i + 1 < end ? i + 1 : first});
    }
    out.gap = std::max(out.gap, unite(out.polygon, surface, f.tolerance));
    for (std::size_t i = 0; i < out.polygon.uv.size(); ++i) {
        const Vec<3> on = jet<0>(f.surface, out.polygon.uv[i].c).value();
        out.gap = std::max(out.gap, norm(on - mesh_points[std::size_t(out.polygon.point[i])]));
    }
    return out;
}

}  // namespace freiform
