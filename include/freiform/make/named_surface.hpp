// Patches of the named schemes, also of a different one along each parameter: bicubic ones by their matrices,
// those of any degrees by their bases.
//
//     Q(u, v) = sum_ij  f_i(u) g_j(v) G_ij,      f = M_u (u^3, u^2, u, 1)^T,  g = M_v (v^3, v^2, v, 1)^T
//
// G_ij is a point, a tangent or a twist, whatever the schemes take: of Hermite along u and Bezier along v,
// G_2j is the derivative by u at the start, of a control point. A patch is a curve of curves: with u fixed,
// sum_i f_i(u) G_ij are the four geometry vectors of a curve of the scheme along v; of the patch as Bezier
// net, iso(patch, 0, u) is that curve.
#pragma once
#include <freiform/basis/named.hpp>
#include <freiform/basis/polynomial_basis.hpp>
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

template <std::size_t N>
constexpr std::array<Interval, N> unit_box() {
    std::array<Interval, N> box;
    box.fill({0, 1});
    return box;
}

template <std::size_t N, Coefficient P>
struct PolynomialPatch {
    Patch<N, P> patch;
    double bound = 0, condition = 0;
};

// The patch with these coefficients in the tensor product of any bases, of any degrees, in Bezier form on the
// box `on`; in matrices
//
//     Q(u, v) = T_u M_u G M_v^T T_v^T,      T_u = (u^m, .., u, 1),  T_v = (v^n, .., v, 1),
//
// the columns of M_u and M_v being the functions of both bases in powers. Coefficients count as the bases
// say: of Hermite along u and Lagrange along v, G_2j is the derivative by u at the start, at the j-th node of
// v. Computed in 512 binary digits and rounded once: no coordinate of a control point is farther than `bound`
// from the exact one; `condition`: from_basis in named_curve.hpp, whose case N = 1 this is. Fix u, and sum_i
// f_i(u) G_ij are the coefficients of a curve in the basis of v: the curve of curves. Refuses nets that do
// not fit the bases, numbers that are not finite, empty intervals, and of Hom weights that are not positive.
//   auto s = from_bases<2, Vec<3>>({*PolynomialBasis::hermite(3), *PolynomialBasis::bernstein(2)}, net);
template <std::size_t N, Coefficient P>
Result<PolynomialPatch<N, P>> from_bases(const std::array<PolynomialBasis, N>& bases,
                                         const Net<N, P>& coefficients,
                                         const std::array<Interval, N>& on = unit_box<N>());

}  // namespace freiform
