// Method. Halves by the better diagonal need a bound for two triangles alone (bending.cpp), not for all that
// a cell can be cut into: where curves of equal height do not run along parameter lines, that saves half of
// the cells and more. With other points on the sides of a cell there are more triangles than two: those of
// the best shape, if they keep the tolerance, and else those from its centre, which nearly always do. For
// sides a, b and diagonals c and d (what the quadratic form is along them) halves are off by a, b and c at
// least, centres by a, b, c / 4 and d / 4, and c + d = 2 (a + b).
#include "block_triangles_detail.hpp"

#include <algorithm>
#include <cmath>

namespace freiform {

void BlockTriangles::settle(MeshedLeaf& l, const JudgedBlock& of_leaf, Work& work) const {
    const auto attempt = [&](double& bound) {
        for (const bool has_centre : {false, true}) {
            if (std::isfinite(bound)) return true;
            l.has_centre = has_centre;
            bound = judged(l, work);
        }
        return std::isfinite(bound);
    };
    l.bound = l.count == 4 ? of_leaf.halves : of_leaf.usual;
    if (!l.is_plain && l.count != 4 && !std::isfinite(l.bound))
        l.bound = usual_of_leaf(tree_, judge_, tolerance_, tree_.block(l.block));
    l.flat = l.count == 4 ? of_leaf.flat_halves : of_leaf.flat;
    if (!l.is_plain && attempt(l.bound)) return;
    l.is_plain = true;
    attempt(l.flat);
}

double BlockTriangles::judged(const MeshedLeaf& l, Work& work) const {
    find(l, work);
    const auto block = tree_.block(l.block);
    double bound = 0;
    for (const auto& t : work.found) {
        std::array<Vec<2>, 3> corner;
        for (std::size_t k = 0; k < 3; ++k)
            corner[k] = t[k] == l.count ? middle_of(block.box)
                                        : points_[std::size_t(border_of(l)[std::size_t(t[k])])];
        bound =
            std::max(bound, judged(tree_.part_bendings(block)[0], block.node, corner, l.is_plain ? 3 : 0));
        if (!std::isfinite(bound)) break;
    }
    return bound;
}

double BlockTriangles::judged(const Bending& bends, int node, const std::array<Vec<2>, 3>& corner,
                              int plain) const {
    Box<2> box;
    for (const Vec<2>& p : corner) box.add(p);
    const double bound = judge_(bends, box, corner, plain, node, true).bound;
    return bound <= tolerance_ ? bound : kInfinity;
}

double BlockTriangles::bound_from_centres(const MeshedBlock& b) const {
    double bound = 0;
    const int row = b.grid.cells(1) - 1;
    each_border_cell(b.grid, b.step, [&](int i, int j, std::span<const int> around) {
        if (around.size() == 4 || !std::isfinite(bound)) return;
        const Bending& bends = tree_.part_bendings(b.of_tree)[b.ways.part_of(i, j)];
        const auto at = [&](int place) {
            if (place >= 0) return points_[std::size_t(b.border[std::size_t(place)])];
            return b.grid.at((-1 - place) / row + 1, (-1 - place) % row + 1);
        };
        for (std::size_t k = 0; k < around.size(); ++k)
            bound = std::max(
                bound, judged(bends, b.of_tree.node,
                              {at(around[k]), at(around[(k + 1) % around.size()]), b.grid.centre(i, j)}, 0));
    });
    return bound;
}

void BlockTriangles::find(const MeshedLeaf& l, Work& work) const {
    auto& [places, found] = work;
    if (l.has_centre) {
        found.clear();
        for (int k = 0; k < l.count; ++k) found.push_back({k, (k + 1) % l.count, l.count});
        return;
    }
    const auto block = tree_.block(l.block);
    const Bending& bends = tree_.part_bendings(block)[0];
    const Vec<2> size = block.box.hi - block.box.lo;
    if (l.count == 4) {
        if (bends.prefers_rising(size))
            found.assign({{0, 1, 2}, {0, 2, 3}});
        else
            found.assign({{0, 1, 3}, {1, 2, 3}});
        return;
    }
    places.clear();
    const Vec<2> scale =  // what makes parameters lengths
        bends.least > 0 ? Vec<2>{{bends.a, bends.b}} : Vec<2>{{1 / size[0], 1 / size[1]}};
    for (const int at : border_of(l)) {
        const Vec<2> x = points_[std::size_t(at)] - block.box.lo;
        places.push_back({{x[0] * scale[0], x[1] * scale[1]}});
    }
    found.clear();
    [[maybe_unused]] const bool has_area = add_best_triangles(places, found);
    FF_REQUIRE(has_area);
}

}  // namespace freiform
