// What can be decided exactly of a curve that comes near to itself.
#pragma once
#include <freiform/core/tuples.hpp>
#include <freiform/query/self_intersection.hpp>

#include <optional>

namespace freiform::detail {

// Says what an answer without a crossing is: its kind, `at` and `distance`. Given are kind (near or
// unresolved), first and second.
template <class P>
void describe(const Curve<P>& curve, SelfIntersection<Space<P>::kDim>& m);

// A coordinate without which the points of a plane, of three coordinates, are still told apart, where all
// these lie in one plane exactly and not on a line; else nothing.
std::optional<int> spare_coordinate(const Tuples& points);

}  // namespace freiform::detail
