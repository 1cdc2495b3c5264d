// The next triangle: coefficients that join a given triangular patch along an edge with C^k or G^1, and
// curved triangles from points and normals.
//
// The new triangle has the edge for its edge 0 and runs along it the other way: its corner 1 is new, its
// corner 2 is where the edge of the given one ends, its corner 3 where that begins. Both have the same
// orientation.
//
//            b                     edge `e` of the given patch from a to b, opposite corner o;
//          / | \                   of the new one: corner 1 = x, corner 2 = b, corner 3 = a
//        o   |   x
//          \ | /                   free: its coefficients b_ijk from corner 1 on, as many as the rows that
//            a                     the joint does not determine have
#pragma once
#include <freiform/spline/simplex_construction.hpp>

namespace freiform {

template <class P>
struct JoinedTriangle {
    SimplexPatch<2, P> patch;
    double bound = 0;  // no (homogeneous) coordinate of a determined coefficient is off by more
};

// Joins with C^k: over the plane of parameters in which the given patch has its triangle and the new one has
// corner 1 at `apex`, all derivatives up to order `order` agree along the edge. (1, 1) makes a parallelogram
// at edge 0. The first order + 1 rows from the edge are determined; the degree follows from the number of
// free coefficients, (n - order)(n - order + 1) / 2, and is at least that of the given patch. Refuses an apex
// on the side of the given triangle, and weights that come out not positive.
template <class P>
Result<JoinedTriangle<P>> next_c(const SimplexPatch<2, P>& s, int edge, int order, const Param<2>& apex,
                                 std::vector<P> free);

// With E(t) the edge and A(t), B(t) the derivatives from a towards o and x:  B = -lambda A + gamma E', both
// factors linear from the beginning a (first number) to the end b (second number). lambda > 0; gamma any
// number. Constants are C^1 over the apex with the barycentric coordinates -lambda, 1 + lambda - gamma, gamma
// at o, a, b.
struct TangentChange {
    std::array<double, 2> lambda{1, 1}, gamma{0, 0};
};
// Joins with G^1: the same tangent plane at every point of the edge [Farin 1982]. The new patch has one
// degree more; `free`: n (n - 1) / 2 coefficients for that degree n.
template <class P>
Result<SimplexPatch<2, P>> next_g1(const SimplexPatch<2, P>& s, int edge, const TangentChange& change,
                                   std::vector<P> free);

// A cubic triangle through three points that has the given normals there, and a quadratic one whose values
// are the normals to shade it with (of length 1 at the corners; normalise others) [Vlachos & Peters & Boyd &
// Mitchell 2001]. Edges depend only on what is given at their ends, so neighbours have the same to the bit
// and leave no gap; tangent planes along them differ in general. Normals may have any length.
// Refuses points that coincide, normals that are zero, numbers that are not finite.
struct PointNormalTriangle {
    SimplexPatch<2, Vec<3>> patch, normals;
};
Result<PointNormalTriangle> point_normal_triangle(const std::array<Vec<3>, 3>& points,
                                                  const std::array<Vec<3>, 3>& normals);

}  // namespace freiform
