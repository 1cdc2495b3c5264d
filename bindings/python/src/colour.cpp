// Colours: maps, gradients, meshes of colours.
#include "records/colour/colour_map.hpp"
#include "records/colour/gradient.hpp"
#include "records/colour/mesh_gradient.hpp"
#include "records/core/interval.hpp"

namespace freiform::python {
namespace {

using Rgba = std::array<double, 4>;
Colour colour_of(const Rgba& c) { return {c[0], c[1], c[2], c[3]}; }

template <class F>
py::array_t<double> colours_at(const Array& t, F&& f) {
    std::vector<py::ssize_t> shape(t.shape(), t.shape() + t.ndim());
    shape.push_back(4);
    py::array_t<double> out(shape);
    double* to = out.mutable_data();
    for (py::ssize_t i = 0; i < t.size(); ++i) {
        const Colour c = f(t.data()[i]);
        *to++ = c.r, *to++ = c.g, *to++ = c.b, *to++ = c.a;
    }
    return out;
}

}  // namespace

void bind_colour(py::module_& m) {
    m.def(
        "colour_named", [](std::string_view hex) { return answer([&] { return colour_named(hex); }); },
        py::arg("hex"));
    m.def(
        "hex_of", [](const Rgba& c) { return hex_of(colour_of(c)); }, py::arg("colour"));
    m.def(
        "to_oklab", [](const Rgba& c) { return to_py(to_oklab(colour_of(c))); }, py::arg("colour"));
    m.def(
        "oklab_distance",
        [](const Rgba& a, const Rgba& b) { return oklab_distance(colour_of(a), colour_of(b)); }, py::arg("a"),
        py::arg("b"));
    m.def(
        "colour_map",
        [](std::string_view kind, const Array& t) {
            const ColourMap map(enum_of<MapKind>(kind, "kind"));
            return colours_at(t, [&](double x) { return map(x); });
        },
        py::arg("kind"), py::arg("t"));
    py::class_<Gradient>(m, "GradientHandle")
        .def(py::init([](const std::vector<std::pair<double, Rgba>>& stops, std::string_view space,
                         std::string_view way, bool longer_hue) {
                 std::vector<ColourStop> all;
                 for (const auto& [at, c] : stops) all.push_back({at, colour_of(c)});
                 return take(Gradient::make(all, {enum_of<ColourSpace>(space, "space"),
                                                  enum_of<GradientOptions::Way>(way, "way"), longer_hue}));
             }),
             py::arg("stops"), py::arg("space"), py::arg("way"), py::arg("longer_hue"))
        .def(
            "evaluate",
            [](const Gradient& g, const Array& t) { return colours_at(t, [&](double x) { return g(x); }); },
            py::arg("t"))
        .def("domain", [](const Gradient& g) { return to_py(g.domain()); })
        .def("curve", [](const Gradient& g) { return to_py(g.curve()); })
        .def(
            "stops_in_srgb",
            [](const Gradient& g, double tolerance) {
                return answer([&] { return g.stops_in_srgb(tolerance); });
            },
            py::arg("tolerance"));
    py::class_<MeshGradient>(m, "MeshGradientHandle")
        .def(py::init([](const SurfaceHandle& s, const std::vector<Rgba>& colours, std::string_view space) {
                 std::vector<Colour> all;
                 for (const Rgba& c : colours) all.push_back(colour_of(c));
                 return take(MeshGradient::make(as<Vec<2>, 2>(*s.patch, "surface"), all,
                                                enum_of<ColourSpace>(space, "space")));
             }),
             py::arg("surface"), py::arg("colours"), py::arg("space"))
        .def(
            "colour",
            [](const MeshGradient& g, double u, double v) {
                const Box<2> on{{{g.surface().domain()[0].lo, g.surface().domain()[1].lo}},
                                {{g.surface().domain()[0].hi, g.surface().domain()[1].hi}}};
                if (!on.contains({{u, v}})) reject(RefusalKind::out_of_domain, "at", "is outside the domain");
                return to_py(g.colour(u, v));
            },
            py::arg("u"), py::arg("v"))
        .def("box", [](const MeshGradient& g) { return to_py(g.box()); })
        .def(
            "picture",
            [](const MeshGradient& g, int width) {
                if (width < 1 || width > 16384)
                    reject(RefusalKind::invalid, "width", "is not from 1 to 16384");
                const Image image =
                    take(unlocked([&] { return picture_of(std::span(&g, 1), g.box(), width); }));
                py::array_t<unsigned char> a({image.height, image.width, 3});
                std::memcpy(a.mutable_data(), image.rgb.data(), image.rgb.size());
                return a;
            },
            py::arg("width"));
}

}  // namespace freiform::python
