// Single patches: what is refused, closed and discontinuous ones, extreme degrees and knots.
#include "support/random.hpp"

#include <freiform/spline/bezier.hpp>
#include <freiform/spline/patch.hpp>

#include <cmath>
#include <gtest/gtest.h>
#include <limits>

namespace freiform {
namespace {

using test::must;
using test::Random;

TEST(Patch, refuses_nets_that_do_not_fit_and_coefficients_that_are_no_numbers) {
    const auto b = must(BSplineBasis::bezier(1));
    const auto where = [&](std::vector<Hom<1>> h) {
        const auto r = Curve<Hom<1>>::make({b}, Net<1, Hom<1>>({int(h.size())}, h));
        return r ? std::string("accepted") : text(name_of(r.error().kind), " ", r.error().where);
    };
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(where({{{1, 1}}, {{2, 1}}}), "accepted");
    EXPECT_EQ(where({{{1, 1}}}), "invalid points");
    EXPECT_EQ(where({{{1, 1}}, {{nan, 1}}}), "nonfinite points[1]");
    EXPECT_EQ(where({{{1, nan}}, {{1, 1}}}), "nonfinite points[0]");
    EXPECT_EQ(where({{{1, 1}}, {{2, 0}}}), "invalid weights[1]");
    EXPECT_EQ(where({{{1, 1}}, {{2, -1}}}), "invalid weights[1]");
    EXPECT_EQ(where({{{1, 1}}, {{0, 1e-310}}}), "ill_conditioned weights[1]");
    EXPECT_EQ(where({{{1, 1}}, {{1e300, 1e-300}}}), "limit points[1]");
    EXPECT_EQ(where({{{1.5e308, 1}}, {{0, 1}}}), "limit points[0]");
    const Vec<1> x[] = {{{1}}, {{2}}};
    const double w[] = {1, nan}, few[] = {1};
    EXPECT_EQ(make_rational<1>(x, w).error().where, "points[1]");
    EXPECT_EQ(make_rational<1>(x, few).error().where, "weights");
    EXPECT_EQ((Net<2, Vec<1>>::make({2, 2}, std::vector<Vec<1>>(3)).error().where), "net");
}

TEST(Patch, a_quarter_circle_has_radius_and_curvature_one) {
    const double w = std::sqrt(0.5);
    const auto c = must(Curve<Hom<2>>::make({must(BSplineBasis::bezier(2))},
                                            Net<1, Hom<2>>({3}, {{{1, 0, 1}}, {{w, w, w}}, {{0, 1, 1}}})));
    for (int i = 0; i <= 1000; ++i) {
        const auto j = c.jet<2>(i / 1000.0);
        ASSERT_NEAR(norm(j.value()), 1, 8 * 0x1p-53);
        ASSERT_NEAR(dot(j.value(), j(1)), 0, 1e-14);
        ASSERT_NEAR(cross(j(1), j(2)) / std::pow(norm(j(1)), 3), 1, 1e-14);
    }
}

TEST(Patch, a_closed_cubic_is_twice_differentiable_at_the_seam_and_not_thrice) {
    Random random(8);
    const auto b = must(BSplineBasis::periodic(3, {0, 0.5, 1.75, 2, 3}));
    const auto c = test::random_patch_on<1, Vec<2>>(random, {b});
    const auto left = c.jet<3>(3), right = c.jet<3>(0);
    EXPECT_LT(test::distance(left(0), right(0)), 1e-15 * 8);
    EXPECT_LT(test::distance(left(1), right(1)), 1e-14 * 8);
    EXPECT_LT(test::distance(left(2), right(2)), 1e-13 * 8);
    EXPECT_GT(test::distance(left(3), right(3)), 1);
    for (double u : {-7.25, 0.75 - 300, 3.5, 1000.0}) EXPECT_LT(test::distance(c(u), c(b.wrap(u))), 1e-15);
}

TEST(Patch, a_knot_of_multiplicity_degree_plus_one_has_the_value_of_its_right_hand_side) {
    for (int p = 0; p <= 5; ++p) {
        std::vector<double> t(std::size_t(p) + 1, 0.0);
        t.insert(t.end(), std::size_t(p) + 1, 1.0);
        t.insert(t.end(), std::size_t(p) + 1, 2.0);
        std::vector<Vec<1>> c(std::size_t(p) + 1, Vec<1>{{5}});
        c.insert(c.end(), std::size_t(p) + 1, Vec<1>{{7}});
        const auto s =
            must(Curve<Vec<1>>::make({must(BSplineBasis::make(p, t))}, Net<1, Vec<1>>({2 * p + 2}, c)));
        EXPECT_EQ(s(1.0)[0], 7);
        EXPECT_EQ(s(2.0)[0], 7);
        EXPECT_NEAR(s(std::nextafter(1.0, 0.0))[0], 5, 1e-14);
        if (p > 0) {
            EXPECT_NEAR(derivative(s, 0)(1.0)[0], 0, 0);
            EXPECT_EQ(derivative(s, 0).basis().degree(), p - 1);
        }
    }
}

TEST(Patch, the_highest_degree_and_the_shortest_spans_give_finite_values) {
    Random random(9);
    const auto high = test::random_patch_on<1, Hom<3>>(random, {must(BSplineBasis::clamped_uniform(25, 40))});
    for (const auto& u : test::parameters(random, high, 50)) ASSERT_TRUE(is_finite(high(u)));
    const double tiny = 1e-320;
    const auto b = must(BSplineBasis::make(2, {0, 0, 0, tiny, 2 * tiny, 1, 1, 1}));
    const auto s = test::random_patch_on<2, Hom<2>>(random, {b, b});
    for (const auto& u : test::parameters(random, s, 50)) ASSERT_TRUE(is_finite(s(u)));
    // Its derivative is above the largest double; asked for many, that is a refusal and not a NaN.
    const Param<2> at[] = {{0.5, 0.5}, {tiny, tiny}};
    Jet<2, 1, Vec<2>> jets[2];
    const auto r = s.evaluate<1>(at, jets);
    ASSERT_FALSE(r.has_value());
    EXPECT_EQ(r.error().where, "at[1]");
    EXPECT_EQ(r.error().kind, RefusalKind::ill_conditioned);
}

TEST(Bezier, keep_left_and_keep_right_are_the_parts_of_the_curve) {
    Random random(10);
    for (int p = 1; p <= 25; p += 3) {
        const auto c = test::random_patch_on<1, Vec<2>>(random, {must(BSplineBasis::bezier(p))});
        const double t = random.real(0, 1);
        Net<1, Vec<2>> left = c.net(), right = c.net();
        keep_left(left.view().fibre(0, {0}), t);
        keep_right(right.view().fibre(0, {0}), t);
        const auto l = must(Curve<Vec<2>>::make({c.basis()}, left)),
                   r = must(Curve<Vec<2>>::make({c.basis()}, right));
        for (double x : {0.0, 0.3, 0.9, 1.0}) {
            EXPECT_LT(test::distance(l(x), c(t * x)), 1e-13);
            EXPECT_LT(test::distance(r(x), c(t + (1 - t) * x)), 1e-13);
        }
    }
}

}  // namespace
}  // namespace freiform
