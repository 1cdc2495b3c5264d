// What counts as simple without a triangulation has nothing that a triangulation would refuse.
#include "mesh/simple_polygons_detail.hpp"
#include "support/random.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <set>

namespace freiform {
namespace {

using test::Random;
using Segments = std::vector<Triangulation::Segment>;

Segments sides_around(int n, int first = 0) {
    Segments s;
    for (int i = 0; i < n; ++i) s.push_back({first + i, first + (i + 1) % n});
    return s;
}

TEST(SimplePolygons, are_never_refused_by_the_triangulation) {
    Random random(7);
    int simple = 0, refused = 0;
    for (int round = 0; round < 6000; ++round) {
        const int n = random.integer(3, 7), side = random.integer(2, 6);
        std::vector<Vec<2>> points;
        std::set<std::array<double, 2>> seen;
        while (int(points.size()) < n && seen.size() < std::size_t((side + 1) * (side + 1))) {
            const Vec<2> p{{double(random.integer(0, side)), double(random.integer(0, side))}};
            if (seen.insert(p.c).second) points.push_back(p);
        }
        const Segments segments = sides_around(int(points.size()));
        const bool fine = Triangulation::attempt(points, segments).has_value();
        const bool answer = are_simple_polygons(points, segments);
        EXPECT_TRUE(fine || !answer);
        simple += answer, refused += !fine;
    }
    EXPECT_GT(simple, 500);
    EXPECT_GT(refused, 500);
}

TEST(SimplePolygons, are_seen_as_such) {
    for (const double scale : {1.0, 0x1p-300, 0x1p300}) {
        std::vector<Vec<2>> points;  // a square with long sides, some of them cut, and a ring within
        for (int i = 0; i < 100; ++i) points.push_back({{scale * i / 100, 0}});
        for (int i = 0; i < 100; ++i) points.push_back({{scale, scale * i / 100}});
        points.push_back({{scale, scale}});
        points.push_back({{0, scale}});
        Segments segments = sides_around(int(points.size()));
        for (const auto& s : sides_around(50, int(points.size()))) segments.push_back(s);
        for (int i = 0; i < 50; ++i)
            points.push_back(
                {{scale * (0.5 + 0.3 * std::cos(i * 0.1256)), scale * (0.5 + 0.3 * std::sin(i * 0.1256))}});
        EXPECT_TRUE(are_simple_polygons(points, segments));
        points.back() = {{scale / 2, 0}};  // on the square
        EXPECT_FALSE(are_simple_polygons(points, segments));
    }
}

TEST(SimplePolygons, are_not_claimed_where_the_form_is_another) {
    const std::vector<Vec<2>> square{{{0, 0}}, {{1, 0}}, {{1, 1}}, {{0, 1}}};
    EXPECT_TRUE(are_simple_polygons(square, sides_around(4)));
    EXPECT_FALSE(are_simple_polygons(square, Segments{}));
    EXPECT_FALSE(are_simple_polygons(square, sides_around(3)));  // a point by itself
    Segments twice = sides_around(4);
    twice.push_back({0, 1});
    EXPECT_FALSE(are_simple_polygons(square, twice));
    EXPECT_FALSE(are_simple_polygons(std::vector<Vec<2>>{{{0, 0}}, {{1, 1}}, {{2, 2}}}, sides_around(3)));
    EXPECT_FALSE(are_simple_polygons(std::vector<Vec<2>>{{{0, 0}}, {{1, 0}}, {{2, 0}}}, sides_around(3)));
    EXPECT_FALSE(are_simple_polygons(std::vector<Vec<2>>{{{0, 0}}, {{1, 0}}, {{NAN, 1}}}, sides_around(3)));
}

}  // namespace
}  // namespace freiform
