#include "support/random.hpp"

#include <freiform/fit/parameters.hpp>

#include <gtest/gtest.h>

namespace freiform {
namespace {

using test::must;

const std::vector<Vec<2>> kPoints{{{0, 0}}, {{3, 4}}, {{3, 5}}, {{12, 5}}};

TEST(Parameters, are_lengths_roots_of_lengths_or_numbers) {
    EXPECT_EQ(must(parameters<2>(kPoints, Spacing::uniform)), (std::vector<double>{0, 1, 2, 3}));
    EXPECT_EQ(must(parameters<2>(kPoints, Spacing::chordal)), (std::vector<double>{0, 5, 6, 15}));
    const auto c = must(parameters<2>(kPoints, Spacing::centripetal));
    EXPECT_DOUBLE_EQ(c[1], std::sqrt(5.0 / 9));
    EXPECT_DOUBLE_EQ(c[3], std::sqrt(5.0 / 9) + 1.0 / 3 + 1);
}

TEST(Parameters, of_closed_polygons_end_with_the_period) {
    EXPECT_EQ(must(parameters<2>(kPoints, Spacing::chordal, true)), (std::vector<double>{0, 5, 6, 15, 28}));
    EXPECT_EQ(must(parameters<2>(kPoints, Spacing::uniform, true)).size(), 5u);
}

TEST(Parameters, of_nets_are_means_over_the_lines_and_poles_do_not_matter) {
    Net<2, Vec<2>> net({3, 2});
    const double x[] = {0, 2, 3};
    for (int i = 0; i < 3; ++i) net.view()({i, 1}) = {{x[i], 1}};  // the line j = 0 is one point
    const auto at = must(parameters(net, 0, Spacing::chordal));
    EXPECT_DOUBLE_EQ(at[1] / at[2], 2.0 / 3);
    EXPECT_DOUBLE_EQ(must(parameters(net, 0, Spacing::centripetal))[1], 0.5);
}

TEST(Parameters, refuse_equal_neighbours_by_index) {
    std::vector<Vec<2>> q = kPoints;
    q[2] = q[1];
    const auto r = parameters<2>(q, Spacing::chordal);
    ASSERT_FALSE(r);
    EXPECT_EQ(r.error().where, "points[2]");
    EXPECT_EQ(r.error().message, "is the same as points[1]; chordal parameters need distinct neighbours");
    EXPECT_TRUE(parameters<2>(q, Spacing::uniform));
    q[1][0] = std::nan("");
    EXPECT_EQ(parameters<2>(q, Spacing::uniform).error().where, "points[1]");
    EXPECT_EQ(parameters<2>(std::span(kPoints).first(1), Spacing::chordal).error().where, "points");
}

}  // namespace
}  // namespace freiform
