#include <freiform/core/sort.hpp>

#include <cmath>
#include <gtest/gtest.h>
#include <memory>
#include <numeric>
#include <random>
#include <span>
#include <string>
#include <vector>

namespace freiform {
namespace {

// How often `less` is asked.
template <class T>
std::size_t comparisons_of_small_sort(std::vector<T>& x, int depth) {
    std::size_t n = 0;
    const auto less = [&](const T& a, const T& b) { return ++n, a < b; };
    detail::small_sort(x.begin(), x.end(), less, depth);
    return n;
}

std::vector<std::vector<int>> orders(int n) {
    std::mt19937 random{std::uint32_t(n)};
    std::vector<int> up(std::size_t(n), 0), down, few, organ, shuffled;
    std::iota(up.begin(), up.end(), 0);
    down.assign(up.rbegin(), up.rend());
    shuffled = up;
    std::shuffle(shuffled.begin(), shuffled.end(), random);
    for (int i = 0; i < n; ++i) few.push_back(int(random() % 3)), organ.push_back(std::min(i, n - i));
    return {up, down, few, organ, shuffled, std::vector<int>(std::size_t(n), 5)};
}

TEST(SmallSort, sorts_as_the_standard_library_does) {
    for (int n = 0; n < 200; ++n)
        for (std::vector<int> x : orders(n))
            for (const int depth : {0, 1, 3, 100}) {
                std::vector<int> theirs = x, ours = x;
                std::sort(theirs.begin(), theirs.end());
                comparisons_of_small_sort(ours, depth);
                ASSERT_EQ(ours, theirs) << n << " " << depth;
            }
}

// 2 n log n at most for the parts, and as many for the heap.
TEST(SmallSort, asks_for_n_log_n_comparisons) {
    for (const int n : {1000, 30'000})
        for (std::vector<int> x : orders(n)) {
            std::vector<int> y = x;
            const double unit = n * std::log2(n);
            EXPECT_LE(double(comparisons_of_small_sort(x, 2 * int(std::log2(n)) + 2)), 4.3 * unit);
            EXPECT_LE(double(comparisons_of_small_sort(y, 0)), 2.1 * unit);
            EXPECT_TRUE(std::ranges::is_sorted(x) && std::ranges::is_sorted(y));
        }
}

// It decides how large elements are only when they are compared, so that the pivot is always small
// [McIlroy 1999].
TEST(SmallSort, an_adversary_gains_nothing) {
    constexpr int n = 4000;
    std::vector<int> value(n, n), x(n);
    std::iota(x.begin(), x.end(), 0);
    int solid = 0, candidate = 0;
    std::size_t asked = 0;
    const auto less = [&](int a, int b) {
        ++asked;
        if (value[std::size_t(a)] == n && value[std::size_t(b)] == n)
            value[std::size_t(a == candidate ? a : b)] = solid++;
        if (value[std::size_t(a)] == n)
            candidate = a;
        else if (value[std::size_t(b)] == n)
            candidate = b;
        return value[std::size_t(a)] < value[std::size_t(b)];
    };
    detail::small_sort(x.begin(), x.end(), less, 2 * int(std::bit_width(unsigned(n))));
    EXPECT_LT(double(asked), 6.0 * n * std::log2(n));
    for (std::size_t i = 1; i < x.size(); ++i)
        ASSERT_LE(value[std::size_t(x[i - 1])], value[std::size_t(x[i])]);
}

// A comparison that is no order (NaN) loses nothing and stays inside.
TEST(SmallSort, keeps_all_elements_whatever_the_comparison_says) {
    std::mt19937 random(3);
    for (int n = 0; n < 100; ++n) {
        std::vector<int> x(std::size_t(n), 0);
        std::iota(x.begin(), x.end(), 0);
        const auto coin = [&](int, int) { return random() % 4 == 0; };
        detail::small_sort(x.begin(), x.end(), coin, 8);
        std::ranges::sort(x);
        for (int i = 0; i < n; ++i) ASSERT_EQ(x[std::size_t(i)], i);
    }
}

TEST(SmallSort, moves_what_cannot_be_copied) {
    std::vector<std::unique_ptr<int>> x;
    for (int i = 0; i < 100; ++i) x.push_back(std::make_unique<int>(i * 37 % 100));
    detail::small_sort(
        x.begin(), x.end(), [](const auto& a, const auto& b) { return *a < *b; }, 2);
    for (int i = 0; i < 100; ++i) ASSERT_EQ(*x[std::size_t(i)], i);
}

TEST(Sort, takes_ranges_and_pairs_of_iterators_orders_and_keys) {
    std::vector<std::string> words{"knot", "a", "net"};
    sort(words);
    EXPECT_EQ(words, (std::vector<std::string>{"a", "knot", "net"}));
    sort(words, {}, &std::string::size);
    EXPECT_EQ(words, (std::vector<std::string>{"a", "net", "knot"}));
    sort(words.begin(), words.end(), std::greater<>(), [](const std::string& s) { return s.size(); });
    EXPECT_EQ(words, (std::vector<std::string>{"knot", "net", "a"}));
    int numbers[] = {3, 1, 2};
    sort(numbers, numbers + 2);
    EXPECT_EQ(std::vector<int>(numbers, numbers + 3), (std::vector<int>{1, 3, 2}));
    sort(std::span(numbers), std::greater<>());
    EXPECT_EQ(numbers[0], 3);
}

}  // namespace
}  // namespace freiform
