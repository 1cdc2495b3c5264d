// The nearest faces of a model, and its farthest point.
#include <freiform/model/nearest.hpp>

#include <gtest/gtest.h>
#include <support/random.hpp>
#include <support/refusal.hpp>
#include <support/sanitizer.hpp>
#include <support/solids.hpp>

namespace freiform::test {
namespace {

// Squares in the planes z = 0, 1, 2, ..
Model shelf(int boards) {
    ModelBuilder builder;
    const auto b = must(BSplineBasis::bezier(1));
    for (int k = 0; k < boards; ++k) {
        const double z = k;
        EXPECT_TRUE(builder.add(must(Surface<Vec<3>>::make(
            {b, b}, Net<2, Vec<3>>({2, 2}, {Vec<3>{{0, 0, z}}, {{0, 1, z}}, {{1, 0, z}}, {{1, 1, z}}})))));
    }
    return must(std::move(builder).finish());
}

TEST(NearestFaces, come_in_order_and_the_others_are_farther) {
    const auto query = must(ModelNearestQuery::make(shelf(8)));
    const Vec<3> q{{0.3, 0.6, 2.2}};
    const auto near = must(query.nearest_faces(q, 3));
    ASSERT_EQ(near.faces.size(), 3u);
    const int faces[] = {2, 3, 1};
    const double distances[] = {0.2, 0.8, 1.2};
    for (std::size_t k = 0; k < 3; ++k) {
        EXPECT_EQ(near.faces[k].face, faces[k]);
        EXPECT_NEAR(near.faces[k].distance, distances[k], 1e-12);
        EXPECT_LE(near.faces[k].lower_bound, distances[k]);
        EXPECT_GE(near.faces[k].lower_bound, distances[k] - 1e-6);
    }
    EXPECT_LE(near.others, 1.8);
    EXPECT_GE(near.others, 1.8 - 1e-6);
    EXPECT_EQ(must(query.nearest_faces(q, 100)).faces.size(), 8u);
    EXPECT_EQ(must(query.nearest_faces(q, 100)).others, kInfinity);
}

TEST(NearestFaces, within_a_radius_are_all_there_are) {
    const auto query = must(ModelNearestQuery::make(shelf(8)));
    const auto near = must(query.nearest_faces({{0.5, 0.5, 2.2}}, 100, 1.5));
    ASSERT_EQ(near.faces.size(), 3u);
    EXPECT_GE(near.others, 1.5);
    EXPECT_LE(near.others, 1.8);
    const auto none = must(query.nearest_faces({{0.5, 0.5, -5}}, 100, 1.5));
    EXPECT_TRUE(none.faces.empty());
    EXPECT_GE(none.others, 1.5);
}

TEST(FarthestOnModel, is_opposite_on_a_sphere_and_in_a_corner_of_a_shelf) {
    const auto ball = must(ModelNearestQuery::make(sphere({{1, 2, 3}}, 2)));
    Random random(4);
    for (int k = 0; k < cases(10); ++k) {
        const Vec<3> d{{random.real(-4, 4), random.real(-4, 4), random.real(-4, 4)}};
        const auto far = must(ball.farthest(Vec<3>{{1, 2, 3}} + d, {.accuracy = 1e-6}));
        EXPECT_NEAR(far.distance, norm(d) + 2, 1e-6);
        EXPECT_GE(far.upper_bound, norm(d) + 2);
        EXPECT_LE(far.upper_bound, norm(d) + 2 + 2e-6);
        EXPECT_NEAR(norm(far.point - Vec<3>{{1, 2, 3}}), 2, 1e-12);
    }
    const auto boards = must(ModelNearestQuery::make(shelf(3)));
    const auto corner = must(boards.farthest({{0.1, 0.2, 0}}));
    EXPECT_EQ(corner.face, 2);
    EXPECT_EQ(corner.point, (Vec<3>{{1, 1, 2}}));
    EXPECT_GE(corner.edge, 0);
    EXPECT_NEAR(corner.upper_bound, corner.distance, 1e-8);
}

TEST(FarthestOnModel, at_the_centre_of_a_sphere_ends_with_a_bound) {
    const auto far = must(must(ModelNearestQuery::make(sphere({}, 1))).farthest({}, {.max_parts = 2000}));
    EXPECT_GE(far.upper_bound, 1);
    EXPECT_LE(far.upper_bound, 1.1);
}

TEST(NearestFaces, refuse_what_is_no_question) {
    const auto query = must(ModelNearestQuery::make(shelf(1)));
    expect_refusal(query.nearest_faces({}, 0), RefusalKind::invalid, "count");
    expect_refusal(query.nearest_faces({}, 1, -1), RefusalKind::invalid, "radius");
    expect_refusal(query.farthest({}, {.accuracy = -1}), RefusalKind::invalid, "accuracy");
    expect_refusal(query.farthest({{kInfinity, 0, 0}}), RefusalKind::nonfinite, "points[0]");
}

}  // namespace
}  // namespace freiform::test
