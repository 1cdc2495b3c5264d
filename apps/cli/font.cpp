// font: what a font contains, and its glyphs one by one.
#include "fonts.hpp"

#include <freiform/core/scan.hpp>
#include <freiform/core/spelling.hpp>
#include <freiform/io/document.hpp>
#include <freiform/io/svg.hpp>

namespace freiform::cli {

namespace {

struct FontCommand {
    FontArguments font;
    std::string glyph;
};

#if FREIFORM_HAS_FONT

// "U+0041", a name, or an index.
Result<int> glyph_of(const Font& font, const std::string& word) {
    if (word.starts_with("U+") || word.starts_with("u+")) {
        unsigned c = 0;
        const auto [end, error] = std::from_chars(word.data() + 2, word.data() + word.size(), c, 16);
        if (error != std::errc() || end != word.data() + word.size() || c > 0x10ffff)
            wrong_usage(
                text("--glyph needs a code point such as U+0041, a name or an index, found \"", word, "\""));
        if (const int index = font.index_of(char32_t(c))) return index;
        return refuse(RefusalKind::no_answer, "--glyph", text("the font has no glyph for ", word));
    }
    if (const auto named = font.index_named(word)) return *named;
    if (const auto index = scan_number<int>(word)) return *index;
    return refuse(RefusalKind::no_answer, "--glyph",
                  text("there is no glyph \"", word, "\"; a code point is written U+0041, an index 0 to ",
                       font.info().glyphs - 1));
}

std::string font_json(const Font& font) {
    const FontInfo& f = font.info();
    json::Writer w;
    w.begin_object().field("family", f.family).field("style", f.style).field("format", f.format);
    w.field("faces", f.faces).field("glyphs", f.glyphs).field("characters", font.characters().size());
    w.field("units_per_em", f.units_per_em).field("ascender", f.ascender).field("descender", f.descender);
    w.field("line_step", f.line_step).key("axes").begin_array();
    for (std::size_t i = 0; i < f.axes.size(); ++i) {
        const FontAxis& a = f.axes[i];
        w.begin_object().field("tag", a.tag).field("name", a.name).field("least", a.least);
        w.field("usual", a.usual).field("most", a.most).field("at", f.at[i]).end_object();
    }
    w.end_array().end_object();
    return w.take() + "\n";
}

std::string font_text(const Font& font, const std::string& file) {
    const FontInfo& f = font.info();
    std::string s = text(file, ": ", f.family, " ", f.style, ", ", f.format, "\n");
    if (f.faces > 1) s += text("  faces       ", f.faces, "\n");
    s += text("  glyphs      ", f.glyphs, ", for ", font.characters().size(), " characters\n");
    s += text("  units       ", f.units_per_em, " per em, ", f.ascender, " above and ", -f.descender,
              " below the base line, lines ", f.line_step, " apart\n");
    for (std::size_t i = 0; i < f.axes.size(); ++i)
        s += text("  axis ", f.axes[i].tag, "   ", f.axes[i].name, ", ", f.axes[i].least, " to ",
                  f.axes[i].most, ", usually ", f.axes[i].usual, ", here ", f.at[i], "\n");
    return s;
}

std::string glyph_json(const Font& font, int index, const Glyph& glyph) {
    std::size_t segments = 0;
    for (const Subpath& s : glyph.path.subpaths) segments += s.segments.size();
    json::Writer w;
    w.begin_object().field("index", index).field("name", font.name_of(index)).field("advance", glyph.advance);
    w.field("contours", glyph.path.subpaths.size()).field("segments", segments);
    w.field("path", path_data(glyph.path)).end_object();
    return w.take() + "\n";
}

Result<void> run_font(const Context& context, const FontCommand& options) {
    const auto font = read_font(context, options.font);
    if (!font) return std::unexpected(font.error());
    if (options.glyph.empty())
        return emit(context, context.json ? font_json(*font) : font_text(*font, shown(options.font.font)));
    const auto index = glyph_of(*font, options.glyph);
    if (!index) return std::unexpected(index.error());
    const auto glyph = font->glyph(*index);
    if (!glyph) return std::unexpected(glyph.error());
    const std::string name = font->name_of(*index);
    return emit(context, context.json ? glyph_json(*font, *index, *glyph)
                                      : text("glyph ", *index, name.empty() ? "" : " ", name, ", advance ",
                                             glyph->advance, "\n", path_data(glyph->path), "\n"));
}

#else

Result<void> run_font(const Context&, const FontCommand&) {
    return refuse(RefusalKind::unavailable, "font",
                  "this program was built without fonts: install libfreetype-dev, libharfbuzz-dev and "
                  "libfontconfig-dev and build again");
}

#endif

}  // namespace

void add_font(CommandLine& line) {
    const auto options = std::make_shared<FontCommand>();
    const Command command = line.add("font", "What a font contains; a glyph as path data in font units, y up",
                                     "  freiform font DejaVuSans.ttf\n"
                                     "  freiform font \"DejaVu Sans\" --glyph U+0041\n"
                                     "  freiform font variable.ttf --axis wght=700 --glyph Aacute --json");
    command.word("FONT", options->font.font, "A file, or the family of an installed font").required();
    command.word("--glyph", options->glyph, "A code point (U+0041), a name or an index");
    command.words("--axis", options->font.axes, "Axes of a variable font: wght=700,wdth=80")
        .shown_as("TAG=VALUE");
    command.count("--face", options->font.face, 0, 65535, "Which font of a collection (default 0)");
    command.answer_file();
    command.limits();
    command.action(options, run_font);
}

}  // namespace freiform::cli
