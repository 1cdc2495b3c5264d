// What patches ask of their coefficients and parameters, and how they refuse them: compiled once for all
// patches.
#pragma once
#include <freiform/basis/band_map.hpp>
#include <freiform/core/interval.hpp>
#include <freiform/core/result.hpp>
#include <freiform/core/tuples.hpp>

#include <functional>
#include <span>
#include <string_view>
#include <vector>

namespace freiform::detail {

// What Patch::make asks of coefficients.
Result<void> check_coefficients(const Tuples& all);

// The largest |coordinate| of a point, and the smallest weight (infinite if there is none).
struct Reach {
    double coordinate = 0, weight = 0;
};
Reach reach_of(const Tuples& all);

// Refuses, as axes[axis][i], what is not finite or (`closed` bases apart) not in the domain.
Result<void> check_axis(std::span<const double> at, const Interval& domain, bool closed, std::size_t axis);

// The points of the net of the given extents after map(0), map(1) .. along its axes, which have as many rows
// as `rows` says.
Result<std::vector<double>> grid_of(const Tuples& net, std::span<const int> extent, std::span<const int> rows,
                                    const std::function<BandMap(std::size_t)>& map);

// The refusal of u, which is not a finite number or not in the domain, as name[first] or name[first][second].
std::unexpected<Refusal> bad_parameter(double u, const Interval& domain, std::string_view name,
                                       std::size_t first, std::ptrdiff_t second = -1);

}  // namespace freiform::detail
