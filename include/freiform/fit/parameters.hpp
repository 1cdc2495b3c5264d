// Parameters for points that come without: where on a curve, or on the lines of a net, they are to lie.
#pragma once
#include <freiform/core/net.hpp>
#include <freiform/core/vec.hpp>

#include <span>
#include <string_view>
#include <vector>

namespace freiform {

enum class Spacing {
    uniform,      // 0, 1, 2, ...
    chordal,      // lengths of the polygon: the curve gets nearly unit speed
    centripetal,  // sums of square roots of chord / longest chord: calmer at sharp turns
};
std::string_view name_of(Spacing spacing);

// One parameter for each point, increasing from 0; of a closed polygon one more, the period. Needs 2 points.
// Refuses points that are not finite, and (unless uniform) equal neighbours, by index.
//   auto at = parameters(std::span(points), Spacing::chordal);
template <int D>
Result<std::vector<double>> parameters(std::span<const Vec<D>> points, Spacing spacing, bool closed = false);

// Along one axis of a net: the mean over its lines, each scaled to the same range and weighted by its length.
// A line that is one point (a pole) has no weight. Refuses where no line leads from one layer to the next.
template <std::size_t N, int D>
Result<std::vector<double>> parameters(const Net<N, Vec<D>>& points, int axis, Spacing spacing,
                                       bool closed = false);

}  // namespace freiform
