#include <freiform/poly/predicates.hpp>
#include <freiform/query/self_intersection.hpp>

#include <gtest/gtest.h>
#include <support/bezier.hpp>

namespace freiform::test {
namespace {

template <class M>
int certain(const std::vector<M>& all) {
    return int(std::count_if(all.begin(), all.end(), [](const M& m) { return m.is_certain(); }));
}

// How often an inscribed polygon crosses itself.
template <class C>
int crossings_of_polygon(const C& curve, int legs_per_span) {
    const auto breaks = curve.basis().breaks();
    std::vector<Vec<2>> p;
    for (std::size_t j = 0; j + 1 < breaks.size(); ++j)
        for (int i = 0; i < legs_per_span; ++i)
            p.push_back(curve(breaks[j] + (breaks[j + 1] - breaks[j]) * i / legs_per_span));
    p.push_back(curve(breaks.back()));
    int n = 0;
    for (std::size_t i = 0; i + 1 < p.size(); ++i) {
        Box<2> a;
        a.add(p[i]), a.add(p[i + 1]);
        for (std::size_t j = i + 2; j + 1 < p.size(); ++j) {
            if (std::max(p[j][0], p[j + 1][0]) < a.lo[0] || std::min(p[j][0], p[j + 1][0]) > a.hi[0])
                continue;
            n += segments_cross(p[i], p[i + 1], p[j], p[j + 1]);
        }
    }
    return n;
}

TEST(SelfIntersections, of_a_loop_is_one_and_exact) {
    const auto found =
        must(self_intersections(bezier<Vec<2>>({{{0, 0}}, {{8, 3}}, {{-5, 3}}, {{3, 0}}}), 1e-10));
    ASSERT_EQ(found.size(), 1u);
    const auto& m = found[0];
    EXPECT_TRUE(m.is_certain());
    EXPECT_NEAR(m.first.middle() + m.second.middle(), 1, 1e-9);  // the loop is symmetric
    EXPECT_NEAR(m.point[0], 1.5, 1e-9);
    EXPECT_LT(m.bound, 1.1e-10);
}

template <class P>
int expect_all_found(std::uint64_t seed, int cases, int degree, Ends ends) {
    Random random(seed);
    int count = 0, open = 0;
    for (int k = 0; k < cases; ++k) {
        const auto c = random_patch<1, P>(random, degree, {ends, k % 5 == 0 ? 8 : 3});
        if (c.basis().degree() < 2 || c.basis().size() < 3) continue;  // a point, a line there and back
        const auto found = must(self_intersections(c, 1e-9));
        open += int(found.size()) - certain(found);
        if (open == 0) EXPECT_EQ(certain(found), crossings_of_polygon(c, 400)) << "case " << k;
        for (const auto& m : found) {
            EXPECT_LT(m.first.hi, m.second.lo);
            EXPECT_LE(distance(c(m.first.middle()), c(m.second.middle())), 2e-9);
            EXPECT_LE(m.bound, 1.1e-9);
        }
        for (std::size_t i = 0; i < found.size(); ++i)
            for (std::size_t j = 0; j < i; ++j)
                EXPECT_FALSE(found[i].first.overlaps(found[j].first) &&
                             found[i].second.overlaps(found[j].second));
        count += certain(found);
    }
    EXPECT_EQ(open, 0);
    return count;
}

TEST(SelfIntersections, of_random_curves_are_those_of_a_fine_polygon) {
    EXPECT_GT(expect_all_found<Vec<2>>(31, 60, 5, Ends::clamped), 10);
    EXPECT_GT(expect_all_found<Hom<2>>(32, 60, 4, Ends::clamped), 10);
    EXPECT_GT(expect_all_found<Hom<2>>(33, 40, 4, Ends::closed), 10);
}

TEST(SelfIntersections, of_an_eight_lie_at_a_knot_or_not) {
    // A closed cubic spline in the form of an 8; the crossing is a knot on both branches.
    for (const double shift : {0.0, 0.25}) {
        const auto basis = must(BSplineBasis::periodic(3, {0, 1, 2, 3, 4, 5, 6, 7, 8}));
        std::vector<Vec<2>> p{{{0, 0}}, {{2, 2}},  {{4, 0}},  {{2, -2}},
                              {{0, 0}}, {{-2, 2}}, {{-4, 0}}, {{-2, -2}}};
        p[1][1] += shift;
        const auto c = must(Curve<Vec<2>>::make({basis}, Net<1, Vec<2>>({8}, p)));
        const auto found = must(self_intersections(c, 1e-9));
        ASSERT_EQ(found.size(), 1u);
        EXPECT_TRUE(found[0].is_certain());
    }
}

TEST(SelfIntersections, are_none_where_curves_are_simple) {
    // An arc, a curve that starts at rest, a closed circle, and a spiral.
    EXPECT_TRUE(must(self_intersections(bezier<Vec<2>>({{{0, 0}}, {{1, 2}}, {{3, 0}}}), 1e-9)).empty());
    EXPECT_TRUE(
        must(self_intersections(bezier<Vec<2>>({{{0, 0}}, {{0, 0}}, {{1, 1}}, {{2, 0}}, {{2, 0}}}), 1e-9))
            .empty());
    const double h = std::sqrt(0.5);
    const std::vector<double> w{1, h, 1, h, 1, h, 1, h};
    const std::vector<Vec<2>> corners{{{1, 0}},  {{1, 1}},   {{0, 1}},  {{-1, 1}},
                                      {{-1, 0}}, {{-1, -1}}, {{0, -1}}, {{1, -1}}};
    const auto circle =
        must(Curve<Hom<2>>::make({must(BSplineBasis::periodic(2, {0, 0, 1, 1, 2, 2, 3, 3, 4}))},
                                 Net<1, Hom<2>>({8}, must(make_rational<2>(corners, w)))));
    EXPECT_TRUE(must(self_intersections(circle, 1e-9)).empty());
    std::vector<Vec<2>> spiral;
    for (int i = 0; i < 40; ++i) spiral.push_back((1 + i) * Vec<2>{{std::cos(0.7 * i), std::sin(0.7 * i)}});
    const auto long_curve =
        must(Curve<Vec<2>>::make({must(BSplineBasis::clamped_uniform(3, 40))}, Net<1, Vec<2>>({40}, spiral)));
    EXPECT_TRUE(must(self_intersections(long_curve, 1e-9)).empty());
}

TEST(SelfIntersections, at_cusps_and_of_ends_that_meet_are_told_apart) {
    const auto cusp =
        must(self_intersections(bezier<Vec<2>>({{{3, -1}}, {{-1, 1}}, {{-1, -1}}, {{3, 1}}}), 1e-8));
    ASSERT_EQ(cusp.size(), 1u);
    EXPECT_EQ(cusp[0].kind, SelfContact::cusp);
    EXPECT_TRUE(cusp[0].first.contains(0.5) || cusp[0].second.contains(0.5));
    EXPECT_LT(cusp[0].bound, 1e-6);
    // A closed teardrop of an open curve: its ends meet.
    const auto drop =
        must(self_intersections(bezier<Vec<2>>({{{0, 0}}, {{3, 3}}, {{-3, 3}}, {{0, 0}}}), 1e-8));
    ASSERT_EQ(drop.size(), 1u);
    EXPECT_EQ(drop[0].kind, SelfContact::meeting);
    EXPECT_EQ(drop[0].at, (std::array<double, 2>{0, 1}));
    EXPECT_EQ(drop[0].first.lo, 0);
    EXPECT_EQ(drop[0].second.hi, 1);
    // Its end aside by less than rounding leaves room for: near, and how near. By more: apart.
    const double off = 0x1p-52;
    const auto open =
        must(self_intersections(bezier<Vec<2>>({{{0, 0}}, {{3, 3}}, {{-3, 3}}, {{0, -off}}}), 1e-8));
    ASSERT_EQ(open.size(), 1u);
    EXPECT_EQ(open[0].kind, SelfContact::near);
    EXPECT_LE(open[0].distance, off + 1e-13);
    EXPECT_TRUE(
        must(self_intersections(bezier<Vec<2>>({{{0, 0}}, {{3, 3}}, {{-3, 3}}, {{0, -0x1p-40}}}), 1e-8))
            .empty());
    // There and back again: everywhere.
    const auto back = must(self_intersections(bezier<Vec<2>>({{{0, 0}}, {{2, 1}}, {{0, 0}}}), 1e-6, 3000));
    ASSERT_EQ(back.size(), 1u);
    EXPECT_EQ(back[0].kind, SelfContact::meeting);
    EXPECT_EQ(back[0].first.lo, 0);
    EXPECT_EQ(back[0].second.hi, 1);
    // The same with ends that differ, and a budget that is used up.
    const auto long_way =
        must(self_intersections(bezier<Vec<2>>({{{0, 0}}, {{2, 1}}, {{0.5, 0.25}}}), 1e-9, 40));
    ASSERT_FALSE(long_way.empty());
    EXPECT_EQ(long_way[0].kind, SelfContact::unresolved);
}

// Two parabolas that touch at their vertices, joined by an arc far away.
Curve<Vec<2>> touching(double gap) {
    std::vector<Vec<2>> pieces;
    // Quadratic, cubic, quadratic: all written as cubics.
    const auto lift = [&](Vec<2> p, Vec<2> q, Vec<2> r) {
        pieces.insert(pieces.end(), {p, 1.0 / 3 * p + 2.0 / 3 * q, 2.0 / 3 * q + 1.0 / 3 * r, r});
    };
    lift({{-3, 3}}, {{0, -3}}, {{3, 3}});
    pieces.insert(pieces.end(), {{{5, 7}}, {{5, -7 - gap}}, {{3, -3 - gap}}});
    const std::size_t end = pieces.size() - 1;
    lift(pieces[end], {{0, 3 - gap}}, {{-3, -3 - gap}});
    pieces.erase(pieces.begin() + std::ptrdiff_t(end));
    const int n = int(pieces.size());
    return must(Curve<Vec<2>>::make({must(BSplineBasis::make(3, {0, 0, 0, 0, 1, 1, 1, 2, 2, 2, 3, 3, 3, 3}))},
                                    Net<1, Vec<2>>({n}, std::move(pieces))));
}

TEST(SelfIntersections, that_touch_are_decided_where_integers_can) {
    const auto found = must(self_intersections(touching(0), 1e-6));
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].kind, SelfContact::meeting);
    EXPECT_EQ(found[0].at, (std::array<double, 2>{0.5, 2.5}));
    EXPECT_LT(norm(found[0].point), 0.01);
    const auto near = must(self_intersections(touching(0x1p-50), 1e-6));
    ASSERT_EQ(near.size(), 1u);
    EXPECT_EQ(near[0].kind, SelfContact::near);
    EXPECT_GE(near[0].distance, 0x1p-50 * 0.99);
    EXPECT_LE(near[0].distance, 1e-12);
    EXPECT_TRUE(must(self_intersections(touching(1e-3), 1e-6)).empty());
    const auto crossing = must(self_intersections(touching(-1e-3), 1e-6));
    EXPECT_EQ(certain(crossing), 2);
    EXPECT_EQ(crossing.size(), 2u);
}

TEST(SelfIntersections, in_space_are_decided_for_curves_of_a_plane) {
    const std::vector<Vec<2>> loop{{{0, 0}}, {{8, 3}}, {{-5, 3}}, {{3, 0}}};
    const auto in_plane = must(self_intersections(bezier(loop), 1e-6));
    // x, y into planes with exact coordinates: level, steep, upright.
    const Vec<3> planes[][2] = {
        {{{1, 0, 0}}, {{0, 1, 0}}}, {{{1, 0, 8}}, {{0, 1, 2}}}, {{{0, 0, 1}}, {{0, 2, 0}}}};
    for (const auto& [x, y] : planes) {
        std::vector<Vec<3>> b;
        std::vector<Hom<3>> r;
        for (const Vec<2>& p : loop) {
            b.push_back(Vec<3>{{1, 2, 3}} + p[0] * x + p[1] * y);
            r.push_back(weighted(b.back(), r.size() == 1 ? 0.5 : 1));
        }
        const auto curve = bezier(b);
        const auto found = must(self_intersections(curve, 1e-6));
        ASSERT_EQ(found.size(), 1u);
        EXPECT_EQ(found[0].kind, SelfContact::crossing);
        EXPECT_NEAR(found[0].at[0], in_plane[0].at[0], 1e-9);
        EXPECT_NEAR(found[0].at[1], in_plane[0].at[1], 1e-9);
        for (const Interval& on : {found[0].first, found[0].second})
            for (const double t : {on.lo, on.middle(), on.hi})
                EXPECT_LE(norm(curve(t) - found[0].point), found[0].bound);
        EXPECT_LT(found[0].bound, 1.1e-6);
        EXPECT_EQ(certain(must(self_intersections(bezier(r), 1e-6))), 1);
    }
    // One point out of the plane by a little: undecided, or apart.
    std::vector<Vec<3>> bent{{{0, 0, 1}}, {{8, 3, 1}}, {{-5, 3, 1 + 0x1p-50}}, {{3, 0, 1}}};
    const auto almost = must(self_intersections(bezier(bent), 1e-6));
    ASSERT_EQ(almost.size(), 1u);
    EXPECT_EQ(almost[0].kind, SelfContact::near);
    EXPECT_LE(almost[0].distance, 1e-12);
    EXPECT_NEAR(almost[0].point[0], 1.5, 1e-5);
    const auto lifted = bezier<Vec<3>>({{{0, 0, 0}}, {{8, 3, 0}}, {{-5, 3, 1}}, {{3, 0, 1}}});
    EXPECT_TRUE(must(self_intersections(lifted, 1e-6)).empty());
}

TEST(SelfIntersections, in_space_are_found_at_simple_parameters) {
    // Segments through the origin along x and along (1, 1, 1), and two to join them: at 1/2 and 3 + 1/4.
    const std::vector<Vec<3>> p{{{-1, 0, 0}}, {{1, 0, 0}}, {{1, 5, 0}}, {{-1, -1, -1}}, {{3, 3, 3}}};
    const auto curve = must(
        Curve<Vec<3>>::make({must(BSplineBasis::make(1, {0, 0, 1, 2, 3, 4, 4}))}, Net<1, Vec<3>>({5}, p)));
    const auto found = must(self_intersections(curve, 1e-6));
    ASSERT_EQ(found.size(), 1u);
    EXPECT_EQ(found[0].kind, SelfContact::meeting);
    EXPECT_EQ(found[0].at, (std::array<double, 2>{0.5, 3.25}));
}

TEST(SelfIntersections, ask_for_an_accuracy) {
    EXPECT_EQ(self_intersections(bezier<Vec<2>>({{{0, 0}}, {{1, 2}}}), 0).error().where, "accuracy");
}

}  // namespace
}  // namespace freiform::test
