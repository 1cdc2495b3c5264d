#include "mesh_edges_detail.hpp"

#include <freiform/core/sort.hpp>

#include <algorithm>
#include <limits>

namespace freiform {
namespace {

constexpr std::size_t kMaxInt = std::size_t(std::numeric_limits<int>::max());

Result<void> validate_parts(const TriangleMesh& mesh) {
    long long next = 0;
    for (std::size_t i = 0; i < mesh.parts.size(); ++i) {
        const MeshPart& part = mesh.parts[i];
        if (part.first != next || part.count < 0)
            return refuse(RefusalKind::invalid, text("parts[", i, "]"),
                          text("begins at triangle ", part.first, " and has ", part.count,
                               " of them; the part before ends at ", next));
        next += part.count;
        if (part.quads < 0 || part.quads > part.count / 2)
            return refuse(RefusalKind::invalid, text("parts[", i, "].quads"),
                          text(part.quads, " quads of ", part.count, " triangles"));
        for (std::size_t q = 0, t = std::size_t(part.first); q < std::size_t(part.quads); ++q, t += 2)
            if (next > (long long)(mesh.triangles.size()) ||
                mesh.triangles[t][0] != mesh.triangles[t + 1][0] ||
                mesh.triangles[t][2] != mesh.triangles[t + 1][1])
                return refuse(RefusalKind::invalid, text("parts[", i, "].quads"),
                              text("triangles ", t, " and ", t + 1, " are not (a, b, c) and (a, c, d)"));
        if (!part.colour) continue;
        for (double c : {part.colour->r, part.colour->g, part.colour->b, part.colour->a})
            if (!(c >= 0 && c <= 1))
                return refuse(RefusalKind::invalid, text("parts[", i, "].colour"),
                              text(c, " is outside [0, 1]"));
    }
    if (!mesh.parts.empty() && next != (long long)(mesh.triangles.size()))
        return refuse(RefusalKind::invalid, "parts",
                      text("cover ", next, " triangles of ", mesh.triangles.size()));
    return {};
}

// b - a, or half of it where that would overflow.
Vec<3> direction(const Vec<3>& a, const Vec<3>& b) {
    const Vec<3> d = b - a;
    return is_finite(d) ? d : 0.5 * b - 0.5 * a;
}

Vec<3> scaled_to_one(Vec<3> v) {
    const double m = max_abs(v);
    if (m == 0) return v;
    const int e = std::ilogb(m);
    for (int i = 0; i < 3; ++i) v[i] = std::scalbn(v[i], -e);
    return v;
}

}  // namespace

Result<void> validate(const TriangleMesh& mesh) {
    if (mesh.points.size() > kMaxInt || mesh.vertices.size() > kMaxInt || mesh.triangles.size() > kMaxInt)
        return refuse(RefusalKind::limit, "mesh",
                      text("more than ", kMaxInt, " points, vertices or triangles"));
    for (std::size_t i = 0; i < mesh.points.size(); ++i)
        if (!is_finite(mesh.points[i]))
            return refuse(RefusalKind::nonfinite, text("points[", i, "]"),
                          "a coordinate is not a finite number");
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
        const MeshVertex& v = mesh.vertices[i];
        if (v.point < 0 || std::size_t(v.point) >= mesh.points.size())
            return refuse(RefusalKind::invalid, text("vertices[", i, "]"),
                          text("point ", v.point, " of ", mesh.points.size()));
        if (!is_finite(v.normal) || !is_finite(v.uv))
            return refuse(RefusalKind::nonfinite, text("vertices[", i, "]"),
                          "the normal or the parameters are not finite numbers");
    }
    for (std::size_t i = 0; i < mesh.triangles.size(); ++i)
        for (int v : mesh.triangles[i])
            if (v < 0 || std::size_t(v) >= mesh.vertices.size())
                return refuse(RefusalKind::invalid, text("triangles[", i, "]"),
                              text("vertex ", v, " of ", mesh.vertices.size()));
    return validate_parts(mesh);
}

// The directions are scaled by powers of two where squares would leave the range of double; that changes no
// bit of the result, so that scaling the model by a power of two does not either.
Vec<3> triangle_normal(const TriangleMesh& mesh, std::size_t triangle) {
    const auto [a, b, c] = mesh.points_of(triangle);
    const Vec<3> u = direction(mesh.points[std::size_t(a)], mesh.points[std::size_t(b)]);
    const Vec<3> v = direction(mesh.points[std::size_t(a)], mesh.points[std::size_t(c)]);
    const Vec<3> n = cross(u, v);
    const double d = dot(n, n);
    if (d > 1e-200 && d < 1e200) return (1 / std::sqrt(d)) * n;
    return unit(cross(scaled_to_one(u), scaled_to_one(v)));
}

std::vector<double> smallest_angles(const TriangleMesh& mesh) {
    std::vector<double> angles(mesh.triangles.size());
    for (std::size_t t = 0; t < angles.size(); ++t) {
        const auto p = mesh.points_of(t);
        double least = 4;
        for (std::size_t k = 0; k < 3; ++k) {
            const Vec<3>& at = mesh.points[std::size_t(p[k])];
            const Vec<3> u = scaled_to_one(direction(at, mesh.points[std::size_t(p[(k + 1) % 3])]));
            const Vec<3> v = scaled_to_one(direction(at, mesh.points[std::size_t(p[(k + 2) % 3])]));
            const double across = norm(cross(u, v));
            least = std::min(least, across > 0 ? std::atan2(across, dot(u, v)) : 0.0);
        }
        angles[t] = least;
    }
    return angles;
}

SortedEdges::SortedEdges(const TriangleMesh& mesh) : begin_(mesh.points.size() + 2, 0) {
    const auto each = [&](auto&& f) {
        for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
            const std::array<int, 3> p = mesh.points_of(t);
            if (p[0] == p[1] || p[1] == p[2] || p[2] == p[0]) continue;
            for (std::size_t i = 0; i < 3; ++i) f(p[i], p[(i + 1) % 3], t);
        }
    };
    each([&](int a, int b, std::size_t) { ++begin_[std::size_t(std::min(a, b)) + 2]; });
    for (std::size_t i = 2; i < begin_.size(); ++i) begin_[i] += begin_[i - 1];
    entries_.resize(begin_.back());
    each([&](int a, int b, std::size_t t) {
        const auto other = std::uint64_t(std::max(a, b)), backward = std::uint64_t(a > b);
        entries_[begin_[std::size_t(std::min(a, b)) + 1]++] = other << 32 | std::uint64_t(t) << 1 | backward;
    });
}

void SortedEdges::each(std::size_t first, std::size_t end,
                       const std::function<void(const MeshEdge&)>& visit) {
    for (std::size_t a = first; a < end; ++a) {
        const auto* it = entries_.data() + begin_[a];
        const auto* const last = entries_.data() + begin_[a + 1];
        sort(entries_.data() + begin_[a], entries_.data() + begin_[a + 1]);
        while (it != last) {
            MeshEdge edge{int(a), int(*it >> 32), 0, 0, {-1, -1}};
            for (; it != last && int(*it >> 32) == edge.b; ++it) {
                const int uses = edge.forward + edge.backward;
                if (uses < 2) edge.triangles[std::size_t(uses)] = int((*it & 0xffffffffu) >> 1);
                ++(*it & 1 ? edge.backward : edge.forward);
            }
            visit(edge);
        }
    }
}

std::vector<MeshEdge> edges(const TriangleMesh& mesh) {
    std::vector<MeshEdge> out;
    out.reserve(3 * mesh.triangles.size() / 2);  // of closed meshes
    SortedEdges(mesh).each(0, mesh.points.size(), [&](const MeshEdge& edge) { out.push_back(edge); });
    return out;
}

}  // namespace freiform
