// Parameter curves of edges on surfaces.
#pragma once
#include "step_chart.hpp"

#include <freiform/core/result.hpp>
#include <freiform/core/sort.hpp>
#include <freiform/core/visit.hpp>

#include <algorithm>
#include <span>
#include <vector>

namespace freiform::step {

struct Trace {
    CurveGeometry<2> curve;
    double gap = 0;       // the largest distance from the edge that was seen
    bool fitted = false;  // a spline that follows the edge, and not a curve of closed form
    bool told = false;    // of the file
    bool cut = false;     // ends at a pole, beside the end of the edge (trace_up_to_poles)
};

// The curve over `on` whose image on the surface follows `c` with the same parameter, as near as the surface
// comes to it, plus `accuracy`. It is continuous where parameters are periodic. Refuses where it runs through
// a pole or fold and a polygon of nearest points is further off than ten times `rough`. Where the surface has
// several points that are as near, as one that folds has, it is where one of the `images` is: curves that are
// said to be this one in the parameters, wherever they are, their third coordinate being 0. `to_poles`: what
// ends beside a pole is followed up to it (trace_up_to_poles).
Result<Trace> trace(const Chart& chart, const CurveGeometry<3>& c, Interval on, double accuracy, double rough,
                    std::span<const CurveGeometry<3>> images = {}, bool to_poles = true);

// Nothing if the surface is no plane. The gap is a bound, in exact arithmetic.
std::optional<Trace> trace_on_plane(const SurfaceGeometry& surface, const CurveGeometry<3>& c, Interval on);

// Straight lines whose ends are those of the edge: along the ends of a spline that does not close, from one
// corner to another or with the parameter of the edge, and likewise along the extrusion of one.
std::vector<Line<2>> lines_along_sides(const Chart& chart, const CurveGeometry<3>& c, Interval on,
                                       double accuracy);

// Where the surface shrinks to a point or folds, slopes mean nothing: a polygon of nearest points, if it is
// nowhere further from the edge than `rough`.
std::optional<Trace> polygon_of_feet(const Chart& chart, const CurveGeometry<3>& c, Interval on,
                                     double rough);

// The ends of equal parts of an interval, and the breaks of a spline inside it, or every so many of them
// where they are more than `most`; in increasing order.
template <int D>
std::vector<double> places_along(const CurveGeometry<D>& c, Interval on, int parts, std::size_t most) {
    std::vector<double> all;
    for (int i = 0; i <= parts; ++i) all.push_back(i == parts ? on.hi : on.lo + on.length() * i / parts);
    visit_one(
        [&](const auto& g) {
            if constexpr (requires { g.net(); }) {
                const auto breaks = g.basis().breaks();
                const std::size_t stride = 1 + breaks.size() / most;
                for (std::size_t i = 0; i < breaks.size(); i += stride)
                    if (on.lo < breaks[i] && breaks[i] < on.hi) all.push_back(breaks[i]);
            }
        },
        c);
    sort(all);
    return all;
}

// Of an edge that goes on beyond a pole by no more than `rough`: a curve that ends there. Else nothing.
std::optional<Trace> trace_up_to_poles(const Chart& chart, const CurveGeometry<3>& c, Interval on,
                                       double accuracy, double rough);

// As few corners on a parameter curve `fine` of the edge, moved into the surface where that ends, as keep the
// polygon through them within `accuracy` of the edge, if some do. What the edge does within `beside` of its
// ends, such as run to and fro past a corner of the surface, is left out.
std::optional<Trace> coarse_polygon(const Chart& chart, const CurveGeometry<3>& c, Interval on,
                                    const CurveGeometry<2>& fine, double beside, double accuracy);

// The foot from the nearest point of the surface; of those that are about as near, as where it folds, the one
// by an image, which may have a parameter of its own. `t`: that of the edge, over `on`.
Foot foot_by_images(const Chart& chart, const Vec<3>& p, const Vec<3>& motion, double t, Interval on,
                    double accuracy, std::span<const CurveGeometry<3>> images);

// Whether an image has the parameter of an edge over `on`: straight, or with its first and last control point
// at the ends, since joints are closed by moving those.
bool begins_and_ends_with(const CurveGeometry<3>& image, Interval on);
// The image, or its part over `on`, if that is so; else none.
std::optional<CurveGeometry<3>> image_over(const CurveGeometry<3>& image, Interval on);

// None of conics.
std::optional<CurveGeometry<2>> without_last_coordinate(const CurveGeometry<3>& c);

}  // namespace freiform::step
