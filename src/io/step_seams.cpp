// Seams: new edges that make the boundaries of faces closed chains of parameters.
//
// Two chains that wind around the surface, or one and a pole, are joined along an edge that is used twice,
// one period apart. It begins at a corner of one and ends at a corner of the other, the pair that is nearest
// in the period, so that it is an isoparametric line where there is one, and with nothing across it. Where
// something is across each, it is a row of edges around that (step_ways.cpp).
#include "step_loops.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/core/sort.hpp>

#include <algorithm>
#include <cmath>
#include <tuple>

namespace freiform::step {

namespace {

constexpr std::size_t kMostCorners = 64;  // of a loop, where a seam may begin

}  // namespace

// The chain from another of its edges on.
void LoopBuilder::turn_to(Chain& c, std::size_t first) const {
    std::rotate(c.uses.begin(), c.uses.begin() + std::ptrdiff_t(first), c.uses.end());
    std::vector<Use> again;
    for (Use& u : c.uses) attach(again, std::move(u));
    c.uses = std::move(again);
    measure(c);
}

void LoopBuilder::turn_around(Chain& c) const {
    std::reverse(c.uses.begin(), c.uses.end());
    for (Use& u : c.uses) {
        u.coedge.reversed = !u.coedge.reversed;
        std::swap(u.from, u.to);
        std::swap(u.start, u.end);
    }
    for (int& w : c.winding) w = -w;
    measure(c);
}

// The curve in space, where it has these parameters.
std::optional<CurveGeometry<3>> LoopBuilder::iso_over(int axis, double at, Interval on) const {
    auto c = chart_.iso(axis, at);
    if (!c || !(std::holds_alternative<Curve<Vec<3>>>(*c) || std::holds_alternative<Curve<Hom<3>>>(*c)))
        return c;
    const Interval all = domain(*c)[0];
    return all.lo <= on.lo && on.hi <= all.hi ? std::move(c) : std::nullopt;
}

// The two uses of a new edge from a to b: there, and back one period beside it.
std::array<Use, 2> LoopBuilder::seam(int from, int to, const Vec<2>& a, const Vec<2>& b,
                                     const Vec<2>& period) {
    if (const int k = period[0] != 0 ? 1 : 0; a[k] > b[k]) {  // curves run along ascending parameters
        auto uses = seam(to, from, b, a, period);
        for (Use& u : uses) {
            u.coedge.reversed = !u.coedge.reversed;
            std::swap(u.from, u.to);
            std::swap(u.start, u.end);
        }
        return uses;
    }
    Edge e;
    e.start = from, e.end = to, e.tolerance = close_;
    Line<2> line{a, b - a};
    const int axis = period[0] != 0 ? 0 : 1;
    if (std::abs(a[axis] - b[axis]) <= 1e-12 * std::abs(period[axis]) && a[1 - axis] < b[1 - axis])
        if (auto c = iso_over(axis, a[axis], {a[1 - axis], b[1 - axis]})) {
            e.curve = std::move(*c);
            e.range = {a[1 - axis], b[1 - axis]};
            line = {};
            line.origin[axis] = a[axis];
            line.direction[1 - axis] = 1;
        }
    if (!e.curve) e.range = {0, 1};
    const int i = int(model_.edges.size());
    model_.edges.push_back(e);
    return {make_use({i, false, line}, e),
            make_use({i, true, Line<2>{line.origin - period, line.direction}}, e)};
}

// A row of them: the points between the first and the last become vertices.
LoopBuilder::Seam LoopBuilder::seams(int from, int to, std::span<const Vec<2>> points, const Vec<2>& period) {
    Seam out;
    for (std::size_t i = 1; i < points.size(); ++i) {
        int next = to;
        if (i + 1 < points.size()) {
            next = int(model_.vertices.size());
            model_.vertices.push_back({chart_.point(points[i]), close_});
        }
        auto uses = seam(from, next, points[i - 1], points[i], period);
        out.there.push_back(std::move(uses[0]));
        out.back.insert(out.back.begin(), std::move(uses[1]));
        from = next;
    }
    return out;
}

// Where a seam may run between a corner of `a`, or the pole with the parameter `first`, and a corner of `b`,
// or the pole with `last`, where no straight one can.
std::optional<Way> LoopBuilder::way(const Chain* a, const Chain* b, int axis, double first,
                                    double last) const {
    const double turn = chart_.period(axis), other = chart_.period(1 - axis);
    Interval across{kInfinity, -kInfinity};
    const auto reach = [&](const Chain* c, double pole) {
        const auto include = [&](double x) { across = {std::min(across.lo, x), std::max(across.hi, x)}; };
        if (c == nullptr) return include(pole);
        for (const Vec<2>& p : c->outline) include(p[1 - axis]);
    };
    reach(a, first), reach(b, last);
    const double lo = across.lo, high = across.length();
    if (!(high > 0)) return std::nullopt;
    const auto in_strip = [&](const Vec<2>& p) {
        return Vec<2>{{p[axis] / turn, (p[1 - axis] - lo) / high}};
    };
    Strip strip;
    const auto add = [&](const Chain& c, int periods) {
        for (std::size_t i = 0; i < c.outline.size(); ++i) {
            Vec<2> p = c.outline[i], q = c.outline[(i + 1) % c.outline.size()];
            if (i + 1 == c.outline.size()) q[axis] += c.winding[std::size_t(axis)] * turn;
            if (p == q) continue;
            for (int n = -periods; n <= periods; ++n) {
                const Vec<2> by{{0, n * other / high}};
                strip.outlines.push_back({in_strip(p) + by, in_strip(q) + by});
            }
        }
    };
    for (const Chain& c : chains_) add(c, other > 0 ? 1 : 0);
    const auto corners = [&](const Chain& c, std::vector<Vec<2>>& out) {
        add(c, 0);
        for (std::size_t i = 0; i < c.uses.size() && i < kMostCorners; ++i)
            out.push_back(in_strip(c.uses[i].start));
    };
    if (a != nullptr)
        corners(*a, strip.from);
    else
        for (int i = 0; i < kBegins; ++i) strip.from.push_back({{double(i) / kBegins, (first - lo) / high}});
    if (b != nullptr)
        corners(*b, strip.to);
    else
        strip.pole = (last - lo) / high;
    auto way = find_way(strip);
    if (!way) return way;
    const auto back = [&](Vec<2>& p) {
        const Vec<2> x = p;
        p[axis] = turn * x[0], p[1 - axis] = lo + high * x[1];
    };
    for (Vec<2>& p : way->inner) back(p);
    back(way->end);
    return way;
}

// Whether the outline of a chain crosses the segment from p to q, or has a corner on it.
bool LoopBuilder::crosses(const Chain& c, const Vec<2>& p, const Vec<2>& q) const {
    const std::array<double, 2> turn{chart_.period(0), chart_.period(1)};
    const double near = 1e-9 * std::max(turn[0], turn[1]);
    const auto side = [](const Vec<2>& x, const Vec<2>& y, const Vec<2>& z) { return cross(y - x, z - x); };
    const auto same = [&](const Vec<2>& x, const Vec<2>& y) { return norm(x - y) <= near; };
    for (int n = 0; n < 9; ++n) {
        if ((turn[0] == 0 && n % 3 != 1) || (turn[1] == 0 && n / 3 != 1)) continue;
        const Vec<2> by{{(n % 3 - 1) * turn[0], (n / 3 - 1) * turn[1]}};
        for (std::size_t i = 0; i < c.outline.size(); ++i) {
            Vec<2> r = c.outline[i], s = c.outline[(i + 1) % c.outline.size()];
            for (int k = 0; k < 2 && i + 1 == c.outline.size(); ++k)
                s[k] += c.winding[std::size_t(k)] * turn[std::size_t(k)];
            r += by, s += by;
            const double part = dot(r - p, q - p) / dot(q - p, q - p);
            if (part > 0 && part < 1 && !same(r, p) && !same(r, q) && same(r, p + part * (q - p)))
                return true;
            if (same(r, p) || same(s, p) || same(r, q) || same(s, q)) continue;
            if (side(p, q, r) * side(p, q, s) < 0 && side(r, s, p) * side(r, s, q) < 0) return true;
        }
    }
    return false;
}

// Between two chains that wind: neither of them nor a hole is across.
bool LoopBuilder::is_free(const Chain& a, const Chain& b, const Vec<2>& p, const Vec<2>& q) const {
    const auto across = [&](const Chain& c) { return crosses(c, p, q); };
    return !across(a) && !across(b) && std::none_of(chains_.begin(), chains_.end(), across);
}

// One chain from a to b along the seam; `a` winds so that the face is on the side of b.
void LoopBuilder::join(Chain& a, Chain b, int axis) {
    const double turn = chart_.period(axis);
    const auto k = std::size_t(axis);
    const double forward = axis == 0 ? a.winding[k] : -a.winding[k];
    const auto shift = [&](const Vec<2>& from, const Vec<2>& to, bool ahead) {
        Vec<2> by{};
        by[axis] = std::round((from[axis] - to[axis]) / turn) * turn;
        if (const double other = chart_.period(1 - axis); other > 0 && ahead) {
            const double way = forward * (to[1 - axis] - from[1 - axis]);
            by[1 - axis] = -forward * std::floor((way - 1e-9 * other) / other) * other;
        }
        return by;
    };
    // The pair of corners with the shortest way along the axis, and nothing across it.
    struct Pair {
        double cost;
        std::size_t i, j;
    };
    std::vector<Pair> pairs;
    for (std::size_t i = 0; i < a.uses.size() && i < kMostCorners; ++i)
        for (std::size_t j = 0; j < b.uses.size() && j < kMostCorners; ++j)
            pairs.push_back(
                {std::abs(std::remainder(a.uses[i].start[axis] - b.uses[j].start[axis], turn)), i, j});
    sort(pairs.begin(), pairs.end(), [](const Pair& x, const Pair& y) {
        return std::tie(x.cost, x.i, x.j) < std::tie(y.cost, y.i, y.j);
    });
    pairs.resize(std::min(pairs.size(), kMostCorners));
    Pair best = pairs.front();
    const auto ends = [&](const Pair& x) {
        const Vec<2> p = a.uses[x.i].start, q = b.uses[x.j].start;
        return std::array{p, q + shift(p, q, true)};
    };
    std::optional<Way> around;
    const auto free = std::ranges::find_if(pairs, [&](const Pair& x) {
        const auto [p, q] = ends(x);
        return is_free(a, b, p, q);
    });
    if (free != pairs.end()) {
        best = *free;
    } else {
        move(b, shift(a.uses.front().start, b.uses.front().start, true));
        around = way(&a, &b, axis, 0, 0);
        if (around) best.i = around->from, best.j = around->to;
    }
    turn_to(a, best.i);
    turn_to(b, best.j);
    std::vector<Vec<2>> points{a.uses.back().end};
    Vec<2> period{};
    period[axis] = points[0][axis] - a.uses.front().start[axis];
    if (around) {
        for (const Vec<2>& p : around->inner) points.push_back(p + period);
        move(b, shift(around->end + period, b.uses.front().start, false));
    } else {
        move(b, shift(points[0], b.uses.front().start, true));
    }
    points.push_back(b.uses.front().start);
    Seam made = seams(a.uses.front().from, b.uses.front().from, points, period);
    for (auto* uses : {&made.there, &b.uses, &made.back})
        for (Use& u : *uses) a.uses.push_back(std::move(u));
    a.winding = {0, 0};
    measure(a);
}

// What a loop goes out along and comes back the same way encloses nothing on a closed surface.
void LoopBuilder::release_spurs() {
    if (!is_closed_surface()) return;
    for (Chain& c : chains_) {
        const std::size_t before = c.uses.size();
        fold_spurs(
            c.uses, [&](const Use& x, const Use& y) { return is_way_back(x, y); },
            [&](const Use& u) { released.push_back(u.coedge.edge); });
        if (c.uses.size() < before) measure(c);
    }
    std::erase_if(chains_, [](const Chain& c) { return c.uses.empty(); });
}

// A seam of the file that a hole lies across is taken away again: two chains that wind are left.
void LoopBuilder::release_seams() {
    const auto part = [&](const std::vector<Use>& uses, std::size_t from, std::size_t to) {
        Chain c;
        for (; from != to; from = (from + 1) % uses.size()) c.uses.push_back(uses[from]);
        for (int k = 0; k < 2 && !c.uses.empty(); ++k)
            c.winding[std::size_t(k)] = turns(c.uses.back().end - c.uses.front().start, k);
        measure(c);
        return c;
    };
    for (std::size_t n = 0; n < chains_.size(); ++n) {
        const auto& uses = chains_[n].uses;
        if (chains_[n].winding != std::array{0, 0}) continue;
        for (std::size_t j = 2; j < uses.size(); ++j)
            for (std::size_t i = 0; i + 1 < j; ++i) {
                if (uses[i].coedge.edge != uses[j].coedge.edge) continue;
                Chain first = part(uses, i + 1, j), second = part(uses, (j + 1) % uses.size(), i);
                if (first.winding == second.winding || second.uses.empty()) continue;
                const bool is_across = std::ranges::any_of(chains_, [&](const Chain& c) {
                    return &c != &chains_[n] && crosses(c, uses[i].start, uses[i].end);
                });
                if (!is_across) continue;
                released.push_back(uses[i].coedge.edge);
                chains_[n] = std::move(first);
                chains_.push_back(std::move(second));
                return release_seams();
            }
    }
}

void LoopBuilder::join_pole(Chain& c, const Pole& pole) {
    const int axis = 1 - pole.axis;
    double level = pole.at;
    if (const double turn = chart_.period(pole.axis); turn > 0)
        level += std::round((c.uses.back().end[pole.axis] - level) / turn) * turn;
    const auto across = [&](const Use& u) {
        Vec<2> at = u.start;
        at[pole.axis] = level;
        return !is_free(c, c, u.start, at);
    };
    std::optional<Way> around;
    const auto corners = std::span(c.uses).first(std::min(c.uses.size(), kMostCorners));
    const auto free = std::size_t(std::ranges::find_if_not(corners, across) - corners.begin());
    if (free == corners.size()) around = way(&c, nullptr, axis, 0, level);
    turn_to(c, around ? around->from : free % corners.size());
    std::vector<Vec<2>> points{c.uses.back().end};
    Vec<2> period{};
    period[axis] = points[0][axis] - c.uses.front().start[axis];
    if (around)
        for (const Vec<2>& p : around->inner) points.push_back(p + period);
    points.push_back(points.back());
    points.back()[pole.axis] = level;
    const int tip = vertex_near(pole.point);
    Seam made = seams(c.uses.front().from, tip, points, period);
    for (Use& u : made.there) c.uses.push_back(std::move(u));
    c.uses.push_back(degenerate(tip, points.back(), points.back() - period));
    for (Use& u : made.back) c.uses.push_back(std::move(u));
    c.winding = {0, 0};
    measure(c);
}

int LoopBuilder::vertex_near(const Vec<3>& p) {
    if (vertex_ >= 0 && norm(model_.vertices[std::size_t(vertex_)].point - p) <= 4 * close_) return vertex_;
    model_.vertices.push_back({p, close_});
    return int(model_.vertices.size()) - 1;
}

// Pairs of chains that wind around along the axis.
Result<void> LoopBuilder::join_winding(int axis) {
    const auto k = std::size_t(axis);
    const double across_turn = chart_.period(1 - axis);
    for (std::size_t guard = chains_.size(); guard-- > 0;) {
        const auto winds = [&](const Chain& c) { return c.winding[k] != 0; };
        const auto forward = [&](const Chain& c) { return axis == 0 ? c.winding[k] : -c.winding[k]; };
        const auto level = [&](const Chain& c) { return c.uses.front().start[1 - axis]; };
        // One with the face ahead of it, and the next one from there.
        auto a = std::find_if(chains_.begin(), chains_.end(),
                              [&](const Chain& c) { return winds(c) && forward(c) > 0; });
        if (a == chains_.end()) a = std::find_if(chains_.begin(), chains_.end(), winds);
        if (a == chains_.end()) return {};
        if (std::abs(a->winding[k]) > 1)
            return refuse(RefusalKind::invalid, "loop",
                          text("winds ", a->winding[k], " times around the surface"));
        const double sign = forward(*a);
        auto best = chains_.end();
        double least = kInfinity;
        for (auto b = chains_.begin(); b != chains_.end(); ++b) {
            if (b == a || !winds(*b)) continue;
            double ahead = sign * (level(*b) - level(*a));
            if (across_turn > 0) ahead -= std::floor(ahead / across_turn) * across_turn;
            // Against its orientation only if there is no other.
            const double cost =
                (ahead > 0 ? ahead : 1e6 + std::abs(ahead)) + (forward(*b) * sign < 0 ? 0 : 1e12);
            if (cost < least) least = cost, best = b;
        }
        if (best != chains_.end()) {
            if (forward(*best) * sign > 0) {
                note = "two of its loops run the same way around the surface; one is taken the other way";
                if (sign * (level(*best) - level(*a)) > 0 || across_turn > 0)
                    turn_around(*best);
                else
                    turn_around(*a);
            } else if (across_turn == 0 && sign * (level(*best) - level(*a)) < 0) {
                note = "its loops run the wrong way around the surface; they are taken the other way";
                turn_around(*best);
                turn_around(*a);
            }
            Chain b = std::move(*best);
            Chain first = std::move(*a);
            if (a > best) std::swap(a, best);
            chains_.erase(best);
            chains_.erase(a);
            join(first, std::move(b), axis);
            chains_.push_back(std::move(first));
            continue;
        }
        const Pole* end = nullptr;
        double nearest = kInfinity;
        for (const Pole& p : chart_.poles()) {
            if (p.axis != 1 - axis) continue;
            double ahead = sign * (p.at - level(*a));
            if (across_turn > 0 && ahead < 0) ahead += across_turn;
            if (ahead > 0 && ahead < nearest) nearest = ahead, end = &p;
        }
        if (end == nullptr)
            for (const Pole& p : chart_.poles())
                if (p.axis == 1 - axis && chart_.poles().size() == 1) {
                    end = &p;
                    note = "its loop runs the wrong way around the surface; it is taken the other way";
                    turn_around(*a);
                }
        if (end == nullptr)
            return refuse(RefusalKind::invalid, "loop",
                          "winds around the surface, and nothing bounds the face on its other side");
        join_pole(*a, *end);
    }
    return {};
}

}  // namespace freiform::step
