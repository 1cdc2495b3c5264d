// The kernels for ARM (NEON), compiled by another compiler and run by an emulator.
#include <freiform/spline/prepared.hpp>

#include <gtest/gtest.h>
#include <prepared.hpp>
#include <random.hpp>
#include <reference.hpp>
#include <remote_kernels.hpp>

namespace freiform {
namespace {

using test::Random;
using test::RemoteKernels;

#define FF_REMOTE_OR_SKIP(name)                                                                      \
    if (FREIFORM_REMOTE_KERNELS[0] == 0)                                                             \
        GTEST_SKIP() << "aarch64-linux-gnu-g++ and qemu-aarch64 were not there (tools/setup.sh ci)"; \
    const RemoteKernels name(FREIFORM_ARM_EMULATOR, FREIFORM_REMOTE_KERNELS);                        \
    ASSERT_TRUE(name.running())

// Kernels that are chosen as long as this lives.
struct Chosen {
    const kernel::Kernels& before = kernel::kernels();
    explicit Chosen(const kernel::Kernels& k) { kernel::choose(k); }
    ~Chosen() { kernel::choose(before); }
};

template <std::size_t N, class P>
void expect_remote_values(const RemoteKernels& remote, int max_degree, std::uint64_t seed) {
    Random random(seed);
    const auto patch = test::random_patch<N, P>(random, max_degree, {.spans = 4});
    const auto fast = test::prepared(patch);
    const auto at = test::parameters<N, P>(random, patch, 13);
    std::vector<PointOf<P>> out(at.size());
    {
        const Chosen chosen(remote.kernels());
        EXPECT_EQ(instruction_set(), "neon");
        ASSERT_TRUE(fast.evaluate(at, out));
    }
    for (std::size_t i = 0; i < at.size(); ++i) {
        const auto exact = test::value_of<test::Rational>(patch, at[i]);
        for (int c = 0; c < PointOf<P>::kCoords; ++c)
            ASSERT_LE(test::gap(out[i][c], exact[std::size_t(c)]), fast.value_error_bound()) << i;
    }
}

TEST(KernelsForArm, give_values_within_the_bound_of_exact_arithmetic) {
    FF_REMOTE_OR_SKIP(remote);
    expect_remote_values<1, Vec<1>>(remote, 5, 1);
    expect_remote_values<1, Hom<3>>(remote, 3, 2);
    expect_remote_values<1, Hom<4>>(remote, 7, 3);
    expect_remote_values<2, Vec<3>>(remote, 3, 4);
    expect_remote_values<2, Hom<3>>(remote, 5, 5);
    expect_remote_values<2, Hom<4>>(remote, 2, 6);
    expect_remote_values<3, Hom<3>>(remote, 2, 7);
}

TEST(KernelsForArm, give_the_derivatives_normals_and_grids_of_the_kernels_here) {
    FF_REMOTE_OR_SKIP(remote);
    Random random(8);
    const auto surface = test::random_patch<2, Hom<3>>(random, 3, {.ends = test::Ends::clamped, .spans = 4});
    const auto fast = test::prepared(surface);
    const auto at = test::parameters<2, Hom<3>>(random, surface, 45, false);
    std::array<std::vector<double>, 2> axes;
    for (std::size_t d = 0; d < 2; ++d)
        for (const auto& u : at) axes[d].push_back(u[d]);
    axes[0].resize(5);
    const auto run = [&](std::vector<Jet<2, 2, Vec<3>>>& jets, std::vector<Vec<3>>& normals,
                         std::vector<Vec<3>>& grid, std::vector<Vec<3>>& grid_normals) {
        jets.resize(at.size()), normals.resize(at.size());
        grid.resize(axes[0].size() * axes[1].size()), grid_normals.resize(grid.size());
        std::vector<Vec<3>> points(at.size());
        return fast.evaluate(at, std::span(jets)) && fast.evaluate(at, points, normals) &&
               fast.evaluate_grid({axes[0], axes[1]}, grid, grid_normals) &&
               fast.evaluate_grid({axes[0], axes[1]}, grid);
    };
    std::vector<Jet<2, 2, Vec<3>>> jets, far_jets;
    std::vector<Vec<3>> normals, grid, grid_normals, far_normals, far_grid, far_grid_normals;
    ASSERT_TRUE(run(jets, normals, grid, grid_normals));
    {
        const Chosen chosen(remote.kernels());
        ASSERT_TRUE(run(far_jets, far_normals, far_grid, far_grid_normals));
    }
    double scale = 1;
    for (const auto& j : jets)
        for (const auto& d : j.d) scale = std::max(scale, max_abs(d));
    for (std::size_t i = 0; i < at.size(); ++i) {
        for (std::size_t s = 0; s < jets[i].d.size(); ++s)
            ASSERT_LE(test::distance(jets[i].d[s], far_jets[i].d[s]), 1e-13 * scale) << i << " " << s;
        ASSERT_LE(test::distance(normals[i], far_normals[i]), 1e-11) << i;
    }
    for (std::size_t i = 0; i < grid.size(); ++i) {
        ASSERT_LE(test::distance(grid[i], far_grid[i]), 4 * fast.value_error_bound()) << i;
        ASSERT_LE(test::distance(grid_normals[i], far_grid_normals[i]), 1e-11) << i;
    }
}

#undef FF_REMOTE_OR_SKIP

}  // namespace
}  // namespace freiform
