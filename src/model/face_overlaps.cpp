// What the loops of two faces leave of a region over which they are the same surface.
//
// Idea. There the parameters of one are an affine function of those of the other, so the loops of both, and
// the polygon of the region, are paths of one plane: their intersection is a Boolean operation of regions.
//
// Notation. x: parameters of the first face times its unit, so that a length of x is about one in space: a
// step d in the plane moves a point by at most 4 |d| (unit >= half of what parameters stretch, for u and v).
//
// Accuracy. The bound of the region, twice, and of curves that are made cubics; for those of the second face
// times what the map makes them longer by.
#include "face_overlaps_detail.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/region/boolean.hpp>

#include <algorithm>
#include <cmath>

namespace freiform {

namespace {

constexpr double kStretch = 4;
constexpr double kShare = 1.0 / 16;  // of the tolerance, for each step

// x -> l x + o
struct Map2 {
    std::array<Vec<2>, 2> row{};
    Vec<2> offset{};
    Vec<2> operator()(const Vec<2>& x) const {
        return {{dot(row[0], x) + offset[0], dot(row[1], x) + offset[1]}};
    }
    double longest() const { return std::sqrt(dot(row[0], row[0]) + dot(row[1], row[1])); }
};
Path mapped(Path path, const auto& map) {
    for (Subpath& s : path.subpaths) {
        s.start = map(s.start);
        for (PathSegment& segment : s.segments)
            for (int k = 0; k <= segment.degree; ++k)
                segment.points[std::size_t(k)] = map(segment.points[std::size_t(k)]);
    }
    return path;
}

// With from[i] -> to[i] for the three corners that are least on one line.
std::optional<Map2> map_of(const std::vector<Vec<2>>& from, const std::vector<Vec<2>>& to) {
    double most = 0;
    std::optional<Map2> out;
    for (std::size_t i = 1; i + 1 < from.size(); ++i) {
        const Vec<2> u = from[i] - from[0], v = from[i + 1] - from[0], p = to[i] - to[0],
                     q = to[i + 1] - to[0];
        const double area = cross(u, v);
        if (!(std::abs(area) > most)) continue;
        most = std::abs(area);
        Map2 m;
        for (std::size_t k = 0; k < 2; ++k) {
            const int c = int(k);
            m.row[k] = {{(p[c] * v[1] - q[c] * u[1]) / area, (q[c] * u[0] - p[c] * v[0]) / area}};
        }
        m.offset = to[0] - Vec<2>{{dot(m.row[0], from[0]), dot(m.row[1], from[0])}};
        out = m;
    }
    return out;
}

Path polygon(const std::vector<Vec<2>>& corners) {
    Subpath s;
    s.start = corners[0];
    s.closed = true;
    for (std::size_t i = 0; i < corners.size(); ++i)
        s.segments.push_back({1, {corners[i], corners[(i + 1) % corners.size()]}});
    return {{s}};
}
double perimeter(const Path& path) {
    double sum = 0;
    for (const Subpath& s : path.subpaths)
        for (const PathSegment& p : s.segments)
            for (std::size_t k = 0; k < std::size_t(p.degree); ++k)
                sum += norm(p.points[k + 1] - p.points[k]);
    return sum;
}

}  // namespace

Result<std::optional<FaceOverlap>> face_overlap(const std::array<const FaceLoops*, 2>& loops,
                                                const SurfaceOverlap& overlap, double tolerance) {
    const Vec<2> unit = loops[0]->unit();
    std::vector<Vec<2>> corners;
    for (const Vec<2>& x : overlap.loop_a) corners.push_back({{x[0] * unit[0], x[1] * unit[1]}});
    const auto to_b = map_of(corners, overlap.loop_b), to_a = map_of(overlap.loop_b, corners);
    if (!to_b || !to_a) return std::nullopt;
    const double share = kShare * tolerance;
    Region all{polygon(corners), 0};
    double bound = 0;
    for (std::size_t side = 0; side < 2; ++side) {
        if (loops[side]->is_empty()) continue;
        // Of lengths in the parameters of this face.
        const double longer = side == 0 ? 1 : to_a->longest();
        auto own = loops[side]->path(side == 0 ? unit : Vec<2>{{1, 1}}, share / longer);
        if (!own) return std::unexpected(own.error());
        bound += own->bound * longer;
        const Path path = side == 0 ? std::move(own->path) : mapped(std::move(own->path), *to_a);
        auto cut = combine({all.path}, {path, FillRule::evenodd}, RegionOperation::intersection,
                           {.tolerance = share});
        if (!cut) return std::unexpected(cut.error());
        bound += cut->bound;
        all = std::move(*cut);
    }
    // What is no wider than the tolerance is a border that they share.
    if (all.path.subpaths.empty() || !(signed_area(all.path).value > tolerance * perimeter(all.path)))
        return std::nullopt;
    double scale = 0;
    for (const Vec<2>& x : corners) scale = std::max(scale, max_abs(x));
    FaceOverlap out;
    out.gap = overlap.gap;
    out.bound = kStretch * (bound + 64 * kUnitRoundoff * scale);
    out.at_b = mapped(all.path, *to_b);
    out.at_a = mapped(std::move(all.path), [&](const Vec<2>& x) {
        return Vec<2>{{x[0] / unit[0], x[1] / unit[1]}};
    });
    return out;
}

}  // namespace freiform
