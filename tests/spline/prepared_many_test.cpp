#include <freiform/core/parallel.hpp>
#include <freiform/spline/prepared.hpp>

#include <gtest/gtest.h>
#include <limits>
#include <prepared.hpp>
#include <random.hpp>

namespace freiform {
namespace {

template <std::size_t N>
using Grid = std::array<std::vector<double>, N>;

template <std::size_t N>
std::array<std::span<const double>, N> views(const Grid<N>& axes) {
    std::array<std::span<const double>, N> out;
    for (std::size_t d = 0; d < N; ++d) out[d] = axes[d];
    return out;
}

// Patches of one kind of bases and then of another, on a grid over [0, 1]^N.
template <std::size_t N, class P>
std::vector<Patch<N, P>> some_patches(std::size_t count, std::uint64_t seed) {
    test::Random random(seed);
    std::vector<Patch<N, P>> out;
    for (std::size_t k = 0; k < count; ++k) {
        const auto b =
            2 * k < count ? *BSplineBasis::bezier(3) : *BSplineBasis::make(2, {0, 0, 0, 0.375, 1, 1, 1});
        const auto bases = [&]<std::size_t... I>(std::index_sequence<I...>) {
            return std::array<BSplineBasis, N>{((void)I, b)...};
        }
        (std::make_index_sequence<N>{});
        out.push_back(test::random_patch_on<N, P>(random, bases));
    }
    return out;
}
template <std::size_t N>
Grid<N> unit_grid(std::array<int, N> counts) {
    Grid<N> axes;
    for (std::size_t d = 0; d < N; ++d)
        for (int i = 0; i < counts[d]; ++i) axes[d].push_back(double(i) / (counts[d] - 1));
    return axes;
}

template <std::size_t N, class P>
void expect_grids(std::size_t count, std::array<int, N> counts, std::uint64_t seed) {
    const auto patches = some_patches<N, P>(count, seed);
    const auto axes = unit_grid<N>(counts);
    std::size_t each = 1;
    for (const auto& a : axes) each *= a.size();
    test::with_every_variant([&] {
        std::vector<PointOf<P>> all(count * each), one(each);
        ASSERT_TRUE((evaluate_grids<N, P, BSplineBasis>(patches, views(axes), all)));
        for (std::size_t k = 0; k < count; ++k) {
            const auto fast = test::prepared(patches[k]);
            ASSERT_TRUE(fast.evaluate_grid(views(axes), one));
            for (std::size_t i = 0; i < each; ++i)
                for (int c = 0; c < PointOf<P>::kCoords; ++c) {
                    const double off = std::abs(all[k * each + i][c] - one[i][c]);
                    ASSERT_LE(off, N == 1 ? 2 * fast.value_error_bound() : 0) << k << " " << i;
                }
        }
    });
}

TEST(EvaluateGrids, gives_the_points_of_each_patch) {
    expect_grids<1, Hom<3>>(6, {21}, 1);
    expect_grids<1, Vec<2>>(3, {2}, 2);
    expect_grids<2, Hom<3>>(9, {5, 11}, 3);
    expect_grids<2, Vec<3>>(4, {9, 4}, 4);
    expect_grids<2, Hom<4>>(4, {3, 8}, 5);
    expect_grids<3, Vec<3>>(3, {3, 4, 5}, 6);
}

TEST(EvaluateGrids, gives_the_same_bits_for_any_number_of_threads_and_any_number_of_patches) {
    const auto patches = some_patches<2, Hom<3>>(1000, 7);
    const std::span<const Surface<Hom<3>>> all(patches);
    const auto axes = unit_grid<2>({8, 9});
    std::vector<Vec<3>> one(1000 * 72), many(1000 * 72), few(1000 * 72);
    set_max_threads(1);
    ASSERT_TRUE((evaluate_grids(all, views(axes), std::span(one))));
    set_max_threads(0);
    ASSERT_TRUE((evaluate_grids(all, views(axes), std::span(many))));
    for (std::size_t k = 0; k < 1000; k += 100)
        ASSERT_TRUE((evaluate_grids(all.subspan(k, 100), views(axes), std::span(few).subspan(k * 72, 7200))));
    EXPECT_EQ(one, many);
    EXPECT_EQ(one, few);
}

TEST(EvaluateGrids, refuses_by_name_and_takes_what_is_empty) {
    auto patches = some_patches<2, Vec<3>>(4, 8);
    auto axes = unit_grid<2>({3, 3});
    std::vector<Vec<3>> out(36, Vec<3>{{7, 7, 7}});
    const auto bezier = *BSplineBasis::bezier(1);
    patches[1] = *Surface<Vec<3>>::make({bezier, bezier}, Net<2, Vec<3>>({2, 2}, std::vector<Vec<3>>(4)));
    std::vector<Vec<3>> large(16);
    large[5][1] = 0x1p101;
    patches[0] = *Surface<Vec<3>>::make({*BSplineBasis::bezier(3), *BSplineBasis::bezier(3)},
                                        Net<2, Vec<3>>({4, 4}, std::move(large)));
    const auto run = [&] { return evaluate_grids<2, Vec<3>, BSplineBasis>(patches, views(axes), out); };
    EXPECT_EQ(run().error().where, "patches[0].points[5]");
    EXPECT_EQ(out, std::vector<Vec<3>>(36, Vec<3>{{7, 7, 7}}));
    patches[0] = patches[1];
    EXPECT_TRUE(run());
    axes[1][2] = 1.5;
    EXPECT_EQ(run().error().where, "axes[1][2]");
    axes[1].clear(), out.clear();
    EXPECT_TRUE(run());
    patches.clear();
    EXPECT_TRUE(run());
}

}  // namespace
}  // namespace freiform
