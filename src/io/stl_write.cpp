#include "io/mesh_bytes.hpp"

#include <freiform/io/mesh_file.hpp>

#include <algorithm>
#include <cstdint>

namespace freiform {

// A text file begins with "solid", so that this header must not.
Result<std::string> to_stl(const TriangleMesh& mesh, const MeshWriteOptions& options) {
    constexpr std::size_t kHeader = 80, kFacet = 50;
    if (auto r = validate(mesh); !r) return std::unexpected(r.error());
    const auto points = float_points(mesh, {});
    if (!points) return std::unexpected(points.error());

    std::string header =
        text("binary STL; unit ", mesh.unit.empty() ? "unknown" : mesh.unit, "; ", options.generator);
    header.resize(kHeader, ' ');
    std::string bytes = std::move(header);
    bytes.resize(kHeader + 4 + kFacet * mesh.triangles.size());
    ByteCursor out(bytes.data() + kHeader + 4);
    std::uint32_t count = 0;
    for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
        const std::array<int, 3> corners = mesh.points_of(t);
        if (!has_three_points(*points, corners)) continue;
        const Vec<3> n = triangle_normal(mesh, t);
        for (int d = 0; d < 3; ++d) out.put(float(n[d]));
        for (int p : corners) out.put((*points)[std::size_t(p)]);
        out.put(std::uint16_t(0));
        ++count;
    }
    bytes.resize(std::size_t(out.at() - bytes.data()));
    ByteCursor(bytes.data() + kHeader).put(count);
    return bytes;
}

}  // namespace freiform
