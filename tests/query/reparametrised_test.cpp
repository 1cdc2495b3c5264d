#include "support/bezier.hpp"

#include <freiform/make/joint.hpp>
#include <freiform/query/continuity.hpp>

#include <gtest/gtest.h>

namespace freiform {
namespace {

using test::bezier;
using test::must;
using test::Random;
using test::random_bezier;

TEST(Reparametrised, makes_a_g_joint_c) {
    Random random(7);
    int rational = 0;
    for (int round = 0; round < 40; ++round) {
        const int k = round % 4 + 1;
        const auto a = random_bezier<Vec<3>>(random, 4, {-1, 1.5});
        std::vector<double> phi{random.real(0.5, 2)};
        for (int i = 1; i < k; ++i) phi.push_back(random.real(-1, 1));
        const auto b = must(next_g(a, phi, {{3, 3.5}, {Vec<3>{{1, 2, 3}}}}));
        ContinuityOptions o;
        o.orders = k;
        o.tolerance = 1e-9;
        const auto j = must(joint(a, b, o));
        ASSERT_EQ(j.g_order, k);
        ASSERT_EQ(j.phi[0], 3);
        const auto c = reparametrised(b, j.phi, 1.5);
        if (!c) {
            EXPECT_EQ(c.error().kind, RefusalKind::unsupported) << c.error().message;
            continue;
        }
        EXPECT_GE(must(joint(a, *c, o)).c_order, k) << k;
        const auto p = a.derivatives(1.5, k), q = c->derivatives(1.5, k);
        for (int i = 0; i <= k; ++i)
            EXPECT_LT(norm(p[std::size_t(i)] - q[std::size_t(i)]), 1e-7 * (1 + norm(p[std::size_t(i)]))) << i;
        // The same points: the ends, and points on the old curve in the same order.
        EXPECT_EQ(c->net().flat().back(), b.net().flat().back());
        if (k == 2) {
            const auto r = reparametrised_rationally(b, j.phi[1], j.phi[2], 1.5);
            if (!r) continue;
            ++rational;
            EXPECT_EQ(r->basis().degree(), b.basis().degree());
            EXPECT_GE(must(joint(a, *r, o)).c_order, 2);
        }
    }
    EXPECT_GT(rational, 5);
}

TEST(Reparametrised, keeps_the_points) {
    Random random(8);
    const auto b = random_bezier<Hom<2>>(random, 3, {1, 2});
    const double phi[] = {1, 2, -1, 0.5};
    const auto c = must(reparametrised(b, phi, 0));
    // phi is the polynomial 2 t - t^2 / 2 + t^3 / 12, if it rises to 1.
    const double end = c.basis().domain().hi;
    const auto value = [](double t) { return 2 * t - t * t / 2 + t * t * t / 12; };
    EXPECT_EQ(c.basis().degree(), 9);
    EXPECT_NEAR(value(end), 1, 1e-14);
    for (int i = 0; i <= 10; ++i) {
        const double t = end * i / 10;
        EXPECT_LT(norm(c(t) - b(std::min(2.0, 1 + value(t)))), 1e-13);
    }
    // A polynomial that turns back before the end gets one degree more.
    const double turning[] = {0, 1, -2};
    const auto d = must(reparametrised(b, turning, 0));
    EXPECT_EQ(d.basis().degree(), 9);
    const auto one = b.jet<2>(1), two = d.jet<2>(0);
    EXPECT_LT(norm(two(1) - one(1)) + norm(two(2) - (one(2) - 2.0 * one(1))), 1e-11);
    // Splines: linear and fractional changes.
    const auto s = test::random_patch_on<1, Vec<2>>(random, {test::random_basis(random, 3, {})});
    const auto lo = s.basis().domain().lo;
    const auto r = must(reparametrised_rationally(s, 2, 0.1, 5));
    for (const double t : {5.0, 5.1, 5.2}) {
        const double x = 2 * (t - 5) / (1 - 0.1 / 4 * (t - 5));
        if (x <= s.basis().domain().length()) EXPECT_LT(norm(r(t) - s(lo + x)), 1e-13);
    }
    EXPECT_EQ(reparametrised(s, phi, 0).error().kind, RefusalKind::unsupported);
    const double rate[] = {0, 4};
    const double x = s.basis().domain().length() / 2;
    EXPECT_LT(norm(must(reparametrised(s, rate, 1))(1 + x / 4) - s(lo + x)), 1e-12);
    EXPECT_EQ(reparametrised_rationally(b, 1, -4, 0).error().kind, RefusalKind::no_answer);
}

TEST(Reparametrised, always_rises) {
    // On a straight line the coefficients are those of phi.
    for (const double turn : {-2.0, -8.0, -50.0}) {
        const double phi[] = {0, 1, turn};
        const auto c = must(reparametrised(bezier<Vec<1>>({{{0}}, {{1}}}), phi, 0));
        const auto b = c.net().flat();
        for (std::size_t i = 0; i + 1 < b.size(); ++i) EXPECT_LT(b[i][0], b[i + 1][0]) << turn;
        const auto d = c.jet<2>(0);
        EXPECT_NEAR(d(1)[0], 1, 1e-12);
        EXPECT_NEAR(d(2)[0], turn, 1e-9);
    }
}

}  // namespace
}  // namespace freiform
