// Signs that are never wrong: decisions about points, exact for all finite doubles.
//
// Subnormal and huge coordinates, also mixed, are no exception: orient2d({0, 0}, {1e300, 1e-300}, {1e300, 0})
// is -1. If a coordinate is not finite, the answer is 0 (or false). Cost: about 3 ns (orient2d) and 10 ns
// (in_circle) where rounding cannot matter; about 0.2 us and 2 us where it could, less on grids; 2 us and 25
// us where exponents are many hundreds apart.
#pragma once
#include <freiform/core/vec.hpp>

namespace freiform {

// +1 if a, b, c turn counter-clockwise, -1 if clockwise, 0 if they lie on one line.
int orient2d(const Vec<2>& a, const Vec<2>& b, const Vec<2>& c);

// +1 if d is strictly inside the circle through a, b, c, which turn counter-clockwise; 0 if it is on the
// circle; -1 if it is outside. For clockwise a, b, c the sign is reversed. For a, b, c on one line, it is
// that of the determinant of (x, y, x^2 + y^2, 1).
int in_circle(const Vec<2>& a, const Vec<2>& b, const Vec<2>& c, const Vec<2>& d);

// +1 if d is below the plane through a, b, c, which turn counter-clockwise seen from above; -1 if above, 0 if
// all four are in one plane. About 10 ns, and some microseconds where rounding could matter.
int orient3d(const Vec<3>& a, const Vec<3>& b, const Vec<3>& c, const Vec<3>& d);

// Is p on the segment ab, and neither a nor b?
bool is_between(const Vec<2>& a, const Vec<2>& b, const Vec<2>& p);

// Do the segments ab and cd have exactly one point in common that is an end of neither?
bool segments_cross(const Vec<2>& a, const Vec<2>& b, const Vec<2>& c, const Vec<2>& d);

}  // namespace freiform
