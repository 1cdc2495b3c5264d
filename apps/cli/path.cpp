// path: what plane paths fill and what strokes cover, as paths: union, intersection, difference, exclusion,
// stroke, offset, simplify.
#include "input.hpp"

#include <freiform/io/document.hpp>
#include <freiform/io/file.hpp>
#include <freiform/io/svg.hpp>
#include <freiform/path/simplify.hpp>
#include <freiform/region/stroke.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>

namespace freiform::cli {

namespace {

struct PathArguments {
    std::string operation;
    std::vector<std::string> files, objects;
    std::optional<double> tolerance, distance, width, miter_limit, dash_offset;
    std::string cap, join, rule;
    std::vector<double> dashes;
};

constexpr std::string_view kPathOperations[] = {"union",  "intersection", "difference", "exclusion",
                                                "stroke", "offset",       "simplify"};
// Those that change each shape by itself.
bool changes_each(std::string_view operation) {
    return operation == "stroke" || operation == "offset" || operation == "simplify";
}
constexpr std::string_view kCapNames[] = {"butt", "round", "square"},
                           kJoinNames[] = {"miter", "miter-clip", "round", "bevel", "arcs"};

// Shapes, how far they are from what they should be, and the area of those that were made here.
struct Shapes {
    SvgPicture picture;
    double bound = 0, area = 0;
};

Result<Shapes> read_shapes(const Context& context, const std::string& file) {
    if (file != "-" && format_of_name(file) == FileFormat::svg) {
        const auto bytes = read_file(file, context.read_options().max_bytes);
        if (!bytes) return std::unexpected(bytes.error());
        auto picture = read_svg(*bytes);
        if (!picture) return refuse_within(shown(file), picture.error());
        for (const Refusal& r : picture->left_out) remark(text(shown(file), ": ", r.where, ": ", r.message));
        return Shapes{*std::move(picture), 0, 0};
    }
    const auto input = read_input(context, file, "");
    if (!input) return std::unexpected(input.error());
    Box<2> box;
    for (const Object& o : input->document->objects)
        with_curve(o.shape, [&](const auto& curve) {
            if constexpr (Space<typename std::remove_cvref_t<decltype(curve)>::Coefficients>::kDim == 2)
                for (const Vec<2>& p : points(curve)) box.add(p);
        });
    auto picture = picture_of(*input->document, std::max(1e-9 * box.diagonal(), 0x1p-1000));
    if (!picture) return refuse_within(shown(file), picture.error());
    return Shapes{std::move(picture->picture), picture->bound, 0};
}

Box<2> box_of_shape(const Path& path) {
    Box<2> box;
    for (const Subpath& s : path.subpaths)
        for (const PathSegment& segment : s.segments)
            for (int i = 0; i <= segment.degree; ++i) box.add(segment.points[std::size_t(i)]);
    return box;
}

// Those that --objects names, in that order; without it all.
Result<void> choose(SvgPicture& picture, const std::vector<std::string>& names) {
    if (names.empty()) return {};
    std::vector<SvgShape> chosen;
    for (const std::string& name : names) {
        const auto found = std::ranges::find(picture.shapes, name, &SvgShape::id);
        if (found == picture.shapes.end())
            return refuse(RefusalKind::no_answer, "--objects", text("there is no shape \"", name, "\""));
        chosen.push_back(*found);
    }
    picture.shapes = std::move(chosen);
    return {};
}

// What a refusal says of shapes is "path 3" for the third one, or its id.
std::string name_of_shape(std::span<const SvgShape> shapes, std::size_t i) {
    return shapes[i].id.empty() ? text(shapes[i].element, " ", i + 1) : shapes[i].id;
}

// "a.subpaths[7]" of loops that come from several shapes, as these.
std::string with_shapes_named(std::string said, std::span<const SvgShape> shapes,
                              std::span<const std::size_t> shape_of_loop) {
    constexpr std::string_view kLoop = "a.subpaths[";
    std::size_t at = 0;
    while ((at = said.find(kLoop, at)) != std::string::npos) {
        const std::size_t digits = at + kLoop.size(), end = said.find(']', digits);
        std::size_t loop = shape_of_loop.size();
        std::from_chars(said.data() + digits, said.data() + std::min(end, said.size()), loop);
        if (end == std::string::npos || loop >= shape_of_loop.size()) break;
        const std::string name = name_of_shape(shapes, shape_of_loop[loop]);
        const auto first = std::ranges::find(shape_of_loop, shape_of_loop[loop]) - shape_of_loop.begin();
        const std::string named = text(name, ": loops[", loop - std::size_t(first), "]");
        said.replace(at, end + 1 - at, named);
        at += named.size();
    }
    return said;
}

// Several shapes as one region.
Result<Region> united(std::span<const SvgShape> shapes, const RegionOptions& options) {
    Path all;
    std::vector<std::size_t> shape_of_loop;
    double bound = 0;
    for (std::size_t i = 0; i < shapes.size(); ++i) {
        const SvgShape& s = shapes[i];
        auto one = region_of({s.path, s.fill_rule}, options);
        if (!one) return refuse_within(name_of_shape(shapes, i), one.error());
        bound = std::max(bound, one->bound);
        for (Subpath& loop : one->path.subpaths)
            all.subpaths.push_back(std::move(loop)), shape_of_loop.push_back(i);
    }
    if (shapes.size() < 2) return Region{std::move(all), bound};
    auto out = region_of({all}, options);
    if (!out)
        return refuse(out.error().kind, with_shapes_named(out.error().where, shapes, shape_of_loop),
                      with_shapes_named(out.error().message, shapes, shape_of_loop));
    out->bound += bound;
    return out;
}

// One file: its shapes, one after the other. Two files: what each of them fills.
Result<Region> combined(const std::vector<Shapes>& files, RegionOperation operation, RegionOptions options) {
    std::vector<std::span<const SvgShape>> operands;
    if (files.size() == 2)
        for (const Shapes& f : files) operands.push_back(f.picture.shapes);
    else
        for (const SvgShape& s : files[0].picture.shapes) operands.push_back(std::span(&s, 1));
    if (operands.empty()) return refuse(RefusalKind::no_answer, "", "there is no shape");
    if (operation == RegionOperation::union_of && files.size() == 1) {
        options.tolerance /= 2;
        return united(files[0].picture.shapes, options);
    }
    options.tolerance /= 3 * double(operands.size());
    auto out = united(operands[0], options);
    for (std::size_t i = 1; out && i < operands.size(); ++i) {
        const auto next = united(operands[i], options);
        if (!next) return next;
        const double bound = out->bound + next->bound;
        out = combine({out->path}, {next->path}, operation, options);
        if (out) out->bound += bound;
    }
    return out;
}

StrokeStyle style_of(const SvgShape& shape, const PathArguments& options) {
    StrokeStyle s = shape.line;
    s.width = options.width.value_or(s.width);
    s.miter_limit = options.miter_limit.value_or(s.miter_limit);
    s.dash_offset = options.dash_offset.value_or(s.dash_offset);
    if (!options.dashes.empty()) s.dashes = options.dashes;
    if (!options.cap.empty()) s.cap = LineCap(std::ranges::find(kCapNames, options.cap) - kCapNames);
    if (!options.join.empty()) s.join = LineJoin(std::ranges::find(kJoinNames, options.join) - kJoinNames);
    return s;
}

// Each shape without its stroke, and after it what its stroke covers; or made larger or smaller.
Result<Shapes> each_changed(const Shapes& in, const PathArguments& options, const RegionOptions& region) {
    Shapes out{in.picture, in.bound, 0};
    out.picture.shapes.clear();
    for (const SvgShape& s : in.picture.shapes) {
        SvgShape made = s;
        if (options.operation == "simplify") {
            auto done = simplified(s.path, {.tolerance = region.tolerance});
            if (!done) return refuse_within(s.id.empty() ? s.element : s.id, done.error());
            made.path = std::move(done->path), made.element = "path";
            out.area += signed_area(made.path).value;
            out.bound = std::max(out.bound, in.bound + done->bound);
            out.picture.shapes.push_back(std::move(made));
            continue;
        }
        made.stroke = "none", made.element = "path";
        const bool stroke = options.operation == "stroke";
        if (stroke && s.stroke == "none" && !options.width) {
            out.picture.shapes.push_back(made);
            continue;
        }
        const StrokeStyle style = style_of(s, options);
        OffsetStyle offset{options.distance.value_or(0), options.join.empty() ? LineJoin::round : style.join,
                           options.miter_limit.value_or(4)};
        auto done = stroke ? stroked(s.path, style, region) : grown({s.path, s.fill_rule}, offset, region);
        if (!done) return refuse_within(s.id.empty() ? s.element : s.id, done.error());
        if (stroke && s.fill != "none") out.picture.shapes.push_back(made);
        if (stroke) made.fill = s.stroke == "none" ? "black" : s.stroke;
        if (!stroke && made.fill == "none") made.fill = "black";
        out.area += signed_area(done->path).value;
        made.path = std::move(done->path), made.fill_rule = FillRule::nonzero;
        out.bound = std::max(out.bound, in.bound + done->bound);
        out.picture.shapes.push_back(std::move(made));
    }
    return out;
}

std::string path_report(const Context& context, const PathArguments& options, const Shapes& made,
                        double tolerance) {
    std::size_t loops = 0, segments = 0;
    for (const SvgShape& s : made.picture.shapes)
        for (const Subpath& l : s.path.subpaths) ++loops, segments += l.segments.size();
    json::Writer w;
    w.begin_object().field("operation", options.operation).field("output", context.output);
    w.field("shapes", made.picture.shapes.size()).field("loops", loops).field("segments", segments);
    w.field("area", made.area).field("tolerance", tolerance).field("error_bound", made.bound);
    return w.end_object().take() + "\n";
}

void check_usage(const PathArguments& o) {
    if (std::ranges::find(kPathOperations, o.operation) == std::end(kPathOperations))
        wrong_usage(
            text("path is followed by union, intersection, difference, exclusion, stroke, offset or "
                 "simplify, found \"",
                 o.operation, "\""));
    const bool each = changes_each(o.operation);
    if (o.files.empty() || o.files.size() > (each ? 1u : 2u))
        wrong_usage(text("path ", o.operation, " takes ", each ? "one file" : "one or two files"));
    if (o.files.size() == 2 && !o.objects.empty()) wrong_usage("--objects chooses shapes of one file");
    if (o.tolerance && !(*o.tolerance > 0)) wrong_usage("--tolerance needs a positive number");
    if (o.operation == "offset" && !o.distance)
        wrong_usage("path offset needs --distance, positive or negative");
}

// All files as one shape.
Result<Shapes> one_shape(const std::vector<Shapes>& files, const PathArguments& options,
                         const RegionOptions& region) {
    const auto operation =
        RegionOperation(std::ranges::find(kPathOperations, options.operation) - kPathOperations);
    auto done = combined(files, operation, region);
    if (!done) return std::unexpected(done.error());
    Shapes made{files[0].picture, 0, signed_area(done->path).value};
    SvgShape shape;
    shape.id = options.operation, shape.element = "path";
    for (const Shapes& f : files) {
        made.bound = std::max(made.bound, f.bound);
        if (!f.picture.view.is_empty()) made.picture.view.add(f.picture.view);
        for (const SvgShape& s : f.picture.shapes)
            if (shape.fill == "black" && s.fill != "none") shape.fill = s.fill;
    }
    made.bound += done->bound;
    shape.path = std::move(done->path);
    made.picture.shapes = {std::move(shape)};
    return made;
}

Result<void> run_path(const Context& context, const PathArguments& options) {
    check_usage(options);
    const std::size_t dot = context.output.rfind('.');
    const std::string ending = dot == std::string::npos ? "svg" : context.output.substr(dot + 1),
                      format = context.to.empty() ? ending : context.to;
    if (format != "svg" && format != "json") wrong_usage(text("path writes .svg and .json, not .", format));
    std::vector<Shapes> files;
    Box<2> box;
    for (const std::string& file : options.files) {
        auto read = read_shapes(context, file);
        if (!read) return std::unexpected(read.error());
        if (const auto ok = choose(read->picture, options.objects); !ok) return ok;
        for (SvgShape& s : read->picture.shapes) {
            if (!options.rule.empty())
                s.fill_rule = options.rule == "evenodd" ? FillRule::evenodd : FillRule::nonzero;
            box.add(box_of_shape(s.path));
        }
        files.push_back(*std::move(read));
    }
    const bool each = changes_each(options.operation);
    const double tolerance = options.tolerance.value_or((each ? 1e-4 : 1e-9) * box.diagonal());
    const RegionOptions region{.tolerance = tolerance};
    auto changed = each ? each_changed(files[0], options, region) : one_shape(files, options, region);
    if (!changed) return std::unexpected(changed.error());
    Shapes& made = *changed;
    if (!made.picture.view.is_empty())
        for (const SvgShape& s : made.picture.shapes) made.picture.view.add(box_of_shape(s.path));
    const std::string bytes =
        format == "svg" ? write_svg(made.picture) : write_document(document_of(made.picture));
    if (auto ok = emit(context, bytes); !ok) return ok;
    if (context.output.empty() || context.output == "-") return {};
    if (context.json) return emit({}, path_report(context, options, made, tolerance));
    remark(text("right to within ", made.bound, ", asked for ", tolerance));
    return {};
}

}  // namespace

void add_path(CommandLine& line) {
    const auto options = std::make_shared<PathArguments>();
    const Command command = line.add(
        "path",
        "Regions that paths fill: union, intersection, difference, exclusion, stroke, offset; simplify",
        "  freiform path union drawing.svg -o one.svg\n"
        "  freiform path difference plate.svg holes.svg -o drilled.svg\n"
        "  freiform path intersection drawing.svg --objects plate eye -o both.svg\n"
        "  freiform path stroke drawing.svg -o outlines.svg\n"
        "  freiform path offset part.svg --distance -0.2 --tolerance 1e-3 -o smaller.svg\n"
        "  freiform path simplify traced.svg --tolerance 0.1 -o few.svg\n"
        "Of one file the shapes are combined one after the other, of two what each of them fills. stroke "
        "and\n"
        "offset change each shape, simplify replaces its segments by fewer cubics.");
    command
        .word("OPERATION", options->operation,
              "union, intersection, difference, exclusion, stroke, offset, simplify")
        .required();
    command.words("FILE", options->files, "One or two drawings (.svg), or documents with plane curves")
        .required();
    command.words("--objects", options->objects, "Only these shapes, by their ids, in this order")
        .shown_as("ID ...");
    command.number(
        "--tolerance", options->tolerance,
        "What the result may be off; 1e-9 of the size of the drawing, otherwise than of regions 1e-4");
    command.word("--fill-rule", options->rule, "Instead of what the drawing says")
        .one_of({"nonzero", "evenodd"});
    command.number("--distance", options->distance, "offset: larger by this, or smaller if it is negative");
    command.number("--width", options->width, "stroke: all shapes with this width");
    command.word("--cap", options->cap, "stroke: ends of lines").one_of({"butt", "round", "square"});
    command.word("--join", options->join, "Corners (offset: round)")
        .one_of({"miter", "miter-clip", "round", "bevel", "arcs"});
    command.number("--miter-limit", options->miter_limit, "Longest miter, in half widths");
    command.numbers("--dashes", options->dashes, "stroke: lengths of dashes and gaps");
    command.number("--dash-offset", options->dash_offset, "stroke: where in the dashes each subpath begins");
    command.output("The result: .svg or .json");
    command.limits();
    command.action(options, run_path);
}

}  // namespace freiform::cli
