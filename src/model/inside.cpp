// Idea. A mesh and the surface that it approximates, each point within B of its partner, go round a point in
// the same way if the point is farther than B from the mesh: moving every point of one straight to its
// partner never meets it. So a coarse mesh decides for most points, and finer ones only for those that are
// near the surface.
//
// Method. The winding number of a closed mesh is the number of triangles that a half-line crosses, +1 where
// it leaves and -1 where it enters. The half-line is parallel to an axis, so that which triangles it crosses
// is decided in the plane, by exact signs (predicates.hpp): an edge that it meets is taken to lie on one side
// of it by both of its triangles, as in the half-open rule for polygons. Whether a triangle that is crossed
// lies ahead or behind is the sign of a determinant, in numbers with bounds; where it is not certain, as on
// triangles parallel to the half-line, another axis is tried.
//
// Cost. Some comparisons for each triangle and point, in the first mesh; in each finer one (tolerance / 8)
// for the points that are left.
//
// Why not count the crossings with the surface itself: tangents and edges, decided exactly, take more than
// the distance to the surface, which answers the question where it has an answer.
#include <freiform/core/bounded.hpp>
#include <freiform/core/parallel.hpp>
#include <freiform/model/inside.hpp>
#include <freiform/model/tessellate.hpp>
#include <freiform/poly/predicates.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

namespace freiform {

namespace {

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

}  // namespace

Result<std::vector<SolidInside>> inside_solid(const Model& model, std::span<const Vec<3>> points,
                                              double accuracy, long long max_triangles) {
    if (!(accuracy > 0) || !std::isfinite(accuracy))
        return refuse(RefusalKind::invalid, "accuracy",
                      text("is ", accuracy, ", expected a distance above 0"));
    for (std::size_t i = 0; i < points.size(); ++i)
        if (!is_finite(points[i]))
            return refuse(RefusalKind::nonfinite, text("points[", i, "]"), "is not finite");
    const Box<3> box = summary(model).box;
    std::vector<SolidInside> out(points.size());
    std::vector<std::size_t> open(points.size());
    for (std::size_t i = 0; i < open.size(); ++i) open[i] = i;
    for (double tolerance = std::max(box.diagonal() / 64, accuracy / 4);;
         tolerance = std::max(tolerance / 8, accuracy / 4)) {
        const auto t = closed_mesh(model, tolerance, max_triangles);
        if (!t) return std::unexpected(t.error());
        const double off = t->error_bound + t->boundary_gap;
        const auto triangles = boxed_triangles(t->mesh);
        std::vector<double> distance(open.size());
        std::vector<std::optional<int>> winding(open.size());
        // At least and at most so far from the surface. Rounding: differences, a division and norms of
        // numbers up to the size of what is looked at.
        const auto away = [&](std::size_t i) {
            const double rounding = 64 * 0x1p-53 * (box.scale() + max_abs(points[open[i]]));
            return Interval{distance[i] - rounding - off, distance[i] + rounding + off};
        };
        parallel_for(open.size(), 1, [&](std::size_t i) {
            const Vec<3>& p = points[open[i]];
            distance[i] = distance_to(triangles, p);
            if (away(i).lo > 0)
                for (int axis = 2; axis >= 0 && !winding[i]; --axis)
                    winding[i] = winding_along(triangles, p, axis);
        });
        const bool last = tolerance <= accuracy / 4;
        std::vector<std::size_t> left;
        for (std::size_t i = 0; i < open.size(); ++i) {
            SolidInside& answer = out[open[i]];
            if (away(i).lo > 0) {
                if (!winding[i])
                    return refuse(
                        RefusalKind::ill_conditioned, text("points[", open[i], "]"),
                        "lies in the planes of triangles of the mesh, so that rounding hides its side");
                answer = {*winding[i] > 0 ? Place::inside : Place::outside, *winding[i], away(i).lo};
            } else if (last) {
                answer = {Place::boundary, 0, away(i).hi};
            } else {
                left.push_back(open[i]);
            }
        }
        open = std::move(left);
        if (open.empty()) return out;
    }
}

}  // namespace freiform
