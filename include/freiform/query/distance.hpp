// The least distance between two sets of curves, surfaces and volumes, with a lower bound that proves it.
#pragma once
#include <freiform/query/nearest.hpp>

namespace freiform {

template <int D>
struct LeastDistance {
    std::array<std::size_t, 2> object{};  // which of the first and of the second set
    std::array<std::array<double, 3>, 2> at{};
    std::array<Vec<D>, 2> point{};
    double distance = 0;     // between the two points
    double point_error = 0;  // bound: how far both together may be from their objects
    // bound: no two points of the two sets are nearer to each other. The true distance lies in
    // [lower_bound, distance + point_error]. 0 where they meet.
    double lower_bound = 0;
};

struct DistanceOptions {
    // A distance: how far lower_bound may stay below `distance`. 0: 2^-30 of the largest coordinate. No less
    // than 2^-44 of that is of use: rounding.
    double accuracy = 0;
    // A backstop: pairs of parts that are looked at. Reached, `lower_bound` is what was proven until then.
    // Objects that run parallel along a surface need many.
    int max_pairs = 200000;
};

// Ends, borders and corners are points like others. Refuses sets with different numbers of coordinates, a
// negative accuracy and max_pairs < 1. REQUIRES D == a.coordinates().
//   auto d = least_distance<3>(a, b);   // d->lower_bound <= distance of any two points
template <int D>
Result<LeastDistance<D>> least_distance(const NearestQuery& a, const NearestQuery& b,
                                        const DistanceOptions& options = {});

}  // namespace freiform
