// Joints of loops. Edges that end beside each other in the parameters, as those do that lie beside the
// surface, cross there or run back a little, and no region has such a boundary. So parameter curves are made
// to meet: straight ones by another direction, splines that follow an edge by their last control point, which
// moves only their last piece. What that moves on the surface is added to the gap of the edge, which is
// measured again once the face is closed.
#include "step_loops.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace freiform::step {

namespace {

constexpr double kBesideCorner = 1e-3;  // of edges: how far their vertex is beside their ends, at most

bool is_straight(const Use& u) { return std::holds_alternative<Line<2>>(u.coedge.curve); }
bool can_move(const Use& u) {
    return is_straight(u) || ((u.fitted || u.told) && std::holds_alternative<Curve<Vec<2>>>(u.coedge.curve));
}

}  // namespace

void LoopBuilder::end_at(Use& u, bool last, const Vec<2>& to) const {
    const Edge& e = model_.edges[std::size_t(u.coedge.edge)];
    Vec<2>& end = last ? u.end : u.start;
    if (end == to) return;
    u.gap += norm(chart_.point(end) - chart_.point(to));
    end = to;
    const bool at_hi = last != u.coedge.reversed;
    if (is_straight(u)) {
        const Vec<2> lo = u.coedge.reversed ? u.end : u.start, hi = u.coedge.reversed ? u.start : u.end;
        const Vec<2> d = (1 / e.range.length()) * (hi - lo);
        u.coedge.curve = Line<2>{lo - e.range.lo * d, d};
        return;
    }
    const auto& c = std::get<Curve<Vec<2>>>(u.coedge.curve);
    Net<1, Vec<2>> net = c.net();
    (at_hi ? net.flat().back() : net.flat().front()) = to;
    u.coedge.curve = Curve<Vec<2>>::trusted(c.bases(), std::move(net));
}

// Ends beside a pole exactly there.
void LoopBuilder::end_at_poles(Use& u) const {
    if (!can_move(u)) return;
    for (const bool last : {false, true}) {
        Vec<2> to = last ? u.end : u.start;
        const double stated = model_.vertices[std::size_t(last ? u.to : u.from)].tolerance;
        const Pole* pole = pole_at(to, to, 2 * stated);
        if (pole == nullptr) continue;
        const double turn = chart_.period(pole->axis), by = pole->at - to[pole->axis];
        to[pole->axis] += turn > 0 ? std::remainder(by, turn) : by;
        end_at(u, last, to);
    }
}

// The same end of another use of the edge there, too: they run to and fro on one way.
void LoopBuilder::end_both_at(Chain& c, Use& u, bool last, const Vec<2>& to) const {
    const Vec<2> old = last ? u.end : u.start;
    end_at(u, last, to);
    for (Use& v : c.uses)
        if (&v != &u && v.coedge.edge == u.coedge.edge && v.coedge.reversed != u.coedge.reversed &&
            (last ? v.start : v.end) == old)
            end_at(v, !last, to);
}

void LoopBuilder::close_joints(Chain& c) const {
    const std::size_t n = c.uses.size();
    std::map<int, int> times;  // that an edge is used
    for (const Use& u : c.uses) ++times[u.coedge.edge];
    const auto is_twice = [&](const Use& u) { return times[u.coedge.edge] > 1; };
    for (std::size_t k = 0; k < n && (n > 1 || !c.uses[0].fitted); ++k) {
        Use &a = c.uses[k], &b = c.uses[(k + 1) % n];
        Vec<2> turns{};  // by which b is to be moved to follow a
        for (int i = 0; i < 2; ++i)
            if (const double turn = chart_.period(i); turn > 0)
                turns[i] = std::round((a.end[i] - b.start[i]) / turn) * turn;
        const Vec<2> from = a.end, to = b.start + turns;
        if (from == to || n == 1) continue;
        const double apart = norm(chart_.point(from) - chart_.point(to));
        const auto stated = [&](const Use& u) { return model_.edges[std::size_t(u.coedge.edge)].tolerance; };
        // Where an edge runs to and fro its ends have to be the same both times, as far as their vertex says.
        const auto way = [&](const Use& u) { return norm(chart_.point(u.start) - chart_.point(u.end)); };
        const double corner = is_twice(a) || is_twice(b)
                                  ? std::min(model_.vertices[std::size_t(a.to)].tolerance,
                                             kBesideCorner * std::min(way(a), way(b)))
                                  : 0;
        if (!(apart <= 2 * std::max({close_, stated(a), stated(b), a.gap, b.gap, corner}))) continue;
        // What follows an edge gives way to what has a closed form.
        const bool a_first = can_move(a) && (!can_move(b) || !is_straight(a) || is_straight(b));
        if (a_first)
            end_both_at(c, a, true, to);
        else if (can_move(b))
            end_both_at(c, b, false, from - turns);
    }
}

}  // namespace freiform::step
