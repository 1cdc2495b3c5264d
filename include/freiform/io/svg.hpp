// Drawings in SVG: the geometry of what they show, read and written.
//
// Coordinates are those of the viewBox, with the y axis pointing up: y changes its sign, exactly, and nothing
// else does. So a drawing that was read and is written again has the same numbers in it.
#pragma once
#include <freiform/core/interval.hpp>
#include <freiform/path/path.hpp>
#include <freiform/path/style.hpp>
#include <freiform/shape.hpp>

#include <string>
#include <string_view>
#include <vector>

namespace freiform {

struct SvgShape {
    std::string id;       // may be empty
    std::string element;  // "path", "rect", ..
    Path path;
    std::string fill = "black", stroke = "none";  // as they are written
    FillRule fill_rule = FillRule::nonzero;
    StrokeStyle line;
};

struct SvgPicture {
    Box<2> view;  // of the viewBox, or of width and height; empty where the file says nothing
    std::string
        unit;  // "mm", "cm", "inch" if the file says that a unit of the viewBox is one; otherwise empty
    std::vector<SvgShape> shapes;
    // What is not among the shapes, or not as the file says, with the line: text, images, what cannot be
    // read.
    std::vector<Refusal> left_out;
};

// Elements: path, rect, circle, ellipse, line, polyline, polygon, in svg, g, a, switch and use. Transforms,
// units, nested viewports, styles by attributes, `style` and style sheets (selectors of one type, class or
// id). What is in defs or hidden is not shown. References to other files and entities of a document type are
// not followed. Where something is and how large is read from attributes alone: elements whose styles say it
// are left out and named. Clips and masks are not applied, and named. Refuses (unreadable) what is not XML or
// not SVG, (limit) elements above 96 MiB, 10^6 shown ones, pictures above 80 MiB (a million lines) and more
// work than a few looks at the file (as nested `use` makes it): all stays below 256 MiB.
Result<SvgPicture> read_svg(std::string_view bytes);

// Each subpath that has a segment as a curve, called as its shape, "/2" and so on after the first.
Document document_of(const SvgPicture& picture);

// Refuses (unsupported) objects that are not plane curves; what SVG has no curve for is approximated within
// the tolerance (`bound`: what was reached).
struct SvgOfDocument {
    SvgPicture picture;
    double bound = 0;
};
Result<SvgOfDocument> picture_of(const Document& document, double tolerance);

// A path element for each shape. Paints that refer to gradients or patterns become grey.
std::string write_svg(const SvgPicture& picture);

}  // namespace freiform
