// Which contacts of loops are crossings: where loops are on each other's sides between their contacts.
//
// Idea. Between contacts a loop meets the other one nowhere, so it stays where that goes round it as often.
// If this number differs before and after a contact, the loops cross there; if it is the same, they do not,
// or they cross an even number of times within what the contact is known by. A loop that meets itself has
// numbers on its left side instead: where it crosses itself, the four sectors have the numbers w, w + 1,
// w + 1, w + 2, so the number on the left changes; where it touches itself it does not.
//
// Method. The intervals of the contacts of two loops are united to groups on one of them; one point of every
// arc between groups is asked. A contact is decided if its group is, on either loop. One group and one arc
// need no point: a closed curve that leaves comes back on the same side.
//
// Accuracy. A point of the loop is known up to rounding and to the errors of its coefficients; it counts if
// it is farther than that from all of the other loop, errors included, by the boxes of control points, halved
// where they are too near. The number of rounds is then the same for all loops within the errors, and exact
// (InsideQuery). On the left of a loop: around a point p a stretch whose legs make less than 45 degrees with
// one direction is a graph over it, and the rest is farther than r from p; then the point r / 2 to the left
// of p is on its left side.
//
// Cost: one search of the boxes for each arc, all within a budget; what it does not reach stays undecided.
#include "trim/loop_links_detail.hpp"

#include <freiform/core/bounded.hpp>
#include <freiform/core/constants.hpp>
#include <freiform/core/sort.hpp>
#include <freiform/spline/bezier.hpp>

#include <algorithm>
#include <cmath>
#include <map>

namespace freiform::detail {

namespace {

// The control points of a piece; `error` bounds how far each coordinate is off.
struct Hull {
    std::vector<Vec<2>> points;
    Box<2> box;
    double error = 0;
};
// x / w with both off by e is off by e (1 + |x / w|) / (w - e), and rounded.
Hull hull_of(const std::vector<Hom<2>>& net, double e) {
    Hull h;
    double x = 0, w = std::numeric_limits<double>::infinity();
    for (const Hom<2>& b : net) {
        h.points.push_back(project(b));
        h.box.add(h.points.back());
        x = std::max(x, max_abs(h.points.back()));
        w = std::min(w, b.weight());
    }
    h.error = w > 2 * e ? 1.01 * (e * (1 + x) / (w - e) + 2 * kUnitRoundoff * x)
                        : std::numeric_limits<double>::infinity();
    return h;
}

struct Known {
    Vec<2> p;
    double error = 0;  // of the distance
};

class Sides {
public:
    Sides(const Links& all, std::span<const Loop> loops, double gap) : all_(all), loops_(loops), gap_(gap) {
        for (const Link& l : all.link) hull_.push_back(hull_of(l.net, l.error));
    }

    // How often loop `other` goes round a point of `loop` between two parameters; the loop's own number is
    // the one on its left. Beyond its end the loop begins again.
    std::optional<int> rounds(std::size_t loop, Interval arc, std::size_t other) {
        const InsideQuery* query = query_of(other);
        if (!query) return std::nullopt;
        const Interval whole = all_.loops[loop];
        for (const double part : {0.5, 0.25, 0.75, 0.125, 0.875, 0.4375, 0.5625}) {
            double t = arc.lo + part * (arc.hi - arc.lo);
            if (t >= whole.hi) t -= whole.hi - whole.lo;
            const std::size_t k = std::min(std::size_t(t), std::size_t(whole.hi) - 1);
            const Interval here{std::max(double(k), t - (arc.hi - arc.lo) / 2),
                                std::min(double(k) + 1, t + (arc.hi - arc.lo) / 2)};
            const auto q = loop == other ? left_of(loop, k, t, here) : on_loop(k, t, other);
            if (q) return query->at(all_.given(*q)).winding;
            if (work_ > kMostWork) break;
        }
        return std::nullopt;
    }

private:
    static constexpr std::size_t kMostWork = 20'000'000;
    using Net = std::vector<Hom<2>>;

    const InsideQuery* query_of(std::size_t loop) {
        auto found = queries_.find(loop);
        if (found == queries_.end())
            found = queries_.emplace(loop, InsideQuery::make(loops_.subspan(loop, 1), gap_)).first;
        return found->second ? &*found->second : nullptr;
    }

    Known at(const Link& link, double t) const {
        std::vector<BoundedVec<3>> b;
        for (const Hom<2>& h : link.net)
            b.push_back({Bounded(h[0], link.error), Bounded(h[1], link.error), Bounded(h[2], link.error)});
        for (std::size_t n = b.size(); n > 1; --n)
            for (std::size_t i = 0; i + 1 < n; ++i)
                for (std::size_t c = 0; c < 3; ++c)
                    b[i][c] = (Bounded(1) - Bounded(t)) * b[i][c] + Bounded(t) * b[i + 1][c];
        const Bounded x = b[0][0] / b[0][2], y = b[0][1] / b[0][2];
        return {{{x.value, y.value}}, x.bound + y.bound};
    }

    // The part of a link between two of its parameters, and the error of its coefficients.
    static std::pair<Net, double> part(const Link& link, double from, double to) {
        Net b = link.net;
        double size = 0;
        for (const Hom<2>& h : b) size = std::max(size, max_abs(h));
        const Fibre<Hom<2>> fibre{b.data(), int(b.size()), 1};
        keep_left(fibre, to);
        if (from > 0) keep_right(fibre, from / to);
        return {std::move(b), link.error + 2.1 * split_error(int(b.size()) - 1) * size};
    }

    static double distance(const Hull& a, const Vec<2>& q) {
        double d[2];
        for (int c = 0; c < 2; ++c)
            d[c] = std::max({0.0, a.box.lo[c] - a.error - q[c], q[c] - a.box.hi[c] - a.error});
        return std::hypot(d[0], d[1]) * (1 - 8 * kUnitRoundoff);
    }

    bool is_farther(Net net, double error, const Vec<2>& q, double r) {
        std::vector<std::pair<Net, double>> rest{{std::move(net), error}};
        for (int k = 0; k < 200 && !rest.empty(); ++k) {
            auto [b, e] = std::move(rest.back());
            rest.pop_back();
            work_ += b.size() * b.size();
            if (distance(hull_of(b, e), q) > r) continue;
            const Link whole{b, e, 0, 0};
            rest.push_back(part(whole, 0.5, 1));
            rest.push_back(part(whole, 0, 0.5));
        }
        return rest.empty();
    }
    bool is_farther(std::size_t k, const Vec<2>& q, double r) {
        ++work_;
        return distance(hull_[k], q) > r || is_farther(all_.link[k].net, all_.link[k].error, q, r);
    }
    bool is_farther_than_all(std::size_t loop, const Vec<2>& q, double r, std::size_t but) {
        const Interval on = all_.loops[loop];
        for (std::size_t k = std::size_t(on.lo); k < std::size_t(on.hi); ++k)
            if (k != but && (work_ > kMostWork || !is_farther(k, q, r))) return false;
        return true;
    }

    std::optional<Vec<2>> on_loop(std::size_t k, double t, std::size_t other) {
        const Known p = at(all_.link[k], t - double(k));
        if (!std::isfinite(p.error)) return std::nullopt;
        return is_farther_than_all(other, p.p, p.error, all_.link.size()) ? std::optional(p.p) : std::nullopt;
    }

    // Do all legs make less than 45 degrees with d, a unit vector?
    static bool moves_along(const Hull& h, const Vec<2>& d) {
        const double e =
            16 * (h.error + kUnitRoundoff * max_abs(h.box.lo) + kUnitRoundoff * max_abs(h.box.hi));
        for (std::size_t i = 1; i < h.points.size(); ++i) {
            const Vec<2> leg = h.points[i] - h.points[i - 1];
            if (!(dot(d, leg) > std::abs(cross(d, leg)) + e)) return false;
        }
        return true;
    }

    std::optional<Vec<2>> left_of(std::size_t loop, std::size_t k, double t, Interval on) {
        const Link& link = all_.link[k];
        const double x = t - double(k);
        const Known p = at(link, x);
        for (int i = 0; i < 12; ++i) {
            const double lo = std::max(0.0, on.lo - double(k)), hi = std::min(1.0, on.hi - double(k));
            on = {t - (t - on.lo) / 2, t + (on.hi - t) / 2};
            if (!(lo < x && x < hi)) return std::nullopt;
            const auto [b, e] = part(link, lo, hi);
            const Hull stretch = hull_of(b, e);
            const Vec<2> chord = stretch.points.back() - stretch.points.front();
            if (!(norm(chord) > 0)) return std::nullopt;
            const Vec<2> d = (1 / norm(chord)) * chord;
            if (!moves_along(stretch, d)) continue;
            double r =
                0.5 * std::min(dot(d, p.p - stretch.points.front()), dot(d, stretch.points.back() - p.p));
            for (int round = 0; round < 10; ++round, r /= 4) {
                if (!(r > 64 * (p.error + stretch.error))) return std::nullopt;
                if (is_farther_than_all(loop, p.p, r, k) &&
                    (lo == 0 || is_farther_part(link, 0, lo, p.p, r)) &&
                    (hi == 1 || is_farther_part(link, hi, 1, p.p, r)))
                    return p.p + (r / 2) * Vec<2>{{-d[1], d[0]}};
            }
        }
        return std::nullopt;
    }
    bool is_farther_part(const Link& link, double from, double to, const Vec<2>& q, double r) {
        auto [b, e] = part(link, from, to);
        return is_farther(std::move(b), e, q, r);
    }

    const Links& all_;
    std::span<const Loop> loops_;
    double gap_;
    std::vector<Hull> hull_;
    std::map<std::size_t, Result<InsideQuery>> queries_;
    std::size_t work_ = 0;
};

// Contacts of one loop with another that are one place on it.
struct Group {
    Interval on;
    std::vector<std::size_t> contacts;
};

// In cyclic order; the last may reach over the end of the loop.
std::vector<Group> groups_of(std::vector<Group> all, const Interval& whole) {
    sort(all.begin(), all.end(), [](const Group& a, const Group& b) { return a.on.lo < b.on.lo; });
    std::vector<Group> out;
    const auto unite = [](Group& a, const Group& b) {
        a.contacts.insert(a.contacts.end(), b.contacts.begin(), b.contacts.end());
    };
    for (Group& g : all)
        if (!out.empty() && g.on.lo <= out.back().on.hi) {
            out.back().on.hi = std::max(out.back().on.hi, g.on.hi);
            unite(out.back(), g);
        } else {
            out.push_back(std::move(g));
        }
    if (out.size() > 1 && out.front().on.lo <= whole.lo && out.back().on.hi >= whole.hi) {
        out.back().on.hi = whole.hi + (out.front().on.hi - whole.lo);
        unite(out.back(), out.front());
        out.erase(out.begin());
    }
    return out;
}

}  // namespace

std::vector<Meets> how_they_meet(const Links& all, std::span<const Loop> loops, double gap,
                                 std::span<const LoopMeeting> found) {
    std::vector<Meets> answer(found.size(), Meets::undecided);
    std::map<std::array<std::size_t, 2>, std::vector<Group>> places;  // of a loop with another, on it
    for (std::size_t i = 0; i < found.size(); ++i)
        for (std::size_t k = 0; k < 2; ++k)
            places[{found[i].loop[k], found[i].loop[1 - k]}].push_back({found[i].on[k], {i}});
    Sides sides(all, loops, gap);
    for (auto& [pair, here] : places) {
        const auto [loop, other] = pair;
        const Interval whole = all.loops[loop];
        const std::vector<Group> groups = groups_of(std::move(here), whole);
        const std::size_t n = groups.size();
        // Before group k; where there is one arc, before and after are the same.
        std::vector<std::optional<int>> before(n, n == 1 && loop != other ? std::optional(0) : std::nullopt);
        if (n > 1)
            for (std::size_t k = 0; k < n; ++k) {
                const double from = k > 0 ? groups[k - 1].on.hi : groups[n - 1].on.hi - (whole.hi - whole.lo),
                             to = groups[k].on.lo, turn = from < whole.lo ? whole.hi - whole.lo : 0;
                if (from < to) before[k] = sides.rounds(loop, {from + turn, to + turn}, other);
            }
        if (n == 1 && !(groups[0].on.length() < whole.length())) continue;
        for (std::size_t k = 0; k < n; ++k) {
            const auto &a = before[k], &b = before[(k + 1) % n];
            if (!a || !b) continue;
            for (const std::size_t i : groups[k].contacts) {
                const bool twice = std::ranges::count(groups[k].contacts, i) > 1;  // of a loop with itself
                if (*a != *b)
                    answer[i] = Meets::crosses;
                else if (answer[i] != Meets::crosses && !twice)
                    answer[i] = Meets::touches;
            }
        }
    }
    return answer;
}

}  // namespace freiform::detail
