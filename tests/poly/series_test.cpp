#include "support/random.hpp"

#include <freiform/core/bounded.hpp>
#include <freiform/poly/series.hpp>

#include <boost/multiprecision/cpp_int.hpp>
#include <gtest/gtest.h>

namespace freiform {
namespace {

using Rational = boost::multiprecision::cpp_rational;
using test::Random;

Series<Rational> random_series(Random& random, int terms) {
    Series<Rational> s;
    for (int i = 0; i < terms; ++i) s.push_back(Rational(random.integer(-9, 9), random.integer(1, 5)));
    return s;
}
Series<Rational> identity(std::size_t terms) {
    Series<Rational> s(terms, Rational(0));
    if (terms > 1) s[1] = 1;
    return s;
}

// In exact rationals, so equality is equality.
TEST(Series, the_inverse_and_the_quotient_undo_composition_and_product) {
    Random random(1);
    for (int terms = 1; terms <= 9; ++terms) {
        auto f = random_series(random, terms), g = random_series(random, terms);
        g[0] = 3;
        EXPECT_EQ(multiply(divide(f, g), g), f);
        g[0] = 0;
        if (terms > 1) g[1] = 2;
        EXPECT_EQ(compose(g, inverse(g)), identity(std::size_t(terms)));
        EXPECT_EQ(compose(inverse(g), g), identity(std::size_t(terms)));
        EXPECT_EQ(compose(compose(f, g), inverse(g)), f);
        EXPECT_EQ(derivatives_of(series_of(std::span<const Rational>(f))), f);
        if (terms > 1) EXPECT_EQ(differentiated(integrated(f)), f);
    }
}

TEST(Series, powers_with_fractions_are_undone_by_their_inverse) {
    Random random(5);
    for (int terms = 1; terms <= 9; ++terms) {
        auto f = random_series(random, terms);
        f[0] = 1;
        const auto third = power_of(f, -2, 3);  // f^(-2/3), three times, and f twice: 1
        auto one = multiply(multiply(multiply(third, third), third), multiply(f, f));
        EXPECT_EQ(one[0], 1);
        for (std::size_t k = 1; k < one.size(); ++k) EXPECT_EQ(one[k], 0) << terms << ", " << k;
        EXPECT_EQ(power_of(f, 2, 1), multiply(f, f));
    }
}

TEST(Series, of_known_functions) {
    // exp t, its inverse less 1 is log(1 + t); sqrt(1 + t); sin o asin.
    Series<double> exponential, logarithm{0};
    double factorial = 1;
    for (int k = 0; k < 8; ++k) {
        exponential.push_back(1 / factorial);
        factorial *= k + 1;
        if (k > 0) logarithm.push_back((k % 2 == 1 ? 1.0 : -1.0) / k);
    }
    const auto log_found = inverse(exponential);
    for (std::size_t k = 1; k < 8; ++k) EXPECT_NEAR(log_found[k], logarithm[k], 1e-14) << k;
    const auto root = square_root(Series<double>{1, 1, 0, 0, 0});
    const double binomials[] = {1, 0.5, -0.125, 0.0625, -0.0390625};
    for (std::size_t k = 0; k < 5; ++k) EXPECT_EQ(root[k], binomials[k]);
    const auto squared =
        multiply(square_root(Series<Bounded>{2, 3, 5, 7}), square_root(Series<Bounded>{2, 3, 5, 7}));
    const double expected[] = {2, 3, 5, 7};
    for (std::size_t k = 0; k < 4; ++k) {
        EXPECT_LE(std::abs(squared[k].value - expected[k]), squared[k].bound);
        EXPECT_LT(squared[k].bound, 1e-13);
    }
}

}  // namespace
}  // namespace freiform
