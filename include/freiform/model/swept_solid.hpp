// Solids that a plane region sweeps: prisms and solids of revolution. Watertight by their construction: every
// edge is stored once and used by both of its faces.
#pragma once
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
// curve. Coordinates are those given, and their sums with `by`. Refuses what check_loops refuses (where: a
// loop), (invalid) vectors in the plane, (unsupported) ellipses: a rational spline is one.
//   auto badge = prism(loops_of(path), {{0, 0, 2}});
Result<Model> prism(const RegionLoops& region, const Vec<3>& by);

// The region turned by `angle` (radians, 0 < angle <= 2 pi) about an axis in its plane, counter-clockwise
// seen from the tip of its direction. A full turn has no flat faces; holes in the region become voids.
// Refuses the same as prism, axes that leave the plane (invalid), and (unsupported) regions with a control
// point on the axis or on both sides of it.
Result<Model> solid_of_revolution(const RegionLoops& region, const Axis& axis, double angle);

}  // namespace freiform
