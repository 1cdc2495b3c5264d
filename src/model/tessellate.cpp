// From a model to a mesh.
//
// Idea: an edge is discretised once, for its own curve and for all faces that use it; faces only fill the
// polygons that result. Two faces that share an edge therefore share its points, and no crack can open,
// whatever the tolerance. Method: (1) discretise edges; (2) assemble the boundary polygons, and cut segments
// that touch each other in the parameter plane until none does; (3) fill the faces, in parallel; (4) cut
// inner edges that two faces happen to have both (a strip between the same two corners), which would be
// non-manifold, and triangles without area. Accuracy: see curvature_tree.cpp for triangles and edge_mesh.cpp
// for what lies between polygon and parameter curve. The rounding of evaluated points is added to the bound.
#include "matched_grids_detail.hpp"
#include "tessellator_detail.hpp"
#include "triangle_budget_detail.hpp"

#include <freiform/core/parallel.hpp>
#include <freiform/core/sort.hpp>
#include <freiform/mesh/chord_triangles.hpp>
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

constexpr int kManifoldRounds = 4;
constexpr std::size_t kFacesAtATime = 8;  // that a thread looks at for an apex
constexpr double kLargeFace = 4096;       // triangles
constexpr double kFlatTriangle = 1e-9;    // of the squared longest side: no area

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
      apexes([&] {
          std::vector<std::optional<Apex>> all(model.faces.size());
          parallel_for(all.size(), kFacesAtATime, [&](std::size_t f) {
              if (queries[f]->weight_spread() <= kWeightsFarApart)
                  all[f] = apex_for(model.faces[f].surface, sampled_box(model, model.faces[f]));
          });
          return all;
      }()),
      edges(model, queries, apexes) {}

Result<void> Tessellator::discretise_edges() {
    std::vector<std::optional<Refusal>> failed(model_.edges.size());
    parallel_for(model_.edges.size(), 1, [&](std::size_t e) {
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

// Whether threads share the work of this face.
bool Tessellator::is_large(std::size_t f) const {
    return faces() == 1 || (f < sizes_.size() && sizes_[f] >= kLargeFace);
}

FaceDemands Tessellator::face_demands(std::size_t f) const {
    return {tolerance_,
            options_.max_edge,
            options_.max_angle,
            options_.max_aspect,
            options_.quads,
            f < grids_.size() && grids_[f] ? &*grids_[f] : nullptr,
            is_large(f),
            f < sizes_.size() ? sizes_[f] : 0,
            f < faces() && apexes_[f] && apexes_[f]->is_true_to(edge_demands().tolerance) ? apexes_[f]
                                                                                          : std::nullopt};
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

Result<void> Tessellator::fill(std::span<const std::size_t> which) {
    std::atomic<std::size_t> done{0};
    std::atomic<bool> stop{false};
    std::atomic<long long> total{0};
    std::vector<std::optional<Refusal>> limits(which.size());
    // The largest first, so that none is left over at the end.
    std::vector<std::size_t> order(which.begin(), which.end());
    sort(order.begin(), order.end(),
         [&](std::size_t f, std::size_t g) { return std::pair(sizes_[g], f) < std::pair(sizes_[f], g); });
    std::atomic<std::size_t> next{0};
    parallel_for(order.size(), 1, [&](std::size_t) {
        const std::size_t i = next++, f = order[i];
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

// Notes a point inside a face to begin with; false if that has been done.
bool Tessellator::add_extra(std::size_t f, const Vec<2>& uv) {
    auto& extra = extra_[f];
    if (std::find(extra.begin(), extra.end(), uv) != extra.end()) return false;
    extra.push_back(uv);
    return true;
}

// The middle of a side that is not of the boundary.
bool Tessellator::halve(std::size_t f, int u, int v) {
    for (const auto& s : boundaries_[f].polygon.segments)
        if ((s[0] == u && s[1] == v) || (s[0] == v && s[1] == u)) return false;
    const auto& uv = meshes_[f].uv;
    return add_extra(f, 0.5 * (uv[std::size_t(u)] + uv[std::size_t(v)]));
}

// A point in the triangle across this side of a triangle without area, which is then seen from its third
// corner: the side goes. At a pole the one across may be left out, as two of its corners are one point: it is
// beside one that goes on from there.
bool Tessellator::look_across(std::size_t f, int u, int v) {
    const FaceMesh& mesh = meshes_[f];
    const auto add_towards = [&](int w) {  // no farther than its middle, and than half of the side
        const Vec<2>&p = mesh.uv[std::size_t(u)], &q = mesh.uv[std::size_t(v)], middle = 0.5 * (p + q),
              way = mesh.uv[std::size_t(w)] - middle;
        return add_extra(f, middle + std::min(1.0 / 3, norm(q - p) / (2 * norm(way))) * way);
    };
    const auto are_one = [&](int a, int b) {
        const int point = mesh.point[std::size_t(a)];
        return point >= 0 && point == mesh.point[std::size_t(b)];
    };
    int beyond = -1;
    for (const auto& t : mesh.triangles)
        for (std::size_t k = 0; k < 3; ++k) {
            const int a = t[k], b = t[(k + 1) % 3];
            if (a == v && b == u) return add_towards(t[(k + 2) % 3]);
            if (b == u && are_one(a, v)) beyond = a;
            if (a == v && are_one(b, u)) beyond = b;
        }
    return beyond >= 0 && add_towards(beyond);
}

// The longest side of a triangle of three boundary points on a line: a straight edge whose parameter curve
// is not straight has them. Corners of the face, or -1.
std::array<int, 2> Tessellator::flat_side(const FaceMesh& mesh, const std::array<int, 3>& t) const {
    std::array<Vec<3>, 3> p;
    for (std::size_t k = 0; k < 3; ++k) {
        const int point = mesh.point[std::size_t(t[k])];
        if (point < 0) return {-1, -1};
        p[k] = points_[std::size_t(point)];
    }
    const auto side = [&](std::size_t k) { return norm(p[(k + 1) % 3] - p[k]); };
    std::size_t longest = 0;
    for (std::size_t k = 1; k < 3; ++k)
        if (side(k) > side(longest)) longest = k;
    if (norm(cross(p[1] - p[0], p[2] - p[0])) > kFlatTriangle * side(longest) * side(longest))
        return {-1, -1};
    return {t[longest], t[(longest + 1) % 3]};
}

// Faces with an inner edge between two boundary points that also is an edge elsewhere, or with a triangle of
// boundary points that has no area; `extra_` gets points that mend it.
std::vector<std::size_t> Tessellator::faces_to_mend() {
    struct Side {
        int a, b;
        int face, u, v;  // corners in the face
        bool operator<(const Side& o) const { return std::tie(a, b, face) < std::tie(o.a, o.b, o.face); }
    };
    std::vector<Side> sides;
    std::set<std::size_t> again;
    for (std::size_t f = 0; f < faces(); ++f) {
        if (is_refused(f)) continue;
        const FaceMesh& mesh = meshes_[f];
        const auto last = std::find_if(mesh.point.rbegin(), mesh.point.rend(), [](int p) { return p >= 0; });
        const int end = int(mesh.point.rend() - last);  // behind the corners on edges, which come first
        for (const auto& t : mesh.triangles) {
            if (std::min({t[0], t[1], t[2]}) >= end) continue;
            for (int k = 0; k < 3; ++k) {
                const int u = t[std::size_t(k)], v = t[std::size_t((k + 1) % 3)];
                // Poles have more corners than the polygon knows.
                const auto [a, b] = std::minmax(mesh.point[std::size_t(u)], mesh.point[std::size_t(v)]);
                if (a >= 0) sides.push_back({a, b, int(f), u, v});
            }
            const auto [u, v] = flat_side(mesh, t);
            if (u >= 0 && look_across(f, u, v)) again.insert(f);
        }
    }
    sort(sides.begin(), sides.end());
    for (std::size_t i = 0; i < sides.size();) {
        std::size_t j = i;
        while (j < sides.size() && sides[j].a == sides[i].a && sides[j].b == sides[i].b) ++j;
        for (std::size_t k = i; j - i > 2 && k < j; ++k)
            if (halve(std::size_t(sides[k].face), sides[k].u, sides[k].v))
                again.insert(std::size_t(sides[k].face));
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
        which = faces_to_mend();
    }
    add_strips();
    // A loop that runs back along itself; where parts of edges became points the face is smaller than the
    // tolerance.
    for (std::size_t f = 0; f < faces(); ++f) {
        bool empty = !is_refused(f) && meshes_[f].triangles.empty();
        for (const Loop& l : model_.faces[f].loops)
            for (const Coedge& c : l.coedges) {
                const EdgeMesh& mesh = edges_->mesh(c.edge);
                empty = empty && !mesh.collapsed && !(mesh.moved > 0);
            }
        if (empty)
            refusals_[f] = Refusal{RefusalKind::invalid, "loops",
                                   "the boundary encloses nothing in the parameter plane"};
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
    // Room for the rounding of points, and for others to prove the tolerance anew (deviation.hpp), whose
    // bounds come near to what is measured with much work alone: a 32nd was not enough for
    // tests/model/deviation_test. Planes that stand in for splines take a 32nd of it (flat_faces.cpp).
    tolerance_ = options_.tolerance * (1 - 1.0 / 24);
    for (std::size_t f = 0; f < faces(); ++f) {
        if (model_.faces[f].loops.empty())
            refusals_[f] = Refusal{RefusalKind::invalid, "loops", "the face has no boundary"};
        if (auto bad = far_parameter(f)) refusals_[f] = *bad;
        for (int axis = 0; axis < 2; ++axis)
            for (const Kink& k : queries_[f]->kinks(axis))
                if (!std::isfinite(k.jump) && !refusals_[f])
                    refusals_[f] =
                        Refusal{RefusalKind::unsupported, text(axis == 0 ? "u = " : "v = ", k.at),
                                std::holds_alternative<OffsetSurface>(model_.faces[f].surface)
                                    ? "the offset is torn here: its base has a kink, or may have no normal"
                                    : "the surface is torn here (a knot of multiplicity degree + 1)"};
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
