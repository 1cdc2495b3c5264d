#include "io/mesh_bytes.hpp"

#include <freiform/io/mesh_file.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>

namespace freiform {
namespace {

using Rgb = std::array<std::uint8_t, 3>;
constexpr Colour kUncoloured{0.8, 0.8, 0.8, 1};  // of parts without a colour beside parts that have one

Rgb rgb_of(const Colour& c) {
    const auto byte = [](double x) { return std::uint8_t(std::lround(255 * x)); };
    return {byte(c.r), byte(c.g), byte(c.b)};
}

std::string header_of(const TriangleMesh& mesh, const MeshWriteOptions& options, std::size_t polygons,
                      bool coloured) {
    const auto one_line = [](std::string s) {
        std::replace_if(
            s.begin(), s.end(), [](unsigned char c) { return c < ' '; }, '_');
        return s;
    };
    std::string h = text("ply\nformat binary_little_endian 1.0\ncomment ", one_line(options.generator), "\n");
    if (!mesh.unit.empty()) h += text("comment unit ", one_line(mesh.unit), "\n");
    h += text("element vertex ", mesh.vertices.size(),
              "\nproperty double x\nproperty double y\nproperty double z\n"
              "property float nx\nproperty float ny\nproperty float nz\n");
    if (coloured) h += "property uchar red\nproperty uchar green\nproperty uchar blue\n";
    return h + text("element face ", polygons, "\nproperty list uchar int vertex_indices\nend_header\n");
}

}  // namespace

// The vertices of different parts are different, so that a vertex can carry the colour of its part.
Result<std::string> to_ply(const TriangleMesh& mesh, const MeshWriteOptions& options) {
    if (auto r = validate(mesh); !r) return std::unexpected(r.error());
    std::size_t polygons = 0, corners = 0;
    const std::vector<MeshPart> parts = parts_of(mesh);
    for (const MeshPart& part : parts)
        for_each_polygon(mesh, part, [&](std::span<const int> p) { ++polygons, corners += p.size(); });
    const bool coloured =
        std::any_of(mesh.parts.begin(), mesh.parts.end(), [](const auto& p) { return p.colour; });
    std::vector<Rgb> colours(coloured ? mesh.vertices.size() : 0, rgb_of(kUncoloured));
    if (coloured)
        for (const MeshPart& part : mesh.parts)
            for (int t = part.first; t < part.first + part.count; ++t)
                for (int v : mesh.triangles[std::size_t(t)])
                    colours[std::size_t(v)] = rgb_of(part.colour.value_or(kUncoloured));

    std::string bytes = header_of(mesh, options, polygons, coloured);
    const std::size_t header = bytes.size(), vertex = 3 * 8 + 3 * 4 + (coloured ? 3 : 0);
    bytes.resize(header + vertex * mesh.vertices.size() + polygons + 4 * corners);
    ByteCursor out(bytes.data() + header);
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
        const Vec<3> n = unit(mesh.vertices[i].normal);
        out.put(mesh.points[std::size_t(mesh.vertices[i].point)].c);
        out.put(FloatPoint{float(n[0]), float(n[1]), float(n[2])});
        if (coloured) out.put(colours[i]);
    }
    for (const MeshPart& part : parts)
        for_each_polygon(mesh, part, [&](std::span<const int> p) {
            out.put(std::uint8_t(p.size()));
            for (const int v : p) out.put(v);
        });
    return bytes;
}

}  // namespace freiform
