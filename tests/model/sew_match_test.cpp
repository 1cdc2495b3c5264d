// Are two edges one? Curves that wind, which are near themselves elsewhere, and curves that agree at their
// breaks.
#include "model/sew_detail.hpp"
#include "support/random.hpp"
#include "support/solids.hpp"

#include <gtest/gtest.h>

namespace freiform {
namespace {

using test::must;
using test::Random;

// Of few pieces and a high degree, with control points far to both sides, as approximations have them.
Curve<Vec<3>> winding(Random& random) {
    const auto basis = *BSplineBasis::make(8, {0, 0, 0, 0, 0, 0, 0, 0, 0, 0.49, 1, 1, 1, 1, 1, 1, 1, 1, 1});
    std::vector<Vec<3>> c;
    for (int i = 0; i < 10; ++i) {
        const double far = (i % 2 ? 300 : -300) * std::sin(test::kPi * i / 9);
        c.push_back({{5.0 * i + far * random.real(0.6, 1), random.real(-1, 1), far * random.real(0.6, 1)}});
    }
    return must(Curve<Vec<3>>::make({basis}, Net<1, Vec<3>>({10}, c)));
}

TEST(SewMatch, curves_that_wind_are_those_that_run_the_other_way) {
    Random random(5);
    for (int k = 0; k < 300; ++k) {
        const auto there = winding(random), back = reverse(there, 0);
        const CurveGeometry<3> a = there, b = back;
        const EdgeTrace one = trace_of(a, there.domain()[0]), other = trace_of(b, back.domain()[0]);
        const auto found = match(one, other, true, 1e-7);
        ASSERT_TRUE(found) << k << ": " << found.error().message;
        EXPECT_LE(found->bound, 1e-7);
        EXPECT_FALSE(match(one, other, false, 1e-7)) << k;
    }
}

// Two lines 0.7 of the tolerance apart, which at the same parameter are more than it apart.
TEST(SewMatch, what_is_good_enough_is_within_the_tolerance) {
    const double tolerance = 1e-5, speed = 0.72 * 2 * tolerance;
    const auto curve = [](std::vector<Vec<3>> points) -> CurveGeometry<3> {
        const int degree = int(points.size()) - 1;
        return must(Curve<Vec<3>>::make({*BSplineBasis::bezier(degree)},
                                        Net<1, Vec<3>>({degree + 1}, std::move(points))));
    };
    const double beside = 0.7 * tolerance;
    const auto a = curve({{{0, 0, 0}}, {{1, 0, 0}}}),
               b = curve({{{0, beside, 0}}, {{0.5 + speed, beside, 0}}, {{1, beside, 0}}});
    const auto found = match(trace_of(a, {0, 1}), trace_of(b, {0, 1}), false, tolerance);
    ASSERT_TRUE(found) << found.error().message;
    EXPECT_LE(found->bound, tolerance);
    EXPECT_GE(found->bound, beside);
}

// Splines that are beside each other by a little less than the tolerance in many places.
TEST(SewMatch, what_is_nearly_the_tolerance_apart_is_proven_to_be_within_it) {
    const double tolerance = 1e-3;
    Random random(3);
    for (int k = 0; k < 20; ++k) {
        const int degree = 3 + k % 4, size = 200;
        std::vector<Vec<3>> here;
        for (int i = 0; i < size; ++i) here.push_back({{i + random.real(-9, 9), random.real(-9, 9), 0}});
        auto there = here;
        for (int i = 1; i + 1 < size; ++i) there[std::size_t(i)][2] = random.real(-1, 1);
        const auto curve = [&](std::vector<Vec<3>> points) {
            return must(Curve<Vec<3>>::make({must(BSplineBasis::clamped_uniform(degree, size))},
                                            Net<1, Vec<3>>({size}, std::move(points))));
        };
        const Interval on = curve(here).domain()[0];
        const auto bent = curve(there);
        double most = 0;
        for (int i = 0; i <= 100'000; ++i)
            most = std::max(most, std::abs(bent(on.lo + on.length() * i / 1e5)[2]));
        const double share = random.real(0.9, 0.98);
        for (Vec<3>& p : there) p[2] *= share * tolerance / most;
        const CurveGeometry<3> a = curve(here), b = curve(there);
        const auto found = match(trace_of(a, on), trace_of(b, on), false, tolerance);
        ASSERT_TRUE(found) << k << ", " << share << ": " << found.error().message;
        EXPECT_LE(found->bound, tolerance);
        EXPECT_GE(found->bound, share * tolerance * (1 - 1e-5));
    }
}

// Of edges that are short beside the tolerance the bound is small beside them, so that they can be told from
// points.
// A circle, and the polynomial of degree 11 that stands for it in files: the places looked at first miss the
// largest distance by 2 %, and a proof that is content with less than the tolerance by as much as they say is
// not within it.
TEST(SewMatch, what_is_found_later_is_proven_closely_too) {
    const std::vector<Vec<2>> half{{{1, 0}},
                                   {{1, -0.571198664}},
                                   {{0.641182488, -1.14238438}},
                                   {{-0.0771969355, -1.46314878}},
                                   {{-0.954807222, -1.28207319}},
                                   {{-1.60917761, -0.528728066}}};
    std::vector<Vec<3>> c;
    for (const Vec<2>& p : half) c.push_back({{p[0], p[1], 0}});
    for (std::size_t i = half.size(); i-- > 0;) c.push_back({{half[i][0], -half[i][1], 0}});
    const CurveGeometry<3> polynomial = must(Curve<Vec<3>>::make(
                               {*BSplineBasis::bezier(11, {0, 2 * test::kPi})}, Net<1, Vec<3>>({12}, c))),
                           circle = Conic<3>{ConicKind::ellipse, {}, {{1, 0, 0}}, {{0, 1, 0}}};
    const Interval on{0, 2 * test::kPi};
    double most = 0;
    for (int i = 0; i <= 100'000; ++i)
        most = std::max(most, std::abs(norm(jet<0>(polynomial, on.length() * i / 1e5).value()) - 1));
    for (double tolerance = 1.01 * most; tolerance < 1.3 * most; tolerance *= 1.003) {
        const auto found = match(trace_of(circle, on), trace_of(polynomial, on), true, tolerance);
        ASSERT_TRUE(found) << tolerance / most << ": " << found.error().message;
        EXPECT_LE(found->bound, tolerance);
        EXPECT_GE(found->bound, 0.9999 * most);
    }
    EXPECT_FALSE(match(trace_of(circle, on), trace_of(polynomial, on), true, 0.999 * most));
}

// An arc and the same arc the other way round, a few units long and 300 000 units from zero: rounding is all
// that they are apart, and no reason to leave them so.
TEST(SewMatch, rounding_far_from_zero_is_told_from_gaps) {
    const Vec<3> centre{{3e5, -2e5, 1e5}}, x{{7, 0, 0}}, y{{0, 4.2, 5.6}};
    const double w = std::sqrt(0.5);
    const auto arc = must(Curve<Hom<3>>::make(
        {*BSplineBasis::bezier(2)}, Net<1, Hom<3>>({3}, {weighted(centre + x, 1), weighted(centre + x + y, w),
                                                         weighted(centre + y, 1)})));
    const auto back = reverse(arc, 0);
    const CurveGeometry<3> a = arc, b = back;
    const double tolerance = 0x1p-42 * 3e5;
    const auto found = match(trace_of(a, arc.domain()[0]), trace_of(b, back.domain()[0]), true, tolerance);
    ASSERT_TRUE(found) << found.error().message;
    EXPECT_LE(found->bound, tolerance);
    EXPECT_FALSE(match(trace_of(a, arc.domain()[0]), trace_of(b, back.domain()[0]), true, 0x1p-52 * 3e5));
}

TEST(SewMatch, short_edges_are_bounded_by_their_size) {
    const double size = 5e-4, tolerance = 2e-3;
    const auto curve = [](std::vector<Vec<3>> points) -> CurveGeometry<3> {
        const int degree = int(points.size()) - 1;
        return must(Curve<Vec<3>>::make({*BSplineBasis::bezier(degree)},
                                        Net<1, Vec<3>>({degree + 1}, std::move(points))));
    };
    const auto a = curve({{{0, 0, 0}}, {{size, 0, 0}}}),
               b = curve({{{0, 0, 0}}, {{0.9 * size, 0, 0}}, {{0.95 * size, 0, 0}}, {{size, 0, 0}}});
    const auto found = match(trace_of(a, {0, 1}), trace_of(b, {0, 1}), false, tolerance);
    ASSERT_TRUE(found) << found.error().message;
    EXPECT_LE(found->bound, size / 8);
}

// One curve at half the speed and backwards: its parameter curve is the same curve, whatever it winds.
TEST(SewMatch, at_another_speed_parameter_curves_stay_what_they_are) {
    Random random(11);
    const SurfaceGeometry plane = Extrusion{Line<3>{{}, {{1, 0, 0}}}, {{0, 1, 0}}, SurfaceKind::plane};
    const DerivativeQuery<2, 3> query(plane);
    std::vector<double> knots(9, 0.0), halved(9, 7.0);
    std::vector<Vec<2>> flat;
    for (int i = 1; i < 12; ++i) knots.push_back(i);
    for (int i = 1; i < 12; ++i) halved.push_back(7 + 2 * i);
    knots.insert(knots.end(), 9, 12.0), halved.insert(halved.end(), 9, 31.0);
    for (int i = 0; i < 20; ++i) flat.push_back({{i + random.real(-300, 300), random.real(-300, 300)}});
    const auto on_surface =
        must(Curve<Vec<2>>::make({*BSplineBasis::make(8, knots)}, Net<1, Vec<2>>({20}, flat)));
    std::vector<Vec<3>> there, back;
    for (const Vec<2>& p : flat) there.push_back({{p[0], p[1], 0}});
    back.assign(there.rbegin(), there.rend());
    const CurveGeometry<3> other =
        must(Curve<Vec<3>>::make({*BSplineBasis::make(8, knots)}, Net<1, Vec<3>>({20}, there)));
    const CurveGeometry<3> stays =
        must(Curve<Vec<3>>::make({*BSplineBasis::make(8, halved)}, Net<1, Vec<3>>({20}, back)));
    const EdgeTrace trace = trace_of(stays, {7, 31});
    const auto found = match(trace, trace_of(other, {0, 12}), true, 1e-6);
    ASSERT_TRUE(found) << found.error().message;
    ASSERT_TRUE(found->map.is_affine);
    const auto follows = followed(query, on_surface, trace, *found, 1e-3);
    ASSERT_TRUE(follows) << follows.error().message;
    EXPECT_LE(follows->bound, 1e-3);
    EXPECT_EQ(std::get<Curve<Vec<2>>>(follows->curve).net().flat().size(), flat.size());
}

TEST(SewMatch, feet_of_points_of_a_winding_curve_are_these_points) {
    Random random(7);
    int missed = 0;
    for (int k = 0; k < 100; ++k) {
        const auto c = winding(random);
        const CurveGeometry<3> curve = c;
        const EdgeTrace trace = trace_of(curve, c.domain()[0]);
        for (int i = 0; i < 50; ++i)
            missed += foot_on(trace, c(random.real(trace.on.lo, trace.on.hi))).distance > 1e-9;
    }
    EXPECT_LE(missed, 10);  // of 5,000: they are estimates
}

// Both of 32 pieces between the same points; the second has an arch over each piece of the first.
TEST(SewMatch, gaps_are_looked_at_between_breaks_too) {
    constexpr double kArch = 1e-3;
    std::vector<double> straight{0}, arched{0};
    std::vector<Vec<3>> line{{{0, 0, 0}}}, arches{{{0, 0, 0}}};
    for (int k = 0; k < 32; ++k) {
        straight.push_back(k);
        arched.insert(arched.end(), 2, k);
        line.push_back({{k + 1.0, 0, 0}});
        arches.push_back({{k + 0.5, 0, 2 * kArch}});
        arches.push_back({{k + 1.0, 0, 0}});
    }
    straight.insert(straight.end(), 2, 32);
    arched.insert(arched.end(), 3, 32);
    Model m;
    const auto add = [&](int degree, std::vector<double> knots, std::vector<Vec<3>> points) {
        const int size = int(points.size());
        const auto curve = must(Curve<Vec<3>>::make({must(BSplineBasis::make(degree, std::move(knots)))},
                                                    Net<1, Vec<3>>({size}, std::move(points))));
        const int v = int(m.vertices.size());
        m.vertices.push_back({{{0, 0, 0}}, 0});
        m.vertices.push_back({{{32, 0, 0}}, 0});
        m.edges.push_back({curve, false, {0, 32}, v, v + 1, 0, ""});
        Face f;
        f.surface = Extrusion{curve, {{0, 1, 0}}};
        f.loops = {{{{int(m.edges.size()) - 1, false, Line<2>{{{0, 0}}, {{1, 0}}}}}}};
        m.faces.push_back(std::move(f));
    };
    add(1, straight, line);
    add(2, arched, arches);
    const auto gaps = remaining_gaps(m, 1e-6);
    ASSERT_EQ(gaps.size(), 2u);
    for (const RemainingGap& g : gaps) {
        EXPECT_GE(g.gap, kArch / 2) << g.edge;
        EXPECT_LE(g.gap, 1.1 * kArch) << g.edge;
    }
}

}  // namespace
}  // namespace freiform
