// The grid of a tree: what its leaves say, noted in equal cells.
#include "curvature_tree_detail.hpp"

#include <freiform/core/constants.hpp>

namespace freiform {

namespace {

// Calls look(leaf) for those of some box: others are of none (curvature_tree_parts.cpp).
void each_leaf(const auto& nodes, auto&& look) {
    nodes.each_place([&](std::size_t i) {
        if (const auto& n = nodes[i]; n.child < 0 && !n.box.is_empty()) look(n);
    });
}

}  // namespace

void CurvatureTree::plan_grid() {
    double leaves = 0;
    Vec<2> sum{};
    each_leaf(nodes_, [&](const Node& n) { sum += n.box.hi - n.box.lo, ++leaves; });
    constexpr double kFewLeaves = 256;  // to walk past
    if (!is_all_plain() && leaves >= kFewLeaves) grid_ = BoundsGrid(nodes_[0].box, (1 / leaves) * sum);
}

void CurvatureTree::fill_grid(int group, int groups) {
    if (grid_.is_empty()) return;
    each_leaf(nodes_, [&](const Node& n) {
        grid_.include(n.box, group, groups, [&]() -> BoundsGrid::Bounds {
            const Curvature c = n.outside ? Curvature{kInfinity, kInfinity, kInfinity} : bending(n).full;
            return {c.uu, c.uv, c.vv, n.inside ? 0.0 : 1.0};
        });
    });
}

}  // namespace freiform
