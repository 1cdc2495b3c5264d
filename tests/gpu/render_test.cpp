#include "support/test_meshes.hpp"

#include <freiform/gpu/render.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <gtest/gtest.h>
#include <numbers>

namespace freiform {
namespace {

class Render : public testing::Test {
protected:
    void SetUp() override {
        options_.width = 400;
        options_.height = 300;
        const auto r = render(TriangleMesh{}, options_);
        if (!r && r.error().kind == RefusalKind::unavailable) GTEST_SKIP() << r.error().message;
        ASSERT_TRUE(r) << r.error().message;
        background_ = *r;
    }
    Image picture(const TriangleMesh& mesh) const {
        auto r = render(mesh, options_);
        EXPECT_TRUE(r) << (r ? "" : r.error().message);
        return r.value_or(background_);
    }
    // Sum of the differences of the three components.
    int from_background(const Image& image, int x, int y) const {
        int sum = 0;
        for (int c = 0; c < 3; ++c)
            sum += std::abs(int(image.pixel(x, y)[c]) - int(background_.pixel(x, y)[c]));
        return sum;
    }
    struct Extent {
        int left = 1 << 20, right = -1, top = 1 << 20, bottom = -1, pixels = 0;
    };
    Extent drawn(const Image& image, int threshold = 60) const {
        Extent e;
        for (int y = 0; y < image.height; ++y)
            for (int x = 0; x < image.width; ++x) {
                if (from_background(image, x, y) <= threshold) continue;
                e.left = std::min(e.left, x), e.right = std::max(e.right, x);
                e.top = std::min(e.top, y), e.bottom = std::max(e.bottom, y);
                ++e.pixels;
            }
        return e;
    }
    static int brightness(const unsigned char* p) { return p[0] + p[1] + p[2]; }

    RenderOptions options_;
    Image background_;
};

double linear(unsigned char c) { return std::pow(c / 255.0, 2.2); }

int largest_difference(const Image& a, const Image& b) {
    int largest = a.rgb.size() == b.rgb.size() ? 0 : 1000;
    for (std::size_t i = 0; i < std::min(a.rgb.size(), b.rgb.size()); ++i)
        largest = std::max(largest, std::abs(int(a.rgb[i]) - int(b.rgb[i])));
    return largest;
}

// A square in the plane of two axes, with a red triangle near its corner at + +.
TriangleMesh marked_square(int i, int j) {
    TriangleMesh mesh;
    const auto add = [&](double a, double b) {
        Vec<3> p;
        p[i] = a, p[j] = b;
        mesh.vertices.push_back({int(mesh.points.size()), {}, {}});
        mesh.points.push_back(p);
    };
    add(-1, -1), add(1, -1), add(1, 0.5), add(0.5, 1), add(-1, 1), add(1, 1);
    mesh.triangles = {{0, 1, 2}, {0, 2, 3}, {0, 3, 4}, {2, 5, 3}};
    mesh.parts = {{"", std::nullopt, 0, 3, 0}, {"red", Colour{1, 0, 0, 1}, 3, 1, 1}};
    return mesh;
}

TEST_F(Render, background_is_the_gradient) {
    const std::array top{options_.top.r, options_.top.g, options_.top.b};
    const std::array bottom{options_.bottom.r, options_.bottom.g, options_.bottom.b};
    for (std::size_t c = 0; c < 3; ++c) {
        EXPECT_NEAR(background_.pixel(0, 0)[c], 255 * top[c], 1);
        EXPECT_NEAR(background_.pixel(399, 299)[c], 255 * bottom[c], 1);
        EXPECT_EQ(background_.pixel(0, 150)[c], background_.pixel(399, 150)[c]);
    }
}

TEST_F(Render, silhouette_of_a_sphere_is_a_disc) {
    for (const bool perspective : {false, true}) {
        options_.perspective = perspective;
        const Image image = picture(test::sphere(60, 120));
        const Extent e = drawn(image);
        const double diameter = 300 * (1 - 2 * options_.margin);
        EXPECT_NEAR(e.pixels, std::numbers::pi / 4 * diameter * diameter, 0.01 * e.pixels);
        EXPECT_NEAR(e.left + e.right, 399, 1);
        EXPECT_NEAR(e.top + e.bottom, 299, 1);
        EXPECT_NEAR(e.right - e.left + 1, diameter, 2);
        // Outside of it nothing is touched at all.
        for (int y = 0; y < 300; ++y)
            for (int x = 0; x < 400; ++x)
                if (std::hypot(x - 199.5, y - 149.5) > diameter / 2 + 2) {
                    ASSERT_EQ(from_background(image, x, y), 0);
                }
    }
}

TEST_F(Render, shading_follows_the_normals) {
    const Image image = picture(test::sphere(16, 32));
    const int lit = brightness(image.pixel(150, 90)), middle = brightness(image.pixel(200, 150)),
              dark = brightness(image.pixel(230, 270));
    EXPECT_GT(lit, middle + 10);
    EXPECT_GT(middle, dark + 60);
    // Smooth: no step between neighbours, where flat triangles would show some.
    int step = 0;
    for (int x = 90; x < 310; ++x)
        step =
            std::max(step, std::abs(brightness(image.pixel(x, 150)) - brightness(image.pixel(x + 1, 150))));
    EXPECT_LE(step, 9);
}

TEST_F(Render, views_show_their_side_and_its_colour) {
    options_.outlines = false;
    const std::pair<const char*, Colour> sides[] = {
        {"top", {0, 0, 1, 1}},    {"front", {1, 0, 0, 1}},       {"back", {0, 1, 0, 1}},
        {"left", {1, 0.5, 0, 1}}, {"right", {0.2, 0.4, 0.6, 1}}, {"bottom", options_.colour}};
    for (const auto& [name, colour] : sides) {
        options_.view = *parse_view(name);
        const Image image = picture(test::cube());
        const unsigned char* p = image.pixel(200, 150);
        const std::array expected{std::pow(colour.r, 2.2), std::pow(colour.g, 2.2), std::pow(colour.b, 2.2)};
        const double light =
            (linear(p[0]) + linear(p[1]) + linear(p[2])) / (expected[0] + expected[1] + expected[2]);
        EXPECT_GT(light, 0.25) << name;
        for (std::size_t c = 0; c < 3; ++c) EXPECT_NEAR(linear(p[c]) / light, expected[c], 0.06) << name << c;
        const Extent e = drawn(image);
        EXPECT_NEAR(e.right - e.left + 1, 276, 2) << name;
        EXPECT_NEAR(e.bottom - e.top + 1, 276, 2) << name;
    }
}

TEST_F(Render, views_are_the_right_way_round) {
    options_.outlines = false;
    struct Case {
        const char* view;
        int i, j, x, y;  // the corner + + of the plane i, j is seen at this side of the picture
    };
    for (const Case& c : {Case{"front", 0, 2, 1, -1}, Case{"back", 0, 2, -1, -1}, Case{"right", 1, 2, 1, -1},
                          Case{"left", 1, 2, -1, -1}, Case{"top", 0, 1, 1, -1}, Case{"bottom", 0, 1, 1, 1},
                          Case{"-90,0", 0, 2, 1, -1}}) {
        options_.view = *parse_view(c.view);
        const Image image = picture(marked_square(c.i, c.j));
        const unsigned char* p = image.pixel(200 + c.x * 120, 150 + c.y * 120);
        EXPECT_GT(p[0], 120) << c.view;
        EXPECT_LT(p[1], 90) << c.view;
        const unsigned char* q = image.pixel(200 - c.x * 120, 150 - c.y * 120);
        EXPECT_GT(q[1], 90) << c.view;
    }
}

TEST_F(Render, nearer_faces_hide_farther_ones_and_outlines_are_drawn_on_them) {
    const Image plain = picture(test::cube());
    const Extent e = drawn(plain);
    EXPECT_LT(brightness(plain.pixel(200, 220)), 120);  // the vertical edge in front
    EXPECT_GT(plain.pixel(200, 100)[2], 200);           // the one behind is hidden
    EXPECT_LT(plain.pixel(200, 100)[0], 40);
    options_.edges = true;
    const Image lined = picture(test::cube());
    EXPECT_EQ(drawn(lined).pixels, e.pixels);
    EXPECT_GT(largest_difference(plain, lined), 30);  // the diagonals
    options_.edges = options_.outlines = false;
    EXPECT_GT(brightness(picture(test::cube()).pixel(200, 220)), 120);
}

TEST_F(Render, sides_between_triangles_of_one_flat_area_are_no_borders) {
    options_.view = *parse_view("top");
    const auto square = [](const char* first, const char* second, double corner) {
        TriangleMesh mesh;
        const std::array<Vec<3>, 4> p{{{{-1, -1, 0}}, {{1, -1, 0}}, {{1, 1, 0}}, {{-1, 1, corner}}}};
        mesh.points.assign(p.begin(), p.end());
        for (const int i : {0, 1, 2, 0, 2, 3}) mesh.vertices.push_back({i, {}, {}});
        mesh.triangles = {{0, 1, 2}, {3, 4, 5}};
        mesh.parts = {{first, std::nullopt, 0, 1, 0}, {second, std::nullopt, 1, 1, 1}};
        return mesh;
    };
    const auto dark = [&](const TriangleMesh& mesh) {
        return brightness(picture(mesh).pixel(200, 149)) < 200;  // on the diagonal
    };
    EXPECT_FALSE(dark(square("face 7", "face 7", 0)));
    EXPECT_TRUE(dark(square("face 7", "face 8", 0)));
    EXPECT_TRUE(dark(square("", "", 0)));
    EXPECT_TRUE(dark(square("face 7", "face 7", 0.3))) << "not flat";
}

TEST_F(Render, size_and_place_of_the_model_play_no_part) {
    options_.edges = true;
    const TriangleMesh mesh = test::torus(40, 20);
    const Image image = picture(mesh);
    for (int e : {-1000, -30, 30, 1000}) {
        TriangleMesh scaled = mesh;
        for (Vec<3>& p : scaled.points)
            for (double& x : p.c) x = std::scalbn(x, e);
        EXPECT_EQ(picture(scaled).rgb, image.rgb) << e;
    }
    TriangleMesh moved = mesh;
    for (Vec<3>& p : moved.points) p += Vec<3>{{1e9, -1e9, 1e9}};
    const Image far = picture(moved);
    int different = 0;
    for (std::size_t i = 0; i < image.rgb.size(); ++i)
        different += std::abs(int(far.rgb[i]) - int(image.rgb[i])) > 40;
    EXPECT_LT(different, 300);
}

TEST_F(Render, orientation_plays_no_part) {
    const TriangleMesh mesh = test::torus(60, 30);
    TriangleMesh turned = mesh;
    for (auto& t : turned.triangles) std::swap(t[1], t[2]);
    EXPECT_LE(largest_difference(picture(mesh), picture(turned)), 2);
    for (MeshVertex& v : turned.vertices) v.normal = -v.normal;
    EXPECT_LE(largest_difference(picture(mesh), picture(turned)), 2);
}

TEST_F(Render, without_normals_triangles_are_flat) {
    TriangleMesh mesh = test::cube();
    const Image image = picture(mesh);
    for (MeshVertex& v : mesh.vertices) v.normal = {};
    EXPECT_LE(largest_difference(picture(mesh), image), 2);
    TriangleMesh coarse = test::torus(12, 6);
    const Image smooth = picture(coarse);
    for (MeshVertex& v : coarse.vertices) v.normal = {};
    EXPECT_GT(largest_difference(picture(coarse), smooth), 30);
}

TEST_F(Render, picture_stays_within_the_margin) {
    for (const bool perspective : {false, true})
        for (const auto& [azimuth, elevation] :
             {std::pair(0.3, 0.2), std::pair(2.0, -1.0), std::pair(-2.5, 1.5)}) {
            options_.perspective = perspective;
            options_.view = {azimuth, elevation};
            options_.outlines = false;
            const Extent e = drawn(picture(test::cube()), 20);
            const int margin = int(300 * options_.margin);
            EXPECT_GE(std::min(e.left, e.top), margin - 1);
            EXPECT_LE(std::max(e.right - 100, e.bottom), 300 - margin);
            EXPECT_TRUE(e.bottom - e.top >= 273 || e.right - e.left >= 373) << azimuth;
        }
}

TEST_F(Render, pixels_are_as_long_as_is_said) {
    for (const double k : {1e-3, 1.0, 700.0}) {
        TriangleMesh ball = test::sphere(60, 120);
        for (Vec<3>& p : ball.points) p = k * p + Vec<3>{{k, 0, 5 * k}};
        options_.outlines = false;
        const Extent e = drawn(picture(ball), 20);
        EXPECT_NEAR((e.bottom - e.top + 1) * pixel_size(ball, options_), 2 * k, 0.02 * k);
        options_.perspective = true;
        EXPECT_LT(pixel_size(ball, options_), 2 * k / (e.bottom - e.top));
        options_.perspective = false;
    }
    // A rod from above is as wide as the picture, however long it is.
    TriangleMesh rod = test::sphere(20, 40);
    for (Vec<3>& p : rod.points) p[2] *= 1000;
    const double across = pixel_size(rod, options_);
    options_.view = {0, std::numbers::pi / 2};
    EXPECT_LT(pixel_size(rod, options_), across / 500);
    EXPECT_EQ(pixel_size({}, options_), 0);
}

TEST_F(Render, zebra_shows_stripes) {
    options_.zebra = true;
    const Image image = picture(test::sphere(60, 120));
    int changes = 0;
    for (int y = 15; y < 284; ++y)
        changes += (image.pixel(200, y)[0] > 128) != (image.pixel(200, y + 1)[0] > 128);
    EXPECT_GE(changes, 16);
}

TEST_F(Render, flat_and_edge_on_models_are_no_danger) {
    options_.edges = true;
    options_.view = *parse_view("front");
    EXPECT_GT(drawn(picture(marked_square(0, 1))).pixels, 100);  // a line
    TriangleMesh point;
    point.points = {{{1, 2, 3}}};
    point.vertices = {{0, {}, {}}};
    point.triangles = {{0, 0, 0}};
    EXPECT_EQ(drawn(picture(point)).pixels, 0);
}

TEST(RenderRefusals, name_the_option) {
    const auto where = [](const RenderOptions& o) {
        const auto r = render(test::cube(), o);
        return r ? std::string() : r.error().where;
    };
    EXPECT_EQ(where({.width = 0}), "size");
    EXPECT_EQ(where({.height = 20000}), "size");
    EXPECT_EQ(where({.view = {NAN, 0}}), "view");
    EXPECT_EQ(where({.supersampling = 5}), "supersampling");
    EXPECT_EQ(where({.margin = 0.5}), "margin");
    EXPECT_EQ(where({.colour = {2, 0, 0, 1}}), "colour");
    TriangleMesh broken = test::cube();
    broken.triangles[2][1] = 99;
    EXPECT_EQ(render(broken).error().where, "triangles[2]");
}

TEST(ParseView, takes_names_and_angles) {
    EXPECT_NEAR(parse_view("30,-45")->azimuth, std::numbers::pi / 6, 1e-15);
    EXPECT_NEAR(parse_view("30,-45")->elevation, -std::numbers::pi / 4, 1e-15);
    for (const char* bad : {"", "side", "30", "30,", ",30", "30,40,50", "nan,0", "0,91", "inf,0", "30;40"})
        EXPECT_FALSE(parse_view(bad)) << bad;
}

TEST(Png, has_the_size_of_the_image) {
    Image image{3, 2, std::vector<unsigned char>(18, 200)};
    const auto png = to_png(image);
    ASSERT_TRUE(png);
    EXPECT_EQ(png->substr(0, 8), "\x89PNG\r\n\x1a\n");
    EXPECT_EQ(png->substr(12, 12), std::string("IHDR\0\0\0\3\0\0\0\2", 12));
    EXPECT_EQ(png->substr(png->size() - 8, 4), "IEND");
    image.rgb.pop_back();
    EXPECT_FALSE(to_png(image));
}

}  // namespace
}  // namespace freiform
