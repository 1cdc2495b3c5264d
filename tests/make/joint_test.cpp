#include "support/bezier.hpp"
#include "support/reference.hpp"

#include <freiform/make/joint.hpp>
#include <freiform/query/continuity.hpp>

#include <gtest/gtest.h>

namespace freiform {
namespace {

using test::bezier;
using test::must;
using test::Random;
using test::random_bezier;

const Vec<2> kP1{{1, 2}}, kP2{{2, 5}}, kP3{{4, 6}}, kP4{{7, 5}}, kFree[] = {{{9, 1}}, {{10, 0}}, {{12, 3}}};
const Curve<Vec<2>> kPrevious = bezier<Vec<2>>({kP1, kP2, kP3, kP4});

// R8: two cubics of equal parameter length, P1 .. P4 and P4 .. P7.
TEST(R08, c0_c1_and_c2_by_the_formulas_of_the_row) {
    const auto c0 = must(next_c(kPrevious, 0, {{1, 2}, {kFree[0], kFree[1], kFree[2]}})).net();
    EXPECT_EQ(c0.flat()[0], kP4);
    EXPECT_EQ(c0.flat()[1], kFree[0]);
    const auto c1 = must(next_c(kPrevious, 1, {{1, 2}, {kFree[1], kFree[2]}})).net();
    EXPECT_EQ(c1.flat()[0], kP4);
    EXPECT_EQ(c1.flat()[1], 2.0 * kP4 - kP3);
    EXPECT_EQ(c1.flat()[3], kFree[2]);
    const auto c2 = must(next_c(kPrevious, 2, {{1, 2}, {kFree[2]}})).net();
    EXPECT_EQ(c2.flat()[1], 2.0 * kP4 - kP3);
    EXPECT_EQ(c2.flat()[2], kP2 + 4.0 * (kP4 - kP3));
    EXPECT_EQ(c2.flat()[3], kFree[2]);
}

TEST(R08, g1_with_a_free_positive_k) {
    for (const double k : {0.25, 1.0, 3.0}) {
        const double phi[] = {k};
        const auto next = must(next_g(kPrevious, phi, {{1, 2}, {kFree[1], kFree[2]}}));
        const Vec<2> p5 = next.net().flat()[1];
        EXPECT_LT(norm((kP3 - kP4) - k * (kP4 - p5)), 1e-15 * 8);
        const auto j = must(joint(kPrevious, next));
        EXPECT_EQ(j.g_order, 1) << k;
        EXPECT_EQ(j.c_order, k == 1 ? 1 : 0) << k;
        EXPECT_NEAR(j.phi[1], k, 1e-14 * k);
    }
    const double back[] = {-1.0};
    const auto refused = next_g(kPrevious, back, {{1, 2}, {kFree[1], kFree[2]}});
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().where, "phi[0]");
}

TEST(R08, any_order_of_two_bezier_pieces_of_any_degree) {
    // C^k of pieces of degree n on equal intervals: the differences at the joint agree, Delta^j b = Delta^j a
    // (degree n both). Of different degrees m, n: m!/(m-j)! Delta^j a = n!/(n-j)! Delta^j b.
    Random random(8);
    for (int m = 1; m <= 9; ++m)
        for (int k = 0; k <= 4; ++k) {
            const auto a = random_bezier<Vec<3>>(random, m, {0, 1});
            const int n = k + random.integer(0, 3);
            std::vector<Vec<3>> free;
            for (int i = k; i < n; ++i) free.push_back(test::random_coefficient<Vec<3>>(random));
            const auto b = must(next_c(a, k, {{1, 2}, free}));
            ASSERT_EQ(b.basis().degree(), n);
            std::vector<Vec<3>> da(a.net().flat().begin(), a.net().flat().end()),
                db(b.net().flat().begin(), b.net().flat().end());
            double fa = 1, fb = 1;
            for (int j = 0; j <= k; ++j) {
                const Vec<3> left = j > m ? Vec<3>{} : fa * da.back(), right = fb * db.front();
                EXPECT_LT(norm(left - right), 1e-13 * std::max(1.0, fb) * 64) << m << " " << n << " " << j;
                fa *= m - j, fb *= n - j;
                for (auto* d : {&da, &db}) {
                    for (std::size_t i = 0; i + 1 < d->size(); ++i) (*d)[i] = (*d)[i + 1] - (*d)[i];
                    if (d->size() > 1) d->pop_back();
                }
            }
        }
}

TEST(R04, joining_with_k_times_the_tangent_is_g1) {
    const Vec<3> p7{{5, 1, 2}}, r7{{1, 0, -3}};
    Random random(4);
    const auto previous = random_bezier<Vec<3>>(random, 3, {0, 1});
    const Vec<3> p4 = previous.net().flat()[3], r4 = 3.0 * (p4 - previous.net().flat()[2]);
    for (const double k : {0.5, 1.0, 2.5}) {
        const auto next = must(next_hermite(previous, k, p7, r7));
        const auto start = next.jet<1>(0), end = next.jet<1>(1);
        EXPECT_EQ(start.value(), p4);
        EXPECT_LT(norm(start(1) - k * r4), 1e-13);
        EXPECT_LT(norm(end.value() - p7) + norm(end(1) - r7), 1e-13);
        const auto j = must(joint(previous, next));
        EXPECT_EQ(j.g_order, 1);
        EXPECT_EQ(j.c_order, k == 1 ? 1 : 0);
        EXPECT_NEAR(j.phi[1], 1 / k, 1e-13);
    }
    EXPECT_EQ(next_hermite(previous, 0, p7, r7).error().where, "k");
}

TEST(NextG, refuses_to_continue_what_stands_still) {
    const double phi[] = {2};
    const auto refused = [&](const auto& curve) {
        using P = typename std::remove_cvref_t<decltype(curve)>::Coefficients;
        const auto next = next_g(curve, phi, NextPiece<P>{{0, 1}, {}});
        EXPECT_FALSE(next);
        if (!next) EXPECT_EQ(next.error().where, "previous");
        if (!next) EXPECT_EQ(next.error().kind, RefusalKind::no_answer);
        EXPECT_TRUE(next_c(curve, 1, NextPiece<P>{{0, 1}, {}}));  // C1 is what it is
        EXPECT_TRUE(next_g(curve, {}, NextPiece<P>{{0, 1}, {curve.net().flat()[0]}}));
    };
    refused(bezier<Vec<2>>({{{0, 0}}, {{1, 2}}, {{3, 1}}, {{3, 1}}}));
    // The same point twice with different weights.
    refused(bezier<Hom<2>>(
        {weighted(Vec<2>{{0, 0}}, 1), weighted(Vec<2>{{3, 1}}, 1), weighted(Vec<2>{{3, 1}}, 0.75)}));
}

// The determined coefficients against the same formula in exact rationals, coefficient by coefficient.
TEST(NextC, determined_coefficients_are_rounded_once) {
    using test::Rational;
    Random random(1);
    for (int round = 0; round < 40; ++round) {
        const int m = random.integer(1, 9), k = random.integer(0, 5);
        const Interval on{random.real(-2, 2), random.real(3, 5)};
        const auto a = random_bezier<Vec<1>>(random, m, {random.real(-3, 0), random.real(1, 2)});
        const auto b = must(next_c(a, k, {on, {Vec<1>{{1}}}}));
        const int n = k + 1;
        std::vector<Rational> difference;
        Rational power(1), factor(1);
        for (int j = 0; j <= k; ++j) {
            const Rational d = test::homogeneous<Rational>(a, a.basis().domain().hi, {j})[0];
            difference.push_back(d * power / factor);
            power *= Rational(on.hi) - Rational(on.lo);
            factor *= n - j;
        }
        for (int i = 0; i <= k; ++i) {
            Rational exact(0);
            for (int j = 0; j <= i; ++j) exact += Rational(binomial(i, j)) * difference[std::size_t(j)];
            const double got = b.net().flat()[std::size_t(i)][0];
            EXPECT_LE(test::gap(got, exact), std::abs(got) * 0x1.0001p-53)
                << "order " << k << " degree " << m;
        }
    }
}

template <class P>
void expect_found(std::uint64_t seed, bool weights) {
    Random random(seed);
    for (int round = 0; round < 30; ++round) {
        const int m = random.integer(2, 9), k = random.integer(0, 4), more = random.integer(1, 3);
        const auto a = random_bezier<P>(random, m, {random.real(-3, 0), random.real(1, 2)});
        NextPiece<P> next{{0, random.real(0.01, 0.1)}, {}};
        for (int i = 0; i < more; ++i) next.free.push_back(test::random_coefficient<P>(random, 1, 0, 0.5));
        if (weights)
            for (int i = 0; i <= k; ++i) next.weights.push_back(random.real(0.5, 2));
        const auto b = must(next_c(a, k, next));
        ContinuityOptions options;
        options.orders = 5;
        const auto j = must(joint(a, b, options));
        EXPECT_EQ(j.c_order, k) << "C, degree " << m;
        EXPECT_EQ(j.g_order, Space<P>::kDim == 1 ? std::max(k, 1) : k) << "degree " << m;

        std::vector<double> phi;
        for (int i = 0; i < k; ++i) phi.push_back(i == 0 ? random.real(0.3, 3) : random.real(-2, 2));
        const auto g = next_g<P>(a, phi, next);
        if (!g) {  // a weight came out negative; with given weights that cannot be
            EXPECT_FALSE(weights);
            EXPECT_EQ(g.error().kind, RefusalKind::no_answer);
            continue;
        }
        const auto found = must(joint(a, *g, options));
        if (Space<P>::kDim > 1) EXPECT_EQ(found.g_order, k) << "degree " << m;
        if (k > 0) EXPECT_EQ(found.c_order, 0);
        for (int i = 0; i < k; ++i)
            EXPECT_NEAR(found.phi[std::size_t(i) + 1], phi[std::size_t(i)],
                        found.phi_bound[std::size_t(i) + 1])
                << i;
    }
}

TEST(NextC, is_found_by_the_analysis_with_this_order_and_not_more) {
    expect_found<Vec<2>>(11, false);
    expect_found<Vec<3>>(12, false);
    expect_found<Vec<4>>(13, false);
    expect_found<Hom<2>>(14, false);
    expect_found<Hom<3>>(15, false);
}

TEST(NextC, joins_the_points_for_any_given_weights) {
    expect_found<Hom<2>>(16, true);
    expect_found<Hom<3>>(17, true);
}

TEST(NextC, refuses_by_name) {
    const NextPiece<Vec<2>> two{{1, 2}, {kFree[0], kFree[1]}};
    EXPECT_EQ(next_c(kPrevious, -1, two).error().where, "order");
    EXPECT_EQ(next_c(kPrevious, 24, two).error().where, "free");
    EXPECT_EQ(next_c(kPrevious, 1, {{2, 2}, {}}).error().where.substr(0, 2), "on");
    EXPECT_EQ(next_c(kPrevious, 1, {{1, 2}, {kFree[0]}, {1, 1}}).error().where, "weights");
    const auto closed = must(Curve<Vec<2>>::make({must(BSplineBasis::periodic(2, {0, 1, 2, 3}))},
                                                 Net<1, Vec<2>>({3}, {kP1, kP2, kP3})));
    EXPECT_EQ(next_c(closed, 1, two).error().where, "previous");
    // A weight that falls towards the end goes on falling.
    const auto falling = bezier<Hom<2>>({weighted(kP1, 4), weighted(kP2, 3), weighted(kP3, 0.5)});
    const auto r = next_c(falling, 1, {{1, 2}, {weighted(kP4, 1)}});
    ASSERT_FALSE(r);
    EXPECT_EQ(r.error().kind, RefusalKind::no_answer);
    EXPECT_EQ(r.error().where, "weights[1]");
    EXPECT_TRUE(next_c(falling, 1, {{1, 2}, {weighted(kP4, 1)}, {1, 1}}));
    EXPECT_EQ(next_c(falling, 1, {{1, 2}, {weighted(kP4, 1)}, {1, 0}}).error().where, "weights[1]");
    EXPECT_EQ(next_c(falling, 1, {{1, 2}, {weighted(kP4, 1)}, {1}}).error().where, "weights");
}

TEST(NextG, shape_parameters_and_beta_constraints_are_inverse_to_each_other) {
    const double b1 = 2, nu = 0.75, beta[] = {b1, nu};
    const auto phi = inverted(beta);
    EXPECT_DOUBLE_EQ(phi[0], 1 / b1);
    EXPECT_DOUBLE_EQ(phi[1], -nu / (b1 * b1 * b1));
    const auto next = must(next_g(kPrevious, phi, {{1, 2}, {kFree[1], kFree[2]}}));
    const auto p = kPrevious.jet<2>(1), q = next.jet<2>(1);
    EXPECT_LT(norm(q(1) - b1 * p(1)), 1e-12);
    EXPECT_LT(norm(q(2) - (b1 * b1 * p(2) + nu * p(1))), 1e-12);
    EXPECT_EQ(must(joint(kPrevious, next)).g_order, 2);
}

}  // namespace
}  // namespace freiform
