// Intersections of curves, surfaces, lines and planes.
#include "records/core/interval.hpp"
#include "records/intersect/contact.hpp"
#include "records/intersect/section.hpp"
#include "records/intersect/surface_surface.hpp"

#include <freiform/intersect/curve_curve.hpp>
#include <freiform/intersect/curve_surface.hpp>

namespace freiform::python {

void bind_intersect(py::module_& m) {
    m.def(
        "intersect_curves",
        [](const CurveHandle& a, const CurveHandle& b, double accuracy, int max_parts) {
            const std::vector<CurveHandle> both{a, b};
            return with_common<2, 3, 1>(both, "curves", [&](const auto& c) {
                return answer([&] { return intersect(c[0], c[1], {accuracy, max_parts}); });
            });
        },
        py::arg("a"), py::arg("b"), py::arg("accuracy"), py::arg("max_parts"));
    // Every curve of `a` with every one of `b`: [[Intersections]]
    m.def(
        "intersect_all_curves",
        [](const std::vector<CurveHandle>& a, const std::vector<CurveHandle>& b, double accuracy,
           int max_parts) {
            std::vector<CurveHandle> all = a;
            all.insert(all.end(), b.begin(), b.end());
            return with_common<2, 3, 1>(all, "curves", [&](const auto& c) -> py::object {
                using P = CoefficientOf<decltype(c[0])>;
                std::vector<IntersectCurve<P>> prepared, first, second;
                for (const auto& curve : c) prepared.emplace_back(curve);
                for (std::size_t i = 0; i < a.size(); ++i)
                    for (std::size_t k = 0; k < b.size(); ++k) {
                        first.push_back(prepared[i]);
                        second.push_back(prepared[a.size() + k]);
                    }
                std::vector<Intersections<dim_of<P>, 2>> found(first.size());
                take(unlocked([&] {
                    return intersect(std::span<const IntersectCurve<P>>(first),
                                     std::span<const IntersectCurve<P>>(second),
                                     std::span<Intersections<dim_of<P>, 2>>(found), {accuracy, max_parts});
                }));
                py::list rows;
                for (std::size_t i = 0; i < a.size(); ++i) {
                    py::list row;
                    for (std::size_t k = 0; k < b.size(); ++k) row.append(to_py(found[i * b.size() + k]));
                    rows.append(row);
                }
                return rows;
            });
        },
        py::arg("a"), py::arg("b"), py::arg("accuracy"), py::arg("max_parts"));
    m.def(
        "intersect_curve_surface",
        [](const CurveHandle& c, const SurfaceHandle& s, double accuracy, int max_parts) {
            const Common kind = common_of<1>(std::span(&c, 1)), other = common_of<2>(std::span(&s, 1));
            const IntersectOptions options{accuracy, max_parts};
            if (kind.rational || other.rational) {
                const auto p = as<Hom<3>, 1>(*c.patch, "curve");
                const auto q = as<Hom<3>, 2>(*s.patch, "surface");
                return answer([&] { return intersect(p, q, options); });
            }
            const auto p = as<Vec<3>, 1>(*c.patch, "curve");
            const auto q = as<Vec<3>, 2>(*s.patch, "surface");
            return answer([&] { return intersect(p, q, options); });
        },
        py::arg("curve"), py::arg("surface"), py::arg("accuracy"), py::arg("max_parts"));
    // Lines point + t direction, t in on.
    m.def(
        "intersect_lines",
        [](const SurfaceHandle& s, const Array& points, const Array& directions, std::pair<double, double> on,
           double accuracy, int max_parts) {
            return visit_dims<3, 3>(*s.patch, "surface", [&](const auto& p) -> py::object {
                const auto from = points_of<Vec<3>>(points, "points"),
                           along = points_of<Vec<3>>(directions, "directions");
                if (from.size() != along.size())
                    reject(RefusalKind::invalid, "directions",
                           text(along.size(), " for ", from.size(), " points"));
                std::vector<StraightLine> lines;
                for (std::size_t i = 0; i < from.size(); ++i)
                    lines.push_back({from[i], along[i], interval_of(on)});
                std::vector<Intersections<3, 3>> found(lines.size());
                take(unlocked([&] {
                    const IntersectSurface<CoefficientOf<decltype(p)>> prepared(p);
                    return prepared.intersect(std::span<const StraightLine>(lines),
                                              std::span<Intersections<3, 3>>(found), {accuracy, max_parts});
                }));
                return to_py(found);
            });
        },
        py::arg("surface"), py::arg("points"), py::arg("directions"), py::arg("on"), py::arg("accuracy"),
        py::arg("max_parts"));
    m.def(
        "section",
        [](const SurfaceHandle& s, const Array& normal, double offset, double tolerance, int max_cells) {
            const Plane plane{vec_of<3>(normal, "normal"), offset};
            return visit_dims<3, 3>(*s.patch, "surface", [&](const auto& p) {
                return answer([&] { return section(p, plane, {tolerance, max_cells}); });
            });
        },
        py::arg("surface"), py::arg("normal"), py::arg("offset"), py::arg("tolerance"), py::arg("max_cells"));
    m.def(
        "intersect_surfaces",
        [](const SurfaceHandle& a, const SurfaceHandle& b, double tolerance, int max_pairs) {
            return visit_dims<3, 3>(*a.patch, "a", [&](const auto& p) {
                return visit_dims<3, 3>(*b.patch, "b", [&](const auto& q) {
                    return answer([&] {
                        return intersect(p, q, SurfaceIntersectOptions{tolerance, max_pairs});
                    });
                });
            });
        },
        py::arg("a"), py::arg("b"), py::arg("tolerance"), py::arg("max_pairs"));
}

}  // namespace freiform::python
