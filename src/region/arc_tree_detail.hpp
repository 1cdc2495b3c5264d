// Arcs in a hierarchy of runs: which are near a segment or each other, and how they go round a point.
#pragma once
#include "arcs_detail.hpp"

#include <optional>
#include <vector>

namespace freiform::detail {

class ArcTree {
public:
    // Keeps none of the arcs; the functions below want the same ones.
    explicit ArcTree(std::span<const RegionArc> arcs = {});

    // Sums of the quarters of all arcs, by operand (poly/arc_index.hpp); nothing on an arc. Exact.
    std::optional<std::array<int, 2>> quarters(std::span<const RegionArc> arcs, const Vec<2>& p) const;

    // Calls `look` with arcs until it says false; returns whether it never did. Those that are left out are
    // farther from the segment pq than `slack`, which is at least kTouchError times the largest coordinate.
    template <class F>
    bool each_near(const Vec<2>& p, const Vec<2>& q, double slack, F&& look) const {
        std::vector<std::size_t> todo = roots();
        while (!todo.empty()) {
            const std::size_t k = todo.back();
            todo.pop_back();
            if (nodes_[k].is_apart(p, q, 2 * slack)) continue;
            if (!nodes_[k].is_leaf()) {
                todo.push_back(nodes_[k].second), todo.push_back(k + 1);
            } else if (!look(nodes_[k].arc)) {
                return false;
            }
        }
        return true;
    }

    // Calls `look(i, j)` with pairs of arcs until it says false, `step()` with each pair of nodes likewise.
    // Pairs that are left out do not meet.
    template <class F, class S>
    bool each_pair(F&& look, S&& step) const {
        std::vector<std::array<std::size_t, 2>> todo;
        for (const std::size_t k : roots()) todo.push_back({k, k});
        while (!todo.empty()) {
            const auto [k, l] = todo.back();
            todo.pop_back();
            if (!step()) return false;
            const Node &a = nodes_[k], &b = nodes_[l];
            if (k == l) {
                if (!a.is_leaf())
                    todo.insert(todo.end(), {{a.second, a.second}, {k + 1, a.second}, {k + 1, k + 1}});
            } else if (!are_apart(a, b)) {
                if (a.is_leaf() && b.is_leaf()) {
                    if (!look(a.arc, b.arc)) return false;
                } else if (b.is_leaf() || (!a.is_leaf() && a.count >= b.count)) {
                    todo.push_back({a.second, l}), todo.push_back({k + 1, l});
                } else {
                    todo.push_back({k, b.second}), todo.push_back({k, l + 1});
                }
            }
        }
        return true;
    }

private:
    // Neighbouring arcs of one operand, each beginning where the one before ends, or many such runs. The
    // first child is the next node.
    struct Node {
        Box<2> box;                      // of the exact curves
        std::array<Vec<2>, 2> axes{};    // of a run: orthogonal, of length 1
        std::array<Interval, 2> on{};    // along them, control points; within the slack of the tree
        std::size_t second = 0;          // child
        std::size_t arc = 0, count = 1;  // the first of a run
        bool is_run = true;
        bool is_closed = false;  // runs that end where they begin, all of them

        bool is_leaf() const { return count == 1; }
        bool is_apart(const Vec<2>& p, const Vec<2>& q, double slack) const;
    };
    std::vector<std::size_t> roots() const {
        return nodes_.empty() ? std::vector<std::size_t>{} : std::vector<std::size_t>{0};
    }
    struct Run {
        std::size_t first = 0, count = 0;
        Box<2> box;
    };
    bool are_apart(const Node& a, const Node& b) const;
    void add_runs(std::span<const RegionArc> arcs, std::span<Run> runs);
    void add_run(std::span<const RegionArc> arcs, std::size_t first, std::size_t count);
    void add_axes(std::span<const RegionArc> arcs, std::size_t node);

    std::vector<Node> nodes_;
    double slack_ = 0;
};

}  // namespace freiform::detail
