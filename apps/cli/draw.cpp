// draw: a picture: lines (curves, surfaces, models) as SVG, PDF or PNG, or shaded surfaces as PNG.
#include "drawing_bytes.hpp"
#include "input.hpp"
#include "shaded.hpp"

#include <freiform/io/drawing.hpp>
#include <freiform/io/mesh_file.hpp>

namespace freiform::cli {

namespace {

struct DrawArguments {
    std::string file, object, view, title, names;
    std::optional<double> tolerance, construction, tangent, osculating;
    std::optional<int> width, height;
    std::optional<int> isolines;
    bool lines = false, hidden = false, wireframe = false;
    bool control = false, knots = false, comb = false, hull = false, box = false;  // of lines
    bool joints = false, a_frames = false, hodograph = false, basis = false, axes = false, grid = false,
         legend = false;
    std::string colour;  // of shaded pictures
    std::vector<double> range;
    std::optional<int> normals;
    bool edges = false, zebra = false, isophotes = false, perspective = false, gpu = false;
};

// Of options that belong to the other kind of picture the first one that was given.
void refuse_other_kind(const DrawArguments& o, bool shaded) {
    struct Given {
        bool is, of_shaded;
        std::string_view name;
    };
    for (const Given& g : {Given{!o.names.empty(), false, "--names"},
                           {o.knots, false, "--knots"},
                           {o.comb, false, "--comb"},
                           {o.hull, false, "--hull"},
                           {o.box, false, "--box"},
                           {o.joints, false, "--joints"},
                           {o.a_frames, false, "--a-frames"},
                           {o.hodograph, false, "--hodograph"},
                           {o.basis, false, "--basis"},
                           {o.construction.has_value(), false, "--construction"},
                           {o.tangent.has_value(), false, "--tangent"},
                           {o.osculating.has_value(), false, "--osculating"},
                           {o.hidden, false, "--hidden"},
                           {o.wireframe, false, "--wireframe"},
                           {o.axes, false, "--axes"},
                           {o.grid, false, "--grid"},
                           {o.legend, false, "--legend"},
                           {!o.title.empty(), false, "--title"},
                           {o.edges, true, "--edges"},
                           {o.zebra, true, "--zebra"},
                           {o.isophotes, true, "--isophotes"},
                           {o.normals.has_value(), true, "--normals"},
                           {!o.colour.empty(), true, "--colour"},
                           {!o.range.empty(), true, "--range"},
                           {o.perspective, true, "--perspective"},
                           {o.gpu, true, "--gpu"},
                           {o.tolerance.has_value(), true, "--tolerance"}}) {
        if (!g.is || g.of_shaded == shaded) continue;
        wrong_usage(text(g.name, shaded ? " is for drawings: .svg, .pdf, or .png of curves without surfaces"
                                        : " is for shaded pictures: .png of surfaces, models and meshes"));
    }
}

bool has_faces(const Shape& shape) {
    return std::holds_alternative<TrimmedSurface>(shape) || std::holds_alternative<Model>(shape) ||
           std::holds_alternative<Surface<Vec<2>>>(shape) || std::holds_alternative<Surface<Hom<2>>>(shape) ||
           std::holds_alternative<Surface<Vec<3>>>(shape) || std::holds_alternative<Surface<Hom<3>>>(shape);
}

bool is_triangle(const Shape& shape) {
    return std::holds_alternative<Triangle<Vec<3>>>(shape) || std::holds_alternative<Triangle<Hom<3>>>(shape);
}

DrawingOptions drawing_options(const DrawArguments& o, const std::optional<View>& view) {
    DrawingOptions how;
    how.width = o.width.value_or(how.width);
    how.height = o.height.value_or(how.height);
    how.view = view;
    how.title = o.title, how.legend = o.legend;
    how.axes = o.grid ? Axes::grid : o.axes ? Axes::ticks : Axes::none;
    how.hidden = o.wireframe ? HiddenLines::shown : o.hidden ? HiddenLines::dashed : HiddenLines::removed;
    how.isolines = o.isolines;
    how.control = o.control, how.knots = o.knots, how.comb = o.comb;
    if (o.names == "b0") how.names = PointNames::from_zero;
    if (o.names == "P1") how.names = PointNames::from_one;
    how.hull = o.hull, how.box = o.box, how.joints = o.joints, how.a_frames = o.a_frames,
    how.hodograph = o.hodograph, how.basis = o.basis;
    how.construction = o.construction, how.tangent = o.tangent, how.osculating = o.osculating;
    return how;
}

Result<std::string> drawn(const Document& document, std::span<const std::size_t> objects,
                          const DrawArguments& options, const std::optional<View>& view,
                          const std::string& format) {
    const auto drawing = draw(document, objects, drawing_options(options, view));
    if (!drawing) return std::unexpected(drawing.error());
    for (const Refusal& r : drawing->left_out) remark(text(r.where, " is missing: ", r.message));
    return drawing_bytes(*drawing, format, "draw");
}

ShadedOptions shaded_options(const DrawArguments& o, const std::optional<View>& view) {
    ShadedOptions how;
    how.colour = o.colour, how.range = o.range, how.tolerance = o.tolerance;
    how.width = o.width, how.height = o.height, how.isolines = o.isolines, how.normals = o.normals;
    how.control = o.control, how.edges = o.edges, how.zebra = o.zebra, how.isophotes = o.isophotes;
    how.perspective = o.perspective, how.gpu = o.gpu;
    how.view = view.value_or(how.view);
    return how;
}

Result<ShadedPicture> picture(const Context& context, const DrawArguments& options,
                              const std::string& format) {
    std::optional<View> view;
    if (!options.view.empty()) {
        const auto parsed = parse_view(options.view);
        if (!parsed) wrong_usage(parsed.error().message);
        view = *parsed;
    }
    if (is_mesh_file(context, options.file)) {
        if (format != "png")
            return refuse(RefusalKind::no_answer, options.file,
                          text("a mesh has no curves to write as .", format, "; a mesh is drawn as .png"));
        refuse_other_kind(options, true);
        const auto mesh = read_mesh(options.file);
        if (!mesh) return std::unexpected(mesh.error());
        return shaded(*mesh, shaded_options(options, view));
    }
    const auto input = read_input(context, options.file, options.object);
    if (!input) return std::unexpected(input.error());
    const Document& document = *input->document;
    const bool lines = options.lines || options.hidden || options.wireframe;
    const bool faces = format == "png" && !lines && std::ranges::any_of(input->chosen, [&](std::size_t i) {
                           const Shape& shape = document.objects[i].shape;
                           return has_faces(shape) || (options.gpu && is_triangle(shape));
                       });
    refuse_other_kind(options, faces);
    if (faces) return shaded(document, input->chosen, context.limits, shaded_options(options, view));
    auto bytes = drawn(document, input->chosen, options, view, format);
    if (!bytes) return std::unexpected(bytes.error());
    return ShadedPicture{std::move(*bytes), "{}\n"};
}

Result<void> run_draw(const Context& context, const DrawArguments& options) {
    const std::string format =
        context.to.empty() ? context.output.substr(context.output.rfind('.') + 1) : context.to;
    if (context.output.empty()) wrong_usage("-o FILE says where the picture goes: .svg, .pdf or .png");
    if (format != "svg" && format != "pdf" && format != "png")
        wrong_usage(text("pictures are written as .svg, .pdf or .png, not .", format));
    if (format != "png") refuse_other_kind(options, false);
    if (context.output == "-" && context.json) wrong_usage("--json and -o - both want standard output");
    if (!options.range.empty() && !(options.range.size() == 2 && options.range[0] < options.range[1] &&
                                    !options.colour.empty() && options.colour != "normal"))
        wrong_usage("--range LEAST,GREATEST is of the numbers of --colour, and LEAST < GREATEST");
    const auto made = picture(context, options, format);
    if (!made) return std::unexpected(made.error());
    if (auto ok = emit(context, made->png); !ok || !context.json) return ok;
    Context screen = context;
    screen.output.clear();
    return emit(screen, made->report);
}

void add_line_options(const Command& command, DrawArguments& o) {
    command.flag("--control", o.control,
                 "Also control polygons and nets; the area of a point is as its weight");
    command.word("--names", o.names, "Name the control points of curves: b0, b1, .. or P1, P2, ..")
        .shown_as("b0|P1")
        .one_of({"b0", "P1"});
    command.flag("--knots", o.knots, "Also the places of the knots on curves, multiple ones larger");
    command.flag("--comb", o.comb, "Also the curvature of curves, as needles away from its centre");
    command.number("--construction", o.construction,
                   "Also the points of the de Casteljau or de Boor scheme at this parameter");
    command.number("--tangent", o.tangent, "Also tangent and normal of curves at this parameter");
    command.number("--osculating", o.osculating, "Also the circle of curvature of curves at this parameter");
    command.flag("--hull", o.hull, "Also the convex hull of the control points of curves");
    command.flag("--box", o.box, "Also the boxes of curves");
    command.flag("--joints", o.joints, "Also the order of continuity at knots and where curves meet");
    command.flag("--a-frames", o.a_frames, "Also the A-frames at inner knots of curves of degree 2 or more");
    command.flag("--hodograph", o.hodograph, "A panel with the curve of the derivatives");
    command.flag("--basis", o.basis, "A panel with the basis functions and the knots of curves");
    command.flag("--axes", o.axes, "Axes with ticks");
    command.flag("--grid", o.grid, "Axes with ticks, and a grid");
    command.flag("--legend", o.legend, "What is what");
    command.flag("--lines", o.lines, "A .png of surfaces as lines, like .svg and .pdf");
    command.flag("--hidden", o.hidden, "Hidden edges and outlines of surfaces, dashed");
    command.flag("--wireframe", o.wireframe, "Surfaces as if they were of glass");
    command.word("--title", o.title, "Above the drawing").shown_as("TEXT");
}

}  // namespace

void add_draw(CommandLine& line) {
    const auto options = std::make_shared<DrawArguments>();
    const Command command =
        line.add("draw", "A picture of curves, surfaces, a model or a mesh",
                 "  freiform draw curves.json -o curves.svg --control --knots\n"
                 "  freiform draw curves.json -o curve.pdf --object cubic --names b0 "
                 "--construction 0.4 --hull\n"
                 "  freiform draw curves.json -o curve.svg --object closed --comb --basis\n"
                 "  freiform draw teapot.bpt -o teapot.png\n"
                 "  freiform draw part.step -o part.png --view 30,20 --zebra\n"
                 "  freiform draw part.step -o part.png --gpu\n"
                 "  freiform draw part.step -o part.svg --hidden\n"
                 "  freiform draw teapot.bpt -o curvature.png --colour mean --isolines 5\n"
                 "  freiform draw part.glb -o part.png --edges");
    command.file(options->file);
    command.output("The picture: .svg and .pdf of lines; .png shaded, or lines where there are only curves");
    command
        .word("--view", options->view,
              "iso, front, back, left, right, top, bottom, or AZIMUTH,ELEVATION in degrees "
              "(default: plane curves as they are, others from iso)")
        .shown_as("VIEW");
    add_line_options(command, *options);
    command.positive("--tolerance", options->tolerance,
                     "Of the mesh that is drawn (default: a quarter of a pixel)");
    command.count("--isolines", options->isolines, 0, 1000,
                  "Isolines of every face in each direction (default: as the knots of surfaces suggest)");
    command.count("--width", options->width, 1, 16384, "Pixels");
    command.count("--height", options->height, 1, 16384, "Pixels");
    command.flag("--edges", options->edges, "Also the edges of the triangles");
    command.flag("--zebra", options->zebra, "Reflected stripes, which show breaks of tangent and curvature");
    command.flag("--isophotes", options->isophotes,
                 "Lines along which the normal makes the same angle with the light");
    command
        .word("--colour", options->colour,
              "Colour surfaces by Gauss, mean, greatest or least curvature, by the error of the mesh, or "
              "by their normals")
        .shown_as("gauss|mean|greatest|least|error|normal")
        .one_of({"gauss", "mean", "greatest", "least", "error", "normal"});
    command.numbers("--range", options->range,
                    "LEAST,GREATEST of the colours (default: so that 90 % of the area are inside)");
    command.count("--normals", options->normals, 1, 200,
                  "Normals of every face, this many in each direction");
    command.flag("--perspective", options->perspective, "Perspective instead of a parallel view");
    command.flag(
        "--gpu", options->gpu,
        "Surfaces by shaders, without a mesh, as fine as the picture needs; where that cannot be, as a "
        "mesh, and the reason is said");
    command.object(options->object);
    command.limits();
    command.triangle_limit();
    command.action(options, run_draw);
}

}  // namespace freiform::cli
