#include "support/bezier.hpp"
#include "support/curves.hpp"
#include "support/reference.hpp"

#include <freiform/fit/loft.hpp>
#include <freiform/make/conic.hpp>
#include <freiform/make/sweep.hpp>

#include <gtest/gtest.h>

namespace freiform {
namespace {

using test::bezier;
using test::must;
using test::Random;
using test::random_curve;
using test::Rational;

constexpr double kAt[] = {0, 0.1875, 0.5, 0.75, 1};

// Exact distance of surface and curve at these parameters.
template <class P, class Q>
double off(const Surface<Q>& s, double u, double v, const Curve<P>& c, double t) {
    const auto q = test::value_of<Rational>(s, {u, v});
    const auto p = test::value_of<Rational>(c, t);
    double sum = 0;
    for (std::size_t i = 0; i < q.size(); ++i) {
        const double d = Rational(q[i] - (i < p.size() ? p[i] : Rational(0))).template convert_to<double>();
        sum += d * d;
    }
    return std::sqrt(sum);
}

template <class P>
class Lofts : public testing::Test {};
using Kinds = testing::Types<Vec<2>, Hom<2>, Vec<3>, Hom<3>>;
TYPED_TEST_SUITE(Lofts, Kinds);

TYPED_TEST(Lofts, contain_their_sections) {
    Random random(1);
    for (const auto spacing : {Spacing::uniform, Spacing::chordal, Spacing::centripetal})
        for (const bool closed : {false, true}) {
            std::vector<Curve<TypeParam>> sections;
            for (int k = 0; k < 5; ++k)
                sections.push_back(random_curve<TypeParam>(random, 1 + k % 3, {k % 2 == 0 ? 0.5 : 0.25}));
            LoftOptions options{3, spacing, SplineEnds::natural, closed};
            const auto made = loft(std::span<const Curve<TypeParam>>(sections), options);
            if (!made && Space<TypeParam>::kRational) continue;  // a pole between sections, proven
            ASSERT_TRUE(made) << made.error().message;
            ASSERT_EQ(made->at.size(), 5u);
            EXPECT_EQ(made->surface.basis(1).is_closed(), closed);
            EXPECT_LT(made->bound, Space<TypeParam>::kRational ? 1e-10 : 1e-12);
            double worst = 0;
            for (std::size_t k = 0; k < 5; ++k)
                for (double u : kAt)
                    worst = std::max(worst, off(made->surface, u, made->at[k], sections[k], u));
            EXPECT_LE(worst, made->bound);
            if (!Space<TypeParam>::kRational) {
                EXPECT_EQ(made->continuity, 2);
            }
        }
}

TEST(Loft, rational_sections_of_equal_weights_stay_rational_ones) {
    std::vector<Curve<Hom<3>>> rings;
    for (int k = 0; k < 4; ++k)
        rings.push_back(
            must(full_ellipse(
                     Conic<3>{ConicKind::ellipse, {{0, 0, double(k)}}, {{1.0 + k, 0, 0}}, {{0, 2, 0}}},
                     EllipseForm::closed))
                .curve);
    const auto made = must(loft(std::span<const Curve<Hom<3>>>(rings)));
    EXPECT_TRUE(made.surface.basis(0).is_closed());
    EXPECT_EQ(made.continuity, 2);
    // Rings that grow linearly make an elliptic cone, of which every section is an ellipse.
    for (double u : kAt)
        for (double v : {0.1, 0.4, 0.77}) {
            const double z = made.at.back() * v;
            const Vec<3> p = made.surface(u, z);
            EXPECT_NEAR(std::pow(p[0] / (1 + p[2]), 2) + p[1] * p[1] / 4, 1, 1e-13);
        }
}

TEST(Loft, of_two_sections_is_the_ruled_surface) {
    Random random(2);
    const std::vector<Curve<Vec<3>>> two{random_curve<Vec<3>>(random, 2, {0.5}),
                                         random_curve<Vec<3>>(random, 3)};
    const auto made = must(loft(std::span<const Curve<Vec<3>>>(two)));
    const auto lines = must(ruled(two[0], two[1]));
    EXPECT_EQ(made.surface.basis(1).degree(), 1);
    EXPECT_EQ(made.continuity, 1);
    for (double u : kAt)
        for (double v : kAt) EXPECT_LE(norm(made.surface(u, v * made.at[1]) - lines.surface(u, v)), 1e-14);
}

TEST(Loft, of_shifted_sections_is_their_extrusion) {
    Random random(3);
    const auto c = random_curve<Vec<3>>(random, 3, {0.25});
    std::vector<Curve<Vec<3>>> all;
    for (int k = 0; k < 5; ++k) {
        auto net = c.net();
        for (Vec<3>& p : net.flat()) p += double(k * k) * Vec<3>{{1, 2, 3}};
        all.push_back(must(Curve<Vec<3>>::make(c.bases(), net)));
    }
    const auto made = must(loft(std::span<const Curve<Vec<3>>>(all)));  // chordal: v grows with the shift
    const auto wall = must(extrude(c, {{16, 32, 48}}));
    for (double u : kAt)
        for (double v : kAt) EXPECT_LE(norm(made.surface(u, v * made.at.back()) - wall.surface(u, v)), 1e-13);
}

TEST(Loft, degree_is_what_was_asked_for_and_scales_with_powers_of_two) {
    Random random(4);
    std::vector<Curve<Vec<3>>> sections, far;
    for (int k = 0; k < 7; ++k) {
        sections.push_back(random_curve<Vec<3>>(random, 2));
        auto net = sections.back().net();
        for (Vec<3>& p : net.flat())
            for (double& x : p.c) x = std::scalbn(x, 60);
        far.push_back(must(Curve<Vec<3>>::make(sections.back().bases(), net)));
    }
    for (const int degree : {1, 2, 3, 4, 5}) {
        const LoftOptions options{degree, Spacing::centripetal, SplineEnds::not_a_knot, false};
        const auto made = must(loft(std::span<const Curve<Vec<3>>>(sections), options));
        EXPECT_EQ(made.surface.basis(1).degree(), degree);
        EXPECT_EQ(made.continuity, degree - 1);
        const auto big = must(loft(std::span<const Curve<Vec<3>>>(far), options));
        EXPECT_EQ(big.at, made.at);
        for (std::size_t i = 0; i < made.surface.net().flat().size(); ++i)
            for (int c = 0; c < 3; ++c)
                EXPECT_EQ(big.surface.net().flat()[i][c], std::scalbn(made.surface.net().flat()[i][c], 60));
    }
}

TEST(Loft, refuses_what_it_cannot_lead_through) {
    Random random(5);
    const auto c = random_curve<Vec<3>>(random, 2);
    const std::vector<Curve<Vec<3>>> one{c}, same{c, c, c}, two{c, random_curve<Vec<3>>(random, 2)};
    const auto refusal = [](const std::vector<Curve<Vec<3>>>& s, LoftOptions o = {}) {
        const auto r = loft(std::span<const Curve<Vec<3>>>(s), o);
        return r ? "none" : r.error().where;
    };
    EXPECT_EQ(refusal(one), "sections");
    EXPECT_EQ(refusal({}), "sections");
    EXPECT_NE(refusal(same), "none");
    EXPECT_EQ(refusal(two), "none");
    EXPECT_EQ(refusal(two, {3, Spacing::chordal, SplineEnds::natural, true}), "sections");
    EXPECT_EQ(refusal(two, {0, Spacing::chordal, SplineEnds::natural, false}), "degree");
    EXPECT_EQ(refusal(two, {3, Spacing::chordal, SplineEnds::clamped, false}), "ends");
}

// A network cut out of a surface.
struct Network {
    std::vector<Curve<Vec<3>>> u, v;
    std::vector<double> at_v, at_u;
};
Network network_of(const Surface<Vec<3>>& s, std::vector<double> at_v, std::vector<double> at_u) {
    Network n{{}, {}, at_v, at_u};
    for (double v : at_v) n.u.push_back(iso(s, 1, v));
    for (double u : at_u) n.v.push_back(iso(s, 0, u));
    return n;
}
Result<GordonSurface<Vec<3>>> gordon_of(const Network& n, double tolerance) {
    return gordon<3>(n.u, n.at_v, n.v, n.at_u, tolerance);
}

TEST(Gordon, contains_every_curve_of_its_network) {
    Random random(6);
    const auto s = test::random_patch_on<2, Vec<3>>(
        random, {must(BSplineBasis::make(4, {0, 0, 0, 0, 0, 0.25, 0.5, 1, 1, 1, 1, 1})),
                 must(BSplineBasis::make(5, {0, 0, 0, 0, 0, 0, 0.375, 1, 1, 1, 1, 1, 1}))});
    const auto n = network_of(s, {0, 0.25, 0.625, 1}, {0, 0.125, 0.5, 0.8125, 1});
    const auto made = must(gordon_of(n, 1e-13));
    EXPECT_LT(made.bound, 1e-11);
    EXPECT_LT(made.gap, 1e-13);
    double worst = 0;
    for (double t : kAt) {
        for (std::size_t k = 0; k < n.u.size(); ++k)
            worst = std::max(worst, off(made.surface, t, n.at_v[k], n.u[k], t));
        for (std::size_t l = 0; l < n.v.size(); ++l)
            worst = std::max(worst, off(made.surface, n.at_u[l], t, n.v[l], t));
    }
    EXPECT_LE(worst, made.bound);
    EXPECT_GT(norm(made.surface(0.7, 0.4) - s(0.7, 0.4)), 1e-6);  // it is another surface between
}

TEST(Gordon, gives_bicubic_surfaces_back) {
    Random random(7);
    const auto s = test::random_patch_on<2, Vec<3>>(
        random, {must(BSplineBasis::bezier(3)), must(BSplineBasis::bezier(3, {1, 3}))});
    const auto made = must(gordon_of(network_of(s, {1, 1.5, 2.25, 3}, {0, 0.25, 0.5, 0.75, 1}), 1e-13));
    for (double u : kAt)
        for (double v : {1.0, 1.3, 2.5, 3.0}) EXPECT_LE(norm(made.surface(u, v) - s(u, v)), 1e-13);
}

TEST(Gordon, says_which_curves_miss_each_other_where_and_by_how_much) {
    Random random(8);
    const auto s = test::random_patch_on<2, Vec<3>>(
        random, {must(BSplineBasis::bezier(3)), must(BSplineBasis::bezier(2))});
    auto n = network_of(s, {0, 0.5, 1}, {0, 0.25, 1});
    auto net = n.u[1].net();
    for (Vec<3>& p : net.flat()) p[2] += 0.125;
    n.u[1] = must(Curve<Vec<3>>::make(n.u[1].bases(), net));
    const auto refused = gordon_of(n, 0.1);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().where, "u_curves[1], v_curves[0]");
    EXPECT_NE(refused.error().message.find("are 0.12"), std::string::npos) << refused.error().message;
    EXPECT_NE(refused.error().message.find("u = 0, v = 0.5"), std::string::npos) << refused.error().message;
    // Within the tolerance the surface stays within its bound of both.
    const auto made = must(gordon_of(n, 0.2));
    EXPECT_NEAR(made.gap, 0.125, 1e-12);
    double worst = 0;
    for (double t : kAt) {
        for (std::size_t k = 0; k < 3; ++k)
            worst = std::max(worst, off(made.surface, t, n.at_v[k], n.u[k], t));
        for (std::size_t l = 0; l < 3; ++l)
            worst = std::max(worst, off(made.surface, n.at_u[l], t, n.v[l], t));
    }
    EXPECT_LE(worst, made.bound);
    EXPECT_GT(worst, 0.25 * made.bound);
}

// Of a surface of revolution, along u arcs that share their weights, along v other rational curves.
TEST(Gordon, contains_every_curve_of_a_rational_network) {
    const double s = std::sqrt(0.5);
    Net<2, Hom<3>> net({3, 3});
    const double radius[3] = {1, 2, 1.5}, weight[3] = {1, 0.7, 1.3};
    for (int i = 0; i < 3; ++i)
        for (int j = 0; j < 3; ++j) {
            const double x = i < 2 ? radius[j] : 0, y = i > 0 ? radius[j] : 0;
            net.view()({i, j}) = weighted(Vec<3>{{x, y, double(j)}}, (i == 1 ? s : 1) * weight[j]);
        }
    const auto vase =
        must(Surface<Hom<3>>::make({must(BSplineBasis::bezier(2)), must(BSplineBasis::bezier(2))}, net));
    std::vector<Curve<Hom<3>>> along_u, along_v;
    const std::vector<double> at_v = {0, 0.25, 0.625, 1}, at_u = {0, 0.5, 1};
    for (double v : at_v) along_u.push_back(iso(vase, 1, v));
    for (double u : at_u) along_v.push_back(iso(vase, 0, u));
    const auto made = must(gordon<3>(along_u, at_v, along_v, at_u, 1e-12));
    EXPECT_LT(made.bound, 1e-11);
    EXPECT_EQ(made.surface.basis(0).degree(), 2 + 2);  // one denominator and cardinal functions of degree 2
    double worst = 0;
    for (double t : kAt) {
        for (std::size_t k = 0; k < along_u.size(); ++k)
            worst = std::max(worst, norm(made.surface(t, at_v[k]) - along_u[k](t)));
        for (std::size_t l = 0; l < along_v.size(); ++l)
            worst = std::max(worst, norm(made.surface(at_u[l], t) - along_v[l](t)));
    }
    EXPECT_LE(worst, made.bound + 1e-14);
    EXPECT_GT(norm(made.surface(0.3, 0.4) - vase(0.3, 0.4)), 1e-6);
    // Too many different weights are refused, and it says what to do.
    for (std::size_t k = 0; k < along_u.size(); ++k) {
        auto other = along_u[k].net();
        other.flat()[1] *= 1 + 0.1 * double(k);
        auto up = must(elevate(must(Curve<Hom<3>>::make(along_u[k].bases(), other)), 0, 5));
        along_u[k] = up;
    }
    const auto refused = gordon<3>(along_u, at_v, along_v, at_u, 10);
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().kind, RefusalKind::unsupported);
    EXPECT_NE(refused.error().message.find("share their weights"), std::string::npos)
        << refused.error().message;
}

TEST(Gordon, refuses_parameters_that_do_not_fit) {
    Random random(9);
    const auto s = test::random_patch_on<2, Vec<3>>(
        random, {must(BSplineBasis::bezier(3)), must(BSplineBasis::bezier(2))});
    const auto where = [&](Network n) {
        const auto r = gordon_of(n, 1);
        return r ? "none" : r.error().where;
    };
    auto n = network_of(s, {0, 0.5, 1}, {0, 1});
    EXPECT_EQ(where(n), "none");
    n.at_v = {0, 0.5};
    EXPECT_EQ(where(n), "at_v");
    n.at_v = {0, 0.5, 0.75};
    EXPECT_EQ(where(n), "at_v");
    n.at_v = {0, 0, 1};
    EXPECT_EQ(where(n), "at_v[1]");
    n.at_v = {0, std::nan(""), 1};
    EXPECT_EQ(where(n), "at_v[1]");
    n.at_v = {0, 0.5, 1};
    n.v.pop_back(), n.at_u.pop_back();
    EXPECT_EQ(where(n), "at_u");
    n.v.clear(), n.at_u.clear();
    EXPECT_EQ(where(n), "curves");
    EXPECT_FALSE(gordon_of(network_of(s, {0, 1}, {0, 1}), std::nan("")));
}

}  // namespace
}  // namespace freiform
