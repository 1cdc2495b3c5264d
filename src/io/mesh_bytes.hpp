// What the writers of meshes share.
#pragma once
#include <freiform/core/interval.hpp>
#include <freiform/io/mesh_file.hpp>
#include <freiform/mesh/triangle_mesh.hpp>

#include <array>
#include <bit>
#include <cstring>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace freiform {

// All formats are little-endian and so are all machines that this is built for.
static_assert(std::endian::native == std::endian::little);

// Writes numbers one after the other into memory that is there already.
class ByteCursor {
public:
    explicit ByteCursor(char* at) : at_(at) {}
    template <class T>
    void put(T value) {
        std::memcpy(at_, &value, sizeof value);
        at_ += sizeof value;
    }
    char* at() const { return at_; }

private:
    char* at_;
};

template <class T>
std::string_view bytes_of(const std::vector<T>& list) {
    return {reinterpret_cast<const char*>(list.data()), list.size() * sizeof(T)};
}

using FloatPoint = std::array<float, 3>;

// Stored coordinates are (x - centre) 2^-exponent.
struct Placement {
    Vec<3> centre{};
    int exponent = 0;
};

Box<3> box_of(const TriangleMesh& mesh);

// All points rounded to floats. Refuses those that leave the range of float, and a mesh so small that all of
// its coordinates would lose bits to underflow.
Result<std::vector<FloatPoint>> float_points(const TriangleMesh& mesh, const Placement& placement);

// The parts, or one without a name if there are none.
std::vector<MeshPart> parts_of(const TriangleMesh& mesh);

// No two of the three positions are equal.
template <class Position>
bool has_three_points(const std::vector<Position>& points, const std::array<int, 3>& p) {
    const auto &a = points[std::size_t(p[0])], &b = points[std::size_t(p[1])], &c = points[std::size_t(p[2])];
    return a != b && b != c && c != a;
}

// Calls f with the corners of each quad and each other triangle of the part that has no two equal points; the
// halves of a quad that has are triangles of their own.
template <class F>
void for_each_polygon(const TriangleMesh& mesh, const MeshPart& part, F&& f) {
    const auto triangle = [&](std::size_t t) {
        if (has_three_points(mesh.points, mesh.points_of(t))) f(std::span<const int>(mesh.triangles[t]));
    };
    const auto point = [&](int v) -> const Vec<3>& {
        return mesh.points[std::size_t(mesh.vertices[std::size_t(v)].point)];
    };
    const std::size_t first = std::size_t(part.first), quads = std::size_t(part.quads);
    for (std::size_t t = first; t < first + 2 * quads; t += 2) {
        const auto &a = mesh.triangles[t], &b = mesh.triangles[t + 1];
        const std::array<int, 4> quad{a[0], a[1], a[2], b[2]};
        if (has_three_points(mesh.points, mesh.points_of(t)) &&
            has_three_points(mesh.points, mesh.points_of(t + 1)) && point(quad[1]) != point(quad[3]))
            f(std::span<const int>(quad));
        else
            triangle(t), triangle(t + 1);
    }
    for (std::size_t t = first + 2 * quads; t < first + std::size_t(part.count); ++t) triangle(t);
}

}  // namespace freiform
