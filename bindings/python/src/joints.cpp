// The next piece: curves and surfaces that join others with C^k or G^k.
#include "handles.hpp"

#include <freiform/make/joint.hpp>
#include <freiform/make/surface_joint.hpp>

namespace freiform::python {
namespace {

SurfaceEdge surface_edge(int axis, std::string_view end) {
    if (axis < 0 || axis > 1)
        reject(RefusalKind::invalid, "edge", text("axis ", axis, " is neither 0 nor 1"));
    return {axis, enum_of<End>(end, "edge")};
}
template <class P>
Net<2, P> rows_of(const Array& free) {
    return free.size() == 0 ? Net<2, P>() : net_of<2, P>(free, "free");
}
ShapeFunctions shape_of(const std::vector<std::vector<double>>& across,
                        const std::vector<std::vector<double>>& along,
                        const std::vector<std::vector<double>>& scale) {
    return {across, along, scale};
}

}  // namespace

void bind_joints(py::module_& m) {
    // `free`: coefficients of the kind that the curve has.
    m.def(
        "next_c",
        [](const CurveHandle& h, int order, const Array& free, std::pair<double, double> on,
           const std::vector<double>& weights) {
            return std::visit(
                [&](const auto& p) {
                    using P = CoefficientOf<decltype(p)>;
                    NextPiece<P> next{interval_of(on), {}, weights};
                    if (free.size() > 0) {
                        const auto f = points_of<P>(free, "free");
                        next.free.assign(f.begin(), f.end());
                    }
                    return answer([&] { return next_c(p, order, next); });
                },
                *h.patch);
        },
        py::arg("previous"), py::arg("order"), py::arg("free"), py::arg("on"), py::arg("weights"));
    m.def(
        "next_g",
        [](const CurveHandle& h, const Array& phi, const Array& free, std::pair<double, double> on,
           const std::vector<double>& weights) {
            return std::visit(
                [&](const auto& p) {
                    using P = CoefficientOf<decltype(p)>;
                    NextPiece<P> next{interval_of(on), {}, weights};
                    if (free.size() > 0) {
                        const auto f = points_of<P>(free, "free");
                        next.free.assign(f.begin(), f.end());
                    }
                    return answer([&] { return next_g(p, numbers_of(phi), next); });
                },
                *h.patch);
        },
        py::arg("previous"), py::arg("phi"), py::arg("free"), py::arg("on"), py::arg("weights"));
    m.def(
        "next_surface_c",
        [](const SurfaceHandle& h, int axis, std::string_view end, int order, const Array& free,
           std::pair<double, double> on) {
            const auto edge = surface_edge(axis, end);
            return visit_dims<3, 3>(*h.patch, "previous", [&](const auto& p) {
                using P = CoefficientOf<decltype(p)>;
                const NextRows<P> next{interval_of(on), rows_of<P>(free)};
                return answer([&] { return next_c(p, edge, order, next); });
            });
        },
        py::arg("previous"), py::arg("axis"), py::arg("end"), py::arg("order"), py::arg("free"),
        py::arg("on"));
    m.def(
        "next_surface_g",
        [](const SurfaceHandle& h, int axis, std::string_view end,
           const std::vector<std::vector<double>>& across, const std::vector<std::vector<double>>& along,
           const std::vector<std::vector<double>>& scale, const Array& free, std::pair<double, double> on) {
            const auto edge = surface_edge(axis, end);
            return visit_dims<3, 3>(*h.patch, "previous", [&](const auto& p) {
                using P = CoefficientOf<decltype(p)>;
                const NextRows<P> next{interval_of(on), rows_of<P>(free)};
                return answer([&] { return next_g(p, edge, shape_of(across, along, scale), next); });
            });
        },
        py::arg("previous"), py::arg("axis"), py::arg("end"), py::arg("across"), py::arg("along"),
        py::arg("scale"), py::arg("free"), py::arg("on"));
    m.def(
        "rejoined",
        [](const SurfaceHandle& a, int axis, std::string_view end, const SurfaceHandle& b, int other_axis,
           std::string_view other_end, bool against, int order) {
            const auto edge = surface_edge(axis, end), other = surface_edge(other_axis, other_end);
            const std::vector<SurfaceHandle> both{a, b};
            return with_common<3, 3, 2>(both, "surfaces", [&](const auto& s) {
                return answer([&] {
                    return rejoined(s[0], edge, s[1], other, against, ShapeFunctions::parametric(order));
                });
            });
        },
        py::arg("previous"), py::arg("axis"), py::arg("end"), py::arg("neighbour"), py::arg("neighbour_axis"),
        py::arg("neighbour_end"), py::arg("against"), py::arg("order"));
}

}  // namespace freiform::python
