// The construction of de Casteljau and de Boor, A-frames, curves of pieces.
#include "records/spline/a_frame.hpp"
#include "records/spline/compatible.hpp"
#include "records/spline/refine.hpp"

#include <freiform/spline/construction.hpp>

namespace freiform::python {

void bind_construct(py::module_& m) {
    // (levels: arrays of points, first, bound) of a curve
    m.def(
        "construction",
        [](const CurveHandle& h, double t) {
            return std::visit(
                [&](const auto& p) {
                    using P = CoefficientOf<decltype(p)>;
                    const auto c = take(de_boor(p, t));
                    py::list levels;
                    for (int r = 0; r <= c.degree(); ++r) {
                        std::vector<PointOf<P>> points;
                        for (const P& b : c.level(r)) points.push_back(project(b));
                        levels.append(to_py(points));
                    }
                    return py::make_tuple(levels, c.first(), c.bound());
                },
                *h.patch);
        },
        py::arg("curve"), py::arg("t"));
    m.def(
        "a_frames",
        [](const CurveHandle& h) {
            return std::visit([](const auto& p) { return answer([&] { return a_frames(p); }); }, *h.patch);
        },
        py::arg("curve"));
    // Coefficients: points, or weighted points (w x, w) where `rational`.
    const auto with_coefficients = [](const Array& c, bool rational, auto&& f) {
        return with_dimension(
            last_extent(c, "points") - (rational ? 1 : 0), "points", [&](auto d) -> py::object {
                constexpr int D = decltype(d)::value;
                return rational ? f(points_of<Hom<D>>(c, "points")) : f(points_of<Vec<D>>(c, "points"));
            });
    };
    m.def(
        "de_boor_points",
        [=](const Array& bezier, bool rational, const Array& breaks) {
            return with_coefficients(bezier, rational, [&](auto points) {
                return answer([&] { return de_boor_points(points, numbers_of(breaks)); });
            });
        },
        py::arg("bezier"), py::arg("rational"), py::arg("breaks"));
    m.def(
        "join_pieces",
        [=](const Array& c, bool rational, int degree, const Array& breaks, double tolerance) {
            return with_coefficients(c, rational, [&](auto points) {
                return answer([&] { return join_pieces(points, degree, numbers_of(breaks), tolerance); });
            });
        },
        py::arg("coefficients"), py::arg("rational"), py::arg("degree"), py::arg("breaks"),
        py::arg("tolerance"));
    m.def(
        "compatible",
        [](const std::vector<CurveHandle>& curves) {
            return with_common<2, 3, 1>(curves, "curves", [](const auto& all) {
                using P = CoefficientOf<decltype(all[0])>;
                return answer([&] { return compatible<P>(all); });
            });
        },
        py::arg("curves"));
}

}  // namespace freiform::python
