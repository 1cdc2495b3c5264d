// Points are numbered as they come, and found again by all of their digits.
#include "mesh/parameter_table_detail.hpp"
#include "support/random.hpp"

#include <cmath>
#include <gtest/gtest.h>
#include <map>

namespace freiform {
namespace {

using test::Random;

// A place among few, whose coordinates have few digits, or all of them.
double coordinate(Random& random, int kind) {
    switch (kind) {
        case 0:
            return std::ldexp(random.integer(-64, 64), -6);
        case 1:
            return 1e6 + std::ldexp(random.integer(0, 200), -20);
        default:
            return std::sin(random.integer(0, 20)) * std::ldexp(1.0, 20 * random.integer(-1, 1));
    }
}

TEST(ParameterTable, numbers_points_as_a_map_does) {
    Random random(11);
    for (const std::size_t expected : {std::size_t(0), std::size_t(1), std::size_t(500), std::size_t(20000)})
        for (int kind = 0; kind < 3; ++kind) {
            ParameterTable table(expected);
            std::map<std::array<double, 2>, int> twin;
            int known = 0;
            for (int k = 0; k < 8000; ++k) {
                const Vec<2> p{{coordinate(random, kind), coordinate(random, kind)}};
                const auto there = twin.find(p.c);
                ASSERT_EQ(table.find(p), there == twin.end() ? -1 : there->second);
                known += there != twin.end();
                if (k % 3 == 0) {
                    const int number = int(twin.size());
                    ASSERT_EQ(table.number(p), twin.try_emplace(p.c, number).first->second);
                }
                ASSERT_EQ(table.size(), twin.size());
            }
            EXPECT_GT(known, 100) << kind;
            for (const auto& [p, number] : twin) {
                EXPECT_EQ(table.find({p}), number);
                EXPECT_EQ(table.points()[std::size_t(number)].c, p);
            }
        }
}

TEST(ParameterTable, zero_has_no_sign) {
    ParameterTable table(4);
    EXPECT_TRUE(table.add({{0.0, 1}}));
    EXPECT_FALSE(table.add({{-0.0, 1}}));
    EXPECT_EQ(table.find({{-0.0, 1}}), 0);
    EXPECT_EQ(table.find({{1, -0.0}}), -1);
}

}  // namespace
}  // namespace freiform
