#include "support/random.hpp"
#include "support/solids.hpp"

#include <freiform/mesh/triangle_tree.hpp>

#include <gtest/gtest.h>

using namespace freiform;
using namespace freiform::test;

namespace {

Vec<3> anywhere(Random& rng) {
    const double x = rng.real(-1, 1), y = rng.real(-1, 1);
    return {{x, y, rng.real(-1, 1)}};
}

// Every third has two equal corners or all on a line.
std::vector<Triangle3> soup(Random& rng, int n) {
    std::vector<Triangle3> out;
    for (int i = 0; i < n; ++i) {
        const Vec<3> a = anywhere(rng), b = a + 0.2 * anywhere(rng), c = a + 0.2 * anywhere(rng);
        out.push_back(i % 6 == 0   ? Triangle3{a, b, a}
                      : i % 6 == 3 ? Triangle3{a, b, 0.5 * (a + b)}
                                   : Triangle3{a, b, c});
    }
    return out;
}

TEST(TriangleTree, finds_what_looking_at_all_triangles_finds) {
    Random rng(1);
    for (const int n : {1, 5, 300}) {
        const auto all = soup(rng, n);
        const TriangleTree tree(all);
        for (int i = 0; i < 300; ++i) {
            const Vec<3> p = 1.5 * anywhere(rng);
            double least = INFINITY;
            for (const auto& t : all) least = std::min(least, distance_to_triangle(p, t[0], t[1], t[2]));
            const auto found = tree.nearest(p);
            ASSERT_GE(found.triangle, 0);
            EXPECT_NEAR(found.distance, least, 1e-14);
            EXPECT_NEAR(norm(found.point - p), found.distance, 1e-15);
            const auto& t = all[std::size_t(found.triangle)];
            EXPECT_LE(distance_to_triangle(found.point, t[0], t[1], t[2]), 1e-14) << "the point is not on it";
            EXPECT_EQ(tree.nearest(p, 0.999 * least).triangle, -1);
            EXPECT_EQ(tree.nearest(p, 1.001 * least + 1e-12).triangle, found.triangle);
        }
    }
}

TEST(TriangleTree, without_triangles_finds_nothing) {
    EXPECT_EQ(TriangleTree({}).nearest({{0, 0, 0}}).triangle, -1);
}

TEST(TriangleTree, nearest_points_scale_exactly_with_powers_of_two) {
    const Triangle3 t{{{{0, 0, 0}}, {{1, 0.25, 0}}, {{0.5, 1, 0.75}}}};
    for (const Vec<3>& p : {Vec<3>{{0.6875, -0.3125, 1.125}}, Vec<3>{{-1, 0.5, 0.25}}, Vec<3>{{2, 0.5, -1}}})
        for (const int k : {-300, -90, 90, 300}) {
            const double f = std::ldexp(1.0, k);
            const Vec<3> one = closest_point(t, p);
            const Vec<3> other = closest_point({f * t[0], f * t[1], f * t[2]}, f * p);
            EXPECT_LE(norm((1 / f) * other - one), 1e-15) << k;
            EXPECT_NEAR(TriangleTree({{f * t[0], f * t[1], f * t[2]}}).nearest(f * p).distance / f,
                        norm(p - one), 1e-15);
        }
}

}  // namespace
