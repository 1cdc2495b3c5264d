#include <freiform/make/image_curve.hpp>

#include <gtest/gtest.h>
#include <numbers>
#include <random.hpp>
#include <refusal.hpp>

namespace freiform {
namespace {

using test::Random;

template <class P>
P coefficient(Random& random, double x, double y, double z) {
    if constexpr (Space<P>::kRational)
        return weighted(Vec<3>{{x, y, z}}, random.real(0.3, 3));
    else
        return {{x, y, z}};
}

template <class P>
Surface<P> wavy(Random& random, int p, int q) {
    const auto basis = [&](int degree) {
        std::vector<double> knots(std::size_t(degree) + 1, -1.0);
        knots.insert(knots.end(), {0.1, 0.5});
        if (degree > 1) knots.insert(knots.end(), {0.5, 0.75});
        knots.insert(knots.end(), std::size_t(degree) + 1, 2.0);
        return test::must(BSplineBasis::make(degree, std::move(knots)));
    };
    const BSplineBasis u = basis(p), v = basis(q);
    std::vector<P> net;
    for (int i = 0; i < u.size(); ++i)
        for (int j = 0; j < v.size(); ++j) net.push_back(coefficient<P>(random, i, j, random.real(-1, 1)));
    return Surface<P>::trusted({u, v}, Net<2, P>({u.size(), v.size()}, std::move(net)));
}

// Same points as the surface has at the points of the curve, whatever is crossed on the way.
void expect_image(const SurfaceGeometry& s, const CurveGeometry<2>& c, int most_degree) {
    const auto image = image_curve(s, c);
    ASSERT_TRUE(image) << image.error().message;
    const Interval on = domain(c)[0];
    EXPECT_EQ(domain(*image)[0], on);
    std::visit(
        [&](const auto& x) {
            if constexpr (requires { x.basis(); }) {
                EXPECT_LE(x.basis().degree(), most_degree);
            }
        },
        *image);
    for (int i = 0; i <= 200; ++i) {
        const double t = on.lo + i * on.length() / 200;
        const Vec<2> uv = clamped(jet<0>(c, t).value(), limits(s));
        EXPECT_LE(norm(jet<0>(*image, t).value() - jet<0>(s, uv.c).value()), 1e-11) << "at " << t;
    }
}

TEST(ImageCurve, has_the_points_of_the_surface) {
    Random random(4);
    const CurveGeometry<2> cubic = test::must(Curve<Vec<2>>::make(
        {test::must(BSplineBasis::make(3, {0, 0, 0, 0, 0.7, 1, 1, 1, 1}))},
        Net<1, Vec<2>>({5}, {{{-0.9, -0.5}}, {{1.9, -0.9}}, {{1, 1.9}}, {{-0.5, 1.5}}, {{0.7, 0.3}}})));
    const CurveGeometry<2> circle = test::must(parameter_spline(
        Conic<2>{ConicKind::ellipse, {{0.5, 0.5}}, {{1.2, 0}}, {{0, 1.2}}}, {0, 2 * std::numbers::pi}));
    const CurveGeometry<2> along = test::must(parameter_spline(Line<2>{{{0.3, -1}}, {{0, 1}}}, {0, 3}));
    const CurveGeometry<2> on_knot = test::must(parameter_spline(Line<2>{{{0.5, -1}}, {{0, 1}}}, {0.25, 3}));
    expect_image(wavy<Vec<3>>(random, 3, 2), cubic, 15);
    expect_image(wavy<Hom<3>>(random, 2, 3), cubic, 15);
    expect_image(wavy<Vec<3>>(random, 3, 1), circle, 8);
    expect_image(wavy<Hom<3>>(random, 3, 3), circle, 12);
    expect_image(wavy<Hom<3>>(random, 3, 2), along, 2);
    expect_image(wavy<Vec<3>>(random, 2, 3), on_knot, 3);
}

TEST(ImageCurve, refuses_high_degrees_and_other_surfaces) {
    Random random(5);
    const CurveGeometry<2> cubic = test::must(Curve<Vec<2>>::make(
        {*BSplineBasis::bezier(3)}, Net<1, Vec<2>>({4}, {{{0, 0}}, {{1, 0}}, {{0, 1}}, {{0.7, 0.3}}})));
    test::expect_refusal(image_curve(wavy<Vec<3>>(random, 5, 5), cubic), RefusalKind::unsupported, "");
    test::expect_refusal(image_curve(Extrusion{Line<3>{{}, {{1, 0, 0}}}, {{0, 1, 0}}}, cubic),
                         RefusalKind::unsupported, "");
}

}  // namespace
}  // namespace freiform
