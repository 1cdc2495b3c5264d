#include "support/random.hpp"
#include "support/triangle.hpp"

#include <freiform/make/quadric.hpp>
#include <freiform/make/triangle_joint.hpp>
#include <freiform/query/triangle_joint.hpp>
#include <freiform/spline/simplex_convert.hpp>

#include <gtest/gtest.h>

namespace freiform {
namespace {

using test::must;
using test::Random;
using test::random_triangle;

std::vector<Vec<3>> random_free(Random& random, int count) {
    std::vector<Vec<3>> out;
    for (int i = 0; i < count; ++i) out.push_back(test::random_coefficient<Vec<3>>(random));
    return out;
}
// A bent plane: its normals do not vanish.
SimplexPatch<2, Vec<3>> landscape(Random& random, int n) {
    std::vector<Vec<3>> b;
    for (int row = 0; row <= n; ++row)
        for (int k = 0; k <= row; ++k)
            b.push_back({{double(row - k) / n, double(k) / n, random.real(-0.1, 0.1)}});
    return must(SimplexPatch<2, Vec<3>>::make(n, b));
}

TEST(R29, joints_that_were_made_smooth_are_found_smooth) {
    Random random(321);
    for (int edge = 0; edge < 3; ++edge) {
        const auto s = landscape(random, 3);
        const auto other = landscape(random, 4);
        const auto free = other.coefficients();
        const TangentChange change{{0.5, 2}, {-0.5, 1}};
        const auto g = must(next_g1(s, edge, change, {free.begin(), free.begin() + 6}));
        const auto found = must(triangle_joint(s, edge, g, 0));
        EXPECT_LT(found.position.bound, 1e-14);
        EXPECT_LT(found.angle.bound, 1e-10) << edge;
        const Param<2> apex[3] = {{1, 1}, {-1, 1}, {1, -1}};
        const auto c = must(next_c(s, edge, 1, apex[edge], random_free(random, 3)));
        EXPECT_LT(must(c1_deviation(s, edge, c.patch, 0, apex[edge])).bound, 1e-13);
        EXPECT_LT(must(triangle_joint(s, edge, c.patch, 0)).angle.bound, 1e-10);
        EXPECT_GT(must(c1_deviation(s, edge, g, 0, apex[edge])).found, 0.01) << "G^1 is not C^1";
    }
    // Parts of one patch, and octants of a sphere, whose edges are rational.
    const auto parts = split_at(random_triangle<Vec<3>>(random, 3), {0.25, 0.5});
    EXPECT_LT(must(triangle_joint(parts[0], 1, parts[1], 0)).position.bound, 1e-14);
    const auto ball = must(sphere_in_eight({}, 1));
    // Octants +++ and -++ meet in the plane x = 0, their edges 0.
    const auto seam = must(triangle_joint(ball.octants[0], 0, ball.octants[4], 0));
    EXPECT_LT(seam.position.bound, 1e-14);
    EXPECT_LT(seam.angle.bound, 1e-11);
}

TEST(R29, what_is_wrong_with_a_joint_is_measured_and_bounded) {
    Random random(322);
    const auto s = landscape(random, 3);
    for (const double tilt : {1e-6, 1e-3, 0.3}) {
        auto c = must(next_c(s, 0, 1, {1, 1}, random_free(random, 3)));
        std::vector<Vec<3>> b(c.patch.coefficients().begin(), c.patch.coefficients().end());
        const std::size_t moved = SimplexPatch<2, Vec<3>>::slot(1, 1);  // beside the edge
        b[moved][2] += tilt;
        const auto bent = must(SimplexPatch<2, Vec<3>>::make(3, b));
        const auto d = must(c1_deviation(s, 0, bent, 0, {1, 1}));
        // 3 B_1^2 tilt, largest in the middle.
        EXPECT_GE(d.bound, 1.5 * tilt);
        EXPECT_NEAR(d.found, 1.5 * tilt, 0.1 * tilt);
        EXPECT_LE(d.bound, 1.03 * 1.5 * tilt + 1e-13);
        const auto angle = must(triangle_joint(s, 0, bent, 0)).angle;
        double sampled = 0;
        for (int i = 1; i < 500; ++i) {
            const double t = i / 500.0;
            const auto m = normal(s, {1 - t, t}), n = normal(bent, {t, 1 - t});
            if (m && n) sampled = std::max(sampled, std::atan2(norm(cross(*m, *n)), dot(*m, *n)));
        }
        EXPECT_LE(sampled, angle.bound * (1 + 1e-6) + 1e-12);
        EXPECT_LE(angle.bound, 1.05 * sampled + 1e-10);
        b[SimplexPatch<2, Vec<3>>::slot(2, 1)][0] += tilt;  // on the edge
        const auto torn = must(SimplexPatch<2, Vec<3>>::make(3, b));
        const auto gap = must(triangle_joint(s, 0, torn, 0)).position;
        EXPECT_GE(gap.bound, 4.0 / 9 * tilt);
        EXPECT_LE(gap.bound, 1.03 * 4.0 / 9 * tilt + 1e-14);
    }
    // A patch that turns back has the opposite normal.
    EXPECT_EQ(must(triangle_joint(s, 0, reversed(s), 0)).angle.bound, std::numbers::pi);
    EXPECT_EQ(triangle_joint(s, 0, s, 3).error().where, "edge");
    EXPECT_EQ(c1_deviation(s, 0, s, 0, {std::nan(""), 0}).error().where, "apex");
}

}  // namespace
}  // namespace freiform
