// Values to the last digit where the ordinary ones lose digits, each with its own bound.
//
//     Accurate<Vec<2>> out;
//     evaluate_accurate(curve, std::span(&t, 1), std::span(&out, 1));  // out.value, out.bound
//
// Patch::evaluate is backward stable: its error is at most value_error_bound(), 1.01 (6 p - 1) 2^-53 max|P_i|
// for a polynomial curve of degree p. Beside a value that is much smaller than the coefficients, as near a
// root, that may be all of it. evaluate_accurate works with twice the digits.
#pragma once
#include <freiform/spline/patch.hpp>

namespace freiform {

template <class Point>
struct Accurate {
    Point value{};
    // |value - exact| <= bound in each coordinate, rounding to double included; infinite where the
    // denominator cannot be told from 0. With positive weights at most half a unit in the last place of the
    // value plus 2^-92 max|P_i| (points, not weighted): so the value is the exact one rounded, or its
    // neighbour, unless it is smaller than 2^-38 max|P_i|; where it is, the bound says what is left.
    Point bound{};
};

// Of the map that the stored coefficients and knots define, at the parameters as given; parameters of closed
// bases are first moved into the domain as wrap() does, which is exact inside. REQUIRES out.size() ==
// at.size(). Refuses, with the index, parameters that are not finite or (on open bases) outside the domain.
template <std::size_t N, Coefficient P, Basis B>
Result<void> evaluate_accurate(const Patch<N, P, B>& patch, std::span<const Param<N>> at,
                               std::span<Accurate<PointOf<P>>> out);

}  // namespace freiform
