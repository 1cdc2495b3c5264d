#include "support/bezier.hpp"

#include <freiform/make/joint.hpp>
#include <freiform/query/continuity.hpp>

#include <gtest/gtest.h>
#include <numbers>

namespace freiform {
namespace {

using test::bezier;
using test::must;
using test::Random;
using test::random_bezier;

TEST(Meetings, are_found_and_put_in_order) {
    const auto ends = [](std::vector<double> a, std::vector<double> b) {
        const auto side = [](std::vector<double> p) {
            CurveSide s;
            s.dimension = int(p.size());
            s.derivatives.resize(p.size());
            s.origin = std::move(p);
            return s;
        };
        return CurveEnds{side(std::move(a)), side(std::move(b))};
    };
    const CurveEnds all[] = {
        ends({0, 0}, {1, 0}), ends({2, 0}, {1, 1e-3}),   ends({2, 1e-4}, {0, 0}), ends({5, 5}, {5, 5}),
        ends({}, {}),         ends({0, 0, 0}, {9, 9, 9})};
    const auto m = must(meetings(all, 0.01));
    ASSERT_EQ(m.size(), 4u);
    EXPECT_EQ(m[0].first, 0u);  // end to end
    EXPECT_EQ(m[0].second, 1u);
    EXPECT_EQ(m[0].first_end, End::end);
    EXPECT_EQ(m[0].second_end, End::end);
    EXPECT_DOUBLE_EQ(m[0].distance, 1e-3);
    EXPECT_EQ(m[1].first, 2u);  // the end of 2 leads into the start of 0
    EXPECT_EQ(m[1].second, 0u);
    EXPECT_EQ(m[2].first_end, End::start);
    EXPECT_EQ(m[2].second_end, End::start);
    EXPECT_EQ(m[3].first, 3u);
    EXPECT_EQ(m[3].second, 3u);
    EXPECT_EQ(must(meetings(all, 0)).size(), 2u);
    EXPECT_EQ(meetings(all, 0.01, 3).error().kind, RefusalKind::limit);
    EXPECT_EQ(meetings(all, -1).error().where, "gap");
}

TEST(Joints, run_through_curves_backwards_where_ends_meet_so) {
    Random random(12);
    for (int round = 0; round < 10; ++round) {
        const auto a = random_bezier<Hom<3>>(random, 4, {2, 3});
        const double phi[] = {0.7, 0.4};
        const auto b = next_g<Hom<3>>(
            a, phi, {{1, 1.25}, {test::random_coefficient<Hom<3>>(random, 1, 0, 0.5)}, {1, 2, 1}});
        const std::vector<Curve<Hom<3>>> forward{a, must(b)};
        for (int flip = 0; flip < 4; ++flip) {
            const auto one = flip & 1 ? reverse(forward[0], 0) : forward[0],
                       two = flip & 2 ? reverse(forward[1], 0) : forward[1];
            const CurveEnds ends[] = {ends_of(one), ends_of(two)};
            const auto all = must(joints(ends, 1e-12));
            ASSERT_EQ(all.size(), 1u) << flip;
            const Meeting& m = all[0].meeting;
            EXPECT_EQ(all[0].joint.g_order, 2) << flip;
            // Both reversed: the second leads into the first, with the inverse of phi.
            EXPECT_EQ(m.first, flip == 3 ? 1u : 0u);
            EXPECT_EQ(m.first_end, flip == 1 ? End::start : End::end);
            EXPECT_EQ(m.second_end, flip == 2 ? End::end : End::start);
            EXPECT_NEAR(all[0].joint.phi[1], flip == 3 ? 1 / 0.7 : 0.7, 1e-11);
            EXPECT_EQ(all[0].joint.phi[0], flip == 3 ? 2 : 1);
        }
    }
    const CurveEnds closed[] = {ends_of(bezier<Vec<2>>({{{0, 0}}, {{3, 0}}, {{0, 3}}, {{0, 0}}}))};
    const auto loop = must(joints(closed, 0));
    ASSERT_EQ(loop.size(), 1u);
    EXPECT_EQ(loop[0].meeting.first, loop[0].meeting.second);
    EXPECT_NEAR(loop[0].joint.g[1].size, std::numbers::pi / 2, 1e-15);
}

}  // namespace
}  // namespace freiform
