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

struct FrameSweep {
    Surface<Vec<3>> surface;
    // Distance of every point from the exact swept surface at the same parameters, up to a turn of the start
    // frame by rounding.
    double bound = 0;
    int pieces = 0;  // of the frame, along v
};

// S(u, v) = rail(v) + x(u) r(v) + y(u) s(v), (x, y) the profile and (r, s, tangent) the rotation-minimising
// frame of the rail: an orthonormal frame with r' and s' parallel to the tangent. The surface is a spline, of
// degree max(3, degree of the rail) along v; along u it has the basis of the profile. Not closed along v, not
// even for closed rails: after one turn the frame comes back at another angle.
//
// Rails are polynomial, with a derivative that is continuous and never zero: refused (unsupported) where a
// knot lets it jump, (ill_conditioned) where it cannot be told from zero. Refuses tolerances that are not
// positive, and (limit) that ask for more than 2^14 pieces.
//   auto pipe = sweep(circle_like, rail, {1e-4});
Result<FrameSweep> sweep(const Curve<Vec<2>>& profile, const Curve<Vec<3>>& rail,
                         const FrameSweepOptions& options);

}  // namespace freiform
