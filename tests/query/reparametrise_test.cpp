#include "bezier.hpp"

#include <freiform/query/reparametrise.hpp>

#include <gtest/gtest.h>
#include <limits>

namespace freiform::test {
namespace {

const Curve<Vec<2>> kBridge = bezier<Vec<2>>({{{0, 0}}, {{1, 2}}, {{3, 2}}, {{4, 0}}});
const Curve<Vec<2>> kSpike = bezier<Vec<2>>({{{0, 0}}, {{1, 1}}, {{0, 1}}, {{1, 0}}});

struct Found {
    double distance = 0, speed = 0;
};
template <class P>
Found measured(const Curve<P>& curve, const ArcLengthCurve<Space<P>::kDim>& even, int samples = 300) {
    const ArcLength s(curve, 0);
    const double all = even.curve.domain()[0].hi;
    Found f;
    for (int k = 0; k <= samples; ++k) {
        const double at = all * k / samples;
        const auto place = must(s.parameter(std::min(at, s.total().value)));
        f.distance = std::max(f.distance, distance(even.curve(at), curve(place.parameter)) - 2 * place.bound);
        f.speed = std::max(f.speed, std::abs(norm(even.curve.template jet<1>(at)(1)) - 1));
    }
    return f;
}

TEST(R20, reparametrisation_by_arc_length_runs_at_unit_speed) {
    const auto even = must(by_arc_length(kBridge, 1e-8));
    EXPECT_EQ(even.curve.domain()[0].lo, 0);
    EXPECT_EQ(even.curve.domain()[0].hi, even.length.value);
    const ArcLength again(even.curve, 0);
    for (int k = 1; k < 20; ++k) {
        const double s = even.length.value * k / 20;
        EXPECT_NEAR(norm(even.curve.jet<1>(s)(1)), 1, 1e-7);
        EXPECT_NEAR(must(again.at(s)).value, s, 1e-7) << "the parameter is the arc length";
    }
}

// What two points are apart that are one but for rounding is rounding, too.
TEST(Reparametrise, bounds_of_the_speed_hold_on_pieces_of_rounding_length) {
    const double big = 1e11, ulp = std::ldexp(1.0, -16);
    for (int k = 1; k < 8; ++k) {
        const auto curve =
            must(Curve<Vec<3>>::make({must(BSplineBasis::make(1, {0, 0, 1, 2, 2}))},
                                     Net<1, Vec<3>>({3}, {Vec<3>{{big, big / 3, big / 7}},
                                                          Vec<3>{{big, big / 3 + k * ulp, big / 7 - ulp}},
                                                          Vec<3>{{big - 1e9, 0, 0}}})));
        const auto even = by_arc_length(curve, 1e-3);
        if (!even) continue;
        for (const Interval& on : {Interval{0, even->length.value}}) {
            const auto breaks = even->curve.basis().breaks();
            for (std::size_t i = 0; i + 1 < breaks.size(); ++i)
                for (const double part : {0.0, 0.5, 0.999}) {
                    const double at = std::min(on.hi, breaks[i] + part * (breaks[i + 1] - breaks[i]));
                    EXPECT_LE(std::abs(norm(even->curve.jet<1>(at)(1)) - 1), even->speed_bound + 1e-13) << k;
                }
        }
    }
}

TEST(Reparametrise, stays_within_its_bounds_and_the_bounds_are_of_use) {
    Random random(301);
    const auto check = [&](const auto& curve, double tolerance, double useful) {
        if (length(curve, 0).value < 1e-6) return;  // closed, with a single coefficient
        const auto even = must(by_arc_length(curve, tolerance));
        const Found f = measured(curve, even);
        EXPECT_LE(f.distance, even.bound);
        EXPECT_LE(f.speed, even.speed_bound + 1e-13);
        EXPECT_LE(even.bound, tolerance);
        EXPECT_GE(f.distance, useful * even.bound);
    };
    const double h = std::sqrt(0.5);
    const auto quarter = bezier<Hom<2>>(
        {weighted(Vec<2>{{1, 0}}, 1), weighted(Vec<2>{{1, 1}}, h), weighted(Vec<2>{{0, 1}}, 1)});
    for (const double tolerance : {1e-2, 1e-5, 1e-9}) {
        check(kBridge, tolerance, 0.1);
        check(quarter, tolerance, 0.02);
        check(kSpike, tolerance, 1e-4);
        check(bezier<Vec<3>>({{{0, 0, 0}}, {{1, 2, 3}}}), tolerance, 0);
    }
    for (int k = 0; k < 3; ++k) {
        check(random_patch<1, Vec<3>>(random, 5, {}), 1e-5, 1e-4);
        check(random_patch<1, Hom<2>>(random, 3, {Ends::closed}), 1e-4, 0);
        check(random_patch<1, Vec<1>>(random, 3, {}), 1e-3, 0);
    }
}

TEST(Reparametrise, curvature_goes_on_where_it_did) {
    const auto spline = must(Curve<Vec<2>>::make(
        {must(BSplineBasis::clamped_uniform(3, 6))},
        Net<1, Vec<2>>({6}, {{{0, 0}}, {{1, 2}}, {{3, 2}}, {{4, 0}}, {{6, 1}}, {{7, 3}}})));
    const auto even = must(by_arc_length(spline, 1e-5));
    const auto breaks = even.curve.basis().breaks();
    ASSERT_GT(breaks.size(), 4u);
    for (std::size_t i = 1; i + 1 < breaks.size(); ++i) {
        const auto before = even.curve.jet<2>(std::nextafter(breaks[i], 0)),
                   after = even.curve.jet<2>(breaks[i]);
        EXPECT_LT(distance(before(1), after(1)), 1e-9);
        EXPECT_LT(distance(before(2), after(2)), 1e-6);
    }
}

TEST(Reparametrise, scales_exactly_with_powers_of_two) {
    Net<1, Vec<2>> net = kBridge.net();
    for (auto& p : net.flat())
        for (int i = 0; i < 2; ++i) p[i] = std::scalbn(p[i], -60);
    const auto small =
        must(by_arc_length(must(Curve<Vec<2>>::make(kBridge.bases(), net)), std::scalbn(1e-6, -60)));
    const auto even = must(by_arc_length(kBridge, 1e-6));
    ASSERT_EQ(small.curve.net().flat().size(), even.curve.net().flat().size());
    EXPECT_EQ(std::scalbn(small.bound, 60), even.bound);
    EXPECT_EQ(small.speed_bound, even.speed_bound);
}

TEST(Reparametrise, refuses_what_has_no_unit_speed) {
    const auto kind = [](const auto& r) { return r ? RefusalKind::io : r.error().kind; };
    EXPECT_EQ(kind(by_arc_length(kBridge, 0)), RefusalKind::invalid);
    EXPECT_EQ(kind(by_arc_length(kBridge, std::numeric_limits<double>::quiet_NaN())), RefusalKind::invalid);
    EXPECT_EQ(kind(by_arc_length(kBridge, 1e-17)), RefusalKind::ill_conditioned);
    EXPECT_EQ(kind(by_arc_length(kBridge, 1e-9, 5)), RefusalKind::limit);
    EXPECT_EQ(kind(by_arc_length(bezier<Vec<2>>({{{1, 1}}, {{1, 1}}}), 1e-3)), RefusalKind::no_answer);
    const auto jump =
        must(Curve<Vec<2>>::make({must(BSplineBasis::make(1, {0, 0, 1, 1, 2, 2}))},
                                 Net<1, Vec<2>>({4}, {{{0, 0}}, {{1, 0}}, {{5, 5}}, {{7, 5}}})));
    EXPECT_EQ(kind(by_arc_length(jump, 1e-3)), RefusalKind::no_answer);
}

}  // namespace
}  // namespace freiform::test
