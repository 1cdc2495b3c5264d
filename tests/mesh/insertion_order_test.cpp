#include "mesh/insertion_order_detail.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <random>
#include <set>

namespace freiform {
namespace {

TEST(InsertionOrder, is_a_permutation_along_a_curve_in_rounds) {
    const int n = 40000;
    std::mt19937 random(1);
    std::vector<Vec<2>> points;
    for (int i = 0; i < n; ++i) points.push_back({{double(random()), double(random() / 2)}});
    const std::vector<int> order = detail::insertion_order(points);
    EXPECT_EQ(std::set<int>(order.begin(), order.end()).size(), std::size_t(n));

    // In the last round, half of all points: a tour of m random points is at least about 0.7 sqrt(m area)
    // long, and along a Hilbert curve about 25 % longer; a random order has a length of about 0.5 m
    // sqrt(area).
    const double area = 0.5 * 0x1p64, m = n / 2 - 300;
    double length = 0;
    for (int i = n / 2 + 300; i + 1 < n; ++i)
        length +=
            norm(points[std::size_t(order[std::size_t(i) + 1])] - points[std::size_t(order[std::size_t(i)])]);
    EXPECT_LT(length, 1.1 * std::sqrt(m * area));
    EXPECT_GT(length, 0.7 * std::sqrt(m * area));
}

TEST(InsertionOrder, begins_everywhere) {
    std::vector<Vec<2>> points;
    for (int i = 0; i < 100000; ++i) points.push_back({{double(i), double(i) * i}});
    const std::vector<int> order = detail::insertion_order(points);
    std::vector<int> count(10);
    for (int i = 0; i < 1000; ++i) ++count[std::size_t(order[std::size_t(i)] / 10000)];
    for (const int c : count) EXPECT_NEAR(c, 100, 50);
}

TEST(InsertionOrder, takes_any_points) {
    EXPECT_TRUE(detail::insertion_order({}).empty());
    EXPECT_EQ(detail::insertion_order(std::vector<Vec<2>>{{{1e308, -1e308}}}).size(), 1u);
    const std::vector<Vec<2>> extreme{
        {{-1.7e308, 1.7e308}}, {{1.7e308, -1.7e308}}, {{0x1p-1074, 0}}, {{0, 0}}};
    EXPECT_EQ(detail::insertion_order(extreme).size(), 4u);
    EXPECT_EQ(detail::insertion_order(std::vector<Vec<2>>(5)).size(), 5u);
}

}  // namespace
}  // namespace freiform
