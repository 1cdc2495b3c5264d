#include <freiform/core/text.hpp>

#include <gtest/gtest.h>
#include <limits>

namespace freiform {
namespace {

TEST(Text, joins_parts_of_every_kind) {
    const std::string owned = "kept";
    EXPECT_EQ(text("a", 'b', owned, std::string_view("view"), " ", -3, " ", 7u, " ", true, false),
              "abkeptview -3 7 truefalse");
    EXPECT_EQ(
        text(std::numeric_limits<long long>::min(), " ", std::numeric_limits<unsigned long long>::max()),
        "-9223372036854775808 18446744073709551615");
    EXPECT_EQ(text(static_cast<short>(-1), " ", static_cast<unsigned char>(200)), "-1 200");
    EXPECT_EQ(text(""), "");
}

TEST(Text, numbers_are_the_shortest_that_read_back) {
    EXPECT_EQ(text(0.1, " ", 1e300, " ", -0.0, " ", 5e-324), "0.1 1e+300 -0 5e-324");
    EXPECT_EQ(text(0.1f), "0.1");
    EXPECT_EQ(text(1.0 / 3), "0.3333333333333333");
}

TEST(Text, is_appended_behind_what_is_there) {
    std::string s = "x = ";
    append_text(s, 2.5);
    append_text(s, ';');
    append_text(s, " done");
    EXPECT_EQ(s, "x = 2.5; done");
}

}  // namespace
}  // namespace freiform
