// Rational splines: coordinates and weights have units of their own, so that the unit of length changes no
// answer.
#include "random.hpp"
#include "shapes.hpp"

#include <freiform/intersect/curve_curve.hpp>
#include <freiform/intersect/curve_surface.hpp>
#include <freiform/query/crossings.hpp>
#include <freiform/query/self_intersection.hpp>

#include <gtest/gtest.h>

namespace freiform::test {
namespace {

constexpr int kUnits[] = {-200, -30, 37, 200};

// Coordinates times 2^e, in a unit of weights of 2^w.
template <std::size_t N, class P>
Patch<N, P> in_unit(const Patch<N, P>& patch, int e, int w) {
    auto net = patch.net();
    for (P& p : net.flat())
        for (int k = 0; k < P::kCoords; ++k) p[k] = std::scalbn(p[k], k < Space<P>::kDim ? e + w : w);
    return must(Patch<N, P>::make(patch.bases(), std::move(net)));
}

template <int D, std::size_t N>
void expect_scaled(const Intersections<D, N>& x, const Intersections<D, N>& y, int e) {
    ASSERT_EQ(x.contacts.size(), y.contacts.size()) << e;
    EXPECT_EQ(x.undecided.size(), y.undecided.size()) << e;
    for (std::size_t k = 0; k < x.contacts.size(); ++k) {
        const auto &c = x.contacts[k], &d = y.contacts[k];
        EXPECT_EQ(c.at, d.at) << e;
        EXPECT_EQ(c.box, d.box) << e;
        EXPECT_EQ(c.kind, d.kind) << e;
        EXPECT_EQ(std::scalbn(c.gap, e), d.gap) << e;
        for (int i = 0; i < D; ++i) EXPECT_EQ(std::scalbn(c.point[i], e), d.point[i]) << e;
    }
}

TEST(IntersectScale, rational_splines_of_the_plane_in_every_unit) {
    std::mt19937 rng(41);
    std::size_t proven = 0;
    for (int i = 0; i < 12; ++i) {
        const auto a = random_patch<1, Hom<2>>(rng, {2 + i % 3}, 4), b = random_patch<1, Hom<2>>(rng, {3}, 5);
        const auto plain = must(intersect(a, b));
        for (const auto& c : plain.contacts) proven += c.is_proven();
        for (const int e : kUnits)
            expect_scaled(plain, must(intersect(in_unit(a, e, 0), in_unit(b, e, -20))), e);
    }
    EXPECT_GT(proven, 30u);
}

TEST(IntersectScale, rational_splines_that_are_far_from_the_origin_cross_as_near_it) {
    std::mt19937 rng(42);
    for (int i = 0; i < 8; ++i) {
        const auto a = random_patch<1, Hom<2>>(rng, {3}, 4), b = random_patch<1, Hom<2>>(rng, {2}, 5);
        const auto moved = [](const Curve<Hom<2>>& c) {
            auto net = c.net();
            for (Hom<2>& p : net.flat())
                for (int k = 0; k < 2; ++k) p[k] += 0x1p20 * p.weight();
            return must(Curve<Hom<2>>::make(c.bases(), std::move(net)));
        };
        const auto near = must(intersect(a, b)), far = must(intersect(moved(a), moved(b)));
        ASSERT_EQ(near.contacts.size(), far.contacts.size()) << i;
        for (std::size_t k = 0; k < near.contacts.size(); ++k) {
            EXPECT_TRUE(far.contacts[k].is_proven()) << i;
            EXPECT_NEAR(near.contacts[k].at[0], far.contacts[k].at[0], 1e-6) << i;
        }
    }
}

TEST(IntersectScale, rational_curves_and_surfaces_in_every_unit) {
    std::mt19937 rng(43);
    std::size_t found = 0;
    for (int i = 0; i < 3; ++i) {
        const auto c = random_patch<1, Hom<3>>(rng, {3}, 3);
        const auto s = random_patch<2, Hom<3>>(rng, {2, 3}, 2);
        const auto plain = must(intersect(c, s));
        found += plain.contacts.size();
        for (const int e : kUnits)
            expect_scaled(plain, must(intersect(in_unit(c, e, 3), in_unit(s, e, -9))), e);
    }
    EXPECT_GT(found, 3u);
}

TEST(IntersectScale, self_intersections_and_crossings_with_lines_in_every_unit) {
    std::mt19937 rng(44);
    std::size_t loops = 0, hits = 0;
    for (int i = 0; i < 6; ++i) {
        const auto c = random_patch<1, Hom<2>>(rng, {3}, 8);
        const auto plain = must(self_intersections(c, 1e-9));
        const auto across = must(crossings(c, Vec<2>{{0.6, 0.8}}, 0.1, 1e-9));
        for (const int e : kUnits) {
            const auto other = must(self_intersections(in_unit(c, e, 0), std::scalbn(1e-9, e)));
            ASSERT_EQ(plain.size(), other.size()) << e;
            for (std::size_t k = 0; k < plain.size(); ++k) {
                EXPECT_EQ(plain[k].first, other[k].first) << e;
                EXPECT_EQ(plain[k].is_certain(), other[k].is_certain()) << e;
                loops += plain[k].is_certain();
            }
            const auto there = must(
                crossings(in_unit(c, e, 5), Vec<2>{{0.6, 0.8}}, std::scalbn(0.1, e), std::scalbn(1e-9, e)));
            ASSERT_EQ(across.size(), there.size()) << e;
            for (std::size_t k = 0; k < across.size(); ++k) {
                EXPECT_EQ(across[k].kind, there[k].kind) << e;
                EXPECT_NEAR(across[k].at.lo, there[k].at.lo, 1e-12) << e;
                EXPECT_LE(there[k].at.length(), 4 * across[k].at.length() + 1e-12) << e;
                hits += across[k].kind == CrossingKind::crossing;
            }
        }
    }
    EXPECT_GT(loops, 8u);
    EXPECT_GT(hits, 8u);
}

}  // namespace
}  // namespace freiform::test
