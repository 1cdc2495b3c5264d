// Conics, graphs, polynomials.
#include "records/make/conic.hpp"
#include "records/make/conic_equation.hpp"
#include "records/make/graph.hpp"
#include "records/make/polynomial_near.hpp"
#include "records/spline/geometry.hpp"

namespace freiform::python {
namespace {

template <int D>
Conic<D> conic_of(std::string_view kind, const Array& centre, const Array& x, const Array& y) {
    return {enum_of<ConicKind>(kind, "kind"), vec_of<D>(centre, "centre"), vec_of<D>(x, "x"),
            vec_of<D>(y, "y")};
}
// f for points of the plane, or of space.
template <class F>
py::object in_plane_or_space(const Array& a, F&& f) {
    if (a.ndim() == 1 && a.size() == 2) return f(std::integral_constant<int, 2>());
    if (a.ndim() == 1 && a.size() == 3) return f(std::integral_constant<int, 3>());
    reject(RefusalKind::invalid, "points", "have neither two nor three coordinates");
}
ConicEquation equation(std::array<double, 6> c, std::array<double, 2> origin) {
    return {c, {{origin[0], origin[1]}}};
}

}  // namespace

void bind_make_curves(py::module_& m) {
    m.def(
        "conic_arc",
        [](std::string_view kind, const Array& centre, const Array& x, const Array& y,
           std::pair<double, double> on, double widest) {
            return in_plane_or_space(centre, [&](auto d) {
                const auto c = conic_of<decltype(d)::value>(kind, centre, x, y);
                return answer([&] { return conic_arc(c, interval_of(on), widest); });
            });
        },
        py::arg("kind"), py::arg("centre"), py::arg("x"), py::arg("y"), py::arg("on"), py::arg("widest"));
    m.def(
        "full_ellipse",
        [](const Array& centre, const Array& x, const Array& y, std::string_view form) {
            return in_plane_or_space(centre, [&](auto d) {
                const auto c = conic_of<decltype(d)::value>("ellipse", centre, x, y);
                const auto f = enum_of<EllipseForm>(form, "form");
                return answer([&] { return full_ellipse(c, f); });
            });
        },
        py::arg("centre"), py::arg("x"), py::arg("y"), py::arg("form"));
    m.def(
        "circle_of",
        [](const Array& centre, double radius, const std::optional<Array>& normal) -> py::object {
            if (!normal) return answer([&] { return circle(vec_of<2>(centre, "centre"), radius); });
            return answer(
                [&] { return circle(vec_of<3>(centre, "centre"), vec_of<3>(*normal, "normal"), radius); });
        },
        py::arg("centre"), py::arg("radius"), py::arg("normal"));
    m.def(
        "arc_through",
        [](const Array& a, const Array& b, const Array& c, double widest) {
            return in_plane_or_space(a, [&](auto d) {
                constexpr int D = decltype(d)::value;
                const auto p = vec_of<D>(a, "a"), q = vec_of<D>(b, "b"), r = vec_of<D>(c, "c");
                return answer([&] { return arc_through(p, q, r, widest); });
            });
        },
        py::arg("a"), py::arg("b"), py::arg("c"), py::arg("widest"));
    m.def(
        "weighted_arc",
        [](const Array& a, const Array& corner, const Array& c, double weight) {
            return in_plane_or_space(a, [&](auto d) {
                constexpr int D = decltype(d)::value;
                const auto p = vec_of<D>(a, "a"), q = vec_of<D>(corner, "corner"), r = vec_of<D>(c, "c");
                return answer([&] { return weighted_arc(p, q, r, weight); });
            });
        },
        py::arg("a"), py::arg("corner"), py::arg("c"), py::arg("weight"));
    m.def(
        "tangent_arc",
        [](const Array& a, const Array& at_a, const Array& c, const Array& at_c, const Array& through) {
            const auto p = vec_of<2>(a, "a"), dp = vec_of<2>(at_a, "at_a"), q = vec_of<2>(c, "c"),
                       dq = vec_of<2>(at_c, "at_c"), x = vec_of<2>(through, "through");
            return answer([&] { return tangent_arc(p, dp, q, dq, x); });
        },
        py::arg("a"), py::arg("at_a"), py::arg("c"), py::arg("at_c"), py::arg("through"));
    m.def(
        "five_point_arc",
        [](const Array& points) {
            const auto p = points_of<Vec<2>>(points, "points");
            if (p.size() != 5)
                reject(RefusalKind::invalid, "points", text(p.size(), " points; five are needed"));
            return answer([&] { return arc_through({p[0], p[1], p[2], p[3], p[4]}); });
        },
        py::arg("points"));
    m.def(
        "equation_through",
        [](const Array& points) {
            const auto p = points_of<Vec<2>>(points, "points");
            if (p.size() != 5)
                reject(RefusalKind::invalid, "points", text(p.size(), " points; five are needed"));
            return answer([&] { return equation_through({p[0], p[1], p[2], p[3], p[4]}); });
        },
        py::arg("points"));
    m.def(
        "equation_of",
        [](std::string_view kind, const Array& centre, const Array& x, const Array& y) {
            const auto c = conic_of<2>(kind, centre, x, y);
            return answer([&] { return equation_of(c); });
        },
        py::arg("kind"), py::arg("centre"), py::arg("x"), py::arg("y"));
    m.def(
        "classify_conic",
        [](std::array<double, 6> c, std::array<double, 2> origin) {
            return answer([&] { return classify(equation(c, origin)); });
        },
        py::arg("c"), py::arg("origin"));
    m.def(
        "solve_conic",
        [](std::array<double, 6> c, std::array<double, 2> origin) {
            return answer([&] { return solve(equation(c, origin)); });
        },
        py::arg("c"), py::arg("origin"));
    m.def(
        "arcs_inside",
        [](std::array<double, 6> c, std::array<double, 2> origin, const Array& lo, const Array& hi) {
            const Box<2> box{vec_of<2>(lo, "lo"), vec_of<2>(hi, "hi")};
            return answer([&]() -> Result<std::vector<ConicArc<2>>> {
                auto form = solve(equation(c, origin));
                if (!form) return std::unexpected(form.error());
                return arcs_inside(*form, box);
            });
        },
        py::arg("c"), py::arg("origin"), py::arg("lo"), py::arg("hi"));
    m.def(
        "graph",
        [](const Array& a, std::pair<double, double> on) {
            return answer([&] { return graph(numbers_of(a), interval_of(on)); });
        },
        py::arg("coefficients"), py::arg("on"));
    m.def(
        "polynomial_near",
        [](const CurveHandle& h, double tolerance) {
            return visit_dims<2, 3>(*h.patch, "curve", [&](const auto& p) -> py::object {
                if constexpr (Space<CoefficientOf<decltype(p)>>::kRational)
                    return answer([&] { return polynomial_near(p, tolerance); });
                else
                    reject(RefusalKind::unsupported, "curve", "is polynomial already");
            });
        },
        py::arg("curve"), py::arg("tolerance"));
}

}  // namespace freiform::python
