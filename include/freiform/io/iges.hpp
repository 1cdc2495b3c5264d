// IGES files (5.3): entities 126 (curves), 128 (surfaces), 144 (trimmed surfaces, with 142 and 102 for their
// loops) and 186 (solids, with 514 to 502 for shells, faces, loops, edges and vertices, and among them 100,
// 104, 110, 120 and 190 for what is round or straight), numbers as the shortest text that reads back as the
// same double.
#pragma once
#include <freiform/shape.hpp>

#include <string>

namespace freiform {

// Plane curves and surfaces lie in z = 0; closed ones are cut at their seam. Units as metres_per knows
// them; others, and none, count as the millimetre. Loops of trimmed surfaces are written in the parameters
// and in space, there as the images of the former (exact up to rounding), turned as orient_loops has them; a
// surface with several outer loops becomes several. Refuses, with the object, what is neither a curve nor a
// surface of two or three coordinates nor a model (unsupported; of models faces without loops, and offsets of
// surfaces that have no normal where they begin and end), images of degrees above 25, several outer loops
// with holes, and documents without objects (no_answer). Names of objects, bodies and faces are properties
// (406, form 15), colours of bodies and faces definitions (314) without opacity; layers, and names and
// colours of edges, are not written.
Result<std::string> write_iges(const Document& document);

}  // namespace freiform
