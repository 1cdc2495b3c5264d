// Outlines of the glyphs of a font: TrueType (quadratics), CFF and CFF2 (cubics), Type 1; instances of
// variable fonts. Through FreeType, without hinting.
#pragma once
#include <freiform/core/interval.hpp>
#include <freiform/core/result.hpp>
#include <freiform/path/path.hpp>

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace freiform {

// A way in which a variable font can be changed: "wght" from 100 to 900, usually 400.
struct FontAxis {
    std::string tag, name;
    double least = 0, usual = 0, most = 0;
};

struct AxisValue {
    std::string tag;
    double value = 0;
};

struct FontOptions {
    int face = 0;                                      // of a collection (.ttc)
    std::vector<AxisValue> axes = {};                  // others have their usual values
    std::size_t memory_bytes = std::size_t(64) << 20;  // besides the bytes of the font
};

// Lengths in font units, y up.
struct FontInfo {
    std::string family, style, format;  // "DejaVu Sans", "Book", "TrueType"
    int faces = 1;                      // in the file
    int glyphs = 0;
    int units_per_em = 0;
    double ascender = 0, descender = 0;  // of a line: above the base line, and (negative) below
    double line_step = 0;                // from one base line to the next
    std::vector<FontAxis> axes;          // of a variable font
    std::vector<double> at;              // values of the axes
};

// Every subpath is closed; what is inside is told by the winding rule (not 0), which fonts are made for.
struct Glyph {
    Path path;
    double advance = 0;  // to where the next glyph begins
};

// A handle of a font that has been read; copies are the same font. Thread-safe; glyphs are read one at a
// time.
class Font {
public:
    // Whatever the bytes are, the answer is a font or a refusal: unreadable, unsupported (no outlines),
    // invalid (a face, an axis or a value that the font does not have), limit.
    static Result<Font> parse(std::string bytes, const FontOptions& options = {});

    const FontInfo& info() const;
    const std::string& bytes() const;
    const FontOptions& options() const;

    // In font units. Coordinates are exact for TrueType, with the implied points in the middle of two others,
    // but those of instances of variable fonts and of scaled components, which FreeType rounds to 1/64 of a
    // unit; CFF has whole units, fractions are cut off. Empty of a space. Refuses (out_of_domain) what is no
    // index, (unreadable) damaged outlines, (limit) what takes more memory than allowed or too much work.
    Result<Glyph> glyph(int index) const;

    int index_of(char32_t character) const;                       // 0: the font has none
    std::optional<int> index_named(std::string_view name) const;  // "uni0041", "Aacute"
    std::string name_of(int index) const;                         // empty where the font has no names
    std::vector<std::pair<char32_t, int>> characters() const;     // with their glyphs, in order

private:
    struct State;
    explicit Font(std::shared_ptr<State> state) : state_(std::move(state)) {}
    std::shared_ptr<State> state_;
};

// The file of an installed font by its family, as fontconfig knows it: "DejaVu Sans", "DejaVu Sans:bold".
// Refuses (no_answer) families that are not installed; never another one instead.
struct FontFile {
    std::string path;
    int face = 0;
};
Result<FontFile> font_file(const std::string& family);

}  // namespace freiform
