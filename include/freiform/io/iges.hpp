// IGES files (5.3) of splines: entities 126 (curves) and 128 (surfaces), numbers as the shortest text that
// reads back as the same double.
#pragma once
#include <freiform/shape.hpp>

#include <string>

namespace freiform {

// Plane curves and surfaces lie in z = 0; closed ones are cut at their seam. Units: mm, cm, m, inch and ft;
// others, and none, count as the millimetre. Refuses, with the object, what is neither a curve nor a surface
// of two or three coordinates (unsupported; trimmed surfaces and models go to STEP), and documents without
// objects (no_answer).
Result<std::string> write_iges(const Document& document);

}  // namespace freiform
