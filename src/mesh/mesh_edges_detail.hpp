// The edges of a mesh, one after the other, where no list of them is needed.
#pragma once
#include <freiform/mesh/triangle_mesh.hpp>

#include <cstdint>
#include <utility>
#include <vector>

namespace freiform {

// Method. A counting sort of the directed edges by their lower point, then a small sort at every point; an
// entry packs the other point, the triangle and the direction into 64 bits.
class SortedEdges {
public:
    explicit SortedEdges(const TriangleMesh& mesh);

    // Those whose lower point is one of [first, end), in the order of their points. Different points may be
    // asked for at the same time.
    template <class F>
    void each(std::size_t first, std::size_t end, F&& visit) {
        for (std::size_t a = first; a < end; ++a)
            for (auto [it, last] = sorted_at(a); it != last;) {
                MeshEdge edge{int(a), int(*it >> 32), 0, 0, {-1, -1}};
                for (; it != last && int(*it >> 32) == edge.b; ++it) {
                    const int uses = edge.forward + edge.backward;
                    if (uses < 2) edge.triangles[std::size_t(uses)] = int((*it & 0xffffffffu) >> 1);
                    ++(*it & 1 ? edge.backward : edge.forward);
                }
                visit(edge);
            }
    }

private:
    std::pair<std::uint64_t*, std::uint64_t*> sorted_at(std::size_t point);

    std::vector<std::size_t> begin_;  // of the entries of a point
    std::vector<std::uint64_t> entries_;
};

}  // namespace freiform
