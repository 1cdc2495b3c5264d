// The next piece: control points that join a given curve with C^k or G^k.
//
// Of a Bezier piece of degree n that joins with order k the first k + 1 control points are determined, the
// other n - k are free. For two cubics of equal parameter length:
//     C0  P4 = P4      C1  P5 = 2 P4 - P3      C2  P6 = P2 + 4 (P4 - P3)      G1  P3 - P4 = k (P4 - P5)
#pragma once
#include <freiform/spline/patch.hpp>

#include <span>
#include <vector>

namespace freiform {

template <class P>
struct NextPiece {
    Interval on{0, 1};    // its parameters
    std::vector<P> free;  // its coefficients after the first k + 1; so its degree is k + free.size()
    // Rational curves: the weights of its first k + 1 control points. Left empty: those with which the
    // homogeneous curves join, numerator and weight each with C^k or G^k; they may come out negative, which
    // is refused. Either way the points join with the order asked for.
    std::vector<double> weights = {};
};

// Joins the end of `previous` (any spline that is not closed) with C^k: derivatives by the parameter agree up
// to order k, whatever the intervals are. Every determined coefficient is the exact one rounded once (with
// given weights: correct to a few roundings). The first is the end of `previous` to the bit, if that is
// clamped. Refuses orders and degrees outside 0..kMaxDegree, empty intervals, and weights that are not
// positive, by name.
//   auto next = next_c(curve, 2, NextPiece<Vec<2>>{{1, 2}, {last}});   // a cubic, C2
template <class P>
Result<Curve<P>> next_c(const Curve<P>& previous, int order, const NextPiece<P>& next);

// Joins with G^k, k = phi.size(): phi[j - 1] is the derivative of order j, at the joint, of the change of
// parameter phi for which next(phi(t)) continues `previous` with C^k; phi[0] > 0, the others any number.
// These are the shape parameters:
//     previous' = phi' next',   previous'' = phi'^2 next'' + phi'' next', ..
// For cubics of equal parameter length G1 is P3 - P4 = k (P4 - P5) with k = phi'. The beta-constraints, next'
// = b1 previous', next'' = b1^2 previous'' + b2 previous', have the derivatives of the inverse, see
// `inverted`; a nu-spline has b1 = 1, b2 = nu.
template <class P>
Result<Curve<P>> next_g(const Curve<P>& previous, std::span<const double> phi, const NextPiece<P>& next);

// Derivatives phi', phi'', .. of a change of parameter to those of its inverse. REQUIRES derivatives[0] != 0.
std::vector<double> inverted(std::span<const double> derivatives);

// Hermite: the cubic from P4 = end of `previous` to P7 with the derivatives k R4 and R7 at its ends, R4 the
// derivative of `previous` at its end; G1 for k > 0, C1 for k = 1.
template <int D>
Result<Curve<Vec<D>>> next_hermite(const Curve<Vec<D>>& previous, double k, const Vec<D>& p7,
                                   const Vec<D>& r7, Interval on = {0, 1});

}  // namespace freiform
