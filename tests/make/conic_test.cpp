#include "support/random.hpp"
#include "support/real.hpp"

#include <freiform/make/conic.hpp>
#include <freiform/make/graph.hpp>

#include <gtest/gtest.h>

namespace freiform {
namespace {

using test::must;
using test::Random;
using test::Rational;
using test::Real;
using test::real;

// The point of a curve in exact arithmetic.
template <class P>
std::vector<Real> exact_point(const Curve<P>& c, double t) {
    std::vector<Real> x;
    for (const Rational& r : test::value_of<Rational>(c, t)) x.push_back(real(r));
    return x;
}
template <int D>
Real distance(const std::vector<Real>& x, const Vec<D>& p) {
    Real sum = 0;
    for (std::size_t i = 0; i < x.size(); ++i) sum += (x[i] - Real(p[int(i)])) * (x[i] - Real(p[int(i)]));
    return sqrt(sum);
}
double off_circle(const ConicArc<2>& arc, const Vec<2>& centre, double r) {
    double worst = 0;
    for (int i = 0; i <= 64; ++i)
        worst = std::max(
            worst, abs(distance(exact_point(arc.curve, i / 64.0), centre) - Real(r)).convert_to<double>());
    return worst;
}
Conic<2> unit_circle() { return {ConicKind::ellipse, {}, {{1, 0}}, {{0, 1}}}; }

// Row R14, literally: arcs of every kind lie on their conic, exactly but for rounding.
TEST(R14, conic_arcs_are_exact) {
    const double s = std::sqrt(0.5);
    const auto quarter = must(weighted_arc<2>({{1, 0}}, {{1, 1}}, {{0, 1}}, s));
    EXPECT_EQ(weights(quarter.curve), (std::vector<double>{1, s, 1}));
    EXPECT_LE(off_circle(quarter, {}, 1), 2e-16);
    const auto ellipse =
        must(conic_arc(Conic<2>{ConicKind::ellipse, {{1, 2}}, {{3, 0}}, {{0, 2}}}, {0.5, 4}));
    const auto hyperbola =
        must(conic_arc(Conic<2>{ConicKind::hyperbola, {{1, 2}}, {{3, 0}}, {{0, 2}}}, {-1, 2}));
    const auto parabola =
        must(conic_arc(Conic<2>{ConicKind::parabola, {{1, 2}}, {{3, 0}}, {{0, 2}}}, {-1, 2}));
    for (int i = 0; i <= 32; ++i) {
        const double t = i / 32.0;
        const Vec<2> e = ellipse.curve(t), h = hyperbola.curve(t), p = parabola.curve(t);
        EXPECT_NEAR((e[0] - 1) * (e[0] - 1) / 9 + (e[1] - 2) * (e[1] - 2) / 4, 1, 1e-14);
        EXPECT_NEAR((h[0] - 1) * (h[0] - 1) / 9 - (h[1] - 2) * (h[1] - 2) / 4, 1, 1e-13);
        EXPECT_NEAR((p[0] - 1) / 3, (p[1] - 2) * (p[1] - 2) / 4, 1e-14);
    }
    EXPECT_EQ(hyperbola.curve.net().extent()[0], 3);
    EXPECT_GT(weights(hyperbola.curve)[1], 1);
    EXPECT_EQ(weights(parabola.curve), (std::vector<double>{1, 1, 1}));
    EXPECT_EQ(ellipse.curve.net().extent()[0], 7);  // 3.5 radians: three pieces
}

TEST(R01, graph_of_a_polynomial_is_a_bezier_curve) {
    const auto g = must(graph(std::array{1.0, -2.0, 0.0, 0.5}, {-1, 3}));  // y = 1 - 2 x + x^3 / 2
    EXPECT_EQ(g.curve.basis().degree(), 3);
    for (double x : {-1.0, -0.3, 0.0, 1.0, 2.5, 3.0}) {
        EXPECT_NEAR(g.curve(x)[0], x, 1e-15);
        EXPECT_NEAR(g.curve(x)[1], 1 - 2 * x + x * x * x / 2, 1e-13);
    }
    EXPECT_EQ(points(must(graph(std::array{0.0, 0.0, 1.0}, {0, 1})).curve),
              (std::vector<Vec<2>>{{{0, 0}}, {{0.5, 0}}, {{1, 1}}}));
}

TEST(Graph, stays_within_its_bound_at_every_degree) {
    Random random(11);
    for (int n = 0; n <= kMaxDegree; ++n) {
        std::vector<double> a;
        for (int k = 0; k <= n; ++k) a.push_back(random.real(-1, 1));
        const Interval on{random.real(-2, 0), random.real(0.1, 2)};
        const auto g = must(graph(a, on));
        for (int i = 0; i <= 4; ++i) {
            const double x = on.lo + (on.hi - on.lo) * i / 4;
            const auto p = test::value_of<Rational>(g.curve, x);
            Rational y = 0;
            for (int k = n; k >= 0; --k) y = y * Rational(x) + Rational(a[std::size_t(k)]);
            EXPECT_LE(std::hypot(test::gap(x, p[0]), Rational(y - p[1]).convert_to<double>()), g.bound) << n;
        }
        EXPECT_LT(g.bound, 1e-13 * std::exp2(n * 1.2));
    }
    EXPECT_EQ(graph({}, {0, 1}).error().where, "coefficients");
    EXPECT_EQ(graph(std::array{1.0, std::nan("")}, {0, 1}).error().where, "coefficients[1]");
    EXPECT_FALSE(graph(std::array{1.0}, {1, 1}));
}

// Radius errors in exact arithmetic, compared with the stated bound.
TEST(ConicArc, circles_are_off_by_a_few_ulps_and_by_less_than_their_bound) {
    Random random(12);
    double worst_quotient = 0;
    for (int k = 0; k < 40; ++k) {
        const Vec<2> centre{{random.real(-2, 2), random.real(-2, 2)}};
        const double r = random.real(0.1, 3), lo = random.real(-4, 4),
                     sweep = random.real(0.01, 2 * std::numbers::pi);
        const auto c = must(circle(centre, r));
        const auto arc = must(conic_arc(c, {lo, std::min(lo + sweep, lo + 2 * std::numbers::pi)}));
        const double off = off_circle(arc, centre, r);
        EXPECT_LE(off, arc.bound);
        EXPECT_LT(arc.bound, 20 * 0x1p-53 * (norm(centre) + r));
        worst_quotient = std::max(worst_quotient, off / arc.bound);
        const int pieces = (arc.curve.net().extent()[0] - 1) / 2;
        EXPECT_EQ(pieces, int(std::ceil(sweep / (std::numbers::pi / 2))));
    }
    EXPECT_GT(worst_quotient, 0.05);
    EXPECT_LT(must(full_ellipse(unit_circle(), EllipseForm::open)).bound, 5 * 0x1p-53);
}

TEST(ConicArc, its_ends_are_at_the_angles) {
    const auto arc = must(conic_arc(must(circle({{1, 1}}, 2)), {0.25, 5}));
    for (int i = 0; i <= 4; ++i) {
        const double t = 0.25 + 4.75 * i / 4;
        EXPECT_NEAR(norm(arc.curve(i / 4.0) - Vec<2>{{1 + 2 * std::cos(t), 1 + 2 * std::sin(t)}}), 0, 2e-15);
    }
}

TEST(ConicArc, as_few_pieces_as_the_widest_angle_allows) {
    const auto pieces = [](double sweep, double widest) {
        return (must(conic_arc(unit_circle(), {0, sweep}, widest)).curve.net().extent()[0] - 1) / 2;
    };
    EXPECT_EQ(pieces(std::numbers::pi / 2, std::numbers::pi / 2), 1);
    EXPECT_EQ(pieces(3, 3.1), 1);
    EXPECT_EQ(pieces(2 * std::numbers::pi, 2 * std::numbers::pi / 3), 3);
    EXPECT_EQ(pieces(2 * std::numbers::pi, std::numbers::pi / 2), 4);
    EXPECT_EQ(pieces(2 * std::numbers::pi, 0.5), 13);
    const auto three = must(conic_arc(unit_circle(), {0, 2 * std::numbers::pi}, 2 * std::numbers::pi / 3));
    EXPECT_LE(off_circle(three, {}, 1), three.bound);
    EXPECT_FALSE(conic_arc(unit_circle(), {0, 7}));
    EXPECT_FALSE(conic_arc(unit_circle(), {0, 2 * std::numbers::pi * (1 + 1e-9)}));
    for (const double beyond : {1e-16, 1e-14, 1e-10}) {  // a turn with the digits of a file
        const double end = 2 * std::numbers::pi * (1 + beyond);
        const auto arc = must(conic_arc(unit_circle(), {0, end}));
        EXPECT_LE(arc.bound, 1e-14);
        EXPECT_NEAR(arc.curve(1.0)[1], std::sin(end), 1e-15);
    }
    EXPECT_FALSE(conic_arc(unit_circle(), {0, 1}, std::numbers::pi));
    EXPECT_FALSE(conic_arc(unit_circle(), {1, 1}));
    EXPECT_EQ(conic_arc(unit_circle(), {0, std::nan("")}).error().kind, RefusalKind::nonfinite);
    EXPECT_FALSE(conic_arc(Conic<2>{ConicKind::ellipse, {}, {{1, 2}}, {{2, 4}}}, {0, 1}));
}

TEST(FullEllipse, has_an_open_a_closed_and_a_rational_form) {
    const Conic<3> tilted{ConicKind::ellipse, {{1, 2, 3}}, {{3, 0, 1}}, {{0, 2, 0.5}}};
    for (const auto form : {EllipseForm::open, EllipseForm::closed, EllipseForm::quintic}) {
        const auto e = must(full_ellipse(tilted, form));
        EXPECT_EQ(e.curve.basis().is_closed(), form == EllipseForm::closed);
        EXPECT_EQ(e.curve.net().extent()[0], form == EllipseForm::open     ? 9
                                             : form == EllipseForm::closed ? 8
                                                                           : 6);
        for (int i = 0; i <= 16; ++i) {
            const Vec<3> p = e.curve(i / 16.0) - tilted.centre;
            const double y = p[1] / 2, x = p[0] / 3;
            EXPECT_NEAR(x * x + y * y, 1, 1e-15);
            EXPECT_NEAR(p[2], x + y / 2, 1e-15);
        }
    }
    // The closed form is differentiable across its seam and its joints.
    const auto closed = must(full_ellipse(unit_circle(), EllipseForm::closed)).curve;
    for (double t : {0.0, 0.25, 0.5}) {
        const auto left = closed.jet<1>(std::nextafter(t == 0 ? 1 : t, 0.0)), right = closed.jet<1>(t);
        EXPECT_NEAR(norm(left.d[1] - right.d[1]), 0, 1e-13);
    }
    // The quintic unit circle is a circle, to the last bit.
    const auto quintic = must(full_ellipse(unit_circle(), EllipseForm::quintic)).curve;
    EXPECT_EQ(weights(quintic), (std::vector<double>{5, 1, 1, 1, 1, 5}));
    for (double t : {0.0, 0.1, 0.3, 0.7, 1.0}) {
        const auto h = test::homogeneous<Rational, 1>(quintic, t, {0});
        EXPECT_EQ(h[0] * h[0] + h[1] * h[1], h[2] * h[2]);
    }
    EXPECT_FALSE(full_ellipse(Conic<2>{ConicKind::parabola, {}, {{1, 0}}, {{0, 1}}}, EllipseForm::open));
}

TEST(Circle, in_space_has_the_normal_as_its_axis) {
    Random random(13);
    for (int k = 0; k < 20; ++k) {
        const Vec<3> n{{random.real(-1, 1), random.real(-1, 1), random.real(-1, 1)}}, centre{{1, 2, 3}};
        const double e = std::exp2(random.integer(-300, 300));
        const auto c = must(circle(centre, e * n, 0.5));
        const auto arc = must(conic_arc(c, {0, 2}));
        for (double t : {0.0, 0.5, 1.0}) {
            const auto p = exact_point(arc.curve, t);
            const Vec<3> d = arc.curve(t) - centre;
            EXPECT_LE(abs(distance(p, centre) - Real(0.5)).convert_to<double>(), arc.bound);
            EXPECT_NEAR(dot(d, n), 0, 1e-15);
        }
        EXPECT_LT(arc.bound, 3e-14);
        EXPECT_GT(dot(cross(c.conic.x, c.conic.y), n), 0);
    }
    EXPECT_FALSE(circle({{0, 0}}, 0));
    EXPECT_FALSE(circle({{0, 0}}, -1));
    EXPECT_EQ(circle({{0, 0}}, std::nan("")).error().kind, RefusalKind::nonfinite);
    EXPECT_EQ(circle({{0, 0, 0}}, {{0, 0, 0}}, 1).error().where, "normal");
}

TEST(ArcThrough, three_points_gives_the_circle_through_them) {
    Random random(14);
    for (int k = 0; k < 60; ++k) {
        const Vec<2> centre{{random.real(-2, 2), random.real(-2, 2)}};
        const double r = random.real(0.5, 3), t0 = random.real(-3, 3), sweep = random.real(0.2, 6);
        const auto at = [&](double t) { return centre + r * Vec<2>{{std::cos(t), std::sin(t)}}; };
        const Vec<2> a = at(t0), b = at(t0 + random.real(0.2, 0.8) * sweep), c = at(t0 + sweep);
        const auto arc = must(arc_through(a, b, c));
        EXPECT_EQ(arc.curve(0.0), a);
        EXPECT_EQ(arc.curve(1.0), c);
        EXPECT_NEAR(norm(arc.curve(0.5) - at(t0 + sweep / 2)), 0, 1e-12);
        for (double w : weights(arc.curve)) EXPECT_GE(w, 0.7);
        // Against the circle through the very same doubles.
        const Rational ax = a[0], ay = a[1], bx = Rational(b[0]) - ax, by = Rational(b[1]) - ay,
                       cx = Rational(c[0]) - ax, cy = Rational(c[1]) - ay, d = 2 * (bx * cy - by * cx),
                       ux = (cy * (bx * bx + by * by) - by * (cx * cx + cy * cy)) / d,
                       uy = (bx * (cx * cx + cy * cy) - cx * (bx * bx + by * by)) / d;
        for (double t : {0.1, 0.4, 0.8}) {
            const auto p = test::value_of<Rational>(arc.curve, t);
            const Rational x = p[0] - ax - ux, y = p[1] - ay - uy, rr = ux * ux + uy * uy;
            const double off = Rational(x * x + y * y - rr).convert_to<double>() / (2 * r);
            EXPECT_LE(std::abs(off), arc.bound * (1 + 1e-6));
        }
    }
}

TEST(ArcThrough, nearly_straight_arcs_and_any_scale) {
    const Vec<3> a{{0, 0, 1}}, b{{1, 0x1p-40, 1}}, c{{2, 0, 1}};
    const auto flat = must(arc_through(a, b, c));
    EXPECT_LT(flat.bound, 3e-14);
    EXPECT_NEAR(flat.curve(0.5)[1], 0x1p-40, 1e-15);
    EXPECT_EQ(arc_through(a, Vec<3>{{1, 0, 1}}, c).error().where, "b");
    EXPECT_FALSE(arc_through(a, a, c));
    EXPECT_FALSE(arc_through(a, c, a));
    for (int e : {-300, 300}) {
        const auto up = [&](Vec<3> p) { return std::exp2(e) * p; };
        const auto big = must(arc_through(up(a), up({{3, 4, 0}}), up(c))),
                   one = must(arc_through(a, {{3, 4, 0}}, c));
        EXPECT_EQ(big.curve(0.3), up(one.curve(0.3)));
        EXPECT_NEAR(big.bound / std::exp2(e), one.bound, 1e-20);
    }
}

TEST(WeightedArc, takes_the_long_way_round_with_a_negative_weight) {
    const auto rest = must(weighted_arc<2>({{1, 0}}, {{1, 1}}, {{0, 1}}, -std::sqrt(0.5)));
    EXPECT_LE(off_circle(rest, {}, 1), rest.bound + 2e-16);
    EXPECT_NEAR(rest.curve(0.5)[0], -std::sqrt(0.5), 1e-15);
    for (double w : weights(rest.curve)) EXPECT_GT(w, 0);
    EXPECT_FALSE(weighted_arc<2>({{1, 0}}, {{1, 1}}, {{0, 1}}, -1));
    EXPECT_FALSE(weighted_arc<2>({{1, 0}}, {{1, 1}}, {{0, 1}}, 0));
    EXPECT_FALSE(weighted_arc<2>({{1, 0}}, {{2, 0}}, {{3, 0}}, 0.5));
}

TEST(TangentArc, ends_tangents_and_a_point_make_one_conic) {
    Random random(15);
    int ellipses = 0, hyperbolas = 0;
    for (int k = 0; k < 100; ++k) {
        // An arc of a conic as truth.
        const Vec<2> a{{random.real(-1, 1), random.real(-1, 1)}}, b{{random.real(-1, 1), random.real(-1, 1)}},
            c{{random.real(-1, 1), random.real(-1, 1)}};
        const double w = random.chance(0.3) ? random.real(-0.8, -0.1) : std::exp2(random.real(-3, 3));
        if (std::abs(cross(b - a, c - a)) < 0.05) continue;
        const auto truth = must(weighted_arc(a, b, c, w));
        const Vec<2> p = truth.curve(random.real(0.2, 0.8));
        const double sign = w < 0 ? -1 : 1, s = std::exp2(random.real(-20, 20));
        const auto arc = tangent_arc(a, (sign * s) * (b - a), c, sign * (c - b), p);
        ASSERT_TRUE(arc) << arc.error().message;
        (w < 1 ? ellipses : hyperbolas)++;
        EXPECT_NEAR(norm(arc->curve(0.5) - truth.curve(0.5)), 0, 1e-9);
        const Vec<2> leave = arc->curve.jet<1>(0).d[1], arrive = arc->curve.jet<1>(1).d[1];
        EXPECT_NEAR(dot(unit(leave), unit(b - a)), sign, 1e-12);
        EXPECT_NEAR(dot(unit(arrive), unit(c - b)), sign, 1e-12);
        EXPECT_LT(arc->bound, 1e-9);
    }
    EXPECT_GT(ellipses, 10);
    EXPECT_GT(hyperbolas, 10);
    // Opposite directions: half an ellipse.
    const auto half = must(tangent_arc({{1, 0}}, {{0, 3}}, {{-1, 0}}, {{0, -1}}, {{0, 1}}));
    EXPECT_LE(off_circle(half, {}, 1), half.bound);
    EXPECT_EQ(tangent_arc({{1, 0}}, {{0, 3}}, {{-1, 0}}, {{0, 1}}, {{0, 1}}).error().kind,
              RefusalKind::no_answer);
    EXPECT_EQ(tangent_arc({{0, 0}}, {{1, 1}}, {{1, 0}}, {{1, 1.5}}, {{0.5, 0.1}}).error().where, "at_c");
    EXPECT_EQ(tangent_arc({{0, 0}}, {{1, 1}}, {{2, 0}}, {{1, -1}}, {{1, -0.1}}).error().where, "through");
    EXPECT_EQ(tangent_arc({{0, 0}}, {{0, 0}}, {{2, 0}}, {{1, -1}}, {{1, 0.1}}).error().where, "at_a");
}

}  // namespace
}  // namespace freiform
