// Orders of continuity, with bounds.
//
// Idea: a joint is two Taylor expansions. C^k compares their terms. G^k compares them after both have been
// written in arc length, the one parameter that belongs to the shape alone: with the power series
//     s(t) = integral |c'|,   t(s) its inverse,   e(s) = c(t(s)) = c + T s + K s^2 / 2 + ..,
// two regular curves meet with G^k if and only if their e agree up to s^k, and the change of parameter that
// shows it is phi = s_2^-1 o s_1, all its derivatives at once [Farin 2002, 11.1-11.3; Barsky & DeRose 1989].
// Everything is one computation with truncated series, of any order and dimension.
//
// Notation: T tangent, K = e'' curvature vector, |K| = kappa, e''' = kappa' N - kappa^2 T + kappa tau B.
//
// Method: all numbers are `Bounded`, so each jump comes with a proven bound: of the rounding on the way and
// of the roundings that the coefficients are granted (options.roundings). "Is the jump 0" becomes "does the
// interval size +- bound contain 0", and no epsilon is chosen. The angle of two unit vectors is 2 asin(|T2 -
// T1| / 2), or pi less that of the sum where this is shorter: monotone, so the bound goes through it.
// Lengths are scaled by a power of two before squares are taken, parameters likewise, which costs no
// rounding.
//
// Singular sides: where c' = 0, c'(t) = c^(r) t^(r-1) / (r-1)! + .. gives the limit of the tangent: c^(r)
// after the joint, (-1)^(r-1) c^(r) before it. So a cusp (r = 2 in the middle of one polynomial) turns back:
// C^infinity and not G^1, and so does the corner of a B-spline with a triple coefficient. "c' = 0" means that
// c' . c' is not known to be positive. The derivatives by arc length that have a limit there are found in
// expansion.cpp, and compared like any other; where the first has none, no order of G from there on holds.
//
// Cost: O(degree^3) for the expansions, O(orders^4) for the inverse series.
//
// Why not the beta-constraints (p'' = b1^2 q'' + b2 q', ..) solved for b1, b2, ..: each order is a new
// formula, the jump comes out in units of the parameter, which say nothing about the shape, and the least
// squares for b weighs the orders against each other. Why not compare kappa, tau: where kappa = 0 tau has no
// value, though the curves may well meet with G^3.
//
// References: [Farin 2002], [Barsky & DeRose 1989], [Higham 2002, 3.3].
#include "continuity_detail.hpp"
#include "expansion_detail.hpp"

#include <freiform/core/constants.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace freiform {

namespace {

using detail::Expansion;
using detail::inner;
using detail::length;
using detail::scaled;
using detail::unit;
using Vector = detail::BoundedVector;

Jump scaled(const Jump& a, int e) { return {std::scalbn(a.size, e), std::scalbn(a.bound, e)}; }

Jump jump_of(const Vector& a, const Vector& b, double factor = 1) {
    Vector d(a.size());
    for (std::size_t i = 0; i < a.size(); ++i) d[i] = Bounded(factor) * (b[i] - a[i]);
    const Bounded l = length(d);
    return {l.value, l.bound};
}
Vector cross(const Vector& a, const Vector& b) {
    return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
std::vector<double> values(const Vector& v) {
    std::vector<double> out;
    for (const Bounded& x : v) out.push_back(x.value);
    return out;
}

// The angle between unit vectors, given |b - a| or |b + a|: f(x) = 2 asin(x / 2) rises.
Jump angle_of_chord(const Bounded& chord) {
    const auto f = [](double x) { return 2 * std::asin(std::clamp(x, 0.0, 2.0) / 2); };
    const double size = f(chord.value), high = f(chord.value + chord.bound),
                 low = f(chord.value - chord.bound);
    return {size, detail::above(std::max(high - size, size - low) + 16 * kUnitRoundoff * high)};
}
Jump angle_between(const Vector& a, const Vector& b) {
    Vector sum(a.size()), difference(a.size());
    for (std::size_t i = 0; i < a.size(); ++i) sum[i] = a[i] + b[i], difference[i] = b[i] - a[i];
    const Bounded far = length(sum), near = length(difference);
    if (near.value <= far.value) return angle_of_chord(near);
    const Jump rest = angle_of_chord(far);
    return {std::numbers::pi - rest.size, detail::above(rest.bound + 4 * kUnitRoundoff)};
}

// Empty outside of space, and where the curvature may be 0.
Vector binormal_of(const Expansion& x) {
    if (x.dimension != 3 || x.by_length.empty() || x.by_length[0].size() < 3) return {};
    return unit(cross(x.tangent, x.derivative(2)));
}

// What one side looks like. Lengths are in units of 2^scale.
SideGeometry geometry_of(const Expansion& x, int scale) {
    SideGeometry g;
    g.tangent = values(x.tangent);
    if (x.by_length.empty() || x.by_length[0].size() < 3) return g;
    const Vector k = x.derivative(2);
    const auto turn = [&](const Vector& v) { return x.tangent[0] * v[1] - x.tangent[1] * v[0]; };
    const Bounded curvature = x.dimension == 2 ? turn(k) : length(k);
    g.curvature = scaled(curvature, -scale);
    const Vector binormal = binormal_of(x);
    g.binormal = values(binormal);
    if (x.by_length[0].size() < 4) return g;
    const Vector third = x.derivative(3);
    if (x.dimension == 2)
        g.curvature_rate = scaled(turn(third), -2 * scale);
    else if (curvature.excludes_zero())
        g.curvature_rate = scaled(inner(k, third) / curvature, -2 * scale);
    if (!binormal.empty() && curvature.excludes_zero())
        g.torsion = scaled(inner(binormal, third) / curvature, -scale);
    return g;
}

Result<void> check(const CurveSide& a, const CurveSide& b, const ContinuityOptions& o) {
    if (a.dimension != b.dimension)
        return refuse(RefusalKind::invalid, "second",
                      text("has ", b.dimension, " coordinates, the first curve has ", a.dimension));
    if (o.orders < 0 || o.orders > kMaxDegree)
        return refuse(RefusalKind::unsupported, "orders", text(o.orders, " is outside 0..", kMaxDegree));
    return detail::check_allowances(o);
}
// The exponent of a length that the derivatives at the joint are measured in: of the first that are not 0, as
// they move a point over the piece.
int length_scale(const CurveSide& before, const CurveSide& after) {
    double most = 0;
    for (const CurveSide* s : {&before, &after}) {
        const int r = detail::first_order(*s);
        if (r == 0) continue;
        for (const Bounded& x : detail::derivative_of(*s, std::size_t(r))) {
            double moved = std::abs(x.value);
            for (int k = 1; k <= r; ++k) moved *= s->span / k;
            most = std::max(most, moved);
        }
    }
    return most > 0 && std::isfinite(most) ? std::ilogb(most) : 0;
}

}  // namespace

namespace detail {

Result<void> check_allowances(const ContinuityOptions& o) {
    const std::pair<const char*, double> numbers[] = {{"tolerance", o.tolerance},
                                                      {"angle", o.angle},
                                                      {"curvature", o.curvature},
                                                      {"third", o.third},
                                                      {"roundings", o.roundings}};
    for (const auto& [name, x] : numbers)
        if (!(x >= 0) || !std::isfinite(x))
            return refuse(std::isfinite(x) ? RefusalKind::invalid : RefusalKind::nonfinite, name,
                          text(x, " is not a finite number >= 0"));
    return {};
}

std::unexpected<Refusal> out_of_range(std::string_view list, std::size_t order) {
    return refuse(RefusalKind::ill_conditioned, text(list, "[", order, "]"),
                  text("the jump of order ", order, " or its error leaves the range of double"));
}

double worth(double distance, double h, int k) {
    for (int i = 1; i <= k && distance != 0; ++i) distance = distance * i / h;
    return distance;
}

}  // namespace detail

std::optional<Jump> Continuity::first_c_jump() const {
    return c_order + 1 < int(c.size()) ? std::optional(c[std::size_t(c_order + 1)]) : std::nullopt;
}
std::optional<Jump> Continuity::first_g_jump() const {
    return g_order + 1 < int(g.size()) ? std::optional(g[std::size_t(g_order + 1)]) : std::nullopt;
}

Result<Continuity> continuity(const CurveSide& before, const CurveSide& after,
                              const ContinuityOptions& options) {
    if (auto ok = check(before, after, options); !ok) return std::unexpected(ok.error());
    Continuity out;
    const std::size_t known = std::size_t(std::min(before.orders, after.orders)) + 1;
    const double h = std::min(before.span, after.span), reach = std::min(before.reach, after.reach);

    // Orders of C: term by term. The values are stored less an origin each, whose difference is added.
    Vector start = detail::derivative_of(after, 0);
    for (int i = 0; i < after.dimension; ++i) {
        const std::size_t c = std::size_t(i);
        start[c] += Bounded(after.origin[c]) - Bounded(before.origin[c]);
        out.point.push_back(before.origin[c] + before.derivatives[c].value);
    }
    for (std::size_t k = 0; k < known; ++k)
        out.c.push_back(
            jump_of(detail::derivative_of(before, k), k == 0 ? start : detail::derivative_of(after, k)));
    if (auto ok = detail::check_finite(out.c, "c"); !ok) return std::unexpected(ok.error());
    out.c_order = detail::order_of(out.c, [&](int k) { return detail::worth(options.tolerance, h, k); });

    // Orders of G: the same in arc length.
    const std::size_t terms = std::min(known, std::size_t(options.orders) + 1);
    const int scale = length_scale(before, after);
    const Expansion a = detail::expand(before, terms, scale, false, options.tolerance),
                    b = detail::expand(after, terms, scale, true, options.tolerance);
    out.before = geometry_of(a, scale);
    out.after = geometry_of(b, scale);
    out.singular = !a.is_regular() || !b.is_regular();
    out.g.push_back(out.c[0]);
    if (options.orders >= 1 && !a.tangent.empty() && !b.tangent.empty()) {
        out.g.push_back(angle_between(a.tangent, b.tangent));
        out.opposed = out.g[1].size + out.g[1].bound + options.angle >= std::numbers::pi;
    }
    if (!a.by_length.empty() && !b.by_length.empty()) {
        const std::size_t both = std::min({terms, a.by_length[0].size(), b.by_length[0].size()});
        for (std::size_t k = 2; k < both; ++k)
            out.g.push_back(scaled(jump_of(a.derivative(k), b.derivative(k)), (1 - int(k)) * scale));
        for (const Expansion* side : {&a, &b})
            if (side->unbounded > 0 && side->unbounded == int(out.g.size())) out.unbounded = side->unbounded;
        const Vector b1 = binormal_of(a), b2 = binormal_of(b);
        if (!b1.empty() && !b2.empty()) out.binormal = angle_between(b1, b2);
    }
    if (!out.singular && terms >= 2) {
        const auto phi = derivatives_of(compose(inverse(b.arc), a.arc));
        for (std::size_t k = 0; k < phi.size(); ++k) {
            const Bounded x = k == 0 ? Bounded(after.parameter) : scaled(phi[k], b.time - int(k) * a.time);
            out.phi.push_back(x.value);
            out.phi_bound.push_back(x.bound);
        }
    }
    if (auto ok = detail::check_finite(out.g, "g"); !ok) return std::unexpected(ok.error());
    const double own[] = {0, options.angle, options.curvature, options.third};
    out.g_order = detail::order_of(out.g, [&](int k) {
        return std::max(detail::worth(options.tolerance, reach, k), k <= 3 ? own[k] : 0.0);
    });
    return out;
}

}  // namespace freiform
