// What is written of a model in place of what it holds, where a file cannot say which part of it is meant.
#pragma once
#include <freiform/model/model.hpp>

#include <optional>

namespace freiform::detail {

// The parameter curve on a flat surface with linear parameters, as a curve in space.
std::optional<CurveGeometry<3>> lifted(const CurveGeometry<2>& curve, const SurfaceGeometry& s);

// The curve of the edge in space; of splines the part that the edge is. REQUIRES e.curve.
CurveGeometry<3> part_of(const Edge& e);

// The surface of a face with one turn, if it has more; parameter curves of the face may be beyond it.
std::optional<SurfaceGeometry> one_turn(const Model& m, const Face& f);

// The loops of a face without edges that have no curve in space and that a loop runs along there and back;
// these are added to `left_out`. Loops of poles alone are left out, too, if there is any other.
std::vector<Loop> without_seams(const Model& m, const Face& f, std::vector<int>& left_out);

}  // namespace freiform::detail
