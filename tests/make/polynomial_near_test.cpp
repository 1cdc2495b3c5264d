#include "support/bezier.hpp"
#include "support/reference.hpp"

#include <freiform/make/polynomial_near.hpp>

#include <gtest/gtest.h>

namespace freiform {
namespace {

using test::bezier;
using test::must;
using test::Random;
using test::Rational;

// The exact distance of corresponding points, rounded once.
template <int D>
double gap(const Curve<Hom<D>>& c, const Curve<Vec<D>>& q, double t) {
    const auto a = test::value_of<Rational>(c, t), b = test::value_of<Rational>(q, t);
    Rational sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
    return std::sqrt(sum.convert_to<double>());
}

// Measured over bound, at three places of each span.
template <int D>
double quotient(const Curve<Hom<D>>& c, const NearPolynomial<D>& near) {
    const auto breaks = near.curve.basis().breaks();
    const std::size_t step = std::max<std::size_t>(1, breaks.size() / 12);
    double worst = 0;
    for (std::size_t i = 1; i < breaks.size(); i += breaks.size() < 40 ? 1 : step)
        for (const double s : {0.21, 0.5, 0.79}) {
            const double t = breaks[i - 1] + s * (breaks[i] - breaks[i - 1]), off = gap(c, near.curve, t);
            EXPECT_LE(off, near.bound) << t;
            worst = std::max(worst, off / near.bound);
        }
    return worst;
}

TEST(PolynomialNear, is_as_far_off_as_its_bound_says_and_not_much_less) {
    Random random(31);
    for (int k = 0; k < 6; ++k) {
        const test::Ends ends[] = {test::Ends::clamped, test::Ends::unclamped, test::Ends::closed};
        const test::BasisOptions options{ends[k % 3]};
        const auto flat = test::random_patch<1, Hom<2>>(random, 2 + k % 2, options);
        const auto space = test::random_patch<1, Hom<3>>(random, 4 - k % 2, options);
        for (const double tolerance : {0.3, 1e-3, 1e-6}) {
            const auto a = must(polynomial_near(flat, tolerance));
            const auto b = must(polynomial_near(space, tolerance));
            EXPECT_LE(a.bound, tolerance);
            EXPECT_LE(b.bound, tolerance);
            EXPECT_GE(quotient(flat, a), 0.05);
            EXPECT_GE(quotient(space, b), 0.05);
            EXPECT_EQ(a.curve.basis().is_closed(), k % 3 == 2);
            EXPECT_EQ(a.curve.domain(), flat.domain());
        }
    }
}

const auto kQuarter = bezier<Hom<2>>(
    {weighted(Vec<2>{{1, 0}}, 1), weighted(Vec<2>{{1, 1}}, std::sqrt(0.5)), weighted(Vec<2>{{0, 1}}, 1)});

TEST(PolynomialNear, spans_grow_like_the_fourth_root) {
    std::size_t spans[4];
    for (int k = 0; k < 4; ++k)
        spans[k] = must(polynomial_near(kQuarter, std::pow(16, -k) * 1e-4)).curve.basis().breaks().size() - 1;
    for (int k = 1; k < 4; ++k) EXPECT_EQ(spans[k], 2 * spans[k - 1]) << k;
}

TEST(PolynomialNear, has_a_derivative_where_the_curve_has_one_and_kinks_where_it_has_none) {
    Random random(32);
    std::vector<Hom<3>> net;
    for (int i = 0; i < 7; ++i) net.push_back(test::random_coefficient<Hom<3>>(random));
    // Of degree 2: smooth at 0.25 and 0.75, with a kink at 0.5.
    const auto curve = must(Curve<Hom<3>>::make(
        {must(BSplineBasis::make(2, {0, 0, 0, 0.25, 0.5, 0.5, 0.75, 1, 1, 1}))}, Net<1, Hom<3>>({7}, net)));
    const auto near = must(polynomial_near(curve, 1e-4)).curve;
    EXPECT_EQ(near.basis().multiplicity(0.25), 2);
    EXPECT_EQ(near.basis().multiplicity(0.5), 3);
    for (const double t : near.basis().breaks()) {
        if (t == 0 || t == 1) continue;
        const double h = 1e-9, f = 1 / h;
        const Vec<3> before = f * (near(t) - near(t - h)), after = f * (near(t + h) - near(t)),
                     given = f * (curve(t + h) - curve(t));
        if (t == 0.5)
            EXPECT_GT(norm(after - before), 0.5);
        else
            EXPECT_LE(norm(after - before), 1e-4) << t;
        EXPECT_LE(norm(after - given), 1e-4) << t;
        EXPECT_LE(norm(near(t) - curve(t)), 1e-14) << t;
    }
}

TEST(PolynomialNear, closed_curves_close_with_their_seam) {
    std::vector<Hom<2>> net;
    for (int i = 0; i < 8; ++i) {
        const double x[] = {1, 1, 0, -1, -1, -1, 0, 1}, y[] = {0, 1, 1, 1, 0, -1, -1, -1};
        net.push_back(weighted(Vec<2>{{x[i], y[i]}}, i % 2 ? std::sqrt(0.5) : 1));
    }
    // The circle of nine points, whose seam has a double knot; the first coefficient is that of its corner.
    const auto circle = must(Curve<Hom<2>>::make(
        {must(BSplineBasis::periodic(2, {0, 1, 1, 2, 2, 3, 3, 4, 4}))}, Net<1, Hom<2>>({8}, net)));
    const auto near = must(polynomial_near(circle, 1e-5));
    EXPECT_TRUE(near.curve.basis().is_closed());
    for (int i = 0; i <= 40; ++i) {
        const double t = i / 10.0;
        EXPECT_LE(norm(near.curve(t) - circle(t)), near.bound + 1e-15) << t;
    }
    const auto one_piece = must(
        Curve<Hom<2>>::make({must(BSplineBasis::periodic(2, {0, 1, 1}))},
                            Net<1, Hom<2>>({2}, {weighted(Vec<2>{{0, 0}}, 1), weighted(Vec<2>{{1, 0}}, 2)})));
    EXPECT_GE(quotient(one_piece, must(polynomial_near(one_piece, 0.5))), 0.01);
}

TEST(PolynomialNear, equal_weights_are_left_out) {
    Random random(33);
    const auto given = test::random_patch<1, Vec<3>>(random, 4, {test::Ends::closed});
    const auto same = must(polynomial_near(to_rational(given), 1e-300));
    EXPECT_EQ(same.curve, given);
    EXPECT_EQ(same.bound, 0);
    std::vector<Hom<2>> net;
    for (const double x : {0.1, 0.7, 1.3}) net.push_back(weighted(Vec<2>{{x, -x}}, 3));
    const auto thrice = bezier<Hom<2>>(net);
    const auto near = must(polynomial_near(thrice, 1e-12));
    EXPECT_EQ(near.curve.basis(), thrice.basis());
    for (const double t : {0.0, 0.3, 1.0}) EXPECT_LE(gap(thrice, near.curve, t), near.bound);
    EXPECT_EQ(polynomial_near(thrice, 1e-20).error().kind, RefusalKind::ill_conditioned);
}

TEST(PolynomialNear, scales_with_powers_of_two) {
    Random random(34);
    const auto curve = test::random_patch<1, Hom<2>>(random, 3, {});
    const auto near = must(polynomial_near(curve, 1e-3));
    for (const int e : {-600, 12, 600}) {
        auto net = curve.net();
        for (Hom<2>& h : net.flat())
            for (int i = 0; i < 2; ++i) h[i] = std::scalbn(h[i], e);
        const auto big =
            must(polynomial_near(must(Curve<Hom<2>>::make(curve.bases(), net)), std::scalbn(1e-3, e)));
        ASSERT_EQ(big.curve.basis(), near.curve.basis()) << e;
        EXPECT_DOUBLE_EQ(std::scalbn(big.bound, -e), near.bound);
        for (std::size_t i = 0; i < near.curve.net().flat().size(); ++i)
            for (int c = 0; c < 2; ++c)
                EXPECT_EQ(big.curve.net().flat()[i][c], std::scalbn(near.curve.net().flat()[i][c], e));
    }
}

TEST(PolynomialNear, refuses_what_it_cannot_reach) {
    EXPECT_EQ(polynomial_near(kQuarter, 0).error().kind, RefusalKind::invalid);
    EXPECT_EQ(polynomial_near(kQuarter, std::nan("")).error().where, "tolerance");
    const auto fine = polynomial_near(kQuarter, 1e-18);
    ASSERT_FALSE(fine);
    EXPECT_TRUE(fine.error().kind == RefusalKind::ill_conditioned || fine.error().kind == RefusalKind::limit);
    const auto steps = must(
        Curve<Hom<2>>::make({must(BSplineBasis::make(1, {0, 0, 1, 1, 2, 2}))},
                            Net<1, Hom<2>>({4}, {weighted(Vec<2>{{0, 0}}, 1), weighted(Vec<2>{{1, 0}}, 2),
                                                 weighted(Vec<2>{{0, 1}}, 1), weighted(Vec<2>{{1, 1}}, 2)})));
    const auto jump = polynomial_near(steps, 1);
    EXPECT_EQ(jump.error().kind, RefusalKind::unsupported);
    EXPECT_EQ(jump.error().message, "jumps at 1");
}

}  // namespace
}  // namespace freiform
