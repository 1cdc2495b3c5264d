// Closed meshes with known shape for tests of writers, readers and pictures.
#pragma once
#include <freiform/mesh/triangle_mesh.hpp>

#include <cmath>
#include <numbers>

namespace freiform::test {

// A grid of nu x nv quadrilaterals, closed in both directions, on the torus with these radii about the z
// axis.
inline TriangleMesh torus(int nu, int nv, double major = 2, double minor = 0.7) {
    TriangleMesh mesh;
    for (int i = 0; i < nu; ++i)
        for (int j = 0; j < nv; ++j) {
            const double u = 2 * std::numbers::pi * i / nu, v = 2 * std::numbers::pi * j / nv;
            const Vec<3> n{{std::cos(u) * std::cos(v), std::sin(u) * std::cos(v), std::sin(v)}};
            mesh.vertices.push_back({int(mesh.points.size()), n, {{u, v}}});
            mesh.points.push_back(minor * n + Vec<3>{{major * std::cos(u), major * std::sin(u), 0}});
        }
    for (int i = 0; i < nu; ++i)
        for (int j = 0; j < nv; ++j) {
            const int k = (i + 1) % nu, l = (j + 1) % nv;
            mesh.triangles.push_back({i * nv + j, k * nv + j, k * nv + l});
            mesh.triangles.push_back({i * nv + j, k * nv + l, i * nv + l});
        }
    mesh.parts.push_back({"torus", Colour{0.8, 0.3, 0.2, 1}, 0, int(mesh.triangles.size()), 0});
    mesh.unit = "mm";
    return mesh;
}

// Rings of latitude between two poles, radius 1 about the origin.
inline TriangleMesh sphere(int rings, int around) {
    TriangleMesh mesh;
    const auto add = [&mesh](const Vec<3>& p) {
        mesh.vertices.push_back({int(mesh.points.size()), p, {}});
        mesh.points.push_back(p);
    };
    add({{0, 0, -1}});
    for (int i = 1; i < rings; ++i)
        for (int j = 0; j < around; ++j) {
            const double a = std::numbers::pi * i / rings, b = 2 * std::numbers::pi * j / around;
            add({{std::sin(a) * std::cos(b), std::sin(a) * std::sin(b), -std::cos(a)}});
        }
    add({{0, 0, 1}});
    const int last = int(mesh.points.size()) - 1;
    const auto at = [around](int ring, int j) { return 1 + (ring - 1) * around + j % around; };
    for (int j = 0; j < around; ++j) mesh.triangles.push_back({0, at(1, j + 1), at(1, j)});
    for (int i = 1; i + 1 < rings; ++i)
        for (int j = 0; j < around; ++j) {
            mesh.triangles.push_back({at(i, j), at(i, j + 1), at(i + 1, j + 1)});
            mesh.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i + 1, j)});
        }
    for (int j = 0; j < around; ++j) mesh.triangles.push_back({last, at(rings - 1, j), at(rings - 1, j + 1)});
    mesh.parts.push_back({"sphere", std::nullopt, 0, int(mesh.triangles.size()), 0});
    mesh.unit = "mm";
    return mesh;
}

// [0, 1]^3, six parts with a colour each but the first, two of them of one name; eight points.
inline TriangleMesh cube() {
    TriangleMesh mesh;
    for (int i = 0; i < 8; ++i) mesh.points.push_back({{double(i & 1), double(i >> 1 & 1), double(i >> 2)}});
    constexpr int kFaces[6][4] = {{0, 2, 3, 1}, {4, 5, 7, 6}, {0, 1, 5, 4},
                                  {2, 6, 7, 3}, {0, 4, 6, 2}, {1, 3, 7, 5}};
    const Colour colours[6] = {{},           {0, 0, 1, 1},   {1, 0, 0, 1},
                               {0, 1, 0, 1}, {1, 0.5, 0, 1}, {0.2, 0.4, 0.6, 0.5}};
    for (int f = 0; f < 6; ++f) {
        const int first = int(mesh.vertices.size());
        Vec<3> n;
        n[f < 2 ? 2 : f < 4 ? 1 : 0] = f % 2 ? 1 : -1;
        for (int k : kFaces[f]) mesh.vertices.push_back({k, n, {}});
        mesh.triangles.push_back({first, first + 1, first + 2});
        mesh.triangles.push_back({first, first + 2, first + 3});
        mesh.parts.push_back({f < 4 ? std::string("face ") + char('a' + f) : "side",
                              f ? std::optional(colours[f]) : std::nullopt, 2 * f, 2, f});
    }
    mesh.unit = "mm";
    return mesh;
}

}  // namespace freiform::test
