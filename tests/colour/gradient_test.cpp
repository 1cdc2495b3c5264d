#include "random.hpp"
#include "refusal.hpp"

#include <freiform/colour/gradient.hpp>

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

namespace freiform {
namespace {

using test::Random;

constexpr ColourSpace kSpaces[] = {ColourSpace::srgb, ColourSpace::linear, ColourSpace::oklab,
                                   ColourSpace::oklch};

double difference(const Colour& a, const Colour& b) {
    return std::max({std::abs(a.r - b.r), std::abs(a.g - b.g), std::abs(a.b - b.b), std::abs(a.a - b.a)});
}
Colour random_colour(Random& random) {
    return {random.real(0, 1), random.real(0, 1), random.real(0, 1), random.real(0, 1)};
}

TEST(Gradient, colours_come_back_from_every_space) {
    Random random(31);
    for (const ColourSpace space : kSpaces)
        for (int i = 0; i < 300; ++i) {
            const Colour c = random_colour(random);
            EXPECT_LE(difference(colour_at(coordinates(c, space), c.a, space), c), 1e-5) << name_of(space);
        }
    // Published values of Oklab: sRGB red.
    const Vec<3> red = coordinates({1, 0, 0}, ColourSpace::oklab);
    EXPECT_NEAR(red[0], 0.62796, 1e-4);
    EXPECT_NEAR(red[1], 0.22486, 1e-4);
    EXPECT_NEAR(red[2], 0.12585, 1e-4);
    EXPECT_NEAR(coordinates({0, 0, 1}, ColourSpace::oklch)[2] * 180 / M_PI, 264.05 - 360, 0.1);
    // What sRGB does not have is brought into it without jumps, at blue and at cyan, too, where its edge is
    // hollow.
    for (const Colour& to : {Colour{0, 0, 1}, Colour{0.05, 0.3, 0.75}, Colour{0, 1, 1}})
        for (const Colour& from : {Colour{1, 0, 0}, Colour{1, 0.9, 0.5}, Colour{0, 1, 0}}) {
            const auto g = *Gradient::make(std::vector<ColourStop>{{0, from}, {1, to}}, {ColourSpace::oklch});
            for (double t = 0; t < 1; t += 1e-3) EXPECT_LE(difference(g(t), g(t + 1e-3)), 0.03) << t;
        }
}

TEST(Gradient, meets_its_stops_and_mixes_in_its_space) {
    Random random(32);
    for (const ColourSpace space : kSpaces)
        for (const auto way : {GradientOptions::Way::lines, GradientOptions::Way::smooth}) {
            std::vector<ColourStop> stops;
            for (int i = 0; i < 5; ++i) stops.push_back({i + random.real(-0.4, 0.4), random_colour(random)});
            const auto g = *Gradient::make(stops, {space, way});
            for (const auto& [at, c] : stops) EXPECT_LE(difference(g(at), c), 1e-5) << name_of(space);
            EXPECT_LE(difference(g(-9), stops[0].colour), 1e-5);
            EXPECT_LE(difference(g(9), stops[4].colour), 1e-5);
        }
    const std::vector<ColourStop> two = {{0, {1, 1, 1}}, {1, {0, 0, 0}}};
    EXPECT_NEAR((*Gradient::make(two, {ColourSpace::srgb}))(0.5).r, 0.5, 1e-12);
    EXPECT_NEAR((*Gradient::make(two, {ColourSpace::linear}))(0.5).r, 0.735357, 1e-5);
    EXPECT_NEAR((*Gradient::make(two, {ColourSpace::oklab}))(0.5).r, 0.388573, 1e-4);  // 0.125 of the light
}

TEST(Gradient, smooth_ones_have_no_corners_and_near_ones_stay_inside) {
    const std::vector<ColourStop> stops = {
        {0, {0.2, 0.4, 0.1}}, {1, {0.8, 0.5, 0.3}}, {3, {0.4, 0.7, 0.6}}, {4, {0.3, 0.3, 0.9}}};
    const auto smooth = *Gradient::make(stops, {ColourSpace::srgb, GradientOptions::Way::smooth});
    for (const double at : {1.0, 3.0}) {
        const double h = 1e-6;
        EXPECT_NEAR((smooth(at + h).r - smooth(at).r) / h, (smooth(at).r - smooth(at - h).r) / h, 1e-4);
    }
    const auto near = *Gradient::make(stops, {ColourSpace::srgb, GradientOptions::Way::near});
    EXPECT_LE(difference(near(0), stops[0].colour), 1e-12);
    EXPECT_LE(difference(near(4), stops[3].colour), 1e-12);
    EXPECT_GT(difference(near(1), stops[1].colour), 0.02);
    for (double t = 0; t <= 4; t += 0.1) {
        EXPECT_GE(near(t).r, 0.2 - 1e-12);
        EXPECT_LE(near(t).r, 0.8 + 1e-12);
    }
}

TEST(Gradient, hues_go_the_way_that_is_asked_for) {
    const auto hue = [](double degrees) {
        return colour_at({{0.7, 0.1, degrees * M_PI / 180}}, 1, ColourSpace::oklch);
    };
    const std::vector<ColourStop> stops = {{0, hue(170)}, {1, hue(-150)}};
    const auto shorter = *Gradient::make(stops, {ColourSpace::oklch});
    const auto longer = *Gradient::make(stops, {ColourSpace::oklch, GradientOptions::Way::lines, true});
    EXPECT_LE(difference(shorter(0.5), hue(-170)), 1e-4);
    EXPECT_LE(difference(longer(0.5), hue(10)), 1e-4);
    // Greys have no hue of their own.
    const std::vector<ColourStop> grey = {{0, {1, 1, 1}}, {1, hue(100)}};
    const auto g = *Gradient::make(grey, {ColourSpace::oklch});
    for (double t = 0.1; t < 1; t += 0.1)
        EXPECT_NEAR(coordinates(g(t), ColourSpace::oklch)[2], 100 * M_PI / 180, 1e-3) << t;
}

TEST(Gradient, becomes_stops_between_which_lines_will_do) {
    Random random(33);
    for (const ColourSpace space : kSpaces) {
        std::vector<ColourStop> stops;
        for (int i = 0; i < 4; ++i) stops.push_back({double(i), random_colour(random)});
        const auto g = *Gradient::make(stops, {space, GradientOptions::Way::smooth});
        const auto out = *g.stops_in_srgb(0.004);
        for (std::size_t i = 0; i + 1 < out.size(); ++i)
            for (double t = 0; t <= 1; t += 0.05) {
                const Colour &a = out[i].colour, &b = out[i + 1].colour,
                             c = g(out[i].at + t * (out[i + 1].at - out[i].at));
                const Colour mixed{(1 - t) * a.r + t * b.r, (1 - t) * a.g + t * b.g, (1 - t) * a.b + t * b.b,
                                   (1 - t) * a.a + t * b.a};
                EXPECT_LE(difference(mixed, c), 0.006) << name_of(space);
            }
        EXPECT_LT(out.size(), 200u);
        EXPECT_GT(out.size(), 6u);
        test::expect_refusal(g.stops_in_srgb(0), RefusalKind::invalid, "tolerance");
    }
    const auto line =
        *Gradient::make(std::vector<ColourStop>{{0, {0, 0, 0}}, {1, {1, 1, 1}}}, {ColourSpace::srgb});
    EXPECT_EQ(line.stops_in_srgb(1e-9)->size(), 2u);
}

TEST(Gradient, refuses_by_stop_and_reads_names) {
    const auto refused = [](std::vector<ColourStop> stops, const char* where,
                            RefusalKind kind = RefusalKind::invalid) {
        test::expect_refusal(Gradient::make(stops), kind, where);
    };
    refused({}, "stops");
    refused({{0, {}}}, "stops");
    refused({{0, {}}, {0, {}}}, "stops[1]");
    refused({{0, {}}, {NAN, {}}}, "stops[1]", RefusalKind::nonfinite);
    refused({{0, {}}, {1, {0, 1.5, 0}}}, "stops[1]");
    refused({{0, {}}, {1, {0, NAN, 0}}}, "stops[1]");
    EXPECT_EQ(*colour_named("#f08"), (Colour{1, 0, 136 / 255.0}));
    EXPECT_EQ(*colour_named("#C8401880"), (Colour{200 / 255.0, 64 / 255.0, 24 / 255.0, 128 / 255.0}));
    for (const char* bad : {"", "#", "red", "#12345", "#12345g", "#123456789"})
        EXPECT_FALSE(colour_named(bad)) << bad;
    for (const char* hex : {"#c84018", "#000000", "#ffffff", "#12345678"})
        EXPECT_EQ(hex_of(*colour_named(hex)), hex);
}

}  // namespace
}  // namespace freiform
