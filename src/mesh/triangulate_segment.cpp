// Forcing a segment into the triangulation. See triangulate.cpp for the whole.
//
// Method. From a towards b, collect the triangles that the open segment ab crosses, and the vertices to its
// left and to its right: two chains from a to b. A crossed edge that is constrained, or a vertex exactly on
// the way, is a conflict, and nothing is changed. Otherwise the triangles are replaced: each chain is closed
// by ab and cut into triangles, and flips make the result Delaunay [Anglada 1997 picks Delaunay triangles
// directly; here the flips do it].
//
// Cutting. Take a chain above ab, c_0 = a, ..., c_n = b. Wherever c_{i-1}, c_i, c_{i+1} strictly turn right,
// cut off this triangle and drop c_i: one pass with a stack, as for convex hulls. Why the triangle is empty:
// the crossed edges at c_i go to vertices w_1 ... w_m strictly below ab, and form, with c_{i-1} and c_{i+1}
// at the ends, a fan of triangles of the old triangulation whose angle at c_i is less than 180 degrees. The
// segment c_{i-1} c_{i+1} is not below ab, so it is nearer to c_i than the rim of the fan, and the triangle
// is within the fan. The same fan without that triangle can be cut into triangles in some way, so the shorter
// chain is again that of a triangulation, and the argument goes on. Why it ends with ab alone: as long as the
// chain has inner vertices, the first of those farthest from ab is such a right turn. A chain may pass a
// vertex twice, around an edge that ends inside the crossed region; the argument holds for such chains as
// well, with the angle at the tip counted as 360 degrees, no turn at all.
#include "mesh/corners_detail.hpp"

#include <freiform/core/sort.hpp>
#include <freiform/mesh/triangulate.hpp>
#include <freiform/poly/predicates.hpp>

#include <algorithm>

namespace freiform {

namespace {

// Is v, on the line ab, on b's side of a?
bool is_ahead(const Vec<2>& a, const Vec<2>& b, const Vec<2>& v) {
    const int k = a[0] == b[0] ? 1 : 0;
    return a[k] < b[k] ? a[k] < v[k] : v[k] < a[k];
}

// Cuts the region between the chain and the segment from its first to its last vertex, which is to the right
// of both.
void cut(const std::vector<int>& chain, std::span<const Vec<2>> points,
         std::vector<std::array<int, 3>>& triangles) {
    const auto point = [&](int v) { return points[std::size_t(v)]; };
    std::vector<int> open;
    for (const int v : chain) {
        while (open.size() >= 2) {
            const int middle = open.back(), first = open[open.size() - 2];
            if (orient2d(point(first), point(middle), point(v)) >= 0) break;
            triangles.push_back({first, v, middle});
            open.pop_back();
        }
        open.push_back(v);
    }
}

}  // namespace

// The triangle at a in which the segment begins. False if it begins along an edge; then `through` is its
// other end.
bool Triangulation::start_of_segment(const Segment& s, int& triangle, int& through) const {
    const Vec<2>&a = point(s.a), &b = point(s.b);
    const int begin = triangle_of(s.a);
    int t = begin;
    do {
        const int here = t, i = corner_of(t, s.a);
        const int right = at(t).vertex[std::size_t(next(i))], left = at(t).vertex[std::size_t(previous(i))];
        t = neighbour(t, next(i));
        if (right == kInfinite) continue;
        const int turn = orient2d(a, b, point(right));
        if (turn == 0 && is_ahead(a, b, point(right))) {
            through = right;
            return false;
        }
        if (turn < 0 && left != kInfinite && orient2d(a, b, point(left)) > 0) {
            triangle = here;
            return true;
        }
    } while (t != begin);
    return false;
}

void Triangulation::constrain(int t, int i) {
    const int n = neighbour(t, i), j = opposite(t, i);
    at(t).flags = std::uint8_t((at(t).flags | 1 << i) ^ 8 << i);
    at(n).flags = std::uint8_t((at(n).flags | 1 << j) ^ 8 << j);
}

// On conflict, false: `point` is the vertex on the way, or point and other_point are the ends of the segment
// crossed.
bool Triangulation::insert_segment(const Segment& s, Conflict& conflict) {
    if (const Edge e = find_edge(s.a, s.b); e.triangle >= 0) {
        constrain(e.triangle, e.edge);
        return true;
    }
    int t = -1;
    if (!start_of_segment(s, t, conflict.point)) return false;
    const Vec<2>&a = point(s.a), &b = point(s.b);
    int i = corner_of(t, s.a);
    int right = at(t).vertex[std::size_t(next(i))], left = at(t).vertex[std::size_t(previous(i))];
    std::vector<int> cavity{t}, above{s.a, left}, below{s.a, right};
    // A segment crosses a triangle once, so this ends.
    for (;;) {
        if (is_constrained(t, i)) {
            conflict.point = left;
            conflict.other_point = right;
            return false;
        }
        const int j = opposite(t, i);
        t = neighbour(t, i);
        cavity.push_back(t);
        const int v = at(t).vertex[std::size_t(j)];
        if (v == s.b) break;
        const int turn = orient2d(a, b, point(v));
        if (turn == 0) {
            conflict.point = v;
            return false;
        }
        (turn > 0 ? above : below).push_back(v);
        i = corner_of(
            t, turn > 0 ? left : right);  // the way on is across the edge opposite to the end that is left
        (turn > 0 ? left : right) = v;
    }
    above.push_back(s.b);
    below.push_back(s.b);
    std::reverse(below.begin(), below.end());
    std::vector<std::array<int, 3>> triangles;
    cut(above, points_, triangles);
    cut(below, points_, triangles);
    replace_cavity(cavity, triangles);
    const Edge e = find_edge(s.a, s.b);
    constrain(e.triangle, e.edge);
    restore_delaunay_in(std::move(cavity));
    return true;
}

// Puts as many new triangles with the same outline in the place of the triangles of the cavity.
void Triangulation::replace_cavity(const std::vector<int>& cavity,
                                   const std::vector<std::array<int, 3>>& by) {
    // Both sides of every edge, under the ends of the edge; those of old constrained edges inside have no
    // triangle.
    struct Record {
        int low, high, triangle, edge;
        std::uint8_t flags;
    };
    std::vector<Record> records;
    const auto record = [&](int u, int v, int t, int i, std::uint8_t flags) {
        records.push_back({std::min(u, v), std::max(u, v), t, i, flags});
    };
    for (const int t : cavity) at(t).flags |= kMarkFlag;
    for (const int t : cavity)
        for (int i = 0; i < 3; ++i) {
            const auto [n, flags] = side(t, i);
            const bool is_within = at(n).flags & kMarkFlag;
            const int u = at(t).vertex[std::size_t(next(i))], v = at(t).vertex[std::size_t(previous(i))];
            if (!is_within) record(u, v, n, opposite(t, i), flags);
            if (is_within && flags) record(u, v, -1, 0, flags);
        }
    start_change();
    for (std::size_t k = 0; k < by.size(); ++k) {
        at(cavity[k]).flags = 0;
        place(cavity[k], by[k], {{{-1, 0}, {-1, 0}, {-1, 0}}});
        for (int i = 0; i < 3; ++i)
            record(by[k][std::size_t(next(i))], by[k][std::size_t(previous(i))], cavity[k], i, 0);
    }
    sort(records.begin(), records.end(), [](const Record& r, const Record& s) {
        return std::array{r.low, r.high, -r.triangle} < std::array{s.low, s.high, -s.triangle};
    });
    // The two triangles of an edge come first, then what is known of its flags.
    for (std::size_t k = 0; k < records.size();) {
        const Record &r = records[k], &s = records[k + 1];
        std::uint8_t flags = 0;
        for (; k < records.size() && records[k].low == r.low && records[k].high == r.high; ++k)
            flags |= records[k].flags;
        at(r.triangle).neighbour[std::size_t(r.edge)] = s.triangle;
        at(s.triangle).neighbour[std::size_t(s.edge)] = r.triangle;
        at(r.triangle).flags |= std::uint8_t(flags << r.edge);
        at(s.triangle).flags |= std::uint8_t(flags << s.edge);
    }
}

// Flips edges of these triangles, and of those that change thereby, until none has a point in its circle.
void Triangulation::restore_delaunay_in(std::vector<int> todo) {
    while (!todo.empty()) {
        const int t = todo.back();
        todo.pop_back();
        if (is_infinite(t)) continue;
        for (int i = 0; i < 3; ++i) {
            const int n = neighbour(t, i);
            if (is_constrained(t, i) || is_infinite(n) ||
                !is_in_circle(t, at(n).vertex[std::size_t(opposite(t, i))]))
                continue;
            flip(t, i);
            todo.push_back(t);
            todo.push_back(n);
            break;
        }
    }
}

}  // namespace freiform
