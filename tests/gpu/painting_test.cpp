#include "support/test_meshes.hpp"

#include <freiform/gpu/render.hpp>

#include <cmath>
#include <gtest/gtest.h>

namespace freiform {
namespace {

class PaintedSurface : public testing::Test {
protected:
    void SetUp() override {
        options_.width = 300, options_.height = 300;
        options_.outlines = false;
        options_.view = *parse_view("front");
        const auto r = render(TriangleMesh{}, options_);
        if (!r && r.error().kind == RefusalKind::unavailable) GTEST_SKIP() << r.error().message;
        mesh_ = test::sphere(40, 80);
        for (const MeshVertex& v : mesh_.vertices) height_.push_back(mesh_.points[std::size_t(v.point)][2]);
    }
    Image picture() const {
        auto r = render(mesh_, options_);
        EXPECT_TRUE(r) << (r ? "" : r.error().message);
        return r.value_or(Image{300, 300, std::vector<unsigned char>(3 * 300 * 300)});
    }
    static Colour at(const Image& image, int x, int y) {
        const unsigned char* p = image.pixel(x, y);
        return {p[0] / 255.0, p[1] / 255.0, p[2] / 255.0, 1};
    }
    // a and b of Oklab, which light changes little.
    static double hue_distance(const Colour& p, const Colour& q) {
        const Oklab a = to_oklab(p), b = to_oklab(q);
        return std::hypot(a.a / a.L - b.a / b.L, a.b / a.L - b.b / b.L);
    }
    RenderOptions options_;
    TriangleMesh mesh_;
    std::vector<double> height_;
};

TEST_F(PaintedSurface, has_the_colours_of_the_map_where_the_field_says) {
    options_.field = height_;
    for (const auto& [painting, kind] : {std::pair(Painting::sequential, MapKind::sequential),
                                         std::pair(Painting::diverging, MapKind::diverging)}) {
        options_.painting = painting;
        options_.range = {-1, 1};
        const Image image = picture();
        const ColourMap map(kind);
        for (const int y : {30, 60, 100, 150, 200, 240, 270}) {
            const double z = (149.5 - y) / (150 * (1 - 2 * options_.margin));
            EXPECT_LT(hue_distance(at(image, 150, y), map(0.5 + 0.5 * z)), 0.05) << y;
        }
    }
}

TEST_F(PaintedSurface, takes_values_beyond_the_range_as_its_ends_and_none_as_grey) {
    options_.painting = Painting::sequential;
    options_.field = height_;
    options_.range = {-0.1, 0.1};
    const ColourMap map(MapKind::sequential);
    EXPECT_LT(hue_distance(at(picture(), 150, 80), map(1)), 0.05);
    EXPECT_LT(hue_distance(at(picture(), 150, 220), map(0)), 0.05);
    std::vector<double> none(height_.size(), NAN);
    options_.field = none;
    EXPECT_LT(hue_distance(at(picture(), 150, 80), kNoValue), 0.05);
    options_.range = {0, 0};
    EXPECT_TRUE(render(mesh_, options_)) << "a field of one value";
}

TEST_F(PaintedSurface, shows_normals_as_colours) {
    options_.painting = Painting::normals;
    const Image image = picture();  // seen from -y: x to the right, z up
    EXPECT_GT(at(image, 270, 150).r, at(image, 30, 150).r + 0.4);
    EXPECT_GT(at(image, 150, 30).b, at(image, 150, 270).b + 0.4);
    EXPECT_LT(at(image, 150, 150).g, 0.2);
}

TEST_F(PaintedSurface, isophotes_are_lines_and_leave_planes_alone) {
    const Image plain = picture();
    options_.isophotes = true;
    const Image lined = picture();
    int changes = 0;
    for (int y = 20; y < 280; ++y) {
        const auto dark = [&](int row) { return lined.pixel(150, row)[1] + 60 < plain.pixel(150, row)[1]; };
        changes += dark(y) != dark(y + 1);
    }
    EXPECT_GE(changes, 14);
    mesh_ = test::cube();
    const Image cube = picture();
    options_.isophotes = false;
    EXPECT_EQ(cube.rgb, picture().rgb);
}

TEST_F(PaintedSurface, lines_are_hidden_by_what_is_in_front_unless_they_are_to_shine_through) {
    RenderLines line{{{Vec<3>{{-0.9, 0, 0}}, Vec<3>{{0.9, 0, 0}}}}, {1, 0, 0, 1}, 4, 0};
    const auto redness = [](const Image& i, int x) { return i.pixel(x, 150)[0] - i.pixel(x, 150)[2]; };
    options_.lines = {&line, 1};
    EXPECT_LT(redness(picture(), 150), 20) << "inside of the sphere";
    line.behind = 0.5;
    EXPECT_GT(redness(picture(), 150), 60);
    line.segments[0][0][1] = line.segments[0][1][1] = -1.2;
    line.behind = 0;
    EXPECT_GT(redness(picture(), 150), 200) << "in front";
    line.segments = {{Vec<3>{{0, -1.2, 0}}, Vec<3>{{0, -1.2, 0}}}};
    line.width = 20;
    const Image dot = picture();
    EXPECT_GT(redness(dot, 157), 200);
    EXPECT_LT(redness(dot, 163), 50);
    EXPECT_LT(dot.pixel(157, 157)[0] - dot.pixel(157, 157)[2], 150) << "round";
}

TEST_F(PaintedSurface, leaves_room_at_the_right) {
    options_.room = 100;
    for (const bool perspective : {false, true}) {
        options_.perspective = perspective;
        const Image image = picture();
        RenderOptions empty = options_;
        const Image ground = *render(TriangleMesh{}, empty);
        int left = 300, right = -1;
        for (int x = 0; x < 300; ++x)
            if (std::abs(image.pixel(x, 150)[0] - ground.pixel(x, 150)[0]) > 20)
                left = std::min(left, x), right = x;
        EXPECT_NEAR(left + right, 199, 2);
        EXPECT_LT(right, 200);
        EXPECT_GT(right - left, 170);
    }
}

TEST_F(PaintedSurface, refuses_fields_of_another_size_and_ranges_that_are_none) {
    std::vector<double> few(3, 1.0);
    options_.field = few;
    EXPECT_EQ(render(mesh_, options_).error().where, "field");
    options_.field = {};
    options_.range = {1, 0};
    EXPECT_EQ(render(mesh_, options_).error().where, "range");
    options_.range = {0, 1};
    options_.room = 200;
    EXPECT_EQ(render(mesh_, options_).error().where, "room");
}

}  // namespace
}  // namespace freiform
