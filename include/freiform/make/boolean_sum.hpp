// Boolean sums: surfaces that blend two families of curves, each of which they contain.
//
//     S(u, v) = sum_k h_k(v) a_k(u) + sum_l g_l(u) b_l(v) - sum_kl g_l(u) h_k(v) T_kl
//
// Coons patches and Gordon surfaces are this with different functions h_k and g_l: where h_k is 1 in one
// place and the others are 0, and so for g, the surface contains all curves, if T_kl is where they meet.
#pragma once
#include <freiform/core/bounded.hpp>
#include <freiform/make/made_surface.hpp>

#include <vector>

namespace freiform {

// Curves a_k on one basis, and the functions of the other parameter that they are multiplied by.
struct BlendedFamily {
    BSplineBasis basis;
    std::vector<std::vector<BoundedVec<3>>> curves;  // curve k: basis.size() coefficients
    std::vector<std::vector<Bounded>> functions;  // function k: coefficients on the basis of the other family
};

// REQUIRES as many coefficients as the bases ask for, and T[k][l] for each curve k of `u` and l of `v`. The
// bound holds against the sum of the exact curves, functions and T. Magnitudes near the range of double are
// not scaled here.
Result<MadeSurface<Vec<3>>> boolean_sum(const BlendedFamily& u, const BlendedFamily& v,
                                        const std::vector<std::vector<BoundedVec<3>>>& T);

// Rational curves, and functions of the same parameter, over one denominator; in the Bezier form of pieces
// that are joined continuously.
struct OverOne {
    BSplineBasis basis;
    std::vector<std::vector<BoundedVec<3>>> curves;  // numerators
    std::vector<std::vector<Bounded>> functions;     // times the denominator
    std::vector<Bounded> denominator;                // positive
};

// The denominator is the product of those of the curves that are not multiples of each other (up to rounding,
// which the bounds contain), so curves that share their weights, as parallel arcs do, keep the degree low:
// with m different denominators of degree p and functions of degree q it is m p + q (m p + p if that is more,
// and a denominator is constant). Functions are on the domain of the first curve. Refuses (unsupported)
// degrees that no basis has, and curves that jump.
Result<OverOne> over_one_denominator(std::span<const Curve<Hom<3>>> curves,
                                     std::span<const Curve<Vec<1>>> functions);

// The sum of rational curves. Curve k of `u` is multiplied by function k of `v`, and the other way round.
Result<MadeSurface<Hom<3>>> boolean_sum(const OverOne& u, const OverOne& v,
                                        const std::vector<std::vector<BoundedVec<3>>>& T);

// The coefficients of x^m on `basis`, where x runs from 0 to 1 over the domain: of x^0 .. x^most. REQUIRES an
// open basis of degree >= most.
std::vector<std::vector<Bounded>> powers_on(const BSplineBasis& basis, int most);

}  // namespace freiform
