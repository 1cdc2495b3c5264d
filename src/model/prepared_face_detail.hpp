// A face as intersections take it: a part of its surface, a little larger than its loops.
#pragma once
#include "face_loops_detail.hpp"
#include "face_region_detail.hpp"

#include <freiform/intersect/surface_surface.hpp>

namespace freiform {

struct PreparedFace {
    SurfacePart part;
    FaceLoops loops;
    FaceRegion region;
    Box<3> box;

    // Refuses what has no spline, and loops that go round the surface more than once.
    static Result<PreparedFace> make(const Model& model, const Face& face);
};

}  // namespace freiform
