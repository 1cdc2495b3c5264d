#include "model/piecewise_bound_detail.hpp"
#include "support/random.hpp"

#include <freiform/core/constants.hpp>

#include <cmath>
#include <gtest/gtest.h>

using namespace freiform;
using namespace freiform::test;

namespace {

// f'' is a constant on each piece, so all of f is known.
struct Pieces {
    std::vector<double> ends{0}, second;

    PiecewiseBound bound() const {
        PiecewiseBound b;
        for (std::size_t i = 0; i < second.size(); ++i) b.add(ends[i + 1], std::abs(second[i]));
        return b;
    }
    // f(t) and f'(t), both 0 at a <= t.
    std::pair<double, double> at(double a, double t) const {
        double f = 0, slope = 0;
        for (std::size_t i = 0; i < second.size() && ends[i] < t; ++i) {
            const double h = std::min(t, ends[i + 1]) - std::max(a, ends[i]);
            if (h <= 0) continue;
            f += slope * h + second[i] * h * h / 2;
            slope += second[i] * h;
        }
        return {f, slope};
    }
};

TEST(PiecewiseBound, holds_for_values_and_slopes) {
    Random random(1);
    double tightest = 0;
    for (int round = 0; round < 300; ++round) {
        Pieces p;
        const int n = random.integer(1, 12);
        for (int i = 0; i < n; ++i) {
            const double length = std::exp2(random.real(-14, 0));
            p.ends.push_back(p.ends.back() + length);
            p.second.push_back(random.real(-1, 1) * std::exp2(random.real(-4, 2)) / (length * length));
        }
        const PiecewiseBound bound = p.bound();
        double a = random.real(0, p.ends.back()), b = random.real(0, p.ends.back());
        if (a > b) std::swap(a, b);
        if (round % 3 == 0) a = 0, b = p.ends.back();
        const double h = b - a, m = bound.steady({a, b});
        const double slope = p.at(a, b).first / h, middle = p.at(a, a + h / 2).second;
        double most = 0, turn = 0;
        for (int k = 0; k <= 200; ++k) {
            const double t = a + h * k / 200;
            const auto [f, s] = p.at(a, t);
            most = std::max(most, std::abs(f - slope * (t - a)));
            turn = std::max({turn, std::abs(s - slope), std::abs(s - middle)});
        }
        EXPECT_LE(most, m * h * h / 8 * (1 + 1e-9)) << round;
        EXPECT_LE(turn, m * h / 2 * (1 + 1e-9)) << round;
        tightest = std::max(tightest, most / (m * h * h / 8));
    }
    EXPECT_GT(tightest, 0.9) << "or the bound says too little";
}

TEST(PiecewiseBound, of_one_piece_is_what_it_was) {
    PiecewiseBound b;
    EXPECT_TRUE(b.is_empty());
    for (const double end : {1.0, 2.0, 3.0}) b.add(end, 7);
    EXPECT_EQ(b.steady({0.25, 2.5}), 7);
    EXPECT_EQ(b.steady({0.25, 0.5}), 7);
    EXPECT_EQ(b.steady({-1, 4}), 7) << "the first and the last go on";
}

// A jump J of the slope in the middle adds J h / 4.
TEST(PiecewiseBound, of_a_short_piece_is_that_of_a_kink) {
    for (const double length : {1e-3, 1e-6, 1e-12}) {
        PiecewiseBound b;
        b.add(1, 0), b.add(1 + length, 5 / length), b.add(2, 0);
        EXPECT_NEAR(b.steady({0, 2}) * 4 / 8, 5.0 * 2 / 4, 1e-2) << length;
        EXPECT_EQ(b.steady({1, 1 + length / 2}), 5 / length);
        EXPECT_EQ(b.steady({0, 0.5}), 0);
    }
}

TEST(PiecewiseBound, of_what_has_none_is_infinite) {
    PiecewiseBound b;
    b.add(1, 1), b.add(2, kInfinity), b.add(3, 1);
    EXPECT_EQ(b.steady({0, 3}), kInfinity);
    EXPECT_EQ(b.steady({0, 1}), 1);
}

}  // namespace
