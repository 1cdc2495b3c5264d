// Questions about surfaces, and boxes of all kinds.
#include "records/core/interval.hpp"
#include "records/query/bounds.hpp"
#include "records/query/continuity.hpp"
#include "records/query/sphere_of.hpp"
#include "records/query/surface_continuity.hpp"
#include "records/query/surface_curvature.hpp"
#include "records/spline/edge.hpp"

namespace freiform::python {
namespace {

using SurfaceOptions = std::tuple<int, double, double, double, double, double>;
ContinuityOptions surface_options(const SurfaceOptions& o) {
    return {std::get<0>(o), std::get<1>(o), std::get<2>(o), std::get<3>(o), std::get<4>(o), std::get<5>(o)};
}
void check_axis_below(int axis, int below) {
    if (axis < 0 || axis >= below) reject(RefusalKind::invalid, "axis", text(axis, " is not below ", below));
}

template <std::size_t N>
void bind_boxes(py::module_& m) {
    m.def(
        "tight_box",
        [](const PatchHandle<N>& h, double accuracy, int max_pieces) {
            return std::visit(
                [&](const auto& p) { return answer([&] { return tight_box(p, accuracy, max_pieces); }); },
                *h.patch);
        },
        py::arg("patch"), py::arg("accuracy"), py::arg("max_pieces"));
    m.def(
        "extent_along",
        [](const PatchHandle<N>& h, const Array& direction, double accuracy, int max_pieces) {
            return std::visit(
                [&](const auto& p) {
                    const auto d = vec_of<dim_of<CoefficientOf<decltype(p)>>>(direction, "direction");
                    return answer([&] { return extent_along(p, d, accuracy, max_pieces); });
                },
                *h.patch);
        },
        py::arg("patch"), py::arg("direction"), py::arg("accuracy"), py::arg("max_pieces"));
    m.def(
        "knot_lines",
        [](const PatchHandle<N>& h, int axis, const SurfaceOptions& o) {
            check_axis_below(axis, int(N));
            return std::visit(
                [&](const auto& p) {
                    return answer([&] { return knot_lines(p, axis, surface_options(o)); });
                },
                *h.patch);
        },
        py::arg("patch"), py::arg("axis"), py::arg("options"));
}

}  // namespace

void bind_surface_queries(py::module_& m) {
    bind_boxes<1>(m);
    bind_boxes<2>(m);
    bind_boxes<3>(m);
    m.def(
        "surface_curvature",
        [](const SurfaceHandle& h, std::array<double, 2> uv) {
            return visit_dims<3, 3>(*h.patch, "surface", [&](const auto& p) {
                return answer([&] { return surface_curvature(p, uv); });
            });
        },
        py::arg("surface"), py::arg("uv"));
    m.def(
        "limit_normal",
        [](const SurfaceHandle& h, std::array<double, 2> uv, const std::optional<Array>& direction) {
            return visit_dims<3, 3>(*h.patch, "surface", [&](const auto& p) {
                if (!direction) return answer([&] { return limit_normal(p, uv); });
                const auto d = vec_of<2>(*direction, "direction");
                return answer([&] { return limit_normal(p, uv, d); });
            });
        },
        py::arg("surface"), py::arg("uv"), py::arg("direction"));
    m.def(
        "sphere_of",
        [](const SurfaceHandle& h, double tolerance) {
            const auto s = as<Hom<3>, 2>(*h.patch, "surface");
            return to_py(unlocked([&] { return sphere_of(s, tolerance); }));
        },
        py::arg("surface"), py::arg("tolerance"));
    m.def(
        "sphere_through",
        [](const Array& points) { return to_py(sphere_through(points_of<Vec<3>>(points, "points"))); },
        py::arg("points"));
    m.def(
        "surface_continuity",
        [](const SurfaceHandle& h, int axis, const SurfaceOptions& o) {
            check_axis_below(axis, 2);
            return visit_dims<1, 4>(*h.patch, "surface", [&](const auto& p) {
                return answer([&] { return continuity(p, axis, surface_options(o)); });
            });
        },
        py::arg("surface"), py::arg("axis"), py::arg("options"));
    m.def(
        "surface_joint",
        [](const SurfaceHandle& a, int axis, std::string_view end, const SurfaceHandle& b, int other_axis,
           std::string_view other_end, bool against, const SurfaceOptions& o) {
            check_axis_below(axis, 2), check_axis_below(other_axis, 2);
            const SurfaceEdge first{axis, enum_of<End>(end, "end")},
                second{other_axis, enum_of<End>(other_end, "end")};
            const std::vector<SurfaceHandle> both{a, b};
            return with_common<1, 4, 2>(both, "surfaces", [&](const auto& s) {
                return answer([&] { return joint(s[0], first, s[1], second, against, surface_options(o)); });
            });
        },
        py::arg("first"), py::arg("axis"), py::arg("end"), py::arg("second"), py::arg("second_axis"),
        py::arg("second_end"), py::arg("against"), py::arg("options"));
    m.def(
        "surface_joints",
        [](const std::vector<SurfaceHandle>& surfaces, double gap, const SurfaceOptions& o) {
            std::vector<SurfaceEdges> edges;
            for (const SurfaceHandle& h : surfaces)
                std::visit([&](const auto& p) { edges.push_back(edges_of(p, surface_options(o))); },
                           *h.patch);
            return answer(
                [&] { return joints(std::span<const SurfaceEdges>(edges), gap, surface_options(o)); });
        },
        py::arg("surfaces"), py::arg("gap"), py::arg("options"));
}

}  // namespace freiform::python
