// Lengths of lines and conics against closed forms, against the splines that they are, and against a slow
// twin.
#include <freiform/core/constants.hpp>
#include <freiform/query/length.hpp>

#include <gtest/gtest.h>
#include <numbers>
#include <support/random.hpp>
#include <support/refusal.hpp>
#include <support/sanitizer.hpp>

namespace freiform::test {
namespace {

constexpr double kPi_ = std::numbers::pi;

void expect_length(const CurveGeometry<3>& c, Interval on, double exact, double within = 1e-13) {
    const auto m = length(c, on, 0);
    ASSERT_TRUE(m);
    EXPECT_LE(std::abs(m->value - exact), m->bound + 1e-15 * exact);
    EXPECT_LE(m->bound, within * (1 + exact)) << exact;
}

TEST(ConicLength, has_closed_forms) {
    expect_length(Line<3>{{{1, 2, 3}}, {{2, 3, 6}}}, {-1, 1}, 14);
    expect_length(Conic<3>{ConicKind::ellipse, {{9, 9, 9}}, {{0, 2, 0}}, {{2, 0, 0}}}, {0, 2 * kPi_},
                  4 * kPi_);
    expect_length(Conic<3>{ConicKind::ellipse, {}, {{0, 2, 0}}, {{2, 0, 0}}}, {1, 1 + 0x1p-40}, 0x1p-39);
    // 4 a E(1 - b^2 / a^2), from the arithmetic-geometric mean with 40 digits.
    expect_length(Conic<3>{ConicKind::ellipse, {}, {{3, 0, 0}}, {{0, 1, 0}}}, {0, 2 * kPi_},
                  13.364893220555258);
    const auto parabola = [](double t) { return t / 2 * std::sqrt(1 + 4 * t * t) + std::asinh(2 * t) / 4; };
    expect_length(Conic<3>{ConicKind::parabola, {}, {{1, 0, 0}}, {{0, 1, 0}}}, {-1, 3},
                  parabola(1) + parabola(3));
}

TEST(ConicLength, of_an_ellipse_without_width_is_there_and_back) {
    expect_length(Conic<3>{ConicKind::ellipse, {}, {{3, 4, 0}}, {}}, {0, 2 * kPi_}, 20, 1e-9);
    expect_length(Conic<3>{ConicKind::ellipse, {}, {{5, 0, 0}}, {{0, 1e-9, 0}}}, {0, 2 * kPi_}, 20, 1e-9);
}

// The midpoint rule with Richardson's step: a twin that knows nothing of bounds.
double slow_length(const Conic<3>& c, Interval on) {
    const auto sum = [&](int n) {
        double s = 0;
        for (int i = 0; i < n; ++i)
            s += norm(jet<1>(CurveGeometry<3>(c), on.lo + on.length() * (i + 0.5) / n).d[1]);
        return s * on.length() / n;
    };
    const double coarse = sum(2000), fine = sum(4000);
    return fine + (fine - coarse) / 3;
}

TEST(ConicLength, is_that_of_a_slow_twin_adds_up_and_scales_exactly) {
    Random random(11);
    for (int k = 0; k < cases(60); ++k) {
        Conic<3> c;
        c.kind =
            std::array{ConicKind::ellipse, ConicKind::hyperbola, ConicKind::parabola}[std::size_t(k % 3)];
        for (int d = 0; d < 3; ++d) c.x[d] = random.real(-2, 2), c.y[d] = random.real(-2, 2);
        const double lo = random.real(-3, 3), hi = lo + random.real(0.1, 3), middle = random.real(lo, hi);
        const auto all = length(c, {lo, hi}, 0), left = length(c, {lo, middle}, 0),
                   right = length(c, {middle, hi}, 0);
        ASSERT_TRUE(all && left && right);
        EXPECT_NEAR(all->value, slow_length(c, {lo, hi}), all->bound + 1e-8 * all->value);
        EXPECT_NEAR(all->value, left->value + right->value, all->bound + left->bound + right->bound);
        EXPECT_LE(all->bound, 1e-12 * all->value);
        const Conic<3> large{c.kind, {}, 0x1p200 * c.x, 0x1p200 * c.y};
        const auto scaled = length(large, {lo, hi}, 0);
        ASSERT_TRUE(scaled);
        EXPECT_EQ(scaled->value, 0x1p200 * all->value);
        EXPECT_EQ(scaled->bound, 0x1p200 * all->bound);
    }
}

TEST(ConicLength, refuses_what_is_no_interval_and_what_is_too_long) {
    const Conic<3> hyperbola{ConicKind::hyperbola, {}, {{1, 0, 0}}, {{0, 1, 0}}};
    expect_refusal(length(hyperbola, {0, kInfinity}, 0), RefusalKind::invalid, "on");
    expect_refusal(length(hyperbola, {1, 0}, 0), RefusalKind::invalid, "on");
    expect_refusal(length(hyperbola, {0, 1e4}, 0), RefusalKind::limit, "on");
    const auto many = length(Conic<3>{ConicKind::ellipse, {}, {{1, 0, 0}}, {{0, 2, 0}}}, {0, 1e9}, 0);
    ASSERT_TRUE(many);  // work ends; the bound says with what
    EXPECT_TRUE(std::isfinite(many->bound));
}

}  // namespace
}  // namespace freiform::test
