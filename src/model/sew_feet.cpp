// Places along an edge, and the places of it that are nearest to points.
//
// Idea. Chords between places say where to begin, Newton's method does the rest. Where a curve winds, the
// nearest chord may belong to another part of it: a few of those that are nearer than their neighbours are
// tried, the neighbours of the nearest one, where a turn is sharp, and what the caller guesses.
#include "sew_detail.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/core/sort.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace freiform {

namespace {

constexpr int kFewestPlaces = 32, kMostPlaces = 2000;
constexpr int kNewtonSteps = 24, kHalvings = 8;
constexpr std::size_t kStarts = 3;  // of a foot

}  // namespace

EdgeTrace trace_of(const CurveGeometry<3>& curve, Interval on) {
    EdgeTrace out{&curve, on, {}, {}, 0};
    std::vector<double> cuts{on.lo, on.hi};
    for (const double b : breaks_inside(curve, on, false)) cuts.push_back(b);
    sort(cuts.begin(), cuts.end());
    const int spans = int(cuts.size()) - 1;
    const int each =
        std::clamp(std::max(kFewestPlaces / spans, kPlacesPerSpan), 1, std::max(kMostPlaces / spans, 1));
    for (int k = 0; k < spans; ++k)
        for (int i = 0; i < each; ++i) {
            const double a = cuts[std::size_t(k)], b = cuts[std::size_t(k) + 1];
            out.t.push_back(a + (b - a) * i / each);
        }
    out.t.push_back(on.hi);
    for (const double t : out.t) {
        out.at.push_back(jet<0>(curve, t).value());
        out.extent = std::max(out.extent, norm(out.at.back() - out.at.front()));
    }
    return out;
}

namespace {

// Newton's method from t, with shorter steps where one leads away.
EdgeFoot foot_from(const EdgeTrace& edge, const Vec<3>& p, double t) {
    const auto at = [&](double x) {
        const Vec<3> point = jet<0>(*edge.curve, x).value();
        return EdgeFoot{x, norm(point - p), point};
    };
    EdgeFoot foot = at(t);
    for (int step = 0; step < kNewtonSteps; ++step) {
        const auto c = jet<2>(*edge.curve, foot.t);
        const Vec<3> off = c(0) - p;
        const double speed2 = dot(c(1), c(1)), down = speed2 + dot(off, c(2));
        double by = dot(off, c(1)) / (down > speed2 / 4 ? down : speed2);
        if (!std::isfinite(by)) break;
        EdgeFoot next = at(clamped(foot.t - by, edge.on));
        for (int k = 0; k < kHalvings && !(next.distance <= foot.distance); ++k)
            next = at(clamped(foot.t - (by /= 2), edge.on));
        if (!(next.distance <= foot.distance) || next.t == foot.t) break;
        const bool settled = std::abs(next.t - foot.t) <= 0x1p-44 * edge.on.length();
        foot = next;
        if (settled) break;
    }
    return foot;
}

}  // namespace

EdgeFoot foot_on(const EdgeTrace& edge, const Vec<3>& p, std::optional<double> guess) {
    struct Start {
        double distance = kInfinity, t = 0;
        std::size_t chord = 0;
    };
    // Of the chords that are nearer than those before and after them the nearest few: where a curve turns
    // much, the nearest chord may belong to another part of it; at a sharp turn, to the chord beside.
    std::array<Start, kStarts> starts{};
    const auto add = [&](const Start& s) {
        for (std::size_t k = 0; k < starts.size(); ++k)
            if (s.distance < starts[k].distance) {
                std::copy_backward(starts.begin() + std::ptrdiff_t(k), starts.end() - 1, starts.end());
                starts[k] = s;
                return;
            }
    };
    const auto on_chord = [&](std::size_t k) {
        const Vec<3> d = edge.at[k + 1] - edge.at[k], to = p - edge.at[k];
        const double length2 = dot(d, d);
        const double part = length2 > 0 ? std::clamp(dot(to, d) / length2, 0.0, 1.0) : 0;
        return Start{norm(to - part * d), edge.t[k] + part * (edge.t[k + 1] - edge.t[k]), k};
    };
    Start before, last;
    for (std::size_t k = 0; k + 1 < edge.at.size(); ++k) {
        const Start here = on_chord(k);
        if (last.distance <= before.distance && last.distance < here.distance) add(last);
        before = last, last = here;
    }
    if (last.distance <= before.distance) add(last);
    EdgeFoot foot{edge.on.lo, kInfinity, edge.end(false)};
    if (guess) foot = foot_from(edge, p, *guess);
    const auto look = [&](double t) {
        if (const EdgeFoot f = foot_from(edge, p, t); f.distance < foot.distance) foot = f;
    };
    for (const Start& s : starts)
        if (s.distance < kInfinity) look(s.t);
    const std::size_t nearest = starts.front().chord;
    if (nearest > 0) look((edge.t[nearest - 1] + edge.t[nearest]) / 2);
    if (nearest + 2 < edge.t.size()) look((edge.t[nearest + 1] + edge.t[nearest + 2]) / 2);
    for (const bool end : {false, true})
        if (const double d = norm(edge.end(end) - p); d < foot.distance)
            foot = {end ? edge.on.hi : edge.on.lo, d, edge.end(end)};
    return foot;
}

}  // namespace freiform
