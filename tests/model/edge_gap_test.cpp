// Gaps that are known, and dense samples for those that are not.
#include <freiform/model/edge_gap.hpp>

#include <cmath>
#include <gtest/gtest.h>
#include <numbers>
#include <support/shapes.hpp>

namespace {

using namespace freiform;

constexpr double kPi = std::numbers::pi;

struct Case {
    SurfaceGeometry surface;
    CurveGeometry<2> on_surface;
    CurveGeometry<3> in_space;
    Interval range{0, 1};

    EdgeGap gap(EdgeGapOptions options = {}) const {
        return edge_gap(DerivativeQuery<2, 3>(surface), on_surface, in_space, range, options);
    }
    double sampled(int n = 20001) const {
        double worst = 0;
        for (int i = 0; i <= n; ++i) {
            const double t = i == n ? range.hi : range.lo + range.length() * i / n;
            const Vec<2> uv = jet<0>(on_surface, t).value();
            worst = std::max(worst, norm(jet<0>(surface, uv.c).value() - jet<0>(in_space, t).value()));
        }
        return worst;
    }
};

SurfaceGeometry cylinder(double radius) {
    return Extrusion{
        test::circle({}, {{radius, 0, 0}}, {{0, radius, 0}}), {{0, 0, 1}}, SurfaceKind::cylinder};
}

CurveGeometry<2> bezier(std::vector<Vec<2>> points, Interval on = {0, 1}) {
    const int degree = int(points.size()) - 1;
    return *Curve<Vec<2>>::make({*BSplineBasis::bezier(degree, on)}, {{degree + 1}, std::move(points)});
}

TEST(EdgeGap, of_a_line_that_drifts_off_a_circle_on_a_cylinder_is_known) {
    for (double drift : {1e-2, 1e-6, 1e-11}) {
        const Case c{cylinder(2),
                     Line<2>{{{0, 0}}, {{1, drift}}},
                     test::circle({}, {{2, 0, 0}}, {{0, 2, 0}}),
                     {0, 2 * kPi}};
        const EdgeGap gap = c.gap();
        EXPECT_GE(gap.bound, 2 * kPi * drift);
        EXPECT_LE(gap.bound, 1.26 * 2 * kPi * drift) << drift;
        EXPECT_NEAR(gap.found, 2 * kPi * drift, 1e-14);
    }
}

TEST(EdgeGap, is_largest_between_samples_too) {
    // A bump of height 1e-7 and width 1e-3 of the range, far from where sparse samples look.
    std::vector<double> knots{0, 0, 0, 0, 0.4001, 0.4004, 0.4006, 0.4007, 0.4011, 1, 1, 1, 1};
    std::vector<Vec<2>> net;
    const auto basis = *BSplineBasis::make(3, knots);
    for (int i = 0; i < basis.size(); ++i)
        net.push_back(
            {{(knots[std::size_t(i) + 1] + knots[std::size_t(i) + 2] + knots[std::size_t(i) + 3]) / 3,
              i == 4 ? 1e-7 : 0}});
    const Case c{cylinder(1), *Curve<Vec<2>>::make({basis}, {{basis.size()}, net}),
                 test::circle({}, {{1, 0, 0}}, {{0, 1, 0}})};
    const EdgeGap gap = c.gap();
    const double sampled = c.sampled();
    EXPECT_GT(sampled, 4e-8);
    EXPECT_GE(gap.bound, sampled);
    EXPECT_LE(gap.bound, 1.3 * sampled);
}

// A tube of parabolas has a jump of curvature between them; the curve in space has knots elsewhere.
TEST(EdgeGap, is_tight_where_curves_cross_the_knots_of_surfaces) {
    std::vector<double> knots_around(1, 0);
    std::vector<Vec<3>> net;
    const auto add = [&](double x, double y) {
        for (const double z : {0.0, 10.0}) net.push_back({{x, y, z}});
    };
    const auto corner = [](int i) { return Vec<2>{{10 * std::cos(i), 10 * std::sin(i)}}; };
    for (int i = 0; i <= 7; ++i) {
        const Vec<2> joint = 0.5 * (corner(i) + corner(i + 1));
        add(joint[0], joint[1]);
        if (i < 7) add(corner(i + 1)[0], corner(i + 1)[1]);
        knots_around.insert(knots_around.end(), 2, i);
    }
    knots_around.push_back(7);
    const SurfaceGeometry tube = *Surface<Vec<3>>::make(
        {*BSplineBasis::make(2, knots_around), *BSplineBasis::bezier(1)}, {{15, 2}, net});
    const auto way = bezier({{{0.123, 0.2}}, {{2, 0.9}}, {{5, 0}}, {{6.3, 0.7}}}, {0, 10});
    std::vector<double> at;
    for (int i = 0; i <= 250; ++i) at.push_back(i / 25.0);
    for (int knot = 1; knot <= 6;
         ++knot) {  // it is near to the tube beside these, too, but has no knot there
        Interval on{0, 10};
        for (int i = 0; i < 50; ++i)
            (jet<0>(way, on.middle()).value()[0] < knot ? on.lo : on.hi) = on.middle();
        for (const double beside : {-1e-3, 2e-3}) at.push_back(on.lo + beside);
    }
    std::ranges::sort(at);
    std::vector<double> knots(2, 0);
    std::vector<Vec<3>> points;
    for (std::size_t i = 0; i < at.size(); ++i) {
        const auto p = jet<1>(way, at[i]);
        const auto j = jet<1>(tube, p.value().c);
        const Vec<3> slope = p(1)[0] * j.d[1] + p(1)[1] * j.d[2];
        knots.insert(knots.end(), 2, at[i]);
        if (i > 0) points.push_back(j.d[0] - (at[i] - at[i - 1]) / 3 * slope);
        if (i == 0 || i + 1 == at.size()) points.push_back(j.d[0]);
        if (i + 1 < at.size()) points.push_back(j.d[0] + (at[i + 1] - at[i]) / 3 * slope);
    }
    knots.insert(knots.end(), 2, 10);
    const int size = int(points.size());
    const Case c{tube, way, *Curve<Vec<3>>::make({*BSplineBasis::make(3, knots)}, {{size}, points}), {0, 10}};
    const EdgeGap gap = c.gap({.factor = 2, .max_samples = 4000});
    const double sampled = c.sampled(200001);
    EXPECT_GE(gap.bound, sampled);
    EXPECT_LE(gap.bound, 4 * sampled);
}

TEST(EdgeGap, of_exact_curves_is_rounding) {
    const Case circle{cylinder(3),
                      Line<2>{{{0, 5}}, {{1, 0}}},
                      test::circle({{0, 0, 5}}, {{3, 0, 0}}, {{0, 3, 0}}),
                      {-1, 4}};
    EXPECT_LE(circle.gap().bound, 1e-11);
    const Case line{Extrusion{Line<3>{{}, {{1, 0, 0}}}, {{0, 1, 0}}, SurfaceKind::plane},
                    Line<2>{{{1, 2}}, {{3, -1}}},
                    Line<3>{{{1, 2, 0}}, {{3, -1, 0}}},
                    {-100, 100}};
    EXPECT_LE(line.gap().bound, 1e-10);
}

TEST(EdgeGap, asks_no_more_than_the_target) {
    const Case c{
        cylinder(1), Line<2>{{{0, 0}}, {{1, 1e-12}}}, test::circle({}, {{1, 0, 0}}, {{0, 1, 0}}), {0, 6}};
    const EdgeGap gap = c.gap({1e-3});
    EXPECT_GE(gap.bound, 6e-12);
    EXPECT_LE(gap.bound, 1e-3);
    EXPECT_GT(gap.bound, 1e-8);  // that little effort proves no more
}

TEST(EdgeGap, is_still_a_bound_when_the_effort_ends) {
    const Case c{cylinder(1),
                 bezier({{{0, 0}}, {{1.0 / 3, 1e-9}}, {{2.0 / 3, -1e-9}}, {{1, 0}}}),
                 test::circle({}, {{1, 0, 0}}, {{0, 1, 0}}),
                 {0, 1}};
    const EdgeGap early = c.gap({0, 1.25, 100}), late = c.gap();
    EXPECT_GE(early.bound, c.sampled());
    EXPECT_GT(early.bound, late.bound);
    EXPECT_TRUE(std::isfinite(early.bound));
}

TEST(EdgeGap, of_a_degenerate_edge_is_the_distance_from_its_vertex) {
    const Revolution sphere{test::circle({}, {{1, 0, 0}}, {{0, 0, 1}}), {}, {{0, 0, 1}}, SurfaceKind::sphere};
    const double off = 1e-5;  // of the pole, in latitude
    const Case c{sphere, Line<2>{{{0, kPi / 2 - off}}, {{1, 0}}}, Line<3>{{{0, 0, 1}}, {}}, {0, 2 * kPi}};
    const double exact = 2 * std::sin(off / 2);
    EXPECT_GE(c.gap().bound, exact);
    EXPECT_LE(c.gap().bound, 1.26 * exact);
}

TEST(EdgeGap, holds_against_dense_samples_on_splines_of_every_kind) {
    std::mt19937 rng(7);
    for (int degree = 1; degree <= 4; ++degree)
        for (int round = 0; round < 3; ++round) {
            const auto polynomial = test::random_patch<2, Vec<3>>(rng, {degree, degree + 1}, 2);
            const auto rational = test::random_patch<2, Hom<3>>(rng, {degree + 1, degree}, 1);
            for (const SurfaceGeometry& s : {SurfaceGeometry(polynomial), SurfaceGeometry(rational)}) {
                const auto on = domain(s);
                std::vector<Vec<2>> p;
                for (int i = 0; i < 4; ++i)
                    p.push_back(
                        {{test::uniform(rng, on[0].lo, on[0].hi), test::uniform(rng, on[1].lo, on[1].hi)}});
                // The edge: a spline through the image, so that gaps are small beside the surface.
                const CurveGeometry<2> curve = bezier(p);
                std::vector<Vec<3>> q;
                for (int i = 0; i <= 40; ++i)
                    q.push_back(jet<0>(s, jet<0>(curve, i / 40.0).value().c).value());
                std::vector<double> knots{0};
                for (int i = 0; i <= 40; ++i) knots.push_back(i / 40.0);
                knots.push_back(1);
                const Case c{s, curve, *Curve<Vec<3>>::make({*BSplineBasis::make(1, knots)}, {{41}, q})};
                const EdgeGap gap = c.gap();
                const double sampled = c.sampled();
                EXPECT_GE(gap.bound, sampled) << degree;
                EXPECT_LE(gap.bound, 1.3 * sampled) << degree;
                EXPECT_GE(gap.found, 0.8 * sampled) << degree;
            }
        }
}

// Where the surface has an edge of its own: along it, across it, and beyond the domain by rounding.
TEST(EdgeGap, is_tight_along_and_across_the_seams_of_a_surface) {
    const auto folded = [](int multiplicity) {
        std::vector<double> u{0, 0, 0, 0};
        u.insert(u.end(), std::size_t(multiplicity), 1.0);
        u.insert(u.end(), 4, 2.0);
        const auto basis = *BSplineBasis::make(3, u);
        std::vector<Vec<3>> net;
        for (int i = 0; i < basis.size(); ++i)
            for (int j = 0; j < 2; ++j) net.push_back({{double(i), 3.0 * j, i == 3 ? 2.0 : i * i * 0.25}});
        return SurfaceGeometry(
            *Surface<Vec<3>>::make({basis, *BSplineBasis::bezier(1)}, {{basis.size(), 2}, net}));
    };
    for (int multiplicity : {1, 2, 3}) {
        const SurfaceGeometry s = folded(multiplicity);
        for (double wobble : {0.0, 1e-15, 1e-9})
            for (double u : {0.0, 1.0, 2.0}) {
                const Vec<3> a = jet<0>(s, {u, 0}).value(), b = jet<0>(s, {u, 1}).value();
                const Case along{
                    s, bezier({{{u, 0}}, {{u + wobble, 1.0 / 3}}, {{u - wobble, 2.0 / 3}}, {{u, 1}}}),
                    Line<3>{a + Vec<3>{{0, 0, 1e-8}}, b - a}};
                EXPECT_GE(along.gap().bound, 1e-8);
                EXPECT_LE(along.gap().bound, 1.3 * (1e-8 + 8 * wobble)) << multiplicity << " " << u;
            }
        const auto& net = std::get<Surface<Vec<3>>>(s).net();
        std::vector<Vec<3>> profile;
        for (int i = 0; i < net.extent()[0]; ++i)
            profile.push_back(net.flat()[std::size_t(2 * i)] + Vec<3>{{0, 0, 1e-7}});
        const auto& basis = std::get<Surface<Vec<3>>>(s).basis(0);
        const Case across{s,
                          Line<2>{{{0, 1e-8}}, {{1, 0}}},
                          *Curve<Vec<3>>::make({basis}, {{basis.size()}, profile}),
                          {0, 2}};
        EXPECT_GE(across.gap().bound, std::hypot(1e-7, 3e-8) * (1 - 1e-6));
        EXPECT_LE(across.gap().bound, 1.3 * std::hypot(1e-7, 3e-8)) << multiplicity;
    }
}

TEST(EdgeGap, scales_exactly_with_powers_of_two) {
    Case c{cylinder(2), Line<2>{{{0, 0}}, {{1, 1e-6}}}, test::circle({}, {{2, 0, 0}}, {{0, 2, 0}}), {0, 6}};
    const EdgeGap one = c.gap();
    const double f = 0x1p-40;
    c.surface =
        Extrusion{test::circle({}, {{2 * f, 0, 0}}, {{0, 2 * f, 0}}), {{0, 0, f}}, SurfaceKind::cylinder};
    c.in_space = test::circle({}, {{2 * f, 0, 0}}, {{0, 2 * f, 0}});
    const EdgeGap other = c.gap();
    EXPECT_EQ(other.bound, f * one.bound);
    EXPECT_EQ(other.found, f * one.found);
}

TEST(EdgeGap, is_infinite_where_nothing_can_be_said) {
    const auto torn = *Surface<Vec<3>>::make(
        {*BSplineBasis::make(1, {0, 0, 1, 1, 2, 2}), *BSplineBasis::bezier(1)}, {{4, 2},
                                                                                 {{{0, 0, 0}},
                                                                                  {{0, 1, 0}},
                                                                                  {{1, 0, 0}},
                                                                                  {{1, 1, 0}},
                                                                                  {{1, 0, 1}},
                                                                                  {{1, 1, 1}},
                                                                                  {{2, 0, 1}},
                                                                                  {{2, 1, 1}}}});
    const Case across{
        SurfaceGeometry(torn), Line<2>{{{0, 0.5}}, {{1, 0}}}, Line<3>{{{0, 0.5, 0}}, {{1, 0, 0}}}, {0, 2}};
    EXPECT_EQ(across.gap().bound, std::numeric_limits<double>::infinity());
    Case outside{
        cylinder(1), bezier({{{0, 0}}, {{1, 0}}}), test::circle({}, {{1, 0, 0}}, {{0, 1, 0}}), {0, 1.5}};
    EXPECT_EQ(outside.gap().bound, std::numeric_limits<double>::infinity());
}

// An offset of a spline has no bound of its third derivative: order 2 has to do.
TEST(EdgeGap, holds_on_offsets) {
    std::mt19937 rng(3);
    const auto base = std::make_shared<const SurfaceGeometry>(test::landscape(rng, 3, 5, 0.05));
    const SurfaceGeometry s = OffsetSurface{base, 0.01};
    const CurveGeometry<2> curve = Line<2>{{{0.3, 0.3}}, {{1, 0.5}}};
    std::vector<Vec<3>> q;
    for (int i = 0; i <= 20; ++i) q.push_back(jet<0>(s, jet<0>(curve, i / 20.0).value().c).value());
    std::vector<double> knots{0};
    for (int i = 0; i <= 20; ++i) knots.push_back(i / 20.0);
    knots.push_back(1);
    const Case c{s, curve, *Curve<Vec<3>>::make({*BSplineBasis::make(1, knots)}, {{21}, q})};
    EXPECT_GE(c.gap().bound, c.sampled());
    EXPECT_LE(c.gap().bound, 2 * c.sampled());
}

}  // namespace
