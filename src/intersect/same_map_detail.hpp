// Two surfaces that are the same over a rectangle of parameters, but for these.
//
// Notation. Own parameters x of A and y of B (angles of a cylinder); s and t those of the splines that stand
// for them (part_spline_detail.hpp). y = M x: each of the y is scale * x + shift of one of the x.
//
// Idea. A part cut out by a split, a raised degree, inserted knots, a reversed or exchanged parameter, a
// cylinder with its seam elsewhere: all are a map M of this kind. One foot of a point of A on B with the
// first derivatives there gives M; the splines over the common rectangle R and over M(R), brought to one
// degree and the same knots, then have nearly the same control points, and how nearly is a bound by the
// convex hull property. Where A and B come together otherwise is not for the map to say: pairs of parts are
// explained by it (charts_detail.hpp) where one of the surfaces is one-to-one around both.
//
// Why not a comparison of the surfaces part by part? Parts over which a distance can be bounded without such
// a map are as small as the root of the tolerance: millions.
#pragma once
#include "part_spline_detail.hpp"

#include <freiform/intersect/surface_surface.hpp>

namespace freiform::detail {

struct SameMap {
    bool swapped = false;                             // y[0] comes from x[1]
    std::array<double, 2> scale{1, 1}, shift{};       // of y[k]
    std::array<std::array<ParameterArcs, 2>, 2> own;  // of the splines of A and B
    std::array<Interval, 2> region{}, image{};        // R and M(R), in own parameters
    double gap = 0;  // bound: no point of A over R is farther from that of B at M x, as splines

    std::size_t source(std::size_t k) const { return swapped ? 1 - k : k; }
    // Of parameters of the splines, both ways, rounding included.
    std::array<Interval, 2> forth(const std::array<Interval, 2>& s) const;
    std::array<Interval, 2> back(const std::array<Interval, 2>& t) const;
    std::array<Interval, 2> region_of_spline(std::size_t side) const;
};

// None where they are not the same within the tolerance, or not by such a map; more than one where they are
// so over two rectangles, because of a seam.
std::vector<SameMap> same_maps(const SurfacePart& a, const SurfacePart& b,
                               const std::array<const PartSpline*, 2>& splines, double tolerance);

// Two parallelograms in one plane; where a map exists, too.
std::optional<SurfaceOverlap> plane_overlap(const PartSpline& a, const PartSpline& b, double tolerance);

}  // namespace freiform::detail
