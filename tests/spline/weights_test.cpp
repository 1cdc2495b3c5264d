#include "support/random.hpp"
#include "support/reference.hpp"

#include <freiform/spline/weights.hpp>

#include <gtest/gtest.h>

namespace freiform {
namespace {

using test::must;
using test::Random;
using test::Rational;

// The distance of two patches at a parameter, the arithmetic being exact.
template <std::size_t N, class P>
double exact_distance(const Patch<N, P>& a, const Patch<N, P>& b, const Param<N>& u) {
    const auto x = test::value_of<Rational>(a, u), y = test::value_of<Rational>(b, u);
    Rational sum = 0;
    for (std::size_t i = 0; i < x.size(); ++i) sum += (x[i] - y[i]) * (x[i] - y[i]);
    return std::sqrt(sum.template convert_to<double>());
}

TEST(R14, a_half_circle_has_its_middle_control_point_at_infinity) {
    const auto bezier = must(BSplineBasis::bezier(2));
    const auto half =
        must(positive_weights<1, 2>({bezier}, Net<1, Hom<2>>({3}, {{{1, 0, 1}}, {{0, 1, 0}}, {{-1, 0, 1}}})));
    EXPECT_EQ(half.inserted, 1);
    EXPECT_FALSE(half.negated);
    EXPECT_EQ(points(half.patch), (std::vector<Vec<2>>{{{1, 0}}, {{1, 1}}, {{-1, 1}}, {{-1, 0}}}));
    EXPECT_EQ(weights(half.patch), (std::vector<double>{1, 0.5, 0.5, 1}));
    for (double t : {0.0, 0.125, 0.3, 0.5, 0.9, 1.0}) {
        EXPECT_NEAR(norm(half.patch(t)), 1, 4e-16);
        EXPECT_GE(half.patch(t)[1], 0);
    }
    // Three quarters of the circle: the weight -sqrt(1/2) is negative.
    const double w = -std::sqrt(0.5);
    const auto long_arc = must(positive_weights<1, 2>(
        {bezier},
        Net<1, Hom<2>>({3}, {weighted<2>({{1, 0}}, 1), weighted<2>({{1, 1}}, w), weighted<2>({{0, 1}}, 1)})));
    EXPECT_NEAR(norm(long_arc.patch(0.5)), 1, 1e-15);
    EXPECT_LT(long_arc.patch(0.5)[0], -0.7);
}

TEST(PositiveWeights, leaves_positive_weights_alone_to_the_bit) {
    Random random(1);
    const auto s = test::random_patch<2, Hom<3>>(random, 3, {});
    const auto form = must(positive_weights<2, 3>(s.bases(), s.net()));
    EXPECT_EQ(form.patch, s);
    EXPECT_EQ(form.bound, 0);
    EXPECT_EQ(form.inserted, 0);
}

// Curves on random bases, some of whose weights were made negative as far as the denominator allows it.
TEST(PositiveWeights, keeps_the_function_within_its_bound) {
    Random random(2);
    int accepted = 0, refused = 0;
    for (int k = 0; k < 40; ++k) {
        const auto ends = k % 3 == 0   ? test::Ends::closed
                          : k % 3 == 1 ? test::Ends::clamped
                                       : test::Ends::unclamped;
        const auto basis = test::random_basis(random, random.integer(2, 5), {ends, 3});
        auto net = test::random_net<1, Hom<2>>(random, {basis.size()});
        for (int i = 1; i + 1 < basis.size(); ++i)
            if (random.chance(0.4))
                net.flat()[std::size_t(i)][2] = random.chance(0.3) ? 0 : random.real(-0.4, 0.1);
        if (k % 4 == 0)
            for (auto& p : net.flat()) p = -p;
        const auto given = Curve<Hom<2>>::trusted({basis}, net);
        const auto form = positive_weights<1, 2>({basis}, net);
        bool negative = false, positive = false;
        for (double u : test::parameters(random, basis, 40)) {
            const Rational w = test::homogeneous<Rational, 1>(given, u, {0})[2];
            negative = negative || w <= 0;
            positive = positive || w >= 0;
        }
        if (!form) {
            ++refused;
            EXPECT_EQ(form.error().where, "weights");
            continue;
        }
        ++accepted;
        EXPECT_FALSE(negative && positive);
        EXPECT_EQ(form->negated, negative);
        for (double w : weights(form->patch)) EXPECT_GT(w, 0);
        double worst = 0;
        for (double u : test::parameters(random, basis, 5))
            worst = std::max(worst, exact_distance(given, form->patch, u));
        EXPECT_LE(worst, form->bound);
        EXPECT_LT(form->bound, 1e-10);
    }
    EXPECT_GT(accepted, 10);
    EXPECT_GT(refused, 3);
}

TEST(PositiveWeights, names_the_place_of_a_pole) {
    const auto bezier = must(BSplineBasis::bezier(2, {0, 4}));
    const auto refusal = [&](std::vector<double> w) {
        Net<1, Hom<2>> net({3});
        for (std::size_t i = 0; i < 3; ++i) net.flat()[i] = weighted<2>({{double(i), 1}}, w[i]);
        const auto form = positive_weights<1, 2>({bezier}, net);
        EXPECT_FALSE(form);
        return form ? Refusal{} : form.error();
    };
    // 1 - 4 t (1 - t) 5/4 .. has its first root at t = (1 - sqrt(1/5)) / 2.
    const Refusal r = refusal({1, -1.5, 1});
    EXPECT_EQ(r.kind, RefusalKind::invalid);
    EXPECT_NE(r.message.find("between the parameters 1.1055728090000"), std::string::npos) << r.message;
    EXPECT_EQ(refusal({1, -1, 1}).kind, RefusalKind::invalid);  // a double root at 2
    EXPECT_NE(refusal({1, -1, 1}).message.find("0 at the parameter 2"), std::string::npos);
    EXPECT_EQ(refusal({0, 1, 1}).message, "the denominator is 0 at the parameter 0: a pole");
    EXPECT_EQ(refusal({1, 1, 0}).message, "the denominator is 0 at the parameter 4: a pole");
    EXPECT_EQ(refusal({1, std::nan(""), 1}).kind, RefusalKind::nonfinite);
    // All but a pole: 1 - w^2 = 2^-40.
    EXPECT_EQ(refusal({1, -1 + 0x1p-52, 1}).kind, RefusalKind::ill_conditioned);
    Net<1, Hom<2>> near({3}, {{{0, 0, 1}}, {{1, 1, -1 + 0x1p-10}}, {{2, 0, 1}}});
    EXPECT_TRUE((positive_weights<1, 2>({bezier}, near)));
}

TEST(PositiveWeights, serves_surfaces_and_volumes_along_the_axis_that_needs_it) {
    // A half cylinder, and a quarter of a solid with it.
    const auto bezier = must(BSplineBasis::bezier(2)), line = must(BSplineBasis::bezier(1));
    const std::vector<Hom<3>> cylinder{{{1, 0, 0, 1}}, {{0, 1, 0, 0}}, {{-1, 0, 0, 1}},
                                       {{1, 0, 2, 1}}, {{0, 1, 0, 0}}, {{-1, 0, 2, 1}}};
    const auto s = must(positive_weights<2, 3>({line, bezier}, Net<2, Hom<3>>({2, 3}, cylinder)));
    EXPECT_EQ(s.inserted, 1);
    EXPECT_EQ(s.patch.basis(0), line);
    const Vec<3> p = s.patch(0.25, 0.3);
    EXPECT_NEAR(std::hypot(p[0], p[1]), 1, 1e-15);
    EXPECT_NEAR(p[2], 0.5, 1e-15);
    std::vector<Hom<3>> solid = cylinder;
    for (Hom<3> h : cylinder) solid.push_back({{2 * h[0], 2 * h[1], h[2], h[3]}});
    const auto v = must(positive_weights<3, 3>({line, line, bezier}, Net<3, Hom<3>>({2, 2, 3}, solid)));
    EXPECT_EQ(v.inserted, 1);
    EXPECT_NEAR(norm(v.patch(0.5, 0.0, 0.3)), 1.5, 1e-15);
    auto pole = cylinder;
    pole[1][3] = -2;
    const auto bad = positive_weights<2, 3>({line, bezier}, Net<2, Hom<3>>({2, 3}, pole));
    ASSERT_FALSE(bad);
    EXPECT_NE(bad.error().message.find("negative at the parameters (0, 0.5)"), std::string::npos)
        << bad.error().message;
}

TEST(PositiveWeights, scales_exactly_with_powers_of_two) {
    const auto bezier = must(BSplineBasis::bezier(3));
    const auto form = [&](int e, int f) {
        Net<1, Hom<2>> net({4}, {{{0, 0, 1}}, {{0.3, 0.4, -0.2}}, {{1.7, 0.1, 0.1}}, {{2, 0, 1}}});
        for (auto& p : net.flat())
            p = {{std::ldexp(p[0], e + f), std::ldexp(p[1], e + f), std::ldexp(p[2], f)}};
        return must(positive_weights<1, 2>({bezier}, net));
    };
    const auto a = form(0, 0), b = form(300, -200);
    EXPECT_GT(a.inserted, 0);
    EXPECT_EQ(a.inserted, b.inserted);
    EXPECT_EQ(std::ldexp(a.bound, 300), b.bound);
    for (std::size_t i = 0; i < a.patch.net().flat().size(); ++i)
        EXPECT_EQ(std::ldexp(a.patch.net().flat()[i][0], 100), b.patch.net().flat()[i][0]);
}

}  // namespace
}  // namespace freiform
