// Triangles of solids, counter-clockwise seen from outside.
//
// Idea. Faces say on which side the material is, and some files say it wrongly for all faces of a shell. The
// volume within a closed mesh tells: it is positive for the outer shell, the largest one, and negative for
// voids. What is not so is turned. Of shells that are not closed nothing is known, and nothing is done.
#include "tessellator_detail.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace freiform {

namespace {

constexpr double kNotClosed = 1e-9;  // of all areas: what the sum of normals of a closed mesh is in rounding

// Of the shell, positive where triangles are counter-clockwise from outside; 0 where that is not known.
double volume_of(const Shell& shell, const TriangleMesh& mesh, const std::vector<int>& part_of) {
    double volume = 0, area = 0;
    Vec<3> normals{};
    const Vec<3> origin = mesh.points.front();
    for (const FaceUse& u : shell.faces) {
        if (part_of[std::size_t(u.face)] < 0) return 0;
        const MeshPart& part = mesh.parts[std::size_t(part_of[std::size_t(u.face)])];
        for (int k = part.first; k < part.first + part.count; ++k) {
            const auto& t = mesh.triangles[std::size_t(k)];
            const auto at = [&](std::size_t c) {
                return mesh.points[std::size_t(mesh.vertices[std::size_t(t[c])].point)] - origin;
            };
            const Vec<3> n = cross(at(1) - at(0), at(2) - at(0));
            normals += n, area += norm(n), volume += dot(at(0), n);
        }
    }
    return norm(normals) <= kNotClosed * area ? volume : 0;
}

void turn(const MeshPart& part, TriangleMesh& mesh, std::vector<char>& is_turned) {
    for (int k = part.first; k < part.first + part.count; ++k) {
        // Turned over, the second half of a quad is the first.
        if (const int i = k - part.first; i < 2 * part.quads && i % 2 == 0)
            std::swap(mesh.triangles[std::size_t(k)], mesh.triangles[std::size_t(k) + 1]);
        auto& t = mesh.triangles[std::size_t(k)];
        std::swap(t[1], t[2]);
        for (const int v : t)
            if (!std::exchange(is_turned[std::size_t(v)], true))
                mesh.vertices[std::size_t(v)].normal = -mesh.vertices[std::size_t(v)].normal;
    }
}

}  // namespace

void turn_outwards(const Model& model, Tessellation& t) {
    std::vector<int> part_of(model.faces.size(), -1), shells(model.faces.size());
    for (std::size_t i = 0; i < t.mesh.parts.size(); ++i) part_of[std::size_t(t.mesh.parts[i].face)] = int(i);
    for (const Shell& shell : model.shells)
        for (const FaceUse& u : shell.faces)
            if (++shells[std::size_t(u.face)] > 1) part_of[std::size_t(u.face)] = -1;
    std::vector<char> is_turned(t.mesh.vertices.size());
    for (const Body& body : model.bodies) {
        if (!body.solid || t.mesh.points.empty()) continue;
        std::vector<double> volumes;
        for (const int s : body.shells)
            volumes.push_back(volume_of(model.shells[std::size_t(s)], t.mesh, part_of));
        if (std::ranges::find(volumes, 0) != volumes.end()) continue;  // the outer one may be among these
        const auto outer = std::ranges::max_element(volumes, {}, [](double v) { return std::abs(v); });
        for (auto v = volumes.begin(); v != volumes.end(); ++v) {
            if ((*v > 0) == (v == outer)) continue;
            const int shell = body.shells[std::size_t(v - volumes.begin())];
            t.turned_shells.push_back(shell);
            for (const FaceUse& u : model.shells[std::size_t(shell)].faces)
                turn(t.mesh.parts[std::size_t(part_of[std::size_t(u.face)])], t.mesh, is_turned);
        }
    }
}

}  // namespace freiform
