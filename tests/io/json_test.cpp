#include <freiform/io/json.hpp>

#include <bit>
#include <cmath>
#include <cstdint>
#include <gtest/gtest.h>
#include <limits>
#include <nlohmann/json.hpp>
#include <random>

namespace freiform::json {
namespace {

using Other = nlohmann::json;

Other converted(Value v) {
    switch (v.kind()) {
        case Kind::null:
            return nullptr;
        case Kind::boolean:
            return v.boolean();
        case Kind::number:
            return v.number();
        case Kind::string:
            return v.string();
        case Kind::array: {
            Other a = Other::array();
            for (const Value x : v.elements()) a.push_back(converted(x));
            return a;
        }
        case Kind::object: {
            Other o = Other::object();
            for (const Member& m : v.members()) o[m.key] = converted(m.value);
            return o;
        }
    }
    return nullptr;
}

double number_of(const std::string& text) {
    const auto tree = parse(text);
    return tree && tree->root().is(Kind::number) ? tree->root().number() : std::nan("");
}

TEST(Json, means_what_another_parser_says) {
    for (const std::string text :
         {R"({"a": [1, 2.5, -3e2, {"b": null}], "c": "x\n\"\\é😀 ü", "d": {}, "e": [], "f": true})",
          "[[[]], [{}], [[1], [2]]]", " \t\r\n 7 ", "\"\"", "false", R"({"":{"":{"":0}}})"}) {
        const auto tree = parse(text);
        ASSERT_TRUE(tree) << text << tree.error().message;
        EXPECT_EQ(converted(tree->root()), Other::parse(text)) << text;
    }
    EXPECT_TRUE(parse("\xEF\xBB\xBF{}"));
}

TEST(Json, accepts_and_refuses_what_another_parser_does_on_damaged_text) {
    const std::string good = R"({"k": [0, -1.5e-3, true, null, "a\u00e9\n"], "m": {"n": [[1], [2]]}})";
    const std::string alphabet = "{}[],:\"\\0123456789.-+eEtrufalsn \n\x80\xC3\xFF";
    std::mt19937 random(1);
    int accepted = 0;
    for (int i = 0; i < 20000; ++i) {
        std::string text = good;
        for (unsigned k = random() % 3 + 1; k > 0; --k) {
            const std::size_t at = random() % text.size();
            switch (random() % 3) {
                case 0:
                    text[at] = alphabet[random() % alphabet.size()];
                    break;
                case 1:
                    text.erase(at, 1 + random() % 4);
                    break;
                default:
                    text.insert(at, 1, alphabet[random() % alphabet.size()]);
            }
            if (text.empty()) text = "0";
        }
        const auto tree = parse(text);
        const Other other = Other::parse(text, nullptr, false);
        if (tree) {
            ++accepted;
            ASSERT_FALSE(other.is_discarded()) << text;
            ASSERT_EQ(converted(tree->root()), other) << text;
        } else if (tree.error().message.find("twice") == std::string::npos) {
            ASSERT_TRUE(other.is_discarded()) << text << "\n" << tree.error().message;
        }
    }
    EXPECT_GT(accepted, 1000);
}

TEST(Json, keeps_every_bit_of_a_number) {
    std::mt19937_64 random(2);
    for (int i = 0; i < 20000; ++i) {
        const auto x = std::bit_cast<double>(random());
        if (!std::isfinite(x)) continue;
        const std::string text = Writer().value(x).text();
        ASSERT_EQ(std::bit_cast<std::uint64_t>(number_of(text)), std::bit_cast<std::uint64_t>(x)) << text;
    }
    for (const double x : {0.0, -0.0, 5e-324, -5e-324, 1.7976931348623157e308, 9007199254740993.0, 0.1}) {
        const double y = number_of(Writer().value(x).text());
        EXPECT_EQ(std::bit_cast<std::uint64_t>(y), std::bit_cast<std::uint64_t>(x));
    }
    EXPECT_TRUE(std::signbit(number_of("-0")));
    EXPECT_EQ(number_of("18446744073709551617"), 18446744073709551616.0);
}

TEST(Json, tells_numbers_that_are_too_large_from_those_that_are_too_small) {
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    EXPECT_EQ(number_of("1e999"), kInfinity);
    EXPECT_EQ(number_of("-1e309"), -kInfinity);
    EXPECT_EQ(number_of("0.001e400"), kInfinity);
    EXPECT_EQ(number_of("1" + std::string(400, '0')), kInfinity);
    EXPECT_EQ(number_of("1e-999"), 0);
    EXPECT_TRUE(std::signbit(number_of("-1e-999")));
    EXPECT_EQ(number_of("0." + std::string(400, '0') + "1"), 0);
    EXPECT_EQ(number_of("1e" + std::string(50, '9')), kInfinity);
    EXPECT_EQ(number_of("0." + std::string(400, '0') + "1e401"), 1);
}

TEST(Json, refuses_with_line_and_column) {
    struct Case {
        const char *text, *where, *message;
    };
    for (const Case& c : {Case{"", "line 1, column 1", "ends where a value is expected"},
                          {"{\n  \"a\": 1,\n  \"b\" 2\n}", "line 3, column 7", "expected ':', found '2'"},
                          {"[1, 2", "line 1, column 6", "ends where ',' or ']'"},
                          {"[1,]", "line 1, column 4", "a comma before ']'"},
                          {"{\"a\":1,}", "line 1, column 8", "a comma before '}'"},
                          {"[NaN]", "line 1, column 2", "found 'NaN'"},
                          {"[Infinity]", "line 1, column 2", "found 'Infinity'"},
                          {"[+1]", "line 1, column 2", "found '+'"},
                          {"[01]", "line 1, column 2", "begin with 0"},
                          {"[1.]", "line 1, column 4", "expected a digit"},
                          {"[1e]", "line 1, column 4", "expected a digit"},
                          {"{} {}", "line 1, column 4", "more text follows"},
                          {"\"\xC3\xA9\xC3\xA9\" x", "line 1, column 6", "more text follows"},
                          {"\"ab", "line 1, column 1", "does not end"},
                          {"\"a\nb\"", "line 1, column 3", "has to be escaped"},
                          {"\"\\x\"", "line 1, column 2", "escape"},
                          {"\"\\ud800\"", "line 1, column 2", "escape"},
                          {"\"\xFF\"", "line 1, column 2", "not UTF-8"},
                          {"{\"a\":1,\n\"a\":2}", "line 2, column 1", "appears twice"},
                          {"{\"a\":1,\"\\u0061\":2}", "line 1, column 8", "appears twice"},
                          {"{a:1}", "line 1, column 2", "a key in double quotes"}}) {
        const auto tree = parse(c.text);
        ASSERT_FALSE(tree) << c.text;
        EXPECT_EQ(tree.error().kind, RefusalKind::unreadable);
        EXPECT_EQ(tree.error().where, c.where) << c.text;
        EXPECT_NE(tree.error().message.find(c.message), std::string::npos) << tree.error().message;
    }
}

TEST(Json, has_a_depth) {
    const auto nested = [](std::size_t n) { return std::string(n, '[') + std::string(n, ']'); };
    EXPECT_TRUE(parse(nested(kMaxDepth)));
    const auto deep = parse(nested(kMaxDepth + 1));
    ASSERT_FALSE(deep);
    EXPECT_EQ(deep.error().where, "line 1, column 65");
    EXPECT_FALSE(parse(std::string(1'000'000, '[')));
    EXPECT_TRUE(parse("[" + nested(10) + std::string(5000, ' ') + "]"));
}

TEST(JsonWriter, puts_commas_and_escapes) {
    Writer w;
    w.begin_object().field("a", 1).key("b").begin_array().value("x\"\\\n\t\x01").null().end_array();
    w.field("c", true).key("d").begin_object().end_object().end_object();
    EXPECT_EQ(w.text(), "{\"a\": 1, \"b\": [\"x\\\"\\\\\\n\\t\\u0001\",null], \"c\": true, \"d\": {}}");
    EXPECT_EQ(Writer().value("a\xFF\xC3z\xE2\x82\xAC").text(), "\"a\xEF\xBF\xBD\xEF\xBF\xBDz\xE2\x82\xAC\"");
    EXPECT_EQ(Writer().value(std::nan("")).text(), "null");
}

}  // namespace
}  // namespace freiform::json
