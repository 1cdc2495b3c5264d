// Interpolation and approximation.
#include "records/fit/interpolate.hpp"
#include "records/fit/least_squares.hpp"

#include <freiform/fit/approximate.hpp>
#include <freiform/fit/bicubic.hpp>
#include <freiform/fit/local.hpp>

namespace freiform::python {
namespace {

// f(number of coordinates).
template <class F>
py::object with_fit_points(const Array& a, F&& f) {
    return with_dimension(last_extent(a, "points"), "points", [&](auto d) -> py::object { return f(d); });
}
template <std::size_t N>
std::array<AxisSpline, N> spline_axes(const std::vector<py::tuple>& given, std::vector<Array>& keep) {
    if (given.size() != N) reject(RefusalKind::invalid, "axes", text(N, " are needed"));
    std::array<AxisSpline, N> axes;
    for (std::size_t d = 0; d < N; ++d) {
        keep.push_back(given[d][2].cast<Array>());
        axes[d] = {given[d][0].cast<int>(), enum_of<SplineEnds>(given[d][1].cast<std::string>(), "ends"),
                   numbers_of(keep.back())};
    }
    return axes;
}

template <std::size_t N>
py::object interpolate_grid(const std::vector<py::tuple>& given, const Array& points) {
    std::vector<Array> keep;
    const auto axes = spline_axes<N>(given, keep);
    return with_fit_points(points, [&](auto d) {
        constexpr int D = decltype(d)::value;
        const auto net = net_of<N, Vec<D>>(points, "points");
        return answer([&] { return interpolate<N, D>(net, axes); });
    });
}

}  // namespace

void bind_fit(py::module_& m) {
    m.def(
        "parameters",
        [](const Array& points, std::string_view spacing, bool closed) {
            const auto how = enum_of<Spacing>(spacing, "spacing");
            return with_fit_points(points, [&](auto d) {
                constexpr int D = decltype(d)::value;
                return answer(
                    [&] { return parameters<D>(points_of<Vec<D>>(points, "points"), how, closed); });
            });
        },
        py::arg("points"), py::arg("spacing"), py::arg("closed"));
    m.def(
        "grid_parameters",
        [](const Array& points, int axis, std::string_view spacing, bool closed) {
            if (axis < 0 || axis > 1) reject(RefusalKind::invalid, "axis", "is neither 0 nor 1");
            const auto how = enum_of<Spacing>(spacing, "spacing");
            return with_fit_points(points, [&](auto d) {
                constexpr int D = decltype(d)::value;
                const auto net = net_of<2, Vec<D>>(points, "points");
                return answer([&] { return parameters<2, D>(net, axis, how, closed); });
            });
        },
        py::arg("points"), py::arg("axis"), py::arg("spacing"), py::arg("closed"));
    m.def(
        "interpolate",
        [](const Array& points, int degree, std::string_view ends, const Array& at,
           const std::optional<Array>& start, const std::optional<Array>& end) {
            const AxisSpline axis{degree, enum_of<SplineEnds>(ends, "ends"), numbers_of(at)};
            return with_fit_points(points, [&](auto d) {
                constexpr int D = decltype(d)::value;
                const auto s = start ? points_of<Vec<D>>(*start, "start") : std::span<const Vec<D>>();
                const auto e = end ? points_of<Vec<D>>(*end, "end") : std::span<const Vec<D>>();
                return answer(
                    [&] { return interpolate<D>(points_of<Vec<D>>(points, "points"), axis, s, e); });
            });
        },
        py::arg("points"), py::arg("degree"), py::arg("ends"), py::arg("at"), py::arg("start"),
        py::arg("end"));
    m.def(
        "interpolate_grid",
        [](const Array& points, const std::vector<py::tuple>& axes) {
            return axes.size() == 3 ? interpolate_grid<3>(axes, points) : interpolate_grid<2>(axes, points);
        },
        py::arg("points"), py::arg("axes"));
    // Values and derivatives on a basis.
    m.def(
        "interpolate_data",
        [](const BSplineBasis& basis, const Array& at, const std::vector<int>& orders, const Array& values) {
            return with_fit_points(values, [&](auto d) {
                constexpr int D = decltype(d)::value;
                const auto v = points_of<Vec<D>>(values, "values");
                if (v.size() != orders.size() || std::size_t(at.size()) != orders.size())
                    reject(RefusalKind::invalid, "values", "at, orders and values have different lengths");
                std::vector<Datum<D>> data;
                for (std::size_t i = 0; i < v.size(); ++i) data.push_back({at.data()[i], orders[i], v[i]});
                return answer([&] { return interpolate<D>(basis, std::span<const Datum<D>>(data)); });
            });
        },
        py::arg("basis"), py::arg("at"), py::arg("orders"), py::arg("values"));
    m.def(
        "averaged_basis",
        [](int degree, const Array& sites) {
            if (degree < 1) reject(RefusalKind::invalid, "degree", "is below 1");
            return answer([&] { return averaged_basis(degree, numbers_of(sites)); });
        },
        py::arg("degree"), py::arg("sites"));
    m.def(
        "least_squares",
        [](const BSplineBasis& basis, const Array& points, const Array& at,
           const std::optional<Array>& weights, double smoothing, int smoothing_order) {
            const LeastSquaresOptions options{weights ? numbers_of(*weights) : std::span<const double>(),
                                              smoothing, smoothing_order};
            return with_fit_points(points, [&](auto d) {
                constexpr int D = decltype(d)::value;
                return answer([&] {
                    return least_squares<D>(basis, points_of<Vec<D>>(points, "points"), numbers_of(at), {},
                                            options);
                });
            });
        },
        py::arg("basis"), py::arg("points"), py::arg("at"), py::arg("weights"), py::arg("smoothing"),
        py::arg("smoothing_order"));
    m.def(
        "least_squares_surface",
        [](const BSplineBasis& u, const BSplineBasis& v, const Array& points, const Array& at_u,
           const Array& at_v) {
            return with_fit_points(points, [&](auto d) {
                constexpr int D = decltype(d)::value;
                const auto net = net_of<2, Vec<D>>(points, "points");
                return answer([&] {
                    return least_squares<D>({u, v}, net, {numbers_of(at_u), numbers_of(at_v)});
                });
            });
        },
        py::arg("u"), py::arg("v"), py::arg("points"), py::arg("at_u"), py::arg("at_v"));
    m.def(
        "approximate",
        [](const Array& points, double tolerance, int degree, bool closed, std::string_view spacing,
           bool move_parameters, double smoothing, int smoothing_order) {
            const ApproximateOptions options{
                tolerance,       degree,    closed,         enum_of<Spacing>(spacing, "spacing"),
                move_parameters, smoothing, smoothing_order};
            return with_fit_points(points, [&](auto d) {
                constexpr int D = decltype(d)::value;
                return answer([&] { return approximate<D>(points_of<Vec<D>>(points, "points"), options); });
            });
        },
        py::arg("points"), py::arg("tolerance"), py::arg("degree"), py::arg("closed"), py::arg("spacing"),
        py::arg("move_parameters"), py::arg("smoothing"), py::arg("smoothing_order"));
    m.def(
        "cubic_through",
        [](const Array& points, const Array& at, std::string_view kind, bool closed) {
            return with_fit_points(points, [&](auto d) {
                constexpr int D = decltype(d)::value;
                const auto p = points_of<Vec<D>>(points, "points");
                if (kind == "catmull_rom") {
                    const Net<1, Vec<D>> net = net_of<1, Vec<D>>(points, "points");
                    return answer([&] { return catmull_rom<1, D>(net, {numbers_of(at)}, {closed}); });
                }
                const auto how = enum_of<LocalSlopes>(kind, "slopes");
                return answer([&]() -> Result<Curve<Vec<D>>> {
                    auto slopes = local_slopes<D>(p, numbers_of(at), how, closed);
                    if (!slopes) return std::unexpected(slopes.error());
                    return cubic_through<D>(p, *slopes, numbers_of(at), closed);
                });
            });
        },
        py::arg("points"), py::arg("at"), py::arg("slopes"), py::arg("closed"));
    m.def(
        "bicubic_through",
        [](const Array& points, const Array& u, const Array& v, std::array<bool, 2> closed,
           std::string_view twists) {
            const auto how = enum_of<Twists>(twists, "twists");
            return with_fit_points(points, [&](auto d) {
                constexpr int D = decltype(d)::value;
                const auto net = net_of<2, Vec<D>>(points, "points");
                return answer([&] {
                    return bicubic_through<D>(net, {numbers_of(u), numbers_of(v)}, closed, how);
                });
            });
        },
        py::arg("points"), py::arg("u"), py::arg("v"), py::arg("closed"), py::arg("twists"));
}

}  // namespace freiform::python
