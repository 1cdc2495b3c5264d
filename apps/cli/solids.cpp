#include "solids.hpp"

#include <freiform/io/document.hpp>
#include <freiform/io/iges.hpp>
#include <freiform/io/mesh_file.hpp>
#include <freiform/io/scene.hpp>
#include <freiform/io/step.hpp>
#include <freiform/model/tessellate.hpp>

namespace freiform::cli {

std::string output_ending(const Context& context, std::string_view otherwise) {
    std::string format = context.to;
    if (format.empty()) {
        const std::size_t dot = context.output.rfind('.'), slash = context.output.rfind('/');
        const bool ending = dot != std::string::npos && (slash == std::string::npos || slash < dot);
        format = ending && context.output != "-" ? context.output.substr(dot + 1) : std::string(otherwise);
    }
    for (char& c : format) c = c >= 'A' && c <= 'Z' ? char(c + 32) : c;
    return format;
}

SolidOutput solid_output(const Context& context, const std::string& command,
                         std::optional<double> tolerance) {
    SolidOutput out{output_ending(context, "json"), tolerance};
    if (out.is_mesh() && !mesh_format(out.format))
        wrong_usage(text(command, " writes solids as .json, .step, .iges, .glb, .stl, .obj and .ply, not \"",
                         out.format, "\""));
    return out;
}

namespace {

Result<std::string> mesh_bytes_of(const TriangleMesh& mesh, const std::string& format) {
    return format == "glb"   ? to_glb(mesh)
           : format == "stl" ? to_stl(mesh)
           : format == "obj" ? to_obj(mesh)
                             : to_ply(mesh);
}

}  // namespace

Result<void> emit_solids(const Context& context, const SolidOutput& output, const Document& document,
                         json::Writer& w, std::string said) {
    Result<std::string> bytes = "";
    remark_unknown_unit(document.unit, output.format);
    if (output.is_mesh()) {
        const auto model = scene_of(document);
        if (!model) return std::unexpected(model.error());
        TessellateOptions how;
        how.tolerance = output.tolerance.value_or(summary(*model).box.diagonal() / 1000);
        how.max_triangles = (long long)(context.limits.max_triangles);
        const auto t = tessellate(*model, how);
        if (!t) return std::unexpected(t.error());
        if (!t->refused.empty())
            return refuse_within(text("faces[", t->refused[0].face, "]"), t->refused[0].reason);
        w.field("triangles", t->mesh.triangles.size()).field("open_edges", t->topology.open_edges);
        w.field("error_bound", t->error_bound).field("boundary_gap", t->boundary_gap);
        said += text(", ", t->mesh.triangles.size(), " triangles within ", t->error_bound, ", ",
                     t->topology.open_edges, " open edges");
        bytes = mesh_bytes_of(t->mesh, output.format);
    } else {
        bytes = output.format == "step" ? write_step(document)
                : output.is_iges()      ? write_iges(document)
                                        : Result<std::string>(write_document(document));
    }
    if (!bytes) return std::unexpected(bytes.error());
    if (auto ok = emit(context, *bytes); !ok) return ok;
    w.end_object();
    if (context.output.empty() || context.output == "-") return {};
    return emit({}, (context.json ? w.take() : said) + "\n");
}

}  // namespace freiform::cli
