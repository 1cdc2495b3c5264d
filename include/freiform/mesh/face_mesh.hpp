// The triangles of one trimmed surface, given its boundary as polygons in the parameter plane.
#pragma once
#include <freiform/core/result.hpp>
#include <freiform/spline/apex.hpp>
#include <freiform/spline/derivative_bounds.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace freiform {

// Closed polygons in the parameter plane. `point` names the place in space that a corner stands for: corners
// with the same number (the two sides of a seam, the corners of a pole) are the same point of the mesh.
struct FaceBoundary {
    std::vector<Vec<2>> uv;
    std::vector<int> point;
    std::vector<std::array<int, 2>> segments;
};

// Two segments (or a segment and a corner, or two corners) that touch where they must not.
struct BoundaryConflict {
    int first = -1, second = -1;  // segments; -1 if the conflict is with the corner
    int corner = -1;
    std::string message;
};
// Empty if the boundary can be triangulated as it is.
std::vector<BoundaryConflict> find_conflicts(const FaceBoundary& boundary);

// Bound of the distance between the surface on a triangle and its linear interpolant at the corners, in any
// sense around; infinite where they are not in its domain.
double triangle_bound(const DerivativeQuery<2, 3>& surface, const std::array<Vec<2>, 3>& corner);

struct FaceMesh {
    std::vector<Vec<2>> uv;  // the corners of the boundary first, in order, then further points
    std::vector<int> point;  // one for each uv: as FaceBoundary::point, -1 for inner points
    std::vector<std::array<int, 3>>
        triangles;     // counter-clockwise in the parameter plane, none with two equal points
    int quads = 0;     // the first triangles are so many pairs (a, b, c), (a, c, d), each the quad a b c d
    double bound = 0;  // of the interpolation error of all triangles
};

// Where normals cannot be bounded, triangles and chords as small as this are left as they are: as the
// tolerance or, where that is coarse beside a face or an edge with this diagonal, as an arc of its size that
// turns by a part of the angle (radians).
inline double angle_floor(double tolerance, double angle, double diagonal) {
    constexpr double kPart = 1.0 / 16;
    return std::min(tolerance, kPart * angle * diagonal);
}
// Likewise, as narrow as this times angle_floor along the surface.
inline constexpr double kAngleWidth = 1.0 / 64;

// Quotient of two weights of a piece, above which places are looked for where no triangles and chords are
// small enough because parameters are doubles.
inline constexpr double kWeightsFarApart = 0x1p40;

// Ascending parameters for each axis: the lines of a grid.
using GridLines = std::array<std::vector<double>, 2>;

// What triangles must keep to; distances in model units.
struct FaceDemands {
    double tolerance = 0;  // of their interpolation bounds, > 0
    // No side of a triangle inside the face is longer (sides on the boundary are given).
    double max_edge = std::numeric_limits<double>::infinity();
    // normal_angle_bound of every triangle (radians), except where a triangle's longest side lies on the
    // boundary or is no longer than angle_floor, where a triangle is no wider than kAngleWidth times that, at
    // poles, and beyond many times the points that the tolerance needs: those are left as they are.
    double max_angle = std::numeric_limits<double>::infinity();
    // An aim: no box of points that the face is begun with is longer than this times its width in space.
    double max_aspect = std::numeric_limits<double>::infinity();
    // Inner points are the crossings of parameter lines, so that cells away from the boundary become quads;
    // given lines reach from end to end of a face that is a rectangle, whose boundary has a corner where each
    // ends. None where the lines would be too many.
    bool quads = false;
    const GridLines* lines = nullptr;
    // Work inside of this face is for all threads. Results are the same for any number of them.
    bool is_shared = false;
    // About how many there will be, for memory that is not moved while it grows; 0 where nothing is known.
    double expected_triangles = 0;
    // Of a cone whose boundary is as fine as cones ask for (chord_triangles.hpp).
    std::optional<Apex> apex = {};

    bool shapes_triangles() const {
        return std::isfinite(max_edge) || std::isfinite(max_angle) || std::isfinite(max_aspect);
    }
};

// About how many triangles the part of the surface over `box` needs: from its curvature at samples, in
// microseconds, to tell hopeless demands before they take time. An estimate, not a bound. `samples` in
// each direction.
double estimated_triangles(const SurfaceGeometry& surface, const Box<2>& box, const FaceDemands& demands,
                           int samples);

// Inner points are placed until every triangle keeps to the demands. `extra`: further inner points to begin
// with. Refuses (invalid) boundaries with a conflict, (limit) more than
// `max_triangles`.
Result<FaceMesh> mesh_face(const DerivativeQuery<2, 3>& surface, const FaceBoundary& boundary,
                           const FaceDemands& demands, long long max_triangles,
                           std::span<const Vec<2>> extra = {});

}  // namespace freiform
