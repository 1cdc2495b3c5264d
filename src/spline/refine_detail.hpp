// How far a spline is from one with fewer knots or of lower degree.
#pragma once
#include "coefficients_detail.hpp"

namespace freiform::detail {

// A bound of the distance of the spline with coefficients `old` from the one with coefficients A `fresh`,
// `image` being the computed A `fresh`; infinite where the weights allow none. `degree`: the higher one.
// Argument in refine.cpp.
double distance_bound(int degree, const Tuples& old, const Tuples& fresh, const Tuples& image);

}  // namespace freiform::detail
