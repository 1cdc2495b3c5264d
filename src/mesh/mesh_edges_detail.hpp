// The edges of a mesh, one after the other.
//
// Method. A counting sort of the directed edges by their lower point, then a small sort at every point; an
// entry packs the other point, the triangle and the direction into 64 bits.
#pragma once
#include <freiform/mesh/triangle_mesh.hpp>

#include <algorithm>
#include <cstdint>
#include <vector>

namespace freiform {

// In the order of their points.
template <class Visit>
void each_edge(const TriangleMesh& mesh, Visit&& visit) {
    const std::size_t n = mesh.points.size();
    std::vector<std::size_t> begin(n + 2, 0);
    const auto each = [&](auto&& f) {
        for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
            const std::array<int, 3> p = mesh.points_of(t);
            if (p[0] == p[1] || p[1] == p[2] || p[2] == p[0]) continue;
            for (std::size_t i = 0; i < 3; ++i) f(p[i], p[(i + 1) % 3], t);
        }
    };
    each([&](int a, int b, std::size_t) { ++begin[std::size_t(std::min(a, b)) + 2]; });
    for (std::size_t i = 2; i < begin.size(); ++i) begin[i] += begin[i - 1];
    std::vector<std::uint64_t> entries(begin.back());
    each([&](int a, int b, std::size_t t) {
        const auto other = std::uint64_t(std::max(a, b)), backward = std::uint64_t(a > b);
        entries[begin[std::size_t(std::min(a, b)) + 1]++] = other << 32 | std::uint64_t(t) << 1 | backward;
    });
    for (std::size_t a = 0; a < n; ++a) {
        const auto first = entries.begin() + std::ptrdiff_t(begin[a]);
        const auto last = entries.begin() + std::ptrdiff_t(begin[a + 1]);
        std::sort(first, last);
        for (auto it = first; it != last;) {
            MeshEdge edge{int(a), int(*it >> 32), 0, 0, {-1, -1}};
            for (; it != last && int(*it >> 32) == edge.b; ++it) {
                const int uses = edge.forward + edge.backward;
                if (uses < 2) edge.triangles[std::size_t(uses)] = int((*it & 0xffffffffu) >> 1);
                ++(*it & 1 ? edge.backward : edge.forward);
            }
            visit(edge);
        }
    }
}

}  // namespace freiform
