#include <freiform/spline/prepared.hpp>

#include <gtest/gtest.h>
#include <limits>
#include <prepared.hpp>
#include <random.hpp>
#include <reference.hpp>

namespace freiform {
namespace {

using test::prepared;
using test::Random;
using test::with_every_variant;

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

}  // namespace
}  // namespace freiform
