// Triangle meshes as files: .glb, .stl, .obj, .ply.
//
//     | format | points          | normals          | parts                    | unit | | glb    | float, see
//     below| float            | names and colours        | metres, Y up; the mesh's kept | | stl    | float
//     | of the triangles | -                        | in the header                 | | obj    | double,
//     exact   | float            | names, colours (comment) | in a comment                  | | ply    |
//     double, exact   | float            | colours                  | in a comment                  |
//
// OBJ and PLY have quads where the parts have them (MeshPart::quads), the others their halves.
// Equal points are written with equal bits in every copy, so that a closed mesh stays closed. Triangles of
// which two points are equal as written are left out; this closes no gap and opens none. Thin triangles stay.
#pragma once
#include <freiform/core/result.hpp>
#include <freiform/mesh/triangle_mesh.hpp>

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

namespace freiform {

// One unit of length ("mm", "inch", ...) in metres; nothing if the name is not known.
std::optional<double> metres_per(std::string_view unit);

enum class MeshFormat { glb, stl, obj, ply };

// From the ending of a file name, or the ending alone ("glb"); case does not matter. Refuses others by naming
// those that are known.
Result<MeshFormat> mesh_format(std::string_view file_name);

struct MeshWriteOptions {
    std::string generator = "freiform";  // the program that the file names as its origin
};

// glTF 2.0, binary. Parts of equal name and colour are one primitive, parts of equal name one node.
// Coordinates that floats would spoil (a model far from the origin, very large or very small) are written
// relative to a node that moves and scales them back. An unknown unit counts as the metre.
Result<std::string> to_glb(const TriangleMesh& mesh, const MeshWriteOptions& options = {});

// Binary STL. Refuses coordinates that a float cannot hold.
Result<std::string> to_stl(const TriangleMesh& mesh, const MeshWriteOptions& options = {});

// Wavefront OBJ, a group per part.
Result<std::string> to_obj(const TriangleMesh& mesh, const MeshWriteOptions& options = {});

// Binary little-endian PLY, a colour per vertex where a part has one.
Result<std::string> to_ply(const TriangleMesh& mesh, const MeshWriteOptions& options = {});

// Writes the file whole or not at all; without a format its ending decides. "-" is standard output.
Result<void> write_mesh(const TriangleMesh& mesh, const std::string& path,
                        std::optional<MeshFormat> format = std::nullopt,
                        const MeshWriteOptions& options = {});

struct MeshReadOptions {
    std::uint64_t max_bytes = std::uint64_t(4) << 30;
    std::uint64_t max_triangles = 100'000'000;
};

// What the functions above write, and plain files of other programs: STL (binary, text), PLY (little-endian,
// text; polygons are cut into fans), OBJ (v, vn, f, g, o), glTF binary without extensions, in its default
// scene, turned to Z up. Points of equal coordinates become one point, so that `topology` says whether the
// mesh is closed. Triangles that have no area are kept. `name` stands in refusals. `read_mesh` without a
// format also takes STEP files, as read_step_mesh does.
Result<TriangleMesh> parse_mesh(std::string_view bytes, MeshFormat format, const std::string& name,
                                const MeshReadOptions& options = {});
Result<TriangleMesh> read_mesh(const std::string& path, std::optional<MeshFormat> format = std::nullopt,
                               const MeshReadOptions& options = {});

}  // namespace freiform
