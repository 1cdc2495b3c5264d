#include "support/test_meshes.hpp"

#include <freiform/mesh/level_lines.hpp>

#include <algorithm>
#include <gtest/gtest.h>

namespace freiform {
namespace {

Vec<3> at(const TriangleMesh& mesh, const EdgePlace& p) {
    const auto point = [&](int v) { return mesh.points[std::size_t(mesh.vertices[std::size_t(v)].point)]; };
    return (1 - p.t) * point(p.a) + p.t * point(p.b);
}

std::vector<double> heights(const TriangleMesh& mesh, int axis) {
    std::vector<double> out;
    for (const MeshVertex& v : mesh.vertices) out.push_back(mesh.points[std::size_t(v.point)][axis]);
    return out;
}

TEST(LevelLines, of_a_torus_are_closed_and_at_their_height_with_the_larger_values_on_the_left) {
    const TriangleMesh mesh = test::torus(40, 24);
    for (const auto& [axis, level, count] :
         {std::tuple(2, 0.1, 2u), std::tuple(2, 0.0, 2u), std::tuple(0, 0.3, 2u), std::tuple(0, 2.0, 1u)}) {
        const auto lines = level_lines(mesh, heights(mesh, axis), level);
        EXPECT_EQ(lines.size(), count) << axis << " " << level;
        for (const LevelLine& line : lines) {
            EXPECT_TRUE(line.closed);
            EXPECT_EQ(at(mesh, line.places.front()), at(mesh, line.places.back()));
            for (const EdgePlace& p : line.places) EXPECT_NEAR(at(mesh, p)[axis], level, 1e-14);
        }
    }
    // On the outer equator, seen from outside, up is left of counter-clockwise about z.
    double turn = 0;
    for (const LevelLine& line : level_lines(mesh, heights(mesh, 2), 0.1))
        for (std::size_t i = 1; i < line.places.size(); ++i) {
            const Vec<3> a = at(mesh, line.places[i - 1]), b = at(mesh, line.places[i]);
            if (std::hypot(a[0], a[1]) > 2) turn += a[0] * b[1] - a[1] * b[0];
        }
    EXPECT_GT(turn, 0);
}

TEST(LevelLines, through_vertices_do_not_branch) {
    const TriangleMesh mesh = test::sphere(4, 8);  // the equator is made of sides
    const auto equator = level_lines(mesh, heights(mesh, 1), 0);
    ASSERT_EQ(equator.size(), 1u);
    EXPECT_TRUE(equator[0].closed);
    EXPECT_TRUE(level_lines(mesh, heights(mesh, 2), -1).empty()) << "nothing is below";
    EXPECT_EQ(level_lines(mesh, heights(mesh, 2), 1).size(), 1u) << "the pole, as one point";
    EXPECT_TRUE(level_lines(mesh, heights(mesh, 2), 1.5).empty());
}

TEST(LevelLines, end_at_the_border_of_their_part) {
    const TriangleMesh mesh = test::cube();
    std::vector<double> z = heights(mesh, 2);
    const auto lines = level_lines(mesh, z, 0.5);
    EXPECT_EQ(lines.size(), 4u);
    for (const LevelLine& line : lines) {
        EXPECT_FALSE(line.closed);
        ASSERT_EQ(line.places.size(), 3u) << "through both triangles of a side";
        EXPECT_NEAR(norm(at(mesh, line.places[0]) - at(mesh, line.places[2])), 1, 1e-15);
    }
}

TEST(Outlines, of_a_cube_are_its_edges) {
    const auto lines = outlines(test::cube(), 0.1);
    EXPECT_EQ(lines.size(), 12u);
    for (const Outline& o : lines) {
        EXPECT_FALSE(o.smooth);
        EXPECT_EQ(o.points.size(), 2u);
        EXPECT_NE(o.parts[0], o.parts[1]);
    }
}

TEST(Outlines, tell_smooth_borders_from_creases_and_ends) {
    TriangleMesh torus = test::torus(20, 12);
    EXPECT_TRUE(outlines(torus, 0.1).empty()) << "closed and smooth";
    // Two parts: the borders are two circles.
    torus.parts[0].count /= 2;
    torus.parts.push_back({"rest", std::nullopt, torus.parts[0].count, torus.parts[0].count, 1});
    const auto borders = outlines(torus, 0.1);
    ASSERT_EQ(borders.size(), 2u);
    for (const Outline& o : borders) {
        EXPECT_TRUE(o.smooth);
        EXPECT_EQ(o.points.front(), o.points.back());
        EXPECT_EQ(o.points.size(), 13u);
    }
    // One of the parts taken away: open ends.
    torus.triangles.resize(std::size_t(torus.parts[0].count));
    torus.parts.pop_back();
    const auto open = outlines(torus, 0.1);
    ASSERT_EQ(open.size(), 2u);
    for (const Outline& o : open) {
        EXPECT_FALSE(o.smooth);
        EXPECT_EQ(o.parts[1], -1);
    }
}

TEST(Outlines, of_a_cone_do_not_run_from_its_apex) {
    // Four triangles that have a vertex each at the apex.
    TriangleMesh cone;
    cone.points = {{{0, 0, 3}}};
    for (int k = 0; k < 4; ++k) {
        const auto towards = [k](double quarters) {
            const double a = (k + quarters) * std::numbers::pi / 2;
            return Vec<3>{{std::cos(a), std::sin(a), 0}};
        };
        cone.points.push_back(towards(0));
        cone.vertices.push_back({k + 1, unit(towards(0) + Vec<3>{{0, 0, 1.0 / 3}}), {}});
        cone.triangles.push_back({k, (k + 1) % 4, 4 + k});
    }
    for (int k = 0; k < 4; ++k) {
        const Vec<3>&a = cone.vertices[std::size_t(k)].normal,
              &b = cone.vertices[std::size_t((k + 1) % 4)].normal;
        cone.vertices.push_back({0, unit(a + b), {{k + 0.5, 1}}});
    }
    const auto lines = outlines(cone, 0.1);
    ASSERT_EQ(lines.size(), 1u) << "the circle";
    EXPECT_EQ(lines[0].points.size(), 5u);
    EXPECT_EQ(std::ranges::count(lines[0].points, 0), 0);
    // A kink that ends at the circle: the same parameters, two normals.
    cone.vertices[5].uv = cone.vertices[4].uv;
    EXPECT_EQ(outlines(cone, 0.1).size(), 2u);
}

}  // namespace
}  // namespace freiform
