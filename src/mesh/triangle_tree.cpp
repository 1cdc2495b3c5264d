// Method. Boxes of triangles, halved at the median along the longest side of the box of their centres; a
// query goes down to the nearer child first and leaves out boxes that are not nearer than what it has.
//
// Accuracy. `point` is computed as a combination of corners with weights in [0, 1] or as the foot of a
// perpendicular that was found inside, so it is off the triangle by a few roundings of coordinates, and
// `distance` is that much from the distance of a point of the triangle. That no other point is nearer holds
// up to rounding too, but for triangles so thin that their normal is rounding: there the sides are taken.
//
// Why not the case analysis by Voronoi regions: it is longer and needs the triangle to have an area.
#include <freiform/mesh/triangle_tree.hpp>

#include <cmath>
#include <numeric>

namespace freiform {

namespace {

constexpr int kLeafTriangles = 4;

Vec<3> closest_on_side(const Vec<3>& a, const Vec<3>& b, const Vec<3>& p) {
    const Vec<3> d = b - a;
    const double length = dot(d, d);
    return a + (length > 0 ? std::clamp(dot(p - a, d) / length, 0.0, 1.0) : 0.0) * d;
}

double squared_distance(const Box<3>& box, const Vec<3>& p) {
    double sum = 0;
    for (int k = 0; k < 3; ++k) {
        const double d = std::max({box.lo[k] - p[k], p[k] - box.hi[k], 0.0});
        sum += d * d;
    }
    return sum;
}

Vec<3> middle_of(const Triangle3& t) { return (1.0 / 3) * (t[0] + t[1] + t[2]); }

Vec<3> closest_near_one(const Triangle3& t, const Vec<3>& p) {
    const Vec<3> n = cross(t[1] - t[0], t[2] - t[0]);
    const double size = dot(n, n);
    if (size > 0) {
        const Vec<3> foot = p - (dot(p - t[0], n) / size) * n;
        bool inside = true;
        for (std::size_t i = 0; i < 3 && inside; ++i)
            inside = dot(n, cross(t[(i + 1) % 3] - t[i], foot - t[i])) >= 0;
        if (inside) return foot;
    }
    Vec<3> best = t[0];
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < 3; ++i) {
        const Vec<3> q = closest_on_side(t[i], t[(i + 1) % 3], p);
        if (const double d = dot(q - p, q - p); d < least) least = d, best = q;
    }
    return best;
}

}  // namespace

// Products of six lengths are taken, which leave the range of double for very large and very small triangles:
// these are moved to the origin and scaled by a power of two.
Vec<3> closest_point(const Triangle3& triangle, const Vec<3>& to) {
    const Vec<3>& origin = triangle[0];
    double most = max_abs(to - origin);
    for (const Vec<3>& c : triangle) most = std::max(most, max_abs(c - origin));
    const int e = most > 0 && std::isfinite(most) ? std::ilogb(most) : 0;
    const auto scaled = [](const Vec<3>& v, int by) {
        return Vec<3>{{std::scalbn(v[0], by), std::scalbn(v[1], by), std::scalbn(v[2], by)}};
    };
    if (e > 100 || e < -100) {
        const Triangle3 near{{{}, scaled(triangle[1] - origin, -e), scaled(triangle[2] - origin, -e)}};
        return origin + scaled(closest_near_one(near, scaled(to - origin, -e)), e);
    }
    return closest_near_one(triangle, to);
}

TriangleTree::TriangleTree(std::vector<Triangle3> triangles)
    : triangles_(std::move(triangles)), order_(triangles_.size()) {
    std::iota(order_.begin(), order_.end(), 0);
    nodes_.push_back({{}, 0, int(order_.size()), -1});
    for (std::size_t k = 0; k < nodes_.size(); ++k) {
        Node node = nodes_[k];
        Box<3> middles;
        for (int i = node.begin; i < node.end; ++i) {
            const Triangle3& t = triangles_[std::size_t(order_[std::size_t(i)])];
            for (const Vec<3>& p : t) node.box.add(p);
            middles.add(middle_of(t));
        }
        if (node.end - node.begin > kLeafTriangles) {
            int axis = 0;
            for (int d = 1; d < 3; ++d)
                if (middles.side(d).length() > middles.side(axis).length()) axis = d;
            const int half = node.begin + (node.end - node.begin) / 2;
            const auto at = order_.begin();
            std::nth_element(at + node.begin, at + half, at + node.end, [&](int i, int j) {
                return middle_of(triangles_[std::size_t(i)])[axis] <
                       middle_of(triangles_[std::size_t(j)])[axis];
            });
            node.left = int(nodes_.size());
            nodes_.push_back({{}, node.begin, half, -1});
            nodes_.push_back({{}, half, node.end, -1});
        }
        nodes_[k] = node;
    }
}

TriangleTree::Found TriangleTree::nearest(const Vec<3>& p, double within) const {
    Found best;
    double least = within * within;
    int stack[128],
        size = 0;  // halved at the median: at most log2(2^31) deep, one more on the stack each time
    stack[size++] = 0;
    while (size > 0) {
        const Node& n = nodes_[std::size_t(stack[--size])];
        if (!(squared_distance(n.box, p) < least)) continue;
        if (n.left < 0) {
            for (int i = n.begin; i < n.end; ++i) {
                const int t = order_[std::size_t(i)];
                const Vec<3> q = closest_point(triangles_[std::size_t(t)], p);
                if (const double d = dot(q - p, q - p); d < least) least = d, best = {t, 0, q};
            }
            continue;
        }
        const int l = n.left, r = n.left + 1;
        const bool left_first = squared_distance(nodes_[std::size_t(l)].box, p) <=
                                squared_distance(nodes_[std::size_t(r)].box, p);
        stack[size++] = left_first ? r : l;
        stack[size++] = left_first ? l : r;
    }
    if (best.triangle >= 0) best.distance = norm(best.point - p);
    return best;
}

}  // namespace freiform
