// Offsets of splines as splines, with a proven distance. An offset has a unit normal in it, which no spline
// is; what meshes, intersects or writes splines knows it so all the same.
#pragma once
#include <freiform/make/made_surface.hpp>
#include <freiform/spline/geometry.hpp>

namespace freiform {

// A bicubic spline over the parameters `on` (within the domain of the base), no point of which is farther
// than `tolerance` (a distance, > 0) from that of the offset at the same parameters: `bound`, proven, is at
// most that. Its tangents are continuous but across knots where curvatures of the base are not. As many
// pieces as that takes, of a grid.
//
// The base is a spline, or what a spline sweeps along a line. Refuses (unsupported) others, creases inside,
// (ill_conditioned) normals that vanish, (limit) tolerances that 2^16 pieces do not reach.
//   auto shell = offset_spline({base, 0.5}, domain(*base), 1e-4);
Result<MadeSurface<Vec<3>>> offset_spline(const OffsetSurface& offset, const std::array<Interval, 2>& on,
                                          double tolerance);

}  // namespace freiform
