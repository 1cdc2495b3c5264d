// draw: a picture of surfaces, models and meshes.
#include "command.hpp"

#include <freiform/io/mesh_file.hpp>
#include <freiform/io/scene.hpp>
#include <freiform/model/tessellate.hpp>
#if FREIFORM_HAS_GL
#include <freiform/gpu/render.hpp>
#endif

namespace freiform::cli {

namespace {

struct Options {
    std::string file, object, view = "iso";
    std::optional<double> tolerance;
    std::optional<int> width, height;
    bool edges = false, zebra = false, perspective = false;
};

#if FREIFORM_HAS_GL

constexpr double kPictureTolerance = 1.0 / 2000;  // of the model's box: below a pixel

Result<TriangleMesh> mesh_of(const Context& context, const Options& options) {
    if (mesh_format(options.file)) return read_mesh(options.file);
    const auto document = read_any(options.file, context.read_options());
    if (!document) return std::unexpected(document.error());
    const auto objects = selected(*document, options.object);
    if (!objects) return std::unexpected(objects.error());
    const auto model = scene_of(*document, *objects);
    if (!model) return std::unexpected(model.error());
    TessellateOptions how;
    how.tolerance = options.tolerance.value_or(summary(*model).box.diagonal() * kPictureTolerance);
    how.max_triangles = (long long)(context.limits.max_triangles);
    auto t = tessellate(*model, how);
    if (!t) return std::unexpected(t.error());
    for (const RefusedFace& r : t->refused)
        remark(text("face ", r.face, " is missing: ", r.reason.where, ": ", r.reason.message));
    for (const Refusal& r : model->refused) remark(text(r.where, " is missing: ", r.message));
    return std::move(t->mesh);
}

Result<void> run(const Context& context, const Options& options) {
    const std::string format =
        context.to.empty() ? context.output.substr(context.output.rfind('.') + 1) : context.to;
    if (context.output.empty()) wrong_usage("-o FILE.png says where the picture goes");
    if (format != "png") wrong_usage(text("pictures of surfaces are written as .png, not .", format));
    RenderOptions how;
    const auto view = parse_view(options.view);
    if (!view) wrong_usage(view.error().message);
    how.view = *view;
    how.width = options.width.value_or(how.width);
    how.height = options.height.value_or(how.height);
    how.edges = options.edges, how.zebra = options.zebra, how.perspective = options.perspective;
    const auto mesh = mesh_of(context, options);
    if (!mesh) return std::unexpected(mesh.error());
    const auto image = render(*mesh, how);
    if (!image) return std::unexpected(image.error());
    const auto png = to_png(*image);
    if (!png) return std::unexpected(png.error());
    return emit(context, *png);
}

#else

Result<void> run(const Context&, const Options&) {
    return refuse(RefusalKind::unavailable, "draw",
                  "this program was built without pictures: install libegl-dev libepoxy-dev libpng-dev and "
                  "build again");
}

#endif

}  // namespace

void add_draw(CLI::App& app, Context& context) {
    const auto options = std::make_shared<Options>();
    CLI::App* command = add_command(app, context, "draw", "A picture of surfaces, a model or a mesh",
                                    "  freiform draw teapot.bpt -o teapot.png\n"
                                    "  freiform draw part.step -o part.png --view 30,20 --zebra\n"
                                    "  freiform draw part.glb -o part.png --edges");
    command->add_option("FILE", options->file, "The file; - is standard input")->required();
    add_output(*command, context, "The picture: .png");
    command
        ->add_option("--view", options->view,
                     "iso, front, back, left, right, top, bottom, or AZIMUTH,ELEVATION in degrees")
        ->type_name("VIEW");
    add_number(*command, "--tolerance", options->tolerance,
               "Of the mesh that is drawn (default: below a pixel)");
    add_count(*command, "--width", options->width, 1, 16384, "Pixels");
    add_count(*command, "--height", options->height, 1, 16384, "Pixels");
    command->add_flag("--edges", options->edges, "Also the edges of the triangles");
    command->add_flag("--zebra", options->zebra,
                      "Reflected stripes, which show breaks of tangent and curvature");
    command->add_flag("--perspective", options->perspective, "Perspective instead of a parallel view");
    command->add_option("--object", options->object, "Only the object of this name or index")
        ->type_name("NAME|INDEX");
    add_limits(*command, context);
    add_triangle_limit(*command, context);
    command->callback(
        [&context, options] { context.action = [&context, options] { return run(context, *options); }; });
}

}  // namespace freiform::cli
