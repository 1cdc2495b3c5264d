#include <freiform/io/drawing.hpp>
#include <freiform/paint/paint.hpp>

#include <gtest/gtest.h>

using namespace freiform;

namespace {

Drawing sample() {
    Figure f;
    f.width = 200, f.height = 100;
    f.margin = 0;
    f.title = plain_text("A parabola");
    Panel p;
    DrawnGroup g{"", "curve", {1, 0, 0, 1}, 4, {}, {}, {}};
    const std::array<Vec<2>, 3> b{{{{0, 0}}, {{1, 2}}, {{2, 0}}}};
    g.paths.push_back(bezier_path(b));
    p.groups.push_back(g);
    f.panels.push_back(p);
    return arrange(f);
}

unsigned be32(const std::string& s, std::size_t at) {
    unsigned x = 0;
    for (std::size_t i = 0; i < 4; ++i) x = 256 * x + static_cast<unsigned char>(s[at + i]);
    return x;
}

}  // namespace

TEST(Pdf, is_one_page_with_letters_and_the_same_every_time) {
    const auto pdf = to_pdf(sample());
    ASSERT_TRUE(pdf) << pdf.error().message;
    EXPECT_TRUE(pdf->starts_with("%PDF-1."));
    EXPECT_NE(pdf->rfind("%%EOF"), std::string::npos);
    EXPECT_NE(pdf->find("/Count 1"), std::string::npos);
    EXPECT_NE(pdf->find("/MediaBox [ 0 0 150 75 ]"), std::string::npos) << "200 x 100 pixels of 1/96 inch";
    EXPECT_NE(pdf->find("/ToUnicode"), std::string::npos) << "words are words";
    EXPECT_NE(pdf->find("/Title (A parabola)"), std::string::npos);
    EXPECT_EQ(pdf->find("CreationDate"), std::string::npos);
    EXPECT_EQ(*pdf, *to_pdf(sample()));
}

TEST(Png, has_the_size_of_the_drawing) {
    const auto png = to_png(sample());
    ASSERT_TRUE(png) << png.error().message;
    EXPECT_TRUE(png->starts_with("\x89PNG\r\n\x1a\n"));
    EXPECT_EQ(be32(*png, 16), 200u);
    EXPECT_EQ(be32(*png, 20), 100u);
    EXPECT_EQ(*png, *to_png(sample()));
}

TEST(Png, shows_what_is_drawn) {
    Drawing bare = sample();
    for (DrawnGroup& g : bare.groups) g.paths.clear();
    EXPECT_LT(to_png(bare)->size() + 200, to_png(sample())->size());
    Drawing empty = bare;
    for (DrawnGroup& g : empty.groups) g.labels.clear();
    EXPECT_LT(to_png(empty)->size() + 200, to_png(bare)->size());
}

TEST(Png, refuses_what_would_fill_the_memory) {
    Drawing huge;
    huge.width = huge.height = 16384;
    const auto png = to_png(huge);
    ASSERT_FALSE(png);
    EXPECT_EQ(png.error().kind, RefusalKind::limit);
    EXPECT_NE(png.error().message.find("268435456"), std::string::npos) << png.error().message;
}

TEST(PaintOver, leaves_pixels_that_the_drawing_does_not_touch) {
    Image picture{4, 3, {}};
    for (int i = 0; i < 36; ++i) picture.rgb.push_back(static_cast<unsigned char>(7 * i));
    const Image before = picture;
    Drawing d;
    d.width = 4, d.height = 3;
    ASSERT_TRUE(paint_over(picture, d));
    EXPECT_EQ(picture.rgb, before.rgb);
    DrawnGroup g{"", "", {1, 0.5, 0, 1}, 0, {}, {}, {}};
    DrawnPath pixel{
        {{1, 1}}, {{1, {Vec<2>{{2, 1}}}}, {1, {Vec<2>{{2, 2}}}}, {1, {Vec<2>{{1, 2}}}}}, true, true};
    g.paths.push_back(pixel);
    d.groups.push_back(g);
    ASSERT_TRUE(paint_over(picture, d));
    for (int y = 0; y < 3; ++y)
        for (int x = 0; x < 4; ++x)
            for (int c = 0; c < 3; ++c)
                EXPECT_EQ(picture.pixel(x, y)[c], x == 1 && y == 1 ? (c == 0   ? 255
                                                                      : c == 1 ? 128
                                                                               : 0)
                                                                   : before.pixel(x, y)[c]);
    d.width = 5;
    EXPECT_EQ(paint_over(picture, d).error().where, "size");
}

// Two squares, one turned the other way round inside the other: a frame. Of a solid path the inside is
// filled.
TEST(Png, areas_have_holes) {
    const auto square = [](double lo, double hi, bool back) {
        DrawnPath p{{{lo, lo}}, {}, true};
        for (const Vec<2> to : {back ? Vec<2>{{lo, hi}} : Vec<2>{{hi, lo}}, Vec<2>{{hi, hi}},
                                back ? Vec<2>{{hi, lo}} : Vec<2>{{lo, hi}}})
            p.segments.push_back({1, {to}});
        return p;
    };
    Drawing d;
    d.width = d.height = 30;
    DrawnGroup g{"", "glyph", {0, 0, 0, 1}, 0, {}, {}, {}};
    g.area = true;
    g.paths = {square(3, 27, false), square(9, 21, true)};
    d.groups = {g};
    const auto grey_at = [&](std::size_t x, std::size_t y) {
        Image picture{30, 30, std::vector<unsigned char>(2700, 255)};
        EXPECT_TRUE(paint_over(picture, d));
        return int(picture.rgb[3 * (30 * y + x)]);
    };
    EXPECT_EQ(grey_at(6, 15), 0);
    EXPECT_EQ(grey_at(15, 15), 255);
    EXPECT_EQ(grey_at(1, 15), 255);
    d.groups[0].paths[1] = square(9, 21, false);  // the same way round: not a hole
    EXPECT_EQ(grey_at(15, 15), 0);
    EXPECT_NE(to_svg(d).find("ZM9 9"), std::string::npos) << to_svg(d);
}
