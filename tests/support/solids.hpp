// Closed models with known shape, made by hand: seams, poles, shared edges.
#pragma once
#include <freiform/mesh/triangle_tree.hpp>
#include <freiform/model/assemble.hpp>
#include <freiform/model/tessellate.hpp>

#include <gtest/gtest.h>
#include <numbers>

namespace freiform::test {

inline constexpr double kPi = std::numbers::pi;

inline CurveGeometry<2> segment(Interval on, Vec<2> from, Vec<2> to) {
    const Vec<2> d = (1 / on.length()) * (to - from);
    return Line<2>{from - on.lo * d, d};
}

inline Model in_one_body(Model m) {
    Shell shell;
    for (std::size_t f = 0; f < m.faces.size(); ++f) shell.faces.push_back({int(f), false});
    shell.closed = true;
    m.shells = {shell};
    m.bodies = {{{0}, true, "", {}}};
    return *make_model(std::move(m));
}

// Of a model without gaps, all of which is there.
inline Tessellation closed_tessellation(const Model& model, double tolerance, double gap = 1e-12) {
    EXPECT_TRUE(make_model(model));
    EXPECT_EQ(summary(model).open_edges, 0);
    auto t = tessellate(model, {.tolerance = tolerance});
    EXPECT_TRUE(t);
    if (!t) return {};
    EXPECT_TRUE(t->refused.empty());
    EXPECT_EQ(t->topology.open_edges, 0);
    EXPECT_EQ(t->topology.non_manifold_edges, 0);
    EXPECT_EQ(t->topology.misoriented_edges, 0);
    EXPECT_LT(t->error_bound, tolerance);
    EXPECT_LE(t->boundary_gap, gap);
    return *std::move(t);
}

// One face, a seam at u = 0 and a pole at either end.
inline Model sphere(Vec<3> centre, double r) {
    Model m;
    const Conic<3> meridian{ConicKind::ellipse, centre, {{r, 0, 0}}, {{0, 0, r}}};
    const Interval v{-kPi / 2, kPi / 2}, u{0, 2 * kPi};
    m.vertices = {{centre - Vec<3>{{0, 0, r}}, 0}, {centre + Vec<3>{{0, 0, r}}, 0}};
    m.edges = {{meridian, false, v, 0, 1, 0, "seam"},
               {{}, true, u, 0, 0, 0, "south"},
               {{}, true, u, 1, 1, 0, "north"}};
    Face f;
    f.surface = Revolution{meridian, centre, {{0, 0, 1}}, SurfaceKind::sphere};
    f.loops = {{{{1, false, segment(u, {{u.lo, v.lo}}, {{u.hi, v.lo}})},
                 {0, false, segment(v, {{u.hi, v.lo}}, {{u.hi, v.hi}})},
                 {2, true, segment(u, {{u.lo, v.hi}}, {{u.hi, v.hi}})},
                 {0, true, segment(v, {{u.lo, v.lo}}, {{u.lo, v.hi}})}}}};
    m.faces = {f};
    return in_one_body(std::move(m));
}

// One face, a seam in each direction.
inline Model torus(double R, double r) {
    Model m;
    const Conic<3> tube{ConicKind::ellipse, {{R, 0, 0}}, {{r, 0, 0}}, {{0, 0, r}}};
    const Conic<3> rim{ConicKind::ellipse, {}, {{R + r, 0, 0}}, {{0, R + r, 0}}};
    const Interval on{0, 2 * kPi};
    m.vertices = {{{{R + r, 0, 0}}, 0}};
    m.edges = {{rim, false, on, 0, 0, 0, ""}, {tube, false, on, 0, 0, 0, ""}};
    Face f;
    f.surface = Revolution{tube, {}, {{0, 0, 1}}, SurfaceKind::torus};
    const double T = on.hi;
    f.loops = {{{{0, false, segment(on, {{0, 0}}, {{T, 0}})},
                 {1, false, segment(on, {{T, 0}}, {{T, T}})},
                 {0, true, segment(on, {{0, T}}, {{T, T}})},
                 {1, true, segment(on, {{0, 0}}, {{0, T}})}}}};
    m.faces = {f};
    return in_one_body(std::move(m));
}

// A side with a seam between two discs; r1 = 0 gives a cone with a pole at its apex.
inline Model frustum(double r0, double r1, double h) {
    Model m;
    const Interval u{0, 2 * kPi}, v{0, 1};
    const Vec<3> slope{{r1 - r0, 0, h}};
    const Line<3> side{{{r0, 0, 0}}, slope};
    const auto circle = [&](double r, double z) {
        return Conic<3>{ConicKind::ellipse, {{0, 0, z}}, {{r, 0, 0}}, {{0, r, 0}}};
    };
    m.vertices = {{{{r0, 0, 0}}, 0}, {{{r1, 0, h}}, 0}};
    m.edges = {
        {side, false, v, 0, 1, 0, ""}, {circle(r0, 0), false, u, 0, 0, 0, ""}, {{}, true, u, 1, 1, 0, ""}};
    if (r1 > 0) m.edges[2] = {circle(r1, h), false, u, 1, 1, 0, ""};
    Face wall;
    wall.surface = Revolution{side, {}, {{0, 0, 1}}, SurfaceKind::cone};
    wall.loops = {{{{1, false, segment(u, {{0, 0}}, {{u.hi, 0}})},
                    {0, false, segment(v, {{u.hi, 0}}, {{u.hi, 1}})},
                    {2, true, segment(u, {{0, 1}}, {{u.hi, 1}})},
                    {0, true, segment(v, {{0, 0}}, {{0, 1}})}}}};
    m.faces = {wall};
    for (int top = 0; top < 2; ++top) {
        const double r = top ? r1 : r0;
        if (r == 0) continue;
        Face disc;
        disc.surface = Extrusion{Line<3>{{{0, 0, top * h}}, {{1, 0, 0}}}, {{0, 1, 0}}, SurfaceKind::plane};
        disc.reversed = !top;
        disc.loops = {{{{1 + top, false, Conic<2>{ConicKind::ellipse, {}, {{r, 0}}, {{0, r}}}}}}};
        m.faces.push_back(disc);
    }
    return in_one_body(std::move(m));
}

inline double signed_volume(const TriangleMesh& mesh) {
    double v = 0;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const auto p = mesh.points_of(i);
        v += dot(mesh.points[std::size_t(p[0])],
                 cross(mesh.points[std::size_t(p[1])], mesh.points[std::size_t(p[2])])) /
             6;
    }
    return v;
}

// Distance of a point from a triangle, by the regions of the closest feature.
inline double distance_to_triangle(const Vec<3>& p, const Vec<3>& a, const Vec<3>& b, const Vec<3>& c) {
    const auto to_segment = [&](const Vec<3>& s, const Vec<3>& e) {
        const Vec<3> d = e - s;
        const double t = dot(d, d) > 0 ? std::clamp(dot(p - s, d) / dot(d, d), 0.0, 1.0) : 0;
        return norm(p - (s + t * d));
    };
    // From the shortest side: of two long ones of a needle the cross product has no digits.
    const double ab = norm(b - a), bc = norm(c - b), ca = norm(a - c);
    const Vec<3> n = ca >= std::max(ab, bc)   ? cross(b - a, c - b)
                     : ab >= std::max(bc, ca) ? cross(c - b, a - c)
                                              : cross(a - c, b - a);
    double best = std::min({to_segment(a, b), to_segment(b, c), to_segment(c, a)});
    if (max_abs(n) == 0) return best;
    const bool over = dot(cross(b - a, p - a), n) >= 0 && dot(cross(c - b, p - b), n) >= 0 &&
                      dot(cross(a - c, p - c), n) >= 0;
    return over ? std::min(best, std::abs(dot(p - a, unit(n)))) : best;
}

// The largest distance between points of the surfaces and the triangle that stands for them, at `k` (k + 1) /
// 2 parameters inside each triangle; triangles that collapsed at poles are not sampled.
inline double sampled_deviation(const Model& model, const Tessellation& t, int k = 5) {
    std::vector<Triangle3> all;
    for (std::size_t i = 0; i < t.mesh.triangles.size(); ++i) {
        const auto p = t.mesh.points_of(i);
        const auto at = [&](std::size_t c) { return t.mesh.points[std::size_t(p[c])]; };
        all.push_back({at(0), at(1), at(2)});
    }
    const TriangleTree tree(all);
    double most = 0;
    for (const MeshPart& part : t.mesh.parts) {
        const SurfaceGeometry& surface = model.faces[std::size_t(part.face)].surface;
        for (int i = part.first; i < part.first + part.count; ++i) {
            const auto& tri = t.mesh.triangles[std::size_t(i)];
            const auto& own = all[std::size_t(i)];
            const auto uv = [&](int c) { return t.mesh.vertices[std::size_t(tri[std::size_t(c)])].uv; };
            for (int x = 0; x < k; ++x)
                for (int y = 0; x + y < k; ++y) {
                    const double s = (x + 1.0 / 3) / k, r = (y + 1.0 / 3) / k;
                    const Vec<2> at = (1 - s - r) * uv(0) + s * uv(1) + r * uv(2);
                    const Vec<3> p = jet<0>(surface, at.c).value();
                    const double from_own = distance_to_triangle(p, own[0], own[1], own[2]);
                    if (!(from_own > most)) continue;
                    const auto found = tree.nearest(p);  // another one may be nearer
                    if (!(found.distance > most)) continue;
                    most = std::max(most, std::min(from_own, found.distance));
                }
        }
    }
    return most;
}

}  // namespace freiform::test
