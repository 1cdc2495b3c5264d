#include <freiform/core/hom.hpp>
#include <freiform/core/vec.hpp>

#include <cmath>
#include <gtest/gtest.h>
#include <limits>

namespace freiform {
namespace {

constexpr double kMax = std::numeric_limits<double>::max();
constexpr double kTiny = std::numeric_limits<double>::denorm_min();

template <int D>
Vec<D> scaled(Vec<D> v, int e) {
    for (int i = 0; i < D; ++i) v[i] = std::scalbn(v[i], e);
    return v;
}

TEST(Vec, norm_scales_exactly_with_powers_of_two) {
    for (const Vec<3>& v : {Vec<3>{{1.25, -0.75, 1.9}}, Vec<3>{{1, 1e-5, 0.3}}, Vec<3>{{0.1, 0.2, -1.7}}})
        for (int e = -960; e <= 1020; e += 7)
            EXPECT_EQ(norm(scaled(v, e)), std::scalbn(norm(v), e)) << "exponent " << e;
}

TEST(Vec, norm_neither_overflows_nor_underflows) {
    EXPECT_EQ(norm(Vec<2>{{kMax, 0}}), kMax);
    EXPECT_EQ(norm(Vec<2>{{3e300, -4e300}}), 5e300);
    EXPECT_EQ(norm(Vec<3>{{kTiny, 0, 0}}), kTiny);
    EXPECT_NEAR(norm(Vec<2>{{3e-310, 4e-310}}), 5e-310, 2 * kTiny);
    EXPECT_EQ(norm(Vec<3>{}), 0);
}

TEST(Vec, norm_of_something_infinite_is_not_finite) {
    EXPECT_FALSE(std::isfinite(norm(Vec<2>{{std::numeric_limits<double>::infinity(), 1}})));
}

TEST(Vec, unit_has_length_one_at_every_scale) {
    for (int e = -1000; e <= 1000; e += 25) {
        const Vec<3> u = unit(scaled(Vec<3>{{1, -2, 3}}, e));
        EXPECT_NEAR(norm(u), 1, 4e-16) << "exponent " << e;
        EXPECT_EQ(u, unit(Vec<3>{{1, -2, 3}})) << "exponent " << e;
    }
    EXPECT_EQ(unit(Vec<3>{}), Vec<3>{});
}

TEST(Vec, finite_means_every_coordinate) {
    EXPECT_TRUE(is_finite(Vec<3>{{kMax, -kMax, 0}}));
    EXPECT_FALSE(is_finite(Vec<3>{{0, std::numeric_limits<double>::quiet_NaN(), 0}}));
    EXPECT_FALSE(is_finite(Vec<2>{{0, -std::numeric_limits<double>::infinity()}}));
}

TEST(Vec, cross_is_orthogonal_and_antisymmetric) {
    const Vec<3> a{{1, 2, 3}}, b{{-4, 5, 7}};
    EXPECT_EQ(dot(cross(a, b), a), 0);
    EXPECT_EQ(dot(cross(a, b), b), 0);
    EXPECT_EQ(cross(a, b), -cross(b, a));
    EXPECT_EQ(cross(Vec<2>{{1, 0}}, Vec<2>{{0, 1}}), 1);
}

TEST(Vec, largest_coordinate_ignores_the_sign) {
    EXPECT_EQ(max_abs(Vec<3>{{1, -7, 3}}), 7);
    EXPECT_EQ(max_abs(Vec<3>{}), 0);
}

TEST(Hom, projection_undoes_weighting) {
    const Vec<3> x{{1, -2, 0.5}};
    for (const double w : {0.25, 1.0, 2.0, -4.0}) {
        EXPECT_EQ(project(weighted(x, w)), x);
        EXPECT_EQ(weighted(x, w).weight(), w);
    }
    EXPECT_EQ(project(x), x);
    EXPECT_EQ(Space<Vec<3>>::lift(x, 5), x);
}

TEST(Hom, does_not_mix_with_points) {
    static_assert(!std::is_convertible_v<Hom<2>, Vec<3>> && !std::is_convertible_v<Vec<3>, Hom<2>>);
    static_assert(sizeof(Hom<2>) == sizeof(Vec<3>));
    static_assert(Space<Hom<3>>::kRational && !Space<Vec<3>>::kRational);
}

}  // namespace
}  // namespace freiform
