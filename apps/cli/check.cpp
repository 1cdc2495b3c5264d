// check: how far a mesh, of whatever program, is from the model that it stands for.
#include "input.hpp"
#include "progress.hpp"
#include "shaded.hpp"
#include "words.hpp"

#include <freiform/io/mesh_file.hpp>
#include <freiform/io/scene.hpp>
#include <freiform/mesh/refine.hpp>
#include <freiform/model/deviation.hpp>

#include <cmath>

namespace freiform::cli {

namespace {

struct CheckArguments {
    std::string mesh, model, object, view;
    std::optional<double> tolerance;
    std::optional<int> width, height, parts;
};

constexpr double kColouredSide = 1.0 / 150;  // longest side of a coloured triangle, of the model's box
constexpr std::size_t kColouredTriangles = 1'000'000;
constexpr int kColouredRounds = 2;  // at least: meshes have no error at their vertices, as a rule

struct Checked {
    MeshDeviation d;
    MeshTopology topology;
    std::size_t triangles = 0;
    std::string unit;
    double seconds = 0;
};

// within: proven; exceeds: a place was found; undecided: neither.
std::string_view verdict(const MeshDeviation& d, double tolerance) {
    if (d.measured > tolerance || d.mesh_measured > tolerance + d.accuracy) return "exceeds";
    return d.bound <= tolerance && d.refused.empty() ? "within" : "undecided";
}

void write_point(json::Writer& w, std::string_view key, const Vec<3>& p) {
    w.key(key).array(std::span<const double>(p.c));
}

std::string json_report(const Checked& c, std::optional<double> tolerance) {
    json::Writer w;
    w.begin_object();
    if (tolerance) w.field("tolerance", *tolerance).field("verdict", verdict(c.d, *tolerance));
    w.field("unit", c.unit).field("triangles", c.triangles);
    w.key("model_to_mesh").begin_object();
    w.field("measured", c.d.measured).field("bound", c.d.bound);  // null where none was found
    if (c.d.worst >= 0) {
        const FaceDeviation& f = c.d.faces[std::size_t(c.d.worst)];
        w.field("face", f.face).field("name", f.name);
        write_point(w, "at", f.at);
    }
    w.end_object().key("mesh_to_model").begin_object();
    w.field("measured", c.d.mesh_measured).field("accuracy", c.d.accuracy).field("overhang", c.d.overhang);
    write_point(w, "at", c.d.mesh_at);
    w.end_object();
    w.field("open_edges", c.topology.open_edges)
        .field("non_manifold_edges", c.topology.non_manifold_edges)
        .field("misoriented_edges", c.topology.misoriented_edges)
        .field("degenerate_triangles", c.topology.degenerate_triangles);
    w.key("faces").begin_array();
    for (const FaceDeviation& f : c.d.faces) {
        w.new_line(1).begin_object().field("face", f.face).field("name", f.name);
        w.field("measured", f.measured).field("bound", f.bound).end_object();
    }
    w.end_array().key("refused").begin_array();
    for (const Refusal& r : c.d.refused)
        w.begin_object()
            .field("face", r.where)
            .field("kind", name_of(r.kind))
            .field("message", r.message)
            .end_object();
    w.end_array().field("parts", c.d.parts).field("seconds", c.seconds).end_object();
    return w.take() + "\n";
}

std::string text_report(const Checked& c, std::optional<double> tolerance) {
    const std::string unit = c.unit.empty() ? "" : text(" ", c.unit);
    std::string s;
    if (tolerance) s += text(verdict(c.d, *tolerance), " ", *tolerance, unit, "\n");
    s += text("model to mesh   ", c.d.measured, " measured, ",
              std::isfinite(c.d.bound) ? text("at most ", c.d.bound) : std::string("no bound found"), unit);
    if (c.d.worst >= 0) {
        const FaceDeviation& f = c.d.faces[std::size_t(c.d.worst)];
        s += text(", face ", f.face, f.name.empty() ? "" : text(" '", f.name, "'"), " at (", f.at[0], ", ",
                  f.at[1], ", ", f.at[2], ")");
    }
    s += text("\nmesh to model   ", c.d.mesh_measured, " measured, within ", c.d.accuracy, unit, ", at (",
              c.d.mesh_at[0], ", ", c.d.mesh_at[1], ", ", c.d.mesh_at[2], ")\n");
    s += text("open edges      ", c.topology.open_edges, "\n");
    if (c.topology.non_manifold_edges > 0) s += text("non-manifold    ", c.topology.non_manifold_edges, "\n");
    if (c.topology.misoriented_edges > 0) s += text("misoriented     ", c.topology.misoriented_edges, "\n");
    if (c.topology.degenerate_triangles > 0)
        s += text("degenerate      ", c.topology.degenerate_triangles, "\n");
    for (const Refusal& r : c.d.refused) s += text("not measured ", r.where, ": ", r.message, "\n");
    return s;
}

// A mesh in another unit that is known is brought to the unit of the model.
void to_unit(TriangleMesh& mesh, const std::string& unit) {
    if (mesh.unit.empty() || unit.empty() || mesh.unit == unit) return;
    const auto from = metres_per(mesh.unit), to = metres_per(unit);
    if (!from || !to)
        return remark(text("the mesh is in ", mesh.unit, ", the model in ", unit, ": taken as equal"));
    if (*from == *to) return;
    remark(text("the mesh is in ", mesh.unit, ", the model in ", unit, ": the mesh is scaled"));
    for (Vec<3>& p : mesh.points) p *= *from / *to;
    mesh.unit = unit;
}

Result<std::string> picture(const Model& model, const TriangleMesh& mesh, const Checked& c,
                            const CheckArguments& o) {
    const double size = summary(model).box.diagonal();
    const TriangleMesh fine =
        refined(mesh, std::max(size * kColouredSide, 1e-300), kColouredTriangles, kColouredRounds);
    const double most = std::max({c.d.measured, c.d.mesh_measured, 1e-9 * size});
    const auto values = distances_from_model(model, fine.points, most / 16);
    if (!values) return std::unexpected(values.error());
    std::vector<double> at_vertex(fine.vertices.size());
    for (std::size_t i = 0; i < at_vertex.size(); ++i)
        at_vertex[i] = (*values)[std::size_t(fine.vertices[i].point)];
    const double shown_most = o.tolerance.value_or(most);
    VertexNumbers numbers{at_vertex, {0, shown_most}, "distance of the mesh", {}};
    if (!c.unit.empty()) numbers.remarks.push_back(text("in ", c.unit));
    numbers.remarks.push_back(text("measured at most ", rounded_up(most)));
    if (std::isfinite(c.d.bound))  // the other direction
        numbers.remarks.push_back(text("model to mesh: at most ", rounded_up(c.d.bound), ", proven"));
    ShadedOptions how;
    how.width = o.width, how.height = o.height;
    if (!o.view.empty()) {
        const auto view = parse_view(o.view);
        if (!view) wrong_usage(view.error().message);
        how.view = *view;
    }
    return coloured(fine, numbers, how);
}

Result<void> run_check(Context& context, const CheckArguments& options) {
    const double start = now();
    const std::string output = context.output;
    if (!output.empty() && !output.ends_with(".png") && context.to != "png")
        wrong_usage("-o is for the picture: a name that ends in .png");
    if (output == "-" && context.json) wrong_usage("--json and -o - both want standard output");
    if (options.tolerance && !(*options.tolerance > 0)) wrong_usage("--tolerance wants a positive distance");
    auto mesh = read_mesh(options.mesh);
    if (!mesh) return std::unexpected(mesh.error());
    const auto input = read_input(context, options.model, options.object);
    if (!input) return std::unexpected(input.error());
    const auto model = scene_of(*input->document, input->chosen);
    if (!model) return std::unexpected(model.error());
    to_unit(*mesh, model->unit);

    DeviationOptions how;
    how.enough = options.tolerance.value_or(0);
    if (options.parts) how.max_parts = std::size_t(*options.parts);
    Progress bar("check");
    const double deadline = context.limits.timeout > 0 ? start + context.limits.timeout : 0;
    how.progress = [&](double part) {
        bar(part);
        return deadline == 0 || now() < deadline;
    };
    auto d = deviation(*model, *mesh, how);
    if (!d)
        return d.error().where == "progress"
                   ? refuse(RefusalKind::limit, "--timeout",
                            text("more than ", context.limits.timeout, " seconds are needed"))
                   : std::unexpected(d.error());
    Checked c{std::move(*d), topology(*mesh), mesh->triangles.size(), model->unit, now() - start};
    if (!output.empty()) {
        const auto png = picture(*model, *mesh, c, options);
        if (!png) return std::unexpected(png.error());
        if (auto ok = emit(context, *png); !ok || output == "-") return ok;
        context.output.clear();
    }
    return emit(context,
                context.json ? json_report(c, options.tolerance) : text_report(c, options.tolerance));
}

}  // namespace

void add_check(CommandLine& line) {
    const auto options = std::make_shared<CheckArguments>();
    const Command command =
        line.add("check", "How far a triangle mesh, of any program, is from its model: measured and bounded",
                 "  freiform check part.stl --against part.step --tolerance 0.05\n"
                 "  freiform check teapot.glb --against teapot.bpt -o error.png --json");
    command.word("MESH", options->mesh, "The mesh: .stl, .ply, .obj or .glb").required();
    command.word("--against", options->model, "The model that it stands for").shown_as("MODEL").required();
    command.number("--tolerance", options->tolerance,
                   "A distance: say whether every point of the model is within it of the mesh");
    command.count("--parts", options->parts, 1000, 2'000'000'000,
                  "Work: into how many parts the faces are cut at most, in all (default 1000000)");
    command.output("A picture of the error: .png");
    command.word("--view", options->view, "Of the picture, as in draw").shown_as("VIEW");
    command.count("--width", options->width, 1, 16384, "Pixels");
    command.count("--height", options->height, 1, 16384, "Pixels");
    command.object(options->object);
    command.limits();
    command.action(options, run_check);
}

}  // namespace freiform::cli
