// Any bytes as a font: read or refused, within the memory that was given; text in it is set or refused.
#include <freiform/font/typeset.hpp>

#include <cstdint>
#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace freiform;
    const auto font = Font::parse({reinterpret_cast<const char*>(data), size});
    if (!font) return 0;
    for (int g = 0; g < 8; ++g) {
        const auto glyph = font->glyph(g * font->info().glyphs / 8);
        if (!glyph) continue;
        for (const Subpath& s : glyph->path.subpaths)
            if (s.segments.empty() || s.segments.back().back() != s.start) std::abort();
    }
    (void)font->name_of(1);
    (void)font->characters();
    const auto set = typeset(*font, "AVfi \u0645\u0631", {12});
    const auto latin = typeset(*font, "AVfi", {12});
    if (latin) (void)outlines(*font, *latin, 12);
    return set ? (std::abort(), 0) : 0;  // two directions in one line
}
