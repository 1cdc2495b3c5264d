#include <freiform/path/flatten.hpp>
#include <freiform/region/boolean.hpp>

#include <gtest/gtest.h>
#include <numbers>
#include <regions.hpp>

namespace freiform {
namespace {

using namespace test;

double polygon_area(std::span<const Vec<2>> p) {
    double sum = 0;
    for (std::size_t i = 0; i < p.size(); ++i) sum += cross(p[i], p[(i + 1) % p.size()]);
    return sum / 2;
}

TEST(SignedArea, of_circles_and_sectors_of_ellipses_is_what_the_formula_says) {
    for (const double r : {1.0, 0x1p-300, 3e5}) {
        const PathArea a = signed_area({{ellipse({{2 * r, -r}}, r, 0.25 * r)}});
        EXPECT_LE(std::abs(a.value - std::numbers::pi * r * (0.25 * r)), 2 * a.bound + 1e-16 * a.value);
        EXPECT_LE(a.bound, 1e-14 * a.value);
    }
    EXPECT_EQ(signed_area({{rectangle(1, 2, 4, 8)}}).value, 18);
}

TEST(SignedArea, agrees_with_polygons_for_all_kinds_of_segments) {
    Random random(1);
    for (int i = 0; i < 40; ++i) {
        const Subpath loop = random_loop(random, {.segments = random.integer(1, 5)});
        std::vector<Vec<2>> polygon;
        for (const PathSegment& s : loop.segments) {
            const auto line = std::visit([](const auto& c) { return must(flatten(c, {.tolerance = 1e-6})); },
                                         curve_of({s.front(), {s}, false}));
            polygon.insert(polygon.end(), line.points.begin(), line.points.end() - 1);
        }
        EXPECT_NEAR(signed_area({{loop}}).value, polygon_area(polygon), 1e-4) << i;
    }
}

TEST(SignedArea, of_conics_does_not_jump_where_the_formula_changes) {
    // Weights on both sides of 1 - w^2 = 1/4, 0, -1/4: the area grows with the weight, steadily.
    for (const double w : {std::sqrt(0.75), 1.0, std::sqrt(1.25)}) {
        const auto area = [](double weight) {
            Path path = path_from("M 0 0 Q 4 1 1 3 Z");
            path.subpaths[0].segments[0].weight = weight;
            return signed_area(path);
        };
        const double h = 1e-9, below = area(w - h).value, at = area(w).value, above = area(w + h).value;
        EXPECT_GT(below, 0);
        EXPECT_NEAR((at - below) / h, (above - at) / h, 1e-5);
    }
}

}  // namespace
}  // namespace freiform
