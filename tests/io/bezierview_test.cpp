#include <freiform/io/bezierview.hpp>
#include <freiform/io/read.hpp>

#include <array>
#include <gtest/gtest.h>
#include <random>
#include <support/corpus.hpp>
#include <support/damaged_text.hpp>

namespace freiform {
namespace {

Document read_or_die(std::string_view text) {
    auto d = read_bezierview(text);
    EXPECT_TRUE(d) << d.error().where << ": " << d.error().message;
    return d ? std::move(*d) : Document{};
}

TEST(BezierView, patches_have_their_second_index_fastest) {
    const Document d =
        read_or_die("5\n1 2\n0 0 0 0 1 0 0 2 0 1 0 0 1 1 5\n1 2 0\r\n4 1 0 0 0 0 1 0 1 0 0 1 1 0");
    ASSERT_EQ(d.objects.size(), 2u);
    const auto& s = std::get<Surface<Vec<3>>>(d.objects[0].shape);
    EXPECT_EQ(s.basis(0).degree(), 1);
    EXPECT_EQ(s.basis(1).degree(), 2);
    EXPECT_EQ(s.net().view()({1, 1}), (Vec<3>{{1, 1, 5}}));
    EXPECT_EQ(s.net().view()({0, 2}), (Vec<3>{{0, 2, 0}}));
    const auto& t = std::get<Surface<Vec<3>>>(d.objects[1].shape);
    EXPECT_EQ(t.basis(1).degree(), 1);
    EXPECT_EQ(t.net().view()({1, 0}), (Vec<3>{{1, 0, 0}}));
}

TEST(BezierView, weights_are_in_the_coordinates_already) {
    const Document d = read_or_die("8 1 1\n0 0 0 1\n0 2 0 2\n1 0 0 1\n2 2 2 2\n");
    const auto& s = std::get<Surface<Hom<3>>>(d.objects.at(0).shape);
    EXPECT_EQ(s.net().view()({1, 1}), (Hom<3>{{2, 2, 2, 2}}));
    EXPECT_EQ(s(1, 1), (Vec<3>{{1, 1, 1}}));
}

// Points of a plane at the places that the format draws: rows from one side to the corner opposite.
TEST(BezierView, triangles_keep_their_shape_and_their_sense) {
    for (const int n : {1, 2, 3, 5}) {
        std::string text = "3 " + std::to_string(n) + "\n";
        for (int row = 0; row <= n; ++row)
            for (int i = 0; i + row <= n; ++i) text += std::to_string(i) + " " + std::to_string(row) + " 0\n";
        const Document d = read_or_die(text);
        const auto& t = std::get<Triangle<Vec<3>>>(d.objects.at(0).shape);
        ASSERT_EQ(t.degree(), n);
        // Linear in the parameters only if every point is in its place.
        const Vec<3> a = t(0, 0), b = t(1, 0), c = t(0, 1);
        for (const auto& [u, v] : {std::array{0.25, 0.5}, std::array{0.5, 0.125}, std::array{0.125, 0.25}}) {
            const Vec<3> expected = (1 - u - v) * a + u * b + v * c, is = t(u, v);
            EXPECT_NEAR(is[0], expected[0], 1e-12) << n;
            EXPECT_NEAR(is[1], expected[1], 1e-12) << n;
        }
        EXPECT_NEAR(cross(b - a, c - a)[2], n * n, 1e-12);
    }
}

TEST(BezierView, polyhedra_become_patches_and_what_has_more_corners_is_told) {
    const Document d = read_or_die(
        "1\n5 4\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n0.5 0.5 1\n4 0 3 2 1\n3 0 1 4\n5 0 1 2 3 4\n3 1 2 4\n");
    ASSERT_EQ(d.objects.size(), 3u);
    const auto& quad = std::get<Surface<Vec<3>>>(d.objects[0].shape);
    // Corners 0, 3, 2, 1 in this order around it.
    EXPECT_EQ(quad(0, 0), (Vec<3>{{0, 0, 0}}));
    EXPECT_EQ(quad(1, 0), (Vec<3>{{0, 1, 0}}));
    EXPECT_EQ(quad(1, 1), (Vec<3>{{1, 1, 0}}));
    EXPECT_EQ(quad(0, 1), (Vec<3>{{1, 0, 0}}));
    const auto& t = std::get<Triangle<Vec<3>>>(d.objects[1].shape);
    EXPECT_EQ(t.coefficients()[2], (Vec<3>{{0.5, 0.5, 1}}));
    ASSERT_EQ(d.left_out.size(), 1u);
    EXPECT_EQ(d.left_out[0].where, "line 10");
    EXPECT_NE(d.left_out[0].message.find("5 corners"), std::string::npos);
}

TEST(BezierView, groups_name_what_follows_and_normals_are_left_out) {
    const Document d = read_or_die(
        "group 3 the lid \n4 1\n0 0 0 0 1 0 1 0 0 1 1 0\n9 1 0\n0 0 0 1 0 0 0 1 0\n0 0 1\ngroup 4\n"
        "10 1 1 0 1\n0 0 0 0 1 0 1 0 0 1 1 0\n0 0 1 0 0 1\n");
    ASSERT_EQ(d.objects.size(), 3u);
    EXPECT_EQ(d.objects[0].name, "the lid");
    EXPECT_EQ(d.objects[1].name, "the lid");
    EXPECT_EQ(d.objects[2].name, "");
    ASSERT_EQ(d.left_out.size(), 1u);
    EXPECT_NE(d.left_out[0].message.find("of 2 patches"), std::string::npos);
}

TEST(BezierView, names_the_line_of_every_fault) {
    struct Case {
        std::string text, where, message;
    };
    for (const Case& c :
         {Case{"", "line 1", "is empty"},
          {"\n x", "line 2", "expected the kind"},
          {"2\n", "line 1", "of kind 2; known are"},
          {"5\n3\n", "line 3", "ends where a degree"},
          {"4 26", "line 1", "degree 26 is outside 0..25"},
          {"3\n-1", "line 2", "degree -1 is outside"},
          {"4 1\n0 0 0\n0 0 nan\n", "line 3", "coordinate of point 2 of 4, found \"nan\""},
          {"4 1\n0 0 0\n0 0", "line 3", "ends where a coordinate of point 2 of 4"},
          {"\n8 0 0\n1 1 1 0", "line 2", "weight"},
          {"1\n3 1000000000\n0 0 0 1 0 0 0 1 0\n", "line 1", "1000000000 polygons are announced"},
          {"1\n-1 1\n", "line 1", "-1 points"},
          {"1 3 1\n0 0 0\n1 0 0\n0 1 0\n3 0 1 3", "line 5", "corner 3 is outside 0..2"},
          {"1 3 1\n0 0 0\n1 0 0\n0 1 0\n2 0 1", "line 5", "has 2 corners"},
          {"group x", "line 1", "the number of a group"},
          {"4 1\n0 0 0 0 1 0 1 0 0 1 1 0 7", "line 2", "of kind 7"}}) {
        const auto d = read_bezierview(c.text);
        ASSERT_FALSE(d) << c.text;
        EXPECT_EQ(d.error().kind, RefusalKind::unreadable) << c.text;
        EXPECT_EQ(d.error().where, c.where) << c.text << d.error().message;
        EXPECT_NE(d.error().message.find(c.message), std::string::npos) << d.error().message;
    }
}

TEST(BezierView, survives_damaged_files) {
    const std::string good =
        "group 1 a\n5 1 1\n0 0 0 0 1 0 1 0 0 1 1 0\n3 1\n0 0 0 1 0 0 0 1 0\n1 3 1\n0 0 0 1 0 0 0 1 0\n3 0 1 "
        "2\n";
    std::mt19937 random(9);
    int accepted = 0;
    for (int i = 0; i < 5000; ++i) {
        const auto d = read_bezierview(test::damaged(good, random));
        accepted += d.has_value();
        if (!d) EXPECT_TRUE(d.error().where.starts_with("line ")) << d.error().where;
    }
    EXPECT_GT(accepted, 0);
}

TEST(BezierView, the_sphere_of_the_corpus_is_one) {
    FF_CORPUS_OR_SKIP(path, "bv/sphere.bv");
    const auto d = read_any(path.string());
    ASSERT_TRUE(d) << d.error().where << d.error().message;
    ASSERT_EQ(d->objects.size(), 24u);
    for (const Object& o : d->objects) {
        const auto& s = std::get<Surface<Hom<3>>>(o.shape);
        for (const auto& [u, v] : {std::array{0.25, 0.5}, std::array{1.0, 0.0}, std::array{0.75, 0.125}})
            EXPECT_NEAR(norm(s(u, v)), 1, 1e-9);  // its numbers have ten digits
    }
}

TEST(BezierView, every_file_of_the_corpus_is_read) {
    FF_CORPUS_OR_SKIP(folder, "bv");
    for (const auto& [name, objects] :
         {std::pair{"cube", 6}, {"hex", 6}, {"teapot", 32}, {"tp2x1", 1}, {"tri1", 3}, {"venus", 1418}}) {
        const auto d = read_any((folder / (std::string(name) + ".bv")).string());
        ASSERT_TRUE(d) << d.error().where << d.error().message;
        EXPECT_EQ(d->objects.size(), std::size_t(objects)) << name;
        EXPECT_TRUE(d->left_out.empty()) << name;
    }
}

}  // namespace
}  // namespace freiform
