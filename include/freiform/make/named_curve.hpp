// Curves of the named schemes (surfaces: named_surface.hpp): Hermite, cardinal, Catmull-Rom,
// Kochanek-Bartels, uniform B-splines, and polynomials given by coefficients in any basis. All are splines
// afterwards; nothing remembers where it came from.
//
// P is Vec<D> or Hom<D>, D = 1 .. 4. Of Hom the schemes work on homogeneous coordinates, so that a weighted
// "tangent" is a derivative of (w x, w); results whose weights are not positive are refused.
#pragma once
#include <freiform/basis/named.hpp>
#include <freiform/basis/polynomial_basis.hpp>
#include <freiform/spline/patch.hpp>

namespace freiform {

// The cubic on [0, 1] from p1 to p4 with the derivatives r1 and r4 there: Bezier points p1, p1 + r1 / 3, p4 -
// r4 / 3, p4.
template <Coefficient P>
Result<Curve<P>> hermite(const P& p1, const P& p4, const P& r1, const P& r4);

// Cubics through points[i] at parameters[i] with the derivative tangents[i], at least 2 of them; parameters
// increase, without them 0, 1, 2, .. Continuous in the first derivative: inner knots are double. A segment of
// length h from P to Q with derivatives R and S has the Bezier points P, P + h R / 3, Q - h S / 3, Q,
// rounded. With `leaving`, tangents[i] is the derivative on arriving at a point and leaving[i] on leaving it;
// knots where they differ are triple. Refuses, by name and index, counts that disagree and numbers that are
// not finite.
template <Coefficient P>
Result<Curve<P>> hermite_spline(std::span<const P> points, std::span<const P> tangents,
                                std::span<const double> parameters = {}, std::span<const P> leaving = {});

// Splines through points whose tangents are made from their neighbours. Closed: at least 3 points, through
// all of them, back to the first, domain [0, n]. Open: at least 4 points, through points[1] .. points[n - 2],
// as the matrices of the schemes are written (repeat or add end points to begin at the first), domain [0, n -
// 3]. Segments have the length 1.
enum class Ring { open, closed };
template <Coefficient P>
Result<Curve<P>> catmull_rom(std::span<const P> points, Ring ring = Ring::open);
template <Coefficient P>
Result<Curve<P>> cardinal(std::span<const P> points, double tension, Ring ring = Ring::open);
// One setting for every point, or one for all. See named.hpp for what they mean.
template <Coefficient P>
Result<Curve<P>> kochanek_bartels(std::span<const P> points, std::span<const TensionContinuityBias> settings,
                                  Ring ring = Ring::open);

// The uniform B-spline with these control points. Open: more points than the degree; knots -degree, .., -1,
// 0, 1, .., domain [0, n - degree] (of m + 1 points and degree 3: m - 2 segments, the first begins at t_3 =
// 0). Closed: domain [0, n].
template <Coefficient P>
Result<Curve<P>> uniform_b_spline(std::span<const P> points, int degree = 3, Ring ring = Ring::open);

// The polynomial with these coefficients in `basis`, on `on`, as a Bezier curve. No coordinate of a control
// point, and so no homogeneous coordinate of a point of the curve, is farther than `bound` from the
// polynomial that was given: control points are computed in 512 binary digits and rounded once. `condition`
// says what errors of the coefficients do.
//   Q(t) = C (t^3, t^2, t, 1)^T:  from_basis(*PolynomialBasis::monomial(3), columns_of_c)
//   through points at nodes:      from_basis(*PolynomialBasis::lagrange(nodes), points, {nodes.front(),
//   nodes.back()})
template <Coefficient P>
struct PolynomialCurve {
    Curve<P> curve;
    double bound = 0, condition = 0;
};
template <Coefficient P>
Result<PolynomialCurve<P>> from_basis(const PolynomialBasis& basis, std::span<const P> coefficients,
                                      Interval on = {0, 1});

// The other way: the coefficients in `basis`, which has the degree of the curve, of its polynomial on the
// span of parameter u (Hom: of the homogeneous one).
template <Coefficient P>
Result<Converted<P>> to_basis(const Curve<P>& curve, double u, const PolynomialBasis& basis);

// Q(t) = C T, T = (t^n, .., t, 1)^T: the columns of C, highest power first.
template <Coefficient P>
Result<PolynomialCurve<P>> polynomial(std::span<const P> columns, Interval on = {0, 1});

// The polynomial of lowest degree through points[i] at nodes[i], on the interval that the nodes span.
template <Coefficient P>
Result<PolynomialCurve<P>> interpolating_polynomial(std::span<const P> points, std::span<const double> nodes);

}  // namespace freiform
