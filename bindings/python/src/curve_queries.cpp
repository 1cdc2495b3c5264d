// Questions about curves: lengths, features, crossings, joints, places where a curve meets itself.
#include "records/query/continuity.hpp"
#include "records/query/crossings.hpp"
#include "records/query/features.hpp"
#include "records/query/implicit.hpp"
#include "records/query/length.hpp"
#include "records/query/reparametrise.hpp"
#include "records/query/self_intersection.hpp"

#include <freiform/spline/bezier.hpp>

namespace freiform::python {
namespace {

void check_accuracy(double accuracy) {
    if (!(accuracy >= 0)) reject(RefusalKind::invalid, "accuracy", text(accuracy, " is not a length >= 0"));
}

// ArcLength of curves of any kind.
struct ArcLengthHandle {
    std::variant<ArcLength<Vec<1>>, ArcLength<Vec<2>>, ArcLength<Vec<3>>, ArcLength<Vec<4>>,
                 ArcLength<Hom<1>>, ArcLength<Hom<2>>, ArcLength<Hom<3>>, ArcLength<Hom<4>>>
        length;
};

// Parameters and bounds as two arrays.
py::tuple arrays_of(std::span<const PlaceAtLength> places) {
    py::array_t<double> at(py::ssize_t(places.size())), bound(py::ssize_t(places.size()));
    for (std::size_t i = 0; i < places.size(); ++i)
        at.mutable_data()[i] = places[i].parameter, bound.mutable_data()[i] = places[i].bound;
    return py::make_tuple(at, bound);
}

// f(ask, x) -> Result<T{value, bound}> for each number of an array; two arrays of its shape.
template <class T, class F>
py::tuple for_each(const Array& numbers, F&& f) {
    const std::vector<py::ssize_t> shape(numbers.shape(), numbers.shape() + numbers.ndim());
    py::array_t<double> value(shape), bound(shape);
    double *v = value.mutable_data(), *b = bound.mutable_data();
    const double* x = numbers.data();
    const std::size_t n = std::size_t(numbers.size());
    take(unlocked([&]() -> Result<void> {
        for (std::size_t i = 0; i < n; ++i) {
            auto r = f(x[i]);
            if (!r) return refuse_within(text("[", i, "]"), r.error());
            if constexpr (std::same_as<T, Measure>)
                v[i] = r->value, b[i] = r->bound;
            else
                v[i] = r->parameter, b[i] = r->bound;
        }
        return {};
    }));
    return py::make_tuple(value, bound);
}

void bind_arc_length(py::module_& m) {
    using H = ArcLengthHandle;
    py::class_<H>(m, "ArcLengthHandle")
        .def(py::init([](const CurveHandle& h, double accuracy) {
                 check_accuracy(accuracy);
                 return unlocked([&] {
                     return std::visit(
                         [&](const auto& p) { return H{ArcLength<CoefficientOf<decltype(p)>>(p, accuracy)}; },
                         *h.patch);
                 });
             }),
             py::arg("curve"), py::arg("accuracy"))
        .def("total",
             [](const H& h) { return std::visit([](const auto& s) { return to_py(s.total()); }, h.length); })
        .def(
            "between",
            [](const H& h, std::pair<double, double> on) {
                return std::visit(
                    [&](const auto& s) { return answer([&] { return s.total(interval_of(on)); }); },
                    h.length);
            },
            py::arg("on"))
        .def(
            "at",
            [](const H& h, const Array& t) {
                return std::visit(
                    [&](const auto& s) { return for_each<Measure>(t, [&](double x) { return s.at(x); }); },
                    h.length);
            },
            py::arg("t"))
        .def(
            "parameter",
            [](const H& h, const Array& length) {
                return std::visit(
                    [&](const auto& s) {
                        return for_each<PlaceAtLength>(length, [&](double x) { return s.parameter(x); });
                    },
                    h.length);
            },
            py::arg("length"))
        .def(
            "equal_parts",
            [](const H& h, int n) {
                return std::visit(
                    [&](const auto& s) {
                        return arrays_of(take(unlocked([&] { return s.equal_parts(n); })));
                    },
                    h.length);
            },
            py::arg("n"))
        .def(
            "spaced",
            [](const H& h, double d) {
                return std::visit(
                    [&](const auto& s) { return arrays_of(take(unlocked([&] { return s.spaced(d); }))); },
                    h.length);
            },
            py::arg("distance"));
    m.def(
        "by_arc_length",
        [](const CurveHandle& h, double tolerance, int max_pieces) {
            return visit_dims<1, 4>(*h.patch, "curve", [&](const auto& p) {
                return answer([&] { return by_arc_length(p, tolerance, max_pieces); });
            });
        },
        py::arg("curve"), py::arg("tolerance"), py::arg("max_pieces"));
}

void bind_features(py::module_& m) {
    m.def(
        "crossings",
        [](const CurveHandle& h, const Array& normal, double offset, double accuracy) {
            return visit_dims<1, 3>(*h.patch, "curve", [&](const auto& p) {
                const auto n = vec_of<dim_of<CoefficientOf<decltype(p)>>>(normal, "normal");
                return answer([&] { return crossings(p, n, offset, accuracy); });
            });
        },
        py::arg("curve"), py::arg("normal"), py::arg("offset"), py::arg("accuracy"));
    m.def(
        "inflections",
        [](const CurveHandle& h, double accuracy) {
            return visit_dims<2, 3>(*h.patch, "curve", [&](const auto& p) {
                return answer([&] { return inflections(p, accuracy); });
            });
        },
        py::arg("curve"), py::arg("accuracy"));
    m.def(
        "cusps",
        [](const CurveHandle& h, double accuracy) {
            return visit_dims<2, 3>(
                *h.patch, "curve", [&](const auto& p) { return answer([&] { return cusps(p, accuracy); }); });
        },
        py::arg("curve"), py::arg("accuracy"));
    m.def(
        "extrema",
        [](const CurveHandle& h, const Array& direction, double accuracy) {
            return visit_dims<1, 3>(*h.patch, "curve", [&](const auto& p) {
                const auto n = vec_of<dim_of<CoefficientOf<decltype(p)>>>(direction, "direction");
                return answer([&] { return extrema(p, n, accuracy); });
            });
        },
        py::arg("curve"), py::arg("direction"), py::arg("accuracy"));
    m.def(
        "vertices",
        [](const CurveHandle& h, double accuracy) {
            return visit_dims<2, 2>(*h.patch, "curve", [&](const auto& p) {
                return answer([&] { return vertices(p, accuracy); });
            });
        },
        py::arg("curve"), py::arg("accuracy"));
    m.def(
        "self_intersections",
        [](const CurveHandle& h, double accuracy, int max_pairs) {
            return visit_dims<2, 3>(*h.patch, "curve", [&](const auto& p) {
                return answer([&] { return self_intersections(p, accuracy, max_pairs); });
            });
        },
        py::arg("curve"), py::arg("accuracy"), py::arg("max_pairs"));
    py::class_<Implicit>(m, "ImplicitHandle")
        .def(py::init([](const CurveHandle& h) {
                 std::optional<Implicit> made;
                 visit_dims<2, 2>(*h.patch, "curve", [&](const auto& p) -> py::object {
                     const auto pieces = decompose(p);
                     if (pieces.extent()[0] != 1)
                         reject(RefusalKind::unsupported, "curve", "has several pieces");
                     made = take(unlocked([&] { return Implicit::make(pieces.piece({0})); }));
                     return py::none();
                 });
                 return *made;
             }),
             py::arg("curve"))
        .def_property_readonly("degree", &Implicit::degree)
        .def_property_readonly("traces", &Implicit::traces)
        .def(
            "value",
            [](const Implicit& f, const Array& at) {
                const Vec<2> p = vec_of<2>(at, "at");
                if (!is_finite(p)) reject(RefusalKind::nonfinite, "at", "is not finite");
                return to_py(f(p));
            },
            py::arg("at"))
        .def(
            "sign",
            [](const Implicit& f, const Array& at) {
                const Vec<2> p = vec_of<2>(at, "at");
                if (!is_finite(p)) reject(RefusalKind::nonfinite, "at", "is not finite");
                return f.sign(p);
            },
            py::arg("at"))
        .def("terms", [](const Implicit& f) { return answer([&] { return f.terms(); }); });
}

// (orders, tolerance, angle, curvature, third, roundings)
ContinuityOptions continuity_options(const std::tuple<int, double, double, double, double, double>& o) {
    return {std::get<0>(o), std::get<1>(o), std::get<2>(o), std::get<3>(o), std::get<4>(o), std::get<5>(o)};
}

void bind_continuity(py::module_& m) {
    using Options = std::tuple<int, double, double, double, double, double>;
    m.def(
        "continuity",
        [](const CurveHandle& h, const Options& o) {
            return std::visit(
                [&](const auto& p) { return answer([&] { return continuity(p, continuity_options(o)); }); },
                *h.patch);
        },
        py::arg("curve"), py::arg("options"));
    m.def(
        "joint",
        [](const CurveHandle& a, const CurveHandle& b, const Options& o) {
            const std::vector<CurveHandle> both{a, b};
            return with_common<1, 4, 1>(both, "curves", [&](const auto& c) {
                return answer([&] { return joint(c[0], c[1], continuity_options(o)); });
            });
        },
        py::arg("first"), py::arg("second"), py::arg("options"));
    m.def(
        "joints",
        [](const std::vector<CurveHandle>& curves, double gap, const Options& o) {
            std::vector<CurveEnds> ends;
            for (const CurveHandle& h : curves)
                std::visit([&](const auto& p) { ends.push_back(ends_of(p, continuity_options(o))); },
                           *h.patch);
            return answer(
                [&] { return joints(std::span<const CurveEnds>(ends), gap, continuity_options(o)); });
        },
        py::arg("curves"), py::arg("gap"), py::arg("options"));
    m.def(
        "reparametrised",
        [](const CurveHandle& h, const Array& phi, double from) {
            if (phi.size() < 2 || !(phi.data()[1] > 0) || !std::isfinite(from))
                reject(RefusalKind::invalid, "phi", "needs a positive derivative phi[1]");
            return std::visit(
                [&](const auto& p) {
                    return answer([&] { return reparametrised(p, numbers_of(phi), from); });
                },
                *h.patch);
        },
        py::arg("curve"), py::arg("phi"), py::arg("from_"));
    m.def(
        "reparametrised_rationally",
        [](const CurveHandle& h, double rate, double second, double from) {
            return std::visit(
                [&](const auto& p) {
                    return answer([&] { return reparametrised_rationally(p, rate, second, from); });
                },
                *h.patch);
        },
        py::arg("curve"), py::arg("rate"), py::arg("second"), py::arg("from_"));
}

}  // namespace

void bind_curve_queries(py::module_& m) {
    bind_arc_length(m);
    bind_features(m);
    bind_continuity(m);
}

}  // namespace freiform::python
