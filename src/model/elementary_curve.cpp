// Arcs. A rational quadratic curve with the control points a, b, c and, in standard form, the weight w is an
// arc of a circle if |b - a| = |b - c| and w is the cosine of the angle between legs and chord [PT97, 7.3].
// That angle is half the sweep, and the centre lies behind the middle of the chord by its half over the
// tangent.
#include "elementary_curve_detail.hpp"

#include <freiform/core/visit.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace freiform::detail {

namespace {

constexpr double kTurn = 2 * std::numbers::pi;
constexpr double kRounding = 0x1p-44;  // of coordinates
constexpr double kLeastSquare = 1e-4;  // of the sine of half the sweep
constexpr double kSameCircle = 64;     // roundings, over that square

std::optional<PlaneArc> arc_of(const Hom<2>& first, const Hom<2>& middle, const Hom<2>& last) {
    const double w = middle.weight() / std::sqrt(first.weight() * last.weight());
    if (!(w > 0 && 1 - w * w > kLeastSquare)) return std::nullopt;
    const Vec<2> a = project(first), b = project(middle), c = project(last), m = 0.5 * (a + c);
    const double leg = norm(b - a), half = norm(c - a) / 2, sine = std::sqrt(1 - w * w),
                 slip = kRounding * std::max({max_abs(a), max_abs(b), max_abs(c)});
    if (!(half > slip && std::abs(norm(c - b) - leg) <= slip && std::abs(w * leg - half) <= slip))
        return std::nullopt;
    PlaneArc out;
    out.start = a, out.end = c;
    out.centre = m + (half * w / sine) * unit(m - b);
    out.radius = norm(a - out.centre);
    out.sweep = std::copysign(2 * std::acos(w), cross(b - a, c - b));
    out.slip = slip / (sine * sine);
    return out;
}

// The second follows the first on the same circle.
std::optional<PlaneArc> joined(const PlaneArc& a, const PlaneArc& b) {
    const double most = kSameCircle * std::max(a.slip, b.slip);
    if (!(norm(a.end - b.start) <= most && norm(a.centre - b.centre) <= most &&
          std::abs(a.radius - b.radius) <= most && a.sweep * b.sweep > 0 &&
          std::abs(a.sweep + b.sweep) <= kTurn * (1 + kRounding)))
        return std::nullopt;
    PlaneArc out = a;
    out.end = b.end, out.sweep = a.sweep + b.sweep, out.slip = std::max(a.slip, b.slip);
    if (out.end == out.start) out.sweep = std::copysign(kTurn, a.sweep);
    return out;
}

// A Bezier curve of the lowest degree that is the same one, within rounding.
std::vector<Hom<2>> lowered(std::vector<Hom<2>> c) {
    double size = 0;
    for (const Hom<2>& p : c) size = std::max({size, std::abs(p[0]), std::abs(p[1]), std::abs(p[2])});
    for (int p = int(c.size()) - 1; p > 1; --p) {
        std::vector<Hom<2>> low{c[0]};
        for (int i = 1; i < p; ++i)
            low.push_back((1.0 / (p - i)) * (double(p) * c[std::size_t(i)] - double(i) * low.back()));
        const Hom<2> off = low.back() - c.back();
        if (!(std::max({std::abs(off[0]), std::abs(off[1]), std::abs(off[2])}) <= kRounding * size)) break;
        low.back() = c.back();
        c = std::move(low);
    }
    return c;
}

// Control points of quadratic Bezier curves, one behind the other, or of one that is straight.
std::vector<Hom<2>> low_net(const CurveGeometry<2>& curve) {
    auto [basis, net] = spline_of(curve);
    if (basis == nullptr || basis->is_closed()) return {};
    const int p = basis->degree(), pieces = int(basis->breaks().size()) - 1;
    if (p < 1 || int(net.size()) != p * pieces + 1) return {};
    if (pieces == 1) return lowered(std::move(net));
    if (p != 2) net.clear();
    return net;
}

std::optional<PlaneArc> arc_of(const std::vector<Hom<2>>& c) {
    if (c.size() < 3 || c.size() % 2 == 0) return std::nullopt;
    std::optional<PlaneArc> out = arc_of(c[0], c[1], c[2]);
    for (std::size_t k = 2; out && k + 2 < c.size(); k += 2) {
        const auto next = arc_of(c[k], c[k + 1], c[k + 2]);
        out = next ? joined(*out, *next) : std::nullopt;
    }
    return out;
}

// One curve of the Bezier curves of both.
Curve<Hom<2>> joined(std::vector<Hom<2>> net, const std::vector<Hom<2>>& more) {
    const double scale = net.back().weight() / more.front().weight();
    for (std::size_t k = 1; k < more.size(); ++k) net.push_back(scale * more[k]);
    const int pieces = int(net.size()) / 2;
    std::vector<double> knots{0};
    for (int k = 0; k <= pieces; ++k) knots.insert(knots.end(), 2, k);
    knots.push_back(pieces);
    const int size = int(net.size());
    return Curve<Hom<2>>::trusted({*BSplineBasis::make(2, std::move(knots))},
                                  Net<1, Hom<2>>({size}, std::move(net)));
}

}  // namespace

PlaneSpline spline_of(const CurveGeometry<2>& curve) {
    return visit_one(
        [](const auto& c) {
            PlaneSpline out;
            if constexpr (requires { c.net(); }) {
                out.basis = &c.basis();
                for (const auto& q : c.net().flat())
                    out.net.push_back(
                        weighted(project(q), Space<std::remove_cvref_t<decltype(q)>>::weight(q)));
            }
            return out;
        },
        curve);
}

ElementaryCurve elementary_of(const CurveGeometry<2>& curve) {
    const auto net = low_net(curve);
    if (net.size() == 2 && project(net[0]) != project(net[1]))
        return PlaneLine{project(net[0]), project(net[1])};
    if (const auto arc = arc_of(net)) return *arc;
    return {};
}

std::vector<CurveGeometry<2>> with_joined_arcs(std::vector<CurveGeometry<2>> loop,
                                               const std::function<bool(const Vec<2>&)>& keep) {
    std::vector<CurveGeometry<2>> out;
    std::vector<Hom<2>> before;
    for (CurveGeometry<2>& c : loop) {
        auto net = low_net(c);
        const auto a = arc_of(before), b = arc_of(net);
        if (a && b && !keep(b->start) && joined(*a, *b)) {
            const auto both = joined(std::move(before), net);
            before.assign(both.net().flat().begin(), both.net().flat().end());
            out.back() = both;
            continue;
        }
        out.push_back(std::move(c));
        before = std::move(net);
    }
    return out;
}

}  // namespace freiform::detail
