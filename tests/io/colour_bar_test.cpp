#include <freiform/io/colour_bar.hpp>

#include <gtest/gtest.h>

namespace freiform {
namespace {

std::vector<std::string> words(const Drawing& d) {
    std::vector<std::string> out;
    for (const DrawnGroup& g : d.groups)
        for (const DrawnLabel& l : g.labels) {
            out.emplace_back();
            for (const DrawnRun& run : l.text) out.back() += run.text;
        }
    return out;
}
bool has(const std::vector<std::string>& all, std::string_view one) {
    return std::ranges::find(all, one) != all.end();
}

TEST(ColourBar, has_ticks_at_round_numbers_inside_the_range_at_their_place) {
    ColourBar bar;
    bar.map = MapKind::diverging;
    bar.range = {-0.3, 0.3};
    bar.title = plain_text("mean curvature");
    bar.remarks = {plain_text("in 1/mm")};
    const Drawing d = drawing_of(bar, 800, 600);
    const auto said = words(d);
    for (const char* one : {"mean curvature", "in 1/mm", "0", "0.1", "\u22120.1", "0.3", "\u22120.3"})
        EXPECT_TRUE(has(said, one)) << one;
    EXPECT_FALSE(has(said, "no value"));
    double zero = 0, most = 0, least = 0;
    for (const DrawnGroup& g : d.groups)
        for (const DrawnLabel& l : g.labels) {
            if (l.text[0].text == "0") zero = l.at[1];
            if (l.text[0].text == "0.3") most = l.at[1];
            if (l.text[0].text == "\u22120.3") least = l.at[1];
        }
    EXPECT_LT(most, zero);
    EXPECT_NEAR(most + least, 2 * zero, 1e-9);
}

TEST(ColourBar, zero_has_no_sign) {
    ColourBar bar;
    bar.map = MapKind::sequential;
    bar.range = {0, 0.043};
    const auto said = words(drawing_of(bar, 800, 600));
    EXPECT_TRUE(has(said, "0"));
    EXPECT_FALSE(has(said, "-0") || has(said, "\u22120"));
}

TEST(ColourBar, writes_all_ticks_of_a_range_in_one_way) {
    ColourBar bar;
    bar.map = MapKind::sequential;
    bar.range = {0, 0.0024};
    const auto said = words(drawing_of(bar, 800, 600));
    for (const char* one : {"0", "0.0005", "0.001", "0.002"}) EXPECT_TRUE(has(said, one)) << one;
    bar.range = {0, 2.4e-7};
    EXPECT_TRUE(has(words(drawing_of(bar, 800, 600)), "5e-08"));
}

TEST(ColourBar, shows_the_colours_of_the_map_over_the_range_asked_for) {
    ColourBar bar;
    bar.map = MapKind::diverging;
    bar.range = {-1, 3};  // 0 stays white: the lower end is a light blue
    const Drawing d = drawing_of(bar, 800, 600);
    const ColourMap map(MapKind::diverging);
    std::vector<Colour> strips;
    for (const DrawnGroup& g : d.groups)
        if (!g.paths.empty() && g.paths[0].solid) strips.push_back(g.colour);
    ASSERT_GT(strips.size(), 100u);
    EXPECT_LT(oklab_distance(strips.front(), map(1)), 0.01) << "the top";
    EXPECT_LT(oklab_distance(strips.back(), map(0.5 - 1.0 / 6)), 0.01) << "the bottom";
}

TEST(ColourBar, of_one_value_or_of_words_alone_is_drawn_too) {
    ColourBar bar;
    bar.title = plain_text("normal");
    bar.no_value = true;
    EXPECT_TRUE(has(words(drawing_of(bar, 800, 600)), "no value"));
    bar.map = MapKind::sequential;
    bar.range = {2, 2};
    EXPECT_TRUE(has(words(drawing_of(bar, 800, 600)), "2"));
    bar.range = {1e-30, 3e-30};
    EXPECT_TRUE(has(words(drawing_of(bar, 800, 600)), "2e-30"));
}

}  // namespace
}  // namespace freiform
