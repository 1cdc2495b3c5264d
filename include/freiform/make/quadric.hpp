// Spheres, cylinders, cones, tori and their affine images (ellipsoids, ..) as rational splines.
//
// A surface here differs from the exact one only by the rounding of its coefficients, and says by how much:
// `bound` is 0 where nothing was rounded, as for integer radii with EllipseForm::quintic.
//
//     auto ball = sphere({}, 2);                                      // two poles, 9 x 5 control points
//     auto tube = cylinder(*frame_about({{0, 0, 1}}, {{1, 1, 0}}), 0.5, {0, 3});
//     auto tiles = sphere_in_six({}, 2);                              // no poles
#pragma once
#include <freiform/make/conic.hpp>
#include <freiform/spline/simplex.hpp>

#include <array>

namespace freiform {

// Where a surface stands: the point with coordinates (a, b, c) is origin + a x + b y + c z. Any three
// independent vectors will do: three of different lengths make an ellipsoid of a sphere. Surfaces have their
// normals S_u x S_v outwards if x, y, z is right-handed, else inwards. Bounds are those of every coordinate.
struct FoundFrame {
    Vec<3> origin{}, x{{1, 0, 0}}, y{{0, 1, 0}}, z{{0, 0, 1}};
    double origin_bound = 0, x_bound = 0, y_bound = 0, z_bound = 0;
};

// Three orthogonal unit vectors, z along `axis`, x in the plane of `axis` and `toward` on the side of the
// latter (zero: the first coordinate axis that is farthest from `axis`). Refuses numbers that are not finite,
// an axis that is zero, and an axis and `toward` that are parallel as far as rounding tells.
Result<FoundFrame> frame_about(const Vec<3>& origin, const Vec<3>& axis, const Vec<3>& toward = {});

// Part of a full turn: an angle in radians, at most 2 pi long; 2 pi as a double is all of it, and only that
// can be closed or quintic. Parts are quadratic pieces of at most 90 degrees.
struct Turn {
    Interval angle{0, 2 * std::numbers::pi};
    EllipseForm form = EllipseForm::open;
};
inline constexpr Interval kPoleToPole{-std::numbers::pi / 2, std::numbers::pi / 2};

struct RoundSurface {
    Surface<Hom<3>> surface;  // on [0, 1] x [0, 1]: u runs around z, from the side of x over that of y
    double bound = 0;         // distance of every point from the exact surface's at the same parameters
};

// All refuse radii that are not positive, empty intervals, frames whose vectors are dependent as far as
// rounding tells, and numbers that leave the range of double.

// v runs over the latitude, from -pi/2 (as a double: the pole, whose coefficients are one point) at most to
// pi/2. The whole sphere with the quintic form is 5 x 3 and has integer control points.
Result<RoundSurface> sphere(const FoundFrame& frame, double radius, const Turn& turn = {},
                            Interval latitude = kPoleToPole);
// About z, from z = height.lo to height.hi, which is the direction of v; open at both ends.
Result<RoundSurface> cylinder(const FoundFrame& frame, double radius, Interval height, const Turn& turn = {});
// The same with another radius at each end. One of them may be 0: an apex, whose coefficients are one point.
Result<RoundSurface> cone(const FoundFrame& frame, double radius_lo, double radius_hi, Interval height,
                          const Turn& turn = {});
// The circle of radius `tube` about the point at distance `ring` from z, turned about z. v runs around the
// tube, from its outermost point upwards. A tube that is wider than the ring crosses itself.
Result<RoundSurface> torus(const FoundFrame& frame, double ring, double tube, const Turn& turn = {},
                           const Turn& around = {});

// A sphere without poles: the faces -z, +z, -x, +x, -y, +y of a cube, as one Bezier patch of degree 4 x 4
// each [Cobb 1988]. Neighbours have the same coefficients along the edge between them, to the bit.
struct SphereInSix {
    std::array<Surface<Hom<3>>, 6> faces;
    double bound = 0;  // distance of every point from the exact patch's at the same parameters
};
Result<SphereInSix> sphere_in_six(const FoundFrame& frame, double radius);

// The same as eight triangles of degree 4, one for each octant: number 4 (x < 0) + 2 (y < 0) + (z < 0)
// [Farin & Piper & Worsey 1987]. Corner 1 is on the x axis.
struct SphereInEight {
    std::array<SimplexPatch<2, Hom<3>>, 8> octants;
    double bound = 0;
};
Result<SphereInEight> sphere_in_eight(const FoundFrame& frame, double radius);

}  // namespace freiform
