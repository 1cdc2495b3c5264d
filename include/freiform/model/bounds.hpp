// Tight boxes and convex hulls of solid models.
#pragma once
#include <freiform/model/model.hpp>
#include <freiform/query/bounds.hpp>
#include <freiform/query/oriented_box.hpp>

namespace freiform {

// The box of all faces as their parameter curves trim them, with `slack` <= accuracy (a length) as far as
// rounding and `max_parts` for each side allow: the answer says what was reached. Refuses accuracies that are
// negative or NaN, models without faces, and faces without bounds of their derivatives or of their boundary.
//   const auto b = tight_box(model, 1e-6);   // b->box.lo, b->slack
Result<TightBox<3>> tight_box(const Model& model, double accuracy, int max_parts = 20000);

// Likewise in an orientation in which it is small (oriented_box.hpp): that of the ends of parts of boundaries
// and of places on the faces.
Result<OrientedBox<3>> oriented_box(const Model& model, double accuracy, int max_parts = 20000);

// A polyhedron that contains all faces, rounding included, and every point of which is at most `slack` from
// their convex hull: up to the tolerance, as far as rounding and max_parts allow; the answer says what was
// reached. Refuses what tight_box refuses.
//   const auto hull = convex_hull(model, 1e-3);   // hull->points, hull->facets, hull->slack
Result<ConvexHull<3>> convex_hull(const Model& model, double tolerance, int max_parts = 20000);

}  // namespace freiform
