// Polynomial curves within a distance of rational ones, parameter by parameter: for what takes no weights.
#pragma once
#include <freiform/spline/patch.hpp>

namespace freiform {

template <int D>
struct NearPolynomial {
    Curve<Vec<D>> curve;
    double bound = 0;  // distance of every point from that of the rational curve at the same parameter
};

// On the domain of the given curve, closed where that is; `tolerance` is a distance. Where all weights are
// equal it is the curve itself, up to the rounding of its control points. Elsewhere it is cubic and has
// points and derivatives of the given curve at its knots, where it is as smooth as that, at most C1; spans
// are halved until each is proven near enough, so their number grows like tolerance^-1/4.
//
// Refuses tolerances that are not positive (invalid), curves that jump (unsupported), and, with the
// parameter, tolerances below what rounding moves (ill_conditioned) and more than 2^14 spans (limit).
//   auto arc = polynomial_near(rational_arc, 1e-6);   // arc->curve, arc->bound <= 1e-6
template <int D>
Result<NearPolynomial<D>> polynomial_near(const Curve<Hom<D>>& curve, double tolerance);

}  // namespace freiform
