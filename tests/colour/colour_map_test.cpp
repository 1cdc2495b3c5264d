#include <freiform/colour/colour_map.hpp>

#include <cmath>
#include <gtest/gtest.h>

namespace freiform {
namespace {

TEST(Oklab, has_grey_without_colour_and_known_red) {
    for (const double g : {0.0, 0.2, 0.7, 1.0}) {
        const Oklab c = to_oklab({g, g, g, 1});
        EXPECT_NEAR(c.a, 0, 1e-6);
        EXPECT_NEAR(c.b, 0, 1e-6);
    }
    EXPECT_NEAR(to_oklab({1, 1, 1, 1}).L, 1, 1e-6);
    // Red of sRGB as the source of the space gives it: L 0.628, a 0.225, b 0.126.
    const Oklab red = to_oklab({1, 0, 0, 1});
    EXPECT_NEAR(red.L, 0.628, 5e-4);
    EXPECT_NEAR(red.a, 0.225, 5e-4);
    EXPECT_NEAR(red.b, 0.126, 5e-4);
}

TEST(ColourMaps, take_equal_steps_and_stay_inside_srgb) {
    for (const MapKind kind : {MapKind::sequential, MapKind::diverging}) {
        const auto c = ColourMap(kind).colours();
        double least = 1e9, most = 0;
        for (std::size_t i = 1; i < c.size(); ++i) {
            least = std::min(least, oklab_distance(c[i - 1], c[i]));
            most = std::max(most, oklab_distance(c[i - 1], c[i]));
            for (const double x : {c[i].r, c[i].g, c[i].b}) EXPECT_TRUE(x >= 0 && x <= 1);
        }
        EXPECT_LT(most, 1.03 * least);
    }
}

TEST(ColourMaps, are_read_by_lightness_alone) {
    const auto s = ColourMap(MapKind::sequential).colours();
    for (std::size_t i = 1; i < s.size(); ++i) EXPECT_GT(to_oklab(s[i]).L, to_oklab(s[i - 1]).L);
    const auto d = ColourMap(MapKind::diverging).colours();
    for (std::size_t i = 0; i < d.size() / 2; ++i) {
        EXPECT_LT(to_oklab(d[i]).L, to_oklab(d[i + 1]).L);
        EXPECT_NEAR(to_oklab(d[i]).L, to_oklab(d[d.size() - 1 - i]).L, 1e-3) << "even about the middle";
    }
    const Colour middle = ColourMap(MapKind::diverging)(0.5);
    EXPECT_NEAR(middle.r, middle.b, 0.01) << "white";
    EXPECT_GT(d.front().b, d.front().r);
    EXPECT_GT(d.back().r, d.back().b);
}

TEST(ColourMaps, take_numbers_outside_as_the_ends) {
    const ColourMap m(MapKind::sequential);
    EXPECT_EQ(m(-5), m(0));
    EXPECT_EQ(m(7), m(1));
    EXPECT_EQ(m(NAN), m(0));
    EXPECT_EQ(m(INFINITY), m(1));
    EXPECT_EQ(m(0.5), m.colours()[ColourMap::kSize / 2]);
}

}  // namespace
}  // namespace freiform
