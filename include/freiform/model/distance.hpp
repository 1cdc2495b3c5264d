// The least distance between the surfaces of two solid models, with a lower bound that proves it.
#pragma once
#include <freiform/model/nearest.hpp>
#include <freiform/query/distance.hpp>

namespace freiform {

struct ModelDistance {
    // Both places; `distance` and `lower_bound` of each are those of the pair.
    std::array<ModelNearest, 2> at;
    double distance = 0;
    double point_error = 0;  // bound: how far both points together may be from their faces
    // bound: no two points of faces of the two are nearer to each other. 0 where they meet.
    double lower_bound = 0;
};

// Of faces as they are trimmed: one solid inside the other is as far away as their surfaces are.
// DistanceOptions::accuracy 0: 2^-24 of the size of both. Where faces run parallel over an area, max_pairs
// ends the search, and `lower_bound` is what was proven. Refuses a negative accuracy and max_pairs < 1.
//   auto d = least_distance(a, b);   // d->at[0].face, d->at[0].point, d->distance, d->lower_bound
Result<ModelDistance> least_distance(const ModelNearestQuery& a, const ModelNearestQuery& b,
                                     const DistanceOptions& options = {});

}  // namespace freiform
