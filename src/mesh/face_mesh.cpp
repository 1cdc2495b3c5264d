// Filling a polygon with triangles that a proof accepts.
//
// Method: a tree of boxes with curvature bounds (curvature_tree.cpp) says how dense points have to be. Boxes
// inside that bend evenly are cut into cells, which become triangles as they are (blocks.cpp). Around them
// the corners of leaves are inserted into the constrained Delaunay triangulation of the boundary; every
// triangle is then judged by its own bound, and one that fails gets a point: the middle of its longest side,
// or of the next one that is not part of the boundary, or where the side crosses a kink of the surface. Only
// inner points are added, so that the neighbours across the boundary never notice. Metric: Delaunay in the
// plane where a mean leaf is a square, since leaves have about equal error in both directions and the
// Delaunay triangulation has the smallest largest min-containment circle. The scales are powers of two, so
// nothing is rounded. Cost: one bound per created triangle, from leaves near those of the triangle before.
// Accuracy: `bound` is the largest over all triangles, collapsed ones (at poles) included, because the
// surface there has to be near something too.
#include "blocks_detail.hpp"
#include "filler_detail.hpp"
#include "simple_polygons_detail.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/core/sort.hpp>
#include <freiform/mesh/face_mesh.hpp>
#include <freiform/mesh/grid.hpp>
#include <freiform/mesh/triangulate.hpp>

#include <algorithm>
#include <cmath>
#include <map>

namespace freiform {

namespace {

constexpr int kSeparateRounds = 16;
constexpr int kAttemptsAround = 6;
constexpr std::size_t kPatience = 16;  // times the points that are expected
constexpr std::size_t kHope = 4;       // likewise, where there is another way

// The boundary with equal corners merged, ready for the triangulation.
struct Polygon {
    std::vector<Vec<2>> points;
    std::vector<int> corner;  // of FaceBoundary, the first that is this point
    std::vector<Triangulation::Segment> segments;
    std::vector<int> segment_source;
};

std::expected<Polygon, BoundaryConflict> merged(const FaceBoundary& boundary) {
    Polygon out;
    std::map<std::array<double, 2>, int> known;
    std::vector<int> at(boundary.uv.size());
    for (std::size_t i = 0; i < boundary.uv.size(); ++i) {
        const Vec<2>& p = boundary.uv[i];
        const auto [it, fresh] = known.try_emplace({p[0] + 0.0, p[1] + 0.0}, int(out.points.size()));
        if (fresh) {
            out.points.push_back(p);
            out.corner.push_back(int(i));
        } else if (boundary.point[std::size_t(out.corner[std::size_t(it->second)])] != boundary.point[i]) {
            return std::unexpected(
                BoundaryConflict{-1, -1, int(i), text("two vertices lie at u = ", p[0], ", v = ", p[1])});
        }
        at[i] = it->second;
    }
    for (std::size_t s = 0; s < boundary.segments.size(); ++s) {
        const auto [a, b] = boundary.segments[s];
        if (at[std::size_t(a)] == at[std::size_t(b)]) continue;
        out.segments.push_back({at[std::size_t(a)], at[std::size_t(b)]});
        out.segment_source.push_back(int(s));
    }
    return out;
}

// The power of two nearest to 1 / x.
double scale_for(double x) {
    return x > 0 && std::isfinite(x) ? std::ldexp(1.0, -std::ilogb(x * 1.4142)) : 1.0;
}

// A segment between two corners that are the same point in space (a pole) belongs to this face alone, so it
// may be cut where the leaves of the tree are.
void cut_poles(Polygon& polygon, const FaceBoundary& boundary, std::span<const CurvatureTree::Corner> corners,
               const Vec<2>& usual_leaf) {
    const std::vector<Triangulation::Segment> before = std::move(polygon.segments);
    polygon.segments.clear();
    for (const auto& s : before) {
        const int a = polygon.corner[std::size_t(s.a)], b = polygon.corner[std::size_t(s.b)];
        if (boundary.point[std::size_t(a)] != boundary.point[std::size_t(b)]) {
            polygon.segments.push_back(s);
            continue;
        }
        const Vec<2> p = boundary.uv[std::size_t(a)], q = boundary.uv[std::size_t(b)], d = q - p;
        std::vector<std::pair<double, Vec<2>>> cuts;  // by the part of the way
        if (d[0] == 0 || d[1] == 0) {
            const int axis = d[0] == 0 ? 1 : 0;
            for (const auto& [c, leaf] : corners)
                if (c[1 - axis] == p[1 - axis] && (c[axis] - p[axis]) * (c[axis] - q[axis]) < 0)
                    cuts.push_back({(c[axis] - p[axis]) / d[axis], c});
        } else {
            const int n = int(std::min(
                1000.0, std::ceil(std::max(std::abs(d[0]) / usual_leaf[0], std::abs(d[1]) / usual_leaf[1]))));
            for (int k = 1; k < n; ++k) cuts.push_back({double(k) / n, p + (double(k) / n) * d});
        }
        sort(cuts.begin(), cuts.end(), [](const auto& x, const auto& y) { return x.first < y.first; });
        int last = s.a;
        for (const auto& cut : cuts) {
            polygon.points.push_back(cut.second);
            polygon.corner.push_back(a);
            polygon.segments.push_back({last, int(polygon.points.size()) - 1});
            last = int(polygon.points.size()) - 1;
        }
        polygon.segments.push_back({last, s.b});
    }
}

}  // namespace

std::vector<BoundaryConflict> find_conflicts(const FaceBoundary& boundary) {
    auto polygon = merged(boundary);
    if (!polygon) return {polygon.error()};
    if (are_simple_polygons(polygon->points, polygon->segments)) return {};
    auto t = Triangulation::attempt(polygon->points, polygon->segments);
    if (t) return {};
    std::vector<BoundaryConflict> all;
    for (const auto& c : t.error().conflicts) {
        const auto source = [&](int s) { return s < 0 ? -1 : polygon->segment_source[std::size_t(s)]; };
        const int corner = c.point < 0 ? -1 : polygon->corner[std::size_t(c.point)];
        all.push_back({source(c.first_segment), source(c.second_segment), corner, t.error().refusal.message});
    }
    if (all.empty()) all.push_back({-1, -1, -1, t.error().refusal.message});
    return all;
}

namespace {

std::optional<GridLines> grid_of(const DerivativeQuery<2, 3>& surface, const CurvatureTree& tree,
                                 const Polygon& polygon, const FaceDemands& demands,
                                 long long max_triangles) {
    if (!demands.quads) return std::nullopt;
    if (demands.lines) return *demands.lines;
    Box<2> box;
    for (const Vec<2>& p : polygon.points) box.add(p);
    return grid_lines(
        surface, box, demands, [&](const Box<2>& cell) { return tree.is_outside(cell); },
        double(max_triangles) / 2);
}

// Row by row; without those on the edges of the grid if it is `inner`.
std::vector<CurvatureTree::Corner> crossings_of(const GridLines& lines, bool inner) {
    std::vector<CurvatureTree::Corner> out;
    const std::size_t nu = lines[0].size(), nv = lines[1].size(), first = inner ? 1 : 0;
    const auto width = [](const std::vector<double>& x, std::size_t i) {
        const double before = i > 0 ? x[i] - x[i - 1] : kInfinity;
        return i + 1 < x.size() ? std::min(before, x[i + 1] - x[i]) : before;
    };
    for (std::size_t i = first; i + first < nu; ++i)
        for (std::size_t row = first; row + first < nv; ++row) {
            const std::size_t k = i % 2 ? nv - 1 - row : row;
            out.push_back({{{lines[0][i], lines[1][k]}}, {{width(lines[0], i), width(lines[1], k)}}});
        }
    return out;
}

Vec<2> mean_cell(const GridLines& lines) {
    const auto mean = [](const std::vector<double>& x) {
        return (x.back() - x.front()) / double(x.size() - 1);
    };
    return {{mean(lines[0]), mean(lines[1])}};
}

// `outline`: the vertex of the first point of the outline, which is there; others are added.
void add_blocks(FaceMesh& out, const BlockMesh& blocks, int outline) {
    const int on_outline = int(blocks.outline.points.size()), others = int(out.uv.size()) - on_outline;
    out.uv.insert(out.uv.end(), blocks.points.begin(), blocks.points.end());
    out.point.resize(out.uv.size(), -1);
    out.bound = std::max(out.bound, blocks.bound);
    out.triangles.reserve(out.triangles.size() + blocks.triangles.size());
    for (std::array<int, 3> t : blocks.triangles) {
        for (int& p : t) p += p < on_outline ? outline : others;
        out.triangles.push_back(t);
    }
}

// What is asked for, and the tree that says how dense points have to be.
struct Filling {
    const DerivativeQuery<2, 3>& surface;
    const FaceBoundary& boundary;
    const FaceDemands& demands;
    long long max_triangles;
    std::span<const Vec<2>> extra;
    CurvatureTree::Ways ways;
    const CurvatureTree& tree;
    const Judge& judge;
};

std::vector<Vec<2>> scaled(std::span<const Vec<2>> points, const Vec<2>& scale) {
    std::vector<Vec<2>> out(points.begin(), points.end());
    for (Vec<2>& p : out) p = {{p[0] * scale[0], p[1] * scale[1]}};
    return out;
}

// The polygon of the boundary, as far as it can be triangulated without the outline of blocks.
struct Bounded {
    Polygon polygon;
    Vec<2> scale;
    Result<Triangulation> triangulation;
    std::vector<int> place;  // of its points: the first one that stands for the same mesh point
};

// `corners`: where poles may be cut.
Bounded bounded(const Filling& f, Polygon polygon, std::span<const CurvatureTree::Corner> corners,
                const Vec<2>& leaf) {
    cut_poles(polygon, f.boundary, corners, leaf);
    const Vec<2> scale{{scale_for(leaf[0]), scale_for(leaf[1])}};
    auto triangulation = Triangulation::make(scaled(polygon.points, scale), polygon.segments);
    std::vector<int> place;
    std::map<int, int> first;
    for (const int corner : polygon.corner)
        place.push_back(
            first.try_emplace(f.boundary.point[std::size_t(corner)], int(place.size())).first->second);
    return {std::move(polygon), scale, std::move(triangulation), std::move(place)};
}

// What lies outside the blocks. `corners`: points to begin with. `stuck`: where blocks have to be left out,
// if that is why there is nothing. `first_on_outline`: a vertex; the others on the outline follow it.
Result<FaceMesh> mesh_around(const Filling& f, Bounded inner, int merged_corners, const GridLines* grid,
                             std::span<const CurvatureTree::Corner> corners, const BlockOutline& outline,
                             std::vector<Vec<2>>& stuck, int& first_on_outline) {
    const auto& [surface, boundary, demands, max_triangles, extra, ways, tree, judge] = f;
    auto& [polygon, scale, triangulation, place] = inner;
    const double tolerance = demands.tolerance;
    if (!triangulation) return std::unexpected(triangulation.error());
    // The outline is a boundary as the polygon is.
    const int first_outline = int(polygon.points.size());
    std::vector<Triangulation::Segment> sides;
    for (const auto& [a, b] : outline.sides) sides.push_back({first_outline + a, first_outline + b});
    if (!outline.points.empty())
        if (auto ok = triangulation->extend(scaled(outline.points, scale), sides); !ok)
            return std::unexpected(ok.error());

    Filler filler(*triangulation, tree, judge, surface, scale, demands);
    filler.keep_feet(first_outline, outline.needs_foot, outline.plain);
    for (const Vec<2>& p : extra) triangulation->insert({{p[0] * scale[0], p[1] * scale[1]}});
    filler.insert_corners(corners);
    const std::size_t at_first = polygon.points.size() + outline.points.size();
    while (place.size() < at_first) place.push_back(int(place.size()));
    // Leaves and boundary say how many points to expect; many times as many mean that something does not
    // converge.
    const std::size_t limit = std::size_t(max_triangles) / 2 + at_first;
    const std::size_t expected = at_first + corners.size() + 600;
    const std::size_t most = demands.shapes_triangles()
                                 ? limit
                                 : std::min(limit, (ways.knows_normals ? kHope : kPatience) * expected);
    for (int round = 0; round < kSeparateRounds; ++round) {
        if (!filler.refine(most)) {
            stuck.assign(filler.stuck_at().begin(), filler.stuck_at().end());
            return filler.is_stuck()
                       ? refuse(RefusalKind::not_converged, "mesh", "triangles beside a block need no foot")
                   : most == limit
                       ? refuse(RefusalKind::limit, "max_triangles",
                                text("more than ", max_triangles, " triangles are needed within ", tolerance))
                       : refuse(RefusalKind::not_converged, "mesh",
                                text("more than ", most, " points do not bring all triangles within ",
                                     tolerance));
        }
        if (filler.separate(place) == 0) break;
    }

    FaceMesh out;
    out.uv = boundary.uv;
    out.point = boundary.point;
    // Merged corners keep the first of their places; what was cut out of poles and what was inserted comes
    // after them.
    const int shift = int(boundary.uv.size()) - merged_corners;
    for (int v = merged_corners; v < int(triangulation->points().size()); ++v) {
        out.uv.push_back(filler.uv(v));
        out.point.push_back(v < first_outline ? boundary.point[std::size_t(polygon.corner[std::size_t(v)])]
                                              : -1);
    }
    first_on_outline = first_outline + shift;
    for (int i = 0; i < triangulation->size(); ++i) {
        if (!triangulation->is_inside(i)) continue;
        const double bound = filler.bound(i);
        if (!(bound <= tolerance))
            return refuse(RefusalKind::not_converged, "mesh",
                          text("a triangle near u = ", filler.uv(triangulation->vertices(i)[0])[0], ", v = ",
                               filler.uv(triangulation->vertices(i)[0])[1], " keeps the bound ", bound));
        out.bound = std::max(out.bound, bound);
        std::array<int, 3> t = triangulation->vertices(i);
        std::array<int, 3> at{};
        for (std::size_t k = 0; k < 3; ++k) {
            at[k] = t[k] < int(place.size()) ? place[std::size_t(t[k])] : t[k];
            t[k] = t[k] < merged_corners ? polygon.corner[std::size_t(t[k])] : t[k] + shift;
        }
        if (at[0] != at[1] && at[1] != at[2] && at[2] != at[0]) out.triangles.push_back(t);
    }
    if (grid) out.quads = pair_halves(*grid, out.uv, out.point, out.triangles);
    return out;
}

// Whether poles are part of the boundary, which cut_poles may cut.
bool has_poles(const Polygon& polygon, const FaceBoundary& boundary) {
    const auto point = [&](int i) { return boundary.point[std::size_t(polygon.corner[std::size_t(i)])]; };
    return std::ranges::any_of(polygon.segments, [&](const auto& s) { return point(s.a) == point(s.b); });
}

// Blocks are left out near places to `avoid`. `stuck`: as above.
Result<FaceMesh> filled_around(const Filling& f, const Polygon& polygon, std::span<const Vec<2>> avoid,
                               std::vector<Vec<2>>& stuck) {
    const auto grid = grid_of(f.surface, f.tree, polygon, f.demands, f.max_triangles);
    const std::vector<CurvatureTree::Corner> crossings =
        grid ? crossings_of(*grid, f.demands.lines != nullptr) : std::vector<CurvatureTree::Corner>{};
    const bool waits = !grid && has_poles(polygon, f.boundary);  // for corners of leaves
    std::optional<Bounded> inner;
    Result<FaceMesh> out;
    int first_on_outline = 0;
    const auto begin = [&](std::span<const CurvatureTree::Corner> corners) {
        inner = bounded(f, polygon, corners, grid ? mean_cell(*grid) : f.tree.mean_leaf());
    };
    const auto before = [&] {
        if (!waits) begin(crossings);
    };
    const auto around = [&](const BlockOutline& outline) {
        if (waits) begin(outline.corners);
        out = mesh_around(f, std::move(*inner), int(polygon.points.size()), grid ? &*grid : nullptr,
                          grid ? crossings : outline.corners, outline, stuck, first_on_outline);
    };
    const BlockMesh blocks =
        mesh_blocks(f.tree, f.judge, f.demands.tolerance, f.demands.is_shared, avoid, {before, around});
    if (out) add_blocks(*out, blocks, first_on_outline);
    return out;
}

Result<FaceMesh> filled(const DerivativeQuery<2, 3>& surface, const FaceBoundary& boundary,
                        const FaceDemands& demands, long long max_triangles, std::span<const Vec<2>> extra,
                        CurvatureTree::Ways ways) {
    const auto polygon = merged(boundary);
    if (!polygon) return refuse(RefusalKind::invalid, "loops", polygon.error().message);
    std::vector<std::array<int, 2>> segments;
    for (const auto& s : polygon->segments) segments.push_back({s.a, s.b});
    const auto tree = CurvatureTree::make(surface, polygon->points, segments, demands,
                                          std::size_t(max_triangles) / 2 + 1, ways);
    if (!tree) return std::unexpected(tree.error());
    Box<2> box;
    for (const Vec<2>& p : polygon->points) box.add(p);
    const Judge judge(*tree, surface, box, demands.tolerance);
    const Filling filling{surface, boundary, demands, max_triangles, extra, ways, *tree, judge};
    std::vector<Vec<2>> avoid, stuck;
    for (int attempt = 0;; ++attempt) {
        stuck.clear();
        auto mesh = filled_around(filling, *polygon, avoid, stuck);
        if (stuck.empty() || attempt == kAttemptsAround) return mesh;
        avoid.insert(avoid.end(), stuck.begin(), stuck.end());
    }
}

}  // namespace

Result<FaceMesh> mesh_face(const DerivativeQuery<2, 3>& surface, const FaceBoundary& boundary,
                           const FaceDemands& demands, long long max_triangles,
                           std::span<const Vec<2>> extra) {
    // Judging by all of the error asks nothing of normals, which kinks spoil around them. Away from them
    // swept surfaces save most of their triangles by normals; splines that have kinks save hardly any, and
    // take longer.
    Box<2> box;
    for (const Vec<2>& p : boundary.uv) box.add(p);
    const bool is_swept = surface.piece_numbers() == 0;
    const bool by_normals =
        (is_swept && !demands.quads) || kinks_are_rounding(surface, box, demands.tolerance);
    const bool blocks = !demands.quads && !demands.shapes_triangles();
    Result<FaceMesh> mesh = refuse(RefusalKind::not_converged, "mesh", "");
    const auto failed = [&] { return !mesh && mesh.error().kind == RefusalKind::not_converged; };
    if (demands.apex)
        if (const auto cone = ConeFace::make(*demands.apex, surface, box))
            mesh = filled(surface, boundary, demands, max_triangles, extra, {false, blocks, cone});
    if (failed()) mesh = filled(surface, boundary, demands, max_triangles, extra, {by_normals, blocks});
    if (blocks && failed())
        mesh = filled(surface, boundary, demands, max_triangles, extra, {by_normals, false});
    if (by_normals && failed())
        mesh = filled(surface, boundary, demands, max_triangles, extra, {false, false});
    return mesh;
}

}  // namespace freiform
