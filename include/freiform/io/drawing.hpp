// Drawings of documents: curves with what defines and explains them, surfaces and models as lines: borders,
// outlines and isolines, without what is behind.
//
// Polynomial curves of degree <= 3 are drawn exactly (drawings have lines and Bezier curves); everything else
// as a polyline that is nowhere further than kDrawingTolerance from the curve, rounding aside. Exceptions:
// hodographs of rational curves are polylines through 400 points of each piece; lines of surfaces in space
// are within three times the tolerance, and hidden where a surface is in front of them by more than eight
// times (in the sense of mesh/visibility.hpp).
#pragma once
#include <freiform/core/view.hpp>
#include <freiform/io/figure.hpp>
#include <freiform/shape.hpp>

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace freiform {

inline constexpr double kDrawingTolerance = 0.05;  // pixels

// How control points are called: not at all, b_0 b_1 .., or P_1 P_2 .. (of further curves c, d, ..; Q, R,
// ..).
enum class PointNames { none, from_zero, from_one };

// What is behind a surface: left out, dashed (of edges and outlines), or drawn as if surfaces were of glass.
// Surfaces hide curves, control polygons and edges of volumes too, which hide nothing; what explains a curve
// (combs, tangents, hulls, ..) is drawn over all.
enum class HiddenLines { removed, dashed, shown };

struct DrawingOptions {
    int width = 1200, height = 900;  // pixels, 16 to 16384
    std::optional<View> view;        // none: plane objects as they are, others from iso
    double margin = 0.05;            // of the smaller side of the picture, in [0, 0.4]
    std::string title;
    std::vector<Colour> palette;  // of the objects in turn; empty: kPalette, and many surfaces alike
    bool legend = false;
    Axes axes = Axes::none;

    bool control = false;                 // control polygons and nets; the area of a point is as its weight
    PointNames names = PointNames::none;  // of control points of curves; implies control
    // Of surfaces in space:
    HiddenLines hidden = HiddenLines::removed;
    std::optional<int> isolines;  // of each face in both directions, 0 to 1000; none: as the knots of
                                  // surfaces suggest, none on models
    // Of curves:
    bool knots = false;     // places of the knots, larger where they are multiple
    bool comb = false;      // curvature: needles away from the centre, of length as the curvature
    bool hull = false;      // the convex hull of the control points, in the plane of the picture
    bool box = false;       // the axis-parallel box of what is drawn of the curve
    bool joints = false;    // knots and ends that meet, in the colour of their order of continuity
    bool a_frames = false;  // what ties the Bezier points on both sides of an inner knot (spline/a_frame.hpp)
    bool hodograph = false;              // a second panel: the curve of the derivatives
    bool basis = false;                  // a further panel: the B-splines of the curve
    std::optional<double> construction;  // all points of the de Boor (de Casteljau) scheme here
    std::optional<double> tangent;       // tangent and normal here
    std::optional<double> osculating;    // the circle of curvature here
};

// `objects`: indices; all if empty. Curves of one coordinate are drawn as graphs over their parameter;
// objects of four coordinates are refused (unsupported, in Drawing::left_out, where others can be drawn).
// Refuses documents with nothing to draw (no_answer), parameters outside the domain of a curve
// (out_of_domain), drawings of more than 4 million segments (limit).
Result<Drawing> draw(const Document& document, std::span<const std::size_t> objects = {},
                     const DrawingOptions& options = {});

// The panels that `draw` arranges, to be changed and put beside others. Width and height say how finely
// curves are followed. `left_out` gets what could not be drawn.
Result<std::vector<Panel>> panels_of(const Document& document, std::span<const std::size_t> objects,
                                     const DrawingOptions& options, std::vector<Refusal>& left_out);

}  // namespace freiform
