// Idea. Counts from the edges. A triangle has no area exactly if its projections to the three
// coordinate planes have none, which is decided without rounding.
//
// Why not the rounded cross product: it errs both ways. Differences that are rounded give area to collinear
// points, and two products that differ only in a bit beyond the 53rd take it from thin triangles.
#include "mesh_edges_detail.hpp"

#include <freiform/core/parallel.hpp>
#include <freiform/poly/predicates.hpp>

#include <algorithm>
#include <atomic>
#include <optional>

namespace freiform {
namespace {

constexpr std::size_t kPointsAtOnce = 4096;

bool is_degenerate(const Vec<3>& a, const Vec<3>& b, const Vec<3>& c) {
    for (int x = 0; x < 3; ++x) {
        const int y = (x + 1) % 3;
        if (orient2d({{a[x], a[y]}}, {{b[x], b[y]}}, {{c[x], c[y]}}) != 0) return false;
    }
    return true;
}

}  // namespace

MeshTopology topology(const TriangleMesh& mesh) {
    MeshTopology out;
    std::optional<SortedEdges> edges;
    const auto count_triangles = [&] {
        for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
            const auto [a, b, c] = mesh.points_of(t);
            out.degenerate_triangles += is_degenerate(
                mesh.points[std::size_t(a)], mesh.points[std::size_t(b)], mesh.points[std::size_t(c)]);
        }
    };
    parallel_for(2, 1,
                 [&](std::size_t which) { which == 0 ? count_triangles() : void(edges.emplace(mesh)); });

    const std::size_t points = mesh.points.size();
    std::atomic<int> open = 0, non_manifold = 0, misoriented = 0;
    parallel_for((points + kPointsAtOnce - 1) / kPointsAtOnce, 1, [&](std::size_t part) {
        const std::size_t first = part * kPointsAtOnce;
        int of_one = 0, of_many = 0, of_two = 0;
        edges->each(first, std::min(points, first + kPointsAtOnce), [&](const MeshEdge& edge) {
            const int uses = edge.forward + edge.backward;
            of_one += uses == 1;
            of_many += uses > 2;
            of_two += uses == 2 && edge.forward != 1;
        });
        open += of_one, non_manifold += of_many, misoriented += of_two;
    });
    out.open_edges = open, out.non_manifold_edges = non_manifold, out.misoriented_edges = misoriented;
    return out;
}

}  // namespace freiform
