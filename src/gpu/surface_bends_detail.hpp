// How finely pieces have to be cut: essay in surface_bends.cpp.
#pragma once
#include "gpu/rational_pieces_detail.hpp"

#include <freiform/model/model.hpp>
#include <freiform/spline/simplex.hpp>

namespace freiform {

// Of columns and of rows of pieces, in model units: ceil(sqrt(bend / d)) cells in each direction keep every
// triangle within d of the surface. Infinite where there is no bound.
std::array<std::vector<double>, 2> bends_of(const Face& face, const SurfacePieces& pieces);
// The same of both directions of a triangle.
double bend_of(const SimplexPatch<2, Hom<3>>& triangle);

}  // namespace freiform
