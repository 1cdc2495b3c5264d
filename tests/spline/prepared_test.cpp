#include <freiform/core/parallel.hpp>
#include <freiform/spline/prepared.hpp>

#include <bit>
#include <gtest/gtest.h>
#include <kernel/evaluate.hpp>
#include <limits>
#include <random.hpp>
#include <reference.hpp>

namespace freiform {
namespace {

using test::Random;

// Runs `check` with every variant that this machine has.
template <class F>
void with_every_variant(F&& check) {
    kernel::Variant all[8];
    const int count = kernel::variants(all, 8);
    const kernel::Kernels& before = kernel::kernels();
    int ran = 0;
    for (int i = 0; i < count; ++i) {
        if (!all[i].runs_here) continue;
        SCOPED_TRACE(all[i].kernels->name);
        kernel::choose(*all[i].kernels);
        check();
        ++ran;
    }
    kernel::choose(before);
    EXPECT_GE(ran, 1);
}

template <std::size_t N, class P>
PreparedPatch<N, P> prepared(const Patch<N, P>& patch) {
    auto made = PreparedPatch<N, P>::make(patch);
    EXPECT_TRUE(made) << made.error().message;
    return *made;
}

template <std::size_t N, class P>
void expect_values_within_bound(int rounds, int max_degree, std::uint64_t seed) {
    Random random(seed);
    for (int round = 0; round < rounds; ++round) {
        const auto ends = round % 3 == 0   ? test::Ends::clamped
                          : round % 3 == 1 ? test::Ends::unclamped
                                           : test::Ends::closed;
        const auto patch = test::random_patch<N, P>(random, max_degree, {.ends = ends, .spans = 4});
        const auto fast = prepared(patch);
        const auto at = test::parameters<N, P>(random, patch, 13);
        std::vector<std::vector<test::Rational>> exact;
        for (const auto& u : at) exact.push_back(test::value_of<test::Rational>(patch, u));
        with_every_variant([&] {
            std::vector<PointOf<P>> out(at.size());
            ASSERT_TRUE(fast.evaluate(at, out));
            for (std::size_t i = 0; i < at.size(); ++i)
                for (int c = 0; c < PointOf<P>::kCoords; ++c)
                    ASSERT_LE(test::gap(out[i][c], exact[i][std::size_t(c)]), fast.value_error_bound())
                        << "round " << round << " parameter " << i;
        });
    }
}

TEST(PreparedPatch, values_of_curves_are_within_the_bound_of_exact_arithmetic) {
    expect_values_within_bound<1, Vec<1>>(9, 5, 1);
    expect_values_within_bound<1, Vec<2>>(9, 7, 2);
    expect_values_within_bound<1, Vec<3>>(9, 3, 3);
    expect_values_within_bound<1, Vec<4>>(9, 3, 4);
    expect_values_within_bound<1, Hom<1>>(9, 5, 5);
    expect_values_within_bound<1, Hom<2>>(9, 3, 6);
    expect_values_within_bound<1, Hom<3>>(12, 5, 7);
    expect_values_within_bound<1, Hom<4>>(9, 4, 8);
    expect_values_within_bound<1, Hom<3>>(3, 12, 9);
}

TEST(PreparedPatch, values_of_surfaces_are_within_the_bound_of_exact_arithmetic) {
    expect_values_within_bound<2, Vec<1>>(3, 3, 11);
    expect_values_within_bound<2, Vec<3>>(6, 5, 12);
    expect_values_within_bound<2, Hom<2>>(3, 3, 13);
    expect_values_within_bound<2, Hom<3>>(9, 4, 14);
    expect_values_within_bound<2, Hom<4>>(6, 4, 15);
}

TEST(PreparedPatch, values_of_volumes_are_within_the_bound_of_exact_arithmetic) {
    expect_values_within_bound<3, Vec<3>>(3, 3, 21);
    expect_values_within_bound<3, Hom<4>>(3, 2, 22);
}

// Equal degrees take the unrolled kernels.
TEST(PreparedPatch, surfaces_of_every_specialised_degree_are_within_the_bound) {
    Random random(31);
    for (const int p : {1, 2, 3, 5, 4}) {
        auto one = test::random_basis(random, p, {.spans = 3}),
             two = test::random_basis(random, p, {.spans = 3});
        const auto patch = test::random_patch_on<2, Hom<3>>(random, {one, two});
        const auto fast = prepared(patch);
        const auto at = test::parameters<2, Hom<3>>(random, patch, 10);
        with_every_variant([&] {
            std::vector<Vec<3>> out(at.size());
            ASSERT_TRUE(fast.evaluate(at, out));
            for (std::size_t i = 0; i < at.size(); ++i) {
                const auto exact = test::value_of<test::Rational>(patch, at[i]);
                for (int c = 0; c < 3; ++c)
                    ASSERT_LE(test::gap(out[i][c], exact[std::size_t(c)]), fast.value_error_bound()) << p;
            }
        });
    }
}

// Derivatives against the textbook ones in exact arithmetic, relative to the largest of their order.
template <std::size_t N, class P, int K>
void expect_jets(int rounds, int max_degree, std::uint64_t seed) {
    Random random(seed);
    for (int round = 0; round < rounds; ++round) {
        const auto ends = round % 2 == 0 ? test::Ends::clamped : test::Ends::closed;
        const auto patch = test::random_patch<N, P>(random, max_degree, {.ends = ends, .spans = 3});
        const auto fast = prepared(patch);
        const auto at = test::parameters<N, P>(random, patch, 9, false);
        std::vector<std::vector<std::vector<double>>> exact;
        double scale = 1;
        for (const auto& u : at) {
            exact.emplace_back();
            for (const auto& d : test::jet_of<test::Rational>(patch, u, K)) {
                exact.back().emplace_back();
                for (const auto& x : d) {
                    exact.back().back().push_back(x.template convert_to<double>());
                    scale = std::max(scale, std::abs(exact.back().back().back()));
                }
            }
        }
        with_every_variant([&] {
            std::vector<Jet<N, K, PointOf<P>>> out(at.size());
            ASSERT_TRUE(fast.evaluate(at, std::span(out)));
            for (std::size_t i = 0; i < at.size(); ++i)
                for (std::size_t s = 0; s < out[i].d.size(); ++s)
                    for (int c = 0; c < PointOf<P>::kCoords; ++c)
                        ASSERT_NEAR(out[i].d[s][c], exact[i][s][std::size_t(c)], 1e-12 * scale)
                            << "round " << round << " parameter " << i << " slot " << s;
        });
    }
}

TEST(PreparedPatch, derivatives_are_those_of_exact_arithmetic) {
    expect_jets<1, Vec<3>, 2>(4, 4, 41);
    expect_jets<1, Hom<3>, 1>(4, 5, 42);
    expect_jets<1, Hom<4>, 2>(4, 3, 43);
    expect_jets<2, Vec<3>, 1>(4, 3, 44);
    expect_jets<2, Hom<3>, 2>(4, 3, 45);
    expect_jets<2, Hom<2>, 1>(4, 3, 46);
    expect_jets<2, Hom<4>, 2>(2, 3, 47);
    expect_jets<3, Hom<3>, 2>(2, 2, 48);
    expect_jets<3, Vec<1>, 1>(2, 3, 49);
}

TEST(PreparedPatch, normals_are_unit_vectors_along_the_product_of_the_tangents) {
    Random random(51);
    for (int round = 0; round < 6; ++round) {
        // Clamped: a closed axis of one span has no tangents.
        auto one = test::random_basis(random, 1 + round % 4, {.spans = 3});
        auto two = test::random_basis(random, 3, {.spans = 3});
        const auto patch = test::random_patch_on<2, Hom<3>>(random, {one, two});
        const auto fast = prepared(patch);
        const auto at = test::parameters<2, Hom<3>>(random, patch, 100, false);
        with_every_variant([&] {
            std::vector<Vec<3>> out(at.size()), normals(at.size());
            ASSERT_TRUE(fast.evaluate(at, out, normals));
            std::vector<Jet<2, 1, Vec<3>>> jets(at.size());
            ASSERT_TRUE(fast.evaluate(at, std::span(jets)));
            for (std::size_t i = 0; i < at.size(); ++i) {
                EXPECT_EQ(out[i], jets[i].value());
                EXPECT_NEAR(norm(normals[i]), 1, 1e-15);
                const Vec<3> n = cross(jets[i](1, 0), jets[i](0, 1));
                const double lost = norm(jets[i](1, 0)) * norm(jets[i](0, 1)) / norm(n);
                EXPECT_LE(test::distance(unit(n), normals[i]), 4e-16 * (2 + lost));
            }
        });
    }
}

TEST(PreparedPatch, normals_of_tangents_that_vanish_or_leave_the_range_are_zero_or_right) {
    // A bilinear patch with a pole, in three sizes; its normal is (0, 0, 1) elsewhere.
    const auto basis = *BSplineBasis::bezier(1);
    for (const double size : {1.0, 0x1p-80, 0x1p99}) {
        const auto patch = *Surface<Vec<3>>::make(
            {basis, basis}, Net<2, Vec<3>>({2, 2}, {Vec<3>{{0, 0, 0}}, Vec<3>{{0, 0, 0}},
                                                    Vec<3>{{size, 0, 0}}, Vec<3>{{size, size, 0}}}));
        const auto fast = prepared(patch);
        const std::vector<Param<2>> at{{0, 0.5}, {0.5, 0.5}, {1, 0}};
        std::vector<Vec<3>> out(3), normals(3, Vec<3>{{7, 7, 7}});
        with_every_variant([&] {
            ASSERT_TRUE(fast.evaluate(at, out, normals));
            EXPECT_EQ(normals[0], (Vec<3>{{0, 0, 0}}));
            EXPECT_NEAR(normals[1][2], 1, 1e-15);
            EXPECT_NEAR(normals[2][2], 1, 1e-15);
        });
    }
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
                ASSERT_NEAR(grid[i][c], scattered[i][c], 2 * fast.value_error_bound()) << i;
        std::vector<Jet<N, 2, PointOf<P>>> jets(all), others(all);
        ASSERT_TRUE(fast.evaluate(at, std::span(others)));
        ASSERT_TRUE(fast.evaluate_grid(views, std::span(jets)));
        double scale = 1;
        for (const auto& j : others)
            for (const auto& d : j.d) scale = std::max(scale, max_abs(d));
        for (std::size_t i = 0; i < all; ++i)
            for (std::size_t s = 0; s < jets[i].d.size(); ++s)
                for (int c = 0; c < PointOf<P>::kCoords; ++c)
                    ASSERT_NEAR(jets[i].d[s][c], others[i].d[s][c], 1e-12 * scale) << i << " " << s;
        if constexpr (N == 2 && PointOf<P>::kCoords == 3) {
            std::vector<Vec<3>> normals(all), others_normals(all);
            ASSERT_TRUE(fast.evaluate_grid(views, grid, normals));
            ASSERT_TRUE(fast.evaluate(at, scattered, others_normals));
            for (std::size_t i = 0; i < all; ++i)
                ASSERT_LE(test::distance(normals[i], others_normals[i]), 1e-10) << i;
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
    expect_grid_is_scattered<2, Hom<3>>({500, 700}, 67);  // past the caches
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

TEST(PreparedPatch, refuses_bad_parameters_before_it_writes_or_gives_nan_where_asked) {
    Random random(81);
    const auto patch = test::random_patch<2, Hom<3>>(random, 3, {.ends = test::Ends::clamped});
    const auto closed =
        test::random_patch_on<1, Vec<2>>(random, {*BSplineBasis::periodic(2, {0, 1, 2, 3, 4})});
    const auto on = patch.domain();
    const double inf = std::numeric_limits<double>::infinity();
    for (const double bad : {std::numeric_limits<double>::quiet_NaN(), inf, -inf,
                             std::nextafter(on[1].hi, inf), std::nextafter(on[1].lo, -inf)}) {
        std::vector<Param<2>> at(100, {on[0].lo, on[1].lo});
        at[97][1] = bad;
        const auto fast = prepared(patch);
        const auto ring = prepared(closed);
        with_every_variant([&] {
            std::vector<Vec<3>> out(at.size(), Vec<3>{{7, 7, 7}}), normals(at.size());
            const auto answer = fast.evaluate(at, out);
            ASSERT_FALSE(answer);
            EXPECT_EQ(answer.error().where, "at[97][1]");
            EXPECT_EQ(answer.error().kind,
                      std::isfinite(bad) ? RefusalKind::out_of_domain : RefusalKind::nonfinite);
            EXPECT_EQ(out, std::vector<Vec<3>>(at.size(), Vec<3>{{7, 7, 7}}));
            ASSERT_TRUE(fast.evaluate(at, out, normals, Outside::nan));
            EXPECT_EQ(out[96], out[98]);
            EXPECT_TRUE(is_finite(out[98]));
            for (int c = 0; c < 3; ++c) EXPECT_TRUE(std::isnan(out[97][c]) && std::isnan(normals[97][c]));
            const std::vector<double> axis{bad}, good{on[0].lo};
            EXPECT_EQ(fast.evaluate_grid({good, axis}, std::span(out).first(1)).error().where, "axes[1][0]");
            // A closed curve takes every finite number.
            std::vector<Vec<2>> round(3);
            const std::vector<double> turns{0.5, 8.5, bad};
            const auto wrapped = ring.evaluate(turns, round);
            EXPECT_EQ(wrapped.has_value(), std::isfinite(bad));
            ASSERT_TRUE(ring.evaluate(turns, round, Outside::nan));
            EXPECT_EQ(round[0], round[1]);
            EXPECT_EQ(std::isnan(round[2][0]), !std::isfinite(bad));
        });
    }
}

TEST(PreparedPatch, finds_spans_however_unevenly_they_are_spread) {
    std::vector<double> knots{0, 0, 0};
    for (int i = 0; i < 40; ++i) knots.push_back(1 + i * 0x1p-40);
    for (int i = 0; i < 5; ++i) knots.push_back(100.0 * (i + 1));
    for (int i = 0; i < 3; ++i) knots.push_back(1e6);
    Random random(91);
    const auto patch = test::random_patch_on<1, Vec<1>>(random, {*BSplineBasis::make(2, knots)});
    const auto fast = prepared(patch);
    const auto at = test::parameters(random, patch.basis(), 20);
    with_every_variant([&] {
        std::vector<Vec<1>> out(at.size());
        ASSERT_TRUE(fast.evaluate(at, out));
        for (std::size_t i = 0; i < at.size(); ++i)
            ASSERT_LE(test::gap(out[i][0], test::value_of<test::Rational>(patch, at[i])[0]),
                      fast.value_error_bound())
                << at[i];
    });
}

TEST(PreparedPatch, gives_the_end_points_of_clamped_curves_exactly) {
    Random random(95);
    for (int p = 1; p < 8; ++p) {
        const auto patch = test::random_patch_on<1, Vec<3>>(
            random, {test::random_basis(random, p, {.ends = test::Ends::clamped, .spans = 3})});
        const Interval on = patch.basis().domain();
        const std::vector<double> at{on.lo, on.hi};
        const auto fast = prepared(patch);
        with_every_variant([&] {
            std::vector<Vec<3>> out(2);
            ASSERT_TRUE(fast.evaluate(at, out));
            EXPECT_EQ(out[0], patch.net().flat().front());
            EXPECT_EQ(out[1], patch.net().flat().back());
        });
    }
}

TEST(PreparedPatch, rounds_once_to_single_precision) {
    Random random(97);
    const auto patch = test::random_patch<2, Hom<3>>(random, 3, {.spans = 4});
    const auto at = test::parameters<2, Hom<3>>(random, patch, 5000);
    const auto fast = prepared(patch);
    std::vector<Vec<3>> out(at.size());
    std::vector<float> single(3 * at.size());
    ASSERT_TRUE(fast.evaluate(at, out));
    ASSERT_TRUE(fast.evaluate(at, std::span(single)));
    for (std::size_t i = 0; i < single.size(); ++i) ASSERT_EQ(single[i], float(out[i / 3][int(i % 3)]));
}

TEST(PreparedPatch, leaves_extreme_patches_to_the_slow_way) {
    const auto tiny = *Curve<Vec<1>>::make({*BSplineBasis::make(1, {0, 0, 0x1p-101, 1, 1})},
                                           Net<1, Vec<1>>({3}, {Vec<1>{{0}}, Vec<1>{{1}}, Vec<1>{{2}}}));
    EXPECT_EQ((PreparedPatch<1, Vec<1>>::make(tiny).error().kind), RefusalKind::unsupported);
    const auto basis = *BSplineBasis::bezier(1);
    const auto large = *Curve<Vec<1>>::make({basis}, Net<1, Vec<1>>({2}, {Vec<1>{{0}}, Vec<1>{{0x1p101}}}));
    EXPECT_EQ((PreparedPatch<1, Vec<1>>::make(large).error().where), "points[1]");
    const auto light =
        *Curve<Hom<1>>::make({basis}, Net<1, Hom<1>>({2}, {Hom<1>{{0, 1}}, Hom<1>{{0, 0x1p-101}}}));
    EXPECT_EQ((PreparedPatch<1, Hom<1>>::make(light).error().where), "weights[1]");
}

}  // namespace
}  // namespace freiform
