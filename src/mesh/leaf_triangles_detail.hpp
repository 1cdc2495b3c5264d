// Triangles of a rectangle with points on its sides.
#pragma once
#include <freiform/core/vec.hpp>

#include <array>
#include <span>
#include <vector>

namespace freiform {

inline constexpr std::size_t kMostAround = 24;

// Appends the triangles (by places in `around`) of a convex polygon whose points may lie on its sides, at
// most kMostAround of them, counter-clockwise: the least well shaped of them is as well shaped as it can be.
// False if there are none with area.
bool add_best_triangles(std::span<const Vec<2>> around, std::vector<std::array<int, 3>>& triangles);

}  // namespace freiform
