// Curves as polylines, within a distance that is proven.
#pragma once
#include <freiform/spline/geometry.hpp>

#include <cstddef>
#include <string_view>
#include <vector>

namespace freiform {

enum class FlattenMethod {
    adaptive,  // as few segments as the tolerance allows: each reaches as far as it can be proven to
    uniform,   // equal parameter steps in every Bezier piece, by Horner's scheme
    forward,   // the same by forward differences of the order of the degree: additions only
    halving,   // every Bezier piece is halved until each part is flat
};

struct FlattenOptions {
    FlattenMethod method = FlattenMethod::adaptive;
    // One of the two: a distance in model units, or the number of segments in all (uniform, forward: rounded
    // up to a multiple of the number of pieces; adaptive: at most, unless corners need more; halving: at
    // least one for every piece).
    double tolerance = 0;
    int segments = 0;
    // halving: draw the control polygons of the last level instead of their chords.
    bool polygons = false;
    std::size_t max_segments = 10'000'000;
};

template <int D>
struct Polyline {
    std::vector<Vec<D>> points;      // two or more
    std::vector<double> parameters;  // points[i] is the curve at parameters[i], up to rounding
    // Where the curve jumps a new polyline begins: the indices of first points, {0} for a connected curve.
    std::vector<std::size_t> parts{0};
    // Every point of the curve between two neighbouring parameters is within this distance of the segment
    // between their points, and every point of the segment within it of that part of the curve. Rounding
    // included. (Control polygons: with `parameters` those of the polygon, see flatten.cpp.)
    double bound = 0;
    bool closed = false;  // the last point is the first

    std::size_t segments() const { return points.size() - parts.size(); }
};

// The polyline of a curve, by one of four methods. With `adaptive` corners (turns of more than kCornerAngle
// at a break) are always points of the polyline; other breaks are not treated in any special way. A curve of
// one coordinate is a function: there `bound` compares values at equal parameters. Refuses (invalid) when not
// exactly one of tolerance and segments is given; (ill_conditioned) a tolerance below the rounding of the
// coordinates, with the smallest that is possible; (limit) more segments than max_segments, with the number
// that suffices.
//   auto line = flatten(curve, {.tolerance = 0.01});
template <class P>
Result<Polyline<Space<P>::kDim>> flatten(const Curve<P>& curve, const FlattenOptions& options);

// The same for a curve of a model on an interval inside its domain (ellipses: any finite interval). Lines
// have two points. Conics have no Bezier pieces: methods other than adaptive take equal parameter steps. D =
// 2, 3.
template <int D>
Result<Polyline<D>> flatten(const CurveGeometry<D>& curve, Interval on, const FlattenOptions& options);

// A curve in the parameters of a surface, as the curve in space that it draws there, halved until it is
// within the tolerance. Refuses (no_answer) curves and surfaces that jump, and points where the surface has
// no value; tolerances and numbers of segments as above.
//   auto line = flatten_on(surface, curve, domain(curve)[0], 0.01, 10'000'000);
Result<Polyline<3>> flatten_on(const SurfaceGeometry& surface, const CurveGeometry<2>& curve, Interval on,
                               double tolerance, std::size_t max_segments);

inline constexpr double kCornerAngle = 1e-4;  // radians

// "adaptive", "uniform", "forward", "halving".
std::string_view name_of(FlattenMethod method);

// The methods at equal effort: what each reaches with the same number of segments.
struct FlattenComparison {
    FlattenMethod method = FlattenMethod::adaptive;
    bool polygons = false;
    std::size_t segments = 0;
    double bound = 0;  // proven
    double measured =
        0;  // largest distance of samples of the curve from the polyline: an estimate from below
};
template <class P>
Result<std::vector<FlattenComparison>> compare_flattening(const Curve<P>& curve, int segments);

}  // namespace freiform
