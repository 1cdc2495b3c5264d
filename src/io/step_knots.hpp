// Knots of splines.
#pragma once
#include "step_fields.hpp"

#include <freiform/basis/bspline.hpp>

#include <string_view>
#include <utility>
#include <vector>

namespace freiform::step {

// Knots that are one, where the file has those between which nothing was left by its digits: of the control
// points of functions between them, which are 0, none is kept, and of two at a place inside one. `kept`: all,
// if it is empty. `joined`: of those two the one that is kept and the one that is not.
struct Knots {
    BSplineBasis basis;
    std::vector<int> kept;
    std::vector<std::pair<int, int>> joined;
};

// With their multiplicities written out. `what`: "CURVE" or "SURFACE", whose subtypes imply knots.
Result<Knots> knots_of(const File& f, std::uint32_t i, const Fields* with_knots, int multiplicities,
                       int knots, std::string_view what, int degree, int size);

// The rows of a net with these extents that are kept along an axis.
template <class T>
std::vector<T> kept_of(const std::vector<T>& net, std::array<std::size_t, 2> extent, int axis,
                       const std::vector<int>& kept) {
    if (kept.empty()) return net;
    std::vector<T> out;
    for (std::size_t r = 0; r < (axis == 0 ? kept.size() : extent[0]); ++r)
        for (std::size_t c = 0; c < (axis == 1 ? kept.size() : extent[1]); ++c)
            out.push_back(net[(axis == 0 ? std::size_t(kept[r]) : r) * extent[1] +
                              (axis == 1 ? std::size_t(kept[c]) : c)]);
    return out;
}
// Bound of what joining moves the spline by. Without weights: `weights` is empty.
double moved_by_joining(const std::vector<Vec<3>>& net, const std::vector<double>& weights,
                        std::array<std::size_t, 2> extent, int axis, const Knots& knots);

}  // namespace freiform::step
