// Surfaces of models as splines; part_spline_detail.hpp is the essay.
//
// Accuracy. Arcs and revolutions come with bounds. A line has an end off by 3 u of its coordinates; a profile
// turned to where the part begins by 16 u of the distance from the axis and of the coordinates together: six
// products of numbers that are off by at most 2 u each, and their sums. Extrusion adds 3 u of both terms.
#include "part_spline_detail.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/core/visit.hpp>
#include <freiform/make/conic.hpp>
#include <freiform/make/offset_spline.hpp>
#include <freiform/make/revolve.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace freiform::detail {

ParameterArcs::Place ParameterArcs::place(double s) const {
    const int arc = std::clamp(int(s * arcs_), 0, arcs_ - 1);
    return {arc, 2 * (s * arcs_ - arc) - 1};
}

double ParameterArcs::at(double s) const {
    if (is_identity()) return s;
    if (s <= 0) return on_.lo;
    if (s >= 1) return on_.hi;
    const auto [arc, v] = place(s);
    const double beside = 2 * (hyperbolic_ ? std::atanh(k_ * v) : std::atan(k_ * v));
    return clamped(on_.lo + on_.length() * ((arc + 0.5) / arcs_) + beside, on_);
}

double ParameterArcs::slope(double s) const {
    if (is_identity()) return 1;
    const double v = place(s).v;
    return 4 * k_ * arcs_ / (1 + (hyperbolic_ ? -1 : 1) * k_ * k_ * v * v);
}

Interval ParameterArcs::over(const Interval& s) const {
    if (is_identity()) return s;
    const double slack = 32 * kUnitRoundoff * std::max({std::abs(on_.lo), std::abs(on_.hi), on_.length()});
    return {std::max(on_.lo, at(s.lo) - slack), std::min(on_.hi, at(s.hi) + slack)};
}

namespace {

// But for the rounding of its ends.
bool is_full_turn(const Interval& on) {
    return std::abs(on.length() - kTwoPi) <= 8 * kUnitRoundoff * (kTwoPi + std::abs(on.lo));
}

struct PartProfile {
    Curve<Hom<3>> curve;
    ParameterArcs map{};
    double bound = 0;
};

double size_of_net(const Curve<Hom<3>>& c) {
    double size = 0;
    for (const Vec<3>& p : points(c)) size = std::max(size, max_abs(p));
    return size;
}

Result<Curve<Hom<3>>> restricted(Curve<Hom<3>> c, Interval on) {
    if (c.domain()[0] == on) return c;
    return restrict_to(c, 0, on);
}

// Of hyperbolas pieces of equal length, none longer than 2: their weights are equal, and so are they where
// two meet.
Result<PartProfile> open_conic(const Conic<3>& conic, Interval on) {
    const bool split = conic.kind == ConicKind::hyperbola;
    const int n = split ? std::max(1, int(std::ceil(std::min(on.length() / 2, 1e3)))) : 1;
    const auto at = [&](int i) { return i == n ? on.hi : on.lo + on.length() * i / n; };
    std::vector<Hom<3>> net;
    std::vector<double> knots(3, split ? 0 : on.lo);
    double bound = 0;
    for (int i = 0; i < n; ++i) {
        const auto arc = conic_arc(conic, {at(i), at(i + 1)});
        if (!arc) return std::unexpected(arc.error());
        bound = std::max(bound, arc->bound);
        const auto& piece = arc->curve.net().flat();
        net.insert(net.end(), piece.begin() + (i > 0), piece.end());
        knots.insert(knots.end(), i + 1 == n ? 3 : 2, split ? double(i + 1) / n : on.hi);
    }
    const auto basis = BSplineBasis::make(2, std::move(knots));
    if (!basis) return std::unexpected(basis.error());
    auto curve = Curve<Hom<3>>::make({*basis}, Net<1, Hom<3>>({2 * n + 1}, std::move(net)));
    if (!curve) return std::unexpected(curve.error());
    // Ends of pieces are rounded, and places by what the parameters are.
    bound += 64 * kUnitRoundoff * (size_of_net(*curve) + norm(conic.centre)) *
             (1 + std::max(std::abs(on.lo), std::abs(on.hi)));
    return PartProfile{std::move(*curve), split ? ParameterArcs(on, n, true) : ParameterArcs(), bound};
}

Result<PartProfile> part_profile(const CurveGeometry<3>& profile, Interval on) {
    if (const auto* line = std::get_if<Line<3>>(&profile)) {
        const auto basis = BSplineBasis::bezier(1, on);
        if (!basis) return std::unexpected(basis.error());
        const Vec<3> a = line->origin + on.lo * line->direction, b = line->origin + on.hi * line->direction;
        auto curve = Curve<Hom<3>>::make(
            {*basis}, Net<1, Hom<3>>({2}, {Space<Hom<3>>::lift(a, 1), Space<Hom<3>>::lift(b, 1)}));
        if (!curve) return std::unexpected(curve.error());
        const double size =
            max_abs(line->origin) + std::max(std::abs(on.lo), std::abs(on.hi)) * max_abs(line->direction);
        return PartProfile{std::move(*curve), {}, 6 * kUnitRoundoff * size};
    }
    if (const auto* conic = std::get_if<Conic<3>>(&profile)) {
        if (conic->kind != ConicKind::ellipse) return open_conic(*conic, on);
        Conic<3> from = *conic;
        const bool turn = is_full_turn(on);
        if (turn && on.lo != 0) {
            from.x = std::cos(on.lo) * conic->x + std::sin(on.lo) * conic->y;
            from.y = std::cos(on.lo) * conic->y - std::sin(on.lo) * conic->x;
        }
        auto arc = conic_arc(from, turn ? Interval{0, kTwoPi} : on);
        if (!arc) return std::unexpected(arc.error());
        const int n = int(arc->curve.basis().breaks().size()) - 1;
        const double size = max_abs(conic->x) + max_abs(conic->y);
        return PartProfile{std::move(arc->curve), ParameterArcs(on, n),
                           arc->bound + 16 * kUnitRoundoff * size};
    }
    const auto* polynomial = std::get_if<Curve<Vec<3>>>(&profile);
    auto curve = restricted(polynomial ? to_rational(*polynomial) : std::get<Curve<Hom<3>>>(profile), on);
    if (!curve) return std::unexpected(curve.error());
    const double bound = 32 * curve->basis().degree() * kUnitRoundoff * size_of_net(*curve);
    return PartProfile{std::move(*curve), {}, bound};
}

Result<PartSpline> part_of(const Extrusion& e, const std::array<Interval, 2>& on) {
    auto profile = part_profile(e.profile, on[0]);
    if (!profile) return std::unexpected(profile.error());
    const auto across = BSplineBasis::bezier(1, on[1]);
    if (!across) return std::unexpected(across.error());
    std::vector<Hom<3>> net;
    for (const Hom<3>& h : profile->curve.net().flat())
        for (const double v : {on[1].lo, on[1].hi}) {
            Hom<3> p = h;
            for (int k = 0; k < 3; ++k) p[k] += h.weight() * (v * e.direction[k]);
            net.push_back(p);
        }
    const double size =
        size_of_net(profile->curve) + std::max(std::abs(on[1].lo), std::abs(on[1].hi)) * max_abs(e.direction);
    auto made = Surface<Hom<3>>::make({profile->curve.basis(), *across},
                                      Net<2, Hom<3>>({profile->curve.basis().size(), 2}, std::move(net)));
    if (!made) return std::unexpected(made.error());
    return PartSpline{std::move(*made), {profile->map, {}}, profile->bound + 16 * kUnitRoundoff * size};
}

// Turned by an angle about the axis, which has length 1.
Vec<3> turned(const Vec<3>& p, const Revolution& r, double angle) {
    const Vec<3> arm = p - r.origin, along = dot(arm, r.axis) * r.axis, out = arm - along;
    return r.origin + along + std::cos(angle) * out + std::sin(angle) * cross(r.axis, out);
}

Result<PartSpline> part_of(const Revolution& r, const std::array<Interval, 2>& on) {
    auto profile = part_profile(r.profile, on[1]);
    if (!profile) return std::unexpected(profile.error());
    std::vector<Hom<3>> net;
    double size = max_abs(r.origin);
    for (const Hom<3>& h : profile->curve.net().flat()) {
        const Vec<3> p = turned(Space<Hom<3>>::project(h), r, on[0].lo);
        size = std::max({size, max_abs(p), max_abs(Space<Hom<3>>::project(h))});
        net.push_back(Space<Hom<3>>::lift(p, h.weight()));
    }
    const int n = int(net.size());
    auto start = Curve<Hom<3>>::make({profile->curve.basis()}, Net<1, Hom<3>>({n}, std::move(net)));
    if (!start) return std::unexpected(start.error());
    const double angle = is_full_turn(on[0]) ? kTwoPi : on[0].length();
    auto made = revolve(*start, Axis{r.origin, r.axis}, angle, Seam::open);
    if (!made) return std::unexpected(made.error());
    const int arcs = int(made->surface.basis(0).breaks().size()) - 1;
    return PartSpline{std::move(made->surface),
                      {ParameterArcs(on[0], arcs), profile->map},
                      profile->bound + made->bound + 128 * kUnitRoundoff * size};
}

template <class P>
Result<PartSpline> part_of(const Surface<P>& s, const std::array<Interval, 2>& on) {
    Result<Surface<Hom<3>>> all = [&] {
        if constexpr (Space<P>::kRational)
            return s;
        else
            return to_rational(s);
    }();
    double size = 0;
    for (const Vec<3>& p : points(s)) size = std::max(size, max_abs(p));
    double bound = 0;
    for (int k = 0; k < 2 && all; ++k)
        if (all->domain()[std::size_t(k)] != on[std::size_t(k)]) {
            bound += 32 * all->basis(k).degree() * kUnitRoundoff * size;
            all = restrict_to(*all, k, on[std::size_t(k)]);
        }
    if (!all) return std::unexpected(all.error());
    return PartSpline{std::move(*all), {}, bound};
}

Result<PartSpline> part_of(const OffsetSurface& o, const std::array<Interval, 2>& on, double tolerance) {
    if (!(tolerance > 0))
        return refuse(RefusalKind::unsupported, "surface", "is an offset, which is no spline");
    auto near = offset_spline(o, on, tolerance);
    if (!near) return refuse(near.error().kind, "surface", text("is an offset: ", near.error().message));
    return PartSpline{to_rational(near->surface), {}, near->bound};
}

}  // namespace

Result<PartSpline> part_spline(const SurfaceGeometry& surface, const std::array<Interval, 2>& on,
                               double tolerance) {
    for (const Interval& side : on)
        if (!(std::isfinite(side.lo) && std::isfinite(side.hi) && side.lo < side.hi))
            return refuse(RefusalKind::invalid, "on",
                          text("[", side.lo, ", ", side.hi, "] is no interval of finite length"));
    return visit_one(
        [&](const auto& s) {
            if constexpr (requires { s.base; })
                return part_of(s, on, tolerance);
            else
                return part_of(s, on);
        },
        surface);
}

}  // namespace freiform::detail
