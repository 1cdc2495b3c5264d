// The rectangle of parameters that a surface without any boundary gets: seams and poles are its sides.
#include "step_loops.hpp"

#include <freiform/core/constants.hpp>

#include <algorithm>
#include <cmath>

namespace freiform::step {

void LoopBuilder::add_rectangle(const std::array<Interval, 2>& on) {
    const std::array<Vec<2>, 4> corner{
        {{{on[0].lo, on[1].lo}}, {{on[0].hi, on[1].lo}}, {{on[0].hi, on[1].hi}}, {{on[0].lo, on[1].hi}}}};
    std::array<int, 4> vertex{};
    for (std::size_t i = 0; i < 4; ++i) {
        const Vec<3> p = chart_.point(corner[i]);
        vertex[i] = -1;
        for (std::size_t j = 0; j < i; ++j)
            if (norm(model_.vertices[std::size_t(vertex[j])].point - p) <= close_) vertex[i] = vertex[j];
        if (vertex[i] < 0) vertex[i] = vertex_near(p);
    }
    const auto closed = [&](int k) {
        return chart_.period(k) > 0 &&
               std::abs(on[std::size_t(k)].length() - chart_.period(k)) <= 1e-9 * chart_.period(k);
    };
    std::array<int, 4> made{-1, -1, -1, -1};
    Chain c;
    for (std::size_t i = 0; i < 4; ++i) {  // below, right, above, left
        const Vec<2> a = corner[i], b = corner[(i + 1) % 4];
        const int axis = i % 2 == 0 ? 1 : 0;  // the parameter that stays
        if (pole_at(a, b) != nullptr && pole_at(a, b)->axis == axis) {
            c.uses.push_back(degenerate(vertex[i], a, b));
            continue;
        }
        const bool backward = i >= 2;
        Line<2> line;
        line.origin[axis] = a[axis];
        line.direction[1 - axis] = 1;
        if (backward && closed(axis) && made[i - 2] >= 0) {
            c.uses.push_back(make_use({made[i - 2], true, line}, model_.edges[std::size_t(made[i - 2])]));
            continue;
        }
        Edge e;
        e.start = vertex[backward ? (i + 1) % 4 : i], e.end = vertex[backward ? i : (i + 1) % 4];
        e.range = on[std::size_t(1 - axis)];
        e.curve = iso_over(axis, a[axis], e.range);
        e.tolerance = close_;
        made[i] = int(model_.edges.size());
        model_.edges.push_back(e);
        c.uses.push_back(make_use({made[i], backward, line}, e));
    }
    measure(c);
    chains_.push_back(std::move(c));
}

// All of the surface, for loops that are holes in it: from where none of them is across.
Result<void> LoopBuilder::add_whole() {
    std::array<Interval, 2> on = chart_.whole();
    for (std::size_t k = 0; k < 2; ++k) {
        if (!std::isfinite(on[k].length()))
            return refuse(RefusalKind::unsupported, "face", "has no boundary, and its surface has none");
        const double turn = chart_.period(int(k));
        if (!(turn > 0) || on[k].length() < turn - 1e-9) continue;
        const auto is_free = [&](double x) {
            return std::ranges::all_of(chains_, [&](const Chain& c) {
                double lo = kInfinity, hi = -kInfinity;
                for (const Vec<2>& p : c.outline) lo = std::min(lo, p[int(k)]), hi = std::max(hi, p[int(k)]);
                const double from = lo - x - std::floor((lo - x) / turn) * turn;
                return from > 0 && from + (hi - lo) < turn;
            });
        };
        int i = 0;
        while (i < kBegins && !is_free(on[k].lo + turn * i / kBegins)) ++i;
        if (i == kBegins && add_from_pole_to_pole(int(k))) return {};
        const double begin = on[k].lo + turn * (i % kBegins) / kBegins;
        on[k] = {begin, begin + turn};
    }
    add_rectangle(on);
    return {};
}

// Likewise, with a seam around holes from one pole to another. False if there are no poles or no way.
bool LoopBuilder::add_from_pole_to_pole(int axis) {
    const Interval on = chart_.whole()[std::size_t(1 - axis)];
    const Pole *first = nullptr, *last = nullptr;
    for (const Pole& p : chart_.poles())
        if (p.axis != axis && p.at == on.lo)
            first = &p;
        else if (p.axis != axis && p.at == on.hi)
            last = &p;
    if (first == nullptr || last == nullptr) return false;
    const double turn = chart_.period(axis);
    const auto around = way(nullptr, nullptr, axis, on.lo, on.hi);
    if (!around) return false;
    Vec<2> period{};
    period[axis] = turn;
    std::vector<Vec<2>> points(1);
    points[0][axis] = turn * double(around->from) / kBegins, points[0][1 - axis] = on.lo;
    points.insert(points.end(), around->inner.begin(), around->inner.end());
    points.push_back(around->end);
    points.back()[1 - axis] = on.hi;
    for (Vec<2>& p : points) p += period;
    const int from = vertex_near(first->point), to = vertex_near(last->point);
    Seam made = seams(from, to, points, period);
    Chain c;
    c.uses.push_back(degenerate(from, points.front() - period, points.front()));
    for (Use& u : made.there) c.uses.push_back(std::move(u));
    c.uses.push_back(degenerate(to, points.back(), points.back() - period));
    for (Use& u : made.back) c.uses.push_back(std::move(u));
    measure(c);
    if (c.area < 0) turn_around(c);
    chains_.push_back(std::move(c));
    return true;
}

}  // namespace freiform::step
