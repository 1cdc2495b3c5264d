// Constrained Delaunay triangulation of polygons: how it is built. Points: triangulate_insert.cpp, segments:
// triangulate_segment.cpp.
//
// Idea. A triangulation of the sphere: the plane's triangulation, plus one vertex at infinity joined to every
// hull edge. Then each edge has two sides, the hull is nothing special, and no far-away auxiliary points
// disturb it. "Inside the circle" of an infinite triangle means beyond its hull edge.
//
// Method. Refuse what cannot work (equal points, open boundaries). Insert the points one by one, in an order
// with short walks (insertion_order); then force the segments one by one through the triangles that they
// cross; then walk from infinity over all triangles, changing sides at each segment that is there an odd
// number of times. A segment that meets another segment or a point where it must not is left out, noted, and
// the next ones are tried, so that one attempt finds many conflicts.
//
// Notation. In comments, (a, b, c) are the corners of a triangle, and "side of a" what is across its edge
// opposite to a.
//
// Accuracy. Every decision is the exact sign of a determinant of given coordinates; no coordinate is ever
// computed. Hence all triangles are strictly counter-clockwise, and edges that are not constrained have
// strictly nothing in their circle. Where four points are on one circle, the order of insertion decides,
// which is determined by the input.
//
// Cost. O(n log n) expected for points. Memory: 32 bytes for each of the 2n triangles, 20 bytes for each
// point.
//
// References. [Shewchuk 1997], [Amenta, Choi & Rote 2003], [Lawson 1977], [Anglada 1997].
//
// Why not a large triangle around everything? Its corners are on the circles of flat hull triangles, so hulls
// come out wrong, and their coordinates spoil the exactness window of the predicates.
#include "mesh/insertion_order_detail.hpp"

#include <freiform/core/sort.hpp>
#include <freiform/mesh/triangulate.hpp>
#include <freiform/poly/predicates.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace freiform {

namespace {

using Segment = Triangulation::Segment;
using Conflict = Triangulation::Conflict;
using Problem = Triangulation::Problem;

std::unexpected<Problem> refuse_all(RefusalKind kind, std::string where, std::string message,
                                    std::vector<Conflict> conflicts = {}) {
    return std::unexpected(Problem{{kind, std::move(where), std::move(message)}, std::move(conflicts)});
}

std::expected<void, Problem> check_input(std::span<const Vec<2>> points, std::span<const Segment> segments) {
    if (points.size() > std::size_t(Triangulation::kMaxPoints))
        return refuse_all(
            RefusalKind::limit, "points",
            text(points.size(), " points, at most ", Triangulation::kMaxPoints, " are possible"));
    for (std::size_t i = 0; i < points.size(); ++i)
        if (!is_finite(points[i]))
            return refuse_all(RefusalKind::nonfinite, text("points[", i, "]"),
                              text("(", points[i][0], ", ", points[i][1], ") is not finite"));
    const int n = int(points.size());
    std::vector<bool> is_odd(points.size());
    for (std::size_t i = 0; i < segments.size(); ++i) {
        const auto [a, b] = segments[i];
        for (const int p : {a, b}) {
            if (p < 0 || p >= n)
                return refuse_all(RefusalKind::invalid, text("segments[", i, "]"),
                                  text("ends at point ", p, ", but there are ", n, " points"));
            is_odd[std::size_t(p)] = !is_odd[std::size_t(p)];
        }
        if (a == b)
            return refuse_all(RefusalKind::invalid, text("segments[", i, "]"),
                              text("leads from point ", a, " to itself"));
    }
    const auto open = std::find(is_odd.begin(), is_odd.end(), true);
    if (open != is_odd.end())
        return refuse_all(RefusalKind::invalid, text("points[", open - is_odd.begin(), "]"),
                          "the boundary is not closed: an odd number of segments ends here");
    return {};
}

// Indices in the order of x, then y, then index.
std::vector<int> sorted(std::span<const Vec<2>> points) {
    std::vector<int> order(points.size());
    std::iota(order.begin(), order.end(), 0);
    sort(order.begin(), order.end(), [&](int i, int j) {
        const Vec<2>&p = points[std::size_t(i)], &q = points[std::size_t(j)];
        return p[0] != q[0] ? p[0] < q[0] : p[1] != q[1] ? p[1] < q[1] : i < j;
    });
    return order;
}

std::expected<void, Problem> check_distinct(std::span<const Vec<2>> points, const std::vector<int>& order) {
    std::vector<Conflict> conflicts;
    for (std::size_t k = 1; k < order.size(); ++k)
        if (points[std::size_t(order[k])] == points[std::size_t(order[k - 1])])
            conflicts.push_back({.point = order[k], .other_point = order[k - 1]});
    if (conflicts.empty()) return {};
    sort(conflicts.begin(), conflicts.end(), [](auto& c, auto& d) { return c.point < d.point; });
    const auto [j, i] = std::pair(conflicts[0].point, conflicts[0].other_point);
    const Vec<2>& p = points[std::size_t(j)];
    return refuse_all(RefusalKind::invalid, text("points[", j, "]"),
                      text("equals points[", i, "], (", p[0], ", ", p[1], "); points must be distinct"),
                      std::move(conflicts));
}

// All points are on one line, in this order along it: segments may only join neighbours.
std::vector<Conflict> conflicts_on_a_line(std::span<const Segment> segments, const std::vector<int>& order) {
    std::vector<int> place(order.size());
    for (std::size_t k = 0; k < order.size(); ++k) place[std::size_t(order[k])] = int(k);
    std::vector<Conflict> conflicts;
    for (std::size_t i = 0; i < segments.size(); ++i) {
        const int from = place[std::size_t(segments[i].a)], to = place[std::size_t(segments[i].b)];
        if (std::abs(from - to) > 1)
            conflicts.push_back(
                {.first_segment = int(i), .point = order[std::size_t(from < to ? from + 1 : from - 1)]});
    }
    return conflicts;
}

// Conflicts come with the ends of the segment that was crossed in point and other_point: finds the segment.
void name_crossed_segments(std::vector<Conflict>& conflicts, std::span<const Segment> segments) {
    struct SegmentEnds {
        int low, high, segment;
        auto operator<=>(const SegmentEnds&) const = default;
    };
    std::vector<SegmentEnds> table;
    for (std::size_t i = 0; i < segments.size(); ++i)
        table.push_back(
            {std::min(segments[i].a, segments[i].b), std::max(segments[i].a, segments[i].b), int(i)});
    sort(table.begin(), table.end());
    for (Conflict& c : conflicts) {
        if (c.other_point < 0) continue;
        const SegmentEnds key{std::min(c.point, c.other_point), std::max(c.point, c.other_point), -1};
        c.second_segment = std::lower_bound(table.begin(), table.end(), key)->segment;
        c.point = c.other_point = -1;
    }
}

std::unexpected<Problem> refuse_conflicts(std::vector<Conflict> conflicts) {
    const Conflict& c = conflicts[0];
    return refuse_all(
        RefusalKind::invalid, text("segments[", c.first_segment, "]"),
        c.point >= 0 ? text("passes through points[", c.point, "], which must be an end of it")
                     : text("crosses segments[", c.second_segment, "]; segments may meet at their ends only"),
        std::move(conflicts));
}

}  // namespace

std::expected<Triangulation, Problem> Triangulation::attempt(std::span<const Vec<2>> points,
                                                             std::span<const Segment> segments) {
    if (auto ok = check_input(points, segments); !ok) return std::unexpected(std::move(ok.error()));
    const std::vector<int> order = sorted(points);
    if (auto ok = check_distinct(points, order); !ok) return std::unexpected(std::move(ok.error()));

    Triangulation t;
    t.points_.assign(points.begin(), points.end());
    t.vertex_triangle_.assign(points.size(), -1);
    t.triangulate_points();
    std::vector<Conflict> conflicts;
    if (t.triangles_.empty()) {
        conflicts = conflicts_on_a_line(segments, order);
    } else {
        for (std::size_t i = 0; i < segments.size(); ++i) {
            Conflict c{.first_segment = int(i)};
            if (!t.insert_segment(segments[i], c)) conflicts.push_back(c);
        }
        name_crossed_segments(conflicts, segments);
    }
    if (!conflicts.empty()) return refuse_conflicts(std::move(conflicts));
    t.find_inside();
    t.changed_.clear();
    return t;
}

Result<Triangulation> Triangulation::make(std::span<const Vec<2>> points, std::span<const Segment> segments) {
    auto t = attempt(points, segments);
    if (!t) return std::unexpected(std::move(t.error().refusal));
    return std::move(*t);
}

// Delaunay triangulation of all points; nothing if they are on one line.
void Triangulation::triangulate_points() {
    std::vector<int> order = detail::insertion_order(points_);
    std::size_t k = 2;
    int turn = 0;
    for (; k < order.size(); ++k)
        if ((turn = orient2d(point(order[0]), point(order[1]), point(order[k]))) != 0) break;
    if (turn == 0) return;
    std::rotate(order.begin() + 2, order.begin() + std::ptrdiff_t(k), order.begin() + std::ptrdiff_t(k) + 1);
    if (turn < 0) std::swap(order[0], order[1]);

    // The first triangle (a, b, c), and the infinite ones of its sides a, b, c.
    triangles_.reserve(2 * points_.size());
    start_change();
    for (int i = 0; i < 4; ++i) append({});
    const int a = order[0], b = order[1], c = order[2];
    place(0, {a, b, c}, {{{1, 0}, {2, 0}, {3, 0}}});
    place(1, {c, b, kInfinite}, {{{3, 0}, {2, 0}, {0, 0}}});
    place(2, {a, c, kInfinite}, {{{1, 0}, {3, 0}, {0, 0}}});
    place(3, {b, a, kInfinite}, {{{2, 0}, {1, 0}, {0, 0}}});
    last_ = 0;
    for (std::size_t i = 3; i < order.size(); ++i) insert_vertex(order[i], locate(point(order[i])));
}

// Odd-even rule: infinite triangles are outside, and each edge with a toggle bit changes sides. As an even
// number of segments ends at each point, all ways to a triangle cross the same number of segments modulo 2.
void Triangulation::find_inside() {
    std::vector<int> todo;
    for (int t = 0; t < size(); ++t) {
        at(t).flags &= std::uint8_t(~kInsideFlag);
        if (is_infinite(t)) {
            todo.push_back(t);
            at(t).flags |= kMarkFlag;
        }
    }
    while (!todo.empty()) {
        const int t = todo.back();
        todo.pop_back();
        for (int i = 0; i < 3; ++i) {
            const auto [n, flags] = side(t, i);
            if (at(n).flags & kMarkFlag) continue;
            const bool toggles = flags & kEdgeFlags & ~1;
            at(n).flags |= std::uint8_t(kMarkFlag | (is_inside(t) != toggles ? kInsideFlag : 0));
            todo.push_back(n);
        }
    }
    for (Triangle& t : triangles_) t.flags &= std::uint8_t(~kMarkFlag);
}

Result<void> Triangulation::extend(std::span<const Vec<2>> points, std::span<const Segment> segments) {
    const std::size_t before = points_.size();
    points_.insert(points_.end(), points.begin(), points.end());
    vertex_triangle_.resize(points_.size(), -1);
    if (auto ok = check_input(points_, segments); !ok) return std::unexpected(std::move(ok.error().refusal));
    if (triangles_.empty()) return refuse(RefusalKind::invalid, "points", "the others are on one line");
    start_change();
    for (const int k : detail::insertion_order(points)) {
        const int v = int(before) + k;
        const Location where = locate(point(v));
        if (where.on == Location::On::vertex ||
            (where.on == Location::On::edge && is_constrained(where.triangle, where.part)))
            return refuse(RefusalKind::invalid, text("points[", v, "]"),
                          "equals another point, or lies on a segment");
        insert_vertex(v, where);
    }
    for (std::size_t i = 0; i < segments.size(); ++i)
        if (Conflict c; !insert_segment(segments[i], c))
            return refuse(RefusalKind::invalid, text("segments[", i, "]"),
                          "crosses another segment, or passes through a point");
    find_inside();
    changed_.clear();
    return {};
}

Triangulation::Edge Triangulation::find_edge(int a, int b) const {
    const int begin = triangle_of(a);
    if (begin < 0 || a == b) return {};
    for (int t = begin;;) {
        const int i = corner_of(t, a);
        if (at(t).vertex[std::size_t((i + 1) % 3)] == b) return {t, (i + 2) % 3};
        t = neighbour(t, (i + 1) % 3);
        if (t == begin) return {};
    }
}

}  // namespace freiform
