// Pictures: drawings as SVG, PDF and PNG, shaded meshes as arrays and PNG.
#include "options.hpp"

#include <freiform/io/drawing.hpp>

#if FREIFORM_HAS_CAIRO
#include <freiform/paint/mesh_gradient.hpp>
#include <freiform/paint/paint.hpp>
#endif

namespace freiform::python {
namespace {

DrawingOptions drawing_options(const py::dict& d) {
    DrawingOptions o;
    Given g(d);
    g.read("width", o.width), g.read("height", o.height), g.read_view(o.view), g.read("margin", o.margin);
    g.read("title", o.title), g.read("legend", o.legend), g.read("axes", o.axes);
    g.read("control", o.control), g.read("names", o.names), g.read("hidden", o.hidden),
        g.read("isolines", o.isolines);
    g.read("knots", o.knots), g.read("comb", o.comb), g.read("hull", o.hull), g.read("box", o.box);
    g.read("joints", o.joints), g.read("a_frames", o.a_frames), g.read("hodograph", o.hodograph);
    g.read("basis", o.basis), g.read("construction", o.construction), g.read("tangent", o.tangent);
    g.read("osculating", o.osculating);
    std::vector<std::string> palette;
    g.read("palette", palette);
    for (const std::string& c : palette) o.palette.push_back(take(colour_named(c)));
    g.finish();
    return o;
}

Result<std::string> drawn(const Drawing& drawing, std::string_view format) {
    if (format == "svg") return to_svg(drawing);
#if FREIFORM_HAS_CAIRO
    if (format == "pdf") return to_pdf(drawing);
    if (format == "png") return to_png(drawing);
#else
    if (format == "pdf" || format == "png")
        return refuse(RefusalKind::unavailable, "draw", "built without cairo");
#endif
    return refuse(RefusalKind::invalid, "format", text("\"", format, "\" is not svg, pdf or png"));
}

}  // namespace

void bind_draw(py::module_& m) {
    m.def(
        "draw",
        [](const DocumentHandle& h, std::string_view format, const py::dict& given) {
            const DrawingOptions options = drawing_options(given);
            return py::bytes(take(unlocked([&]() -> Result<std::string> {
                auto drawing = draw(*h.document, {}, options);
                if (!drawing) return std::unexpected(drawing.error());
                return drawn(*drawing, format);
            })));
        },
        py::arg("document"), py::arg("format"), py::arg("options"));
    // (height, width, 3) bytes, or a PNG
    m.def(
        "render",
        [](const MeshHandle& h, bool png, const py::dict& given,
           const std::optional<Array>& field) -> py::object {
#if FREIFORM_HAS_GL
            RenderOptions o = render_options(given);
            if (field) {
                if (std::size_t(field->size()) != h.mesh->vertices.size())
                    reject(RefusalKind::invalid, "field",
                           text("one number for each of ", h.mesh->vertices.size(), " vertices is needed"));
                o.field = numbers_of(*field);
            }
            const Image image = take(unlocked([&] { return render(*h.mesh, o); }));
            if (png) return py::bytes(take(unlocked([&] { return to_png(image); })));
            return picture_of(image);
#else
            (void)h, (void)png, (void)given, (void)field;
            reject(RefusalKind::unavailable, "render", "built without OpenGL");
#endif
        },
        py::arg("mesh"), py::arg("png"), py::arg("options"), py::arg("field"));
    m.def(
        "pixel_size",
        [](const MeshHandle& h, const py::dict& given) -> double {
#if FREIFORM_HAS_GL
            return pixel_size(*h.mesh, render_options(given));
#else
            (void)h, (void)given;
            reject(RefusalKind::unavailable, "pixel_size", "built without OpenGL");
#endif
        },
        py::arg("mesh"), py::arg("options"));
}

}  // namespace freiform::python
