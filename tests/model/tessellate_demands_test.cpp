#include "support/shapes.hpp"
#include "support/solids.hpp"

#include <chrono>
#include <gtest/gtest.h>
#include <support/sanitizer.hpp>

using namespace freiform;
using namespace freiform::test;

namespace {

double longest_side(const TriangleMesh& mesh) {
    double longest = 0;
    for (const MeshEdge& e : edges(mesh))
        longest = std::max(longest, norm(mesh.points[std::size_t(e.a)] - mesh.points[std::size_t(e.b)]));
    return longest;
}

TEST(TessellateDemands, no_side_is_longer_than_asked_for) {
    std::mt19937 rng(21);
    ModelBuilder builder;
    ASSERT_TRUE(builder.add(landscape(rng, 3, 8, 0.1)));
    const Model models[] = {test::sphere({{1, 2, 3}}, 2), frustum(2, 1, 3), frustum(2, 0, 3),
                            *std::move(builder).finish()};
    for (const Model& m : models)
        for (const double part : {0.2, 0.03}) {
            const double longest = part * summary(m).box.diagonal();
            const auto t = tessellate(m, {.tolerance = 10 * longest, .max_edge = longest});
            ASSERT_TRUE(t) << t.error().message;
            EXPECT_TRUE(t->refused.empty());
            EXPECT_LE(longest_side(t->mesh), longest * (1 + 1e-12));
            EXPECT_GE(longest_side(t->mesh), 0.5 * longest) << "shorter than asked for";
            EXPECT_EQ(t->topology.non_manifold_edges, 0);
            EXPECT_EQ(t->topology.degenerate_triangles, 0);
            if (summary(m).open_edges == 0) {
                EXPECT_EQ(t->topology.open_edges, 0);
            }
        }
}

TEST(TessellateDemands, predictions_are_of_the_right_size) {
    for (const Model& m : {test::sphere({}, 1), test::torus(3, 1), frustum(2, 1, 3)})
        for (const double tolerance : {1e-2, 1e-3}) {
            TessellateOptions how{.tolerance = tolerance};
            for (const double longest : {HUGE_VAL, 0.1}) {
                how.max_edge = longest;
                const double predicted = predicted_triangles(m, how);
                const double made = double(tessellate(m, how)->mesh.triangles.size());
                EXPECT_LE(predicted, 2 * made) << tolerance << " " << longest;
                EXPECT_GE(predicted, made / 2) << tolerance << " " << longest;
            }
        }
}

TEST(TessellateDemands, what_is_far_too_much_is_refused_at_once_with_the_number) {
    const Model m = test::torus(3, 1);
    for (const auto& how :
         {TessellateOptions{.tolerance = 1e-12}, TessellateOptions{.tolerance = 1, .max_edge = 1e-5}}) {
        const auto start = std::chrono::steady_clock::now();
        const auto t = tessellate(m, how);
        const double seconds =
            std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
        ASSERT_FALSE(t);
        EXPECT_EQ(t.error().kind, RefusalKind::limit);
        EXPECT_NE(t.error().message.find("about "), std::string::npos) << t.error().message;
        EXPECT_LT(seconds, kAddressSanitizer ? 1 : 0.05);
    }
    for (const double bad : {0.0, -1.0, double(NAN)})
        EXPECT_EQ(tessellate(m, {.tolerance = 0.1, .max_edge = bad}).error().where, "max_edge");
}

}  // namespace
