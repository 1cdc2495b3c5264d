#include <freiform/spline/prepared.hpp>

#include <gtest/gtest.h>
#include <limits>
#include <prepared.hpp>
#include <random.hpp>
#include <reference.hpp>

namespace freiform {
namespace {

using test::prepared;
using test::Random;
using test::with_every_variant;

template <std::size_t N, class P>
void expect_values_within_bound(int rounds, int max_degree, std::uint64_t seed) {
    Random random(seed);
    for (int round = 0; round < rounds; ++round) {
        const auto ends = round % 3 == 0   ? test::Ends::clamped
                          : round % 3 == 1 ? test::Ends::unclamped
                                           : test::Ends::closed;
        const auto patch = test::random_patch<N, P>(random, max_degree, {.ends = ends, .spans = 4});
        const auto fast = prepared(patch);
        const auto at = test::parameters<N, P>(random, patch, 13);
        std::vector<std::vector<test::Rational>> exact;
        for (const auto& u : at) exact.push_back(test::value_of<test::Rational>(patch, u));
        with_every_variant([&] {
            std::vector<PointOf<P>> out(at.size());
            ASSERT_TRUE(fast.evaluate(at, out));
            for (std::size_t i = 0; i < at.size(); ++i)
                for (int c = 0; c < PointOf<P>::kCoords; ++c)
                    ASSERT_LE(test::gap(out[i][c], exact[i][std::size_t(c)]), fast.value_error_bound())
                        << "round " << round << " parameter " << i;
        });
    }
}

TEST(PreparedPatch, values_of_curves_are_within_the_bound_of_exact_arithmetic) {
    expect_values_within_bound<1, Vec<1>>(9, 5, 1);
    expect_values_within_bound<1, Vec<2>>(9, 7, 2);
    expect_values_within_bound<1, Vec<3>>(9, 3, 3);
    expect_values_within_bound<1, Vec<4>>(9, 3, 4);
    expect_values_within_bound<1, Hom<1>>(9, 5, 5);
    expect_values_within_bound<1, Hom<2>>(9, 3, 6);
    expect_values_within_bound<1, Hom<3>>(12, 5, 7);
    expect_values_within_bound<1, Hom<4>>(9, 4, 8);
    expect_values_within_bound<1, Hom<3>>(3, 12, 9);
}

TEST(PreparedPatch, values_of_surfaces_are_within_the_bound_of_exact_arithmetic) {
    expect_values_within_bound<2, Vec<1>>(3, 3, 11);
    expect_values_within_bound<2, Vec<3>>(6, 5, 12);
    expect_values_within_bound<2, Hom<2>>(3, 3, 13);
    expect_values_within_bound<2, Hom<3>>(9, 4, 14);
    expect_values_within_bound<2, Hom<4>>(6, 4, 15);
}

TEST(PreparedPatch, values_of_volumes_are_within_the_bound_of_exact_arithmetic) {
    expect_values_within_bound<3, Vec<3>>(3, 3, 21);
    expect_values_within_bound<3, Hom<4>>(3, 2, 22);
}

// Equal degrees take the unrolled kernels.
TEST(PreparedPatch, surfaces_of_every_specialised_degree_are_within_the_bound) {
    Random random(31);
    for (const int p : {1, 2, 3, 5, 4}) {
        auto one = test::random_basis(random, p, {.spans = 3}),
             two = test::random_basis(random, p, {.spans = 3});
        const auto patch = test::random_patch_on<2, Hom<3>>(random, {one, two});
        const auto fast = prepared(patch);
        const auto at = test::parameters<2, Hom<3>>(random, patch, 10);
        with_every_variant([&] {
            std::vector<Vec<3>> out(at.size());
            ASSERT_TRUE(fast.evaluate(at, out));
            for (std::size_t i = 0; i < at.size(); ++i) {
                const auto exact = test::value_of<test::Rational>(patch, at[i]);
                for (int c = 0; c < 3; ++c)
                    ASSERT_LE(test::gap(out[i][c], exact[std::size_t(c)]), fast.value_error_bound()) << p;
            }
        });
    }
}

// What docs/evaluation.md says of the difference between two kernels.
TEST(PreparedPatch, kernels_differ_by_few_units_in_the_last_place_of_the_largest_coordinate) {
    Random random(61);
    double largest = 0;
    for (int round = 0; round < 12; ++round) {
        const auto patch = test::random_patch<2, Hom<3>>(random, 5, {.spans = 4});
        double c = 0;
        for (const auto& p : patch.net().flat()) c = std::max(c, max_abs(project(p)));
        const auto at = test::parameters<2, Hom<3>>(random, patch, 150);
        const auto fast = prepared(patch);
        std::vector<Vec<3>> first;
        with_every_variant([&] {
            std::vector<Vec<3>> out(at.size());
            ASSERT_TRUE(fast.evaluate(at, out));
            if (first.empty()) first = out;
            for (std::size_t i = 0; i < at.size(); ++i)
                largest = std::max(largest, max_abs(out[i] - first[i]) / (c * 0x1p-53));
        });
    }
    EXPECT_LE(largest, 12);
    std::printf("kernels differ by %.2f units\n", largest);
}

TEST(PreparedPatch, refuses_bad_parameters_before_it_writes_or_gives_nan_where_asked) {
    Random random(81);
    const auto patch = test::random_patch<2, Hom<3>>(random, 3, {.ends = test::Ends::clamped});
    const auto closed =
        test::random_patch_on<1, Vec<2>>(random, {*BSplineBasis::periodic(2, {0, 1, 2, 3, 4})});
    const auto on = patch.domain();
    const double inf = std::numeric_limits<double>::infinity();
    for (const double bad : {std::numeric_limits<double>::quiet_NaN(), inf, -inf,
                             std::nextafter(on[1].hi, inf), std::nextafter(on[1].lo, -inf)}) {
        std::vector<Param<2>> at(100, {on[0].lo, on[1].lo});
        at[97][1] = bad;
        const auto fast = prepared(patch);
        const auto ring = prepared(closed);
        with_every_variant([&] {
            std::vector<Vec<3>> out(at.size(), Vec<3>{{7, 7, 7}}), normals(at.size());
            const auto answer = fast.evaluate(at, out);
            ASSERT_FALSE(answer);
            EXPECT_EQ(answer.error().where, "at[97][1]");
            EXPECT_EQ(answer.error().kind,
                      std::isfinite(bad) ? RefusalKind::out_of_domain : RefusalKind::nonfinite);
            EXPECT_EQ(out, std::vector<Vec<3>>(at.size(), Vec<3>{{7, 7, 7}}));
            ASSERT_TRUE(fast.evaluate(at, out, normals, Outside::nan));
            EXPECT_EQ(out[96], out[98]);
            EXPECT_TRUE(is_finite(out[98]));
            for (int c = 0; c < 3; ++c) EXPECT_TRUE(std::isnan(out[97][c]) && std::isnan(normals[97][c]));
            const std::vector<double> axis{bad}, good{on[0].lo};
            EXPECT_EQ(fast.evaluate_grid({good, axis}, std::span(out).first(1)).error().where, "axes[1][0]");
            // A closed curve takes every finite number.
            std::vector<Vec<2>> round(3);
            const std::vector<double> turns{0.5, 8.5, bad};
            const auto wrapped = ring.evaluate(turns, round);
            EXPECT_EQ(wrapped.has_value(), std::isfinite(bad));
            ASSERT_TRUE(ring.evaluate(turns, round, Outside::nan));
            EXPECT_EQ(round[0], round[1]);
            EXPECT_EQ(std::isnan(round[2][0]), !std::isfinite(bad));
        });
    }
}

TEST(PreparedPatch, finds_spans_however_unevenly_they_are_spread) {
    std::vector<double> knots{0, 0, 0};
    for (int i = 0; i < 40; ++i) knots.push_back(1 + i * 0x1p-40);
    for (int i = 0; i < 5; ++i) knots.push_back(100.0 * (i + 1));
    for (int i = 0; i < 3; ++i) knots.push_back(1e6);
    Random random(91);
    const auto patch = test::random_patch_on<1, Vec<1>>(random, {*BSplineBasis::make(2, knots)});
    const auto fast = prepared(patch);
    const auto at = test::parameters(random, patch.basis(), 20);
    with_every_variant([&] {
        std::vector<Vec<1>> out(at.size());
        ASSERT_TRUE(fast.evaluate(at, out));
        for (std::size_t i = 0; i < at.size(); ++i)
            ASSERT_LE(test::gap(out[i][0], test::value_of<test::Rational>(patch, at[i])[0]),
                      fast.value_error_bound())
                << at[i];
    });
}

TEST(PreparedPatch, gives_the_end_points_of_clamped_curves_exactly) {
    Random random(95);
    for (int p = 1; p < 8; ++p) {
        const auto patch = test::random_patch_on<1, Vec<3>>(
            random, {test::random_basis(random, p, {.ends = test::Ends::clamped, .spans = 3})});
        const Interval on = patch.basis().domain();
        const std::vector<double> at{on.lo, on.hi};
        const auto fast = prepared(patch);
        with_every_variant([&] {
            std::vector<Vec<3>> out(2);
            ASSERT_TRUE(fast.evaluate(at, out));
            EXPECT_EQ(out[0], patch.net().flat().front());
            EXPECT_EQ(out[1], patch.net().flat().back());
        });
    }
}

TEST(PreparedPatch, rounds_once_to_single_precision) {
    Random random(97);
    const auto patch = test::random_patch<2, Hom<3>>(random, 3, {.spans = 4});
    const auto at = test::parameters<2, Hom<3>>(random, patch, 5000);
    const auto fast = prepared(patch);
    std::vector<Vec<3>> out(at.size());
    std::vector<float> single(3 * at.size());
    ASSERT_TRUE(fast.evaluate(at, out));
    ASSERT_TRUE(fast.evaluate(at, std::span(single)));
    for (std::size_t i = 0; i < single.size(); ++i) ASSERT_EQ(single[i], float(out[i / 3][int(i % 3)]));
}

TEST(PreparedPatch, leaves_extreme_patches_to_the_slow_way) {
    const auto tiny = *Curve<Vec<1>>::make({*BSplineBasis::make(1, {0, 0, 0x1p-101, 1, 1})},
                                           Net<1, Vec<1>>({3}, {Vec<1>{{0}}, Vec<1>{{1}}, Vec<1>{{2}}}));
    EXPECT_EQ((PreparedPatch<1, Vec<1>>::make(tiny).error().kind), RefusalKind::unsupported);
    const auto basis = *BSplineBasis::bezier(1);
    const auto large = *Curve<Vec<1>>::make({basis}, Net<1, Vec<1>>({2}, {Vec<1>{{0}}, Vec<1>{{0x1p101}}}));
    EXPECT_EQ((PreparedPatch<1, Vec<1>>::make(large).error().where), "points[1]");
    const auto light =
        *Curve<Hom<1>>::make({basis}, Net<1, Hom<1>>({2}, {Hom<1>{{0, 1}}, Hom<1>{{0, 0x1p-101}}}));
    EXPECT_EQ((PreparedPatch<1, Hom<1>>::make(light).error().where), "weights[1]");
}

}  // namespace
}  // namespace freiform
