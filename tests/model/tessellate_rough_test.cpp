// Splines that are hard to follow: wild weights, rough shapes, knots a rounding apart.
#include "support/shapes.hpp"
#include "support/solids.hpp"

#include <ctime>
#include <gtest/gtest.h>

using namespace freiform;
using namespace freiform::test;

namespace {

// A spline of degree 2 with n x n control points and one weight per control point.
Model weighted(int n, const std::vector<double>& weights) {
    std::vector<double> knots{0, 0, 0};
    for (int i = 1; i + 2 < n; ++i) knots.push_back(double(i) / (n - 2));
    knots.insert(knots.end(), 3, 1.0);
    const auto basis = *BSplineBasis::make(2, knots);
    std::vector<Hom<3>> c;
    for (int i = 0; i < n * n; ++i) {
        const double w = weights[std::size_t(i)];
        c.push_back({{(i / n) * w, (i % n) * w, (i % 5 == 4) * w, w}});
    }
    ModelBuilder builder;
    EXPECT_TRUE(builder.add(*Surface<Hom<3>>::make({basis, basis}, Net<2, Hom<3>>({n, n}, c))));
    return *std::move(builder).finish();
}

TEST(Tessellate, weights_that_parameters_cannot_follow_are_refused_at_once) {
    std::vector<double> inner(64, 1.0), light = inner;
    inner[9 * 4] = 1e300;
    light[9 * 4] = 1e-300;
    const double m = 1e150, l = 1e-150;
    const Model torn[] = {weighted(3, {m, 1, 1, 1, l, 1, 1, 1, m}),
                          weighted(3, {1, 1, 1, 1, 1e300, 1, 1, 1, 1}),
                          weighted(3, {m, m, m, l, l, l, l, l, l}),
                          weighted(3, {1, 1, 1, 1, 1e20, 1, 1, 1, 1}), weighted(8, inner)};
    for (const Model& model : torn) {
        const auto start = std::clock();
        const auto t = tessellate(model, {.tolerance = 0.01});
        EXPECT_LT(double(std::clock() - start) / CLOCKS_PER_SEC, 2);
        ASSERT_TRUE(t) << t.error().message;
        ASSERT_EQ(t->refused.size(), 1u);
        EXPECT_EQ(t->refused[0].reason.kind, RefusalKind::ill_conditioned);
        EXPECT_FALSE(t->refused[0].reason.message.empty());
    }
    // One light point among others does no harm, and neither do weights that are all as large.
    for (const Model& model : {weighted(3, {1, 1, 1, 1, 1e-300, 1, 1, 1, 1}), weighted(8, light),
                               weighted(3, {m, m, m, m, m, m, m, m, m})}) {
        const auto t = tessellate(model, {.tolerance = 0.01});
        ASSERT_TRUE(t) << t.error().message;
        EXPECT_TRUE(t->refused.empty());
        EXPECT_LE(sampled_deviation(model, *t), t->error_bound);
    }
}

// Beside leaves of a rough face there are triangles that are hardly more than a side: where nothing is proven
// of them, the leaf is given up, not all of them, which takes 4,714 triangles here.
TEST(Tessellate, leaves_are_given_up_for_slivers_beside_them_one_by_one) {
    constexpr double kPoints[25][4] = {
        // and weights
        {-0.12, 0.27, 4.63, 0.59}, {0.06, 0.77, 4.15, 2.02},  {-0.3, 2.22, 1.89, 0.74},
        {0.21, 2.89, 1.1, 1.59},   {-0.03, 4.27, 7.09, 2.76}, {1.21, -0.23, 0.88, 1.46},
        {0.92, 1.16, 2.82, 0.49},  {0.72, 1.9, 8.94, 1.56},   {1.03, 3.15, 9.99, 2.52},
        {0.97, 3.77, 9.03, 1.71},  {1.87, -0.18, 9.07, 2.34}, {1.72, 1.11, 2.29, 1.39},
        {1.73, 2.21, 1.44, 1.62},  {1.93, 2.73, 1.37, 1.95},  {2.12, 4.13, 3.44, 2.07},
        {3.18, 0.07, 1, 2.71},     {2.93, 0.89, 4.01, 1.33},  {3.2, 2.03, 3.4, 1.61},
        {2.85, 2.9, 2.02, 0.92},   {2.73, 4.09, 2.77, 1.88},  {3.83, 0.17, 5.25, 1.35},
        {4.13, 1.09, 9.2, 1.59},   {3.9, 2.26, 6.68, 1.75},   {3.77, 3.08, 6.89, 0.7},
        {4.28, 4.07, 1.84, 0.34}};
    std::vector<Hom<3>> c;
    for (const auto& p : kPoints) c.push_back(freiform::weighted(Vec<3>{{p[0], p[1], p[2]}}, p[3]));
    const auto basis = *BSplineBasis::make(3, {0, 0, 0, 0, 1, 2, 2, 2, 2});
    ModelBuilder builder;
    ASSERT_TRUE(builder.add(*Surface<Hom<3>>::make({basis, basis}, Net<2, Hom<3>>({5, 5}, c))));
    const auto model = std::move(builder).finish();
    ASSERT_TRUE(model);
    const auto t = tessellate(*model, {.tolerance = 0.01});
    ASSERT_TRUE(t && t->refused.empty());
    EXPECT_LE(t->error_bound, 0.01);
    EXPECT_LE(sampled_deviation(*model, *t), t->error_bound);
    EXPECT_LT(t->mesh.triangles.size(), 4500u);
}

TEST(Tessellate, knots_a_rounding_apart_end_in_a_mesh_or_a_refusal) {
    std::mt19937 rng(13);
    const double twin = std::nextafter(0.5, 1);
    const auto basis = *BSplineBasis::make(3, {0, 0, 0, 0, 0.25, 0.5, 0.5, twin, 0.75, 1, 1, 1, 1});
    std::vector<Vec<3>> c;
    for (int i = 0; i < 9; ++i)
        for (int j = 0; j < 9; ++j) c.push_back({{i / 8.0, j / 8.0, 0.2 * uniform(rng, -1, 1)}});
    ModelBuilder builder;
    ASSERT_TRUE(builder.add(*Surface<Vec<3>>::make({basis, basis}, Net<2, Vec<3>>({9, 9}, c))));
    const auto model = std::move(builder).finish();
    const auto start = std::clock();
    const auto t = tessellate(*model, {.tolerance = 0.002});
    EXPECT_LT(double(std::clock() - start) / CLOCKS_PER_SEC, 20);
    ASSERT_TRUE(t) << t.error().message;
    if (t->refused.empty()) {
        EXPECT_LE(t->error_bound, 0.002);
        EXPECT_LE(sampled_deviation(*model, *t), t->error_bound);
    } else {
        EXPECT_FALSE(t->refused[0].reason.message.empty());
    }
}

}  // namespace
