// The free-form statements of Wavefront OBJ: curves and surfaces as B-splines, with trimming loops.
#pragma once
#include <freiform/shape.hpp>

#include <string>
#include <string_view>

namespace freiform {

// cstype bspline and bezier, rat or not: v, vp, deg, curv, curv2, surf, parm, trim, hole, end; o and g name
// objects, lines end in \ where they go on. Curves are in space; a part of a curve or surface that curv or
// surf asks for is cut out. What is no free-form object (polygons, special points, connections) is left out
// and named, once for each kind. Refuses, with the line (unreadable): what contradicts itself or the
// specification; (unsupported) cardinal, Taylor and basis-matrix curves; (no_answer) files without free-form
// objects. Time and memory are proportional to the text.
Result<Document> read_obj_freeform(std::string_view text);

// Curves of two and three coordinates (plane ones in z = 0), surfaces of three, trimmed surfaces: as
// `bspline`, numbers exact, knots as they are (closed ones are cut at their seam), rational coefficients as
// points and weights that give them back where such exist. Models as their faces (model/spline_faces.hpp,
// whose refusals are passed on), each by itself: the format knows no shared edges. Outer loops
// counter-clockwise, holes clockwise. Refuses (unsupported) other objects and loops with ellipses.
Result<std::string> write_obj_freeform(const Document& document);

struct WrittenObj {
    std::string text;
    double bound = 0;  // proven: of any point of a loop that had to be approximated to its edge
};
// The same, but loops of models that have no rational image are followed within `tolerance` > 0
// (spline_face_within).
Result<WrittenObj> write_obj_freeform(const Document& document, double tolerance);

}  // namespace freiform
