// Convex hulls of control points. A Bezier curve lies in the hull of its control points, a B-spline curve of
// degree p over one span in the hull of the p + 1 that matter there.
#pragma once
#include <freiform/spline/patch.hpp>

#include <array>
#include <span>
#include <vector>

namespace freiform {

// The corners of the convex hull, counter-clockwise, as indices into `points`, from the leftmost (of those
// the lowest) on. No three are on one line: decided exactly. One or two indices where all points are equal or
// on one line; none without points. Refuses points that are not finite. Cost: n log n.
Result<std::vector<int>> convex_hull(std::span<const Vec<2>> points);

// The triangles of the convex hull in space, counter-clockwise seen from outside, as indices into `points`:
// closed, every point inside or on it: decided exactly. Facets with more than three corners come as several
// triangles; points on them that are no corners may be used. Refuses points that are not finite and
// (no_answer) points that are all in one plane.
Result<std::vector<std::array<int, 3>>> hull_triangles(std::span<const Vec<3>> points);

class NearestQuery;

// A polygon (counter-clockwise, facets: its sides) or polyhedron (triangles, counter-clockwise seen from
// outside) that contains an object, rounding included, and is hardly larger than its convex hull.
template <int D>
struct ConvexHull {
    std::vector<Vec<D>> points;  // all of them corners, or (in space) on facets with more than three
    std::vector<std::array<int, D>> facets;
    double slack = 0;  // bound: every point of it is at most this far from the convex hull of the object
};

// Around points: contains them; slack: how far it is beyond their hull. Points of one place have no facets.
ConvexHull<3> hull_around(std::span<const Vec<3>> points);

// D = 2 or 3. Parts are halved until `slack` <= tolerance, as far as rounding and max_parts allow: the answer
// says what was reached. A flat object in space has a hull that is as thick as rounding. Refuses a tolerance
// that is negative or NaN. REQUIRES D == object.coordinates().
//   auto hull = convex_hull<3>(query, 1e-3);   // hull->points, hull->facets, hull->slack
template <int D>
Result<ConvexHull<D>> convex_hull(const NearestQuery& object, double tolerance, int max_parts = 20000);

// A part of the domain of a curve and the coefficients first .. first + degree (modulo the number of
// coefficients, of a closed curve) whose hull contains the curve there, exactly.
struct LocalHull {
    Interval on;
    int first = 0;
};
std::vector<LocalHull> local_hulls(const BSplineBasis& basis);

}  // namespace freiform
