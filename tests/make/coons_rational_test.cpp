#include "support/bezier.hpp"
#include "support/curves.hpp"

#include <freiform/make/coons.hpp>

#include <gtest/gtest.h>

namespace freiform {
namespace {

using test::bezier;
using test::must;
using test::Random;

constexpr double kBetween[] = {0, 0.1875, 0.5, 0.75, 0.9375, 1};

Curve<Vec<3>> with_ends(Curve<Vec<3>> c, const Vec<3>& from, const Vec<3>& to) {
    auto net = c.net();
    net.flat().front() = from, net.flat().back() = to;
    return must(Curve<Vec<3>>::make(c.bases(), net));
}
Curve<Hom<3>> rational_between(Random& random, int degree, std::vector<double> inner, const Vec<3>& from,
                               const Vec<3>& to) {
    const auto c = with_ends(test::random_curve<Vec<3>>(random, degree, std::move(inner)), from, to);
    Net<1, Hom<3>> net(c.net().extent());
    for (std::size_t i = 0; i < net.flat().size(); ++i)
        net.flat()[i] = weighted(c.net().flat()[i], random.real(0.5, 2));
    return must(Curve<Hom<3>>::make(c.bases(), net));
}

// R25, of rational curves: the literal sum again.
TEST(R25, a_coons_patch_of_rational_curves_is_the_same_sum) {
    Random random(21);
    const Vec<3> corner[4] = {{{0, 0, 0}}, {{1.1, 0, 0.3}}, {{0.2, 0.9, 0.7}}, {{1, 1, 1.3}}};
    const auto u0 = rational_between(random, 3, {0.5}, corner[0], corner[1]);
    const auto u1 = rational_between(random, 2, {0.25, 0.75}, corner[2], corner[3]);
    const auto v0 = rational_between(random, 4, {}, corner[0], corner[2]);
    const auto v1 =
        to_rational(with_ends(test::random_curve<Vec<3>>(random, 1, {0.25}), corner[1], corner[3]));
    const auto patch = must(coons(u0, u1, v0, v1, 0));
    EXPECT_LT(patch.bound, 1e-11);
    EXPECT_LT(patch.corner_gap, 1e-12);
    double worst = 0;
    for (double u : kBetween)
        for (double v : kBetween) {
            const Vec<3> sum = (1 - v) * u0(u) + v * u1(u) + (1 - u) * v0(v) + u * v1(v) -
                               (1 - u) * (1 - v) * corner[0] - u * (1 - v) * corner[1] -
                               (1 - u) * v * corner[2] - u * v * corner[3];
            worst = std::max(worst, norm(patch.surface(u, v) - sum));
        }
    EXPECT_LE(worst, patch.bound + 2e-14);  // the judge's own rounding
    EXPECT_EQ(patch.surface.basis(0).degree(), 2 * 3 + 1);
}

// Arcs that share their weights keep the degree low: a quarter of a cylinder with_ends two of its arcs.
TEST(Coons, of_parallel_arcs_has_one_denominator) {
    const double s = std::sqrt(0.5);
    const auto arc = [&](double z, double factor) {
        return test::bezier<Hom<3>>({weighted(Vec<3>{{1, 0, z}}, factor),
                                     weighted(Vec<3>{{1, 1, z}}, factor * s),
                                     weighted(Vec<3>{{0, 1, z}}, factor)});
    };
    const auto line = [](const Vec<3>& p, const Vec<3>& q) {
        return test::bezier<Hom<3>>({weighted(p, 1), weighted(q, 1)});
    };
    const auto patch =
        must(coons(arc(0, 1), arc(2, 3), line({{1, 0, 0}}, {{1, 0, 2}}), line({{0, 1, 0}}, {{0, 1, 2}}), 0));
    EXPECT_EQ(patch.surface.basis(0).degree(), 3);
    EXPECT_EQ(patch.surface.basis(1).degree(), 1);
    for (double u : kBetween)
        for (double v : kBetween) {
            const Vec<3> p = patch.surface(u, v);
            EXPECT_NEAR(std::hypot(p[0], p[1]), 1, 1e-14);
            EXPECT_NEAR(p[2], 2 * v, 1e-14);
        }
}

TEST(Coons, of_rational_curves_refuses_corners_that_miss_and_degrees_that_none_has) {
    Random random(22);
    const Vec<3> corner[4] = {{{0, 0, 0}}, {{1, 0, 0}}, {{0, 1, 0}}, {{1, 1, 0}}};
    const auto make = [&](int degree, int from, int to) {
        return rational_between(random, degree, {}, corner[from], corner[to]);
    };
    const auto u0 = make(2, 0, 1), u1 = make(2, 2, 3), v0 = make(2, 0, 2);
    const auto off = rational_between(random, 2, {}, corner[1], {{1, 1, 0.25}});
    const auto refused = coons(u0, u1, v0, off, 0.1);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().where, "upper u, upper v");
    EXPECT_TRUE(coons(u0, u1, v0, off, 0.3));
    const auto high0 = make(13, 0, 1), high1 = make(13, 2, 3), v1 = make(2, 1, 3);
    EXPECT_EQ(coons(high0, high1, v0, v1, 0).error().kind, RefusalKind::unsupported);
}

// --- bicubic patches of rational curves

using RationalEdge = CoonsEdge<Hom<3>>;

// A vector that varies along an edge, over the given weights.
Curve<Hom<3>> over(const Curve<Hom<3>>& weights, const std::vector<Vec<3>>& values) {
    Net<1, Hom<3>> net(weights.net().extent());
    for (std::size_t i = 0; i < values.size(); ++i)
        net.flat()[i] = weighted(values[i], weights.net().flat()[i].weight());
    return must(Curve<Hom<3>>::make(weights.bases(), net));
}

// Rational along u over one denominator and cubic along v: its own bicubic patch.
TEST(Coons, bicubic_patches_of_rational_curves_reproduce_what_is_rational_in_one_direction) {
    Random random(23);
    const double w[] = {1, 0.6, 1.7, 0.9};
    const std::array<BSplineBasis, 2> bases{must(BSplineBasis::bezier(3, {1, 3})),
                                            must(BSplineBasis::bezier(3, {0, 0.5}))};
    std::vector<Vec<3>> p;
    for (int i = 0; i < 16; ++i) p.push_back(test::random_coefficient<Vec<3>>(random));
    Net<2, Hom<3>> net({4, 4});
    for (std::size_t i = 0; i < 16; ++i) net.flat()[i] = weighted(p[i], w[i / 4]);
    const auto s = must(Surface<Hom<3>>::make(bases, net));
    // Across v: differences of rows of control points, with the weights of the row. Across u: the quotient
    // rule at an end, 3 w_1 / w_0 (P_1 - P_0), a cubic along v.
    const double dv = 3 / 0.5, du = 3.0 / 2;
    const auto row = [&](int j) { return boundary(s, 1, j); };
    std::vector<Vec<3>> low, high, left, right;
    for (std::size_t i = 0; i < 4; ++i) {
        low.push_back(dv * (p[4 * i + 1] - p[4 * i])), high.push_back(dv * (p[4 * i + 3] - p[4 * i + 2]));
        left.push_back(du * w[1] / w[0] * (p[4 + i] - p[i]));
        right.push_back(du * w[2] / w[3] * (p[12 + i] - p[8 + i]));
    }
    const auto u0 = row(0), u1 = row(1), v0 = boundary(s, 0, 0), v1 = boundary(s, 0, 1);
    const auto patch = must(coons_bicubic(RationalEdge{u0, over(u0, low)}, RationalEdge{u1, over(u1, high)},
                                          RationalEdge{v0, over(v0, left)}, RationalEdge{v1, over(v1, right)},
                                          CoonsTolerance{1e-13, 1e-12, 1e-11}));
    EXPECT_EQ(patch.surface.basis(0).degree(), 6);
    EXPECT_EQ(patch.surface.basis(1).degree(), 3);
    EXPECT_LT(patch.bound, 1e-10);
    for (double u : {1.0, 1.3, 2.75, 3.0})
        for (double v : {0.0, 0.1, 0.3, 0.5}) EXPECT_LE(norm(patch.surface(u, v) - s(u, v)), 1e-12);
}

// The sum itself, term by term, of conics with different weights on domains of other lengths than 1.
TEST(Coons, bicubic_patches_of_rational_curves_are_the_hermite_sum) {
    const Vec<3> c[4] = {{{0, 0, 0}}, {{1, 0, 0.3}}, {{0.2, 0.9, 0.7}}, {{1, 1, 1.3}}};
    const Interval in_u{0, 2}, in_v{1, 1.5};
    const auto conic = [](const Vec<3>& p, const Vec<3>& q, double bulge, double weight, Interval on) {
        return bezier<Hom<3>>(
            {weighted(p, 1), weighted(0.5 * (p + q) + Vec<3>{{0, 0, bulge}}, weight), weighted(q, 1)}, on);
    };
    const auto u0 = conic(c[0], c[1], 1, 0.5, in_u), u1 = conic(c[2], c[3], -1, 2, in_u);
    const auto v0 = conic(c[0], c[2], 0.5, 0.7, in_v), v1 = conic(c[1], c[3], 0.25, 1.5, in_v);
    // End tangents of the crossing edges at both ends, a bulge with_ends: the derivative of a conic at its
    // ends is 2 w (P_1 - P_0) over the length of the domain.
    const auto tangent = [](const Curve<Hom<3>>& e, int side) {
        const auto n = e.net().flat();
        const double f = 2 * n[1].weight() / e.domain()[0].length();
        return side == 0 ? f * (project(n[1]) - project(n[0])) : f * (project(n[2]) - project(n[1]));
    };
    const auto across = [&](const Curve<Hom<3>>& e, const Curve<Hom<3>>& first, const Curve<Hom<3>>& second,
                            int side) {
        const Vec<3> a = tangent(first, side), b = tangent(second, side);
        return over(e, {a, 0.5 * (a + b), b});
    };
    const RationalEdge edge[4] = {{u0, across(u0, v0, v1, 0)},
                                  {u1, across(u1, v0, v1, 1)},
                                  {v0, across(v0, u0, u1, 0)},
                                  {v1, across(v1, u0, u1, 1)}};
    const auto patch =
        must(coons_bicubic(edge[0], edge[1], edge[2], edge[3], CoonsTolerance{1e-12, 1e-12, 9}));
    EXPECT_LT(patch.tangent_gap, 1e-12);
    EXPECT_GT(patch.twist_gap, 0.1);
    EXPECT_LT(patch.bound, 1e-9);
    const auto hermite = [](double x) {
        return std::array{1 - 3 * x * x + 2 * x * x * x, 3 * x * x - 2 * x * x * x, x - 2 * x * x + x * x * x,
                          x * x * x - x * x};
    };
    const double Lu = in_u.length(), Lv = in_v.length();
    // Twists are means of both derivatives of cross derivatives, of conics again.
    const auto twist = [&](int i, int j) {
        return 0.5 * (tangent(edge[j].across, i) + tangent(edge[2 + i].across, j));
    };
    double worst = 0;
    for (double x : kBetween)
        for (double y : kBetween) {
            const double u = in_u.lo + x * Lu, v = in_v.lo + y * Lv;
            const auto g = hermite(x), h = hermite(y);
            Vec<3> sum{};
            for (std::size_t k = 0; k < 2; ++k) {
                sum = sum + h[k] * edge[k].curve(u) + h[k + 2] * Lv * edge[k].across(u);
                sum = sum + g[k] * edge[2 + k].curve(v) + g[k + 2] * Lu * edge[2 + k].across(v);
            }
            for (int i = 0; i < 2; ++i)
                for (int j = 0; j < 2; ++j) {
                    const std::size_t I = std::size_t(i), J = std::size_t(j);
                    sum = sum - g[I] * h[J] * c[i + 2 * j] -
                          g[I + 2] * h[J] * Lu * tangent(edge[j].curve, i) -
                          g[I] * h[J + 2] * Lv * tangent(edge[2 + i].curve, j) -
                          g[I + 2] * h[J + 2] * Lu * Lv * twist(i, j);
                }
            worst = std::max(worst, norm(patch.surface(u, v) - sum));
        }
    EXPECT_LE(worst, patch.bound + 2e-13);  // the judge's own rounding
    // It has the edges; the derivatives across them where twists agree.
    for (double x : kBetween) {
        const double u = in_u.lo + x * Lu, v = in_v.lo + x * Lv;
        EXPECT_LE(norm(patch.surface(u, in_v.hi) - u1(u)), 1e-12);
        EXPECT_LE(norm(patch.surface(in_u.lo, v) - v0(v)), 1e-12);
    }
}

TEST(Coons, bicubic_patches_of_rational_curves_refuse_what_contradicts_itself) {
    const auto line = [](const Vec<3>& a, const Vec<3>& b, double w) {
        return bezier<Hom<3>>({weighted(a, 1), weighted(b, w)});
    };
    const Vec<3> x{{1, 0, 0}}, y{{0, 1, 0}}, up{{0, 0, 1}};
    const RationalEdge u1{line(y, x + y, 1), line(y, y, 1)}, v0{line({}, y, 1), line(x, x, 1)},
        v1{line(x, x + y, 1), line(x, x, 1)};
    EXPECT_TRUE(coons_bicubic(RationalEdge{line({}, x, 1), line(y, y, 1)}, u1, v0, v1, CoonsTolerance{}));
    const auto off = coons_bicubic(RationalEdge{line(up, x, 1), line(y, y, 1)}, u1, v0, v1, CoonsTolerance{});
    EXPECT_EQ(off.error().where, "lower u, lower v");
    const std::string& said = off.error().message;
    ASSERT_TRUE(said.starts_with("positions differ by ")) << said;
    EXPECT_NEAR(std::stod(said.substr(20)), 1, 1e-12);
    const auto tangent = coons_bicubic(RationalEdge{line({}, x, 1), line(y, y + 0.5 * up, 2)}, u1, v0, v1,
                                       CoonsTolerance{1e-12, 0.4, 9});
    EXPECT_EQ(tangent.error().where, "upper u, lower v");
    EXPECT_NE(tangent.error().message.find("tangents differ by 0.5"), std::string::npos)
        << tangent.error().message;
    // The weights of an edge make its tangent longer than the neighbour says.
    EXPECT_FALSE(
        coons_bicubic(RationalEdge{line({}, x, 3), line(y, y, 3)}, u1, v0, v1, CoonsTolerance{0, 1, 9}));
    EXPECT_EQ(coons_bicubic(u1, u1, v0, v1, CoonsTolerance{0, std::nan(""), 0}).error().where, "tolerance");
}

}  // namespace
}  // namespace freiform
