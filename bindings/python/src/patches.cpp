// Curves, surfaces and volumes: made from arrays, taken apart into arrays.
#include "handles.hpp"

#include <freiform/spline/weights.hpp>

namespace freiform::python {
namespace {

// Bases as Python has them: (degree, knots, closed); of closed ones the breaks of one period.
template <std::size_t N>
std::array<BSplineBasis, N> bases_of(const std::vector<py::tuple>& given) {
    if (given.size() != N)
        reject(RefusalKind::invalid, "degrees", text("one for each of ", N, " parameters is needed"));
    const auto one = [&](std::size_t d) {
        const Array knots = given[d][1].cast<Array>();
        const auto k = numbers_of(knots);
        std::vector<double> all(k.begin(), k.end());
        auto basis = given[d][2].cast<bool>()
                         ? BSplineBasis::periodic(given[d][0].cast<int>(), std::move(all))
                         : BSplineBasis::make(given[d][0].cast<int>(), std::move(all));
        if (!basis && N > 1) throw Thrown{refuse_within(text("[", d, "]"), basis.error()).error()};
        return take(std::move(basis));
    };
    return [&]<std::size_t... D>(std::index_sequence<D...>) { return std::array<BSplineBasis, N>{one(D)...}; }
    (std::make_index_sequence<N>{});
}

template <std::size_t N>
PatchHandle<N> make_patch(const std::vector<py::tuple>& bases, const Array& points,
                          const std::optional<Array>& weights) {
    return with_dimension(last_extent(points, "points"), "points", [&](auto d) {
        constexpr int D = decltype(d)::value;
        Net<N, Vec<D>> net = net_of<N, Vec<D>>(points, "points");
        auto all = bases_of<N>(bases);
        if (!weights) return PatchHandle<N>(take(Patch<N, Vec<D>>::make(std::move(all), std::move(net))));
        if (weights->size() != points.size() / D)
            reject(RefusalKind::invalid, "weights",
                   text(weights->size(), " weights for ", points.size() / D, " points"));
        auto rational = take(make_rational<D>(std::span<const Vec<D>>(net.flat()), numbers_of(*weights)));
        return PatchHandle<N>(
            take(Patch<N, Hom<D>>::make(std::move(all), Net<N, Hom<D>>(net.extent(), std::move(rational)))));
    });
}

template <std::size_t N>
PatchHandle<N> patch_from_homogeneous(const std::vector<py::tuple>& bases, const Array& coefficients) {
    return with_dimension(last_extent(coefficients, "coefficients") - 1, "coefficients", [&](auto d) {
        using P = Hom<decltype(d)::value>;
        return PatchHandle<N>(
            take(Patch<N, P>::make(bases_of<N>(bases), net_of<N, P>(coefficients, "coefficients"))));
    });
}

template <std::size_t N>
void bind_patch_of(py::module_& m, const char* name) {
    py::class_<PatchHandle<N>> handle(m, name);
    handle.def_static("make", &make_patch<N>, py::arg("bases"), py::arg("points"), py::arg("weights"))
        .def_static("from_homogeneous", &patch_from_homogeneous<N>, py::arg("bases"), py::arg("coefficients"))
        .def_static(
            "positive",
            [](const std::vector<py::tuple>& bases, const Array& coefficients) {
                return with_dimension(
                    last_extent(coefficients, "coefficients") - 1, "coefficients", [&](auto d) {
                        constexpr int D = decltype(d)::value;
                        const auto all = bases_of<N>(bases);
                        const auto net = net_of<N, Hom<D>>(coefficients, "coefficients");
                        auto form = take(unlocked([&] { return positive_weights<N, D>(all, net); }));
                        return py::make_tuple(to_py(form.patch), form.bound, form.inserted, form.negated);
                    });
            },
            py::arg("bases"), py::arg("coefficients"))
        .def_property_readonly(
            "dimension",
            [](const PatchHandle<N>& h) {
                return std::visit([](const auto& p) { return dim_of<CoefficientOf<decltype(p)>>; }, *h.patch);
            })
        .def_property_readonly(
            "is_rational",
            [](const PatchHandle<N>& h) {
                return std::visit([](const auto& p) { return Space<CoefficientOf<decltype(p)>>::kRational; },
                                  *h.patch);
            })
        .def(
            "basis",
            [](const PatchHandle<N>& h, int axis) {
                return std::visit([&](const auto& p) { return p.basis(axis); }, *h.patch);
            },
            py::arg("axis"))
        .def("points",
             [](const PatchHandle<N>& h) {
                 return std::visit(
                     [](const auto& p) -> py::object {
                         using V = PointOf<CoefficientOf<decltype(p)>>;
                         return to_py(Net<N, V>(p.net().extent(), points(p)));
                     },
                     *h.patch);
             })
        .def("coefficients",
             [](const PatchHandle<N>& h) {
                 return std::visit([](const auto& p) { return to_py(p.net()); }, *h.patch);
             })
        .def("weights",
             [](const PatchHandle<N>& h) {
                 return std::visit(
                     [](const auto& p) {
                         const auto w = weights(p);
                         return array_of(w.data(), {p.net().extent().begin(), p.net().extent().end()});
                     },
                     *h.patch);
             })
        .def("to_rational",
             [](const PatchHandle<N>& h) {
                 return std::visit(
                     [](const auto& p) -> py::object {
                         if constexpr (Space<CoefficientOf<decltype(p)>>::kRational)
                             return to_py(p);
                         else
                             return to_py(to_rational(p));
                     },
                     *h.patch);
             })
        .def("in_space",
             [](const PatchHandle<N>& h) {
                 return visit_dims<1, 3>(*h.patch, "patch", [](const auto& p) { return to_py(in_space(p)); });
             })
        .def(
            "equals", [](const PatchHandle<N>& a, const PatchHandle<N>& b) { return *a.patch == *b.patch; },
            py::arg("other"));
}

}  // namespace

void bind_patches(py::module_& m) {
    bind_patch_of<1>(m, "CurveHandle");
    bind_patch_of<2>(m, "SurfaceHandle");
    bind_patch_of<3>(m, "VolumeHandle");
}

}  // namespace freiform::python
