// Motions along curves that bend: limits hold everywhere, and what is known in closed form comes out.
#include "random.hpp"
#include "refusal.hpp"

#include <freiform/animate/motion.hpp>
#include <freiform/make/conic.hpp>

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

namespace freiform {
namespace {

using test::Random;

constexpr double kNoBend = std::numeric_limits<double>::infinity();

template <class P>
double curvature_at(const Curve<P>& c, double t) {
    const auto j = c.template jet<2>(t);
    const auto first = j(1), second = j(2);
    const double speed2 = dot(first, first);
    return norm(second - (dot(second, first) / speed2) * first) / speed2;
}

template <int D>
Curve<Vec<D>> random_curve(Random& random, int n) {
    std::vector<double> knots;
    for (int i = 0; i < n + 4; ++i) knots.push_back(std::clamp(i - 3, 0, n - 3));
    std::vector<Vec<D>> net;
    for (int i = 0; i < n; ++i) {
        Vec<D> p{};
        for (int d = 0; d < D; ++d) p[d] = 3.0 * i * (d == 0) + random.real(-2, 2);
        net.push_back(p);
    }
    return *Curve<Vec<D>>::make({*BSplineBasis::make(3, knots)}, Net<1, Vec<D>>({n}, net));
}

template <class P>
void expect_within(const Curve<P>& curve, const Motion& m, const BendLimits& limits, double accuracy) {
    const ArcLength<P> length(curve, accuracy);
    double before = 0, v_before = 0, a_before = 0;
    const int n = 1500;
    const double step = m.duration() / n;
    for (int i = 0; i <= n; ++i) {
        const auto s = m.at(m.duration() * i / n);
        EXPECT_GE(s.distance, before - 1e-9);
        EXPECT_LE(s.speed, limits.speed * (1 + 1e-9));
        EXPECT_LE(std::abs(s.acceleration), limits.acceleration * (1 + 1e-9));
        const double t = length.parameter(std::min(s.distance, length.total().value))->parameter;
        EXPECT_LE(s.speed * s.speed * curvature_at(curve, t), limits.across * (1 + 1e-6)) << "at " << t;
        // The speed does not jump, and is the derivative of the distance.
        if (i > 0 && std::isfinite(limits.acceleration)) {
            EXPECT_LE(std::abs(s.speed - v_before), limits.acceleration * step * (1 + 1e-6) + 1e-9);
            EXPECT_NEAR(s.distance - before, step * (s.speed + v_before) / 2,
                        limits.acceleration * step * step);
        }
        if (i > 0 && std::isfinite(limits.jerk))
            EXPECT_LE(std::abs(s.acceleration - a_before), limits.jerk * step * (1 + 1e-6) + 1e-9) << i;
        before = s.distance, v_before = s.speed, a_before = s.acceleration;
    }
    EXPECT_NEAR(m.at(m.duration()).distance, length.total().value, 2 * accuracy + 1e-9);
}

TEST(MotionAlong, keeps_all_limits_on_curves_in_the_plane_and_in_space) {
    Random random(5);
    for (int round = 0; round < 9; ++round) {
        const BendLimits limits{round % 3 == 0 ? kNoBend : random.real(1, 5), random.real(0.3, 4),
                                random.real(0.3, 4)};
        const auto plane = random_curve<2>(random, 8);
        const auto a = Motion::along(plane, limits, 1e-9);
        ASSERT_TRUE(a) << a.error().message;
        expect_within(plane, *a, limits, 1e-9);
        const auto space = random_curve<3>(random, 8);
        const auto b = Motion::along(space, limits, 1e-9);
        ASSERT_TRUE(b) << b.error().message;
        expect_within(space, *b, limits, 1e-9);
    }
}

// On a circle of the radius r the limit across is a limit of the speed.
TEST(MotionAlong, on_a_circle_is_that_of_the_speed_at_which_it_slips) {
    const auto circle =
        full_ellipse(Conic<2>{ConicKind::ellipse, {}, {{2, 0}}, {{0, 2}}}, EllipseForm::open)->curve;
    const double across = 4.5, v = std::sqrt(across * 2);
    const ArcLength<Hom<2>> length(circle, 1e-12);
    const auto plain = Motion::limited(length.total().value, {.speed = v, .acceleration = 1.5});
    const auto m = Motion::along(circle, {.acceleration = 1.5, .across = across}, 1e-10);
    ASSERT_TRUE(m) << m.error().message;
    EXPECT_GE(m->duration(), plain->duration() * (1 - 1e-9));
    EXPECT_LE(m->duration(), plain->duration() * 1.02);
}

TEST(MotionAlong, a_straight_way_is_what_limits_along_it_make_of_it) {
    const auto line =
        *Curve<Vec<2>>::make({*BSplineBasis::bezier(1)}, Net<1, Vec<2>>({2}, {{{0, 0}}, {{30, 40}}}));
    for (const double speed : {3.0, 100.0, kNoBend}) {
        const auto m = Motion::along(line, {.speed = speed, .acceleration = 2, .across = 0.1}, 1e-9);
        ASSERT_TRUE(m) << m.error().message;
        const auto plain = Motion::limited(50, {.speed = speed, .acceleration = 2});
        EXPECT_NEAR(m->duration(), plain->duration(), 1e-9);
        for (int i = 0; i <= 50; ++i)
            EXPECT_NEAR(m->at(m->duration() * i / 50).distance, plain->at(m->duration() * i / 50).distance,
                        1e-8);
    }
}

// Looser limits are never slower; halving the limit across and that along at once takes sqrt 2 times as long.
TEST(MotionAlong, is_faster_with_looser_limits_and_scales_with_time) {
    Random random(8);
    const auto curve = random_curve<3>(random, 9);
    const auto time = [&](double a, double across) {
        return Motion::along(curve, {.acceleration = a, .across = across}, 1e-9)->duration();
    };
    EXPECT_GE(time(1, 1), time(2, 1));
    EXPECT_GE(time(1, 1), time(1, 2));
    EXPECT_NEAR(time(0.5, 0.5), std::sqrt(2.0) * time(1, 1), 1e-9 * time(1, 1));
}

TEST(MotionAlong, stops_at_corners_and_refuses_where_it_cannot_pass) {
    const auto bent = *Curve<Vec<2>>::make({*BSplineBasis::make(1, {0, 0, 1, 2, 2})},
                                           Net<1, Vec<2>>({3}, {{{0, 0}}, {{4, 0}}, {{4, 9}}}));
    const auto m = Motion::along(bent, {.acceleration = 1, .across = 1}, 1e-9);
    ASSERT_TRUE(m) << m.error().message;
    EXPECT_NEAR(m->duration(), 2 * std::sqrt(4.0) + 2 * std::sqrt(9.0), 1e-9);
    EXPECT_NEAR(m->at(4).distance, 4, 1e-9);
    EXPECT_NEAR(m->at(4).speed, 0, 1e-9);
    const auto cusp = *Curve<Vec<2>>::make({*BSplineBasis::bezier(3)},
                                           Net<1, Vec<2>>({4}, {{{0, 0}}, {{1, 1}}, {{0, 1}}, {{1, 0}}}));
    test::expect_refusal(Motion::along(cusp, {.acceleration = 1, .across = 1}, 1e-9),
                         RefusalKind::ill_conditioned, "curve");
    test::expect_refusal(Motion::along(bent, {.across = 1}, 1e-9), RefusalKind::invalid, "speed");
    test::expect_refusal(Motion::along(bent, {.acceleration = 1, .across = -1}, 1e-9), RefusalKind::invalid,
                         "across");
    test::expect_refusal(Motion::along(bent, {.acceleration = 1, .across = 1}, 0), RefusalKind::invalid,
                         "accuracy");
}

TEST(MotionAlong, keeps_the_jerk_too_and_takes_longer_for_it) {
    Random random(6);
    for (int round = 0; round < 12; ++round) {
        BendLimits limits{round % 3 == 0 ? kNoBend : random.real(1, 5),
                          round % 4 == 3 ? kNoBend : random.real(0.3, 4), random.real(0.3, 4),
                          random.real(0.3, 6)};
        const auto curve = random_curve<3>(random, 8);
        const auto m = Motion::along(curve, limits, 1e-9);
        ASSERT_TRUE(m) << m.error().message;
        expect_within(curve, *m, limits, 1e-9);
        EXPECT_EQ(m->at(0).speed, 0);
        EXPECT_NEAR(m->at(m->duration()).acceleration, 0, 1e-6);
        if (std::isinf(limits.acceleration)) continue;
        limits.jerk = kNoBend;
        EXPECT_GE(m->duration(), Motion::along(curve, limits, 1e-9)->duration() * (1 - 1e-9));
    }
}

// What the limit of the jerk takes away gets small as it gets large.
TEST(MotionAlong, with_a_large_jerk_is_almost_that_without_a_limit) {
    Random random(7);
    for (int round = 0; round < 8; ++round) {
        const auto curve = random_curve<2>(random, 10);
        const BendLimits limits{random.real(1, 5), random.real(0.3, 4), random.real(0.3, 4)};
        BendLimits smooth = limits;
        smooth.jerk = 1e5;
        const double without = Motion::along(curve, limits, 1e-9)->duration(),
                     with = Motion::along(curve, smooth, 1e-9)->duration();
        EXPECT_LE(with, 1.05 * without) << round;
    }
}

TEST(MotionAlong, on_lines_and_circles_with_jerk_is_that_of_the_limits_along_them) {
    const auto line =
        *Curve<Vec<2>>::make({*BSplineBasis::bezier(1)}, Net<1, Vec<2>>({2}, {{{0, 0}}, {{30, 40}}}));
    for (const double speed : {3.0, 100.0, kNoBend})
        for (const double acceleration : {2.0, kNoBend}) {
            const auto m = Motion::along(
                line, {.speed = speed, .acceleration = acceleration, .across = 0.1, .jerk = 0.7}, 1e-9);
            ASSERT_TRUE(m) << m.error().message;
            const auto plain =
                Motion::limited(50, {.speed = speed, .acceleration = acceleration, .jerk = 0.7});
            EXPECT_NEAR(m->duration(), plain->duration(), 1e-6);
            for (int i = 0; i <= 50; ++i)
                EXPECT_NEAR(m->at(m->duration() * i / 50).distance,
                            plain->at(plain->duration() * i / 50).distance, 1e-5);
        }
    const auto circle =
        full_ellipse(Conic<2>{ConicKind::ellipse, {}, {{2, 0}}, {{0, 2}}}, EllipseForm::open)->curve;
    const double v = std::sqrt(4.5 * 2);
    const ArcLength<Hom<2>> length(circle, 1e-12);
    const auto plain = Motion::limited(length.total().value, {.speed = v, .acceleration = 1.5, .jerk = 2});
    const auto m = Motion::along(circle, {.acceleration = 1.5, .across = 4.5, .jerk = 2}, 1e-10);
    ASSERT_TRUE(m) << m.error().message;
    EXPECT_GE(m->duration(), plain->duration() * (1 - 1e-9));
    EXPECT_LE(m->duration(), plain->duration() * 1.02);
    test::expect_refusal(Motion::along(circle, {.across = 1, .jerk = 0}, 1e-9), RefusalKind::invalid, "jerk");
}

// Sizes of the numbers play no part: with another unit of time and length it is the same motion; and a jerk
// that is as good as none does no harm.
TEST(MotionAlong, with_jerk_keeps_its_shape_in_other_units) {
    Random random(9);
    const auto curve = random_curve<2>(random, 8);
    const double plain = Motion::along(curve, {.acceleration = 1, .across = 2, .jerk = 3}, 1e-9)->duration();
    for (const double s : {1e-20, 1e20}) {  // seconds are s times as long
        const auto m = Motion::along(
            curve, {.acceleration = 1 / s / s, .across = 2 / s / s, .jerk = 3 / s / s / s}, 1e-9);
        ASSERT_TRUE(m) << m.error().message;
        EXPECT_NEAR(m->duration(), s * plain, 1e-6 * s * plain);
    }
    const auto line =
        *Curve<Vec<2>>::make({*BSplineBasis::bezier(1)}, Net<1, Vec<2>>({2}, {{{0, 0}}, {{30, 40}}}));
    for (const double jerk : {1e30, 1e60}) {
        const auto m = Motion::along(line, {.acceleration = 2, .across = 1, .jerk = jerk}, 1e-9);
        ASSERT_TRUE(m) << m.error().message;
        EXPECT_NEAR(m->duration(), 2 * std::sqrt(50 / 2.0), 1e-6);
        EXPECT_NEAR(m->at(m->duration()).distance, 50, 1e-6);
    }
}

// A bend next to the start, which the motion passes while it still gets faster, and one far away.
TEST(MotionAlong, is_not_held_down_by_a_bend_that_it_passes_at_once) {
    const auto curve = *Curve<Vec<2>>::make(
        {*BSplineBasis::make(2, {0, 0, 0, 1, 2, 3, 4, 5, 5, 5})},
        Net<1, Vec<2>>(
            {7}, {{{0, 0}}, {{0.1, 0}}, {{0.2, 0.1}}, {{50, 50}}, {{100, 100}}, {{101, 102}}, {{101, 104}}}));
    const BendLimits limits{.acceleration = 1, .across = 1, .jerk = 3};
    const auto m = Motion::along(curve, limits, 1e-9);
    ASSERT_TRUE(m) << m.error().message;
    expect_within(curve, *m, limits, 1e-9);
    BendLimits free = limits;
    free.jerk = kNoBend;
    EXPECT_LE(m->duration(), 1.2 * Motion::along(curve, free, 1e-9)->duration());
}

}  // namespace
}  // namespace freiform
