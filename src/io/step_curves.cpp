// Curves. The standard fixes their parametrisation, which is kept: of lines point + t vector, of conics
//
//     circle, ellipse   C + a cos t X + b sin t Y        hyperbola  C + a cosh t X + b sinh t Y
//     parabola          C + f (t^2 X + 2 t Y)
//
// and of splines by their knots, which subtypes without knots imply. Wrappings (trimmed curves, curves on
// surfaces, replicas) are taken off one by one, in a loop and not on the stack.
//
// References: ISO 10303-42:2014, 4.4 (placements, curves).
#include "step_knots.hpp"
#include "step_shape.hpp"

#include <freiform/core/constants.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace freiform::step {

namespace {

constexpr int kMostWrappings = 100;

}  // namespace

Result<CurveGeometry<3>> GeometryReader::conic(std::uint32_t i, Type type) const {
    const bool one = type == Type::CIRCLE || type == Type::PARABOLA;
    const auto f = Fields::of(f_, i, type, one ? 3 : 4);
    if (!f) return std::unexpected(f.error());
    const auto at = f->reference(1, "position");
    if (!at) return std::unexpected(at.error());
    const auto p = placement(*at);
    if (!p) return std::unexpected(p.error());
    const auto a = f->number(2, one ? "radius" : "first semi-axis");
    if (!a) return std::unexpected(a.error());
    const auto b = one ? a : f->number(3, "second semi-axis");
    if (!b) return std::unexpected(b.error());
    if (!(*a > 0) || !(*b > 0))
        return f->refused(text("has the radius ", std::min(*a, *b)), RefusalKind::invalid);
    if (type == Type::PARABOLA) return Conic<3>{ConicKind::parabola, p->o, *a * p->x, 2 * *a * p->y};
    return Conic<3>{type == Type::HYPERBOLA ? ConicKind::hyperbola : ConicKind::ellipse, p->o, *a * p->x,
                    *b * p->y};
}

// Pieces of a spline are joined where that moves it by no more than the tolerance.
Result<void> GeometryReader::join(std::uint32_t spline, double moved) {
    if (!(moved <= tolerance))
        return refuse(RefusalKind::invalid, f_.label(spline),
                      text("has a knot that is repeated more than degree + 1 times, where its pieces are ",
                           moved, " apart"));
    if (moved > 0) approximated.push_back({spline, moved});
    return {};
}

Result<CurveGeometry<3>> GeometryReader::spline_curve(std::uint32_t i) {
    constexpr Type kNamed[] = {Type::B_SPLINE_CURVE_WITH_KNOTS, Type::BEZIER_CURVE, Type::UNIFORM_CURVE,
                               Type::QUASI_UNIFORM_CURVE, Type::B_SPLINE_CURVE};
    const bool complex = f_.type(i) == Type::unknown;
    std::uint32_t main = complex ? f_.part(i, Type::B_SPLINE_CURVE) : kMissing;
    for (const Type t : kNamed)
        if (main == kMissing && !complex) main = f_.part(i, t);
    if (main == kMissing)
        return refuse(RefusalKind::unreadable, f_.label(i), "is a spline without control points");
    const Fields f(f_, i, main);
    const int first = complex ? 0 : 1;
    const auto degree = f.integer(first, "degree");
    if (!degree) return std::unexpected(degree.error());
    const auto ids = f.references(first + 1, "control points");
    if (!ids) return std::unexpected(ids.error());
    const std::uint32_t list = f_.part(i, Type::B_SPLINE_CURVE_WITH_KNOTS);
    const std::optional<Fields> with =
        list == kMissing ? std::nullopt : std::optional<Fields>(Fields(f_, i, list));
    const int k = complex ? 0 : 6;
    auto basis = knots_of(f_, i, with ? &*with : nullptr, k, k + 1, "CURVE", *degree, int(ids->size()));
    if (!basis) return std::unexpected(basis.error());
    std::vector<Vec<3>> points;
    points.reserve(ids->size());
    for (const std::uint32_t id : *ids) {
        const auto p = point(id);
        if (!p) return std::unexpected(p.error());
        points.push_back(*p);
    }
    const std::array<std::size_t, 2> extent{points.size(), 1};
    const int size = basis->basis.size();
    const auto joined = [&](const std::vector<double>& weights) {
        auto ok = join(i, moved_by_joining(points, weights, extent, 0, *basis));
        points = kept_of(points, extent, 0, basis->kept);
        return ok;
    };
    const auto within = [&](Refusal r) {
        return refuse(r.kind, f_.label(i), text(r.where, ": ", r.message));
    };
    if (const std::uint32_t rational = f_.part(i, Type::RATIONAL_B_SPLINE_CURVE); rational != kMissing) {
        const Fields g(f_, i, rational);
        const auto w = g.numbers(g.size() - 1, "weights");
        if (!w) return std::unexpected(w.error());
        if (w->size() != extent[0])
            return g.refused(text("has ", w->size(), " weights for ", extent[0], " control points"),
                             RefusalKind::invalid);
        if (auto ok = joined(*w); !ok) return std::unexpected(ok.error());
        auto net = make_rational<3>(points, kept_of(*w, extent, 0, basis->kept));
        if (!net) return within(net.error());
        auto made = Curve<Hom<3>>::make({std::move(basis->basis)}, Net<1, Hom<3>>({size}, std::move(*net)));
        if (!made) return within(made.error());
        return CurveGeometry<3>(std::move(*made));
    }
    if (auto ok = joined({}); !ok) return std::unexpected(ok.error());
    auto made = Curve<Vec<3>>::make({std::move(basis->basis)}, Net<1, Vec<3>>({size}, std::move(points)));
    if (!made) return within(made.error());
    return CurveGeometry<3>(std::move(*made));
}

Result<BoundedCurve> GeometryReader::basic_curve(std::uint32_t i) {
    for (const Type t : {Type::CIRCLE, Type::ELLIPSE, Type::HYPERBOLA, Type::PARABOLA})
        if (f_.is(i, t)) {
            auto c = conic(i, t);
            if (!c) return std::unexpected(c.error());
            return BoundedCurve{std::move(*c), false, std::nullopt};
        }
    if (f_.is(i, Type::LINE)) {
        const auto f = Fields::of(f_, i, Type::LINE, 3);
        if (!f) return std::unexpected(f.error());
        const auto at = f->reference(1, "point"), along = f->reference(2, "vector");
        if (!at || !along) return std::unexpected(at ? along.error() : at.error());
        const auto o = point(*at);
        if (!o) return std::unexpected(o.error());
        const auto d = vector(*along);
        if (!d) return std::unexpected(d.error());
        return BoundedCurve{Line<3>{*o, *d}, false, std::nullopt};
    }
    if (f_.is(i, Type::POLYLINE)) {
        const auto f = Fields::of(f_, i, Type::POLYLINE, 2);
        if (!f) return std::unexpected(f.error());
        const auto ids = f->references(1, "points");
        if (!ids) return std::unexpected(ids.error());
        if (ids->size() < 2) return f->refused("has fewer than two points", RefusalKind::invalid);
        std::vector<Vec<3>> points;
        for (const std::uint32_t id : *ids) {
            const auto p = point(id);
            if (!p) return std::unexpected(p.error());
            points.push_back(*p);
        }
        const int size = int(points.size());
        auto basis = BSplineBasis::clamped_uniform(1, size);
        if (!basis) return std::unexpected(basis.error());
        auto made = Curve<Vec<3>>::make({std::move(*basis)}, Net<1, Vec<3>>({size}, std::move(points)));
        if (!made) return refuse(made.error().kind, f_.label(i), made.error().message);
        return BoundedCurve{std::move(*made), false, std::nullopt};
    }
    for (const Type t : {Type::B_SPLINE_CURVE, Type::B_SPLINE_CURVE_WITH_KNOTS, Type::BEZIER_CURVE,
                         Type::UNIFORM_CURVE, Type::QUASI_UNIFORM_CURVE})
        if (f_.is(i, t)) {
            auto c = spline_curve(i);
            if (!c) return std::unexpected(c.error());
            return BoundedCurve{std::move(*c), false, std::nullopt};
        }
    if (const std::uint32_t row = composite_in(f_, i); row != kMissing) return composite(row);
    return refuse(RefusalKind::unsupported, f_.label(i),
                  text("is a curve that has no exact counterpart here (byte ", f_.instances[i].at, ")"));
}

// The part that TRIMMED_CURVE leaves of its basis curve.
Result<BoundedCurve> GeometryReader::trimmed(std::uint32_t i, BoundedCurve basis) const {
    const auto f = Fields::of(f_, i, Type::TRIMMED_CURVE, 5);
    if (!f) return std::unexpected(f.error());
    const bool conic = std::holds_alternative<Conic<3>>(basis.curve);
    const bool ellipse = conic && std::get<Conic<3>>(basis.curve).kind == ConicKind::ellipse;
    const double unit = ellipse || basis.has_angles ? angle : 1.0;  // of the parameter
    const bool prefers_points = f->enumeration(5) == "CARTESIAN";
    std::array<double, 2> t{};
    for (int end = 0; end < 2; ++end) {
        if (!f->is(2 + end, TokenKind::list)) return f->expected(2 + end, "trim", "a list");
        std::optional<double> parameter, projected;
        std::optional<Refusal> bad;
        each_item(f_, f->list(2 + end), [&](std::uint32_t k) {
            const Token& token = f_.tokens[k];
            if (token.kind == TokenKind::keyword) {
                const auto x = f->numbers_at(k + 1, "trim");
                if (!x)
                    bad = x.error();
                else if (!x->empty())
                    parameter = x->front() * unit;
            } else if (token.kind == TokenKind::number) {  // without its type, against the standard
                if (const auto x = Fields(f_, i, f->list(2 + end)).number(0, "trim")) parameter = *x * unit;
            } else if (token.kind == TokenKind::reference && token.at != kMissing) {
                if (const auto p = point(token.at)) {
                    double distance = 0;
                    projected = parameter_of(basis.curve, *p, distance);
                }
            }
        });
        if (bad) return std::unexpected(*bad);
        if (!parameter && !projected) return f->refused("has a trim that is neither a point nor a parameter");
        if (basis.has_own_parameters && !projected)
            return f->refused("is trimmed by a parameter of a composite curve with conics",
                              RefusalKind::unsupported);
        t[std::size_t(end)] = parameter && !((prefers_points || basis.has_own_parameters) && projected)
                                  ? *parameter
                                  : *projected;
    }
    bool backward = !f->flag(4);
    double lo = backward ? t[1] : t[0], hi = backward ? t[0] : t[1];
    if (ellipse) {
        while (hi <= lo && std::abs(lo) < 1e6) hi += kTwoPi;
    } else if (hi <= lo) {
        const double turn = domain(basis.curve)[0].length();
        if (auto longer = continued(basis.curve, hi + turn, tolerance))
            basis.curve = std::move(*longer), hi += turn;  // over the place where it closes
        else if (hi < lo)
            std::swap(lo, hi), backward = !backward;  // from one to the other there is one way only
    }
    basis.reversed = basis.reversed != backward;
    basis.range = Interval{lo, std::max(lo, hi)};
    return basis;
}

Result<BoundedCurve> GeometryReader::wrapped_curve(std::uint32_t wrapping, BoundedCurve c) const {
    if (f_.is(wrapping, Type::TRIMMED_CURVE)) return trimmed(wrapping, std::move(c));
    for (const Type t : {Type::OFFSET_CURVE_2D, Type::OFFSET_CURVE_3D})
        if (f_.is(wrapping, t)) return offset_of(wrapping, t, std::move(c));
    if (!f_.is(wrapping, Type::CURVE_REPLICA)) return c;
    const auto f = Fields::of(f_, wrapping, Type::CURVE_REPLICA, 3);
    if (!f) return std::unexpected(f.error());
    const auto by = f->reference(2, "transformation");
    if (!by) return std::unexpected(by.error());
    const auto to = transformation(*by);
    if (!to) return std::unexpected(to.error());
    Motion m = motion_to(to->to);
    m.scale = to->scale;
    c.curve = moved(c.curve, m);
    c.bound *= m.scale;
    return c;
}

Result<BoundedCurve> GeometryReader::unwrapped_curve(std::uint32_t i) {
    std::vector<std::uint32_t> wrappings;
    std::uint32_t at = i;
    for (;;) {
        if (wrappings.size() > kMostWrappings)
            return refuse(RefusalKind::invalid, f_.label(i), "is a curve that refers to itself, or too deep");
        int field = -1;
        for (const Type t :
             {Type::TRIMMED_CURVE, Type::SURFACE_CURVE, Type::SEAM_CURVE, Type::INTERSECTION_CURVE,
              Type::CURVE_REPLICA, Type::OFFSET_CURVE_2D, Type::OFFSET_CURVE_3D})
            if (f_.is(at, t) && field < 0) {
                const Fields f(f_, at, f_.part(at, t));
                field = f_.type(at) == Type::unknown ? 0 : 1;
                const auto next = f.reference(field, "curve");
                if (!next) return std::unexpected(next.error());
                wrappings.push_back(at);
                at = *next;
            }
        if (field < 0) break;
    }
    auto c = basic_curve(at);
    for (; c && !wrappings.empty(); wrappings.pop_back()) c = wrapped_curve(wrappings.back(), std::move(*c));
    if (c)
        if (auto ok = check(c->curve); !ok) return refuse(ok.error().kind, f_.label(i), ok.error().message);
    return c;
}

Result<BoundedCurve> GeometryReader::curve(std::uint32_t i) {
    auto known = curves_.find(i);
    if (known == curves_.end()) {
        // Until it is known; composite curves may come back to it.
        const Refusal itself{RefusalKind::invalid, f_.label(i), "is a curve that is a part of itself"};
        known = curves_.emplace(i, std::unexpected(itself)).first;
        Result<BoundedCurve>& own = known->second;
        ++depth_;
        own = unwrapped_curve(i);
        --depth_;
        known = curves_.find(i);
    }
    const Result<BoundedCurve>& c = known->second;
    if (c && c->approximated != kMissing) approximated.push_back({c->approximated, c->bound});
    return c;
}

}  // namespace freiform::step
