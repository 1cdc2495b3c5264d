// Branches from settled cells. Every simple cell has no or two crossed sides, each of which it shares with
// one other cell, an open one, or the boundary: so cells and sides make paths, which are the branches.
#include "level_links_detail.hpp"

#include <set>

namespace freiform::detail {

LevelLinks::LevelLinks(const Index<2>& count, const std::array<bool, 2>& whole)
    : count_(count), whole_(whole) {}

double LevelLinks::canonical(int axis, double x) const {
    const std::size_t k = std::size_t(axis);
    // Only the last line of a cyclic axis is the first one again; the sum is exact.
    if (!whole_[k] || lines_[k].empty() || x < count_[k]) return x;
    return x == lines_[k].begin()->first + count_[k] ? lines_[k].begin()->first : x;
}

void LevelLinks::add(LevelCell&& cell, LevelState state) {
    for (int a = 0; a < 2; ++a)
        for (int b = 0; b < 2; ++b) {
            const double x = a ? cell.on[0].hi : cell.on[0].lo, y = b ? cell.on[1].hi : cell.on[1].lo;
            const int sign =
                state == LevelState::clear ? cell.blocks[0].c[0] > 0 ? 1 : -1 : cell.corner_sign(a, b);
            int& at_line = lines_[0][x][y];
            int& on_line = lines_[1][y][x];
            if (sign) at_line = on_line = sign;
        }
    if (state != LevelState::clear) held_.push_back({std::move(cell), state, {}});
}

template <class F>
void LevelLinks::each_side(const LevelCell& cell, F&& f) {
    for (int axis = 0; axis < 2; ++axis) {
        const Interval across = cell.on[std::size_t(axis)], along = cell.on[std::size_t(1 - axis)];
        for (const double line : {across.lo, across.hi}) {
            Vertices& all = lines_[std::size_t(axis)][canonical(axis, line)];
            auto v = all.lower_bound(along.lo);
            for (auto next = std::next(v); next != all.end() && next->first <= along.hi; v = next++)
                f(Side{axis, canonical(axis, line), v->first, next->first}, v->second, next->second);
        }
    }
}

// Both sides of a seam are one line of vertices.
static void join_seam(std::array<std::map<double, std::map<double, int>>, 2>& lines,
                      const std::array<bool, 2>& whole, const Index<2>& count) {
    for (std::size_t k = 0; k < 2; ++k) {
        if (!whole[k] || lines[k].empty()) continue;
        auto& first = lines[k].begin()->second;
        const auto last = lines[k].find(lines[k].begin()->first + count[k]);
        if (last == lines[k].end()) continue;
        for (const auto& [at, sign] : last->second) {
            int& known = first[at];
            if (sign) known = sign;
        }
    }
}

// The line of a side of a cell, as the cell counts places.
double LevelLinks::line_of(const Side& side, const LevelCell& cell) const {
    const Interval on = cell.on[std::size_t(side.axis)];
    return canonical(side.axis, on.lo) == side.line ? on.lo : on.hi;
}

bool LevelLinks::look_at_sides(Held& held) {
    held.crossed.clear();
    bool known = true;
    each_side(held.cell, [&](const Side& side, int& s, int& t) {
        const double here = line_of(side, held.cell);
        const auto look = [&](double along, int& sign) {
            if (sign == 0) sign = held.cell.sign_at(side.axis == 0 ? Place{here, along} : Place{along, here});
            known = known && sign != 0;
        };
        look(side.lo, s);
        look(side.hi, t);
        if (s != t) held.crossed.push_back(side);
    });
    return known && (held.crossed.empty() || held.crossed.size() == 2);
}

void LevelLinks::gather_nodes(LevelSet& out) {
    // Those that share a vertex are one.
    std::vector<int> root(held_.size());
    for (std::size_t i = 0; i < root.size(); ++i) root[i] = int(i);
    const auto find = [&](int i) {
        while (root[std::size_t(i)] != i) i = root[std::size_t(i)] = root[std::size_t(root[std::size_t(i)])];
        return i;
    };
    std::map<Place, int> at;
    for (std::size_t i = 0; i < held_.size(); ++i) {
        if (!is_open(i)) continue;
        each_side(held_[i].cell, [&](const Side& side, int, int) {
            open_at_.try_emplace(side.key(), int(i));
            for (const double along : {side.lo, side.hi}) {
                const double other = canonical(1 - side.axis, along);
                const Place p = side.axis == 0 ? Place{side.line, other} : Place{other, side.line};
                const auto [old, is_new] = at.try_emplace(p, int(i));
                if (!is_new) root[std::size_t(find(int(i)))] = find(old->second);
            }
        });
    }
    std::set<int> unknown;
    for (std::size_t i = 0; i < held_.size(); ++i)
        if (is_open(i) && held_[i].state != LevelState::open) unknown.insert(find(int(i)));
    node_of_.assign(held_.size(), -1);
    std::map<int, int> index;
    for (std::size_t i = 0; i < held_.size(); ++i) {
        if (!is_open(i)) continue;
        const LevelCell& cell = held_[i].cell;
        if (unknown.contains(find(int(i)))) {
            node_of_[i] = -2;
            if (held_[i].state != LevelState::flat) out.undecided.push_back(cell.on);
            continue;
        }
        const auto [it, is_new] = index.try_emplace(find(int(i)), int(out.nodes.size()));
        if (is_new) out.nodes.push_back({cell.on, 0, 0, 0});
        node_of_[i] = it->second;
        LevelNode& node = out.nodes[std::size_t(it->second)];
        for (std::size_t k = 0; k < 2; ++k) {
            // Beside the seam a cell may be a period away.
            Interval on = cell.on[k];
            if (whole_[k] && std::abs(on.lo - node.box[k].lo) > 0.5 * count_[k]) {
                const double by = on.lo > node.box[k].lo ? -count_[k] : count_[k];
                on = {on.lo + by, on.hi + by};
            }
            node.box[k] = hull(node.box[k], on);
        }
    }
}

// The function is monotone along the side and has opposite signs at its ends.
Place LevelLinks::zero_on(const Side& side, const LevelCell& cell) const {
    const double line = line_of(side, cell);
    const auto place = [&](double t) { return side.axis == 0 ? Place{line, t} : Place{t, line}; };
    const auto value = [&](double t) { return level_value(cell.block_at(place(t)), place(t)).value; };
    double lo = side.lo, hi = side.hi;
    const bool rises = value(hi) > value(lo);
    for (int i = 0; i < 100; ++i) {
        const double mid = lo + (hi - lo) / 2;
        if (!(lo < mid && mid < hi)) break;
        ((value(mid) > 0) == rises ? hi : lo) = mid;
    }
    return place(lo + (hi - lo) / 2);
}

void LevelLinks::walk(int first, int from, bool closed, LevelSet& out) {
    LevelBranch branch;
    branch.closed = closed;
    Place shift{};
    const auto end_of = [&](const Side& side) {
        const auto open = open_at_.find(side.key());
        return open == open_at_.end() ? -1 : node_of_[std::size_t(open->second)];
    };
    branch.node[0] = closed ? -1 : end_of(held_[std::size_t(first)].crossed[std::size_t(from)]);
    for (int i = first;;) {
        const Held& held = held_[std::size_t(i)];
        done_[std::size_t(i)] = 1;
        const Side &in = held.crossed[std::size_t(from)], &leave = held.crossed[std::size_t(1 - from)];
        const Place a = zero_on(in, held.cell), b = zero_on(leave, held.cell);
        for (std::size_t k = 0; k < 2 && !branch.at.empty(); ++k) {
            // A seam was crossed: whole periods.
            shift[k] = count_[k] * std::round((branch.at.back()[k] - a[k]) / count_[k]);
        }
        if (branch.at.empty()) branch.at.push_back(a);
        branch.at.push_back({b[0] + shift[0], b[1] + shift[1]});
        branch.shift.push_back(shift);
        branch.cells.push_back(int(out.cells.size()));
        out.cells.push_back(held.cell);
        const auto& both = crossed_by_[leave.key()];
        const int next = both.size() < 2 ? -1 : both[0] == i ? both[1] : both[0];
        if (next < 0) {
            branch.node[1] = end_of(leave);
            break;
        }
        if (closed && next == first) break;
        const auto& sides = held_[std::size_t(next)].crossed;
        from = sides[0].key() == leave.key() ? 0 : 1;
        i = next;
    }
    for (const int node : branch.node)
        if (node >= 0) ++out.nodes[std::size_t(node)].arms;
    out.branches.push_back(std::move(branch));
}

void LevelLinks::link(LevelSet& out) {
    for (std::size_t i = 0; i < held_.size(); ++i)
        if (held_[i].state == LevelState::simple)
            for (const Side& side : held_[i].crossed) crossed_by_[side.key()].push_back(int(i));
    done_.assign(held_.size(), 0);
    const auto is_left = [&](std::size_t i) {
        return held_[i].state == LevelState::simple && !held_[i].crossed.empty() && !done_[i];
    };
    for (std::size_t i = 0; i < held_.size(); ++i)
        for (int side = 0; side < 2 && is_left(i); ++side)
            if (crossed_by_[held_[i].crossed[std::size_t(side)].key()].size() == 1)
                walk(int(i), side, false, out);
    for (std::size_t i = 0; i < held_.size(); ++i)
        if (is_left(i)) walk(int(i), 0, true, out);
}

void LevelLinks::finish(LevelSet& out) {
    join_seam(lines_, whole_, count_);
    for (bool changed = true; changed;) {
        changed = false;
        for (Held& held : held_)
            if (held.state == LevelState::simple && !look_at_sides(held))
                held.state = LevelState::open, changed = true;
    }
    gather_nodes(out);
    link(out);
}

}  // namespace freiform::detail
