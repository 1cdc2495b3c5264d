#include "support/bezier.hpp"
#include "support/random.hpp"
#include "support/real.hpp"

#include <freiform/make/conic.hpp>
#include <freiform/make/revolve.hpp>

#include <boost/math/constants/constants.hpp>
#include <gtest/gtest.h>

namespace freiform {
namespace {

using test::bezier;
using test::must;
using test::Random;
using test::Rational;
using test::Real;
using test::real;
using Point = std::array<Real, 3>;

const Axis kZ{{}, {{0, 0, 1}}};

template <class P>
Point exact_curve_point(const Curve<P>& c, double t) {
    Point x{};
    const auto r = test::value_of<Rational>(c, t);
    for (std::size_t i = 0; i < r.size(); ++i) x[i] = real(r[i]);
    return x;
}
template <class P>
Point exact_curve_point(const Surface<P>& s, double u, double v) {
    Point x{};
    const auto r = test::value_of<Rational>(s, {u, v});
    for (std::size_t i = 0; i < 3; ++i) x[i] = real(r[i]);
    return x;
}
Real dot_of(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
double gap(const Point& a, const Point& b) {
    const Point d{a[0] - b[0], a[1] - b[1], a[2] - b[2]};
    return sqrt(dot_of(d, d)).convert_to<double>();
}

// A point apart from its rotation: p turned by the angle whose cosine and sine are given.
struct Turned {
    Point centre, arm, side;

    Turned(const Point& p, const Axis& axis) {
        Point k, r;
        for (int i = 0; i < 3; ++i) k[std::size_t(i)] = axis.direction[i];
        const Real length = sqrt(dot_of(k, k));
        for (Real& x : k) x /= length;
        for (std::size_t i = 0; i < 3; ++i) r[i] = p[i] - Real(axis.origin[int(i)]);
        const Real h = dot_of(r, k);
        for (std::size_t i = 0; i < 3; ++i) arm[i] = r[i] - h * k[i], centre[i] = p[i] - arm[i];
        for (std::size_t i = 0; i < 3; ++i)
            side[i] = k[(i + 1) % 3] * arm[(i + 2) % 3] - k[(i + 2) % 3] * arm[(i + 1) % 3];
    }
    Point by(const Real& c, const Real& s) const {
        Point q;
        for (std::size_t i = 0; i < 3; ++i) q[i] = centre[i] + c * arm[i] + s * side[i];
        return q;
    }
};

// Where a rational quadratic of n arcs is at u, as cosine and sine: its definition, in 100 digits. Joints are
// the doubles nearest to angle k / n; 2 pi as a double means the whole turn.
std::pair<Real, Real> on_circle(double angle, int n, double u) {
    const auto joint = [&](int k) {
        const Real pi = boost::math::constants::pi<Real>();
        if (std::abs(angle) == 2 * std::numbers::pi) return Real((angle > 0 ? 2 * pi : -2 * pi) * k / n);
        return Real(k == n ? angle : angle * k / n);
    };
    const int k = std::min(int(u * n), n - 1);
    const Real s = (Real(u) - Real(double(k) / n)) / (Real(double(k + 1) / n) - Real(double(k) / n));
    const Real from = joint(k), to = joint(k + 1), w = cos((to - from) / 2);
    const Real a = (1 - s) * (1 - s), b = 2 * s * (1 - s), c = s * s, m = (from + to) / 2;
    const Real weight = a + b * w + c;
    return {(a * cos(from) + b * cos(m) + c * cos(to)) / weight,
            (a * sin(from) + b * sin(m) + c * sin(to)) / weight};
}

template <class P>
double worst_quotient(const Curve<P>& profile, const Axis& axis, double angle) {
    const auto made = must(revolve(profile, axis, angle));
    const bool full = std::abs(angle) == 2 * std::numbers::pi;
    EXPECT_EQ(made.surface.basis(0).is_closed(), full);
    const int n = full ? 4 : (made.surface.basis(0).size() - 1) / 2;
    EXPECT_EQ(made.surface.basis(1), profile.basis());
    const Interval on = profile.domain()[0];
    double worst = 0;
    for (int i = 0; i <= 8; ++i)
        for (int j = 0; j <= 2; ++j) {
            const double u = i / 8.0, v = j == 2 ? on.hi : on.lo + on.length() * j / 2.5;
            const auto [c, s] = on_circle(angle, n, u);
            const double off = gap(exact_curve_point(made.surface, u, v),
                                   Turned(exact_curve_point(profile, v), axis).by(c, s));
            EXPECT_LE(off, made.bound);
            worst = std::max(worst, off / made.bound);
        }
    return worst;
}

// Row R25, literally: the point of the surface is the point of the curve, turned.
TEST(R25, a_point_of_the_surface_is_the_turned_point_of_the_curve) {
    const auto outline = bezier<Vec<3>>({{{1, 0, 0}}, {{3, 0, 1}}, {{0.5, 0, 2}}, {{2, 0, 4}}});
    const auto vase = must(revolve(outline, kZ, 2 * std::numbers::pi));
    for (int k = 0; k < 4; ++k)
        for (double v : {0.0, 0.25, 0.5, 1.0}) {
            const Vec<3> p = outline(v), q = vase.surface(k / 4.0, v);
            const double c[] = {1, 0, -1, 0}, s[] = {0, 1, 0, -1};
            EXPECT_LE(norm(q - Vec<3>{{c[k] * p[0], s[k] * p[0], p[2]}}), 2e-15) << k << " " << v;
        }
    EXPECT_LT(vase.bound, 1e-14);
    EXPECT_GT(vase.bound, 0);
    // Any profile, any axis, any angle: within the bound of the exact rotation in 100 digits.
    Random random(25);
    double worst = 0;
    for (int k = 0; k < 6; ++k) {
        const Axis axis{{{random.real(-2, 2), random.real(-2, 2), random.real(-2, 2)}},
                        {{random.real(-1, 1), random.real(-1, 1), random.real(-1, 1)}}};
        const double angle = k % 4 == 0   ? 2 * std::numbers::pi
                             : k % 4 == 1 ? -2 * std::numbers::pi
                                          : random.real(-6, 6);
        const test::BasisOptions ends{k % 3 == 0 ? test::Ends::closed : test::Ends::clamped};
        worst = std::max(worst, worst_quotient(test::random_patch<1, Vec<2>>(random, 5, ends), axis, angle));
        worst = std::max(worst, worst_quotient(test::random_patch<1, Hom<2>>(random, 4, ends), axis, angle));
        worst = std::max(worst, worst_quotient(test::random_patch<1, Vec<3>>(random, 5, ends), axis, angle));
        worst = std::max(worst, worst_quotient(test::random_patch<1, Hom<3>>(random, 4, ends), axis, angle));
    }
    EXPECT_GT(worst, 0.02);
}

TEST(Revolve, u_0_is_the_profile_to_the_bit_and_arcs_are_as_few_as_90_degrees_allow) {
    Random random(26);
    const auto profile = test::random_patch<1, Hom<3>>(random, 4, {});
    const Axis axis{{{0.1, 0.2, 0.3}}, {{1, 2, 3}}};
    for (const auto& [angle, arcs] : {std::pair(0.1, 1),
                                      {-std::numbers::pi / 2, 1},
                                      {1.6, 2},
                                      {std::numbers::pi, 2},
                                      {-4.8, 4},
                                      {6.28, 4}}) {
        const auto made = must(revolve(profile, axis, angle));
        EXPECT_EQ(made.surface.basis(0).size(), 2 * arcs + 1) << angle;
        EXPECT_EQ(boundary(made.surface, 0, 0), profile) << angle;
    }
    const auto full = must(revolve(profile, axis, 2 * std::numbers::pi));
    EXPECT_EQ(full.surface.basis(0).size(), 8);
    EXPECT_EQ(iso(full.surface, 0, 0.0), profile);
    EXPECT_EQ(full.surface(1.0, 0.0), full.surface(0.0, 0.0));
}

TEST(Revolve, an_open_full_turn_ends_at_the_profile_to_the_bit) {
    Random random(29);
    const auto profile = test::random_patch<1, Vec<3>>(random, 3, {});
    const Axis axis{{{0.1, 0.2, 0.3}}, {{1, 2, 3}}};
    const auto closed = must(revolve(profile, axis, -2 * std::numbers::pi)),
               open = must(revolve(profile, axis, -2 * std::numbers::pi, Seam::open));
    EXPECT_FALSE(open.surface.basis(0).is_closed());
    EXPECT_EQ(open.surface.basis(0).size(), 9);
    EXPECT_EQ(boundary(open.surface, 0, 1), to_rational(profile));
    EXPECT_EQ(boundary(open.surface, 0, 0), to_rational(profile));
    const double v = profile.domain()[0].middle();
    for (double u : {0.1, 0.5, 0.8}) EXPECT_LE(norm(open.surface(u, v) - closed.surface(u, v)), 1e-15);
    const auto cubic = must(revolve_polynomial(profile, axis, 2 * std::numbers::pi, 1e-4, Seam::open));
    EXPECT_EQ(boundary(cubic.surface, 0, 1), profile);
    EXPECT_FALSE(cubic.surface.basis(0).is_closed());
}

TEST(Revolve, spheres_tori_cones_are_where_their_equations_say) {
    const auto half =
        must(conic_arc(Conic<3>{ConicKind::ellipse, {}, {{0, 0, -2}}, {{2, 0, 0}}}, {0, std::numbers::pi}));
    const auto sphere = must(revolve(half.curve, kZ, 2 * std::numbers::pi));
    const auto tube = must(full_ellipse(Conic<3>{ConicKind::ellipse, {{3, 0, 0}}, {{1, 0, 0}}, {{0, 0, 1}}},
                                        EllipseForm::closed));
    const auto torus = must(revolve(tube.curve, kZ, 2 * std::numbers::pi));
    EXPECT_TRUE(torus.surface.basis(0).is_closed() && torus.surface.basis(1).is_closed());
    for (int i = 0; i <= 20; ++i)
        for (int j = 0; j <= 20; ++j) {
            const Vec<3> p = sphere.surface(i / 20.0, j / 20.0), q = torus.surface(i / 20.0, j / 20.0);
            EXPECT_NEAR(norm(p), 2, 2e-15);
            EXPECT_NEAR(std::hypot(std::hypot(q[0], q[1]) - 3, q[2]), 1, 4e-15);
        }
}

TEST(Revolve, negative_angles_turn_the_other_way) {
    Random random(27);
    const auto profile = test::random_bezier<Vec<3>>(random, 3);
    const auto there = must(revolve(profile, kZ, 1.25)), back = must(revolve(profile, kZ, -1.25));
    const auto opposite = must(revolve(profile, Axis{{}, {{0, 0, -3}}}, 1.25));
    EXPECT_EQ(back.surface, opposite.surface);
    EXPECT_GT(norm(there.surface(1.0, 0.5) - back.surface(1.0, 0.5)), 0.1);
}

TEST(Revolve, scales_with_powers_of_two_and_moves_with_the_axis) {
    Random random(28);
    const auto profile = test::random_patch<1, Hom<3>>(random, 3, {});
    const Axis axis{{{0.5, -0.25, 1}}, {{1, 1, -2}}};
    const auto made = must(revolve(profile, axis, 2.5));
    for (const int e : {-900, -40, 7, 900}) {
        auto net = profile.net();
        for (Hom<3>& h : net.flat())
            for (int i = 0; i < 3; ++i) h[i] = std::scalbn(h[i], e);
        Axis far{axis};
        for (double& x : far.origin.c) x = std::scalbn(x, e);
        for (double& x : far.direction.c) x = std::scalbn(x, -e);
        const auto big = must(revolve(must(Curve<Hom<3>>::make(profile.bases(), net)), far, 2.5));
        EXPECT_NEAR(std::scalbn(big.bound, -e) / made.bound, 1, 1e-12);
        for (std::size_t i = 0; i < made.surface.net().flat().size(); ++i)
            for (int c = 0; c < 4; ++c)
                EXPECT_EQ(big.surface.net().flat()[i][c],
                          std::scalbn(made.surface.net().flat()[i][c], c < 3 ? e : 0));
    }
    // A shift of the profile and the axis together shifts the surface.
    auto net = profile.net();
    for (Hom<3>& h : net.flat())
        for (int i = 0; i < 3; ++i) h[i] += 2 * h[3];
    const Axis moved{axis.origin + Vec<3>{{2, 2, 2}}, axis.direction};
    const auto shifted = must(revolve(must(Curve<Hom<3>>::make(profile.bases(), net)), moved, 2.5));
    const double v = profile.domain()[0].middle();
    for (double u : {0.0, 0.3, 0.9})
        EXPECT_LE(norm(shifted.surface(u, v) - made.surface(u, v) - Vec<3>{{2, 2, 2}}), 3e-14);
}

TEST(Revolve, a_profile_may_touch_and_cross_the_axis_but_not_lie_on_it) {
    const auto crossing = bezier<Vec<3>>({{{-1, 0, 0}}, {{1, 0, 2}}});
    const auto cone = must(revolve(crossing, kZ, 2 * std::numbers::pi));
    for (double u : {0.0, 0.3, 0.8}) EXPECT_LE(norm(cone.surface(u, 0.5) - Vec<3>{{0, 0, 1}}), cone.bound);
    const auto touching = bezier<Vec<2>>({{{0, 0}}, {{1, 1}}, {{0, 2}}});
    const auto lemon = must(revolve(touching, Axis{{}, {{0, 1, 0}}}, 1));
    for (double u : {0.0, 0.5, 1.0}) EXPECT_EQ(lemon.surface(u, 1.0), (Vec<3>{{0, 2, 0}}));
    const auto on_it = bezier<Vec<3>>({{{0, 0, 0}}, {{0, 0, 2}}});
    EXPECT_EQ(revolve(on_it, kZ, 1).error().where, "profile");
    const auto skew = bezier<Vec<3>>({{{0.1, 0.2, 0.3}}, {{0.2, 0.4, 0.6}}});
    EXPECT_EQ(revolve(skew, Axis{{}, {{0.3, 0.6, 0.9}}}, 1).error().kind, RefusalKind::ill_conditioned);
}

TEST(Revolve, refuses_what_turns_nothing) {
    const auto line = bezier<Vec<3>>({{{1, 0, 0}}, {{1, 0, 2}}});
    const double nan = std::nan(""), inf = std::numeric_limits<double>::infinity();
    const auto where = [&](const Axis& axis, double angle) {
        const auto r = revolve(line, axis, angle);
        const auto p = revolve_polynomial(line, axis, angle, 1e-3);
        EXPECT_FALSE(p);
        return r ? "none" : r.error().where;
    };
    EXPECT_EQ(where({{}, {}}, 1), "axis.direction");
    EXPECT_EQ(where({{}, {{0, 0, nan}}}, 1), "axis.direction");
    EXPECT_EQ(where({{{inf, 0, 0}}, {{0, 0, 1}}}, 1), "axis.origin");
    EXPECT_EQ(where(kZ, nan), "angle");
    EXPECT_EQ(where(kZ, 0), "angle");
    EXPECT_EQ(where(kZ, 6.3), "angle");
    EXPECT_FALSE(revolve_polynomial(line, kZ, 1, 0));
    EXPECT_FALSE(revolve_polynomial(line, kZ, 1, nan));
    EXPECT_EQ(revolve_polynomial(line, kZ, 1, 1e-18).error().kind, RefusalKind::ill_conditioned);
    const auto far = bezier<Vec<3>>({{{0x1p1021, 0, 0}}, {{0x1p1021, 0x1p1021, 0}}});
    EXPECT_TRUE(revolve(far, kZ, 1));
    EXPECT_FALSE(revolve(far, Axis{{{-0x1p1023, 0, 0}}, {{0, 0, 1}}}, std::numbers::pi));
    const auto tiny = bezier<Vec<3>>({{{0x1p-1070, 0, 0}}, {{0x1p-1070, 0, 0x1p-1070}}});
    EXPECT_TRUE(revolve(tiny, kZ, 1));
}

// The bound of the polynomial surface, against its true distance: along a line at distance r from the axis
// that is | sqrt(x^2 + y^2) - r |.
TEST(RevolvePolynomial, is_as_far_off_as_its_bound_says_and_not_much_less) {
    const auto curve = bezier<Vec<3>>({{{1, 0, 0}}, {{4, 1, 1}}, {{-1, 0.5, 2}}, {{2, 0, 4}}});
    for (const double angle : {2 * std::numbers::pi, -2 * std::numbers::pi, 1.0, 3.0, -5.5})
        for (const double tolerance : {0.5, 1e-2, 1e-4, 1e-8, 1e-11}) {
            const auto made = must(revolve_polynomial(curve, kZ, angle, tolerance));
            EXPECT_LE(made.bound, tolerance);
            EXPECT_EQ(made.surface.basis(0).is_closed(), std::abs(angle) == 2 * std::numbers::pi);
            double worst = 0;
            for (int i = 0; i <= 24; ++i)  // the first piece: all are alike
                for (int j = 0; j <= 16; ++j) {
                    const double u = std::min(1.0, double(i) / (24 * made.pieces)), v = j / 16.0;
                    const Vec<3> p = made.surface(u, v), q = curve(v);
                    const double off =
                        std::hypot(std::hypot(p[0], p[1]) - std::hypot(q[0], q[1]), p[2] - q[2]);
                    EXPECT_LE(off, made.bound + 2e-15);  // the rounding of this test
                    worst = std::max(worst, off);
                }
            EXPECT_GE(worst, 0.05 * made.bound) << angle << " " << tolerance;
            EXPECT_GE(worst, (tolerance > 1e-10 ? 0.8 : 0.05) * made.bound) << angle << " " << tolerance;
        }
}

TEST(RevolvePolynomial, takes_no_more_pieces_than_its_bound_needs) {
    const auto circle = bezier<Vec<3>>({{{2, 0, 0}}, {{2, 0, 1}}});
    for (const double tolerance : {1e-1, 1e-3, 1e-6, 1e-9}) {
        const int n = must(revolve_polynomial(circle, kZ, 2 * std::numbers::pi, tolerance)).pieces;
        const auto eps = [](int k) {
            const double t = std::tan(2 * std::numbers::pi / k / 4);
            return 2 * 2.0 / 27 * std::pow(t, 6) / std::pow(1 + t * t, 2);
        };
        EXPECT_LE(eps(n), tolerance);
        if (n > 2) {
            EXPECT_GT(eps(n - 1), tolerance * (1 - 1e-5));
        }
    }
}

TEST(RevolvePolynomial, begins_at_the_profile_and_has_a_continuous_derivative) {
    const auto curve = bezier<Vec<3>>({{{1, 0, 0}}, {{4, 1, 1}}, {{2, 0, 4}}});
    const auto open = must(revolve_polynomial(curve, kZ, 5, 1e-5));
    EXPECT_EQ(boundary(open.surface, 0, 0), curve);
    const auto full = must(revolve_polynomial(curve, kZ, 2 * std::numbers::pi, 1e-5));
    for (const auto* s : {&open.surface, &full.surface}) {
        for (int i = s == &full.surface ? 0 : 1; i < 3; ++i) {
            const double at = s->basis(0).breaks()[std::size_t(i)], near = 1e-9;
            const auto a = s->jet<1>({at == 0 ? 1 - near : at - near, 0.5}), b = s->jet<1>({at + near, 0.5});
            EXPECT_LE(norm(a.d[1] - b.d[1]), 1e-5);
        }
    }
    EXPECT_LE(norm(full.surface(0.0, 0.5) - curve(0.5)), full.bound);
}

// Rational profiles: a half circle becomes a sphere, a circle a torus; their equations say how far off.
TEST(RevolvePolynomial, of_rational_profiles_is_as_far_off_as_its_bound_says) {
    const auto half =
        must(conic_arc(Conic<3>{ConicKind::ellipse, {}, {{0, 0, -2}}, {{2, 0, 0}}}, {0, std::numbers::pi}));
    const auto tube = must(full_ellipse(Conic<3>{ConicKind::ellipse, {{3, 0, 0}}, {{1, 0, 0}}, {{0, 0, 1}}},
                                        EllipseForm::closed));
    for (const double tolerance : {0.1, 1e-3, 1e-6, 1e-9}) {
        const auto sphere = must(revolve_polynomial(half.curve, kZ, 2 * std::numbers::pi, tolerance));
        const auto torus = must(revolve_polynomial(tube.curve, kZ, -4, tolerance));
        EXPECT_TRUE(torus.surface.basis(1).is_closed());
        EXPECT_LE(std::max(sphere.bound, torus.bound), tolerance);
        double of_sphere = 0, of_torus = 0;
        for (int i = 0; i <= 30; ++i)
            for (int j = 0; j <= 80; ++j) {
                const double u = i / (30.0 * sphere.pieces), w = i / (30.0 * torus.pieces);
                const auto at = [&](const BSplineBasis& b) {  // around a break in the middle
                    const auto t = b.breaks();
                    const std::size_t m = t.size() / 2;
                    return j < 40 ? t[m - 1] + (t[m] - t[m - 1]) * j / 40
                                  : t[m] + (t[m + 1] - t[m]) * (j - 40) / 40.0;
                };
                const Vec<3> p = sphere.surface(u, at(sphere.surface.basis(1))),
                             q = torus.surface(w, at(torus.surface.basis(1)));
                of_sphere = std::max(of_sphere, std::abs(norm(p) - 2));
                of_torus = std::max(of_torus, std::abs(std::hypot(std::hypot(q[0], q[1]) - 3, q[2]) - 1));
            }
        EXPECT_LE(of_sphere, sphere.bound + 2e-15);
        EXPECT_LE(of_torus, torus.bound + 2e-15);
        EXPECT_GE(of_sphere, 0.05 * sphere.bound) << tolerance;
        EXPECT_GE(of_torus, 0.05 * torus.bound) << tolerance;
    }
}

// Corresponding points, with the parameters of v: turned back, a point lies within the bound of the profile.
TEST(RevolvePolynomial, of_rational_profiles_keeps_their_parameters) {
    Random random(30);
    for (int k = 0; k < 4; ++k) {
        const auto profile = test::random_patch<1, Hom<3>>(random, 3, {});
        const auto made = must(revolve_polynomial(profile, kZ, 5, 1e-4));
        const Interval on = profile.domain()[0];
        double worst = 0;
        for (int i = 0; i <= 20; ++i)
            for (int j = 0; j <= 20; ++j) {
                const Vec<3> p = made.surface(i / (20.0 * made.pieces), on.lo + on.length() * j / 20.01),
                             q = profile(on.lo + on.length() * j / 20.01);
                const double off = std::hypot(std::hypot(p[0], p[1]) - std::hypot(q[0], q[1]), p[2] - q[2]);
                EXPECT_LE(off, made.bound + 1e-14);
                worst = std::max(worst, off);
            }
        EXPECT_GE(worst, 0.05 * made.bound);
    }
}

TEST(RevolvePolynomial, of_rational_profiles_with_equal_weights_and_of_bad_tolerances) {
    const auto curve = bezier<Vec<3>>({{{1, 0, 0}}, {{4, 1, 1}}, {{2, 0, 4}}});
    const auto plain = must(revolve_polynomial(curve, kZ, 5, 1e-5));
    const auto lifted = must(revolve_polynomial(to_rational(curve), kZ, 5, 1e-5));
    EXPECT_EQ(lifted.surface, plain.surface);
    const auto arc =
        must(conic_arc(Conic<3>{ConicKind::ellipse, {}, {{0, 0, 1}}, {{1, 0, 0}}}, {0, 1})).curve;
    EXPECT_EQ(revolve_polynomial(arc, kZ, 1, 0).error().where, "tolerance");
    EXPECT_EQ(revolve_polynomial(arc, kZ, 0, 1).error().where, "angle");
    const auto fine = revolve_polynomial(arc, kZ, 1, 1e-18);
    ASSERT_FALSE(fine);
    EXPECT_TRUE(fine.error().where.starts_with("profile")) << fine.error().where;
}

TEST(Revolution, of_a_line_along_the_axis_is_the_cylinder_with_the_same_parameters) {
    const Vec<3> axis{{0.48, 0.6, 0.64}}, origin{{1, -2, 3}}, away{{0.8, 0, -0.6}};
    for (const double side : {1.0, -1.0}) {
        const Line<3> line{origin + 0.7 * axis + 1.5 * away, (side * 2) * axis};
        const SurfaceGeometry made = revolution(line, origin, axis);
        ASSERT_TRUE(std::holds_alternative<Extrusion>(made));
        EXPECT_EQ(kind_name(made), "cylinder");
        const SurfaceGeometry turned = Revolution{line, origin, axis};
        for (const double u : {-1.0, 0.0, 0.3, 2.0, 6.0})
            for (const double v : {-3.0, 0.0, 0.5}) {
                const auto a = jet<1>(made, Param<2>{{u, v}}), b = jet<1>(turned, Param<2>{{u, v}});
                for (std::size_t k = 0; k < 3; ++k) EXPECT_LE(norm(a.d[k] - b.d[k]), 1e-14);
            }
    }
    const auto other = [&](const Vec<3>& from, const Vec<3>& along) {
        return std::holds_alternative<Revolution>(revolution(Line<3>{from, along}, origin, axis));
    };
    EXPECT_TRUE(other(origin + away, axis + 1e-12 * away)) << "a cone";
    EXPECT_TRUE(other(origin + axis, axis)) << "no surface, which others refuse";
}

}  // namespace
}  // namespace freiform
