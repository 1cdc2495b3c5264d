// Triangle meshes: their arrays are views of the library's memory.
#include "records/mesh/level_lines.hpp"
#include "records/mesh/triangle_mesh.hpp"

#include <freiform/io/mesh_file.hpp>
#include <freiform/mesh/refine.hpp>
#include <freiform/mesh/triangle_tree.hpp>
#include <freiform/mesh/triangulate.hpp>

namespace freiform::python {
namespace {

// An array that does not own its numbers but keeps the mesh; it cannot be written to.
template <class T>
py::array array_view(const MeshHandle& h, const T* first, std::vector<py::ssize_t> shape,
                     std::vector<py::ssize_t> strides) {
    auto* keep = new std::shared_ptr<const TriangleMesh>(h.mesh);
    py::capsule owner(keep, [](void* p) { delete static_cast<std::shared_ptr<const TriangleMesh>*>(p); });
    py::array a(py::dtype::of<T>(), std::move(shape), std::move(strides), first, owner);
    py::detail::array_proxy(a.ptr())->flags &= ~py::detail::npy_api::NPY_ARRAY_WRITEABLE_;
    return a;
}
template <class T>
const T* pointer(const std::vector<T>& v) {
    return v.empty() ? nullptr : v.data();
}

TriangleMesh mesh_of(const Array& points,
                     const py::array_t<int, py::array::c_style | py::array::forcecast>& triangles,
                     const std::string& unit) {
    if (triangles.ndim() != 2 || triangles.shape(1) != 3)
        reject(RefusalKind::invalid, "triangles", "is not (n, 3)");
    TriangleMesh mesh;
    const auto p = points_of<Vec<3>>(points, "points");
    mesh.points.assign(p.begin(), p.end());
    mesh.vertices.resize(p.size());
    for (std::size_t i = 0; i < p.size(); ++i) mesh.vertices[i].point = int(i);
    for (py::ssize_t i = 0; i < triangles.shape(0); ++i)
        mesh.triangles.push_back({triangles.at(i, 0), triangles.at(i, 1), triangles.at(i, 2)});
    MeshPart all;
    all.count = int(mesh.triangles.size());
    mesh.parts.push_back(all);
    mesh.unit = unit;
    take(validate(mesh));
    return mesh;
}

// All of a mesh as bytes and tuples, for pickle: the memory of its arrays as it is.
template <class T>
py::bytes bytes_of(const std::vector<T>& v) {
    static_assert(std::is_trivially_copyable_v<T>);
    return {reinterpret_cast<const char*>(v.data()), v.size() * sizeof(T)};
}
template <class T>
std::vector<T> vector_from(const py::handle& h) {
    const std::string_view b = h.cast<std::string_view>();
    if (b.size() % sizeof(T) != 0) reject(RefusalKind::unreadable, "state", "has a part of another length");
    std::vector<T> v(b.size() / sizeof(T));
    if (!v.empty()) std::memcpy(v.data(), b.data(), b.size());
    return v;
}
py::tuple state_of(const TriangleMesh& m) {
    py::list parts;
    for (const MeshPart& p : m.parts) {
        const std::optional<std::array<double, 4>> colour =
            p.colour ? std::optional(std::array{p.colour->r, p.colour->g, p.colour->b, p.colour->a})
                     : std::nullopt;
        parts.append(py::make_tuple(p.name, colour, p.first, p.count, p.face, p.quads));
    }
    return py::make_tuple(bytes_of(m.points), bytes_of(m.vertices), bytes_of(m.triangles), parts, m.unit);
}
TriangleMesh mesh_from(const py::tuple& state) {
    if (state.size() != 5) reject(RefusalKind::unreadable, "state", "is not that of a mesh");
    TriangleMesh m;
    m.points = vector_from<Vec<3>>(state[0]);
    m.vertices = vector_from<MeshVertex>(state[1]);
    m.triangles = vector_from<std::array<int, 3>>(state[2]);
    for (const py::handle& h : state[3]) {
        const auto p =
            h.cast<std::tuple<std::string, std::optional<std::array<double, 4>>, int, int, int, int>>();
        MeshPart part{std::get<0>(p), {}, std::get<2>(p), std::get<3>(p), std::get<4>(p), std::get<5>(p)};
        if (const auto& c = std::get<1>(p)) part.colour = Colour{(*c)[0], (*c)[1], (*c)[2], (*c)[3]};
        m.parts.push_back(std::move(part));
    }
    m.unit = state[4].cast<std::string>();
    take(validate(m));
    return m;
}

void bind_mesh_questions(py::module_& m) {
    using H = MeshHandle;
    m.def(
        "mesh_topology", [](const H& h) { return answer([&] { return topology(*h.mesh); }); },
        py::arg("mesh"));
    m.def(
        "mesh_edges", [](const H& h) { return answer([&] { return edges(*h.mesh); }); }, py::arg("mesh"));
    m.def(
        "mesh_smallest_angles", [](const H& h) { return answer([&] { return smallest_angles(*h.mesh); }); },
        py::arg("mesh"));
    m.def(
        "mesh_level_lines",
        [](const H& h, const Array& values, double level) {
            if (std::size_t(values.size()) != h.mesh->vertices.size())
                reject(RefusalKind::invalid, "values",
                       text("one for each of ", h.mesh->vertices.size(), " vertices is needed"));
            for (py::ssize_t i = 0; i < values.size(); ++i)
                if (!std::isfinite(values.data()[i]))
                    reject(RefusalKind::nonfinite, text("values[", i, "]"), "is not finite");
            return answer([&] { return level_lines(*h.mesh, numbers_of(values), level); });
        },
        py::arg("mesh"), py::arg("values"), py::arg("level"));
    m.def(
        "mesh_outlines",
        [](const H& h, double angle) { return answer([&] { return outlines(*h.mesh, angle); }); },
        py::arg("mesh"), py::arg("angle"));
    m.def(
        "mesh_refined",
        [](const H& h, double longest, std::size_t max_triangles) {
            if (!(longest > 0)) reject(RefusalKind::invalid, "longest", "is not positive");
            return answer([&] { return refined(*h.mesh, longest, max_triangles); });
        },
        py::arg("mesh"), py::arg("longest"), py::arg("max_triangles"));
    // (triangle, distance, point) of each point
    m.def(
        "mesh_nearest",
        [](const H& h, const Array& points) {
            const auto p = points_of<Vec<3>>(points, "points");
            py::array_t<std::int64_t> triangle(py::ssize_t(p.size()));
            py::array_t<double> distance(py::ssize_t(p.size())),
                point({py::ssize_t(p.size()), py::ssize_t(3)});
            auto* t = triangle.mutable_data();
            double *d = distance.mutable_data(), *x = point.mutable_data();
            unlocked([&] {
                std::vector<Triangle3> all;
                for (std::size_t i = 0; i < h.mesh->triangles.size(); ++i) {
                    const auto v = h.mesh->points_of(i);
                    all.push_back({h.mesh->points[std::size_t(v[0])], h.mesh->points[std::size_t(v[1])],
                                   h.mesh->points[std::size_t(v[2])]});
                }
                const TriangleTree tree(std::move(all));
                for (std::size_t i = 0; i < p.size(); ++i) {
                    const auto found = tree.nearest(p[i]);
                    t[i] = found.triangle, d[i] = found.distance;
                    for (int k = 0; k < 3; ++k) x[3 * i + std::size_t(k)] = found.point[k];
                }
                return 0;
            });
            return py::make_tuple(triangle, distance, point);
        },
        py::arg("mesh"), py::arg("points"));
    m.def(
        "triangulate",
        [](const Array& points, const std::vector<std::array<int, 2>>& segments) {
            std::vector<Triangulation::Segment> all;
            for (const auto& s : segments) all.push_back({s[0], s[1]});
            const auto p = points_of<Vec<2>>(points, "points");
            auto t = take(unlocked([&] { return Triangulation::make(p, all); }));
            std::vector<std::array<int, 3>> inside;
            for (int i = 0; i < t.size(); ++i)
                if (!t.is_infinite(i) && (segments.empty() || t.is_inside(i)))
                    inside.push_back(t.vertices(i));
            py::array_t<int> out({py::ssize_t(inside.size()), py::ssize_t(3)});
            if (!inside.empty())
                std::memcpy(out.mutable_data(), inside.data(), inside.size() * sizeof inside[0]);
            return out;
        },
        py::arg("points"), py::arg("segments"));
}

}  // namespace

void bind_meshes(py::module_& m) {
    using H = MeshHandle;
    py::class_<H>(m, "MeshHandle")
        .def(py::init([](const Array& points,
                         const py::array_t<int, py::array::c_style | py::array::forcecast>& triangles,
                         const std::string& unit) {
                 return H{std::make_shared<const TriangleMesh>(mesh_of(points, triangles, unit))};
             }),
             py::arg("points"), py::arg("triangles"), py::arg("unit"))
        .def("points",
             [](const H& h) {
                 const auto& p = h.mesh->points;
                 return array_view(h, p.empty() ? nullptr : p[0].c.data(), {py::ssize_t(p.size()), 3},
                                   {py::ssize_t(sizeof(Vec<3>)), sizeof(double)});
             })
        .def("triangles",
             [](const H& h) {
                 const auto& t = h.mesh->triangles;
                 return array_view(h, t.empty() ? nullptr : t[0].data(), {py::ssize_t(t.size()), 3},
                                   {py::ssize_t(sizeof(t[0])), sizeof(int)});
             })
        .def("vertex_points",
             [](const H& h) {
                 const auto* v = pointer(h.mesh->vertices);
                 return array_view(h, v ? &v->point : nullptr, {py::ssize_t(h.mesh->vertices.size())},
                                   {py::ssize_t(sizeof(MeshVertex))});
             })
        .def("normals",
             [](const H& h) {
                 const auto* v = pointer(h.mesh->vertices);
                 return array_view(h, v ? v->normal.c.data() : nullptr,
                                   {py::ssize_t(h.mesh->vertices.size()), 3},
                                   {py::ssize_t(sizeof(MeshVertex)), sizeof(double)});
             })
        .def("uv",
             [](const H& h) {
                 const auto* v = pointer(h.mesh->vertices);
                 return array_view(h, v ? v->uv.c.data() : nullptr, {py::ssize_t(h.mesh->vertices.size()), 2},
                                   {py::ssize_t(sizeof(MeshVertex)), sizeof(double)});
             })
        .def("state", [](const H& h) { return state_of(*h.mesh); })
        .def_static(
            "from_state",
            [](const py::tuple& state) { return H{std::make_shared<const TriangleMesh>(mesh_from(state))}; },
            py::arg("state"))
        .def("parts", [](const H& h) { return to_py(h.mesh->parts); })
        .def_property_readonly("unit", [](const H& h) { return h.mesh->unit; })
        .def(
            "to_bytes",
            [](const H& h, std::string_view format) {
                const MeshFormat f = take(mesh_format(format));
                return py::bytes(take(unlocked([&] {
                    return f == MeshFormat::glb   ? to_glb(*h.mesh)
                           : f == MeshFormat::stl ? to_stl(*h.mesh)
                           : f == MeshFormat::obj ? to_obj(*h.mesh)
                                                  : to_ply(*h.mesh);
                })));
            },
            py::arg("format"))
        .def_static(
            "from_bytes",
            [](std::string_view bytes, std::string_view format) {
                const MeshFormat f = take(mesh_format(format));
                return H{std::make_shared<const TriangleMesh>(
                    take(unlocked([&] { return parse_mesh(bytes, f, "mesh"); })))};
            },
            py::arg("data"), py::arg("format"))
        .def(
            "write",
            [](const H& h, const std::string& path) { answer([&] { return write_mesh(*h.mesh, path); }); },
            py::arg("path"))
        .def_static(
            "read",
            [](const std::string& path) {
                return H{
                    std::make_shared<const TriangleMesh>(take(unlocked([&] { return read_mesh(path); })))};
            },
            py::arg("path"));
    bind_mesh_questions(m);
}

}  // namespace freiform::python
