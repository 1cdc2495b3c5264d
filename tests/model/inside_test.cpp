#include "support/sanitizer.hpp"
#include "support/solids.hpp"

#include <freiform/model/inside.hpp>

#include <cmath>
#include <gtest/gtest.h>
#include <random>

namespace freiform {
namespace {

double uniform(std::mt19937& rng) { return double(rng() >> 5) * 0x1p-27; }

TEST(R27, a_point_in_a_closed_body_is_told_from_one_outside) {
    const Model ball = test::sphere({{1, 2, 3}}, 2);
    const auto in = inside_solid(
        ball, std::vector<Vec<3>>{{{1, 2, 3}}, {{2.9, 2, 3}}, {{3.1, 2, 3}}, {{1, 2, 5.5}}, {{9, 9, 9}}},
        1e-3);
    ASSERT_TRUE(in) << in.error().message;
    const Place want[] = {Place::inside, Place::inside, Place::outside, Place::outside, Place::outside};
    for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ((*in)[i].place, want[i]) << i;
    EXPECT_EQ((*in)[0].winding, 1);
}

TEST(InsideSolid, answers_of_a_torus_are_right_and_their_distances_hold) {
    const double R = 3, r = 1, accuracy = 4e-3;
    const Model torus = test::torus(R, r);
    std::mt19937 rng(12);
    std::vector<Vec<3>> points;
    for (int i = 0; i < 300; ++i)
        points.push_back({{9 * uniform(rng) - 4.5, 9 * uniform(rng) - 4.5, 3 * uniform(rng) - 1.5}});
    for (int i = 0; i < 100; ++i) {  // near the surface, on either side of it
        const double a = 7 * uniform(rng), b = 7 * uniform(rng), away = std::pow(10, -1 - 5 * uniform(rng));
        const double tube = r + (i % 2 ? away : -away), axis = R + tube * std::cos(b);
        points.push_back({{axis * std::cos(a), axis * std::sin(a), tube * std::sin(b)}});
    }
    const auto in = inside_solid(torus, points, accuracy);
    ASSERT_TRUE(in) << in.error().message;
    int boundary = 0;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const Vec<3>& p = points[i];
        const double signed_distance = std::hypot(std::hypot(p[0], p[1]) - R, p[2]) - r;
        const SolidInside& s = (*in)[i];
        if (s.place == Place::boundary) {
            ++boundary;
            EXPECT_LE(std::abs(signed_distance), s.distance);
            EXPECT_LE(s.distance, accuracy);
        } else {
            EXPECT_EQ(s.place, signed_distance < 0 ? Place::inside : Place::outside) << i;
            EXPECT_GE(std::abs(signed_distance), s.distance);
        }
        if (std::abs(signed_distance) > accuracy) EXPECT_NE(s.place, Place::boundary) << i;
    }
    EXPECT_GT(boundary, 10);
    EXPECT_LT(boundary, 80);
}

TEST(InsideSolid, open_models_and_nonsense_are_refused) {
    ModelBuilder builder;
    std::vector<Vec<3>> net = {{{0, 0, 0}}, {{0, 1, 0}}, {{1, 0, 0}}, {{1, 1, 1}}};
    const auto linear = *BSplineBasis::bezier(1);
    ASSERT_TRUE(builder.add(*Surface<Vec<3>>::make({linear, linear}, Net<2, Vec<3>>({2, 2}, net))));
    const auto sheet = std::move(builder).finish();
    ASSERT_TRUE(sheet);
    const std::vector<Vec<3>> origin = {{{0, 0, 0}}}, nan = {{{0, NAN, 0}}};
    EXPECT_EQ(inside_solid(*sheet, origin, 1e-3).error().kind, RefusalKind::no_answer);
    const Model ball = test::sphere({}, 1);
    EXPECT_EQ(inside_solid(ball, nan, 1e-3).error().kind, RefusalKind::nonfinite);
    EXPECT_EQ(inside_solid(ball, origin, 0).error().kind, RefusalKind::invalid);
    EXPECT_EQ(inside_solid(ball, origin, 1e-3, 10).error().kind, RefusalKind::limit);
}

// A mesh that is as near would have millions of triangles.
TEST(InsideSolid, points_near_the_surface_are_decided_by_a_coarse_mesh) {
    const double R = 3, r = 1, accuracy = 1e-8;
    std::mt19937 rng(14);
    std::vector<Vec<3>> points;
    std::vector<double> away;
    for (int i = 0; i < 3 * test::cases(20); ++i) {
        const double a = 7 * uniform(rng), b = 7 * uniform(rng), d = std::pow(10, -1 - 6 * uniform(rng));
        away.push_back(i % 3 == 2 ? 0 : i % 3 == 1 ? d : -d);
        const double tube = r + away.back(), axis = R + tube * std::cos(b);
        points.push_back({{axis * std::cos(a), axis * std::sin(a), tube * std::sin(b)}});
    }
    const auto in = inside_solid(test::torus(R, r), points, accuracy, 5000);
    ASSERT_TRUE(in) << in.error().message;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const SolidInside& s = (*in)[i];
        if (away[i] == 0) {
            EXPECT_EQ(s.place, Place::boundary) << i;
            EXPECT_LE(s.distance, accuracy) << i;
        } else {
            EXPECT_EQ(s.place, away[i] < 0 ? Place::inside : Place::outside) << i << ": " << away[i];
            EXPECT_LE(s.distance, std::abs(away[i]) + 1e-14) << i;
            EXPECT_GE(s.distance, std::abs(away[i]) - accuracy) << i;
        }
    }
}

// The circle of an edge is 1e-4 beside the faces that meet there: as near as that there is no side.
TEST(InsideSolid, nearer_than_faces_are_from_each_other_the_side_is_left_open) {
    Model can = test::frustum(1, 1, 1);
    std::get<Conic<3>>(*can.edges[1].curve).x[0] += 1e-4;
    std::get<Conic<3>>(*can.edges[1].curve).y[1] += 1e-4;
    can = test::in_one_body(std::move(can));
    const auto beside = [](double d) { return (1 + d) * Vec<3>{{0.6, 0.8, 0}} + Vec<3>{{0, 0, 0.5}}; };
    const std::vector<Vec<3>> points = {beside(0), beside(5e-5), beside(-5e-5), beside(1e-3), beside(-1e-3)};
    const auto in = inside_solid(can, points, 1e-8, 20000);
    ASSERT_TRUE(in) << in.error().message;
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ((*in)[i].place, Place::boundary) << i;
        EXPECT_NEAR((*in)[i].distance, i == 0 ? 0 : 5e-5, 1e-8) << i;
    }
    EXPECT_EQ((*in)[3].place, Place::outside);
    EXPECT_EQ((*in)[4].place, Place::inside);
}

// Between two spheres that are nearer to each other than any mesh within the budget can tell.
TEST(InsideSolid, the_side_in_a_wall_too_thin_for_the_budget_is_left_open) {
    Model shell = test::sphere({}, 1);
    const Model inner = test::sphere({}, 1 - 1e-6);
    shell.vertices.insert(shell.vertices.end(), inner.vertices.begin(), inner.vertices.end());
    for (Edge e : inner.edges) {
        e.start += 2, e.end += 2;
        shell.edges.push_back(e);
    }
    Face face = inner.faces[0];
    face.reversed = true;
    for (Coedge& c : face.loops[0].coedges) c.edge += 3;
    shell.faces.push_back(face);
    shell = test::in_one_body(std::move(shell));
    const Vec<3> along = unit(Vec<3>{{3, 4, 5}});
    const std::vector<Vec<3>> points = {(1 - 5e-7) * along, 0.99999 * along, 1.00001 * along, along};
    const auto in = inside_solid(shell, points, 1e-8, 3000);
    ASSERT_TRUE(in) << in.error().message;
    EXPECT_EQ((*in)[0].place, Place::boundary);
    EXPECT_GE((*in)[0].distance, 4.999e-7);
    EXPECT_LE((*in)[0].distance, 6e-7);
    EXPECT_EQ((*in)[1].place, Place::outside);  // in the void
    EXPECT_EQ((*in)[2].place, Place::outside);
    EXPECT_EQ((*in)[3].place, Place::boundary);
    EXPECT_LE((*in)[3].distance, 1e-8);
}

}  // namespace
}  // namespace freiform
