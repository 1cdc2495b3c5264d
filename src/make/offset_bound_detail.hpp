// How far a polynomial is from the offset of a Bezier patch: a proven bound.
#pragma once
#include <freiform/core/constants.hpp>
#include <freiform/core/hom.hpp>
#include <freiform/core/net.hpp>

namespace freiform::detail {

inline constexpr double kOffsetRounding = 64 * kUnitRoundoff;  // of coefficients, for each degree
inline constexpr int kMostOffsetDegree = 12;                   // of the base: products take its fourth power

// |h(s, t) - O(s, t)| over [0, 1]^2 is nowhere above this, O = base + distance n, of patches that Bernstein
// coefficients say; infinite where it is not known. `size`: coefficients of both are off by a few roundings
// of this. REQUIRES degrees of the base from 1 to kMostOffsetDegree, of h no higher.
template <class P>
double offset_bound(const NetView<2, const Vec<3>>& h, const NetView<2, const P>& base, double distance,
                    double size);

}  // namespace freiform::detail
