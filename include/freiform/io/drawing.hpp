// Line drawings of documents: curves with what defines them, surfaces and models as lines. Written as SVG and
// PDF, or turned into pixels, with nothing but the standard library.
//
// Polynomial curves of degree <= 3 are drawn exactly (both formats have lines and Bezier curves); everything
// else as a polyline that is nowhere further than kDrawingTolerance from the curve, rounding aside.
#pragma once
#include <freiform/core/view.hpp>
#include <freiform/shape.hpp>

#include <optional>
#include <span>
#include <string>
#include <vector>

namespace freiform {

inline constexpr double kDrawingTolerance = 0.05;  // pixels

// A line (1), a quadratic (2) or a cubic Bezier curve (3) that begins where the one before ends.
struct DrawnSegment {
    int degree = 1;
    std::array<Vec<2>, 3> points{};  // the first `degree` of them; the last is the end
};

struct DrawnPath {
    Vec<2> start{};
    std::vector<DrawnSegment> segments;
    bool closed = false;
};

struct DrawnDisc {
    Vec<2> centre{};
    double radius = 1;  // pixels
    bool hollow = false;
};

// All of one role that one object has.
struct DrawnGroup {
    std::string name;  // the object
    std::string role;  // "curve", "isolines", "edges", "control", "knots", "comb", "construction", "point"
    Colour colour;
    double width = 1;  // of lines, pixels
    std::vector<DrawnPath> paths;
    std::vector<DrawnDisc> discs;  // drawn after the paths
};

// In pixels, the origin at the upper left corner, y down.
struct Drawing {
    int width = 0, height = 0;
    std::vector<DrawnGroup> groups;  // in the order of drawing
    // A point (x, y) of the drawn plane is the pixel (origin_x + scale x, origin_y - scale y). The plane is
    // that of the objects where all of them are plane, else the plane of the view.
    double scale = 1;
    Vec<2> origin{};
    std::vector<Refusal> left_out;  // what could not be drawn
};

struct DrawingOptions {
    int width = 1200, height = 900;  // pixels, 16 to 16384
    std::optional<View> view;        // none: plane objects as they are, others from iso
    double margin = 0.05;            // of the smaller side of the picture, in [0, 0.4]
    bool control = false;            // control polygons and nets; the area of a point is as its weight
    bool knots = false;              // places of the knots on curves, larger where they are multiple
    bool comb = false;               // curvature: needles away from the centre, of length as the curvature
    std::optional<double> construction;  // all points of the de Boor (de Casteljau) scheme here
};

// `objects`: indices; all if empty. Curves of one coordinate are drawn as graphs over their parameter;
// objects of four coordinates are refused (unsupported, in Drawing::left_out, where others can be drawn).
// Refuses documents with nothing to draw (no_answer), parameters outside the domain of a curve
// (out_of_domain), drawings of more than 4 million segments (limit).
Result<Drawing> draw(const Document& document, std::span<const std::size_t> objects = {},
                     const DrawingOptions& options = {});

std::string to_svg(const Drawing& drawing);
std::string to_pdf(const Drawing& drawing);  // one page, 96 pixels to the inch
// Rows from the top, three sRGB bytes per pixel, on white, smoothed. Refuses (limit) above 2^26 pixels.
Result<std::vector<unsigned char>> to_pixels(const Drawing& drawing);

}  // namespace freiform
