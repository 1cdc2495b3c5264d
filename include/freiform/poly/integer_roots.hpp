// Roots of polynomials with integer Bernstein coefficients, for algorithms that compute such coefficients
// exactly. What users call is roots.hpp.
#pragma once
#include <freiform/poly/integer.hpp>
#include <freiform/poly/roots.hpp>

#include <span>
#include <vector>

namespace freiform::detail {

// The coefficients, each the sum of `terms` of the parts, all multiplied by one power of two that makes them
// integers.
std::vector<Integer> integer_coefficients(std::span<const double> parts, int terms);

// All roots in [0, 1], with signs. REQUIRES some coefficient that is not zero.
std::vector<Root> integer_roots(const std::vector<Integer>& bernstein, double width);

// The roots in [0, 1] that all these polynomials share, with the multiplicity that they share. Polynomials
// that are zero everywhere are left out. REQUIRES one that is not.
std::vector<Root> common_roots(std::span<const std::vector<Integer>> bernstein, double width);

}  // namespace freiform::detail
