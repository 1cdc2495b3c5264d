// Fonts: outlines of glyphs, text.
#include "paths.hpp"

#if FREIFORM_HAS_FONT
#include "records/font/font.hpp"
#include "records/font/typeset.hpp"
#endif

namespace freiform::python {

void bind_font(py::module_& m) {
#if FREIFORM_HAS_FONT
    m.attr("has_font") = true;
    py::class_<Font>(m, "FontHandle")
        .def(py::init([](const py::bytes& data, int face,
                         const std::vector<std::pair<std::string, double>>& axes) {
                 FontOptions options;
                 options.face = face;
                 for (const auto& [tag, value] : axes) options.axes.push_back({tag, value});
                 std::string bytes = data;
                 return take(unlocked([&] { return Font::parse(std::move(bytes), options); }));
             }),
             py::arg("data"), py::arg("face"), py::arg("axes"))
        .def("info", [](const Font& f) { return to_py(f.info()); })
        .def(
            "glyph", [](const Font& f, int index) { return answer([&] { return f.glyph(index); }); },
            py::arg("index"))
        .def(
            "index_of", [](const Font& f, char32_t c) { return f.index_of(c); }, py::arg("character"))
        .def(
            "index_named", [](const Font& f, std::string_view name) { return to_py(f.index_named(name)); },
            py::arg("name"))
        .def(
            "typeset",
            [](const Font& f, std::string_view utf8, double size, const std::vector<std::string>& features,
               const std::string& language) {
                const TypesetOptions options{size, features, language};
                return answer([&] { return typeset(f, utf8, options); });
            },
            py::arg("text"), py::arg("size"), py::arg("features"), py::arg("language"))
        .def(
            "outlines",
            [](const Font& f, std::string_view utf8, double size, const std::vector<std::string>& features,
               const std::string& language) {
                const TypesetOptions options{size, features, language};
                return answer([&]() -> Result<std::vector<Path>> {
                    auto line = typeset(f, utf8, options);
                    if (!line) return std::unexpected(line.error());
                    return outlines(f, *line, size);
                });
            },
            py::arg("text"), py::arg("size"), py::arg("features"), py::arg("language"));
    m.def(
        "font_file", [](const std::string& family) { return answer([&] { return font_file(family); }); },
        py::arg("family"));
#else
    m.attr("has_font") = false;
#endif
}

}  // namespace freiform::python
