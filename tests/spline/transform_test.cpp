#include "support/random.hpp"
#include "support/reference.hpp"

#include <freiform/spline/transform.hpp>

#include <gtest/gtest.h>

namespace freiform {
namespace {

using test::must;
using test::Random;
using test::Rational;

template <std::size_t R, std::size_t C>
std::vector<Rational> times(const std::array<std::array<double, C>, R>& m, const std::vector<Rational>& x) {
    std::vector<Rational> y(R, Rational(0));
    for (std::size_t i = 0; i < R; ++i)
        for (std::size_t j = 0; j < C; ++j) y[i] += Rational(m[i][j]) * x[j];
    return y;
}
double gap(const std::vector<Rational>& a, const std::vector<Rational>& b) {
    Rational sum = 0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
    return std::sqrt(sum.convert_to<double>());
}
std::vector<Rational> projected(std::vector<Rational> h) {
    const Rational w = h.back();
    h.pop_back();
    for (Rational& x : h) x /= w;
    return h;
}

// Row R14, literally: the perspective projection of the control points alone gives the projected curve.
TEST(R14, perspective_of_the_control_points_is_perspective_of_the_curve) {
    const Vec<3> eye{{0, 0, 4}}, origin{{0, 0, 0}};
    const auto map = must(perspective(eye, origin, {{1, 0, 0}}, {{0, 1, 0}}));
    Random random(3);
    const auto curve = test::random_patch<1, Hom<3>>(random, 4, {});
    const auto picture = must(transform(curve, map));
    ASSERT_EQ(picture.patch.net().extent(), curve.net().extent());
    for (std::size_t i = 0; i < curve.net().flat().size(); ++i) {
        const Hom<3>& h = curve.net().flat()[i];  // (X, Y, Z, W) -> (4 X, 4 Y, 4 W - Z)
        const Vec<2> p = project(picture.patch.net().flat()[i]);
        EXPECT_NEAR(p[0], 4 * h[0] / (4 * h[3] - h[2]), 1e-14);
        EXPECT_NEAR(p[1], 4 * h[1] / (4 * h[3] - h[2]), 1e-14);
    }
    for (double t : test::parameters(random, curve.basis(), 20)) {
        const Vec<3> x = curve(t);
        const double s = 4 / (4 - x[2]);
        EXPECT_NEAR(picture.patch(t)[0], s * x[0], 1e-14);
        EXPECT_NEAR(picture.patch(t)[1], s * x[1], 1e-14);
    }
}

TEST(Transform, projective_images_stay_within_their_bound) {
    Random random(4);
    int inserted = 0, refused = 0;
    for (int k = 0; k < 60; ++k) {
        const auto s =
            test::random_patch<1, Hom<3>>(random, 4, {k % 2 ? test::Ends::closed : test::Ends::clamped});
        Projectivity<3> map;
        for (auto& row : map.m)
            for (double& x : row) x = random.real(-1, 1);
        map.m[3][3] = random.real(0.5, 2);
        const auto image = transform(s, map);
        if (!image) {
            ++refused;
            EXPECT_EQ(image.error().where, "weights");
            continue;
        }
        inserted += image->patch.net().extent() != s.net().extent();
        double worst = 0;
        for (double u : test::parameters(random, s.basis(), 2))
            worst = std::max(worst, gap(projected(times(map.m, test::homogeneous<Rational, 1>(s, u, {0}))),
                                        test::value_of<Rational>(image->patch, u)));
        EXPECT_LE(worst, image->bound);
        EXPECT_LT(image->bound, 1e-10);
    }
    EXPECT_GT(inserted, 0);
    EXPECT_GT(refused, 2);
    EXPECT_LT(refused, 50);
}

TEST(Transform, affine_images_stay_within_their_bound) {
    Random random(5);
    Affinity<2, 3> map{{{{0.1, -2, 0.7}, {3, 0.3, 1e-3}}}, {{100, -0.1}}};
    const auto check = [&](const auto& s) {
        const auto image = must(transform(s, map));
        EXPECT_EQ(weights(image.patch), weights(s));
        for (const auto& u : test::parameters(random, s, 10)) {
            const auto x = test::value_of<Rational>(s, u);
            std::vector<Rational> y;
            for (std::size_t i = 0; i < 2; ++i) {
                Rational sum = map.offset[int(i)];
                for (std::size_t j = 0; j < 3; ++j) sum += Rational(map.linear[i][j]) * x[j];
                y.push_back(sum);
            }
            EXPECT_LE(gap(y, test::value_of<Rational>(image.patch, u)), image.bound);
        }
        EXPECT_GT(image.bound, 0);
        EXPECT_LT(image.bound, 1e-12);
    };
    check(test::random_patch<1, Vec<3>>(random, 4, {}));
    check(test::random_patch<2, Hom<3>>(random, 2, {test::Ends::clamped, 2}));
    check(test::random_patch<3, Hom<3>>(random, 1, {test::Ends::clamped, 1}));
}

TEST(Transform, refuses_where_a_curve_passes_the_plane_of_the_eye) {
    const auto map = must(perspective({{0, 0, 4}}, {{0, 0, 0}}, {{1, 0, 0}}, {{0, 1, 0}}));
    const auto line = [](double z0, double z1) {
        const auto b = must(BSplineBasis::bezier(1));
        return to_rational(must(Curve<Vec<3>>::make({b}, Net<1, Vec<3>>({2}, {{{1, 1, z0}}, {{1, 1, z1}}}))));
    };
    EXPECT_TRUE(transform(line(0, 3.9), map));
    EXPECT_TRUE(transform(line(5, 7), map));  // all behind the eye
    const auto through = transform(line(2, 10), map);
    ASSERT_FALSE(through);
    EXPECT_NE(through.error().message.find("between the parameters 0.24999999"), std::string::npos)
        << through.error().message;
    EXPECT_EQ(perspective({{0, 0, 4}}, {{0, 0, 4}}, {{1, 0, 0}}, {{0, 1, 0}}).error().where, "eye");
    EXPECT_EQ(perspective({{0, 0, 4}}, {{0, 0, 0}}, {{1, 2, 0}}, {{2, 4, 0}}).error().where, "up");
    EXPECT_EQ(perspective({{0, 0, 4}}, {{0, 0, 0}}, {{0, 0, 0}}, {{2, 4, 0}}).error().where, "across");
    EXPECT_EQ(perspective({{0, std::nan(""), 4}}, {{0, 0, 0}}, {{1, 0, 0}}, {{2, 4, 0}}).error().kind,
              RefusalKind::nonfinite);
    Projectivity<3> infinite{};
    infinite.m[1][2] = HUGE_VAL;
    EXPECT_EQ(transform(line(0, 1), infinite).error().where, "m[1][2]");
}

TEST(Transform, perspective_meets_planes_in_any_position) {
    Random random(6);
    const auto any = [&](double e) {
        return Vec<3>{{random.real(-e, e), random.real(-e, e), random.real(-e, e)}};
    };
    for (int k = 0; k < 50; ++k) {
        const Vec<3> eye = any(4), origin = any(2), across = any(1), up = any(1e-3);
        const auto map = perspective(eye, origin, across, up);
        ASSERT_TRUE(map);
        const double a = random.real(-2, 2), b = random.real(-2, 2), s = random.real(0.1, 0.9);
        const Vec<3> on_plane = origin + a * across + b * up, x = eye + s * (on_plane - eye);
        const auto h = times(map->m, {Rational(x[0]), Rational(x[1]), Rational(x[2]), Rational(1)});
        EXPECT_GT(h[2], 0);
        EXPECT_NEAR(Rational(h[0] / h[2]).convert_to<double>(), a, 1e-8);
        EXPECT_NEAR(Rational(h[1] / h[2]).convert_to<double>(), b, 1e-5);
    }
}

}  // namespace
}  // namespace freiform
