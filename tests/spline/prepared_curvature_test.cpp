#include <freiform/query/surface_curvature.hpp>
#include <freiform/spline/prepared.hpp>

#include <gtest/gtest.h>
#include <limits>
#include <prepared.hpp>
#include <random.hpp>

namespace freiform {
namespace {

template <class P>
void expect_curvatures_within_bounds(int degree, std::uint64_t seed) {
    test::Random random(seed);
    auto one = test::random_basis(random, degree, {.spans = 3});
    auto two = test::random_basis(random, 3, {.spans = 3});
    const auto patch = test::random_patch_on<2, P>(random, {one, two});
    const auto fast = test::prepared(patch);
    auto at = test::parameters<2, P>(random, patch, 41, false);
    std::vector<SurfaceCurvature> exact;
    std::erase_if(at, [&](const Param<2>& uv) {
        auto c = surface_curvature(patch, uv);
        if (c) exact.push_back(*c);
        return !c;
    });
    ASSERT_GE(at.size(), 30U);
    test::with_every_variant([&] {
        std::vector<Curvatures> out(at.size());
        ASSERT_TRUE(fast.evaluate(at, out));
        for (std::size_t i = 0; i < at.size(); ++i) {
            EXPECT_NEAR(out[i].gauss, exact[i].gauss.value, 2 * exact[i].gauss.bound) << i;
            EXPECT_NEAR(out[i].mean, exact[i].mean.value, 2 * exact[i].mean.bound) << i;
        }
    });
}

TEST(PreparedPatch, curvatures_are_those_with_a_bound) {
    expect_curvatures_within_bounds<Vec<3>>(2, 1);
    expect_curvatures_within_bounds<Hom<3>>(3, 2);
    expect_curvatures_within_bounds<Hom<3>>(5, 3);
}

// (a u, b v, c (u^2 + v^2) / 2) on [-1, 1]^2: at the origin gauss c^2 / (a b)^2, mean c (1 / a^2 + 1 / b^2)
// / 2.
Surface<Vec<3>> bowl(double a, double b, double c) {
    const auto basis = *BSplineBasis::bezier(2, {-1, 1});
    const double x[3] = {-1, 0, 1}, square[3] = {1, -1, 1};
    std::vector<Vec<3>> net;
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j)
            net.push_back(Vec<3>{{a * x[i], b * x[j], c * (square[i] + square[j]) / 2}});
    return *Surface<Vec<3>>::make({basis, basis}, Net<2, Vec<3>>({3, 3}, std::move(net)));
}

TEST(PreparedPatch, curvatures_of_a_bowl_in_any_size_are_right) {
    for (const double a : {1.0, 0x1p-80, 0x1p90})
        for (const double b : {1.0, 0x1p-70}) {
            const double c = 3 * a;
            const auto fast = test::prepared(bowl(a, b, c));
            const std::vector<Param<2>> at(9, {0, 0});
            const double gauss = c / a * (c / a) / (b * b), mean = c * (1 / (a * a) + 1 / (b * b)) / 2;
            test::with_every_variant([&] {
                std::vector<Curvatures> out(at.size());
                ASSERT_TRUE(fast.evaluate(at, out));
                for (const Curvatures& k : out) {
                    EXPECT_NEAR(k.gauss, gauss, 1e-14 * gauss);
                    EXPECT_NEAR(k.mean, mean, 1e-14 * mean);
                }
            });
        }
}

TEST(PreparedPatch, curvatures_are_not_numbers_where_the_normal_vanishes_or_the_parameter_is_outside) {
    const auto fast =
        test::prepared(bowl(1, 0, 1));  // u, v -> (u, 0, ..): a plane, S_u x S_v = 0 where v = 0
    test::with_every_variant([&] {
        std::vector<Curvatures> out(3);
        const std::vector<Param<2>> at{{0.5, 0}, {0.5, 0.5}, {2, 0}};
        EXPECT_EQ(fast.evaluate(at, out).error().where, "at[2][0]");
        ASSERT_TRUE(fast.evaluate(at, out, Outside::nan));
        EXPECT_TRUE(std::isnan(out[0].gauss) && std::isnan(out[0].mean));
        EXPECT_EQ(out[1].gauss, 0);
        EXPECT_EQ(out[1].mean, 0);
        EXPECT_TRUE(std::isnan(out[2].gauss) && std::isnan(out[2].mean));
    });
}

TEST(PreparedPatch, curvatures_on_grids_are_those_of_scattered_parameters_also_past_the_caches) {
    test::Random random(4);
    const auto patch = test::random_patch<2, Hom<3>>(random, 3, {.ends = test::Ends::clamped, .spans = 3});
    const auto fast = test::prepared(patch);
    std::array<std::vector<double>, 2> axes;
    for (std::size_t d = 0; d < 2; ++d)
        for (int i = 0; i < (d == 0 ? 701 : 403); ++i) {
            const Interval on = patch.basis(int(d)).domain();
            axes[d].push_back(std::min(on.hi, on.lo + on.length() * (i % 17) / 16));
        }
    std::vector<Param<2>> at;
    for (const double u : axes[0])
        for (const double v : axes[1]) at.push_back({u, v});
    std::vector<Curvatures> grid(at.size()), scattered(at.size());
    ASSERT_TRUE(fast.evaluate(at, scattered));
    ASSERT_TRUE(fast.evaluate_grid({axes[0], axes[1]}, grid));
    double largest = 0;
    for (const Curvatures& k : scattered) largest = std::max({largest, std::abs(k.gauss), std::abs(k.mean)});
    std::size_t off = 0;
    for (std::size_t i = 0; i < at.size(); ++i)
        off += !(std::abs(grid[i].gauss - scattered[i].gauss) <= 1e-11 * largest) +
               !(std::abs(grid[i].mean - scattered[i].mean) <= 1e-11 * largest);
    EXPECT_EQ(off, 0U);
}

}  // namespace
}  // namespace freiform
