// Surfaces from curves, and quadrics.
#include "records/fit/loft.hpp"
#include "records/make/coons.hpp"
#include "records/make/frame_sweep.hpp"
#include "records/make/made_surface.hpp"
#include "records/make/quadric.hpp"
#include "records/make/revolve.hpp"

#include <freiform/make/offset_spline.hpp>
#include <freiform/make/sweep.hpp>

namespace freiform::python {
namespace {

Axis axis_of(const Array& origin, const Array& direction) {
    return {vec_of<3>(origin, "origin"), vec_of<3>(direction, "direction")};
}
// Two to four curves of one kind.
template <class F>
py::object with_curves(std::initializer_list<const CurveHandle*> all, F&& f) {
    std::vector<CurveHandle> list;
    for (const CurveHandle* h : all) list.push_back(*h);
    return with_common<2, 3, 1>(list, "curves", std::forward<F>(f));
}

void bind_swept(py::module_& m) {
    m.def(
        "revolve",
        [](const CurveHandle& h, const Array& origin, const Array& direction, double angle, bool closed) {
            const Axis axis = axis_of(origin, direction);
            return visit_dims<2, 3>(*h.patch, "profile", [&](const auto& p) {
                return answer([&] { return revolve(p, axis, angle, closed ? Seam::closed : Seam::open); });
            });
        },
        py::arg("profile"), py::arg("origin"), py::arg("direction"), py::arg("angle"), py::arg("closed"));
    m.def(
        "revolve_polynomial",
        [](const CurveHandle& h, const Array& origin, const Array& direction, double angle, double tolerance,
           bool closed) {
            const Axis axis = axis_of(origin, direction);
            return visit_dims<2, 3>(*h.patch, "profile", [&](const auto& p) {
                return answer([&] {
                    return revolve_polynomial(p, axis, angle, tolerance, closed ? Seam::closed : Seam::open);
                });
            });
        },
        py::arg("profile"), py::arg("origin"), py::arg("direction"), py::arg("angle"), py::arg("tolerance"),
        py::arg("closed"));
    m.def(
        "extrude",
        [](const CurveHandle& h, const Array& vector) {
            const Vec<3> v = vec_of<3>(vector, "vector");
            return visit_dims<2, 3>(*h.patch, "profile",
                                    [&](const auto& p) { return answer([&] { return extrude(p, v); }); });
        },
        py::arg("profile"), py::arg("vector"));
    m.def(
        "ruled",
        [](const CurveHandle& a, const CurveHandle& b) {
            return with_curves({&a, &b},
                               [](const auto& c) { return answer([&] { return ruled(c[0], c[1]); }); });
        },
        py::arg("a"), py::arg("b"));
    m.def(
        "offset_spline",
        [](const SurfaceHandle& h, double distance, double tolerance,
           const std::optional<std::array<double, 4>>& on) {
            return visit_dims<3, 3>(*h.patch, "surface", [&](const auto& p) {
                std::array<Interval, 2> part = p.domain();
                if (on) part = {Interval{(*on)[0], (*on)[1]}, Interval{(*on)[2], (*on)[3]}};
                const OffsetSurface offset{std::make_shared<const SurfaceGeometry>(p), distance};
                return answer([&] { return offset_spline(offset, part, tolerance); });
            });
        },
        py::arg("surface"), py::arg("distance"), py::arg("tolerance"), py::arg("on") = py::none());
    m.def(
        "translate_along",
        [](const CurveHandle& a, const CurveHandle& b) {
            return with_curves(
                {&a, &b}, [](const auto& c) { return answer([&] { return translate_along(c[0], c[1]); }); });
        },
        py::arg("profile"), py::arg("rail"));
    m.def(
        "sweep",
        [](const CurveHandle& profile, const CurveHandle& rail, double tolerance, const Array& x_at_start) {
            const FrameSweepOptions options{tolerance, vec_of<3>(x_at_start, "x_at_start")};
            return visit_dims<2, 2>(*profile.patch, "profile", [&](const auto& p) {
                return visit_dims<3, 3>(*rail.patch, "rail", [&](const auto& r) {
                    return answer([&] { return sweep(p, r, options); });
                });
            });
        },
        py::arg("profile"), py::arg("rail"), py::arg("tolerance"), py::arg("x_at_start"));
}

void bind_through(py::module_& m) {
    m.def(
        "loft",
        [](const std::vector<CurveHandle>& sections, int degree, std::string_view spacing,
           std::string_view ends, bool closed) {
            const LoftOptions options{degree, enum_of<Spacing>(spacing, "spacing"),
                                      enum_of<SplineEnds>(ends, "ends"), closed};
            return with_common<2, 3, 1>(sections, "sections", [&](const auto& all) {
                using P = CoefficientOf<decltype(all[0])>;
                return answer([&] { return loft(std::span<const Curve<P>>(all), options); });
            });
        },
        py::arg("sections"), py::arg("degree"), py::arg("spacing"), py::arg("ends"), py::arg("closed"));
    m.def(
        "coons",
        [](const CurveHandle& u0, const CurveHandle& u1, const CurveHandle& v0, const CurveHandle& v1,
           double tolerance) {
            return with_curves({&u0, &u1, &v0, &v1}, [&](const auto& c) {
                return answer([&] { return coons(c[0], c[1], c[2], c[3], tolerance); });
            });
        },
        py::arg("u0"), py::arg("u1"), py::arg("v0"), py::arg("v1"), py::arg("tolerance"));
    m.def(
        "coons_bicubic",
        [](const std::vector<CurveHandle>& eight, std::array<double, 3> tolerance) {
            if (eight.size() != 8) reject(RefusalKind::invalid, "curves", "eight are needed");
            return with_common<2, 3, 1>(eight, "curves", [&](const auto& c) {
                using P = CoefficientOf<decltype(c[0])>;
                const CoonsTolerance t{tolerance[0], tolerance[1], tolerance[2]};
                return answer([&] {
                    return coons_bicubic(CoonsEdge<P>{c[0], c[1]}, CoonsEdge<P>{c[2], c[3]},
                                         CoonsEdge<P>{c[4], c[5]}, CoonsEdge<P>{c[6], c[7]}, t);
                });
            });
        },
        py::arg("curves"), py::arg("tolerance"));
    m.def(
        "gordon",
        [](std::vector<CurveHandle> u_curves, const Array& at_v, const std::vector<CurveHandle>& v_curves,
           const Array& at_u, double tolerance) {
            const std::size_t count = u_curves.size();
            u_curves.insert(u_curves.end(), v_curves.begin(), v_curves.end());
            return with_common<2, 3, 1>(u_curves, "curves", [&](const auto& all) {
                using P = CoefficientOf<decltype(all[0])>;
                const std::span<const Curve<P>> c(all);
                return answer([&] {
                    return gordon(c.first(count), numbers_of(at_v), c.subspan(count), numbers_of(at_u),
                                  tolerance);
                });
            });
        },
        py::arg("u_curves"), py::arg("at_v"), py::arg("v_curves"), py::arg("at_u"), py::arg("tolerance"));
}

// (origin, x, y, z) as Python has them.
FoundFrame frame_of(const std::array<Array, 4>& f) {
    return {vec_of<3>(f[0], "origin"), vec_of<3>(f[1], "x"), vec_of<3>(f[2], "y"), vec_of<3>(f[3], "z")};
}
Turn turn_of(std::pair<double, double> angle, std::string_view form) {
    return {interval_of(angle), enum_of<EllipseForm>(form, "form")};
}

void bind_quadrics(py::module_& m) {
    using Frame = std::array<Array, 4>;
    using Pair = std::pair<double, double>;
    m.def(
        "frame_about",
        [](const Array& origin, const Array& axis, const Array& toward) {
            const FoundFrame f = take(frame_about(vec_of<3>(origin, "origin"), vec_of<3>(axis, "axis"),
                                                  vec_of<3>(toward, "toward")));
            return py::make_tuple(to_py(f.origin), to_py(f.x), to_py(f.y), to_py(f.z));
        },
        py::arg("origin"), py::arg("axis"), py::arg("toward"));
    m.def(
        "sphere",
        [](const Frame& f, double radius, Pair angle, std::string_view form, Pair latitude) {
            const auto frame = frame_of(f);
            return answer([&] { return sphere(frame, radius, turn_of(angle, form), interval_of(latitude)); });
        },
        py::arg("frame"), py::arg("radius"), py::arg("angle"), py::arg("form"), py::arg("latitude"));
    m.def(
        "cylinder",
        [](const Frame& f, double radius, Pair height, Pair angle, std::string_view form) {
            const auto frame = frame_of(f);
            return answer([&] { return cylinder(frame, radius, interval_of(height), turn_of(angle, form)); });
        },
        py::arg("frame"), py::arg("radius"), py::arg("height"), py::arg("angle"), py::arg("form"));
    m.def(
        "cone",
        [](const Frame& f, double lo, double hi, Pair height, Pair angle, std::string_view form) {
            const auto frame = frame_of(f);
            return answer([&] { return cone(frame, lo, hi, interval_of(height), turn_of(angle, form)); });
        },
        py::arg("frame"), py::arg("radius_lo"), py::arg("radius_hi"), py::arg("height"), py::arg("angle"),
        py::arg("form"));
    m.def(
        "torus",
        [](const Frame& f, double ring, double tube, Pair angle, std::string_view form, Pair around,
           std::string_view around_form) {
            const auto frame = frame_of(f);
            return answer(
                [&] { return torus(frame, ring, tube, turn_of(angle, form), turn_of(around, around_form)); });
        },
        py::arg("frame"), py::arg("ring"), py::arg("tube"), py::arg("angle"), py::arg("form"),
        py::arg("around"), py::arg("around_form"));
    m.def(
        "sphere_in_six",
        [](const Frame& f, double radius) {
            const auto frame = frame_of(f);
            return answer([&] { return sphere_in_six(frame, radius); });
        },
        py::arg("frame"), py::arg("radius"));
    m.def(
        "sphere_in_eight",
        [](const Frame& f, double radius) {
            const auto frame = frame_of(f);
            return answer([&] { return sphere_in_eight(frame, radius); });
        },
        py::arg("frame"), py::arg("radius"));
}

}  // namespace

void bind_make_surfaces(py::module_& m) {
    bind_swept(m);
    bind_through(m);
    bind_quadrics(m);
}

}  // namespace freiform::python
