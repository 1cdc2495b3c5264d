#include "fonts.hpp"
#include "refusal.hpp"

#include <freiform/font/font.hpp>
#include <freiform/model/swept_solid.hpp>
#include <freiform/trim/inside.hpp>

#include <chrono>
#include <ft2build.h>
#include FT_FREETYPE_H

namespace freiform::test {
namespace {

// Twice the area to the left of the control polygon and between it and the curve: Green's theorem, exactly.
double doubled_area(const Path& path) {
    double sum = 0;
    for (const Subpath& s : path.subpaths)
        for (const PathSegment& g : s.segments) {
            const auto& p = g.points;
            const auto x = [&](std::size_t i, std::size_t j) { return cross(p[i], p[j]); };
            sum += g.degree == 1 ? x(0, 1)
                   : g.degree == 2
                       ? (2 * x(0, 1) + x(0, 2) + 2 * x(1, 2)) / 3
                       : (6 * x(0, 1) + 3 * x(0, 2) + x(0, 3) + 3 * x(1, 2) + 3 * x(1, 3) + 6 * x(2, 3)) / 10;
        }
    return sum;
}

void expect_well_formed(const Path& path, int degree, int glyph) {
    for (const Subpath& s : path.subpaths) {
        ASSERT_FALSE(s.segments.empty());
        ASSERT_TRUE(s.closed);
        Vec<2> at = s.start;
        for (const PathSegment& g : s.segments) {
            ASSERT_EQ(g.front(), at) << "glyph " << glyph;
            ASSERT_TRUE(g.degree == 1 || g.degree == degree) << "glyph " << glyph;
            ASSERT_EQ(g.weight, 1);
            at = g.back();
        }
        ASSERT_EQ(at, s.start) << "glyph " << glyph;
    }
}

struct Seen {
    int outlines = 0, clockwise = 0, segments = 0;
};

Seen every_glyph(const Font& font, int degree) {
    Seen seen;
    const auto start = std::chrono::steady_clock::now();
    for (int i = 0; i < font.info().glyphs; ++i) {
        const auto glyph = font.glyph(i);
        if (!glyph) {
            ADD_FAILURE() << glyph.error().where << ": " << glyph.error().message;
            break;
        }
        expect_well_formed(glyph->path, degree, i);
        for (const Subpath& s : glyph->path.subpaths) seen.segments += int(s.segments.size());
        if (glyph->path.subpaths.empty()) continue;
        ++seen.outlines;
        if (doubled_area(glyph->path) < 0) ++seen.clockwise;
    }
    const std::chrono::duration<double, std::micro> time = std::chrono::steady_clock::now() - start;
    testing::Test::RecordProperty("microseconds_per_glyph", text(time.count() / font.info().glyphs));
    return seen;
}

// What FreeType paints of the character against the share of points of each pixel that are inside the path.
constexpr int kSamples = 200;
struct Difference {
    double largest = 0, mean = 0;
};
Difference difference(const std::string& file, const Font& font, char32_t character, int pixels) {
    FT_Library library = nullptr;
    FT_Face face = nullptr;
    if (FT_Init_FreeType(&library) != 0 || FT_New_Face(library, file.c_str(), 0, &face) != 0) return {1, 1};
    FT_Set_Pixel_Sizes(face, 0, FT_UInt(pixels));
    FT_Load_Char(face, character, FT_LOAD_NO_HINTING | FT_LOAD_RENDER);
    const FT_Bitmap& bitmap = face->glyph->bitmap;
    const double scale = double(pixels) / font.info().units_per_em;
    const Path path =
        transformed(font.glyph(font.index_of(character))->path, {{{{scale, 0}, {0, scale}}}, {}});
    const RegionLoops loops = loops_of(path);
    const auto inside = InsideQuery::make(loops, 0);
    const double pixels_of_it = double(bitmap.rows * bitmap.width);
    Difference all{pixels_of_it > 0 ? 0.0 : 1.0, 0};
    for (unsigned row = 0; row < bitmap.rows; ++row)
        for (unsigned column = 0; column < bitmap.width; ++column) {
            int within = 0;
            for (int k = 0; k < kSamples; ++k) {
                // Spread evenly, and not in rows, which straight edges would meet all at once.
                const double x = std::fmod(k * 0.7548776662466927 + 0.5, 1),
                             y = std::fmod(k * 0.5698402909980532 + 0.5, 1);
                const Vec<2> at{
                    {face->glyph->bitmap_left + int(column) + x, face->glyph->bitmap_top - int(row) - y}};
                within += inside->at(at).winding != 0;
            }
            const double grey = bitmap.buffer[int(row) * bitmap.pitch + int(column)] / 255.0;
            const double off = std::abs(grey - double(within) / kSamples);
            all.largest = std::max(all.largest, off), all.mean += off / pixels_of_it;
        }
    FT_Done_Face(face);
    FT_Done_FreeType(library);
    return all;
}

TEST(Font, every_glyph_of_a_truetype_font_is_closed_quadratics_that_turn_clockwise) {
    FF_FONT_OR_SKIP(font, kDejaVu);
    EXPECT_EQ(font.info().family, "DejaVu Sans");
    EXPECT_EQ(font.info().format, "TrueType");
    EXPECT_EQ(font.info().units_per_em, 2048);
    ASSERT_EQ(font.info().glyphs, 6253);
    const Seen seen = every_glyph(font, 2);
    EXPECT_EQ(seen.outlines, 6190) << seen.segments;
    EXPECT_EQ(seen.clockwise, seen.outlines);
}

TEST(Font, every_glyph_of_a_cff_font_is_closed_cubics_that_turn_counter_clockwise) {
    FF_FONT_OR_SKIP(font, kCantarell);
    EXPECT_EQ(font.info().format, "CFF");
    EXPECT_EQ(font.info().units_per_em, 1000);
    const Seen seen = every_glyph(font, 3);
    EXPECT_GT(seen.outlines, 1000);
    EXPECT_EQ(seen.clockwise, 0);
}

// By hand from the tables of the font: an A of straight lines, and the first points of an o that implies
// others.
TEST(Font, outlines_are_the_numbers_in_the_font) {
    FF_FONT_OR_SKIP(font, kDejaVu);
    const auto a = font.glyph(font.index_of(U'A'));
    ASSERT_TRUE(a);
    EXPECT_EQ(path_data(a->path),
              "M 700,1294 L 426,551 L 975,551 Z M 586,1493 L 815,1493 L 1384,0 L 1174,0 L "
              "1038,383 L 365,383 L 229,0 L 16,0 Z");
    EXPECT_EQ(a->advance, 1401);
    EXPECT_EQ(font.name_of(*font.index_named("A")), "A");
    EXPECT_EQ(font.index_named("A"), font.index_of(U'A'));
    EXPECT_FALSE(font.index_named("no-such-glyph"));
    EXPECT_EQ(font.index_of(0xF0000), 0);
    EXPECT_TRUE(font.glyph(font.index_of(U' '))->path.subpaths.empty());
    int halves = 0;
    const Path eight = must(font.glyph(font.index_of(U'8'))).path;
    for (const Subpath& s : eight.subpaths)
        for (const PathSegment& g : s.segments) halves += 2 * g.back()[0] != 2 * std::floor(g.back()[0]);
    EXPECT_GT(halves, 0) << "points in the middle of two others are not rounded";
}

TEST(Font, looks_as_freetype_paints_it) {
    for (const char* name : {kDejaVu, kCantarell}) {
        FF_FONT_OR_SKIP(font, name);
        for (const char32_t c : U"Ag8@&Q%ij") {
            if (c == 0) continue;
            // FreeType follows curves by chords that are a quarter of a pixel off at most.
            const Difference d = difference(name, font, c, 20);
            EXPECT_LT(d.largest, 0.25) << name << " U+" << std::uint32_t(c);
            EXPECT_LT(d.mean, 0.03) << name << " U+" << std::uint32_t(c);
        }
    }
}

TEST(Font, instances_of_a_variable_font_differ_by_their_axes) {
    FF_FONT_OR_SKIP(font, kInter);
    ASSERT_EQ(font.info().axes.size(), 2u);
    EXPECT_EQ(font.info().axes[0].tag, "wght");
    EXPECT_EQ(font.info().axes[0].least, 100);
    EXPECT_EQ(font.info().axes[0].most, 900);
    const auto area = [&](double weight) {
        const auto one = Font::parse(font.bytes(), {0, {{"wght", weight}}});
        return std::abs(doubled_area(one->glyph(one->index_of(U'I'))->path));
    };
    const double usual = std::abs(doubled_area(font.glyph(font.index_of(U'I'))->path));
    EXPECT_EQ(area(400), usual);
    EXPECT_LT(2 * area(100), usual);
    EXPECT_GT(area(900), 1.5 * usual);
    expect_refusal(Font::parse(font.bytes(), {0, {{"wdth", 80}}}), RefusalKind::invalid, "axes[0]",
                   "it has wght, slnt");
    expect_refusal(Font::parse(font.bytes(), {0, {{"slnt", 0}, {"wght", 901}}}), RefusalKind::invalid,
                   "axes[1]", "from 100 to 900");
}

TEST(Font, what_is_no_font_is_refused) {
    expect_refusal(Font::parse(""), RefusalKind::unreadable, "");
    expect_refusal(Font::parse("<svg/>"), RefusalKind::unreadable, "", "FreeType");
    FF_FONT_OR_SKIP(font, kDejaVu);
    expect_refusal(Font::parse(font.bytes(), {1}), RefusalKind::unreadable, "faces[1]");
    expect_refusal(Font::parse(font.bytes(), {-1}), RefusalKind::invalid, "face");
    expect_refusal(Font::parse(font.bytes(), {0, {{"wght", 400}}}), RefusalKind::invalid, "axes[0]",
                   "no axis");
    expect_refusal(Font::parse(font.bytes(), {0, {}, 1000}), RefusalKind::limit, "");
    expect_refusal(font.glyph(6253), RefusalKind::out_of_domain, "glyphs[6253]", "6253 glyphs");
    expect_refusal(font.glyph(-1), RefusalKind::out_of_domain, "glyphs[-1]");
    expect_refusal(font_file("No Such Family"), RefusalKind::no_answer, "No Such Family");
}

TEST(Font, damaged_fonts_are_read_or_refused) {
    for (const char* name : {kDejaVu, kCantarell}) {
        FF_FONT_OR_SKIP(font, name);
        Random random(7);
        int read = 0, refused = 0;
        for (int round = 0; round < cases(60); ++round) {
            std::string bytes = font.bytes();
            const int most = int(bytes.size()) - 1;
            for (int k = random.integer(1, 200); k > 0; --k)
                bytes[std::size_t(random.integer(0, random.chance(0.5) ? 2000 : most))] =
                    char(random.integer(0, 255));
            if (random.chance(0.2)) bytes.resize(std::size_t(random.integer(0, most)));
            const auto damaged = Font::parse(std::move(bytes));
            if (!damaged) ++refused;
            for (int g = 0; damaged && g < 20; ++g)
                (damaged->glyph(random.integer(0, std::max(0, damaged->info().glyphs - 1))) ? read
                                                                                            : refused) += 1;
        }
        EXPECT_GT(read, 0);
        EXPECT_GT(refused, 0);
    }
}

// Glyph k is 250 times glyph k - 1; glyph 0 is empty. All of it would be 250^12 components.
TEST(Font, components_of_components_end_at_a_limit) {
    const auto font = Font::parse(font_of_components(12, 250), {.memory_bytes = std::size_t(2) << 20});
    ASSERT_TRUE(font) << font.error().message;
    EXPECT_TRUE(font->glyph(1));
    expect_refusal(font->glyph(12), RefusalKind::limit, "glyphs[12]");
    EXPECT_TRUE(font->glyph(1)) << "the limit is of each glyph";
}

}  // namespace
}  // namespace freiform::test
