// Fonts that Debian installs, and one made by hand.
#pragma once
#include "random.hpp"

#include <freiform/font/font.hpp>

#include <fstream>
#include <gtest/gtest.h>

namespace freiform::test {

inline constexpr const char* kDejaVu = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf";
inline constexpr const char* kCantarell = "/usr/share/fonts/opentype/cantarell/Cantarell-Regular.otf";
inline constexpr const char* kInter = "/usr/share/fonts/truetype/inter-vf/Inter.var.ttf";

inline std::string bytes_of_file(const char* path) {
    std::ifstream in(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

// How often a test repeats itself: FREIFORM_FONTS says, or the given number.
inline int cases(int usual) {
    const char* asked = std::getenv("FREIFORM_FONTS");
    return asked != nullptr ? std::atoi(asked) : usual;
}

// A TrueType font of which glyph k is `times` glyph k - 1, and glyph 0 nothing.
inline std::string font_of_components(int depth, int times) {
    const auto put = [](std::string& s, int size, unsigned long value) {
        while (size-- > 0) s += char(value >> (8 * size) & 0xff);
    };
    const int glyphs = depth + 1;
    std::string head, hhea, maxp, hmtx, loca, glyf;
    put(head, 4, 0x10000), put(head, 4, 0x10000), put(head, 4, 0), put(head, 4, 0x5F0F3CF5);
    put(head, 2, 0), put(head, 2, 1024), put(head, 8, 0), put(head, 8, 0);
    for (const unsigned long x : {0, 0, 1024, 1024, 0, 8, 2, 1, 0}) put(head, 2, x);  // loca of four bytes
    put(hhea, 4, 0x10000);
    for (const unsigned long x : {800, 0, 0, 1024, 0, 0, 0, 1, 0, 0, 0, 0, 0, 0, 0}) put(hhea, 2, x);
    put(hhea, 2, static_cast<unsigned long>(glyphs));
    put(maxp, 4, 0x10000), put(maxp, 2, static_cast<unsigned long>(glyphs));
    for (const unsigned long x : {0, 0, 0, 0, 2, 0, 0, 0, 0, 0, 0, times, 100}) put(maxp, 2, x);
    for (int g = 0; g < glyphs; ++g) {
        put(hmtx, 4, 1024UL << 16), put(loca, 4, glyf.size());
        if (g == 0) continue;
        put(glyf, 2, 0xffff), put(glyf, 8, 0);
        for (int k = 0; k < times; ++k)
            put(glyf, 2, k + 1 < times ? 0x23 : 0x03), put(glyf, 2, static_cast<unsigned long>(g - 1)),
                put(glyf, 4, 0);
    }
    put(loca, 4, glyf.size());
    const std::pair<const char*, std::string*> tables[] = {{"glyf", &glyf}, {"head", &head}, {"hhea", &hhea},
                                                           {"hmtx", &hmtx}, {"loca", &loca}, {"maxp", &maxp}};
    std::string font, body;
    put(font, 4, 0x10000), put(font, 2, 6), put(font, 6, 0);
    for (const auto& [tag, table] : tables) {
        font += tag;
        put(font, 4, 0), put(font, 4, 12 + 6 * 16 + body.size()), put(font, 4, table->size());
        body += *table;
        body.resize((body.size() + 3) / 4 * 4);
    }
    return font + body;
}

}  // namespace freiform::test

// Declares `font`, that of the file, or skips the test and says why. For the body of a TEST.
#define FF_FONT_OR_SKIP(font, file)                                                                    \
    const auto font##_read_ = ::freiform::Font::parse(::freiform::test::bytes_of_file(file));          \
    if (!std::ifstream(file)) GTEST_SKIP() << "no " << (file) << " (tools/setup.sh test installs it)"; \
    ASSERT_TRUE(font##_read_) << font##_read_.error().message;                                         \
    const ::freiform::Font& font = *font##_read_
