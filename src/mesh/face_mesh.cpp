// Filling a polygon with triangles that a proof accepts.
//
// Method: a tree of boxes with curvature bounds (curvature_tree.cpp) says how dense points have to be; the
// corners of its leaves are inserted into the constrained Delaunay triangulation of the boundary; every
// triangle is then judged by its own bound, and one that fails gets a point: the middle of its longest side,
// or of the next one that is not part of the boundary, or where the side crosses a kink of the surface. Only
// inner points are added, so that the neighbours across the boundary never notice. Metric: Delaunay in the
// plane where a mean leaf is a square, since leaves have about equal error in both directions and the
// Delaunay triangulation has the smallest largest min-containment circle. The scales are powers of two, so
// nothing is rounded. Cost: one bound per created triangle, O(log leaves). Accuracy: `bound` is the largest
// over all triangles, collapsed ones (at poles) included, because the surface there has to be near something
// too.
#include "curvature_tree_detail.hpp"

#include <freiform/mesh/face_mesh.hpp>
#include <freiform/mesh/triangulate.hpp>

#include <algorithm>
#include <cmath>
#include <map>

namespace freiform {

namespace {

constexpr int kSeparateRounds = 16;
constexpr std::size_t kPatience = 16;  // times the points that are expected
constexpr double kNearPoint = 1e-3;    // likewise of a leaf, for other points
constexpr double kLeastLength = 1e-9;  // of the box of the face: shorter is rounding
constexpr double kNearBoundary =
    0.3;  // leaf corners nearer to the boundary than this part of a leaf make slivers

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
void cut_poles(Polygon& polygon, const FaceBoundary& boundary, const CurvatureTree& tree) {
    std::vector<Vec<2>> corners;
    const std::vector<Triangulation::Segment> before = std::move(polygon.segments);
    polygon.segments.clear();
    for (const auto& s : before) {
        const int a = polygon.corner[std::size_t(s.a)], b = polygon.corner[std::size_t(s.b)];
        if (boundary.point[std::size_t(a)] != boundary.point[std::size_t(b)]) {
            polygon.segments.push_back(s);
            continue;
        }
        if (corners.empty())
            for (const auto& c : tree.corners()) corners.push_back(c.at);
        const Vec<2> p = boundary.uv[std::size_t(a)], q = boundary.uv[std::size_t(b)], d = q - p;
        std::vector<std::pair<double, Vec<2>>> cuts;  // by the part of the way
        if (d[0] == 0 || d[1] == 0) {
            const int axis = d[0] == 0 ? 1 : 0;
            for (const Vec<2>& c : corners)
                if (c[1 - axis] == p[1 - axis] && (c[axis] - p[axis]) * (c[axis] - q[axis]) < 0)
                    cuts.push_back({(c[axis] - p[axis]) / d[axis], c});
        } else {
            const Vec<2> leaf = tree.mean_leaf();
            const int n = int(
                std::min(1000.0, std::ceil(std::max(std::abs(d[0]) / leaf[0], std::abs(d[1]) / leaf[1]))));
            for (int k = 1; k < n; ++k) cuts.push_back({double(k) / n, p + (double(k) / n) * d});
        }
        std::sort(cuts.begin(), cuts.end(), [](const auto& x, const auto& y) { return x.first < y.first; });
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

class Filler {
public:
    Filler(Triangulation& t, const CurvatureTree& tree, const DerivativeQuery<2, 3>& surface, Vec<2> scale,
           double tolerance)
        : t_(t), tree_(tree), surface_(surface), scale_(scale), tolerance_(tolerance) {
        Box<2> box;
        for (const Vec<2>& p : t.points()) box.add(unscaled(p));
        least_ = kLeastLength * (box.hi - box.lo);
    }

    void insert_corners();
    // False when more than `max_points` are needed.
    bool refine(std::size_t max_points);
    double bound(int triangle) const;
    // Inserts the middles of inner edges that more than two triangles have once corners with the same `place`
    // are one. The number of points inserted.
    int separate(std::span<const int> place);
    Vec<2> uv(int vertex) const { return unscaled(t_.points()[std::size_t(vertex)]); }

private:
    Vec<2> unscaled(const Vec<2>& x) const { return {{x[0] / scale_[0], x[1] / scale_[1]}}; }
    Vec<2> scaled(const Vec<2>& x) const { return {{x[0] * scale_[0], x[1] * scale_[1]}}; }
    bool is_near_boundary(int triangle, const Vec<2>& x, const Vec<2>& leaf) const;
    bool improve(int triangle);

    Triangulation& t_;
    Curvature curvature_over(const Vec<2>& a, const Vec<2>& b, const Vec<2>& c) const;
    const CurvatureTree& tree_;
    const DerivativeQuery<2, 3>& surface_;
    Vec<2> scale_, least_{};  // least_: what counts as a length at all
    double tolerance_;
};

bool Filler::is_near_boundary(int triangle, const Vec<2>& x, const Vec<2>& leaf) const {
    // Distances in the metric where the leaf is a unit square. Leaves between two kinks that differ by
    // rounding only are too thin to measure by.
    const auto local = [&](const Vec<2>& d) {
        return Vec<2>{{d[0] / (std::max(leaf[0], least_[0]) * scale_[0]),
                       d[1] / (std::max(leaf[1], least_[1]) * scale_[1])}};
    };
    const auto& v = t_.vertices(triangle);
    for (std::size_t e = 0; e < 3; ++e) {
        const Vec<2> a = t_.points()[std::size_t(v[(e + 1) % 3])],
                     b = t_.points()[std::size_t(v[(e + 2) % 3])];
        const Vec<2> ab = local(b - a), ax = local(x - a);
        if (max_abs(ax) < kNearPoint) return true;
        if (!t_.is_constrained(triangle, int(e))) continue;
        const double along = std::clamp(dot(ab, ax) / dot(ab, ab), 0.0, 1.0);
        if (norm(ax - along * ab) < kNearBoundary) return true;
    }
    return false;
}

void Filler::insert_corners() {
    for (const auto& corner : tree_.corners()) {
        const Vec<2> x = scaled(corner.at);
        t_.insert(x, -1, [&](int triangle) { return is_near_boundary(triangle, x, corner.leaf); });
    }
}

// What the tree says of the leaves that the triangle meets; where that is not enough, of its own box, which
// may be much smaller than a leaf.
Curvature Filler::curvature_over(const Vec<2>& a, const Vec<2>& b, const Vec<2>& c) const {
    Box<2> box;
    for (const Vec<2>& p : {a, b, c}) box.add(p);
    const Curvature from_tree = tree_.over(box);
    if (linear_interpolation_bound(from_tree, a, b, c) + tree_.kink_bound(box) <= tolerance_)
        return from_tree;
    const auto own = surface_({box.side(0), box.side(1)});
    return {std::min(from_tree.uu, own(2, 0)), std::min(from_tree.uv, own(1, 1)),
            std::min(from_tree.vv, own(0, 2))};
}

double Filler::bound(int triangle) const {
    const auto& v = t_.vertices(triangle);
    const Vec<2> a = uv(v[0]), b = uv(v[1]), c = uv(v[2]);
    Box<2> box;
    for (const Vec<2>& p : {a, b, c}) box.add(p);
    return linear_interpolation_bound(curvature_over(a, b, c), a, b, c) + tree_.kink_bound(box);
}

// Inserts a point that makes the triangle better; false if there is none.
bool Filler::improve(int triangle) {
    const auto v = t_.vertices(triangle);
    const Vec<2> corner[3] = {uv(v[0]), uv(v[1]), uv(v[2])};
    Box<2> box;
    for (const Vec<2>& p : corner) box.add(p);
    const Curvature c = curvature_over(corner[0], corner[1], corner[2]);
    const auto attempt = [&](const Vec<2>& at) {
        return t_.insert(scaled(at), triangle).status == Triangulation::Insert::done;
    };
    std::array<std::pair<double, int>, 3> sides;  // by the error that they stand for
    for (int e = 0; e < 3; ++e) {
        const Vec<2> d = corner[(e + 2) % 3] - corner[(e + 1) % 3];
        sides[std::size_t(e)] = {c.along(d[0], d[1]), e};
    }
    if (const auto kink = tree_.worst_kink(box); kink && tree_.kink_bound(box) > tolerance_ / 4) {
        const auto [axis, at] = *kink;
        std::array<std::pair<double, int>, 3> spans;
        for (int e = 0; e < 3; ++e)
            spans[std::size_t(e)] = {std::abs(corner[(e + 2) % 3][axis] - corner[(e + 1) % 3][axis]), e};
        std::sort(spans.rbegin(), spans.rend());
        for (const auto& [span, e] : spans) {
            const Vec<2> p = corner[(e + 1) % 3], q = corner[(e + 2) % 3];
            if (t_.is_constrained(triangle, e) || (p[axis] - at) * (q[axis] - at) >= 0) continue;
            Vec<2> x = p + ((at - p[axis]) / (q[axis] - p[axis])) * (q - p);
            x[axis] = at;
            if (attempt(x)) return true;
        }
    }
    std::sort(sides.rbegin(), sides.rend());
    for (const auto& [error, e] : sides)
        if (!t_.is_constrained(triangle, e) && attempt(0.5 * (corner[(e + 1) % 3] + corner[(e + 2) % 3])))
            return true;
    return attempt((1.0 / 3) * (corner[0] + corner[1] + corner[2]));
}

bool Filler::refine(std::size_t max_points) {
    struct Entry {
        int triangle;
        std::uint32_t stamp;
    };
    std::vector<Entry> queue;
    for (int i = 0; i < t_.size(); ++i)
        if (t_.is_inside(i)) queue.push_back({i, t_.stamp(i)});
    for (std::size_t head = 0; head < queue.size(); ++head) {
        const Entry entry = queue[head];
        if (t_.stamp(entry.triangle) != entry.stamp || bound(entry.triangle) <= tolerance_) continue;
        if (t_.points().size() >= max_points) return false;
        if (!improve(entry.triangle)) continue;  // its bound stands, and the caller will see it
        for (int i : t_.changed())
            if (t_.is_inside(i)) queue.push_back({i, t_.stamp(i)});
        if (head > 4096 && head > queue.size() / 2) {
            queue.erase(queue.begin(), queue.begin() + std::ptrdiff_t(head) + 1);
            head = std::size_t(-1);
        }
    }
    return true;
}

// Around a pole two triangles that are neighbours across a single inner point fall on each other, and so do
// edges across a seam when a strip is one edge wide.
int Filler::separate(std::span<const int> place) {
    std::vector<int> corners_at(place.size(), 0);
    const auto id = [&](int v) { return v < int(place.size()) ? place[std::size_t(v)] : v; };
    for (int p : place) ++corners_at[std::size_t(p)];
    struct Side {
        int a, b, u, v;
        bool operator<(const Side& o) const { return std::tie(a, b, u, v) < std::tie(o.a, o.b, o.u, o.v); }
    };
    std::vector<Side> sides;
    for (int i = 0; i < t_.size(); ++i) {
        if (!t_.is_inside(i)) continue;
        const auto& v = t_.vertices(i);
        if (id(v[0]) == id(v[1]) || id(v[1]) == id(v[2]) || id(v[2]) == id(v[0])) continue;
        for (std::size_t k = 0; k < 3; ++k) {
            const int u = std::min(v[k], v[(k + 1) % 3]), w = std::max(v[k], v[(k + 1) % 3]);
            if (u >= int(place.size()) || (corners_at[std::size_t(id(u))] < 2 &&
                                           (w >= int(place.size()) || corners_at[std::size_t(id(w))] < 2)))
                continue;
            const int a = id(u), b = id(w);
            sides.push_back({std::min(a, b), std::max(a, b), u, w});
        }
    }
    std::sort(sides.begin(), sides.end());
    int inserted = 0;
    for (std::size_t i = 0, j; i < sides.size(); i = j) {
        for (j = i; j < sides.size() && sides[j].a == sides[i].a && sides[j].b == sides[i].b;) ++j;
        if (j - i <= 2) continue;
        for (std::size_t k = i; k < j; ++k) {
            if (k > i && sides[k].u == sides[k - 1].u && sides[k].v == sides[k - 1].v) continue;
            const auto e = t_.find_edge(sides[k].u, sides[k].v);
            if (e.triangle < 0 || t_.is_constrained(e.triangle, e.edge)) continue;
            inserted += t_.insert(scaled(0.5 * (uv(sides[k].u) + uv(sides[k].v))), e.triangle).status ==
                        Triangulation::Insert::done;
        }
    }
    return inserted;
}

}  // namespace

std::vector<BoundaryConflict> find_conflicts(const FaceBoundary& boundary) {
    auto polygon = merged(boundary);
    if (!polygon) return {polygon.error()};
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

Result<FaceMesh> mesh_face(const DerivativeQuery<2, 3>& surface, const FaceBoundary& boundary,
                           double tolerance, long long max_triangles, std::span<const Vec<2>> extra) {
    auto polygon = merged(boundary);
    if (!polygon) return refuse(RefusalKind::invalid, "loops", polygon.error().message);
    std::vector<std::array<int, 2>> segments;
    for (const auto& s : polygon->segments) segments.push_back({s.a, s.b});
    auto tree = CurvatureTree::make(surface, polygon->points, segments, tolerance,
                                    std::size_t(max_triangles) / 2 + 1);
    if (!tree) return std::unexpected(tree.error());

    const int merged_corners = int(polygon->points.size());
    cut_poles(*polygon, boundary, *tree);
    const Vec<2> leaf = tree->mean_leaf();
    const Vec<2> scale{{scale_for(leaf[0]), scale_for(leaf[1])}};
    std::vector<Vec<2>> points = polygon->points;
    for (Vec<2>& p : points) p = {{p[0] * scale[0], p[1] * scale[1]}};
    auto triangulation = Triangulation::make(points, polygon->segments);
    if (!triangulation) return std::unexpected(triangulation.error());

    Filler filler(*triangulation, *tree, surface, scale, tolerance);
    for (const Vec<2>& p : extra) triangulation->insert({{p[0] * scale[0], p[1] * scale[1]}});
    filler.insert_corners();
    // Corners that stand for the same mesh point, numbered by the first of them.
    std::vector<int> place(points.size());
    std::map<int, int> first;
    for (std::size_t i = 0; i < place.size(); ++i)
        place[i] = first.try_emplace(boundary.point[std::size_t(polygon->corner[i])], int(i)).first->second;
    // Leaves and boundary say how many points to expect; many times as many mean that something does not
    // converge.
    const std::size_t limit = std::size_t(max_triangles) / 2 + points.size();
    const std::size_t most = std::min(limit, kPatience * (points.size() + tree->corners().size()) + 10'000);
    for (int round = 0; round < kSeparateRounds; ++round) {
        if (!filler.refine(most))
            return most == limit
                       ? refuse(RefusalKind::limit, "max_triangles",
                                text("more than ", max_triangles, " triangles are needed within ", tolerance))
                       : refuse(RefusalKind::not_converged, "mesh",
                                text("more than ", most, " points do not bring all triangles within ",
                                     tolerance));
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
        out.point.push_back(
            v < int(points.size()) ? boundary.point[std::size_t(polygon->corner[std::size_t(v)])] : -1);
    }
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
            t[k] = t[k] < merged_corners ? polygon->corner[std::size_t(t[k])] : t[k] + shift;
        }
        if (at[0] != at[1] && at[1] != at[2] && at[2] != at[0]) out.triangles.push_back(t);
    }
    return out;
}

}  // namespace freiform
