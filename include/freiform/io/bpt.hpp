// .bpt: Bezier patches as plain text, the form in which Newell's teapot goes around.
//
//     2            number of patches
//     3 3          degrees m n of a patch
//     x y z        its (m + 1)(n + 1) points, one per line, the second index fastest
//     ...
//
// Empty lines and what follows a # are ignored.
#pragma once
#include <freiform/core/result.hpp>
#include <freiform/shape.hpp>

#include <string>
#include <string_view>

namespace freiform {

// The patches as surfaces on [0, 1] x [0, 1]. Refusals name the line. Memory is proportional to the text.
Result<Document> read_bpt(std::string_view text);

// Reads back to the same control points, to the last bit. Refuses (no_answer), with the object's index and
// name, what is not one polynomial Bezier patch in space; weights that are all 1 are none. Names, the unit
// and a domain other than [0, 1] x [0, 1] have no place in the format and are left out.
Result<std::string> write_bpt(const Document& document);

// "objects[3]", and the name if it has one: objects[3] "lid".
std::string object_label(const Document& document, std::size_t index);

}  // namespace freiform
