// Is a point of space inside a closed body? Proven by a mesh that is proven to be close to its surface.
#pragma once
#include <freiform/model/model.hpp>
#include <freiform/trim/inside.hpp>

#include <span>
#include <vector>

namespace freiform {

struct SolidInside {
    // boundary: the point is nearer to the surface than `distance`, and on which side it lies is not known.
    // `distance` is about the accuracy asked for, and more only where faces are farther from each other on
    // their edges or the budget of work was spent.
    Place place = Place::outside;
    int winding =
        0;  // times that the surface goes round the point: 1 inside a solid, 0 outside and in its voids
    // An estimate where the mesh has triangles so thin that rounding turns their planes: `place` and
    // `winding` do not suffer, because the nearest edge of such a triangle is as near as the triangle is.
    double distance = 0;  // inside, outside: at least so far from the surface; boundary: at most so far
};

// For every point, in order. `accuracy`: a distance > 0; points that are farther than it from the surface,
// and than faces are from each other on their edges, get an answer, except in walls and gaps so thin that it
// takes a mesh of more than max_triangles, or of half a million: their side is left open (boundary). Refuses
// (no_answer) models whose surface is not closed, with the number of open edges or the faces that are
// missing, and (limit) models of which even a mesh within a 64th of their size needs more than max_triangles.
//   auto in = inside_solid(model, std::array{Vec<3>{{0, 0, 0}}}, 1e-6);
Result<std::vector<SolidInside>> inside_solid(const Model& model, std::span<const Vec<3>> points,
                                              double accuracy, long long max_triangles = 20'000'000);

}  // namespace freiform
