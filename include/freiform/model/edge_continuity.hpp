// How smoothly the faces of a model meet along its edges: gap, angle of the tangent planes, jump of the
// curvature.
#pragma once
#include <freiform/model/model.hpp>

#include <array>
#include <vector>

namespace freiform {

struct EdgeContinuityOptions {
    // Up to these a joint counts as G0, G1, G2: a distance (the tolerance that the edge and the faces state
    // is allowed if it is more), radians, 1/length.
    double gap = 0, angle = 0, curvature = 0;
    int max_parts = 2000;  // effort for one joint: its bounds are then what they are
};

// Two faces, or one with itself along a seam, at an edge that both use.
struct EdgeContinuity {
    int edge = -1;
    std::array<int, 2> face{-1, -1};
    // The largest distance at places looked at, and a bound of it at equal parameters along the whole edge;
    // infinite where the edge has no curve in space or there is no bound.
    double gap = 0, gap_bound = 0;
    // Likewise the angle between the normals, radians, and the parameter of the edge where it was found.
    // Where both faces are of one shell the outward normals are meant, so that pi is a fold; else the planes,
    // up to pi/2. Infinite bound: faces without bounds (offsets), sharp kinks of a surface along the edge.
    double angle = 0, angle_bound = 0, at = 0;
    bool directed = true;
    // An estimate: the largest difference at places looked at of the normal curvatures orthogonal to the
    // edge, which is all that second order can differ by where planes are tangent [Pegna & Wolter 1992]. -1:
    // the joint is not G1.
    double curvature = -1, curvature_at = 0;
    // Somewhere a face has no normal (poles, apices): the angle within a thousandth of the edge is left out.
    bool singular = false;
    // The order that holds, by the bounds of gap and angle; and the order that what was found does not
    // exclude. 2 by the estimate alone. -1: not even G0.
    int g_order = -1, g_at_most = -1;
};

// Every edge and pair of its uses, the worst first: by the order that is not excluded, then by angle,
// curvature, gap. Degenerate edges and those of one face only have no joint. Refuses options that are
// negative or NaN.
//   const auto all = edge_continuity(model, {.gap = 1e-6, .angle = 1e-3});
Result<std::vector<EdgeContinuity>> edge_continuity(const Model& model, const EdgeContinuityOptions& options);

}  // namespace freiform
