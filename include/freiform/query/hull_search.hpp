// The convex hull of a tree of parts, from outside.
//
// A side is as in pair_search.hpp: parts within the hull of their points but for `slack`. Besides
//     is_box(i)      the part is a box of parts, whose points say nothing of the object
//     apart(i, k)    bound: how far point k of the part is from the hull of the object, but for `slack`
// The hull A of all points contains the object but for the slacks. The distance from the hull of the object
// is a convex function, so over A it is largest at a corner of A; the parts that own corners which are too
// far away are halved until there are none.
#pragma once
#include <freiform/core/sort.hpp>
#include <freiform/query/hull.hpp>
#include <freiform/query/pair_search.hpp>

namespace freiform::detail {

// The points that matter of some, and the sides or triangles of their hull; none where it has no interior.
template <int D>
struct PointHull {
    explicit PointHull(std::span<const Vec<D>> points);
    std::vector<int> corners;
    std::vector<std::array<int, D>> facets;
};

// A hull that contains all within `margin` of the hull of the points: blown up about its middle, or, where
// that is too thin, with a cube around every corner. slack: how far it reaches beyond the hull of the points.
template <int D>
ConvexHull<D> grown(std::span<const Vec<D>> points, const PointHull<D>& hull, double margin);

template <int D, class Side>
ConvexHull<D> hull_of_parts(Side& side, double tolerance, double slip, int max_parts) {
    std::vector<int> leaves{0};
    for (std::size_t i = 0; i < leaves.size();) {
        if (!side.is_box(leaves[i]) || !side.split(leaves[i])) {
            ++i;
            continue;
        }
        const PairPart<D> part = side.parts()[std::size_t(leaves[i])];
        leaves[i] = part.first;
        for (int k = part.first + 1; k < part.end; ++k) leaves.push_back(k);
    }
    for (;;) {
        std::vector<Vec<D>> points;
        std::vector<std::pair<int, int>> owner;  // part, point of it
        double slack = 0, scale = 0, farthest = 0;
        for (const int i : leaves) {
            const PairPart<D>& part = side.parts()[std::size_t(i)];
            slack = std::max(slack, part.slack);
            scale = std::max(scale, part.box.scale());
            for (int k = 0; const Vec<D>& x : side.hull(i)) points.push_back(x), owner.push_back({i, k++});
        }
        // On a grid that is coarser than what orient3d has to look at twice: tilted planes stay quick.
        const double grid = scale > 0 ? std::scalbn(1.0, std::ilogb(scale) - 45) : 1;
        for (Vec<D>& p : points)
            for (int k = 0; k < D; ++k) p[k] = std::nearbyint(p[k] / grid) * grid;
        const PointHull<D> hull(points);
        std::vector<int> open;
        for (const int corner : hull.corners) {
            const auto [i, k] = owner[std::size_t(corner)];
            const double apart = side.apart(i, k);
            farthest = std::max(farthest, apart);
            if (apart > tolerance) open.push_back(i);
        }
        sort(open);
        bool any = false;
        std::vector<int> next;
        for (const int i : leaves) {
            if (int(next.size()) < max_parts && std::ranges::binary_search(open, i) && side.split(i)) {
                const PairPart<D> part = side.parts()[std::size_t(i)];
                for (int k = part.first; k < part.end; ++k) next.push_back(k);
                any = true;
            } else {
                next.push_back(i);
            }
        }
        leaves = std::move(next);
        if (any && int(leaves.size()) < max_parts) continue;
        // What the corners may be off counts twice: A is moved by it, and the object's hull is as far from
        // it.
        const double off = slack + slip + grid;
        ConvexHull<D> out = grown<D>(points, hull, off);
        out.slack = (out.slack + farthest + off) * (1 + 0x1p-40);
        return out;
    }
}

}  // namespace freiform::detail
