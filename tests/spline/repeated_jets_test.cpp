// Derivatives at parameters that come again are those that are found at once.
#include "support/prepared.hpp"
#include "support/random.hpp"
#include "support/shapes.hpp"

#include <freiform/spline/repeated_jets.hpp>

#include <gtest/gtest.h>

using namespace freiform;
using namespace freiform::test;

namespace {

// More parameters than are kept, in an order in which some come again at once and others late.
void expect_the_same(const SurfaceGeometry& surface, const std::array<Interval, 2>& on, std::size_t places,
                     std::mt19937& rng, const std::string& name) {
    std::array<std::vector<double>, 2> kept;
    for (std::size_t d = 0; d < 2; ++d)
        for (int k = 0; k < 90; ++k)
            kept[d].push_back(k == 0 ? on[d].lo : k == 1 ? on[d].hi : uniform(rng, on[d].lo, on[d].hi));
    RepeatedJets jets(surface, places);
    std::uniform_int_distribution<std::size_t> any(0, 89), near(0, 3);
    for (int k = 0; k < 600; ++k) {
        auto& choice = k % 2 ? any : near;
        const Param<2> at{kept[0][choice(rng)], kept[1][choice(rng)]};
        EXPECT_EQ(jets.at<2>(at).d, jet<2>(surface, at).d) << name;
        EXPECT_EQ(jets.at<1>(at).d, jet<1>(surface, at).d) << name;
    }
}

template <class P>
SurfaceGeometry bumpy(std::mt19937& rng, int p, int q) {
    const auto u = must(BSplineBasis::clamped_uniform(p, p + 5)),
               v = must(BSplineBasis::clamped_uniform(q, q + 3));
    std::vector<P> c;
    for (int i = 0; i < u.size(); ++i)
        for (int k = 0; k < v.size(); ++k) {
            const Vec<3> at{{i + uniform(rng, -0.2, 0.2), k + uniform(rng, -0.2, 0.2), uniform(rng, -1, 1)}};
            if constexpr (std::same_as<P, Hom<3>>)
                c.push_back(weighted(at, uniform(rng, 0.5, 2)));
            else
                c.push_back(at);
        }
    return must(Surface<P>::make({u, v}, Net<2, P>({u.size(), v.size()}, c)));
}

TEST(RepeatedJets, are_those_of_surfaces_of_every_kind) {
    std::mt19937 rng(51);
    for (const auto& [name, surface, on] : surfaces_of_every_kind(5))
        for (const std::size_t places : {10, 100, 100000}) expect_the_same(surface, on, places, rng, name);
}

TEST(RepeatedJets, are_those_of_splines_of_every_degree) {
    std::mt19937 rng(52);
    for (const int p : {1, 2, 3, 4})
        for (const int q : {1, 3, 5})
            for (const std::size_t places : {64, 4000}) {
                const std::string name = text(p, " x ", q, ", ", places);
                const auto look = [&](const SurfaceGeometry& s) {
                    expect_the_same(s, domain(s), places, rng, name);
                };
                look(bumpy<Vec<3>>(rng, p, q));
                look(bumpy<Hom<3>>(rng, p, q));
            }
}

}  // namespace
