// Method. The best triangulation of a polygon has that of both parts that a triangle on one of its sides
// leaves [Klincsek 1980]: cubic in the points, which are few. Shape: area over the sum of the squared sides.
#include "leaf_triangles_detail.hpp"

#include <freiform/core/result.hpp>

#include <algorithm>
#include <cstdint>

namespace freiform {

bool add_best_triangles(std::span<const Vec<2>> around, std::vector<std::array<int, 3>>& triangles) {
    const std::size_t n = around.size();
    FF_REQUIRE(n >= 3 && n <= kMostAround);
    double best[kMostAround][kMostAround];
    std::uint8_t by[kMostAround][kMostAround];
    for (std::size_t i = 0; i + 1 < n; ++i) best[i][i + 1] = 1;
    for (std::size_t span = 2; span < n; ++span)
        for (std::size_t i = 0; i + span < n; ++i) {
            const std::size_t j = i + span;
            best[i][j] = 0;
            by[i][j] = std::uint8_t(i + 1);
            const Vec<2> ij = around[j] - around[i];
            for (std::size_t k = i + 1; k < j; ++k) {
                const double parts = std::min(best[i][k], best[k][j]);
                if (!(parts > best[i][j])) continue;
                const Vec<2> ik = around[k] - around[i], kj = around[j] - around[k];
                const double shape = cross(ik, ij) / (dot(ik, ik) + dot(ij, ij) + dot(kj, kj));
                if (const double all = std::min(parts, shape); all > best[i][j])
                    best[i][j] = all, by[i][j] = std::uint8_t(k);
            }
        }
    if (!(best[0][n - 1] > 0)) return false;
    std::array<std::array<std::uint8_t, 2>, kMostAround> open{{{0, std::uint8_t(n - 1)}}};
    for (std::size_t left = 1; left > 0;) {
        const auto [i, j] = open[--left];
        if (j - i < 2) continue;
        const std::uint8_t k = by[i][j];
        triangles.push_back({int(i), int(k), int(j)});
        open[left++] = {k, j};
        open[left++] = {i, k};
    }
    return true;
}

}  // namespace freiform
