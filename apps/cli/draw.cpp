// draw: a picture: lines (curves, surfaces, models) as SVG, PDF or PNG, or shaded surfaces as PNG.
#include "command.hpp"

#include <freiform/io/drawing.hpp>
#include <freiform/io/mesh_file.hpp>
#include <freiform/io/scene.hpp>
#include <freiform/model/tessellate.hpp>
#if FREIFORM_HAS_GL
#include <freiform/gpu/render.hpp>
#endif

namespace freiform::cli {

namespace {

struct Options {
    std::string file, object, view;
    std::optional<double> tolerance, construction;
    std::optional<int> width, height;
    bool control = false, knots = false, comb = false;       // of lines
    bool edges = false, zebra = false, perspective = false;  // of shaded pictures
};

// Of options that belong to the other kind of picture the first one that was given.
void refuse_other_kind(const Options& o, bool shaded) {
    const auto given = [&](bool is, std::string_view name) {
        if (is && shaded)
            wrong_usage(text(name, " is for drawings: .svg, .pdf, or .png of curves without surfaces"));
        if (is) wrong_usage(text(name, " is for shaded pictures: .png of surfaces, models and meshes"));
    };
    if (shaded) {
        given(o.control, "--control");
        given(o.knots, "--knots");
        given(o.comb, "--comb");
        given(o.construction.has_value(), "--construction");
    } else {
        given(o.edges, "--edges");
        given(o.zebra, "--zebra");
        given(o.perspective, "--perspective");
        given(o.tolerance.has_value(), "--tolerance");
    }
}

bool has_faces(const Shape& shape) {
    return std::holds_alternative<TrimmedSurface>(shape) || std::holds_alternative<Model>(shape) ||
           std::holds_alternative<Surface<Vec<2>>>(shape) || std::holds_alternative<Surface<Hom<2>>>(shape) ||
           std::holds_alternative<Surface<Vec<3>>>(shape) || std::holds_alternative<Surface<Hom<3>>>(shape);
}

Result<std::string> png_of(int width, int height, std::vector<unsigned char> rgb) {
#if FREIFORM_HAS_GL
    return to_png({width, height, std::move(rgb)});
#else
    (void)width, (void)height, (void)rgb;
    return refuse(RefusalKind::unavailable, "draw",
                  "this program was built without .png: install libegl-dev libepoxy-dev libpng-dev and build "
                  "again, or write .svg or .pdf");
#endif
}

Result<std::string> drawn(const Document& document, std::span<const std::size_t> objects,
                          const Options& options, const std::optional<View>& view,
                          const std::string& format) {
    DrawingOptions how;
    how.width = options.width.value_or(how.width);
    how.height = options.height.value_or(how.height);
    how.view = view;
    how.control = options.control, how.knots = options.knots, how.comb = options.comb;
    how.construction = options.construction;
    const auto drawing = draw(document, objects, how);
    if (!drawing) return std::unexpected(drawing.error());
    for (const Refusal& r : drawing->left_out) remark(text(r.where, " is missing: ", r.message));
    if (format == "svg") return to_svg(*drawing);
    if (format == "pdf") return to_pdf(*drawing);
    auto rgb = to_pixels(*drawing);
    if (!rgb) return std::unexpected(rgb.error());
    return png_of(drawing->width, drawing->height, std::move(*rgb));
}

#if FREIFORM_HAS_GL

constexpr double kPictureTolerance = 1.0 / 2000;  // of the model's box: below a pixel

Result<TriangleMesh> mesh_of(const Document& document, std::span<const std::size_t> objects,
                             const Context& context, const Options& options) {
    const auto model = scene_of(document, objects);
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

Result<std::string> shaded(const TriangleMesh& mesh, const Options& options,
                           const std::optional<View>& view) {
    RenderOptions how;
    how.view = view.value_or(how.view);
    how.width = options.width.value_or(how.width);
    how.height = options.height.value_or(how.height);
    how.edges = options.edges, how.zebra = options.zebra, how.perspective = options.perspective;
    const auto image = render(mesh, how);
    if (!image) return std::unexpected(image.error());
    return to_png(*image);
}

#endif

Result<std::string> picture(const Context& context, const Options& options, const std::string& format) {
    std::optional<View> view;
    if (!options.view.empty()) {
        const auto parsed = parse_view(options.view);
        if (!parsed) wrong_usage(parsed.error().message);
        view = *parsed;
    }
    if (mesh_format(options.file)) {
        if (format != "png")
            return refuse(RefusalKind::no_answer, options.file,
                          text("a mesh has no curves to write as .", format, "; a mesh is drawn as .png"));
        refuse_other_kind(options, true);
#if FREIFORM_HAS_GL
        const auto mesh = read_mesh(options.file);
        if (!mesh) return std::unexpected(mesh.error());
        return shaded(*mesh, options, view);
#else
        return png_of(0, 0, {});
#endif
    }
    const auto document = read_any(options.file, context.read_options());
    if (!document) return std::unexpected(document.error());
    const auto objects = selected(*document, options.object);
    if (!objects) return std::unexpected(objects.error());
    const bool faces = format == "png" && std::ranges::any_of(*objects, [&](std::size_t i) {
                           return has_faces(document->objects[i].shape);
                       });
    refuse_other_kind(options, faces);
    if (!faces) return drawn(*document, *objects, options, view, format);
#if FREIFORM_HAS_GL
    const auto mesh = mesh_of(*document, *objects, context, options);
    if (!mesh) return std::unexpected(mesh.error());
    return shaded(*mesh, options, view);
#else
    return png_of(0, 0, {});
#endif
}

Result<void> run(const Context& context, const Options& options) {
    const std::string format =
        context.to.empty() ? context.output.substr(context.output.rfind('.') + 1) : context.to;
    if (context.output.empty()) wrong_usage("-o FILE says where the picture goes: .svg, .pdf or .png");
    if (format != "svg" && format != "pdf" && format != "png")
        wrong_usage(text("pictures are written as .svg, .pdf or .png, not .", format));
    if (format != "png") refuse_other_kind(options, false);
    const auto bytes = picture(context, options, format);
    if (!bytes) return std::unexpected(bytes.error());
    return emit(context, *bytes);
}

}  // namespace

void add_draw(CLI::App& app, Context& context) {
    const auto options = std::make_shared<Options>();
    CLI::App* command = add_command(app, context, "draw", "A picture of curves, surfaces, a model or a mesh",
                                    "  freiform draw curves.json -o curves.svg --control --knots\n"
                                    "  freiform draw teapot.bpt -o teapot.png\n"
                                    "  freiform draw part.step -o part.png --view 30,20 --zebra\n"
                                    "  freiform draw part.glb -o part.png --edges");
    command->add_option("FILE", options->file, "The file; - is standard input")->required();
    add_output(*command, context,
               "The picture: .svg and .pdf of lines; .png shaded, or lines where there are only curves");
    command
        ->add_option("--view", options->view,
                     "iso, front, back, left, right, top, bottom, or AZIMUTH,ELEVATION in degrees "
                     "(default: plane curves as they are, others from iso)")
        ->type_name("VIEW");
    command->add_flag("--control", options->control,
                      "Also control polygons and nets; the area of a point is as its weight");
    command->add_flag("--knots", options->knots,
                      "Also the places of the knots on curves, multiple ones larger");
    command->add_flag("--comb", options->comb,
                      "Also the curvature of curves, as needles away from its centre");
    add_number(*command, "--construction", options->construction,
               "Also the points of the de Casteljau or de Boor scheme at this parameter");
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
