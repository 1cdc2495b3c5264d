// STEP files (ISO 10303-21, AP242) of what a document holds, written here and not by another library: numbers
// are the shortest text that reads back as the same double, so that control points, knots and weights come
// back exact.
#pragma once
#include <freiform/shape.hpp>

#include <string>

namespace freiform {

// Solids become manifold solid breps (with voids), other shells and surfaces shell-based surface models,
// curves geometric curve sets. Analytic surfaces stay such. Plane curves lie in z = 0. The unit is the
// document's, a model's own if the document says none, and the millimetre if there is none.
//
// Edges are written with their curves in space; parameter curves are left to the reader, who finds them from
// those. Edges of trimmed surfaces that are not flat have the images of their parameter curves (exact up to
// rounding, of degree 18 for cubics on a bicubic surface), and the parameter curves. Loops are turned as the
// standard has them. Refuses, with the place: faces without loops, images of degrees above 25, loops that
// orient_loops refuses, curves of one or four coordinates, volumes, triangles (unsupported), documents with
// nothing to write (no_answer).
Result<std::string> write_step(const Document& document);

}  // namespace freiform
