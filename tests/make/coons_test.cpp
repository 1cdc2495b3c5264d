#include "support/bezier.hpp"
#include "support/curves.hpp"
#include "support/reference.hpp"

#include <freiform/make/boolean_sum.hpp>
#include <freiform/make/coons.hpp>

#include <gtest/gtest.h>

namespace freiform {
namespace {

using test::bezier;
using test::must;
using test::Random;
using test::Rational;

constexpr double kAt[] = {0, 0.1875, 0.5, 0.75, 0.9375, 1};

Curve<Vec<3>> random_curve(Random& random, int degree, std::vector<double> inner = {}) {
    return test::random_curve<Vec<3>>(random, degree, std::move(inner));
}
Curve<Vec<3>> between(Curve<Vec<3>> c, const Vec<3>& from, const Vec<3>& to) {
    auto net = c.net();
    net.flat().front() = from, net.flat().back() = to;
    return must(Curve<Vec<3>>::make(c.bases(), net));
}
std::array<Rational, 3> exact(const Curve<Vec<3>>& c, double t) {
    const auto r = test::value_of<Rational>(c, t);
    return {r[0], r[1], r[2]};
}
double off(const Surface<Vec<3>>& s, double u, double v, const std::array<Rational, 3>& p) {
    const auto q = test::value_of<Rational>(s, {u, v});
    double sum = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const double d = Rational(q[i] - p[i]).convert_to<double>();
        sum += d * d;
    }
    return std::sqrt(sum);
}

TEST(R25, a_coons_patch_is_the_sum_of_two_ruled_surfaces_less_the_bilinear_one) {
    Random random(1);
    const Vec<3> corner[4] = {{{0, 0, 0}}, {{1.1, 0, 0.3}}, {{0.2, 0.9, 0.7}}, {{1, 1, 1.3}}};
    const auto u0 = between(random_curve(random, 3, {0.5}), corner[0], corner[1]);
    const auto u1 = between(random_curve(random, 2, {0.25, 0.75}), corner[2], corner[3]);
    const auto v0 = between(random_curve(random, 4), corner[0], corner[2]);
    const auto v1 = between(random_curve(random, 1, {0.25}), corner[1], corner[3]);
    const auto patch = must(coons(u0, u1, v0, v1, 0));
    EXPECT_EQ(patch.corner_gap, 0);
    EXPECT_LT(patch.bound, 1e-13);
    double worst = 0;
    for (double u : kAt)
        for (double v : kAt) {
            const Rational U(u), V(v);
            const auto a = exact(u0, u), b = exact(u1, u), c = exact(v0, v), d = exact(v1, v);
            std::array<Rational, 3> p;
            for (std::size_t i = 0; i < 3; ++i) {
                const Rational P[4] = {corner[0][int(i)], corner[1][int(i)], corner[2][int(i)],
                                       corner[3][int(i)]};
                p[i] = (1 - V) * a[i] + V * b[i] + (1 - U) * c[i] + U * d[i] - (1 - U) * (1 - V) * P[0] -
                       U * (1 - V) * P[1] - (1 - U) * V * P[2] - U * V * P[3];
            }
            worst = std::max(worst, off(patch.surface, u, v, p));
        }
    EXPECT_LE(worst, patch.bound);
    EXPECT_GT(worst, 0.002 * patch.bound);
    for (double t : kAt) {
        EXPECT_LE(off(patch.surface, t, 0, exact(u0, t)), patch.bound);
        EXPECT_LE(off(patch.surface, t, 1, exact(u1, t)), patch.bound);
        EXPECT_LE(off(patch.surface, 0, t, exact(v0, t)), patch.bound);
        EXPECT_LE(off(patch.surface, 1, t, exact(v1, t)), patch.bound);
    }
}

TEST(Coons, boundaries_that_need_no_change_are_kept_to_the_bit) {
    Random random(2);
    const Vec<3> c[4] = {{{0, 0, 0.1}}, {{1, 0, 0.3}}, {{0, 1, 0.7}}, {{1, 1, 1.3}}};
    const auto u0 = between(random_curve(random, 3, {0.3}), c[0], c[1]),
               u1 = between(random_curve(random, 3, {0.3}), c[2], c[3]);
    const auto v0 = between(random_curve(random, 2, {0.6}), c[0], c[2]),
               v1 = between(random_curve(random, 2, {0.6}), c[1], c[3]);
    const auto s = must(coons(u0, u1, v0, v1, 0)).surface;
    EXPECT_EQ(boundary(s, 1, 0), u0);
    EXPECT_EQ(boundary(s, 1, 1), u1);
    EXPECT_EQ(boundary(s, 0, 0), v0);
    EXPECT_EQ(boundary(s, 0, 1), v1);
}

TEST(Coons, reproduces_bilinear_patches_and_all_of_degree_one_in_a_direction) {
    Random random(3);
    const auto line = [](const Vec<3>& a, const Vec<3>& b) { return bezier<Vec<3>>({a, b}); };
    const Vec<3> p{{0, 0, 0}}, q{{2, 0, 1}}, r{{0, 1, 3}}, s{{1, 1, 1}};
    const auto flat = must(coons(line(p, q), line(r, s), line(p, r), line(q, s), 0));
    EXPECT_EQ(points(flat.surface), (std::vector<Vec<3>>{p, r, q, s}));
    // Boundaries of any surface that is linear in v give the surface.
    const std::array<BSplineBasis, 2> bases{must(BSplineBasis::make(3, {0, 0, 0, 0, 0.5, 1, 1, 1, 1})),
                                            must(BSplineBasis::bezier(1))};
    const auto ruled = test::random_patch_on<2, Vec<3>>(random, bases);
    const auto back = must(
        coons(boundary(ruled, 1, 0), boundary(ruled, 1, 1), boundary(ruled, 0, 0), boundary(ruled, 0, 1), 0));
    for (double u : kAt)
        for (double v : kAt) EXPECT_LE(norm(back.surface(u, v) - ruled(u, v)), 3e-15);
}

TEST(Coons, corners_that_miss_each_other_are_refused_or_met_half_way) {
    const auto line = [](const Vec<2>& a, const Vec<2>& b) { return bezier<Vec<2>>({a, b}); };
    const auto u0 = line({{0, 0}}, {{1, 0}}), u1 = line({{0, 1}}, {{1, 1}}), v0 = line({{0, 0}}, {{0, 1}});
    const auto v1 = line({{1, 0.25}}, {{1, 1}});
    const auto refused = coons(u0, u1, v0, v1, 0.1);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().where, "upper u, lower v");
    EXPECT_NE(refused.error().message.find("0.25"), std::string::npos) << refused.error().message;
    const auto patch = must(coons(u0, u1, v0, v1, 0.3));
    EXPECT_NEAR(patch.corner_gap, 0.25, 1e-12);
    for (double t : kAt) {
        EXPECT_LE(norm(patch.surface(t, 0.0) - in_space(u0)(t)), 0.125 + 1e-15);
        EXPECT_LE(norm(patch.surface(1.0, t) - in_space(v1)(t)), 0.125 + 1e-15);
    }
    EXPECT_FALSE(coons(u0, u1, v0, v1, std::nan("")));
    EXPECT_FALSE(coons(u0, u1, v0,
                       must(Curve<Vec<2>>::make({must(BSplineBasis::bezier(0))}, Net<1, Vec<2>>({1}))), 9));
}

TEST(Coons, bicubic_patches_reproduce_bicubic_surfaces_and_have_the_cross_derivatives) {
    Random random(4);
    // On domains of other lengths than 1.
    const std::array<BSplineBasis, 2> bases{must(BSplineBasis::bezier(3, {1, 3})),
                                            must(BSplineBasis::bezier(3, {0, 0.5}))};
    const auto s = test::random_patch_on<2, Vec<3>>(random, bases);
    const auto edge = [](const Surface<Vec<3>>& f, int axis, int side) {
        return CoonsEdge<Vec<3>>{boundary(f, axis, side), boundary(derivative(f, axis), axis, side)};
    };
    const CoonsTolerance tight{1e-14, 1e-12, 1e-11};
    const auto back = must(coons_bicubic(edge(s, 1, 0), edge(s, 1, 1), edge(s, 0, 0), edge(s, 0, 1), tight));
    for (double u : {1.0, 1.3, 2.75, 3.0})
        for (double v : {0.0, 0.1, 0.3, 0.5}) EXPECT_LE(norm(back.surface(u, v) - s(u, v)), 1e-13);
    EXPECT_LT(back.bound, 1e-12);
    // Of a surface of higher degrees it has the edges and cross derivatives, not the inside.
    const auto high = test::random_patch_on<2, Vec<3>>(
        random,
        {must(BSplineBasis::make(4, {0, 0, 0, 0, 0, 0.5, 1, 1, 1, 1, 1})), must(BSplineBasis::bezier(5))});
    const auto near = must(coons_bicubic(edge(high, 1, 0), edge(high, 1, 1), edge(high, 0, 0),
                                         edge(high, 0, 1), CoonsTolerance{1e-13, 1e-12, 1e-11}));
    for (double t : kAt)
        for (double end : {0.0, 1.0}) {
            const auto a = near.surface.jet<1>({t, end}), b = high.jet<1>({t, end});
            const auto c = near.surface.jet<1>({end, t}), d = high.jet<1>({end, t});
            for (std::size_t i = 0; i < 3; ++i) {
                EXPECT_LE(norm(a.d[i] - b.d[i]), 3e-12) << i;
                EXPECT_LE(norm(c.d[i] - d.d[i]), 3e-12) << i;
            }
        }
    EXPECT_GT(norm(near.surface(0.4, 0.4) - high(0.4, 0.4)), 1e-3);
}

TEST(Coons, twists_that_contradict_each_other_are_refused_with_their_corner) {
    const auto line = [](const Vec<3>& a, const Vec<3>& b) { return bezier<Vec<3>>({a, b}); };
    const Vec<3> x{{1, 0, 0}}, y{{0, 1, 0}}, up{{0, 0, 1}};
    // The unit square; the cross derivative of u0 rises in its middle, so that it twists at both ends.
    const CoonsEdge<Vec<3>> u0{line({}, x), bezier<Vec<3>>({y, y + 0.25 * up, y})},
        u1{line(y, x + y), line(y, y)}, v0{line({}, y), line(x, x)}, v1{line(x, x + y), line(x, x)};
    const auto refused = coons_bicubic(u0, u1, v0, v1, CoonsTolerance{1e-12, 1e-12, 0.4});
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().where, "lower u, lower v");
    EXPECT_NE(refused.error().message.find("twists differ by 0.5"), std::string::npos)
        << refused.error().message;
    const auto patch = must(coons_bicubic(u0, u1, v0, v1, CoonsTolerance{1e-12, 1e-12, 0.6}));
    EXPECT_NEAR(patch.twist_gap, 0.5, 1e-9);
    EXPECT_LT(patch.tangent_gap, 1e-12);
    // A tangent that is not the derivative of the neighbouring edge.
    const CoonsEdge<Vec<3>> leaning{line({}, x), line(y, y + 0.5 * up)};
    const auto tangent = coons_bicubic(leaning, u1, v0, v1, CoonsTolerance{1e-12, 0.4, 9});
    ASSERT_FALSE(tangent);
    EXPECT_EQ(tangent.error().where, "upper u, lower v");
    EXPECT_NE(tangent.error().message.find("tangents differ by 0.5"), std::string::npos)
        << tangent.error().message;
}

TEST(PowersOn, are_the_coefficients_of_powers) {
    Random random(5);
    for (int p = 1; p <= 6; ++p) {
        const auto basis = test::random_basis(random, p, {test::Ends::clamped, 4, false, true});
        const auto x = powers_on(basis, std::min(p, 3));
        const Interval on = basis.domain();
        for (std::size_t m = 0; m < x.size(); ++m) {
            std::vector<Vec<1>> c;
            double bound = 0;
            for (const Bounded& b : x[m]) c.push_back({{b.value}}), bound = std::max(bound, b.bound);
            const int n = int(c.size());
            const auto f = must(Curve<Vec<1>>::make({basis}, Net<1, Vec<1>>({n}, std::move(c))));
            for (double t : {on.lo, on.lo + on.length() / 3, on.hi}) {
                Rational s = (Rational(t) - Rational(on.lo)) / (Rational(on.hi) - Rational(on.lo)), power = 1;
                for (std::size_t k = 0; k < m; ++k) power *= s;
                EXPECT_LE(std::abs(Rational(test::value_of<Rational>(f, t)[0] - power).convert_to<double>()),
                          bound);
            }
            EXPECT_LT(bound, 1e-14);
        }
    }
}

}  // namespace
}  // namespace freiform
