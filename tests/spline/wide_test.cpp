// Of splines among those of four dimensions, the last of which are 0, everything is said as of themselves:
// what modules do, which have the code for four alone.
#include "support/curves.hpp"
#include "support/random.hpp"

#include <freiform/fit/approximate.hpp>
#include <freiform/path/flatten.hpp>
#include <freiform/query/continuity.hpp>
#include <freiform/query/reparametrise.hpp>
#include <freiform/spline/wide.hpp>

#include <gtest/gtest.h>

namespace freiform::test {
namespace {

template <class P>
Curve<P> some_curve(Random& random) {
    const auto basis = must(BSplineBasis::clamped_uniform(3, 9));
    std::vector<P> c;
    for (int i = 0; i < 9; ++i) {
        Vec<Space<P>::kDim> x;
        for (int d = 0; d < Space<P>::kDim; ++d) x[d] = random.real(-3, 3);
        c.push_back(Space<P>::lift(x, random.real(0.5, 2)));
    }
    return must(Curve<P>::make({basis}, Net<1, P>({9}, std::move(c))));
}

template <class P>
class Wide : public testing::Test {};
using Coefficients = testing::Types<Vec<1>, Vec<2>, Vec<3>, Hom<1>, Hom<2>, Hom<3>>;
TYPED_TEST_SUITE(Wide, Coefficients);

TYPED_TEST(Wide, curves_are_flattened_as_they_are) {
    constexpr int D = Space<TypeParam>::kDim;
    if (D != 3) return;  // others have ways of their own
    Random random(3);
    for (int n = 0; n < 20; ++n) {
        const auto c = some_curve<TypeParam>(random);
        for (const auto method : {FlattenMethod::adaptive, FlattenMethod::uniform, FlattenMethod::halving}) {
            const FlattenOptions options{.method = method, .tolerance = 0.01};
            const auto own = must(flatten(c, options));
            const auto wide = must(flatten(detail::widened(c), options));
            EXPECT_NEAR(own.bound, wide.bound, 1e-8);
            ASSERT_EQ(own.points.size(), wide.points.size());
            for (std::size_t i = 0; i < own.points.size(); ++i) {
                EXPECT_NEAR(own.parameters[i], wide.parameters[i], 1e-6);
                EXPECT_LE(norm(own.points[i] - detail::narrowed<D>(wide.points[i])), 1e-6);
            }
        }
    }
}

TYPED_TEST(Wide, curves_are_run_through_at_unit_speed_as_they_are) {
    constexpr int D = Space<TypeParam>::kDim;
    Random random(5);
    for (int n = 0; n < 5; ++n) {
        const auto c = some_curve<TypeParam>(random);
        const auto own = by_arc_length(c, 1e-3);
        const auto wide = by_arc_length(detail::widened(c), 1e-3);
        ASSERT_EQ(own.has_value(), wide.has_value());
        if (!own) continue;
        const auto narrow = detail::narrowed<D>(wide->curve);
        ASSERT_EQ(own->curve.basis().size(), narrow.basis().size());
        for (std::size_t i = 0; i < narrow.net().flat().size(); ++i)
            EXPECT_LE(norm(own->curve.net().flat()[i] - narrow.net().flat()[i]), 1e-9);
        EXPECT_NEAR(own->bound, wide->bound, 1e-9);
        EXPECT_NEAR(own->length.value, wide->length.value, 1e-12);
    }
}

TYPED_TEST(Wide, jumps_at_knots_are_the_same) {
    Random random(7);
    for (int n = 0; n < 20; ++n) {
        const auto c = some_curve<TypeParam>(random);
        const auto own = must(knot_lines(c, 0)), wide = must(knot_lines(detail::widened(c), 0));
        ASSERT_EQ(own.size(), wide.size());
        for (std::size_t i = 0; i < own.size(); ++i) {
            EXPECT_EQ(own[i].c_order, wide[i].c_order);
            for (std::size_t k = 0; k < own[i].c.size(); ++k) {
                EXPECT_NEAR(own[i].c[k].size, wide[i].c[k].size, 1e-12 * (1 + own[i].c[k].size));
                EXPECT_NEAR(wide[i].c[k].bound, own[i].c[k].bound, 1e-12 * (1 + own[i].c[k].size));
            }
        }
    }
}

TEST(WidePoints, points_are_approximated_as_they_are) {
    Random random(9);
    std::vector<Vec<3>> points;
    for (int i = 0; i < 60; ++i)
        points.push_back({{i / 10.0, std::sin(i / 7.0), 0.01 * random.real(-1, 1) + std::cos(i / 9.0)}});
    const ApproximateOptions options{.tolerance = 0.02};
    const std::vector<KeptPoint<3>> kept{{0, 1, {{1, 0, 0}}}};
    const std::vector<KeptPoint<4>> wide_kept{{0, 1, {{1, 0, 0, 0}}}};
    const auto wide_points = detail::widened(std::span<const Vec<3>>(points));
    const auto own = must(approximate<3>(points, options, kept));
    const auto wide = must(approximate<4>(wide_points, options, wide_kept));
    const auto narrow = detail::narrowed<3>(wide.curve);
    ASSERT_EQ(own.curve.basis().size(), narrow.basis().size());
    for (std::size_t i = 0; i < narrow.net().flat().size(); ++i)
        EXPECT_LE(norm(own.curve.net().flat()[i] - narrow.net().flat()[i]), 1e-9);
    EXPECT_NEAR(own.report.bound, wide.report.bound, 1e-9);
}

}  // namespace
}  // namespace freiform::test
