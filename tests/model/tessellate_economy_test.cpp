// How many triangles are made, and that the fewer they are the bound still holds: by `deviation`, which knows
// nothing of how meshes are made.
#include "support/random.hpp"
#include "support/shapes.hpp"
#include "support/solids.hpp"

#include <freiform/model/deviation.hpp>

#include <gtest/gtest.h>

using namespace freiform;
using namespace freiform::test;

namespace {

// Triangles that a surface of constant curvatures cannot do without: chords of length sqrt(8 r tolerance).
double steps(double angle, double r, double tolerance) { return angle / std::sqrt(8 * tolerance / r); }

TEST(TessellateEconomy, walls_of_cones_are_judged_by_their_chords) {
    for (const double tolerance : {1e-2, 1e-3}) {
        const auto t = tessellate(frustum(2, 1, 3), {.tolerance = tolerance});
        ASSERT_TRUE(t);
        EXPECT_LE(t->error_bound, tolerance);
        EXPECT_EQ(t->topology.open_edges, 0);
        const double around = steps(2 * kPi, 2, tolerance);
        EXPECT_LE(double(t->mesh.triangles.size()), 16 * around) << "of " << tolerance;
        const auto d = deviation(frustum(2, 1, 3), t->mesh, {.enough = tolerance, .max_parts = 1'000});
        ASSERT_TRUE(d);
        EXPECT_LE(d->measured, t->error_bound + t->boundary_gap);
        EXPECT_GE(d->measured, 0.3 * tolerance);
        EXPECT_LE(d->mesh_measured, t->error_bound + t->boundary_gap + d->accuracy);
    }
}

TEST(TessellateEconomy, spheres_of_any_size_take_as_many_triangles) {
    for (const double r : {1e6, 1e-5}) {
        const double tolerance = std::ldexp(r, -7);
        const Model m = test::sphere({}, r);
        const auto t = tessellate(m, {.tolerance = tolerance});
        ASSERT_TRUE(t);
        EXPECT_LE(t->error_bound, tolerance);
        // Equilateral triangles with a circumradius of sqrt(2 r tolerance) have the area 2.6 r tolerance.
        const double least = 4 * kPi * r / (2.6 * tolerance);
        EXPECT_LE(double(t->mesh.triangles.size()), 5 * least);
        const double deviation = sampled_deviation(m, *t, 3);
        EXPECT_LE(deviation, t->error_bound + t->boundary_gap);
        EXPECT_GE(deviation, 0.4 * tolerance);
    }
}

// Rational surfaces move points along themselves; here with poles, kinks in speed, and ends of all kinds.
TEST(TessellateEconomy, bounds_hold_where_points_move_along_the_surface) {
    Random rng(31);
    for (int round = 0; round < 2; ++round) {
        const auto basis = *BSplineBasis::clamped_uniform(round % 2 ? 2 : 3, 6);
        const double bend = rng.real(0.8, 1.5), lean = rng.real(-0.5, 0.5);
        std::vector<Hom<3>> c;
        for (int i = 0; i < 6; ++i)
            for (int k = 0; k < 6; ++k) {
                const double w = std::exp2(rng.real(-0.3, 0.3)), angle = bend * i / 5.0,
                             r = 1 + lean * k / 5.0 + 0.003 * rng.real(-1, 1);
                const double slide = rng.real(-0.02, 0.02);
                c.push_back(weighted(
                    Vec<3>{{r * std::cos(angle + slide), r * std::sin(angle + slide), 0.4 * k + 2 * slide}},
                    w));
            }
        ModelBuilder builder;
        ASSERT_TRUE(builder.add(*Surface<Hom<3>>::make({basis, basis}, Net<2, Hom<3>>({6, 6}, c))));
        const auto model = std::move(builder).finish();
        ASSERT_TRUE(model);
        const double tolerance = std::ldexp(0.004, -2 * round);
        const auto t = tessellate(*model, {.tolerance = tolerance});
        ASSERT_TRUE(t);
        ASSERT_TRUE(t->refused.empty()) << t->refused[0].reason.message;
        EXPECT_LE(t->error_bound, tolerance);
        const double found = sampled_deviation(*model, *t, 4);
        EXPECT_LE(found, t->error_bound + t->boundary_gap) << round;
        EXPECT_GE(found, 0.2 * tolerance) << round;
        const auto d = deviation(*model, t->mesh, {.enough = tolerance, .max_parts = 300});
        ASSERT_TRUE(d);
        EXPECT_LE(d->measured, t->error_bound + t->boundary_gap) << round;
    }
}

// A quarter of a torus tube: arcs of a quarter of a circle, `arcs` of them with double knots between, about
// the z-axis at the distance 3; coordinates are rounded to multiples of `grain`.
Surface<Hom<3>> bow(int arcs, double grain) {
    std::vector<double> knots{0, 0, 0};
    for (int i = 1; i < arcs; ++i) knots.insert(knots.end(), 2, double(i));
    knots.insert(knots.end(), 3, double(arcs));
    const auto along = *BSplineBasis::make(2, knots);
    const double corner[5][2] = {{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}}, w[3] = {1, std::sqrt(0.5), 1};
    std::vector<Hom<3>> c;
    for (int i = 0; i <= 2 * arcs; ++i)
        for (int k = 0; k < 3; ++k) {
            const double r = 3 + corner[k][0];
            const double x = r * corner[i][0], y = r * corner[i][1], turn = 0.3;
            Vec<3> p{{std::cos(turn) * x - std::sin(turn) * y, std::sin(turn) * x + std::cos(turn) * y,
                      corner[k][1]}};
            for (double& at : p.c) at = grain > 0 ? std::round(at / grain) * grain : at;
            c.push_back(weighted(p, w[i % 2] * w[k % 2]));
        }
    return *Surface<Hom<3>>::make({along, *BSplineBasis::bezier(2)}, Net<2, Hom<3>>({2 * arcs + 1, 3}, c));
}

TEST(TessellateEconomy, knots_that_are_kinks_by_the_digits_of_a_file_cost_nothing) {
    const auto triangles = [](const Surface<Hom<3>>& s, double tolerance) {
        ModelBuilder builder;
        EXPECT_TRUE(builder.add(s));
        const Model m = *std::move(builder).finish();
        const auto t = tessellate(m, {.tolerance = tolerance});
        EXPECT_TRUE(t && t->refused.empty());
        EXPECT_LE(t->error_bound, tolerance);
        const double deviation = sampled_deviation(m, *t, 3);
        EXPECT_LE(deviation, t->error_bound + t->boundary_gap);
        EXPECT_GE(deviation, 0.3 * tolerance);
        return double(t->mesh.triangles.size());
    };
    const double one = triangles(bow(1, 0), 1e-3), rounded = triangles(bow(2, 1e-7), 1e-3);
    EXPECT_LE(rounded, 2.3 * one);
    EXPECT_GE(triangles(bow(2, 1e-4), 1e-3), 1.25 * rounded) << "kinks that matter are still kinks";
}

}  // namespace
