// How far a flat part of a face may be from a mesh.
//
// Bounds. A face over a box is within e of two flat triangles, or of what its boundary leaves of them
// (face_parts.cpp). Two bounds of the distance from these to the mesh; the smaller one counts. (1) One
// triangle: the largest distance of the corners from it. (2) Many triangles: let n be a direction, and D a
// disc across n that holds the projections of the corners and of the balls of radius e about them. From the
// nearest triangle, go to neighbours across every edge whose projection meets D. If all of them face n, and
// no edge that was met ends the mesh, their projections cover D: the part of D that they cover is closed, not
// empty, and open in D, since about each of its points, on an edge or corner too, the neighbours were taken
// as well. So each point x of the part has a point of some triangle T_k straight along n, at the distance
// |l_k(x)|, l_k linear; and |l_k| over the part is at most its largest value at the corners plus e / cos.
// Rounding: coordinates enter with errors of a few u times their size; 64 u is added. Normals of thin
// triangles are uncertain by u size longest / area, which is added for l_k over the reach of the part.
#include "mesh_side_detail.hpp"

#include <freiform/core/constants.hpp>

#include <algorithm>
#include <cmath>

namespace freiform {

namespace {

constexpr double kSlack = 64 * 0x1p-53;
constexpr std::size_t kMostTriangles = 64;  // that bound (2) looks at
constexpr double kLeastCosine = 0.25;

Vec<3> normal_of(const Triangle3& t) { return cross(t[1] - t[0], t[2] - t[0]); }

std::vector<Triangle3> triangles_of(const TriangleMesh& mesh) {
    std::vector<Triangle3> out(mesh.triangles.size());
    for (std::size_t i = 0; i < out.size(); ++i) {
        const auto p = mesh.points_of(i);
        for (std::size_t k = 0; k < 3; ++k) out[i][k] = mesh.points[std::size_t(p[k])];
    }
    return out;
}

}  // namespace

Vec<3> mean_of(std::span<const Vec<3>> points) {
    Vec<3> sum{};
    for (const Vec<3>& p : points) sum += p;
    return (1 / double(points.size())) * sum;
}

MeshSide::MeshSide(const TriangleMesh& mesh) : tree_(triangles_of(mesh)), neighbours_(mesh.triangles.size()) {
    for (auto& n : neighbours_) n.fill(-1);
    for (const MeshEdge& e : edges(mesh)) {
        if (e.forward != 1 || e.backward != 1) continue;
        for (int side = 0; side < 2; ++side) {
            const int t = e.triangles[std::size_t(side)];
            const auto p = mesh.points_of(std::size_t(t));
            for (std::size_t k = 0; k < 3; ++k)
                if (p[k] != e.a && p[k] != e.b)
                    neighbours_[std::size_t(t)][k] = e.triangles[std::size_t(1 - side)];
        }
    }
    for (const Vec<3>& p : mesh.points) box_.add(p);
}

double MeshSide::bound(std::span<const Vec<3>> corners, double error,
                       const TriangleTree::Found& nearest) const {
    if (!std::isfinite(error)) return kInfinity;
    const Triangle3& t = tree_.triangles()[std::size_t(nearest.triangle)];
    double one = 0;
    for (const Vec<3>& c : corners) one = std::max(one, norm(c - closest_point(t, c)));
    double scale = box_.scale();
    for (const Vec<3>& c : corners) scale = std::max(scale, max_abs(c));
    return std::min(one + error, across(corners, error, nearest, scale)) + kSlack * scale;
}

// Bound (2), e included; infinite where its conditions do not hold.
double MeshSide::across(std::span<const Vec<3>> corners, double error, const TriangleTree::Found& nearest,
                        double scale) const {
    const auto& all = tree_.triangles();
    const Vec<3> n = unit(normal_of(all[std::size_t(nearest.triangle)]));
    if (!(norm(n) > 0.5)) return kInfinity;
    const auto flat = [&](const Vec<3>& x) { return x - dot(x, n) * n; };
    const Vec<3> middle = mean_of(corners);
    double radius = 0;
    for (const Vec<3>& c : corners) radius = std::max(radius, norm(flat(c - middle)));
    radius = (radius + error) * (1 + 1e-12) + kSlack * scale;
    if (!(norm(flat(nearest.point - middle)) <= radius)) return kInfinity;
    std::vector<int> met{nearest.triangle};
    double worst = 0;
    for (std::size_t i = 0; i < met.size(); ++i) {
        const Triangle3& t = all[std::size_t(met[i])];
        const Vec<3> nk = normal_of(t);
        const double length = norm(nk), facing = dot(nk, n);
        if (!(facing > kLeastCosine * length)) return kInfinity;
        double reach = 0, longest = 0;
        for (std::size_t k = 0; k < 3; ++k) longest = std::max(longest, norm(t[(k + 1) % 3] - t[k]));
        for (const Vec<3>& c : corners) {
            worst = std::max(worst, (std::abs(dot(nk, c - t[0])) + error * length) / facing);
            reach = std::max(reach, norm(c - t[0]));
        }
        worst += 4 * kSlack * scale * longest * reach / facing;
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec<3> a = flat(t[(k + 1) % 3] - middle), d = flat(t[(k + 2) % 3] - middle) - a;
            const double dd = dot(d, d), s = dd > 0 ? std::clamp(-dot(a, d) / dd, 0.0, 1.0) : 0;
            if (norm(a + s * d) > radius) continue;
            const int next = neighbours_[std::size_t(met[i])][k];
            if (next < 0 || met.size() == kMostTriangles) return kInfinity;
            if (std::ranges::find(met, next) == met.end()) met.push_back(next);
        }
    }
    return worst;
}

}  // namespace freiform
