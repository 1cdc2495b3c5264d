// 3DM files (openNURBS, Rhino; versions 1 to 8) as models.
#pragma once
#include <freiform/io/step_read.hpp>

namespace freiform {

// The model in the file: its polysurfaces, surfaces and extrusions, blocks where they are inserted, or, if
// there is none of these, its curves as wires. Coordinates in the unit of the file, which Model::unit names;
// lengths that are less than its absolute tolerance count as nothing. Names and layers come along, and
// colours that objects have of their own.
//
// Curves and surfaces are what the file says: NURBS, lines, arcs, planes, surfaces of revolution (by angle);
// sums, extrusions and what is in stretched blocks up to rounding; maps of blocks that are similarities but
// for 2^-36 of their scale are taken for such. Parameter curves of edges are made new from edge and surface,
// as of STEP files (docs/step.md), and so are their bounds; what is mended or repaired is told likewise, by
// the object and the number of its face or edge in the file.
//
// What is not in the model stands in Model::refused: objects of kinds that are not read (unsupported: meshes,
// subdivision surfaces, points; texts, dimensions, lights and views are passed over), instances of blocks
// that are stretched (unsupported), faces that contradict themselves. Refuses: unreadable (with the byte)
// what is no such file, ends too early or is damaged, no_answer where nothing in it has a shape, limit.
// Whatever the bytes are, the answer comes, in time and memory proportional to their number and to what
// blocks make of them.
Result<Model> read_3dm(std::string_view bytes, const StepReadOptions& options = {});

}  // namespace freiform
