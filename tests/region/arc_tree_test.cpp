#include "region/arc_tree_detail.hpp"

#include <freiform/poly/arc_index.hpp>
#include <freiform/poly/predicates.hpp>

#include <gtest/gtest.h>
#include <numbers>
#include <regions.hpp>
#include <sanitizer.hpp>

namespace freiform {
namespace {

using namespace test;
using detail::ArcTree;
using detail::RegionArc;

std::vector<RegionArc> arcs_of(const Path& a, const Path& b) {
    std::vector<RegionArc> arcs;
    EXPECT_TRUE(add_arcs(a, 0, arcs));
    EXPECT_TRUE(add_arcs(b, 1, arcs));
    return arcs;
}

// The slow twin: every arc is asked.
std::optional<std::array<int, 2>> quarters_of_all(std::span<const RegionArc> arcs, const Vec<2>& p) {
    std::array<int, 2> sums{};
    for (const RegionArc& arc : arcs) {
        const ArcIndex index = arc_index(arc.coordinates(arc.x), arc.coordinates(arc.y), arc.weights(), p);
        if (index.through) return {};
        sums[std::size_t(arc.operand)] += index.quarters;
    }
    return sums;
}

TEST(ArcTree, says_of_points_what_all_arcs_say_one_by_one) {
    Random random(1);
    for (int i = 0; i < cases(60); ++i) {
        const PathOptions o{.segments = random.integer(2, 30), .lattice = i % 2 == 0, .lines = i % 3 == 0};
        std::vector<RegionArc> arcs = arcs_of(random_path(random, o), random_path(random, o));
        // Every third without some of its arcs: runs that do not close.
        if (i % 3 == 2) std::erase_if(arcs, [&](const RegionArc&) { return random.chance(0.2); });
        const ArcTree tree(arcs);
        for (int k = 0; k < 100; ++k) {
            const auto coordinate = [&] {
                return random.chance(0.5) ? random.integer(-2, 10) / 2.0 : random.real(-1, 5);
            };
            const Vec<2> p{{coordinate(), coordinate()}};
            EXPECT_EQ(tree.quarters(arcs, p), quarters_of_all(arcs, p)) << i << ' ' << p[0] << ' ' << p[1];
        }
    }
}

TEST(ArcTree, leaves_out_no_pair_of_lines_that_cross_and_no_line_across_a_segment) {
    Random random(2);
    const auto cross = [](const Vec<2>& a, const Vec<2>& b, const Vec<2>& c, const Vec<2>& d) {
        return orient2d(a, b, c) * orient2d(a, b, d) <= 0 && orient2d(c, d, a) * orient2d(c, d, b) <= 0;
    };
    for (int i = 0; i < cases(40); ++i) {
        const PathOptions o{.segments = random.integer(3, 25), .lattice = i % 2 == 0, .lines = true};
        const std::vector<RegionArc> arcs = arcs_of(random_path(random, o), random_path(random, o));
        const ArcTree tree(arcs);
        std::vector<std::vector<bool>> asked(arcs.size(), std::vector<bool>(arcs.size()));
        EXPECT_TRUE(
            tree.each_pair([&](std::size_t k, std::size_t l) { return asked[k][l] = asked[l][k] = true; },
                           [] { return true; }));
        const Vec<2> p{{random.real(0, 4), random.real(0, 4)}}, q{{random.real(0, 4), random.real(0, 4)}};
        std::vector<bool> near(arcs.size());
        tree.each_near(p, q, 4 * detail::kTouchError, [&](std::size_t k) { return near[k] = true; });
        for (std::size_t k = 0; k < arcs.size(); ++k) {
            const PathSegment& s = arcs[k].s;
            const auto is_flat_together = [&](const Vec<2>& a, const Vec<2>& b) {  // then boxes decide
                return orient2d(s.front(), s.back(), a) == 0 && orient2d(s.front(), s.back(), b) == 0;
            };
            EXPECT_TRUE(near[k] || !cross(s.front(), s.back(), p, q)) << i << ' ' << k;
            for (std::size_t l = 0; l < k; ++l) {
                const PathSegment& t = arcs[l].s;
                if (!is_flat_together(t.front(), t.back()))
                    EXPECT_TRUE(asked[k][l] || !cross(s.front(), s.back(), t.front(), t.back())) << k << l;
            }
        }
    }
}

// Two stars with spikes side by side, and grids of squares: seconds if pairs or probes look at a tenth of
// all.
TEST(ArcTree, ten_thousand_spikes_do_not_take_ten_thousand_times_as_long) {
    const int n = 10'000;
    const auto star = [&](double phase) {
        std::vector<Vec<2>> corners;
        for (int i = 0; i < n; ++i) {
            const double angle = phase + 2 * std::numbers::pi * i / n, r = i % 2 ? 0.05 : 1;
            corners.push_back({{r * std::cos(angle), r * std::sin(angle)}});
        }
        return Path{{polygon(std::move(corners))}};
    };
    const auto arcs = arcs_of(star(0), star(2.1 / n));
    const ArcTree tree(arcs);
    std::size_t steps = 0, asked = 0, looked = 0;
    tree.each_pair([&](std::size_t, std::size_t) { return ++asked > 0; }, [&] { return ++steps > 0; });
    EXPECT_LT(asked, std::size_t(40 * n));
    EXPECT_LT(steps, std::size_t(400 * n));
    Random random(3);
    for (int k = 0; k < 200; ++k) {
        const double angle = random.real(0, 6.28), r = random.real(0.1, 1.1);
        const Vec<2> p{{r * std::cos(angle), r * std::sin(angle)}};
        if (k < 5) EXPECT_EQ(tree.quarters(arcs, p), quarters_of_all(arcs, p));
        tree.each_near(p, p, 4 * detail::kTouchError, [&](std::size_t) { return ++looked > 0; });
    }
    EXPECT_LT(looked, 200u * 16);
}

}  // namespace
}  // namespace freiform
