// The least distance of two solids: what is known of spheres, tori and cones, and many points.
#include <freiform/model/bounds.hpp>
#include <freiform/model/distance.hpp>

#include <gtest/gtest.h>
#include <support/polygon_face.hpp>
#include <support/random.hpp>
#include <support/refusal.hpp>
#include <support/shapes.hpp>
#include <support/solids.hpp>

namespace freiform::test {
namespace {

ModelNearestQuery solid_query(Model m) { return must(ModelNearestQuery::make(std::move(m))); }

TEST(ModelDistance, of_spheres_and_a_torus_is_what_geometry_says) {
    const auto one = solid_query(sphere({}, 1));
    struct Known {
        Vec<3> centre;
        double radius, distance;
    };
    for (const Known& k : {Known{{{3, 4, 0}}, 2, 2}, {{{0, 0, 5}}, 1, 3}}) {
        const auto other = solid_query(sphere(k.centre, k.radius));
        const bool poles = k.distance == 3;  // face each other: needles on both sides, which take longer
        const auto d = must(least_distance(one, other, {.accuracy = 1e-5, .max_pairs = 10000}));
        EXPECT_NEAR(d.distance, k.distance, 1e-5);
        EXPECT_LE(d.lower_bound, k.distance);
        EXPECT_GE(d.lower_bound, k.distance - (poles ? 2e-3 : 1.1e-5));
        EXPECT_NEAR(norm(d.at[0].point), 1, 1e-12);
        EXPECT_NEAR(norm(d.at[1].point - k.centre), k.radius, 1e-12);
        EXPECT_NEAR(norm(d.at[0].point - d.at[1].point), d.distance, 1e-14);
    }
    const auto ring = must(
        least_distance(solid_query(torus(3, 1)), solid_query(sphere({{0, 0, 3}}, 0.5)), {.accuracy = 1e-2}));
    EXPECT_NEAR(ring.distance, std::sqrt(18) - 1.5, 1e-2);
    EXPECT_LE(ring.lower_bound, std::sqrt(18) - 1.5);
}

TEST(ModelDistance, sees_edges_and_meetings) {
    const auto cone = solid_query(frustum(1, 0.5, 2));
    // Beside the rim of the wide end: the edge is nearest.
    const Vec<3> c{{3, 0, -1.5}};
    const auto d = must(least_distance(cone, solid_query(sphere(c, 0.5)), {.accuracy = 1e-4}));
    EXPECT_NEAR(d.distance, norm(c - Vec<3>{{1, 0, 0}}) - 0.5, 1e-4);
    EXPECT_LE(d.lower_bound, norm(c - Vec<3>{{1, 0, 0}}) - 0.5);
    EXPECT_GE(d.lower_bound, d.distance - 1e-3);
    EXPECT_GE(d.at[0].edge, 0);
    const auto meet = must(least_distance(cone, solid_query(sphere({{1, 0, 1}}, 0.5))));
    EXPECT_LE(meet.distance, 1e-6);
    EXPECT_EQ(meet.lower_bound, 0);
}

TEST(ModelDistance, of_facing_poles_is_known_as_well_as_elsewhere) {
    const auto a = must(ModelNearestQuery::make(sphere({}, 1))),
               b = must(ModelNearestQuery::make(sphere({{0, 0, 5}}, 2)));
    const auto d = must(least_distance(a, b, {.accuracy = 1e-4, .max_pairs = 20000}));
    EXPECT_NEAR(d.distance, 2, 1e-3);
    EXPECT_LE(d.lower_bound, 2);
    EXPECT_GE(d.lower_bound, 2 - 5e-4);
}

// Nothing is known of the normals of an offset over large parts of it: it had no box then, and no distance.
TEST(ModelDistance, of_offsets_is_found_where_their_normals_vary) {
    std::mt19937 random(5);
    for (const double height : {0.5, 2.0}) {
        const auto base = std::make_shared<const SurfaceGeometry>(landscape(random, 3, 6, height));
        const SurfaceGeometry offset = OffsetSurface{base, 0.02};
        const std::vector<Vec<2>> corners{{{0, 0}}, {{3, 0}}, {{3, 3}}, {{0, 3}}};
        const auto face = solid_query(polygon_face(offset, corners));
        const Vec<3> centre{{3, 2, 6}};
        double least = kInfinity;
        for (const Vec<3>& x : places_on(offset, corners, 200)) least = std::min(least, norm(x - centre) - 1);
        const auto d = must(least_distance(face, solid_query(sphere(centre, 1)), {.accuracy = 1e-4}));
        EXPECT_LE(d.distance, least + 1e-4) << height;
        EXPECT_LE(d.lower_bound, least) << height;
        EXPECT_GE(d.lower_bound, d.distance - 2e-4) << height;
        EXPECT_NEAR(norm(d.at[0].point - d.at[1].point), d.distance, 1e-12);
        EXPECT_NEAR(norm(jet<0>(offset, d.at[0].uv.c).value() - d.at[0].point), 0, 1e-12);
        const auto box = must(tight_box(face.model(), 1e-3));
        EXPECT_LE(box.slack, 1e-3) << height;
    }
}

TEST(ModelDistance, a_spent_budget_leaves_a_bound_that_holds_and_nonsense_is_refused) {
    const auto a = solid_query(sphere({}, 1)), b = solid_query(sphere({{0, 3, 0}}, 1));
    double before = -1;
    for (const int pairs : {1, 100}) {
        const auto d = must(least_distance(a, b, {.max_pairs = pairs}));
        EXPECT_LE(d.lower_bound, 1);
        EXPECT_GE(d.distance, 1 - 1e-12);
        EXPECT_GE(d.lower_bound, before);
        before = d.lower_bound;
    }
    expect_refusal(least_distance(a, b, {.accuracy = -1}), RefusalKind::invalid, "accuracy");
    expect_refusal(least_distance(a, b, {.max_pairs = 0}), RefusalKind::invalid, "max_pairs");
}

}  // namespace
}  // namespace freiform::test
