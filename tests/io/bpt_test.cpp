#include <freiform/io/bpt.hpp>
#include <freiform/io/document.hpp>
#include <freiform/io/file.hpp>
#include <freiform/io/read.hpp>

#include <bit>
#include <cstdint>
#include <gtest/gtest.h>
#include <random>
#include <set>
#include <support/corpus.hpp>
#include <support/damaged_text.hpp>

namespace freiform {
namespace {

const std::string kPlane = "1\n1 1\n0 0 0\n0 1 0\n1 0 0\n1 1 0\n";

TEST(Bpt, reads_points_row_by_row) {
    const auto d =
        read_bpt("# a plane\r\n\n 1 \n1 2 # degrees\n0 0 0\n0 1 0\n0 2 0\n1 0 -0\n\n1\t1e0 +1 \n1 2 0");
    ASSERT_TRUE(d) << d.error().where << d.error().message;
    ASSERT_EQ(d->objects.size(), 1u);
    const auto& s = std::get<Surface<Vec<3>>>(d->objects[0].shape);
    EXPECT_EQ(s.basis(0).degree(), 1);
    EXPECT_EQ(s.basis(1).degree(), 2);
    EXPECT_EQ(s.net().view()({1, 1}), (Vec<3>{{1, 1, 1}}));
    EXPECT_EQ(s.net().view()({0, 2}), (Vec<3>{{0, 2, 0}}));
    EXPECT_TRUE(std::signbit(s.net().view()({1, 0})[2]));
}

TEST(Bpt, names_the_line_of_every_fault) {
    struct Case {
        std::string text, where, message;
    };
    for (const Case& c : {Case{"", "line 1", "ends where the number of patches"},
                          {"x", "line 1", "expected the number of patches, found \"x\""},
                          {"-1", "line 1", "number of patches"},
                          {"1.5", "line 1", "number of patches"},
                          {"99999999\n1 1\n", "line 1", "99999999 patches are announced"},
                          {"2\n" + kPlane.substr(2), "line 7", "patch 2 of 2"},
                          {"1\n3\n0 0 0\n", "line 2", "two degrees"},
                          {"1\n3 -3\n0 0 0\n", "line 2", "degree -3 is outside"},
                          {"1\n26 1\n0 0 0\n", "line 2", "degree 26 is outside"},
                          {"1\n1 1\n0 0\n0 0 0\n", "line 3", "three finite numbers (point 1 of 4)"},
                          {"1\n1 1\n0 0 0\n0 0 nan\n", "line 4", "point 2 of 4"},
                          {"1\n1 1\n0 0 0\n0 0 1e999\n", "line 4", "point 2 of 4"},
                          {"1\n1 1\n0 0 0\n0 0 0 0\n", "line 4", "point 2 of 4"},
                          {"1\n1 1\n0 0 0\n", "line 4", "ends where point 2 of 4"},
                          {kPlane + "7 7", "line 7", "more follows"},
                          {"1\n1 1\n0 0 0\n0 0 1e308\n0 0 0\n0 0 0\n", "line 6", "2^1022"}}) {
        const auto d = read_bpt(c.text);
        ASSERT_FALSE(d) << c.text;
        EXPECT_EQ(d.error().kind, RefusalKind::unreadable) << c.text;
        EXPECT_EQ(d.error().where, c.where) << c.text;
        EXPECT_NE(d.error().message.find(c.message), std::string::npos) << d.error().message;
    }
}

TEST(Bpt, round_trips_every_bit) {
    std::mt19937_64 random(5);
    Document d;
    for (int i = 0; i < 50; ++i) {
        const int p = int(random() % 6), q = int(random() % 6);
        std::vector<Vec<3>> net(std::size_t((p + 1) * (q + 1)));
        for (Vec<3>& x : net)
            for (double& c : x.c) do
                    c = std::bit_cast<double>(random());
                while (!(std::abs(c) < 1e300));
        d.objects.push_back({"",
                             *Surface<Vec<3>>::make({*BSplineBasis::bezier(p), *BSplineBasis::bezier(q)},
                                                    Net<2, Vec<3>>({p + 1, q + 1}, net)),
                             {}});
    }
    const auto text = write_bpt(d);
    ASSERT_TRUE(text);
    const auto again = read_bpt(*text);
    ASSERT_TRUE(again) << again.error().message;
    EXPECT_EQ(write_document(*again), write_document(d));
}

TEST(Bpt, refuses_to_write_what_it_cannot_hold_and_names_it) {
    const auto refused = [](const std::string& object) {
        const auto d = read_document(
            R"({"objects": [{"type": "surface", "points": [[[0,0,0],[1,0,0]],[[0,1,0],[1,1,0]]]},)" + object +
            "]}");
        EXPECT_TRUE(d) << d.error().message;
        const auto text = write_bpt(*d);
        EXPECT_FALSE(text) << object;
        if (text) return Refusal{};
        EXPECT_EQ(text.error().kind, RefusalKind::no_answer);
        return text.error();
    };
    EXPECT_EQ(refused(R"({"type": "curve", "name": "c", "points": [[0,0,0],[1,0,0]]})").where,
              "objects[1] \"c\"");
    EXPECT_NE(
        refused(R"({"type": "surface", "points": [[[0,0],[1,0]],[[0,1],[1,1]]]})").message.find("in space"),
        std::string::npos);
    EXPECT_NE(
        refused(
            R"({"type": "surface", "points": [[[0,0,0],[1,0,0]],[[0,1,0],[1,1,0]]], "weights": [[1,1],[1,2]]})")
            .message.find("weights"),
        std::string::npos);
    EXPECT_NE(refused(R"({"type": "surface", "degrees": [1,1], "knots": [[0,0,1,2,2],[0,0,1,1]],
                          "points": [[[0,0,0],[1,0,0]],[[0,1,0],[1,1,0]],[[0,2,0],[1,2,0]]]})")
                  .message.find("--to-bezier"),
              std::string::npos);
}

// The numbers that are known of the teapot of 1975.
void expect_teapot(const Document& d) {
    ASSERT_EQ(d.objects.size(), 32u);
    std::set<std::array<double, 3>> distinct;
    for (const Object& o : d.objects) {
        const auto& s = std::get<Surface<Vec<3>>>(o.shape);
        EXPECT_EQ(s.basis(0).degree(), 3);
        EXPECT_EQ(s.basis(1).degree(), 3);
        for (const Vec<3>& p : s.net().flat()) distinct.insert(p.c);
    }
    EXPECT_EQ(distinct.size(), 290u);  // of the 306 numbered ones, some are at the same place
}

TEST(Bpt, the_example_is_the_teapot) {
    const auto d = read_any(std::string(FREIFORM_SOURCE_DIR) + "/examples/teapot.bpt");
    ASSERT_TRUE(d) << d.error().where << d.error().message;
    expect_teapot(*d);
}

TEST(Bpt, the_example_is_the_teapot_of_the_corpus) {
    FF_CORPUS_OR_SKIP(path, "bpt/teapot.bpt");
    const auto ours = read_any(std::string(FREIFORM_SOURCE_DIR) + "/examples/teapot.bpt"),
               theirs = read_any(path.string());
    ASSERT_TRUE(ours);
    ASSERT_TRUE(theirs) << theirs.error().where << theirs.error().message;
    EXPECT_EQ(write_document(*ours), write_document(*theirs));
}

TEST(Bpt, survives_damaged_files) {
    const std::string good = *write_bpt(*read_bpt("2\n" + kPlane.substr(2) + kPlane.substr(2)));
    std::mt19937 random(9);
    int accepted = 0;
    for (int i = 0; i < 5000; ++i) {
        const auto d = read_bpt(test::damaged(good, random));
        if (d) {
            ++accepted;
            EXPECT_TRUE(write_bpt(*d));
        } else {
            EXPECT_TRUE(d.error().where.starts_with("line ")) << d.error().where;
        }
    }
    EXPECT_GT(accepted, 0);
}

TEST(ReadAny, chooses_by_name_and_by_content) {
    EXPECT_EQ(format_of_name("/a.b/c.JSON"), FileFormat::json);
    EXPECT_EQ(format_of_name("x.stp"), FileFormat::step);
    EXPECT_EQ(format_of_name("x.IGS"), FileFormat::iges);
    EXPECT_EQ(format_of_name("x.bv"), FileFormat::bezierview);
    EXPECT_EQ(format_of_name("/a.json/x"), std::nullopt);
    EXPECT_EQ(format_of_content("\n {"), FileFormat::json);
    EXPECT_EQ(format_of_content("ISO-10303-21;\nHEADER;"), FileFormat::step);
    EXPECT_EQ(format_of_content("DBRep_DrawableShape\n\nCASCADE Topology V1"), FileFormat::brep);
    EXPECT_EQ(format_of_content(std::string(72, ' ') + "S      1\n"), FileFormat::iges);
    EXPECT_EQ(format_of_content("# teapot\n32\n"), FileFormat::bpt);
    EXPECT_EQ(format_of_content("hello"), std::nullopt);
    EXPECT_EQ(format_of_content(""), std::nullopt);
}

TEST(ReadAny, names_the_file_in_its_refusals) {
    const auto missing = read_any("/no/such/file.json");
    ASSERT_FALSE(missing);
    EXPECT_EQ(missing.error().kind, RefusalKind::io);
    EXPECT_EQ(missing.error().where, "/no/such/file.json");
    const std::string path = testing::TempDir() + "freiform_read_test.bpt";
    ASSERT_TRUE(write_file(path, "1\n1 1\n0 0 x\n"));
    const auto damaged = read_any(path);
    ASSERT_FALSE(damaged);
    EXPECT_EQ(damaged.error().where, path + ": line 3");
    ReadOptions tight;
    tight.max_bytes = 3;
    EXPECT_EQ(read_any(path, tight).error().kind, RefusalKind::limit);
    ::unlink(path.c_str());
}

}  // namespace
}  // namespace freiform
