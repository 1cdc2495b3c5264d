#include <freiform/query/bounds.hpp>
#include <freiform/query/features.hpp>

#include <gtest/gtest.h>
#include <support/bezier.hpp>

namespace freiform::test {
namespace {

template <class F>
std::string kinds(const F& features) {
    std::string s;
    for (const auto& f : features) s += text(s.empty() ? "" : " ", name_of(f.kind), f.at_knot ? "!" : "");
    return s;
}

TEST(Inflections, of_known_curves_are_exact) {
    // y = cube about the middle; undulation; a straight line; the cusp (t^2, t^3) is no inflection.
    const auto cube = must(inflections(bezier<Vec<2>>({{{0, -1}}, {{1, 1}}, {{2, -1}}, {{3, 1}}}), 1e-9));
    ASSERT_EQ(kinds(cube), "inflection");
    EXPECT_TRUE(cube[0].at.contains(0.5));
    EXPECT_EQ(
        kinds(must(inflections(bezier<Vec<2>>({{{0, 1}}, {{1, -1}}, {{2, 1}}, {{3, -1}}, {{4, 1}}}), 1e-9))),
        "flat");
    EXPECT_EQ(kinds(must(inflections(bezier<Vec<2>>({{{0, 0}}, {{1, 2}}, {{3, 6}}}), 1e-9))), "straight");
    const auto cusp = bezier<Vec<2>>({{{3, -1}}, {{-1, 1}}, {{-1, -1}}, {{3, 1}}});
    EXPECT_EQ(kinds(must(inflections(cusp, 1e-9))), "");
    const auto at = must(cusps(cusp, 1e-9));
    ASSERT_EQ(kinds(at), "cusp");
    EXPECT_TRUE(at[0].at.contains(0.5));
    EXPECT_LT(at[0].bound, 1e-8);
}

TEST(Inflections, of_random_curves_change_the_sign_of_the_curvature) {
    Random random(21);
    int count = 0;
    for (int k = 0; k < 150; ++k) {
        const auto c = random_patch<1, Hom<2>>(random, 5, {k % 3 ? Ends::clamped : Ends::closed, 3});
        if (c.basis().degree() < 3) continue;
        const auto found = must(inflections(c, 1e-9));
        const auto curvature = [&](double t) {
            const auto j = c.jet<2>(t);
            return cross(j.d[1], j.d[2]);
        };
        // Between two answers the sign is the same everywhere, at those that change it, it does.
        std::vector<double> ends{c.basis().domain().lo};
        for (const auto& f : found) ends.push_back(f.at.lo), ends.push_back(f.at.hi);
        ends.push_back(c.basis().domain().hi);
        int last = 0;
        for (std::size_t i = 0; i + 1 < ends.size(); i += 2) {
            if (!(ends[i + 1] - ends[i] > 1e-6)) {
                last = 0;
                continue;
            }
            int sign = 0;
            for (int j = 1; j < 60; ++j) {
                const double x = curvature(ends[i] + (ends[i + 1] - ends[i]) * j / 60);
                if (sign == 0) sign = x > 0 ? 1 : -1;
                EXPECT_GT(sign * x, 0);
            }
            if (last != 0 && found[i / 2 - 1].kind == FeatureKind::inflection) {
                EXPECT_EQ(sign, -last);
                ++count;
            }
            last = sign;
        }
    }
    EXPECT_GT(count, 60);
}

TEST(Inflections, at_knots_where_the_curvature_jumps_are_found) {
    // A quadratic spline of two arcs that bend to different sides.
    const auto c = must(Curve<Vec<2>>::make({must(BSplineBasis::make(2, {0, 0, 0, 1, 2, 2, 2}))},
                                            Net<1, Vec<2>>({4}, {{{0, 0}}, {{1, 1}}, {{2, -1}}, {{3, 0}}})));
    const auto found = must(inflections(c, 1e-9));
    ASSERT_EQ(kinds(found), "inflection!");
    EXPECT_EQ(found[0].at, (Interval{1, 1}));
}

TEST(Inflections, in_space_are_points_without_curvature) {
    // (t, t^3, t^4) about t = 1/2 has curvature 0 there, (t, t^2, t^3) nowhere.
    const auto flat = bezier<Vec<3>>({{{0, -4, 1}}, {{1, 2, -1}}, {{2, 0, 1}}, {{3, -2, -1}}, {{4, 4, 1}}});
    const auto found = must(inflections(flat, 1e-9));
    ASSERT_EQ(kinds(found), "flat");
    EXPECT_TRUE(found[0].at.contains(0.5));
    EXPECT_EQ(
        kinds(must(inflections(bezier<Vec<3>>({{{0, 0, 0}}, {{1, 0, 0}}, {{2, 1, 0}}, {{3, 3, 1}}}), 1e-9))),
        "");
}

TEST(Cusps, at_ends_and_of_rational_curves_are_found) {
    const auto still =
        must(cusps(bezier<Vec<3>>({{{0, 0, 1}}, {{0, 0, 1}}, {{1, 2, 3}}, {{3, 1, 1}}}), 1e-9));
    ASSERT_EQ(kinds(still), "cusp");
    EXPECT_EQ(still[0].at, (Interval{0, 0}));
    // The projective image of a cusp is a cusp.
    const auto c = bezier<Hom<2>>({{{3, -1, 1}}, {{-1, 1, 2}}, {{-1, -1, 3}}, {{3, 1, 4}}});
    const auto found = must(cusps(c, 1e-9));
    ASSERT_EQ(kinds(found), "cusp");
    EXPECT_TRUE(found[0].at.contains(0.5));
    Random random(22);
    for (int k = 0; k < 100; ++k) {
        const auto r = random_patch<1, Hom<2>>(random, 5, {Ends::closed, 4});
        if (r.basis().size() < 3) continue;  // a point, or a line there and back
        EXPECT_EQ(kinds(must(cusps(r, 1e-9))), "") << k;
    }
}

TEST(Extrema, with_the_ends_make_the_box) {
    Random random(23);
    int count = 0;
    for (int k = 0; k < 200; ++k) {
        const auto c = random_patch<1, Hom<3>>(random, 6, {k % 2 ? Ends::closed : Ends::clamped, 3});
        const Vec<3> d{{random.real(-1, 1), random.real(-1, 1), random.real(-1, 1)}};
        if (c.basis().size() == 1) continue;  // a point
        const auto found = must(extrema(c, d, 1e-12));
        double lo = 1e9, hi = -1e9;
        for (const double t : {c.basis().domain().lo, c.basis().domain().hi})
            lo = std::min(lo, dot(d, c(t))), hi = std::max(hi, dot(d, c(t)));
        for (const auto& f : found) {
            EXPECT_TRUE(f.kind == FeatureKind::maximum || f.kind == FeatureKind::minimum) << name_of(f.kind);
            lo = std::min(lo, dot(d, f.point)), hi = std::max(hi, dot(d, f.point));
            ++count;
        }
        const Extent e = must(extent_along(c, d, 1e-12));
        EXPECT_NEAR(lo, e.range.lo, 1e-10);
        EXPECT_NEAR(hi, e.range.hi, 1e-10);
    }
    EXPECT_GT(count, 300);
    const auto s = bezier<Vec<1>>({{{-1}}, {{1}}, {{-1}}, {{1}}});  // (2 t - 1)^3
    EXPECT_EQ(kinds(must(extrema(s, Vec<1>{{1}}, 1e-9))), "stationary");
    EXPECT_EQ(kinds(must(extrema(bezier<Vec<1>>({{{-1}}, {{0}}, {{0}}, {{1}}}), Vec<1>{{1}}, 1e-9))), "");
    EXPECT_EQ(kinds(must(extrema(bezier<Vec<1>>({{{-1}}, {{2}}, {{-2}}, {{1}}}), Vec<1>{{1}}, 1e-9))),
              "maximum minimum");
    EXPECT_EQ(kinds(must(extrema(bezier<Vec<2>>({{{0, 7}}, {{1, 7}}, {{3, 7}}}), Vec<2>{{0, 1}}, 1e-9))),
              "constant");
}

TEST(Vertices, of_a_parabola_and_a_circle_are_exact) {
    const auto parabola = must(vertices(bezier<Vec<2>>({{{-1, 1}}, {{0, -1}}, {{1, 1}}}), 1e-9));
    ASSERT_EQ(kinds(parabola), "maximum");
    EXPECT_TRUE(parabola[0].at.contains(0.5));
    // A quarter of the unit circle with weights 1, 1, 2, exactly.
    EXPECT_EQ(kinds(must(vertices(bezier<Hom<2>>({{{1, 0, 1}}, {{1, 1, 1}}, {{0, 2, 2}}}), 1e-9))),
              "constant");
    // A quarter of an ellipse from axis to axis has its vertices at the ends.
    const auto ellipse = must(vertices(bezier<Hom<2>>({{{2, 0, 1}}, {{2, 1, 1}}, {{0, 2, 2}}}), 1e-9));
    ASSERT_EQ(ellipse.size(), 2u);
    EXPECT_EQ(ellipse[0].at, (Interval{0, 0}));
    EXPECT_EQ(ellipse[1].at, (Interval{1, 1}));
}

TEST(Vertices, of_random_curves_agree_with_samples_of_the_curvature) {
    Random random(24);
    int count = 0;
    for (int k = 0; k < 60; ++k) {
        const auto c = random_patch_on<1, Vec<2>>(random, {must(BSplineBasis::bezier(random.integer(2, 5)))});
        const auto curvature = [&](double t) {
            const auto j = c.jet<2>(t);
            return cross(j.d[1], j.d[2]) / std::pow(norm(j.d[1]), 3);
        };
        for (const auto& f : must(vertices(c, 1e-12))) {
            const double t = f.at.middle(), h = 1e-3;
            if (t < h || t > 1 - h) continue;
            const double side = f.kind == FeatureKind::maximum ? 1 : -1;
            int nearby = 0;
            for (const auto& g : must(vertices(c, 1e-12))) nearby += std::abs(g.at.middle() - t) < 3 * h;
            if (nearby > 1) continue;
            EXPECT_GT(side * (curvature(t) - curvature(t - h)), 0);
            EXPECT_GT(side * (curvature(t) - curvature(t + h)), 0);
            ++count;
        }
    }
    EXPECT_GT(count, 60);
}

TEST(Features, refuse_what_is_no_question) {
    const auto c = bezier<Vec<2>>({{{0, 0}}, {{1, 1}}, {{2, 0}}});
    EXPECT_EQ(inflections(c, -1.0).error().where, "accuracy");
    EXPECT_EQ(cusps(c, NAN).error().kind, RefusalKind::invalid);
    EXPECT_EQ(extrema(c, Vec<2>{}, 1e-9).error().where, "direction");
    Random random(25);
    const auto high = random_patch_on<1, Hom<2>>(random, {must(BSplineBasis::bezier(25))});
    EXPECT_EQ(vertices(high, 1e-9).error().kind, RefusalKind::unsupported);
    EXPECT_TRUE(inflections(high, 1e-9).has_value());
}

}  // namespace
}  // namespace freiform::test
