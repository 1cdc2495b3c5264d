// The loops of a face as splines in its parameter plane, to clip curves of the plane by.
#pragma once
#include "loop_runs_detail.hpp"

#include <freiform/model/model.hpp>
#include <freiform/path/path.hpp>
#include <freiform/trim/inside.hpp>

#include <optional>

namespace freiform {

// A part of a curve in the parameter plane, [on.lo, on.hi], which is in the face.
struct ClippedPart {
    Interval on;
    // Of the ends: where on the loops, or none: the curve itself ends.
    struct End {
        int loop = -1, coedge = -1;
    };
    std::array<std::optional<End>, 2> ends{};
    bool along = false;  // some of it is within the tolerance of a loop
};

class FaceLoops {
public:
    // `stretch`: lengths in space for lengths of u and v, at most. Refuses what has no spline.
    static Result<FaceLoops> make(const Face& face, const std::vector<Edge>& edges, const Vec<2>& stretch);

    // The parts of a curve that are in the face or within the tolerance (a length in space, by `stretch`) of
    // its loops, in order.
    Result<std::vector<ClippedPart>> clip(const Curve<Vec<2>>& curve, double tolerance) const;
    // Neither inside nor on a loop, proven by samples of none: exactly.
    bool is_inside(const Vec<2>& uv) const { return !query_ || query_->at(uv).place != Place::outside; }
    // Where a box of parameters is: inside or outside as a whole, proven (for the loops as splines, rounding
    // included); or the boundary may run through it, then of that of which curve.
    struct Where {
        Place place = Place::boundary;
        ClippedPart::End on{};
    };
    Where place(const Box<2>& box) const;
    // The loops in order, every parameter times `unit`; curves that are no segments of paths become cubics,
    // within `bound` of the tolerance (both in these units).
    struct AsPath {
        Path path;
        double bound = 0;
    };
    Result<AsPath> path(const Vec<2>& unit, double tolerance) const;
    const Vec<2>& unit() const {
        return unit_;
    }  // with which lengths are about those in space, at least half
    bool is_empty() const { return trims_.empty(); }

private:
    struct Trim {
        LoopRail rail;  // in lengths in space, roughly
        const Curve<Hom<2>>& curve() const { return rail.curve(); }
        Box<2> box;
        ClippedPart::End place;
    };
    Result<void> add(const CurveGeometry<2>& curve, ClippedPart::End place);
    Vec<2> unit_{};  // powers of two
    std::vector<Trim> trims_;
    std::vector<std::vector<CurveGeometry<2>>> loops_;
    std::optional<InsideQuery> query_;
};

}  // namespace freiform
