// Surfaces. Elementary ones are a placement and radii, which our extrusions and revolutions express with the
// same parameters:
//
//     plane    O + u X + v Y                                  extrusion of a line
//     cylinder O + R (cos u X + sin u Y) + v Z                extrusion of a circle
//     cone     O + (R + v sin a)(cos u X + sin u Y) + v cos a Z             revolution of a line
//     sphere   O + R cos v (cos u X + sin u Y) + R sin v Z                  revolution of a circle
//     torus    O + (R + r cos v)(cos u X + sin u Y) + r sin v Z             revolution of a circle
//
// but for the parameter v of the cone, which is a length along it instead of one along its axis. Offsets of
// elementary surfaces along their normal are such again, as long as no radius vanishes.
//
// References: ISO 10303-42:2014, 4.5 (surfaces).
#include "step_geometry.hpp"
#include "step_knots.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/make/revolve.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace freiform::step {

namespace {

// An offset that is part of another.
struct OffsetStep {
    std::uint32_t instance;
    double distance;
};

// Whether the offset by d has the normals of the surface everywhere: 1 + d k > 0 for both curvatures k.
// Proven for planes, cylinders, spheres and rings alone.
bool keeps_normal(const SurfaceGeometry& s, double d) {
    const auto is_positive = [](double radius, double by) {
        return radius + by > 8 * kUnitRoundoff * (radius + std::abs(by));
    };
    if (const auto* e = std::get_if<Extrusion>(&s)) {
        if (std::holds_alternative<Line<3>>(e->profile)) return true;
        const auto* c = std::get_if<Conic<3>>(&e->profile);
        return e->kind == SurfaceKind::cylinder && c != nullptr && is_positive(norm(c->x), d);
    }
    const auto* r = std::get_if<Revolution>(&s);
    const auto* c = r != nullptr ? std::get_if<Conic<3>>(&r->profile) : nullptr;
    if (c == nullptr) return false;
    const double radius = norm(c->x);
    if (r->kind == SurfaceKind::sphere) return is_positive(radius, d);
    if (r->kind != SurfaceKind::torus) return false;
    // The inside of a ring is a saddle: it meets itself where the circle reaches the axis.
    const double major = norm(c->centre - r->origin);
    return is_positive(radius, d) && is_positive(major, -radius) && is_positive(major, -radius - d);
}

}  // namespace

Result<SurfaceGeometry> GeometryReader::elementary(std::uint32_t i, Type type, double offset) const {
    const auto f = Fields::of(f_, i, type, 2);
    if (!f) return std::unexpected(f.error());
    const auto at = f->reference(1, "position");
    if (!at) return std::unexpected(at.error());
    const auto p = placement(*at);
    if (!p) return std::unexpected(p.error());
    const auto radius = type == Type::PLANE ? Result<double>(0) : f->number(2, "radius");
    if (!radius) return std::unexpected(radius.error());
    const auto bad = [&](double r) { return f->refused(text("has the radius ", r), RefusalKind::invalid); };
    switch (type) {
        case Type::PLANE:
            return Extrusion{Line<3>{p->o + offset * p->z, p->x}, p->y, SurfaceKind::plane};
        case Type::CYLINDRICAL_SURFACE: {
            const double r = *radius + offset;
            if (!(r > 0)) return bad(r);
            return Extrusion{Conic<3>{ConicKind::ellipse, p->o, r * p->x, r * p->y}, p->z,
                             SurfaceKind::cylinder};
        }
        case Type::CONICAL_SURFACE: {
            const auto a = f->number(3, "semi-angle");
            if (!a) return std::unexpected(a.error());
            const double s = std::sin(*a * angle), c = std::cos(*a * angle);
            if (!(*radius >= 0) || !(c > 1e-9) || !(std::abs(s) > 1e-12))
                return f->refused(text("has the radius ", *radius, " and the semi-angle ", *a),
                                  RefusalKind::invalid);
            return Revolution{Line<3>{p->o + *radius * p->x, s * p->x + c * p->z}, p->o, p->z,
                              SurfaceKind::cone};
        }
        case Type::SPHERICAL_SURFACE: {
            const double r = *radius + offset;
            if (!(r > 0)) return bad(r);
            return Revolution{Conic<3>{ConicKind::ellipse, p->o, r * p->x, r * p->z}, p->o, p->z,
                              SurfaceKind::sphere};
        }
        default:
            break;
    }
    const auto minor = f->number(3, "minor radius");
    if (!minor) return std::unexpected(minor.error());
    const double r = *minor + offset;
    if (!(r > 0) || !(*radius != 0)) return bad(!(r > 0) ? r : *radius);
    return Revolution{Conic<3>{ConicKind::ellipse, p->o + *radius * p->x, r * p->x, r * p->z}, p->o, p->z,
                      SurfaceKind::torus};
}

Result<SurfaceGeometry> GeometryReader::spline_surface(std::uint32_t i) {
    constexpr Type kNamed[] = {Type::B_SPLINE_SURFACE_WITH_KNOTS, Type::BEZIER_SURFACE, Type::UNIFORM_SURFACE,
                               Type::QUASI_UNIFORM_SURFACE, Type::B_SPLINE_SURFACE};
    const bool complex = f_.type(i) == Type::unknown;
    std::uint32_t main = complex ? f_.part(i, Type::B_SPLINE_SURFACE) : kMissing;
    for (const Type t : kNamed)
        if (main == kMissing && !complex) main = f_.part(i, t);
    if (main == kMissing)
        return refuse(RefusalKind::unreadable, f_.label(i), "is a spline without control points");
    const Fields f(f_, i, main);
    const int first = complex ? 0 : 1;
    const auto p = f.integer(first, "degree along u"), q = f.integer(first + 1, "degree along v");
    if (!p || !q) return std::unexpected(p ? q.error() : p.error());
    const auto rows = f.rows(first + 2, "control points");
    if (!rows) return std::unexpected(rows.error());
    std::vector<Vec<3>> points;
    std::size_t columns = 0;
    for (std::size_t r = 0; r < rows->size(); ++r) {
        const auto ids = f.references_at((*rows)[r], "control points");
        if (!ids) return std::unexpected(ids.error());
        if (r > 0 && ids->size() != columns)
            return f.refused(text("has rows of ", columns, " and of ", ids->size(), " control points"),
                             RefusalKind::invalid);
        columns = ids->size();
        for (const std::uint32_t id : *ids) {
            const auto x = point(id);
            if (!x) return std::unexpected(x.error());
            points.push_back(*x);
        }
    }
    const std::uint32_t list = f_.part(i, Type::B_SPLINE_SURFACE_WITH_KNOTS);
    const std::optional<Fields> with =
        list == kMissing ? std::nullopt : std::optional<Fields>(Fields(f_, i, list));
    const int k = complex ? 0 : 8;
    auto u = knots_of(f_, i, with ? &*with : nullptr, k, k + 2, "SURFACE", *p, int(rows->size()));
    if (!u) return std::unexpected(u.error());
    auto v = knots_of(f_, i, with ? &*with : nullptr, k + 1, k + 3, "SURFACE", *q, int(columns));
    if (!v) return std::unexpected(v.error());
    const std::array<std::size_t, 2> extent{rows->size(), columns};
    const auto kept = [&](const auto& net) {
        const auto some = kept_of(net, extent, 0, u->kept);
        return kept_of(some, {u->kept.empty() ? extent[0] : u->kept.size(), extent[1]}, 1, v->kept);
    };
    const auto joined = [&](const std::vector<double>& weights) {
        auto ok = join(i, moved_by_joining(points, weights, extent, 0, *u) +
                              moved_by_joining(points, weights, extent, 1, *v));
        points = kept(points);
        return ok;
    };
    const int nu = u->basis.size(), nv = v->basis.size();
    const auto within = [&](Refusal r) {
        return refuse(r.kind, f_.label(i), text(r.where, ": ", r.message));
    };
    if (const std::uint32_t rational = f_.part(i, Type::RATIONAL_B_SPLINE_SURFACE); rational != kMissing) {
        const Fields g(f_, i, rational);
        const auto lists = g.rows(g.size() - 1, "weights");
        if (!lists) return std::unexpected(lists.error());
        std::vector<double> w;
        for (const std::uint32_t row : *lists) {
            const auto more = g.numbers_at(row, "weights");
            if (!more) return std::unexpected(more.error());
            w.insert(w.end(), more->begin(), more->end());
        }
        if (w.size() != extent[0] * extent[1])
            return g.refused(
                text("has ", w.size(), " weights for ", extent[0] * extent[1], " control points"),
                RefusalKind::invalid);
        if (auto ok = joined(w); !ok) return std::unexpected(ok.error());
        auto net = make_rational<3>(points, kept(w));
        if (!net) return within(net.error());
        auto made = Surface<Hom<3>>::make({std::move(u->basis), std::move(v->basis)},
                                          Net<2, Hom<3>>({nu, nv}, std::move(*net)));
        if (!made) return within(made.error());
        return SurfaceGeometry(std::move(*made));
    }
    if (auto ok = joined({}); !ok) return std::unexpected(ok.error());
    auto made = Surface<Vec<3>>::make({std::move(u->basis), std::move(v->basis)},
                                      Net<2, Vec<3>>({nu, nv}, std::move(points)));
    if (!made) return within(made.error());
    return SurfaceGeometry(std::move(*made));
}

Result<CurveGeometry<3>> GeometryReader::profile(std::uint32_t i) {
    auto c = curve(i);
    if (!c) return std::unexpected(c.error());
    has_own_parameters_ = has_own_parameters_ || c->has_own_parameters;
    return c->reversed ? reversed(c->curve) : std::move(c->curve);
}

Result<SurfaceGeometry> GeometryReader::basic_surface(std::uint32_t i) {
    for (const Type t : {Type::PLANE, Type::CYLINDRICAL_SURFACE, Type::CONICAL_SURFACE,
                         Type::SPHERICAL_SURFACE, Type::TOROIDAL_SURFACE, Type::DEGENERATE_TOROIDAL_SURFACE})
        if (f_.is(i, t)) return elementary(i, t, 0);
    for (const Type t : {Type::B_SPLINE_SURFACE, Type::B_SPLINE_SURFACE_WITH_KNOTS, Type::BEZIER_SURFACE,
                         Type::UNIFORM_SURFACE, Type::QUASI_UNIFORM_SURFACE})
        if (f_.is(i, t)) return spline_surface(i);
    if (f_.is(i, Type::SURFACE_OF_LINEAR_EXTRUSION)) {
        const auto f = Fields::of(f_, i, Type::SURFACE_OF_LINEAR_EXTRUSION, 3);
        if (!f) return std::unexpected(f.error());
        const auto swept = f->reference(1, "curve"), along = f->reference(2, "direction");
        if (!swept || !along) return std::unexpected(swept ? along.error() : swept.error());
        auto c = profile(*swept);
        if (!c) return std::unexpected(c.error());
        const auto d = vector(*along);
        if (!d) return std::unexpected(d.error());
        const bool flat = std::holds_alternative<Line<3>>(*c);
        return Extrusion{std::move(*c), *d, flat ? SurfaceKind::plane : SurfaceKind::general};
    }
    if (f_.is(i, Type::SURFACE_OF_REVOLUTION)) {
        const auto f = Fields::of(f_, i, Type::SURFACE_OF_REVOLUTION, 3);
        if (!f) return std::unexpected(f.error());
        const auto swept = f->reference(1, "curve"), about = f->reference(2, "axis");
        if (!swept || !about) return std::unexpected(swept ? about.error() : swept.error());
        auto c = profile(*swept);
        if (!c) return std::unexpected(c.error());
        const auto axis = placement(*about);
        if (!axis) return std::unexpected(axis.error());
        return revolution(std::move(*c), axis->o, axis->z);
    }
    return refuse(RefusalKind::unsupported, f_.label(i),
                  text("is a surface that has no exact counterpart here (byte ", f_.instances[i].at, ")"));
}

// Offsets, trimmings and replicas are taken off one by one. Distances add up where the normal of each offset
// is that of the surface below: where none but the outermost turns or collapses it.
Result<SurfaceGeometry> GeometryReader::surface(std::uint32_t i) {
    double offset = 0;
    std::vector<OffsetStep> steps;
    std::optional<Motion> by;
    std::uint32_t at = i, trim = kMissing;
    for (int depth = 0;; ++depth) {
        if (depth > 100)
            return refuse(RefusalKind::invalid, f_.label(i),
                          "is a surface that refers to itself, or too deep");
        Type wrapping = Type::unknown;
        for (const Type t : {Type::OFFSET_SURFACE, Type::RECTANGULAR_TRIMMED_SURFACE,
                             Type::CURVE_BOUNDED_SURFACE, Type::SURFACE_REPLICA})
            if (f_.is(at, t)) wrapping = t;
        if (wrapping == Type::unknown) break;
        if (wrapping == Type::RECTANGULAR_TRIMMED_SURFACE) trim = at;
        const auto f = Fields::of(f_, at, wrapping, 3);
        if (!f) return std::unexpected(f.error());
        if (wrapping == Type::OFFSET_SURFACE) {
            const auto d = f->number(2, "distance");
            if (!d) return std::unexpected(d.error());
            steps.push_back({at, *d * (by ? by->scale : 1.0)});
            offset += steps.back().distance;
        } else if (wrapping == Type::SURFACE_REPLICA) {
            const auto m = f->reference(2, "transformation");
            if (!m) return std::unexpected(m.error());
            const auto to = transformation(*m);
            if (!to) return std::unexpected(to.error());
            Motion next = motion_to(to->to);
            next.scale = to->scale;
            by = by ? *by * next : next;
        }
        const auto basis = f->reference(1, "surface");
        if (!basis) return std::unexpected(basis.error());
        at = *basis;
    }
    const std::size_t known = approximated.size();
    has_own_parameters_ = false;
    auto made = [&]() -> Result<SurfaceGeometry> {
        std::erase_if(steps, [](const OffsetStep& s) { return s.distance == 0; });
        if (steps.size() > 1) {
            auto base = basic_surface(at);
            if (base && by) base = moved(*base, *by);
            if (!base) return base;
            double below = 0;
            for (; steps.size() > 1; steps.pop_back()) {
                below += steps.back().distance;
                if (!keeps_normal(*base, below))
                    return refuse(RefusalKind::unsupported, f_.label(steps[steps.size() - 2].instance),
                                  text("is the offset of ", f_.label(steps.back().instance),
                                       ", whose normal is not proven to be that of the surface below it"));
            }
        }
        if (offset != 0 && !by)
            for (const Type t :
                 {Type::PLANE, Type::CYLINDRICAL_SURFACE, Type::SPHERICAL_SURFACE, Type::TOROIDAL_SURFACE})
                if (f_.is(at, t))
                    if (auto simple = elementary(at, t, offset)) return simple;
        auto base = basic_surface(at);
        if (base && by) base = moved(*base, *by);
        for (std::size_t k = known; by && k < approximated.size(); ++k) approximated[k].bound *= by->scale;
        if (!base || offset == 0) return base;
        if (approximated.size() > known)
            return refuse(RefusalKind::unsupported, f_.label(i),
                          text("is the offset of a surface that rests on ",
                               f_.label(approximated.back().instance), ", which is taken as a spline"));
        return OffsetSurface{std::make_shared<const SurfaceGeometry>(std::move(*base)), offset};
    }();
    if (made && trim != kMissing && has_own_parameters_)
        return refuse(RefusalKind::unsupported, f_.label(trim),
                      "is trimmed by parameters of a composite curve with conics");
    if (made)
        if (auto ok = check(*made); !ok) return refuse(ok.error().kind, f_.label(i), ok.error().message);
    return made;
}

}  // namespace freiform::step
