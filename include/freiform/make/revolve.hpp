// Surfaces of revolution as splines: exact rational ones, and polynomial ones within a tolerance.
//
//     S(u, v) = profile(v), turned about the axis by an angle that grows with u from 0 to `angle`
//
// as the analytic Revolution of geometry.hpp has it: u turns, v runs along the profile. Seen from the tip of
// the axis' direction, positive angles turn counter-clockwise. Plane profiles lie in z = 0.
#pragma once
#include <freiform/make/made_surface.hpp>
#include <freiform/spline/geometry.hpp>

namespace freiform {

// The analytic one about an axis of length 1. Of a line along it, as far as rounding tells, the cylinder as
// the extrusion of a circle: with the same parameters, and known to be straight along v.
SurfaceGeometry revolution(CurveGeometry<3> profile, const Vec<3>& origin, const Vec<3>& axis);

struct Axis {
    Vec<3> origin{};
    Vec<3> direction{{0, 0, 1}};  // of any length but 0
};

// How a full turn (2 pi as a double, or -2 pi) comes back to its start: on a closed basis along u, or on an
// open one whose two ends are the profile to the bit.
enum class Seam { closed, open };

// Profiles may be polynomial or rational, of any degree, open or closed (P: Vec or Hom, 2 or 3 coordinates);
// they may touch and cross the axis, where the surface has poles or crosses itself. `angle` in radians, not
// 0, at most 2 pi in size.
//
// The fewest rational quadratic arcs of equal angle that is at most 90 degrees. u is in [0, 1], at the joints
// proportional to the angle; the basis of v is that of the profile. A full turn has eight columns of control
// points if closed, nine if open; all its knots are double. The curve at u = 0 is the profile to the bit.
//
// Refuses numbers that are not finite, a zero direction, angles out of range, and (ill_conditioned) profiles
// all of whose control points are on the axis, as far as rounding tells: they sweep no surface.
//   auto vase = revolve(outline, Axis{{{0, 0, 0}}, {{0, 0, 1}}}, 2 * std::numbers::pi);
template <class P>
Result<MadeSurface<Hom<3>>> revolve(const Curve<P>& profile, const Axis& axis, double angle,
                                    Seam seam = Seam::closed);

struct RevolvedPolynomial {
    Surface<Vec<3>> surface;
    // No point of it is farther than this from the surface of revolution, and the other way round; in the
    // direction of v both points belong to the same v.
    double bound = 0;
    int pieces = 0;  // along u
};

// The same surface, of a polynomial profile, cubic in u and continuously differentiable there: as few pieces
// of equal angle as this bound allows for `tolerance` (a distance). Ends of open surfaces are exact: u = 0 is
// the profile to the bit. Refuses as `revolve` does; a tolerance that is not positive (invalid); and one
// below what rounding moves (ill_conditioned).
//   auto vase = revolve_polynomial(outline, Axis{}, 2 * std::numbers::pi, 1e-3);
template <int D>
Result<RevolvedPolynomial> revolve_polynomial(const Curve<Vec<D>>& profile, const Axis& axis, double angle,
                                              double tolerance, Seam seam = Seam::closed);

// Of rational profiles: of a polynomial one near it (polynomial_near.hpp), for which three fifths of the
// tolerance are there; what that leaves is for the arcs. u = 0 is the polynomial profile, cubic in v unless
// all weights are equal. Refuses what `polynomial_near` refuses, too.
template <int D>
Result<RevolvedPolynomial> revolve_polynomial(const Curve<Hom<D>>& profile, const Axis& axis, double angle,
                                              double tolerance, Seam seam = Seam::closed);

}  // namespace freiform
