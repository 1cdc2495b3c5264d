// Pairs of surfaces for intersection: hills over nearly the same square, one a little longer than the other.
//
// The truth: both are graphs over the plane, so branches are lines of zeros of the difference of their
// heights, counted and measured on a grid of 1200 x 1200 points of the first surface (2000 x 2000 for
// "loops"). Lines of the answer:
//     task seconds_per_pair branches length
#pragma once
#include "curve_tasks.hpp"
#include "evaluation_inputs.hpp"

#include <array>

namespace freiform::bench {

struct SurfacePairTask {
    const char* name;
    int size;
    std::uint64_t seed;
    bool rational;
    double beyond;  // the second surface, at every side
    double tolerance;
    int branches;  // of all ten pairs, the truth
    double length;
};
inline constexpr int kSurfacePairs = 10;
inline constexpr SurfacePairTask kSurfacePairTasks[] = {
    {"rational", 10, 8000, true, 0.1, 1e-6, 47, 36.42},
    {"polynomial", 10, 8000, false, 0.1, 1e-6, 46, 36.95},
    {"loops", 20, 8100, true, 0.02, 1e-6, 182, 112.84},
    {"single", 4, 8200, false, 0.1, 1e-6, 24, 16.01},
};

inline SurfaceInput hills_over(int n, std::uint64_t seed, bool rational, double lo, double hi) {
    SurfaceInput s = hills(n, seed);
    for (std::size_t i = 0; i < s.weights.size(); ++i) {
        for (std::size_t k = 0; k < 2; ++k) {
            double& x = s.points[3 * i + k];
            x = lo + (hi - lo) * x;
        }
        if (!rational) s.weights[i] = 1;
    }
    return s;
}
inline std::array<SurfaceInput, 2> surface_pair(const SurfacePairTask& task, int i) {
    const std::uint64_t seed = task.seed + 2 * std::uint64_t(i);
    return {hills_over(task.size, seed, task.rational, 0, 1),
            hills_over(task.size, seed + 1, task.rational, -task.beyond, 1 + task.beyond)};
}

inline void print_surface_task(const SurfacePairTask& task, double seconds, int branches, double length) {
    std::printf("%s %.9g branches=%d true_branches=%d length=%.6g true_length=%.6g\n", task.name,
                seconds / kSurfacePairs, branches, task.branches, length, task.length);
}

}  // namespace freiform::bench
