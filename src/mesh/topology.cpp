// Idea. Counts from the edges. A triangle has no area exactly if its projections to the three
// coordinate planes have none, which is decided without rounding.
//
// Why not the rounded cross product: it errs both ways. Differences that are rounded give area to collinear
// points, and two products that differ only in a bit beyond the 53rd take it from thin triangles.
#include "mesh_edges_detail.hpp"

#include <freiform/core/parallel.hpp>
#include <freiform/poly/predicates.hpp>

namespace freiform {
namespace {

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
    const auto count_triangles = [&] {
        for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
            const auto [a, b, c] = mesh.points_of(t);
            out.degenerate_triangles += is_degenerate(
                mesh.points[std::size_t(a)], mesh.points[std::size_t(b)], mesh.points[std::size_t(c)]);
        }
    };
    const auto count_edges = [&] {
        each_edge(mesh, [&](const MeshEdge& edge) {
            const int uses = edge.forward + edge.backward;
            out.open_edges += uses == 1;
            out.non_manifold_edges += uses > 2;
            out.misoriented_edges += uses == 2 && edge.forward != 1;
        });
    };
    parallel_for(2, 1, [&](std::size_t which) { which == 0 ? count_triangles() : count_edges(); });
    return out;
}

}  // namespace freiform
