// The three stages of the predicates, each on its own, so that tests can hold them against each other.
#pragma once
#include <freiform/core/vec.hpp>

#include <array>
#include <optional>

namespace freiform::detail {

// A determinant of points: orient2d for 3 of them, in_circle for 4.
template <std::size_t N>
using PlanePoints = std::array<Vec<2>, N>;

// The sign in plain doubles, where it is proved to be right.
std::optional<int> filtered_sign(const PlanePoints<3>& p);
std::optional<int> filtered_sign(const PlanePoints<4>& p);

// The sign by filter, then by expansions, after scaling by a power of two; nothing outside the exactness
// window.
std::optional<int> expansion_sign(PlanePoints<3> p);
std::optional<int> expansion_sign(PlanePoints<4> p);

// The sign in integers. REQUIRES: finite coordinates.
int integer_sign(const PlanePoints<3>& p);
int integer_sign(const PlanePoints<4>& p);

}  // namespace freiform::detail
