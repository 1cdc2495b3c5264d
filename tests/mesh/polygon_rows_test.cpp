// Rows of sides say of every point what all sides say.
#include "support/random.hpp"

#include <freiform/mesh/segment_box.hpp>

#include <cmath>
#include <gtest/gtest.h>

namespace freiform {
namespace {

using test::Random;

struct Polygons {
    std::vector<Vec<2>> points = {};
    std::vector<std::array<int, 2>> sides = {};

    void add(const std::vector<Vec<2>>& loop) {
        const int first = int(points.size()), n = int(loop.size());
        points.insert(points.end(), loop.begin(), loop.end());
        for (int i = 0; i < n; ++i) sides.push_back({first + i, first + (i + 1) % n});
    }
    bool hold(const Vec<2>& x) const {
        bool in = false;
        for (const auto& [a, b] : sides) {
            const Vec<2>&p = points[std::size_t(a)], &q = points[std::size_t(b)];
            if ((p[1] > x[1]) != (q[1] > x[1]) && x[0] < p[0] + (x[1] - p[1]) / (q[1] - p[1]) * (q[0] - p[0]))
                in = !in;
        }
        return in;
    }
};

Polygons random_polygons(Random& random, const Vec<2>& at, const Vec<2>& size) {
    Polygons out;
    for (int l = random.integer(1, 4); l > 0; --l) {
        std::vector<Vec<2>> loop;
        for (int k = random.integer(3, 400); k > 0; --k)
            loop.push_back(at + Vec<2>{{random.real(0, 1) * size[0], random.real(0, 1) * size[1]}});
        out.add(loop);
    }
    return out;
}

TEST(PolygonRows, say_what_all_sides_say) {
    Random random(7);
    int inside = 0, all = 0;
    for (int round = 0; round < 60; ++round) {
        const Vec<2> at{{random.real(-5, 5), round % 3 == 0 ? 1e9 : random.real(-5, 5)}},
            size{{1, std::pow(10, random.real(-6, 3))}};
        const Polygons polygons = random_polygons(random, at, size);
        const PolygonRows rows(polygons.points, polygons.sides);
        for (int k = 0; k < 300; ++k) {
            // Also beyond all rows, and as high as corners.
            Vec<2> x = at + Vec<2>{{random.real(-0.2, 1.2) * size[0], random.real(-0.2, 1.2) * size[1]}};
            if (k % 4 == 0) x[1] = polygons.points[std::size_t(k) % polygons.points.size()][1];
            EXPECT_EQ(rows.is_inside(x), polygons.hold(x)) << round << ": " << x[0] << ", " << x[1];
            inside += polygons.hold(x), ++all;
        }
    }
    EXPECT_GT(inside, all / 5);
    EXPECT_LT(inside, all * 4 / 5);
}

// Of a comb every side is as high as all of it: rows would have each of them.
TEST(PolygonRows, of_high_sides_are_few) {
    std::vector<Vec<2>> loop;
    constexpr int kTeeth = 20000;
    for (int i = 0; i < kTeeth; ++i) {
        loop.push_back({{double(i), 0}});
        loop.push_back({{i + 0.5, 1}});
    }
    loop.push_back({{double(kTeeth), -1}});
    loop.push_back({{-1, -1}});
    Polygons comb;
    comb.add(loop);
    const PolygonRows rows(comb.points, comb.sides);
    EXPECT_LE(rows.sides(), 8 * comb.sides.size());
    for (const double x : {0.26, 777.24, kTeeth - 0.6})
        EXPECT_EQ(rows.is_inside({{x, 0.5}}), comb.hold({{x, 0.5}})) << x;
}

TEST(PolygonRows, of_nothing_and_of_a_line_hold_nothing) {
    EXPECT_FALSE(PolygonRows().is_inside({{0, 0}}));
    EXPECT_FALSE(PolygonRows({}, {}).is_inside({{0, 0}}));
    Polygons flat;
    flat.add({{{0, 1}}, {{2, 1}}, {{1, 1}}});
    EXPECT_FALSE(PolygonRows(flat.points, flat.sides).is_inside({{0.5, 1}}));
}

}  // namespace
}  // namespace freiform
