// Letters as regions: what a font draws with overlapping contours, and pens along all of it.
#include "fonts.hpp"

#include <freiform/region/stroke.hpp>

#include <region_laws.hpp>

namespace freiform {
namespace {

std::size_t segments_of(const Path& path) {
    std::size_t n = 0;
    for (const Subpath& s : path.subpaths) n += s.segments.size();
    return n;
}

// A sample of the glyphs, and those whose diamonds have nearly tangent arcs in their strokes.
TEST(GlyphRegions, glyphs_of_a_font_are_united_and_stroked_without_a_refusal) {
    FF_FONT_OR_SKIP(font, test::kDejaVu);
    const double em = font.info().units_per_em;
    const RegionOptions options{.tolerance = em / 1000};
    std::vector<int> sample{3743, 3744};
    const int wanted = test::cases(300);
    for (int i = 0; i < wanted; ++i)
        sample.push_back(int((long(i) * font.info().glyphs) / wanted) % font.info().glyphs);
    test::Random random(1);
    for (const int index : sample) {
        const Glyph glyph = test::must(font.glyph(index));
        if (glyph.path.subpaths.empty()) continue;
        SCOPED_TRACE(text("glyph ", index, ' ', font.name_of(index)));
        const auto whole = region_of({glyph.path}, options);
        ASSERT_TRUE(whole) << whole.error().where << ": " << whole.error().message;
        EXPECT_LE(whole->bound, options.tolerance);
        const InsideQuery given = test::inside_query(glyph.path), made = test::inside_query(whole->path);
        for (int i = 0; i < 10; ++i) {
            const Vec<2> p{{random.real(0, em), random.real(-em / 4, em)}};
            if (made.at(p).winding == int(given.at(p).winding != 0)) continue;
            EXPECT_LE(test::distance_from_above(glyph.path, p), whole->bound) << p[0] << ' ' << p[1];
        }
        if (segments_of(glyph.path) > 24 && index != 3744) continue;  // strokes of shades take a while
        StrokeStyle style;
        style.width = em / 20;
        const auto pen = stroked(glyph.path, style, options);
        ASSERT_TRUE(pen) << pen.error().where << ": " << pen.error().message;
        EXPECT_LE(pen->bound, options.tolerance);
        const InsideQuery covered = test::inside_query(pen->path);
        for (const Subpath& s : glyph.path.subpaths)
            for (const PathSegment& segment : s.segments)
                EXPECT_EQ(covered.at(test::point_at(segment, 0.5)).winding, 1);
    }
}

}  // namespace
}  // namespace freiform
