// Bicubic patches of the named schemes, also of two different ones.
//
//     Q(u, v) = sum_ij  f_i(u) g_j(v) G_ij,      f = M_u (u^3, u^2, u, 1)^T,  g = M_v (v^3, v^2, v, 1)^T
//
// G_ij is a point, a tangent or a twist, whatever the schemes take: of Hermite along u and Bezier along v,
// G_2j is the derivative by u at the start, of a control point. A patch is a curve of curves: with u fixed,
// sum_i f_i(u) G_ij are the four geometry vectors of a curve of the scheme along v; of the patch as Bezier
// net, iso(patch, 0, u) is that curve.
#pragma once
#include <freiform/basis/named.hpp>
#include <freiform/spline/patch.hpp>

#include <array>

namespace freiform {

// The patch on [0, 1] x [0, 1] in Bezier form. Every coordinate of a control point is the exact one for these
// matrices, rounded once (the sixths of kUniformBSpline are rounded themselves). Refuses numbers that are not
// finite, and of Hom weights that are not positive.
//   auto s = bicubic(geometry, kHermite, kBezier);
template <Coefficient P>
Result<Surface<P>> bicubic(const std::array<std::array<P, 4>, 4>& geometry, const Matrix4& along_u,
                           const Matrix4& along_v);

// The geometry of the curve along v of the patch where the first parameter is u: sum_i f_i(u) G_ij, rounded
// once.
template <Coefficient P>
std::array<P, 4> curve_of_curves(const std::array<std::array<P, 4>, 4>& geometry, const Matrix4& along_u,
                                 double u);

}  // namespace freiform
