// convert: from any format to any that can hold it, with changes on the way that leave the shape as it is
// (or, with --reduce, within a bound).
#include "convert_changes.hpp"
#include "input.hpp"

#include <freiform/core/visit.hpp>
#include <freiform/io/bpt.hpp>
#include <freiform/io/document.hpp>
#include <freiform/io/file.hpp>
#include <freiform/io/iges.hpp>
#include <freiform/io/mesh_file.hpp>
#include <freiform/io/obj_freeform.hpp>
#include <freiform/io/step.hpp>
#include <freiform/io/svg.hpp>
#include <freiform/trim/loops.hpp>

namespace freiform::cli {

namespace {

constexpr double kUsualTolerance = 1e-6;  // unless given; of the largest object

struct Report {
    double bound = 0;  // the largest of all objects
    double drawn = 0;  // of what SVG and OBJ have no curve for
    int removed = 0;
    std::vector<std::string> turned;  // loops, as objects[i].loops[j]
};

Result<TrimmedSurface> oriented(const TrimmedSurface& t, const std::string& label, Report& report) {
    const auto sides = visit_one([](const auto& s) { return s.domain(); }, t.surface);
    const double gap = TrimmedSurface::kSlack * std::hypot(sides[0].length(), sides[1].length());
    auto done = orient_loops(t.loops, {gap, gap});
    if (!done) return std::unexpected(done.error());
    for (const std::size_t l : done->reversed) report.turned.push_back(text(label, ": loops[", l, "]"));
    return TrimmedSurface{t.surface, std::move(done->loops)};
}

Result<Document> converted(const Input& input, const ConvertArguments& options, Report& report) {
    const Document& document = *input.document;
    Document out;
    out.unit = document.unit;
    for (const std::size_t i : input.chosen) {
        const Object& o = document.objects[i];
        if (!options.changes()) {
            out.objects.push_back(o);
            if (const auto* t = std::get_if<TrimmedSurface>(&o.shape); t && options.orient_loops) {
                auto turned = oriented(*t, object_label(document, i), report);
                if (!turned) return input.about(i, turned.error());
                out.objects.back().shape = *std::move(turned);
            }
            continue;
        }
        auto made = converted(o.shape, options);
        if (!made) {
            Refusal r = made.error();
            r.where = text(object_label(document, i), r.where.empty() ? "" : ": ", r.where);
            return std::unexpected(std::move(r));
        }
        report.bound = std::max(report.bound, made->bound);
        report.removed += made->removed;
        for (ConvertedPiece& p : made->pieces) {
            const std::string name =
                p.suffix.empty() || !o.name.empty() ? o.name + p.suffix : text(i, p.suffix);
            out.objects.push_back({name, std::move(p.shape), {}});
        }
    }
    return out;
}

std::string output_format(const Context& context) {
    if (!context.to.empty()) return context.to;
    const std::size_t dot = context.output.rfind('.'), slash = context.output.rfind('/');
    if (context.output.empty() || context.output == "-") return "json";
    if (dot == std::string::npos || (slash != std::string::npos && dot < slash)) return "json";
    std::string ending = context.output.substr(dot + 1);
    for (char& c : ending) c = c >= 'A' && c <= 'Z' ? char(c + 32) : c;
    return ending;
}

// The picture with all its styles, where nothing else is asked for.
Result<std::string> svg_again(const Context& context, const ConvertArguments& options, std::size_t& objects) {
    const auto bytes = read_file(options.file, context.read_options().max_bytes);
    if (!bytes) return std::unexpected(bytes.error());
    const auto picture = read_svg(*bytes);
    if (!picture) return std::unexpected(picture.error());
    objects = picture->shapes.size();
    return write_svg(*picture);
}

Result<std::string> written(const Document& document, std::string_view format,
                            const ConvertArguments& options, Report& report) {
    remark_unknown_unit(document.unit, format);
    if (format == "json") return write_document(document);
    if (format == "bpt") return write_bpt(document);
    if (format == "step" || format == "stp") return write_step(document);
    if (format == "iges" || format == "igs") return write_iges(document);
    double size = 0;
    for (const Object& o : document.objects) {
        // Curves and surfaces of models may go on far beyond what is used of them.
        const auto* model = std::get_if<Model>(&o.shape);
        size = std::max(size, model ? summary(*model).box.diagonal() : control_box(o.shape).diagonal);
    }
    const double tolerance = options.tolerance.value_or(size > 0 ? kUsualTolerance * size : 1);
    if (format == "obj") {
        auto obj = write_obj_freeform(document, tolerance);
        if (!obj) return std::unexpected(obj.error());
        report.drawn = obj->bound;
        return std::move(obj->text);
    }
    const auto picture = picture_of(document, tolerance);
    if (!picture) return std::unexpected(picture.error());
    report.drawn = picture->bound;
    return write_svg(picture->picture);
}

// What a reader could not make, which documents name and other formats cannot.
std::vector<Refusal> missing_in(const Document& document) {
    std::vector<Refusal> all;
    for (const Object& o : document.objects)
        if (const auto* model = std::get_if<Model>(&o.shape))
            all.insert(all.end(), model->refused.begin(), model->refused.end());
    return all;
}

// Whether a model has what files of surfaces alone have no room for.
bool has_looks(const Document& document) {
    return std::ranges::any_of(document.objects, [](const Object& o) {
        const auto* m = std::get_if<Model>(&o.shape);
        const auto named = [](const auto& x) { return !x.name.empty() || x.colour; };
        return m && (!m->layers.empty() || std::ranges::any_of(m->bodies, named) ||
                     std::ranges::any_of(m->faces, named));
    });
}

// A file of triangles, as another one.
Result<void> convert_mesh(const Context& context, const ConvertArguments& options, MeshFormat format) {
    if (options.changes() || options.orient_loops || !options.object.empty())
        wrong_usage(
            text(shown(options.file), " has triangles, which no option of convert changes or chooses"));
    const auto mesh = read_mesh(options.file);
    if (!mesh) return std::unexpected(mesh.error());
    const std::string output = context.output.empty() ? "-" : context.output;
    if (auto ok = write_mesh(*mesh, output, format); !ok) return ok;
    if (!context.json || output == "-") return {};
    json::Writer w;
    w.begin_object().field("output", output).field("format", output_format(context));
    w.field("triangles", mesh->triangles.size()).field("vertices", mesh->points.size()).end_object();
    return emit({}, w.take() + "\n");
}

Result<void> run_convert(Context& context, const ConvertArguments& options) {
    if (options.reduce && !(*options.reduce >= 0))
        wrong_usage("--reduce needs a distance that is not negative");
    const std::string format = output_format(context);
    static constexpr std::string_view kFormats[] = {"json", "bpt",  "svg", "step",
                                                    "stp",  "iges", "igs", "obj"};
    if (const auto mesh = mesh_format(format); mesh && is_mesh_file(context, options.file))
        return convert_mesh(context, options, *mesh);
    if (std::ranges::find(kFormats, format) == std::end(kFormats))
        wrong_usage(text(
            "convert writes .json, .bpt, .svg, .step, .iges and (free-form) .obj, not \"", format, "\"",
            format == "stl" || format == "ply" || format == "glb" ? "; freiform tessellate writes triangles"
                                                                  : ""));
    const auto input = read_input(context, options.file, options.object);
    if (!input) return std::unexpected(input.error());
    Report report;
    const bool as_it_is = format == "svg" && options.file != "-" &&
                          format_of_name(options.file) == FileFormat::svg && !options.changes() &&
                          options.object.empty();
    const auto out = converted(*input, options, report);
    if (!out) {
        Refusal r = out.error();
        if (r.where.starts_with("objects[")) r.where = text(shown(options.file), ": ", r.where);
        return std::unexpected(std::move(r));
    }
    std::size_t objects = out->objects.size();
    const auto bytes =
        as_it_is ? svg_again(context, options, objects) : written(*out, format, options, report);
    if (!bytes) {
        Refusal r = bytes.error();
        r.where = text(shown(options.file), ": ", r.where);
        if (r.kind == RefusalKind::unsupported) r.kind = RefusalKind::no_answer;  // the file was read
        return std::unexpected(std::move(r));
    }
    if (auto ok = emit(context, *bytes); !ok) return ok;
    const std::vector<Refusal> missing = missing_in(*out);
    for (const Refusal& r : missing) remark(text(r.where, " is left out: ", r.message));
    if ((format == "iges" || format == "igs") && has_looks(*out))
        remark("names, colours and layers of models are not written to IGES files");
    context.in_part = format != "json" && std::ranges::any_of(missing, is_face);
    if (options.reduce && !context.json)
        remark(text(report.removed, " knots removed, no point moved by more than ", report.bound));
    if (report.drawn > 0 && !context.json)
        remark(text("approximated, no point moved by more than ", report.drawn));
    if (options.orient_loops && !context.json) {
        for (const std::string& loop : report.turned) remark(loop + " turned round");
        if (report.turned.empty()) remark("all loops are turned as they should be");
    }
    if (!context.json || context.output.empty() || context.output == "-") return {};
    json::Writer w;
    w.begin_object().field("output", context.output).field("format", format).field("objects", objects);
    if (format == "svg" || format == "obj") w.field("error_bound", report.drawn);
    if (options.reduce) w.field("removed_knots", report.removed).field("bound", report.bound);
    if (options.orient_loops) {
        w.key("turned_loops").begin_array();
        for (const std::string& loop : report.turned) w.value(loop);
        w.end_array();
    }
    if (!missing.empty()) write_refusals(w, "refused", missing);
    w.end_object();
    return emit({}, w.take() + "\n");
}

}  // namespace

void add_convert(CommandLine& line) {
    const auto options = std::make_shared<ConvertArguments>();
    const Command command = line.add(
        "convert", "Read any known format, write any that can hold it, change splines on the way",
        "  freiform convert teapot.bpt -o teapot.json\n"
        "  freiform convert curve.json --elevate 1 --insert-knots 0.25,0.5 -o finer.json\n"
        "  freiform convert surface.json --to-bezier -o patches.bpt\n"
        "  freiform convert drawing.svg -o drawing.json\n"
        "  freiform convert teapot.bpt -o teapot.step\n"
        "  freiform convert surface.json --split 0.5 --axis v -o halves.json\n"
        "Changes are made in this order: --insert-knots, --elevate, --reduce, --split, "
        "--reverse, --to-bezier.\n"
        "--elevate and --reduce change all directions, --insert-knots, --split and --reverse the "
        "first, unless\n"
        "--axis says which. Of triangles --reduce lowers the degree, --split cuts from a corner to the "
        "opposite\n"
        "edge: --axis u, v or w.");
    command.file(options->file);
    command.output(
        "The file to write: .json, .bpt, .svg, .step, .iges or .obj (free-form); of files of triangles, also "
        "STEP files that have nothing else, .stl, .ply, .glb or .obj");
    command.object(options->object);
    command.flag("--to-bezier", options->to_bezier,
                 "Cut splines into their Bezier pieces, an object for each");
    command.count("--elevate", options->elevate, 0, kMaxDegree, "Raise the degree by N; the shape stays");
    command.numbers("--insert-knots", options->knots, "Insert knots; the shape stays");
    command.number("--reduce", options->reduce,
                   "Remove knots as long as no point moves by more than this; the bound reached is printed");
    command.number("--split", options->split, "Cut at a parameter, an object for each side");
    command.flag("--to-triangles", options->to_triangles,
                 "Cut surfaces into Bezier triangles, two for each piece");
    command.flag("--to-surfaces", options->to_surfaces,
                 "Cut triangles into three surfaces each; others stay");
    command.flag(
        "--orient-loops", options->orient_loops,
        "Turn loops of trimmed surfaces: outer ones counter-clockwise, holes clockwise; says which were "
        "turned");
    command.flag("--reverse", options->reverse, "Run through the parameter backwards");
    command.word("--axis", options->axis, "Which parameter the changes are for").one_of({"u", "v", "w"});
    command.number(
        "--tolerance", options->tolerance,
        "How far what SVG and OBJ have no curve for may be off (default: a millionth of the largest "
        "object); the bound reached is reported");
    command.limits();
    command.action(options, run_convert);
}

}  // namespace freiform::cli
