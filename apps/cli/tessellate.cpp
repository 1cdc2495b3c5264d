// tessellate: a file to a mesh within a tolerance, and a report of what was reached.
#include "input.hpp"
#include "progress.hpp"
#include "sewing.hpp"
#include "words.hpp"

#include <freiform/io/mesh_file.hpp>
#include <freiform/io/scene.hpp>
#include <freiform/model/tessellate.hpp>

#include <cmath>

namespace freiform::cli {

namespace {

struct TessellateArguments {
    std::string file, object;
    std::optional<double> tolerance, max_edge;
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

struct Times {
    double read = 0, sew = 0, write = 0, total = 0;
};

std::string json_report(const Tessellation& t, const Model& model, const std::optional<Sewing>& sewing,
                        double predicted, double tolerance, const std::string& output, double rounding,
                        const Times& times) {
    json::Writer w;
    w.begin_object();
    w.field("triangles", t.mesh.triangles.size())
        .field("vertices", t.mesh.points.size())
        .field("faces", model.faces.size());
    w.field("open_edges", t.topology.open_edges).field("non_manifold_edges", t.topology.non_manifold_edges);
    w.field("error_bound", t.error_bound).field("boundary_gap", t.boundary_gap);
    w.field("degenerate_triangles", t.topology.degenerate_triangles);
    w.field("predicted_triangles", std::ceil(predicted));
    w.field("tolerance", tolerance).field("unit", model.unit);
    if (!output.empty()) w.field("output", output).field("storage_rounding", rounding);
    if (sewing) write_sewing(w, *sewing);
    w.key("seconds").begin_object();
    w.field("read", times.read).field("edges", t.seconds.edges).field("faces", t.seconds.faces);
    if (sewing) w.field("sew", times.sew);
    w.field("write", times.write).field("total", times.total).end_object();
    w.key("refused").begin_array();
    for (const RefusedFace& r : t.refused)
        w.begin_object()
            .field("face", r.face)
            .field("name", r.name)
            .field("kind", name_of(r.reason.kind))
            .field("where", r.reason.where)
            .field("message", r.reason.message)
            .end_object();
    for (const Refusal& r : model.refused)
        w.begin_object()
            .field("face", r.where)
            .field("kind", name_of(r.kind))
            .field("where", r.where)
            .field("message", r.message)
            .end_object();
    w.end_array().key("approximations").begin_array();
    for (const Approximation& a : model.approximations) write_approximation(w, a);
    w.end_array().end_object();
    return w.take() + "\n";
}

std::string text_report(const Tessellation& t, const Model& model, const std::optional<Sewing>& sewing,
                        double tolerance, const std::string& output, double rounding, const Times& times) {
    std::string s = text(t.mesh.triangles.size(), " triangles, ", t.mesh.points.size(), " points, ",
                         model.faces.size(), " faces\n");
    s += text("open edges      ", t.topology.open_edges, "\n");
    if (t.topology.non_manifold_edges > 0) s += text("non-manifold    ", t.topology.non_manifold_edges, "\n");
    if (t.topology.degenerate_triangles > 0)
        s += text("degenerate      ", t.topology.degenerate_triangles, "\n");
    s += text("error bound     ", t.error_bound, " (tolerance ", tolerance, model.unit.empty() ? "" : " ",
              model.unit, ")\n");
    s += text("boundary gap    ", t.boundary_gap, " (of the model itself)\n");
    if (rounding > 0) s += text("stored as float ", rounding, " more\n");
    if (sewing) s += sewing_text(*sewing, model.unit);
    s += text("seconds         ", times.total, "\n");
    for (const RefusedFace& r : t.refused)
        s += text("refused face ", r.face, r.name.empty() ? "" : text(" '", r.name, "'"), ": ",
                  r.reason.where, ": ", r.reason.message, "\n");
    for (const Refusal& r : model.refused) s += text("refused ", r.where, ": ", r.message, "\n");
    for (const Approximation& a : model.approximations)
        s += text("approximated ", approximation_text(a), "\n");
    if (!output.empty()) s += text("written to ", output, "\n");
    return s;
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
    if (output == "-" && context.json) wrong_usage("--json and -o - both want standard output");

    const auto input = read_input(context, options.file, options.object);
    if (!input) return std::unexpected(input.error());
    auto model = scene_of(*input->document, input->chosen);
    if (!model) return std::unexpected(model.error());
    Times times;
    times.read = now() - start;
    const auto sewing = sewn(*model, options.sew);
    if (!sewing) return std::unexpected(sewing.error());
    if (*sewing) *model = (*sewing)->model;
    times.sew = now() - start - times.read;

    TessellateOptions how;
    how.tolerance = options.tolerance.value_or(0);
    if (!options.tolerance) {
        how.tolerance = summary(*model).box.diagonal() / 1000;
        remark(text("tolerance ", how.tolerance, model->unit.empty() ? "" : " ", model->unit,
                    ", a thousandth of the model's box"));
    }
    if (options.max_edge) how.max_edge = *options.max_edge;
    how.max_triangles = (long long)(context.limits.max_triangles);
    Progress bar("tessellate");
    const double deadline = context.limits.timeout > 0 ? start + context.limits.timeout : 0;
    how.progress = [&](double part) {
        bar(part);
        return deadline == 0 || now() < deadline;
    };
    auto t = tessellate(*model, how);
    if (!t) {
        if (t.error().where == "progress")
            return refuse(RefusalKind::limit, "--timeout",
                          text("more than ", context.limits.timeout, " seconds are needed"));
        return std::unexpected(t.error());
    }
    if (t->mesh.triangles.empty() && !t->refused.empty())
        return refuse(
            t->refused[0].reason.kind == RefusalKind::limit ? RefusalKind::limit : RefusalKind::no_answer,
            text("faces[", t->refused[0].face, "].", t->refused[0].reason.where),
            text("no face could be meshed: ", t->refused[0].reason.message));
    const double written = now();
    double rounding = 0;
    if (!output.empty()) {
        if (auto ok = write_mesh(t->mesh, output, format); !ok) return ok;
        if (format == MeshFormat::glb || format == MeshFormat::stl) rounding = float_rounding(t->mesh);
    }
    times.write = now() - written;
    times.total = now() - start;
    if (output == "-") return {};
    context.output.clear();  // the report goes to standard output
    return emit(context, context.json
                             ? json_report(*t, *model, *sewing, predicted_triangles(*model, how),
                                           how.tolerance, output, rounding, times)
                             : text_report(*t, *model, *sewing, how.tolerance, output, rounding, times));
}

}  // namespace

void add_tessellate(CommandLine& line) {
    const auto options = std::make_shared<TessellateArguments>();
    const Command command =
        line.add("tessellate", "Triangles within a tolerance, watertight where the model is closed",
                 "  freiform tessellate teapot.bpt --tolerance 0.01 -o teapot.glb\n"
                 "  freiform tessellate part.step --tolerance 0.05 -o part.stl --json\n"
                 "  freiform tessellate part.step --tolerance 0.05 --to ply -o - > part.ply");
    command.file(options->file);
    command.number(
        "--tolerance", options->tolerance,
        "The largest distance between mesh and model, in the file's unit (default: a thousandth of its box)");
    command.number("--max-edge", options->max_edge,
                   "The longest side of a triangle, in the file's unit (default: none)");
    options->sew.add_to(command);
    command.object(options->object);
    command.output("The mesh: .glb, .stl, .obj or .ply");
    command.limits();
    command.triangle_limit();
    command.action(options, run_tessellate);
}

}  // namespace freiform::cli
