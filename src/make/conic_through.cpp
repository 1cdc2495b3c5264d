// The arc of a conic through five points in order.
//
// Order: five points of an ellipse, a parabola or one branch of a hyperbola are the corners of a convex
// polygon, in the order of the curve. Conversely, of five points on both branches at least three are on one,
// and the middle one of these is inside the triangle of the outer two and a point of the other branch (lines
// from that point meet their branch once each). So the points follow each other iff every turn that begins at
// the first one has the same sign; exact predicates decide.
//
// Arc: between tangents at the first and the last point, through the third; the tangents are those of the
// exact conic, rounded, so the points between come out with an error, which is measured: a bound of the
// distance of the curve at a parameter of its own from each point. On a piece with the points b0, b1, b2 and
// the weights w0, w1, w2, a point with the barycentric coordinates t0, t1, t2 is at the parameter t with
// t / (1 - t) = w0 t1 / (2 w1 t0) = 2 w1 t2 / (w2 t1).
//
// Parabolas and hyperbolas also have a part from the last point through infinity to the first; tangent_arc
// refuses it.
#include <freiform/make/conic_equation.hpp>
#include <freiform/poly/predicates.hpp>

#include <algorithm>
#include <cmath>

namespace freiform {

namespace {

// The direction of the tangent at p, with `inner` on its left (side = 1) or right (-1).
Result<Vec<2>> tangent(const FoundEquation& q, const Vec<2>& p, const Vec<2>& inner, double side) {
    std::array<Bounded, 6> c;
    for (std::size_t i = 0; i < 6; ++i) c[i] = {q.equation.c[i], q.bound[i]};
    const auto from_origin = [&](int k) { return Bounded(p[k]) - Bounded(q.equation.origin[k]); };
    const Bounded x = from_origin(0), y = from_origin(1), two(2);
    const Bounded fx = two * c[0] * x + c[1] * y + c[3], fy = c[1] * x + two * c[2] * y + c[4];
    const Bounded turn = -fy * (Bounded(inner[1]) - Bounded(p[1])) - fx * (Bounded(inner[0]) - Bounded(p[0]));
    if (!turn.excludes_zero())
        return refuse(RefusalKind::ill_conditioned, "points",
                      "rounding hides the tangent of the conic at one of its ends");
    const double sign = (turn.value > 0) == (side > 0) ? 1 : -1;
    return Vec<2>{{-sign * fy.value, sign * fx.value}};
}

// A proven bound of |curve(at) - p| for a spline of quadratic pieces: all in Bounded, and hypot is off by at
// most one unit in the last place, which `above` covers.
double distance_at(const Curve<Hom<2>>& curve, std::size_t piece, double at, const Vec<2>& p) {
    const auto& breaks = curve.basis().breaks();
    const auto& net = curve.net().flat();
    const Bounded lo(breaks[piece]), t = (Bounded(at) - lo) / (Bounded(breaks[piece + 1]) - lo),
                                     s = Bounded(1) - t;
    std::array<Bounded, 3> sum{};
    for (int k = 0; k < 3; ++k) {
        const auto c = [&](std::size_t i) { return Bounded(net[2 * piece + i][k]); };
        sum[std::size_t(k)] = s * s * c(0) + Bounded(2) * s * t * c(1) + t * t * c(2);
    }
    const Bounded dx = sum[0] / sum[2] - Bounded(p[0]), dy = sum[1] / sum[2] - Bounded(p[1]);
    const auto size = [](const Bounded& b) { return std::abs(b.value) + b.bound; };
    return detail::above(std::hypot(size(dx), size(dy)));
}

// The parameter of the point on the piece that is nearest to it, as rounding tells, and the distance there.
std::pair<double, double> place(const Curve<Hom<2>>& curve, const Vec<2>& p) {
    const auto& breaks = curve.basis().breaks();
    const auto& net = curve.net().flat();
    std::pair<double, double> best{breaks.front(), HUGE_VAL};
    for (std::size_t piece = 0; piece + 1 < breaks.size(); ++piece) {
        const Hom<2>&a = net[2 * piece], &b = net[2 * piece + 1], &c = net[2 * piece + 2];
        const Vec<2> u = project(a) - p, v = project(b) - p, w = project(c) - p;
        const auto turn = [](const Vec<2>& m, const Vec<2>& n) { return m[0] * n[1] - m[1] * n[0]; };
        const double t0 = turn(v, w), t1 = turn(w, u), t2 = turn(u, v);
        const bool early = std::abs(t0) >= std::abs(t2);
        const double ratio = early ? a.weight() * t1 / (2 * b.weight() * t0)
                                   : c.weight() * t1 / (2 * b.weight() * t2),
                     r = std::max(ratio, 0.0);  // at a joint it may be a little below
        const double t = early ? r / (1 + r) : 1 / (1 + r),
                     at = std::clamp(breaks[piece] + t * (breaks[piece + 1] - breaks[piece]), breaks[piece],
                                     breaks[piece + 1]);
        if (const double d = distance_at(curve, piece, at, p); d < best.second) best = {at, d};
    }
    return best;
}

}  // namespace

Result<FivePointArc> arc_through(const std::array<Vec<2>, 5>& points) {
    const auto equation = equation_through(points);
    if (!equation) return std::unexpected(equation.error());
    const int side = orient2d(points[0], points[1], points[2]);
    for (std::size_t i = 1; i < 5; ++i)
        for (std::size_t k = i + 1; k < 5; ++k)
            if (side == 0 || orient2d(points[0], points[i], points[k]) != side)
                return refuse(
                    RefusalKind::no_answer, "points",
                    text("the ", name_of(equation->type), " through them passes them in another order"));
    const auto first = tangent(*equation, points[0], points[2], side),
               last = tangent(*equation, points[4], points[2], side);
    if (!first) return std::unexpected(first.error());
    if (!last) return std::unexpected(last.error());
    auto arc = tangent_arc(points[0], *first, points[4], *last, points[2]);
    if (!arc) return std::unexpected(arc.error());
    FivePointArc out{std::move(arc->curve), equation->type, {}, 0};
    for (std::size_t i = 0; i < 5; ++i) {
        const auto [at, distance] = place(out.curve, points[i]);
        out.at[i] = at;
        out.bound = std::max(out.bound, distance);
    }
    if (!std::isfinite(out.bound) || !std::is_sorted(out.at.begin(), out.at.end()))
        return refuse(RefusalKind::ill_conditioned, "points", "rounding hides where the arc passes them");
    return out;
}

}  // namespace freiform
