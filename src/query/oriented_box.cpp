// Boxes in any orientation.
//
// Idea. Which orientation is a choice, made on the hull of control points of coarse pieces; what the object
// reaches along the three axes is then found as for tight boxes (bounds.cpp), with a proof that does not ask
// where the axes came from.
//
// Method. In the plane a box of least area has a side on a side of the hull. In space one of least volume has
// two neighbouring sides on edges of the hull [O'Rourke 1985], found by an algorithm of cubic time; here one
// side is on a facet and one on an edge of the shadow of the hull along its normal, which is nearly as good.
// The largest facets are tried, and the coordinate axes.
//
// Reach along a: branch and bound over parts, the one that may reach farthest first: at most a . p for its
// points p, and at least a . p less how far p is from the hull of the object.
//
// Accuracy. Scalar products: 2 (D + 1) u |p|, in both bounds. Axes are off orthonormal by some u: they are
// computed by products and a division.
//
// Why not principal axes? They depend on how the points are spread, and are wrong for a cube.
#include "query/piece_side_detail.hpp"

#include <freiform/core/sort.hpp>
#include <freiform/query/checks.hpp>
#include <freiform/query/oriented_box.hpp>

namespace freiform {

namespace {

constexpr std::size_t kMostFacets = 200;
constexpr double kCoarse = 1.0 / 64;  // of the diagonal: the hull that orientations come from
constexpr double kThinBox =
    0x1p-40;  // likewise, what a side counts at least: flat boxes have areas to compare
constexpr int kCoarseParts = 2000;

template <int D>
Interval extent_of(std::span<const Vec<D>> points, const Vec<D>& a) {
    Interval out{kInfinity, -kInfinity};
    for (const Vec<D>& p : points) {
        const double x = dot(a, p);
        out = {std::min(out.lo, x), std::max(out.hi, x)};
    }
    return out;
}

// The direction of a side of a polygon along which its box has the least area.
Vec<2> best_side(std::span<const Vec<2>> points, const std::vector<std::array<int, 2>>& sides, double thin) {
    Vec<2> best{{1, 0}};
    const auto area = [&](const Vec<2>& d) {
        return (extent_of<2>(points, d).length() + thin) *
               (extent_of<2>(points, {{-d[1], d[0]}}).length() + thin);
    };
    double least = area(best);
    for (const auto& [a, b] : sides) {
        const Vec<2> side = points[std::size_t(b)] - points[std::size_t(a)];
        if (!(norm(side) > 0)) continue;
        const Vec<2> d = unit(side);
        if (const double x = area(d); x < least) least = x, best = d;
    }
    return best;
}

// How far the object reaches along a: [least, most].
template <int D>
Interval reach_along(detail::PieceSide<D>& side, const Vec<D>& a, double accuracy, int max_parts) {
    const double rounding = 2 * (D + 1) * kUnitRoundoff * side.largest() * std::sqrt(double(D));
    struct Item {
        double most;
        int part;
    };
    std::vector<Item> heap;
    double least = -kInfinity;
    const auto push = [&](int i, double bound) {
        const double slack = side.parts()[std::size_t(i)].slack + side.slip() + rounding;
        double most = -kInfinity;
        for (int k = 0; const Vec<D>& p : side.hull(i)) {
            const double x = dot(a, p);
            if (!side.is_box(i) && x - slack > least) least = std::max(least, x - side.apart(i, k) - slack);
            most = std::max(most, x + slack);
            ++k;
        }
        heap.push_back({std::min(most, bound), i});
        std::ranges::push_heap(heap, {}, &Item::most);
    };
    push(0, kInfinity);
    for (int parts = 0;; ++parts) {
        std::ranges::pop_heap(heap, {}, &Item::most);
        const Item item = heap.back();
        heap.pop_back();
        const double slack = side.parts()[std::size_t(item.part)].slack + side.slip() + rounding;
        const bool done = item.most - least <= std::max(accuracy, 8 * slack) ||
                          (parts >= max_parts && std::isfinite(least));
        if (done || !side.split(item.part)) return {least, item.most};
        const detail::PairPart<D> part = side.parts()[std::size_t(item.part)];
        for (int k = part.first; k < part.end; ++k) push(k, item.most);
    }
}

}  // namespace

template <int D>
Vec<D> OrientedBox<D>::half() const {
    double scale = 0;
    for (const Interval& r : range) scale += std::max(std::abs(r.lo), std::abs(r.hi));
    Vec<D> h{};
    for (int k = 0; k < D; ++k) h[k] = range[std::size_t(k)].length() / 2 + 64 * kUnitRoundoff * scale;
    return h;
}
template <int D>
double OrientedBox<D>::volume() const {
    double v = 1;
    for (const Interval& r : range) v *= r.length();
    return v;
}

template <>
std::array<Vec<2>, 2> box_axes<2>(const ConvexHull<2>& hull) {
    Box<2> box;
    for (const Vec<2>& p : hull.points) box.add(p);
    const Vec<2> d = best_side(hull.points, hull.facets, kThinBox * box.diagonal());
    return {d, Vec<2>{{-d[1], d[0]}}};
}

template <>
std::array<Vec<3>, 3> box_axes<3>(const ConvexHull<3>& hull) {
    Box<3> box;
    for (const Vec<3>& p : hull.points) box.add(p);
    const double thin = kThinBox * box.diagonal();
    struct Normal {
        double area;
        Vec<3> n;
    };
    std::vector<Normal> normals;
    for (const auto& f : hull.facets) {
        const Vec<3>& a = hull.points[std::size_t(f[0])];
        const Vec<3> n = cross(hull.points[std::size_t(f[1])] - a, hull.points[std::size_t(f[2])] - a);
        if (norm(n) > 0) normals.push_back({norm(n), unit(n)});
    }
    sort(normals, {}, [](const Normal& n) { return -n.area; });
    if (normals.size() > kMostFacets) normals.resize(kMostFacets);
    for (int k = 0; k < 3; ++k) {
        Vec<3> axis{};
        axis[k] = 1;
        normals.push_back({0, axis});
    }
    std::array<Vec<3>, 3> best{};
    double least = kInfinity;
    for (const Normal& normal : normals) {
        Vec<3> axis{};
        axis[std::abs(normal.n[0]) < 0.6 ? 0 : 1] = 1;
        const Vec<3> e = unit(cross(normal.n, axis)), f = unit(cross(normal.n, e));
        std::vector<Vec<2>> shadow;
        for (const Vec<3>& p : hull.points) shadow.push_back({{dot(e, p), dot(f, p)}});
        const auto corners = convex_hull(std::span<const Vec<2>>(shadow));
        if (!corners) continue;
        std::vector<Vec<2>> polygon;
        std::vector<std::array<int, 2>> sides;
        for (const int i : *corners) {
            sides.push_back({int(polygon.size()), int((polygon.size() + 1) % corners->size())});
            polygon.push_back(shadow[std::size_t(i)]);
        }
        const Vec<2> d = best_side(polygon, sides, thin);
        const Vec<3> u = unit(d[0] * e + d[1] * f), v = unit(cross(normal.n, u));
        double volume = extent_of<3>(hull.points, normal.n).length() + thin;
        for (const Vec<3>& a : {u, v}) volume *= extent_of<3>(hull.points, a).length() + thin;
        if (volume < least) least = volume, best = {u, v, cross(u, v)};
    }
    return best;
}

template <int D>
Result<OrientedBox<D>> oriented_box(const NearestQuery& object, double accuracy, int max_parts) {
    if (auto ok = detail::check_accuracy(accuracy); !ok) return std::unexpected(ok.error());
    if (max_parts < 1) return refuse(RefusalKind::invalid, "max_parts", "is below 1");
    FF_REQUIRE(D == object.coordinates());
    const int e = object.tree().exponent();
    detail::PieceSide<D> side(object.tree(), 1);
    const auto hull =
        convex_hull<D>(object, kCoarse * std::scalbn(side.parts()[0].box.diagonal(), e), kCoarseParts);
    if (!hull) return std::unexpected(hull.error());
    OrientedBox<D> out;
    out.axes = box_axes(*hull);
    for (std::size_t k = 0; k < D; ++k) {
        const double within = std::scalbn(accuracy, -e);
        const Interval up = reach_along<D>(side, out.axes[k], within, max_parts);
        const Interval down = reach_along<D>(side, -1.0 * out.axes[k], within, max_parts);
        out.range[k] = {std::scalbn(-down.hi, e), std::scalbn(up.hi, e)};
        out.slack = std::max({out.slack, std::scalbn(up.length(), e), std::scalbn(down.length(), e)});
    }
    return out;
}

template struct OrientedBox<2>;
template struct OrientedBox<3>;
template Result<OrientedBox<2>> oriented_box<2>(const NearestQuery&, double, int);
template Result<OrientedBox<3>> oriented_box<3>(const NearestQuery&, double, int);

}  // namespace freiform
