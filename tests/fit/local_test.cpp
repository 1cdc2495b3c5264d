#include "support/curves.hpp"

#include <freiform/fit/local.hpp>
#include <freiform/spline/bezier.hpp>

#include <gtest/gtest.h>

namespace freiform {
namespace {

using test::must;
using test::Random;
using test::random_points;

std::vector<double> uniform(int count) {
    std::vector<double> at;
    for (int i = 0; i < count; ++i) at.push_back(i);
    return at;
}

// P_{3i-2} = Q_i; P_{3i-1} = Q_i + (Q_{i+1} - Q_{i-1}) / 6; P_{3i-3} = Q_i - (Q_{i+1} - Q_{i-1}) / 6;
// ends P_2 = (Q_1 + P_3) / 2, P_{3l-3} = (P_{3l-4} + Q_l) / 2. Indices from 1.
TEST(R10, bezier_points_of_the_curve_through_l_points) {
    Random random(1);
    for (int l : {3, 4, 9}) {
        const auto q = random_points<3>(random, std::size_t(l));
        std::vector<Vec<3>> p(std::size_t(3 * l - 2) + 1);
        const auto Q = [&](int i) { return q[std::size_t(i - 1)]; };
        const auto P = [&](int i) -> Vec<3>& { return p[std::size_t(i)]; };
        for (int i = 1; i <= l; ++i) P(3 * i - 2) = Q(i);
        for (int i = 2; i < l; ++i) {
            P(3 * i - 1) = Q(i) + (1.0 / 6) * (Q(i + 1) - Q(i - 1));
            P(3 * i - 3) = Q(i) - (1.0 / 6) * (Q(i + 1) - Q(i - 1));
        }
        P(2) = 0.5 * (Q(1) + P(3));
        P(3 * l - 3) = 0.5 * (P(3 * l - 4) + Q(l));

        const auto at = uniform(l);
        const auto c = must(catmull_rom<1, 3>(Net<1, Vec<3>>({l}, q), {at}));
        ASSERT_EQ(c.net().extent()[0], 3 * l - 2);
        for (int i = 1; i <= 3 * l - 2; ++i)
            EXPECT_LT(test::distance(c.net().flat()[std::size_t(i - 1)], P(i)), 1e-15) << i;
        for (int i = 1; i <= l; ++i) EXPECT_EQ(c.net().flat()[std::size_t(3 * i - 3)], Q(i));
        // C1 where pieces meet: the differences of the neighbours of P_{3i-2} are equal.
        for (int i = 2; i < l; ++i)
            EXPECT_LT(test::distance(c.net().flat()[std::size_t(3 * i - 2)] - Q(i),
                                     Q(i) - c.net().flat()[std::size_t(3 * i - 4)]),
                      1e-15);
    }
}

TEST(CatmullRom, follows_the_parabola_of_three_points_at_any_parameters) {
    const std::vector<double> at{0, 1, 3, 3.5, 5, 5.25};
    std::vector<Vec<1>> q;
    for (const double t : at) q.push_back({{2 + t - 3 * t * t}});
    const auto c = must(catmull_rom<1, 1>(Net<1, Vec<1>>({6}, q), {at}));
    for (std::size_t i = 1; i < 5; ++i) {
        const auto d = c.derivatives(at[i], 1);
        EXPECT_NEAR(d[0][0], q[i][0], 1e-14 * std::abs(q[i][0]));
        EXPECT_NEAR(d[1][0], 1 - 6 * at[i], 1e-12) << i;
    }
    for (double t = 1; t <= 5; t += 0.125) EXPECT_NEAR(c(t)[0], 2 + t - 3 * t * t, 1e-12);
    EXPECT_NEAR(c.derivatives(0, 2)[2][0], 0, 1e-12);
    EXPECT_NEAR(c.derivatives(5.25, 2)[2][0], 0, 1e-10);
}

TEST(CatmullRom, closes_with_its_derivative) {
    Random random(2);
    for (int m : {2, 3, 6}) {
        const auto q = random_points<3>(random, std::size_t(m));
        std::vector<double> at{0};
        for (int i = 0; i < m; ++i) at.push_back(at.back() + random.real(0.5, 2));
        const auto c = must(catmull_rom<1, 3>(Net<1, Vec<3>>({m}, q), {at}, {true}));
        EXPECT_TRUE(c.basis().is_closed());
        for (int i = 0; i < m; ++i) {  // the slope of the parabola through a point and its neighbours
            const auto k = std::size_t(i), before = std::size_t((i + m - 1) % m),
                       after = std::size_t((i + 1) % m);
            const double g = at[before + 1] - at[before], h = at[k + 1] - at[k];
            const Vec<3> left = (1 / g) * (q[k] - q[before]), right = (1 / h) * (q[after] - q[k]);
            EXPECT_LT(test::distance(c.derivatives(at[k], 1)[1], (1 / (g + h)) * (h * left + g * right)),
                      1e-13)
                << m << " " << i;
        }
        for (int i = 0; i < m; ++i)
            EXPECT_LT(test::distance(c(at[std::size_t(i)]), q[std::size_t(i)]), 1e-15);
        const auto pieces = decompose(c);
        ASSERT_EQ(pieces.extent()[0], m);
        for (int i = 0; i < m; ++i) {
            const auto a = pieces.net({i}), b = pieces.net({(i + 1) % m});
            const double h = at[std::size_t(i) + 1] - at[std::size_t(i)],
                         g = at[std::size_t((i + 1) % m) + 1] - at[std::size_t((i + 1) % m)];
            EXPECT_LT(test::distance((1 / h) * (a({3}) - a({2})), (1 / g) * (b({1}) - b({0}))), 1e-13) << i;
        }
    }
}

TEST(CatmullRom, two_points_make_a_line) {
    const std::vector<double> at{1, 3};
    const auto c = must(catmull_rom<1, 1>(Net<1, Vec<1>>({2}, {Vec<1>{{0}}, Vec<1>{{6}}}), {at}));
    for (double t = 1; t <= 3; t += 0.25) EXPECT_NEAR(c(t)[0], 3 * (t - 1), 1e-14);
}

// R24 on the grid of the texts: 7 x 7 points, 36 patches, R10 along both directions.
TEST(CatmullRom, makes_a_grid_of_points_a_surface_whose_isocurves_are_such_curves) {
    Random random(3);
    const auto grid = test::random_net<2, Vec<3>>(random, {7, 7});
    const auto at = uniform(7);
    const auto s = must(catmull_rom<2, 3>(grid, {at, at}));
    EXPECT_EQ(decompose(s).extent(), (Index<2>{6, 6}));
    for (int i = 0; i < 7; ++i) {
        std::vector<Vec<3>> along_v, along_u;
        for (int j = 0; j < 7; ++j) {
            EXPECT_EQ(s(at[std::size_t(i)], at[std::size_t(j)]), grid.view()({i, j}));
            along_v.push_back(grid.view()({i, j})), along_u.push_back(grid.view()({j, i}));
        }
        const auto cv = must(catmull_rom<1, 3>(Net<1, Vec<3>>({7}, along_v), {at}));
        const auto cu = must(catmull_rom<1, 3>(Net<1, Vec<3>>({7}, along_u), {at}));
        for (double t = 0; t <= 6; t += 0.3) {
            EXPECT_LT(test::distance(s(double(i), t), cv(t)), 1e-14);
            EXPECT_LT(test::distance(s(t, double(i)), cu(t)), 1e-14);
        }
    }
}

TEST(Monotone, rises_only_where_the_points_rise) {
    Random random(4);
    for (int round = 0; round < 40; ++round) {
        const int n = random.integer(2, 9);
        std::vector<double> at{0};
        std::vector<Vec<1>> q{{{0}}};
        for (int i = 1; i < n; ++i) {
            at.push_back(at.back() + std::exp2(random.real(-6, 3)));
            const double step = random.chance(0.2) ? 0 : std::exp2(random.real(-10, 6));
            q.push_back({{q.back()[0] + (random.chance(0.8) ? step : -step)}});
        }
        const auto kind = round % 2 ? LocalSlopes::monotone : LocalSlopes::fritsch_carlson;
        const auto slopes = must(local_slopes<1>(q, at, kind));
        const auto c = must(cubic_through<1>(q, slopes, at));
        for (int i = 0; i + 1 < n; ++i) {
            const double a = q[std::size_t(i)][0], b = q[std::size_t(i) + 1][0], lo = at[std::size_t(i)],
                         hi = at[std::size_t(i) + 1];
            double last = a;
            for (int k = 1; k <= 64; ++k) {
                const double x = c(std::min(hi, lo + (hi - lo) * k / 64))[0];
                EXPECT_GE((x - last) * (b >= a ? 1 : -1), -1e-13 * (std::abs(a) + std::abs(b)));
                last = x;
            }
        }
    }
}

TEST(FritschCarlson, keeps_slopes_that_need_no_shortening_and_stays_in_the_circle) {
    // On a parabola nothing is shortened, and the slopes are those of the parabola.
    const std::vector<double> at{0, 1, 2.5, 3, 5};
    std::vector<Vec<1>> q;
    for (const double t : at) q.push_back({{t * t + t}});
    const auto slopes = must(local_slopes<1>(q, at, LocalSlopes::fritsch_carlson));
    for (std::size_t i = 0; i < at.size(); ++i) EXPECT_NEAR(slopes[i][0], 2 * at[i] + 1, 1e-13);
    // Elsewhere a^2 + b^2 <= 9, and signs stay.
    Random random(14);
    for (int round = 0; round < 50; ++round) {
        std::vector<double> t{0};
        std::vector<Vec<1>> y{{{0}}};
        for (int i = 1; i < 8; ++i) {
            t.push_back(t.back() + std::exp2(random.real(-4, 4)));
            y.push_back({{y.back()[0] + std::exp2(random.real(-8, 8))}});
        }
        const auto v = must(local_slopes<1>(y, t, LocalSlopes::fritsch_carlson));
        for (std::size_t i = 0; i + 1 < t.size(); ++i) {
            const double d = (y[i + 1][0] - y[i][0]) / (t[i + 1] - t[i]);
            EXPECT_LE(std::hypot(v[i][0] / d, v[i + 1][0] / d), 3 * (1 + 1e-14));
            EXPECT_GE(v[i][0], 0);
        }
    }
}

TEST(Akima, stays_straight_where_the_points_are) {
    const std::vector<double> at{0, 1, 2, 3, 4, 5, 6};
    std::vector<Vec<1>> q;
    for (const double y : {0.0, 0.0, 0.0, 0.0, 5.0, 6.0, 8.0}) q.push_back({{y}});
    const auto c = must(cubic_through<1>(q, must(local_slopes<1>(q, at, LocalSlopes::akima)), at));
    for (double t = 0; t <= 3; t += 0.125) EXPECT_EQ(c(t)[0], 0) << t;
}

TEST(Local, closed_slopes_see_around_the_seam) {
    Random random(5);
    for (const LocalSlopes kind : {LocalSlopes::akima, LocalSlopes::monotone, LocalSlopes::fritsch_carlson}) {
        const auto q = random_points<3>(random, 7);
        std::vector<double> at{0, 1, 3, 3.5, 4, 6, 7, 9};
        const auto slopes = must(local_slopes<3>(q, at, kind, true));
        // Begin at point 2 instead.
        std::vector<Vec<3>> turned;
        std::vector<double> later;
        for (std::size_t i = 0; i < 7; ++i)
            turned.push_back(q[(i + 2) % 7]), later.push_back(at[(i + 2) % 7] + (i + 2 >= 7 ? 9 : 0));
        later.push_back(at[2] + 9);
        const auto again = must(local_slopes<3>(turned, later, kind, true));
        for (std::size_t i = 0; i < 7; ++i) EXPECT_LT(test::distance(again[i], slopes[(i + 2) % 7]), 1e-12);
        const auto c = must(cubic_through<3>(q, slopes, at, true));
        const auto first = c.derivatives(0, 1), last = c.derivatives(9, 1);
        for (std::size_t k = 0; k < 2; ++k) EXPECT_LT(test::distance(first[k], last[k]), 1e-12);
        EXPECT_LT(test::distance(first[1], slopes[0]), 1e-12);
    }
}

TEST(Local, refuses_by_index) {
    const std::vector<double> at{0, 1, 1};
    std::vector<Vec<1>> q(3);
    EXPECT_EQ(catmull_rom(at).error().where, "at[2]");
    EXPECT_EQ((catmull_rom<2, 1>(Net<2, Vec<1>>({2, 3}), {std::vector<double>{0, 1}, at}).error().where),
              "axes[1].at[2]");
    EXPECT_EQ(catmull_rom(std::span(at).first(1)).error().where, "points");
    q[1][0] = std::nan("");
    const std::vector<double> good{0, 1, 2};
    EXPECT_EQ(local_slopes<1>(q, good, LocalSlopes::akima).error().where, "points[1]");
    EXPECT_EQ(cubic_through<1>(q, std::vector<Vec<1>>(2), good).error().where, "derivatives");
}

}  // namespace
}  // namespace freiform
