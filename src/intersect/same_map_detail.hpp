// Two surfaces that are the same over a rectangle of parameters, but for these.
//
// Notation. s and t: parameters of the splines A and B; x and y: the same, or angles along an axis that goes
// round ellipses (axis_angles_detail.hpp), of any spline that does. y = M x: each of the y is scale * x +
// shift of one of the x.
//
// Idea. A part cut out by a split, a raised degree, inserted knots, a reversed or exchanged parameter, a
// cylinder, cone, sphere or torus with its seams elsewhere: all are a map M of this kind. One foot of a point
// of A on B with the first derivatives there gives M; the splines over the common rectangle R and over M(R),
// brought to one degree and the same knots, then have nearly the same control points, and how nearly is a
// bound by the convex hull property. Where A and B come together otherwise is not for the map to say: pairs
// of parts are explained by it (charts_detail.hpp) where one of the surfaces is one-to-one around both.
//
// Why not a comparison of the surfaces part by part? Parts over which a distance can be bounded without such
// a map are as small as the root of the tolerance: millions.
#pragma once
#include "axis_angles_detail.hpp"
#include "part_spline_detail.hpp"

#include <freiform/intersect/surface_surface.hpp>

namespace freiform::detail {

struct SameMap {
    struct Side {
        const Surface<Hom<3>>* surface = nullptr;
        std::array<AxisAngles, 2> own;
        std::array<Interval, 2> range() const { return {own[0].range(), own[1].range()}; }
    };
    std::array<Side, 2> side;
    bool swapped = false;                         // y[0] comes from x[1]
    std::array<double, 2> scale{1, 1}, shift{};   // of y[k]
    std::array<Interval, 2> region{}, image{};    // R and M(R)
    std::array<std::array<Interval, 2>, 2> on{};  // the same, of the splines
    double gap = 0;  // bound: no point of A over R is farther from that of B at M x, as splines

    std::size_t source(std::size_t k) const { return swapped ? 1 - k : k; }
    // Of parameters of the splines, both ways, rounding included.
    std::array<Interval, 2> forth(const std::array<Interval, 2>& s) const;
    std::array<Interval, 2> back(const std::array<Interval, 2>& t) const;
};

// Both lie on one sphere, together no farther off it than the tolerance: proven.
bool are_one_sphere(const Surface<Hom<3>>& a, const Surface<Hom<3>>& b, double tolerance);

// What is known before a search.
struct Sameness {
    // None where they are not the same within the tolerance, or not by such a map; more than one where they
    // are so over several rectangles, because of seams. They point to the splines.
    std::vector<SameMap> maps;
    bool one_sphere = false;  // without a map, and some point of A is on B, as far as sampling tells
};
Sameness sameness(const std::array<const PartSpline*, 2>& splines, double tolerance);

// Two parallelograms in one plane; where a map exists, too.
std::optional<SurfaceOverlap> plane_overlap(const PartSpline& a, const PartSpline& b, double tolerance);

}  // namespace freiform::detail
