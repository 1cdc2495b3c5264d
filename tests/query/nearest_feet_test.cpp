// Feet against local minima among many samples, and those that are known.
#include <freiform/make/conic.hpp>
#include <freiform/query/nearest.hpp>

#include <gtest/gtest.h>
#include <support/random.hpp>
#include <support/refusal.hpp>
#include <support/shapes.hpp>

namespace freiform::test {
namespace {

NearestQuery feet_query(const auto& patch) {
    return must(NearestQuery::make(std::array{NearestObject::of(patch)}));
}

// Every sample that is nearer than its neighbours has a foot that is no farther, in a neighbourhood of two
// steps, or is beyond `others`.
TEST(NearestFeet, of_curves_are_all_local_minima_among_samples) {
    std::mt19937 rng(11);
    Random random(12);
    int feet_seen = 0;
    for (int trial = 0; trial < 40; ++trial) {
        const auto curve = random_patch<1, Hom<2>>(rng, {2 + trial % 4}, 4);
        const auto query = feet_query(curve);
        const Interval on = curve.domain()[0];
        constexpr int kSteps = 4000;
        for (int k = 0; k < 5; ++k) {
            const Vec<2> q{{random.real(-2, 2), random.real(-2, 2)}};
            const auto all = must(query.feet<2>(q, 3));
            ASSERT_TRUE(all.complete);
            std::vector<double> d;
            for (int i = 0; i <= kSteps; ++i) d.push_back(norm(curve(on.lo + on.length() * i / kSteps) - q));
            int minima = 0;
            for (int i = 0; i <= kSteps; ++i) {
                const auto at = std::size_t(i);
                if ((i > 0 && d[at - 1] <= d[at]) || (i < kSteps && d[at + 1] < d[at])) continue;
                const double t = on.lo + on.length() * i / kSteps, step = on.length() / kSteps;
                bool listed = d[at] >= all.others;
                for (const auto& f : all.feet)
                    listed = listed ||
                             (std::abs(f.foot.at[0] - t) <= 2 * step && f.foot.distance <= d[at] + 1e-12);
                EXPECT_TRUE(listed) << "trial " << trial << ", parameter " << t << ", distance " << d[at];
                ++minima;
            }
            EXPECT_LE(int(all.feet.size()), std::min(minima, 3)) << "trial " << trial;
            for (std::size_t i = 0; i < all.feet.size(); ++i) {
                const auto& f = all.feet[i];
                EXPECT_LE(f.foot.lower_bound, f.foot.distance);
                EXPECT_GE(f.foot.lower_bound, f.foot.distance - 1e-7);
                EXPECT_LE(f.box[0].lo, f.foot.at[0] + 1e-12);
                EXPECT_GE(f.box[0].hi, f.foot.at[0] - 1e-12);
                if (i > 0) EXPECT_GE(f.foot.distance, all.feet[i - 1].foot.distance);
            }
            feet_seen += int(all.feet.size());
            EXPECT_NEAR(all.feet[0].foot.distance, must(query.nearest<2>(q)).distance, 1e-14);
        }
    }
    EXPECT_GT(feet_seen, 300);
}

TEST(NearestFeet, of_surfaces_are_all_local_minima_among_samples) {
    std::mt19937 rng(21);
    Random random(22);
    for (int trial = 0; trial < 6; ++trial) {
        const auto surface = random_patch<2, Hom<3>>(rng, {2, 1 + trial % 3}, 3);
        const auto query = feet_query(surface);
        const auto on = surface.domain();
        constexpr int kSteps = 120;
        const Vec<3> q{{random.real(-2, 2), random.real(-2, 2), random.real(-2, 2)}};
        const auto all = must(query.feet<3>(q, 5));
        ASSERT_TRUE(all.complete);
        const auto at = [&](int i, int j) {
            return Vec<2>{{on[0].lo + on[0].length() * i / kSteps, on[1].lo + on[1].length() * j / kSteps}};
        };
        std::vector<std::vector<double>> d(kSteps + 1, std::vector<double>(kSteps + 1));
        for (int i = 0; i <= kSteps; ++i)
            for (int j = 0; j <= kSteps; ++j)
                d[std::size_t(i)][std::size_t(j)] = norm(surface(at(i, j)[0], at(i, j)[1]) - q);
        int minima = 0;
        for (int i = 0; i <= kSteps; ++i)
            for (int j = 0; j <= kSteps; ++j) {
                const double here = d[std::size_t(i)][std::size_t(j)];
                bool least = true;
                for (int a = std::max(0, i - 1); a <= std::min(kSteps, i + 1); ++a)
                    for (int b = std::max(0, j - 1); b <= std::min(kSteps, j + 1); ++b)
                        least = least && d[std::size_t(a)][std::size_t(b)] >= here;
                if (!least) continue;
                ++minima;
                bool listed = here >= all.others;
                for (const auto& f : all.feet)  // valleys across the grid: the foot may be some steps on
                    listed = listed || (f.foot.distance <= here + 1e-12 &&
                                        std::abs(f.foot.at[0] - at(i, j)[0]) <= on[0].length() / 12 &&
                                        std::abs(f.foot.at[1] - at(i, j)[1]) <= on[1].length() / 12);
                EXPECT_TRUE(listed) << "trial " << trial << " at " << i << ", " << j << ": " << here;
            }
        EXPECT_LE(int(all.feet.size()), std::min(minima, 5)) << "trial " << trial;
    }
}

TEST(NearestFeet, knots_and_seams_are_no_feet_but_ends_and_corners_are) {
    const auto ring = must(full_ellipse(must(circle(Vec<2>{{0, 0}}, 1.0)), EllipseForm::closed)).curve;
    const auto open = must(full_ellipse(must(circle(Vec<2>{{0, 0}}, 1.0)), EllipseForm::open)).curve;
    for (const auto& curve : {ring, open})
        for (const Vec<2>& q :
             {Vec<2>{{3, 0.1}}, Vec<2>{{-3, 0.1}}, Vec<2>{{0.2, 0.1}}, Vec<2>{{3, 0}}, Vec<2>{{0.3, 0.4}}}) {
            const auto all = must(feet_query(curve).feet<2>(q, 4));
            ASSERT_EQ(all.feet.size(), 1u) << q[0] << ", " << q[1];
            EXPECT_NEAR(all.feet[0].foot.distance, std::abs(norm(q) - 1), 1e-14);
            EXPECT_EQ(all.others, std::numeric_limits<double>::infinity());
        }
    const auto line = must(Curve<Vec<2>>::make({*BSplineBasis::bezier(2)},
                                               Net<1, Vec<2>>({3}, {{{-1, 1}}, {{0, -1}}, {{1, 1}}})));
    const auto bowl = must(feet_query(line).feet<2>(Vec<2>{{0, 3}}, 4));  // a parabola from its inside
    ASSERT_EQ(bowl.feet.size(), 2u);  // its ends: the bottom is the farthest
    EXPECT_EQ(bowl.feet[0].foot.at[0], 0);
    EXPECT_EQ(bowl.feet[1].foot.at[0], 1);
    const auto one = must(feet_query(line).feet<2>(Vec<2>{{0, 3}}, 1));
    EXPECT_EQ(one.feet.size(), 1u);
    EXPECT_NEAR(one.others, std::sqrt(5.0), 1e-12);
    const auto centre = must(feet_query(ring).feet<2>(Vec<2>{{0, 0}}, 3));
    ASSERT_EQ(centre.feet.size(), 1u);
    EXPECT_TRUE(centre.feet[0].stretch);
}

// At a doubled end, exact but for rounding, the direction of the curve is nothing but rounding.
TEST(NearestFeet, ends_with_doubled_control_points_are_feet) {
    for (const double off : {0.0, 0x1p-53, -0x1p-53}) {
        const auto curve = must(Curve<Vec<2>>::make(
            {must(BSplineBasis::bezier(3))},
            Net<1, Vec<2>>({4}, {Vec<2>{{0, 0}}, Vec<2>{{0, 1}}, Vec<2>{{1, 1}}, Vec<2>{{1, 1 + off}}})));
        const auto all = must(feet_query(curve).feet<2>(Vec<2>{{2, 2}}, 3));
        ASSERT_EQ(all.feet.size(), 1u) << off;
        EXPECT_NEAR(all.feet[0].foot.distance, std::sqrt(2), 1e-12);
        EXPECT_EQ(all.feet[0].foot.at[0], 1);
    }
}

TEST(NearestFeet, a_spent_budget_is_said_and_leaves_a_bound_that_holds) {
    std::mt19937 rng(31);
    const Vec<2> q{{0.3, 0.2}};
    for (const int inner : {0, 6}) {
        const auto query = feet_query(random_patch<1, Hom<2>>(rng, {inner == 0 ? 7 : 3}, inner));
        const auto whole = must(query.feet<2>(q, 10));
        ASSERT_TRUE(whole.complete);
        for (const int parts : {1, 2, 3, 5}) {
            const auto some = must(query.feet<2>(q, 10, {.max_parts = parts}));
            EXPECT_FALSE(some.complete);
            for (const auto& f : whole.feet) {
                bool listed = f.foot.distance + f.foot.point_error >= some.others;
                for (const auto& s : some.feet) listed = listed || norm(s.foot.point - f.foot.point) < 1e-6;
                EXPECT_TRUE(listed) << parts;
            }
        }
    }
    const auto query = feet_query(random_patch<1, Hom<2>>(rng, {3}, 2));
    expect_refusal(query.feet<2>(q, 0), RefusalKind::invalid, "count");
    expect_refusal(query.feet<2>(Vec<2>{{NAN, 0}}, 1), RefusalKind::nonfinite, "points[0]");
}

}  // namespace
}  // namespace freiform::test
