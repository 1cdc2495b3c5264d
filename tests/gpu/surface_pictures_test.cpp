#include "compared_pictures.hpp"
#include "support/corpus.hpp"
#include "support/effort.hpp"
#include "support/random.hpp"
#include "support/solids.hpp"

#include <freiform/gpu/surfaces.hpp>
#include <freiform/io/read.hpp>
#include <freiform/io/scene.hpp>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <gtest/gtest.h>

namespace freiform {
namespace {

// Two faces at an angle, a hole in one of them: what is between them is seen from both sides.
Model cut_roof() {
    ModelBuilder builder;
    const auto basis = *BSplineBasis::bezier(1);
    const auto flat = [&](const std::array<Vec<3>, 4>& p) {
        return *Surface<Vec<3>>::make({basis, basis}, Net<2, Vec<3>>({2, 2}, {p[0], p[1], p[2], p[3]}));
    };
    const CurveGeometry<2> hole = Conic<2>{ConicKind::ellipse, {{0.55, 0.45}}, {{0.3, 0.1}}, {{-0.1, 0.25}}};
    const auto side = [&](Vec<2> a, Vec<2> b) -> CurveGeometry<2> {
        return Curve<Vec<2>>::trusted({basis}, Net<1, Vec<2>>({2}, {a, b}));
    };
    const std::vector<std::vector<CurveGeometry<2>>> loops{
        {side({{0, 0}}, {{1, 0}}), side({{1, 0}}, {{1, 1}}), side({{1, 1}}, {{0, 1}}),
         side({{0, 1}}, {{0, 0}})},
        {hole}};
    EXPECT_TRUE(builder.add_trimmed(flat({{{{0, 0, 0}}, {{0, 1, 0}}, {{1, 0, 0}}, {{1, 1, 0}}}}), loops));
    EXPECT_TRUE(builder.add(flat({{{{1, 0, 0}}, {{1, 1, 0}}, {{1.5, 0, 0.8}}, {{1.5, 1, 0.8}}}})));
    return *std::move(builder).finish();
}

// One surface as two faces: what is within an ellipse, and what is around it.
Model disc_in_hill() {
    const auto basis = *BSplineBasis::bezier(2);
    Net<2, Vec<3>> net({3, 3});
    each_index(net.extent(), [&](const Index<2>& at) {
        net.view()(at) = Vec<3>{{0.5 * at[0], 0.5 * at[1], at[0] == 1 && at[1] == 1 ? 0.8 : 0.0}};
    });
    const auto hill = *Surface<Vec<3>>::make({basis, basis}, net);
    const auto line = *BSplineBasis::bezier(1);
    const auto side = [&](Vec<2> a, Vec<2> b) -> CurveGeometry<2> {
        return Curve<Vec<2>>::trusted({line}, Net<1, Vec<2>>({2}, {a, b}));
    };
    const CurveGeometry<2> ellipse = Conic<2>{ConicKind::ellipse, {{0.5, 0.5}}, {{0.3, 0.1}}, {{-0.1, 0.25}}};
    ModelBuilder builder;
    const std::vector<CurveGeometry<2>> square{side({{0, 0}}, {{1, 0}}), side({{1, 0}}, {{1, 1}}),
                                               side({{1, 1}}, {{0, 1}}), side({{0, 1}}, {{0, 0}})};
    EXPECT_TRUE(builder.add_trimmed(hill, std::vector<std::vector<CurveGeometry<2>>>{square, {ellipse}}));
    EXPECT_TRUE(builder.add_trimmed(hill, std::vector<std::vector<CurveGeometry<2>>>{{ellipse}}));
    return *std::move(builder).finish();
}

class SurfacePictures : public testing::TestWithParam<SurfacePipeline> {
protected:
    void SetUp() override {
        options_.width = 200, options_.height = 150;
        options_.outlines = false;
        options_.top = options_.bottom = {1, 0, 1, 1};
        options_.colour = {0.6, 0.6, 0.6, 1};
        const auto probe = renderer_of(test::sphere(Vec<3>{}, 1.0));
        if (!probe && probe.error().kind == RefusalKind::unavailable) GTEST_SKIP() << probe.error().message;
        ASSERT_TRUE(probe) << probe.error().message;
    }
    Result<SurfaceRenderer> renderer_of(Model model) {
        for (Face& f : model.faces) f.colour.reset();
        for (Body& b : model.bodies) b.colour.reset();
        auto b = surface_buffers(
            model, {.edge_tolerance = summary(model).box.diagonal() / 16000, .colour = options_.colour});
        if (!b) return std::unexpected(b.error());
        options_.frame = extent_ = b->extent;
        return SurfaceRenderer::make(std::move(*b), GetParam());
    }
    static TriangleMesh mesh_of(Model model) {
        for (Face& f : model.faces) f.colour.reset();
        for (Body& b : model.bodies) b.colour.reset();
        TessellateOptions how;
        how.tolerance = summary(model).box.diagonal() / 10000;
        auto t = test::must(tessellate(model, how));
        EXPECT_TRUE(t.refused.empty());
        return std::move(t.mesh);
    }
    void expect_same(const Model& model, const std::string& name, std::initializer_list<const char*> views,
                     int by = 16) {
        auto renderer = renderer_of(model);
        ASSERT_TRUE(renderer) << name << ": " << renderer.error().where << ": " << renderer.error().message;
        const TriangleMesh fine = mesh_of(model);
        for (const char* view : views) {
            options_.view = *parse_view(view);
            const auto gpu = renderer->draw(options_);
            ASSERT_TRUE(gpu) << name << ": " << gpu.error().where << ": " << gpu.error().message;
            const Image mesh = test::must(render(fine, options_));
            const test::ComparedPictures c = test::compared(*gpu, mesh, by);
            EXPECT_EQ(c.cracked, 0) << name << " " << view;
            EXPECT_LE(c.different, c.surface / 1000) << name << " " << view;
            EXPECT_GT(c.surface, 200) << name << " " << view;
            if (const char* folder = std::getenv("FREIFORM_PICTURES")) {
                const auto keep = [&](const char* which, const Image& image) {
                    std::ofstream(text(folder, "/", name, "_", view, "_", which, ".png")) << *to_png(image);
                };
                keep("gpu", *gpu), keep("mesh", mesh), keep("difference", test::difference(*gpu, mesh));
                std::printf("%s %s: %d of %d pixels differ, %d cracked\n", name.c_str(), view, c.different,
                            c.surface, c.cracked);
            }
        }
    }

    RenderOptions options_;
    std::vector<Vec<3>> extent_;
};

TEST_P(SurfacePictures, show_what_the_mesh_shows) {
    expect_same(test::sphere(Vec<3>{{5, 0, 0}}, 2.0), "sphere", {"iso"});
    expect_same(test::torus(2.0, 0.7), "torus", {"40,25"});
    expect_same(test::frustum(1, 0, 2), "cone", {"iso"});
    expect_same(test::frustum(1, 0.6, 1), "frustum", {"20,50"});
    expect_same(cut_roof(), "roof", {"iso", "100,20"}, 48);
    options_.perspective = true;
    expect_same(test::frustum(1, 0.6, 1), "frustum_perspective", {"20,50"});
}

// Triangles at outlines of saddles are seen from behind, by less than a pixel. Their light is that of the
// outside, whichever way the faces are turned.
TEST_P(SurfacePictures, closed_bodies_have_no_dark_dots_at_outlines) {
    options_.supersampling = 1;
    for (const bool inside_out : {false, true}) {
        Model model = test::torus(2.0, 0.7);
        for (Face& f : model.faces) f.reversed = f.reversed != inside_out;
        auto renderer = renderer_of(model);
        ASSERT_TRUE(renderer);
        const TriangleMesh coarse = test::must(tessellate(model, {.tolerance = 0.002})).mesh;
        for (const char* view : {"40,25", "120,-30", "250,40"}) {
            options_.view = *parse_view(view);
            RenderOptions large = options_;
            large.width *= 8, large.height *= 8;
            const Image whole = test::reduced(test::must(renderer->draw(large)), 8);
            const Image drawn = test::must(renderer->draw(options_));
            EXPECT_EQ(test::darker(drawn, whole, 16), 0) << view << (inside_out ? ", inside out" : "");
            EXPECT_EQ(test::darker(test::must(render(coarse, options_)), whole, 16), 0) << view << ", mesh";
            if (const char* folder = std::getenv("FREIFORM_PICTURES"))
                std::ofstream(text(folder, "/outlines_", view, int(GetParam()), inside_out, ".png"))
                    << *to_png(drawn);
        }
    }
}

// Many small triangles, narrow seams: a pixel whose samples are of several triangles must not be decided on
// by one place for one face and by another for its neighbour.
TEST_P(SurfacePictures, have_no_open_pixels_between_trimmed_faces_with_narrow_seams) {
    options_.supersampling = 1;
    options_.view = *parse_view("37,61");
    auto renderer = renderer_of(disc_in_hill());
    ASSERT_TRUE(renderer) << renderer.error().message;
    const auto drawn = renderer->draw(options_, 0.01);
    ASSERT_TRUE(drawn) << drawn.error().message;
    int open = 0, inside = 0;
    for (int y = 45; y < 105; ++y)
        for (int x = 60; x < 140; ++x) ++inside, open += test::background(*drawn, x, y) > 6;
    EXPECT_EQ(open, 0);
    EXPECT_GT(inside, 4000);
    if (const char* folder = std::getenv("FREIFORM_PICTURES"))
        std::ofstream(text(folder, "/disc_in_hill_", int(GetParam()), ".png")) << *to_png(*drawn);
}

// Neighbours that are cut into different numbers of cells along their common edge, coarsely: without seams
// several pixels would lie open between them.
TEST_P(SurfacePictures, seams_fill_what_coarse_triangles_leave_open) {
    const std::array bases{*BSplineBasis::bezier(2), *BSplineBasis::bezier(1)};
    const auto strip = [&](const std::array<double, 3>& near, const std::array<double, 3>& far) {
        std::vector<Vec<3>> net;
        for (const std::size_t i : {std::size_t(0), std::size_t(1), std::size_t(2)})
            for (const double y : {near[i], far[i]}) net.push_back({{0.5 * double(i), y, 0}});
        return *Surface<Vec<3>>::make(bases, Net<2, Vec<3>>({3, 2}, net));
    };
    ModelBuilder builder;
    ASSERT_TRUE(builder.add(strip({0, -0.5, 0}, {1, 1, 1})));
    ASSERT_TRUE(builder.add(strip({0, -0.5, 0}, {-0.8, -2.8, -0.8})));
    const Model model = *std::move(builder).finish();
    options_.view = *parse_view("top");
    auto renderer = renderer_of(model);
    ASSERT_TRUE(renderer);
    const auto fine = renderer->draw(options_);
    ASSERT_TRUE(fine);
    const auto coarse = renderer->draw(options_, 6);
    ASSERT_TRUE(coarse);
    int inside = 0, open = 0;
    constexpr int kFar = 14;  // the outline itself is coarse
    for (int y = kFar; y + kFar < fine->height; ++y)
        for (int x = kFar; x + kFar < fine->width; ++x) {
            int around = 0;
            for (int i = -kFar; i <= kFar; i += 2)
                for (int j = -kFar; j <= kFar; j += 2)
                    around = std::max(around, test::background(*fine, x + i, y + j));
            if (around > 3) continue;
            ++inside;
            open += test::background(*coarse, x, y) > 6;
        }
    EXPECT_GT(inside, 1000);
    EXPECT_EQ(open, 0);
}

TEST_P(SurfacePictures, show_the_teapot_without_cracks) {
    const auto document = test::must(read_any(std::string(FREIFORM_SOURCE_DIR) + "/examples/teapot.bpt"));
    expect_same(test::must(scene_of(document)), "teapot", {"60,-20"});
}

// Eleven models of the corpus, from three sides. With sanitizers it takes many minutes: FREIFORM_MODELS=1.
TEST_P(SurfacePictures, show_models_of_the_corpus_without_cracks) {
    setenv("FREIFORM_OCCT_IMPORT", FREIFORM_OCCT_BINARY, 0);
    if (!test::kIsMeasured && !std::getenv("FREIFORM_MODELS"))
        GTEST_SKIP() << "FREIFORM_MODELS=1 compares pictures of eleven models with sanitizers, too";
    options_.width = 400, options_.height = 300, options_.supersampling = 2;
    for (const char* name :
         {"step/linkrods.step", "step/screw.step", "step/as1-oc-214.stp", "step/trj4_k1_geo-tc-214.stp",
          "step/conical-surface.step", "step/bug28414_bug_toroidal_surface.stp",
          "step/red_cube_blue_cylinder.step", "brep/CrankArm.brep", "brep/Ball.brep", "iges/bearing.iges",
          "bpt/teaset_teaspoon.bpt"}) {
        FF_CORPUS_OR_SKIP(path, name);
        const auto document = read_any(path.string());
        if (!document) GTEST_SKIP() << document.error().message;
        const auto model = scene_of(*document);
        ASSERT_TRUE(model) << name;
        expect_same(*model, path.stem().string(), {"iso", "200,35", "top"});
    }
}

INSTANTIATE_TEST_SUITE_P(Pipelines, SurfacePictures,
                         testing::Values(SurfacePipeline::tessellation, SurfacePipeline::grid),
                         [](const auto& made) {
                             return made.param == SurfacePipeline::grid ? "grid" : "tessellation";
                         });

}  // namespace
}  // namespace freiform
