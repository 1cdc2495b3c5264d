// As fast as a curve allows that bends.
//
// Idea. On the way s, with w = v^2, the limits are w curvature <= across, w <= speed^2 and |dw/ds| <= 2
// acceleration. Where the first two are a constant W_i on each part, the largest w that obeys all of them is
// known: at the nodes between parts from both sides (forwards no faster than accelerating from the node
// before, backwards than braking to the next), and inside a part it accelerates, goes on at W_i if it gets
// there, and brakes. It is the largest, for any other starts and ends at rest and obeys the same two passes,
// node by node. Constant acceleration is what a phase is.
//
// The curvature. With T the unit tangent in the middle of a part of the width h, N a normal of T, and bounds
// of derivatives over the whole part, |N . c''| <= n (of two normals: the root of the squares), |c''| <= b,
// |c'| <= m, and |c'| >= |c'(middle)| - h b / 2 = l:
//     |c' x c''| <= |T . c'| |c'' across T| + |c' across T| |c''| <= m n + (h n / 2) b,     curvature <= that
//     / l^3.
// This converges to the curvature as parts get shorter, however unevenly the curve runs. Rounding: 2^-30 of
// it all.
//
// Cost: a few dozen parts for a piece, each a bound of derivatives and an arc length.
//
// With a limit of the jerk the passes do not do, which do not know how long the acceleration takes to change:
// see bends_jerk.cpp.
//
// References: [Bobrow, Dubowsky & Gibson 1985] for the two passes.
#include "bends_detail.hpp"

#include <freiform/animate/motion.hpp>
#include <freiform/core/constants.hpp>
#include <freiform/spline/derivative_bounds.hpp>

#include <algorithm>
#include <cmath>

namespace freiform {

struct Motion::BendPart {
    double from = 0, length = 0, most = 0;  // `most`: of the square of the speed
};

namespace {

constexpr int kHalvings = 8;
constexpr std::size_t kMostParts = 1 << 16;
constexpr double kNear = 1.02, kBendSlack = 0x1p-30, kSameDirection = 1e-9;

template <int D>
Vec<D> unit_or_zero(const Vec<D>& v) {
    const double n = norm(v);
    return n > 0 ? (1 / n) * v : v;
}

// A bound of the curvature over the part, and the curvature in its middle.
template <int D>
std::pair<double, double> curvature_over(const DerivativeQuery<1, D>& query, Interval on) {
    const auto j = jet<2>(query.geometry(), on.middle());
    const Vec<D> first = j(1), second = j(2), tangent = unit_or_zero(first);
    const auto all = query({on});
    double across = 0;
    if constexpr (D == 2) {
        across = query.along({{-tangent[1], tangent[0]}}, {on})(2);
    } else {
        const Vec<3> axis = std::abs(tangent[0]) < 0.6 ? Vec<3>{{1, 0, 0}} : Vec<3>{{0, 1, 0}};
        const Vec<3> n = unit_or_zero(cross(tangent, axis)), b = cross(tangent, n);
        across = std::hypot(query.along(n, {on})(2), query.along(b, {on})(2));
    }
    const double h = on.length(), speed = norm(first);
    const double least = speed * (1 - kBendSlack) - h / 2 * all(2) - kBendSlack * all(1);
    if (!(least > 0)) return {kInfinity, kInfinity};
    const double bound = (all(1) * across + h / 2 * across * all(2)) / (least * least * least);
    const Vec<D> off = second - dot(second, tangent) * tangent;
    return {bound * (1 + kBendSlack), norm(off) / (speed * speed)};
}

// The ends of parts: breaks, and halves of what lies between while the bound of the curvature holds the speed
// down.
template <int D>
Result<std::vector<double>> parts_of(const DerivativeQuery<1, D>& query, std::vector<double> breaks,
                                     const BendLimits& limits, std::vector<double>& most) {
    std::vector<double> ends{breaks.front()};
    const double free = limits.speed * limits.speed;
    for (std::size_t i = 0; i + 1 < breaks.size(); ++i) {
        std::vector<std::pair<Interval, int>> todo{{{breaks[i], breaks[i + 1]}, 0}};
        while (!todo.empty()) {
            const auto [on, depth] = todo.back();
            todo.pop_back();
            double bound = 0, middle = 0;
            if (std::isfinite(limits.across)) std::tie(bound, middle) = curvature_over<D>(query, on);
            const bool is_fine = bound * free <= limits.across || bound <= kNear * middle;
            if ((!is_fine || !std::isfinite(bound)) && depth < kHalvings) {
                todo.push_back({{on.middle(), on.hi}, depth + 1});
                todo.push_back({{on.lo, on.middle()}, depth + 1});
                continue;
            }
            if (!std::isfinite(bound))
                return refuse(RefusalKind::ill_conditioned, "curve",
                              text("near the parameter ", on.middle(),
                                   " it stands still, or its curvature has no bound"));
            if (ends.size() > kMostParts)
                return refuse(RefusalKind::limit, "curve", text("more than ", kMostParts, " parts"));
            ends.push_back(on.hi), most.push_back(std::min(free, limits.across / bound));
        }
    }
    return ends;
}

// Does the direction jump there?
template <int D>
bool is_corner(const CurveGeometry<D>& curve, double t) {
    const Vec<D> before = unit_or_zero(Vec<D>(jet<1>(curve, std::nextafter(t, -kInfinity))(1))),
                 after = unit_or_zero(Vec<D>(jet<1>(curve, t)(1)));
    return norm(after - before) > kSameDirection;
}

Result<void> check_limits(const BendLimits& limits, double accuracy) {
    const std::pair<const char*, double> all[] = {{"speed", limits.speed},
                                                  {"acceleration", limits.acceleration},
                                                  {"across", limits.across},
                                                  {"jerk", limits.jerk},
                                                  {"accuracy", accuracy}};
    for (const auto& [name, value] : all)
        if (!(value > 0)) return refuse(RefusalKind::invalid, name, "a positive number is expected");
    return {};
}

}  // namespace

// One part, from the square w0 of the speed to w1.
void Motion::pass(const BendPart& part, double w0, double w1, double acceleration) {
    const auto phase = [&](double from, double length, double v0, double v1) {
        const double sum = v0 + v1;
        if (!(length > 0) || !(sum > 0)) return;
        const double duration = 2 * length / sum;
        phases_.push_back({from, {0, v0, (v1 - v0) / duration / 2, 0}});
        times_.push_back(times_.back() + duration);
        fastest_ = std::max({fastest_, v0, v1});
    };
    if (std::isinf(acceleration))
        return phase(part.from, part.length, std::sqrt(part.most), std::sqrt(part.most));
    const double peak = std::max({w0, w1, std::min(part.most, (w0 + w1) / 2 + acceleration * part.length)});
    const double up = (peak - w0) / (2 * acceleration), down = (peak - w1) / (2 * acceleration);
    const double v = std::sqrt(peak), level = part.length - up - down;
    phase(part.from, std::min(up, part.length), std::sqrt(w0), v);
    if (level > 0x1p-40 * part.length) phase(part.from + up, level, v, v);
    phase(part.from + part.length - std::min(down, part.length), std::min(down, part.length), v,
          std::sqrt(w1));
}

// By the squares of speeds at nodes, forwards and backwards.
void Motion::pass_all(std::span<const BendPart> parts, const std::vector<bool>& stops, double acceleration) {
    std::vector<double> w(stops.size(), 0);
    const double gain = std::isinf(acceleration) ? 0 : 2 * acceleration;  // else not asked for
    for (std::size_t i = 1; i + 1 < stops.size(); ++i)
        w[i] = stops[i] ? 0
                        : std::min({parts[i - 1].most, parts[i].most, w[i - 1] + gain * parts[i - 1].length});
    for (std::size_t i = stops.size() - 1; i-- > 0;) w[i] = std::min(w[i], w[i + 1] + gain * parts[i].length);
    for (std::size_t i = 0; i < parts.size(); ++i) pass(parts[i], w[i], w[i + 1], acceleration);
}

// With a limit of the jerk, from stop to stop; no where one of these has no motion in double.
bool Motion::pass_below(std::span<const BendPart> parts, const std::vector<bool>& stops,
                        const BendLimits& limits) {
    std::vector<detail::SpeedCeiling> ceilings;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        const BendPart& part = parts[i];
        ceilings.push_back({part.from, part.from + part.length, std::sqrt(part.most)});
        if (!stops[i + 1]) continue;
        const auto phases = detail::motion_below(ceilings, limits.acceleration, limits.jerk);
        if (phases.empty() && ceilings.back().to > ceilings.front().from) return false;
        for (const detail::JerkPhase& p : phases) {
            phases_.push_back({p.from, {0, p.speed, p.acceleration / 2, p.jerk / 6}});
            times_.push_back(times_.back() + p.duration);
            fastest_ = std::max(fastest_, p.speed);
        }
        ceilings.clear();
    }
    return true;
}

template <class P>
Result<Motion> Motion::along(const Curve<P>& curve, const BendLimits& limits, double accuracy) {
    constexpr int D = Space<P>::kDim;
    if (auto ok = check_limits(limits, accuracy); !ok) return std::unexpected(ok.error());
    const CurveGeometry<D> geometry = curve;
    const DerivativeQuery<1, D> query(geometry);
    const auto breaks = curve.basis().breaks();
    std::vector<double> most;
    const auto ends = parts_of<D>(query, {breaks.begin(), breaks.end()}, limits, most);
    if (!ends) return std::unexpected(ends.error());
    const ArcLength<P> length(curve, accuracy);
    std::vector<BendPart> parts;
    std::vector<double> at{0};
    for (std::size_t i = 0; i < most.size(); ++i) {
        const auto s = length.at((*ends)[i + 1]);
        if (!s) return std::unexpected(s.error());
        parts.push_back({at.back(), std::max(0.0, s->value - at.back()), most[i]});
        at.push_back(std::max(at.back(), s->value));
        if (std::isinf(limits.acceleration) && std::isinf(limits.jerk) && std::isinf(most[i]))
            return refuse(
                RefusalKind::invalid, "speed",
                text("near the parameter ", (*ends)[i], " no limit holds: there is no fastest motion"));
    }
    std::vector<bool> stops(at.size(), true);
    for (std::size_t i = 1; i + 1 < at.size(); ++i)
        stops[i] = std::ranges::binary_search(breaks, (*ends)[i]) && is_corner<D>(geometry, (*ends)[i]);
    Motion m;
    m.length_ = at.back();
    bool passes = true;
    if (std::isfinite(limits.jerk))
        passes = m.pass_below(parts, stops, limits);
    else
        m.pass_all(parts, stops, limits.acceleration);
    if (!passes || m.phases_.empty() || !std::isfinite(m.duration()))
        return refuse(RefusalKind::limit, "curve", "with these limits times leave the range of double");
    return m;
}

#define FF_ALONG(P) template Result<Motion> Motion::along(const Curve<P>&, const BendLimits&, double);
FF_ALONG(Vec<2>)
FF_ALONG(Hom<2>)
FF_ALONG(Vec<3>)
FF_ALONG(Hom<3>)
#undef FF_ALONG

}  // namespace freiform
