// Edges that end at a pole but for what the file rounds. What of such an edge lies beyond the pole would be
// found there, on the other nappe of a cone or half a turn away. So its parameter curve is that of the edge
// up to where it is nearest to the pole, ends at the pole, and has the parameters of all of the edge.
#include "step_trace.hpp"

#include <algorithm>
#include <cmath>

namespace freiform::step {

namespace {

constexpr int kNewton = 20;
constexpr int kPlacesLookedAt = 64;
constexpr double kAround = 8;  // times as far as the edge passes the pole: directions mean little there

// Where an edge is left that passes `p` beside its end: so far from it that the direction there is that of an
// edge through the pole, but for an angle whose square is as small as the bend of a way as long. Nothing if
// it does not pass within `near`, or does within `close`, which is no distance.
std::optional<double> before_pole(const CurveGeometry<3>& c, Interval on, bool at_hi, const Vec<3>& p,
                                  double near, double close) {
    double t = at_hi ? on.hi : on.lo;
    const double off = norm(jet<0>(c, t).value() - p);
    if (!(off <= near) || off <= close) return std::nullopt;
    double speed = 0;
    for (int i = 0; i < kNewton; ++i) {
        const auto j = jet<1>(c, t);
        speed = norm(j.d[1]);
        if (!(speed > 0)) return std::nullopt;
        const double next = std::clamp(t + dot(p - j.d[0], j.d[1]) / (speed * speed), on.lo, on.hi);
        if (next == t) break;
        t = next;
    }
    const double past = norm(jet<0>(c, t).value() - p);
    if (past <= close) return t;
    const double back = std::max(kAround * past, std::sqrt(past * speed * on.length())) / speed;
    return at_hi ? t - back : t + back;
}

// The curve over `kept` goes on, straight, to poles at the ends of `on`.
std::optional<CurveGeometry<2>> continued(const CurveGeometry<2>& curve, Interval kept, Interval on,
                                          const std::array<std::optional<Pole>, 2>& ends) {
    const auto at_pole = [&](Vec<2> at, std::size_t end) {
        if (ends[end]) at[ends[end]->axis] = ends[end]->at;
        return at;
    };
    if (std::holds_alternative<Line<2>>(curve)) {
        const Vec<2> a = at_pole(jet<0>(curve, kept.lo).value(), 0),
                     b = at_pole(jet<0>(curve, kept.hi).value(), 1);
        const Vec<2> d = (1 / on.length()) * (b - a);
        return Line<2>{a - on.lo * d, d};
    }
    const auto* spline = std::get_if<Curve<Vec<2>>>(&curve);
    if (spline == nullptr) return std::nullopt;
    const int degree = spline->basis(0).degree();
    const auto given = spline->basis(0).knots();
    std::vector<double> knots(given.begin(), given.end());
    const auto points = spline->net().flat();
    std::vector<Vec<2>> net(points.begin(), points.end());
    const auto prolong = [&](std::size_t end, double to) {  // at the back
        if (!ends[end]) return;
        const Vec<2> from = net.back(), last = at_pole(from, end);
        if (from == last) return void(std::fill(knots.end() - degree - 1, knots.end(), to));
        knots.back() = to;
        knots.insert(knots.end(), std::size_t(degree), to);
        for (int i = 1; i <= degree; ++i) net.push_back(from + (double(i) / degree) * (last - from));
    };
    prolong(1, on.hi);
    std::ranges::reverse(knots), std::ranges::reverse(net);
    prolong(0, on.lo);
    std::ranges::reverse(knots), std::ranges::reverse(net);
    auto basis = BSplineBasis::make(degree, std::move(knots));
    if (!basis) return std::nullopt;
    const int size = int(net.size());
    return Curve<Vec<2>>::trusted({*std::move(basis)}, Net<1, Vec<2>>({size}, std::move(net)));
}

}  // namespace

std::optional<Trace> trace_up_to_poles(const Chart& chart, const CurveGeometry<3>& c, Interval on,
                                       double accuracy, double rough) {
    Interval kept = on;
    std::array<std::optional<Pole>, 2> ends;
    for (const Pole& p : chart.poles())
        for (const bool at_hi : {false, true})
            if (const auto t = before_pole(c, on, at_hi, p.point, rough, accuracy); t && !ends[at_hi])
                ends[at_hi] = p, (at_hi ? kept.hi : kept.lo) = *t;
    if (!(ends[0] || ends[1]) || !(kept.lo < kept.hi)) return std::nullopt;
    auto part = trace(chart, c, kept, accuracy, rough, {}, false);
    if (!part) return std::nullopt;
    auto curve = continued(part->curve, kept, on, ends);
    if (!curve || chart.has_pole_across(*curve, on)) return std::nullopt;
    part->curve = *std::move(curve);
    part->cut = true;
    for (int i = 0; i <= kPlacesLookedAt; ++i) {
        const double t = i == kPlacesLookedAt ? on.hi : on.lo + on.length() * i / kPlacesLookedAt;
        part->gap =
            std::max(part->gap, norm(chart.point(jet<0>(part->curve, t).value()) - jet<0>(c, t).value()));
    }
    if (!(part->gap <= rough)) return std::nullopt;
    return *std::move(part);
}

}  // namespace freiform::step
