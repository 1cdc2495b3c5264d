// Solids that a plane region sweeps: prisms, solids of revolution, solids along a rail. Watertight by their
// construction: every edge is stored once and used by both of its faces.
#pragma once
#include <freiform/make/frame_sweep.hpp>
#include <freiform/make/revolve.hpp>
#include <freiform/model/model.hpp>
#include <freiform/path/path.hpp>

#include <span>

namespace freiform {

// Loops of curves in the plane z = 0, in any order and direction; the region is where the odd-even rule says
// inside, so that loops in loops are holes. As of check_loops (trim/loops.hpp): each curve is a spline, the
// end of each at the start of the next, and loops neither cross themselves nor each other.
using RegionLoops = std::vector<std::vector<CurveGeometry<2>>>;

// The subpaths, a Bezier curve for each segment; open ones are closed by a line, as if they were filled.
// Segments that do not move and subpaths without others are left out.
RegionLoops loops_of(const Path& path);

// The region moved along `by`: a solid for each connected part of it, with two flat faces and a wall for each
// curve. Lines and arcs of circles, in whatever degree they are written, are edges that are lines and
// circles, one for arcs that follow each other on one circle; their walls are planes and cylinders.
// Coordinates are those given, and their sums with `by`. Refuses what check_loops refuses (where: a loop),
// (invalid) vectors in the plane, (unsupported) ellipses: a rational spline is one.
//   auto badge = prism(loops_of(path), {{0, 0, 2}});
Result<Model> prism(const RegionLoops& region, const Vec<3>& by);

// The region turned by `angle` (radians, 0 < angle <= 2 pi) about an axis in its plane, counter-clockwise
// seen from the tip of its direction. Of lines and arcs the walls are planes, cylinders, cones, spheres and
// tori. A full turn has no flat faces at its ends; holes in the region become voids, and so
// does what it leaves out along the axis. Curves may begin and end on the axis, where the solid has poles,
// and lines lie on it. Refuses the same as prism, axes that leave the plane (invalid), and (unsupported)
// regions on both sides of the axis, and curves with other control points on it.
//   auto ball = solid_of_revolution(loops_of(half_disc), {{}, {{0, 1, 0}}}, 2 * std::numbers::pi);
Result<Model> solid_of_revolution(const RegionLoops& region, const Axis& axis, double angle);

struct SolidAlong {
    Model model;
    double bound = 0;  // distance of every point of a wall from that of the exact one at the same parameters
    int pieces = 0;    // of the frame, along the rail
};

// The region moved along a rail in the frame that does not turn about it, as sweep (make/frame_sweep.hpp)
// moves curves: a point (x, y) sweeps rail(v) + x r(v) + y s(v). All of the boundary shares one frame. Flat
// faces at both ends; walls are splines, one for each curve. R: Vec<3> or Hom<3>. Refuses what sweep refuses
// of the rail and the options, what prism refuses of the region, (unsupported) rails that end where they
// begin, for the frame comes back at another angle, (no_answer) rails that are seen to bend around a
// control point of the region, where walls fold, and (limit) walls of more than 2^24 coefficients. Whether
// far parts of the solid meet is not asked.
//   auto pipe = solid_along(loops_of(ring), rail, {1e-4});
template <class R>
Result<SolidAlong> solid_along(const RegionLoops& region, const Curve<R>& rail,
                               const FrameSweepOptions& options);

}  // namespace freiform
