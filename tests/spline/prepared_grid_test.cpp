#include <freiform/core/parallel.hpp>
#include <freiform/spline/prepared.hpp>

#include <gtest/gtest.h>
#include <limits>
#include <prepared.hpp>
#include <random.hpp>
#include <reference.hpp>
#include <refusal.hpp>

namespace freiform {
namespace {

using test::prepared;
using test::Random;
using test::with_every_variant;

// The same of derivatives.
template <std::size_t N, class P>
void expect_jets_on_grid(const PreparedPatch<N, P>& fast, const std::vector<Param<N>>& at,
                         const std::array<std::span<const double>, N>& views) {
    std::vector<Jet<N, 2, PointOf<P>>> jets(at.size()), others(at.size());
    ASSERT_TRUE(fast.evaluate(at, std::span(others)));
    ASSERT_TRUE(fast.evaluate_grid(views, std::span(jets)));
    double scale = 1;
    for (const auto& j : others)
        for (const auto& d : j.d) scale = std::max(scale, max_abs(d));
    for (std::size_t i = 0; i < at.size(); ++i)
        for (std::size_t s = 0; s < jets[i].d.size(); ++s)
            for (int c = 0; c < PointOf<P>::kCoords; ++c)
                if (!(std::abs(jets[i].d[s][c] - others[i].d[s][c]) <= 1e-12 * scale))
                    FAIL() << i << " " << s;
}

template <std::size_t N, class P>
void expect_grid_is_scattered(std::array<std::size_t, N> counts, std::uint64_t seed) {
    Random random(seed);
    const auto patch = test::random_patch<N, P>(random, 3, {.ends = test::Ends::clamped, .spans = 4});
    const auto fast = prepared(patch);
    std::array<std::vector<double>, N> axes;
    std::array<std::span<const double>, N> views;
    std::size_t all = 1;
    for (std::size_t d = 0; d < N; ++d) {
        for (std::size_t i = 0; i < counts[d]; ++i) {
            const Interval on = patch.basis(int(d)).domain();
            axes[d].push_back(std::min(on.hi, random.real(on.lo, on.hi)));  // unsorted
        }
        views[d] = axes[d];
        all *= counts[d];
    }
    std::vector<Param<N>> at;
    Index<N> extent{};
    for (std::size_t d = 0; d < N; ++d) extent[d] = int(counts[d]);
    each_index(extent, [&](const Index<N>& i) {
        std::array<double, N> u{};
        for (std::size_t d = 0; d < N; ++d) u[d] = axes[d][std::size_t(i[d])];
        at.push_back(test::to_param<N>(u));
    });
    with_every_variant([&] {
        std::vector<PointOf<P>> grid(all), scattered(all);
        ASSERT_TRUE(fast.evaluate(at, scattered));
        ASSERT_TRUE(fast.evaluate_grid(views, grid));
        for (std::size_t i = 0; i < all; ++i)
            for (int c = 0; c < PointOf<P>::kCoords; ++c)
                if (!(std::abs(grid[i][c] - scattered[i][c]) <= 2 * fast.value_error_bound())) FAIL() << i;
        if (all < 10000) expect_jets_on_grid<N, P>(fast, at, views);
        if constexpr (N == 2 && PointOf<P>::kCoords == 3) {
            std::vector<Vec<3>> normals(all), others_normals(all);
            ASSERT_TRUE(fast.evaluate_grid(views, grid, normals));
            ASSERT_TRUE(fast.evaluate(at, scattered, others_normals));
            for (std::size_t i = 0; i < all; ++i)
                if (!(test::distance(normals[i], others_normals[i]) <= 1e-10)) FAIL() << i;
        }
    });
}

TEST(PreparedPatch, grids_are_what_scattered_parameters_give) {
    expect_grid_is_scattered<1, Hom<3>>({37}, 61);
    expect_grid_is_scattered<2, Hom<3>>({7, 45}, 62);
    expect_grid_is_scattered<2, Vec<3>>({5, 8}, 63);
    expect_grid_is_scattered<2, Hom<4>>({5, 19}, 64);
    expect_grid_is_scattered<2, Vec<2>>({1, 3}, 65);
    expect_grid_is_scattered<3, Hom<3>>({3, 4, 21}, 66);
    expect_grid_is_scattered<2, Hom<3>>({260, 700}, 67);  // past the caches
}

template <class P>
void expect_grid_within_bound(std::uint64_t seed) {
    Random random(seed);
    const auto patch = test::random_patch<2, P>(random, 4, {.ends = test::Ends::clamped, .spans = 3});
    const auto fast = prepared(patch);
    std::array<std::vector<double>, 2> axes;
    for (std::size_t d = 0; d < 2; ++d)
        for (int i = 0; i < (d == 0 ? 2 : 19); ++i) {
            const Interval on = patch.basis(int(d)).domain();
            axes[d].push_back(i == 3 ? on.hi : std::min(on.hi, random.real(on.lo, on.hi)));
        }
    std::ranges::sort(axes[1]);
    std::vector<std::vector<test::Rational>> exact;
    for (const double u : axes[0])
        for (const double v : axes[1]) exact.push_back(test::value_of<test::Rational>(patch, {u, v}));
    with_every_variant([&] {
        std::vector<PointOf<P>> out(exact.size());
        ASSERT_TRUE(fast.evaluate_grid({axes[0], axes[1]}, out));
        for (std::size_t i = 0; i < out.size(); ++i)
            for (int c = 0; c < PointOf<P>::kCoords; ++c)
                ASSERT_LE(test::gap(out[i][c], exact[i][std::size_t(c)]), fast.value_error_bound()) << i;
    });
}

TEST(PreparedPatch, values_on_grids_are_within_the_bound_of_exact_arithmetic) {
    expect_grid_within_bound<Hom<3>>(23);
    expect_grid_within_bound<Vec<3>>(24);
    expect_grid_within_bound<Hom<4>>(25);
    expect_grid_within_bound<Vec<2>>(26);
}

// Large results go past the caches, in whole lines of memory that are shifted from where the points begin.
// Nothing around them may change.
TEST(PreparedPatch, writes_large_results_wherever_memory_begins_and_nothing_beside_them) {
    Random random(68);
    const auto curve = test::random_patch<1, Vec<3>>(random, 2, {.spans = 3});
    const auto surface = test::random_patch<2, Hom<3>>(random, 3, {.ends = test::Ends::clamped, .spans = 3});
    const auto quick = prepared(curve);
    const auto fast = prepared(surface);
    constexpr std::size_t kMany = 180003;
    const auto some = test::parameters<1, Vec<3>>(random, curve, 997);
    std::vector<double> t;
    for (std::size_t i = 0; i < kMany; ++i) t.push_back(some[i % some.size()]);
    std::array<std::vector<double>, 2> axes;
    for (std::size_t d = 0; d < 2; ++d)
        for (std::size_t i = 0; i < (d == 0 ? 3 : kMany / 3); ++i) {
            const Interval on = surface.basis(int(d)).domain();
            axes[d].push_back(std::min(on.hi, on.lo + on.length() * (double(i % 101) / 100)));
        }
    const Vec<3> kept{{7, 7, 7}};
    with_every_variant([&] {
        std::vector<Vec<3>> few(some.size()), row(3 * 101), row_normals(3 * 101);
        std::vector<Jet<1, 1, Vec<3>>> few_jets(some.size());
        ASSERT_TRUE(quick.evaluate(some, few));
        ASSERT_TRUE(quick.evaluate(some, std::span(few_jets)));
        const std::span<const double> first(axes[1].data(), 101);
        ASSERT_TRUE(fast.evaluate_grid({axes[0], first}, row, row_normals));
        ASSERT_TRUE(fast.evaluate_grid({axes[0], first}, row));
        std::vector<Vec<3>> expected(kMany + 9, kept);
        for (std::size_t shift = 0; shift < 8; ++shift) {
            std::vector<Vec<3>> out(kMany + 9, kept);
            ASSERT_TRUE(quick.evaluate(t, std::span(out).subspan(shift, kMany)));
            std::ranges::fill(expected, kept);
            for (std::size_t i = 0; i < kMany; ++i) expected[shift + i] = few[i % few.size()];
            EXPECT_EQ(std::ranges::mismatch(out, expected).in1 - out.begin(), std::ptrdiff_t(out.size()));
        }
        for (const std::size_t shift : {0, 3}) {
            std::vector<Vec<3>> out(kMany + 9, kept), normals(kMany + 9, kept);
            const auto inner = std::span(out).subspan(shift, kMany);
            const auto inner_normals = std::span(normals).subspan(shift + 1, kMany);
            const auto expect_rows = [&](std::span<const Vec<3>> found, const std::vector<Vec<3>>& wanted) {
                double worst = 0;
                for (std::size_t i = 0; i < kMany; ++i)
                    worst = std::max(
                        worst,
                        test::distance(found[i], wanted[i / (kMany / 3) * 101 + i % (kMany / 3) % 101]));
                EXPECT_LE(worst, 1e-9);
            };
            ASSERT_TRUE(fast.evaluate_grid({axes[0], axes[1]}, inner));
            expect_rows(inner, row);
            ASSERT_TRUE(fast.evaluate_grid({axes[0], axes[1]}, inner, inner_normals));
            expect_rows(inner, row);
            expect_rows(inner_normals, row_normals);
            for (std::size_t i = 0; i < out.size(); ++i) {
                EXPECT_TRUE(out[i] == kept || (i >= shift && i < shift + kMany)) << i;
                EXPECT_TRUE(normals[i] == kept || (i >= shift + 1 && i < shift + 1 + kMany)) << i;
            }
            std::vector<Jet<1, 1, Vec<3>>> jets(kMany + 9);
            ASSERT_TRUE(quick.evaluate(t, std::span(jets).subspan(shift, kMany)));
            bool same = jets[shift + kMany].d == Jet<1, 1, Vec<3>>().d;
            for (std::size_t i = 0; i < kMany; ++i)
                same = same && jets[shift + i].d == few_jets[i % few.size()].d;
            EXPECT_TRUE(same);
        }
    });
}

TEST(Patch, large_batches_of_derivatives_and_grids_take_the_kernels_and_agree_with_single_points) {
    Random random(69);
    const auto surface = test::random_patch<2, Hom<3>>(random, 3, {.ends = test::Ends::clamped, .spans = 3});
    const auto fast = prepared(surface);
    auto at = test::parameters<2, Hom<3>>(random, surface, 2000);
    std::vector<Jet<2, 2, Vec<3>>> jets(at.size()), by_kernels(at.size());
    ASSERT_TRUE(surface.evaluate(at, std::span(jets)));
    ASSERT_TRUE(fast.evaluate(at, std::span(by_kernels)));
    double scale = 1;
    for (const auto& j : jets)
        for (const auto& d : j.d) scale = std::max(scale, max_abs(d));
    for (std::size_t i = 0; i < at.size(); ++i) {
        ASSERT_EQ(jets[i].d, by_kernels[i].d) << i;
        const auto single = surface.jet<2>(at[i]);
        for (std::size_t s = 0; s < single.d.size(); ++s)
            ASSERT_LE(test::distance(jets[i].d[s], single.d[s]), 1e-12 * scale) << i;
    }
    // A batch of few goes point by point, with other bits.
    std::vector<Jet<2, 2, Vec<3>>> few(3);
    ASSERT_TRUE(surface.evaluate(std::span(at).first(3), std::span(few)));
    for (std::size_t i = 0; i < 3; ++i) EXPECT_EQ(few[i].d, surface.jet<2>(at[i]).d);
    at[77][1] = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(surface.evaluate(at, std::span(jets)).error().where, "at[77][1]");

    const Interval u = surface.basis(0).domain(), v = surface.basis(1).domain();
    std::vector<double> us, vs;
    for (int i = 0; i <= 40; ++i) us.push_back(std::min(u.hi, u.lo + u.length() * i / 40));
    for (int i = 0; i <= 60; ++i) vs.push_back(std::min(v.hi, v.lo + v.length() * i / 60));
    const auto grid = evaluate_grid(surface, {us, vs});
    std::vector<Vec<3>> expected(us.size() * vs.size());
    ASSERT_TRUE(grid);
    ASSERT_TRUE(fast.evaluate_grid({us, vs}, expected));
    EXPECT_TRUE(std::ranges::equal(grid->flat(), expected));
    us[7] = u.hi + 1;
    EXPECT_EQ(evaluate_grid(surface, {us, vs}).error().where, "axes[0][7]");
}

TEST(PreparedPatch, results_do_not_depend_on_place_in_the_batch_nor_on_threads) {
    Random random(71);
    const auto surface = test::random_patch<2, Hom<3>>(random, 3, {.spans = 6});
    const auto curve = test::random_patch<1, Hom<3>>(random, 3, {.spans = 6});
    const auto fast = prepared(surface);
    const auto quick = prepared(curve);
    const auto uv = test::parameters<2, Hom<3>>(random, surface, 70000);
    auto t = test::parameters<1, Hom<3>>(random, curve, 70000);
    std::sort(t.begin(), t.begin() + 35000);
    with_every_variant([&] {
        std::vector<Vec<3>> one(uv.size()), two(uv.size()), alone(1);
        std::vector<Jet<1, 2, Vec<3>>> first(t.size()), second(t.size()), single(1);
        set_max_threads(1);
        ASSERT_TRUE(fast.evaluate(uv, one));
        ASSERT_TRUE(quick.evaluate(t, std::span(first)));
        set_max_threads(0);
        ASSERT_TRUE(fast.evaluate(uv, two));
        ASSERT_TRUE(quick.evaluate(t, std::span(second)));
        EXPECT_EQ(one, two);
        for (std::size_t i = 0; i < t.size(); ++i) ASSERT_EQ(first[i].d, second[i].d);
        for (std::size_t i = 0; i < uv.size(); i += 997) {
            ASSERT_TRUE(fast.evaluate(std::span(uv).subspan(i, 1), alone));
            ASSERT_EQ(alone[0], one[i]);
            ASSERT_TRUE(quick.evaluate(std::span(t).subspan(i, 1), std::span(single)));
            ASSERT_EQ(single[0].d, first[i].d);
        }
    });
}

// Batches of fewer points than a vector has lanes take ways of their own.
template <std::size_t N, class P>
void expect_short_batches_to_agree(unsigned seed) {
    Random random(seed);
    const auto patch = test::random_patch<N, P>(random, 3, {.spans = 3});
    const auto fast = prepared(patch);
    const auto at = test::parameters<N, P>(random, patch, 40);
    with_every_variant([&] {
        std::vector<PointOf<P>> values(at.size());
        std::vector<Jet<N, 2, PointOf<P>>> jets(at.size());
        ASSERT_TRUE(fast.evaluate(at, values));
        ASSERT_TRUE(fast.evaluate(at, std::span(jets)));
        for (std::size_t n = 1; n <= 17; ++n)
            for (std::size_t first : {std::size_t(0), std::size_t(5), at.size() - n}) {
                const auto some = std::span(at).subspan(first, n);
                std::vector<PointOf<P>> few(n);
                std::vector<Jet<N, 2, PointOf<P>>> few_jets(n);
                ASSERT_TRUE(fast.evaluate(some, few));
                ASSERT_TRUE(fast.evaluate(some, std::span(few_jets)));
                for (std::size_t i = 0; i < n; ++i) {
                    ASSERT_EQ(few[i], values[first + i]) << n << " points, " << i;
                    ASSERT_EQ(few_jets[i].d, jets[first + i].d) << n << " points, " << i;
                }
            }
    });
}
TEST(PreparedPatch, short_batches_give_the_bits_of_long_ones) {
    expect_short_batches_to_agree<1, Hom<3>>(72);
    expect_short_batches_to_agree<1, Hom<4>>(73);
    expect_short_batches_to_agree<2, Vec<3>>(74);
    expect_short_batches_to_agree<2, Hom<3>>(75);
    expect_short_batches_to_agree<2, Hom<4>>(76);
    expect_short_batches_to_agree<3, Hom<3>>(77);
}

TEST(PreparedPatch, large_batches_are_checked_to_their_end_before_anything_is_written) {
    Random random(78);
    const auto surface = test::random_patch<2, Hom<3>>(random, 2, {.ends = test::Ends::clamped});
    const auto fast = prepared(surface);
    const auto on = surface.domain();
    const std::size_t n = 70001;
    for (const std::size_t place : {std::size_t(0), std::size_t(4096), std::size_t(40000), n - 1})
        for (const int threads : {1, 0}) {
            std::vector<Param<2>> at(n, {on[0].lo, on[1].hi});
            at[place][0] = std::nextafter(on[0].hi, on[0].hi + 1);
            std::vector<Vec<3>> out(n, Vec<3>{{7, 7, 7}});
            set_max_threads(threads);
            test::expect_refusal(fast.evaluate(at, out), RefusalKind::out_of_domain,
                                 text("at[", place, "][0]"));
            set_max_threads(0);
            ASSERT_EQ(std::ranges::count(out, Vec<3>{{7, 7, 7}}), std::ptrdiff_t(n));
        }
}

}  // namespace
}  // namespace freiform
