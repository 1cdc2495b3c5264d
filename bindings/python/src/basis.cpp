// Bases of one parameter: knots, and changes of basis as matrices.
#include "handles.hpp"
#include "records/basis/polynomial_basis.hpp"
#include "records/poly/roots.hpp"
#include "records/query/hull.hpp"

#include <freiform/basis/blossom.hpp>
#include <freiform/basis/greville.hpp>
#include <freiform/basis/named.hpp>
#include <freiform/basis/subdivide.hpp>
#include <freiform/poly/predicates.hpp>

namespace freiform::python {
namespace {

std::vector<double> list_of(const Array& a) {
    const auto x = numbers_of(a);
    return {x.begin(), x.end()};
}
// (new basis, matrix)
py::tuple changed(Change<BSplineBasis> change) {
    return py::make_tuple(to_py(change.basis), to_py(change.map));
}

void bind_polynomial(py::module_& m) {
    using B = PolynomialBasis;
    const auto pair = [](std::pair<double, double> on) { return interval_of(on); };
    py::class_<B>(m, "PolynomialBasisHandle")
        .def_static(
            "monomial", [](int degree, double origin) { return take(B::monomial(degree, origin)); },
            py::arg("degree"), py::arg("origin"))
        .def_static(
            "bernstein",
            [=](int degree, std::pair<double, double> on) { return take(B::bernstein(degree, pair(on))); },
            py::arg("degree"), py::arg("on"))
        .def_static(
            "hermite",
            [=](int degree, std::pair<double, double> on) { return take(B::hermite(degree, pair(on))); },
            py::arg("degree"), py::arg("on"))
        .def_static(
            "lagrange", [](const Array& nodes) { return take(B::lagrange(list_of(nodes))); },
            py::arg("nodes"))
        .def_static(
            "newton", [](const Array& nodes) { return take(B::newton(list_of(nodes))); }, py::arg("nodes"))
        .def_static(
            "uniform_b_spline", [](int degree) { return take(B::uniform_b_spline(degree)); },
            py::arg("degree"))
        .def_static(
            "b_spline",
            [](const BSplineBasis& basis, int span) {
                if (span < basis.degree() || span >= basis.size() + basis.wrapped())
                    reject(RefusalKind::invalid, "span", text(span, " is no span of the basis"));
                return take(B::b_spline(basis, span));
            },
            py::arg("basis"), py::arg("span"))
        .def_property_readonly("scheme", [](const B& b) { return std::string(name_of(b.scheme())); })
        .def_property_readonly("degree", &B::degree)
        .def_property_readonly("numbers", [](const B& b) { return to_py(b.numbers()); })
        .def(
            "values", [](const B& b, double t) { return to_py(b.values(t)); }, py::arg("t"))
        .def(
            "equals", [](const B& a, const B& b) { return a == b; }, py::arg("other"));
    m.def(
        "change_basis",
        [](const B& from, const B& to) { return answer([&] { return change_basis(from, to); }); },
        py::arg("from_"), py::arg("to"));
    m.def(
        "convert_coefficients",
        [](const B& from, const B& to, const Array& coefficients) {
            const py::ssize_t columns = coefficients.ndim() == 2 ? coefficients.shape(1) : 1;
            if (coefficients.ndim() < 1 || coefficients.ndim() > 2 || coefficients.shape(0) != from.size())
                reject(RefusalKind::invalid, "coefficients", text(from.size(), " rows are needed"));
            auto found = take(unlocked(
                [&] { return convert_coefficients(from, to, numbers_of(coefficients), int(columns)); }));
            py::array_t<double> value({py::ssize_t(to.size()), columns}),
                bound({py::ssize_t(to.size()), columns});
            for (std::size_t i = 0; i < found.values.size(); ++i)
                value.mutable_data()[i] = found.values[i].value,
                bound.mutable_data()[i] = found.values[i].bound;
            return py::make_tuple(value, bound, found.condition);
        },
        py::arg("from_"), py::arg("to"), py::arg("coefficients"));
    for (const NamedMatrix& named : kNamedMatrices) {
        py::array_t<double> a({4, 4});
        std::memcpy(a.mutable_data(), named.matrix.data(), 16 * sizeof(double));
        m.attr(("matrix_" + std::string(named.name)).c_str()) = a;
    }
    m.def(
        "kochanek_bartels_matrix",
        [](std::array<double, 3> p2, std::array<double, 3> p3) {
            const Matrix4 k = kochanek_bartels_matrix({p2[0], p2[1], p2[2]}, {p3[0], p3[1], p3[2]});
            return array_of(k[0].data(), {4, 4});
        },
        py::arg("at_p2"), py::arg("at_p3"));
}

}  // namespace

void bind_basis(py::module_& m) {
    using B = BSplineBasis;
    py::class_<B>(m, "BasisHandle")
        .def_static(
            "make", [](int degree, const Array& knots) { return take(B::make(degree, list_of(knots))); },
            py::arg("degree"), py::arg("knots"))
        .def_static(
            "periodic",
            [](int degree, const Array& breaks) { return take(B::periodic(degree, list_of(breaks))); },
            py::arg("degree"), py::arg("breaks"))
        .def_static(
            "clamped_uniform", [](int degree, int size) { return take(B::clamped_uniform(degree, size)); },
            py::arg("degree"), py::arg("size"))
        .def_property_readonly("degree", &B::degree)
        .def_property_readonly("size", &B::size)
        .def_property_readonly("is_closed", &B::is_closed)
        .def_property_readonly("knots", [](const B& b) { return to_py(b.knots()); })
        .def_property_readonly("defining", [](const B& b) { return to_py(b.defining()); })
        .def_property_readonly("domain", [](const B& b) { return to_py(b.domain()); })
        .def_property_readonly("breaks", [](const B& b) { return to_py(b.breaks()); })
        .def_property_readonly("greville",
                               [](const B& b) {
                                   std::vector<double> all;
                                   for (int i = 0; b.degree() > 0 && i < b.size(); ++i)
                                       all.push_back(greville(b, i));
                                   return to_py(all);
                               })
        .def("multiplicity", &B::multiplicity, py::arg("u"))
        .def(
            "span", [](const B& b, double u) { return b.span(b.wrap(u)); }, py::arg("u"))
        .def(
            "collocation",
            [](const B& b, const Array& at, int order) {
                if (order < 0) reject(RefusalKind::invalid, "derivative", text(order, " is not an order"));
                for (py::ssize_t i = 0; i < at.size(); ++i)
                    if (!std::isfinite(at.data()[i]))
                        reject(RefusalKind::nonfinite, text("at[", i, "]"), "is not a finite number");
                return to_py(collocation(b, numbers_of(at), order));
            },
            py::arg("at"), py::arg("order"))
        .def(
            "insert_knots",
            [](const B& b, const Array& more) { return changed(take(insert_knots(b, numbers_of(more)))); },
            py::arg("knots"))
        .def(
            "insert_knot", [](const B& b, double u) { return changed(take(insert_knot(b, u))); },
            py::arg("u"))
        .def(
            "blossom",
            [](const B& b, int span, const Array& arguments) {
                const int p = b.degree();
                if (span < p || span >= b.size() + b.wrapped() || !(b.knot(span) < b.knot(span + 1)))
                    reject(RefusalKind::invalid, "span", text(span, " is no span of the basis"));
                if (arguments.ndim() != 1 || arguments.size() != p)
                    reject(RefusalKind::invalid, "arguments", text(p, " are needed"));
                for (py::ssize_t i = 0; i < p; ++i)
                    if (!std::isfinite(arguments.data()[i]))
                        reject(RefusalKind::nonfinite, text("arguments[", i, "]"), "is not a finite number");
                py::array_t<double> weights(p + 1);
                blossom(b, span, arguments.data(), weights.mutable_data());
                return weights;
            },
            py::arg("span"), py::arg("arguments"))
        .def("elevate", [](const B& b) { return changed(take(elevate(b))); })
        .def(
            "restrict_to",
            [](const B& b, std::pair<double, double> on) {
                return changed(take(restrict_to(b, interval_of(on))));
            },
            py::arg("on"))
        .def(
            "extend_to",
            [](const B& b, std::pair<double, double> on) {
                return changed(take(extend_to(b, interval_of(on))));
            },
            py::arg("on"))
        .def("reverse", [](const B& b) { return changed(reverse(b)); })
        .def("differentiate",
             [](const B& b) {
                 if (b.degree() < 1) reject(RefusalKind::invalid, "degree", "is 0");
                 return changed(differentiate(b));
             })
        .def("to_bezier", [](const B& b) { return changed(to_bezier(b)); })
        .def("halve_uniform", [](const B& b) { return changed(take(halve_uniform(b))); })
        .def("local_hulls", [](const B& b) { return to_py(local_hulls(b)); })
        .def(
            "equals", [](const B& a, const B& b) { return a == b; }, py::arg("other"));
    bind_polynomial(m);
    m.def(
        "real_roots",
        [](const Array& c, double width, double error) {
            return answer([&] { return real_roots(numbers_of(c), width, error); });
        },
        py::arg("coefficients"), py::arg("width"), py::arg("error"));
    m.def(
        "orient2d",
        [](const Array& a, const Array& b, const Array& c) {
            return orient2d(vec_of<2>(a, "a"), vec_of<2>(b, "b"), vec_of<2>(c, "c"));
        },
        py::arg("a"), py::arg("b"), py::arg("c"));
    m.def(
        "orient3d",
        [](const Array& a, const Array& b, const Array& c, const Array& d) {
            return orient3d(vec_of<3>(a, "a"), vec_of<3>(b, "b"), vec_of<3>(c, "c"), vec_of<3>(d, "d"));
        },
        py::arg("a"), py::arg("b"), py::arg("c"), py::arg("d"));
    m.def(
        "in_circle",
        [](const Array& a, const Array& b, const Array& c, const Array& d) {
            return in_circle(vec_of<2>(a, "a"), vec_of<2>(b, "b"), vec_of<2>(c, "c"), vec_of<2>(d, "d"));
        },
        py::arg("a"), py::arg("b"), py::arg("c"), py::arg("d"));
}

}  // namespace freiform::python
