#include "support/bezier.hpp"

#include <freiform/make/joint.hpp>
#include <freiform/query/continuity.hpp>

#include <gtest/gtest.h>
#include <numbers>

namespace freiform {
namespace {

using test::bezier;
using test::must;
using test::Random;
using test::random_bezier;

template <class P>
Curve<P> spline(int degree, std::vector<double> knots, std::vector<P> b) {
    const int n = int(b.size());
    return must(
        Curve<P>::make({must(BSplineBasis::make(degree, std::move(knots)))}, Net<1, P>({n}, std::move(b))));
}

TEST(R09, g1_is_parallel_tangents_of_the_same_sense) {
    const auto a = bezier<Vec<2>>({{{0, 0}}, {{1, 0}}});
    EXPECT_EQ(must(joint(a, bezier<Vec<2>>({{{1, 0}}, {{4, 0}}}))).g_order, 3);  // a straight line
    const auto same = must(joint(a, bezier<Vec<2>>({{{1, 0}}, {{4, 0}}, {{5, 2}}})));
    EXPECT_EQ(same.g_order, 1);
    EXPECT_EQ(same.c_order, 0);
    const auto back = must(joint(a, bezier<Vec<2>>({{{1, 0}}, {{0.5, 0}}, {{0, 2}}})));
    EXPECT_EQ(back.g_order, 0);
    EXPECT_TRUE(back.opposed);
    EXPECT_DOUBLE_EQ(back.g[1].size, std::numbers::pi);
    const auto corner = must(joint(a, bezier<Vec<2>>({{{1, 0}}, {{2, 1}}})));
    EXPECT_EQ(corner.g_order, 0);
    EXPECT_FALSE(corner.opposed);
    EXPECT_NEAR(corner.g[1].size, std::numbers::pi / 4, corner.g[1].bound);
    EXPECT_LT(corner.g[1].bound, 1e-14);
    const auto gap = must(joint(a, bezier<Vec<2>>({{{4, 4}}, {{5, 4}}})));
    EXPECT_EQ(gap.g_order, -1);
    EXPECT_EQ(gap.c_order, -1);
    EXPECT_NEAR(gap.first_c_jump()->size, 5, 1e-14);
}

TEST(R09, curvature_is_the_cross_product_over_the_cubed_speed) {
    Random random(1);
    for (int i = 0; i < 20; ++i) {
        const auto c = random_bezier<Vec<3>>(random, 4), next = random_bezier<Vec<3>>(random, 3);
        const auto j = must(joint(c, next));
        const auto d = c.jet<3>(1);
        const Vec<3> b = cross(d(1), d(2));
        const double kappa = norm(b) / std::pow(norm(d(1)), 3), tau = dot(b, d(3)) / dot(b, b);
        EXPECT_NEAR(j.before.curvature->value, kappa, 1e-12 * kappa);
        EXPECT_NEAR(j.before.torsion->value, tau, 1e-11 * (1 + std::abs(tau)));
        for (int k = 0; k < 3; ++k) EXPECT_NEAR(j.before.binormal[std::size_t(k)], unit(b)[k], 1e-12);
    }
    const auto plane =
        must(joint(bezier<Vec<2>>({{{0, 0}}, {{1, 0}}, {{2, 1}}}), bezier<Vec<2>>({{{2, 1}}, {{3, 3}}})));
    const double kappa = cross(Vec<2>{{2, 2}}, Vec<2>{{0, 2}}) / std::pow(8, 1.5);
    EXPECT_NEAR(plane.before.curvature->value, kappa, 1e-15);  // left turns are positive
    const auto right =
        must(joint(bezier<Vec<2>>({{{0, 0}}, {{1, 0}}, {{2, -1}}}), bezier<Vec<2>>({{{2, -1}}, {{3, -3}}})));
    EXPECT_NEAR(right.before.curvature->value, -kappa, 1e-15);
}

TEST(R09, g2_of_an_arc_and_a_parabola_that_osculates_it) {
    const double s = std::sqrt(0.5);
    // Quarter circle of radius 1 about the origin from (0, -1) to (1, 0), then parabolas up from there.
    const auto arc = bezier<Hom<2>>(
        {weighted(Vec<2>{{0, -1}}, 1), weighted(Vec<2>{{1, -1}}, s), weighted(Vec<2>{{1, 0}}, 1)});
    // (1, 0), (1, b), (1 - h, 2 b): c' = (0, 2b), c'' = (-2h, 0), curvature 4 b h / 8 b^3 = 1 for h = 2 b^2.
    const auto osculating = bezier<Vec<2>>({{{1, 0}}, {{1, 0.5}}, {{0.5, 1}}});
    const auto g2 = must(joint(arc, osculating));
    EXPECT_EQ(g2.g_order, 3);  // at its vertex a parabola and its circle meet with G3
    EXPECT_EQ(g2.c_order, 0);
    EXPECT_NEAR(g2.before.curvature->value, 1, g2.before.curvature->bound);
    const auto g1 = must(joint(arc, bezier<Vec<2>>({{{1, 0}}, {{1, 0.5}}, {{0, 1}}})));
    EXPECT_EQ(g1.g_order, 1);
    EXPECT_NEAR(g1.g[2].size, 1, 1e-14);  // curvature 2 after 1
}

// A helix x = r cos t, y = r sin t, z = h t expanded to order 7 at t = 0: the
// curvature is r / (r^2 + h^2), the torsion h / (r^2 + h^2).
Curve<Vec<3>> helix(double r, double h, bool backwards) {
    std::vector<Vec<3>> b(8);
    const double s = backwards ? -1 : 1;
    for (int i = 0; i < 8; ++i)
        for (int j = 0; j <= i; ++j) {
            const double a = binomial(i, j) / binomial(7, j), f = std::tgamma(j + 1);
            const double x = j % 2 == 0 ? (j % 4 == 0 ? 1 : -1) / f : 0,
                         y = j % 2 == 1 ? (j % 4 == 1 ? 1 : -1) / f * s : 0;
            b[std::size_t(i)] += Vec<3>{{a * r * x, a * r * y, j == 1 ? a * h * s : 0}};
        }
    if (backwards) std::reverse(b.begin(), b.end());
    return bezier(std::move(b));
}

TEST(R09, helices_of_equal_curvature_and_other_torsion_are_g2_in_space) {
    // r / (r^2 + h^2) = 1/2 for r = 1, h = 1 and, left-handed, for h = -1: torsion 1/2 and -1/2. Rotated so
    // that the tangents agree.
    const auto right = helix(1, 1, true);
    Curve<Vec<3>> left = helix(1, -1, false);
    std::vector<Vec<3>> b(left.net().flat().begin(), left.net().flat().end());
    for (Vec<3>& p : b)
        p = Vec<3>{{p[0], -p[2], p[1]}};  // quarter turn about the x-axis: (0, 1, -1) -> (0, 1, 1)
    const auto j = must(joint(right, bezier(std::move(b))));
    EXPECT_EQ(j.g_order, 2);
    EXPECT_NEAR(j.before.curvature->value, 0.5, 1e-14);
    EXPECT_NEAR(j.after.curvature->value, 0.5, 1e-14);
    EXPECT_NEAR(j.before.torsion->value, 0.5, 1e-13);
    EXPECT_NEAR(j.after.torsion->value, -0.5, 1e-13);
    EXPECT_NEAR(j.g[3].size, 0.5, 1e-13);  // kappa |tau - tau'|
    EXPECT_LE(j.binormal->size, j.binormal->bound);
    const auto whole = must(joint(right, helix(1, 1, false)));
    EXPECT_EQ(whole.g_order, 3);
    EXPECT_EQ(whole.c_order, 7);
}

TEST(R09, a_knot_of_multiplicity_m_leaves_d_minus_m_derivatives) {
    Random random(9);
    for (int d = 1; d <= 6; ++d)
        for (int m = 1; m <= d + 1; ++m) {
            std::vector<double> t(std::size_t(d) + 1, 0.0);
            t.insert(t.end(), std::size_t(m), 1.0);
            t.insert(t.end(), std::size_t(d) + 1, 2.5);
            std::vector<Vec<3>> b;
            for (int i = 0; i < d + 1 + m; ++i) b.push_back(test::random_coefficient<Vec<3>>(random));
            const auto all = must(continuity(spline(d, t, b)));
            ASSERT_EQ(all.size(), 1u);
            EXPECT_EQ(all[0].multiplicity, m);
            EXPECT_EQ(all[0].joint.c_order, d - m) << d << " " << m;
            EXPECT_EQ(all[0].joint.g_order, std::min(d - m, 3)) << d << " " << m;
            EXPECT_FALSE(all[0].removable);
            EXPECT_EQ(all[0].at, 1);
        }
}

TEST(R11, a_tripled_control_point_is_c2_with_zero_derivative_and_not_g1) {
    const Vec<2> corner{{2, 3}};
    const auto c = spline<Vec<2>>(3, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10},
                                  {{{0, 0}}, {{1, 1}}, corner, corner, corner, {{4, 0}}, {{5, 1}}});
    const auto all = must(continuity(c));
    ASSERT_EQ(all.size(), 3u);
    const Continuity& j = all[1].joint;  // knot 5: where the three coefficients alone count
    EXPECT_EQ(all[1].at, 5);
    EXPECT_EQ(j.c_order, 2);
    EXPECT_TRUE(j.singular);
    EXPECT_EQ(j.g_order, 0);
    EXPECT_EQ(j.unbounded, 0);
    ASSERT_EQ(j.g.size(), 4u);  // straight on both sides: curvature 0
    EXPECT_EQ(j.g[2].size, 0);
    // The straight pieces run along (1, 2) and (2, -3).
    EXPECT_NEAR(j.g[1].size, std::acos((2 - 6) / std::sqrt(5 * 13)), 1e-14);
    EXPECT_EQ(all[0].joint.g_order, 2);
    EXPECT_FALSE(all[0].joint.singular);
}

TEST(Continuity, a_cusp_turns_back_and_a_stop_does_not) {
    // (t^2, t^3) as a spline with a removable knot at 0: C-infinity, and a cusp.
    const auto half = [](std::vector<Vec<2>> b) { return bezier(std::move(b)); };
    const auto in = half({{{1, -1}}, {{1.0 / 3, 0}}, {{0, 0}}, {{0, 0}}}),
               out = half({{{0, 0}}, {{0, 0}}, {{1.0 / 3, 0}}, {{1, 1}}});
    const auto cusp = must(joint(in, out));
    EXPECT_EQ(cusp.c_order, 3);
    EXPECT_TRUE(cusp.singular);
    EXPECT_TRUE(cusp.opposed);
    EXPECT_EQ(cusp.g_order, 0);
    EXPECT_EQ(cusp.unbounded, 2);  // its curvature is infinite
    EXPECT_EQ(cusp.g.size(), 2u);
    EXPECT_TRUE(cusp.phi.empty());
    // (t^3, 0): stops and goes on.
    const auto stop = must(joint(half({{{-1, 0}}, {{0, 0}}, {{0, 0}}, {{0, 0}}}),
                                 half({{{0, 0}}, {{0, 0}}, {{0, 0}}, {{1, 0}}})));
    EXPECT_EQ(stop.g_order, 3);  // a straight line, whatever its speed is
    EXPECT_TRUE(stop.singular);
    EXPECT_EQ(stop.unbounded, 0);
    // A piece that is one point has no tangent.
    const auto none = must(joint(in, bezier<Vec<2>>({{{0, 0}}, {{0, 0}}})));
    EXPECT_EQ(none.g.size(), 1u);
    EXPECT_EQ(none.g_order, 0);
}

// c(t^r) is singular and has the shape of c: every answer about the shape is that for c.
TEST(Continuity, of_singular_sides_is_that_of_the_shape_run_through_regularly) {
    Random random(77);
    for (const int r : {2, 3, 4})
        for (int round = 0; round < 6; ++round) {
            // A cubic c with c' != 0 at both ends, and c(t^r) in Bezier form of degree 3 r, exactly:
            // B_i^3(t^r) has the monomial coefficients of c at the powers of t^r.
            const auto shape = [&] {
                std::vector<Vec<3>> m(4);
                for (auto& v : m) v = Vec<3>{{random.real(-1, 1), random.real(-1, 1), random.real(-1, 1)}};
                m[1] += Vec<3>{{2, 0, 0}};
                return m;
            };
            const auto in_powers = [](const std::vector<Vec<3>>& m, int power) {
                const int n = 3 * power;
                std::vector<Vec<3>> b(std::size_t(n) + 1);
                for (int i = 0; i <= n; ++i)
                    for (int k = 0; k <= 3 && k * power <= i; ++k)
                        b[std::size_t(i)] += double(binomial(i, k * power)) / double(binomial(n, k * power)) *
                                             m[std::size_t(k)];
                return bezier(std::move(b));
            };
            auto m1 = shape(), m2 = shape();
            // The second starts like the first: from G0 to G2 in turn.
            m2[0] = m1[0];
            if (round % 3 > 0) m2[1] = -m1[1];
            if (round % 3 > 1) m2[2] = m1[2];
            const auto options = ContinuityOptions{.orders = 3, .tolerance = 1e-9, .roundings = 16};
            const auto flipped = [&](const auto& c) { return must(leaving(c, End::start, options)); };
            const auto arriving_at_start = [&](const auto& c) {
                return must(arriving(c, End::start, options));
            };
            const auto plain = must(continuity(arriving_at_start(in_powers(m1, 1)), flipped(in_powers(m2, 1)),
                                               options)),
                       slow = must(continuity(arriving_at_start(in_powers(m1, r)), flipped(in_powers(m2, r)),
                                              options)),
                       one = must(continuity(arriving_at_start(in_powers(m1, 1)), flipped(in_powers(m2, r)),
                                             options));
            for (const auto* j : {&slow, &one}) {
                EXPECT_TRUE(j->singular);
                EXPECT_EQ(j->unbounded, 0);
                EXPECT_EQ(j->g_order, plain.g_order) << r << ", " << round;
                ASSERT_EQ(j->g.size(), plain.g.size());
                for (std::size_t k = 0; k < j->g.size(); ++k) {
                    EXPECT_LE(std::abs(j->g[k].size - plain.g[k].size), j->g[k].bound + plain.g[k].bound)
                        << r << ", " << round << ", " << k;
                    EXPECT_LE(j->g[k].bound, 1e-8);
                }
                ASSERT_TRUE(j->after.curvature && plain.after.curvature);
                EXPECT_LE(std::abs(j->after.curvature->value - plain.after.curvature->value), 1e-10);
                ASSERT_TRUE(j->after.torsion && plain.after.torsion);
                EXPECT_LE(std::abs(j->after.torsion->value - plain.after.torsion->value), 1e-8);
            }
            EXPECT_EQ(plain.g_order, round % 3);
        }
}

TEST(Continuity, of_singular_sides_ends_where_a_derivative_by_arc_length_is_infinite) {
    const auto half = [](std::vector<Vec<2>> b) { return bezier(std::move(b)); };
    // (t^3, t^4), y = x^(4/3), from both sides: the tangent goes on, the curvature is infinite.
    const auto out = half({{{0, 0}}, {{0, 0}}, {{0, 0}}, {{0.25, 0}}, {{1, 1}}});
    const auto in = half({{{-1, 1}}, {{-0.25, 0}}, {{0, 0}}, {{0, 0}}, {{0, 0}}});
    const auto j = must(joint(in, out));
    EXPECT_EQ(j.g_order, 1);
    EXPECT_EQ(j.unbounded, 2);
    EXPECT_EQ(j.g.size(), 2u);
    EXPECT_FALSE(j.after.curvature);
    // (t^2, t^5): s^(5/2), curvature 0 and a third derivative without limit.
    const auto fifth = half({{{0, 0}}, {{0, 0}}, {{0.1, 0}}, {{0.3, 0}}, {{0.6, 0}}, {{1, 1}}});
    const auto line = half({{{-1, 0}}, {{0, 0}}});
    const auto third = must(joint(line, fifth));
    EXPECT_EQ(third.g_order, 2);
    EXPECT_EQ(third.unbounded, 3);
    // (t^2, t^2 + t^3) within a tolerance: what bends it moves points by less.
    const auto nearly = half({{{0, 0}}, {{0, 0}}, {{1.0 / 3, 0}}, {{1, 1e-8}}});
    EXPECT_EQ(must(joint(line, nearly)).unbounded, 2);
    EXPECT_EQ(must(joint(line, nearly, {.tolerance = 1e-7})).g_order, 3);
}

// Full circle of four arcs: C0 in homogeneous coordinates with these knots, G-infinity in the plane.
TEST(Continuity, judges_rational_curves_by_their_points) {
    const double s = std::sqrt(0.5);
    std::vector<Hom<2>> b;
    const double x[][2] = {{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}, {-1, -1}, {0, -1}, {1, -1}, {1, 0}};
    for (int i = 0; i < 9; ++i) b.push_back(weighted(Vec<2>{{x[i][0], x[i][1]}}, i % 2 ? s : 1));
    const auto circle = spline<Hom<2>>(2, {0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4}, b);
    const auto all = must(continuity(circle));
    ASSERT_EQ(all.size(), 4u);  // with the seam
    EXPECT_TRUE(all[3].seam);
    for (const auto& k : all) {
        EXPECT_EQ(k.joint.g_order, 3);
        EXPECT_EQ(k.joint.c_order, 1);  // C1 by symmetry, though the weights have corners
        EXPECT_FALSE(k.removable);
    }
    const auto lines = must(knot_lines(circle, 0));
    EXPECT_EQ(lines[0].c_order, 0);
}

TEST(Continuity, does_not_depend_on_the_place_and_scales) {
    Random random(6);
    for (int round = 0; round < 20; ++round) {
        const auto a = random_bezier<Vec<3>>(random, 4);
        const double phi[] = {1.5, -0.5};
        const auto b = must(next_g(a, phi, {{0, 0.5}, {Vec<3>{{1, 2, 3}}, Vec<3>{{2, 2, 2}}}}));
        const double u = std::cos(0.7), v = std::sin(0.7);
        const auto mapped = [](const Curve<Vec<3>>& c, auto&& f) {
            std::vector<Vec<3>> p(c.net().flat().begin(), c.net().flat().end());
            for (Vec<3>& q : p) q = f(q);
            return must(Curve<Vec<3>>::make(c.bases(), Net<1, Vec<3>>({int(p.size())}, p)));
        };
        const auto larger = [](const Vec<3>& q) { return 0x1p300 * q; };
        const auto moved = [&](const Vec<3>& q) {
            return Vec<3>{{u * q[0] - v * q[1] + 7, u * q[1] + v * q[0] + 3, q[2] - 5}};
        };
        const auto other = must(joint(mapped(a, moved), mapped(b, moved)));
        EXPECT_EQ(other.g_order, 2);
        EXPECT_EQ(other.c_order, 0);
        const auto j = must(joint(a, b)), big = must(joint(mapped(a, larger), mapped(b, larger)));
        EXPECT_NEAR(other.g[3].size, j.g[3].size, other.g[3].bound + j.g[3].bound);
        ASSERT_EQ(j.g_order, 2);
        EXPECT_EQ(big.g_order, 2);
        for (int k = 0; k < 4; ++k) {
            EXPECT_EQ(big.g[std::size_t(k)].size,
                      k == 1 ? j.g[1].size : std::scalbn(j.g[std::size_t(k)].size, 300 * (1 - k)));
            EXPECT_EQ(big.c[std::size_t(k)].size, std::scalbn(j.c[std::size_t(k)].size, 300));
        }
        EXPECT_EQ(big.phi, j.phi);
    }
}

TEST(Continuity, tolerances_are_distances_over_a_piece) {
    const auto a = bezier<Vec<2>>({{{0, 0}}, {{1, 0}}});
    // A gap of 0.01 and an angle of 0.01.
    const auto gap = bezier<Vec<2>>({{{1.01, 0}}, {{2, 0}}}), turn = bezier<Vec<2>>({{{1, 0}}, {{2, 0.01}}});
    ContinuityOptions o;
    o.tolerance = 0.011;
    EXPECT_EQ(must(joint(a, gap)).g_order, -1);
    EXPECT_EQ(must(joint(a, gap, o)).g_order, 3);
    EXPECT_EQ(must(joint(a, turn)).g_order, 0);
    EXPECT_EQ(must(joint(a, turn, o)).c_order, 3);
    EXPECT_EQ(must(joint(a, turn, o)).g_order, 3);
    o.tolerance = 0.009;
    EXPECT_EQ(must(joint(a, turn, o)).g_order, 0);
    o.angle = 0.011;
    EXPECT_EQ(must(joint(a, turn, o)).g_order, 3);
    EXPECT_EQ(must(joint(a, turn, o)).c_order, 0);
    o.angle = -1;
    EXPECT_EQ(joint(a, turn, o).error().where, "angle");
}

TEST(Continuity, angles_are_certain_also_near_half_a_turn) {
    const auto a = bezier<Vec<2>>({{{-1, 0}}, {{0, 0}}});
    for (const double e : {1e-3, 1e-8, 1e-12}) {
        const auto j = must(joint(a, bezier<Vec<2>>({{{0, 0}}, {{-1, e}}})));
        EXPECT_NEAR(j.g[1].size, std::numbers::pi - std::atan(e), j.g[1].bound);
        EXPECT_LT(j.g[1].bound, 1e-14);
        EXPECT_FALSE(j.opposed);
    }
}

TEST(Continuity, of_large_and_long_pieces_uses_the_tolerance_over_their_length) {
    // Pieces of length 10 in 5 units of the parameter; the second one turns by 0.01.
    const auto a = bezier<Vec<2>>({{{0, 0}}, {{10, 0}}}, {0, 5});
    const auto b = bezier<Vec<2>>({{{10, 0}}, {{20, 0.1}}}, {5, 10});
    ContinuityOptions o;
    o.tolerance = 0.101;
    EXPECT_EQ(must(joint(a, b, o)).c_order, 3);
    EXPECT_EQ(must(joint(a, b, o)).g_order, 3);
    o.tolerance = 0.099;
    EXPECT_EQ(must(joint(a, b, o)).c_order, 0);
    EXPECT_EQ(must(joint(a, b, o)).g_order, 0);
}

TEST(Continuity, refuses_what_leaves_the_range_of_double) {
    const auto huge = bezier<Vec<1>>({{{-4e307}}, {{4e307}}}, {0, 1e-3});
    const auto r = joint(huge, huge);
    ASSERT_FALSE(r);
    EXPECT_EQ(r.error().kind, RefusalKind::ill_conditioned);
    EXPECT_EQ(r.error().where, "c[1]");
    ContinuityOptions o;
    o.orders = 1 << 30;
    EXPECT_EQ(joint(huge, huge, o).error().where, "orders");
    o = {};
    o.roundings = NAN;
    EXPECT_EQ(joint(huge, huge, o).error().kind, RefusalKind::nonfinite);
    const auto closed =
        must(Curve<Vec<2>>::make({must(BSplineBasis::periodic(1, {0, 1, 2}))}, Net<1, Vec<2>>({2})));
    EXPECT_EQ(joint(closed, bezier<Vec<2>>({{{0, 0}}, {{1, 1}}})).error().where, "first.curve");
}

}  // namespace
}  // namespace freiform
