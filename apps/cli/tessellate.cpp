// tessellate: a file to a mesh within a tolerance, and a report of what was reached.
#include "input.hpp"
#include "progress.hpp"
#include "tessellate_report.hpp"
#include "words.hpp"

#include <freiform/io/mesh_file.hpp>
#include <freiform/io/scene.hpp>

#include <algorithm>
#include <numbers>

namespace freiform::cli {

namespace {

struct TessellateArguments {
    std::string file, object;
    std::vector<double> tolerances;
    std::optional<double> max_edge, angle, aspect;
    bool quads = false;
    SewArguments sew;
};

// The most that a point moves when its coordinates become floats.
double float_rounding(const TriangleMesh& mesh) {
    double most = 0;
    for (const Vec<3>& p : mesh.points) {
        Vec<3> d;
        for (int i = 0; i < 3; ++i) d[i] = double(float(p[i])) - p[i];
        most = std::max(most, norm(d));
    }
    return most;
}

// The name of the file for one of several tolerances.
std::string named_by(const std::string& pattern, double tolerance) {
    std::string name = pattern;
    const std::size_t at = name.find('%');
    if (at != std::string::npos) name.replace(at, 1, text(tolerance));
    return name;
}

std::vector<double> tolerances_of(const Model& model, const TessellateArguments& options) {
    if (!options.tolerances.empty()) return options.tolerances;
    const double part = summary(model).box.diagonal() / 1000;
    remark(text("tolerance ", part, model.unit.empty() ? "" : " ", model.unit,
                ", a thousandth of the model's box"));
    return {part};
}

Result<void> is_of_use(const Result<Tessellation>& t, double timeout) {
    if (!t && t.error().where == "progress")
        return refuse(RefusalKind::limit, "--timeout", text("more than ", timeout, " seconds are needed"));
    if (!t) return std::unexpected(t.error());
    if (!t->mesh.triangles.empty() || t->refused.empty()) return {};
    const RefusedFace& first = t->refused[0];
    return refuse(first.reason.kind == RefusalKind::limit ? RefusalKind::limit : RefusalKind::no_answer,
                  text("faces[", first.face, "].", first.reason.where),
                  text("no face could be meshed: ", first.reason.message));
}

// What is missing in the mesh, in one sentence; empty where nothing is.
std::string missing(const Tessellation& t, const Model& model) {
    std::size_t n = t.refused.size();
    std::string first;
    if (n > 0) first = text("face ", t.refused[0].face, ": ", t.refused[0].reason.message);
    for (const Refusal& r : model.refused)
        if (is_face(r) && n++ == 0) first = text(r.where, ": ", r.message);
    if (n == 0) return {};
    return text("the mesh is without ",
                n == 1 ? "one face that was refused: " : text(n, " faces that were refused; the first: "),
                first);
}

Result<void> run_tessellate(Context& context, const TessellateArguments& options) {
    const double start = now();
    // The mesh may go to standard output; then the report does not.
    const std::string output = context.output;
    std::optional<MeshFormat> format;
    if (!context.to.empty() || (!output.empty() && output != "-")) {
        auto known = mesh_format(context.to.empty() ? output : context.to);
        if (!known) wrong_usage(known.error().message);
        format = *known;
    } else if (output == "-") {
        wrong_usage("-o - needs --to glb, stl, obj or ply");
    }
    if (std::ranges::any_of(options.tolerances, [](double t) { return !(t > 0); }))
        wrong_usage("--tolerance needs positive numbers");
    if (options.aspect && !(*options.aspect > 1)) wrong_usage("--aspect needs a number above 1");
    if (options.tolerances.size() > 1 && !output.empty() && output.find('%') == std::string::npos)
        wrong_usage("several tolerances need a % in the name of the output, such as -o part-%.glb");
    if (output == "-" && context.json) wrong_usage("--json and -o - both want standard output");

    const auto input = read_input(context, options.file, options.object);
    if (!input) return std::unexpected(input.error());
    auto model = scene_of(*input->document, input->chosen);
    if (!model) return std::unexpected(model.error());
    const double read = now() - start;
    const auto sewing = sewn(*model, options.sew);
    if (!sewing) return std::unexpected(sewing.error());
    if (*sewing) *model = (*sewing)->model;
    const double sew = now() - start - read;

    Progress bar("tessellate");
    const double deadline = context.limits.timeout > 0 ? start + context.limits.timeout : 0;
    const auto progress = [&](double part) {
        bar(part);
        return deadline == 0 || now() < deadline;
    };
    std::vector<TessellateOptions> all;
    for (const double tolerance : tolerances_of(*model, options)) {
        TessellateOptions how;
        how.tolerance = tolerance;
        if (options.max_edge) how.max_edge = *options.max_edge;
        if (options.angle) how.max_angle = *options.angle * (std::numbers::pi / 180);
        if (options.aspect) how.max_aspect = *options.aspect;
        how.quads = options.quads;
        how.as_planes = true;  // what is written has no parameters
        how.max_triangles = (long long)(context.limits.max_triangles);
        how.progress = progress;
        all.push_back(how);
    }
    const auto results = tessellate(*model, all);
    for (const auto& t : results)
        if (auto ok = is_of_use(t, context.limits.timeout); !ok) return ok;

    json::Writer w;
    std::string said;
    if (results.size() > 1) w.begin_object().key("runs").begin_array();
    for (std::size_t i = 0; i < results.size(); ++i) {
        const TriangleMesh& mesh = results[i]->mesh;
        TessellateReport report{*results[i], *model, *sewing,      all[i], named_by(output, all[i].tolerance),
                                0,           {},     options.angle};
        const double written = now();
        if (!output.empty()) {
            if (format == MeshFormat::glb) remark_unknown_unit(mesh.unit, "glb");
            if (auto ok = write_mesh(mesh, report.output, format); !ok) return ok;
            if (format == MeshFormat::glb || format == MeshFormat::stl)
                report.rounding = float_rounding(mesh);
        }
        if (const std::string without = missing(*results[i], *model); !without.empty()) {
            remark(without);
            context.in_part = true;
        }
        report.seconds = {read, sew, now() - written, now() - start};
        if (output == "-") return {};
        if (context.json)
            write_report(w, report);
        else
            said += report_text(report);
    }
    if (results.size() > 1) w.end_array().end_object();
    context.output.clear();  // the report goes to standard output
    return emit(context, context.json ? w.take() + "\n" : said);
}

}  // namespace

void add_tessellate(CommandLine& line) {
    const auto options = std::make_shared<TessellateArguments>();
    const Command command =
        line.add("tessellate", "Triangles within a tolerance, watertight where the model is closed",
                 "  freiform tessellate teapot.bpt --tolerance 0.01 -o teapot.glb\n"
                 "  freiform tessellate part.step --tolerance 0.05 -o part.stl --json\n"
                 "  freiform tessellate part.step --tolerance 1,0.1,0.01 -o part-%.glb\n"
                 "  freiform tessellate part.iges --sew 0.001 --angle 15 -o part.stl\n"
                 "  freiform tessellate part.step --tolerance 0.05 --quads -o part.obj\n"
                 "  freiform tessellate part.step --tolerance 0.05 --to ply -o - > part.ply\n"
                 "\n"
                 "Faces that cannot be done are named in the report (\"refused\"); the others are meshed, "
                 "and the exit\n"
                 "code is 1.");
    command.file(options->file);
    command.numbers(
        "--tolerance", options->tolerances,
        "The largest distance between mesh and model, in the file's unit (default: a thousandth of its box); "
        "several give a mesh each, with a % in the name of the output");
    command.positive("--max-edge", options->max_edge,
                     "The longest side of a triangle, in the file's unit (default: none)");
    command.positive(
        "--angle", options->angle,
        "The largest angle between a triangle and normals of its part of the surface, in degrees "
        "(default: none)");
    command.number(
        "--aspect", options->aspect,
        "An aim: points inside faces lie in boxes at most so much longer than wide (default: none)");
    command.flag(
        "--quads", options->quads,
        "Quads along parameter lines inside faces, from edge to edge in faces that are rectangles of "
        "parameters; .obj and .ply keep them, .stl and .glb have their halves");
    options->sew.add_to(command);
    command.object(options->object);
    command.output("The mesh: .glb, .stl, .obj or .ply");
    command.limits();
    command.triangle_limit();
    command.action(options, run_tessellate);
}

}  // namespace freiform::cli
