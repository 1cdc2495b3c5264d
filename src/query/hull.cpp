// Convex hulls in the plane.
//
// Method. Points sorted by x, then y; lower and upper chain each keep only left turns [Andrew 1979]. The turn
// is decided by orient2d, so the result is the hull of the given doubles.
// Cost. n log n for sorting, at most 2 n turns.
#include <freiform/core/sort.hpp>
#include <freiform/poly/predicates.hpp>
#include <freiform/query/hull.hpp>

#include <algorithm>
#include <numeric>

namespace freiform {

Result<std::vector<int>> convex_hull(std::span<const Vec<2>> points) {
    for (std::size_t i = 0; i < points.size(); ++i)
        if (!is_finite(points[i]))
            return refuse(RefusalKind::nonfinite, text("points[", i, "]"),
                          "has a coordinate that is not finite");
    std::vector<int> order(points.size());
    std::iota(order.begin(), order.end(), 0);
    const auto at = [&](int i) -> const Vec<2>& { return points[std::size_t(i)]; };
    sort(order.begin(), order.end(), [&](int a, int b) {
        return at(a)[0] != at(b)[0]   ? at(a)[0] < at(b)[0]
               : at(a)[1] != at(b)[1] ? at(a)[1] < at(b)[1]
                                      : a < b;
    });
    order.erase(std::unique(order.begin(), order.end(), [&](int a, int b) { return at(a) == at(b); }),
                order.end());
    if (order.size() < 3) return order;
    std::vector<int> hull;
    for (const int pass : {0, 1}) {
        const std::size_t base = hull.size();
        for (const int i : order) {
            while (hull.size() >= base + 2 &&
                   orient2d(at(hull[hull.size() - 2]), at(hull.back()), at(i)) <= 0)
                hull.pop_back();
            hull.push_back(i);
        }
        hull.pop_back();  // the first of the other chain
        if (pass == 0) std::reverse(order.begin(), order.end());
    }
    return hull;
}

std::vector<LocalHull> local_hulls(const BSplineBasis& basis) {
    std::vector<LocalHull> all;
    const std::vector<double> breaks = basis.breaks();
    for (std::size_t i = 0; i + 1 < breaks.size(); ++i)
        all.push_back({{breaks[i], breaks[i + 1]}, basis.span(breaks[i]) - basis.degree()});
    return all;
}

}  // namespace freiform
