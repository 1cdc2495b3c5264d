// Convex hulls of curves, surfaces, volumes and triangles.
//
// Idea. The object is in the hull of the control points of its Bezier pieces, and their hull comes near to
// that of the object as pieces are halved (query/hull_search.hpp): only those that own a corner which is too
// far away.
//
// Bounds. The corner control points of a piece are points of the object, and so are combinations of them
// points of its hull: a control point (i / p, j / q) of the net is no farther from it than from the
// multilinear interpolation of the corners there. Halving brings it nearer by four.
//
// Containment. Control points are off by what halving and extraction rounded (piece_side_detail.hpp),
// `margin`. If a ball of radius r about c is in the convex set K, then all within m of K is in c + (1 + m /
// r)(K - c): the hull is blown up by twice that, r from the distances of the facets, halved for rounding.
// Thin hulls, and objects in a plane of space, get a cube of twice the margin around every corner instead.
//
// Cost. About sqrt(1 / tolerance) corners for a curve, 1 / tolerance for a surface, n log n for each round.
//
// References. [Barber 1996] for the hull of points; [Lane Riesenfeld 1981].
//
// Why not libqhull? It decides by doubles and merges what it is not sure of; its facets would have to be
// widened by an error that it states only for its own input.
#include "query/piece_side_detail.hpp"

#include <freiform/core/sort.hpp>
#include <freiform/query/checks.hpp>
#include <freiform/query/hull_search.hpp>
#include <freiform/query/nearest.hpp>

namespace freiform {

namespace detail {

template <>
PointHull<2>::PointHull(std::span<const Vec<2>> points) {
    if (const auto found = convex_hull(points)) corners = *found;
    for (std::size_t i = 0; corners.size() > 2 && i < corners.size(); ++i)
        facets.push_back({corners[i], corners[(i + 1) % corners.size()]});
}

template <>
PointHull<3>::PointHull(std::span<const Vec<3>> points) {
    if (auto found = hull_triangles(points)) {
        facets = *std::move(found);
        for (const auto& f : facets) corners.insert(corners.end(), f.begin(), f.end());
    } else {  // in a plane: a corner of its polygon is one along two of the axes
        for (int k = 0; k < 3; ++k) {
            std::vector<Vec<2>> flat;
            for (const Vec<3>& p : points) flat.push_back({{p[k], p[(k + 1) % 3]}});
            if (const auto hull = convex_hull(flat))
                corners.insert(corners.end(), hull->begin(), hull->end());
        }
    }
    sort(corners);
    const auto again = std::ranges::unique(corners);
    corners.erase(again.begin(), again.end());
}

namespace {

double depth_below(std::span<const Vec<2>> p, const std::array<int, 2>& f, const Vec<2>& c) {
    const Vec<2> a = p[std::size_t(f[0])], d = p[std::size_t(f[1])] - a, r = c - a;
    return (d[0] * r[1] - d[1] * r[0]) / norm(d);
}
double depth_below(std::span<const Vec<3>> p, const std::array<int, 3>& f, const Vec<3>& c) {
    const Vec<3>& a = p[std::size_t(f[0])];
    const Vec<3> n = cross(p[std::size_t(f[1])] - a, p[std::size_t(f[2])] - a);
    return dot(n, a - c) / norm(n);
}

template <int D>
ConvexHull<D> hull_of_points(std::vector<Vec<D>> points) {
    const PointHull<D> hull(points);
    ConvexHull<D> out;
    std::vector<int> place(points.size(), -1);
    for (const int i : hull.corners) {
        place[std::size_t(i)] = int(out.points.size());
        out.points.push_back(points[std::size_t(i)]);
    }
    out.facets = hull.facets;
    for (auto& facet : out.facets)
        for (int& v : facet) v = place[std::size_t(v)];
    return out;
}

}  // namespace

template <int D>
ConvexHull<D> grown(std::span<const Vec<D>> points, const PointHull<D>& hull, double margin) {
    Vec<D> c{};
    for (const int i : hull.corners) c += (1 / double(hull.corners.size())) * points[std::size_t(i)];
    double r = hull.facets.empty() ? 0 : kInfinity, scale = 0;
    for (const auto& f : hull.facets) r = std::min(r, depth_below(points, f, c));
    for (const int i : hull.corners) scale = std::max(scale, max_abs(points[std::size_t(i)]));
    const double wide = 2 * margin + 16 * kUnitRoundoff * scale;  // the points made here are rounded as well
    std::vector<Vec<D>> moved;
    double most = 0;
    const bool thin = !(r > 0x1p10 * wide);
    for (const int i : hull.corners) {
        const Vec<D>& p = points[std::size_t(i)];
        for (unsigned corner = 0; corner < (thin ? 1u << D : 1u); ++corner) {
            Vec<D> q = p + (2 * wide / r) * (p - c);
            for (int k = 0; k < D && thin; ++k) q[k] = p[k] + (corner >> k & 1 ? wide : -wide);
            most = std::max(most, norm(q - p));
            moved.push_back(q);
        }
    }
    ConvexHull<D> out = hull_of_points(std::move(moved));
    out.slack = most;
    return out;
}
template ConvexHull<2> grown<2>(std::span<const Vec<2>>, const PointHull<2>&, double);
template ConvexHull<3> grown<3>(std::span<const Vec<3>>, const PointHull<3>&, double);

}  // namespace detail

ConvexHull<3> hull_around(std::span<const Vec<3>> points) {
    double scale = 0;
    for (const Vec<3>& p : points) scale = std::max(scale, max_abs(p));
    return detail::grown<3>(points, detail::PointHull<3>(points), 0x1p-48 * scale);
}

template <int D>
Result<ConvexHull<D>> convex_hull(const NearestQuery& object, double tolerance, int max_parts) {
    FF_REQUIRE(D == object.coordinates());
    if (!(tolerance >= 0))
        return refuse(RefusalKind::invalid, "tolerance", text(tolerance, " is not a length >= 0"));
    if (max_parts < 1) return refuse(RefusalKind::invalid, "max_parts", "is below 1");
    const int e = object.tree().exponent();
    detail::PieceSide<D> side(object.tree(), 1);
    auto out = detail::hull_of_parts<D>(side, std::scalbn(tolerance, -e) / 2, side.slip(), max_parts);
    for (Vec<D>& p : out.points)
        for (int k = 0; k < D; ++k) p[k] = std::scalbn(p[k], e);
    out.slack = std::scalbn(out.slack, e);
    return out;
}
template Result<ConvexHull<2>> convex_hull<2>(const NearestQuery&, double, int);
template Result<ConvexHull<3>> convex_hull<3>(const NearestQuery&, double, int);

}  // namespace freiform
