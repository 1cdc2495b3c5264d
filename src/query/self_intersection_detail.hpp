// The search for self-intersections, of several closed chains at once.
#pragma once
#include <freiform/query/self_intersection.hpp>

#include <optional>
#include <span>

namespace freiform::detail {

// As self_intersections. The chain may jump (knots of multiplicity degree + 1); over each interval of `closed`
// it comes back to where it began, which is not listed. What is certain is so for all coefficients of piece i
// that are off by at most errors[i]. Nothing if more than max_pairs pairs of pieces are near each other. REQUIRES
// an accuracy > 0, an error for each piece.
std::optional<std::vector<SelfIntersection<2>>> meetings_of_chain(const Curve<Hom<2>>& chain,
                                                   std::span<const Interval> closed,
                                                   std::span<const double> errors, double accuracy,
                                                   int max_pairs);

}  // namespace freiform::detail
