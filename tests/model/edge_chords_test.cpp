// Edges are judged by their distance from chords: bounds against dense samples, and how many points are made.
#include "model/chord_curve_detail.hpp"
#include "support/random.hpp"
#include "support/shapes.hpp"
#include "support/solids.hpp"

#include <freiform/model/deviation.hpp>

#include <gtest/gtest.h>

using namespace freiform;
using namespace freiform::test;

namespace {

double from_chord(const Vec<3>& p, const Vec<3>& a, const Vec<3>& b) {
    const Vec<3> d = b - a;
    const double t = dot(d, d) > 0 ? std::clamp(dot(p - a, d) / dot(d, d), 0.0, 1.0) : 0;
    return norm(p - a - t * d);
}

// Half a circle of radius r about the z-axis as one rational cubic, of uneven speed.
std::vector<Hom<3>> half_circle(double r, double z) {
    std::vector<Hom<3>> out;
    const double x[] = {1, 1, -1, -1}, y[] = {0, 2, 2, 0}, w[] = {1, 1.0 / 3, 1.0 / 3, 1};
    for (int i = 0; i < 4; ++i) out.push_back(weighted(Vec<3>{{r * x[i], r * y[i], z}}, w[i]));
    return out;
}
Surface<Hom<3>> half_cylinder(double r, double height) {
    std::vector<Hom<3>> c;
    const auto below = half_circle(r, 0), above = half_circle(r, height);
    for (std::size_t i = 0; i < 4; ++i) c.push_back(below[i]), c.push_back(above[i]);
    return *Surface<Hom<3>>::make({*BSplineBasis::bezier(3), *BSplineBasis::bezier(1)},
                                  Net<2, Hom<3>>({4, 2}, c));
}

TEST(EdgeChords, distances_from_chords_are_bounded_on_curves_of_every_kind) {
    Random rng(5);
    std::mt19937 engine(6);
    for (int round = 0; round < 60; ++round) {
        CurveGeometry<3> curve = random_patch<1, Hom<3>>(engine, {2 + round % 3}, round % 4);
        if (round % 5 == 0) curve = random_patch<1, Vec<3>>(engine, {3}, 2);
        if (round % 5 == 1) curve = circle({}, {{2, 0, 0}}, {{0, rng.real(0.5, 2), 0}});
        const ChordCurve chords(curve);
        const Interval all = domain(curve)[0];
        for (int k = 0; k < 8; ++k) {
            const double size = all.length() * std::exp2(rng.real(-6, 0)),
                         lo = rng.real(all.lo, all.hi - size);
            const Interval on{lo, lo + size};
            const double enough = std::exp2(rng.real(-20, 0)), bound = chords.across(on, enough);
            const Vec<3> a = jet<0>(curve, on.lo).value(), b = jet<0>(curve, on.hi).value();
            double most = 0;
            for (int i = 0; i <= 64; ++i)
                most = std::max(most, from_chord(jet<0>(curve, on.lo + on.length() * i / 64).value(), a, b));
            EXPECT_LE(most, bound + chords.kinks(on) + 1e-15) << round;
        }
    }
}

TEST(EdgeChords, the_speed_along_a_circle_does_not_matter) {
    const CurveGeometry<3> curve =
        Curve<Hom<3>>::trusted({*BSplineBasis::bezier(3)}, Net<1, Hom<3>>({4}, half_circle(5, 0)));
    const ChordCurve chords(curve);
    for (double t = 0; t < 0.95; t += 0.05) {
        const Vec<3> a = jet<0>(curve, t).value(), b = jet<0>(curve, t + 0.05).value();
        const double sagitta = 5 - norm(0.5 * (a + b));
        const double bound = chords.across({t, t + 0.05}, 0);
        EXPECT_GE(bound, sagitta * (1 - 1e-9));
        EXPECT_LE(bound, 1.35 * sagitta) << t;
    }
}

TEST(EdgeChords, of_lifted_curves_are_those_on_the_surface) {
    const SurfaceGeometry plane =
        Extrusion{Line<3>{{{1, 2, 3}}, {{1, 1, 0}}}, {{0, 0, 2}}, SurfaceKind::plane};
    const SurfaceGeometry wall = half_cylinder(5, 3);
    const SurfaceGeometry cone = Revolution{Line<3>{{{2, 0, 0}}, {{-0.3, 0, 1}}}, {}, {{0, 0, 1}}};
    const CurveGeometry<2> round = Conic<2>{ConicKind::ellipse, {{1, 1}}, {{1, 0}}, {{0, 0.5}}};
    const CurveGeometry<2> across = Line<2>{{{0.1, 0.5}}, {{0.8, 0}}}, along = Line<2>{{{0.3, 0}}, {{0, 1}}};
    const CurveGeometry<2> slanted = Line<2>{{{0, 0}}, {{1, 1}}};
    const auto check = [](const SurfaceGeometry& s, const CurveGeometry<2>& p, bool has) {
        const auto lift = lifted(s, p);
        ASSERT_EQ(lift.has_value(), has);
        if (!has) return;
        const auto on_surface = [&](double t) { return jet<0>(s, jet<0>(p, t).value().c).value(); };
        const auto on_lift = [&](double t) {
            return jet<0>(*lift->geometry, lift->shift + lift->speed * t).value();
        };
        for (double t = 0; t < 0.9; t += 0.1)
            EXPECT_NEAR(norm(on_surface(t + 0.1) - on_surface(t)), norm(on_lift(t + 0.1) - on_lift(t)),
                        1e-14);
    };
    check(plane, round, true);
    check(plane, slanted, true);
    check(wall, across, true);
    check(wall, along, true);
    check(wall, slanted, false);
    check(cone, across, true);
    check(cone, along, true);
    check(cone, slanted, false);
}

TEST(EdgeChords, borders_of_rational_cylinders_take_the_chords_of_circles) {
    ModelBuilder builder;
    ASSERT_TRUE(builder.add(half_cylinder(5, 40)));
    const auto model = std::move(builder).finish();
    ASSERT_TRUE(model);
    for (const double tolerance : {0.03, 0.003}) {
        const auto t = tessellate(*model, {.tolerance = tolerance});
        ASSERT_TRUE(t && t->refused.empty());
        EXPECT_LE(t->error_bound, tolerance);
        const double chords = std::ceil(kPi / (2 * std::acos(1 - tolerance / 5)));
        EXPECT_LE(double(t->topology.open_edges), 2 * 1.6 * chords + 2) << tolerance;
        EXPECT_GE(double(t->topology.open_edges), 2 * chords + 2) << tolerance;
        EXPECT_LE(sampled_deviation(*model, *t, 6), t->error_bound + t->boundary_gap);
    }
}

// Trimmed by uneven curves of every kind: on the boundary points of mesh and face do not correspond.
TEST(EdgeChords, faces_between_uneven_edges_stay_within_the_bound) {
    Random rng(9);
    for (int round = 0; round < 4; ++round) {
        std::vector<Hom<2>> hole;
        const double x[] = {1, 1, -1, -1}, w[] = {1, 0.3, 0.2, 1};
        const double y[] = {0, 2, 2, 0};
        for (int i = 0; i < 4; ++i)
            hole.push_back(weighted(Vec<2>{{0.5 + 0.3 * x[i], 0.3 + 0.2 * y[i]}}, w[i] * rng.real(0.8, 1.2)));
        const CurveGeometry<2> arc =
            Curve<Hom<2>>::trusted({*BSplineBasis::bezier(3)}, Net<1, Hom<2>>({4}, hole));
        const Vec<2> a = jet<0>(arc, 0).value(), b = jet<0>(arc, 1).value();
        ModelBuilder builder;
        const CurveGeometry<2> chord =
            Curve<Vec<2>>::trusted({*BSplineBasis::bezier(1)}, Net<1, Vec<2>>({2}, {b, a}));
        const std::vector<std::vector<CurveGeometry<2>>> loops{{arc, chord}};
        std::mt19937 engine{std::uint_fast32_t(round)};
        ModelBuilder::SplineSurface surface = half_cylinder(5, 12);
        if (round % 2) surface = landscape(engine, 3, 5, 0.3);
        ASSERT_TRUE(builder.add_trimmed(surface, loops, "", {}));
        const auto model = std::move(builder).finish();
        ASSERT_TRUE(model);
        const double tolerance = round % 2 ? 0.002 : 0.02;
        const auto t = tessellate(*model, {.tolerance = tolerance});
        ASSERT_TRUE(t && t->refused.empty());
        EXPECT_LE(t->error_bound, tolerance);
        const auto d = deviation(*model, t->mesh, {.enough = tolerance, .max_parts = 600});
        ASSERT_TRUE(d);
        EXPECT_LE(d->measured, t->error_bound + t->boundary_gap) << round;
        EXPECT_GE(d->measured, 0.2 * tolerance) << round;
    }
}

}  // namespace
