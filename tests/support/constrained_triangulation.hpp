// Regions of many shapes, and what holds for any constrained Delaunay triangulation of one.
#pragma once
#include <freiform/core/constants.hpp>
#include <freiform/mesh/triangulate.hpp>
#include <freiform/poly/predicates.hpp>

#include <algorithm>
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>
#include <random>
#include <set>

namespace freiform::test {

using Rational = boost::multiprecision::cpp_rational;
using Segment = Triangulation::Segment;
using Points = std::vector<Vec<2>>;
using Segments = std::vector<Segment>;

struct Region {
    Points points;
    Segments segments;

    void add_loop(const Points& loop) {
        const int first = int(points.size()), n = int(loop.size());
        points.insert(points.end(), loop.begin(), loop.end());
        for (int i = 0; i < n; ++i) segments.push_back({first + i, first + (i + 1) % n});
    }
};

// Whole numbers divisible by 3, so that triangles have exact centres.
inline Vec<2> on_lattice(double x, double y) { return {{3 * std::round(x), 3 * std::round(y)}}; }

inline Points ring(std::mt19937& random, double cx, double cy, double r, int n, double roughness) {
    std::uniform_real_distribution<double> radius(1 - roughness, 1);
    Points p;
    for (int i = 0; i < n; ++i) {
        const double a = 2 * std::numbers::pi * i / n, q = r * radius(random);
        p.push_back(on_lattice(cx + q * std::cos(a), cy + q * std::sin(a)));
    }
    return p;
}

inline Points comb(int teeth, double height) {
    Points p;
    for (int i = 0; i < teeth; ++i) {
        p.push_back({{6.0 * i, i == 0 ? -30 : 0.0}});
        p.push_back({{6.0 * i + 3, height}});
    }
    p.push_back({{6.0 * teeth, -30}});
    return p;
}

inline Points spiral(int n, double width) {
    Points p;
    for (const bool back : {false, true})
        for (int k = 0; k < n; ++k) {
            const int i = back ? n - 1 - k : k;
            const double a = 0.1 * i, r = 50 * width + width * a / 8 + (back ? width / 3 : 0);
            p.push_back(on_lattice(r * std::cos(a), r * std::sin(a)));
        }
    return p;
}

inline Region nested_rings(std::mt19937& random) {
    Region r;
    r.add_loop(ring(random, 0, 0, 100000, 97, 0.1));
    Points hole = ring(random, 30000, 0, 50000, 40, 0.4);
    std::reverse(hole.begin(), hole.end());
    r.add_loop(hole);
    r.add_loop(ring(random, 30000, 0, 25000, 33, 0.3));
    r.add_loop(ring(random, 30000, 0, 12000, 21, 0.3));
    r.add_loop(ring(random, -50000, 0, 20000, 25, 0.5));
    r.add_loop(ring(random, 500000, 0, 20000, 25, 0.5));
    return r;
}

// Odd-even rule by a ray to the right, in exact predicates. REQUIRES: p on no segment.
inline bool is_in_region(const Region& r, const Vec<2>& p) {
    bool inside = false;
    for (const auto [i, j] : r.segments) {
        const Vec<2>&a = r.points[std::size_t(i)], &b = r.points[std::size_t(j)];
        if ((a[1] > p[1]) == (b[1] > p[1])) continue;
        if (orient2d(a[1] < b[1] ? a : b, a[1] < b[1] ? b : a, p) > 0) inside = !inside;
    }
    return inside;
}

inline Rational doubled_area(const Vec<2>& a, const Vec<2>& b, const Vec<2>& c) {
    const Rational ax(a[0]), ay(a[1]), bx(b[0]), by(b[1]), cx(c[0]), cy(c[1]);
    return (ax - cx) * (by - cy) - (ay - cy) * (bx - cx);
}

inline Rational inside_area(const Triangulation& t) {
    Rational sum = 0;
    for (int i = 0; i < t.size(); ++i) {
        if (!t.is_inside(i)) continue;
        const auto& v = t.vertices(i);
        sum += doubled_area(t.points()[std::size_t(v[0])], t.points()[std::size_t(v[1])],
                            t.points()[std::size_t(v[2])]);
    }
    return sum;
}

// Every invariant that holds for any triangulation with at least one triangle.
inline void check_structure(const Triangulation& t, const Segments& segments) {
    ASSERT_EQ(t.size(), 2 * int(t.points().size()) - 2);  // Euler, with the vertex at infinity
    std::set<std::pair<int, int>> wanted, constrained;
    for (const auto [a, b] : segments) wanted.insert(std::minmax(a, b));
    for (int i = 0; i < t.size(); ++i) {
        const auto v = t.vertices(i);
        const auto point = [&](int k) { return t.points()[std::size_t(v[std::size_t(k)])]; };
        if (t.is_infinite(i))
            ASSERT_FALSE(t.is_inside(i));
        else
            ASSERT_GT(orient2d(point(0), point(1), point(2)), 0);
        for (int k = 0; k < 3; ++k) {
            const int n = t.neighbour(i, k), a = v[std::size_t((k + 1) % 3)], b = v[std::size_t((k + 2) % 3)];
            const int j = 3 - t.corner_of(n, a) - t.corner_of(n, b);
            ASSERT_EQ(t.vertices(n)[std::size_t((j + 1) % 3)], b);
            ASSERT_EQ(t.vertices(n)[std::size_t((j + 2) % 3)], a);
            ASSERT_EQ(t.neighbour(n, j), i);
            ASSERT_EQ(t.is_constrained(n, j), t.is_constrained(i, k));
            if (t.is_constrained(i, k)) {
                constrained.insert(std::minmax(a, b));
                continue;
            }
            ASSERT_EQ(t.is_inside(i), t.is_inside(n));
            const int q = t.vertices(n)[std::size_t(j)];
            if (t.is_infinite(i) || t.is_infinite(n)) continue;
            ASSERT_LE(in_circle(point(0), point(1), point(2), t.points()[std::size_t(q)]), 0)
                << "triangle " << i;
        }
    }
    ASSERT_EQ(wanted, constrained);
    for (int v = 0; v < int(t.points().size()); ++v) ASSERT_GE(t.corner_of(t.triangle_of(v), v), 0);
}

// The definition: a vertex in the circle of a triangle is hidden from its inside by a segment. And the
// odd-even rule.
inline void check_by_definition(const Triangulation& t, const Region& r) {
    for (int i = 0; i < t.size(); ++i) {
        if (t.is_infinite(i)) continue;
        const auto& v = t.vertices(i);
        const Vec<2> a = t.points()[std::size_t(v[0])], b = t.points()[std::size_t(v[1])],
                     c = t.points()[std::size_t(v[2])];
        const Vec<2> centre{{(a[0] + b[0] + c[0]) / 3, (a[1] + b[1] + c[1]) / 3}};  // exact: see on_lattice
        ASSERT_EQ(t.is_inside(i), is_in_region(r, centre)) << "triangle " << i;
        for (const Vec<2>& p : t.points()) {
            if (in_circle(a, b, c, p) <= 0) continue;
            const bool is_hidden = std::any_of(r.segments.begin(), r.segments.end(), [&](const Segment& s) {
                const Vec<2>&e = t.points()[std::size_t(s.a)], &f = t.points()[std::size_t(s.b)];
                return segments_cross(centre, p, e, f) || is_between(centre, p, e) ||
                       is_between(centre, p, f);
            });
            ASSERT_TRUE(is_hidden) << "triangle " << i;
        }
    }
}

inline Triangulation make(const Region& r) {
    auto t = Triangulation::make(r.points, r.segments);
    if (!t) ADD_FAILURE() << t.error().where << ": " << t.error().message;
    return std::move(t.value());
}

inline Region region_number(int k, std::mt19937& random) {
    Region r;
    if (k % 4 == 0) r.add_loop(ring(random, 0, 0, 1e6, 5 + k * 7, 0.95));
    if (k % 4 == 1) r.add_loop(comb(3 + 3 * k, 30 + 90 * k));
    if (k % 4 == 2) r.add_loop(spiral(50 + 30 * k, 600));
    if (k % 4 == 3) r = nested_rings(random);
    return r;
}

}  // namespace freiform::test
