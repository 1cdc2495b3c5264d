// The extension module freiform._core: functions over handles and arrays. The package around it has the
// names, the types and the documentation.
#include "handles.hpp"

#include <freiform/core/parallel.hpp>

namespace freiform::python {

void bind_animate(py::module_&);
void bind_basis(py::module_&);
void bind_colour(py::module_&);
void bind_construct(py::module_&);
void bind_curve_queries(py::module_&);
void bind_draw(py::module_&);
void bind_edit(py::module_&);
void bind_evaluate(py::module_&);
void bind_files(py::module_&);
void bind_fit(py::module_&);
void bind_font(py::module_&);
void bind_gpu(py::module_&);
void bind_intersect(py::module_&);
void bind_joints(py::module_&);
void bind_make_curves(py::module_&);
void bind_make_surfaces(py::module_&);
void bind_meshes(py::module_&);
void bind_models(py::module_&);
void bind_named(py::module_&);
void bind_nearest(py::module_&);
void bind_patches(py::module_&);
void bind_paths(py::module_&);
void bind_surface_queries(py::module_&);
void bind_triangles(py::module_&);

}  // namespace freiform::python

PYBIND11_MODULE(_core, m) {
    using namespace freiform::python;
    m.doc() = "What the package freiform is made of; use that.";
    py::register_exception_translator([](std::exception_ptr p) {
        try {
            if (p) std::rethrow_exception(p);
        } catch (const Thrown& t) {
            const py::object error = to_py(t.refusal);
            PyErr_SetObject(py::type::of(error).ptr(), error.ptr());
        }
    });
    m.def("set_max_threads", &freiform::set_max_threads, py::arg("threads"));
    m.def("max_threads", &freiform::max_threads);
    m.def("instruction_set", [] { return std::string(freiform::instruction_set()); });
    for (auto* bind : {bind_basis,         bind_patches,         bind_evaluate, bind_edit,
                       bind_construct,     bind_triangles,       bind_paths,    bind_make_curves,
                       bind_named,         bind_make_surfaces,   bind_joints,   bind_fit,
                       bind_curve_queries, bind_surface_queries, bind_nearest,  bind_intersect,
                       bind_meshes,        bind_models,          bind_files,    bind_draw,
                       bind_colour,        bind_animate,         bind_font,     bind_gpu})
        bind(m);
}
