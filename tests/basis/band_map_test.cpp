#include "support/random.hpp"

#include <freiform/basis/band_map.hpp>

#include <gtest/gtest.h>

namespace freiform {
namespace {

using test::Random;

// Rows of any width whose columns may wrap, with zeros among the entries.
BandMap random_map(Random& random, int rows, int cols) {
    BandMap m{cols, random.integer(1, cols), {}, {}};
    for (int i = 0; i < rows; ++i) m.first.push_back(random.integer(0, 2 * cols));
    for (int k = 0; k < rows * m.width; ++k) m.entry.push_back(random.chance(0.2) ? 0.0 : random.real(-1, 1));
    return m;
}

// The slow twin: fibre by fibre, coefficient by coefficient.
template <std::size_t N, class P>
Net<N, P> fibre_by_fibre(int axis, const BandMap& m, const Net<N, P>& in) {
    Index<N> extent = in.extent();
    extent[std::size_t(axis)] = m.rows();
    Net<N, P> out(extent);
    each_index(extent, [&](const Index<N>& at) {
        P sum{};
        for (int k = 0; k < m.width; ++k) {
            Index<N> from = at;
            const auto row = std::size_t(at[std::size_t(axis)]);
            from[std::size_t(axis)] = (m.first[row] + k) % m.cols;
            if (const double w = m.row(int(row))[std::size_t(k)]; w != 0) sum += w * in.view()(from);
        }
        out.view()(at) = sum;
    });
    return out;
}

template <std::size_t N, class P>
void expect_the_same_bits(std::uint64_t seed) {
    Random random(seed);
    for (int k = 0; k < 40; ++k) {
        Index<N> extent{};
        for (int& e : extent) e = random.integer(1, 7);
        const auto net = test::random_net<N, P>(random, extent);
        for (int axis = 0; axis < int(N); ++axis) {
            const BandMap m = random_map(random, random.integer(0, 9), extent[std::size_t(axis)]);
            const auto mapped = along(axis, m, net);
            EXPECT_EQ(mapped.extent()[std::size_t(axis)], m.rows());
            if (m.rows() == 0) continue;
            EXPECT_EQ(mapped, fibre_by_fibre(axis, m, net)) << "axis " << axis << " case " << k;
        }
    }
}

TEST(BandMap, along_an_axis_acts_on_every_fibre_alone) {
    expect_the_same_bits<1, Vec<1>>(1);
    expect_the_same_bits<1, Hom<4>>(2);
    expect_the_same_bits<2, Vec<2>>(3);
    expect_the_same_bits<2, Hom<2>>(4);
    expect_the_same_bits<3, Vec<4>>(5);
    expect_the_same_bits<3, Hom<1>>(6);
}

TEST(BandMap, skips_what_has_weight_zero) {
    const Net<1, Vec<1>> net({2}, {{{INFINITY}}, {{3}}});
    const BandMap m{2, 2, {0}, {0.0, 2.0}};
    EXPECT_EQ(along(0, m, net).flat()[0][0], 6);
}

}  // namespace
}  // namespace freiform
