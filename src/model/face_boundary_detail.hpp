// The boundary of a face as polygons, from the discretised edges.
#pragma once
#include "edge_mesh_detail.hpp"

#include <freiform/mesh/face_mesh.hpp>

namespace freiform {

struct BoundaryOfFace {
    FaceBoundary polygon;
    struct Source {
        int edge = -1, segment = -1;  // -1: joins the ends of two coedges at a pole
    };
    std::vector<Source> sources;  // one for each segment of the polygon
    double gap = 0;               // of the model along this boundary
    // Triangles beside the polygon, of parts of the boundary that cross others (tessellate_lenses.cpp).
    struct StripTriangle {
        std::array<Vec<2>, 3> uv;
        std::array<int, 3> point;  // of the mesh
    };
    std::vector<StripTriangle> strip;
    double strip_bound = 0;  // of their interpolation error
};

// Refuses loops whose coedges do not meet, in the model or in the parameter plane. `rounding`: distances in
// space below it say nothing.
Result<BoundaryOfFace> boundary_of(const Model& model, int face, const EdgeMesher& edges,
                                   const DerivativeQuery<2, 3>& surface, std::span<const Vec<3>> mesh_points,
                                   double tolerance, double rounding);

}  // namespace freiform
