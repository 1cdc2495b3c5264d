// Pictures: drawings as SVG, PDF and PNG, shaded meshes as arrays and PNG.
#include "handles.hpp"

#include <freiform/colour/gradient.hpp>
#include <freiform/io/drawing.hpp>

#if FREIFORM_HAS_CAIRO
#include <freiform/paint/mesh_gradient.hpp>
#include <freiform/paint/paint.hpp>
#endif
#if FREIFORM_HAS_GL
#include <freiform/gpu/render.hpp>
#endif

namespace freiform::python {
namespace {

// The options that were given, by name; others are refused.
class Given {
public:
    explicit Given(const py::dict& d) : all_(d) {}
    template <class T>
    void read(const char* name, T& to) {
        known_.push_back(name);
        if (!all_.contains(name) || all_[name].is_none()) return;
        const py::handle value = all_[name];
        try {
            if constexpr (std::is_enum_v<T>)
                to = enum_of<T>(value.cast<std::string>(), name);
            else if constexpr (is_form<T, std::optional>)
                to = value.cast<typename T::value_type>();
            else
                to = value.cast<T>();
        } catch (const py::cast_error&) {
            reject(RefusalKind::invalid, name, text("cannot be ", std::string(py::repr(value))));
        }
    }
    void read_view(std::optional<View>& to) {
        known_.push_back("view");
        if (all_.contains("view") && !all_["view"].is_none())
            to = take(parse_view(all_["view"].cast<std::string>()));
    }
    void finish() const {
        for (const auto& item : all_) {
            const auto name = item.first.cast<std::string>();
            if (std::ranges::find(known_, name) == known_.end())
                reject(RefusalKind::invalid, name, "is no option" + did_you_mean(name, known_));
        }
    }

private:
    py::dict all_;
    std::vector<std::string_view> known_;
};

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
            RenderOptions o;
            Given g(given);
            std::optional<View> view;
            std::pair<double, double> range{o.range.lo, o.range.hi};
            std::string colour;
            g.read("width", o.width), g.read("height", o.height), g.read_view(view);
            g.read("perspective", o.perspective), g.read("outlines", o.outlines), g.read("edges", o.edges);
            g.read("zebra", o.zebra), g.read("isophotes", o.isophotes), g.read("painting", o.painting);
            g.read("range", range), g.read("supersampling", o.supersampling), g.read("margin", o.margin);
            g.read("colour", colour);
            g.finish();
            if (view) o.view = *view;
            if (!colour.empty()) o.colour = take(colour_named(colour));
            o.range = interval_of(range);
            if (field) {
                if (std::size_t(field->size()) != h.mesh->vertices.size())
                    reject(RefusalKind::invalid, "field",
                           text("one number for each of ", h.mesh->vertices.size(), " vertices is needed"));
                o.field = numbers_of(*field);
            }
            const Image image = take(unlocked([&] { return render(*h.mesh, o); }));
            if (png) return py::bytes(take(unlocked([&] { return to_png(image); })));
            py::array_t<unsigned char> a({image.height, image.width, 3});
            std::memcpy(a.mutable_data(), image.rgb.data(), image.rgb.size());
            return a;
#else
            (void)h, (void)png, (void)given, (void)field;
            reject(RefusalKind::unavailable, "render", "built without OpenGL");
#endif
        },
        py::arg("mesh"), py::arg("png"), py::arg("options"), py::arg("field"));
}

}  // namespace freiform::python
