// A closed spline continued beyond its end: the coefficients of its turns one after the other. One that goes
// on with its first coefficients beyond its ends is as smooth between its turns as it is there. The ends of
// others are clamped first, so that each turn begins with the point where the last one ended. Files get one
// turn again: where a surface passes its points twice, edges do not say which part of it is meant.
#include "step_shape.hpp"

#include <freiform/core/visit.hpp>

#include <algorithm>
#include <cmath>

namespace freiform::step {

namespace {

constexpr double kSameTurn = 1e-12;  // of a turn: knots that many turns apart are so up to rounding

// Whether the patch goes on after m coefficients with the same ones at the same distances of knots; its last
// ones may be `close`.
template <std::size_t N, class P>
bool same_after(const Patch<N, P>& s, std::size_t axis, int m, double close) {
    const auto& basis = s.basis(int(axis));
    const int p = basis.degree(), n = basis.size();
    Index<N> extent = s.net().extent(), next{};
    next[axis] = m;
    const auto net = s.net().view();
    bool same = net(next) == net({});
    const double turn = basis.knot(p + m) - basis.knot(p);
    for (int i = 1; same && i + m < n + p; ++i)
        same = std::abs(basis.knot(i + m) - basis.knot(i) - turn) <= kSameTurn * turn;
    if (!same) return false;
    extent[axis] -= m;
    each_index(extent, [&](const Index<N>& at) {
        next = at, next[axis] += m;
        same = same && (net(at) == net(next) ||
                        (next[axis] + 1 == n && norm(project(net(at)) - project(net(next))) <= close));
    });
    return same;
}

// After how many coefficients one begins again that is not clamped; 0 if it is, or does not.
template <std::size_t N, class P>
int coefficients_of_turn(const Patch<N, P>& s, int axis) {
    const auto& basis = s.basis(axis);
    const int p = basis.degree(), n = basis.size();
    if (basis.is_closed() || basis.knot(0) == basis.knot(p)) return 0;
    for (int m = std::max(n - p, p + 1); m < n; ++m)
        if (basis.knot(p + m) == basis.knot(n) && same_after(s, std::size_t(axis), m, 0)) return m;
    return 0;
}

// The patch with other knots along the axis; `from`: which of its coefficients each one is.
template <std::size_t N, class P, class F>
std::optional<Patch<N, P>> with_knots(const Patch<N, P>& s, int axis, std::vector<double> knots,
                                      const F& from) {
    const int p = s.basis(axis).degree(), size = int(knots.size()) - p - 1;
    auto basis = BSplineBasis::make(p, std::move(knots));
    if (!basis) return std::nullopt;
    Index<N> extent = s.net().extent();
    extent[std::size_t(axis)] = size;
    std::vector<P> all;
    each_index(extent, [&](Index<N> at) {
        at[std::size_t(axis)] = from(at[std::size_t(axis)]);
        all.push_back(s.net().view()(at));
    });
    auto bases = s.bases();
    bases[std::size_t(axis)] = std::move(*basis);
    auto made = Patch<N, P>::make(std::move(bases), Net<N, P>(extent, std::move(all)));
    if (!made) return std::nullopt;
    return std::move(*made);
}

// Turns `turns` of the patch along the axis; the first one is the patch itself.
template <std::size_t N, class P>
Patch<N, P> turned_patch(const Patch<N, P>& given, int axis, int turns) {
    const Interval whole = given.domain()[std::size_t(axis)];
    int m = coefficients_of_turn(given, axis);
    auto ends = m > 0 ? given : restrict_to(given, axis, whole);
    if (!ends) return given;
    const auto& basis = ends->basis(axis);
    const int p = basis.degree(), n = basis.size();
    if (m == 0) m = n - 1;
    const int more = (turns - 1) * m;
    std::vector<double> t;
    for (int i = 0; i <= n + p + more; ++i) {
        const int k = std::clamp((i - 1 - p) / m, 0, turns - 1);
        const double knot = basis.knot(i - k * m);
        t.push_back(knot == whole.hi ? whole.lo + (k + 1) * whole.length() : knot + k * whole.length());
    }
    auto made =
        with_knots(*ends, axis, std::move(t), [&](int i) { return i < n - 1 + more ? i % m : n - 1; });
    return made ? *made : given;
}

// The first turn of the patch, if it goes on after it.
template <std::size_t N, class P>
bool turn_back(Patch<N, P>& s, int axis, double close) {
    const auto& basis = s.basis(axis);
    const int p = basis.degree(), n = basis.size();
    for (int m = 1; m + p < n && !basis.is_closed(); ++m) {
        if (!same_after(s, std::size_t(axis), m, close)) continue;
        const Interval turn{basis.knot(p), basis.knot(p + m)};
        int size = n;  // of one that is not clamped
        while (size >= p + 2 * m && basis.knot(size - m) >= turn.hi) size -= m;
        std::optional<Patch<N, P>> once;
        if (basis.knot(0) < turn.lo && basis.knot(size) == turn.hi) {
            const auto knots = basis.knots().first(std::size_t(size + p) + 1);
            once = with_knots(s, axis, {knots.begin(), knots.end()}, [](int i) { return i; });
        } else if (auto part = restrict_to(s, axis, turn)) {
            once = std::move(*part);
        }
        if (!once) continue;
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
            for (int axis = 0; axis < int(std::remove_cvref_t<decltype(g)>::kParams); ++axis)
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
