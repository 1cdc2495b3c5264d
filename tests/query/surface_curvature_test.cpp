#include "support/shapes.hpp"

#include <freiform/query/surface_curvature.hpp>

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <cmath>
#include <cstdio>
#include <gtest/gtest.h>
#include <numbers>
#include <random>

namespace freiform {
namespace {

using Wide = boost::multiprecision::cpp_bin_float_100;

Vec<3> values_of(const BoundedVec<3>& a) { return {{a[0].value, a[1].value, a[2].value}}; }

const double kHalf = std::sqrt(0.5);

// Circle nets in (x, y) with their weights: 9 points round, 5 half round from (0, -1) to (0, 1).
std::vector<Hom<2>> full_circle() {
    const double x[9] = {1, 1, 0, -1, -1, -1, 0, 1, 1}, y[9] = {0, 1, 1, 1, 0, -1, -1, -1, 0};
    std::vector<Hom<2>> c;
    for (int i = 0; i < 9; ++i) c.push_back(weighted(Vec<2>{{x[i], y[i]}}, i % 2 == 0 ? 1 : kHalf));
    return c;
}
std::vector<Hom<2>> half_circle() {
    const double x[5] = {0, 1, 1, 1, 0}, y[5] = {-1, -1, 0, 1, 1};
    std::vector<Hom<2>> c;
    for (int i = 0; i < 5; ++i) c.push_back(weighted(Vec<2>{{x[i], y[i]}}, i % 2 == 0 ? 1 : kHalf));
    return c;
}

// The profile (distance from the z axis, height) turned round the z axis.
Surface<Hom<3>> turned(const std::vector<Hom<2>>& profile, std::vector<double> knots, int degree) {
    const auto round = full_circle();
    std::vector<Hom<3>> net;
    for (const Hom<2>& c : round)
        for (const Hom<2>& p : profile) net.push_back({{p[0] * c[0], p[0] * c[1], p[1] * c[2], p[2] * c[2]}});
    return *Surface<Hom<3>>::make({*BSplineBasis::make(2, {0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4}),
                                   *BSplineBasis::make(degree, std::move(knots))},
                                  Net<2, Hom<3>>({9, int(profile.size())}, net));
}
Surface<Hom<3>> sphere(double r) {
    auto profile = half_circle();
    for (Hom<2>& p : profile) p[0] *= r, p[1] *= r;
    return turned(profile, {0, 0, 0, 1, 1, 2, 2, 2}, 2);
}
Surface<Hom<3>> torus(double major, double minor) {
    auto profile = full_circle();
    for (Hom<2>& p : profile) p = weighted(Vec<2>{{major + minor * p[0] / p[2], minor * p[1] / p[2]}}, p[2]);
    return turned(profile, {0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4}, 2);
}

// The nets above hold sqrt(1/2) and their products only to double precision.
constexpr double kOfTheNet = 1e-13;

TEST(SurfaceCurvature, of_a_sphere_is_exact_to_rounding) {
    const auto s = sphere(2);
    double worst = 0;
    for (double u = 0.05; u < 4; u += 0.27)
        for (double v = 0.05; v < 2; v += 0.19) {
            const auto c = surface_curvature(s, {u, v});
            ASSERT_TRUE(c) << c.error().message;
            EXPECT_NEAR(c->gauss.value, 0.25, kOfTheNet);
            EXPECT_NEAR(c->mean.value, -0.5, kOfTheNet);
            EXPECT_NEAR(c->greatest.value, -0.5, kOfTheNet);
            EXPECT_NEAR(c->least.value, -0.5, kOfTheNet);
            EXPECT_TRUE(c->umbilic);
            const Vec<3> x = s(u, v);
            for (int d = 0; d < 3; ++d) EXPECT_NEAR(c->normal[std::size_t(d)].value, x[d] / 2, kOfTheNet);
            worst = std::max({worst, c->gauss.bound, c->mean.bound, c->greatest.bound});
        }
    EXPECT_LT(worst, 1e-10);
    EXPECT_GT(worst, 0);
}

TEST(SurfaceCurvature, of_a_torus_is_that_of_the_formula) {
    const double R = 5, r = 1.5;
    const auto s = torus(R, r);
    for (double u = 0.1; u < 4; u += 0.31)
        for (double v = 0.05; v < 4; v += 0.23) {
            const auto c = surface_curvature(s, {u, v});
            ASSERT_TRUE(c) << c.error().message;
            const Vec<3> x = s(u, v);
            const double distance = std::hypot(x[0], x[1]), cosine = (distance - R) / r;
            EXPECT_NEAR(c->gauss.value, cosine / (r * distance), kOfTheNet);
            EXPECT_NEAR(c->least.value, -1 / r, kOfTheNet);
            EXPECT_NEAR(c->greatest.value, -cosine / distance, kOfTheNet);
            // The tube bends most round itself: across the circle of latitude.
            const Vec<3> latitude{{-x[1] / distance, x[0] / distance, 0}};
            EXPECT_NEAR(std::abs(dot(c->along_greatest, latitude)), 1, 1e-10);
            EXPECT_NEAR(dot(c->along_least, latitude), 0, 1e-5);
        }
}

TEST(SurfaceCurvature, of_a_cylinder_is_one_over_the_radius_and_zero) {
    std::vector<Hom<2>> line = {weighted(Vec<2>{{3, 0}}, 1), weighted(Vec<2>{{3, 7}}, 1)};
    const auto s = turned(line, {0, 0, 1, 1}, 1);
    for (double u = 0; u <= 4; u += 0.25) {
        const auto c = surface_curvature(s, {u, 0.3});
        ASSERT_TRUE(c);
        EXPECT_NEAR(c->gauss.value, 0, kOfTheNet);
        EXPECT_LE(std::abs(c->gauss.value), c->gauss.bound + 1e-16);
        EXPECT_NEAR(c->greatest.value, 0, kOfTheNet);
        EXPECT_NEAR(c->least.value, -1.0 / 3, kOfTheNet);
        EXPECT_NEAR(std::abs(c->along_greatest[2]), 1, 1e-14);
        EXPECT_FALSE(c->umbilic);
    }
}

// All in 100 digits, from the coefficients, with derivatives of Bernstein sums written out.
struct WideCurvature {
    Wide gauss, mean;
};
template <class P>
WideCurvature wide_curvature(const Surface<P, Bernstein>& s, const Param<2>& uv) {
    const auto weight = [](int n, Wide u, int order) {
        std::vector<Wide> w(std::size_t(n) + 1, Wide(0));
        for (int i = 0; i <= n; ++i) {  // Bernstein of degree n - order, differenced `order` times
            for (int k = 0; k <= order; ++k) {
                const int m = n - order, j = i - k;
                if (j < 0 || j > m) continue;
                Wide b = Wide(binomial(m, j)) * pow(u, j) * pow(1 - u, m - j) * Wide(binomial(order, k));
                w[std::size_t(i)] += (order - k) % 2 ? -b : b;
            }
            for (int k = 0; k < order; ++k) w[std::size_t(i)] *= n - k;
        }
        return w;
    };
    using W = std::array<Wide, 4>;
    std::array<W, 6> h{};
    const int p = s.basis(0).degree(), q = s.basis(1).degree();
    for (const Index<2>& o : jet_orders<2>(2)) {
        const auto a = weight(p, uv[0], o[0]), b = weight(q, uv[1], o[1]);
        for (int i = 0; i <= p; ++i)
            for (int j = 0; j <= q; ++j) {
                const P& c = s.net().view()({i, j});
                for (int d = 0; d < P::kCoords; ++d)
                    h[jet_slot(o)][std::size_t(d)] += a[std::size_t(i)] * b[std::size_t(j)] * Wide(c[d]);
            }
    }
    if (P::kCoords == 3) h[0][3] = 1;
    std::array<std::array<Wide, 3>, 6> x{};
    for (std::size_t d = 0; d < 3; ++d) {
        x[0][d] = h[0][d] / h[0][3];
        x[1][d] = (h[1][d] - h[1][3] * x[0][d]) / h[0][3];
        x[2][d] = (h[2][d] - h[2][3] * x[0][d]) / h[0][3];
        x[3][d] = (h[3][d] - 2 * h[1][3] * x[1][d] - h[3][3] * x[0][d]) / h[0][3];
        x[4][d] = (h[4][d] - h[1][3] * x[2][d] - h[2][3] * x[1][d] - h[4][3] * x[0][d]) / h[0][3];
        x[5][d] = (h[5][d] - 2 * h[2][3] * x[2][d] - h[5][3] * x[0][d]) / h[0][3];
    }
    const auto dot3 = [](const auto& a, const auto& b) {
        return Wide(a[0] * b[0] + a[1] * b[1] + a[2] * b[2]);
    };
    const std::array<Wide, 3> m{x[1][1] * x[2][2] - x[1][2] * x[2][1], x[1][2] * x[2][0] - x[1][0] * x[2][2],
                                x[1][0] * x[2][1] - x[1][1] * x[2][0]};
    const Wide area = sqrt(dot3(m, m)), L = dot3(x[3], m) / area, M = dot3(x[4], m) / area,
               N = dot3(x[5], m) / area, E = dot3(x[1], x[1]), F = dot3(x[1], x[2]), G = dot3(x[2], x[2]);
    return {(L * N - M * M) / (area * area), (E * N - 2 * F * M + G * L) / (2 * area * area)};
}

template <class P>
void compare_with_wide(std::mt19937& rng, double& worst) {
    for (int round = 0; round < 60; ++round) {
        const int p = 1 + int(rng() % 5), q = 1 + int(rng() % 5);
        std::vector<P> net;
        for (int i = 0; i < (p + 1) * (q + 1); ++i) net.push_back(test::random_coefficient<P>(rng));
        const auto s = *Surface<P, Bernstein>::make({*Bernstein::make(p), *Bernstein::make(q)},
                                                    Net<2, P>({p + 1, q + 1}, net));
        const Param<2> uv{test::uniform(rng, 0, 1), test::uniform(rng, 0, 1)};
        const auto c = surface_curvature(s, uv);
        if (!c) continue;
        const WideCurvature exact = wide_curvature(s, uv);
        const auto ratio = [&](const Bounded& got, const Wide& want) {
            return double(abs(Wide(got.value) - want) / Wide(got.bound));
        };
        const Wide spread = sqrt(abs(exact.mean * exact.mean - exact.gauss));
        worst = std::max({worst, ratio(c->gauss, exact.gauss), ratio(c->mean, exact.mean),
                          ratio(c->greatest, exact.mean + spread), ratio(c->least, exact.mean - spread)});
    }
}

TEST(SurfaceCurvature, bounds_hold_against_a_hundred_digits) {
    std::mt19937 rng(71);
    double worst = 0;
    compare_with_wide<Vec<3>>(rng, worst);
    compare_with_wide<Hom<3>>(rng, worst);
    std::printf("largest error / bound of a curvature: %.3f\n", worst);
    EXPECT_LE(worst, 1);
    EXPECT_GT(worst, 1e-4);
}

TEST(SurfaceCurvature, of_a_triangle_is_that_of_the_same_quadric) {
    // z = x^2 + 3 x y over the unit triangle, as a triangle of degree 2; and as a bilinear-times-quadratic
    // patch.
    const std::vector<Vec<3>> b = {{{0, 0, 0}}, {{0.5, 0, 0}},     {{0, 0.5, 0}},
                                   {{1, 0, 1}}, {{0.5, 0.5, 1.5}}, {{0, 1, 0}}};
    const auto triangle = *SimplexPatch<2, Vec<3>>::make(2, b);
    const auto c = surface_curvature(triangle, {0.25, 0.5});
    ASSERT_TRUE(c) << c.error().message;
    const double zx = 2 * 0.25 + 3 * 0.5, zy = 3 * 0.25, g = 1 + zx * zx + zy * zy;
    EXPECT_NEAR(c->gauss.value, -9 / (g * g), c->gauss.bound);
    EXPECT_LT(c->gauss.bound, 1e-12);
    EXPECT_NEAR(c->mean.value, ((1 + zy * zy) * 2 - 2 * zx * zy * 3) / (2 * std::pow(g, 1.5)), c->mean.bound);
    EXPECT_FALSE(surface_curvature(triangle, {0.75, 0.5}));
}

TEST(SurfaceCurvature, scales_exactly_with_powers_of_two) {
    std::mt19937 rng(5);
    const auto s = test::random_patch<2, Hom<3>>(rng, {3, 2}, 2);
    std::vector<Hom<3>> net(s.net().flat().begin(), s.net().flat().end());
    for (Hom<3>& c : net)
        for (int d = 0; d < 3; ++d) c[d] *= 0x1p100;
    const auto big = *Surface<Hom<3>>::make(s.bases(), Net<2, Hom<3>>(s.net().extent(), net));
    const auto a = surface_curvature(s, {0.3, 0.4}), b = surface_curvature(big, {0.3, 0.4});
    ASSERT_TRUE(a && b);
    EXPECT_EQ(b->mean.value, a->mean.value * 0x1p-100);
    EXPECT_EQ(b->gauss.value, a->gauss.value * 0x1p-200);
    EXPECT_EQ(values_of(b->normal), values_of(a->normal));
}

TEST(SurfaceCurvature, is_refused_where_there_is_no_normal) {
    const auto s = sphere(1);
    for (double v : {0.0, 2.0}) {
        const auto c = surface_curvature(s, {0.3, v});
        ASSERT_FALSE(c);
        EXPECT_EQ(c.error().kind, RefusalKind::ill_conditioned);
    }
    EXPECT_EQ(surface_curvature(s, {5, 1}).error().kind, RefusalKind::out_of_domain);
    EXPECT_EQ(surface_curvature(s, {NAN, 1}).error().kind, RefusalKind::nonfinite);
}

TEST(LimitNormal, is_the_normal_at_regular_points) {
    const auto s = torus(5, 1);
    const auto c = surface_curvature(s, {1.3, 0.4});
    const auto n = limit_normal(s, {1.3, 0.4});
    ASSERT_TRUE(c && n);
    EXPECT_EQ(n->order, 0);
    for (int d = 0; d < 3; ++d) EXPECT_NEAR(n->normal[d], c->normal[std::size_t(d)].value, 1e-14);
}

TEST(LimitNormal, at_the_poles_of_a_sphere_is_the_axis) {
    const auto s = sphere(3);
    for (double u : {0.0, 0.3, 1.0, 2.7, 4.0})
        for (double v : {0.0, 2.0}) {
            const auto n = limit_normal(s, {u, v});
            ASSERT_TRUE(n) << n.error().message;
            EXPECT_EQ(n->order, 1);
            EXPECT_NEAR(n->normal[2], v == 0 ? -1 : 1, 1e-14);
            EXPECT_LT(std::hypot(n->normal[0], n->normal[1]), 1e-14);
            EXPECT_LT(n->bound, 1e-12);
        }
}

TEST(LimitNormal, at_the_apex_of_a_cone_depends_on_the_direction) {
    std::vector<Hom<2>> line = {weighted(Vec<2>{{0, 1}}, 1), weighted(Vec<2>{{1, 0}}, 1)};
    const auto s = turned(line, {0, 0, 1, 1}, 1);
    for (double u : {0.0, 0.5, 1.0, 2.3}) {
        const auto n = limit_normal(s, {u, 0}), beside = limit_normal(s, {u, 0.5});
        ASSERT_TRUE(n && beside);
        for (int d = 0; d < 3; ++d) EXPECT_NEAR(n->normal[d], beside->normal[d], 1e-13);
        EXPECT_NEAR(std::abs(n->normal[2]), kHalf, 1e-14);
    }
}

TEST(LimitNormal, is_found_where_two_derivatives_vanish) {
    // All of one boundary row and half of the next in one point: a corner where S_u and S_v are 0.
    std::vector<Vec<3>> net;
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j) net.push_back({{i * i / 9.0, j * j / 9.0 * (i + 1), 0}});
    const auto s = *Surface<Vec<3>, Bernstein>::make({*Bernstein::make(3), *Bernstein::make(3)},
                                                     Net<2, Vec<3>>({4, 4}, net));
    net[1] = net[4] = net[5] = net[0];
    const auto t = *Surface<Vec<3>, Bernstein>::make({*Bernstein::make(3), *Bernstein::make(3)},
                                                     Net<2, Vec<3>>({4, 4}, net));
    const auto n = limit_normal(t, {0, 0});
    ASSERT_TRUE(n) << n.error().message;
    EXPECT_GE(n->order, 2);
    EXPECT_NEAR(n->normal[2], 1, 1e-13);
}

TEST(LimitNormal, is_refused_on_patches_without_area_and_for_directions_that_leave) {
    std::vector<Vec<3>> net(9, Vec<3>{{1, 2, 3}});
    for (int i = 0; i < 9; ++i) net[std::size_t(i)][0] = i % 3;
    const auto flat = *Surface<Vec<3>, Bernstein>::make({*Bernstein::make(2), *Bernstein::make(2)},
                                                        Net<2, Vec<3>>({3, 3}, net));
    EXPECT_EQ(limit_normal(flat, {0.5, 0.5}).error().kind, RefusalKind::ill_conditioned);
    const auto s = sphere(1);
    EXPECT_EQ(limit_normal(s, {0.5, 0}, {{0, -1}}).error().kind, RefusalKind::out_of_domain);
    EXPECT_EQ(limit_normal(s, {0.5, 0}, {{0, 0}}).error().kind, RefusalKind::invalid);
}

// A roof: at the knot line the two sides have different normals.
TEST(LimitNormal, takes_the_side_that_the_direction_points_to) {
    std::vector<Vec<3>> net;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 2; ++j) net.push_back({{double(i), double(j), i == 1 ? 1.0 : 0.0}});
    const auto s = *Surface<Vec<3>>::make(
        {*BSplineBasis::make(1, {0, 0, 1, 2, 2}), *BSplineBasis::make(1, {0, 0, 1, 1})},
        Net<2, Vec<3>>({3, 2}, net));
    const auto right = limit_normal(s, {1, 0.5}, {{1, 0}}), left = limit_normal(s, {1, 0.5}, {{-1, 0}});
    ASSERT_TRUE(right && left);
    EXPECT_NEAR(right->normal[0], kHalf, 1e-15);
    EXPECT_NEAR(left->normal[0], -kHalf, 1e-15);
}

}  // namespace
}  // namespace freiform
