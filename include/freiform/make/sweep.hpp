// Surfaces that a curve sweeps: extrusions, ruled and translational surfaces. All are exact splines, but for
// the rounding of their coefficients, of which each says what it moves. Plane curves lie in z = 0; curves may
// be polynomial or rational (P: Vec or Hom, 2 or 3 coordinates), open or closed. The surface is polynomial if
// the curves are.
#pragma once
#include <freiform/make/made_surface.hpp>

namespace freiform {

// S(u, v) = profile(u) + v vector, v in [0, 1]; the curve at v = 0 is the profile to the bit. Refuses a zero
// vector and numbers that are not finite.
//   auto wall = extrude(outline, {{0, 0, 3}});
template <class P>
Result<MadeSurface<InSpace<P>>> extrude(const Curve<P>& profile, const Vec<3>& vector);

// The straight lines from a(u) to b(u), v in [0, 1], on the basis of both (see compatible.hpp); u runs over
// the domain of a, to which that of b is mapped linearly. Of weights p(u) and q(u) the point at v divides the
// line in the ratio v q : (1 - v) p; so for polynomial curves, S(u, v) = (1 - v) a(u) + v b(u).
template <class P>
Result<MadeSurface<InSpace<P>>> ruled(const Curve<P>& a, const Curve<P>& b);

// S(u, v) = profile(u) + rail(v) - rail(v0), v0 the lower end of the rail's domain: the profile moved along
// the rail without turning. Closed in each direction in which the curve is.
template <class P>
Result<MadeSurface<InSpace<P>>> translate_along(const Curve<P>& profile, const Curve<P>& rail);

}  // namespace freiform
