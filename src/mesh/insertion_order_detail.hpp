// In which order points enter a triangulation.
#pragma once
#include <freiform/core/vec.hpp>

#include <span>
#include <vector>

namespace freiform::detail {

// A permutation of the indices: rounds of doubling size with points drawn as if by chance, and each round
// along a Hilbert curve, so that a walk from the last point to the next is short [Amenta, Choi & Rote 2003].
// Chance depends on the index only, and the curve on coordinates relative to their largest: times a power of
// two gives the same order. REQUIRES: finite coordinates.
std::vector<int> insertion_order(std::span<const Vec<2>> points);

}  // namespace freiform::detail
