// Laws: spheres in any parameters are found and nothing else is, wherever they are and however large; the
// bound holds at points of the surface.
#include "support/random.hpp"

#include <freiform/make/quadric.hpp>
#include <freiform/query/sphere_of.hpp>

#include <cmath>
#include <gtest/gtest.h>

namespace freiform {
namespace {

using test::must;

double farthest(const Surface<Hom<3>>& s, const Vec<3>& centre, double radius) {
    const auto on = s.domain();
    double off = 0;
    for (int i = 0; i <= 40; ++i)
        for (int j = 0; j <= 40; ++j) {
            const Param<2> at{clamped(on[0].lo + on[0].length() * i / 40, on[0]),
                              clamped(on[1].lo + on[1].length() * j / 40, on[1])};
            off = std::max(off, std::abs(norm(s(at) - centre) - radius));
        }
    return off;
}

TEST(SphereOf, spheres_and_parts_of_them_are_found_within_a_bound_that_holds) {
    for (const double radius : {1e-5, 0.3, 7.0, 1e6})
        for (const Vec<3>& origin : {Vec<3>{}, Vec<3>{{3, -20, 0.1}}})
            for (const Interval latitude : {kPoleToPole, Interval{-0.2, 1.1}})
                for (const Turn& turn : {Turn{}, Turn{{0.3, 2.9}}}) {
                    const auto frame = must(frame_about(radius * origin, {{1, 2, -0.5}}));
                    const auto made = must(sphere(frame, radius, turn, latitude)).surface;
                    const auto found = sphere_of(made, 1e-9 * radius);
                    ASSERT_TRUE(found) << radius;
                    EXPECT_LT(norm(found->centre - radius * origin), 1e-10 * radius);
                    EXPECT_NEAR(found->radius, radius, 1e-10 * radius);
                    EXPECT_GE(found->off, farthest(made, found->centre, found->radius));
                    EXPECT_LT(found->off, 1e-9 * radius);
                }
}

TEST(SphereOf, tiles_without_poles_lie_on_the_sphere_too) {
    for (const auto& tile : must(sphere_in_six(must(frame_about({{1, 1, 1}}, {{0, 1, 0}})), 2)).faces) {
        const auto found = sphere_of(tile, 1e-10);
        ASSERT_TRUE(found);
        EXPECT_LT(norm(found->centre - Vec<3>{{1, 1, 1}}), 1e-12);
    }
}

TEST(SphereOf, what_leaves_the_sphere_between_samples_is_no_sphere_and_its_bound_says_how_far) {
    const auto made = must(sphere(must(frame_about({}, {{0, 0, 1}})), 1)).surface;
    auto net = made.net();
    Hom<3>& moved = net.view()({2, 1});
    moved = weighted(1.02 * project(moved), moved.weight());
    const auto dented = must(Surface<Hom<3>>::make(made.bases(), std::move(net)));
    const double off = farthest(dented, {}, 1);
    EXPECT_GT(off, 1e-3);
    EXPECT_GE(off_sphere(dented, {}, 1), off);
    EXPECT_LT(off_sphere(dented, {}, 1), 16 * off);
    EXPECT_FALSE(sphere_of(dented, 1e-4));
    EXPECT_TRUE(sphere_of(dented, 0.1));
}

TEST(SphereOf, planes_cylinders_and_ellipsoids_are_none) {
    const auto frame = must(frame_about({}, {{0, 0, 1}}));
    EXPECT_FALSE(sphere_of(must(cylinder(frame, 1, {0, 1})).surface, 1e-3));
    EXPECT_FALSE(sphere_of(must(torus(frame, 2, 1)).surface, 1e-3));
    auto longer = frame;
    longer.z = 1.01 * longer.z;
    EXPECT_FALSE(sphere_of(must(sphere(longer, 1)).surface, 1e-3));
    EXPECT_FALSE(sphere_through(std::vector<Vec<3>>{{{0, 0, 0}}, {{1, 0, 0}}, {{0, 1, 0}}, {{1, 1, 0}}}));
}

}  // namespace
}  // namespace freiform
