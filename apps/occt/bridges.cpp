#include "bridges.hpp"

#include <Precision.hxx>
#include <algorithm>
#include <cmath>
#include <gp_Pnt.hxx>

namespace freiform::occt {

namespace {

constexpr double kNear = 1e-6;    // of a period
constexpr double kSliver = 1e-5;  // of a turn around the surface: what is narrower encloses nothing

// The periods that a bridge goes along both parameters; nothing where the coedge is none.
std::optional<Vec<2>> periods_of(const Coedge& c, const Edge& e, const std::array<double, 2>& period) {
    const auto* line = std::get_if<Line<2>>(&c.curve);
    if (line == nullptr || e.degenerate || e.start != e.end) return std::nullopt;
    const Vec<2> by = (c.reversed ? -e.range.length() : e.range.length()) * line->direction;
    Vec<2> turns{};
    for (int k = 0; k < 2; ++k) {
        const double p = period[std::size_t(k)];
        turns[k] = p > 0 ? std::round(by[k] / p) : 0;
        const double scale = p > 0 ? p : std::abs(by[1 - k]);
        if (!(std::abs(by[k] - turns[k] * p) <= kNear * scale)) return std::nullopt;
    }
    return turns[0] != 0 || turns[1] != 0 ? std::optional(turns) : std::nullopt;
}

// The box of a loop in the parameters, and the area that it has on its left, of polygons along it.
struct Extent {
    Box<2> box;
    double area = 0;
    Vec<2> open{};  // from its beginning to its end
};
Extent extent_of(const Loop& loop, const std::vector<Edge>& edges) {
    Extent out;
    std::vector<Vec<2>> along;
    for (const Coedge& c : loop.coedges) {
        const Interval on = edges[std::size_t(c.edge)].range;
        for (int i = 0; i <= 16; ++i) {
            along.push_back(jet<0>(c.curve, on.lo + on.length() * (c.reversed ? 16 - i : i) / 16).value());
            out.box.add(along.back());
        }
    }
    if (!along.empty()) out.open = along.back() - along[0];
    for (std::size_t i = 0; i < along.size(); ++i) {
        const Vec<2> a = along[i] - along[0], b = along[(i + 1) % along.size()] - along[0];
        out.area += (a[0] * b[1] - a[1] * b[0]) / 2;
    }
    return out;
}

Vec<3> at(const Handle(Geom_Surface) & s, const Vec<2>& uv) {
    const gp_Pnt p = s->Value(uv[0], uv[1]);
    return {{p.X(), p.Y(), p.Z()}};
}

}  // namespace

std::optional<Slit> slit_of(const Loop& loop, const std::vector<Edge>& edges, const Handle(Geom_Surface) & s,
                            const std::array<double, 2>& period, double close) {
    for (int axis = 0; axis < 2; ++axis) {
        const double turn = period[std::size_t(axis)];
        if (!(turn > 0)) continue;
        const int along = 1 - axis;
        Box<2> box;
        std::vector<double> ways;
        for (const Coedge& c : loop.coedges) {
            const Interval on = edges[std::size_t(c.edge)].range;
            for (int i = 0; i <= 8; ++i) box.add(jet<0>(c.curve, on.lo + on.length() * i / 8).value());
            const double by = (jet<0>(c.curve, on.hi).value() - jet<0>(c.curve, on.lo).value())[along];
            ways.push_back(c.reversed ? -by : by);
        }
        if (!(box.side(axis).length() <= kNear * turn) || !(box.side(along).length() > 0)) continue;
        Slit slit{axis, turn, 0};
        int turns = 0;
        for (std::size_t i = 0; i < ways.size(); ++i)
            if ((ways[i] > 0) != (ways[(i + ways.size() - 1) % ways.size()] > 0)) slit.turn = i, ++turns;
        bool poles = turns == 2;
        for (const double end : {box.lo[along], box.hi[along]})
            for (int i = 0; i < 4 && poles; ++i) {
                Vec<2> a{}, b{};
                a[along] = b[along] = end;
                a[axis] = box.lo[axis], b[axis] = box.lo[axis] + turn * i / 4;
                poles = norm(at(s, a) - at(s, b)) <= close;
            }
        if (poles) return slit;
    }
    return std::nullopt;
}

bool is_slit(const Loop& loop, const std::vector<Edge>& edges, const Handle(Geom_Surface) & s) {
    const Box<2> box = extent_of(loop, edges).box;
    Vec<2> lo, hi;
    s->Bounds(lo[0], hi[0], lo[1], hi[1]);
    for (int axis = 0; axis < 2; ++axis)
        if (!Precision::IsInfinite(lo[axis]) && !Precision::IsInfinite(hi[axis]) &&
            box.side(axis).length() <= kNear * (hi[axis] - lo[axis]))
            return true;
    return false;
}

void swap_sides(Loop& loop, const std::vector<Edge>& edges, const std::array<double, 2>& period) {
    std::vector<std::size_t> at;
    std::vector<Vec<2>> turns;
    Box<2> box;
    for (std::size_t i = 0; i < loop.coedges.size(); ++i) {
        const Coedge& c = loop.coedges[i];
        const Interval on = edges[std::size_t(c.edge)].range;
        for (int k = 0; k <= 8; ++k) box.add(jet<0>(c.curve, on.lo + on.length() * k / 8).value());
        if (const auto by = periods_of(c, edges[std::size_t(c.edge)], period))
            at.push_back(i), turns.push_back(*by);
    }
    if (at.size() != 2 || turns[0] + turns[1] != Vec<2>{} || std::abs(turns[0][0] + turns[0][1]) != 1) return;
    const int along = turns[0][0] != 0 ? 0 : 1, across = 1 - along;
    const double turn = period[std::size_t(along)], around = period[std::size_t(across)];
    const auto place = [&](std::size_t i) {
        const Coedge& c = loop.coedges[at[i]];
        return jet<0>(c.curve, edges[std::size_t(c.edge)].range.lo).value()[across];
    };
    if (!(std::abs(std::abs(place(1) - place(0)) - around) <= kNear * around)) return;
    if (!(box.side(along).length() > (1 + kNear) * turn)) return;
    std::rotate(loop.coedges.begin(), loop.coedges.begin() + std::ptrdiff_t(at[0]), loop.coedges.end());
    const std::size_t second = at[1] - at[0], n = loop.coedges.size();
    std::vector<Coedge> swapped;
    const auto append = [&](std::size_t from, std::size_t to, double by) {
        Vec<2> shift{};
        shift[along] = by * turn;
        for (std::size_t i = to; i-- > from;) {
            Coedge c = loop.coedges[i];
            c.reversed = !c.reversed;
            c.curve = translated(c.curve, shift);
            swapped.push_back(std::move(c));
        }
    };
    swapped.push_back(loop.coedges[0]);
    append(second + 1, n, turns[0][along]);
    swapped.push_back(loop.coedges[second]);
    append(1, second, -turns[0][along]);
    loop.coedges = std::move(swapped);
}

void remove_bridges(Loop& loop, const std::vector<Edge>& edges, const std::array<double, 2>& period) {
    Vec<2> sum{}, crossed{};
    Loop left;
    for (const Coedge& c : loop.coedges) {
        const auto turns = periods_of(c, edges[std::size_t(c.edge)], period);
        if (!turns) {
            left.coedges.push_back(c);
            left.coedges.back().curve = translated(c.curve, {{-sum[0] * period[0], -sum[1] * period[1]}});
            continue;
        }
        sum += *turns;
        for (int k = 0; k < 2; ++k) crossed[k] += std::abs((*turns)[k]);
    }
    if (sum[0] != 0 || sum[1] != 0) return;
    const Extent with = extent_of(loop, edges), without = extent_of(left, edges);
    bool over = false;
    double turn = 0;
    for (int k = 0; k < 2; ++k) {
        if (!(crossed[k] > 0 && with.box.side(k).length() > (1 + kNear) * period[std::size_t(k)])) continue;
        over = true;
        turn = std::max(turn, period[std::size_t(k)] * with.box.side(1 - k).length());
    }
    const double same_side = with.area < 0 ? -without.area : without.area;
    if (over && same_side > kSliver * turn) loop = std::move(left);
}

bool enclose_less_than_nothing(const std::vector<Loop>& loops, const std::vector<Edge>& edges) {
    Box<2> box;
    double area = 0;
    std::vector<Vec<2>> open;
    for (const Loop& l : loops) {
        const Extent one = extent_of(l, edges);
        box.add(one.box.lo), box.add(one.box.hi);
        area += one.area;
        open.push_back(one.open);
    }
    const Vec<2> size = box.hi - box.lo;
    for (const Vec<2>& by : open)
        if (!(std::abs(by[0]) <= kSliver * size[0] && std::abs(by[1]) <= kSliver * size[1])) return false;
    return area < -kSliver * size[0] * size[1];
}

}  // namespace freiform::occt
