#include "fonts.hpp"
#include "refusal.hpp"

#include <freiform/font/typeset.hpp>

namespace freiform::test {
namespace {

double sum_of_advances(const Font& font, std::u32string_view s) {
    double sum = 0;
    for (const char32_t c : s) sum += font.glyph(font.index_of(c))->advance;
    return sum;
}

TEST(Typeset, is_kerned_as_the_font_says) {
    for (const char* name : {kDejaVu, kInter}) {
        FF_FONT_OR_SKIP(font, name);
        const double em = font.info().units_per_em;
        const auto plain = typeset(font, "AVATAR", {em, {"-kern"}});
        ASSERT_TRUE(plain);
        EXPECT_EQ(plain->width, sum_of_advances(font, U"AVATAR")) << name;
        const auto kerned = typeset(font, "AVATAR", {em});
        EXPECT_LT(kerned->width, plain->width - 0.02 * em);
        ASSERT_EQ(kerned->glyphs.size(), 6u);
        EXPECT_EQ(kerned->glyphs[1].index, font.index_of(U'V'));
        EXPECT_EQ(kerned->glyphs[5].byte, 5u);
        EXPECT_EQ(typeset(font, "AVATAR", {2 * em})->width, 2 * kerned->width);
    }
}

TEST(Typeset, joins_letters_unless_told_not_to) {
    FF_FONT_OR_SKIP(font, kDejaVu);
    EXPECT_EQ(typeset(font, "fi")->glyphs.size(), 1u);
    EXPECT_EQ(typeset(font, "fi", {1, {"-liga"}})->glyphs.size(), 2u);
}

TEST(Typeset, runs_from_right_to_left_where_letters_do) {
    FF_FONT_OR_SKIP(font, kDejaVu);
    const auto hebrew = typeset(font, "\u05e9\u05dc\u05d5\u05dd");
    ASSERT_TRUE(hebrew);
    ASSERT_EQ(hebrew->glyphs.size(), 4u);
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_EQ(hebrew->glyphs[i].byte, 6 - 2 * i);
        if (i > 0) EXPECT_GT(hebrew->glyphs[i].at[0], hebrew->glyphs[i - 1].at[0]);
    }
    // Letters of Arabic have other shapes where they are joined.
    const auto arabic = typeset(font, "\u0645\u0631\u062d\u0628\u0627");
    ASSERT_EQ(arabic->glyphs.size(), 5u);
    EXPECT_NE(arabic->glyphs[1].index, font.index_of(U'\u0628'));
    expect_refusal(typeset(font, "ab \u05e9"), RefusalKind::unsupported, "byte 3", "other direction");
    expect_refusal(typeset(font, "\u05e9 42"), RefusalKind::unsupported, "byte 3", "number");
    EXPECT_TRUE(typeset(font, "\u05e9 4\nab"));
}

TEST(Typeset, sets_lines_below_each_other_and_names_what_is_missing) {
    FF_FONT_OR_SKIP(font, kDejaVu);
    const auto two = typeset(font, "a\n\nb\U000F0000", {2048});
    ASSERT_TRUE(two);
    EXPECT_EQ(two->lines, 3);
    EXPECT_EQ(two->glyphs[0].at, (Vec<2>{{0, 0}}));
    EXPECT_EQ(two->glyphs[1].at, (Vec<2>{{0, -2 * 2384.0}}));
    ASSERT_EQ(two->missing.size(), 1u);
    EXPECT_EQ(two->missing[0].where, "byte 4");
    EXPECT_EQ(two->missing[0].message, "the font has no glyph for U+F0000");
    const auto paths = outlines(font, *two, 2048);
    ASSERT_EQ(paths->size(), 3u);
    EXPECT_EQ(path_data((*paths)[0]), path_data(font.glyph(font.index_of(U'a'))->path));
    EXPECT_EQ(typeset(font, "")->lines, 1);
}

TEST(Typeset, instances_have_widths_of_their_own) {
    FF_FONT_OR_SKIP(font, kInter);
    const auto bold = Font::parse(font.bytes(), {0, {{"wght", 900}}});
    EXPECT_GT(typeset(*bold, "weight")->width, 1.05 * typeset(font, "weight")->width);
}

TEST(Typeset, refuses_what_is_no_text_and_no_feature) {
    FF_FONT_OR_SKIP(font, kDejaVu);
    expect_refusal(typeset(font, "ab\xff"), RefusalKind::invalid, "byte 2", "UTF-8");
    expect_refusal(typeset(font, "\xc0\x80"), RefusalKind::invalid, "byte 0", "UTF-8");
    expect_refusal(typeset(font, "a\xe2\x82"), RefusalKind::invalid, "byte 1", "UTF-8");
    expect_refusal(typeset(font, "\xed\xa0\x80"), RefusalKind::invalid, "byte 0", "UTF-8");
    expect_refusal(typeset(font, "a", {0}), RefusalKind::invalid, "size");
    expect_refusal(typeset(font, "a", {1, {"kern", "!"}}), RefusalKind::invalid, "features[1]");
    expect_refusal(typeset(font, std::string(1'000'001, 'a')), RefusalKind::limit, "text");
}

}  // namespace
}  // namespace freiform::test
