#include "support/random.hpp"
#include "support/reference.hpp"

#include <freiform/spline/construction.hpp>

#include <gtest/gtest.h>
#include <limits>

namespace freiform {
namespace {

using test::must;
using test::Random;
using test::Rational;

TEST(R15, de_casteljau_of_a_cubic_at_one_half_has_these_intermediate_points) {
    const std::vector<Vec<2>> b{{{0, 0}}, {{0, 8}}, {{8, 8}}, {{8, 0}}};
    const auto c = must(de_casteljau(std::span(b), 0.5));
    EXPECT_EQ(c(1, 0), (Vec<2>{{0, 4}}));
    EXPECT_EQ(c(1, 1), (Vec<2>{{4, 8}}));
    EXPECT_EQ(c(1, 2), (Vec<2>{{8, 4}}));
    EXPECT_EQ(c(2, 0), (Vec<2>{{2, 6}}));
    EXPECT_EQ(c(2, 1), (Vec<2>{{6, 6}}));
    EXPECT_EQ(c.point(), (Vec<2>{{4, 6}}));
    EXPECT_EQ(c.left(), (std::vector<Vec<2>>{{{0, 0}}, {{0, 4}}, {{2, 6}}, {{4, 6}}}));
    EXPECT_EQ(c.right(), (std::vector<Vec<2>>{{{4, 6}}, {{6, 6}}, {{8, 4}}, {{8, 0}}}));
    EXPECT_EQ(c.level(0).size(), 4u);
    EXPECT_EQ(c.flat().size(), 10u);
}

TEST(R15, of_a_rational_curve_is_done_in_homogeneous_coordinates) {
    const double w = std::sqrt(0.5);
    const std::vector<Hom<2>> arc{{{1, 0, 1}}, {{w, w, w}}, {{0, 1, 1}}};
    for (double t : {0.0, 0.25, 0.5, 1.0})
        EXPECT_NEAR(norm(project(must(de_casteljau(std::span(arc), t)).point())), 1, 1e-15);
}

// Every point of every level, and the bound, against exact arithmetic; parameters also outside the domain.
template <class P>
void check_all_points(Random& random, double& worst) {
    for (int p : {0, 1, 2, 3, 5, 8, 11})
        for (int k = 0; k < 3; ++k) {
            const auto patch = test::random_patch_on<1, P>(
                random, {test::random_basis(random, p, {test::Ends(k % (p == 0 ? 2 : 3)), 3, false, false})});
            const BSplineBasis& basis = patch.basis();
            const double u = random.real(basis.domain().lo - 0.1, basis.domain().hi + 0.1);
            const auto c = must(de_boor(patch, u));
            const int span = c.first() + p;
            using Exact = std::array<Rational, std::size_t(P::kCoords)>;
            std::vector<Exact> level(std::size_t(p) + 1);
            for (std::size_t i = 0; i <= std::size_t(p); ++i)
                for (int d = 0; d < P::kCoords; ++d)
                    level[i][std::size_t(d)] =
                        patch.net().flat()[(std::size_t(c.first()) + i) % std::size_t(basis.size())][d];
            for (int r = 0; r <= p; ++r) {
                if (r > 0)
                    for (int i = 0; i <= p - r; ++i) {
                        const Rational tl = basis.knot(span - p + i + r), tr = basis.knot(span + i + 1);
                        const Rational a = (Rational(c.parameter()) - tl) / (tr - tl);
                        for (std::size_t d = 0; d < std::size_t(P::kCoords); ++d)
                            level[std::size_t(i)][d] =
                                (1 - a) * level[std::size_t(i)][d] + a * level[std::size_t(i) + 1][d];
                    }
                for (int i = 0; i <= p - r; ++i)
                    for (int d = 0; d < P::kCoords; ++d) {
                        const double error = test::gap(c(r, i)[d], level[std::size_t(i)][std::size_t(d)]);
                        ASSERT_LE(error, c.bound()) << "degree " << p << " level " << r;
                        worst = std::max(worst, error / c.bound());
                    }
            }
        }
}

TEST(Construction, has_every_intermediate_point_within_its_bound) {
    Random random(51);
    double worst = 0;
    check_all_points<Vec<1>>(random, worst);
    check_all_points<Vec<3>>(random, worst);
    check_all_points<Hom<2>>(random, worst);
    check_all_points<Hom<4>>(random, worst);
    std::printf("construction: observed error / bound = %.3g\n", worst);
    EXPECT_GT(worst, 0.001);
}

TEST(Construction, ends_on_the_curve_and_splits_it) {
    Random random(52);
    for (int p = 1; p <= 9; ++p) {
        const auto basis = must(Bernstein::make(p, {-1, 2}));
        const auto net = test::random_net<1, Vec<3>>(random, {p + 1});
        const auto curve = must(Curve<Vec<3>, Bernstein>::make({basis}, net));
        const double u = random.real(-1, 2);
        const auto c = must(de_boor(curve, u));
        EXPECT_LE(norm(c.point() - curve(u)), 1e-14 * (p + 1));
        const auto left = must(Curve<Vec<3>, Bernstein>::make({must(Bernstein::make(p, {-1, u}))},
                                                              must(Net<1, Vec<3>>::make({p + 1}, c.left()))));
        const auto right = must(Curve<Vec<3>, Bernstein>::make(
            {must(Bernstein::make(p, {u, 2}))}, must(Net<1, Vec<3>>::make({p + 1}, c.right()))));
        for (int k = 0; k <= 8; ++k) {
            const double x = -1 + 3 * (k / 8.0);
            EXPECT_LE(norm((x < u ? left : right)(x)-curve(x)), 1e-13 * (p + 1));
        }
    }
}

TEST(Construction, refuses_what_is_not_finite_and_degrees_that_are_none) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    std::vector<Vec<1>> b{{{0}}, {{nan}}};
    EXPECT_EQ(de_casteljau(std::span<const Vec<1>>(b), 0.5).error().where, "points[1]");
    b[1][0] = 1;
    EXPECT_EQ(de_casteljau(std::span<const Vec<1>>(b), nan).error().kind, RefusalKind::nonfinite);
    EXPECT_FALSE(de_casteljau(std::span<const Vec<1>>(), 0.5).has_value());
    b[1][0] = 1e300;
    EXPECT_EQ(de_casteljau(std::span<const Vec<1>>(b), 1e300).error().kind, RefusalKind::ill_conditioned);
}

}  // namespace
}  // namespace freiform
