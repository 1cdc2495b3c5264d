#include "support/random.hpp"

#include <freiform/make/named_surface.hpp>

#include <gtest/gtest.h>

namespace freiform {
namespace {

using test::must;
using test::Random;
using Geometry = std::array<std::array<Vec<3>, 4>, 4>;

Geometry random_geometry(Random& random) {
    Geometry g;
    for (auto& row : g)
        for (Vec<3>& x : row)
            for (int c = 0; c < 3; ++c) x[c] = random.real(-1, 1);
    return g;
}

// R21: Q(s, t) = T^T M^T G M S, for every pair of named matrices.
TEST(R21, every_pair_of_matrices_gives_the_surface_of_the_product) {
    Random random(1);
    for (const NamedMatrix& mu : kNamedMatrices)
        for (const NamedMatrix& mv : kNamedMatrices) {
            const Geometry g = random_geometry(random);
            const auto s = must(bicubic(g, mu.matrix, mv.matrix));
            for (const double u : {0.0, 0.3, 0.75, 1.0})
                for (const double v : {0.0, 0.4, 1.0}) {
                    const auto f = basis_functions(mu.matrix, powers(u)),
                               h = basis_functions(mv.matrix, powers(v));
                    Vec<3> q{};
                    for (std::size_t i = 0; i < 4; ++i)
                        for (std::size_t j = 0; j < 4; ++j) q += (f[i] * h[j]) * g[i][j];
                    EXPECT_LT(norm(s(u, v) - q), 1e-14) << mu.name << " " << mv.name;
                }
        }
}

TEST(R21, bezier_geometry_is_the_net_and_hermite_geometry_has_tangents_and_twists) {
    Random random(2);
    const Geometry g = random_geometry(random);
    const auto bezier = must(bicubic(g, kBezier, kBezier));
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j) EXPECT_EQ(bezier.net().view()({i, j}), g[std::size_t(i)][std::size_t(j)]);
    const auto s = must(bicubic(g, kHermite, kHermite));
    for (const int i : {0, 1})
        for (const int j : {0, 1}) {
            const auto jet = s.jet<2>({double(i), double(j)});
            const std::size_t a = std::size_t(i), b = std::size_t(j);
            EXPECT_LT(norm(jet(0, 0) - g[a][b]), 1e-15);
            EXPECT_LT(norm(jet(1, 0) - g[a + 2][b]), 1e-14);
            EXPECT_LT(norm(jet(0, 1) - g[a][b + 2]), 1e-14);
            EXPECT_LT(norm(jet(1, 1) - g[a + 2][b + 2]), 1e-13);
        }
}

// R22: fix u, get the control points of the v-curve.
TEST(R22, a_patch_is_a_curve_of_curves) {
    Random random(3);
    const Geometry g = random_geometry(random);
    const auto s = must(bicubic(g, kCatmullRom, kBezier));
    for (const double u : {0.0, 0.2, 0.9}) {
        const auto points = curve_of_curves(g, kCatmullRom, u);
        const auto curve = iso(s, 0, u);
        for (std::size_t j = 0; j < 4; ++j) EXPECT_LT(norm(curve.net().flat()[j] - points[j]), 1e-15);
        for (const double v : {0.1, 0.5}) EXPECT_LT(norm(curve(v) - s(u, v)), 1e-15);
    }
    // At the start of a Catmull-Rom segment its second point.
    EXPECT_EQ(curve_of_curves(g, kCatmullRom, 0), g[1]);
}

TEST(R21, geometry_that_is_not_finite_is_refused_by_place) {
    Random random(4);
    Geometry g = random_geometry(random);
    g[2][3][1] = INFINITY;
    EXPECT_EQ(bicubic(g, kBezier, kBezier).error().where, "geometry[2][3]");
}

}  // namespace
}  // namespace freiform
