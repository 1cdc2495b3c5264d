#include "random.hpp"
#include "refusal.hpp"

#include <freiform/animate/easing.hpp>
#include <freiform/animate/keys.hpp>

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

namespace freiform {
namespace {

using test::Random;

std::vector<Key<2>> random_keys(Random& random, std::size_t n, Between next) {
    std::vector<Key<2>> keys(n);
    double t = random.real(-3, 3);
    const auto vec = [&] { return Vec<2>{{random.real(-1, 1), random.real(-1, 1)}}; };
    for (Key<2>& k : keys) {
        k.time = t += random.real(0.1, 2);
        k.value = vec(), k.arriving = vec(), k.leaving = vec(), k.next = next;
        k.easing = {random.real(0, 1), random.real(-1, 2), random.real(0, 1), random.real(-1, 2)};
    }
    for (std::size_t i = 0; i < n; ++i) {
        const double h = i + 1 < n ? keys[i + 1].time - keys[i].time : 0,
                     g = i > 0 ? keys[i].time - keys[i - 1].time : 0;
        keys[i].after = {keys[i].time + random.real(0, 1) * h, vec()};
        keys[i].before = {keys[i].time - random.real(0, 1) * g, vec()};
    }
    return keys;
}

TEST(Keys, hermite_is_the_formula_of_gltf) {
    Random random(7);
    for (int round = 0; round < 50; ++round) {
        const auto keys = random_keys(random, 5, Between::hermite);
        const auto track = *Track<2>::make(keys);
        for (std::size_t i = 0; i + 1 < keys.size(); ++i)
            for (int k = 1; k < 20; ++k) {
                const double time = keys[i].time + (keys[i + 1].time - keys[i].time) * k / 20;
                const double h = keys[i + 1].time - keys[i].time, t = (time - keys[i].time) / h;
                Vec<2> out;
                double bound = 0;
                track.evaluate({&time, 1}, {&out, 1}, {&bound, 1});
                for (int d = 0; d < 2; ++d) {
                    const double expected = (2 * t * t * t - 3 * t * t + 1) * keys[i].value[d] +
                                            h * (t * t * t - 2 * t * t + t) * keys[i].leaving[d] +
                                            (-2 * t * t * t + 3 * t * t) * keys[i + 1].value[d] +
                                            h * (t * t * t - t * t) * keys[i + 1].arriving[d];
                    EXPECT_NEAR(out[d], expected, 4e-15);
                }
                EXPECT_LT(bound, 1e-14);
            }
    }
}

TEST(Keys, every_kind_meets_its_keys_and_keeps_its_bound) {
    Random random(8);
    for (const Between next :
         {Between::step, Between::linear, Between::hermite, Between::bezier, Between::eased})
        for (int round = 0; round < 40; ++round) {
            const auto keys = random_keys(random, 4, next);
            const auto track = *Track<2>::make(keys);
            for (const Key<2>& k : keys) EXPECT_EQ(track(k.time), k.value);
            EXPECT_EQ(track(keys[0].time - 9), keys[0].value);
            EXPECT_EQ(track(keys[3].time + 9), keys[3].value);
            // Beside a key nothing jumps but steps.
            if (next != Between::step)
                for (std::size_t i = 1; i < 4; ++i) {
                    const double just = std::nextafter(keys[i].time, -100);
                    Vec<2> out;
                    double bound = 0;
                    track.evaluate({&just, 1}, {&out, 1}, {&bound, 1});
                    EXPECT_LE(max_abs(out - keys[i].value), bound + 1e-4);
                }
            // The same keys a little later give the same values.
            for (int k = 0; k < 20; ++k) {
                const double time = random.real(keys[0].time, keys[3].time);
                Vec<2> out;
                double bound = 0;
                track.evaluate({&time, 1}, {&out, 1}, {&bound, 1});
                auto later = keys;
                for (Key<2>& q : later) q.time *= 0.5, q.before.time *= 0.5, q.after.time *= 0.5;
                for (Key<2>& q : later) q.arriving *= 2.0, q.leaving *= 2.0;
                EXPECT_LE(max_abs((*Track<2>::make(later))(time / 2) - out), 2 * bound + 1e-300);
                EXPECT_LT(bound, 1e-6);
            }
        }
}

// Time and value by the parameter, the other way round than the track does.
TEST(Keys, bezier_keys_are_points_of_the_curve) {
    Random random(9);
    double worst = 0;
    for (int round = 0; round < 200; ++round) {
        const auto keys = random_keys(random, 2, Between::bezier);
        const auto track = *Track<2>::make(keys);
        const auto at = [&](double a, double b, double c, double d, double s) {
            const double r = 1 - s;
            return r * r * r * a + 3 * r * r * s * b + 3 * r * s * s * c + s * s * s * d;
        };
        for (double s = 0.1; s < 1; s += 0.2) {
            const double time = at(keys[0].time, keys[0].after.time, keys[1].before.time, keys[1].time, s);
            Vec<2> out;
            double bound = 0;
            track.evaluate({&time, 1}, {&out, 1}, {&bound, 1});
            for (int d = 0; d < 2; ++d) {
                const double off = std::abs(out[d] - at(keys[0].value[d], keys[0].after.value[d],
                                                        keys[1].before.value[d], keys[1].value[d], s));
                EXPECT_LE(off, 1e3 * bound);  // `time` itself is rounded
                worst = std::max(worst, off);
            }
        }
    }
    EXPECT_LT(worst, 1e-8);
}

TEST(Keys, eased_keys_follow_the_easing) {
    const auto track =
        *Track<1>::make({{.time = 2, .value = {{10}}, .next = Between::eased}, {.time = 4, .value = {{20}}}});
    const auto ease = *CubicBezierEasing::named("ease");
    for (double x = 0; x <= 1; x += 0.05)
        EXPECT_NEAR(track(2 + 2 * x)[0], 10 + 10 * ease(x).value, 1e-13) << x;
}

TEST(Keys, polynomial_ones_are_a_spline) {
    Random random(10);
    auto keys = random_keys(random, 6, Between::hermite);
    keys[2].next = Between::linear;
    const auto track = *Track<2>::make(keys);
    const auto curve = *track.curve();
    EXPECT_EQ(curve.domain()[0].lo, keys[0].time);
    for (int k = 0; k <= 100; ++k) {
        const double t = keys[0].time + (keys[5].time - keys[0].time) * k / 100;
        EXPECT_LE(max_abs(curve(t) - track(t)), 1e-13) << t;
    }
    keys[3].next = Between::step;
    test::expect_refusal(Track<2>::make(keys)->curve(), RefusalKind::unsupported, "keys[3]");
    EXPECT_FALSE(Track<2>::make({keys[0]})->curve());
}

TEST(Keys, tangents_are_those_of_the_schemes) {
    std::vector<Key<2>> keys(5);
    const double times[] = {0, 1, 3, 4, 8};
    for (std::size_t i = 0; i < 5; ++i)
        keys[i].time = times[i], keys[i].value = {{times[i] * times[i], -2 * times[i]}};
    set_tangents<2>(keys);
    for (std::size_t i = 1; i < 4; ++i) {
        const Vec<2> expected = (1 / (times[i + 1] - times[i - 1])) * (keys[i + 1].value - keys[i - 1].value);
        EXPECT_LE(max_abs(keys[i].leaving - expected), 1e-15);
        EXPECT_EQ(keys[i].leaving, keys[i].arriving);
    }
    // Lines are kept at constant speed, at the ends too.
    for (const Key<2>& k : keys) EXPECT_NEAR(k.leaving[1], -2, 1e-15);
    const std::array<TensionContinuityBias, 1> tight = {{{1, 0, 0}}};
    set_tangents<2>(keys, tight);
    for (const Key<2>& k : keys) EXPECT_EQ(max_abs(k.leaving), 0);
    const std::array<TensionContinuityBias, 1> corners = {{{0, -1, 0}}};  // each side its own slope
    set_tangents<2>(keys, corners);
    for (std::size_t i = 0; i + 1 < 3; ++i)
        EXPECT_GT(max_abs(keys[i + 1].leaving - keys[i + 1].arriving), 0.1);
}

TEST(Keys, repeat_and_mirror) {
    const std::vector<Key<1>> keys = {{.time = 1, .value = {{0}}}, {.time = 3, .value = {{4}}}};
    const auto repeated = *Track<1>::make(keys, BeyondKeys::repeat),
               mirrored = *Track<1>::make(keys, BeyondKeys::mirror);
    for (const double t : {1.25, 2.0, 2.75}) {
        const double v = (*Track<1>::make(keys))(t)[0];
        for (const double turns : {-6.0, 2.0, 40.0}) EXPECT_EQ(repeated(t + turns)[0], v);
        for (const double turns : {-8.0, 4.0, 40.0}) EXPECT_EQ(mirrored(t + turns)[0], v);
        EXPECT_EQ(mirrored(6 - t)[0], v);
    }
    const double nan = std::nan("");
    EXPECT_TRUE(std::isnan(repeated(nan)[0]));
}

TEST(Keys, refuses_what_contradicts_itself) {
    const auto refused = [](std::vector<Key<1>> keys, const char* where,
                            RefusalKind kind = RefusalKind::invalid) {
        test::expect_refusal(Track<1>::make(std::move(keys)), kind, where);
    };
    refused({}, "keys");
    refused({{.time = 0}, {.time = 0}}, "keys[1].time");
    refused({{.time = 0}, {.time = std::nan("")}}, "keys[1].time", RefusalKind::nonfinite);
    refused({{.time = 0, .value = {{INFINITY}}}}, "keys[0]", RefusalKind::nonfinite);
    refused({{.time = -1e308}, {.time = 1e308}}, "keys[1].time");
    refused({{.time = 0, .next = Between::bezier, .after = {2, {}}}, {.time = 1}}, "keys[0].after.time");
    refused({{.time = 0, .next = Between::bezier, .after = {1, {}}}, {.time = 1, .before = {-1, {}}}},
            "keys[1].before.time");
    refused({{.time = 0, .next = Between::eased, .easing = {2, 0, 1, 1}}, {.time = 1}}, "keys[0].easing.x1");
}

}  // namespace
}  // namespace freiform
