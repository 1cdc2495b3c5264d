#include <freiform/query/bounds.hpp>

#include <gtest/gtest.h>
#include <numbers>
#include <support/random.hpp>

namespace freiform::test {
namespace {

template <std::size_t N, class P>
void expect_tight(std::uint64_t seed, double accuracy, int samples) {
    Random random(seed);
    constexpr int D = Space<P>::kDim;
    for (int k = 0; k < 12; ++k) {
        const auto s =
            random_patch<N, P>(random, N == 1 ? 6 : 3, {k % 3 == 0 ? Ends::closed : Ends::clamped, 3});
        const TightBox<D> b = must(tight_box(s, accuracy));
        EXPECT_LE(b.slack, accuracy);
        Box<D> seen;
        const double rounding = s.value_error_bound();
        for (const auto& u : parameters<N>(random, s, samples)) {
            const auto x = s(u);
            seen.add(x);
            for (int i = 0; i < D; ++i) {
                EXPECT_LE(b.box.lo[i], x[i] + rounding);
                EXPECT_GE(b.box.hi[i], x[i] - rounding);
            }
        }
        if constexpr (N > 1) continue;
        const auto breaks = s.basis(0).breaks();
        for (std::size_t j = 0; j + 1 < breaks.size(); ++j)
            for (int i = 0; i <= 300; ++i)
                if constexpr (N == 1) seen.add(s(breaks[j] + (breaks[j + 1] - breaks[j]) * i / 300));
        for (int i = 0; i < D; ++i) {  // many samples come near to each side of the box of a curve
            EXPECT_NEAR(seen.lo[i], b.box.lo[i], 2e-3);
            EXPECT_NEAR(seen.hi[i], b.box.hi[i], 2e-3);
        }
    }
}

TEST(TightBox, contains_curves_and_touches_them) {
    expect_tight<1, Vec<2>>(1, 1e-12, 50);
    expect_tight<1, Hom<3>>(2, 1e-11, 50);
    expect_tight<1, Vec<1>>(3, 1e-12, 50);
}
TEST(TightBox, contains_surfaces_and_volumes) {
    expect_tight<2, Vec<3>>(4, 1e-5, 300);
    expect_tight<2, Hom<3>>(5, 1e-5, 300);
    expect_tight<3, Hom<2>>(6, 1e-2, 200);
}

TEST(TightBox, of_a_parabola_and_a_circle_is_the_one_known) {
    const auto parabola = must(Curve<Vec<2>>::make({must(BSplineBasis::bezier(2))},
                                                   Net<1, Vec<2>>({3}, {{{0, 0}}, {{1, 2}}, {{2, 0}}})));
    const auto b = must(tight_box(parabola, 0));
    EXPECT_EQ(b.box.lo, (Vec<2>{{0, 0}}));
    EXPECT_EQ(b.box.hi[0], 2);
    EXPECT_NEAR(b.box.hi[1], 1, 1e-15);
    EXPECT_GE(b.box.hi[1], 1);
    EXPECT_LT(b.slack, 1e-14);

    const double h = std::numbers::sqrt2 / 2;
    const std::vector<double> weights{1, h, 1, h, 1, h, 1, h, 1};
    const std::vector<Vec<2>> corners{{{1, 0}},   {{1, 1}},  {{0, 1}},  {{-1, 1}}, {{-1, 0}},
                                      {{-1, -1}}, {{0, -1}}, {{1, -1}}, {{1, 0}}};
    const auto circle =
        must(Curve<Hom<2>>::make({must(BSplineBasis::make(2, {0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4}))},
                                 Net<1, Hom<2>>({9}, must(make_rational<2>(corners, weights)))));
    const auto c = must(tight_box(circle, 0));
    for (int i : {0, 1}) {
        EXPECT_NEAR(c.box.lo[i], -1, 1e-14);
        EXPECT_NEAR(c.box.hi[i], 1, 1e-14);
    }
    EXPECT_LT(c.slack, 1e-13);
    const Extent e = must(extent_along(circle, Vec<2>{{3, 4}}, 1e-12));
    EXPECT_NEAR(e.range.hi, 5, 1e-11);
    EXPECT_NEAR(e.range.lo, -5, 1e-11);
}

TEST(TightBox, of_a_triangle_contains_it_and_touches_it) {
    Random random(7);
    for (int n = 1; n <= 5; ++n) {
        std::vector<Hom<3>> c;
        for (int i = 0; i < (n + 1) * (n + 2) / 2; ++i) c.push_back(random_coefficient<Hom<3>>(random));
        const auto t = must(SimplexPatch<2, Hom<3>>::make(n, c));
        const auto b = must(tight_box(t, 1e-6));
        EXPECT_LE(b.slack, 1e-6);
        Box<3> seen;
        for (int i = 0; i <= 60; ++i)
            for (int j = 0; i + j <= 60; ++j) seen.add(t(i / 60.0, j / 60.0));
        for (int i = 0; i < 3; ++i) {
            EXPECT_LE(b.box.lo[i], seen.lo[i] + 1e-15);
            EXPECT_GE(b.box.hi[i], seen.hi[i] - 1e-15);
            EXPECT_NEAR(b.box.lo[i], seen.lo[i], 2e-3);
            EXPECT_NEAR(b.box.hi[i], seen.hi[i], 2e-3);
        }
    }
}

// Weights of very different size, directions of any kind.
template <std::size_t N, class P>
void expect_extent(std::uint64_t seed, double accuracy) {
    Random random(seed);
    constexpr int D = Space<P>::kDim;
    for (int k = 0; k < 8; ++k) {
        const auto shape = random_patch<N, P>(random, 3, {k % 2 == 0 ? Ends::clamped : Ends::closed, 2});
        const auto s = must(Patch<N, P>::make(
            shape.bases(), random_net<N, P>(random, shape.net().extent(), 1, 0, k < 4 ? 1.0 : 12.0)));
        Vec<D> d;
        for (int i = 0; i < D; ++i) d[i] = k == 0 ? double(i == 0) : random.real(-2, 2);
        const Extent e = must(extent_along(s, d, accuracy));
        const double rounding = 3 * D * (s.value_error_bound() + 0x1p-50);
        Interval seen{INFINITY, -INFINITY};
        for (const auto& u : parameters<N>(random, s, 400)) {
            const double x = dot(d, s(u));
            seen = {std::min(seen.lo, x), std::max(seen.hi, x)};
        }
        EXPECT_LE(e.range.lo, seen.lo + rounding);
        EXPECT_GE(e.range.hi, seen.hi - rounding);
        EXPECT_LE(e.slack, accuracy) << "case " << k;
        if (k > 0) continue;
        const auto box = must(tight_box(s, accuracy)).box;
        EXPECT_EQ(e.range, box.side(0));
    }
}
TEST(TightBox, reaches_in_a_direction_as_far_as_the_object_does) {
    expect_extent<1, Hom<2>>(21, 1e-9);
    expect_extent<1, Vec<4>>(22, 1e-9);
    expect_extent<2, Hom<3>>(23, 1e-4);
    expect_extent<3, Vec<2>>(24, 1e-2);
}

TEST(TightBox, scales_exactly_with_powers_of_two) {
    Random random(8);
    const auto s = random_patch<1, Vec<2>>(random, 5, {Ends::clamped, 3});
    auto net = s.net();
    for (auto& p : net.flat()) p *= 0x1p-40;
    const auto small = must(Curve<Vec<2>>::make(s.bases(), net));
    const auto a = must(tight_box(s, 1e-9)), b = must(tight_box(small, 1e-9 * 0x1p-40));
    EXPECT_EQ(0x1p-40 * a.box.lo, b.box.lo);
    EXPECT_EQ(0x1p-40 * a.box.hi, b.box.hi);
    EXPECT_EQ(a.slack * 0x1p-40, b.slack);
}

TEST(TightBox, says_what_it_reached_when_the_pieces_run_out) {
    Random random(9);
    const auto s = random_patch<2, Vec<3>>(random, 3, {Ends::clamped, 3});
    const auto rough = must(tight_box(s, 0, 3)), fine = must(tight_box(s, 1e-6));
    EXPECT_GT(rough.slack, fine.slack);
    for (int i = 0; i < 3; ++i) {
        EXPECT_LE(rough.box.lo[i], fine.box.lo[i] + 1e-6);
        EXPECT_GE(rough.box.lo[i] + rough.slack, fine.box.lo[i]);
    }
    EXPECT_EQ(tight_box(s, -1.0).error().where, "accuracy");
    EXPECT_EQ(tight_box(s, NAN).error().kind, RefusalKind::invalid);
}

}  // namespace
}  // namespace freiform::test
