#include <freiform/query/crossings.hpp>

#include <gtest/gtest.h>
#include <support/bezier.hpp>
#include <support/sturm.hpp>

namespace freiform::test {
namespace {

// normal . X + offset w, exactly, as a polynomial in t.
template <class P>
Polynomial distance_polynomial(const Curve<P>& c, const PointOf<P>& normal, double offset) {
    constexpr int kLeast = -300;
    Polynomial b;
    for (const P& p : c.net().flat()) {
        Whole sum = whole_of(offset, kLeast) * whole_of(Space<P>::weight(p), kLeast);
        for (int k = 0; k < Space<P>::kDim; ++k) sum += whole_of(normal[k], kLeast) * whole_of(p[k], kLeast);
        b.push_back(sum);
    }
    return power_form(std::move(b));
}

// Returns the number of crossings; none may be missed and none invented.
template <class P>
int expect_exact(const Curve<P>& c, const PointOf<P>& normal, double offset, double accuracy) {
    const auto hits = must(crossings(c, normal, offset, accuracy));
    const Polynomial p = distance_polynomial(c, normal, offset);
    if (p.empty()) {
        EXPECT_EQ(hits.size(), 1u);
        if (!hits.empty()) EXPECT_EQ(hits[0].kind, CrossingKind::overlap);
        return 0;
    }
    const RootCount exact(p);
    int all = 0;
    for (const auto& h : hits) {
        EXPECT_NE(h.kind, CrossingKind::possible);
        EXPECT_EQ(h.least, h.most);
        const int inside = exact.with_multiplicity(h.at.lo, h.at.hi);
        if (h.at.lo == h.at.hi)
            EXPECT_EQ(exact.multiplicity_at(h.at.lo), h.most);
        else
            EXPECT_EQ(inside, h.most);
        EXPECT_LE(h.bound, accuracy + 1e-13);
        const bool end = h.at.lo == 0 || h.at.hi == 1;
        EXPECT_EQ(h.kind, end               ? CrossingKind::end
                          : h.most % 2 != 0 ? CrossingKind::crossing
                                            : CrossingKind::tangent);
        all += h.most;
    }
    EXPECT_EQ(all, exact.with_multiplicity(0, 1) + exact.multiplicity_at(0));
    return int(hits.size());
}

TEST(Crossings, of_ten_thousand_random_curves_with_lines_agree_with_sturm) {
    Random random(11);
    int count = 0;
    for (int k = 0; k < 10000; ++k) {
        const int n = random.integer(1, k % 50 == 0 ? 9 : 4);
        const bool grid = k % 4 != 0;
        const auto number = [&](double size) {
            return grid ? random.integer(-3, 3) : random.real(-size, size);
        };
        Vec<2> normal{{number(1), number(1)}};
        if (normal == Vec<2>{}) normal[0] = 1;
        if (k % 2 == 0) {
            std::vector<Vec<2>> p;
            for (int i = 0; i <= n; ++i) p.push_back({{number(1), number(1)}});
            count += expect_exact(bezier(p), normal, 0.3 * number(1), 1e-9);
        } else {
            std::vector<Hom<2>> p;
            for (int i = 0; i <= n; ++i)
                p.push_back(weighted(Vec<2>{{number(1), number(1)}},
                                     grid ? random.integer(1, 3) : random.real(0.5, 2)));
            count += expect_exact(bezier(p), normal, number(0.5), 1e-9);
        }
        if (HasFailure()) FAIL() << "case " << k;
    }
    EXPECT_GT(count, 5000);
}

TEST(Crossings, of_nasty_curves_with_lines_agree_with_sturm) {
    Random random(12);
    int cases = 0;
    const auto nasty = [&](std::vector<Vec<2>> p, Vec<2> normal, double offset) {
        expect_exact(bezier(p), normal, offset, 1e-10);
        ++cases;
    };
    for (int k = 0; k < 25; ++k) {
        const double a = random.integer(1, 9), x = random.real(-1, 1), y = random.real(-1, 1);
        nasty({{{0, a}}, {{1, -a}}, {{2, a}}}, {{0, 1}}, 0);             // touches
        nasty({{{0, a}}, {{1, -a}}, {{2, a + 1e-12}}}, {{0, 1}}, 0);     // misses
        nasty({{{0, a}}, {{1, -a}}, {{2, a}}}, {{0, 1}}, -1e-12);        // crosses twice
        nasty({{{0, -a}}, {{1, a}}, {{2, -a}}, {{3, a}}}, {{0, 1}}, 0);  // triple
        nasty({{{0, 0}}, {{1, a}}, {{2, a}}, {{3, 0}}}, {{0, 1}}, 0);    // at both ends
        nasty({{{0, 0}}, {{1, 0}}, {{2, a}}, {{3, 1}}}, {{0, 1}}, 0);    // tangent at an end
        nasty({{{x, y}}, {{y, x}}, {{x + y, 0.1}}, {{x, y}}}, {{x, y}}, -(x * x + y * y));  // nearly an end
        nasty({{{x, 0.1}}, {{2 * x, 0.2}}, {{3 * x, 0.3}}}, {{0.1, -x}}, 0);  // nearly in the line
        nasty({{{1, 3}}, {{2, 3}}, {{a, 3}}}, {{0, 2}}, -6);                  // in the line
    }
    EXPECT_GE(cases, 200);
}

TEST(Crossings, of_splines_are_joined_at_knots) {
    // Two parabolas through (1, 0): the first three knots, of multiplicity 2, make it a spline.
    const auto basis = must(BSplineBasis::make(2, {0, 0, 0, 1, 1, 2, 2, 2}));
    const auto spline = [&](double last) {
        return must(Curve<Vec<2>>::make(
            {basis}, Net<1, Vec<2>>({5}, {{{0, 1}}, {{0.5, 1}}, {{1, 0}}, {{1.5, -1}}, {{2, last}}})));
    };
    const auto through = must(crossings(spline(-1), {{0, 1}}, 0, 1e-9));
    ASSERT_EQ(through.size(), 1u);
    EXPECT_EQ(through[0].kind, CrossingKind::crossing);
    EXPECT_EQ(through[0].at, (Interval{1, 1}));
    EXPECT_EQ(through[0].most, 1);

    // A cubic with simple knots: pieces are computed, crossings are certain all the same.
    Random random(13);
    int count = 0;
    for (int k = 0; k < 200; ++k) {
        const auto c = random_patch<1, Hom<3>>(random, 5, {k % 2 ? Ends::closed : Ends::unclamped, 4});
        const Vec<3> normal{{random.real(-1, 1), random.real(-1, 1), random.real(-1, 1)}};
        const auto hits = must(crossings(c, normal, 0.1, 1e-10));
        int sign_changes = 0, odd = 0;
        const Interval on = c.basis().domain();
        double last = 0;
        const int samples = 400;
        for (int i = 0; i <= samples; ++i) {
            const double v = dot(normal, c(on.lo + on.length() * i / samples)) + 0.1;
            sign_changes += last * v < 0;
            if (v != 0) last = v;
        }
        for (const auto& h : hits) {
            odd += h.kind == CrossingKind::crossing;
            EXPECT_NE(h.kind, CrossingKind::possible);
            EXPECT_NEAR(dot(normal, h.point) + 0.1, 0, 1e-8);
            ++count;
        }
        EXPECT_GE(odd, sign_changes);
        EXPECT_EQ((odd - sign_changes) % 2, 0);
    }
    EXPECT_GT(count, 100);
}

TEST(Crossings, overlap_where_the_curve_lies_in_the_line) {
    const auto basis = must(BSplineBasis::make(1, {0, 0, 1, 2, 3, 3}));
    const auto c =
        must(Curve<Vec<2>>::make({basis}, Net<1, Vec<2>>({4}, {{{0, 1}}, {{1, 0}}, {{2, 0}}, {{3, -1}}})));
    const auto hits = must(crossings(c, {{0, 1}}, 0, 1e-9));
    ASSERT_EQ(hits.size(), 1u);
    EXPECT_EQ(hits[0].kind, CrossingKind::overlap);
    EXPECT_EQ(hits[0].at, (Interval{1, 2}));
}

TEST(Crossings, refuse_what_is_no_plane) {
    const auto c = bezier<Vec<2>>({{{0, 0}}, {{1, 1}}});
    EXPECT_EQ(crossings(c, {{0, 0}}, 1, 1e-9).error().where, "normal");
    EXPECT_EQ(crossings(c, {{0, NAN}}, 1, 1e-9).error().kind, RefusalKind::nonfinite);
    EXPECT_EQ(crossings(c, {{0, 1}}, 1, -1).error().where, "accuracy");
}

}  // namespace
}  // namespace freiform::test
