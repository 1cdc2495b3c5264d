#include "support/corpus.hpp"

#include <freiform/io/document.hpp>
#include <freiform/io/file.hpp>
#include <freiform/io/quake3.hpp>
#include <freiform/io/scene.hpp>
#include <freiform/spline/bezier.hpp>

#include <cstring>
#include <gtest/gtest.h>

namespace freiform {
namespace {

// A level of a few faces, put together byte by byte.
struct Level {
    std::string textures, vertices, indices, faces;

    template <class T>
    static void put(std::string& s, T x) {
        s.append(reinterpret_cast<const char*>(&x), sizeof x);
    }
    void texture(std::string name) {
        name.resize(64);
        textures += name;
        put(textures, 0), put(textures, 0);
    }
    void vertex(Vec<3> p, Vec<3> n, std::uint8_t grey = 128) {
        for (int d = 0; d < 3; ++d) put(vertices, float(p[d]));
        for (int d = 0; d < 4; ++d) put(vertices, 0.0f);
        for (int d = 0; d < 3; ++d) put(vertices, float(n[d]));
        for (int d = 0; d < 3; ++d) put(vertices, grey);
        put(vertices, std::uint8_t(255));
    }
    void face(int type, int first, int count, int first_index, int indices_count, int width, int height,
              int texture = 0) {
        for (int x : {texture, -1, type, first, count, first_index, indices_count}) put(faces, x);
        for (int i = 0; i < 17; ++i) put(faces, 0);
        put(faces, width), put(faces, height);
    }
    // A grid over [x, x + (w - 1)] x [0, h - 1] with a bump, as the file has it: row by row.
    void grid(double x, int w, int h, double up = 1) {
        const int first = int(vertices.size() / 44);
        for (int j = 0; j < h; ++j)
            for (int i = 0; i < w; ++i)
                vertex({{x + i, double(j), double((i % 2) * (j % 2))}}, {{0, 0, up}},
                       std::uint8_t(10 * i + j));
        face(2, first, w * h, 0, 0, w, h);
    }
    std::string bytes() const {
        std::string s = "IBSP";
        put(s, 46);
        const std::string* lumps[17] = {};
        lumps[1] = &textures, lumps[10] = &vertices, lumps[11] = &indices, lumps[13] = &faces;
        std::string body;
        for (const std::string* l : lumps) {
            put(s, int(8 + 17 * 8 + body.size()));
            put(s, l ? int(l->size()) : 0);
            if (l) body += *l;
        }
        return s + body;
    }
};

const Surface<Vec<3>>& surface(const Object& o) { return std::get<Surface<Vec<3>>>(o.shape); }

TEST(R26, a_grid_is_made_of_biquadratic_pieces_with_common_boundaries) {
    Level level;
    level.texture("textures/base/wall");
    level.grid(0, 5, 3);
    const auto d = read_quake3_bsp(level.bytes());
    ASSERT_TRUE(d) << d.error().where << d.error().message;
    ASSERT_EQ(d->objects.size(), 1u);
    EXPECT_EQ(d->objects[0].name, "face 0");
    EXPECT_EQ(d->objects[0].material, "textures/base/wall");
    const auto& s = surface(d->objects[0]);
    EXPECT_EQ(s.basis(0).degree(), 2);
    EXPECT_EQ(s.basis(1).degree(), 2);
    const BezierPieces<2, Vec<3>> pieces(s);
    EXPECT_EQ(pieces.extent(), (Index<2>{2, 1}));
    for (int piece = 0; piece < 2; ++piece)
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) {
                const int x = 2 * piece + i;
                EXPECT_EQ(pieces.net({piece, 0})({i, j}),
                          (Vec<3>{{double(x), double(j), double((x % 2) * (j % 2))}}));
                EXPECT_EQ(d->objects[0].colours[std::size_t(3 * x + j)].r, (10 * x + j) / 255.0);
            }
    // The biquadratic polynomial at the middle of a piece: 1/16 of (1 2 1; 2 4 2; 1 2 1).
    EXPECT_EQ(s(0.5, 0.5), (Vec<3>{{1, 1, 0.25}}));
}

TEST(Quake3, the_normals_of_the_file_say_which_side_is_the_outer_one) {
    for (const double up : {1.0, -1.0}) {
        Level level;
        level.texture("t");
        level.grid(0, 3, 5, up);
        const auto d = read_quake3_bsp(level.bytes());
        ASSERT_TRUE(d);
        const auto j = surface(d->objects[0]).jet<1>({0.3, 0.4});
        EXPECT_GT(cross(j.d[1], j.d[2])[2] * up, 0);
    }
}

TEST(Quake3, a_large_grid_and_two_small_ones_beside_it_have_no_crack_between_them) {
    Level level;
    level.texture("t");
    level.grid(0, 5, 3);
    const int first = 15;
    for (int part = 0; part < 2; ++part) {  // below: the rows y = 0, -1, -2 in two grids
        const int at = first + 9 * part;
        for (int j = 0; j < 3; ++j)
            for (int i = 0; i < 3; ++i) level.vertex({{2.0 * part + i, -double(j), 0.0}}, {{0, 0, 1}});
        level.face(2, at, 9, 0, 0, 3, 3);
    }
    const auto d = read_quake3_bsp(level.bytes());
    ASSERT_TRUE(d);
    const auto model = scene_of(*d);
    ASSERT_TRUE(model);
    // Sides: 2 x (2 + 1) of the large grid, and 4 + 4 - 1 of the small ones, of which 2 are common.
    EXPECT_EQ(model->edges.size(), 6u + 7u - 2u);
}

TEST(Quake3, flat_faces_become_triangles_that_look_where_their_normals_look) {
    Level level;
    level.texture("floor");
    for (const Vec<3>& p : {Vec<3>{{0, 0, 0}}, Vec<3>{{4, 0, 0}}, Vec<3>{{4, 4, 0}}, Vec<3>{{0, 4, 0}}})
        level.vertex(p, {{0, 0, 1}});
    for (int i : {0, 2, 1, 0, 2, 3, 1, 1, 2}) Level::put(level.indices, i);
    level.face(1, 0, 4, 0, 9, 0, 0);
    const auto d = read_quake3_bsp(level.bytes());
    ASSERT_TRUE(d) << d.error().message;
    ASSERT_EQ(d->objects.size(), 2u);  // the third has no area
    for (const Object& o : d->objects) {
        const auto& t = std::get<Triangle<Vec<3>>>(o.shape);
        EXPECT_EQ(t.degree(), 1);
        EXPECT_GT(
            cross(t.coefficient(1, 0) - t.coefficient(0, 0), t.coefficient(0, 1) - t.coefficient(0, 0))[2],
            0);
        EXPECT_EQ(o.material, "floor");
    }
    const auto model = scene_of(*d);
    ASSERT_TRUE(model);
    EXPECT_EQ(model->edges.size(), 5u);
}

TEST(Quake3, materials_and_colours_survive_the_document) {
    Level level;
    level.texture("a \"b\"");
    level.grid(0, 3, 3);
    const auto d = read_quake3_bsp(level.bytes());
    ASSERT_TRUE(d);
    const auto again = read_document(write_document(*d));
    ASSERT_TRUE(again) << again.error().where << ": " << again.error().message;
    EXPECT_EQ(again->objects[0].material, d->objects[0].material);
    EXPECT_EQ(again->objects[0].colours, d->objects[0].colours);
    EXPECT_EQ(surface(again->objects[0]), surface(d->objects[0]));
    const auto wrong =
        read_document(R"({"type": "curve", "points": [[0, 0], [1, 1]], "colours": [[1, 0, 0]]})");
    ASSERT_FALSE(wrong);
    EXPECT_EQ(wrong.error().where, "colours");
}

TEST(Quake3, damaged_levels_are_refused_with_the_place) {
    Level good;
    good.texture("t");
    good.grid(0, 3, 3);
    const std::string bytes = good.bytes();
    for (std::size_t n = 0; n < bytes.size(); ++n)
        EXPECT_FALSE(read_quake3_bsp(std::string_view(bytes).substr(0, n)));
    const auto changed = [&](auto&& change) {
        Level level = good;
        change(level);
        auto d = read_quake3_bsp(level.bytes());
        return d ? std::string("read") : d.error().where;
    };
    const auto number = [](std::string& s, std::size_t at, std::int32_t x) { std::memcpy(&s[at], &x, 4); };
    EXPECT_EQ(changed([&](Level& l) { number(l.faces, 0, 7); }), "faces[0].texture");
    EXPECT_EQ(changed([&](Level& l) { number(l.faces, 8, 9); }), "faces[0].type");
    EXPECT_EQ(changed([&](Level& l) { number(l.faces, 12, -1); }), "faces[0].vertices");
    EXPECT_EQ(changed([&](Level& l) { number(l.faces, 16, 0x7fffffff); }), "faces[0].vertices");
    EXPECT_EQ(changed([&](Level& l) { number(l.faces, 96, 4); }), "faces[0].grid");
    EXPECT_EQ(changed([&](Level& l) { number(l.vertices, 44, 0x7fc00000); }), "faces[0].vertices[1]");
    EXPECT_EQ(changed([&](Level& l) { l.faces += "x"; }), "lump 13");
    std::string old = bytes;
    number(old, 4, 38);
    EXPECT_EQ(read_quake3_bsp(old).error().kind, RefusalKind::unsupported);
    EXPECT_EQ(read_quake3_bsp("IBSP").error().where, "header");
}

constexpr std::string_view kMap = R"(// a remark
{
"classname" "worldspawn"
{
patchDef2
{
base/arch
( 3 3 0 0 0 )
(
( ( 0 0 0 0 0 ) ( 0 1 0 0 0 ) ( 0 2 0 0 0 ) )
( ( 1 0 1.5 0 0 ) ( 1 1 1.5 0 0 ) ( 1 2 1.5 0 0 ) )
( ( 2 0 0 0 0 ) ( 2 1 0 0 0 ) ( 2 2 0 0 0 ) )
)
}
}
{
( 0 0 0 ) ( 1 0 0 ) ( 0 1 0 ) base/floor 0 0 0 1 1 0 0 0
}
}
)";

TEST(Quake3, patches_of_a_map_are_read_and_walls_of_planes_passed_over) {
    const auto d = read_quake3_map(kMap);
    ASSERT_TRUE(d) << d.error().where << ": " << d.error().message;
    ASSERT_EQ(d->objects.size(), 1u);
    EXPECT_EQ(d->objects[0].name, "entity 0 brush 0");
    EXPECT_EQ(d->objects[0].material, "base/arch");
    EXPECT_TRUE(d->objects[0].colours.empty());
    EXPECT_EQ(surface(d->objects[0])(0.5, 0.5), (Vec<3>{{1, 1, 0.75}}));
}

TEST(Quake3, damaged_maps_are_refused_with_the_line) {
    for (std::size_t n = 0; n + 2 < kMap.size(); ++n) EXPECT_FALSE(read_quake3_map(kMap.substr(0, n))) << n;
    const auto changed = [](std::string_view from, std::string_view to) {
        std::string s(kMap);
        s.replace(s.find(from), from.size(), to);
        const auto d = read_quake3_map(s);
        return d ? std::string("read") : d.error().where;
    };
    EXPECT_EQ(changed("( 3 3 0 0 0 )", "( 4 3 0 0 0 )"), "line 8");
    EXPECT_EQ(changed("( 3 3 0 0 0 )", "( 3 999 0 0 0 )"), "line 8");
    EXPECT_EQ(changed("( 3 3 0 0 0 )", "( 3 -3 0 0 0 )"), "line 8");
    EXPECT_EQ(changed("1.5", "nan"), "line 11");
    EXPECT_EQ(changed("patchDef2", "patchDef3"), "line 8");
    EXPECT_EQ(read_quake3_map("{ { ( 0 0 0 ) } }").error().kind, RefusalKind::no_answer);
}

TEST(Quake3, levels_of_a_free_game_have_the_patches_that_they_are_known_to_have) {
    struct Known {
        const char* file;
        int patches;
    };
    for (const Known& k : {Known{"q3bsp/oa_ctf2.bsp", 42},
                           {"q3bsp/oa_dm5.bsp", 124},
                           {"q3bsp/ps37ctf.bsp", 21},
                           {"q3bsp/slimefac.bsp", 77}}) {
        FF_CORPUS_OR_SKIP(path, k.file);
        const auto bytes = read_file(path.string(), 1 << 24);
        ASSERT_TRUE(bytes);
        const auto d = read_quake3_bsp(*bytes);
        ASSERT_TRUE(d) << k.file << ": " << d.error().where << ": " << d.error().message;
        int patches = 0;
        for (const Object& o : d->objects) patches += std::holds_alternative<Surface<Vec<3>>>(o.shape);
        EXPECT_EQ(patches, k.patches) << k.file;
    }
}

TEST(Quake3, two_patches_of_a_map_share_their_seam) {
    FF_CORPUS_OR_SKIP(path, std::string_view("q3map/patch_seam.map"));
    const auto bytes = read_file(path.string(), 1 << 24);
    ASSERT_TRUE(bytes);
    const auto d = read_quake3_map(*bytes);
    ASSERT_TRUE(d);
    const auto model = scene_of(*d);
    ASSERT_TRUE(model);
    EXPECT_EQ(model->faces.size(), 2u);
    EXPECT_EQ(model->edges.size(), 7u);
}

}  // namespace
}  // namespace freiform
