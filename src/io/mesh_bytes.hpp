// What the writers of meshes share.
#pragma once
#include <freiform/core/interval.hpp>
#include <freiform/io/mesh_file.hpp>
#include <freiform/mesh/triangle_mesh.hpp>

#include <array>
#include <bit>
#include <cstring>
#include <string>
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

}  // namespace freiform
