// How faces meet: solids with known angles, and random patches against samples.
#include <freiform/model/edge_continuity.hpp>

#include <gtest/gtest.h>
#include <support/random.hpp>
#include <support/refusal.hpp>
#include <support/sanitizer.hpp>
#include <support/solids.hpp>

namespace freiform::test {
namespace {

constexpr EdgeContinuityOptions kTight{.gap = 1e-9, .angle = 1e-3, .curvature = 1e-6};

TEST(EdgeContinuity, seams_of_round_solids_are_smooth) {
    for (const Model& m : {sphere({{1, 2, 3}}, 2), torus(3, 1)})
        for (const EdgeContinuity& j : must(edge_continuity(m, kTight))) {
            EXPECT_EQ(j.g_order, 2) << j.edge << " angle " << j.angle_bound << " gap " << j.gap_bound;
            EXPECT_EQ(j.face[0], j.face[1]);
            EXPECT_LE(j.angle_bound, 1e-3);
            EXPECT_EQ(j.singular, m.vertices.size() == 2) << "the poles of the sphere";
        }
}

// Two bicubic patches over [0, 1]^2 that share the edge u = 1 of the first, of the given heights of points.
Model pair_of(const std::function<Vec<3>(int, int)>& first, const std::function<Vec<3>(int, int)>& second) {
    ModelBuilder builder;
    for (const auto* point : {&first, &second}) {
        std::vector<Vec<3>> net;
        for (int i = 0; i < 4; ++i)
            for (int j = 0; j < 4; ++j) net.push_back((*point)(i, j));
        const auto basis = must(BSplineBasis::bezier(3));
        EXPECT_TRUE(builder.add(must(Surface<Vec<3>>::make({basis, basis}, Net<2, Vec<3>>({4, 4}, net)))));
    }
    return must(std::move(builder).finish());
}

TEST(EdgeContinuity, of_two_planes_is_their_angle) {
    for (const double angle : {0.0, 1e-5, 0.3, 1.5, 3.0}) {
        const auto m = pair_of(
            [](int i, int j) {
                return Vec<3>{{i - 3.0, double(j), 0}};
            },
            [&](int i, int j) {
                return Vec<3>{{i * std::cos(angle), double(j), i * std::sin(angle)}};
            });
        const auto all = must(edge_continuity(m, kTight));
        ASSERT_EQ(all.size(), 1u);
        EXPECT_NEAR(all[0].angle, angle, 1e-14);
        EXPECT_GE(all[0].angle_bound, angle);
        EXPECT_LE(all[0].angle_bound, std::max(1.03 * angle, 1e-3));
        EXPECT_EQ(all[0].g_order, angle < 1e-4 ? 2 : 0);
    }
}

TEST(EdgeContinuity, bounds_hold_between_the_samples_and_are_near_to_them) {
    Random random(8);
    for (int k = 0; k < cases(10); ++k) {
        std::array<std::array<double, 4>, 8> z;
        for (auto& row : z)
            for (double& x : row) x = random.real(-1, 1);
        z[4] = z[3];
        if (k % 2)  // tangent planes agree, curvatures do not
            for (std::size_t j = 0; j < 4; ++j) z[5][j] = 2 * z[3][j] - z[2][j];
        const auto m = pair_of(
            [&](int i, int j) {
                return Vec<3>{{i - 3.0, double(j), z[std::size_t(i)][std::size_t(j)]}};
            },
            [&](int i, int j) {
                return Vec<3>{{double(i), double(j), z[std::size_t(4 + i)][std::size_t(j)]}};
            });
        const auto all = must(edge_continuity(m, {.gap = 1e-9, .angle = 1e-3, .curvature = 1e-3}));
        ASSERT_EQ(all.size(), 1u);
        const EdgeContinuity& joint = all[0];
        double most = 0;
        for (int i = 0; i <= 3000; ++i) {
            const double v = i / 3000.0;
            Vec<3> n[2];
            for (std::size_t f = 0; f < 2; ++f) n[f] = normal(m.faces[f].surface, {f == 0 ? 1.0 : 0.0, v});
            most = std::max(most, 2 * std::asin(norm(n[0] - n[1]) / 2));
        }
        EXPECT_LE(most, joint.angle_bound);
        EXPECT_LE(joint.angle, joint.angle_bound);
        EXPECT_LE(joint.angle_bound, std::max(1.02 * joint.angle, 1e-3)) << k;
        EXPECT_EQ(joint.g_order, k % 2) << joint.curvature;
        EXPECT_EQ(joint.curvature > 1e-3, k % 2 == 1);
    }
}

TEST(EdgeContinuity, curvatures_differ_where_a_plane_goes_over_into_a_cylinder) {
    // A quarter of a parabola z = x^2 / 4 beside the plane: curvature 1/2 at the edge.
    const auto m = pair_of(
        [](int i, int j) {
            return Vec<3>{{i - 3.0, double(j), 0}};
        },
        [](int i, int j) {
            return Vec<3>{{double(i), double(j), i < 2 ? 0 : i == 2 ? 0.75 : 2.25}};
        });
    const auto all = must(edge_continuity(m, kTight));
    ASSERT_EQ(all.size(), 1u);
    EXPECT_EQ(all[0].g_order, 1);
    EXPECT_NEAR(all[0].curvature, 0.5, 1e-12);
}

TEST(EdgeContinuity, refuses_negative_allowances) {
    expect_refusal(edge_continuity(torus(3, 1), {.angle = -1}), RefusalKind::invalid, "angle");
}

}  // namespace
}  // namespace freiform::test
