// Compares a conversion with what it was made from, point by point.
#pragma once
#include "convert.hpp"

namespace freiform::occt {

// Prints one line to standard error: counts and the largest deviations. False if a surface or curve deviates
// by more than rounding, or an edge from a face by more than the tolerance that the model states.
bool verify(const Conversion& c, const std::string& name);

}  // namespace freiform::occt
