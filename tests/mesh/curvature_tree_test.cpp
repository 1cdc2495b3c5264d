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
        const auto tree = must(CurvatureTree::make(surface, polygon, segments, {.tolerance = 1e-3}, 100'000,
                                                   {knows_normals, false}));
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

// As few as are counted at once, and many more: by one thread and by all.
TEST(CurvatureTree, no_more_leaves_are_made_than_are_allowed) {
    Random random(6);
    const SurfaceGeometry s = waves(random);
    const DerivativeQuery<2, 3> surface(s);
    const std::vector<Vec<2>> polygon{{{0, 0}}, {{5, 0}}, {{5, 5}}, {{0, 5}}};
    const std::vector<std::array<int, 2>> segments{{0, 1}, {1, 2}, {2, 3}, {3, 0}};
    for (const double tolerance : {0.1, 2e-3}) {
        std::vector<std::size_t> fewest;
        for (const bool is_shared : {false, true}) {
            std::size_t refused = 1, enough = 100'000;
            while (enough - refused > 1) {
                const std::size_t most = (refused + enough) / 2;
                const auto tree = CurvatureTree::make(surface, polygon, segments,
                                                      {.tolerance = tolerance, .is_shared = is_shared}, most);
                if (!tree) {
                    EXPECT_EQ(tree.error().kind, RefusalKind::limit);
                }
                (tree ? enough : refused) = most;
            }
            fewest.push_back(enough);
        }
        EXPECT_EQ(fewest[0], fewest[1]);
        EXPECT_GT(fewest[0], 20u);
        EXPECT_EQ(fewest[0]<256, tolerance> 0.01) << fewest[0];
    }
}

// So many control points for each piece that leaves are judged by samples; C1 at some of its knots, and
// rational.
SurfaceGeometry many_waves(Random& random) {
    const auto u = *BSplineBasis::make(6, {0, 0, 0, 0, 0, 0, 0, 1, 2, 2, 2, 2, 2, 3, 5, 5, 5, 5, 5, 5, 5});
    const auto v = *BSplineBasis::clamped_uniform(5, 10);
    std::vector<Hom<3>> c;
    for (int i = 0; i < u.size(); ++i)
        for (int k = 0; k < 10; ++k)
            c.push_back(weighted(Vec<3>{{5.0 * i / (u.size() - 1), double(k), 0.2 * random.real(-1, 1)}},
                                 random.real(0.8, 1.2)));
    return must(Surface<Hom<3>>::make({u, v}, Net<2, Hom<3>>({u.size(), 10}, c)));
}

TEST(CurvatureTree, bounds_by_samples_of_pieces_with_many_control_points_hold) {
    Random random(5);
    const SurfaceGeometry s = many_waves(random);
    const DerivativeQuery<2, 3> surface(s);
    ASSERT_TRUE(surface.is_twice_smooth({Interval{0.5, 2}, Interval{0, 5}}));
    EXPECT_FALSE(surface.is_twice_smooth({Interval{1.5, 2.5}, Interval{0, 5}})) << "C1 at 2";
    EXPECT_FALSE(surface.is_twice_smooth({Interval{4, 5.1}, Interval{0, 5}})) << "beyond the end";
    int known = 0;
    double sharpness = 0;
    for (int k = 0; k < 300; ++k) {
        const auto box_in = [&](const Box<2>& all) {
            Box<2> out;
            for (int i = 0; i < 2; ++i)
                out.add(Vec<2>{{random.real(all.lo[0], all.hi[0]), random.real(all.lo[1], all.hi[1])}});
            return out;
        };
        const Box<2> outer = box_in({{{2, 0}}, {{5, 5}}}), box = box_in(outer);
        const auto middle_of = [&](const Box<2>& b) {
            return jet<2>(s, {b.side(0).middle(), b.side(1).middle()});
        };
        const auto j = middle_of(outer);
        Variation variation;
        (void)bending_of(surface, outer, true, j, &variation);
        const BoxBending at = bending_from_middle(surface, box, true, middle_of(box), variation);
        for (int i = 0; i < 40; ++i) {
            const auto x = jet<2>(s, {random.real(box.lo[0], box.hi[0]), random.real(box.lo[1], box.hi[1])});
            EXPECT_LE(norm(x(2, 0)), at.full.uu);
            EXPECT_LE(norm(x(1, 1)), at.full.uv);
            EXPECT_LE(norm(x(0, 2)), at.full.vv);
            EXPECT_LE(norm(x(1, 0)), at.first[0]);
            EXPECT_LE(norm(x(0, 1)), at.first[1]);
            if (!(norm(at.n) > 0)) continue;
            EXPECT_LE(std::abs(dot(at.n, x(2, 0))), at.across.uu);
            EXPECT_LE(std::abs(dot(at.n, x(1, 1))), at.across.uv);
            EXPECT_LE(std::abs(dot(at.n, x(0, 2))), at.across.vv);
        }
        if (!(at.least > 0)) continue;
        ++known;
        sharpness = std::max(sharpness, norm(middle_of(box)(2, 0)) / at.full.uu);
    }
    EXPECT_GT(known, 50);
    EXPECT_GT(sharpness, 0.9) << "bounds that are useful";
}

// Threads, and growing a tree in parts, change nothing.
TEST(CurvatureTree, of_a_face_that_is_alone_is_the_same_tree) {
    Random random(6);
    const std::vector<Vec<2>> polygon{{{0, 0}}, {{5, 0}}, {{5, 3}}, {{0, 5}}};
    const std::vector<std::array<int, 2>> segments{{0, 1}, {1, 2}, {2, 3}, {3, 0}};
    for (const SurfaceGeometry& s : {waves(random), many_waves(random)}) {
        const DerivativeQuery<2, 3> surface(s);
        const auto made = [&](bool shared) {
            return must(CurvatureTree::make(surface, polygon, segments,
                                            {.tolerance = 1e-3, .is_shared = shared}, 100'000));
        };
        const auto usual = made(false), shared = made(true);
        ASSERT_GT(usual.corners().size(), 200u);
        ASSERT_EQ(usual.corners().size(), shared.corners().size());
        for (std::size_t i = 0; i < usual.corners().size(); ++i) {
            EXPECT_EQ(usual.corners()[i].at, shared.corners()[i].at);
            EXPECT_EQ(usual.corners()[i].leaf, shared.corners()[i].leaf);
        }
        const Box<2> box{{{0.3, 0.2}}, {{2.7, 2.1}}};
        EXPECT_EQ(usual.over(box, 0).full.uu, shared.over(box, 0).full.uu);
        EXPECT_EQ(usual.over(box, 0).least, shared.over(box, 0).least);
        EXPECT_EQ(shared.place_of(box, shared.place_of({{{0.1, 0.1}}, {{0.2, 0.2}}})), shared.place_of(box));
    }
    const SurfaceGeometry s = waves(random);
    const DerivativeQuery<2, 3> surface(s);
    for (const bool shared : {false, true}) {
        const auto none =
            CurvatureTree::make(surface, polygon, segments, {.tolerance = 1e-3, .is_shared = shared}, 50);
        ASSERT_FALSE(none);
        EXPECT_EQ(none.error().kind, RefusalKind::limit);
    }
}

// Of an offset surface over a box along which normals turn by half a turn nothing is bounded: the longer side
// is what has to be cut then, not always the same.
TEST(CurvatureTree, boxes_without_bounds_are_cut_along_their_longer_side) {
    const auto bent = *BSplineBasis::clamped_uniform(3, 4), straight = *BSplineBasis::clamped_uniform(1, 2);
    for (const bool along_u : {true, false}) {
        std::vector<Vec<3>> c;
        const Vec<3> arc[] = {{{1, 0, 0}}, {{1, 1.3, 0}}, {{-1, 1.3, 0}}, {{-1, 0, 0}}};
        const auto at = [&](int k, int z) { return arc[k] + Vec<3>{{0, 0, 0.2 * z}}; };
        for (int i = 0; i < (along_u ? 4 : 2); ++i)
            for (int k = 0; k < (along_u ? 2 : 4); ++k) c.push_back(along_u ? at(i, k) : at(k, i));
        const SurfaceGeometry base =
            along_u ? must(Surface<Vec<3>>::make({bent, straight}, Net<2, Vec<3>>({4, 2}, c)))
                    : must(Surface<Vec<3>>::make({straight, bent}, Net<2, Vec<3>>({2, 4}, c)));
        // Half the least radius inwards.
        const SurfaceGeometry s =
            OffsetSurface{std::make_shared<SurfaceGeometry>(base), along_u ? 0.3 : -0.3};
        const DerivativeQuery<2, 3> surface(s);
        ASSERT_FALSE(std::isfinite(surface({Interval{0, 1}, Interval{0, 1}})(2, 0)));
        const std::vector<Vec<2>> polygon{{{0, 0}}, {{1, 0}}, {{1, 1}}, {{0, 1}}};
        const std::vector<std::array<int, 2>> segments{{0, 1}, {1, 2}, {2, 3}, {3, 0}};
        // So coarse that nothing else asks for a cut.
        const auto tree = CurvatureTree::make(surface, polygon, segments, {.tolerance = 10}, 100);
        EXPECT_TRUE(tree) << along_u << ": " << tree.error().message;
    }
}

}  // namespace
}  // namespace freiform
