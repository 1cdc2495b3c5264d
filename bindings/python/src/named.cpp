// Curves and surfaces of the named schemes.
#include "records/basis/polynomial_basis.hpp"
#include "records/make/named_curve.hpp"
#include "records/make/named_surface.hpp"

namespace freiform::python {
namespace {

template <class F>
py::object with_named_points(const Array& points, F&& f) {
    return with_dimension(last_extent(points, "points"), "points", [&](auto d) -> py::object {
        return f(points_of<Vec<decltype(d)::value>>(points, "points"));
    });
}
Ring ring_of(bool closed) { return closed ? Ring::closed : Ring::open; }

}  // namespace

void bind_named(py::module_& m) {
    m.def(
        "hermite_spline",
        [](const Array& points, const Array& tangents, const std::optional<Array>& at,
           const std::optional<Array>& leaving) {
            return with_named_points(points, [&](auto p) {
                using V = std::remove_cvref_t<decltype(p[0])>;
                const auto t = points_of<V>(tangents, "tangents");
                const auto u = at ? numbers_of(*at) : std::span<const double>();
                const auto l = leaving ? points_of<V>(*leaving, "leaving") : std::span<const V>();
                return answer([&] { return hermite_spline(p, t, u, l); });
            });
        },
        py::arg("points"), py::arg("tangents"), py::arg("parameters"), py::arg("leaving"));
    m.def(
        "catmull_rom_spline",
        [](const Array& points, bool closed) {
            return with_named_points(
                points, [&](auto p) { return answer([&] { return catmull_rom(p, ring_of(closed)); }); });
        },
        py::arg("points"), py::arg("closed"));
    m.def(
        "cardinal",
        [](const Array& points, double tension, bool closed) {
            return with_named_points(points, [&](auto p) {
                return answer([&] { return cardinal(p, tension, ring_of(closed)); });
            });
        },
        py::arg("points"), py::arg("tension"), py::arg("closed"));
    m.def(
        "kochanek_bartels",
        [](const Array& points, const std::vector<std::array<double, 3>>& settings, bool closed) {
            std::vector<TensionContinuityBias> all;
            for (const auto& s : settings) all.push_back({s[0], s[1], s[2]});
            return with_named_points(points, [&](auto p) {
                return answer([&] {
                    return kochanek_bartels(p, std::span<const TensionContinuityBias>(all), ring_of(closed));
                });
            });
        },
        py::arg("points"), py::arg("settings"), py::arg("closed"));
    m.def(
        "uniform_b_spline",
        [](const Array& points, int degree, bool closed) {
            return with_named_points(points, [&](auto p) {
                return answer([&] { return uniform_b_spline(p, degree, ring_of(closed)); });
            });
        },
        py::arg("points"), py::arg("degree"), py::arg("closed"));
    m.def(
        "from_basis",
        [](const PolynomialBasis& basis, const Array& coefficients, std::pair<double, double> on) {
            return with_named_points(coefficients, [&](auto c) {
                return answer([&] { return from_basis(basis, c, interval_of(on)); });
            });
        },
        py::arg("basis"), py::arg("coefficients"), py::arg("on"));
    m.def(
        "to_basis",
        [](const CurveHandle& h, double u, const PolynomialBasis& basis) {
            if (!std::isfinite(u)) reject(RefusalKind::nonfinite, "u", "is not a finite number");
            return std::visit([&](const auto& p) { return answer([&] { return to_basis(p, u, basis); }); },
                              *h.patch);
        },
        py::arg("curve"), py::arg("u"), py::arg("basis"));
    m.def(
        "interpolating_polynomial",
        [](const Array& points, const Array& nodes) {
            return with_named_points(points, [&](auto p) {
                return answer([&] { return interpolating_polynomial(p, numbers_of(nodes)); });
            });
        },
        py::arg("points"), py::arg("nodes"));
    m.def(
        "from_bases",
        [](const std::vector<PolynomialBasis>& bases, const Array& coefficients,
           const std::array<double, 4>& on) {
            if (bases.size() != 2) reject(RefusalKind::invalid, "bases", "two are needed");
            return with_dimension(
                last_extent(coefficients, "coefficients"), "coefficients", [&](auto d) -> py::object {
                    using V = Vec<decltype(d)::value>;
                    const auto net = net_of<2, V>(coefficients, "coefficients");
                    return answer([&] {
                        return from_bases<2, V>({bases[0], bases[1]}, net,
                                                {Interval{on[0], on[1]}, Interval{on[2], on[3]}});
                    });
                });
        },
        py::arg("bases"), py::arg("coefficients"), py::arg("on"));
    m.def(
        "bicubic",
        [](const Array& geometry, const Array& along_u, const Array& along_v) {
            const auto matrix = [](const Array& a, const char* where) {
                if (a.ndim() != 2 || a.shape(0) != 4 || a.shape(1) != 4)
                    reject(RefusalKind::invalid, where, "is not a 4 x 4 matrix");
                Matrix4 k;
                std::memcpy(k.data(), a.data(), sizeof k);
                return k;
            };
            const Matrix4 mu = matrix(along_u, "along_u"), mv = matrix(along_v, "along_v");
            return with_dimension(last_extent(geometry, "geometry"), "geometry", [&](auto d) -> py::object {
                using V = Vec<decltype(d)::value>;
                const auto g = points_of<V>(geometry, "geometry");
                if (g.size() != 16) reject(RefusalKind::invalid, "geometry", "is not 4 x 4 vectors");
                std::array<std::array<V, 4>, 4> net;
                for (std::size_t i = 0; i < 16; ++i) net[i / 4][i % 4] = g[i];
                return answer([&] { return bicubic<V>(net, mu, mv); });
            });
        },
        py::arg("geometry"), py::arg("along_u"), py::arg("along_v"));
}

}  // namespace freiform::python
