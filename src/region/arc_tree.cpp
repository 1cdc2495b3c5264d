// Idea. Arcs that follow each other along a path are a run. If the convex hull of a run does not contain a
// point, the run can be drawn straight within its hull without passing over the point: it goes round it as
// the line from its first to its last point does. So a whole run is answered for by one line, a closed one by
// nothing, and only runs around the point are taken apart.
//
// Method. Runs are halved until they are arcs; above them runs are parted at the median of the middles of
// their boxes. What stands for the hull is a box, and for runs a turned box too: its axes are the chord of
// the run or those of a half, whichever are tighter. Long slanted arcs side by side, the spikes of a star,
// have boxes that all overlap, and turned boxes that do not.
//
// Cost. n log n to build. A point takes some log n where hulls of runs of equal length overlap little; where
// paths are cut into runs that do not close (after cancel_opposite), one step for each of those that are
// beside the point at its height.
//
// Accuracy. quarters() is exact: boxes are compared as they are. A product of a point and an axis rounds by
// 2^-51 of the largest coordinate M, boxes of conics by as much, an axis is off from length 1 and from the
// other one by 2^-51, corners of turned boxes by 2^-49 M. Together less than 2^-47 M, which is the slack.
//
// Why not strips of equal height? A probe looks at everything in one: n / 10 arcs of a star with n spikes.
#include "arc_tree_detail.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/poly/arc_index.hpp>

#include <algorithm>
#include <cmath>

namespace freiform::detail {

namespace {

constexpr double kTurnedError = 0x1p-47;

Vec<2> left_of(const Vec<2>& d) { return {{-d[1], d[0]}}; }

bool apart(const Interval& a, const Interval& b, double slack) {
    return a.lo > b.hi + slack || b.lo > a.hi + slack;
}

// Of the line from a to b about p.
std::optional<int> quarters_of_line(const Vec<2>& a, const Vec<2>& b, const Vec<2>& p) {
    const auto side = [&](double y) { return int(y > p[1]) - int(y < p[1]); };
    const int up = side(b[1]) - side(a[1]);
    if (up == 0 && side(a[1]) != 0) return 0;
    if (a[0] > p[0] && b[0] > p[0]) return up;
    if (a[0] < p[0] && b[0] < p[0]) return -up;
    const std::array<double, 2> x{a[0], b[0]}, y{a[1], b[1]};
    const ArcIndex index = arc_index(x, y, {}, p);
    if (index.through) return {};
    return index.quarters;
}

}  // namespace

ArcTree::ArcTree(std::span<const RegionArc> arcs) {
    std::vector<Run> runs;
    double scale = 0;
    for (std::size_t i = 0; i < arcs.size(); ++i) {
        scale = std::max(scale, arcs[i].box.scale());
        if (i == 0 || arcs[i].operand != arcs[i - 1].operand || arcs[i].s.front() != arcs[i - 1].s.back() ||
            arcs[i].place[0] != arcs[i - 1].place[0])
            runs.push_back({i, 0, {}});
        ++runs.back().count;
        runs.back().box.add(arcs[i].box);
    }
    slack_ = kTurnedError * scale;
    nodes_.reserve(2 * arcs.size());
    if (!runs.empty()) add_runs(arcs, runs);
}

void ArcTree::add_runs(std::span<const RegionArc> arcs, std::span<Run> runs) {
    if (runs.size() == 1) return add_run(arcs, runs[0].first, runs[0].count);
    const std::size_t k = nodes_.size();
    Node node;
    Box<2> middles;
    const auto middle = [](const Run& r, int d) { return r.box.side(d).middle(); };
    node.count = 0, node.is_run = false;
    for (const Run& r : runs) {
        node.box.add(r.box), node.count += r.count;
        middles.add(Vec<2>{{middle(r, 0), middle(r, 1)}});
    }
    nodes_.push_back(node);
    const int d = middles.side(0).length() < middles.side(1).length();
    const std::size_t half = runs.size() / 2;
    std::ranges::nth_element(runs, runs.begin() + std::ptrdiff_t(half), {},
                             [&](const Run& r) { return std::pair(middle(r, d), r.first); });
    add_runs(arcs, runs.first(half));
    nodes_[k].second = nodes_.size();
    add_runs(arcs, runs.subspan(half));
    nodes_[k].is_closed = nodes_[k + 1].is_closed && nodes_[nodes_[k].second].is_closed;
}

void ArcTree::add_run(std::span<const RegionArc> arcs, std::size_t first, std::size_t count) {
    const std::size_t k = nodes_.size();
    Node node;
    node.arc = first, node.count = count;
    node.is_closed = arcs[first].s.front() == arcs[first + count - 1].s.back();
    for (std::size_t i = first; i < first + count; ++i) node.box.add(arcs[i].box);
    nodes_.push_back(node);
    if (count > 1) {
        add_run(arcs, first, count / 2);
        nodes_[k].second = nodes_.size();
        add_run(arcs, first + count / 2, count - count / 2);
    }
    add_axes(arcs, k);
}

void ArcTree::add_axes(std::span<const RegionArc> arcs, std::size_t k) {
    Node& node = nodes_[k];
    const auto run = arcs.subspan(node.arc, node.count);
    const Vec<2> chord = unit(run.back().s.back() - run.front().s.front());
    std::vector<Vec<2>> candidates{max_abs(chord) > 0 ? chord : Vec<2>{{1, 0}}};
    if (!node.is_leaf())
        for (const std::size_t child : {k + 1, node.second}) candidates.push_back(nodes_[child].axes[0]);
    double least = kInfinity;
    for (const Vec<2>& x : candidates) {
        const std::array<Vec<2>, 2> axes{x, left_of(x)};
        std::array<Interval, 2> on{{{kInfinity, -kInfinity}, {kInfinity, -kInfinity}}};
        for (const RegionArc& arc : run)
            for (std::size_t i = 0; i <= std::size_t(arc.s.degree); ++i)
                for (std::size_t d = 0; d < 2; ++d) {
                    const double at = dot(axes[d], arc.s.points[i]);
                    on[d] = hull(on[d], {at, at});
                }
        if (const double width = std::min(on[0].length(), on[1].length()); width < least)
            least = width, node.axes = axes, node.on = on;
    }
}

bool ArcTree::Node::is_apart(const Vec<2>& p, const Vec<2>& q, double slack) const {
    for (int d = 0; d < 2; ++d)
        if (apart(box.side(d), {std::min(p[d], q[d]), std::max(p[d], q[d])}, slack)) return true;
    if (!is_run) return false;
    for (std::size_t d = 0; d < 2; ++d) {
        const double a = dot(axes[d], p), b = dot(axes[d], q);
        if (apart(on[d], {std::min(a, b), std::max(a, b)}, slack)) return true;
    }
    return false;
}

bool ArcTree::are_apart(const Node& a, const Node& b) const {
    if (!a.box.side(0).overlaps(b.box.side(0)) || !a.box.side(1).overlaps(b.box.side(1))) return true;
    if (!a.is_run || !b.is_run) return false;
    const auto parts = [&](const Node& x, const Node& y) {
        for (std::size_t d = 0; d < 2; ++d) {
            const double u = dot(x.axes[d], y.axes[0]), v = dot(x.axes[d], y.axes[1]);
            const Interval s{std::min(u * y.on[0].lo, u * y.on[0].hi),
                             std::max(u * y.on[0].lo, u * y.on[0].hi)},
                t{std::min(v * y.on[1].lo, v * y.on[1].hi), std::max(v * y.on[1].lo, v * y.on[1].hi)};
            if (apart(x.on[d], {s.lo + t.lo, s.hi + t.hi}, slack_)) return true;
        }
        return false;
    };
    return parts(a, b) || parts(b, a);
}

std::optional<std::array<int, 2>> ArcTree::quarters(std::span<const RegionArc> arcs, const Vec<2>& p) const {
    std::array<int, 2> sums{};
    const double slack = std::max(slack_, kTurnedError * max_abs(p));
    std::vector<std::size_t> todo = roots();
    while (!todo.empty()) {
        const std::size_t k = todo.back();
        todo.pop_back();
        const Node& node = nodes_[k];
        if (!node.box.side(1).contains(p[1])) continue;  // all lines between its points are above or below
        const RegionArc &first = arcs[node.arc], &last = arcs[node.arc + (node.is_run ? node.count - 1 : 0)];
        const bool beside = !node.box.contains(p) || (node.is_run && node.is_apart(p, p, slack));
        if (beside && node.is_closed) continue;
        if (beside && node.is_run) {
            const auto line = quarters_of_line(first.s.front(), last.s.back(), p);
            if (!line) return {};
            sums[std::size_t(first.operand)] += *line;
        } else if (node.is_leaf()) {
            const ArcIndex index =
                arc_index(first.coordinates(first.x), first.coordinates(first.y), first.weights(), p);
            if (index.through) return {};
            sums[std::size_t(first.operand)] += index.quarters;
        } else {
            todo.push_back(node.second), todo.push_back(k + 1);
        }
    }
    return sums;
}

}  // namespace freiform::detail
