#include "io/mesh_builder.hpp"

#include <freiform/io/file.hpp>
#include <freiform/io/read.hpp>
#include <freiform/io/step_read.hpp>

#include <algorithm>
#include <limits>

namespace freiform {

Result<TriangleMesh> parse_mesh(std::string_view bytes, MeshFormat format, const std::string& name,
                                const MeshReadOptions& options) {
    MeshReadOptions bounded = options;
    constexpr auto kMost = std::uint64_t(std::numeric_limits<int>::max() / 3);  // three vertices each
    bounded.max_triangles = std::min(options.max_triangles, kMost);
    switch (format) {
        case MeshFormat::glb:
            return parse_glb(bytes, name, bounded);
        case MeshFormat::stl:
            return parse_stl(bytes, name, bounded);
        case MeshFormat::obj:
            return parse_obj(bytes, name, bounded);
        case MeshFormat::ply:
            return parse_ply(bytes, name, bounded);
    }
    return refuse(RefusalKind::unsupported, name, "not a format of meshes");
}

Result<TriangleMesh> read_mesh(const std::string& path, std::optional<MeshFormat> format,
                               const MeshReadOptions& options) {
    if (!format && format_of_name(path) == FileFormat::step) {
        const auto bytes = read_file(path, options.max_bytes);
        if (!bytes) return std::unexpected(bytes.error());
        auto mesh = read_step_mesh(*bytes, options);
        if (!mesh) return refuse_within(path, mesh.error());
        return mesh;
    }
    if (!format) {
        auto found = mesh_format(path);
        if (!found) return std::unexpected(found.error());
        format = *found;
    }
    const auto bytes = read_file(path, options.max_bytes);
    if (!bytes) return std::unexpected(bytes.error());
    return parse_mesh(*bytes, *format, path, options);
}

}  // namespace freiform
