// Text as placed glyphs: kerning, ligatures, marks, right-to-left scripts, by HarfBuzz.
#pragma once
#include <freiform/font/font.hpp>

namespace freiform {

struct TypesetOptions {
    double size = 1;  // of an em, in model units, > 0
    std::vector<std::string> features =
        {};                        // as CSS and HarfBuzz write them: "-liga", "ss01", "kern=0", "aalt[3:5]=2"
    std::string language = "und";  // BCP 47: "sr", "tr"; never that of the machine
};

struct PlacedGlyph {
    int index = 0;         // in the font
    std::size_t byte = 0;  // of the text, where what it shows begins
    Vec<2> at{};           // where its origin goes, in model units
};

// The first base line begins at (0, 0) and runs along x; right-to-left text too ends at its left end. Further
// lines are below.
struct Typeset {
    std::vector<PlacedGlyph> glyphs;  // from left to right, line by line
    double width = 0;                 // of the widest line
    int lines = 0;
    std::vector<Refusal> missing;  // characters that the font has no glyph for; a box stands for each
};

// Positions are font units times size / units_per_em. Each line (between "\n") is one run of one direction:
// that of its letters. Refuses sizes that are not positive, features that are none, text that is not UTF-8
// (invalid); lines with letters of both directions and right-to-left lines with numbers of several digits,
// which would have to be taken apart (unsupported); more than 1,000,000 bytes (limit).
//   const auto line = typeset(font, "Hello", {.size = 20});
Result<Typeset> typeset(const Font& font, std::string_view utf8, const TypesetOptions& options = {});

// The outlines, in the order of the glyphs, in their places; empty ones too.
Result<std::vector<Path>> outlines(const Font& font, const Typeset& text, double size);

}  // namespace freiform
