// Idea. An arc of the curve whose ends are near the rail is as near all over, if its control points are near
// its chord, and those of the rail between the feet of its ends near theirs: between the chords distances are
// at most those at the ends, and a rail that leaves its chord by h passes every point of it within h. Arcs of
// which one end at least is near are halved until this shows, or they are short.
//
// Why not overlaps of curves (curve_curve.hpp)? These compare points of equal parameters, and a branch that
// runs along a circle has another parameter than the circle: its arcs would be taken for many contacts.
#include "loop_runs_detail.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/spline/bezier.hpp>

#include <algorithm>
#include <cmath>

namespace freiform {

namespace {

constexpr int kSamplesOfPiece = 8;
constexpr double kShort = 64;  // times the distance
constexpr int kDeepestRun = 24;

// Control points that leave the chord of the first and the last one by no more.
double sag_of(const std::vector<Vec<2>>& p) {
    const Vec<2> d = p.back() - p.front();
    const double length = norm(d);
    double most = 0;
    for (const Vec<2>& x : p) {
        const Vec<2> r = x - p.front();
        const double along = length > 0 ? dot(r, d) / length : 0;
        const double beyond = std::max({0.0, -along, along - length});
        const double aside = length > 0 ? std::abs(cross(d, r)) / length : norm(r);
        most = std::max(most, std::hypot(aside, beyond));
    }
    return most;
}

std::array<std::vector<Vec<2>>, 2> halves_of(const std::vector<Vec<2>>& arc) {
    std::array<std::vector<Vec<2>>, 2> out{arc, arc};
    const int n = int(arc.size());
    keep_left(Fibre<Vec<2>>{out[0].data(), n, 1}, 0.5);
    keep_right(Fibre<Vec<2>>{out[1].data(), n, 1}, 0.5);
    return out;
}

class RunSearch {
public:
    RunSearch(const std::vector<const LoopRail*>& rails, double within) : rails_(rails), within_(within) {}

    void look(const std::vector<Vec<2>>& arc, Interval on, int depth) {
        bool near = false;
        for (std::size_t r = 0; r < rails_.size(); ++r) {
            const bool from = rails_[r]->foot(arc.front(), within_).has_value(),
                       to = rails_[r]->foot(arc.back(), within_).has_value();
            near = near || from || to;
            if (from && to &&
                (norm(arc.back() - arc.front()) + sag_of(arc) <= kShort * within_ ||
                 rails_[r]->carries(arc, within_)))
                return add(on, int(r));
        }
        const double middle = on.middle();
        if (!near || depth >= kDeepestRun ||
            norm(arc.back() - arc.front()) + sag_of(arc) <= kShort * within_ ||
            !(on.lo < middle && middle < on.hi))
            return add(on, -1);
        const auto halves = halves_of(arc);
        look(halves[0], {on.lo, middle}, depth + 1);
        look(halves[1], {middle, on.hi}, depth + 1);
    }
    std::vector<RailRun> runs;

private:
    void add(Interval on, int rail) {
        if (!runs.empty() && runs.back().rail == rail)
            runs.back().on.hi = on.hi;
        else
            runs.push_back({on, rail});
    }
    const std::vector<const LoopRail*>& rails_;
    double within_;
};

}  // namespace

LoopRail::LoopRail(const Curve<Hom<2>>& curve) : curve_(curve) {
    const auto breaks = curve.basis().breaks();
    for (std::size_t i = 0; i + 1 < breaks.size(); ++i)
        for (int k = 0; k <= kSamplesOfPiece; ++k) {
            const double t =
                clamped(breaks[i] + (breaks[i + 1] - breaks[i]) * k / kSamplesOfPiece, curve.domain()[0]);
            samples_.push_back({t, curve(t)});
        }
}

std::optional<double> LoopRail::foot(const Vec<2>& p, double within) const {
    const Interval on = curve_.domain()[0];
    const auto from = [&](double t) {
        double off = norm(Vec<2>(curve_(t)) - p);
        for (int i = 0; i < 12 && off > 0; ++i) {
            const auto j = curve_.jet<1>(t);
            const double step = dot(p - j.value(), j.d[1]) / dot(j.d[1], j.d[1]);
            if (!std::isfinite(step)) break;
            const double next = clamped(t + step, on), now = norm(Vec<2>(curve_(next)) - p);
            if (!(now < off)) break;
            t = next, off = now;
        }
        return std::pair(off, t);
    };
    const auto nearest =
        std::ranges::min_element(samples_, {}, [&](const auto& s) { return norm(s.second - p); });
    auto best = from(nearest->first);
    // Where the curve is closed, its other end is as near.
    if (nearest == samples_.begin() || std::next(nearest) == samples_.end())
        best = std::min(best, from(nearest == samples_.begin() ? on.hi : on.lo));
    return best.first <= within ? std::optional(best.second) : std::nullopt;
}

bool LoopRail::carries(const std::vector<Vec<2>>& arc, double within) const {
    struct Open {
        std::vector<Vec<2>> arc;
        int depth;
    };
    std::vector<Open> open{{arc, 0}};
    while (!open.empty()) {
        const Open one = std::move(open.back());
        open.pop_back();
        const auto from = foot(one.arc.front(), within), to = foot(one.arc.back(), within);
        if (!from || !to) return false;
        const Interval on{std::min(*from, *to), std::max(*from, *to)};
        const double ends = std::max(norm(Vec<2>(curve_(*from)) - one.arc.front()),
                                     norm(Vec<2>(curve_(*to)) - one.arc.back()));
        double sag = kInfinity;
        if (on.lo < on.hi)
            if (const auto part = restrict_to(curve_, 0, on)) sag = sag_of(points(*part));
        if (ends + sag + sag_of(one.arc) <= within) continue;
        if (one.depth >= 12) return false;
        const auto halves = halves_of(one.arc);
        open.push_back({halves[0], one.depth + 1}), open.push_back({halves[1], one.depth + 1});
    }
    return true;
}

std::vector<RailRun> rail_runs(const Curve<Vec<2>>& curve, const std::vector<const LoopRail*>& rails,
                               double within) {
    if (rails.empty()) return {{curve.domain()[0], -1}};
    RunSearch search(rails, within);
    const BezierPieces<1, Vec<2>> pieces(curve);
    for (int i = 0; i < pieces.extent()[0]; ++i) {
        const auto net = pieces.net({i});
        std::vector<Vec<2>> arc;
        for (int k = 0; k < net.extent[0]; ++k) arc.push_back(net({k}));
        search.look(arc, pieces.box({i})[0], 0);
    }
    return std::move(search.runs);
}

}  // namespace freiform
