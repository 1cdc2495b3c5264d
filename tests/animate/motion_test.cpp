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

constexpr double kNoLimit = std::numeric_limits<double>::infinity();

Curve<Vec<1>> speed_curve(std::vector<double> values, double length, int degree) {
    std::vector<Vec<1>> net;
    for (const double v : values) net.push_back({{v}});
    const int n = int(values.size());
    std::vector<double> knots;
    for (int i = 0; i < n + degree + 1; ++i)
        knots.push_back(length * std::clamp(i - degree, 0, n - degree) / double(n - degree));
    auto basis = BSplineBasis::make(degree, knots);
    return *Curve<Vec<1>>::make({*basis}, Net<1, Vec<1>>({n}, net));
}

TEST(Motion, keeps_its_limits_and_is_as_fast_as_they_allow) {
    Random random(11);
    int reached_speed = 0, reached_acceleration = 0;
    for (int round = 0; round < 400; ++round) {
        const MotionLimits limits{std::pow(10, random.real(-1, 1)),
                                  round % 5 == 0 ? kNoLimit : std::pow(10, random.real(-1, 1)),
                                  round % 5 == 1 ? kNoLimit : std::pow(10, random.real(-1, 1))};
        const double length = std::pow(10, random.real(-2, 2));
        const auto m = *Motion::limited(length, limits);
        EXPECT_EQ(m.length(), length);
        const double all = m.duration();
        double top = 0, most = 0, before = 0;
        const int n = 2000;
        for (int i = 0; i <= n; ++i) {
            const auto s = m.at(all * i / n);
            EXPECT_GE(s.distance, before - 1e-12 * length);
            // It goes the same way back.
            EXPECT_NEAR(s.distance + m.at(all * (n - i) / n).distance, length, 1e-11 * length);
            EXPECT_LE(s.bound, 1e-13 * length);
            if (i > 0 && i < n) {
                // The speed is the derivative.
                const double h = 1e-4 * all;
                if (i > 2 && i < n - 2 && std::isfinite(limits.jerk))
                    EXPECT_NEAR((m.at(all * i / n + h).distance - m.at(all * i / n - h).distance) / (2 * h),
                                s.speed, 1e-4 * limits.speed + limits.jerk * h * h);
                top = std::max(top, s.speed), most = std::max(most, std::abs(s.acceleration));
            }
            before = s.distance;
        }
        EXPECT_LE(top, limits.speed * (1 + 1e-12));
        EXPECT_LE(most, limits.acceleration * (1 + 1e-12));
        // At least one of them is reached, or the jerk never rests: then it is length = 2 j (T / 4)^3.
        const bool fast = top > limits.speed * (1 - 1e-9), strong = most > limits.acceleration * (1 - 1e-2);
        reached_speed += fast, reached_acceleration += strong;
        if (!fast && !strong && std::isfinite(limits.jerk))
            EXPECT_NEAR(2 * limits.jerk * std::pow(all / 4, 3), length, 1e-9 * length);
        // Known durations without a limit of the jerk.
        if (std::isinf(limits.jerk) && std::isfinite(limits.acceleration)) {
            const double v = limits.speed, a = limits.acceleration;
            EXPECT_NEAR(all, length > v * v / a ? length / v + v / a : 2 * std::sqrt(length / a),
                        1e-12 * all);
        }
        // Where speed and acceleration are reached: length / v + v / a + a / j.
        const double v = limits.speed, a = limits.acceleration, j = limits.jerk;
        if (std::isfinite(a) && std::isfinite(j) && v >= a * a / j && length >= v * (v / a + a / j))
            EXPECT_NEAR(all, length / v + v / a + a / j, 1e-12 * all);
    }
    EXPECT_GT(reached_speed, 50);
    EXPECT_GT(reached_acceleration, 50);
}

TEST(Motion, phases_join_in_place_speed_and_acceleration) {
    const auto m = *Motion::limited(10, {2, 1.5, 3});
    for (int i = 1; i < 100000; ++i) {
        const double t = m.duration() * i / 100000, h = m.duration() / 100000;
        const auto a = m.at(t - h), b = m.at(t);
        EXPECT_LE(std::abs(b.distance - a.distance), 2.001 * h);
        EXPECT_LE(std::abs(b.speed - a.speed), 1.501 * h);
        EXPECT_LE(std::abs(b.acceleration - a.acceleration), 3.001 * h);
    }
}

TEST(Motion, by_speed_is_the_integral) {
    // v = 1 + s on [0, 3]: s = e^t - 1.
    const auto growing = *Motion::with_speed(speed_curve({1, 4}, 3, 1), 1e-9);
    EXPECT_NEAR(growing.duration(), std::log(4.0), 1e-9);
    for (double t = 0; t < std::log(4.0); t += 0.01) {
        const auto s = growing.at(t);
        EXPECT_LE(std::abs(s.distance - (std::exp(t) - 1)), s.bound);
        EXPECT_LE(s.bound, 1e-9);
        EXPECT_NEAR(s.speed, std::exp(t), 1e-8);
        EXPECT_NEAR(s.acceleration, std::exp(t), 1e-7);
    }
    // v = 1 + s^2 on [0, 1]: s = tan t.
    const auto curved = *Motion::with_speed(speed_curve({1, 1, 2}, 1, 2), 1e-7);
    double closest = 0;
    for (double t = 0; t < std::numbers::pi / 4; t += 0.01) {
        const auto s = curved.at(t);
        EXPECT_LE(std::abs(s.distance - std::tan(t)), s.bound);
        closest = std::max(closest, std::abs(s.distance - std::tan(t)) / s.bound);
    }
    EXPECT_GT(closest, 0.001);
    // Against many small steps, of a spline that is almost still in places.
    const auto v = speed_curve({1, 0.01, 2, 0.02, 3, 1}, 5, 3);
    const auto m = *Motion::with_speed(v, 1e-6);
    double time = 0;
    const int n = 200000;
    for (int i = 0; i < n; ++i) {
        time += 5.0 / n / v(5 * (i + 0.5) / n)[0];
        if (i % 10000 == 9999) EXPECT_NEAR(m.at(time).distance, 5 * (i + 1.0) / n, 2e-6) << i;
    }
}

TEST(Motion, refuses_what_cannot_be) {
    test::expect_refusal(Motion::limited(-1, {}), RefusalKind::invalid, "length");
    test::expect_refusal(Motion::limited(1, {0}), RefusalKind::invalid, "speed");
    test::expect_refusal(Motion::limited(1, {1, -1}), RefusalKind::invalid, "acceleration");
    test::expect_refusal(Motion::limited(1, {kNoLimit}), RefusalKind::invalid, "speed");
    test::expect_refusal(Motion::uniform(1, 0), RefusalKind::invalid, "duration");
    test::expect_refusal(Motion::with_speed(speed_curve({1, -1}, 1, 1), 1e-6), RefusalKind::invalid, "speed",
                         "distance 1");
    test::expect_refusal(Motion::with_speed(speed_curve({1e-30, 1}, 1, 1), 1e-9), RefusalKind::limit,
                         "speed");
    EXPECT_EQ(Motion::limited(0, {})->duration(), 0);
    EXPECT_EQ(Motion::limited(3, {2})->duration(), 1.5);
}

TEST(Trajectory, moves_along_a_circle_as_the_formula_says) {
    const auto ring = *conic_arc(*circle(Vec<2>{{0, 0}}, 2), {0, 1.5 * std::numbers::pi});
    const double length = 3 * std::numbers::pi;
    const auto motion = *Motion::limited(length, {2, 1, 4});
    for (const Facing facing : {Facing::fixed, Facing::least_turning, Facing::upright}) {
        const auto t = *Trajectory::make(ring.curve, motion, {1e-9, facing});
        for (int i = 0; i <= 50; ++i) {
            const double time = motion.duration() * i / 50, angle = motion.at(time).distance / 2;
            const auto s = *t.at(time);
            const Vec<3> place{{2 * std::cos(angle), 2 * std::sin(angle), 0}},
                along{{-std::sin(angle), std::cos(angle), 0}};
            EXPECT_LE(norm(s.point - place), s.bound + 1e-12);
            EXPECT_LE(s.bound, 2e-9);
            EXPECT_LE(norm(s.tangent - along), 1e-8);
            if (facing == Facing::fixed) {
                EXPECT_EQ(s.facing, Quaternion{});
            } else {  // the circle is plane: both are the same
                EXPECT_LE(norm(rotated(s.facing, {{1, 0, 0}}) - along), 1e-8);
                EXPECT_LE(norm(rotated(s.facing, {{0, 0, 1}}) - Vec<3>{{0, 0, 1}}), 1e-8 + s.facing_bound);
            }
        }
    }
}

TEST(Trajectory, least_turning_does_not_turn_about_the_way) {
    Random random(12);
    std::vector<Vec<3>> net;
    for (int i = 0; i < 7; ++i) net.push_back({{double(i), random.real(-1, 1), random.real(-1, 1)}});
    const auto curve = *Curve<Vec<3>>::make({*BSplineBasis::clamped_uniform(3, 7)}, Net<1, Vec<3>>({7}, net));
    const double all = length(curve, 1e-9).value;
    const auto t = *Trajectory::make(curve, *Motion::uniform(all, 1), {1e-8, Facing::least_turning});
    double turned = 0, upright = 0;
    const auto other = *Trajectory::make(curve, *Motion::uniform(all, 1), {1e-8, Facing::upright});
    const int n = 1000;
    const auto about = [](const Trajectory::State& a, const Trajectory::State& b) {
        return dot(2.0 * log(conjugate(a.facing) * b.facing), Vec<3>{{1, 0, 0}});
    };
    for (int i = 0; i < n; ++i) {
        turned += std::abs(about(*t.at(double(i) / n), *t.at((i + 1.0) / n)));
        upright += std::abs(about(*other.at(double(i) / n), *other.at((i + 1.0) / n)));
    }
    EXPECT_LT(turned, 1e-3);
    EXPECT_GT(upright, 0.1);
    EXPECT_LE(t.at(0.5)->facing_bound, 1e-6);
    EXPECT_GT(t.at(0.5)->facing_bound, 0);
}

// Around three sides of a cube's corner: a quarter turn at each of two corners.
TEST(Trajectory, least_turning_goes_round_corners) {
    const auto way =
        *Curve<Vec<3>>::make({*BSplineBasis::make(1, {0, 0, 1, 2, 3, 3})},
                             Net<1, Vec<3>>({4}, {{{0, 0, 0}}, {{1, 0, 0}}, {{1, 1, 0}}, {{1, 1, 1}}}));
    const auto t = *Trajectory::make(way, *Motion::uniform(3, 3), {1e-9, Facing::least_turning});
    const Vec<3> x[] = {{{1, 0, 0}}, {{0, 1, 0}}, {{0, 0, 1}}},
                 z[] = {{{0, 0, 1}}, {{0, 0, 1}}, {{0, -1, 0}}};
    for (int i = 0; i < 3; ++i) {
        const auto s = *t.at(i + 0.5);
        EXPECT_LE(norm(rotated(s.facing, {{1, 0, 0}}) - x[i]), 1e-9);
        EXPECT_LE(norm(rotated(s.facing, {{0, 0, 1}}) - z[i]), 1e-9);
        EXPECT_LE(s.facing_bound, 1e-9);
    }
    // The smallest turn is not the projection: what is across the corner stays, what is along it turns.
    const auto bend = *Curve<Vec<3>>::make({*BSplineBasis::make(1, {0, 0, 1, 2, 2})},
                                           Net<1, Vec<3>>({3}, {{{0, 0, 0}}, {{1, 0, 0}}, {{1.6, 0.8, 0}}}));
    const auto turned =
        *Trajectory::make(bend, *Motion::uniform(2, 2), {1e-9, Facing::least_turning, {{0, 1, 1}}});
    EXPECT_LE(norm(rotated(turned.at(1.5)->facing, {{0, 0, 1}}) - std::sqrt(0.5) * Vec<3>{{-0.8, 0.6, 1}}),
              1e-9);
}

TEST(Trajectory, refuses_by_name) {
    const auto line =
        *Curve<Vec<3>>::make({*BSplineBasis::bezier(1)}, Net<1, Vec<3>>({2}, {{{0, 0, 0}}, {{0, 0, 2}}}));
    test::expect_refusal(Trajectory::make(line, *Motion::uniform(1, 1), {1e-6}), RefusalKind::invalid,
                         "motion");
    test::expect_refusal(Trajectory::make(line, *Motion::uniform(2, 1), {0}), RefusalKind::invalid,
                         "accuracy");
    const auto up = *Trajectory::make(line, *Motion::uniform(2, 1), {1e-6, Facing::upright});
    test::expect_refusal(up.at(0.5), RefusalKind::ill_conditioned, "at 0.5");
    test::expect_refusal(up.at(NAN), RefusalKind::nonfinite, "time");
}

// Speeds over three orders of magnitude: time runs forward, and twice the accuracy moves nothing by more than
// the bounds.
TEST(Motion, with_speeds_far_apart_never_runs_backwards) {
    Random random(21);
    for (int round = 0; round < 12; ++round) {
        std::vector<double> values;
        for (int i = 0; i < 6; ++i) values.push_back(std::pow(10, random.real(-2, 1)));
        const auto v = speed_curve(values, 3, 1 + round % 4);
        const auto m = Motion::with_speed(v, 1e-3), fine = Motion::with_speed(v, 1e-5);
        ASSERT_TRUE(m && fine);
        EXPECT_NEAR(m->duration(), fine->duration(), 1e-2 * m->duration());
        double before = 0;
        for (int i = 0; i <= 500; ++i) {
            const double t = m->duration() * i / 500;
            const auto s = m->at(t), f = fine->at(t);
            EXPECT_GE(s.distance, before);
            if (i < 500) EXPECT_GT(s.speed, 0);
            EXPECT_LE(std::abs(s.distance - f.distance), s.bound + f.bound);
            before = s.distance;
        }
    }
}

TEST(Motion, limits_with_huge_numbers_are_kept_or_refused) {
    for (const double scale : {1e100, 1e-100}) {
        const auto m = Motion::limited(scale, {.speed = scale, .acceleration = scale, .jerk = scale});
        ASSERT_TRUE(m) << scale;
        EXPECT_NEAR(m->at(m->duration() / 2).distance / scale, 0.5, 1e-12);
    }
    // The square of the length is no double.
    const auto far = Motion::limited(1e200, {.speed = kNoLimit, .jerk = 1});
    ASSERT_TRUE(far);
    EXPECT_NEAR(far->duration() / std::cbrt(32e200), 1, 1e-12);
    test::expect_refusal(Motion::limited(1e300, {.speed = 1e-300}), RefusalKind::limit, "length");
}

TEST(Trajectory, without_turning_goes_round_closed_curves_with_corners) {
    // A closed polygon-like spline: degree 2, double breaks make corners.
    const auto basis = BSplineBasis::periodic(2, {0, 0, 1, 1, 2, 2, 3});
    ASSERT_TRUE(basis) << basis.error().message;
    std::vector<Vec<2>> net;
    for (int i = 0; i < basis->size(); ++i) {
        const double a = 2 * std::numbers::pi * i / basis->size();
        net.push_back({{(2 + i % 2) * std::cos(a), (2 + i % 2) * std::sin(a)}});
    }
    const auto curve = Curve<Vec<2>>::make({*basis}, Net<1, Vec<2>>({basis->size()}, net));
    ASSERT_TRUE(curve);
    const double total = length(*curve, 1e-9).value;
    const auto m = *Motion::uniform(total, 2);
    const auto way = Trajectory::make(*curve, m, {.accuracy = 1e-6, .facing = Facing::least_turning});
    ASSERT_TRUE(way) << way.error().where << ": " << way.error().message;
    for (int i = 0; i <= 40; ++i) {
        const auto s = way->at(2.0 * i / 40);
        ASSERT_TRUE(s);
        EXPECT_NEAR(norm(s->tangent), 1, 1e-12);
    }
    for (const double wrong : {0.0, -1.0, kNoLimit})
        test::expect_refusal(
            Trajectory::make(*curve, m,
                             {.accuracy = 1e-6, .facing = Facing::least_turning, .facing_accuracy = wrong}),
            RefusalKind::invalid, "facing_accuracy");
}

}  // namespace
}  // namespace freiform
