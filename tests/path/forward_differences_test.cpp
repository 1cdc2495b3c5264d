#include "random.hpp"
#include "reference.hpp"

#include <freiform/path/forward_differences.hpp>

#include <gtest/gtest.h>

namespace freiform::test {
namespace {

// The value at i / n, exactly.
Rational exact(const std::vector<Vec<1>>& b, int i, int n) {
    std::vector<Rational> c;
    for (const auto& p : b) c.push_back(Rational(p[0]));
    const Rational t = Rational(i) / n;
    for (std::size_t r = c.size() - 1; r > 0; --r)
        for (std::size_t k = 0; k < r; ++k) c[k] = (1 - t) * c[k] + t * c[k + 1];
    return c[0];
}

TEST(ForwardDifferences, drift_stays_within_its_bound_against_exact_arithmetic) {
    Random random(31);
    for (const int degree : {1, 2, 3, 5, 9})
        for (const int steps : {7, 64, 1000}) {
            std::vector<Vec<1>> b;
            for (int i = 0; i <= degree; ++i) b.push_back({{random.real(-1, 1)}});
            ForwardDifferences<Vec<1>> f(b, steps);
            double worst = 0;
            for (int i = 1; i <= steps; ++i) {
                f.advance();
                if (i % 31 == 0 || i == steps) worst = std::max(worst, gap(f.value()[0], exact(b, i, steps)));
            }
            EXPECT_LE(worst, f.drift()[0]) << degree << " " << steps;
            if (steps > 7)
                EXPECT_GT(worst, 1e-5 * f.drift()[0]) << "a useless bound: " << degree << " " << steps;
        }
}

TEST(ForwardDifferences, step_polynomials_of_any_degree_and_rational_ones) {
    Random random(32);
    std::vector<Hom<2>> b;
    for (int i = 0; i <= 4; ++i) b.push_back(random_coefficient<Hom<2>>(random));
    ForwardDifferences<Hom<2>> f(b, 50);
    for (int i = 1; i <= 50; ++i) {
        f.advance();
        const Hom<2> wanted = de_casteljau(b, i / 50.0);
        for (int k = 0; k < 3; ++k) EXPECT_NEAR(f.value()[k], wanted[k], f.drift()[k] + 1e-14);
    }
}

TEST(ForwardDifferences, a_constant_does_not_drift) {
    const std::vector<Vec<2>> b{{{3, 4}}};
    ForwardDifferences<Vec<2>> f(b, 5);
    f.advance();
    EXPECT_EQ(f.value(), b[0]);
    EXPECT_EQ(f.drift(), Vec<2>{});
}

}  // namespace
}  // namespace freiform::test
