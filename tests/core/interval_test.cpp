#include <freiform/core/interval.hpp>

#include <gtest/gtest.h>
#include <limits>

namespace freiform {
namespace {

TEST(Interval, contains_its_ends) {
    const Interval i{-1, 3};
    EXPECT_TRUE(i.contains(-1) && i.contains(3) && i.contains(0));
    EXPECT_FALSE(i.contains(-1.001) || i.contains(3.001));
    EXPECT_FALSE(i.contains(std::numeric_limits<double>::quiet_NaN()));
    EXPECT_EQ(i.length(), 4);
}

TEST(Interval, middle_lies_inside_and_does_not_overflow) {
    for (const Interval& i :
         {Interval{-1, 3}, Interval{1e308, 1.7e308}, Interval{1, 1 + 0x1p-52}, Interval{2, 2}})
        EXPECT_TRUE(i.contains(i.middle())) << i.lo << " " << i.hi;
    EXPECT_EQ((Interval{-1, 3}.middle()), 1);
}

TEST(Interval, overlap_is_symmetric_and_includes_touching) {
    const Interval a{0, 1}, b{1, 2}, c{1.5, 3};
    EXPECT_TRUE(a.overlaps(b) && b.overlaps(a));
    EXPECT_FALSE(a.overlaps(c) || c.overlaps(a));
    EXPECT_EQ(hull(a, c), (Interval{0, 3}));
    EXPECT_EQ(hull(c, a), (Interval{0, 3}));
}

TEST(Box, is_empty_until_something_is_added) {
    Box<2> box;
    EXPECT_TRUE(box.is_empty());
    EXPECT_EQ(box.diagonal(), 0);
    EXPECT_EQ(box.scale(), 0);
    EXPECT_FALSE(box.contains({{0, 0}}));
    box.add(Vec<2>{{1, -4}});
    EXPECT_FALSE(box.is_empty());
    EXPECT_EQ(box.diagonal(), 0);
    EXPECT_EQ(box.scale(), 4);
    box.add(Vec<2>{{6, 0}});
    EXPECT_EQ(box.scale(), 6);
    box.add(Vec<2>{{-9, 0}});
    EXPECT_EQ(box.scale(), 9);
}

TEST(Box, is_the_smallest_of_what_was_added) {
    Box<3> a, b;
    a.add(Vec<3>{{0, 1, 2}});
    a.add(Vec<3>{{3, 1, -2}});
    b.add(Vec<3>{{0, 5, 0}});
    Box<3> both = a;
    both.add(b);
    EXPECT_EQ(both.lo, (Vec<3>{{0, 1, -2}}));
    EXPECT_EQ(both.hi, (Vec<3>{{3, 5, 2}}));
    EXPECT_EQ(both.side(1), (Interval{1, 5}));
    EXPECT_TRUE(both.contains({{0, 5, 0}}));
    EXPECT_FALSE(both.contains({{0, 5.5, 0}}));
    EXPECT_EQ(a.diagonal(), 5);
    both.add(Box<3>{});
    EXPECT_EQ(both.hi, (Vec<3>{{3, 5, 2}}));
}

}  // namespace
}  // namespace freiform
