// Surfaces for graphics cards: buffers as arrays, shaders as text, pictures and points that OpenGL computes.
#include "options.hpp"

#if FREIFORM_HAS_GL
#include <freiform/gpu/surfaces.hpp>
#include <freiform/spline/simplex_convert.hpp>

namespace freiform::python {
namespace {

struct SurfaceBuffersHandle {
    std::shared_ptr<const SurfaceBuffers> buffers;
};
// What holds an OpenGL context: used by one thread at a time.
template <class T>
struct ContextHandle {
    std::shared_ptr<T> object;
    std::shared_ptr<std::mutex> free = std::make_shared<std::mutex>();

    template <class F>
    auto use(F&& f) const {
        return take(unlocked([&] {
            const std::lock_guard alone(*free);
            return f(*object);
        }));
    }
};
using RendererHandle = ContextHandle<SurfaceRenderer>;
using EvaluatorHandle = ContextHandle<SurfaceEvaluator>;

// Arrays of numbers as they are in memory, which the buffers keep; they cannot be written to.
template <class Number, class T>
py::array view_of(const SurfaceBuffersHandle& h, const std::vector<T>& all, std::vector<py::ssize_t> each) {
    py::ssize_t width = 1;
    for (const py::ssize_t n : each) width *= n;
    FF_REQUIRE(sizeof(T) == std::size_t(width) * sizeof(Number));
    auto* keep = new std::shared_ptr<const SurfaceBuffers>(h.buffers);
    py::capsule owner(keep, [](void* p) { delete static_cast<std::shared_ptr<const SurfaceBuffers>*>(p); });
    each.insert(each.begin(), py::ssize_t(all.size()));
    py::array a(py::dtype::of<Number>(), each, all.data(), owner);
    py::detail::array_proxy(a.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
    return a;
}

SurfaceBuffersHandle make_buffers(const ModelHandle& model, double edge_tolerance,
                                  const std::vector<std::pair<TriangleHandle, std::string>>& triangles,
                                  const std::string& colour) {
    std::vector<TriangularFace> faces;
    for (std::size_t i = 0; i < triangles.size(); ++i) {
        const auto& [patch, own] = triangles[i];
        std::optional<Colour> c;
        if (!own.empty()) c = take(colour_named(own));
        std::visit(
            [&](const auto& p) {
                using P = CoefficientOf<decltype(p)>;
                if constexpr (std::same_as<P, Hom<3>>)
                    faces.push_back({p, c});
                else if constexpr (std::same_as<P, Vec<3>>)
                    faces.push_back({to_rational(p), c});
                else
                    reject(RefusalKind::unsupported, text("triangles[", i, "]"),
                           text("has ", dim_of<P>, " coordinates; 3 are needed"));
            },
            patch.patch);
    }
    SurfaceBufferOptions options;
    options.edge_tolerance = edge_tolerance;
    if (!colour.empty()) options.colour = take(colour_named(colour));
    return {std::make_shared<const SurfaceBuffers>(
        take(unlocked([&] { return surface_buffers(*model.model, faces, options); })))};
}

// The points, and the normals or nothing.
py::tuple evaluated(const EvaluatorHandle& h, const Array& at, bool with_normals) {
    const auto parameters = points_of<Vec<2>>(at, "at");
    std::vector<Param<2>> u;
    for (const Vec<2>& p : parameters) u.push_back(p.c);
    std::vector<Vec<3>> points(u.size()), normals(with_normals ? u.size() : 0);
    h.use([&](SurfaceEvaluator& e) { return e.evaluate(u, points, normals); });
    return py::make_tuple(to_py(points), with_normals ? to_py(normals) : py::none());
}

void bind_buffers(py::module_& m) {
    using H = SurfaceBuffersHandle;
    py::class_<H>(m, "SurfaceBuffersHandle")
        .def(py::init(&make_buffers), py::arg("model"), py::arg("edge_tolerance"), py::arg("triangles"),
             py::arg("colour"))
        .def("middle", [](const H& h) { return to_py(h.buffers->middle); })
        .def_property_readonly("size", [](const H& h) { return h.buffers->size; })
        .def_property_readonly("pieces", [](const H& h) { return h.buffers->pieces; })
        .def_property_readonly("faces", [](const H& h) { return h.buffers->faces; })
        .def_property_readonly("tensor_pieces", [](const H& h) { return h.buffers->tensor_pieces; })
        .def_property_readonly("triangles", [](const H& h) { return h.buffers->triangles; })
        .def_property_readonly("face_count", [](const H& h) { return h.buffers->face_count; })
        .def_property_readonly("edge_tolerance", [](const H& h) { return h.buffers->edge_tolerance; })
        .def("texels", [](const H& h) { return view_of<float>(h, h.buffers->texels, {4}); })
        .def("bends", [](const H& h) { return view_of<float>(h, h.buffers->bends, {2}); })
        .def("seams", [](const H& h) { return view_of<SeamSegment>(h, h.buffers->seams, {}); })
        .def("outlines",
             [](const H& h) {
                 return view_of<float>(h, h.buffers->outlines, {2, 3});
             })
        .def("extent", [](const H& h) { return view_of<double>(h, h.buffers->extent, {3}); });
    m.def(
        "shader_source",
        [](std::string_view shader, std::string_view dialect) {
            return shader_source(enum_of<SurfaceShader>(shader, "shader"),
                                 enum_of<GlslDialect>(dialect, "dialect"));
        },
        py::arg("shader"), py::arg("dialect"));
}

}  // namespace

void bind_gpu(py::module_& m) {
    PYBIND11_NUMPY_DTYPE(SeamSegment, from, to, edge_from, edge_to, normal_from, normal_to, other_from,
                         other_to, colour, other_colour);
    PYBIND11_NUMPY_DTYPE(SurfaceVertex, position, normal, at, piece);
    bind_buffers(m);
    py::class_<RendererHandle>(m, "SurfaceRendererHandle")
        .def(py::init([](const SurfaceBuffersHandle& buffers, std::string_view pipeline) {
                 const auto way = enum_of<SurfacePipeline>(pipeline, "pipeline");
                 return RendererHandle{std::make_shared<SurfaceRenderer>(
                     take(unlocked([&] { return SurfaceRenderer::make(*buffers.buffers, way); })))};
             }),
             py::arg("buffers"), py::arg("pipeline"))
        .def(
            "draw",
            [](const RendererHandle& h, double deviation, const py::dict& given) {
                const RenderOptions o = render_options(given);
                return picture_of(h.use([&](SurfaceRenderer& r) { return r.draw(o, deviation); }));
            },
            py::arg("deviation"), py::arg("options"))
        .def(
            "triangles",
            [](const RendererHandle& h, double deviation, const py::dict& given) {
                const RenderOptions o = render_options(given);
                const auto all = h.use([&](SurfaceRenderer& r) { return r.triangles(o, deviation); });
                py::array_t<SurfaceVertex> out({py::ssize_t(all.size() / 3), py::ssize_t(3)});
                if (!all.empty()) std::memcpy(out.mutable_data(), all.data(), all.size() * sizeof all[0]);
                return out;
            },
            py::arg("deviation"), py::arg("options"));
    py::class_<EvaluatorHandle>(m, "SurfaceEvaluatorHandle")
        .def(py::init([](const SurfaceHandle& surface, std::string_view precision) {
                 const auto p = enum_of<ShaderPrecision>(precision, "precision");
                 const auto s = as<Hom<3>, 2>(*surface.patch, "surface");
                 return EvaluatorHandle{std::make_shared<SurfaceEvaluator>(
                     take(unlocked([&] { return SurfaceEvaluator::make(s, p); })))};
             }),
             py::arg("surface"), py::arg("precision"))
        .def("evaluate", &evaluated, py::arg("at"), py::arg("with_normals"));
}

}  // namespace freiform::python
#else
namespace freiform::python {
void bind_gpu(py::module_&) {}  // _gpu.py says so
}  // namespace freiform::python
#endif
