// From a model to a mesh.
//
// Idea: an edge is discretised once, for its own curve and for all faces that use it; faces only fill the
// polygons that result. Two faces that share an edge therefore share its points, and no crack can open,
// whatever the tolerance. Method: (1) discretise edges; (2) assemble the boundary polygons, and cut segments
// that touch each other in the parameter plane until none does; (3) fill the faces, in parallel; (4) cut
// inner edges that two faces happen to have both (a strip between the same two corners), which would be
// non-manifold. Accuracy: see curvature_tree.cpp for triangles and edge_mesh.cpp for what lies between
// polygon and parameter curve. The rounding of evaluated points is added to the bound.
#include "matched_grids_detail.hpp"
#include "tessellator_detail.hpp"

#include <freiform/core/parallel.hpp>
#include <freiform/mesh/face_mesh.hpp>
#include <freiform/model/tessellate.hpp>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <map>
#include <numeric>
#include <set>

namespace freiform {

namespace {

constexpr int kConflictRounds = 12;  // each halves the segments that touch
constexpr int kManifoldRounds = 4;

double now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

}  // namespace

SharedWork::SharedWork(const Model& model)
    : queries([&] {
          std::vector<std::unique_ptr<DerivativeQuery<2, 3>>> all(model.faces.size());
          parallel_for(all.size(), 1, [&](std::size_t f) {
              all[f] = std::make_unique<DerivativeQuery<2, 3>>(model.faces[f].surface);
          });
          return all;
      }()),
      edges(model, queries) {}

Result<void> Tessellator::discretise_edges() {
    std::vector<std::optional<Refusal>> failed(model_.edges.size());
    parallel_for(model_.edges.size(), 4, [&](std::size_t e) {
        if (edges_->mesh(int(e)).uses.empty()) return;
        if (auto ok = edges_->discretise(int(e), edge_demands(), std::size_t(options_.max_triangles)); !ok)
            failed[e] = ok.error();
    });
    for (std::size_t e = 0; e < failed.size(); ++e) {
        if (!failed[e]) continue;
        if (failed[e]->kind == RefusalKind::limit) return std::unexpected(*failed[e]);
        for (const auto& use : edges_->mesh(int(e)).uses)
            if (!is_refused(std::size_t(use->face))) refusals_[std::size_t(use->face)] = failed[e];
    }
    // Edges between the same two vertices must differ by more than their ends.
    std::map<std::pair<int, int>, std::vector<int>> same_ends;
    for (std::size_t e = 0; e < model_.edges.size(); ++e)
        if (const Edge& edge = model_.edges[e];
            !edge.degenerate && edges_->mesh(int(e)).parameters.size() == 2)
            same_ends[std::minmax(edge.start, edge.end)].push_back(int(e));
    for (const auto& [ends, list] : same_ends)
        if (list.size() > 1)
            for (int e : list)
                if (!model_.edges[std::size_t(e)].curve ||
                    !std::holds_alternative<Line<3>>(*model_.edges[std::size_t(e)].curve))
                    edges_->split(e, 0);
    return {};
}

FaceDemands Tessellator::face_demands(std::size_t f) const {
    return {tolerance_,          options_.max_edge, options_.max_angle,
            options_.max_aspect, options_.quads,    f < grids_.size() && grids_[f] ? &*grids_[f] : nullptr,
            faces() == 1};
}

Result<void> Tessellator::match_grids() {
    if (!options_.quads) return {};
    auto grids = matched_grids(model_, queries_, *edges_, edge_demands(), face_demands(faces()), refusals_,
                               double(options_.max_triangles) / 2);
    if (!grids)
        return refuse(RefusalKind::limit, "max_triangles",
                      text("more than ", options_.max_triangles, " triangles are needed for quads within ",
                           options_.tolerance));
    grids_ = std::move(*grids);
    return {};
}

// Mesh points: one per used vertex, then those inside the edges.
void Tessellator::number_points() {
    points_.clear();
    std::vector<int> of_vertex(model_.vertices.size(), -1);
    const auto at_vertex = [&](int v) {
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
            mesh.points[k] = edge.degenerate ? mesh.points.front() : int(points_.size());
            if (!edge.degenerate) points_.push_back(edges_->position(int(e), mesh.parameters[k]));
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

void Tessellator::resolve_conflicts() {
    std::vector<char> stale(faces(), 1);
    for (int round = 0;; ++round) {
        number_points();
        std::vector<std::vector<BoundaryConflict>> conflicts(faces());
        parallel_for(faces(), 1, [&](std::size_t f) {
            if (is_refused(f)) return;
            assemble(f);  // point numbers change with every cut
            if (!is_refused(f) && stale[f]) conflicts[f] = find_conflicts(boundaries_[f].polygon);
        });
        std::set<std::pair<int, int>, std::greater<>> cuts;  // later segments of an edge first
        std::fill(stale.begin(), stale.end(), 0);
        for (std::size_t f = 0; f < faces(); ++f) {
            for (const BoundaryConflict& conflict : conflicts[f]) {
                std::set<std::pair<int, int>> here;
                const auto add = [&](int s) {
                    if (s >= 0 && boundaries_[f].sources[std::size_t(s)].edge >= 0)
                        here.insert({boundaries_[f].sources[std::size_t(s)].edge,
                                     boundaries_[f].sources[std::size_t(s)].segment});
                };
                add(conflict.first);
                add(conflict.second);
                if (conflict.second < 0 &&
                    conflict.corner >= 0)  // a segment through a corner: the corner's neighbours too
                    for (std::size_t s = 0; s < boundaries_[f].polygon.segments.size(); ++s)
                        for (int end : boundaries_[f].polygon.segments[s])
                            if (end == conflict.corner) add(int(s));
                if (here.empty() || round == kConflictRounds) {
                    refuse_boundary(f, conflict);
                    break;
                }
                cuts.insert(here.begin(), here.end());
            }
        }
        if (cuts.empty() || round == kConflictRounds) return;
        for (const auto& [edge, segment] : cuts) {
            edges_->split(edge, segment);
            for (const auto& use : edges_->mesh(edge).uses) stale[std::size_t(use->face)] = 1;
        }
    }
}

Result<void> Tessellator::fill(std::span<const std::size_t> which) {
    std::atomic<std::size_t> done{0};
    std::atomic<bool> stop{false};
    std::atomic<long long> total{0};
    std::vector<std::optional<Refusal>> limits(which.size());
    parallel_for(which.size(), 1, [&](std::size_t i) {
        const std::size_t f = which[i];
        if (is_refused(f) || stop) return;
        auto mesh = mesh_face(*queries_[f], boundaries_[f].polygon, face_demands(f), options_.max_triangles,
                              extra_[f]);
        if (mesh) {
            if ((total += (long long)(mesh->triangles.size())) > options_.max_triangles) stop = true;
            meshes_[f] = std::move(*mesh);
        } else if (mesh.error().kind == RefusalKind::limit) {
            limits[i] = mesh.error();
            stop = true;
        } else {
            refusals_[f] = mesh.error();
        }
        if (options_.progress && !options_.progress(double(++done) / double(which.size()))) stop = true;
    });
    for (const auto& l : limits)
        if (l) return std::unexpected(*l);
    if (total > options_.max_triangles)
        return refuse(
            RefusalKind::limit, "max_triangles",
            text("more than ", options_.max_triangles, " triangles are needed within ", options_.tolerance));
    if (stop) return refuse(RefusalKind::limit, "progress", "stopped by the caller");
    return {};
}

// Faces with an inner edge between two boundary points that also is an edge elsewhere; `extra_` gets its
// middle.
std::vector<std::size_t> Tessellator::non_manifold_faces() {
    struct Side {
        int a, b;
        int face, u, v;  // corners in the face
        bool operator<(const Side& o) const { return std::tie(a, b, face) < std::tie(o.a, o.b, o.face); }
    };
    std::vector<Side> sides;
    for (std::size_t f = 0; f < faces(); ++f) {
        if (is_refused(f)) continue;
        const FaceMesh& mesh = meshes_[f];
        for (const auto& t : mesh.triangles)
            for (int k = 0; k < 3; ++k) {
                const int u = t[std::size_t(k)], v = t[std::size_t((k + 1) % 3)];
                // Poles have more corners than the polygon knows.
                const auto [a, b] = std::minmax(mesh.point[std::size_t(u)], mesh.point[std::size_t(v)]);
                if (a < 0) continue;
                sides.push_back({a, b, int(f), u, v});
            }
    }
    std::sort(sides.begin(), sides.end());
    std::set<std::size_t> again;
    for (std::size_t i = 0; i < sides.size();) {
        std::size_t j = i;
        while (j < sides.size() && sides[j].a == sides[i].a && sides[j].b == sides[i].b) ++j;
        if (j - i > 2)
            for (std::size_t k = i; k < j; ++k) {
                const auto& s = sides[k];
                const auto& segments = boundaries_[std::size_t(s.face)].polygon.segments;
                const bool boundary =
                    std::any_of(segments.begin(), segments.end(), [&](const std::array<int, 2>& g) {
                        return (g[0] == s.u && g[1] == s.v) || (g[0] == s.v && g[1] == s.u);
                    });
                if (boundary) continue;
                const auto& uv = meshes_[std::size_t(s.face)].uv;
                const Vec<2> middle = 0.5 * (uv[std::size_t(s.u)] + uv[std::size_t(s.v)]);
                auto& extra = extra_[std::size_t(s.face)];
                if (std::find(extra.begin(), extra.end(), middle) == extra.end()) {
                    extra.push_back(middle);
                    again.insert(std::size_t(s.face));
                }
            }
        i = j;
    }
    return {again.begin(), again.end()};
}

Result<void> Tessellator::fill_all() {
    std::vector<std::size_t> which(faces());
    std::iota(which.begin(), which.end(), std::size_t(0));
    for (int round = 0; !which.empty(); ++round) {
        if (auto ok = fill(which); !ok) return std::unexpected(ok.error());
        if (round == kManifoldRounds) break;
        which = non_manifold_faces();
    }
    return {};
}

// Parameters that are so large or small that their squares leave little room in double precision.
std::optional<Refusal> Tessellator::far_parameter(std::size_t f) const {
    constexpr double kLargest = 0x1p320;
    const auto& loops = model_.faces[f].loops;
    for (std::size_t l = 0; l < loops.size(); ++l)
        for (std::size_t c = 0; c < loops[l].coedges.size(); ++c) {
            const Coedge& coedge = loops[l].coedges[c];
            const Interval on = model_.edges[std::size_t(coedge.edge)].range;
            const Vec<2> a = jet<0>(coedge.curve, on.lo).value(), b = jet<0>(coedge.curve, on.hi).value();
            const double most = std::max({std::abs(on.lo), std::abs(on.hi), max_abs(a), max_abs(b)});
            if (!(most <= kLargest))
                return Refusal{RefusalKind::unsupported, text("loops[", l, "][", c, "]"),
                               text("the parameter ", most, " is larger than 2^320")};
            if (!(on.length() >= 1 / kLargest))
                return Refusal{RefusalKind::unsupported, text("loops[", l, "][", c, "]"),
                               text("the range [", on.lo, ", ", on.hi, "] is shorter than 2^-320")};
        }
    return std::nullopt;
}

Result<Tessellation> Tessellator::run() {
    const double start = now();
    Box<3> box;
    for (const Vertex& v : model_.vertices) box.add(v.point);
    rounding_ = 1e-12 * box.scale();
    // Room for the sliver between polygon and parameter curve (a 32nd) and for rounding.
    tolerance_ = options_.tolerance * (1 - 1.0 / 16);
    for (std::size_t f = 0; f < faces(); ++f) {
        if (model_.faces[f].loops.empty())
            refusals_[f] = Refusal{RefusalKind::invalid, "loops", "the face has no boundary"};
        if (auto bad = far_parameter(f)) refusals_[f] = *bad;
        for (int axis = 0; axis < 2; ++axis)
            for (const Kink& k : queries_[f]->kinks(axis))
                if (!std::isfinite(k.jump) && !refusals_[f])
                    refusals_[f] = Refusal{RefusalKind::unsupported, text(axis == 0 ? "u = " : "v = ", k.at),
                                           "the surface is torn here (a knot of multiplicity degree + 1)"};
    }
    edges_->forget();
    if (auto ok = discretise_edges(); !ok) return std::unexpected(ok.error());
    if (auto ok = match_grids(); !ok) return std::unexpected(ok.error());
    resolve_conflicts();
    const double meshed_edges = now();
    if (auto ok = fill_all(); !ok) return std::unexpected(ok.error());
    Tessellation out = collect();
    out.seconds = {meshed_edges - start, now() - meshed_edges, now() - start};
    return out;
}

}  // namespace freiform
