// Idea. The distance from a sample to a face's triangles is needed exactly only where it may raise the
// maximum, or where it decides whether a triangle exceeds the tolerance. The distance to the sample's own
// triangle is an upper bound that settles nearly all samples; the others search a tree of boxes over the
// triangles of the face.
#include "measure.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>
#include <ctime>
#include <limits>
#include <numbers>
#include <numeric>
#include <unordered_map>

namespace freiform::bench {

namespace {

Point minus(const Point& a, const Point& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
double dot(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
double length(const Point& a) { return std::sqrt(dot(a, a)); }

double to_segment(const Point& p, const Point& a, const Point& b) {
    const Point d = minus(b, a), w = minus(p, a);
    const double l = dot(d, d);
    const double t = l > 0 ? std::clamp(dot(w, d) / l, 0.0, 1.0) : 0.0;
    return length({w[0] - t * d[0], w[1] - t * d[1], w[2] - t * d[2]});
}

// The foot in the plane if it lies inside, else the nearest of the three sides.
double to_triangle(const Point& p, const Point& a, const Point& b, const Point& c) {
    const double sides = std::min({to_segment(p, a, b), to_segment(p, b, c), to_segment(p, c, a)});
    const Point u = minus(b, a), v = minus(c, a), w = minus(p, a);
    const Point n{u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]};
    const double nn = dot(n, n);
    if (!(nn > 0)) return sides;
    const Point wv{w[1] * v[2] - w[2] * v[1], w[2] * v[0] - w[0] * v[2], w[0] * v[1] - w[1] * v[0]};
    const Point uw{u[1] * w[2] - u[2] * w[1], u[2] * w[0] - u[0] * w[2], u[0] * w[1] - u[1] * w[0]};
    const double s = dot(wv, n) / nn, t = dot(uw, n) / nn;
    if (s < 0 || t < 0 || s + t > 1) return sides;
    return std::min(sides, std::abs(dot(w, n)) / std::sqrt(nn));
}

// Boxes over the triangles of a face, halved by the longest side of the box of their centres.
class Tree {
public:
    explicit Tree(const FaceTriangles& face) : face_(face), order_(face.triangles.size()) {
        std::iota(order_.begin(), order_.end(), 0);
        nodes_.push_back({{}, {}, 0, int(order_.size()), -1});
        for (std::size_t i = 0; i < nodes_.size(); ++i) divide(i);
    }

    // The smallest of `known` and the distances from p to all triangles.
    double nearest(const Point& p, double known) const {
        std::vector<int> open{0};
        while (!open.empty()) {
            const Node& n = nodes_[std::size_t(open.back())];
            open.pop_back();
            if (away(p, n) >= known) continue;
            if (n.left < 0) {
                for (int i = n.first; i < n.last; ++i) known = std::min(known, to(p, order_[std::size_t(i)]));
                continue;
            }
            const bool swap = away(p, nodes_[std::size_t(n.left)]) < away(p, nodes_[std::size_t(n.left) + 1]);
            open.push_back(n.left + (swap ? 1 : 0));
            open.push_back(n.left + (swap ? 0 : 1));  // the nearer one is looked at first
        }
        return known;
    }

    double to(const Point& p, int triangle) const {
        const auto& t = face_.triangles[std::size_t(triangle)];
        return to_triangle(p, corner(t[0]), corner(t[1]), corner(t[2]));
    }

private:
    struct Node {
        Point lo, hi;
        int first, last, left;
    };

    const Point& corner(int i) const { return face_.points[std::size_t(i)]; }

    static double away(const Point& p, const Node& n) {
        double sum = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            const double d = std::max({n.lo[k] - p[k], p[k] - n.hi[k], 0.0});
            sum += d * d;
        }
        return std::sqrt(sum);
    }

    double centre(int triangle, std::size_t axis) const {
        double sum = 0;
        for (int i : face_.triangles[std::size_t(triangle)]) sum += corner(i)[axis];
        return sum;
    }

    void divide(std::size_t at) {
        Node& n = nodes_[at];
        constexpr double kFar = std::numeric_limits<double>::infinity();
        n.lo = {kFar, kFar, kFar}, n.hi = {-kFar, -kFar, -kFar};
        for (int i = n.first; i < n.last; ++i)
            for (int v : face_.triangles[std::size_t(order_[std::size_t(i)])])
                for (std::size_t k = 0; k < 3; ++k) {
                    n.lo[k] = std::min(n.lo[k], corner(v)[k]);
                    n.hi[k] = std::max(n.hi[k], corner(v)[k]);
                }
        if (n.last - n.first <= 8) return;
        std::size_t axis = 0;
        for (std::size_t k = 1; k < 3; ++k)
            if (n.hi[k] - n.lo[k] > n.hi[axis] - n.lo[axis]) axis = k;
        const int middle = n.first + (n.last - n.first) / 2;
        std::nth_element(order_.begin() + n.first, order_.begin() + middle, order_.begin() + n.last,
                         [&](int a, int b) { return centre(a, axis) < centre(b, axis); });
        const Node left{{}, {}, n.first, middle, -1}, right{{}, {}, middle, n.last, -1};
        n.left = int(nodes_.size());
        nodes_.push_back(left);
        nodes_.push_back(right);
    }

    const FaceTriangles& face_;
    std::vector<int> order_;
    std::vector<Node> nodes_;
};

struct Cell {
    long long x, y, z;
    bool operator==(const Cell&) const = default;
};
struct CellHash {
    std::size_t operator()(const Cell& c) const {
        std::uint64_t h = 0;
        for (long long k : {c.x, c.y, c.z}) h = (h ^ std::uint64_t(k)) * 0x9e3779b97f4a7c15u, h ^= h >> 29;
        return std::size_t(h);
    }
};

// Numbers points so that those within `distance` of an earlier one get its number.
class Welder {
public:
    explicit Welder(double distance) : distance_(distance) {}

    int number(const Point& p) {
        const auto cell = [&](double x) { return (long long)(std::floor(x / (2 * distance_))); };
        const Cell at{cell(p[0]), cell(p[1]), cell(p[2])};
        for (long long x = at.x - 1; x <= at.x + 1; ++x)
            for (long long y = at.y - 1; y <= at.y + 1; ++y)
                for (long long z = at.z - 1; z <= at.z + 1; ++z)
                    if (const auto found = cells_.find({x, y, z}); found != cells_.end())
                        for (int i : found->second)
                            if (length(minus(points_[std::size_t(i)], p)) <= distance_) return i;
        points_.push_back(p);
        cells_[at].push_back(int(points_.size()) - 1);
        return int(points_.size()) - 1;
    }

private:
    double distance_;
    std::vector<Point> points_;
    std::unordered_map<Cell, std::vector<int>, CellHash> cells_;
};

}  // namespace

Deviation deviation(const std::vector<FaceTriangles>& faces, double tolerance) {
    constexpr int kParts = 6;  // i + j + k = 6 with all positive: ten places, none on a side
    Deviation out;
    for (std::size_t f = 0; f < faces.size(); ++f) {
        const FaceTriangles& face = faces[f];
        if (face.uv.empty() || face.triangles.empty()) continue;
        const Tree tree(face);
        for (std::size_t t = 0; t < face.triangles.size(); ++t) {
            std::array<std::array<double, 2>, 3> uv;
            for (std::size_t k = 0; k < 3; ++k) uv[k] = face.uv[std::size_t(face.triangles[t][k])];
            bool over = false;
            for (int i = 1; i < kParts; ++i)
                for (int j = 1; i + j < kParts; ++j) {
                    const int k = kParts - i - j;
                    const Point p = face.surface((i * uv[0][0] + j * uv[1][0] + k * uv[2][0]) / kParts,
                                                 (i * uv[0][1] + j * uv[1][1] + k * uv[2][1]) / kParts);
                    double d = tree.to(p, int(t));
                    if (d > out.largest || d > tolerance) d = tree.nearest(p, d);
                    ++out.samples;
                    over = over || d > tolerance;
                    if (d > out.largest) out.largest = d, out.face = int(f);
                }
            out.over += over;
        }
    }
    return out;
}

Welded weld(const std::vector<FaceTriangles>& faces, double distance) {
    Welded out;
    Welder welder(distance);
    std::unordered_map<std::uint64_t, int> uses;
    for (const FaceTriangles& face : faces) {
        std::vector<int> number;
        for (const Point& p : face.points) number.push_back(welder.number(p));
        for (const auto& t : face.triangles) {
            const std::array<int, 3> n{number[std::size_t(t[0])], number[std::size_t(t[1])],
                                       number[std::size_t(t[2])]};
            if (n[0] == n[1] || n[1] == n[2] || n[2] == n[0]) {
                ++out.degenerate;
                continue;
            }
            for (std::size_t k = 0; k < 3; ++k) {
                const auto [a, b] = std::minmax(n[k], n[(k + 1) % 3]);
                ++uses[std::uint64_t(a) << 32 | std::uint64_t(b)];
            }
        }
    }
    for (const auto& [edge, count] : uses) {
        out.open += count == 1;
        out.non_manifold += count > 2;
    }
    return out;
}

std::vector<double> smallest_angles(const std::vector<FaceTriangles>& faces,
                                    const std::vector<double>& limits) {
    std::vector<double> below(limits.size());
    for (const FaceTriangles& face : faces)
        for (const auto& t : face.triangles) {
            double smallest = 180;
            for (std::size_t k = 0; k < 3; ++k) {
                const Point& o = face.points[std::size_t(t[k])];
                const Point a = minus(face.points[std::size_t(t[(k + 1) % 3])], o);
                const Point b = minus(face.points[std::size_t(t[(k + 2) % 3])], o);
                const double size = length(a) * length(b);
                const double angle = size > 0 ? std::acos(std::clamp(dot(a, b) / size, -1.0, 1.0)) : 0;
                smallest = std::min(smallest, angle * 180 / std::numbers::pi);
            }
            for (std::size_t i = 0; i < limits.size(); ++i) below[i] += smallest < limits[i];
        }
    const double all = double(std::max(triangle_count(faces), 1LL));
    for (double& b : below) b /= all;
    return below;
}

long long triangle_count(const std::vector<FaceTriangles>& faces) {
    long long n = 0;
    for (const FaceTriangles& f : faces) n += (long long)(f.triangles.size());
    return n;
}

Seconds now() {
    std::timespec used{};
    clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &used);
    return {std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(),
            double(used.tv_sec) + 1e-9 * double(used.tv_nsec)};
}

std::vector<Seconds> repeat(int repetitions, double budget, const std::function<void()>& job) {
    std::vector<Seconds> times;
    const double start = now().wall;
    while (int(times.size()) < repetitions && (times.size() < 2 || now().wall - start < budget)) {
        const Seconds before = now();
        job();
        const Seconds after = now();
        times.push_back({after.wall - before.wall, after.processor - before.processor});
    }
    return times;
}

}  // namespace freiform::bench
