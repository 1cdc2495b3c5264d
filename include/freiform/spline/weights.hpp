// Weights that are zero or negative: proven harmless, or refused with the place of the pole.
//
// A patch has positive weights, by construction. That is no restriction: a rational function without a pole
// in its domain has positive weights after enough knots have been inserted.
#pragma once
#include <freiform/spline/patch.hpp>

namespace freiform {

template <std::size_t N, int D>
struct PositiveForm {
    Patch<N, Hom<D>> patch;
    double bound = 0;      // distance of the patch from the given function, at the same parameters
    int inserted = 0;      // knots, of all axes together
    bool negated = false;  // all coefficients have changed their sign
};

// The same function with positive weights. Weight 0 is a control point at infinity: its coefficient (v, 0)
// pulls in the direction v.
//
// Where all weights are positive already, nothing changes. Otherwise ends that are not clamped are clamped,
// and knots are inserted in the middle of spans until all weights are positive, which proves that the
// denominator has no zero in the domain, rounding included. A denominator that is negative everywhere is
// negated together with the numerator.
//
// Refuses, as "weights": `invalid` with the parameters between which the denominator changes its sign (of
// surfaces and volumes: with parameters where it is negative), or where it is 0 in a corner;
// `ill_conditioned` with the place where it cannot be told from 0; `limit` if more than a million
// coefficients would be needed; and what Patch::make refuses.
//   // A half circle, whose middle control point is at infinity:
//   Net<1, Hom<2>> net({3}, {{{1, 0, 1}}, {{0, 1, 0}}, {{-1, 0, 1}}});
//   auto half = positive_weights<1, 2>({*BSplineBasis::bezier(2)}, net);
template <std::size_t N, int D>
Result<PositiveForm<N, D>> positive_weights(const std::array<BSplineBasis, N>& bases,
                                            const Net<N, Hom<D>>& net);

}  // namespace freiform
