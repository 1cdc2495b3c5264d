// text: a line of text as outlines, a picture, or solids.
#include "drawing_bytes.hpp"
#include "fonts.hpp"
#include "solids.hpp"

#include <freiform/core/scan.hpp>
#include <freiform/io/document.hpp>
#include <freiform/io/svg.hpp>
#include <freiform/model/swept_solid.hpp>
#include <freiform/region/boolean.hpp>

#if FREIFORM_HAS_FONT
#include <freiform/font/typeset.hpp>
#endif

#include <numbers>

namespace freiform::cli {

namespace {

struct TextArguments {
    std::string words, language = "und";
    FontArguments font;
    std::vector<std::string> features;
    std::optional<double> size, extrude, angle, tolerance;
    std::vector<double> revolve;

    bool solid() const { return extrude || !revolve.empty(); }
};

#if FREIFORM_HAS_FONT

struct Letters {
    Typeset set;
    std::vector<Path> paths;         // of the glyphs
    std::vector<std::string> names;  // likewise
    double width = 0, top = 0, bottom = 0;
};

Box<2> box_of(const std::vector<Path>& paths) {
    Box<2> box;
    for (const Path& path : paths)
        for (const Subpath& s : path.subpaths)
            for (const PathSegment& segment : s.segments)
                for (int i = 0; i <= segment.degree; ++i) box.add(segment.points[std::size_t(i)]);
    return box;
}

// What is seen, and the lines as wide and high as they are set.
Box<2> view_of(const Letters& letters) {
    Box<2> box = box_of(letters.paths);
    box.add(Vec<2>{{0, letters.bottom}});
    box.add(Vec<2>{{letters.width, letters.top}});
    return box;
}

Result<Letters> letters_of(const Context& context, const TextArguments& options) {
    const double size = options.size.value_or(72);
    const auto font = read_font(context, options.font);
    if (!font) return std::unexpected(font.error());
    std::vector<std::string> features;
    for (std::string_view all : options.features)
        while (!all.empty()) features.emplace_back(next_part(all, ','));
    auto set = typeset(*font, options.words, {size, features, options.language});
    if (!set) return std::unexpected(set.error());
    auto paths = outlines(*font, *set, size);
    if (!paths) return std::unexpected(paths.error());
    Letters letters{*std::move(set), *std::move(paths), {}, 0, 0, 0};
    for (const PlacedGlyph& g : letters.set.glyphs) letters.names.push_back(font->name_of(g.index));
    const double unit = size / font->info().units_per_em;
    letters.width = letters.set.width, letters.top = unit * font->info().ascender;
    letters.bottom = unit * (font->info().descender - (letters.set.lines - 1) * font->info().line_step);
    for (const Refusal& r : letters.set.missing) remark(text(r.where, ": ", r.message));
    return letters;
}

SvgPicture picture_of(const Letters& letters) {
    SvgPicture picture;
    picture.view = view_of(letters);
    for (std::size_t i = 0; i < letters.paths.size(); ++i) {
        if (letters.paths[i].subpaths.empty()) continue;
        const std::string& name = letters.names[i];
        SvgShape shape;
        shape.id = text(i, name.empty() ? "" : ".", name), shape.element = "path",
        shape.path = letters.paths[i];
        picture.shapes.push_back(std::move(shape));
    }
    return picture;
}

// A unit is a pixel; y down.
Drawing drawing_of(const Letters& letters, const std::string& title) {
    const Box<2> view = view_of(letters);
    Drawing d;
    d.width = int(std::clamp(std::ceil(view.side(0).length()), 1.0, 1e6));
    d.height = int(std::clamp(std::ceil(view.side(1).length()), 1.0, 1e6));
    d.origin = {{-view.lo[0], view.hi[1]}}, d.title = title;
    const auto place = [&](const Vec<2>& p) { return Vec<2>{{d.origin[0] + p[0], d.origin[1] - p[1]}}; };
    for (std::size_t i = 0; i < letters.paths.size(); ++i) {
        DrawnGroup group{letters.names[i], "glyph", {0, 0, 0, 1}, 0, {}, {}, {}};
        group.area = true;
        for (const Subpath& s : letters.paths[i].subpaths) {
            DrawnPath path{place(s.start), {}, true};
            for (const PathSegment& segment : s.segments) {
                DrawnSegment drawn{segment.degree, {}};
                for (std::size_t k = 0; k < std::size_t(segment.degree); ++k)
                    drawn.points[k] = place(segment.points[k + 1]);
                path.segments.push_back(drawn);
            }
            group.paths.push_back(std::move(path));
        }
        if (!group.paths.empty()) d.groups.push_back(std::move(group));
    }
    return d;
}

struct LetterSolids {
    Document document;
    double outline_bound = 0;  // by which uniting contours that overlap moved outlines
};

Result<LetterSolids> solids_of(const Letters& letters, const TextArguments& options) {
    LetterSolids out;
    // Contours that nothing crosses keep their numbers; the others are cut where they meet.
    const double accuracy = 1e-6 * options.size.value_or(72);
    for (std::size_t i = 0; i < letters.paths.size(); ++i) {
        if (letters.paths[i].subpaths.empty()) continue;
        const std::string name = text(i, letters.names[i].empty() ? "" : ".", letters.names[i]);
        const auto whole = region_of({letters.paths[i]}, {.tolerance = accuracy});
        if (!whole) return refuse_within(text("glyph ", name), whole.error());
        const RegionLoops loops = loops_of(whole->path);
        if (loops.empty()) continue;
        out.outline_bound = std::max(out.outline_bound, whole->bound);
        const auto& r = options.revolve;
        auto model = options.extrude
                         ? prism(loops, {{0, 0, *options.extrude}})
                         : solid_of_revolution(loops, {{{r[0], r[1], 0}}, {{r[2], r[3], 0}}},
                                               options.angle.value_or(360) / 180 * std::numbers::pi);
        if (!model) return refuse_within(text("glyph ", name), model.error());
        out.document.objects.push_back({name, *std::move(model)});
    }
    if (out.document.objects.empty())
        return refuse(RefusalKind::no_answer, "text", "there is nothing to see in it");
    return out;
}

Result<void> run_text(const Context& context, const TextArguments& options) {
    if (options.extrude && !options.revolve.empty()) wrong_usage("either --extrude or --revolve");
    if (!options.revolve.empty() && options.revolve.size() != 4)
        wrong_usage("--revolve needs four numbers: a point and a direction, PX,PY,DX,DY");
    if (!options.revolve.empty()) require_direction("--revolve", std::span(options.revolve).last(2));
    if (options.extrude == 0.0) wrong_usage("--extrude needs a height that is not 0");
    SolidOutput solid;
    const std::string format = output_ending(context, options.solid() ? "json" : "svg");
    if (options.solid())
        solid = solid_output(context, "text", options.tolerance);
    else if (format != "svg" && format != "json" && format != "pdf" && format != "png")
        wrong_usage(
            text("text writes .svg, .json, .pdf and .png, not \"", format,
                 "\"; solids (--extrude, --revolve) go to .json, .step, .iges, .glb, .stl, .obj and .ply"));
    const auto letters = letters_of(context, options);
    if (!letters) return std::unexpected(letters.error());
    json::Writer w;
    w.begin_object().field("glyphs", letters->set.glyphs.size()).field("lines", letters->set.lines);
    w.field("width", letters->set.width).key("missing").begin_array();
    for (const Refusal& r : letters->set.missing) w.value(r.message);
    w.end_array();
    std::string said =
        text(letters->set.glyphs.size(), letters->set.glyphs.size() == 1 ? " glyph, " : " glyphs, ",
             letters->set.width, " wide");
    if (options.solid()) {
        const auto document = solids_of(*letters, options);
        if (!document) return std::unexpected(document.error());
        w.field("outline_bound", document->outline_bound);
        return emit_solids(context, solid, document->document, w, said);
    }
    const SvgPicture picture = picture_of(*letters);
    const auto bytes = format == "svg" ? Result<std::string>(write_svg(picture))
                       : format == "json"
                           ? Result<std::string>(write_document(document_of(picture)))
                           : drawing_bytes(drawing_of(*letters, options.words), format, "text");
    if (!bytes) return std::unexpected(bytes.error());
    if (auto ok = emit(context, *bytes); !ok) return ok;
    w.end_object();
    if (context.output.empty() || context.output == "-") return {};
    return emit({}, (context.json ? w.take() : said) + "\n");
}

#else

Result<void> run_text(const Context&, const TextArguments&) {
    return refuse(RefusalKind::unavailable, "text",
                  "this program was built without fonts: install libfreetype-dev, libharfbuzz-dev and "
                  "libfontconfig-dev and build again");
}

#endif

}  // namespace

void add_text(CommandLine& line) {
    const auto options = std::make_shared<TextArguments>();
    const Command command = line.add(
        "text", "Text as outlines of a font: exact curves, pictures, solids",
        "  freiform text \"Hello\" --font \"DejaVu Sans\" --size 72 -o hello.svg\n"
        "  freiform text \"Affinity\" --font font.otf --features -liga,ss01 -o word.json\n"
        "  freiform text \"Bold\" --font variable.ttf --axis wght=700 -o bold.pdf\n"
        "  freiform text \"Sign\" --font \"DejaVu Sans\" --size 20 --extrude 3 --tolerance 0.01 -o sign.stl\n"
        "  freiform text \"Ring\" --font \"DejaVu Sans\" --revolve 0,-50,1,0 -o ring.glb\n"
        "The first base line runs from 0,0 along x. Kerning, ligatures and scripts that run from right to "
        "left "
        "are\nset as the font says; a line has one direction. Of solids, contours that overlap are united, "
        "within a\nmillionth of the size.");
    command.word("TEXT", options->words, "What to set; \\n begins a new line").required();
    command
        .word("--font", options->font.font,
              "A file, or the family of an installed font (\"DejaVu Sans:bold\")")
        .required();
    command.positive("--size", options->size,
                     "Of an em, in units of the output; of pictures pixels (default 72)");
    command.words("--axis", options->font.axes, "Axes of a variable font: wght=700,wdth=80")
        .shown_as("TAG=VALUE");
    command.count("--face", options->font.face, 0, 65535, "Which font of a collection (default 0)");
    command.words("--features", options->features, "OpenType features: -liga,ss01,kern=0");
    command.word("--language", options->language, "Of the text: tr, sr, ..");
    command.number("--extrude", options->extrude, "Solids of this height along z");
    command.numbers("--revolve", options->revolve, "Solids of revolution about this axis in the plane")
        .shown_as("PX,PY,DX,DY");
    command.number("--angle", options->angle, "Degrees of the revolution (default 360)");
    command.positive(
        "--tolerance", options->tolerance,
        "The largest distance of triangles from the solids (default: a thousandth of their box)");
    command.output(
        "The file to write: .svg, .json, .pdf, .png; of solids .json, .step, .iges, .glb, .stl, .obj, .ply");
    command.limits();
    command.triangle_limit();
    command.action(options, run_text);
}

}  // namespace freiform::cli
