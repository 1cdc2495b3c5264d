// Inserting a point: walk to it, split what it is in, flip until Delaunay. See triangulate.cpp for the whole.
//
// Method. Locate: from a triangle, go across an edge that has the point strictly on its other side, trying
// the edges in an order that changes from step to step. In a Delaunay triangulation any such walk ends; among
// constrained edges one of fixed order may go round in circles, hence the changes, and hence the limit on
// steps with an exhaustive search behind it. The changes come from a counter, not from chance: the same walk
// every time.
//
// Flips [Lawson 1977]: only edges opposite to the new vertex v can be wrong, as all other pairs of triangles
// were right before. If v is strictly in the circle of the triangle across such an edge, the two form a
// strictly convex quadrilateral: flip, and look at the two edges that v now faces. Each flip adds an edge at
// v and none is taken away, so there are fewer flips than vertices. With infinite triangles the same holds: v
// is beyond the hull edge, and the flip makes that edge part of a triangle with v.
#include "mesh/corners_detail.hpp"
#include "mesh/insertion_order_detail.hpp"

#include <freiform/mesh/triangulate.hpp>
#include <freiform/poly/predicates.hpp>

namespace freiform {

void Triangulation::start_change() {
    ++now_;
    changed_.clear();
}

void Triangulation::touch(int t) {
    if (at(t).stamp == now_) return;
    at(t).stamp = now_;
    changed_.push_back(t);
}

int Triangulation::append(const Triangle& like) {
    triangles_.push_back(like);
    triangles_.back().stamp = 0;  // less than any change
    return size() - 1;
}

// Gives triangle t these corners and sides; what is inside stays so. Neighbours are not told: see relink.
void Triangulation::place(int t, const std::array<int, 3>& vertices, const std::array<Side, 3>& sides) {
    Triangle& triangle = at(t);
    int flags = triangle.flags & (kInsideFlag | kMarkFlag);
    for (int i = 0; i < 3; ++i) {
        const auto k = std::size_t(i);
        triangle.vertex[k] = vertices[k];
        triangle.neighbour[k] = sides[k].neighbour;
        flags |= sides[k].flags << i;
        if (vertices[k] != kInfinite) vertex_triangle_[std::size_t(vertices[k])] = t;
    }
    triangle.flags = std::uint8_t(flags);
    touch(t);
}

// What is across the edge of t that led to `from`, is now triangle `to`.
void Triangulation::relink(int t, int from, int to) {
    auto& n = at(t).neighbour;
    n[n[0] == from ? 0 : n[1] == from ? 1 : 2] = to;
}

// The corner of the triangle across edge i that is not on the edge, as corner number there.
int Triangulation::opposite(int t, int i) const {
    const int n = neighbour(t, i);
    return next(corner_of(n, at(t).vertex[std::size_t(next(i))]));
}

bool Triangulation::is_in_circle(int t, int v) const {
    const auto& c = at(t).vertex;
    const int i = corner_of(t, kInfinite);
    if (i >= 0)
        return orient2d(point(c[std::size_t(next(i))]), point(c[std::size_t(previous(i))]), point(v)) > 0;
    return in_circle(point(c[0]), point(c[1]), point(c[2]), point(v)) > 0;
}

// --- locate ------------------------------------------------------------------------------------------------

// Is p in the closed finite triangle t?
bool Triangulation::has_inside(int t, const Vec<2>& p, Location& where) const {
    const auto& c = at(t).vertex;
    std::array<int, 3> sign{};
    int zeros = 0;
    for (int i = 0; i < 3; ++i) {
        sign[std::size_t(i)] =
            orient2d(point(c[std::size_t(next(i))]), point(c[std::size_t(previous(i))]), p);
        if (sign[std::size_t(i)] < 0) return false;
        zeros += sign[std::size_t(i)] == 0;
    }
    where = {Location::On::face, t, -1};
    if (zeros == 0) return true;
    where.on = zeros == 1 ? Location::On::edge : Location::On::vertex;
    for (int i = 0; i < 3; ++i)
        if ((sign[std::size_t(i)] == 0) == (zeros == 1)) where.part = i;
    return true;
}

Triangulation::Location Triangulation::locate_by_search(const Vec<2>& p) const {
    Location where;
    for (int t = 0; t < size(); ++t)
        if (!is_infinite(t) && has_inside(t, p, where)) return where;
    for (int t = 0; t < size(); ++t) {
        const int i = corner_of(t, kInfinite);
        if (i < 0) continue;
        const auto& c = at(t).vertex;
        if (orient2d(point(c[std::size_t(next(i))]), point(c[std::size_t(previous(i))]), p) > 0)
            return {Location::On::outside, t, -1};
    }
    return {};
}

Triangulation::Location Triangulation::locate(const Vec<2>& p, int hint) const {
    if (triangles_.empty() || !is_finite(p)) return {};
    int t = hint >= 0 ? hint : last_;
    if (const int i = corner_of(t, kInfinite); i >= 0) t = neighbour(t, i);
    int from = -1;  // where the walk came from: p is not there
    std::uint32_t counter = 0;
    for (std::size_t steps = 0; steps <= triangles_.size(); ++steps) {
        if (is_infinite(t)) return {Location::On::outside, t, -1};
        const auto& c = at(t).vertex;
        counter = counter * 1664525 + 1013904223;
        int i = int((counter >> 16) % 3), onward = -1;
        for (int k = 0; k < 3 && onward < 0; ++k, i = next(i)) {
            const int n = neighbour(t, i);
            if (n != from &&
                orient2d(point(c[std::size_t(next(i))]), point(c[std::size_t(previous(i))]), p) < 0)
                onward = n;
        }
        if (onward < 0) {
            Location where;
            if (has_inside(t, p, where)) return where;
            break;
        }
        from = t;
        t = onward;
    }
    return locate_by_search(p);
}

// --- insert ------------------------------------------------------------------------------------------------

Triangulation::Inserted Triangulation::admit(const Location& where) const {
    if (where.on == Location::On::outside) return {Insert::outside, -1};
    if (where.on == Location::On::vertex)
        return {Insert::duplicate, at(where.triangle).vertex[std::size_t(where.part)]};
    if (where.on == Location::On::edge && is_constrained(where.triangle, where.part))
        return {Insert::on_segment, -1};
    if (!is_inside(where.triangle)) return {Insert::outside, -1};
    if (points_.size() >= std::size_t(kMaxPoints)) return {Insert::full, -1};
    return {Insert::done, -1};
}

int Triangulation::insert_at(const Vec<2>& p, const Location& where) {
    const int v = int(points_.size());
    points_.push_back(p);
    vertex_triangle_.push_back(-1);
    insert_vertex(v, where);
    return v;
}

std::vector<Triangulation::Inserted> Triangulation::insert_all(std::span<const Vec<2>> points) {
    std::vector<Vec<2>> finite;
    std::vector<int> index;
    for (std::size_t i = 0; i < points.size(); ++i)
        if (is_finite(points[i])) {
            finite.push_back(points[i]);
            index.push_back(int(i));
        }
    std::vector<Inserted> result(points.size());
    bool is_first = true;
    for (const int k : detail::insertion_order(finite)) {
        const Vec<2>& p = finite[std::size_t(k)];
        const Location where = locate(p);
        Inserted& r = result[std::size_t(index[std::size_t(k)])] = admit(where);
        if (r.status != Insert::done) {
            if (where.triangle >= 0) last_ = where.triangle;
            continue;
        }
        if (is_first) start_change();
        is_first = false;
        r.vertex = insert_at(p, where);
    }
    return result;
}

void Triangulation::insert_vertex(int v, const Location& where) {
    if (where.on == Location::On::edge)
        split_edge(where.triangle, where.part, v);
    else
        split_face(where.triangle, v);
    last_ = where.triangle;
    restore_delaunay(v);
}

// (a, b, c) becomes (a, b, v), (b, c, v), (c, a, v). One of a, b, c may be infinite, if v is beyond the hull
// edge.
void Triangulation::split_face(int t, int v) {
    const auto [a, b, c] = at(t).vertex;
    const Side sa = side(t, 0), sb = side(t, 1), sc = side(t, 2);
    const int bc = append(at(t)), ca = append(at(t));
    place(t, {a, b, v}, {{{bc, 0}, {ca, 0}, sc}});
    place(bc, {b, c, v}, {{{ca, 0}, {t, 0}, sa}});
    place(ca, {c, a, v}, {{{t, 0}, {bc, 0}, sb}});
    relink(sa.neighbour, t, bc);
    relink(sb.neighbour, t, ca);
    stack_.assign({t, bc, ca});
}

// The edge ab between (c, a, b) and (d, b, a) gets the vertex v.
void Triangulation::split_edge(int t, int i, int v) {
    const int n = neighbour(t, i), j = opposite(t, i);
    const auto corner = [&](int triangle, int k) { return at(triangle).vertex[std::size_t(k)]; };
    const int c = corner(t, i), a = corner(t, next(i)), b = corner(t, previous(i)), d = corner(n, j);
    const Side bc = side(t, next(i)), ca = side(t, previous(i)), ad = side(n, next(j)),
               db = side(n, previous(j));
    const int tb = append(at(t)), na = append(at(n));
    place(t, {c, a, v}, {{{na, 0}, {tb, 0}, ca}});
    place(tb, {c, v, b}, {{{n, 0}, bc, {t, 0}}});
    place(n, {d, b, v}, {{{tb, 0}, {na, 0}, db}});
    place(na, {d, v, a}, {{{t, 0}, ad, {n, 0}}});
    relink(bc.neighbour, t, tb);
    relink(ad.neighbour, n, na);
    stack_.assign({t, tb, n, na});
}

// The edge ab between (v, a, b) and (d, b, a) becomes the edge vd: (v, a, d) and (v, d, b).
void Triangulation::flip(int t, int i) {
    const int n = neighbour(t, i), j = opposite(t, i);
    const auto corner = [&](int triangle, int k) { return at(triangle).vertex[std::size_t(k)]; };
    const int v = corner(t, i), a = corner(t, next(i)), b = corner(t, previous(i)), d = corner(n, j);
    const Side bv = side(t, next(i)), va = side(t, previous(i)), ad = side(n, next(j)),
               db = side(n, previous(j));
    place(t, {v, a, d}, {{ad, {n, 0}, va}});
    place(n, {v, d, b}, {{db, bv, {t, 0}}});
    relink(ad.neighbour, n, t);
    relink(bv.neighbour, t, n);
}

// The triangles at the new vertex v are on the stack.
void Triangulation::restore_delaunay(int v) {
    while (!stack_.empty()) {
        const int t = stack_.back(), i = corner_of(t, v);
        stack_.pop_back();
        if (is_constrained(t, i) || !is_in_circle(neighbour(t, i), v)) continue;
        stack_.push_back(t);
        stack_.push_back(neighbour(t, i));
        flip(t, i);
    }
}

}  // namespace freiform
