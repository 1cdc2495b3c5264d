#include <freiform/poly/predicates.hpp>
#include <freiform/query/hull.hpp>

#include <gtest/gtest.h>
#include <support/random.hpp>

namespace freiform::test {
namespace {

TEST(ConvexHull, turns_left_at_every_corner_and_has_all_points_on_its_left) {
    Random random(1);
    for (int k = 0; k < 300; ++k) {
        std::vector<Vec<2>> p(std::size_t(random.integer(3, 40)));
        const bool grid = k % 2 == 0;  // with many points on one line
        for (auto& x : p)
            x = grid ? Vec<2>{{double(random.integer(0, 4)), double(random.integer(0, 4))}}
                     : Vec<2>{{random.real(0, 1), random.real(0, 1)}};
        const auto hull = must(convex_hull(p));
        if (hull.size() < 3) continue;
        for (std::size_t i = 0; i < hull.size(); ++i) {
            const auto at = [&](std::size_t j) { return p[std::size_t(hull[j % hull.size()])]; };
            EXPECT_EQ(orient2d(at(i), at(i + 1), at(i + 2)), 1);
            for (const auto& x : p) EXPECT_GE(orient2d(at(i), at(i + 1), x), 0);
        }
    }
}

TEST(ConvexHull, of_points_on_a_line_has_its_ends) {
    const std::vector<Vec<2>> p{{{0.1, 0.1}}, {{0.3, 0.3}}, {{0.2, 0.2}}, {{0.1, 0.1}}};
    EXPECT_EQ(must(convex_hull(p)), (std::vector<int>{0, 1}));
    EXPECT_EQ(must(convex_hull(std::vector<Vec<2>>{{{1, 2}}, {{1, 2}}})), std::vector<int>{0});
    EXPECT_TRUE(must(convex_hull({})).empty());
    EXPECT_EQ(convex_hull(std::vector<Vec<2>>{{{1, NAN}}}).error().where, "points[0]");
}

}  // namespace
}  // namespace freiform::test
