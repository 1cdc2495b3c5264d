// Asking the tree from a place nearby says what asking it from the root says.
#include "mesh/curvature_tree_detail.hpp"
#include "support/random.hpp"

#include <gtest/gtest.h>

namespace freiform {
namespace {

using test::must;
using test::Random;

SurfaceGeometry waves(Random& random) {
    const auto basis = *BSplineBasis::clamped_uniform(3, 8);
    std::vector<Vec<3>> c;
    for (int i = 0; i < 8; ++i)
        for (int k = 0; k < 8; ++k) c.push_back({{double(i), double(k), 0.1 * i * random.real(-1, 1)}});
    return must(Surface<Vec<3>>::make({basis, basis}, Net<2, Vec<3>>({8, 8}, c)));
}

TEST(CurvatureTree, says_the_same_from_any_place) {
    Random random(3);
    const SurfaceGeometry s = waves(random);
    const DerivativeQuery<2, 3> surface(s);
    const std::vector<Vec<2>> polygon{{{0, 0}}, {{5, 0}}, {{5, 3}}, {{0, 5}}};
    const std::vector<std::array<int, 2>> segments{{0, 1}, {1, 2}, {2, 3}, {3, 0}};
    for (const bool knows_normals : {true, false}) {
        const auto tree = must(
            CurvatureTree::make(surface, polygon, segments, {.tolerance = 1e-3}, 100'000, knows_normals));
        int place = 0, inner = 0, whole = 0;
        for (int k = 0; k < 3000; ++k) {
            const double w = random.chance(0.3) ? 1 : 0.05;
            const Vec<2> lo{{random.real(-0.1, 5), random.real(-0.1, 5)}};
            const Box<2> box{lo, lo + Vec<2>{{random.real(0, w), random.real(0, w)}}};
            place = tree.place_of(box, place);
            EXPECT_EQ(place, tree.place_of(box));
            inner += place != 0;
            const Bending here = tree.over(box, place), all = tree.over(box, 0);
            EXPECT_EQ(here.full.uu, all.full.uu);
            EXPECT_EQ(here.full.uv, all.full.uv);
            EXPECT_EQ(here.least, all.least);
            const auto near = tree.all_over(box, place), far = tree.all_over(box, 0);
            ASSERT_EQ(near.has_value(), far.has_value());
            if (near) {
                EXPECT_EQ(near->uu, far->uu);
                EXPECT_EQ(near->vv, far->vv);
            }
            if (const Curvature* c = tree.all_in(place, box)) {
                ++whole;
                ASSERT_TRUE(near);
                EXPECT_GE(c->uu, near->uu);
                EXPECT_GE(c->uv, near->uv);
                EXPECT_GE(c->vv, near->vv);
            }
        }
        EXPECT_GT(inner, 1000);
        EXPECT_GT(whole, 500);
    }
}

// Bounds of a box serve its parts, and still bound what is there.
TEST(CurvatureTree, bounds_second_derivatives_at_samples) {
    Random random(4);
    const SurfaceGeometry s = waves(random);
    const DerivativeQuery<2, 3> surface(s);
    const std::vector<Vec<2>> polygon{{{0, 0}}, {{5, 0}}, {{5, 5}}, {{0, 5}}};
    const std::vector<std::array<int, 2>> segments{{0, 1}, {1, 2}, {2, 3}, {3, 0}};
    const auto tree = must(CurvatureTree::make(surface, polygon, segments, {.tolerance = 1e-3}, 100'000));
    for (int k = 0; k < 3000; ++k) {
        const Vec<2> x{{random.real(0, 5), random.real(0, 5)}};
        const Box<2> box{x - Vec<2>{{1e-9, 1e-9}}, x + Vec<2>{{1e-9, 1e-9}}};
        const Bending at = tree.over(box, 0);
        const auto j = jet<2>(s, x.c);
        EXPECT_LE(norm(j(2, 0)), at.full.uu * (1 + 1e-9));
        EXPECT_LE(norm(j(1, 1)), at.full.uv * (1 + 1e-9));
        EXPECT_LE(norm(j(0, 2)), at.full.vv * (1 + 1e-9));
        if (!(at.least > 0)) continue;
        const Vec<3> n = unit(cross(j(1, 0), j(0, 1)));
        EXPECT_LE(norm(n - at.n), at.tilt * (1 + 1e-9));
        EXPECT_LE(std::abs(dot(at.n, j(2, 0))), at.across.uu + 1e-9);
        EXPECT_LE(std::abs(dot(n, j(0, 2))), at.seen(0).vv + 1e-9);
    }
}

}  // namespace
}  // namespace freiform
