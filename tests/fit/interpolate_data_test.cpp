#include "support/curves.hpp"
#include "support/reference.hpp"
#include "support/refusal.hpp"

#include <freiform/fit/interpolate.hpp>

#include <gtest/gtest.h>

namespace freiform {
namespace {

using test::expect_refusal;
using test::must;
using test::Random;

TEST(InterpolateData, meets_values_and_derivatives_anywhere) {
    Random random(10);
    for (int degree = 2; degree <= 6; ++degree)
        for (int round = 0; round < 5; ++round) {
            std::vector<Datum<2>> data;
            std::vector<double> where;
            double t = 0;
            while (int(data.size()) < degree + 6) {
                const int orders = random.integer(1, std::min(degree, 3));
                for (int k = 0; k < orders; ++k) {
                    data.push_back({t, k, test::random_coefficient<Vec<2>>(random)});
                    where.push_back(t);
                }
                t += random.real(0.5, 1.5);
            }
            const auto basis = must(averaged_basis(degree, where));
            std::swap(data[0], data[3]);  // the order does not matter
            const auto c = must(interpolate<2>(basis, std::span<const Datum<2>>(data)));
            for (const auto& d : data) {
                const Vec<2> got = c.patch.derivatives(d.at, d.order)[std::size_t(d.order)];
                EXPECT_LT(test::distance(got, d.value), 1e-9 * c.condition_estimate)
                    << degree << " order " << d.order;
                if (d.order == 0) EXPECT_LE(test::distance(got, d.value), c.bound);
            }
        }
}

TEST(InterpolateData, names_the_datum_that_stands_in_the_wrong_place) {
    const auto basis = must(BSplineBasis::make(2, {0, 0, 0, 1, 2, 3, 3, 3}));
    const auto run = [&](std::vector<double> at) {
        std::vector<Datum<1>> data;
        for (const double t : at) data.push_back({t, 0, {{t}}});
        return interpolate<1>(basis, std::span<const Datum<1>>(data));
    };
    EXPECT_TRUE(run({0, 0.5, 1.5, 2.5, 3}).has_value());
    expect_refusal(run({0, 0.25, 0.5, 0.75, 3}), RefusalKind::ill_conditioned, "data[3]",
                   "does not begin yet");
    expect_refusal(run({0, 2.25, 2.5, 2.75, 3}), RefusalKind::ill_conditioned, "data[1]", "has ended");
    expect_refusal(run({0, 0.5, 0.5, 2.5, 3}), RefusalKind::invalid, "data[2]", "second time");
    expect_refusal(run({0, 0.5, 1.5, 2.5, 3.5}), RefusalKind::out_of_domain, "data[4]", "outside the domain");
    expect_refusal(run({0, 1, 2, 3}), RefusalKind::invalid, "data", "4 data for a basis of 5");
}

TEST(InterpolateData, says_when_derivatives_do_not_determine_a_spline) {
    // f(0), f(2) and f'(1) do not determine a parabola: the classical example of Birkhoff.
    const auto basis = must(BSplineBasis::bezier(2, {0, 2}));
    const std::vector<Datum<1>> data{{0, 0, {{0}}}, {1, 1, {{1}}}, {2, 0, {{0}}}};
    expect_refusal(interpolate<1>(basis, std::span<const Datum<1>>(data)), RefusalKind::ill_conditioned,
                   "data[1]", "no single spline");
}

TEST(InterpolateData, averaged_knots_are_means_of_degree_successive_sites) {
    Random random(15);
    for (int degree = 1; degree <= 5; ++degree) {
        const auto at = test::random_breaks(random, 11, false);
        const auto basis = must(averaged_basis(degree, at));
        ASSERT_EQ(basis.size(), 11);
        for (int k = 0; k <= degree; ++k) {
            EXPECT_EQ(basis.knot(k), at.front());
            EXPECT_EQ(basis.knot(11 + k), at.back());
        }
        for (int i = 1; i + degree < 11; ++i) {
            double sum = 0;
            for (int k = 0; k < degree; ++k) sum += at[std::size_t(i + k)];
            EXPECT_NEAR(basis.knot(degree + i), sum / degree, 1e-13 * std::abs(at.back() - at.front()))
                << degree << " " << i;
        }
    }
}

}  // namespace
}  // namespace freiform
