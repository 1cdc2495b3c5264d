#include <freiform/io/points.hpp>

#include <gtest/gtest.h>

namespace freiform {
namespace {

TEST(Points, lines_may_have_commas_semicolons_or_blanks_a_heading_and_comments) {
    for (const char* text :
         {"1,2\n3,4\n", "x,y\n1, 2\r\n3 ,4", "1;2\n3;4\n", "# two points\n1 2\n\n3\t4  # second\n",
          "\xEF\xBB\xBFx1;y1\n+1;2e0\n3;4;\n", "1,2,\n3,4,\n"}) {
        const auto t = parse_points(text);
        ASSERT_TRUE(t) << text << t.error().where << t.error().message;
        EXPECT_EQ(t->coords, 2) << text;
        EXPECT_EQ(t->values, (std::vector<double>{1, 2, 3, 4})) << text;
        EXPECT_EQ(t->extent, (Index<2>{2, 1}));
        EXPECT_FALSE(t->grid);
    }
    EXPECT_EQ(parse_points("x y\n1 2\n\n3 4\n")->place, (std::vector<std::string>{"line 2", "line 4"}));
}

TEST(Points, lines_may_end_as_any_machine_ends_them_and_begin_with_a_mark) {
    for (const char* bytes : {"1,2\n3,4\n\n5,6", "1,2\r\n3,4\r\n\r\n5,6\r\n", "1,2\r3,4\r\r5,6\r",
                              "\xEF\xBB\xBF\r\n1,2\n3,4\r5,6"}) {
        const auto t = parse_points(bytes);
        ASSERT_TRUE(t) << t.error().where << t.error().message;
        EXPECT_EQ(t->extent, (Index<2>{3, 1}));
    }
    EXPECT_TRUE(parse_points("\xEF\xBB\xBF[[1,2],[3,4]]"));
    const auto bad = parse_points("1,2\r3,4\r5,x\r");
    ASSERT_FALSE(bad);
    EXPECT_EQ(bad.error().where, "line 3");
}

TEST(Points, json_holds_points_or_rows_of_points) {
    EXPECT_EQ(parse_points(" [[1,2,3],[4,5,6]]")->values, (std::vector<double>{1, 2, 3, 4, 5, 6}));
    const auto t = parse_points(R"({"points": [[[1,2],[3,4],[5,6]], [[7,8],[9,10],[11,12]]]})");
    ASSERT_TRUE(t);
    EXPECT_TRUE(t->grid);
    EXPECT_EQ(t->extent, (Index<2>{2, 3}));
    EXPECT_EQ(t->place[4], "points[1][1]");
    EXPECT_EQ(t->values[8], 9);
}

TEST(Points, refusals_name_the_line_or_the_index) {
    const auto expect = [](const char* text, const std::string& where, const std::string& message) {
        const auto t = parse_points(text);
        ASSERT_FALSE(t) << text;
        EXPECT_EQ(t.error().where, where) << text;
        EXPECT_NE(t.error().message.find(message), std::string::npos) << t.error().message;
    };
    expect("1,2\n3,x\n", "line 2", "found \"x\"");
    expect("x,y\na,b\n", "line 2", "found \"a\"");
    expect("1,2\n3,nan\n", "line 2", "found \"nan\"");
    for (const char* first : {"nan", "NaN", "-inf", "+Infinity", "1e999", "\"1\""})
        expect((text(first, ",", first, "\n1,2\n")).c_str(), "line 1", text("found \"", first, "\""));
    expect("1,2\n3,,4\n", "line 2", "found \"\"");
    expect("1,2\n3\n", "line 2", "found 1 number, the points before have 2");
    expect("1,2,3,4,5\n", "line 1", "points have 1 to 4 coordinates");
    expect("[[1,2],[3]]", "[1]", "found 1 number");
    expect("[[1,2],3]", "[1]", "expected a point");
    expect("[[1,\"2\"]]", "[0][1]", "expected a number, found a string");
    expect("[[1,1e999]]", "[0][1]", "range of double");
    expect("[[[1,2],[3,4]],[[5,6]]]", "[1]", "a row of 1 points, the rows before have 2");
    expect("{\"point\": []}", "", "the field points");
    expect("[1,", "line 1, column 4", "");
}

TEST(Points, files_are_named_in_refusals) {
    const auto t = read_points("/nonexistent/points.csv");
    ASSERT_FALSE(t);
    EXPECT_EQ(name_of(t.error().kind), name_of(RefusalKind::io));
    EXPECT_NE(t.error().where.find("points.csv"), std::string::npos);
}

}  // namespace
}  // namespace freiform
