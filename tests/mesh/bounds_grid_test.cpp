// What a grid says of a place is at least what was noted there, and not what was noted far away.
#include "mesh/bounds_grid_detail.hpp"
#include "support/random.hpp"

#include <gtest/gtest.h>

namespace freiform {
namespace {

using test::Random;

bool meets(const Box<2>& a, const Box<2>& b) {
    return a.lo[0] <= b.hi[0] && b.lo[0] <= a.hi[0] && a.lo[1] <= b.hi[1] && b.lo[1] <= a.hi[1];
}

Box<2> random_box(Random& random, const Box<2>& whole, double part) {
    Box<2> box;
    for (int d = 0; d < 2; ++d) {
        const double size = whole.hi[d] - whole.lo[d];
        box.lo[d] = whole.lo[d] + random.real(0, 1 - part) * size;
        box.hi[d] = std::min(whole.hi[d], box.lo[d] + random.real(0, part) * size);
    }
    return box;
}

TEST(BoundsGrid, no_part_that_a_box_meets_is_missed) {
    Random random(41);
    for (const Box<2>& whole : {Box<2>{{{-1, 2}}, {{3, 2.5}}}, Box<2>{{{1e9, 0}}, {{1e9 + 1, 1e-6}}}})
        for (int round = 0; round < 40; ++round) {
            const double part = random.real(0.005, 0.4);
            const Vec<2> size = whole.hi - whole.lo;
            BoundsGrid grid(whole, part * size);
            std::vector<std::pair<Box<2>, BoundsGrid::Bounds>> noted;
            for (int k = 0; k < 60; ++k) {
                const BoundsGrid::Bounds bounds{random.real(0, 1), random.real(0, 1), random.real(0, 1), 0};
                noted.push_back({random_box(random, whole, part), bounds});
                grid.include(noted.back().first, bounds);
            }
            int answered = 0;
            for (int k = 0; k < 60; ++k) {
                // Also with a side in common.
                Box<2> box = random_box(random, whole, part);
                if (k % 3 == 0) box.lo[0] = std::min(box.hi[0], noted[std::size_t(k)].first.hi[0]);
                const auto found = grid.over(box);
                if (!found) continue;
                ++answered;
                for (const auto& [at, bounds] : noted)
                    for (std::size_t d = 0; d < 4 && meets(at, box); ++d) EXPECT_LE(bounds[d], (*found)[d]);
            }
            EXPECT_GT(answered, 50);
        }
}

TEST(BoundsGrid, far_away_nothing_is_said) {
    const Box<2> whole{{{0, 0}}, {{8, 8}}};
    BoundsGrid grid(whole, {{0.5, 0.25}});
    grid.include({{{1, 1}}, {{1.5, 1.25}}}, {5, 6, 7, 1});
    EXPECT_EQ(*grid.over({{{1.25, 1.1}}, {{1.75, 1.2}}}), (BoundsGrid::Bounds{5, 6, 7, 1}));
    EXPECT_EQ(*grid.over({{{2.25, 1.1}}, {{2.5, 1.2}}}), BoundsGrid::Bounds{});
    EXPECT_EQ(*grid.over({{{1.25, 2}}, {{1.3, 2.2}}}), BoundsGrid::Bounds{});
    EXPECT_FALSE(grid.over({{{1, 1}}, {{7, 7}}}));  // takes long
    EXPECT_FALSE(grid.over({{{7, 7}}, {{8.1, 7.1}}}));
    EXPECT_FALSE(BoundsGrid().over({{{0, 0}}, {{0, 0}}}));
}

TEST(BoundsGrid, groups_of_cells_share_them) {
    Random random(43);
    const Box<2> whole{{{-1, 0}}, {{1, 3}}};
    for (const int groups : {2, 3, 7}) {
        BoundsGrid at_once(whole, {{0.1, 0.2}}), in_groups(whole, {{0.1, 0.2}});
        int asked = 0;
        for (int k = 0; k < 200; ++k) {
            const Box<2> part = random_box(random, whole, 0.2);
            const BoundsGrid::Bounds bounds{random.real(0, 1), random.real(0, 1), 0, random.real(0, 1)};
            at_once.include(part, bounds);
            for (int g = 0; g < groups; ++g)
                in_groups.include(part, g, groups, [&] { return ++asked, bounds; });
        }
        EXPECT_LT(asked, 200 * groups);
        for (int k = 0; k < 200; ++k) {
            const Box<2> box = random_box(random, whole, 0.1);
            EXPECT_EQ(in_groups.over(box), at_once.over(box));
        }
    }
}

TEST(BoundsGrid, a_box_without_an_extent_has_one_cell) {
    BoundsGrid grid({{{2, 3}}, {{2, 5}}}, {{0, 0.5}});
    grid.include({{{2, 3}}, {{2, 3.2}}}, {1, 0, 0, 0});
    EXPECT_EQ((*grid.over({{{2, 3}}, {{2, 3.1}}}))[0], 1);
    EXPECT_EQ((*grid.over({{{2, 4.8}}, {{2, 4.9}}}))[0], 0);
}

}  // namespace
}  // namespace freiform
