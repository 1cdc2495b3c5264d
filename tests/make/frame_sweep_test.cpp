#include "support/bezier.hpp"
#include "support/random.hpp"

#include <freiform/make/conic.hpp>
#include <freiform/make/frame_sweep.hpp>

#include <gtest/gtest.h>
#include <numbers>

namespace freiform {
namespace {

using test::bezier;
using test::must;
using test::Random;

// The rotation-minimising frame by many steps of Runge and Kutta: the judge.
Vec<3> frame_at(const Curve<Vec<3>>& rail, Vec<3> r, double to, int steps) {
    const auto turn = [&](double t, const Vec<3>& q) {
        const auto j = rail.jet<2>(t);
        const double c = dot(j.d[1], j.d[1]);
        return (dot(j.d[1], q) / c) * j.d[2] - (dot(j.d[2], q) / c) * j.d[1];
    };
    const double h = to / steps;
    for (int i = 0; i < steps; ++i) {
        const double t = i * h;
        const Vec<3> a = turn(t, r), b = turn(t + h / 2, r + (h / 2) * a),
                     c = turn(t + h / 2, r + (h / 2) * b), d = turn(t + h, r + h * c);
        r += (h / 6) * (a + 2 * b + 2 * c + d);
    }
    return r;
}
const auto kBend = bezier<Vec<3>>({{{0, 0, 0}}, {{2, 0, 0}}, {{2, 2, 1}}, {{0, 3, 3}}});
const auto kProfile = bezier<Vec<2>>({{{0.5, 0}}, {{0.2, 0.4}}, {{-0.3, 0.3}}, {{-0.4, -0.2}}});

TEST(FrameSweep, is_within_its_bound_of_the_exact_swept_surface) {
    const Vec<3> x{{0, 0, 1}};  // orthogonal to the rail at its start
    for (const double tolerance : {0.1, 1e-3, 1e-5, 1e-7}) {
        const auto made = must(sweep(kProfile, kBend, {tolerance, x}));
        EXPECT_LE(made.bound, tolerance);
        double worst = 0;
        for (int j = 0; j <= 37; ++j) {
            const double v = j / 37.0;
            const Vec<3> r = frame_at(kBend, x, v, 1000), s = cross(unit(kBend.jet<1>(v).d[1]), r);
            for (double u : {0.0, 0.3, 0.6, 1.0}) {
                const Vec<2> p = kProfile(u);
                worst = std::max(worst, norm(made.surface(u, v) - kBend(v) - p[0] * r - p[1] * s));
            }
        }
        EXPECT_LE(worst, made.bound + 1e-11) << made.pieces;  // the judge's own error
        std::printf("sweep within %g: %d pieces, error / bound = %.3g\n", tolerance, made.pieces,
                    worst / made.bound);
        EXPECT_GE(worst, 0.05 * made.bound) << made.pieces;
    }
}

TEST(FrameSweep, begins_in_the_direction_that_was_asked_for) {
    const auto made =
        must(sweep(kProfile, kBend, {1e-3, {{5, 0, 1}}}));  // its part along the rail does not count
    for (double u : {0.0, 0.5, 1.0}) {
        const Vec<2> p = kProfile(u);
        EXPECT_LE(norm(made.surface(u, 0.0) - Vec<3>{{0, -p[1], p[0]}}), 1e-15);
    }
    const auto any = must(sweep(kProfile, kBend, {1e-3}));
    EXPECT_NEAR(norm(any.surface(0.5, 0.0)), norm(kProfile(0.5)), 1e-15);
}

TEST(FrameSweep, along_a_straight_rail_is_an_extrusion) {
    const auto line = bezier<Vec<3>>({{{1, 0, 0}}, {{1, 0, 3}}});
    const auto made = must(sweep(kProfile, line, {1e-13, {{1, 0, 0}}}));
    EXPECT_EQ(made.pieces, 1);
    EXPECT_LT(made.bound, 1e-14);
    for (double u : {0.0, 0.4, 1.0})
        for (double v : {0.0, 0.3, 1.0}) {
            const Vec<2> p = kProfile(u);
            EXPECT_LE(norm(made.surface(u, v) - Vec<3>{{1 + p[0], p[1], 3 * v}}), 1e-14);
        }
}

TEST(FrameSweep, in_a_plane_the_frame_keeps_the_normal_of_the_plane) {
    const auto arc = must(Curve<Vec<3>>::make(
        {must(BSplineBasis::make(3, {0, 0, 0, 0, 1, 3, 3, 3, 3}))},
        Net<1, Vec<3>>({5}, {{{0, 0, 0}}, {{1, 0, 0}}, {{2, 1, 0}}, {{1, 3, 0}}, {{-1, 2, 0}}})));
    const auto made = must(sweep(kProfile, arc, {1e-4, {{0, 0, 1}}}));
    for (double u : {0.0, 0.4, 1.0})
        for (double v : {0.0, 0.7, 1.0, 2.2, 3.0}) {
            const Vec<2> p = kProfile(u);
            const Vec<3> q = made.surface(u, v) - arc(v);
            EXPECT_NEAR(q[2], p[0], made.bound);
            EXPECT_NEAR(norm(q), norm(p), made.bound);
            EXPECT_NEAR(dot(q, unit(arc.jet<1>(v).d[1])), 0, made.bound);
        }
}

TEST(FrameSweep, does_not_turn_where_the_curvature_vanishes) {
    // An inflection, at which the Frenet frame jumps to its opposite.
    const auto wave = bezier<Vec<3>>({{{0, 0, 0}}, {{1, 2, 0}}, {{2, -2, 0}}, {{3, 0, 0}}});
    const auto made = must(sweep(kProfile, wave, {1e-3, {{0, 0, 1}}}));
    for (double v : {0.1, 0.45, 0.55, 0.9})
        EXPECT_NEAR(made.surface(0.0, v)[2], kProfile(0.0)[0], made.bound);
}

TEST(FrameSweep, scales_with_powers_of_two) {
    const auto scaled = [](auto curve, int e) {
        auto net = curve.net();
        for (auto& p : net.flat())
            for (double& x : p.c) x = std::scalbn(x, e);
        return must(decltype(curve)::make(curve.bases(), net));
    };
    const auto made = must(sweep(kProfile, kBend, {1e-3}));
    for (const int e : {-700, 700}) {
        const auto far = must(sweep(scaled(kProfile, e), scaled(kBend, e), {std::scalbn(1e-3, e)}));
        EXPECT_EQ(far.pieces, made.pieces);
        for (std::size_t i = 0; i < made.surface.net().flat().size(); ++i)
            for (int c = 0; c < 3; ++c)
                EXPECT_EQ(far.surface.net().flat()[i][c], std::scalbn(made.surface.net().flat()[i][c], e));
    }
}

// A rational rail and profile: a circle swept along a circle about z is a torus, turned nowhere about the
// rail.
TEST(FrameSweep, a_circle_along_a_circle_is_a_torus) {
    const auto ring =
        must(full_ellipse(Conic<3>{ConicKind::ellipse, {}, {{3, 0, 0}}, {{0, 3, 0}}}, EllipseForm::quintic));
    const auto tube =
        must(full_ellipse(Conic<2>{ConicKind::ellipse, {}, {{1, 0}}, {{0, 1}}}, EllipseForm::open));
    for (const double tolerance : {1e-2, 1e-5}) {
        const auto made = must(sweep(tube.curve, ring.curve, {tolerance, {{0, 0, 1}}}));
        EXPECT_LE(made.bound, tolerance);
        double worst = 0;
        for (int i = 0; i <= 16; ++i)
            for (int j = 0; j <= 59; ++j) {
                const double u = i / 16.0, v = j / 59.0;
                const Vec<3> c = ring.curve(v), out = (1.0 / 3) * c;
                const Vec<2> p = tube.curve(u);
                // x of the profile stays z; y = tangent x z is outwards.
                worst =
                    std::max(worst, norm(made.surface(u, v) - (c + p[0] * Vec<3>{{0, 0, 1}} + p[1] * out)));
            }
        std::printf("torus within %g: %d pieces, error / bound = %.3g\n", tolerance, made.pieces,
                    worst / made.bound);
        EXPECT_LE(worst, made.bound);
        EXPECT_GE(worst, 0.05 * made.bound);
    }
}

TEST(FrameSweep, rational_curves_of_weight_one_sweep_what_polynomial_ones_do) {
    const auto a = must(sweep(kProfile, kBend, {1e-4}));
    const auto rational = must(sweep(to_rational(kProfile), to_rational(kBend), {1e-4}));
    EXPECT_EQ(rational.pieces, a.pieces);
    for (double u : {0.0, 0.4, 1.0})
        for (double v : {0.0, 0.3, 0.9}) EXPECT_LE(norm(rational.surface(u, v) - a.surface(u, v)), 1e-13);
    // Weights that are no constant, the same curve: (1 + v) times all.
    const auto line = bezier<Hom<3>>({{{0, 0, 0, 1}}, {{1, 0, 2, 2}}});
    const auto along = must(sweep(kProfile, line, {1e-9, {{1, 0, 0}}}));
    for (double v : {0.0, 0.5, 1.0}) {
        const Vec<3> c = line(v), t = unit(Vec<3>{{1, 0, 2}}), r = unit(Vec<3>{{2, 0, -1}}), s = cross(t, r);
        const Vec<2> p = kProfile(0.25);
        EXPECT_LE(norm(along.surface(0.25, v) - (c + p[0] * r + p[1] * s)), along.bound + 1e-15);
    }
}

TEST(FrameSweep, refuses_rails_without_a_direction) {
    const auto kink = must(Curve<Vec<3>>::make({must(BSplineBasis::make(1, {0, 0, 1, 2, 2}))},
                                               Net<1, Vec<3>>({3}, {{{0, 0, 0}}, {{1, 0, 0}}, {{1, 1, 0}}})));
    EXPECT_EQ(sweep(kProfile, kink, {1e-3}).error().kind, RefusalKind::unsupported);
    const auto cusp = bezier<Vec<3>>({{{0, 0, 0}}, {{1, 1, 0}}, {{0, 1, 0}}, {{1, 0, 0}}});
    EXPECT_EQ(sweep(kProfile, cusp, {1e-3}).error().kind, RefusalKind::ill_conditioned);
    const auto point = bezier<Vec<3>>({{{1, 1, 1}}, {{1, 1, 1}}});
    EXPECT_EQ(sweep(kProfile, point, {1e-3}).error().kind, RefusalKind::ill_conditioned);
    EXPECT_EQ(sweep(kProfile, kBend, {0}).error().where, "tolerance");
    EXPECT_EQ(sweep(kProfile, kBend, {std::nan("")}).error().where, "tolerance");
    EXPECT_EQ(sweep(kProfile, kBend, {1e-3, {{std::nan(""), 0, 0}}}).error().where, "x_at_start");
    EXPECT_FALSE(sweep(kProfile, kBend, {1e-17}));
}

}  // namespace
}  // namespace freiform
