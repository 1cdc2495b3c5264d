// STEP files (ISO 10303-21, editions 1 to 3; AP203, AP214, AP242) as models.
#pragma once
#include <freiform/io/mesh_file.hpp>
#include <freiform/model/model.hpp>

#include <cstdint>
#include <functional>
#include <string>
#include <string_view>

namespace freiform {

struct StepReadOptions {
    // That the model may take; an estimate is kept below it.
    std::uint64_t memory_bytes = std::uint64_t(4) << 30;
    // What contradicts itself beyond the tolerance of the file is made right where that is possible, and
    // listed in Model::repairs: open loops are closed by straight edges, edges far beside their surface are
    // taken with that as their tolerance, loops that run the wrong way are turned. Without it the face is
    // refused; of loops that run the wrong way, where the surface is not closed, it is only told.
    bool repair = false;
    // The longest gap of a loop that is closed, in the unit of the file; 0: a hundredth of the face.
    double repair_limit = 0;
    // The bytes of another file that parts of an assembly are in. `path`: from the folder of the first file
    // on, with slashes, never above it. Without it such parts are in Model::refused.
    std::function<Result<std::string>(const std::string& path)> open = {};
};

// The model in the file; coordinates in the unit of the file, which Model::unit names: that of the first
// representation with shapes, to which those in other units are scaled. Elementary curves and surfaces stay
// such. Assemblies are flattened, one body for each solid or shell in each place, also where parts are in
// other files.
//
// Every parameter curve is made here, from the edge and the surface: in closed form on planes and along
// isoparametric lines, else as a spline that follows the edge, which Model::approximations lists with the
// bound of its distance. Edges::tolerance is the uncertainty that the file states, or that bound if it is
// larger. Seams and poles that the file leaves out are added. What is not in the model stands in
// Model::refused, with the number of the instance.
//
// Refuses: unreadable (with the byte) what is no such file or ends too early, no_answer where nothing in it
// has a shape, limit. Whatever the bytes are, the answer comes, in time proportional to their number (and
// that of the bytes of other files).
Result<Model> read_step(std::string_view bytes, const StepReadOptions& options = {});

// The tessellated items of a file (AP242) as a mesh, in its unit, each where the assembly has it:
// triangulated faces and surface sets, also of strips and fans, in solids, shells and sets; a part for each
// face. Refuses, with the number of the instance, indices and counts that contradict each other (invalid) and
// items of other types (unsupported); no_answer where there are no triangles.
Result<TriangleMesh> read_step_mesh(std::string_view bytes, const MeshReadOptions& options = {});
// Whether every shape of a STEP file is of tessellated items; what is no such file has none.
bool has_only_triangles(std::string_view bytes);

}  // namespace freiform
