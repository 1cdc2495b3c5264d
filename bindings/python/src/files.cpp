// Documents and files.
#include "records/core/interval.hpp"
#include "records/io/svg.hpp"
#include "records/model/model.hpp"
#include "records/path/path.hpp"
#include "records/path/style.hpp"

#include <freiform/core/text.hpp>
#include <freiform/io/bezierview.hpp>
#include <freiform/io/bpt.hpp>
#include <freiform/io/document.hpp>
#include <freiform/io/file.hpp>
#include <freiform/io/iges.hpp>
#include <freiform/io/obj_freeform.hpp>
#include <freiform/io/points.hpp>
#include <freiform/io/quake3.hpp>
#include <freiform/io/read.hpp>
#include <freiform/io/rhino_read.hpp>
#include <freiform/io/scene.hpp>
#include <freiform/io/step.hpp>
#include <freiform/io/step_read.hpp>

namespace freiform::python {
namespace {

DocumentHandle document_handle(Document d) { return {std::make_shared<const Document>(std::move(d))}; }

template <class Variant>
Shape shape_of(const Variant& v) {
    return std::visit([](const auto& s) { return Shape(s); }, v);
}
Shape shape_of_handle(const py::handle& x) {
    if (py::isinstance<CurveHandle>(x)) return shape_of(*x.cast<const CurveHandle&>().patch);
    if (py::isinstance<SurfaceHandle>(x)) return shape_of(*x.cast<const SurfaceHandle&>().patch);
    if (py::isinstance<VolumeHandle>(x)) return shape_of(*x.cast<const VolumeHandle&>().patch);
    if (py::isinstance<TriangleHandle>(x)) return shape_of(x.cast<const TriangleHandle&>().patch);
    if (py::isinstance<TrimmedHandle>(x)) return *x.cast<const TrimmedHandle&>().surface;
    if (py::isinstance<ModelHandle>(x)) return *x.cast<const ModelHandle&>().model;
    reject(RefusalKind::invalid, "objects",
           "are curves, surfaces, volumes, triangular patches, trimmed surfaces and models");
}

Result<std::string> bytes_as(const Document& d, std::string_view format, double tolerance) {
    if (format == "json") return write_document(d);
    if (format == "bpt") return write_bpt(d);
    if (format == "step" || format == "stp") return write_step(d);
    if (format == "iges" || format == "igs") return write_iges(d);
    if (format == "obj") return write_obj_freeform(d);
    if (format == "svg") {
        auto picture = picture_of(d, tolerance);
        if (!picture) return std::unexpected(picture.error());
        return write_svg(picture->picture);
    }
    return refuse(
        RefusalKind::unsupported, "format",
        text("\"", format, "\" is not json, bpt, step, iges, obj or svg; meshes are written by Mesh"));
}
Result<Document> parsed(std::string_view bytes, std::string_view format) {
    if (format == "step" || format == "stp" || format == "rhino" || format == "3dm") {
        auto model = format == "rhino" || format == "3dm" ? read_3dm(bytes) : read_step(bytes);
        if (!model) return std::unexpected(model.error());
        Document d;
        d.unit = model->unit;
        d.objects.push_back({"", std::move(*model), {}});
        return d;
    }
    if (format == "json") return read_document(bytes);
    if (format == "bpt") return read_bpt(bytes);
    if (format == "bezierview" || format == "bv") return read_bezierview(bytes);
    if (format == "obj") return read_obj_freeform(bytes);
    if (format == "quake3_bsp" || format == "bsp") return read_quake3_bsp(bytes);
    if (format == "quake3_map" || format == "map") return read_quake3_map(bytes);
    if (format == "svg") {
        auto picture = read_svg(bytes);
        if (!picture) return std::unexpected(picture.error());
        return document_of(*picture);
    }
    return refuse(RefusalKind::unsupported, "format",
                  text("\"", format,
                       "\" is not json, bpt, bezierview, step, rhino, obj, svg, quake3_bsp or quake3_map; "
                       "IGES and BREP are "
                       "read from files"));
}

}  // namespace

void bind_files(py::module_& m) {
    py::class_<DocumentHandle>(m, "DocumentHandle")
        .def(py::init(
                 [](const std::vector<std::pair<std::string, py::object>>& objects, const std::string& unit) {
                     Document d;
                     d.unit = unit;
                     for (const auto& [name, shape] : objects)
                         d.objects.push_back({name, shape_of_handle(shape)});
                     return document_handle(std::move(d));
                 }),
             py::arg("objects"), py::arg("unit"))
        .def("size", [](const DocumentHandle& h) { return h.document->objects.size(); })
        .def(
            "name", [](const DocumentHandle& h, std::size_t i) { return h.document->objects.at(i).name; },
            py::arg("index"))
        .def(
            "type",
            [](const DocumentHandle& h, std::size_t i) {
                return to_py(type_name(h.document->objects.at(i).shape));
            },
            py::arg("index"))
        .def(
            "shape",
            [](const DocumentHandle& h, std::size_t i) { return to_py(h.document->objects.at(i).shape); },
            py::arg("index"))
        .def(
            "approximations",
            [](const DocumentHandle& h, std::size_t i) {
                return to_py(h.document->objects.at(i).approximations);
            },
            py::arg("index"))
        .def_property_readonly("unit", [](const DocumentHandle& h) { return h.document->unit; })
        .def("left_out", [](const DocumentHandle& h) { return to_py(h.document->left_out); })
        .def(
            "to_bytes",
            [](const DocumentHandle& h, std::string_view format, double tolerance) {
                return py::bytes(take(unlocked([&] { return bytes_as(*h.document, format, tolerance); })));
            },
            py::arg("format"), py::arg("tolerance"))
        .def("scene", [](const DocumentHandle& h) { return answer([&] { return scene_of(*h.document); }); });
    m.def(
        "read",
        [](const std::string& path, const std::optional<std::string>& format, double timeout,
           std::uint64_t max_bytes, std::uint64_t max_memory, const std::optional<std::string>& reader,
           bool repair, double repair_limit) {
            ReadOptions options;
            if (format) options.format = enum_of<FileFormat>(*format, "format");
            if (reader && reader != "freiform" && reader != "occt")
                reject(RefusalKind::invalid, "reader", text("\"", *reader, "\" is not freiform or occt"));
            if (reader) options.step_reader = reader == "occt" ? StepReader::occt : StepReader::own;
            options.timeout = timeout, options.max_memory = max_memory;
            options.repair = repair, options.repair_limit = repair_limit;
            if (max_bytes > 0) options.max_bytes = max_bytes;
            return document_handle(take(unlocked([&] { return read_any(path, options); })));
        },
        py::arg("path"), py::arg("format"), py::arg("timeout"), py::arg("max_bytes"), py::arg("max_memory"),
        py::arg("reader"), py::arg("repair"), py::arg("repair_limit"));
    m.def(
        "parse",
        [](std::string_view bytes, std::optional<std::string> format) {
            if (!format) {
                const auto found = format_of_content(bytes);
                if (!found) reject(RefusalKind::unreadable, "data", "say nothing of their format: name it");
                format = name_of(*found);
            }
            return document_handle(take(unlocked([&] { return parsed(bytes, *format); })));
        },
        py::arg("data"), py::arg("format"));
    m.def(
        "write_file",
        [](const std::string& path, std::string_view bytes) {
            answer([&] { return write_file(path, bytes); });
        },
        py::arg("path"), py::arg("data"));
    m.def(
        "read_points",
        [](const std::string& path) {
            const PointTable t = take(unlocked([&] { return read_points(path); }));
            std::vector<py::ssize_t> shape{t.extent[0]};
            if (t.grid) shape.push_back(t.extent[1]);
            shape.push_back(t.coords);
            return array_of(t.values.data(), shape);
        },
        py::arg("path"));
}

}  // namespace freiform::python
