// Idea. The mesh of a closed model is closed: each side of a triangle belongs to two, whichever faces these
// are of. So a line of zeros of the height over the plane, which leaves a triangle through the side where it
// enters the next, closes. Heights belong to points, which faces share, and are computed once: all triangles
// at a point agree about its side.
//
// Accuracy. Points of the mesh are within error_bound + boundary_gap of their faces (tessellate.hpp), and so
// are those between. The height n . p + d of a point, |n| = 1 but for 3 u, has seven roundings, each of at
// most u (3 max |p| + |d|); interpolation between two heights of different sign adds as many, and coordinates
// three u. 32 u (3 max |p| + |d|) is more than all of them. Heights up to 2^-40 of the coordinates count as
// 0, so that faces in the plane are in it whatever the last digits are.
//
// Why not clip the branches of the section of each surface (intersect/section.cpp) by its loops? That needs a
// section of every kind of analytic surface, and ends of branches that meet at edges only up to the tolerance
// of the file, so that nothing proves that they close.
#include <freiform/core/constants.hpp>
#include <freiform/core/sort.hpp>
#include <freiform/mesh/level_lines.hpp>
#include <freiform/model/section.hpp>

#include <algorithm>
#include <cmath>
#include <map>

namespace freiform {

namespace {

constexpr double kDecimals = 0x1p-40;  // of the coordinates

// The mesh with one vertex for each point, in one part.
TriangleMesh joined_mesh(const TriangleMesh& mesh) {
    TriangleMesh out;
    out.points = mesh.points;
    out.vertices.resize(mesh.points.size());
    for (std::size_t i = 0; i < out.vertices.size(); ++i) out.vertices[i].point = int(i);
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
        if (const auto t = mesh.points_of(i); t[0] != t[1] && t[1] != t[2] && t[2] != t[0])
            out.triangles.push_back(t);
    return out;
}

using Corners = std::array<int, 3>;  // points, in order

// The faces of the triangles that have points on both sides.
std::map<Corners, int> faces_at(const TriangleMesh& mesh, std::span<const double> height) {
    std::map<Corners, int> out;
    for (const MeshPart& part : mesh.parts)
        for (int i = part.first; i < part.first + part.count; ++i) {
            Corners c = mesh.points_of(std::size_t(i));
            const auto above = std::ranges::count_if(c, [&](int p) { return height[std::size_t(p)] >= 0; });
            if (above == 0 || above == 3) continue;
            sort(c);
            out[c] = part.face;
        }
    return out;
}

// The triangle that has both sides.
Corners corners_of(const EdgePlace& s, const EdgePlace& t) {
    Corners c{s.a, s.b, t.a == s.a || t.a == s.b ? t.b : t.a};
    sort(c);
    return c;
}

ModelSectionLine line_of(const LevelLine& from, const TriangleMesh& mesh, const std::map<Corners, int>& faces,
                         const Vec<3>& normal) {
    ModelSectionLine line;
    line.closed = from.closed;
    for (std::size_t i = 0; i < from.places.size(); ++i) {
        const EdgePlace& p = from.places[i];
        const Vec<3>&a = mesh.points[std::size_t(p.a)], &b = mesh.points[std::size_t(p.b)];
        const Vec<3> x = p.t == 0 ? a : p.t == 1 ? b : (1 - p.t) * a + p.t * b;
        if (!line.points.empty()) {
            if (x == line.points.back()) continue;  // through a corner of triangles
            const auto found = faces.find(corners_of(from.places[i - 1], p));
            line.faces.push_back(found == faces.end() ? -1 : found->second);
        }
        line.points.push_back(x);
    }
    if (!line.closed) return line;
    Vec<3> twice{};
    for (std::size_t i = 0; i + 1 < line.points.size(); ++i)
        twice = twice + cross(line.points[i] - line.points[0], line.points[i + 1] - line.points[0]);
    line.area = 0.5 * dot(twice, normal);
    return line;
}

}  // namespace

Result<ModelSection> section(const Model& model, const Plane& plane, const TessellateOptions& options) {
    if (!is_finite(plane.normal) || !std::isfinite(plane.offset))
        return refuse(RefusalKind::nonfinite, "plane", "has a number that is not finite");
    const double largest = max_abs(plane.normal);
    if (largest == 0) return refuse(RefusalKind::invalid, "plane", "has no normal");
    auto made = tessellate(model, options);
    if (!made) return std::unexpected(made.error());
    const Vec<3> direction = (1 / largest) * plane.normal;  // its square does not overflow
    const double length = norm(direction);
    const Vec<3> normal = (1 / length) * direction;
    const double offset = plane.offset / largest / length;
    const TriangleMesh mesh = joined_mesh(made->mesh);
    std::vector<double> height;
    double reach = 0;
    for (const Vec<3>& p : mesh.points) {
        height.push_back(dot(normal, p) + offset);
        reach = std::max(reach, max_abs(p));
    }
    ModelSection out;
    out.bound = made->error_bound + made->boundary_gap;
    const double scale = 3 * reach + std::abs(offset);
    // What lies in the plane but for the rounding of a file's decimals shall lie in it altogether.
    const double snapped = kDecimals * scale;
    for (double& h : height)
        if (std::abs(h) <= snapped) h = 0;
    out.plane_bound = 32 * kUnitRoundoff * scale + snapped;
    out.bound += out.plane_bound;
    out.refused = std::move(made->refused);
    const auto faces = faces_at(made->mesh, height);
    for (const LevelLine& l : level_lines(mesh, height, 0)) {
        ModelSectionLine line = line_of(l, mesh, faces, normal);
        if (line.points.size() < 2) continue;  // a corner touches the plane
        out.area += line.area;
        out.lines.push_back(std::move(line));
    }
    return out;
}

}  // namespace freiform
