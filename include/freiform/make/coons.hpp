// Coons patches: surfaces from their four boundary curves, as exact splines.
//
//                  u1                 u0, u1 run along u at the lower and upper end of v,
//          +---------------+          v0, v1 along v at the lower and upper end of u
//      v0  |               |  v1      ("lower end": of the domain of v0, of u0)
//          +---------------+
//                  u0
// Curves have a degree of at least 1; closed ones are opened.
#pragma once
#include <freiform/make/made_surface.hpp>

namespace freiform {

template <class Q>
struct CoonsPatch {
    Surface<Q> surface;
    double bound = 0;  // distance of every point from that of the exact patch at the same parameters
    // Curves that should meet are not farther apart than this at corners; the patch takes the middle, so no
    // boundary is farther than half of it, and `bound`, from its curve. 0: boundaries are the curves.
    double corner_gap = 0;
    // Of bicubic patches: by how much tangents and twists disagree at corners (mean values are taken).
    double tangent_gap = 0, twist_gap = 0;
};

// S = (1-v) u0 + v u1 + (1-u) v0 + u v1 - the bilinear patch of the corners, u and v from 0 to 1 over the
// domains. Refuses (invalid, naming the corner) curves that meet less closely than `tolerance`.
//   auto patch = coons(bottom, top, left, right, 1e-9);
template <int D>
Result<CoonsPatch<Vec<3>>> coons(const Curve<Vec<D>>& u0, const Curve<Vec<D>>& u1, const Curve<Vec<D>>& v0,
                                 const Curve<Vec<D>>& v1, double tolerance);

// The same sum of rational curves: exact, rational, over the product of their denominators, of degree 2 p + 1
// (p + 1 where opposite curves have the same weights, as parallel arcs do). Its knots are breaks of that
// multiplicity. Refuses as above, and (unsupported) degrees that no basis has.
template <int D>
Result<CoonsPatch<Hom<3>>> coons(const Curve<Hom<D>>& u0, const Curve<Hom<D>>& u1, const Curve<Hom<D>>& v0,
                                 const Curve<Hom<D>>& v1, double tolerance);

// A boundary and the derivative across it: by v along u0 and u1, by u along v0 and v1. The derivatives are by
// the parameters of the surface; degrees of at least 1, domain as the curve's. P: Vec or Hom, 2 or 3
// coordinates; a rational cross derivative is the vector that its curve has as a point.
template <class P>
struct CoonsEdge {
    Curve<P> curve, across;
};

struct CoonsTolerance {
    double distance = 0, tangent = 0, twist = 0;
};

// The same with cubic Hermite functions for 1-v, v, .., and derivatives: of boundary and cross derivative.
// Each corner has a position, two tangents and a twist S_uv, and each of them comes from two curves; where
// those disagree by more than the tolerance that is refused (invalid, with the corner and the amount),
// because then no such surface exists. `twist` compares (d/du) of u-edges' cross derivative with (d/dv) of
// v-edges'.
template <int D>
Result<CoonsPatch<Vec<3>>> coons_bicubic(const CoonsEdge<Vec<D>>& u0, const CoonsEdge<Vec<D>>& u1,
                                         const CoonsEdge<Vec<D>>& v0, const CoonsEdge<Vec<D>>& v1,
                                         const CoonsTolerance& tolerance);

// The same sum of rational curves and derivatives: exact, rational, over the product of the denominators that
// are not multiples of each other: m of degree p in a direction make the degree m p + 3 or more
// (over_one_denominator). So curves and derivatives that have one denominator, as those of extrusions and of
// surfaces of revolution with polynomial profiles do, make p + 3. Refuses as above, and (unsupported) degrees
// that no basis has.
template <int D>
Result<CoonsPatch<Hom<3>>> coons_bicubic(const CoonsEdge<Hom<D>>& u0, const CoonsEdge<Hom<D>>& u1,
                                         const CoonsEdge<Hom<D>>& v0, const CoonsEdge<Hom<D>>& v1,
                                         const CoonsTolerance& tolerance);

}  // namespace freiform
