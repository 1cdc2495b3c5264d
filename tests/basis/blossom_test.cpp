#include "support/random.hpp"
#include "support/reference.hpp"

#include <freiform/basis/blossom.hpp>

#include <cmath>
#include <gtest/gtest.h>
#include <numeric>

namespace freiform {
namespace {

using test::Ends;
using test::must;
using test::Random;
using test::Rational;

constexpr Ends kAllEnds[] = {Ends::clamped, Ends::unclamped, Ends::closed};

template <class F>
void each_basis(F&& f) {
    Random random(11);
    for (int p : {1, 2, 3, 4, 5, 6, 7, 8, 9, 25})
        for (Ends ends : kAllEnds)
            for (int k = 0; k < (p > 9 ? 2 : 6); ++k)
                f(random, test::random_basis(random, p, {ends, random.integer(1, 5), ends != Ends::closed}));
}

TEST(Blossom, values_are_not_negative_and_sum_to_one) {
    each_basis([](Random& random, const BSplineBasis& b) {
        const int p = b.degree();
        double w[kMaxDegree + 1];
        for (double u : test::parameters(random, b)) {
            weights(b, u, 0, w);
            double sum = 0;
            for (int i = 0; i <= p; ++i) {
                ASSERT_GE(w[i], 0) << "degree " << p << " at " << u;
                sum += w[i];
            }
            ASSERT_NEAR(sum, 1, (p + 1) * 5 * 0x1p-53);
        }
    });
}

TEST(Blossom, values_and_derivatives_are_those_of_cox_and_de_boor) {
    double worst = 0;
    each_basis([&](Random& random, const BSplineBasis& b) {
        const int p = b.degree();
        const auto t = test::knots_as<Rational>(b);
        double w[kMaxDegree + 1];
        const auto all = test::parameters(random, b, 1);
        for (std::size_t k = 0; k<all.size(); k += p> 9 ? 17 : p > 5 ? 3 : 1)
            for (int order : {0, 1, 2, p, p + 1}) {
                if (order > p + 1) continue;
                const int first = weights(b, all[k], order, w);
                const auto exact = test::cox_de_boor(t, p, Rational(all[k]), order);
                Rational scale(0), out(0);
                for (std::size_t i = 0; i < exact.size(); ++i) {
                    const int local = int(i) - first;
                    scale = std::max<Rational>(scale, abs(exact[i]));
                    if (local < 0 || local > p) {
                        ASSERT_EQ(exact[i], 0) << "support reaches further";
                    }
                }
                for (int i = 0; i <= p; ++i)
                    out = std::max<Rational>(out, abs(Rational(w[i]) - exact[std::size_t(first + i)]));
                if (scale == 0) {
                    ASSERT_EQ(out, 0);
                    continue;
                }
                // Order 0: every weight is off by at most 5 p roundings. Derivatives: differences of the
                // values of a lower degree; their errors are small beside the largest of them.
                const double relative = Rational(out / scale).convert_to<double>();
                ASSERT_LE(relative, (order == 0 ? 5 * p : 40 * (p + 1)) * 0x1p-53)
                    << "degree " << p << " order " << order;
                worst = std::max(worst, relative / ((p + 1) * 0x1p-53));
            }
    });
    std::printf("  largest error of a weight, in units of (p + 1) 2^-53 of the largest weight: %.3g\n",
                worst);
}

TEST(Blossom, is_symmetric_and_multiaffine) {
    Random random(13);
    for (int p = 2; p <= 9; ++p) {
        const auto b = test::random_basis(random, p, {Ends::closed, 4, false, true});
        const int s = b.span(random.real(b.domain().lo, b.domain().hi));
        std::vector<Rational> args, w(std::size_t(p) + 1), v(w), x(w), y(w);
        for (int i = 0; i < p; ++i) args.emplace_back(random.real(-3, 3));
        blossom(b, s, args.data(), w.data());
        auto turned = args;
        std::rotate(turned.begin(), turned.begin() + 1, turned.end());
        std::swap(turned[0], turned[1]);
        blossom(b, s, turned.data(), v.data());
        EXPECT_EQ(w, v);
        const Rational other(random.real(-3, 3)), mix(random.real(-1, 2));
        auto a1 = args;
        a1[1] = other;
        blossom(b, s, a1.data(), x.data());
        a1[1] = (1 - mix) * args[1] + mix * other;
        blossom(b, s, a1.data(), y.data());
        for (std::size_t i = 0; i < w.size(); ++i) EXPECT_EQ(y[i], Rational((1 - mix) * w[i] + mix * x[i]));
        // At p consecutive knots around the span the blossom is a coefficient.
        for (int j = 0; j <= p; ++j) {
            for (int k = 0; k < p; ++k) args[std::size_t(k)] = Rational(b.knot(s - p + j + 1 + k));
            blossom(b, s, args.data(), w.data());
            for (int k = 0; k <= p; ++k) EXPECT_EQ(w[std::size_t(k)], k == j ? 1 : 0);
        }
    }
}

TEST(Blossom, spans_as_short_as_a_denormal_number_give_finite_values) {
    const double tiny = 1e-320;
    for (int p = 1; p <= 9; ++p) {
        std::vector<double> t(std::size_t(p) + 1, 0.0);
        t.insert(t.end(), {tiny, 2 * tiny, 3 * tiny});
        t.insert(t.end(), std::size_t(p) + 1, 1.0);
        const auto b = must(BSplineBasis::make(p, t));
        double w[kMaxDegree + 1];
        for (double u : {0.0, tiny / 2, tiny, 1.5 * tiny, 2 * tiny, 2.5 * tiny, 3 * tiny, 1e-300, 0.5, 1.0}) {
            weights(b, u, 0, w);
            for (int i = 0; i <= p; ++i) ASSERT_TRUE(w[i] >= 0 && w[i] <= 1) << w[i];
            ASSERT_NEAR(std::accumulate(w, w + p + 1, 0.0), 1, 1e-14);
        }
    }
}

TEST(Blossom, bernstein_is_the_b_spline_basis_of_one_span) {
    Random random(14);
    for (int p = 0; p <= 25; ++p) {
        const Interval on{random.real(-2, 0), random.real(1, 3)};
        const auto a = must(Bernstein::make(p, on));
        const auto b = must(BSplineBasis::bezier(p, on));
        for (double u : test::parameters(random, b))
            for (int order = 0; order <= 4; ++order) {
                double v[kMaxDegree + 1], w[kMaxDegree + 1];
                EXPECT_EQ(weights(a, u, order, v), 0);
                EXPECT_EQ(weights(b, u, order, w), 0);
                for (int i = 0; i <= p; ++i) ASSERT_EQ(v[i], w[i]);
            }
    }
}

}  // namespace
}  // namespace freiform
