// Curves in space meet by construction, or pass each other.
#include "bezier.hpp"

#include <freiform/intersect/curve_curve.hpp>

#include <gtest/gtest.h>

namespace freiform::test {
namespace {

using Winding = Curve<Vec<3>>;
Winding space_bezier(std::vector<Vec<3>> points) { return bezier(std::move(points)); }
Intersections<3, 2> meet_in_space(const Winding& a, const Winding& b, double accuracy = 0) {
    return must(intersect(a, b, {.accuracy = accuracy}));
}

TEST(IntersectSpace, lines_meet_at_thirds_exactly) {
    const Winding a = space_bezier({{{0, 0, 0}}, {{3, 3, 6}}}), b = space_bezier({{{1, 0, 2}}, {{1, 3, 2}}});
    const auto found = meet_in_space(a, b);
    ASSERT_EQ(found.contacts.size(), 1u);
    EXPECT_TRUE(found.contacts[0].is_proven());
    EXPECT_EQ(found.contacts[0].kind, ContactKind::crossing);
    EXPECT_NEAR(found.contacts[0].at[0], 1.0 / 3, 1e-16);
    for (const double up : {1e-15, 1e-9, 0.5})
        EXPECT_TRUE(meet_in_space(a, space_bezier({{{1, 0, 2 + up}}, {{1, 3, 2 + up}}})).contacts.empty())
            << up;
}

TEST(IntersectSpace, curves_through_common_points_meet_there_and_nowhere_else) {
    Random random(8);
    const auto near_whole = [&] {
        return Vec<3>{
            {random.integer(-4, 4) / 4.0, random.integer(-4, 4) / 4.0, random.integer(-4, 4) / 4.0}};
    };
    for (int i = 0; i < 40; ++i) {
        // The middle of a quadratic is (a + 2 b + c) / 4, exactly.
        const Vec<3> a = near_whole(), b = near_whole(), c = near_whole(), d = near_whole(), e = near_whole();
        const Vec<3> m = 0.25 * (a + 2.0 * b + c);
        const Winding one = space_bezier({a, b, c}), two = space_bezier({d, 0.5 * (4.0 * m - d - e), e});
        const auto found = meet_in_space(one, two);
        const auto middle = std::find_if(found.contacts.begin(), found.contacts.end(), [](const auto& x) {
            return x.at == std::array{0.5, 0.5};
        });
        ASSERT_NE(middle, found.contacts.end()) << i;
        EXPECT_LT(middle->gap, 1e-13);
        EXPECT_TRUE(middle->is_proven()) << i;
        // A little off, they pass each other.
        const Vec<3> n = cross(c - a, e - d);
        if (norm(n) < 1e-3) continue;
        const Vec<3> off = (1e-10 / norm(n)) * n;
        for (const auto& x :
             meet_in_space(one, space_bezier({d + off, 0.5 * (4.0 * m - d - e) + off, e + off})).contacts)
            EXPECT_GT(std::abs(x.at[0] - 0.5) + std::abs(x.at[1] - 0.5), 1e-3) << i;
    }
}

TEST(IntersectSpace, splines_with_rounded_pieces_say_how_near_they_come) {
    Random random(9);
    const auto basis = must(BSplineBasis::make(3, {0, 0, 0, 0, 0.3, 0.6, 1, 1, 1, 1}));
    for (int i = 0; i < 20; ++i) {
        const Winding c = random_patch_on<1, Vec<3>>(random, {basis});
        const Vec<3> x = c(0.45), y = random_coefficient<Vec<3>>(random, 1);
        const auto found = meet_in_space(c, space_bezier({x - y, x + y}));
        const auto hit = std::find_if(found.contacts.begin(), found.contacts.end(),
                                      [](const auto& h) { return std::abs(h.at[0] - 0.45) < 1e-9; });
        ASSERT_NE(hit, found.contacts.end()) << i;
        EXPECT_EQ(hit->kind, ContactKind::possible);
        EXPECT_EQ(hit->least, 0);
        EXPECT_LT(hit->gap, 1e-13);
    }
}

TEST(IntersectSpace, the_same_curve_overlaps) {
    Random random(10);
    for (int i = 0; i < 10; ++i) {
        const Winding c = random_bezier<Vec<3>>(random, 3);
        const auto found = meet_in_space(c, must(restrict_to(c, 0, {0.2, 0.7})));
        ASSERT_EQ(found.overlaps.size(), 1u) << i;
        EXPECT_NEAR(found.overlaps[0].a.lo, 0.2, 1e-12);
        EXPECT_NEAR(found.overlaps[0].a.hi, 0.7, 1e-12);
        EXPECT_LT(found.overlaps[0].gap, 1e-11);
        EXPECT_TRUE(found.undecided.empty());
    }
}

}  // namespace
}  // namespace freiform::test
