// From a model to a mesh.
//
// Idea: an edge is discretised once, for its own curve and for all faces that use it; faces only fill the
// polygons that result. Two faces that share an edge therefore share its points, and no crack can open,
// whatever the tolerance. Method: (1) discretise edges; (2) assemble the boundary polygons, and cut segments
// that touch each other in the parameter plane until none does; (3) fill the faces, in parallel; (4) cut
// inner edges that two faces happen to have both (a strip between the same two corners), which would be
// non-manifold. Accuracy: see curvature_tree.cpp for triangles and edge_mesh.cpp for what lies between
// polygon and parameter curve. The rounding of evaluated points is added to the bound.
#include "face_boundary_detail.hpp"
#include "triangle_budget_detail.hpp"

#include <freiform/core/parallel.hpp>
#include <freiform/mesh/face_mesh.hpp>
#include <freiform/model/tessellate.hpp>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <map>
#include <set>

namespace freiform {

namespace {

// What triangles beside the boundary add to the bound of an edge at most: see bending.cpp.
constexpr double kBesideBoundary = 1 + 1.0 / 64;
constexpr int kConflictRounds = 12;  // each halves the segments that touch
constexpr int kManifoldRounds = 4;

double now() {
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

class Tessellator {
public:
    Tessellator(const Model& model, const TessellateOptions& options)
        : model_(model),
          options_(options),
          queries_(model.faces.size()),
          boundaries_(model.faces.size()),
          meshes_(model.faces.size()),
          extra_(model.faces.size()),
          refusals_(model.faces.size()) {}

    Result<Tessellation> run();

private:
    std::size_t faces() const { return model_.faces.size(); }
    bool is_refused(std::size_t f) const { return refusals_[f].has_value(); }
    Result<void> discretise_edges();
    void number_points();
    void assemble(std::size_t face);
    void refuse_boundary(std::size_t face, const BoundaryConflict& conflict);
    void resolve_conflicts();
    Result<void> fill(std::span<const std::size_t> which);
    std::vector<std::size_t> non_manifold_faces();
    Tessellation collect();
    Vec<3> normal_at(std::size_t face, const Vec<2>& uv, const Vec<2>& inwards,
                     const Jet<2, 1, Vec<3>>& here) const;
    double rounding_of(std::size_t face) const;

    const Model& model_;
    const TessellateOptions& options_;
    double tolerance_ = 0, rounding_ = 0;
    std::vector<std::unique_ptr<DerivativeQuery<2, 3>>> queries_;
    std::unique_ptr<EdgeMesher> edges_;
    std::vector<Vec<3>> points_;  // on vertices and edges
    std::vector<BoundaryOfFace> boundaries_;
    std::vector<FaceMesh> meshes_;
    std::vector<std::vector<Vec<2>>> extra_;
    std::vector<std::optional<Refusal>> refusals_;
};

Result<void> Tessellator::discretise_edges() {
    std::vector<std::optional<Refusal>> failed(model_.edges.size());
    parallel_for(model_.edges.size(), 4, [&](std::size_t e) {
        if (edges_->mesh(int(e)).uses.empty()) return;
        if (auto ok = edges_->discretise(int(e), tolerance_ / kBesideBoundary, options_.max_edge,
                                         std::size_t(options_.max_triangles));
            !ok)
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
        auto mesh = mesh_face(*queries_[f], boundaries_[f].polygon, {tolerance_, options_.max_edge},
                              options_.max_triangles, extra_[f]);
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
        const auto& polygon = boundaries_[f].polygon;
        const int n = int(polygon.uv.size());
        for (const auto& t : meshes_[f].triangles)
            for (int k = 0; k < 3; ++k) {
                const int u = t[std::size_t(k)], v = t[std::size_t((k + 1) % 3)];
                if (u >= n || v >= n) continue;
                const auto [a, b] = std::minmax(polygon.point[std::size_t(u)], polygon.point[std::size_t(v)]);
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
                const auto& polygon = boundaries_[std::size_t(s.face)].polygon;
                const bool boundary = std::any_of(
                    polygon.segments.begin(), polygon.segments.end(), [&](const std::array<int, 2>& g) {
                        return (g[0] == s.u && g[1] == s.v) || (g[0] == s.v && g[1] == s.u);
                    });
                if (boundary) continue;
                const Vec<2> middle = 0.5 * (polygon.uv[std::size_t(s.u)] + polygon.uv[std::size_t(s.v)]);
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

// Unit normal, from the jet at uv; where the surface has none (a pole), that of a point a little inside the
// triangle.
Vec<3> Tessellator::normal_at(std::size_t f, const Vec<2>& uv, const Vec<2>& inwards,
                              const Jet<2, 1, Vec<3>>& here) const {
    const SurfaceGeometry& surface = model_.faces[f].surface;
    for (double step : {0.0, 1e-6, 1e-4, 1e-2, 0.5}) {
        const Vec<2> at = (1 - step) * uv + step * inwards;
        const auto j = step == 0 ? here : jet<1>(surface, at.c);
        const Vec<3> m = cross(j.d[1], j.d[2]);
        if (norm(m) > 1e-9 * norm(j.d[1]) * norm(j.d[2]) && max_abs(j.d[1]) > 0 && max_abs(j.d[2]) > 0) {
            // A vanishing derivative leaves the direction of the other to chance.
            const auto inner = jet<1>(surface, inwards.c);
            if (norm(j.d[1]) > 1e-9 * norm(inner.d[1]) && norm(j.d[2]) > 1e-9 * norm(inner.d[2]))
                return unit(m);
        }
    }
    return {};
}

double Tessellator::rounding_of(std::size_t f) const {
    Box<2> box;
    for (const Vec<2>& p : boundaries_[f].polygon.uv) box.add(p);
    return box.is_empty() ? 0 : 2 * value_error_bound(model_.faces[f].surface, {box.side(0), box.side(1)});
}

Tessellation Tessellator::collect() {
    Tessellation out;
    out.mesh.unit = model_.unit;
    out.mesh.points = points_;
    std::vector<char> flipped(faces(), 0);
    for (const Shell& s : model_.shells)
        for (const FaceUse& u : s.faces) flipped[std::size_t(u.face)] = u.reversed;
    std::vector<const Colour*> body_colour(faces(), nullptr);
    for (const Body& b : model_.bodies)
        if (b.colour)
            for (int s : b.shells)
                for (const FaceUse& u : model_.shells[std::size_t(s)].faces)
                    body_colour[std::size_t(u.face)] = &*b.colour;
    for (std::size_t f = 0; f < faces(); ++f) {
        const Face& face = model_.faces[f];
        if (is_refused(f)) {
            out.refused.push_back({int(f), face.name, *refusals_[f]});
            continue;
        }
        const FaceMesh& m = meshes_[f];
        const bool flip = face.reversed != bool(flipped[f]);
        const int base = int(out.mesh.vertices.size());
        std::vector<Vec<2>> inwards(m.uv.size());
        for (const auto& t : m.triangles)
            for (int k = 0; k < 3; ++k)
                inwards[std::size_t(t[std::size_t(k)])] =
                    (1.0 / 3) * (m.uv[std::size_t(t[0])] + m.uv[std::size_t(t[1])] + m.uv[std::size_t(t[2])]);
        for (std::size_t i = 0; i < m.uv.size(); ++i) {
            MeshVertex v;
            v.uv = m.uv[i];
            v.point = m.point[i];
            const auto here = jet<1>(face.surface, m.uv[i].c);
            if (v.point < 0) {
                v.point = int(out.mesh.points.size());
                out.mesh.points.push_back(here.value());
            }
            v.normal = normal_at(f, m.uv[i], inwards[i], here);
            if (flip) v.normal = -v.normal;
            out.mesh.vertices.push_back(v);
        }
        MeshPart part{face.name, face.colour, int(out.mesh.triangles.size()), 0, int(f)};
        if (!part.colour && body_colour[f]) part.colour = *body_colour[f];
        for (auto t : m.triangles) {
            if (flip) std::swap(t[1], t[2]);
            for (int& i : t) i += base;
            const std::size_t last = out.mesh.triangles.size();
            out.mesh.triangles.push_back(t);
            const auto p = out.mesh.points_of(last);
            if (p[0] == p[1] || p[1] == p[2] || p[2] == p[0]) out.mesh.triangles.pop_back();
        }
        part.count = int(out.mesh.triangles.size()) - part.first;
        out.mesh.parts.push_back(part);

        FaceReport report{int(f), part.count, m.bound, boundaries_[f].gap};
        for (const Loop& l : face.loops)
            for (const Coedge& c : l.coedges)
                report.error_bound =
                    std::max(report.error_bound, kBesideBoundary * edges_->mesh(c.edge).bound);
        report.error_bound += rounding_of(f);
        out.error_bound = std::max(out.error_bound, report.error_bound);
        out.boundary_gap = std::max(out.boundary_gap, report.boundary_gap);
        out.faces.push_back(report);
    }
    out.topology = topology(out.mesh);
    return out;
}

Result<Tessellation> Tessellator::run() {
    const double start = now();
    Box<3> box;
    for (const Vertex& v : model_.vertices) box.add(v.point);
    rounding_ = 1e-12 * box.scale();
    // Room for the sliver between polygon and parameter curve (a 32nd) and for rounding.
    tolerance_ = options_.tolerance * (1 - 1.0 / 16);
    if (auto ok = check_budget(model_, options_); !ok) return std::unexpected(ok.error());
    for (std::size_t f = 0; f < faces(); ++f) {
        queries_[f] = std::make_unique<DerivativeQuery<2, 3>>(model_.faces[f].surface);
        if (model_.faces[f].loops.empty())
            refusals_[f] = Refusal{RefusalKind::invalid, "loops", "the face has no boundary"};
        for (int axis = 0; axis < 2; ++axis)
            for (const Kink& k : queries_[f]->kinks(axis))
                if (!std::isfinite(k.jump) && !refusals_[f])
                    refusals_[f] = Refusal{RefusalKind::unsupported, text(axis == 0 ? "u = " : "v = ", k.at),
                                           "the surface is torn here (a knot of multiplicity degree + 1)"};
    }
    edges_ = std::make_unique<EdgeMesher>(model_, queries_);
    if (auto ok = discretise_edges(); !ok) return std::unexpected(ok.error());
    resolve_conflicts();
    const double meshed_edges = now();
    std::vector<std::size_t> which(faces());
    for (std::size_t f = 0; f < faces(); ++f) which[f] = f;
    for (int round = 0; !which.empty(); ++round) {
        if (auto ok = fill(which); !ok) return std::unexpected(ok.error());
        if (round == kManifoldRounds) break;
        which = non_manifold_faces();
    }
    Tessellation out = collect();
    out.seconds = {meshed_edges - start, now() - meshed_edges, now() - start};
    return out;
}

}  // namespace

Result<Tessellation> tessellate(const Model& model, const TessellateOptions& options) {
    if (!std::isfinite(options.tolerance))
        return refuse(RefusalKind::nonfinite, "tolerance",
                      text(options.tolerance, " is not a finite number"));
    if (!(options.tolerance > 0))
        return refuse(RefusalKind::invalid, "tolerance", text(options.tolerance, " is not positive"));
    if (!(options.max_edge > 0))
        return refuse(RefusalKind::invalid, "max_edge", text(options.max_edge, " is not positive"));
    return Tessellator(model, options).run();
}

}  // namespace freiform
