// Fonts made to take all memory or all time: each is read or refused within 256 MiB and a second.
#include "fonts.hpp"

#include <freiform/font/typeset.hpp>

#include <effort.hpp>

namespace freiform::test {
namespace {

// What a program does with a font that it was given. Never wrong: there may be an answer or none.
bool used(std::string bytes) {
    const auto font = Font::parse(std::move(bytes));
    if (!font) return !font.error().message.empty();
    (void)font->characters();
    for (int g = 0; g < 200; ++g) {
        const auto glyph = font->glyph(int(long(g) * font->info().glyphs / 200));
        if (!glyph && glyph.error().message.empty()) return false;
    }
    const auto set = typeset(*font, "AVATAR fi", {12});
    if (set) (void)outlines(*font, *set, 12);
    return true;
}

unsigned long number_at(const std::string& s, std::size_t at, int size) {
    unsigned long x = 0;
    for (int i = 0; i < size; ++i) x = x << 8 | static_cast<unsigned char>(s[at + std::size_t(i)]);
    return x;
}
void set_number(std::string& s, std::size_t at, int size, unsigned long x) {
    if (at + std::size_t(size) > s.size()) return;
    while (size-- > 0) s[at + std::size_t(size)] = char(x & 0xff), x >>= 8;
}

struct FontTable {
    std::string tag;
    std::size_t entry = 0, from = 0, size = 0;
};
std::vector<FontTable> tables_of(const std::string& font) {
    std::vector<FontTable> all;
    for (std::size_t i = 0; i < number_at(font, 4, 2); ++i) {
        const std::size_t at = 12 + 16 * i;
        all.push_back({font.substr(at, 4), at, number_at(font, at + 8, 4), number_at(font, at + 12, 4)});
    }
    return all;
}

TEST(FontHostile, fonts_cut_off_anywhere_are_read_or_refused) {
    for (const char* name : {kDejaVu, kCantarell}) {
        FF_FONT_OR_SKIP(font, name);
        std::vector<std::size_t> cuts{0, 1, 4, 11, 12, 13, 28, 100};
        for (const FontTable& t : tables_of(font.bytes()))
            for (const std::size_t at : {t.entry, t.entry + 8, t.from, t.from + 1, t.from + t.size / 2})
                cuts.push_back(at);
        for (const std::size_t cut : cuts) {
            SCOPED_TRACE(text(name, " up to ", cut));
            FF_EXPECT_LITTLE_EFFORT([&] { return used(font.bytes().substr(0, cut)); });
        }
    }
}

TEST(FontHostile, tables_said_to_be_large_or_elsewhere_are_read_or_refused) {
    for (const char* name : {kDejaVu, kCantarell}) {
        FF_FONT_OR_SKIP(font, name);
        for (const FontTable& t : tables_of(font.bytes()))
            for (const unsigned long x : {0UL, 0x7fffffffUL, 0x80000000UL, 0xffffffffUL, 0xfffffff0UL})
                for (const std::size_t field : {8, 12}) {
                    std::string bytes = font.bytes();
                    set_number(bytes, t.entry + field, 4, x);
                    SCOPED_TRACE(text(name, " ", t.tag, " ", field, " ", x));
                    FF_EXPECT_LITTLE_EFFORT([&] { return used(bytes); });
                }
        std::string bytes = font.bytes();
        set_number(bytes, 4, 2, 0xffff);  // tables
        FF_EXPECT_LITTLE_EFFORT([&] { return used(bytes); });
    }
}

// The largest number at every place where a count may be: the first 64 bytes of each table.
TEST(FontHostile, counts_of_two_and_four_bytes_at_their_largest_are_read_or_refused) {
    for (const char* name : {kDejaVu, kCantarell}) {
        FF_FONT_OR_SKIP(font, name);
        for (const FontTable& t : tables_of(font.bytes())) {
            for (const int size : {2, 4})
                FF_EXPECT_LITTLE_EFFORT([&] {
                    std::string bytes = font.bytes();
                    for (std::size_t at = 0; at < std::min<std::size_t>(64, t.size); at += std::size_t(size))
                        set_number(bytes, t.from + at, size, size == 2 ? 0xffff : 0x7fffffff);
                    return used(std::move(bytes));
                });
            for (std::size_t at = 0; at < std::min<std::size_t>(64, t.size); at += 2) {
                std::string bytes = font.bytes();
                set_number(bytes, t.from + at, 2, at % 4 == 0 ? 0x7fff : 0xffff);
                SCOPED_TRACE(text(name, " ", t.tag, " + ", at));
                FF_EXPECT_LITTLE_EFFORT([&] { return used(bytes); });
            }
        }
    }
}

TEST(FontHostile, glyphs_of_glyphs_and_of_themselves_end) {
    for (const auto& [depth, times] : {std::pair{12, 250}, std::pair{60, 2}})
        FF_EXPECT_LITTLE_EFFORT([depth = depth, times = times] {
            const auto font = Font::parse(font_of_components(depth, times));
            return font && font->glyph(1) && !font->glyph(depth);
        });
    // Glyph 1 is glyph 3, which is glyph 2, which is glyph 1.
    std::string ring = font_of_components(3, 1);
    for (const FontTable& t : tables_of(ring))
        if (t.tag == "glyf") set_number(ring, t.from + 12, 2, 3);
    FF_EXPECT_LITTLE_EFFORT([&] {
        const auto font = Font::parse(ring);
        return font && !font->glyph(1) && !font->glyph(3);
    });
}

}  // namespace
}  // namespace freiform::test
