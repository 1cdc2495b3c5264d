// Matrices of glTF nodes.
#pragma once
#include <freiform/core/vec.hpp>

#include <array>

namespace freiform {

using NodeMatrix = std::array<double, 16>;  // by columns

inline constexpr NodeMatrix kIdentity{1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
inline constexpr NodeMatrix kYUpToZUp{1, 0, 0, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1};

inline NodeMatrix product(const NodeMatrix& a, const NodeMatrix& b) {
    NodeMatrix c{};
    for (std::size_t j = 0; j < 4; ++j)
        for (std::size_t i = 0; i < 4; ++i)
            for (std::size_t k = 0; k < 4; ++k) c[4 * j + i] += a[4 * k + i] * b[4 * j + k];
    return c;
}

inline Vec<3> moved(const NodeMatrix& m, const Vec<3>& p) {
    Vec<3> q;
    for (std::size_t i = 0; i < 3; ++i) q.c[i] = m[i] * p[0] + m[4 + i] * p[1] + m[8 + i] * p[2] + m[12 + i];
    return q;
}

// Normals follow the cofactors of the matrix; a reflection does not turn them round.
inline Vec<3> turned(const NodeMatrix& m, const Vec<3>& n) {
    const Vec<3> x{{m[0], m[1], m[2]}}, y{{m[4], m[5], m[6]}}, z{{m[8], m[9], m[10]}};
    const Vec<3> yz = cross(y, z), zx = cross(z, x), xy = cross(x, y);
    return (dot(x, yz) < 0 ? -1.0 : 1.0) * (n[0] * yz + n[1] * zx + n[2] * xy);
}

inline double determinant(const NodeMatrix& m) {
    return dot(Vec<3>{{m[0], m[1], m[2]}}, cross(Vec<3>{{m[4], m[5], m[6]}}, Vec<3>{{m[8], m[9], m[10]}}));
}

}  // namespace freiform
