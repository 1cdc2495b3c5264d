#include <freiform/core/result.hpp>

#include <charconv>
#include <fstream>
#include <gtest/gtest.h>
#include <iterator>
#include <limits>
#include <set>

namespace freiform {
namespace {

TEST(Refusal, places_chain_from_the_outside_in) {
    const Refusal inner{RefusalKind::nonfinite, "points[3]", "x is nan"};
    const Refusal outer = refuse_within("file.json", refuse_within("objects[0]", inner).error()).error();
    EXPECT_EQ(outer.where, "file.json.objects[0].points[3]");
    EXPECT_EQ(outer.kind, inner.kind);
    EXPECT_EQ(outer.message, inner.message);
}

TEST(Refusal, an_index_is_appended_without_a_dot) {
    EXPECT_EQ(refuse_within("knots", Refusal{RefusalKind::invalid, "[3]", ""}).error().where, "knots[3]");
    EXPECT_EQ(refuse_within("knots", Refusal{RefusalKind::invalid, "", ""}).error().where, "knots");
}

TEST(Refusal, travels_as_a_result) {
    const Result<int> r = refuse(RefusalKind::limit, "triangles", "needs 12, may have 10");
    ASSERT_FALSE(r);
    EXPECT_EQ(r.error(), (Refusal{RefusalKind::limit, "triangles", "needs 12, may have 10"}));
}

TEST(Refusal, every_kind_has_a_name_of_its_own) {
    std::set<std::string_view> names;
    const int last = int(RefusalKind::io);
    for (int k = 0; k <= last; ++k) names.insert(name_of(RefusalKind(k)));
    EXPECT_EQ(int(names.size()), last + 1);
    EXPECT_EQ(name_of(RefusalKind::ill_conditioned), "ill_conditioned");
}

TEST(Refusal, every_kind_is_in_the_documentation) {
    std::ifstream file(FREIFORM_SOURCE_DIR "/docs/refusals.md");
    const std::string page{std::istreambuf_iterator<char>(file), {}};
    for (int k = 0; k <= int(RefusalKind::io); ++k) {
        const std::string row = text("\n| `", name_of(RefusalKind(k)), "` |");
        EXPECT_NE(page.find(row), std::string::npos) << row;
    }
}

TEST(Text, doubles_are_the_shortest_that_read_back) {
    for (const double x : {0.1, 1.0 / 3, 1e-310, 6.02214076e23, -0.0, std::numeric_limits<double>::max()}) {
        const std::string s = text(x);
        double back = 0;
        std::from_chars(s.data(), s.data() + s.size(), back);
        EXPECT_EQ(back, x) << s;
    }
    EXPECT_EQ(text(0.1), "0.1");
    EXPECT_EQ(text(1.0), "1");
}

TEST(Result, text_joins_parts_of_every_kind) {
    EXPECT_EQ(text("knots[", 3, "] decreases (", 1.5, " -> ", 0.5, ')', true),
              "knots[3] decreases (1.5 -> 0.5)true");
}

}  // namespace
}  // namespace freiform
