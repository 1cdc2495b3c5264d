// Edges that lie beside their surface, and loops that touch.
//
// The nearest points of an edge that lies beside its surface wander: near the end of a spline they stay at it
// while the edge goes on, near a pole they run to and fro. Two such edges that meet can then cover the same
// piece of the boundary of the domain, and what they enclose is no region. Such a face is known by polygons
// through its parameter curves; the reader then follows its edges no closer than they lie beside the surface
// anyway, mostly by straight lines. Where that does not help, as where an edge runs past a corner of the
// surface and back, polygons with few corners follow them, within a few times what the file promises.
//
// A hole may touch the boundary around it, in a vertex of the one inside an edge of the other. In a face
// boundaries meet in vertices only, so the edge is cut there: both parts keep its curve and its parameter
// curves, and so do the other faces along it.
//
// Cost: the search for touching vertices looks, along one axis, only at those beside the box of an edge, and
// gives up after kMostPairs pairs of a face.
#include "step_tangles.hpp"

#include "step_geometry.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/core/sort.hpp>
#include <freiform/core/visit.hpp>
#include <freiform/mesh/face_mesh.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

namespace freiform::step {

namespace {

constexpr std::size_t kMostPairs = 4'000'000;
constexpr int kMostOfPiece = 600;  // points of one parameter curve

// Points along the range, those of `on` included: the breaks, and `each` pieces between two.
std::vector<double> places_on(const CurveGeometry<2>& curve, Interval on, int each) {
    std::vector<double> breaks{on.lo};
    const bool straight = std::holds_alternative<Line<2>>(curve);
    visit_one(
        [&](const auto& g) {
            if constexpr (requires { g.net(); }) {
                const auto all = g.basis().breaks();
                const std::size_t stride = 1 + all.size() * std::size_t(each) / kMostOfPiece;
                for (std::size_t i = 0; i < all.size(); i += stride)
                    if (on.lo < all[i] && all[i] < on.hi) breaks.push_back(all[i]);
            } else if (!straight) {
                for (int i = 1; i < 8; ++i) breaks.push_back(on.lo + on.length() * i / 8);
            }
        },
        curve);
    breaks.push_back(on.hi);
    if (straight) return breaks;
    std::vector<double> out;
    for (std::size_t i = 0; i + 1 < breaks.size(); ++i)
        for (int k = 0; k < each; ++k) out.push_back(breaks[i] + (breaks[i + 1] - breaks[i]) * k / each);
    out.push_back(on.hi);
    return out;
}

FaceBoundary polygon_of(const std::vector<std::vector<Use>>& loops, const Model& model, const Chart& chart,
                        int each) {
    FaceBoundary out;
    int inner = int(model.vertices.size());
    for (const auto& uses : loops) {
        const int first = int(out.uv.size());
        for (const Use& u : uses) {
            auto places = places_on(u.coedge.curve, model.edges[std::size_t(u.coedge.edge)].range, each);
            if (u.coedge.reversed) std::reverse(places.begin(), places.end());
            for (std::size_t k = 0; k + 1 < places.size(); ++k) {
                out.uv.push_back(chart.inside(jet<0>(u.coedge.curve, places[k]).value()));
                out.point.push_back(k == 0 ? u.from : inner++);
            }
        }
        const int end = int(out.uv.size());
        for (int i = first; i < end; ++i) out.segments.push_back({i, i + 1 < end ? i + 1 : first});
    }
    return out;
}

// Whether some of them stays in a corner where the surface ends, though the edge goes on.
bool stays_in_corner(const std::vector<std::vector<Use>>& loops, const Model& model, const Chart& chart) {
    for (const auto& uses : loops)
        for (const Use& u : uses) {
            const Edge& e = model.edges[std::size_t(u.coedge.edge)];
            if (e.degenerate) continue;
            std::optional<Vec<2>> last;
            for (const double t : places_on(u.coedge.curve, e.range, 12)) {
                const Vec<2> uv = jet<0>(u.coedge.curve, t).value(), moved = chart.inside(uv);
                if (last == moved && uv != moved) return true;
                last = moved;
            }
        }
    return false;
}

Box<3> box_of(const Edge& e) {
    Box<3> box;
    visit_one(
        [&](const auto& g) {
            using G = std::remove_cvref_t<decltype(g)>;
            if constexpr (std::same_as<G, Line<3>>) {
                box.add(g.origin + e.range.lo * g.direction);
                box.add(g.origin + e.range.hi * g.direction);
            } else if constexpr (std::same_as<G, Conic<3>>) {
                if (g.kind != ConicKind::ellipse) return;
                for (const double a : {-1.0, 1.0})
                    for (const double b : {-1.0, 1.0}) box.add(g.centre + a * g.x + b * g.y);
            } else {
                for (const Vec<3>& p : points(g)) box.add(p);
            }
        },
        *e.curve);
    return box;
}

struct TouchedEdges {
    const Model& model;
    double close;
    std::map<int, std::map<double, int>> cuts;  // of an edge: the vertex at a parameter

    // Whether the vertex lies inside the edge; where.
    std::optional<double> inside(const Edge& e, const Vec<3>& p) const {
        double off = 0;
        double t = parameter_of(*e.curve, p, off);
        if (!(off <= close)) return std::nullopt;
        if (const auto* c = std::get_if<Conic<3>>(&*e.curve); c != nullptr && c->kind == ConicKind::ellipse)
            t -= std::floor((t - e.range.lo) / kTwoPi) * kTwoPi;
        if (!(e.range.lo < t && t < e.range.hi)) return std::nullopt;
        for (const double end : {e.range.lo, e.range.hi})
            if (!(norm(jet<0>(*e.curve, end).value() - p) > 1e3 * close)) return std::nullopt;
        return t;
    }
    void look_at(const Face& f) {
        struct Corner {
            double x;
            int vertex, loop;
        };
        std::vector<Corner> corners;
        for (std::size_t l = 0; l < f.loops.size(); ++l)
            for (const Coedge& c : f.loops[l].coedges) {
                const Edge& e = model.edges[std::size_t(c.edge)];
                for (const int v : {e.start, e.end})
                    corners.push_back({model.vertices[std::size_t(v)].point[0], v, int(l)});
            }
        sort(corners, {}, [](const Corner& c) { return std::tuple(c.x, c.vertex, c.loop); });
        std::size_t left = kMostPairs;
        for (std::size_t l = 0; l < f.loops.size(); ++l)
            for (const Coedge& c : f.loops[l].coedges) {
                const Edge& e = model.edges[std::size_t(c.edge)];
                if (e.degenerate || !e.curve) continue;
                const Box<3> box = box_of(e);
                if (box.is_empty()) continue;
                auto at = std::ranges::lower_bound(corners, box.lo[0] - close, {}, &Corner::x);
                for (int last = -1; at != corners.end() && at->x <= box.hi[0] + close; ++at) {
                    if (left-- == 0) return;
                    if (at->loop == int(l) || at->vertex == last || at->vertex == e.start ||
                        at->vertex == e.end)
                        continue;
                    last = at->vertex;
                    const Vec<3>& p = model.vertices[std::size_t(at->vertex)].point;
                    bool near = true;
                    for (int k = 1; k < 3; ++k)
                        near = near && box.lo[k] - close <= p[k] && p[k] <= box.hi[k] + close;
                    if (!near) continue;
                    if (const auto t = inside(e, p)) cuts[c.edge].try_emplace(*t, at->vertex);
                }
            }
    }
};

}  // namespace

bool is_tangled(const std::vector<std::vector<Use>>& loops, const Model& model, const Chart& chart) {
    if (stays_in_corner(loops, model, chart)) return true;
    for (const int each : {2, 12})
        if (find_conflicts(polygon_of(loops, model, chart, each)).empty()) return false;
    return true;
}

void cut_touched_edges(Model& model, double close, const std::function<void(int, int, int)>& told) {
    TouchedEdges touched{model, close, {}};
    for (const Face& f : model.faces)
        if (f.loops.size() > 1) touched.look_at(f);
    if (touched.cuts.empty()) return;
    std::map<int, int> first_of;  // of the new parts of an edge
    for (const auto& [edge, cuts] : touched.cuts) {
        const int first = int(model.edges.size());
        first_of[edge] = first;
        const double hi = model.edges[std::size_t(edge)].range.hi;
        const int end = model.edges[std::size_t(edge)].end;
        int part = edge;
        for (const auto& [t, vertex] : cuts) {
            Edge next = model.edges[std::size_t(edge)];
            Edge& before = model.edges[std::size_t(part)];
            before.range.hi = t, before.end = vertex;
            next.range = {t, hi}, next.start = vertex, next.end = end;
            part = int(model.edges.size());
            model.edges.push_back(std::move(next));
        }
        told(edge, int(cuts.size()) + 1, first);
    }
    for (Face& f : model.faces)
        for (Loop& l : f.loops) {
            std::vector<Coedge> coedges;
            for (Coedge& c : l.coedges) {
                const auto at = first_of.find(c.edge);
                if (at == first_of.end()) {
                    coedges.push_back(std::move(c));
                    continue;
                }
                const int n = int(touched.cuts[c.edge].size()) + 1;
                for (int k = 0; k < n; ++k) {
                    const int part = c.reversed ? n - 1 - k : k;
                    coedges.push_back({part == 0 ? c.edge : at->second + part - 1, c.reversed, c.curve});
                }
            }
            l.coedges = std::move(coedges);
        }
}

}  // namespace freiform::step
