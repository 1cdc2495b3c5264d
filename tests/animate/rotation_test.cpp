#include "random.hpp"
#include "refusal.hpp"

#include <freiform/animate/rotation.hpp>

#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

namespace freiform {
namespace {

using test::Random;

Quaternion random_rotation(Random& random) {
    return unit({random.real(-1, 1), random.real(-1, 1), random.real(-1, 1), random.real(-1, 1)});
}
double distance(const Quaternion& a, const Quaternion& b) { return angle_between(a, b); }

TEST(Rotation, turns_as_its_matrix_does) {
    const Quaternion quarter = turn_about({{0, 0, 2}}, std::numbers::pi / 2);
    EXPECT_LE(norm(rotated(quarter, {{1, 0, 0}}) - Vec<3>{{0, 1, 0}}), 1e-15);
    Random random(3);
    for (int i = 0; i < 200; ++i) {
        const Quaternion a = random_rotation(random), b = random_rotation(random);
        const Vec<3> v{{random.real(-1, 1), random.real(-1, 1), random.real(-1, 1)}};
        EXPECT_LE(norm(rotated(a * b, v) - rotated(a, rotated(b, v))), 1e-14);
        EXPECT_NEAR(norm(rotated(a, v)), norm(v), 1e-14);
        EXPECT_LE(
            distance(from_axes(rotated(a, {{1, 0, 0}}), rotated(a, {{0, 1, 0}}), rotated(a, {{0, 0, 1}})), a),
            1e-14);
        EXPECT_LE(distance(exp(log(a)), a), 1e-14);
        EXPECT_LE(norm(log(turn_about(v, 0.5)) - 0.25 * unit(v)), 1e-15);
    }
    EXPECT_EQ(exp({{0, 0, 0}}), Quaternion{});
    EXPECT_NEAR(std::abs(exp(log(Quaternion{0, 0, 0, -1})).w), 1, 1e-15);
}

TEST(Rotation, slerp_turns_at_constant_speed_the_shorter_way) {
    Random random(4);
    for (int i = 0; i < 100; ++i) {
        const Quaternion a = random_rotation(random), b = random_rotation(random);
        const double all = angle_between(a, b);
        EXPECT_LE(all, std::numbers::pi);
        for (double t = 0; t <= 1; t += 0.125) {
            EXPECT_NEAR(angle_between(a, slerp(a, b, t)), t * all, 1e-14);
            EXPECT_LE(distance(slerp(a, b, t), slerp(a, -b, t)), 1e-14);
        }
    }
}

// Angular velocity by a difference.
Vec<3> velocity(const RotationTrack& track, double t, double h) {
    return (2 / h) * log(conjugate(track(t)) * track(t + h));
}

TEST(Rotation, tracks_meet_their_keys_and_are_as_smooth_as_they_say) {
    Random random(5);
    const std::vector<double> even = {0, 1, 2, 3, 4, 5}, uneven = {0, 0.3, 2, 2.5, 4, 5};
    for (int round = 0; round < 30; ++round) {
        std::vector<Quaternion> keys = {random_rotation(random)};
        for (int i = 1; i < 6; ++i)
            keys.push_back(keys.back() *
                           turn_about({{random.real(-1, 1), random.real(-1, 1), 1}}, random.real(0.2, 1.5)));
        for (std::size_t i = 0; i < 6; i += 2) keys[i] = -keys[i];  // signs mean nothing
        const auto slerped = *RotationTrack::make(uneven, keys, RotationTrack::Kind::slerp),
                   squad = *RotationTrack::make(uneven, keys, RotationTrack::Kind::squad),
                   spline = *RotationTrack::make(even, keys, RotationTrack::Kind::spline);
        for (std::size_t i = 0; i < 6; ++i) {
            EXPECT_LE(distance(slerped(uneven[i]), keys[i]), 1e-14);
            EXPECT_LE(distance(squad(uneven[i]), keys[i]), 1e-14);
        }
        EXPECT_LE(distance(spline(0), keys[0]) + distance(spline(5), keys[5]), 1e-14);
        double jump = 0;
        const double h = 1e-6;
        for (std::size_t i = 1; i < 5; ++i) {
            EXPECT_LE(norm(velocity(squad, uneven[i], h) - velocity(squad, uneven[i] - h, h)), 1e-4);
            jump =
                std::max(jump, norm(velocity(slerped, uneven[i], h) - velocity(slerped, uneven[i] - h, h)));
            // Acceleration, too.
            const double k = 1e-4;
            const auto bend = [&](double t) {
                return (1 / k) * (velocity(spline, t + k, k) - velocity(spline, t, k));
            };
            EXPECT_LE(norm(bend(even[i]) - bend(even[i] - 2 * k)), 0.05);
        }
        EXPECT_GT(jump, 0.1);
    }
}

TEST(Rotation, turns_about_one_axis_stay_about_it) {
    std::vector<Quaternion> keys;
    const std::vector<double> times = {0, 1, 2, 3};
    for (const double t : times) keys.push_back(turn_about({{1, 2, 2}}, 0.7 * t));
    for (const auto kind :
         {RotationTrack::Kind::slerp, RotationTrack::Kind::squad, RotationTrack::Kind::spline}) {
        const auto track = *RotationTrack::make(times, keys, kind);
        for (double t = 0; t <= 3; t += 0.1)
            EXPECT_LE(distance(track(t), turn_about({{1, 2, 2}}, 0.7 * t)), 1e-14);
    }
    const auto steps = *RotationTrack::make(times, keys, RotationTrack::Kind::step);
    EXPECT_EQ(steps(1.9), keys[1]);
}

TEST(Rotation, refuses_by_place) {
    using Kind = RotationTrack::Kind;
    test::expect_refusal(RotationTrack::make({}, {}, Kind::slerp), RefusalKind::invalid, "times");
    test::expect_refusal(RotationTrack::make({0}, {{}, {}}, Kind::slerp), RefusalKind::invalid, "times");
    test::expect_refusal(RotationTrack::make({0, 0}, {{}, {}}, Kind::slerp), RefusalKind::invalid,
                         "times[1]");
    test::expect_refusal(RotationTrack::make({0, 1, 3}, {{}, {}, {}}, Kind::spline), RefusalKind::invalid,
                         "times[1]");
    test::expect_refusal(RotationTrack::make({0, 1}, {{}, {0, 0, 0, 0}}, Kind::slerp), RefusalKind::invalid,
                         "keys[1]");
    test::expect_refusal(RotationTrack::make({0, 1}, {{}, {NAN, 0, 0, 1}}, Kind::slerp),
                         RefusalKind::nonfinite, "keys[1]");
}

}  // namespace
}  // namespace freiform
