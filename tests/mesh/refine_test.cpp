#include "support/test_meshes.hpp"

#include <freiform/mesh/refine.hpp>

#include <gtest/gtest.h>

namespace freiform {
namespace {

double area(const TriangleMesh& mesh) {
    double sum = 0;
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i) {
        const auto p = mesh.points_of(i);
        const Vec<3>& a = mesh.points[std::size_t(p[0])];
        sum += norm(cross(mesh.points[std::size_t(p[1])] - a, mesh.points[std::size_t(p[2])] - a)) / 2;
    }
    return sum;
}

TEST(Refined, keeps_the_shape_and_its_closedness_and_shortens_all_sides) {
    for (const TriangleMesh& mesh : {test::cube(), test::torus(12, 7), test::sphere(5, 9)}) {
        const TriangleMesh fine = refined(mesh, 0.11, 1'000'000);
        ASSERT_TRUE(validate(fine));
        EXPECT_NEAR(area(fine), area(mesh), 1e-12 * area(mesh));
        EXPECT_EQ(topology(fine).open_edges, 0);
        EXPECT_EQ(topology(fine).misoriented_edges, 0);
        for (const MeshEdge& e : edges(fine))
            EXPECT_LE(norm(fine.points[std::size_t(e.a)] - fine.points[std::size_t(e.b)]), 0.11);
        for (const MeshVertex& v : fine.vertices) EXPECT_NEAR(norm(v.normal), 1, 1e-12);
        EXPECT_EQ(fine.parts.size(), mesh.parts.size());
        EXPECT_EQ(std::vector(fine.points.begin(), fine.points.begin() + long(mesh.points.size())),
                  mesh.points);
    }
}

TEST(Refined, changes_nothing_where_sides_are_short_but_the_rounds_asked_for) {
    const TriangleMesh mesh = test::cube();
    EXPECT_EQ(refined(mesh, 2, 1'000'000).triangles, mesh.triangles);
    EXPECT_EQ(refined(mesh, 2, 1'000'000, 2).triangles.size(), 16 * mesh.triangles.size());
    EXPECT_EQ(refined(mesh, 1e-9, 100).triangles.size(), 4 * mesh.triangles.size()) << "the limit";
}

}  // namespace
}  // namespace freiform
