// Curves that a file gives in the parameters of a surface alone: PCURVE, or SURFACE_CURVE whose curve in
// space is left out or cannot be read.
//
// On planes, and along parameter lines, they are curves of ours, exactly but for rounding. Elsewhere a cubic
// spline stands for them within a bound that is proven (step_lift.hpp) and told.
//
// Units. The parameters of the standard are those of our surfaces, but for that along a cone, which is a
// length along its axis there; and angles are in the unit of the file, or in radians, against the standard.
// The vertices of the edge say which.
//
// References: ISO 10303-42:2014, 4.4 (pcurve, surface_curve).
#include "step_lift.hpp"
#include "step_shape.hpp"

#include <freiform/core/visit.hpp>

#include <algorithm>
#include <cmath>

namespace freiform::step {

namespace {

constexpr int kMostTurns = 16;  // of a line in parameters around its surface

// Of the size of the curve: vertices further off than this belong to another.
constexpr double kOffEnds = 1e-3;

bool has_angle(const CurveGeometry<3>& profile) {
    const auto* c = std::get_if<Conic<3>>(&profile);
    return c != nullptr && c->kind == ConicKind::ellipse;
}

// What the parameters of the standard have to be multiplied by; `angle`: its unit, in radians.
Vec<2> parameter_units(const SurfaceGeometry& s, double angle) {
    if (const auto* o = std::get_if<OffsetSurface>(&s)) return parameter_units(*o->base, angle);
    if (const auto* e = std::get_if<Extrusion>(&s)) return {{has_angle(e->profile) ? angle : 1, 1}};
    const auto* r = std::get_if<Revolution>(&s);
    if (r == nullptr) return {{1, 1}};
    const auto* l = std::get_if<Line<3>>(&r->profile);
    if (l != nullptr && r->kind == SurfaceKind::cone) return {{angle, 1 / dot(l->direction, r->axis)}};
    return {{angle, has_angle(r->profile) ? angle : 1}};
}

// The first two coordinates, each times its unit.
CurveGeometry<2> flattened(const CurveGeometry<3>& c, const Vec<2>& unit) {
    const auto flat = [&](const auto& p) { return Vec<2>{{unit[0] * p[0], unit[1] * p[1]}}; };
    return visit_one(
        [&](const auto& g) -> CurveGeometry<2> {
            using G = std::remove_cvref_t<decltype(g)>;
            if constexpr (std::same_as<G, Line<3>>) {
                return Line<2>{flat(g.origin), flat(g.direction)};
            } else if constexpr (std::same_as<G, Conic<3>>) {
                return Conic<2>{g.kind, flat(g.centre), flat(g.x), flat(g.y)};
            } else {
                using P = std::conditional_t<Space<typename G::Coefficients>::kRational, Hom<2>, Vec<2>>;
                Net<1, P> net(g.net().extent());
                for (std::size_t i = 0; i < net.flat().size(); ++i) {
                    const auto& from = g.net().flat()[i];
                    const Vec<2> p = flat(from);
                    if constexpr (std::same_as<P, Hom<2>>)
                        net.flat()[i] = {{p[0], p[1], from.weight()}};
                    else
                        net.flat()[i] = p;
                }
                return Curve<P>::trusted(g.bases(), std::move(net));
            }
        },
        c);
}

// On a plane: the same curve in other coordinates.
std::optional<CurveGeometry<3>> raised(const SurfaceGeometry& surface, const CurveGeometry<2>& c) {
    const auto* s = std::get_if<Extrusion>(&surface);
    const auto* l = s != nullptr ? std::get_if<Line<3>>(&s->profile) : nullptr;
    if (l == nullptr) return std::nullopt;
    const auto direction = [&](const auto& d) { return d[0] * l->direction + d[1] * s->direction; };
    const auto point = [&](const auto& p) { return l->origin + direction(p); };
    return visit_one(
        [&](const auto& g) -> CurveGeometry<3> {
            using G = std::remove_cvref_t<decltype(g)>;
            if constexpr (std::same_as<G, Line<2>>) {
                return Line<3>{point(g.origin), direction(g.direction)};
            } else if constexpr (std::same_as<G, Conic<2>>) {
                // centre + t^2 x + t y and the like: the vectors are directions
                return Conic<3>{g.kind, point(g.centre), direction(g.x), direction(g.y)};
            } else {
                using P = std::conditional_t<Space<typename G::Coefficients>::kRational, Hom<3>, Vec<3>>;
                Net<1, P> net(g.net().extent());
                for (std::size_t i = 0; i < net.flat().size(); ++i) {
                    const auto& from = g.net().flat()[i];
                    if constexpr (std::same_as<P, Hom<3>>)
                        net.flat()[i] = weighted(point(project(from)), from.weight());
                    else
                        net.flat()[i] = point(from);
                }
                return Curve<P>::trusted(g.bases(), std::move(net));
            }
        },
        c);
}

// A line, also one that is written as a spline between two points.
std::optional<Line<2>> as_line(const CurveGeometry<2>& c) {
    if (const auto* l = std::get_if<Line<2>>(&c)) return *l;
    const auto* s = std::get_if<Curve<Vec<2>>>(&c);
    if (s == nullptr || s->net().flat().size() != 2) return std::nullopt;
    const Interval on = s->basis().domain();
    const Vec<2> d = (1 / on.length()) * (s->net().flat()[1] - s->net().flat()[0]);
    return Line<2>{s->net().flat()[0] - on.lo * d, d};
}

// Along a parameter line of the surface.
std::optional<BoundedCurve> along_parameter(const Chart& chart, const Line<2>& l,
                                            std::optional<Interval> on) {
    for (int axis = 0; axis < 2; ++axis) {
        const double speed = l.direction[1 - axis], from = l.origin[1 - axis];
        if (l.direction[axis] != 0 || speed == 0) continue;
        auto c = chart.iso(axis, l.origin[axis]);
        if (!c) return std::nullopt;
        BoundedCurve out{std::move(*c), speed < 0, std::nullopt};
        if (on) {
            const double p = from + speed * on->lo, q = from + speed * on->hi;
            out.range = Interval{std::min(p, q), std::max(p, q)};
        }
        return out;
    }
    return std::nullopt;
}

// Which part of a line in parameters, around the surface or not, ends at the two points.
std::optional<Interval> part_between(const Chart& chart, const Line<2>& l,
                                     const std::array<Vec<3>, 2>& ends) {
    const double square = dot(l.direction, l.direction);
    std::array<double, 2> at{};
    for (std::size_t k = 0; k < 2; ++k) {
        const Vec<2> uv = chart.locate(ends[k]);
        double least = std::numeric_limits<double>::infinity();
        for (int i = -kMostTurns; i <= kMostTurns; ++i)
            for (int j = -kMostTurns; j <= kMostTurns; ++j) {
                if ((i != 0 && !(chart.period(0) > 0)) || (j != 0 && !(chart.period(1) > 0))) continue;
                const Vec<2> p = uv + Vec<2>{{i * chart.period(0), j * chart.period(1)}} - l.origin;
                const double t = dot(p, l.direction) / square, off = norm(p - t * l.direction);
                if (off < least) least = off, at[k] = t;
            }
    }
    const Interval on{std::min(at[0], at[1]), std::max(at[0], at[1])};
    if (!std::isfinite(on.length()) || !(on.lo < on.hi)) return std::nullopt;
    return on;
}

}  // namespace

// The PCURVEs that a curve is, or says that it is: two at most, as the standard has it.
std::vector<std::uint32_t> GeometryReader::pcurves(std::uint32_t curve) const {
    if (f_.is(curve, Type::PCURVE)) return {curve};
    std::vector<std::uint32_t> found;
    for (const Type t : {Type::SURFACE_CURVE, Type::SEAM_CURVE, Type::INTERSECTION_CURVE}) {
        if (!f_.is(curve, t)) continue;
        const Fields f(f_, curve, f_.part(curve, t));
        const int first = f_.type(curve) == Type::unknown ? 0 : 1;
        std::vector<std::uint32_t> all;
        if (const auto space = f.reference(first, "curve")) all.push_back(*space);
        if (const auto ids = f.references(first + 1, "associated geometry"))
            all.insert(all.end(), ids->begin(), ids->end());
        for (const std::uint32_t id : all)
            if (f_.is(id, Type::PCURVE) && found.size() < 2) found.push_back(id);
        break;
    }
    return found;
}

Result<std::vector<std::uint32_t>> GeometryReader::items_of_pcurve(std::uint32_t pcurve) const {
    const auto p = Fields::of(f_, pcurve, Type::PCURVE, 2);  // a part of a complex instance has no name
    if (!p) return std::unexpected(p.error());
    const auto by = p->reference(p->size() - 1, "representation");
    if (!by) return std::unexpected(by.error());
    const auto d = Fields::of(f_, *by, Type::DEFINITIONAL_REPRESENTATION, 3);
    if (!d) return std::unexpected(d.error());
    return d->references(1, "items");
}

Result<BoundedCurve> ShapeReader::lifted_curve(std::uint32_t pcurve, const std::array<Vec<3>, 2>* ends) {
    const auto p = Fields::of(f_, pcurve, Type::PCURVE, 2);
    if (!p) return std::unexpected(p.error());
    const auto on = p->reference(p->size() - 2, "surface");
    if (!on) return std::unexpected(on.error());
    const auto items = geometry_.items_of_pcurve(pcurve);
    if (!items) return std::unexpected(items.error());
    if (items->size() != 1)
        return p->refused(text("has ", items->size(), " curves for one"), RefusalKind::invalid);
    const auto given = geometry_.curve(items->front());
    if (!given) return std::unexpected(given.error());
    const auto made = surface(*on);
    if (!made) return std::unexpected(made.error());
    const Chart& chart = *(*made)->chart;
    std::optional<Refusal> why;
    for (const double angle : {geometry_.angle, 1.0}) {
        const auto flat = flattened(given->curve, parameter_units(chart.surface(), angle));
        // The part of an endless one is that between the vertices; others are the same for all edges.
        const bool endless = !given->range && !std::isfinite(domain(flat)[0].length());
        const auto key = std::pair(pcurve, angle == geometry_.angle);
        auto known = endless ? lifts_.end() : lifts_.find(key);
        auto c = known == lifts_.end() ? lift_one(chart, flat, *given, ends, pcurve) : known->second;
        if (!endless && known == lifts_.end()) lifts_.emplace(key, c);
        if (c && ends == nullptr) return c;
        if (c) {
            Box<3> box;
            for (const Vec<3>& end : *ends) box.add(end);
            const Interval part = c->range.value_or(domain(c->curve)[0]);
            for (int k = 0; k <= 8 && std::isfinite(part.length()); ++k)
                box.add(jet<0>(c->curve, part.lo + part.length() * k / 8).value());
            double off = 0, worst = 0;
            for (const Vec<3>& end : *ends) parameter_of(c->curve, end, off), worst = std::max(worst, off);
            if (worst <= std::max(tolerance_, kOffEnds * box.diagonal())) return c;
            why = Refusal{RefusalKind::invalid, "",
                          text("passes ", worst, " beside the vertices of the edge that it is")};
        } else if (!why) {
            why = c.error();
        }
        if (geometry_.angle == 1) break;
    }
    return p->refused(why->message, why->kind);
}

Result<BoundedCurve> ShapeReader::lift_one(const Chart& chart, const CurveGeometry<2>& flat,
                                           const BoundedCurve& given, const std::array<Vec<3>, 2>* ends,
                                           std::uint32_t pcurve) {
    const Interval whole = given.range.value_or(domain(flat)[0]);
    const bool endless = !std::isfinite(whole.length());
    if (!(whole.lo < whole.hi)) return refuse(RefusalKind::invalid, "", "is trimmed to nothing");
    const auto line = as_line(flat);
    BoundedCurve out{{}, given.reversed, endless ? std::nullopt : std::optional<Interval>(whole)};
    if (auto same = raised(chart.surface(), flat)) {
        out.curve = std::move(*same);
    } else if (auto along = line ? along_parameter(chart, *line, out.range) : std::nullopt) {
        along->reversed = along->reversed != given.reversed;
        out = std::move(*along);
    } else {
        std::optional<Interval> on = out.range;
        if (endless && line && ends != nullptr) on = part_between(chart, *line, *ends);
        if (!on) return refuse(RefusalKind::unsupported, "", "is a curve without end");
        Box<3> box;
        for (int k = 0; k <= 16; ++k)
            box.add(chart.point(jet<0>(flat, on->lo + on->length() * k / 16).value()));
        const double size = box.diagonal();
        auto near =
            lift(chart.surface(), flat, *on, geometry_.lift_accuracy(size), geometry_.lift_limit(size));
        if (!near) return std::unexpected(near.error());
        out.curve = std::move(near->curve), out.range = *on;
        out.approximated = pcurve, out.bound = near->bound;
    }
    if (auto ok = check(out.curve); !ok) return std::unexpected(ok.error());
    return out;
}

// The curve in space; where there is none, or it cannot be read, one that the parameters of a surface give.
Result<BoundedCurve> ShapeReader::curve_in_space(std::uint32_t i, const std::array<Vec<3>, 2>* ends) {
    auto c = geometry_.curve(i);
    if (c) return c;
    const auto all = geometry_.pcurves(i);
    for (const std::uint32_t pcurve : all) {
        auto lifted = lifted_curve(pcurve, ends);
        if (!lifted) {
            c = std::unexpected(lifted.error());
            continue;
        }
        if (lifted->approximated != kMissing)
            geometry_.approximated.push_back({lifted->approximated, lifted->bound});
        return lifted;
    }
    return c;
}

}  // namespace freiform::step
