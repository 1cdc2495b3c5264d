#include "support/random.hpp"

#include <freiform/fit/approximate.hpp>

#include <gtest/gtest.h>

namespace freiform {
namespace {

using test::must;
using test::Random;

std::vector<Vec<2>> arc(int count, double noise = 0, double turns = 0.5) {
    Random random(3);
    std::vector<Vec<2>> q;
    for (int i = 0; i < count; ++i) {
        const double a = 2 * M_PI * turns * i / (turns < 1 ? count - 1 : count);
        q.push_back(
            {{10 * std::cos(a) + random.real(-noise, noise), 10 * std::sin(a) + random.real(-noise, noise)}});
    }
    return q;
}

// The distance from a point to the curve, by brute force: from above.
double nearest(const Curve<Vec<2>>& c, const Vec<2>& p) {
    const Interval on = c.basis().domain();
    double best = 1e300;
    for (int i = 0; i <= 4000; ++i)
        best = std::min(best, test::distance(c(on.lo + on.length() * i / 4000), p));
    return best;
}

double to_segment(const Vec<2>& a, const Vec<2>& b, const Vec<2>& p) {
    const Vec<2> d = b - a;
    const double t = std::clamp(dot(p - a, d) / std::max(dot(d, d), 1e-300), 0.0, 1.0);
    return test::distance(a + t * d, p);
}

TEST(Approximate, bounds_hold_in_both_directions_against_dense_measurement) {
    for (const bool closed : {false, true})
        for (const double tolerance : {0.5, 0.05, 0.015}) {
            const auto q = arc(120, 0.01, closed ? 1 : 0.7);
            const auto f = must(approximate<2>(q, {.tolerance = tolerance, .closed = closed}));
            EXPECT_LE(f.report.bound, tolerance);
            EXPECT_EQ(f.curve.basis().is_closed(), closed);
            double squares = 0;
            for (std::size_t i = 0; i < q.size(); ++i)
                squares += std::pow(test::distance(f.curve(f.at[i]), q[i]), 2);
            EXPECT_NEAR(f.report.rms_error, std::sqrt(squares / double(q.size())), 1e-13);
            for (std::size_t i = 0; i < q.size(); ++i) {
                EXPECT_LE(test::distance(f.curve(f.at[i]), q[i]), f.report.bound);
                EXPECT_LE(nearest(f.curve, q[i]), f.report.bound + 2e-2);
                if (i > 0) EXPECT_LE(f.at[i - 1], f.at[i]);
            }
            const Interval on = f.curve.basis().domain();
            double farthest = 0;
            for (int k = 0; k <= 3000; ++k) {
                const Vec<2> p = f.curve(on.lo + on.length() * k / 3000);
                double best = 1e300;
                for (std::size_t i = 0; i + 1 < q.size() + closed; ++i)
                    best = std::min(best, to_segment(q[i], q[(i + 1) % q.size()], p));
                farthest = std::max(farthest, best);
            }
            EXPECT_LE(farthest, f.report.polyline_bound);
            EXPECT_GT(farthest, 0.3 * f.report.polyline_bound);
        }
}

TEST(Approximate, needs_no_more_knots_than_even_ones_would_be) {
    Random random(1);
    std::vector<Vec<2>> spiral;
    for (int i = 0; i <= 300; ++i) {
        const double a = 6 * M_PI * i / 300;
        spiral.push_back({{std::exp(0.15 * a) * std::cos(a), std::exp(0.15 * a) * std::sin(a)}});
    }
    for (const auto& q : {arc(200), arc(200, 0.003), spiral})
        for (const double tolerance : {0.1, 0.01}) {
            const auto f = must(approximate<2>(q, {.tolerance = tolerance}));
            const auto at = must(parameters<2>(q, Spacing::chordal));
            int even = 0;
            for (int spans = 1; even == 0 && spans < 100; ++spans) {
                std::vector<double> t(4, at.front());
                for (int k = 1; k < spans; ++k) t.push_back(at.back() * k / spans);
                t.insert(t.end(), 4, at.back());
                const auto l =
                    least_squares<2>(must(BSplineBasis::make(3, t)), std::span<const Vec<2>>(q), at);
                if (l && l->report.bound <= tolerance) even = l->curve.basis().size();
            }
            EXPECT_TRUE(even == 0 || f.curve.basis().size() <= even) << f.curve.basis().size() << " " << even;
        }
}

TEST(Approximate, a_cubic_needs_no_inner_knot) {
    const std::vector<Vec<3>> net{{{0, 0, 0}}, {{1, 2, 0}}, {{3, 2, 1}}, {{4, 0, 3}}};
    const auto c = must(Curve<Vec<3>>::make({must(BSplineBasis::bezier(3))}, Net<1, Vec<3>>({4}, net)));
    std::vector<Vec<3>> q;
    for (int i = 0; i <= 60; ++i) q.push_back(c(i / 60.0));
    EXPECT_EQ(must(approximate<3>(q, {.tolerance = 1e-2})).curve.basis().size(), 4);
}

TEST(Approximate, keeps_values_and_derivatives_exactly) {
    const auto q = arc(100, 0.02);
    const std::vector<KeptPoint<2>> kept{
        {0, 0, q[0]}, {99, 0, {{-10, 0}}}, {50, 0, q[50]}, {0, 1, {{0, 1}}}, {99, 1, {{0, -1}}}};
    const auto f = must(approximate<2>(q, {.tolerance = 0.05}, std::span<const KeptPoint<2>>(kept)));
    EXPECT_EQ(f.curve(f.at.front()), q[0]);
    EXPECT_EQ(f.curve(f.at.back()), (Vec<2>{{-10, 0}}));
    EXPECT_LT(test::distance(f.curve(f.at[50]), q[50]), 1e-13);
    EXPECT_LT(test::distance(f.curve.derivatives(f.at[0], 1)[1], {{0, 1}}), 1e-11);
    EXPECT_LT(test::distance(f.curve.derivatives(f.at[99], 1)[1], {{0, -1}}), 1e-11);
    EXPECT_LT(f.report.kept_bound, 1e-12);
    EXPECT_LE(test::distance(f.curve(f.at[50]), q[50]), f.report.kept_bound);
    EXPECT_GT(f.report.kept_bound, 0) << "the value inside is met up to rounding only";
    EXPECT_LE(f.report.bound, 0.05);
    // Values at the ends are met to the bit, whatever the degree and the numbers.
    Random random(6);
    for (int degree = 2; degree <= 5; ++degree)
        for (int round = 0; round < 5; ++round) {
            std::vector<Vec<2>> p;
            for (int i = 0; i < 12; ++i) p.push_back({{double(i), random.real(-1, 1)}});
            const std::vector<KeptPoint<2>> ends{{0, 0, p[0] + Vec<2>{{0, random.real(0, 0.1)}}},
                                                 {11, 0, p[11] + Vec<2>{{0, random.real(0, 0.1)}}}};
            const auto g = must(
                approximate<2>(p, {.tolerance = 0.5, .degree = degree}, std::span<const KeptPoint<2>>(ends)));
            EXPECT_EQ(g.curve(g.at.front()), ends[0].value) << degree;
            EXPECT_EQ(g.curve(g.at.back()), ends[1].value) << degree;
        }
}

TEST(Approximate, any_degree_and_few_points) {
    const auto q = arc(40);
    for (int degree = 1; degree <= 6; ++degree)
        for (const bool closed : {false, true}) {
            const auto f = must(approximate<2>(q, {.tolerance = 0.05, .degree = degree, .closed = closed}));
            EXPECT_EQ(f.curve.basis().degree(), degree);
            EXPECT_LE(f.report.bound, 0.05);
        }
    for (std::size_t m : {2, 3, 4}) {
        const auto f = must(approximate<2>(std::span(q).first(m), {.tolerance = 1e-6}));
        EXPECT_EQ(f.curve.basis().degree(), 3);
        EXPECT_EQ(f.curve.basis().size(), 4);
        EXPECT_LT(f.report.bound, 1e-12);
    }
    // As many coefficients as points, if it must be.
    Random random(4);
    std::vector<Vec<2>> wild;
    for (int i = 0; i < 20; ++i) wild.push_back(test::random_coefficient<Vec<2>>(random));
    EXPECT_LE(must(approximate<2>(wild, {.tolerance = 1e-9})).report.bound, 1e-9);
}

TEST(Approximate, scales_with_powers_of_two_to_the_bit) {
    const auto q = arc(50, 0.01);
    auto small = q;
    for (auto& p : small) p *= 0x1p-40;
    const auto a = must(approximate<2>(q, {.tolerance = 0.0625})),
               b = must(approximate<2>(small, {.tolerance = 0x1p-44}));
    EXPECT_EQ(a.report.bound * 0x1p-40, b.report.bound);
    EXPECT_EQ(a.curve.basis().size(), b.curve.basis().size());
}

TEST(Approximate, repeated_points_are_points) {
    auto q = arc(30);
    q.insert(q.begin() + 7, q[7]);
    q.push_back(q.back());
    const auto f = must(approximate<2>(q, {.tolerance = 0.01}));
    EXPECT_EQ(f.at[7], f.at[8]);
    EXPECT_LE(f.report.bound, 0.01);
}

TEST(Approximate, bounds_are_within_the_tolerance_or_it_is_refused) {
    const std::vector<Vec<2>> points{{{100, 100}}, {{101, 100}}, {{102, 100}}, {{102, 101}}};
    int fitted = 0, refused = 0;
    for (int degree = 3; degree <= 9; ++degree)
        for (int e = 10; e <= 15; ++e) {
            const double tolerance = std::pow(10.0, -e);
            const auto f = approximate<2>(points, {.tolerance = tolerance, .degree = degree}, {});
            f ? ++fitted : ++refused;
            if (f)
                EXPECT_LE(f->report.bound, tolerance);
            else
                EXPECT_EQ(f.error().kind, RefusalKind::no_answer);
        }
    EXPECT_GT(fitted, 0);
    EXPECT_GT(refused, 0);
}

TEST(Approximate, refuses_what_has_no_answer) {
    const auto expect = [](const auto& r, RefusalKind kind, const std::string& where,
                           const std::string& message) {
        ASSERT_FALSE(r.has_value());
        EXPECT_EQ(name_of(r.error().kind), name_of(kind)) << r.error().message;
        EXPECT_EQ(r.error().where, where);
        EXPECT_NE(r.error().message.find(message), std::string::npos) << r.error().message;
    };
    auto q = arc(20);
    const auto run = [&](ApproximateOptions o, std::vector<KeptPoint<2>> kept = {}) {
        return approximate<2>(q, o, std::span<const KeptPoint<2>>(kept));
    };
    expect(run({.tolerance = 0}), RefusalKind::invalid, "tolerance", "not a positive distance");
    expect(run({.tolerance = std::nan("")}), RefusalKind::invalid, "tolerance", "not a positive");
    expect(run({.tolerance = 1e-30}), RefusalKind::no_answer, "tolerance",
           "the closest curve found, with 20 coefficients");
    expect(run({.tolerance = 1, .degree = 0}), RefusalKind::invalid, "degree", "outside");
    expect(run({.tolerance = 1}, {{20, 0, {}}}), RefusalKind::invalid, "kept[0]", "point 20 does not exist");
    expect(run({.tolerance = 1}, {{3, 0, {{50, 50}}}}), RefusalKind::invalid, "kept[0]",
           "farther than the tolerance");
    expect(run({.tolerance = 1}, {{3, 1, {}}, {3, 1, {}}}), RefusalKind::invalid, "kept[1]",
           "same derivative as kept[0]");
    q[4][1] = std::nan("");
    expect(run({.tolerance = 1}), RefusalKind::nonfinite, "points[4]", "not finite");
    q.assign(5, Vec<2>{{1, 2}});
    expect(run({.tolerance = 1}), RefusalKind::invalid, "points", "all 5 points are equal");
    q.resize(1);
    expect(run({.tolerance = 1}), RefusalKind::invalid, "points", "1 point; a curve needs 2");
    q = arc(2);
    expect(run({.tolerance = 1, .closed = true}), RefusalKind::invalid, "points", "needs 3");
}

}  // namespace
}  // namespace freiform
