// Is a point of space inside a closed body? Proven by a mesh that is proven to be close to its surface.
#pragma once
#include <freiform/model/model.hpp>
#include <freiform/trim/inside.hpp>

#include <span>
#include <vector>

namespace freiform {

struct SolidInside {
    // boundary: the point is nearer to the surface than `distance`, which is about the accuracy asked for,
    // and on which side it lies is not known.
    Place place = Place::outside;
    int winding =
        0;  // times that the surface goes round the point: 1 inside a solid, 0 outside and in its voids
    // An estimate where the mesh has triangles so thin that rounding turns their planes: `place` and
    // `winding` do not suffer, because the nearest edge of such a triangle is as near as the triangle is.
    double distance = 0;  // inside, outside: at least so far from the surface; boundary: at most so far
};

// For every point, in order. `accuracy`: a distance > 0; points that are farther than it from the surface
// always get an answer. Refuses (no_answer) models whose surface is not closed, with the number of open edges
// or the faces that are missing, and (limit) accuracies that need more than max_triangles.
//   auto in = inside_solid(model, std::array{Vec<3>{{0, 0, 0}}}, 1e-6);
Result<std::vector<SolidInside>> inside_solid(const Model& model, std::span<const Vec<3>> points,
                                              double accuracy, long long max_triangles = 20'000'000);

}  // namespace freiform
