#include "support/random.hpp"

#include <freiform/core/tuples.hpp>

#include <gtest/gtest.h>

namespace freiform {
namespace {

template <class P>
void expect_the_same_numbers(std::uint64_t seed) {
    test::Random random(seed);
    std::vector<P> all;
    for (int i = 0; i < 9; ++i) all.push_back(test::random_coefficient<P>(random));
    const Tuples t = tuples(std::span<const P>(all));
    ASSERT_EQ(t.count(), all.size());
    EXPECT_EQ(t.dim(), Space<P>::kDim);
    for (std::size_t i = 0; i < all.size(); ++i) {
        EXPECT_EQ(t.weight(i), Space<P>::weight(all[i]));
        for (int c = 0; c < P::kCoords; ++c) EXPECT_EQ(t[i][c], all[i][c]);
        const auto point = project(all[i]);
        for (int c = 0; c < 4; ++c) {
            EXPECT_EQ(t.point(i)[c], c < t.dim() ? point[c < t.dim() ? c : 0] : 0);
            EXPECT_EQ(t.numerator(i)[c], c < t.dim() ? all[i][c] : 0);
        }
    }
}

TEST(Tuples, are_the_numbers_of_coefficients) {
    expect_the_same_numbers<Vec<1>>(1);
    expect_the_same_numbers<Vec<3>>(2);
    expect_the_same_numbers<Vec<4>>(3);
    expect_the_same_numbers<Hom<1>>(4);
    expect_the_same_numbers<Hom<2>>(5);
    expect_the_same_numbers<Hom<4>>(6);
}

TEST(Tuples, numbers_are_written_through) {
    std::vector<Hom<2>> all(3);
    EXPECT_TRUE(numbers(std::span<const Vec<2>>()).empty());
    numbers(std::span(all))[7] = 5;
    EXPECT_EQ(all[2][1], 5);
}

}  // namespace
}  // namespace freiform
