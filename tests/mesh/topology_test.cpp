#include <freiform/mesh/triangle_mesh.hpp>

#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <random>

namespace freiform {
namespace {

TriangleMesh mesh_of(std::vector<Vec<3>> points, std::vector<std::array<int, 3>> triangles) {
    TriangleMesh mesh;
    mesh.points = std::move(points);
    for (int i = 0; i < int(mesh.points.size()); ++i) mesh.vertices.push_back({i, {}, {}});
    mesh.triangles = std::move(triangles);
    return mesh;
}

const std::vector<Vec<3>> kCorners{{{0, 0, 0}}, {{1, 0, 0}}, {{0, 1, 0}}, {{0, 0, 1}}, {{1, 1, 1}}};
const std::vector<std::array<int, 3>> kTetrahedron{{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};

int degenerate(Vec<3> a, Vec<3> b, Vec<3> c) {
    return topology(mesh_of({a, b, c}, {{0, 1, 2}})).degenerate_triangles;
}

TEST(Topology, closed_mesh_has_no_faults) {
    const MeshTopology t = topology(mesh_of(kCorners, kTetrahedron));
    EXPECT_EQ(t.open_edges, 0);
    EXPECT_EQ(t.non_manifold_edges, 0);
    EXPECT_EQ(t.misoriented_edges, 0);
    EXPECT_EQ(t.degenerate_triangles, 0);
}

TEST(Topology, missing_triangle_opens_three_edges) {
    auto triangles = kTetrahedron;
    triangles.pop_back();
    EXPECT_EQ(topology(mesh_of(kCorners, triangles)).open_edges, 3);
}

TEST(Topology, triangle_that_faces_the_wrong_way_disagrees_with_its_neighbours) {
    auto triangles = kTetrahedron;
    std::swap(triangles[2][0], triangles[2][1]);
    const MeshTopology t = topology(mesh_of(kCorners, triangles));
    EXPECT_EQ(t.misoriented_edges, 3);
    EXPECT_EQ(t.open_edges, 0);
}

TEST(Topology, third_triangle_at_an_edge_is_not_manifold) {
    auto triangles = kTetrahedron;
    triangles.push_back({0, 1, 4});
    const MeshTopology t = topology(mesh_of(kCorners, triangles));
    EXPECT_EQ(t.non_manifold_edges, 1);
    EXPECT_EQ(t.open_edges, 2);
}

TEST(Topology, vertices_of_different_parts_meet_in_their_points) {
    TriangleMesh mesh = mesh_of(kCorners, kTetrahedron);
    for (auto& triangle : mesh.triangles)
        for (int& v : triangle) {
            mesh.vertices.push_back(mesh.vertices[std::size_t(v)]);
            v = int(mesh.vertices.size()) - 1;
        }
    EXPECT_EQ(topology(mesh).open_edges, 0);
}

TEST(Topology, triangle_with_two_equal_points_is_degenerate_and_adds_no_edges) {
    auto triangles = kTetrahedron;
    triangles.push_back({1, 1, 2});
    const MeshTopology t = topology(mesh_of(kCorners, triangles));
    EXPECT_EQ(t.degenerate_triangles, 1);
    EXPECT_EQ(t.non_manifold_edges, 0);
}

TEST(Topology, zero_area_is_decided_exactly) {
    // On lines through the origin, although the rounded differences are not parallel.
    std::mt19937_64 random(5);
    for (int i = 0; i < 1000; ++i) {
        const auto on_line = [&](double unit) {
            const double m = double(random() >> 14) * unit;
            return Vec<3>{{m, 3 * m, 5 * m}};
        };
        ASSERT_EQ(degenerate(on_line(1), on_line(0x1p-7), on_line(0x1p-12)), 1);
    }
    EXPECT_EQ(degenerate({{0.5, 1.5, -2.5}}, {{1, 3, -5}}, {{0x1p-60, 0x3p-60, -0x5p-60}}), 1);
    EXPECT_EQ(degenerate({{0x1p60, 0x3p60, 7}}, {{1, 3, 7}}, {{-0x1p-30, -0x3p-30, 7}}), 1);
    EXPECT_EQ(degenerate({{0, 0, 1}}, {{1e300, 1e-300, 1}}, {{1e300, 0, 1}}), 0);
    // Not on a line, although both products of the cross product round to the same double.
    const double big = 0x1p27;
    EXPECT_EQ(degenerate({{0, 0, 0}}, {{big + 1, big, 0}}, {{big, big - 1, 0}}), 0);
    EXPECT_EQ(degenerate({{0, 0, 4}}, {{0x1p40, 0x1p40, 4}}, {{0x1p40 + 0x1p-12, 0x1p40, 4}}), 0);
}

TEST(Topology, zero_area_does_not_depend_on_the_scale) {
    for (int e : {-1000, -500, -60, 60, 500, 1000}) {
        const auto s = [&](double x) { return std::scalbn(x, e); };
        EXPECT_EQ(degenerate({{s(.5), s(1.5), s(2)}}, {{s(1), s(3), s(4)}}, {{s(2), s(6), s(8)}}), 1) << e;
        EXPECT_EQ(degenerate({{s(.5), s(1.5), s(2)}}, {{s(1), s(3), s(4)}}, {{s(2), s(6), s(8 + 0x1p-48)}}),
                  0)
            << e;
    }
}

TEST(Topology, exact_decision_agrees_with_integers) {
    std::mt19937_64 random(7);
    int lines = 0;
    for (int i = 0; i < 20000; ++i) {
        std::array<std::array<std::int64_t, 3>, 3> p;
        for (auto& x : p[0]) x = std::int64_t(random() % 2048) - 1024;
        for (auto& x : p[1]) x = std::int64_t(random() % 2048) - 1024;
        const auto k = std::int64_t(random() % 5) - 2;
        for (std::size_t d = 0; d < 3; ++d) p[2][d] = p[0][d] + k * (p[1][d] - p[0][d]);
        if (random() % 2) p[2][random() % 3] += 1;
        bool area = false;
        for (std::size_t x = 0; x < 3; ++x) {
            const std::size_t y = (x + 1) % 3;
            area |= (p[1][x] - p[0][x]) * (p[2][y] - p[0][y]) != (p[1][y] - p[0][y]) * (p[2][x] - p[0][x]);
        }
        std::array<Vec<3>, 3> q;
        for (std::size_t j = 0; j < 3; ++j)
            for (std::size_t d = 0; d < 3; ++d) q[j][int(d)] = double(p[j][d]) * 0x1p-20;
        ASSERT_EQ(degenerate(q[0], q[1], q[2]), !area);
        lines += !area;
    }
    EXPECT_GT(lines, 5000);
}

TEST(Edges, are_sorted_and_name_their_triangles) {
    const auto list = edges(mesh_of(kCorners, kTetrahedron));
    ASSERT_EQ(list.size(), 6u);
    for (std::size_t i = 1; i < list.size(); ++i)
        EXPECT_LT(std::pair(list[i - 1].a, list[i - 1].b), std::pair(list[i].a, list[i].b));
    EXPECT_EQ(list[0].triangles, (std::array{0, 1}));
    EXPECT_EQ(list[0].forward, 1);
    EXPECT_EQ(list[0].backward, 1);
}

TEST(TriangleNormal, scales_exactly_and_survives_extremes) {
    const std::vector<Vec<3>> p{{{.1, .2, .3}}, {{1.7, .4, .2}}, {{.3, 2.1, .9}}};
    const Vec<3> n = triangle_normal(mesh_of(p, {{0, 1, 2}}), 0);
    EXPECT_NEAR(norm(n), 1, 1e-15);
    for (int e : {-900, -300, 300, 900}) {
        auto q = p;
        for (auto& x : q)
            for (int i = 0; i < 3; ++i) x[i] = std::scalbn(x[i], e);
        EXPECT_EQ(triangle_normal(mesh_of(q, {{0, 1, 2}}), 0), n) << e;
    }
    const double m = std::numeric_limits<double>::max();
    EXPECT_EQ(triangle_normal(mesh_of({{{-m, -m, 0}}, {{m, -m, 0}}, {{-m, m, 0}}}, {{0, 1, 2}}), 0),
              (Vec<3>{{0, 0, 1}}));
    EXPECT_EQ(triangle_normal(mesh_of({{{0, 0, 0}}, {{1, 1, 1}}, {{2, 2, 2}}}, {{0, 1, 2}}), 0), Vec<3>{});
}

TEST(Validate, names_what_leads_outside) {
    const TriangleMesh good = mesh_of(kCorners, kTetrahedron);
    EXPECT_TRUE(validate(good));
    TriangleMesh m = good;
    m.points[3][1] = NAN;
    EXPECT_EQ(validate(m).error().where, "points[3]");
    EXPECT_EQ(validate(m).error().kind, RefusalKind::nonfinite);
    m = good;
    m.vertices[2].point = 5;
    EXPECT_EQ(validate(m).error().where, "vertices[2]");
    m = good;
    m.vertices[1].normal[0] = INFINITY;
    EXPECT_EQ(validate(m).error().kind, RefusalKind::nonfinite);
    m = good;
    m.triangles[1][2] = -1;
    EXPECT_EQ(validate(m).error().where, "triangles[1]");
    m = good;
    m.parts = {{"a", {}, 0, 2, -1}, {"b", {}, 3, 1, -1}};
    EXPECT_EQ(validate(m).error().where, "parts[1]");
    m.parts = {{"a", {}, 0, 2, -1}, {"b", {}, 2, 1, -1}};
    EXPECT_EQ(validate(m).error().where, "parts");
    m.parts = {{"a", {}, 0, 2, -1}, {"b", Colour{0, 0, 2, 1}, 2, 2, -1}};
    EXPECT_EQ(validate(m).error().where, "parts[1].colour");
}

}  // namespace
}  // namespace freiform
