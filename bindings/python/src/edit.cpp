// Curves, surfaces and volumes made into others: knots, degrees, parts, maps.
#include "records/spline/refine.hpp"
#include "records/spline/subdivision.hpp"
#include "records/spline/transform.hpp"

#include <freiform/spline/bezier.hpp>

namespace freiform::python {
namespace {

template <std::size_t N>
int axis_below(int axis) {
    if (axis < 0 || axis >= int(N)) reject(RefusalKind::invalid, "axis", text(axis, " is not below ", N));
    return axis;
}

// f(patch, axis) as a function of Python, with more arguments.
template <std::size_t N, class... More, class F, class... Names>
void def_along(py::module_& m, const char* name, F f, Names... names) {
    m.def(
        name,
        [f](const PatchHandle<N>& h, int axis, More... more) {
            axis_below<N>(axis);
            return std::visit([&](const auto& p) { return answer([&] { return f(p, axis, more...); }); },
                              *h.patch);
        },
        py::arg("patch"), py::arg("axis"), names...);
}

template <std::size_t N>
void bind_with_matrix(py::module_& m) {
    // linear (to, from) and offset (to), or a projectivity (to + 1, from + 1).
    m.def(
        "transform",
        [](const PatchHandle<N>& h, const Array& linear, const Array& offset) {
            return visit_dims<2, 3>(*h.patch, "patch", [&](const auto& p) -> py::object {
                constexpr int D = dim_of<CoefficientOf<decltype(p)>>;
                if (linear.ndim() != 2 || linear.shape(0) != D || linear.shape(1) != D)
                    reject(RefusalKind::invalid, "linear", text("is not a ", D, " x ", D, " matrix"));
                Affinity<D> map;
                for (int i = 0; i < D; ++i)
                    for (int j = 0; j < D; ++j) map.linear[std::size_t(i)][std::size_t(j)] = linear.at(i, j);
                map.offset = vec_of<D>(offset, "offset");
                return answer([&] { return transform(p, map); });
            });
        },
        py::arg("patch"), py::arg("linear"), py::arg("offset"));
    m.def(
        "project",
        [](const PatchHandle<N>& h, const Array& eye, const Array& origin, const Array& across,
           const Array& up) {
            const auto p = as<Hom<3>, N>(*h.patch, "patch");
            const auto map = take(perspective(vec_of<3>(eye, "eye"), vec_of<3>(origin, "origin"),
                                              vec_of<3>(across, "across"), vec_of<3>(up, "up")));
            return answer([&] { return transform(p, map); });
        },
        py::arg("patch"), py::arg("eye"), py::arg("origin"), py::arg("across"), py::arg("up"));
}

template <std::size_t N>
void bind_changes_of(py::module_& m) {
    m.def(
        "insert_knots",
        [](const PatchHandle<N>& h, int axis, const Array& knots) {
            axis_below<N>(axis);
            return std::visit(
                [&](const auto& p) {
                    return answer([&] { return insert_knots(p, axis, numbers_of(knots)); });
                },
                *h.patch);
        },
        py::arg("patch"), py::arg("axis"), py::arg("knots"));
    def_along<N, double>(
        m, "insert_knot", [](const auto& p, int a, double u) { return insert_knot(p, a, u); }, py::arg("u"));
    def_along<N, double>(
        m, "remove_knots", [](const auto& p, int a, double t) { return remove_knots(p, a, t); },
        py::arg("tolerance"));
    def_along<N, double>(
        m, "reduce_degree", [](const auto& p, int a, double t) { return reduce_degree(p, a, t); },
        py::arg("tolerance"));
    m.def(
        "elevate",
        [](const PatchHandle<N>& h, int axis, int by) {
            axis_below<N>(axis);
            if (by < 0) reject(RefusalKind::invalid, "by", text(by, " is negative"));
            return std::visit(
                [&](const auto& p) {
                    return answer([&] { return elevate(p, axis, std::min(by, kMaxDegree + 1)); });
                },
                *h.patch);
        },
        py::arg("patch"), py::arg("axis"), py::arg("by"));
    def_along<N, double, double>(
        m, "restrict_to",
        [](const auto& p, int a, double lo, double hi) {
            return restrict_to(p, a, {lo, hi});
        },
        py::arg("lo"), py::arg("hi"));
    def_along<N, double, double>(
        m, "extend_to",
        [](const auto& p, int a, double lo, double hi) {
            return extend_to(p, a, {lo, hi});
        },
        py::arg("lo"), py::arg("hi"));
    def_along<N, double>(
        m, "split", [](const auto& p, int a, double u) { return split(p, a, u); }, py::arg("u"));
    def_along<N>(m, "reverse", [](const auto& p, int a) { return reverse(p, a); });
    def_along<N>(m, "halve_uniform", [](const auto& p, int a) { return halve_uniform(p, a); });
    m.def(
        "derivative",
        [](const PatchHandle<N>& h, int axis) {
            axis_below<N>(axis);
            return std::visit(
                [&](const auto& p) -> py::object {
                    if constexpr (Space<CoefficientOf<decltype(p)>>::kRational)
                        reject(RefusalKind::unsupported, "patch",
                               "the derivative of a rational patch is no patch");
                    else if (p.basis(axis).degree() < 1)
                        reject(RefusalKind::invalid, "degree", "is 0");
                    else
                        return to_py(derivative(p, axis));
                },
                *h.patch);
        },
        py::arg("patch"), py::arg("axis"));
    // [(box, piece)]
    m.def(
        "decompose",
        [](const PatchHandle<N>& h) {
            return std::visit(
                [](const auto& p) {
                    const auto pieces = unlocked([&] { return decompose(p); });
                    py::list list;
                    each_index(pieces.extent(),
                               [&](const Index<N>& at) { list.append(to_py(pieces.piece(at))); });
                    return list;
                },
                *h.patch);
        },
        py::arg("patch"));
    if constexpr (N >= 2)
        m.def(
            "iso",
            [](const PatchHandle<N>& h, int axis, double at) {
                axis_below<N>(axis);
                return std::visit(
                    [&](const auto& p) {
                        const auto& basis = p.basis(axis);
                        if (!std::isfinite(at) || (!basis.is_closed() && !basis.domain().contains(at)))
                            reject(RefusalKind::out_of_domain, "at",
                                   text(at, " is not in the domain [", basis.domain().lo, ", ",
                                        basis.domain().hi, "]"));
                        return to_py(iso(p, axis, at));
                    },
                    *h.patch);
            },
            py::arg("patch"), py::arg("axis"), py::arg("at"));
    bind_with_matrix<N>(m);
}

}  // namespace

void bind_edit(py::module_& m) {
    bind_changes_of<1>(m);
    bind_changes_of<2>(m);
    bind_changes_of<3>(m);
}

}  // namespace freiform::python
