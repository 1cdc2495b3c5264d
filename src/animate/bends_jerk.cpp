// From rest to rest below ceilings of the speed, with a limit of the jerk.
//
// Idea. A hump goes from one speed up to a higher one, along at that, and down to another one, with no
// acceleration at its ends and on top; how it gets up is as fast as the limits allow. The highest hump over
// the whole way that stays below the ceilings is a motion. Where a ceiling holds it down, there is often a
// faster one: two humps, one before that ceiling and one after it, between which the motion goes along it;
// and so on in each of them. Of the two ways the one that takes less time is kept, so that each step makes
// the motion faster, and all of them obey the limits.
//
// A ramp from v up to V reaches a speed c between them after a distance that is known in closed form. It
// stays below a ceiling of c if that ceiling ends before it; higher humps get there sooner, so the highest
// one is found by halving.
//
// Ceilings that differ by less than kAlike are taken as one. What is tried has an end (kPatience), behind
// which humps are no more divided.
//
// Why not the fastest motion of all? It changes its jerk at places that have to be found together, along all
// of the way at once; no answer of such a search would be known to be within the limits before it ends.
#include "bends_detail.hpp"

#include <freiform/core/constants.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

namespace freiform::detail {

namespace {

constexpr double kAlike = 0.99, kBelow = 1 - 0x1p-36;
constexpr int kPatience = 20'000, kTries = 8, kHalvingsOfSpeed = 60;

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
        const Node start{ceilings_.front().from, 0, 0}, end{ceilings_.back().to, 0, ceilings_.size()};
        if (const auto plan = best(start, end))
            for (const Hump& h : plan->humps) emit(h);
        return std::move(phases_);
    }

private:
    // Where the motion has no acceleration; `ceiling`: the first one after it.
    struct Node {
        double at, speed;
        std::size_t ceiling;
    };
    struct Hump {
        Node from, to;
        double top;
    };
    struct Plan {
        std::vector<Hump> humps;
        double duration = 0;
    };

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

    // The highest speed from `low` on for which the condition holds, as it does for all below.
    template <class Holds>
    static std::optional<double> highest(double low, double high, Holds&& holds) {
        if (!holds(low)) return std::nullopt;
        if (holds(high)) return high;
        for (int i = 0; i < kHalvingsOfSpeed; ++i) {
            const double middle = low / 2 + high / 2;
            (holds(middle) ? low : high) = middle;
        }
        return low;
    }

    Plan plan_of(const Hump& h) const {
        const Ramp up = ramp(h.from.speed, h.top), down = ramp(h.to.speed, h.top);
        const double level = h.to.at - h.from.at - up.length() - down.length();
        return {{h}, up.duration + down.duration + (h.top > 0 ? std::max(0.0, level) / h.top : 0)};
    }

    std::optional<Plan> best(const Node& a, const Node& b) {
        const double least = std::max(a.speed, b.speed), length = b.at - a.at;
        if (!(length > 0) || !is_long_enough(a, b, least)) return std::nullopt;
        double top = 0, lowest = kInfinity;
        for (std::size_t i = a.ceiling; i < b.ceiling; ++i)
            top = std::max(top, ceilings_[i].speed), lowest = std::min(lowest, ceilings_[i].speed);
        if (std::isinf(top))  // no faster than with this jerk all of the way
            top = least + 2 * std::cbrt(length) * std::cbrt(length * jerk_);
        top = std::max(top, least);
        const double reach = *highest(least, top, [&](double v) { return is_long_enough(a, b, v); });
        const auto hump = highest(least, reach, [&](double v) { return is_below_ceilings(a, b, v); });
        std::optional<Plan> plan;
        if (hump && (*hump > 0 || least > 0)) plan = plan_of({a, b, *hump});
        if ((hump && *hump >= reach) || ++tried_ > kPatience) return plan;
        // At the end or the start of one of the lowest ceilings where its speed can be had there.
        std::vector<Node> nodes;
        for (std::size_t i = a.ceiling; i < b.ceiling; ++i) {
            const SpeedCeiling& c = ceilings_[i];
            if (!(c.speed < reach)) continue;
            for (const Node& n : {Node{c.to, c.speed, i + 1}, Node{c.from, c.speed, i}})
                if (n.at > a.at && n.at < b.at && ramp(a.speed, n.speed).length() <= n.at - a.at &&
                    ramp(n.speed, b.speed).length() <= b.at - n.at)
                    nodes.push_back(n);
        }
        const std::size_t tries = std::min<std::size_t>(nodes.size(), kTries);
        std::ranges::partial_sort(nodes, nodes.begin() + std::ptrdiff_t(tries), {},
                                  [&](const Node& n) { return std::pair(n.speed, n.at); });
        for (std::size_t k = 0; k < tries; ++k) {
            auto before = best(a, nodes[k]);
            if (!before) continue;
            const auto after = best(nodes[k], b);
            if (!after) continue;
            const double duration = before->duration + after->duration;
            if (plan && !(duration < plan->duration * (1 - 1e-12))) continue;
            before->humps.insert(before->humps.end(), after->humps.begin(), after->humps.end());
            before->duration = duration;
            return before;
        }
        return plan;
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
    int tried_ = 0;
    std::vector<JerkPhase> phases_;
};

}  // namespace

std::vector<JerkPhase> motion_below(std::span<const SpeedCeiling> ceilings, double acceleration,
                                    double jerk) {
    return Planner(ceilings, acceleration, jerk).run();
}

}  // namespace freiform::detail
