#include "random.hpp"
#include "refusal.hpp"

#include <freiform/animate/easing.hpp>

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

namespace freiform {
namespace {

using test::Random;

// The graph by halving the parameter in long double: slow and obvious.
long double eased_slowly(const std::array<double, 4>& h, double x) {
    const auto at = [](long double p, long double q, long double s) {
        return 3 * p * s * (1 - s) * (1 - s) + 3 * q * s * s * (1 - s) + s * s * s;
    };
    long double lo = 0, hi = 1;
    for (int i = 0; i < 90; ++i) {
        const long double mid = (lo + hi) / 2;
        (at(h[0], h[2], mid) < x ? lo : hi) = mid;
    }
    return at(h[1], h[3], lo);
}

TEST(Easing, is_the_graph_of_the_curve_within_its_bound) {
    Random random(41);
    double worst_bound = 0, closest = 0;
    for (int i = 0; i < 3000; ++i) {
        const auto e = *CubicBezierEasing::make(random.real(0, 1), random.real(-2, 3), random.real(0, 1),
                                                random.real(-2, 3));
        const double x = random.real(0, 1);
        const Bounded y = e(x);
        const double off = double(std::abs((long double)(y.value) - eased_slowly(e.handles(), x)));
        ASSERT_LE(off, y.bound + 1e-18) << x;
        worst_bound = std::max(worst_bound, y.bound);
        closest = std::max(closest, off / y.bound);
    }
    EXPECT_LT(worst_bound, 1e-11);
    EXPECT_GT(closest, 0.02);  // bounds are not absurdly large
}

TEST(Easing, knows_the_curves_of_css) {
    EXPECT_EQ((*CubicBezierEasing::named("linear"))(0.3).value, 0.3);
    // Values that browsers give.
    EXPECT_NEAR((*CubicBezierEasing::named("ease"))(0.5).value, 0.8024033877, 1e-9);
    EXPECT_NEAR((*CubicBezierEasing::named("ease-in"))(0.25).value, 0.0934646507, 1e-9);
    EXPECT_NEAR((*CubicBezierEasing::named("ease-in-out"))(0.5).value, 0.5, 1e-15);
    for (const char* name : {"ease", "ease-in", "ease-out", "ease-in-out"}) {
        const auto e = *CubicBezierEasing::named(name);
        EXPECT_EQ(e(0).value, 0) << name;
        EXPECT_EQ(e(1).value, 1) << name;
    }
    // Point symmetry.
    const auto in = *CubicBezierEasing::named("ease-in"), out = *CubicBezierEasing::named("ease-out");
    for (double x = 0; x <= 1; x += 0.0625) EXPECT_NEAR(in(x).value, 1 - out(1 - x).value, 1e-15);
}

TEST(Easing, is_honest_where_the_graph_is_vertical) {
    // x = 4 (s - 1/2)^3 + 1/2: vertical in the middle.
    const auto e = *CubicBezierEasing::make(1, 0, 0, 1);
    for (const double x : {0.5, 0.5 + 1e-12, 0.5 - 1e-9, 0.500001}) {
        const Bounded y = e(x);
        EXPECT_LE(std::abs(y.value - double(eased_slowly(e.handles(), x))), y.bound) << x;
        EXPECT_LT(y.bound, 1e-4) << x;
    }
    EXPECT_GT(e(0.5).bound, 1e-7);
    // Flat in time at both ends.
    const auto flat = *CubicBezierEasing::make(0, 1, 0, 1);
    for (const double x : {1e-300, 1e-30, 1e-9}) {
        const Bounded y = flat(x);
        EXPECT_LE(std::abs(y.value - double(eased_slowly(flat.handles(), x))), y.bound) << x;
    }
}

TEST(Easing, goes_on_along_its_tangents) {
    const auto e = *CubicBezierEasing::make(0.25, 0.5, 0.5, 0.75);
    EXPECT_EQ(e(-1).value, -2);
    EXPECT_EQ(e(3).value, 2);
    EXPECT_EQ((*CubicBezierEasing::make(0, 0, 0.5, 0.25))(-1).value, -0.5);
    EXPECT_EQ((*CubicBezierEasing::make(0.5, 0.25, 1, 1))(2).value, 2.5);
    EXPECT_EQ((*CubicBezierEasing::make(0, 0.5, 1, 0.5))(-1).value, 0);
    EXPECT_EQ((*CubicBezierEasing::make(0, 0.5, 1, 0.5))(2).value, 1);
    EXPECT_TRUE(std::isnan(e(std::nan("")).value));
}

TEST(Easing, refuses_what_is_no_function) {
    test::expect_refusal(CubicBezierEasing::make(-0.1, 0, 1, 1), RefusalKind::invalid, "x1");
    test::expect_refusal(CubicBezierEasing::make(0, 0, 1.5, 1), RefusalKind::invalid, "x2", "1.5");
    test::expect_refusal(CubicBezierEasing::make(0, std::nan(""), 1, 1), RefusalKind::nonfinite, "y1");
    test::expect_refusal(CubicBezierEasing::named("bounce"), RefusalKind::invalid, "", "bounce");
}

TEST(Easing, steps_jump_where_css_says) {
    const auto all = [](StepJump jump) {
        std::vector<double> out;
        for (const double x : {-0.5, 0.0, 0.3, 0.5, 0.99, 1.0, 1.5}) out.push_back(step_easing(x, 2, jump));
        return out;
    };
    EXPECT_EQ(all(StepJump::end), (std::vector<double>{-0.5, 0, 0, 0.5, 0.5, 1, 1.5}));
    EXPECT_EQ(all(StepJump::start), (std::vector<double>{0, 0.5, 0.5, 1, 1, 1, 2}));
    EXPECT_EQ(all(StepJump::neither), (std::vector<double>{-1, 0, 0, 1, 1, 1, 3}));
    EXPECT_EQ(step_easing(0, 3, StepJump::both), 0.25);
    EXPECT_EQ(step_easing(0.999, 3, StepJump::both), 0.75);
    EXPECT_EQ(step_easing(1, 3, StepJump::both), 1);
    // At the rounded k / n the k-th step begins.
    for (int n = 1; n < 200; ++n)
        for (int k = 0; k <= n; ++k) {
            EXPECT_EQ(step_easing(double(k) / n, n), double(k) / n);
            if (k > 0 && k < n)
                EXPECT_EQ(step_easing(std::nextafter(double(k) / n, 0), n), double(k - 1) / n);
        }
}

}  // namespace
}  // namespace freiform
