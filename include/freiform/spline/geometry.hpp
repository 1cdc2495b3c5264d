// The curves and surfaces that models are made of: splines, and the analytic ones that files call line,
// circle, plane, cylinder, ... Analytic ones stay what they are, because the parameter curves of a model
// refer to their parametrisation (an angle), which no rational spline has.
//
//     plane     = extrusion of a line            cone          = revolution of a line
//     cylinder  = extrusion of a circle          sphere, torus = revolution of a circle
#pragma once
#include <freiform/spline/patch.hpp>

#include <memory>
#include <string_view>
#include <variant>

namespace freiform {

// origin + t direction, for all t.
template <int D>
struct Line {
    Vec<D> origin{}, direction{};
    friend bool operator==(const Line&, const Line&) = default;
};

// ellipse:   centre + cos(t) x + sin(t) y     (a circle if |x| = |y| and x is orthogonal to y), period 2 pi
// hyperbola: centre + cosh(t) x + sinh(t) y   (one branch)
// parabola:  centre + t^2 x + t y
enum class ConicKind { ellipse, hyperbola, parabola };
template <int D>
struct Conic {
    ConicKind kind = ConicKind::ellipse;
    Vec<D> centre{}, x{}, y{};
    friend bool operator==(const Conic&, const Conic&) = default;
};

template <int D>
using CurveGeometry = std::variant<Line<D>, Conic<D>, Curve<Vec<D>>, Curve<Hom<D>>>;

// What a file calls the surface; says nothing that the geometry does not say.
enum class SurfaceKind { general, plane, cylinder, cone, sphere, torus };

// S(u, v) = profile(u) + v direction.
struct Extrusion {
    CurveGeometry<3> profile;
    Vec<3> direction{};
    SurfaceKind kind = SurfaceKind::general;
};

// S(u, v) = profile(v) turned by the angle u about the axis through `origin`. `axis` has length 1.
struct Revolution {
    CurveGeometry<3> profile;
    Vec<3> origin{}, axis{};
    SurfaceKind kind = SurfaceKind::general;
};

struct OffsetSurface;

using SurfaceGeometry = std::variant<Extrusion, Revolution, Surface<Vec<3>>, Surface<Hom<3>>, OffsetSurface>;

// S(u, v) = base(u, v) + distance n(u, v), n the unit normal of the base in the sense of S_u x S_v. The base
// is not an offset itself (distances add up).
struct OffsetSurface {
    std::shared_ptr<const SurfaceGeometry> base;
    double distance = 0;
};

// The parameters for which the geometry is defined: infinite for lines, [0, 2 pi] (one period) for ellipses.
template <int D>
std::array<Interval, 1> domain(const CurveGeometry<D>& curve);
std::array<Interval, 2> domain(const SurfaceGeometry& surface);

// Where a spline ends nothing is defined beyond its domain: faces take parameters there as moved back to it.
// The ends of splines, in each direction; infinite where there are none.
std::array<Interval, 2> limits(const SurfaceGeometry& surface);
inline Vec<2> clamped(const Vec<2>& uv, const std::array<Interval, 2>& limits) {
    return {{clamped(uv[0], limits[0]), clamped(uv[1], limits[1])}};
}

// The curve with its points moved by this, at the same parameters. Off by the rounding of its coordinates.
CurveGeometry<2> translated(const CurveGeometry<2>& curve, const Vec<2>& by);

// Refuses numbers that are not finite, directions and radii that vanish where none may.
template <int D>
Result<void> check(const CurveGeometry<D>& curve);
Result<void> check(const SurfaceGeometry& surface);

// Value and derivatives to order K = 0..2; of curves 0..3.
template <int K, int D>
Jet<1, K, Vec<D>> jet(const CurveGeometry<D>& curve, double t);
template <int K>
Jet<2, K, Vec<3>> jet(const SurfaceGeometry& surface, const Param<2>& uv);

// The unit normal in the sense of S_u x S_v; zero where S_u and S_v are parallel.
Vec<3> normal(const SurfaceGeometry& surface, const Param<2>& uv);

// "line", "circle" (within rounding), "ellipse", "bspline", "nurbs", ...; "plane", "cylinder", "offset", ...
template <int D>
std::string_view kind_name(const CurveGeometry<D>& curve);
std::string_view kind_name(const SurfaceGeometry& surface);

// A bound of |computed - exact| of a coordinate of a value with parameters in `on`.
template <int D>
double value_error_bound(const CurveGeometry<D>& curve, const std::array<Interval, 1>& on);
double value_error_bound(const SurfaceGeometry& surface, const std::array<Interval, 2>& on);

}  // namespace freiform
