// Lines of parameters that cut a rectangle into cells fine enough for quads: essay in grid.cpp.
#pragma once
#include <freiform/mesh/face_mesh.hpp>

#include <functional>

namespace freiform {

// What a strip between neighbouring lines asks for: up to 1 where it will do, else into how many it is to be
// cut. REQUIRES needs of the sizes of the strips; they become larger.
using StripNeeds = std::array<std::vector<double>, 2>;
void add_cell_needs(const DerivativeQuery<2, 3>& surface, const GridLines& lines, const FaceDemands& demands,
                    const std::function<bool(const Box<2>&)>& is_outside, StripNeeds& needs);

// The lines moved so that strips get equal shares of what they ask for, and as many more as that takes, none
// fewer; lines of `fixed` (a sorted part of them, the ends included) stay. Unchanged where no strip asks for
// more than 1. `halve`: strips that ask for more are halved instead.
std::vector<double> with_needs_met(std::span<const double> lines, std::span<const double> needs,
                                   std::span<const double> fixed, bool halve);

inline constexpr int kGridPasses = 5, kGridHalvings = 6;

// Lines for the part of `box` that is not outside; nothing beyond `max_cells`.
std::optional<GridLines> grid_lines(const DerivativeQuery<2, 3>& surface, const Box<2>& box,
                                    const FaceDemands& demands,
                                    const std::function<bool(const Box<2>&)>& is_outside, double max_cells);

// Triangles that are halves of one cell come first, in pairs (a, b, c), (a, c, d). How many pairs. `point` as
// in FaceMesh: the corners of a quad are four points.
int pair_halves(const GridLines& lines, std::span<const Vec<2>> uv, std::span<const int> point,
                std::vector<std::array<int, 3>>& triangles);

}  // namespace freiform
