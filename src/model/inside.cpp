// Idea. A mesh and the surface that it approximates, each point within B of its partner, go round a point in
// the same way if the point is farther than B from the mesh: moving every point of one straight to its
// partner never meets it. So a coarse mesh decides for most points, and finer ones only for those that are
// near the surface. Those are first taken away from it: where the nearest point of the surface is proven to
// be farther than d, everything within d of the point has the same side, so steps of less than d away from
// the foot, each about twice the last, lead to where the coarse mesh decides.
//
// Method. The winding number of a closed mesh is the number of triangles that a half-line crosses, +1 where
// it leaves and -1 where it enters. The half-line is parallel to an axis, so that which triangles it crosses
// is decided in the plane, by exact signs (predicates.hpp): an edge that it meets is taken to lie on one side
// of it by both of its triangles, as in the half-open rule for polygons. Whether a triangle that is crossed
// lies ahead or behind is the sign of a determinant, in numbers with bounds; where it is not certain, as on
// triangles parallel to the half-line, another axis is tried.
//
// What closes a model between faces that do not quite meet is within boundary_gap of them. That is known at
// the points of a mesh on the edges alone; twice as much is kept away from.
//
// Cost. Some comparisons for each triangle and point, in the first mesh; some searches for the nearest point
// for each that is near. In finer meshes (tolerance / 8) the same for the points that are left, in thin walls
// and narrow gaps. A mesh has 1 / tolerance triangles, so that they end at kMostFine.
//
// Why not count the crossings with the surface itself: tangents and edges, decided exactly, take more than
// the distance to the surface, which answers the question where it has an answer.
#include <freiform/core/bounded.hpp>
#include <freiform/core/constants.hpp>
#include <freiform/core/parallel.hpp>
#include <freiform/model/inside.hpp>
#include <freiform/model/nearest.hpp>
#include <freiform/model/tessellate.hpp>
#include <freiform/poly/predicates.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

namespace freiform {

namespace {

constexpr long long kMostFine = 500'000;  // triangles of a mesh other than the first
constexpr int kMostSteps = 64;            // away from the surface,
constexpr int kInVain = 5;                // and as many that bring it no farther: a corner takes three

struct Corners {
    Vec<3> a, b, c;  // from the point
};

double distance_to_segment(const Vec<3>& a, const Vec<3>& b) {
    const Vec<3> d = b - a;
    const double length = dot(d, d), t = length > 0 ? std::clamp(-dot(a, d) / length, 0.0, 1.0) : 0;
    return norm(a + t * d);
}

// Of the origin.
double distance_to_triangle(const Corners& t) {
    const double edges = std::min(
        {distance_to_segment(t.a, t.b), distance_to_segment(t.b, t.c), distance_to_segment(t.c, t.a)});
    const Vec<3> n = cross(t.b - t.a, t.c - t.a);
    const double size = norm(n);
    if (!(size > 0)) return edges;
    // The foot of the perpendicular is inside if it is on the same side of all three edges.
    const Vec<3> foot = (dot(t.a, n) / size / size) * n;
    const auto side = [&](const Vec<3>& p, const Vec<3>& q) { return dot(n, cross(q - p, foot - p)) >= 0; };
    if (!side(t.a, t.b) || !side(t.b, t.c) || !side(t.c, t.a)) return edges;
    return std::min(edges, std::abs(dot(t.a, n)) / size);
}

// The coordinates other than `axis`, so that (first, second, axis) is a right-handed system.
Vec<2> across(const Vec<3>& p, int axis) { return {{p[(axis + 1) % 3], p[(axis + 2) % 3]}}; }

// How often the triangle, seen along the axis, goes round the point: 1, -1 or 0.
int turns(const std::array<Vec<3>, 3>& t, const Vec<3>& p, int axis) {
    const Vec<2> q = across(p, axis);
    int sum = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec<2> a = across(t[i], axis), b = across(t[(i + 1) % 3], axis);
        if ((a[1] <= q[1]) == (b[1] <= q[1])) continue;
        const int side = orient2d(a, b, q);
        sum += a[1] <= q[1] ? side > 0 : -(side < 0);
    }
    return sum;
}

// The sign of the volume of the triangle and p: positive if the normal of the triangle points away from p.
int volume_sign(const std::array<Vec<3>, 3>& t, const Vec<3>& p) {
    std::array<BoundedVec<3>, 3> d;
    for (std::size_t i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k) d[i][std::size_t(k)] = Bounded(t[i][k]) - Bounded(p[k]);
    const Bounded v = dot(d[0], cross(d[1], d[2]));
    return v.excludes_zero() ? (v.value > 0 ? 1 : -1) : 0;
}

struct MeshTriangle {
    std::array<Vec<3>, 3> at;
    Box<3> box;
};

// Nothing where a sign is not certain.
std::optional<int> winding_along(const std::vector<MeshTriangle>& mesh, const Vec<3>& p, int axis) {
    const int u = (axis + 1) % 3, v = (axis + 2) % 3;
    int sum = 0;
    for (const MeshTriangle& t : mesh) {
        if (p[u] < t.box.lo[u] || p[u] > t.box.hi[u] || p[v] < t.box.lo[v] || p[v] > t.box.hi[v] ||
            p[axis] > t.box.hi[axis])
            continue;
        const int w = turns(t.at, p, axis);
        if (w == 0) continue;
        const int side = volume_sign(t.at, p);
        if (side == 0) return std::nullopt;
        if (side == w) sum += w;
    }
    return sum;
}

double distance_to(const Box<3>& box, const Vec<3>& p) {
    Vec<3> d;
    for (int k = 0; k < 3; ++k) d[k] = std::max({box.lo[k] - p[k], p[k] - box.hi[k], 0.0});
    return norm(d);
}

double distance_to(const std::vector<MeshTriangle>& mesh, const Vec<3>& p) {
    double least = INFINITY;
    for (const MeshTriangle& t : mesh)
        if (distance_to(t.box, p) < least)
            least = std::min(least, distance_to_triangle({t.at[0] - p, t.at[1] - p, t.at[2] - p}));
    return least;
}

std::vector<MeshTriangle> boxed_triangles(const TriangleMesh& mesh) {
    std::vector<MeshTriangle> out;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        MeshTriangle t;
        const auto points = mesh.points_of(i);
        for (std::size_t k = 0; k < 3; ++k) {
            t.at[k] = mesh.points[std::size_t(points[k])];
            t.box.add(t.at[k]);
        }
        out.push_back(t);
    }
    return out;
}

Result<Tessellation> closed_mesh(const Model& model, double tolerance, long long max_triangles) {
    TessellateOptions options;
    options.tolerance = tolerance;
    options.max_triangles = max_triangles;
    auto t = tessellate(model, options);
    if (!t) return t;
    if (!t->refused.empty())
        return refuse(RefusalKind::no_answer, text("faces[", t->refused[0].face, "]"),
                      text("has no mesh (", t->refused[0].reason.message,
                           "), and with a face missing there is no inside"));
    if (t->topology.open_edges > 0 || t->topology.misoriented_edges > 0 || t->topology.non_manifold_edges > 0)
        return refuse(RefusalKind::no_answer, "model",
                      text("is not a closed body: its mesh has ", t->topology.open_edges, " open edges, ",
                           t->topology.misoriented_edges, " where neighbours disagree about the outside and ",
                           t->topology.non_manifold_edges, " between more than two triangles"));
    return t;
}

struct SideMesh {
    std::vector<MeshTriangle> triangles;
    double off;  // bound: of the distance of its points from the surface, and the other way round
};

// The points whose side is not known yet, and what is known of them.
class SideSearch {
public:
    SideSearch(const Model& model, std::span<const Vec<3>> points, double accuracy)
        : model_(model), points_(points), box_(summary(model).box), accuracy_(accuracy), out_(points.size()) {
        for (std::size_t i = 0; i < points.size(); ++i) open_.push_back({i, points[i], 0, kInfinity});
    }

    double size() const { return box_.diagonal(); }
    bool done() const { return open_.empty(); }
    std::vector<SolidInside> answers() && {
        for (const Open& o : open_) out_[o.index] = {Place::boundary, 0, o.upper};
        return std::move(out_);
    }

    Result<void> decide(const SideMesh& mesh) {
        std::vector<std::optional<int>> winding(open_.size());
        std::vector<char> clear(open_.size(), 0);
        parallel_for(open_.size(), 1, [&](std::size_t i) {
            Open& o = open_[i];
            const double distance = distance_to(mesh.triangles, o.at), off = mesh.off + rounding(o.at);
            clear[i] = distance - off > 0;
            if (o.at == points_[o.index]) {
                o.lower = std::max(o.lower, distance - off);
                o.upper = std::min(o.upper, distance + off);
            }
            for (int axis = 2; axis >= 0 && clear[i] && !winding[i]; --axis)
                winding[i] = winding_along(mesh.triangles, o.at, axis);
        });
        std::vector<Open> left;
        for (std::size_t i = 0; i < open_.size(); ++i) {
            const Open& o = open_[i];
            if (!clear[i]) {
                left.push_back(o);
                continue;
            }
            if (!winding[i])
                return refuse(RefusalKind::ill_conditioned, text("points[", o.index, "]"),
                              "lies in the planes of triangles of the mesh, so that rounding hides its side");
            out_[o.index] = {*winding[i] > 0 ? Place::inside : Place::outside, *winding[i], o.lower};
        }
        open_ = std::move(left);
        return {};
    }

    // Points that the surface is too near to are answered as on it. False: nothing is left, or nothing known.
    bool take_away(double off, double gap) {
        if (open_.empty()) return false;
        const auto query = ModelNearestQuery::make(model_);
        if (!query) return false;
        std::vector<char> near(open_.size(), 0);
        parallel_for(open_.size(), 1,
                     [&](std::size_t i) { near[i] = !leads_away(*query, open_[i], off, gap); });
        std::vector<Open> left;
        for (std::size_t i = 0; i < open_.size(); ++i) {
            if (near[i] && open_[i].upper <= std::max(accuracy_, gap))  // finer meshes have the same gap
                out_[open_[i].index] = {Place::boundary, 0, open_[i].upper};
            else
                left.push_back(open_[i]);
        }
        open_ = std::move(left);
        return !open_.empty();
    }

private:
    struct Open {
        std::size_t index;
        Vec<3> at;            // on the same side as the point
        double lower, upper;  // bounds of the distance of the point from the surface
    };

    // Differences, a division and norms of numbers up to the size of what is looked at.
    double rounding(const Vec<3>& p) const { return 64 * 0x1p-53 * (box_.scale() + max_abs(p)); }

    bool leads_away(const ModelNearestQuery& query, Open& o, double off, double gap) const {
        double accuracy = accuracy_ / 4, farthest = 0;
        for (int step = 0, since = 0; step < kMostSteps && since < kInVain; ++step) {
            const auto near = query.nearest(o.at, {.accuracy = accuracy});
            if (!near) return false;
            if (step == 0) {
                o.lower = std::max(o.lower, near->lower_bound);
                o.upper = std::min(o.upper, near->distance + near->point_error);
            }
            if (near->lower_bound > 2 * off) return true;
            since = near->lower_bound > 1.125 * farthest ? 0 : since + 1;
            farthest = std::max(farthest, near->lower_bound);
            const double free = (near->lower_bound - 2 * gap - rounding(o.at)) * 0.875;
            if (!(free > 0)) return false;
            const Vec<3> to = o.at + (free / near->distance) * (o.at - near->point);
            if (to == o.at) return false;
            o.at = to;
            accuracy = std::max(accuracy, near->distance / 8);
        }
        return false;
    }

    const Model& model_;
    std::span<const Vec<3>> points_;
    Box<3> box_;
    double accuracy_;
    std::vector<Open> open_;
    std::vector<SolidInside> out_;
};

}  // namespace

Result<std::vector<SolidInside>> inside_solid(const Model& model, std::span<const Vec<3>> points,
                                              double accuracy, long long max_triangles) {
    if (!(accuracy > 0) || !std::isfinite(accuracy))
        return refuse(RefusalKind::invalid, "accuracy",
                      text("is ", accuracy, ", expected a distance above 0"));
    for (std::size_t i = 0; i < points.size(); ++i)
        if (!is_finite(points[i]))
            return refuse(RefusalKind::nonfinite, text("points[", i, "]"), "is not finite");
    SideSearch search(model, points, accuracy);
    double tolerance = std::max(search.size() / 64, accuracy / 4);
    for (bool first = true;; first = false) {
        const auto t =
            closed_mesh(model, tolerance, first ? max_triangles : std::min(max_triangles, kMostFine));
        if (!t && !first && t.error().kind == RefusalKind::limit) break;
        if (!t) return std::unexpected(t.error());
        const SideMesh mesh{boxed_triangles(t->mesh), t->error_bound + t->boundary_gap};
        if (auto done = search.decide(mesh); !done) return std::unexpected(done.error());
        if (first && search.take_away(mesh.off, t->boundary_gap))
            if (auto done = search.decide(mesh); !done) return std::unexpected(done.error());
        if (search.done() || tolerance <= accuracy / 4) break;
        tolerance = std::max(tolerance / 8, accuracy / 4);
    }
    return std::move(search).answers();
}

}  // namespace freiform
