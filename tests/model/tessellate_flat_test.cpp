// Splines that lie in a plane, meshed as planes.
#include "support/random.hpp"
#include "support/solids.hpp"

#include <freiform/model/tessellate.hpp>

#include <gtest/gtest.h>

using namespace freiform;
using namespace freiform::test;

namespace {

using SplineSurface = ModelBuilder::SplineSurface;

// A disc about `middle` in the plane z = middle[2], as one rational biquadratic patch whose four corners lie
// on the circle, where it has no normal.
Surface<Hom<3>> disc(const Vec<3>& middle, double radius) {
    const double h = std::sqrt(0.5);
    const double at[3][3][3] = {{{-h, -h, 1}, {-2 * h, 0, h}, {-h, h, 1}},
                                {{0, -2 * h, h}, {0, 0, 1}, {0, 2 * h, h}},
                                {{h, -h, 1}, {2 * h, 0, h}, {h, h, 1}}};
    std::vector<Hom<3>> p;
    for (const auto& row : at)
        for (const auto& [x, y, w] : row)
            p.push_back(weighted(middle + Vec<3>{{radius * x, radius * y, 0}}, w));
    const auto basis = *BSplineBasis::bezier(2);
    return *Surface<Hom<3>>::make({basis, basis}, Net<2, Hom<3>>({3, 3}, p));
}

Model of(const SplineSurface& s) {
    ModelBuilder builder;
    EXPECT_TRUE(builder.add(s));
    return must(std::move(builder).finish());
}

Tessellation meshed(const Model& m, double tolerance) {
    return must(tessellate(m, {.tolerance = tolerance, .as_planes = true}));
}

// (u, v) -> (u, v + bend u^2, 0) over the unit square, whose inverse takes curves of degree 2 to degree 4.
Surface<Vec<3>> sheared(double bend) {
    std::vector<Vec<3>> p;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 2; ++j) p.push_back({{i / 2.0, j + (i == 2 ? bend : 0.0), 0}});
    return *Surface<Vec<3>>::make({*BSplineBasis::bezier(2), *BSplineBasis::bezier(1)},
                                  Net<2, Vec<3>>({3, 2}, p));
}

// (x, y) of degree 2 to (x, y - bend x^2).
CurveGeometry<2> unsheared(const std::array<Vec<2>, 3>& b, double bend) {
    // x^2 with x = b_0 .. b_2, and y raised to degree 4.
    const auto x = [&](int i) { return b[std::size_t(i)][0]; };
    const auto y = [&](int i) { return b[std::size_t(i)][1]; };
    const double square[5] = {x(0) * x(0), x(0) * x(1), (2 * x(1) * x(1) + x(0) * x(2)) / 3, x(1) * x(2),
                              x(2) * x(2)};
    const auto raised = [](auto&& c) {
        return std::array{c(0), (c(0) + c(1)) / 2, (c(0) + 4 * c(1) + c(2)) / 6, (c(1) + c(2)) / 2, c(2)};
    };
    std::vector<Vec<2>> p;
    for (std::size_t i = 0; i < 5; ++i) p.push_back({{raised(x)[i], raised(y)[i] - bend * square[i]}});
    return Curve<Vec<2>>::trusted({*BSplineBasis::bezier(4)}, Net<1, Vec<2>>({5}, std::move(p)));
}

// The sheared square of this bend, of which straight lines in space cut a smaller square with a hole.
Model plate(double bend) {
    Model m;
    Face face;
    face.surface = sheared(bend);
    const auto loop = [&](const std::vector<Vec<2>>& corners) {
        const int n = int(corners.size()), first = int(m.vertices.size());
        Loop l;
        for (int k = 0; k < n; ++k) {
            const Vec<2> a = corners[std::size_t(k)], b = corners[std::size_t((k + 1) % n)];
            m.vertices.push_back({{{a[0], a[1], 0}}, 0});
            Edge e;
            e.start = first + k, e.end = first + (k + 1) % n, e.range = {0, 1};
            e.curve = Line<3>{{{a[0], a[1], 0}}, {{b[0] - a[0], b[1] - a[1], 0}}};
            l.coedges.push_back({int(m.edges.size()), false, unsheared({a, 0.5 * (a + b), b}, bend)});
            m.edges.push_back(e);
        }
        face.loops.push_back(l);
    };
    loop({{{0.1, 0.6}}, {{0.9, 0.6}}, {{0.9, 1.3}}, {{0.1, 0.9}}});
    loop({{{0.3, 0.7}}, {{0.4, 0.7}}, {{0.4, 0.8}}, {{0.3, 0.8}}});
    m.faces.push_back(face);
    return in_one_body(std::move(m));
}

// Corners are where their parameters are, and normals point up.
void expect_places(const Model& m, const Tessellation& t, double within) {
    for (const MeshVertex& v : t.mesh.vertices) {
        const Vec<3> there = jet<0>(m.faces[0].surface, v.uv.c).value();
        EXPECT_LE(norm(there - t.mesh.points[std::size_t(v.point)]), within);
        EXPECT_NEAR(v.normal[2], 1, 1e-12);
    }
}

double area(const TriangleMesh& mesh) {
    double sum = 0;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const auto [a, b, c] = mesh.points_of(i);
        const auto at = [&](int k) { return mesh.points[std::size_t(k)]; };
        sum += cross(at(b) - at(a), at(c) - at(a))[2] / 2;
    }
    return sum;
}

TEST(FlatFaces, a_disc_takes_two_triangles_less_than_its_circle_takes_chords) {
    for (const double scale : {1.0, 1e-4, 1e6})
        for (const double far : {0.0, 1e3}) {
            const Model m = of(disc({{far * scale, -far * scale, 3 * scale}}, 10 * scale));
            for (const double tolerance : {2e-2, 2e-3, 2e-4}) {
                const Tessellation t = meshed(m, tolerance * scale);
                ASSERT_TRUE(t.refused.empty());
                EXPECT_LE(t.error_bound, tolerance * scale);
                EXPECT_EQ(int(t.mesh.triangles.size()), int(t.mesh.points.size()) - 2);
                EXPECT_EQ(t.topology.open_edges, int(t.mesh.points.size()));
                const double chords = std::numbers::pi / std::acos(1 - tolerance / 10);
                EXPECT_LE(double(t.mesh.points.size()), 1.25 * chords + 4) << scale << " " << far;
                expect_places(m, t, 1e-12 * scale * (1 + far));
                // What is missing of the disc is within the tolerance of its circle.
                const double whole = std::numbers::pi * 100 * scale * scale;
                EXPECT_LE(area(t.mesh), whole * (1 + 1e-9));
                EXPECT_GE(area(t.mesh), whole - 20 * std::numbers::pi * scale * t.error_bound);
            }
        }
}

TEST(FlatFaces, straight_edges_take_few_points_whatever_parameter_lines_do) {
    const Model m = plate(0.5);
    const Tessellation t = meshed(m, 1e-3);
    ASSERT_TRUE(t.refused.empty());
    EXPECT_LE(t.mesh.triangles.size(), 24u);
    EXPECT_LE(t.error_bound, 1e-4);
    EXPECT_LE(t.boundary_gap, 1e-14);
    EXPECT_NEAR(area(t.mesh), 0.8 * (0.3 + 0.7) / 2 - 0.01, 1e-12);
    EXPECT_EQ(t.topology.non_manifold_edges, 0);
    expect_places(m, t, 1e-14);
    const auto as_given = must(tessellate(m, {.tolerance = 1e-3}));
    EXPECT_GE(as_given.mesh.triangles.size(), 3 * t.mesh.triangles.size());
    // What asks for triangles inside has them in the parameter plane.
    const auto quads = must(tessellate(m, {.tolerance = 1e-3, .quads = true, .as_planes = true}));
    EXPECT_EQ(quads.mesh.triangles, must(tessellate(m, {.tolerance = 1e-3, .quads = true})).mesh.triangles);
}

TEST(FlatFaces, folds_are_seen_and_meshed_as_they_are_given) {
    // Pushed over the side x = 1 from inside: the boundary is that of the unit square.
    std::vector<Vec<3>> p;
    for (int i = 0; i < 5; ++i)
        for (int j = 0; j < 5; ++j) p.push_back({{i / 4.0 + (i == 3 && j == 2 ? 4.0 : 0.0), j / 4.0, 0}});
    const auto basis = *BSplineBasis::bezier(4);
    const Model m = of(*Surface<Vec<3>>::make({basis, basis}, Net<2, Vec<3>>({5, 5}, p)));
    const Tessellation t = meshed(m, 1e-3);
    ASSERT_TRUE(t.refused.empty());
    EXPECT_LE(sampled_deviation(m, t), t.error_bound);
    double most = 0;
    for (const Vec<3>& q : t.mesh.points) most = std::max(most, q[0]);
    EXPECT_GT(most, 1.2);
}

// A ring that goes round one and a half times, of which a face has two pieces, one above the other.
TEST(FlatFaces, pieces_above_each_other_are_both_there) {
    constexpr int kQuarters = 6;
    std::vector<double> knots{0, 0, 0};
    for (int k = 1; k <= kQuarters; ++k) knots.insert(knots.end(), 2, k);
    knots.push_back(kQuarters);
    std::vector<Hom<3>> p;
    for (int k = 0; k <= 2 * kQuarters; ++k)
        for (const double r : {1.0, 2.0}) {
            const double w = k % 2 ? std::sqrt(0.5) : 1, at = k * kPi / 4;
            p.push_back(weighted(Vec<3>{{r / w * std::cos(at), r / w * std::sin(at), 0}}, w));
        }
    const auto ring = *Surface<Hom<3>>::make({*BSplineBasis::make(2, knots), *BSplineBasis::bezier(1)},
                                             Net<2, Hom<3>>({2 * kQuarters + 1, 2}, p));
    const auto rectangle = [](Interval u, Interval v) {
        const std::array<Vec<2>, 4> at{{{{u.lo, v.lo}}, {{u.hi, v.lo}}, {{u.hi, v.hi}}, {{u.lo, v.hi}}}};
        std::vector<CurveGeometry<2>> out;
        for (std::size_t k = 0; k < 4; ++k)
            out.push_back(Curve<Vec<2>>::trusted({*BSplineBasis::bezier(1)},
                                                 Net<1, Vec<2>>({2}, {at[k], at[(k + 1) % 4]})));
        return out;
    };
    ModelBuilder builder;
    ASSERT_TRUE(builder.add_trimmed(
        SplineSurface(ring),
        std::vector{rectangle({0.2, 1.8}, {0.1, 0.9}), rectangle({4.5, 5.0}, {0.4, 0.6})}, ""));
    const Model m = must(std::move(builder).finish());
    const Tessellation t = meshed(m, 1e-3), as_given = must(tessellate(m, {.tolerance = 1e-3}));
    ASSERT_TRUE(t.refused.empty());
    EXPECT_NEAR(area(t.mesh), area(as_given.mesh), 0.01);
    EXPECT_LT(area(t.mesh), -3);  // S_u x S_v looks down
}

TEST(FlatFaces, what_is_torn_in_its_plane_is_refused) {
    // A square with a slit that does not reach its sides.
    std::vector<Vec<3>> p;
    for (int i = 0; i < 6; ++i)
        for (int j = 0; j < 3; ++j)
            p.push_back({{(i < 3 ? i : i - 1) / 4.0 + (i == 3 && j == 1 ? 0.1 : 0), j / 2.0, 0}});
    const auto torn = *BSplineBasis::make(2, {0, 0, 0, 0.5, 0.5, 0.5, 1, 1, 1});
    Model m;
    Face face;
    face.surface = *Surface<Vec<3>>::make({torn, *BSplineBasis::bezier(2)}, Net<2, Vec<3>>({6, 3}, p));
    Loop loop;
    const std::array<Vec<2>, 4> corners{{{{0, 0}}, {{1, 0}}, {{1, 1}}, {{0, 1}}}};
    for (int k = 0; k < 4; ++k) {
        m.vertices.push_back({{{corners[std::size_t(k)][0], corners[std::size_t(k)][1], 0}}, 0});
        Edge e;
        e.start = k, e.end = (k + 1) % 4, e.range = {0, 1};
        const Vec<2> a = corners[std::size_t(k)], b = corners[std::size_t((k + 1) % 4)];
        e.curve = Line<3>{{{a[0], a[1], 0}}, {{b[0] - a[0], b[1] - a[1], 0}}};
        m.edges.push_back(e);
        loop.coedges.push_back({k, false, segment({0, 1}, a, b)});
    }
    face.loops.push_back(loop);
    m.faces.push_back(face);
    const Tessellation t = meshed(in_one_body(std::move(m)), 1);
    ASSERT_EQ(t.refused.size(), 1u);
    EXPECT_NE(t.refused[0].reason.message.find("torn"), std::string::npos) << t.refused[0].reason.message;
}

TEST(FlatFaces, what_is_nearly_flat_counts_against_the_tolerance_or_is_not_flat) {
    for (const double off : {1e-6, 5e-6, 1e-4, 1e-2}) {
        Surface<Hom<3>> s = disc({}, 10);
        std::vector<Hom<3>> p(s.net().flat().begin(), s.net().flat().end());
        p[4][2] = off;  // weight 1
        s = *Surface<Hom<3>>::make(s.bases(), Net<2, Hom<3>>({3, 3}, p));
        const Model m = of(s);
        const Tessellation t = meshed(m, 1e-3);
        EXPECT_LE(t.error_bound, 1e-3);
        const bool is_flat = t.mesh.triangles.size() + 2 == t.mesh.points.size();
        EXPECT_EQ(is_flat, off < 1e-5) << off;
        for (int i = 0; i <= 10; ++i)
            for (int j = 0; j <= 10; ++j) {
                const Vec<3> q = jet<0>(m.faces[0].surface, {i / 10.0, j / 10.0}).value();
                double least = kInfinity;
                for (std::size_t k = 0; k < t.mesh.triangles.size(); ++k) {
                    const auto [a, b, c] = t.mesh.points_of(k);
                    least = std::min(least, distance_to_triangle(q, t.mesh.points[std::size_t(a)],
                                                                 t.mesh.points[std::size_t(b)],
                                                                 t.mesh.points[std::size_t(c)]));
                }
                EXPECT_LE(least, t.error_bound);
            }
    }
}

// Of two tolerances in one run each is what it is alone, though the first is so large that all is flat.
TEST(FlatFaces, several_tolerances_are_as_each_alone) {
    Surface<Hom<3>> s = disc({}, 10);
    std::vector<Hom<3>> p(s.net().flat().begin(), s.net().flat().end());
    p[4][2] = 1e-4;
    const Model m = of(*Surface<Hom<3>>::make(s.bases(), Net<2, Hom<3>>({3, 3}, p)));
    const std::vector<TessellateOptions> both{{.tolerance = 0.1, .as_planes = true},
                                              {.tolerance = 1e-4, .as_planes = true}};
    const auto all = tessellate(m, both);
    for (std::size_t i = 0; i < 2; ++i) {
        const auto alone = must(tessellate(m, both[i]));
        EXPECT_EQ(must(all[i]).mesh.points, alone.mesh.points);
        EXPECT_EQ(must(all[i]).mesh.triangles, alone.mesh.triangles);
    }
    EXPECT_EQ(all[0]->mesh.triangles.size() + 2, all[0]->mesh.points.size());
    EXPECT_GT(all[1]->mesh.triangles.size() + 2, all[1]->mesh.points.size());
}

// Walls over the sides of discs: what they share is closed, and one disc is a copy of the other.
TEST(FlatFaces, discs_close_drums) {
    const auto raised = [](Hom<3> h) {
        h[2] += 5 * h.weight();
        return h;
    };
    const Surface<Hom<3>> below = disc({}, 10);
    std::vector<Hom<3>> p;
    for (const Hom<3>& h : below.net().flat()) p.push_back(raised(h));
    ModelBuilder builder;
    ASSERT_TRUE(builder.add(SplineSurface(below)));
    ASSERT_TRUE(builder.add(SplineSurface(*Surface<Hom<3>>::make(below.bases(), Net<2, Hom<3>>({3, 3}, p)))));
    for (int axis = 0; axis < 2; ++axis)
        for (int which = 0; which < 2; ++which) {
            const auto side = boundary(below, axis, which);
            std::vector<Hom<3>> q;
            for (const Hom<3>& h : side.net().flat()) q.push_back(h), q.push_back(raised(h));
            ASSERT_TRUE(builder.add(SplineSurface(*Surface<Hom<3>>::make(
                {side.basis(), *BSplineBasis::bezier(1)}, Net<2, Hom<3>>({3, 2}, q)))));
        }
    const Model m = must(std::move(builder).finish());
    const Tessellation t = meshed(m, 1e-2);
    ASSERT_TRUE(t.refused.empty());
    EXPECT_EQ(t.topology.open_edges, 0);
    EXPECT_EQ(t.topology.non_manifold_edges, 0);
    EXPECT_LE(t.error_bound, 1e-2);
    const int rim = int(t.mesh.points.size()) / 2;
    EXPECT_EQ(t.faces[0].triangles, rim - 2);
    EXPECT_EQ(t.faces[1].triangles, rim - 2);
    for (const MeshVertex& v : t.mesh.vertices) EXPECT_TRUE(Interval(0, 1).contains(v.uv[0]));
    const double predicted = predicted_triangles(m, {.tolerance = 1e-2, .as_planes = true});
    EXPECT_LE(predicted, 2 * double(t.mesh.triangles.size()));
    EXPECT_GE(predicted, 0.5 * double(t.mesh.triangles.size()));
}

}  // namespace
