// A profile swept along a rail in the frame that does not turn about it.
#pragma once
#include <freiform/make/made_surface.hpp>

namespace freiform {

struct FrameSweepOptions {
    double tolerance = 0;  // distance, > 0
    // Where x of the profile points to at the start of the rail, as far as that is orthogonal to the rail;
    // zero: to the coordinate axis that the rail is farthest from.
    Vec<3> x_at_start{};
};

template <class Q>
struct FrameSweep {
    Surface<Q> surface;
    // Distance of every point from the exact swept surface at the same parameters, up to a turn of the start
    // frame by rounding.
    double bound = 0;
    int pieces = 0;  // of the frame, along v
};

// Polynomial if both curves are.
template <class P, class R>
using Swept = std::conditional_t<Space<P>::kRational || Space<R>::kRational, Hom<3>, Vec<3>>;

// S(u, v) = rail(v) + x(u) r(v) + y(u) s(v), (x, y) the profile and (r, s, tangent) the rotation-minimising
// frame of the rail: an orthonormal frame with r' and s' parallel to the tangent. Profile (Vec<2>, Hom<2>)
// and rail (Vec<3>, Hom<3>) are polynomial or rational; only the frame is approximated. The surface is a
// spline, along v of degree max(3, degree of the rail), of rational rails their degree + 3; along u it has
// the basis of the profile. Not closed along v, not even for closed rails: after one turn the frame comes
// back at another angle.
//
// Rails have a direction that is continuous: refused (unsupported) where a knot lets it jump,
// (ill_conditioned) where their derivative cannot be told from zero. Refuses tolerances that are not
// positive, and (limit) that ask for more than 2^14 pieces.
//   auto pipe = sweep(circle, rail, {1e-4});
template <class P, class R>
Result<FrameSweep<Swept<P, R>>> sweep(const Curve<P>& profile, const Curve<R>& rail,
                                      const FrameSweepOptions& options);

}  // namespace freiform
