#include <freiform/io/drawing.hpp>

#include <charconv>
#include <gtest/gtest.h>
#include <set>

using namespace freiform;

namespace {

// Position of the labels with these letters.
std::vector<DrawnLabel> labels(const Drawing& d, std::string_view letters) {
    std::vector<DrawnLabel> out;
    for (const DrawnGroup& g : d.groups)
        for (const DrawnLabel& l : g.labels) {
            std::string s;
            for (const DrawnRun& run : l.text) s += run.text;
            if (s == letters) out.push_back(l);
        }
    return out;
}

Box<2> box_of(const DrawnLabel& l) {
    const double w = width_of(l.text, l.size);
    const double x = l.at[0] - w * (l.anchor == Anchor::start ? 0 : l.anchor == Anchor::middle ? 0.5 : 1);
    return {{{x, l.at[1] - 0.75 * l.size}}, {{x + w, l.at[1] + 0.2 * l.size}}};
}

bool overlap(const Box<2>& a, const Box<2>& b) {
    return a.side(0).overlaps(b.side(0)) && a.side(1).overlaps(b.side(1));
}

Panel square(double side) {
    Panel p;
    DrawnGroup g{"", "square", kInk, 1, {}, {}, {}};
    const std::array<Vec<2>, 4> corners{{{{0, 0}}, {{side, 0}}, {{side, side}}, {{0, side}}}};
    g.paths.push_back(line_through(corners, true));
    p.groups.push_back(g);
    return p;
}

}  // namespace

TEST(Formula, letters_after_the_signs_are_low_or_high) {
    const DrawnText t = formula("*b*_0^{n-1} = 2");
    ASSERT_EQ(t.size(), 5u);
    EXPECT_EQ(t[0].text, "b");
    EXPECT_TRUE(t[0].italic);
    EXPECT_EQ(t[1].text, "0");
    EXPECT_EQ(t[1].level, -1);
    EXPECT_EQ(t[2].text, "n");
    EXPECT_TRUE(t[2].italic);
    EXPECT_EQ(t[2].level, 1);
    EXPECT_EQ(t[3].text, "-1");
    EXPECT_FALSE(t[3].italic);
    EXPECT_EQ(t[3].level, 1);
    EXPECT_EQ(t[4].text, " = 2");
    EXPECT_FALSE(t[4].italic);
    EXPECT_EQ(formula("a_κ")[1].text, "κ") << "one letter, not one byte";
    EXPECT_EQ(plain_text("a_b*c")[0].text, "a_b*c");
    for (const char* odd : {"", "_", "^", "a_", "*", "a_{b", "^}", "**"})
        EXPECT_LE(formula(odd).size(), 3u) << odd;
}

TEST(Arrange, panels_share_the_page_and_do_not_meet) {
    Figure f;
    f.width = 800, f.height = 400, f.columns = 3;
    for (int i = 0; i < 5; ++i) f.panels.push_back(square(1 + i));
    for (std::size_t i = 0; i < 5; ++i) f.panels[i].name = text("panel ", i);
    const Drawing d = arrange(f);
    std::vector<Box<2>> boxes;
    for (const DrawnGroup& g : d.groups) boxes.push_back(freiform::box_of(std::span(&g, 1)));
    ASSERT_EQ(boxes.size(), 5u);
    for (std::size_t i = 0; i < 5; ++i) {
        EXPECT_NEAR(boxes[i].side(0).length(), boxes[i].side(1).length(), 1e-9) << "squares stay squares";
        EXPECT_GT(boxes[i].side(0).length(), 100);
        EXPECT_TRUE(boxes[i].lo[0] >= 0 && boxes[i].hi[0] <= 800 && boxes[i].lo[1] >= 0 &&
                    boxes[i].hi[1] <= 400);
        for (std::size_t k = 0; k < i; ++k) EXPECT_FALSE(overlap(boxes[i], boxes[k]));
    }
}

TEST(Arrange, both_directions_are_filled_where_scales_may_differ) {
    Figure f;
    f.width = 800, f.height = 400, f.margin = 0;
    f.panels.push_back(square(3));
    f.panels[0].equal = false;
    const Box<2> box = freiform::box_of(arrange(f).groups);
    EXPECT_NEAR(box.side(0).length(), 800, 1e-9);
    EXPECT_NEAR(box.side(1).length(), 400, 1e-9);
}

TEST(Arrange, words_do_not_overlap_each_other_nor_leave_the_page) {
    Figure f;
    f.width = f.height = 400;
    Panel p = square(1);
    for (int i = 0; i < 5; ++i)
        for (int j = 0; j < 5; ++j)
            p.notes.push_back({{{0.25 * i, 0.25 * j}}, formula(text("*P*_{", i, j, "}")), kInk, 15});
    for (int i = 0; i < 5; ++i) p.notes.push_back({{{0, 0}}, plain_text("origin"), kInk, 15, {{-1, -1}}});
    f.panels.push_back(p);
    const Drawing d = arrange(f);
    std::vector<Box<2>> boxes;
    for (const DrawnGroup& g : d.groups)
        for (const DrawnLabel& l : g.labels) boxes.push_back(box_of(l));
    ASSERT_EQ(boxes.size(), 30u);
    for (std::size_t i = 0; i < boxes.size(); ++i) {
        for (int k = 0; k < 2; ++k) EXPECT_TRUE(boxes[i].lo[k] >= 0 && boxes[i].hi[k] <= 400);
        for (std::size_t k = 0; k < i; ++k) EXPECT_FALSE(overlap(boxes[i], boxes[k])) << i << ' ' << k;
    }
}

TEST(Arrange, ticks_are_where_their_numbers_say) {
    Figure f;
    Panel p = square(0.7);
    p.axes = Axes::grid;
    f.panels.push_back(p);
    const Drawing d = arrange(f);
    for (const auto& [word, x] : {std::pair("0.3", 0.3), std::pair("0.1", 0.1), std::pair("0", 0.0)}) {
        const auto found = labels(d, word);
        ASSERT_EQ(found.size(), 2u) << word;
        EXPECT_NEAR(found[0].at[0], d.origin[0] + d.scale * x, 1e-9);
    }
    p = square(-0.7);
    f.panels = {p};
    f.panels[0].axes = Axes::ticks;
    EXPECT_EQ(labels(arrange(f), "\u22120.3").size(), 2u) << "a minus sign, not a hyphen";
}

TEST(Arrange, the_legend_says_each_thing_once) {
    Figure f;
    f.panels = {square(1), square(1)};
    for (Panel& p : f.panels) p.groups[0].legend = plain_text("a square");
    EXPECT_EQ(labels(arrange(f), "a square").size(), 1u);
    f.legend = false;
    EXPECT_TRUE(labels(arrange(f), "a square").empty());
}

TEST(Arrange, arrows_end_where_their_lines_end) {
    Figure f;
    Panel p;
    DrawnGroup g{"", "arrow", kInk, 2, {}, {}, {}};
    g.paths.push_back(line_through(std::array{Vec<2>{{0, 0}}, Vec<2>{{1, 0}}}));
    g.arrows = true;
    p.groups.push_back(g);
    f.panels.push_back(p);
    const Drawing d = arrange(f);
    ASSERT_EQ(d.groups[0].paths.size(), 2u);
    const DrawnPath& head = d.groups[0].paths[1];
    EXPECT_TRUE(head.solid && head.closed);
    EXPECT_NEAR(head.start[0], d.origin[0] + d.scale, 1e-9);
    EXPECT_LT(end_of(d.groups[0].paths[0])[0], head.start[0]) << "the line ends inside the head";
}

TEST(Arrange, nothing_is_a_page_without_anything) {
    Figure f;
    EXPECT_TRUE(arrange(f).groups.empty());
    f.panels.emplace_back();
    f.panels[0].axes = Axes::grid;
    for (const DrawnGroup& g : arrange(f).groups)
        for (const DrawnPath& path : g.paths) EXPECT_TRUE(is_finite(path.start));
}

TEST(Svg, layers_and_ids_are_those_of_an_editor) {
    Figure f;
    f.panels = {square(1), square(2)};
    f.panels[0].name = f.panels[1].name = "side";
    f.panels[1].name = "other <side>";
    const std::string s = to_svg(arrange(f));
    std::multiset<std::string> ids;
    for (std::size_t at = s.find(" id=\""); at != std::string::npos; at = s.find(" id=\"", at + 1))
        ids.insert(s.substr(at + 5, s.find('"', at + 5) - at - 5));
    EXPECT_EQ(ids, (std::multiset<std::string>{"side", "square", "other-side", "square-2"}));
    EXPECT_NE(s.find("inkscape:groupmode=\"layer\" inkscape:label=\"other &lt;side&gt;\""),
              std::string::npos);
}

TEST(Svg, a_raised_run_is_moved_back_afterwards) {
    Drawing d;
    d.width = d.height = 100;
    d.groups.push_back({"", "words", kInk, 1, {}, {}, {{{{1, 2}}, formula("a_1^2b"), 10}}});
    const std::string s = to_svg(d);
    double sum = 0;
    for (std::size_t at = s.find(" dy=\""); at != std::string::npos; at = s.find(" dy=\"", at + 1)) {
        double x = 0;
        std::from_chars(&s[at + 5], &s[s.find('"', at + 5)], x);
        sum += x;
    }
    EXPECT_NEAR(sum, 0, 1e-12);
    EXPECT_NE(s.find(">a<tspan"), std::string::npos) << s;
}
