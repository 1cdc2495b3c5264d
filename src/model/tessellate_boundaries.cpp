// The boundaries of faces in the parameter plane, without segments that touch each other. Essay in
// tessellate.cpp.
//
// Polygons of curves that are apart can cross where the curves come near each other: their segments are cut
// until none does. Curves that cross because the file says so within its tolerance stay crossed: the more
// segments, the more of them do. Mostly an edge is to blame that is shorter than the tolerance; as a point it
// does no harm. Else what of the edges that clash lies within the tolerance of their vertices becomes part of
// these: curves of intersections begin with spikes that their neighbours have, too. Where that does not help,
// the edges are whole again, and what crosses within the tolerance is closed by strips
// (tessellate_lenses.cpp). Vertices of one face at one place are one point in any case, for two of them
// would leave triangles without area. What becomes a point is moved by `EdgeMesh::moved` at most, which
// counts as gap.
#include "tessellator_detail.hpp"

#include <freiform/core/parallel.hpp>

#include <algorithm>
#include <map>
#include <numeric>
#include <set>

namespace freiform {

namespace {

constexpr int kConflictRounds = 12;  // each cuts the segments that touch
constexpr int kGrowingRounds = 3;    // conflicts get more by cutting: curves that lie on each other
constexpr int kLooks = 8;            // at the curve of a segment
constexpr double kLeastPart = 0.1;   // of a segment, that is cut from it
constexpr double kLittle = 0.1;      // of an edge, that may become part of the vertex at its end
constexpr double kOnePlace = 1e-6;   // of the box of the face in the parameter plane

}  // namespace

// Mesh points: one per used vertex, then those inside the edges. The ends of collapsed edges are one.
void Tessellator::number_points() {
    points_.clear();
    std::vector<int> of_vertex(model_.vertices.size(), -1), same(model_.vertices.size());
    std::iota(same.begin(), same.end(), 0);
    const auto first_of = [&](int v) {
        while (same[std::size_t(v)] != v) v = same[std::size_t(v)];
        return v;
    };
    for (std::size_t e = 0; e < model_.edges.size(); ++e)
        if (edges_->mesh(int(e)).collapsed) {
            const auto [a, b] = std::minmax({first_of(model_.edges[e].start), first_of(model_.edges[e].end)});
            same[std::size_t(b)] = a;
        }
    for (const auto& [a, b] : together_)
        if (const int i = first_of(a), j = first_of(b); i != j)
            same[std::size_t(std::max(i, j))] = std::min(i, j);
    const auto at_vertex = [&](int v) {
        v = first_of(v);
        if (of_vertex[std::size_t(v)] < 0) {
            of_vertex[std::size_t(v)] = int(points_.size());
            points_.push_back(model_.vertices[std::size_t(v)].point);
        }
        return of_vertex[std::size_t(v)];
    };
    for (std::size_t e = 0; e < model_.edges.size(); ++e) {
        EdgeMesh& mesh = edges_->mesh(int(e));
        if (mesh.uses.empty() || mesh.parameters.empty()) continue;
        const Edge& edge = model_.edges[e];
        mesh.points.assign(mesh.parameters.size(), -1);
        mesh.points.front() = at_vertex(edge.start);
        mesh.points.back() = at_vertex(edge.end);
        for (std::size_t k = 1; k + 1 < mesh.points.size(); ++k) {
            const double t = mesh.parameters[k];
            if (edge.degenerate || mesh.collapsed || t <= mesh.kept.lo) {
                mesh.points[k] = mesh.points.front();
            } else if (t >= mesh.kept.hi) {
                mesh.points[k] = mesh.points.back();
            } else {
                mesh.points[k] = int(points_.size());
                points_.push_back(edges_->position(int(e), t));
            }
        }
    }
}

void Tessellator::assemble(std::size_t f) {
    auto boundary =
        boundary_of(model_, int(f), *edges_, *queries_[f], points_, options_.tolerance, rounding_);
    if (boundary)
        boundaries_[f] = std::move(*boundary);
    else
        refusals_[f] = boundary.error();
}

void Tessellator::refuse_boundary(std::size_t f, const BoundaryConflict& conflict) {
    const int s = std::max(conflict.first, conflict.second);
    const int edge = s < 0 ? -1 : boundaries_[f].sources[std::size_t(s)].edge;
    refusals_[f] = Refusal{RefusalKind::invalid, edge < 0 ? std::string("loops") : text("edges[", edge, "]"),
                           text("the boundary touches itself in the parameter plane: ", conflict.message)};
}

// The edges whose segments touch, or that have a corner where they do.
void Tessellator::edges_of(std::size_t f, const BoundaryConflict& conflict, std::vector<int>& out) const {
    const BoundaryOfFace& boundary = boundaries_[f];
    for (std::size_t s = 0; s < boundary.sources.size(); ++s) {
        const auto& ends = boundary.polygon.segments[s];
        const bool has = ends[0] == conflict.corner || ends[1] == conflict.corner ||
                         int(s) == conflict.first || int(s) == conflict.second;
        if (has && boundary.sources[s].edge >= 0) out.push_back(boundary.sources[s].edge);
    }
}

// After that part of the segment, as the loop runs.
void Tessellator::add_cut(std::size_t f, int s, double part, std::vector<Cut>& cuts) const {
    if (s < 0) return;
    const auto& polygon = boundaries_[f].polygon;
    const auto [edge, segment] = boundaries_[f].sources[std::size_t(s)];
    if (edge < 0) return;
    const auto& points = edges_->mesh(edge).points;
    const int a = points[std::size_t(segment)], b = points[std::size_t(segment) + 1];
    const bool back = polygon.point[std::size_t(polygon.segments[std::size_t(s)][0])] == b;
    cuts.push_back({edge, segment, a == b ? 0.5 : back ? 1 - part : part});
}

// Segments to cut. One of two that cross is cut beside an end of the other: where curves touch in a common
// end and part slowly, chords cross unless their ends are abreast.
std::vector<Tessellator::Cut> Tessellator::cuts_for(std::size_t f, const BoundaryConflict& conflict) const {
    const auto& polygon = boundaries_[f].polygon;
    std::vector<Cut> out;
    const auto add = [&](int s, double part) { add_cut(f, s, part, out); };
    // The part of s after which an end of `other` is beside it; 0 if none is.
    const auto abreast = [&](int s, int other) {
        const auto ends = polygon.segments[std::size_t(s)];
        const Vec<2> a = polygon.uv[std::size_t(ends[0])], d = polygon.uv[std::size_t(ends[1])] - a;
        for (const int end : polygon.segments[std::size_t(other)]) {
            const double part = dot(polygon.uv[std::size_t(end)] - a, d) / dot(d, d);
            if (part > kLeastPart && part < 1 - kLeastPart) return part;
        }
        return 0.0;
    };
    const int first = conflict.first, second = conflict.second;
    const double part = first >= 0 && second >= 0 ? abreast(first, second) : 0,
                 other = first >= 0 && second >= 0 ? abreast(second, first) : 0;
    const bool halves = part == 0 && other == 0;
    if (halves || part > 0) add(first, halves ? 0.5 : part);
    if (halves || other > 0) add(second, halves ? 0.5 : other);
    if (second < 0 && conflict.corner >= 0)  // a segment through a corner: the corner's neighbours too
        for (std::size_t s = 0; s < polygon.segments.size(); ++s)
            for (int end : polygon.segments[s])
                if (end == conflict.corner) add(int(s), 0.5);
    return out;
}

bool Tessellator::is_straight(int edge) const {
    const auto& curve = model_.edges[std::size_t(edge)].curve;
    return curve && std::holds_alternative<Line<3>>(*curve);
}

// Whether the polygon runs clockwise, though the curves that it stands for do not: chords of narrow faces.
bool Tessellator::is_turned_over(std::size_t f) const {
    double area = 0;
    const auto& polygon = boundaries_[f].polygon;
    if (polygon.uv.empty()) return false;
    const Vec<2> from = polygon.uv[0];
    for (const auto& [a, b] : polygon.segments)
        area += cross(polygon.uv[std::size_t(a)] - from, polygon.uv[std::size_t(b)] - from);
    if (!(area < 0)) return false;
    area = 0;
    for (const Loop& loop : model_.faces[f].loops) {
        std::vector<Vec<2>> along;
        for (const Coedge& c : loop.coedges) {
            const auto& t = edges_->mesh(c.edge).parameters;
            if (t.empty()) continue;
            const std::size_t first = along.size();
            for (std::size_t k = 0; k + 1 < t.size(); ++k)
                for (int i = 0; i < kLooks; ++i)
                    along.push_back(jet<0>(c.curve, t[k] + (t[k + 1] - t[k]) * i / kLooks).value());
            along.push_back(jet<0>(c.curve, t.back()).value());
            if (c.reversed) std::reverse(along.begin() + std::ptrdiff_t(first), along.end());
        }
        for (std::size_t k = 0; k < along.size(); ++k)
            area += cross(along[k] - from, along[(k + 1) % along.size()] - from);
    }
    return area > 0;
}

// The faces that had to be refused. Then cuts have been made that nobody needs; `before` keeps what was there
// before the first.
std::vector<Tessellator::Clash> Tessellator::cut_conflicts(std::vector<std::vector<double>>& before) {
    std::vector<char> stale(faces(), 1);
    std::vector<std::size_t> known(faces(), 0);  // conflicts in the round before
    std::vector<int> growing(faces(), 0);
    std::vector<Clash> refused;
    for (int round = 0;; ++round) {
        number_points();
        std::vector<std::vector<BoundaryConflict>> conflicts(faces());
        std::vector<char> open(faces(), 0), turned(faces(), 0);
        parallel_for(faces(), 1, [&](std::size_t f) {
            if (is_refused(f)) return;
            assemble(f);  // point numbers change with every cut
            open[f] = is_refused(f);
            if (open[f] || !stale[f]) return;
            conflicts[f] = find_conflicts(boundaries_[f].polygon);
            turned[f] = conflicts[f].empty() && is_turned_over(f);
        });
        std::map<std::pair<int, int>, double, std::greater<>> cuts;  // later segments of an edge first
        std::fill(stale.begin(), stale.end(), 0);
        for (std::size_t f = 0; f < faces(); ++f) {
            if (open[f]) refused.push_back({f, true, {}});
            if (turned[f])
                for (const auto& [edge, segment] : boundaries_[f].sources)
                    if (edge >= 0 && !is_straight(edge)) cuts.try_emplace({edge, segment}, 0.5);
            growing[f] = round > 0 && conflicts[f].size() > known[f] ? growing[f] + 1 : 0;
            known[f] = conflicts[f].size();
            const bool hopeless = round == kConflictRounds || growing[f] == kGrowingRounds;
            for (const BoundaryConflict& conflict : conflicts[f]) {
                const auto here = cuts_for(f, conflict);
                if (here.empty() || hopeless) {
                    refuse_boundary(f, conflict);
                    refused.push_back({f, false, {}});
                    for (const auto& c : conflicts[f]) edges_of(f, c, refused.back().edges);
                    break;
                }
                for (const Cut& cut : here) cuts.try_emplace({cut.edge, cut.segment}, cut.part);
            }
        }
        if (cuts.empty() || round == kConflictRounds) return refused;
        for (std::size_t e = before.size(); e < model_.edges.size(); ++e)
            before.push_back(edges_->mesh(int(e)).parameters);
        for (const auto& [where, part] : cuts) {
            const auto [edge, segment] = where;
            edges_->split(edge, segment, part);
            for (const auto& use : edges_->mesh(edge).uses) stale[std::size_t(use->face)] = 1;
        }
    }
}

// What the model says of its accuracy there.
double Tessellator::accuracy_at(int e, int vertex, double of_face) const {
    return std::max(
        {model_.edges[std::size_t(e)].tolerance, model_.vertices[std::size_t(vertex)].tolerance, of_face});
}

// Makes the edge a point, if it is shorter than the tolerance of the model there.
bool Tessellator::collapse(int e, double of_face) {
    const Edge& edge = model_.edges[std::size_t(e)];
    EdgeMesh& mesh = edges_->mesh(e);
    if (mesh.collapsed || edge.degenerate) return false;
    const Vec<3> from = model_.vertices[std::size_t(edge.start)].point;
    double reach = norm(model_.vertices[std::size_t(edge.end)].point - from);
    for (const double t : mesh.parameters) reach = std::max(reach, norm(edges_->position(e, t) - from));
    reach += mesh.bound;
    if (!(reach <= std::max(accuracy_at(e, edge.start, of_face), accuracy_at(e, edge.end, of_face))))
        return false;
    mesh.moved = reach;
    return mesh.collapsed = true;
}

// Makes what is within the tolerance of the model from an end of the edge part of the vertex there.
bool Tessellator::shorten(int e, double of_face) {
    const Edge& edge = model_.edges[std::size_t(e)];
    EdgeMesh& mesh = edges_->mesh(e);
    if (mesh.collapsed || edge.degenerate) return false;
    const auto& t = mesh.parameters;
    Interval kept = mesh.kept;
    double moved = mesh.moved;
    const auto walk = [&](int vertex, auto begin, auto end, double& limit) {
        const Vec<3> at = model_.vertices[std::size_t(vertex)].point;
        double before = norm(edges_->position(e, *begin) - at), extent = 0;
        for (auto i = begin; i != end; ++i) extent = std::max(extent, norm(edges_->position(e, *i) - at));
        const double accuracy = std::min(accuracy_at(e, vertex, of_face), kLittle * extent);
        for (; begin + 1 != end; ++begin) {
            const auto [a, b] = std::minmax(*begin, *(begin + 1));
            const double there = norm(edges_->position(e, *(begin + 1)) - at),
                         reach = std::max(before, there) + edges_->part(e, a, b, edge_demands()).bound;
            if (!(reach <= accuracy)) return;
            limit = *(begin + 1), before = there, moved = std::max(moved, reach);
        }
    };
    walk(edge.start, t.begin(), t.end(), kept.lo);
    walk(edge.end, t.rbegin(), t.rend(), kept.hi);
    if (kept == mesh.kept || !(kept.lo < kept.hi)) return false;
    mesh.kept = kept, mesh.moved = moved;
    return true;
}

// Two points of the boundary at one place in space and in the parameter plane leave a triangle without area.
// If both are vertices they are to be one; else the edges that have them run along each other.
Tessellator::Doubled Tessellator::doubled(std::size_t f) const {
    const auto& polygon = boundaries_[f].polygon;
    const auto point = [&](int i) { return polygon.point[std::size_t(i)]; };
    std::vector<std::pair<std::array<double, 3>, int>> places;
    for (std::size_t i = 0; i < polygon.uv.size(); ++i)
        places.push_back({points_[std::size_t(point(int(i)))].c, int(i)});
    sort(places.begin(), places.end());
    Box<2> box;
    for (const Vec<2>& p : polygon.uv) box.add(p);
    Doubled out;
    for (std::size_t k = 0; k + 1 < places.size(); ++k) {
        const auto [i, j] = std::pair(places[k].second, places[k + 1].second);
        if (point(i) == point(j) || places[k].first != places[k + 1].first) continue;
        const Vec<2> apart = polygon.uv[std::size_t(i)] - polygon.uv[std::size_t(j)];
        bool near = true;
        for (int d = 0; d < 2; ++d) near &= std::abs(apart[d]) <= kOnePlace * (box.hi[d] - box.lo[d]);
        if (!near) continue;
        std::array<int, 2> vertex{-1, -1};
        for (const Loop& loop : model_.faces[f].loops)
            for (const Coedge& use : loop.coedges) {
                const Edge& edge = model_.edges[std::size_t(use.edge)];
                const auto& points = edges_->mesh(use.edge).points;
                for (const auto& [p, v] :
                     {std::pair(points.front(), edge.start), std::pair(points.back(), edge.end)})
                    if (p == point(i) || p == point(j)) vertex[p == point(j)] = v;
            }
        if (vertex[0] >= 0 && vertex[1] >= 0) {
            out.vertices.push_back({vertex[0], vertex[1]});
            continue;
        }
        for (const int corner : {i, j}) edges_of(f, {-1, -1, corner, {}}, out.edges);
    }
    return out;
}

// Parameters without the cuts that were in vain, but with the ends of what is left of edges.
void Tessellator::undo_cuts(const std::vector<std::vector<double>>& before) {
    for (std::size_t e = 0; e < before.size(); ++e) {
        EdgeMesh& mesh = edges_->mesh(int(e));
        mesh.parameters = before[e];
        for (const double end : {mesh.kept.lo, mesh.kept.hi})
            if (const auto at = std::ranges::lower_bound(mesh.parameters, end);
                at != mesh.parameters.begin() && at != mesh.parameters.end() && *at != end)
                mesh.parameters.insert(at, end);
    }
}

void Tessellator::resolve_conflicts() {
    std::vector<std::vector<double>> before;
    std::vector<std::vector<int>> shortened(faces());
    std::vector<char> clashed(faces(), 0);
    for (;;) {
        bool again = false;
        std::set<int> changed;  // edges of several faces mostly
        const auto change = [&](std::size_t f, int e, bool whole) {
            const double accuracy = model_.faces[f].tolerance;
            if (!changed.contains(e) && (whole ? collapse(e, accuracy) : shorten(e, accuracy)))
                changed.insert(e);
            return changed.contains(e);
        };
        const auto unite = [&](const Doubled& twice) {
            together_.insert(together_.end(), twice.vertices.begin(), twice.vertices.end());
            again = again || !twice.vertices.empty();
            return !twice.vertices.empty();
        };
        for (Clash& clash : cut_conflicts(before)) {
            const std::size_t f = clash.face;
            bool changes = false;
            if (!clash.open) {
                again = again || !before.empty();
                const Doubled twice = doubled(f);
                clash.edges.insert(clash.edges.end(), twice.edges.begin(), twice.edges.end());
                changes = unite(twice);
                for (const Loop& loop : model_.faces[f].loops)
                    for (const Coedge& use : loop.coedges) changes |= change(f, use.edge, true);
            }
            if (!changes)
                for (const int e : clash.edges)
                    if (std::ranges::find(shortened[f], e) == shortened[f].end() && change(f, e, false))
                        changes = true, shortened[f].push_back(e);
            if (changes) {
                refusals_[f].reset();
                continue;
            }
            // In vain: the edges are whole again, also for faces that did not like it.
            clashed[f] = 1;
            for (const int e : shortened[f]) {
                EdgeMesh& mesh = edges_->mesh(e);
                mesh.lengthen(), again = true;
                for (const auto& use : mesh.uses) {
                    const auto g = std::size_t(use->face);
                    if (g != f && !is_refused(g)) std::erase(shortened[g], e);
                    if (clashed[g] && shortened[g].empty()) refusals_[g].reset(), clashed[g] = 0;
                }
            }
        }
        if (changed.empty() && !again) {
            std::vector<Doubled> twice(faces());
            parallel_for(faces(), 16, [&](std::size_t f) {
                if (!is_refused(f)) twice[f] = doubled(f);
            });
            for (std::size_t f = 0; f < faces(); ++f) {
                unite(twice[f]);
                for (const int e : twice[f].edges) change(f, e, false);
            }
        }
        if (changed.empty() && !again) break;
        undo_cuts(before);
    }
    close_all_lenses(std::move(clashed));
}

}  // namespace freiform
