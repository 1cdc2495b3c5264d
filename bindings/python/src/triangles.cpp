// Triangular patches.
#include "handles.hpp"
#include "records/core/interval.hpp"
#include "records/make/triangle_joint.hpp"
#include "records/query/bounds.hpp"
#include "records/query/surface_curvature.hpp"
#include "records/query/triangle_joint.hpp"
#include "records/spline/simplex_convert.hpp"

#include <freiform/spline/bezier.hpp>

namespace freiform::python {
namespace {

using Uv = std::array<double, 2>;

int checked_edge(int edge) {
    if (edge < 0 || edge > 2) reject(RefusalKind::invalid, "edge", text(edge, " is not 0, 1 or 2"));
    return edge;
}
void check_numbers(std::span<const double> all, std::string_view where) {
    for (const double x : all)
        if (!std::isfinite(x)) reject(RefusalKind::nonfinite, std::string(where), "is not a finite number");
}

// f(s) for the patch as it is.
template <class F>
py::object visit_triangle(const TriangleHandle& h, F&& f) {
    return std::visit([&](const auto& s) -> py::object { return f(s); }, h.patch);
}
template <class F>
py::object visit_in_space(const TriangleHandle& h, F&& f) {
    return std::visit(
        [&](const auto& s) -> py::object {
            if constexpr (dim_of<CoefficientOf<decltype(s)>> == 3)
                return f(s);
            else
                reject(RefusalKind::unsupported, "triangle", "three coordinates are needed");
        },
        h.patch);
}
// f(a, b) for two patches of one kind.
template <class F>
py::object visit_two(const TriangleHandle& a, const TriangleHandle& b, F&& f) {
    return visit_in_space(a, [&](const auto& s) -> py::object {
        if (const auto* t = std::get_if<std::remove_cvref_t<decltype(s)>>(&b.patch)) return f(s, *t);
        reject(RefusalKind::unsupported, "b", "both triangles must be polynomial, or both rational");
    });
}

TriangleHandle make_triangle(int degree, const Array& points, const std::optional<Array>& weights) {
    return with_dimension(last_extent(points, "points"), "points", [&](auto d) {
        constexpr int D = decltype(d)::value;
        const auto p = points_of<Vec<D>>(points, "points");
        if (!weights) return TriangleHandle{take(Triangle<Vec<D>>::make(degree, {p.begin(), p.end()}))};
        if (weights->size() != py::ssize_t(p.size()))
            reject(RefusalKind::invalid, "weights",
                   text(weights->size(), " weights for ", p.size(), " points"));
        return TriangleHandle{
            take(Triangle<Hom<D>>::make(degree, take(make_rational<D>(p, numbers_of(*weights)))))};
    });
}

// (n, slots, D) or (n, D)
py::object triangle_values(const TriangleHandle& h, const Array& at, int order) {
    if (order < 0 || order > 100)
        reject(RefusalKind::invalid, "derivatives", "is not an order from 0 to 100");
    if (at.ndim() != 2 || at.shape(1) != 2) reject(RefusalKind::invalid, "at", "is not an array of pairs");
    return visit_triangle(h, [&](const auto& s) -> py::object {
        using V = PointOf<CoefficientOf<decltype(s)>>;
        const std::span<const Uv> u(reinterpret_cast<const Uv*>(at.data()), std::size_t(at.shape(0)));
        std::vector<V> points(u.size());
        take(unlocked([&] { return s.evaluate(u, std::span<V>(points)); }));
        if (order == 0) return to_py(points);
        const py::ssize_t slots = py::ssize_t(jet_size(2, order));
        py::array_t<double> out({at.shape(0), slots, py::ssize_t(V::kCoords)});
        double* to = out.mutable_data();
        unlocked([&] {
            for (const Uv& p : u)
                for (const V& v : s.derivatives(p, order))
                    for (int c = 0; c < V::kCoords; ++c) *to++ = v[c];
            return 0;
        });
        return out;
    });
}

template <class P>
std::vector<P> free_of(const Array& a) {
    if (a.size() == 0) return {};
    const auto p = points_of<P>(a, "free");
    return {p.begin(), p.end()};
}

void bind_triangle_joints(py::module_& m) {
    m.def(
        "triangle_next_c",
        [](const TriangleHandle& h, int edge, int order, Uv apex, const Array& free) {
            checked_edge(edge);
            return visit_in_space(h, [&](const auto& s) {
                auto more = free_of<CoefficientOf<decltype(s)>>(free);
                return answer([&] { return next_c(s, edge, order, apex, more); });
            });
        },
        py::arg("triangle"), py::arg("edge"), py::arg("order"), py::arg("apex"), py::arg("free"));
    m.def(
        "triangle_next_g1",
        [](const TriangleHandle& h, int edge, Uv lambda, Uv gamma, const Array& free) {
            checked_edge(edge);
            return visit_in_space(h, [&](const auto& s) {
                auto more = free_of<CoefficientOf<decltype(s)>>(free);
                return answer([&] { return next_g1(s, edge, TangentChange{lambda, gamma}, more); });
            });
        },
        py::arg("triangle"), py::arg("edge"), py::arg("lambda_"), py::arg("gamma"), py::arg("free"));
    m.def(
        "point_normal_triangle",
        [](const Array& points, const Array& normals) {
            const auto p = points_of<Vec<3>>(points, "points"), n = points_of<Vec<3>>(normals, "normals");
            if (p.size() != 3 || n.size() != 3) reject(RefusalKind::invalid, "points", "three are needed");
            return answer([&] { return point_normal_triangle({p[0], p[1], p[2]}, {n[0], n[1], n[2]}); });
        },
        py::arg("points"), py::arg("normals"));
    m.def(
        "triangle_joint",
        [](const TriangleHandle& a, int edge_a, const TriangleHandle& b, int edge_b) {
            checked_edge(edge_a), checked_edge(edge_b);
            return visit_two(a, b, [&](const auto& s, const auto& t) {
                return answer([&] { return triangle_joint(s, edge_a, t, edge_b); });
            });
        },
        py::arg("a"), py::arg("edge_a"), py::arg("b"), py::arg("edge_b"));
    m.def(
        "c1_deviation",
        [](const TriangleHandle& a, int edge_a, const TriangleHandle& b, int edge_b, Uv apex) {
            checked_edge(edge_a), checked_edge(edge_b);
            return visit_two(a, b, [&](const auto& s, const auto& t) {
                return answer([&] { return c1_deviation(s, edge_a, t, edge_b, apex); });
            });
        },
        py::arg("a"), py::arg("edge_a"), py::arg("b"), py::arg("edge_b"), py::arg("apex"));
}

}  // namespace

void bind_triangles(py::module_& m) {
    py::class_<TriangleHandle>(m, "TriangleHandle")
        .def_static("make", &make_triangle, py::arg("degree"), py::arg("points"), py::arg("weights"))
        .def_static(
            "from_homogeneous",
            [](int degree, const Array& c) {
                return with_dimension(last_extent(c, "coefficients") - 1, "coefficients", [&](auto d) {
                    using P = Hom<decltype(d)::value>;
                    const auto p = points_of<P>(c, "coefficients");
                    return TriangleHandle{take(Triangle<P>::make(degree, {p.begin(), p.end()}))};
                });
            },
            py::arg("degree"), py::arg("coefficients"))
        .def_property_readonly("degree",
                               [](const TriangleHandle& h) {
                                   return std::visit([](const auto& s) { return s.degree(); }, h.patch);
                               })
        .def_property_readonly(
            "is_rational",
            [](const TriangleHandle& h) {
                return std::visit([](const auto& s) { return Space<CoefficientOf<decltype(s)>>::kRational; },
                                  h.patch);
            })
        .def("coefficients",
             [](const TriangleHandle& h) {
                 return visit_triangle(h, [](const auto& s) { return to_py(s.coefficients()); });
             })
        .def(
            "equals", [](const TriangleHandle& a, const TriangleHandle& b) { return a.patch == b.patch; },
            py::arg("other"))
        .def("value_error_bound", [](const TriangleHandle& h) {
            return std::visit([](const auto& s) { return s.value_error_bound(); }, h.patch);
        });
    m.def("triangle_evaluate", &triangle_values, py::arg("triangle"), py::arg("at"), py::arg("order"));
    m.def(
        "triangle_elevate",
        [](const TriangleHandle& h) {
            return visit_triangle(h, [](const auto& s) { return answer([&] { return elevate(s); }); });
        },
        py::arg("triangle"));
    m.def(
        "triangle_restrict_to",
        [](const TriangleHandle& h, std::array<Uv, 3> corners) {
            for (const Uv& p : corners) check_numbers(p, "corners");
            return visit_triangle(
                h, [&](const auto& s) { return answer([&] { return restrict_to(s, corners); }); });
        },
        py::arg("triangle"), py::arg("corners"));
    m.def(
        "triangle_split_at",
        [](const TriangleHandle& h, Uv u) {
            check_numbers(u, "at");
            return visit_triangle(h, [&](const auto& s) { return answer([&] { return split_at(s, u); }); });
        },
        py::arg("triangle"), py::arg("at"));
    m.def(
        "triangle_split_in_four",
        [](const TriangleHandle& h) {
            return visit_triangle(h, [](const auto& s) { return answer([&] { return split_in_four(s); }); });
        },
        py::arg("triangle"));
    m.def(
        "triangle_split_edge",
        [](const TriangleHandle& h, int edge, double at) {
            checked_edge(edge);
            if (!(at > 0 && at < 1))
                reject(RefusalKind::out_of_domain, "at", text(at, " is not inside (0, 1)"));
            return visit_triangle(
                h, [&](const auto& s) { return answer([&] { return split_edge(s, edge, at); }); });
        },
        py::arg("triangle"), py::arg("edge"), py::arg("at"));
    m.def(
        "triangle_boundary",
        [](const TriangleHandle& h, int edge) {
            checked_edge(edge);
            return visit_triangle(h, [&](const auto& s) { return to_py(boundary(s, edge)); });
        },
        py::arg("triangle"), py::arg("edge"));
    m.def(
        "triangle_reversed",
        [](const TriangleHandle& h) {
            return visit_triangle(h, [](const auto& s) { return to_py(reversed(s)); });
        },
        py::arg("triangle"));
    m.def(
        "triangle_reduce_degree",
        [](const TriangleHandle& h, double tolerance) {
            return visit_triangle(
                h, [&](const auto& s) { return answer([&] { return reduce_degree(s, tolerance); }); });
        },
        py::arg("triangle"), py::arg("tolerance"));
    m.def(
        "triangle_normal",
        [](const TriangleHandle& h, Uv u) {
            return visit_in_space(h, [&](const auto& s) { return answer([&] { return normal(s, u); }); });
        },
        py::arg("triangle"), py::arg("at"));
    m.def(
        "triangle_curvature",
        [](const TriangleHandle& h, Uv u) {
            return visit_in_space(
                h, [&](const auto& s) { return answer([&] { return surface_curvature(s, u); }); });
        },
        py::arg("triangle"), py::arg("at"));
    m.def(
        "triangle_to_surface",
        [](const TriangleHandle& h) {
            return visit_triangle(h, [](const auto& s) { return answer([&] { return to_surface(s); }); });
        },
        py::arg("triangle"));
    m.def(
        "triangle_to_three_surfaces",
        [](const TriangleHandle& h, Uv centre) {
            return visit_triangle(
                h, [&](const auto& s) { return answer([&] { return to_three_surfaces(s, centre); }); });
        },
        py::arg("triangle"), py::arg("centre"));
    m.def(
        "surface_to_triangles",
        [](const SurfaceHandle& h) {
            return std::visit(
                [](const auto& s) {
                    using P = CoefficientOf<decltype(s)>;
                    const auto pieces = decompose(s);
                    if (pieces.extent() != Index<2>{1, 1})
                        reject(RefusalKind::unsupported, "surface", "has several pieces");
                    const auto piece = pieces.piece({0, 0});
                    return answer(
                        [&] { return to_triangles(static_cast<const Surface<P, Bernstein>&>(piece)); });
                },
                *h.patch);
        },
        py::arg("surface"));
    m.def(
        "triangle_tight_box",
        [](const TriangleHandle& h, double accuracy, int max_pieces) {
            return visit_triangle(
                h, [&](const auto& s) { return answer([&] { return tight_box(s, accuracy, max_pieces); }); });
        },
        py::arg("triangle"), py::arg("accuracy"), py::arg("max_pieces"));
    m.def(
        "triangle_construction",
        [](const TriangleHandle& h, Uv u) {
            return visit_triangle(h, [&](const auto& s) -> py::object {
                using P = CoefficientOf<decltype(s)>;
                const auto all = take(de_casteljau(s, u));
                py::list levels;
                for (int r = 0; r <= all.degree(); ++r) {
                    std::vector<PointOf<P>> points;
                    for (const P& b : all.level(r)) points.push_back(project(b));
                    levels.append(to_py(points));
                }
                return py::make_tuple(levels, all.bound());
            });
        },
        py::arg("triangle"), py::arg("at"));
    m.def(
        "triangle_blossom",
        [](const TriangleHandle& h, const Array& arguments) {
            const auto given = points_of<Vec<2>>(arguments, "arguments");
            std::vector<Param<2>> at;
            for (const Vec<2>& u : given) check_numbers(u.c, "arguments"), at.push_back(u.c);
            return visit_triangle(h, [&](const auto& s) -> py::object {
                if (at.size() != std::size_t(s.degree()))
                    reject(RefusalKind::invalid, "arguments", text(s.degree(), " are needed"));
                return to_py(blossom(s, std::span<const Param<2>>(at)));
            });
        },
        py::arg("triangle"), py::arg("arguments"));
    m.def(
        "triangle_directional",
        [](const TriangleHandle& h, Uv u, const Array& directions) {
            check_numbers(u, "at");
            return visit_triangle(h, [&](const auto& s) {
                return to_py(derivative(s, u, points_of<Vec<2>>(directions, "directions")));
            });
        },
        py::arg("triangle"), py::arg("at"), py::arg("directions"));
    bind_triangle_joints(m);
}

}  // namespace freiform::python
