#include "support/random.hpp"
#include "support/reference.hpp"

#include <freiform/make/conic_equation.hpp>

#include <gtest/gtest.h>

namespace freiform {
namespace {

using test::must;
using test::Random;
using test::Rational;

ConicForm form_of(const std::array<double, 6>& c) { return must(solve({c})); }
ConicType type_of(const std::array<double, 6>& c) { return must(classify({c})); }
double value_of(const ConicEquation& q, const Vec<2>& p) {
    const double x = p[0] - q.origin[0], y = p[1] - q.origin[1];
    const auto& c = q.c;
    return c[0] * x * x + c[1] * x * y + c[2] * y * y + c[3] * x + c[4] * y + c[5];
}

TEST(R01, circle_and_conics_from_implicit_to_parametric_and_back) {
    // (x - 1)^2 + (y + 2)^2 = 9
    const auto circle = form_of({1, 0, 1, -2, 4, -4});
    EXPECT_EQ(circle.type, ConicType::circle);
    EXPECT_EQ(circle.conic->conic.centre, (Vec<2>{{1, -2}}));
    EXPECT_NEAR(norm(circle.conic->conic.x), 3, 1e-15);
    const auto arc = must(conic_arc(*circle.conic, {0, 6}));
    for (double t : {0.0, 0.2, 0.7, 1.0}) EXPECT_NEAR(norm(arc.curve(t) - Vec<2>{{1, -2}}), 3, 1e-14);

    const auto ellipse = form_of({1, 0, 4, 0, 0, -4});
    EXPECT_EQ(ellipse.type, ConicType::ellipse);
    EXPECT_EQ(max_abs(ellipse.conic->conic.x), 2);
    EXPECT_EQ(max_abs(ellipse.conic->conic.y), 1);
    const auto parabola = form_of({1, 0, 0, 0, -1, 0});  // y = x^2
    EXPECT_EQ(parabola.type, ConicType::parabola);
    EXPECT_EQ(parabola.conic->conic, (Conic<2>{ConicKind::parabola, {}, {{0, 1}}, {{-1, 0}}}))
        << parabola.conic->conic.y[0];
    const auto hyperbola = form_of({0, 1, 0, 0, 0, -1});  // x y = 1
    EXPECT_EQ(hyperbola.type, ConicType::hyperbola);
    EXPECT_NEAR(std::abs(hyperbola.conic->conic.x[0]), 1, 1e-15);
    EXPECT_NEAR(hyperbola.conic->conic.x[0] * hyperbola.conic->conic.x[1], 1, 1e-15);
    EXPECT_EQ(must(equation_of(ellipse.conic->conic)).equation.c[1], 0);
    EXPECT_NEAR(must(equation_of(ellipse.conic->conic)).equation.c[2] /
                    must(equation_of(ellipse.conic->conic)).equation.c[0],
                4, 1e-15);
}

TEST(ConicEquation, every_kind_is_told_from_every_other) {
    EXPECT_EQ(type_of({1, 0, 1, 0, 0, 1}), ConicType::empty);
    EXPECT_EQ(type_of({1, 0, 1, 0, 0, 0}), ConicType::point);
    EXPECT_EQ(type_of({1, 0, -1, 0, 0, 0}), ConicType::crossing_lines);
    EXPECT_EQ(type_of({1, 0, 0, 0, 0, -4}), ConicType::parallel_lines);
    EXPECT_EQ(type_of({1, 2, 1, 0, 0, 0}), ConicType::double_line);
    EXPECT_EQ(type_of({1, 2, 1, 0, 0, 1}), ConicType::empty);
    EXPECT_EQ(type_of({0, 0, 0, 2, 1, 0}), ConicType::line);
    EXPECT_EQ(type_of({0, 0, 0, 0, 0, 1}), ConicType::empty);
    EXPECT_EQ(type_of({}), ConicType::plane);
    // One unit in the last place makes another kind of a parabola and of a circle.
    const double up = 1 + 0x1p-52;
    EXPECT_EQ(type_of({1, 2, 1, 1, 0, 0}), ConicType::parabola);
    EXPECT_EQ(type_of({1, 2, up, 1, 0, 0}), ConicType::ellipse);
    EXPECT_EQ(type_of({1, 2 * up, 1, 1, 0, 0}), ConicType::hyperbola);
    EXPECT_EQ(type_of({1, 0, up, 0, 0, -1}), ConicType::ellipse);
    EXPECT_EQ(type_of({1e300, 0, 1e-300, 0, 0, -1e-300}), ConicType::ellipse);
    EXPECT_EQ(classify({{1, 0, std::nan(""), 0, 0, 0}}).error().where, "c[2]");
    EXPECT_EQ(name_of(ConicType::crossing_lines), "crossing lines");
    EXPECT_EQ(name_of(ConicType::plane), "plane");

    const auto cross = form_of({1, 1, -2, -5, 2, 4});  // (x - y - 1)(x + 2 y - 4)
    EXPECT_EQ(cross.type, ConicType::crossing_lines);
    ASSERT_EQ(cross.lines.size(), 2u);
    for (const auto& l : cross.lines) EXPECT_NEAR(norm(l.origin - Vec<2>{{2, 1}}), 0, 1e-15);
    const auto lines = form_of({1, -4, 4, 0, 0, -5});  // |x - 2 y| = sqrt 5
    EXPECT_EQ(lines.type, ConicType::parallel_lines);
    for (const auto& l : lines.lines) {
        EXPECT_NEAR(norm(l.origin), 1, 1e-14);
        EXPECT_NEAR(l.direction[0] - 2 * l.direction[1], 0, 1e-14);
    }
    EXPECT_EQ(form_of({1, 0, 1, -2, -4, 5}).point, (Vec<2>{{1, 2}}));
    EXPECT_EQ(form_of({0, 0, 0, 1, 1, -2}).lines[0].origin, (Vec<2>{{1, 1}}));
    EXPECT_EQ(form_of({1, 2, 1, 2, 2, 1}).lines.size(), 1u);
}

// Random conics: analytic -> equation -> analytic is the same point set, at all scales; the bounds hold.
TEST(ConicEquation, round_trips_at_all_scales) {
    Random random(21);
    for (int k = 0; k < 200; ++k) {
        const auto kind = ConicKind(k % 3);
        const double s = std::exp2(random.integer(-300, 300));
        const auto any = [&] { return s * Vec<2>{{random.real(-1, 1), random.real(-1, 1)}}; };
        const Conic<2> conic{kind, any(), any(), any()};
        if (std::abs(cross((1 / s) * conic.x, (1 / s) * conic.y)) < 0.05) continue;
        const auto q = must(equation_of(conic));
        if (kind != ConicKind::parabola) EXPECT_EQ(must(classify(q.equation)), q.type);
        if (kind == ConicKind::parabola && must(classify(q.equation)) != ConicType::parabola)
            continue;  // rounding
        const auto back = must(solve(q.equation));
        ASSERT_TRUE(back.conic);
        const double size = q.equation.c[0] + q.equation.c[2];
        for (double t : {-1.0, 0.0, 0.5, 2.0}) {
            const Vec<2> p = jet<0>(CurveGeometry<2>(back.conic->conic), t).d[0];
            EXPECT_NEAR(value_of(q.equation, p) / size / s / s, 0, 1e-11);
        }
        EXPECT_LT(back.conic->centre_bound, 1e-10 * s);
        EXPECT_LT(back.conic->x_bound, 1e-10 * s);
    }
}

// The bounds against exact arithmetic: the centre of the exact equation.
TEST(ConicEquation, the_bound_of_the_centre_holds_even_beside_a_parabola) {
    Random random(22);
    for (int k = 0; k < 100; ++k) {
        std::array<double, 6> c;
        for (double& x : c) x = random.real(-1, 1);
        if (k % 2 == 0) c[2] = c[1] * c[1] / (4 * c[0]) * (1 + std::exp2(-random.integer(10, 50)));
        const auto form = solve({c});
        ASSERT_TRUE(form);
        if (!form->conic || form->type == ConicType::parabola) continue;
        const Rational a = c[0], b = c[1], cc = c[2], d = c[3], e = c[4], delta = 4 * a * cc - b * b;
        const Rational x = (b * e - 2 * cc * d) / delta, y = (b * d - 2 * a * e) / delta;
        EXPECT_LE(test::gap(form->conic->conic.centre[0], x), form->conic->centre_bound);
        EXPECT_LE(test::gap(form->conic->conic.centre[1], y), form->conic->centre_bound);
        EXPECT_LT(form->conic->centre_bound, 1e-14 * norm(form->conic->conic.centre));
        // F(centre + x) = 0 (hyperbola and ellipse), relative to the size of the conic.
        const Vec<2> p = form->conic->conic.centre + form->conic->conic.x;
        const Rational px = p[0], py = p[1];
        const Rational f = a * px * px + b * px * py + cc * py * py + d * px + e * py + c[5];
        const Rational gx = 2 * a * px + b * py + d, gy = b * px + 2 * cc * py + e;
        const double off =
            std::abs(f.convert_to<double>()) / std::hypot(gx.convert_to<double>(), gy.convert_to<double>());
        EXPECT_LE(off, 1.5 * (form->conic->centre_bound + form->conic->x_bound) + 2e-16 * norm(p));
    }
}

TEST(ConicEquation, the_weight_of_an_arc_says_its_kind) {
    // The equation of the arc with weights 1, w, 1 at a, b, c: 4 w^2 L_ab L_bc = L_ac^2, with the lines
    // through the points as barycentric coordinates: here x, y and 1 - x - y.
    for (const auto& [w, type] :
         {std::pair{0.5, ConicType::ellipse}, {1.0, ConicType::parabola}, {2.0, ConicType::hyperbola}}) {
        const auto arc = must(weighted_arc<2>({{1, 0}}, {{0, 0}}, {{0, 1}}, w));
        const double k = 4 * w * w;  // 4 w^2 x y = (1 - x - y)^2
        const ConicEquation q{{1, 2 - k, 1, -2, -2, 1}};
        EXPECT_EQ(must(classify(q)), type);
        for (double t : {0.25, 0.5, 0.9}) EXPECT_NEAR(value_of(q, arc.curve(t)), 0, 1e-15);
        // Back: the arcs of the equation inside the unit square contain this one.
        const auto back = must(arcs_inside(must(solve(q)), {{{0, 0}}, {{1, 1}}}));
        double nearest = 1;
        for (const auto& a : back)
            for (int i = 0; i <= 1000; ++i)
                nearest = std::min(nearest, norm(a.curve(i / 1000.0) - arc.curve(0.4)));
        EXPECT_LT(nearest, 2e-3);
    }
}

TEST(ConicEquation, arcs_inside_a_box) {
    const Box<2> box{{{-2, -2}}, {{2, 2}}};
    const auto inside = [&](const std::array<double, 6>& c) {
        const auto arcs = must(arcs_inside(form_of(c), box));
        for (const auto& arc : arcs)
            for (int i = 0; i <= 8; ++i) {
                const Vec<2> p = arc.curve(i / 8.0);
                EXPECT_NEAR(value_of({c}, p), 0, 1e-13);
                EXPECT_LE(max_abs(p), 2 + 1e-14);
            }
        return arcs.size();
    };
    EXPECT_EQ(inside({1, 0, 1, 0, 0, -1}), 1u);   // a whole circle
    EXPECT_EQ(inside({1, 0, 1, 0, 0, -5}), 4u);   // radius sqrt 5: four arcs
    EXPECT_EQ(inside({1, 0, 1, 0, 0, -9}), 0u);   // encloses the box
    EXPECT_EQ(inside({0, 1, 0, 0, 0, -1}), 2u);   // both branches of x y = 1
    EXPECT_EQ(inside({1, 0, 0, 0, -1, -1}), 1u);  // y = x^2 - 1
    EXPECT_EQ(inside({1, 0, -1, 0, 0, -1}), 2u);
    EXPECT_EQ(inside({4, 0, 0, 0, -1, -3}), 2u);  // y = 4 x^2 - 3 leaves through the bottom: two parts
    EXPECT_EQ(inside({1, 0, 1, 0, 0, -4}), 1u);   // touches all sides
    EXPECT_EQ(arcs_inside(form_of({1, 0, -1, 0, 0, 0}), box).error().kind, RefusalKind::no_answer);
}

TEST(ConicEquation, five_points_determine_a_conic) {
    Random random(23);
    for (int k = 0; k < 100; ++k) {
        std::array<Vec<2>, 5> p;
        const double s = std::exp2(random.integer(-150, 150));
        for (auto& x : p) x = s * Vec<2>{{random.real(-1, 1) + 3, random.real(-1, 1)}};
        const auto q = must(equation_through(p));
        EXPECT_TRUE(q.type == ConicType::ellipse || q.type == ConicType::hyperbola);
        for (const auto& x : p) {
            double size = 0;
            for (int i = 0; i < 6; ++i) {
                const Vec<2> d = x - q.equation.origin;
                size += q.bound[std::size_t(i)] * (i < 3 ? norm(d) * norm(d) : i < 5 ? norm(d) : 1);
            }
            EXPECT_LE(std::abs(value_of(q.equation, x)), 10 * size + 1e-15 * s * s);
        }
    }
    const auto kind = [](std::array<Vec<2>, 5> p) { return must(equation_through(p)).type; };
    EXPECT_EQ(kind({{{{1, 0}}, {{0, 1}}, {{-1, 0}}, {{0, -1}}, {{0.6, 0.8}}}}),
              ConicType::ellipse);  // 0.6, 0.8 are rounded
    EXPECT_EQ(kind({{{{5, 0}}, {{0, 5}}, {{-5, 0}}, {{3, 4}}, {{4, -3}}}}), ConicType::circle);
    EXPECT_EQ(kind({{{{0, 0}}, {{1, 1}}, {{2, 4}}, {{-1, 1}}, {{3, 9}}}}), ConicType::parabola);
    EXPECT_EQ(kind({{{{1, 1}}, {{2, 0.5}}, {{4, 0.25}}, {{-1, -1}}, {{-2, -0.5}}}}), ConicType::hyperbola);
    const auto refused = [](std::array<Vec<2>, 5> p) { return equation_through(p).error(); };
    EXPECT_NE(refused({{{{0, 0}}, {{1, 0}}, {{2, 0}}, {{0, 1}}, {{0, 3}}}}).message.find("crossing lines"),
              std::string::npos);
    EXPECT_NE(refused({{{{0, 0}}, {{1, 0}}, {{2, 0}}, {{0, 1}}, {{5, 1}}}}).message.find("parallel lines"),
              std::string::npos);
    EXPECT_NE(refused({{{{0, 0}}, {{1, 0}}, {{2, 0}}, {{3, 0}}, {{5, 1}}}}).message.find("more than one"),
              std::string::npos);
    EXPECT_EQ(refused({{{{0, 0}}, {{1, 0}}, {{1, 0}}, {{3, 0}}, {{5, 1}}}}).kind, RefusalKind::no_answer);
    EXPECT_EQ(refused({{{{0, 0}}, {{1, HUGE_VAL}}, {{1, 0}}, {{3, 0}}, {{5, 1}}}}).where, "points[1]");
}

// The largest |F| on the curve, over the size of its terms.
double residual(const ConicEquation& q, const Curve<Hom<2>>& curve) {
    double worst = 0;
    for (int i = 0; i <= 64; ++i) {
        const Vec<2> p = curve(i / 64.0), d = p - q.origin;
        const std::array<double, 6> term{d[0] * d[0], d[0] * d[1], d[1] * d[1], d[0], d[1], 1};
        double size = 0;
        for (std::size_t k = 0; k < 6; ++k) size += std::abs(q.c[k] * term[k]);
        worst = std::max(worst, std::abs(value_of(q, p)) / size);
    }
    return worst;
}

TEST(ConicEquation, the_arc_through_five_points_passes_them_in_order_on_their_conic) {
    Random random(24);
    int more_than_half = 0;
    for (int k = 0; k < 300; ++k) {
        const double s = std::exp2(random.integer(-150, 150)), way = random.integer(0, 1) ? 1 : -1;
        const int kind = random.integer(0, 2);
        const Vec<2> x = s * Vec<2>{{random.real(1, 2), random.real(-1, 1)}},
                     y = s * Vec<2>{{random.real(-1, 1), random.real(1, 2)}},
                     m = s * Vec<2>{{random.real(-3, 3), 1}};
        std::array<Vec<2>, 5> p;
        const double from = random.real(-1.2, -0.8),
                     step = kind == 0 ? random.real(0.3, 1.2) : random.real(0.3, 0.6);
        for (int i = 0; i < 5; ++i) {
            const double t = way * (from + i * step);
            p[std::size_t(i)] = m + (kind == 0   ? std::cos(t) * x + std::sin(t) * y
                                     : kind == 1 ? t * t * x + t * y
                                                 : std::cosh(t) * x + std::sinh(t) * y);
        }
        const auto arc = must(arc_through(p));
        EXPECT_LE(arc.bound, 1e-11 * s);
        for (std::size_t i = 0; i < 5; ++i) {
            EXPECT_LE(norm(arc.curve(arc.at[i]) - p[i]), arc.bound * (1 + 1e-9));
            if (i > 0) EXPECT_LT(arc.at[i - 1], arc.at[i]);
        }
        EXPECT_LE(residual(must(equation_through(p)).equation, arc.curve), 1e-11);
        more_than_half += kind == 0 && 4 * step > std::numbers::pi;
    }
    EXPECT_GT(more_than_half, 20);
    const auto half = must(arc_through({{{{5, 0}}, {{4, 3}}, {{3, 4}}, {{0, 5}}, {{-5, 0}}}}));
    EXPECT_EQ(half.type, ConicType::circle);
    for (int i = 0; i <= 16; ++i) EXPECT_NEAR(norm(half.curve(i / 16.0)), 5, 1e-14);
}

TEST(ConicEquation, points_that_no_arc_passes_in_order_are_refused) {
    const auto refused = [](std::array<Vec<2>, 5> p) { return arc_through(p).error(); };
    EXPECT_EQ(refused({{{{5, 0}}, {{3, 4}}, {{4, 3}}, {{0, 5}}, {{-5, 0}}}}).kind, RefusalKind::no_answer);
    EXPECT_EQ(refused({{{{5, 0}}, {{3, 4}}, {{4, 3}}, {{0, 5}}, {{-5, 0}}}}).where, "points");
    // x y = 1: on both branches.
    EXPECT_EQ(refused({{{{1, 1}}, {{2, 0.5}}, {{4, 0.25}}, {{-1, -1}}, {{-2, -0.5}}}}).kind,
              RefusalKind::no_answer);
    // y = x^2 and x y = 1 in an order that asks for infinity.
    EXPECT_EQ(refused({{{{1, 1}}, {{2, 4}}, {{-2, 4}}, {{-1, 1}}, {{0, 0}}}}).kind, RefusalKind::no_answer);
    EXPECT_EQ(refused({{{{1, 1}}, {{0.5, 2}}, {{0.25, 4}}, {{4, 0.25}}, {{2, 0.5}}}}).kind,
              RefusalKind::no_answer);
    EXPECT_EQ(refused({{{{0, 0}}, {{1, 0}}, {{2, 0}}, {{0, 1}}, {{0, 3}}}}).kind, RefusalKind::no_answer);
    EXPECT_EQ(refused({{{{0, 0}}, {{1, HUGE_VAL}}, {{1, 0}}, {{3, 0}}, {{5, 1}}}}).kind,
              RefusalKind::nonfinite);
}

}  // namespace
}  // namespace freiform
