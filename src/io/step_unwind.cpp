// A closed spline continued beyond its end: the coefficients of its turns one after the other. The ends are
// clamped first, so that each turn begins with the point where the last one ended. Files get one turn again:
// where a surface passes its points twice, edges do not say which part of it is meant.
#include "step_shape.hpp"

#include <freiform/core/visit.hpp>

#include <algorithm>
#include <cmath>

namespace freiform::step {

namespace {

constexpr double kSameTurn = 1e-12;  // of a turn: knots that many turns apart are so up to rounding

// Turns `turns` of the patch along the axis; the first one is the patch itself.
template <std::size_t N, class P>
Patch<N, P> turned_patch(const Patch<N, P>& given, int axis, int turns) {
    const Interval whole = given.domain()[std::size_t(axis)];
    const auto clamped_ends = restrict_to(given, axis, whole);
    if (!clamped_ends) return given;
    const Patch<N, P>& s = *clamped_ends;
    const auto& basis = s.basis(axis);
    const int p = basis.degree(), n = basis.size();
    const auto knots = basis.knots();
    std::vector<double> t(knots.begin(), knots.end() - 1);
    for (int k = 1; k < turns; ++k) {
        for (std::size_t i = std::size_t(p) + 1; i + 1 < knots.size(); ++i)
            t.push_back(i >= std::size_t(n) ? whole.lo + (k + 1) * whole.length()
                                            : knots[i] + k * whole.length());
    }
    t.push_back(t.back());
    auto longer = BSplineBasis::make(p, std::move(t));
    if (!longer) return given;
    Index<N> extent = s.net().extent();
    const int size = 1 + turns * (n - 1);
    extent[std::size_t(axis)] = size;
    std::vector<P> all;
    each_index(extent, [&](const Index<N>& at) {
        Index<N> from = at;
        int& i = from[std::size_t(axis)];
        i = i == size - 1 ? n - 1 : i % (n - 1);
        all.push_back(s.net().view()(from));
    });
    auto bases = s.bases();
    bases[std::size_t(axis)] = std::move(*longer);
    auto made = Patch<N, P>::make(std::move(bases), Net<N, P>(extent, std::move(all)));
    return made ? *made : given;
}

// The first turn of the patch, if it goes on with the same coefficients at the same distances of knots; its
// last ones may be `close`.
template <std::size_t N, class P>
bool turn_back(Patch<N, P>& s, std::size_t axis, double close) {
    const auto& basis = s.basis(int(axis));
    const int p = basis.degree(), n = basis.size();
    for (int m = 1; m + p < n && !basis.is_closed(); ++m) {
        Index<N> extent = s.net().extent(), next{};
        next[axis] = m;
        const auto net = s.net().view();
        bool same = net(next) == net({});
        const double turn = basis.knot(p + m) - basis.knot(p);
        for (int i = 1; same && i + m < n + p; ++i)
            same = std::abs(basis.knot(i + m) - basis.knot(i) - turn) <= kSameTurn * turn;
        if (!same) continue;
        extent[axis] -= m;
        each_index(extent, [&](const Index<N>& at) {
            next = at, next[axis] += m;
            same = same && (net(at) == net(next) ||
                            (next[axis] + 1 == n && norm(project(net(at)) - project(net(next))) <= close));
        });
        auto once = restrict_to(s, int(axis), {basis.knot(p), basis.knot(p + m)});
        if (!same || !once) continue;
        s = std::move(*once);
        return true;
    }
    return false;
}

// The spline that the surface is, or whose profile or base is one.
template <class F>
void change_spline(SurfaceGeometry& s, const F& change) {
    if (const auto* o = std::get_if<OffsetSurface>(&s)) {
        SurfaceGeometry base = *o->base;
        change_spline(base, change);
        s = OffsetSurface{std::make_shared<const SurfaceGeometry>(std::move(base)), o->distance};
    } else if (auto* e = std::get_if<Extrusion>(&s)) {
        visit_one(change, e->profile);
    } else if (auto* r = std::get_if<Revolution>(&s)) {
        visit_one(change, r->profile);
    } else {
        visit_one(change, s);
    }
}

}  // namespace

SurfaceGeometry unwound(const SurfaceGeometry& surface, const Chart& chart, const Box<2>& on, double slack) {
    SurfaceGeometry out = surface;
    for (int axis = 0; axis < 2; ++axis) {
        const Interval whole = chart.whole()[std::size_t(axis)];
        const double turn = chart.period(axis);
        if (!chart.is_spline(axis) || !(turn > 0) || on.is_empty()) continue;
        const int turns = int(std::clamp(std::ceil((on.hi[axis] - whole.lo) / turn - slack), 1.0, 8.0));
        if (turns == 1) continue;
        change_spline(out, [&](auto& g) {
            if constexpr (requires { g.net(); })
                g = turned_patch(g, std::remove_cvref_t<decltype(g)>::kParams == 1 ? 0 : axis, turns);
        });
    }
    return out;
}

bool rewind(SurfaceGeometry& surface, double close) {
    bool changed = false;
    change_spline(surface, [&](auto& g) {
        if constexpr (requires { g.net(); })
            for (std::size_t axis = 0; axis < std::remove_cvref_t<decltype(g)>::kParams; ++axis)
                changed |= turn_back(g, axis, close);
    });
    return changed;
}

std::optional<CurveGeometry<3>> continued(const CurveGeometry<3>& curve, double to, double close) {
    const SurfaceGeometry sheet = Extrusion{curve, {{1, 0, 0}}};
    const Chart chart(sheet, close);
    if (!chart.is_spline(0) || !(chart.period(0) > 0)) return std::nullopt;
    Box<2> on;
    on.add(Vec<2>{{to, 0}});
    auto longer = std::get<Extrusion>(unwound(sheet, chart, on, 0)).profile;
    if (!domain(longer)[0].contains(to)) return std::nullopt;
    return longer;
}

}  // namespace freiform::step
