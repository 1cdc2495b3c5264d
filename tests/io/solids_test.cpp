// Real solids from files to closed meshes: what the program is for.
#include "support/solids.hpp"

#include "support/corpus.hpp"

#include <freiform/io/exchange.hpp>
#include <freiform/io/mesh_file.hpp>
#include <freiform/io/scene.hpp>

#include <filesystem>
#include <gtest/gtest.h>

using namespace freiform;
using namespace freiform::test;

namespace {

class Solids : public ::testing::Test {
protected:
    void SetUp() override {
        if (!std::filesystem::exists(FREIFORM_OCCT_BINARY))
            GTEST_SKIP() << FREIFORM_OCCT_BINARY << " is not built";
        ::setenv("FREIFORM_OCCT_IMPORT", FREIFORM_OCCT_BINARY, 1);
    }
    // Tessellates within `part` of the diagonal and checks everything that is promised of a closed solid.
    static void expect_closed(const std::filesystem::path& path, double part) {
        const auto model = read_with_occt(path.string(), {});
        ASSERT_TRUE(model) << path << ": " << model.error().message;
        ASSERT_EQ(summary(*model).open_edges, 0) << path;
        Box<3> box;
        for (const Vertex& v : model->vertices) box.add(v.point);
        const double tolerance = part * box.diagonal();
        const auto t = tessellate(*model, {.tolerance = tolerance});
        ASSERT_TRUE(t) << path << ": " << t.error().message;
        for (const RefusedFace& r : t->refused)
            ADD_FAILURE() << path << " face " << r.face << ": " << r.reason.where << ": " << r.reason.message;
        EXPECT_EQ(t->topology.open_edges, 0) << path;
        EXPECT_EQ(t->topology.non_manifold_edges, 0) << path;
        EXPECT_EQ(t->topology.misoriented_edges, 0) << path;
        EXPECT_EQ(t->topology.degenerate_triangles, 0) << path;
        EXPECT_LE(t->error_bound, tolerance) << path;
        EXPECT_LE(sampled_deviation(*model, *t, 4), t->error_bound + t->boundary_gap) << path;
        EXPECT_GT(signed_volume(t->mesh), 0) << path << ": the triangles face inwards";
    }
};

TEST_F(Solids, the_bracket_of_the_examples_is_closed_at_any_tolerance) {
    for (double part : {1e-2, 1e-3, 1e-4})
        expect_closed(std::filesystem::path(FREIFORM_SOURCE_DIR) / "examples/bracket.step", part);
}

TEST_F(Solids, solids_of_the_corpus_are_closed) {
    for (const char* name :
         {"step/linkrods.step", "step/screw.step", "brep/Ball.brep", "brep/CrankArm.brep",
          "step/as1-oc-214.stp", "step/NIST_MBE_PMI_3.stp", "step/pr1sy.stp", "brep/fuse.brep"}) {
        FF_CORPUS_OR_SKIP(path, name);
        expect_closed(path, 1e-3);
    }
}

TEST_F(Solids, a_closed_mesh_stays_closed_in_every_format) {
    const auto model = read_with_occt(std::string(FREIFORM_SOURCE_DIR) + "/examples/bracket.step", {});
    ASSERT_TRUE(model);
    const auto t = tessellate(*model, {.tolerance = 0.05});
    ASSERT_TRUE(t);
    const auto closed = [](const Result<std::string>& bytes, MeshFormat format) {
        ASSERT_TRUE(bytes) << bytes.error().message;
        const auto back = parse_mesh(*bytes, format, "bracket");
        ASSERT_TRUE(back) << back.error().message;
        EXPECT_EQ(topology(*back).open_edges, 0) << int(format);
    };
    closed(to_glb(t->mesh), MeshFormat::glb);
    closed(to_stl(t->mesh), MeshFormat::stl);
    closed(to_obj(t->mesh), MeshFormat::obj);
    closed(to_ply(t->mesh), MeshFormat::ply);
}

TEST(Scene, joins_surfaces_and_names_what_has_no_faces) {
    Document d;
    d.unit = "mm";
    const auto flat = *BSplineBasis::bezier(1);
    const auto square = [&](double x) {
        return *Surface<Vec<3>>::make(
            {flat, flat},
            Net<2, Vec<3>>({2, 2}, {{{x, 0, 0}}, {{x, 1, 0}}, {{x + 1, 0, 0}}, {{x + 1, 1, 0}}}));
    };
    d.objects.push_back({"left", square(0), {}});
    d.objects.push_back({"right", square(1), {}});
    d.objects.push_back(
        {"line", *Curve<Vec<2>>::make({flat}, Net<1, Vec<2>>({2}, {{{0, 0}}, {{1, 0}}})), {}});
    const auto model = scene_of(d);
    ASSERT_TRUE(model);
    EXPECT_EQ(model->faces.size(), 2u);
    EXPECT_EQ(model->edges.size(), 7u) << "the squares share a side";
    ASSERT_EQ(model->refused.size(), 1u);
    EXPECT_NE(model->refused[0].where.find("line"), std::string::npos);
    EXPECT_EQ(model->unit, "mm");
    const std::size_t only_line[] = {2};
    EXPECT_EQ(scene_of(d, only_line).error().kind, RefusalKind::no_answer);
}

TEST(Scene, triangular_patches_share_their_sides) {
    // Flat triangles of degree 2 over the faces of a tetrahedron: closed to the bit, whatever the corner they
    // begin at.
    const Vec<3> corner[4] = {{{0, 0, 0}}, {{1, 0, 0}}, {{0, 1, 0}}, {{0, 0, 1}}};
    const int faces[4][3] = {{0, 2, 1}, {0, 1, 3}, {3, 2, 0}, {1, 2, 3}};
    Document d;
    for (const auto& f : faces) {
        std::vector<Vec<3>> c;
        for (int a = 0; a <= 2; ++a)
            for (int k = 0; k <= a; ++k) {  // b_ijk = (i c_0 + j c_1 + k c_2) / 2
                Vec<3> p =
                    double(2 - a) * corner[f[0]] + double(a - k) * corner[f[1]] + double(k) * corner[f[2]];
                c.push_back(0.5 * p);
            }
        d.objects.push_back({"", *Triangle<Vec<3>>::make(2, c), {}});
    }
    const auto model = scene_of(d);
    ASSERT_TRUE(model);
    EXPECT_EQ(model->faces.size(), 4u);
    EXPECT_TRUE(model->bodies[0].solid) << "the sides of the triangles are shared";
    const auto t = tessellate(*model, {.tolerance = 0.01});
    ASSERT_TRUE(t);
    EXPECT_EQ(t->topology.open_edges, 0);
    EXPECT_NEAR(std::abs(signed_volume(t->mesh)), 1.0 / 6, 1e-12);
}

}  // namespace
