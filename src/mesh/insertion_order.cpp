// Idea. Randomised insertion has O(log n) expected work per point whatever the points are (a sorted parabola
// costs O(n) flips per point otherwise), but jumps all over the memory. Sorting along a curve inside rounds
// that double in size keeps both the bound and the locality [Amenta, Choi & Rote 2003].
#include "mesh/insertion_order_detail.hpp"

#include <freiform/core/sort.hpp>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>

namespace freiform::detail {

namespace {

constexpr int kBits =
    24;  // of each coordinate along the curve; points nearer than that keep the order of indices

// Place of the cell (x, y) on the Hilbert curve through 2^kBits x 2^kBits cells: from the coarsest level
// down, which quarter, and then the turn of the axes in that quarter.
std::uint64_t place_on_curve(std::uint32_t x, std::uint32_t y) {
    std::uint64_t place = 0;
    for (int bit = kBits - 1; bit >= 0; --bit) {
        const std::uint32_t right = x >> bit & 1, top = y >> bit & 1;
        place = place << 2 | (right ? 3 - top : top);
        if (top) continue;
        if (right) x = ~x, y = ~y;
        std::swap(x, y);
    }
    return place;
}

// A fixed scrambling of the index.
std::uint64_t scrambled(std::uint64_t i) {
    i = (i + 1) * 0x9e3779b97f4a7c15u;
    i = (i ^ i >> 31) * 0xd6e8feb86659fd93u;
    return i ^ i >> 32;
}

struct Key {
    int round;
    std::uint64_t place;
    int index;
    auto operator<=>(const Key&) const = default;
};

}  // namespace

std::vector<int> insertion_order(std::span<const Vec<2>> points) {
    double largest = 0;
    for (const Vec<2>& p : points) largest = std::max(largest, max_abs(p));
    const int exponent = largest > 0 ? std::ilogb(largest) : 0;
    // In two steps, as 2^-exponent alone may overflow; exact but for what vanishes beside the largest.
    const double once = std::ldexp(1.0, -exponent / 2), twice = std::ldexp(1.0, -exponent - -exponent / 2);
    const auto scaled = [&](const Vec<2>& p, int k) { return p[k] * once * twice; };  // in (-2, 2)
    std::array<double, 2> low{2, 2}, high{-2, -2};
    for (const Vec<2>& p : points)
        for (int k = 0; k < 2; ++k) {
            low[std::size_t(k)] = std::min(low[std::size_t(k)], scaled(p, k));
            high[std::size_t(k)] = std::max(high[std::size_t(k)], scaled(p, k));
        }
    const double extent = std::max({high[0] - low[0], high[1] - low[1], 0x1p-1000});
    const auto cell = [&](const Vec<2>& p, int k) {
        return std::uint32_t((scaled(p, k) - low[std::size_t(k)]) / extent * ((1 << kBits) - 1));
    };
    const int rounds = std::bit_width(points.size());
    std::vector<Key> keys;
    keys.reserve(points.size());
    for (std::size_t i = 0; i < points.size(); ++i)
        keys.push_back({rounds - std::min(rounds, std::countr_zero(scrambled(i))),
                        place_on_curve(cell(points[i], 0), cell(points[i], 1)), int(i)});
    sort(keys.begin(), keys.end());
    std::vector<int> order;
    order.reserve(points.size());
    for (const Key& k : keys) order.push_back(k.index);
    return order;
}

}  // namespace freiform::detail
