#include "support/bezier.hpp"
#include "support/curves.hpp"
#include "support/reference.hpp"

#include <freiform/make/conic.hpp>
#include <freiform/make/sweep.hpp>
#include <freiform/spline/compatible.hpp>

#include <gtest/gtest.h>

namespace freiform {
namespace {

using test::bezier;
using test::must;
using test::Random;
using test::random_curve;
using test::Rational;

using Exact3 = std::array<Rational, 3>;
template <std::size_t N, class P>
Exact3 exact(const Patch<N, P>& s, const Param<N>& at) {
    Exact3 x{};
    const auto r = test::value_of<Rational>(s, at);
    std::copy(r.begin(), r.end(), x.begin());
    return x;
}
double distance(const Exact3& a, const Exact3& b) {
    double sum = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        const double d = Rational(a[i] - b[i]).convert_to<double>();
        sum += d * d;
    }
    return std::sqrt(sum);
}

constexpr double kSweptAt[] = {0, 0.1875, 0.5, 0.75, 0.9375, 1};

template <class P>
class Sweeps : public testing::Test {};
using SweptKinds = testing::Types<Vec<2>, Hom<2>, Vec<3>, Hom<3>>;
TYPED_TEST_SUITE(Sweeps, SweptKinds);

TYPED_TEST(Sweeps, extrusion_adds_a_multiple_of_the_vector) {
    Random random(1);
    const auto c = random_curve<TypeParam>(random, 3, {0.25, 0.5, 0.5});
    const Vec<3> d{{0.3, -1.7, 2.9}};
    const auto made = must(extrude(c, d));
    EXPECT_EQ(boundary(made.surface, 1, 0), in_space(c));
    EXPECT_LT(made.bound, 2e-14);
    double worst = 0;
    for (double u : kSweptAt)
        for (double v : kSweptAt) {
            Exact3 p = exact(c, u);
            for (int i = 0; i < 3; ++i) p[std::size_t(i)] += Rational(v) * Rational(d[i]);
            worst = std::max(worst, distance(exact(made.surface, {u, v}), p));
        }
    EXPECT_LE(worst, made.bound);
    EXPECT_GT(worst, 0.02 * made.bound);
}

TYPED_TEST(Sweeps, ruled_surface_has_both_curves_as_boundaries_and_straight_lines_between) {
    Random random(2);
    const auto a = random_curve<TypeParam>(random, 2, {0.25, 0.5}),
               b = random_curve<TypeParam>(random, 4, {0.5, 0.5});
    const auto made = must(ruled(a, b));
    EXPECT_EQ(made.surface.basis(0).degree(), 4);
    EXPECT_EQ(made.surface.basis(0).multiplicity(0.25), 3);
    EXPECT_EQ(made.surface.basis(0).multiplicity(0.5), 3);
    EXPECT_LT(made.bound, 3e-13);
    double worst = 0;
    for (double u : kSweptAt) {
        const Exact3 p = exact(a, u), q = exact(b, u);
        worst = std::max(
            {worst, distance(exact(made.surface, {u, 0}), p), distance(exact(made.surface, {u, 1}), q)});
        const auto wa = test::homogeneous<Rational>(a, u, {0}), wb = test::homogeneous<Rational>(b, u, {0});
        constexpr bool kRational = Space<TypeParam>::kRational;
        const Rational one(1), x = kRational ? wa.back() : one, y = kRational ? wb.back() : one;
        for (double v : kSweptAt) {
            const Rational s = (1 - Rational(v)) * x, t = Rational(v) * y;
            Exact3 r;
            for (std::size_t i = 0; i < 3; ++i) r[i] = (s * p[i] + t * q[i]) / (s + t);
            worst = std::max(worst, distance(exact(made.surface, {u, v}), r));
        }
    }
    EXPECT_LE(worst, made.bound);
    EXPECT_GT(worst, 0);
}

TYPED_TEST(Sweeps, ruled_with_its_own_translate_is_the_extrusion) {
    Random random(3);
    const auto c = in_space(random_curve<TypeParam>(random, 3, {0.5}));
    auto net = c.net();
    for (auto& p : net.flat())
        for (int i = 0; i < 3; ++i) p[i] += double(i + 1) * Space<InSpace<TypeParam>>::weight(p);
    using Q = InSpace<TypeParam>;
    const auto lines = must(ruled(c, must(Curve<Q>::make(c.bases(), net))));
    const auto wall = must(extrude(c, {{1, 2, 3}}));
    EXPECT_EQ(lines.surface.bases(), wall.surface.bases());
    for (std::size_t i = 0; i < wall.surface.net().flat().size(); ++i)
        EXPECT_LE(max_abs(lines.surface.net().flat()[i] - wall.surface.net().flat()[i]), 5e-15);
}

TYPED_TEST(Sweeps, translational_surface_is_the_sum_of_its_curves) {
    Random random(4);
    const auto a = random_curve<TypeParam>(random, 3, {0.5}),
               b = random_curve<TypeParam>(random, 2, {0.25, 0.5});
    const auto made = must(translate_along(a, b));
    double worst = 0;
    const Exact3 start = exact(b, 0.0);
    for (double u : kSweptAt)
        for (double v : kSweptAt) {
            Exact3 p = exact(a, u);
            const Exact3 q = exact(b, v);
            for (std::size_t i = 0; i < 3; ++i) p[i] += q[i] - start[i];
            worst = std::max(worst, distance(exact(made.surface, {u, v}), p));
        }
    EXPECT_LE(worst, made.bound);
    EXPECT_LT(made.bound, 1e-13);
    if (!Space<TypeParam>::kRational) {
        EXPECT_EQ(boundary(made.surface, 1, 0), in_space(a));
    }
    // A straight rail is an extrusion.
    const auto rail = [&] {
        if constexpr (Space<TypeParam>::kDim == 3)
            return bezier<TypeParam>(
                {Space<TypeParam>::lift({{1, 1, 1}}, 1), Space<TypeParam>::lift({{2, 3, 5}}, 1)});
        else
            return bezier<TypeParam>(
                {Space<TypeParam>::lift({{1, 1}}, 1), Space<TypeParam>::lift({{2, 3}}, 1)});
    }();
    const auto along = must(translate_along(a, rail)),
               wall = must(extrude(a, rail(1.0)[0] == 2 && Space<TypeParam>::kDim == 3 ? Vec<3>{{1, 2, 4}}
                                                                                       : Vec<3>{{1, 2, 0}}));
    for (double u : kSweptAt) EXPECT_LE(norm(along.surface(u, 0.75) - wall.surface(u, 0.75)), 1e-14);
}

TEST(Sweep, closed_curves_stay_closed) {
    const auto ring =
        must(full_ellipse(Conic<3>{ConicKind::ellipse, {}, {{2, 0, 0}}, {{0, 1, 0}}}, EllipseForm::closed))
            .curve;
    const auto other = must(full_ellipse(Conic<3>{ConicKind::ellipse, {{0, 0, 3}}, {{1, 0, 0}}, {{0, 2, 0}}},
                                         EllipseForm::closed))
                           .curve;
    EXPECT_TRUE(must(extrude(ring, {{0, 0, 1}})).surface.basis(0).is_closed());
    EXPECT_TRUE(must(ruled(ring, other)).surface.basis(0).is_closed());
    const auto both = must(translate_along(ring, other));
    EXPECT_TRUE(both.surface.basis(0).is_closed() && both.surface.basis(1).is_closed());
    EXPECT_LE(norm(both.surface(0.3, 0.0) - ring(0.3)), 4 * both.bound);
    // One open curve opens the other.
    const auto line = bezier<Hom<3>>({{{0, 0, 1, 1}}, {{1, 0, 1, 1}}});
    const auto mixed = must(ruled(line, ring));
    EXPECT_FALSE(mixed.surface.basis(0).is_closed());
    for (double u : kSweptAt) EXPECT_LE(norm(mixed.surface(u, 1.0) - ring(u)), mixed.bound + 2e-15);
}

TEST(Sweep, an_unclamped_rail_begins_at_its_start) {
    Random random(5);
    test::BasisOptions options;
    options.ends = test::Ends::unclamped;
    const auto rail = test::random_patch<1, Hom<3>>(random, 4, options);
    const auto profile = random_curve<Hom<3>>(random, 2);
    const auto made = must(translate_along(profile, rail));
    for (double u : kSweptAt)
        EXPECT_LE(distance(exact(made.surface, {u, rail.domain()[0].lo}), exact(profile, u)), made.bound);
}

TEST(Sweep, domains_that_differ_are_mapped_to_the_first) {
    const auto a = bezier<Vec<3>>({{{0, 0, 0}}, {{1, 0, 0}}}, {2, 4});
    const auto b = must(Curve<Vec<3>>::make({must(BSplineBasis::make(1, {-1, -1, 0, 3, 3}))},
                                            Net<1, Vec<3>>({3}, {{{0, 1, 0}}, {{1, 2, 0}}, {{2, 1, 0}}})));
    const auto made = must(ruled(a, b));
    EXPECT_EQ(made.surface.domain()[0], (Interval{2, 4}));
    EXPECT_EQ(made.surface(2.5, 1.0), (Vec<3>{{1, 2, 0}}));
    EXPECT_EQ(made.surface(2.5, 0.0), (Vec<3>{{0.25, 0, 0}}));
}

TEST(Sweep, refuses_what_sweeps_nothing_and_scales_with_powers_of_two) {
    Random random(6);
    const auto c = random_curve<Hom<3>>(random, 3, {0.5}), d = random_curve<Hom<3>>(random, 2);
    EXPECT_EQ(extrude(c, {}).error().where, "vector");
    EXPECT_EQ(extrude(c, {{0, std::nan(""), 1}}).error().kind, RefusalKind::nonfinite);
    EXPECT_FALSE(extrude(c, {{0x1p1023, 0, 0}}));
    const auto scaled = [](const Curve<Hom<3>>& curve, int e) {
        auto net = curve.net();
        for (Hom<3>& h : net.flat())
            for (int i = 0; i < 3; ++i) h[i] = std::scalbn(h[i], e);
        return must(Curve<Hom<3>>::make(curve.bases(), net));
    };
    for (const int e : {-800, 800}) {
        const auto check = [&](const MadeSurface<Hom<3>>& small, const MadeSurface<Hom<3>>& big) {
            EXPECT_NEAR(std::scalbn(big.bound, -e) / small.bound, 1, 1e-9);
            for (std::size_t i = 0; i < small.surface.net().flat().size(); ++i)
                for (int k = 0; k < 3; ++k)
                    EXPECT_EQ(big.surface.net().flat()[i][k],
                              std::scalbn(small.surface.net().flat()[i][k], e));
        };
        check(must(ruled(c, d)), must(ruled(scaled(c, e), scaled(d, e))));
        check(must(translate_along(c, d)), must(translate_along(scaled(c, e), scaled(d, e))));
    }
}

TEST(Compatible, curves_stay_what_they_are) {
    Random random(7);
    for (const auto ends : {test::Ends::clamped, test::Ends::unclamped, test::Ends::closed}) {
        std::vector<Curve<Hom<2>>> curves;
        for (int k = 0; k < 4; ++k) {
            const int p = random.integer(1, 4);
            std::vector<double> t;
            if (ends == test::Ends::closed)
                for (int i = 0; i <= 8; ++i) t.push_back(i % 3 == 1 ? i / 8.0 : (i / 2) / 4.0);
            if (ends == test::Ends::clamped) t.assign(std::size_t(p) + 1, 0.0);
            if (ends == test::Ends::unclamped)
                for (int i = p; i > 0; --i) t.push_back(-i / 4.0);
            if (ends == test::Ends::unclamped) t.push_back(0);
            if (ends != test::Ends::closed)
                for (int i = 1; i < 8; ++i)
                    if (random.chance(0.5)) t.push_back(i / 8.0);
            if (ends == test::Ends::clamped) t.insert(t.end(), std::size_t(p) + 1, 1.0);
            if (ends == test::Ends::unclamped)
                for (int i = 0; i <= p; ++i) t.push_back(1 + i / 4.0);
            curves.push_back(test::random_patch_on<1, Hom<2>>(
                random, {ends == test::Ends::closed ? must(BSplineBasis::periodic(p, t))
                                                    : must(BSplineBasis::make(p, t))}));
        }
        const auto same = must(compatible(std::span<const Curve<Hom<2>>>(curves)));
        for (std::size_t i = 0; i < curves.size(); ++i) {
            EXPECT_EQ(same.curves[i].basis(), same.curves[0].basis());
            for (double t : kSweptAt)
                EXPECT_LE(distance(exact(same.curves[i], t), exact(curves[i], t)), 40 * same.relative[i]);
            EXPECT_LT(same.relative[i], 1e-13);
        }
    }
    EXPECT_FALSE(compatible(std::span<const Curve<Vec<2>>>()));
}

}  // namespace
}  // namespace freiform
