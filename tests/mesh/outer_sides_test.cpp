#include "mesh/outer_sides_detail.hpp"
#include "support/random.hpp"

#include <algorithm>
#include <array>
#include <gtest/gtest.h>
#include <map>
#include <vector>

namespace freiform {
namespace {

using Side = std::array<int, 2>;

std::vector<Side> sides_of(const std::vector<int>& polygon) {
    std::vector<Side> out;
    for (std::size_t k = 0; k < polygon.size(); ++k) {
        const auto [lo, hi] = std::minmax(polygon[k], polygon[(k + 1) % polygon.size()]);
        out.push_back({lo, hi});
    }
    return out;
}

std::vector<Side> outer(const OuterSides& sides) {
    std::vector<Side> out;
    sides.each([&](int a, int b) { out.push_back({a, b}); });
    std::sort(out.begin(), out.end());
    return out;
}

// Squares of a board, added and removed in any order, beside counting all sides.
TEST(OuterSides, are_those_of_one_polygon_alone_whatever_was_removed) {
    test::Random random(5);
    const int n = 6;
    const auto square = [&](int k) {
        const int at = k % n + (k / n) * (n + 1);
        return std::vector<int>{at, at + 1, at + n + 2, at + n + 1};
    };
    for (int round = 0; round < 20; ++round) {
        OuterSides sides((n + 1) * (n + 1), 8);
        std::vector<char> there(n * n);
        for (int step = 0; step < 200; ++step) {
            const int k = random.integer(0, n * n - 1);
            there[std::size_t(k)] ? sides.remove(square(k)) : sides.add(square(k));
            there[std::size_t(k)] ^= 1;
            if (step % 10 != 0) continue;
            std::map<Side, int> counts;
            for (int i = 0; i < n * n; ++i)
                if (there[std::size_t(i)])
                    for (const Side& s : sides_of(square(i))) ++counts[s];
            std::vector<Side> expected;
            for (const auto& [side, polygons] : counts)
                if (polygons == 1) expected.push_back(side);
            EXPECT_EQ(outer(sides), expected);
        }
    }
}

}  // namespace
}  // namespace freiform
