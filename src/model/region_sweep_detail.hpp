// A region of the plane that is moved through space, whatever moves it.
#pragma once
#include <freiform/model/swept_solid.hpp>

#include <functional>
#include <optional>

namespace freiform::detail {

// What a curve of a loop sweeps: a wall, the edges at both ends of it, and the way of the curve's start.
struct SweptCurve {
    SurfaceGeometry wall;
    CurveGeometry<3> near, far, rail;
    Vec<3> start{}, start_far{};
    double tolerance = 0;  // of these edges and vertices
    // The curve as the edges run through it, and over what, where that is not the curve over its domain.
    // `against`: the other way; the wall, which is as the edges are, too.
    struct Flat {
        CurveGeometry<2> curve;
        Interval on;
        bool against = false;
    };
    std::optional<Flat> flat = {};
    // Of a line across the axis, which runs outwards: at both ends, how far it is from there. The wall is a
    // plane then, with the axis as origin of its parameters, and the line at the near end along the first.
    std::optional<Interval> level = {};
};

struct RegionSweep {
    std::function<Result<SweptCurve>(const CurveGeometry<2>&)> curve;
    // The flat face at the far or the near end; its parameters are coordinates of the region.
    std::function<SurfaceGeometry(bool at_far)> cap;
    Interval range{0, 1};   // of rails
    bool turns = false;     // parameters of walls are (s, t) of sweep and curve, otherwise (t, s)
    bool full = false;      // the far end is the near one
    bool reversed = false;  // the sweep goes to the other side of the region's left-hand walls
    // Of points of an axis, which stay where they are: the place there, growing away from the first of the
    // points that a loop with the region on its left leaves outwards. None, or nothing: all points move.
    std::function<std::optional<double>(const Vec<2>&)> on_axis = {};
};

// Of all control points. Refuses curves that are no splines.
Result<void> each_point(const RegionLoops& region, const std::function<void(const Vec<2>&)>& f);

// A solid for each connected part of the region. Refuses what orient_loops and the sweep of a curve refuse.
Result<Model> sweep_region(const RegionLoops& region, const RegionSweep& how);

}  // namespace freiform::detail
