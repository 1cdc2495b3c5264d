// The largest value of a function along a line that is given by polynomials in pieces: a number, and a bound.
//
// Idea: branch and bound. A function of some polynomials is enclosed over an interval where the polynomials
// are, and they are where their Bernstein coefficients are. The interval with the largest upper end is halved
// until that end is near the largest value found so far, which is the one at an end of some interval, where
// a Bernstein coefficient is the value.
//
// Method: every interval is judged twice, with the bounds of its coefficients and without. What only the
// bounds contribute does not shrink by halving, so an interval is not halved for the sake of less than that.
// Where the function has no enclosure (a denominator that may be 0) the interval is halved up to kDepth times
// and then set aside; at once if all coefficients of all polynomials may be 0.
//
// Accuracy: the exact largest value lies between the lower end at the place found and the upper end of the
// first interval of the queue, whichever way the search ended.
#pragma once
#include <freiform/core/bounded.hpp>
#include <freiform/core/interval.hpp>

#include <algorithm>
#include <limits>
#include <optional>
#include <queue>
#include <span>
#include <vector>

namespace freiform::detail {

// Bernstein coefficients over a part of the line.
struct LinePart {
    Interval on;  // the parameters; lo > hi where the line is run through backwards
    std::vector<std::vector<Bounded>> polynomial;
    int depth = 0;
};

struct Largest {
    double value = 0, bound = 0, at = 0;
    bool any = false;  // otherwise there was no enclosure anywhere
    std::vector<Interval> aside;
};

inline constexpr int kDepth = 12, kBudget = 4000;
inline constexpr double kRelative = 1e-3;

inline Interval range_of(std::span<const Bounded> c, bool with_bounds) {
    Interval r{std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity()};
    for (const Bounded& x : c) {
        const double b = with_bounds ? x.bound : 0;
        r.lo = std::min(r.lo, x.value - b - std::abs(x.value) * 0x1p-52 * (b > 0));
        r.hi = std::max(r.hi, x.value + b + std::abs(x.value) * 0x1p-52 * (b > 0));
    }
    return c.empty() ? Interval{0, 0} : r;
}

// Left: c becomes the part on [0, 1/2]; returns that on [1/2, 1].
inline std::vector<Bounded> halve(std::vector<Bounded>& c) {
    std::vector<Bounded> right = c;
    const std::size_t n = c.size();
    for (std::size_t r = 0; r < n; ++r) {
        c[r] = right[0];
        for (std::size_t i = 0; i + 1 + r < n; ++i) right[i] = Bounded(0.5) * (right[i] + right[i + 1]);
    }
    // The triangle in place: right[i] is now what level n - 1 - i left there.
    return right;
}

// f(ranges) encloses the function where the polynomials are in these ranges, or nothing.
template <class F>
Largest largest(std::vector<LinePart> parts, F&& f) {
    struct Candidate {
        LinePart part;
        double low = 0, high = 0;  // the upper end without and with bounds
        bool operator<(const Candidate& o) const { return high < o.high; }
    };
    Largest out;
    double best = 0, sure = 0;
    const auto enclosed = [&](auto&& coefficients, bool with_bounds) -> std::optional<Interval> {
        std::vector<Interval> ranges;
        for (std::size_t i = 0; i < coefficients.size(); ++i)
            ranges.push_back(range_of(coefficients[i], with_bounds));
        return f(std::span<const Interval>(ranges));
    };
    const auto look = [&](const LinePart& p, bool end) {
        std::vector<std::span<const Bounded>> at;
        for (const auto& c : p.polynomial) {
            const std::span<const Bounded> all(c);
            at.push_back(all.empty() ? all : end ? all.last(1) : all.first(1));
        }
        const auto value = enclosed(at, false), around = enclosed(at, true);
        if (!value || !around || (out.any && !(value->lo > best))) return;
        out.any = true;
        best = value->lo, sure = around->lo;
        out.at = end ? p.on.hi : p.on.lo;
    };
    std::vector<LinePart> undefined;
    std::priority_queue<Candidate> queue;
    const auto add = [&](LinePart p) {
        look(p, false), look(p, true);
        const auto value = enclosed(p.polynomial, false), around = enclosed(p.polynomial, true);
        if (value && around)
            queue.push({std::move(p), value->hi, around->hi});
        else
            undefined.push_back(std::move(p));
    };
    const auto halves = [](LinePart p) {
        LinePart right = p;
        for (std::size_t i = 0; i < p.polynomial.size(); ++i) right.polynomial[i] = halve(p.polynomial[i]);
        right.on.lo = p.on.hi = p.on.middle();
        right.depth = ++p.depth;
        return std::pair(std::move(p), std::move(right));
    };
    const auto may_vanish = [](const LinePart& p) {
        for (const auto& c : p.polynomial)
            for (const Bounded& x : c)
                if (x.excludes_zero()) return false;
        return true;
    };
    for (LinePart& p : parts) add(std::move(p));
    while (!undefined.empty()) {
        LinePart p = std::move(undefined.back());
        undefined.pop_back();
        if (p.depth >= kDepth || may_vanish(p)) {
            out.aside.push_back(p.on);
            continue;
        }
        auto [left, right] = halves(std::move(p));
        add(std::move(left)), add(std::move(right));
    }
    double upper = 0;
    for (int budget = kBudget; !queue.empty(); --budget) {
        const Candidate& top = queue.top();
        upper = top.high;
        const double gain = top.low - best, noise = top.high - top.low;
        if (!(gain > std::max(kRelative * top.high, noise)) || budget == 0 || top.part.depth >= 50) break;
        auto [left, right] = halves(top.part);
        queue.pop();
        add(std::move(left)), add(std::move(right));
        // A half of a defined part is defined, up to rounding; if not, its parent's bound is kept.
        for (; !undefined.empty(); undefined.pop_back())
            queue.push({std::move(undefined.back()), best, upper}), budget = std::min(budget, 1);
    }
    out.value = best;
    out.bound = above(std::max({upper - best, best - sure, 0.0}));
    return out;
}

}  // namespace freiform::detail
