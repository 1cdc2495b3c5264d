#include <freiform/core/net.hpp>
#include <freiform/core/vec.hpp>

#include <gtest/gtest.h>
#include <vector>

namespace freiform {
namespace {

TEST(Net, last_index_runs_fastest) {
    Net<3, Vec<1>> net({2, 3, 4});
    ASSERT_EQ(net.flat().size(), 24u);
    for (std::size_t i = 0; i < net.flat().size(); ++i) net.flat()[i] = {{double(i)}};
    const auto v = net.view();
    EXPECT_EQ(v.stride, (std::array<std::ptrdiff_t, 3>{12, 4, 1}));
    for (int i = 0; i < 2; ++i)
        for (int j = 0; j < 3; ++j)
            for (int k = 0; k < 4; ++k) EXPECT_EQ(v({i, j, k})[0], 12 * i + 4 * j + k);
}

TEST(Net, each_index_visits_the_storage_in_order) {
    const Index<3> extent{2, 3, 4};
    Net<3, Vec<1>> net(extent);
    std::vector<const Vec<1>*> seen;
    each_index(extent, [&](const Index<3>& at) { seen.push_back(&net.view()(at)); });
    ASSERT_EQ(seen.size(), 24u);
    for (std::size_t i = 0; i < seen.size(); ++i) EXPECT_EQ(seen[i], &net.flat()[i]);
}

TEST(Net, each_index_of_an_empty_extent_visits_nothing) {
    int calls = 0;
    each_index(Index<2>{3, 0}, [&](const Index<2>&) { ++calls; });
    each_index(Index<2>{0, 3}, [&](const Index<2>&) { ++calls; });
    EXPECT_EQ(calls, 0);
}

TEST(Net, fibres_along_an_axis_cover_every_entry_once) {
    Net<3, Vec<1>> net({2, 3, 4});
    for (int axis = 0; axis < 3; ++axis) {
        each_fibre(axis, net.extent(), [&](const Index<3>& at) {
            const auto fibre = net.view().fibre(axis, at);
            EXPECT_EQ(fibre.size, net.extent()[std::size_t(axis)]);
            for (int i = 0; i < fibre.size; ++i) fibre[i][0] += 1;
        });
        for (const auto& p : net.flat()) EXPECT_EQ(p[0], axis + 1);
    }
}

TEST(Net, window_is_a_view_of_the_same_storage) {
    Net<2, Vec<1>> net({4, 5});
    const auto inner = net.view().window({1, 2}, {2, 3});
    inner({1, 2}) = {{7}};
    EXPECT_EQ(net.view()({2, 4})[0], 7);
    EXPECT_EQ(inner.extent, (Index<2>{2, 3}));
}

TEST(Net, count_refuses_negative_extents_and_products_beyond_int) {
    EXPECT_EQ(count_of(Index<2>{3, 5}), 15);
    EXPECT_EQ(count_of(Index<2>{3, 0}), 0);
    EXPECT_EQ(count_of(Index<2>{-1, 5}), -1);
    EXPECT_EQ(count_of(Index<2>{65536, 65536}), -1);
    EXPECT_EQ(count_of(Index<3>{0x7fffffff, 0x7fffffff, 0x7fffffff}), -1);
}

TEST(Net, make_says_what_disagrees) {
    const auto net = Net<2, Vec<1>>::make({2, 3}, std::vector<Vec<1>>(5));
    ASSERT_FALSE(net);
    EXPECT_EQ(net.error().kind, RefusalKind::invalid);
    EXPECT_EQ(net.error().message, "extents ask for 6 coefficients, 5 are given");
    EXPECT_TRUE((Net<2, Vec<1>>::make({2, 3}, std::vector<Vec<1>>(6))));
}

}  // namespace
}  // namespace freiform
