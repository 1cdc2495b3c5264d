// From rest to rest below ceilings of the speed, with a limit of the jerk.
//
// Idea. A hump goes from one speed up to a higher one, along at that, and down to another one, with no
// acceleration at its ends and on top; how it gets up is as fast as the limits allow. Nodes are the ends of
// ceilings, with the speed that both ceilings there allow, and beside low ceilings with parts of it, too. Of
// the motions that are humps from node to node, from each to the next few, to some farther away and to those
// beside the next low ceilings, the quickest is found node by node, as a shortest path.
//
// A ramp from v up to V reaches a speed c between them after a distance that is known in closed form. It
// stays below a ceiling of c if that ceiling ends before it; higher humps get there sooner, so the highest
// one is found by halving.
//
// Ceilings that differ by less than kAlike are taken as one. Cost: some 60 humps for each place.
//
// Why not the fastest motion of all? It changes its jerk at places that have to be found together, along all
// of the way at once; no answer of such a search would be known to be within the limits before it ends.
#include "bends_detail.hpp"

#include <freiform/core/constants.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <ranges>

namespace freiform::detail {

namespace {

constexpr double kAlike = 0.98, kBelow = 1 - 0x1p-36;
constexpr double kSameTop = 1 + 0x1p-30;
constexpr int kLows = 6, kLevels = 12;
constexpr std::size_t kNext = 6, kFarthest = 192;  // places

// From the speed `low` to `high`, or back, without acceleration at its ends.
struct Ramp {
    double low, high, jerk;
    double jerk_time, most;  // most: the acceleration between the times of jerk
    double duration;

    Ramp(double a, double b, double acceleration, double j)
        : low(std::min(a, b)), high(std::max(a, b)), jerk(j) {
        const double gain = high - low;
        jerk_time = std::min(std::sqrt(gain / j), acceleration / j);
        most = j * jerk_time;
        duration = gain > 0 ? gain / most + jerk_time : 0;
    }
    double steady() const { return std::max(0.0, duration - 2 * jerk_time); }
    double length() const { return (low + high) / 2 * duration; }
    // The distance from the low end at which a speed between both is reached.
    double reaches(double speed) const {
        const double u = speed - low, gain = high - low, early = most * jerk_time / 2;
        if (u <= early) {
            const double t = std::sqrt(2 * u / jerk);
            return low * t + jerk * t * t * t / 6;
        }
        if (u <= gain - early) {
            const double t = (u - early) / most;
            return low * (jerk_time + t) + most * jerk_time * jerk_time / 6 + early * t + most * t * t / 2;
        }
        const double left = std::sqrt(2 * std::max(0.0, gain - u) / jerk);
        return length() - (high * left - jerk * left * left * left / 6);
    }
};

class Planner {
public:
    Planner(std::span<const SpeedCeiling> ceilings, double acceleration, double jerk)
        : acceleration_(acceleration), jerk_(jerk) {
        double most = 0;
        for (const SpeedCeiling& c : ceilings) {
            if (!(c.to > c.from)) continue;
            most = ceilings_.empty() ? c.speed : std::max(most, c.speed);
            if (!ceilings_.empty() && std::min(ceilings_.back().speed, c.speed) >= kAlike * most) {
                ceilings_.back().to = c.to;
                ceilings_.back().speed = std::min(ceilings_.back().speed, c.speed);
            } else {
                ceilings_.push_back(c);
                most = c.speed;
            }
        }
        for (SpeedCeiling& c : ceilings_) c.speed *= kBelow;
    }

    std::vector<JerkPhase> run() {
        if (ceilings_.empty()) return {};
        find_nodes();
        const std::size_t last = places_.size() - 1, end = nodes_.size() - 1;
        std::vector<Way> ways(nodes_.size());
        ways[0].duration = 0;
        const auto extend = [&](std::size_t i, std::size_t j) {
            const auto hump = best_hump(nodes_[i], nodes_[j]);
            if (!hump) return;
            const double duration = ways[i].duration + hump->duration;
            if (duration < ways[j].duration) ways[j] = {duration, i, hump->top};
        };
        const auto extend_to = [&](std::size_t i, std::size_t place) {
            const std::size_t next = place < last ? places_[place + 1] : nodes_.size();
            for (std::size_t j = places_[place]; j < next; ++j) extend(i, j);
        };
        extend(0, end);  // from rest to rest there is always one, unless its speed is below all doubles
        for (std::size_t place = 0; place < last; ++place)
            for (std::size_t i = places_[place]; i < places_[place + 1]; ++i) {
                if (std::isinf(ways[i].duration)) continue;
                for (std::size_t p = place + 1; p <= last && p <= place + kNext; ++p) extend_to(i, p);
                for (std::size_t step = kNext + 1; step <= kFarthest && place + step <= last;
                     step += step / 4)
                    extend_to(i, place + step);
                auto low = std::ranges::upper_bound(lows_, place + kNext);
                for (int k = 0; k < kLows && low != lows_.end(); ++k, ++low) extend_to(i, *low);
            }
        if (std::isinf(ways[end].duration)) return {};
        std::vector<std::size_t> path;
        for (std::size_t i = end; i > 0; i = ways[i].before) path.push_back(i);
        for (const std::size_t i : path | std::views::reverse)
            emit({nodes_[ways[i].before], nodes_[i], ways[i].top, 0});
        return std::move(phases_);
    }

private:
    // Where the motion may have no acceleration; `ceiling`: the first one after it.
    struct Node {
        double at, speed;
        std::size_t ceiling;
    };
    struct Hump {
        Node from, to;
        double top, duration;
    };
    // The quickest one to a node: by its last hump.
    struct Way {
        double duration = kInfinity;
        std::size_t before = 0;
        double top = 0;
    };

    void find_nodes() {
        const auto is_low = [&](std::size_t i) {
            return (i == 0 || ceilings_[i].speed < ceilings_[i - 1].speed) &&
                   (i + 1 == ceilings_.size() || ceilings_[i].speed < ceilings_[i + 1].speed);
        };
        places_.push_back(0), nodes_.push_back({ceilings_.front().from, 0, 0});
        for (std::size_t i = 1; i < ceilings_.size(); ++i) {
            const double speed = std::min(ceilings_[i - 1].speed, ceilings_[i].speed);
            const bool low = is_low(i - 1) || is_low(i);
            if (low) lows_.push_back(places_.size());
            places_.push_back(nodes_.size());
            for (int k = 0; k < (low ? kLevels : 1); ++k)
                nodes_.push_back({ceilings_[i].from, speed * (1 - double(k) / kLevels), i});
        }
        lows_.push_back(places_.size());
        places_.push_back(nodes_.size()), nodes_.push_back({ceilings_.back().to, 0, ceilings_.size()});
    }

    Ramp ramp(double a, double b) const { return {a, b, acceleration_, jerk_}; }
    bool is_long_enough(const Node& a, const Node& b, double top) const {
        return ramp(a.speed, top).length() + ramp(top, b.speed).length() <= b.at - a.at;
    }
    bool is_below_ceilings(const Node& a, const Node& b, double top) const {
        const Ramp up = ramp(a.speed, top), down = ramp(b.speed, top);
        for (std::size_t i = a.ceiling; i < b.ceiling; ++i) {
            const SpeedCeiling& c = ceilings_[i];
            if (c.speed >= top) continue;
            const bool in_time = c.speed >= a.speed && a.at + up.reaches(c.speed) >= c.to,
                       later = c.speed >= b.speed && b.at - down.reaches(c.speed) <= c.from;
            if (!in_time && !later) return false;
        }
        return true;
    }

    std::optional<Hump> best_hump(const Node& a, const Node& b) const {
        const double least = std::max(a.speed, b.speed), length = b.at - a.at;
        const auto holds = [&](double top) {
            return is_long_enough(a, b, top) && is_below_ceilings(a, b, top);
        };
        if (!(length > 0) || !holds(least)) return std::nullopt;
        double low = least, high = 0;
        for (std::size_t i = a.ceiling; i < b.ceiling; ++i) high = std::max(high, ceilings_[i].speed);
        if (std::isinf(high))  // no faster than with this jerk all of the way
            high = least + 2 * std::cbrt(length) * std::cbrt(length * jerk_);
        if (high > low && holds(high)) low = high;
        while (high > low * kSameTop) {
            const double middle = low / 2 + high / 2;
            if (middle == low || middle == high) break;
            (holds(middle) ? low : high) = middle;
        }
        if (!(low > 0)) return std::nullopt;
        const Ramp up = ramp(a.speed, low), down = ramp(b.speed, low);
        const double level = std::max(0.0, length - up.length() - down.length());
        return Hump{a, b, low, up.duration + down.duration + level / low};
    }

    void emit(const Hump& h) {
        const Ramp up = ramp(h.from.speed, h.top), down = ramp(h.to.speed, h.top);
        const auto add = [&](double from, double duration, double speed, double acceleration, double jerk) {
            if (duration > 0) phases_.push_back({from, duration, speed, acceleration, jerk});
        };
        const auto early = [](const Ramp& r) { return r.most * r.jerk_time / 2; };
        double at = h.from.at;
        add(at, up.jerk_time, up.low, 0, jerk_);
        add(at + up.reaches(up.low + early(up)), up.steady(), up.low + early(up), up.most, 0);
        add(at + up.reaches(up.high - early(up)), up.jerk_time, up.high - early(up), up.most, -jerk_);
        at += up.length();
        const double end = h.to.at, down_at = end - down.length();
        if (h.top > 0) add(at, std::max(0.0, down_at - at) / h.top, h.top, 0, 0);
        add(down_at, down.jerk_time, h.top, 0, -jerk_);
        add(end - down.reaches(down.high - early(down)), down.steady(), down.high - early(down), -down.most,
            0);
        add(end - down.reaches(down.low + early(down)), down.jerk_time, down.low + early(down), -down.most,
            jerk_);
    }

    double acceleration_, jerk_;
    std::vector<SpeedCeiling> ceilings_;
    std::vector<Node> nodes_;
    std::vector<std::size_t> places_;  // the first node at each
    std::vector<std::size_t> lows_;    // places beside a ceiling that is lower than the next ones; the last
    std::vector<JerkPhase> phases_;
};

}  // namespace

std::vector<JerkPhase> motion_below(std::span<const SpeedCeiling> ceilings, double acceleration,
                                    double jerk) {
    return Planner(ceilings, acceleration, jerk).run();
}

}  // namespace freiform::detail
