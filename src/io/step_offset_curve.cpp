// Offset curves: C(t) + d n(t), n the direction of V x C'(t), with V the same everywhere.
//
// Of lines, and of circles about an axis along V, they are such again, with the same parameter. Of others
// they are no curve of ours: a cubic spline stands for them, and the model tells how far it is off. That is
// proven: with the surface C(t) + v V, whose unit normal along v = 0 is -n, the offset is the parameter line
// v = 0 of its offset by -d, and lift bounds the distance of a spline from a parameter curve.
//
// Cost. There are no third derivatives of offsets to prove with, so the bound shrinks like the square of the
// effort only; a file of many offset curves gets less for each.
//
// Why not offsets of offsets of splines? The distance of the first spline says nothing about its slope.
//
// Curves of parameters are offset in the plane, V = z; a spline near one would be off by a distance of
// parameters, which says nothing in space.
//
// References: ISO 10303-42:2014, 4.4 (offset_curve_2d, offset_curve_3d).
#include "step_geometry.hpp"
#include "step_lift.hpp"

#include <freiform/core/constants.hpp>

#include <algorithm>
#include <cmath>

namespace freiform::step {

namespace {

constexpr std::uint32_t kOffsetSamples = 400'000;  // of a file

bool is_circle(const Conic<3>& c) {
    return c.kind == ConicKind::ellipse && std::abs(norm(c.x) - norm(c.y)) <= 8 * kUnitRoundoff * norm(c.x) &&
           std::abs(dot(c.x, c.y)) <= 8 * kUnitRoundoff * dot(c.x, c.x);
}

// The offset of a line or circle; nothing if it is no such curve.
std::optional<CurveGeometry<3>> simple_offset(const CurveGeometry<3>& c, double d, const Vec<3>& v) {
    if (const auto* l = std::get_if<Line<3>>(&c))
        return Line<3>{l->origin + d * unit(cross(v, l->direction)), l->direction};
    const auto* k = std::get_if<Conic<3>>(&c);
    if (k == nullptr || !is_circle(*k)) return std::nullopt;
    const Vec<3> axis = unit(cross(k->x, k->y));
    if (norm(cross(axis, v)) > 1e-14) return std::nullopt;
    const double scale = 1 - (dot(axis, v) < 0 ? -d : d) / norm(k->x);
    return Conic<3>{ConicKind::ellipse, k->centre, scale * k->x, scale * k->y};
}

}  // namespace

Result<BoundedCurve> GeometryReader::offset_of(std::uint32_t i, Type type, BoundedCurve basis) const {
    const bool flat = type == Type::OFFSET_CURVE_2D;
    const auto f = Fields::of(f_, i, type, flat ? 3 : 4);
    if (!f) return std::unexpected(f.error());
    const int first = f->size() > (flat ? 3 : 4) ? 2 : 1;  // a part of a complex instance has no name
    const auto distance = f->number(first, "distance");
    if (!distance) return std::unexpected(distance.error());
    Result<Vec<3>> v = Vec<3>{{0, 0, 1}};
    if (!flat) {
        const auto along = f->reference(first + 2, "reference direction");
        if (!along) return std::unexpected(along.error());
        v = direction(*along);
    }
    if (!v) return std::unexpected(v.error());
    if (*distance == 0) return basis;
    const double d = basis.reversed ? -*distance : *distance;
    if (const auto* l = std::get_if<Line<3>>(&basis.curve);
        l != nullptr && !(norm(cross(*v, l->direction)) > 1e-9 * norm(l->direction)))
        return f->refused("is the offset of a line along itself", RefusalKind::invalid);
    if (basis.approximated != kMissing)
        return f->refused("is the offset of a curve that is taken as a spline near it",
                          RefusalKind::unsupported);
    if (auto simple = simple_offset(basis.curve, d, *v)) {
        basis.curve = std::move(*simple);
        return basis;
    }
    if (flat)
        return f->refused("is the offset of a curve of parameters that is no line and no circle",
                          RefusalKind::unsupported);
    const Interval on = basis.range.value_or(domain(basis.curve)[0]);
    if (!std::isfinite(on.length()) || !(on.lo < on.hi))
        return f->refused("is the offset of a curve without end", RefusalKind::unsupported);
    Box<3> box;
    for (int k = 0; k <= 16; ++k) box.add(jet<0>(basis.curve, on.lo + on.length() * k / 16).value());
    const double size = box.diagonal() + std::abs(d);
    const SurfaceGeometry sheet = OffsetSurface{
        std::make_shared<const SurfaceGeometry>(Extrusion{basis.curve, *v, SurfaceKind::general}), -d};
    const auto samples = int(std::clamp(kOffsetSamples / std::max(f_.offset_curves, 1u), 500u, 40'000u));
    auto made = lift(sheet, Line<2>{{}, {{1, 0}}}, on, lift_accuracy(size), lift_limit(size), samples);
    if (!made) return f->refused(made.error().message, made.error().kind);
    basis.has_angles = std::holds_alternative<Conic<3>>(basis.curve) &&
                       std::get<Conic<3>>(basis.curve).kind == ConicKind::ellipse;
    basis.curve = std::move(made->curve);
    basis.approximated = i, basis.bound = made->bound;
    return basis;
}

// What parameter curves are asked for.
double GeometryReader::lift_accuracy(double size) const {
    return std::max(1e-9 * size, std::min(1e-7 * size, 1e-3 * tolerance));
}
double GeometryReader::lift_limit(double size) const { return std::max(1e-3 * size, tolerance); }

}  // namespace freiform::step
