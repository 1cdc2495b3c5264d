#include <freiform/core/scan.hpp>
#include <freiform/core/spelling.hpp>

#include <array>
#include <gtest/gtest.h>

namespace freiform {
namespace {

constexpr std::array<std::string_view, 4> kWords = {"knots", "weights", "points", "degree"};

TEST(Closest, finds_words_with_a_letter_missing_added_changed_or_swapped) {
    EXPECT_EQ(closest("knot", kWords), "knots");
    EXPECT_EQ(closest("wieghts", kWords), "weights");
    EXPECT_EQ(closest("pointts", kWords), "points");
    EXPECT_EQ(closest("decree", kWords), "degree");
    EXPECT_EQ(closest("konts", kWords), "knots");
}

TEST(Closest, says_nothing_about_words_that_are_like_none) {
    EXPECT_EQ(closest("colour", kWords), "");
    EXPECT_EQ(closest("", kWords), "");
    EXPECT_EQ(closest(std::string(100000, 'k'), kWords), "");
    EXPECT_EQ(did_you_mean("colour", kWords), "");
    EXPECT_EQ(did_you_mean("knot", kWords), "; did you mean \"knots\"?");
}

TEST(Listed, reads_like_a_sentence) {
    EXPECT_EQ(listed(kWords), "knots, weights, points or degree");
    EXPECT_EQ(listed(std::span(kWords).first(1)), "knots");
}

TEST(ScanNumber, takes_all_of_a_finite_number_and_nothing_else) {
    EXPECT_EQ(scan_number<double>("1e-3"), 1e-3);
    EXPECT_EQ(scan_number<double>("+2"), 2.0);
    EXPECT_TRUE(std::signbit(*scan_number<double>("-0")));
    EXPECT_EQ(scan_number<double>("1e-400"), 0.0);
    EXPECT_EQ(scan_number<int>("-7"), -7);
    for (const char* bad : {"", "+", "+-1", "1x", " 1", "nan", "inf", "1e999", "0x10", "1,5"})
        EXPECT_FALSE(scan_number<double>(bad)) << bad;
    EXPECT_FALSE(scan_number<int>("1.5"));
    EXPECT_FALSE(scan_number<int>("99999999999"));
}

TEST(NextWord, walks_through_a_line) {
    std::string_view rest = "  a\tbb  c\r";
    EXPECT_EQ(next_word(rest), "a");
    EXPECT_EQ(next_word(rest), "bb");
    EXPECT_EQ(next_word(rest), "c");
    EXPECT_EQ(next_word(rest), "");
}

}  // namespace
}  // namespace freiform
