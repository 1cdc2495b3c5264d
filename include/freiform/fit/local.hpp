// Cubic interpolation that looks at neighbours only: continuous first derivatives, and a point that moves
// moves the curve nearby alone. All of these give one Bezier piece between two points; the points are
// coefficients, so the curve goes through them exactly.
#pragma once
#include <freiform/basis/change.hpp>
#include <freiform/fit/parameters.hpp>
#include <freiform/spline/patch.hpp>

#include <span>
#include <vector>

namespace freiform {

// The map from m points at increasing parameters `at` (closed: m + 1, the last one the end of the period) to
// Bezier coefficients. The derivative at a point is that of the parabola through it and its neighbours; for
// at = 0, 1, 2, .. this is (Q_{i+1} - Q_{i-1}) / 2. At open ends f'' = 0, that is P_2 = (P_1 + P_3) / 2.
// Every parameterisation is allowed: uniform is the classical spline of Catmull and Rom. Linear in the
// points, so it extends to grids. Needs 2 points.
Result<Change<BSplineBasis>> catmull_rom(std::span<const double> at, bool closed = false);

// Along all axes of a grid: bicubic Bezier patches for N = 2.
//   auto s = catmull_rom<2, 3>(grid, {u, v}, {false, true});
template <std::size_t N, int D>
Result<Patch<N, Vec<D>>> catmull_rom(const Net<N, Vec<D>>& points,
                                     const std::array<std::span<const double>, N>& at,
                                     const std::array<bool, N>& closed = {});

// The cubic pieces with these points and derivatives.
template <int D>
Result<Curve<Vec<D>>> cubic_through(std::span<const Vec<D>> points, std::span<const Vec<D>> derivatives,
                                    std::span<const double> at, bool closed = false);

enum class LocalSlopes {
    akima,     // weighted by how much the slopes change on either side: no overshoot beside a bend
    monotone,  // each coordinate rises and falls only where its points do, and is extreme at points only
    fritsch_carlson,  // the same promise; parabolas' slopes (catmull_rom), only as much shortened as it needs
};

// Derivatives for cubic_through, coordinate by coordinate. Needs 2 points.
template <int D>
Result<std::vector<Vec<D>>> local_slopes(std::span<const Vec<D>> points, std::span<const double> at,
                                         LocalSlopes kind, bool closed = false);

}  // namespace freiform
