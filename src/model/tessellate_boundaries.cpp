// The boundaries of faces in the parameter plane, without segments that touch each other. Essay in
// tessellate.cpp.
//
// Polygons of curves that are apart can cross where the curves come near each other: their segments are cut
// until none does. Curves that cross because the file says so within its tolerance stay crossed: the more
// segments, the more of them do. Mostly an edge is to blame that is shorter than the tolerance; as a point it
// does no harm, and what it moves counts as gap.
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
constexpr double kLeastPart = 0.1;   // of a segment, that is cut from it

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
            const bool is_point = edge.degenerate || mesh.collapsed;
            mesh.points[k] = is_point ? mesh.points.front() : int(points_.size());
            if (!is_point) points_.push_back(edges_->position(int(e), mesh.parameters[k]));
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

// Segments to cut. One of two that cross is cut beside an end of the other: where curves touch in a common
// end and part slowly, chords cross unless their ends are abreast.
std::vector<Tessellator::Cut> Tessellator::cuts_for(std::size_t f, const BoundaryConflict& conflict) const {
    const auto& polygon = boundaries_[f].polygon;
    std::vector<Cut> out;
    const auto add = [&](int s, double part) {
        if (s < 0) return;
        const auto [edge, segment] = boundaries_[f].sources[std::size_t(s)];
        if (edge < 0) return;
        const auto& points = edges_->mesh(edge).points;
        const int a = points[std::size_t(segment)], b = points[std::size_t(segment) + 1];
        const bool back = polygon.point[std::size_t(polygon.segments[std::size_t(s)][0])] == b;
        out.push_back({edge, segment, a == b ? 0.5 : back ? 1 - part : part});
    };
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

// The faces that had to be refused. Then cuts have been made that nobody needs; `before` keeps what was there
// before the first.
std::vector<std::size_t> Tessellator::cut_conflicts(std::vector<std::vector<double>>& before) {
    std::vector<char> stale(faces(), 1);
    std::vector<std::size_t> known(faces(), 0);  // conflicts in the round before
    std::vector<int> growing(faces(), 0);
    std::vector<std::size_t> refused;
    for (int round = 0;; ++round) {
        number_points();
        std::vector<std::vector<BoundaryConflict>> conflicts(faces());
        parallel_for(faces(), 1, [&](std::size_t f) {
            if (is_refused(f)) return;
            assemble(f);  // point numbers change with every cut
            if (!is_refused(f) && stale[f]) conflicts[f] = find_conflicts(boundaries_[f].polygon);
        });
        std::map<std::pair<int, int>, double, std::greater<>> cuts;  // later segments of an edge first
        std::fill(stale.begin(), stale.end(), 0);
        for (std::size_t f = 0; f < faces(); ++f) {
            growing[f] = round > 0 && conflicts[f].size() > known[f] ? growing[f] + 1 : 0;
            known[f] = conflicts[f].size();
            const bool hopeless = round == kConflictRounds || growing[f] == kGrowingRounds;
            for (const BoundaryConflict& conflict : conflicts[f]) {
                const auto here = cuts_for(f, conflict);
                if (here.empty() || hopeless) {
                    refuse_boundary(f, conflict);
                    refused.push_back(f);
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

// Whether the edge is shorter than the tolerance of the model there.
bool Tessellator::is_tiny(int e, double tolerance) const {
    const Edge& edge = model_.edges[std::size_t(e)];
    const EdgeMesh& mesh = edges_->mesh(e);
    if (edge.degenerate || edge.start == edge.end) return false;
    const Vertex &from = model_.vertices[std::size_t(edge.start)],
                 &to = model_.vertices[std::size_t(edge.end)];
    double reach = norm(to.point - from.point);
    for (const double t : mesh.parameters) reach = std::max(reach, norm(edges_->position(e, t) - from.point));
    return reach + mesh.bound <= std::max({edge.tolerance, from.tolerance, to.tolerance, tolerance});
}

void Tessellator::resolve_conflicts() {
    std::vector<std::vector<double>> before;
    for (;;) {
        bool again = false;
        std::set<int> points;  // edges that become points, of several faces mostly
        for (const std::size_t f : cut_conflicts(before)) {
            again = again || !before.empty();
            for (const Loop& loop : model_.faces[f].loops)
                for (const Coedge& use : loop.coedges)
                    if (points.contains(use.edge) ||
                        (!edges_->mesh(use.edge).collapsed && is_tiny(use.edge, model_.faces[f].tolerance))) {
                        points.insert(use.edge);
                        refusals_[f].reset();
                    }
        }
        for (const int e : points) edges_->mesh(e).collapsed = again = true;
        if (!again) return;
        for (std::size_t e = 0; e < before.size(); ++e) edges_->mesh(int(e)).parameters = before[e];
    }
}

}  // namespace freiform
