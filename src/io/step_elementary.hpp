// Extrusions and revolutions that are cylinders, cones, spheres and tori, as their entities have them: a
// place, an axis, where angles begin, radii. Programs that read STEP know them by their names, and take a
// surface that is swept for something else. Those whose parameters run another way round have no entity, nor
// have those that are not what they are called, but for rounding.
#pragma once
#include <freiform/core/constants.hpp>
#include <freiform/spline/geometry.hpp>

#include <cmath>
#include <numbers>
#include <optional>
#include <utility>
#include <vector>

namespace freiform::detail {

struct Elementary {
    const char* name;
    Vec<3> at, axis, x;
    std::vector<double> sizes;  // radii, and the angle of a cone
};

namespace elementary {

// Frames lose digits where the directions that a file gives them by are nearly parallel.
constexpr double kRounding = 0x1p-43;

inline bool is_across(const Vec<3>& a, const Vec<3>& b) {
    return std::abs(dot(a, b)) <= kRounding * norm(a) * norm(b);
}
// Of the same direction.
inline bool is_along(const Vec<3>& a, const Vec<3>& b) {
    return dot(a, b) > 0 && norm(cross(a, b)) <= kRounding * norm(a) * norm(b);
}
inline bool is_circle(const Conic<3>& c) {
    return c.kind == ConicKind::ellipse && is_across(c.x, c.y) &&
           std::abs(norm(c.x) - norm(c.y)) <= kRounding * norm(c.x);
}

}  // namespace elementary

// A conic by its axes, an ellipse by the longer one first: the given one at t is it at t - shift. Any two
// vectors x and y give a conic; this is the same one.
struct ByAxes {
    Conic<3> conic;
    double shift = 0;  // not finite where a hyperbola has no width
};
inline ByAxes by_axes(Conic<3> c) {
    const double skew = dot(c.x, c.y), xx = dot(c.x, c.x), yy = dot(c.y, c.y);
    double shift = 0;
    if (std::abs(skew) > 4 * kUnitRoundoff * norm(c.x) * norm(c.y)) {
        const Vec<3> x = c.x, y = c.y;
        if (c.kind == ConicKind::parabola) {
            shift = -skew / (2 * xx);
            c.centre += shift * (y + shift * x), c.y += 2 * shift * x;
        } else if (c.kind == ConicKind::hyperbola) {
            shift = std::atanh(-2 * skew / (xx + yy)) / 2;
            c.x = std::cosh(shift) * x + std::sinh(shift) * y,
            c.y = std::cosh(shift) * y + std::sinh(shift) * x;
        } else {
            shift = std::atan2(2 * skew, xx - yy) / 2;
            c.x = std::cos(shift) * x + std::sin(shift) * y, c.y = std::cos(shift) * y - std::sin(shift) * x;
        }
    }
    if (c.kind == ConicKind::ellipse && norm(c.x) < norm(c.y))
        std::swap(c.x, c.y), c.y = -1.0 * c.y, shift += std::numbers::pi / 2;
    return {c, shift};
}

inline std::optional<Elementary> elementary_of(const Extrusion& s) {
    const auto* c = std::get_if<Conic<3>>(&s.profile);
    if (s.kind != SurfaceKind::cylinder || c == nullptr || !elementary::is_circle(*c)) return {};
    // Heights are lengths.
    if (!elementary::is_along(cross(c->x, c->y), s.direction) ||
        std::abs(norm(s.direction) - 1) > elementary::kRounding)
        return {};
    return Elementary{"CYLINDRICAL_SURFACE", c->centre, s.direction, c->x, {norm(c->x)}};
}

inline std::optional<Elementary> elementary_of(const Revolution& s) {
    using namespace elementary;
    const auto radial = [&](const Vec<3>& d) { return d - dot(d, s.axis) * s.axis; };
    const auto near = [&](double length, double size) { return std::abs(length) <= kRounding * size; };
    if (const auto* l = std::get_if<Line<3>>(&s.profile); l != nullptr && s.kind == SurfaceKind::cone) {
        const Vec<3> out = radial(l->origin - s.origin), steep = radial(l->direction);
        const double up = dot(l->direction, s.axis), scale = max_abs(l->origin) + max_abs(s.origin);
        Vec<3> x = (1 / norm(steep)) * steep;
        if (!(up > 0) || !is_finite(x)) return {};
        double radius = dot(out, x);
        if (near(radius, scale)) radius = 0;
        if (radius < 0) x = -1.0 * x, radius = -radius;
        if (!near(norm(out - radius * x), scale + radius)) return {};
        // The angle is positive: a cone that narrows is one that widens the other way, with the same normals.
        const double wider = dot(steep, x);
        return Elementary{"CONICAL_SURFACE",
                          l->origin - out,
                          wider < 0 ? -1.0 * s.axis : s.axis,
                          x,
                          {radius, std::atan2(std::abs(wider), up)}};
    }
    const auto* c = std::get_if<Conic<3>>(&s.profile);
    if (c == nullptr || !is_circle(*c) || !is_along(c->y, s.axis) || !is_across(c->x, s.axis)) return {};
    const Vec<3> out = radial(c->centre - s.origin), x = (1 / norm(c->x)) * c->x;
    const double radius = norm(c->x), scale = radius + max_abs(c->centre) + max_abs(s.origin);
    if (s.kind == SurfaceKind::sphere && near(norm(out), scale))
        return Elementary{"SPHERICAL_SURFACE", c->centre, s.axis, x, {radius}};
    if (const double major = dot(out, x);
        s.kind == SurfaceKind::torus && major > radius && near(norm(out - major * x), scale))
        return Elementary{"TOROIDAL_SURFACE", c->centre - out, s.axis, x, {major, radius}};
    return {};
}

}  // namespace freiform::detail
