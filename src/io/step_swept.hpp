// Pieces of regions that solids of STEP files sweep.
#pragma once
#include <freiform/model/swept_solid.hpp>

namespace freiform::step {

CurveGeometry<2> segment(const Vec<2>& a, const Vec<2>& b);
Result<std::vector<CurveGeometry<2>>> circle_about(const Vec<2>& centre, double radius);

}  // namespace freiform::step
