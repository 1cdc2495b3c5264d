// The edges of a mesh, one after the other, where no list of them is needed.
#pragma once
#include <freiform/mesh/triangle_mesh.hpp>

#include <cstdint>
#include <functional>
#include <vector>

namespace freiform {

// Method. A counting sort of the directed edges by their lower point, then a small sort at every point; an
// entry packs the other point, the triangle and the direction into 64 bits.
class SortedEdges {
public:
    explicit SortedEdges(const TriangleMesh& mesh);

    // Those whose lower point is one of [first, end), in the order of their points. Different points may be
    // asked for at the same time.
    void each(std::size_t first, std::size_t end, const std::function<void(const MeshEdge&)>& visit);

private:
    std::vector<std::size_t> begin_;  // of the entries of a point
    std::vector<std::uint64_t> entries_;
};

}  // namespace freiform
