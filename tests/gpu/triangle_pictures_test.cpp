// Triangular patches, alone and beside others, against fine meshes of them.
#include "compared_pictures.hpp"
#include "support/random.hpp"
#include "support/solids.hpp"

#include <freiform/gpu/surfaces.hpp>

#include <cmath>
#include <fstream>
#include <gtest/gtest.h>

namespace freiform {
namespace {

using Patch3 = SimplexPatch<2, Hom<3>>;

// Over the triangle of these corners, heights and weights random.
Patch3 hill_of(test::Random& random, int n, const std::array<Vec<3>, 3>& corner, double height,
               double spread) {
    std::vector<Hom<3>> net;
    for (int row = 0; row <= n; ++row)
        for (int k = 0; k <= row; ++k) {
            const double j = double(row - k) / n, l = double(k) / n;
            const Vec<3> foot = (1 - j - l) * corner[0] + j * corner[1] + l * corner[2];
            net.push_back(weighted(foot + Vec<3>{{0, 0, random.real(-height, height)}},
                                   std::exp2(random.real(-spread, spread))));
        }
    return *Patch3::make(n, net);
}

// The same patch with the coefficients of the degree above.
Patch3 elevated(const Patch3& p) {
    const int n = p.degree() + 1;
    std::vector<Hom<3>> net(std::size_t((n + 1) * (n + 2) / 2));
    for (int j = 0; j <= n; ++j)
        for (int k = 0; j + k <= n; ++k) {
            Hom<3> h{};
            if (j + k < n) h += double(n - j - k) / n * p.coefficient(j, k);
            if (j > 0) h += double(j) / n * p.coefficient(j - 1, k);
            if (k > 0) h += double(k) / n * p.coefficient(j, k - 1);
            net[Patch3::slot(j, k)] = h;
        }
    return *Patch3::make(n, net);
}

void add_to(TriangleMesh& mesh, const Patch3& patch, int n) {
    const int first = int(mesh.vertices.size()), part = int(mesh.triangles.size());
    for (int row = 0; row <= n; ++row)
        for (int k = 0; k <= row; ++k) {
            Param<2> at{double(row - k) / n, double(k) / n};
            auto direction = normal(patch, at);
            if (!direction)  // at a pole that of a place inside
                direction =
                    normal(patch, {at[0] + 1e-3 * (1.0 / 3 - at[0]), at[1] + 1e-3 * (1.0 / 3 - at[1])});
            mesh.vertices.push_back({int(mesh.points.size()), direction.value_or(Vec<3>{}), {}});
            mesh.points.push_back(patch(at));
        }
    const auto number = [&](int row, int k) { return first + row * (row + 1) / 2 + k; };
    for (int row = 0; row < n; ++row)
        for (int k = 0; k <= row; ++k) {
            mesh.triangles.push_back({number(row, k), number(row + 1, k), number(row + 1, k + 1)});
            if (k < row)
                mesh.triangles.push_back({number(row, k), number(row + 1, k + 1), number(row, k + 1)});
        }
    mesh.parts.push_back({"", std::nullopt, part, int(mesh.triangles.size()) - part, 0});
}

class TrianglePictures : public testing::TestWithParam<SurfacePipeline> {
protected:
    void SetUp() override {
        options_.width = 120, options_.height = 90, options_.supersampling = 1;
        options_.outlines = false;
        options_.top = options_.bottom = {1, 0, 1, 1};
        options_.colour = {0.6, 0.6, 0.6, 1};
        test::Random random(1);
        const TriangularFace face{hill_of(random, 1, kCorners, 0, 0), {}};
        const auto buffers = surface_buffers(Model{}, std::span(&face, 1), {.edge_tolerance = 1e-3});
        const auto probe = SurfaceRenderer::make(test::must(buffers), GetParam());
        if (!probe && probe.error().kind == RefusalKind::unavailable) GTEST_SKIP() << probe.error().message;
    }
    void expect_same(std::span<const Patch3> patches, const Model& model, const std::string& name,
                     std::initializer_list<const char*> views) {
        std::vector<TriangularFace> faces;
        TriangleMesh mesh;
        for (const Patch3& p : patches) {
            faces.push_back({p, {}});
            add_to(mesh, p, 40);
        }
        if (!model.faces.empty()) {
            const TriangleMesh more = test::must(tessellate(model, {.tolerance = 1e-4})).mesh;
            const int points = int(mesh.points.size()), vertices = int(mesh.vertices.size());
            for (MeshVertex v : more.vertices) {
                v.point += points;
                mesh.vertices.push_back(v);
            }
            mesh.points.insert(mesh.points.end(), more.points.begin(), more.points.end());
            const int part = int(mesh.triangles.size());
            for (auto t : more.triangles) {
                for (int& v : t) v += vertices;
                mesh.triangles.push_back(t);
            }
            mesh.parts.push_back({"", std::nullopt, part, int(more.triangles.size()), 0});
        }
        const SurfaceBuffers buffers =
            test::must(surface_buffers(model, faces, {.edge_tolerance = 1e-4, .colour = options_.colour}));
        options_.frame = mesh.points;
        auto renderer = test::must(SurfaceRenderer::make(buffers, GetParam()));
        for (const char* view : views) {
            options_.view = *parse_view(view);
            const Image gpu = test::must(renderer.draw(options_)), fine = test::must(render(mesh, options_));
            const test::ComparedPictures c = test::compared(gpu, fine, 12);
            EXPECT_EQ(c.cracked, 0) << name << " " << view;
            EXPECT_EQ(c.different, 0) << name << " " << view;
            EXPECT_GT(c.surface, 1000) << name << " " << view;
            if (const char* folder = std::getenv("FREIFORM_PICTURES")) {
                std::ofstream(std::string(folder) + "/" + name + "_" + view + "_gpu.png") << *to_png(gpu);
                std::ofstream(std::string(folder) + "/" + name + "_" + view + "_mesh.png") << *to_png(fine);
            }
        }
    }

    static constexpr std::array<Vec<3>, 3> kCorners{{{{0, 0, 0}}, {{1, 0, 0}}, {{0.3, 0.9, 0}}}};
    RenderOptions options_;
};

TEST_P(TrianglePictures, have_no_hairlines) {
    // Bent in one direction alone: its triangles have sides on lines that are no straight lines in space.
    std::vector<Hom<3>> bent;
    for (const Vec<3>& p :
         {Vec<3>{{0, 0, 0}}, {{1, 0, .5}}, {{0, 1, .5}}, {{2, 0, 0}}, {{1, 1, .5}}, {{0, 2, 0}}})
        bent.push_back(weighted(p, 1.0));
    expect_same(std::array{*Patch3::make(2, bent)}, {}, "bent", {"iso"});
    test::Random random(3);
    for (const int n : {1, 2, 4, 7, 10})
        expect_same(std::array{hill_of(random, n, kCorners, 0.3 / n, n < 4 ? 1 : 0.1)}, {},
                    text("degree_", n), {"top"});
}

TEST_P(TrianglePictures, have_no_cracks_between_neighbours_of_other_degrees_and_levels) {
    test::Random random(5);
    // A half of a tensor product patch is a triangle of the sum of its degrees; here the neighbours of one
    // that has the curve (t, 0, f(t)), of all degrees, with other bends inside.
    const Patch3 first = hill_of(random, 3, kCorners, 0.15, 0.5);
    std::vector<Patch3> all{first};
    const std::array<Vec<3>, 3> across{{{{0, 0, 0}}, {{1, 0, 0}}, {{0.6, -0.8, 0}}}};
    Patch3 second = hill_of(random, 3, across, 0.6, 0);
    std::vector<Hom<3>> net(second.coefficients().begin(), second.coefficients().end());
    for (int j = 0; j <= 3; ++j) net[Patch3::slot(j, 0)] = first.coefficient(j, 0);
    second = *Patch3::make(3, net);
    for (int n = 3; n < 7; ++n) second = elevated(second);
    all.push_back(second);
    // Along the side from the first corner to the third a tensor product patch, flat.
    const std::array bases{*BSplineBasis::bezier(1), *BSplineBasis::bezier(3)};
    Net<2, Hom<3>> beside({2, 4});
    for (int k = 0; k <= 3; ++k) {
        beside.view()({0, k}) = first.coefficient(0, k);
        beside.view()({1, k}) = weighted(Vec<3>{{-0.7, 0.9 * k / 3, 0.1}}, 1.0);
    }
    ModelBuilder builder;
    ASSERT_TRUE(builder.add(*Surface<Hom<3>>::make(bases, beside)));
    const Model model = *std::move(builder).finish();
    expect_same(all, model, "neighbours", {"30,40", "200,35"});
}

TEST_P(TrianglePictures, may_have_poles_and_unequal_weights) {
    test::Random random(7);
    // A side that is a point: f = corner + (1 - t1) g.
    Patch3 fan = hill_of(random, 4, kCorners, 0.1, 0.5);
    std::vector<Hom<3>> net(fan.coefficients().begin(), fan.coefficients().end());
    for (int k = 0; k <= 4; ++k) net[Patch3::slot(4 - k, k)] = weighted(kCorners[1], 1.0);
    expect_same(std::array{*Patch3::make(4, net)}, {}, "pole", {"iso"});
    expect_same(std::array{hill_of(random, 2, kCorners, 0.2, 3)}, {}, "weights", {"top"});
}

INSTANTIATE_TEST_SUITE_P(Pipelines, TrianglePictures,
                         testing::Values(SurfacePipeline::tessellation, SurfacePipeline::grid),
                         [](const auto& made) {
                             return made.param == SurfacePipeline::grid ? "grid" : "tessellation";
                         });

}  // namespace
}  // namespace freiform
