#include "support/random.hpp"

#include <freiform/fit/bicubic.hpp>
#include <freiform/query/surface_continuity.hpp>
#include <freiform/spline/bezier.hpp>

#include <gtest/gtest.h>

namespace freiform {
namespace {

using test::must;
using test::Random;

constexpr Twists kAll[] = {Twists::tensor, Twists::zero, Twists::adini, Twists::bessel};
const std::vector<double> kUniform{0, 1, 2, 3, 4, 5, 6}, kU{0, 0.5, 2, 3, 3.75, 5, 5.5},
    kV{-1, 0, 0.25, 2, 4};

Net<2, Vec<3>> hills(Random& random, int n, int m) {
    Net<2, Vec<3>> net({n, m});
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < m; ++j) net.view()({i, j}) = {{double(i), double(j), random.real(-1, 1)}};
    return net;
}

// R24: 7 x 7 points, 36 patches, R10 along both directions.
TEST(R24, seven_by_seven_points_make_36_patches_that_join_with_c1) {
    Random random(1);
    const auto grid = hills(random, 7, 7);
    for (const Twists kind : kAll) {
        const auto s = must(bicubic_through<3>(grid, {kUniform, kUniform}, {}, kind));
        const auto pieces = decompose(s);
        EXPECT_EQ(pieces.extent(), (Index<2>{6, 6}));
        for (int i = 0; i < 7; ++i)
            for (int j = 0; j < 7; ++j) EXPECT_EQ(s(double(i), double(j)), grid.view()({i, j}));
        ContinuityOptions options;
        options.roundings = 16;
        for (int axis : {0, 1}) {
            const auto lines = must(continuity(s, axis, options));
            ASSERT_EQ(lines.size(), 5u);
            for (const LineContinuity& l : lines) {
                EXPECT_EQ(l.joint.c_order, 1) << name_of(kind);
                EXPECT_EQ(l.joint.g_order, 1);
            }
        }
        // And as 36 patches of their own.
        std::vector<SurfaceEdges> all;
        for (int i = 0; i < 6; ++i)
            for (int j = 0; j < 6; ++j) {
                const auto a = must(restrict_to(s, 0, {double(i), i + 1.0}));
                all.push_back(edges_of(must(restrict_to(a, 1, {double(j), j + 1.0})), options));
            }
        const auto found = must(joints(all, 1e-9, options));
        EXPECT_EQ(found.size(), 60u);  // 2 x 5 x 6 inner edges
        for (const SurfaceJoint& j : found) EXPECT_EQ(j.joint.c_order, 1);
    }
}

TEST(R24, the_rules_of_the_row_hold_along_both_directions) {
    Random random(2);
    const auto grid = hills(random, 7, 7);
    const auto s = must(bicubic_through<3>(grid, {kUniform, kUniform}));
    const auto b = s.net().view();
    const auto q = grid.view();
    for (int i = 1; i < 6; ++i)
        for (int j = 0; j < 7; ++j) {
            const Vec<3> sixth = (1 / 6.0) * (q({i + 1, j}) - q({i - 1, j}));
            EXPECT_LT(norm(b({3 * i + 1, 3 * j}) - (q({i, j}) + sixth)), 1e-14);
            EXPECT_LT(norm(b({3 * i - 1, 3 * j}) - (q({i, j}) - sixth)), 1e-14);
            const Vec<3> other = (1 / 6.0) * (q({j, i + 1}) - q({j, i - 1}));
            EXPECT_LT(norm(b({3 * j, 3 * i + 1}) - (q({j, i}) + other)), 1e-14);
        }
    for (int j = 0; j < 19; ++j) {
        EXPECT_LT(norm(b({1, j}) - 0.5 * (b({0, j}) + b({2, j}))), 1e-14);
        EXPECT_LT(norm(b({j, 17}) - 0.5 * (b({j, 16}) + b({j, 18}))), 1e-14);
    }
    // The twist of the tensor product is what the scheme makes of every line.
    const auto twin = must(catmull_rom<2, 3>(grid, {kUniform, kUniform}));
    for (std::size_t i = 0; i < twin.net().flat().size(); ++i)
        EXPECT_LT(norm(s.net().flat()[i] - twin.net().flat()[i]), 1e-14);
}

TEST(R24, separable_data_give_the_product_of_the_curves) {
    Random random(3);
    for (const std::array<bool, 2> closed : {std::array{false, false}, {true, false}, {true, true}}) {
        const std::size_t n = kU.size() - closed[0], m = kV.size() - closed[1];
        std::vector<Vec<1>> f(n), g(m);
        for (auto* list : {&f, &g})
            for (Vec<1>& x : *list) x[0] = random.real(-1, 1);
        Net<2, Vec<1>> grid({int(n), int(m)});
        for (std::size_t i = 0; i < n; ++i)
            for (std::size_t j = 0; j < m; ++j) grid.view()({int(i), int(j)})[0] = f[i][0] * g[j][0];
        const auto s = must(bicubic_through<1>(grid, {kU, kV}, closed));
        const auto a = must(catmull_rom<1, 1>(Net<1, Vec<1>>({int(n)}, f), {kU}, {closed[0]}));
        const auto b = must(catmull_rom<1, 1>(Net<1, Vec<1>>({int(m)}, g), {kV}, {closed[1]}));
        EXPECT_EQ(s.basis(0).is_closed(), closed[0]);
        for (int k = 0; k < 200; ++k) {
            const double u = random.real(0, 5.5), v = random.real(-1, 4);
            EXPECT_NEAR(s(u, v)[0], a(u)[0] * b(v)[0], 1e-13);
        }
        ContinuityOptions options;
        options.roundings = 64;
        for (int axis : {0, 1})
            for (const auto& l : must(knot_lines(s, axis, options))) EXPECT_GE(l.c_order, 1);
    }
}

// Derivatives of a function at the grid, and what comes of them with each kind of twist.
template <class F, class U, class V>
double largest_error(F&& f, U&& fu, V&& fv, Twists kind) {
    const int n = int(kU.size()), m = int(kV.size());
    Net<2, Vec<1>> q({n, m}), du({n, m}), dv({n, m});
    each_index(q.extent(), [&](const Index<2>& at) {
        const double u = kU[std::size_t(at[0])], v = kV[std::size_t(at[1])];
        q.view()(at)[0] = f(u, v), du.view()(at)[0] = fu(u, v), dv.view()(at)[0] = fv(u, v);
    });
    const GridDerivatives<1> d{du, dv};
    const auto s = must(bicubic_through<1>(q, d, must(twists<1>(q, d, {kU, kV}, {}, kind)), {kU, kV}));
    double most = 0;
    for (double u = 0; u <= 5.5; u += 0.11)
        for (double v = -1; v <= 4; v += 0.1) most = std::max(most, std::abs(s(u, v)[0] - f(u, v)));
    return most;
}

TEST(R24, adini_reproduces_bicubic_coons_patches) {
    const auto f = [](double u, double v) {
        return u * u * u - 2 * u * u * u * v + v * v * v * (1 - u) + u * v;
    };
    const auto fu = [](double u, double v) { return 3 * u * u - 6 * u * u * v - v * v * v + v; };
    const auto fv = [](double u, double v) { return -2 * u * u * u + 3 * v * v * (1 - u) + u; };
    EXPECT_LT(largest_error(f, fu, fv, Twists::adini), 1e-11);
    EXPECT_GT(largest_error(f, fu, fv, Twists::bessel), 0.1);
    EXPECT_GT(largest_error(f, fu, fv, Twists::zero), 0.1);
}

TEST(R24, bessel_reproduces_biquadratics) {
    const auto f = [](double u, double v) { return (1 + u - 0.5 * u * u) * (2 - v + v * v); };
    const auto fu = [](double u, double v) { return (1 - u) * (2 - v + v * v); };
    const auto fv = [](double u, double v) { return (1 + u - 0.5 * u * u) * (2 * v - 1); };
    EXPECT_LT(largest_error(f, fu, fv, Twists::bessel), 1e-11);
    EXPECT_GT(largest_error(f, fu, fv, Twists::adini), 0.01);
    EXPECT_GT(largest_error(f, fu, fv, Twists::zero), 0.1);
}

TEST(R24, twists_zero_have_no_mixed_derivative_at_the_points) {
    Random random(5);
    const auto s = must(bicubic_through<3>(hills(random, 7, 5), {kU, kV}, {}, Twists::zero));
    for (const double u : kU)
        for (const double v : kV) EXPECT_LT(norm(s.jet<2>({u, v})(1, 1)), 1e-12);
}

TEST(R24, what_does_not_fit_is_refused_by_name) {
    Random random(6);
    const auto grid = hills(random, 7, 5);
    EXPECT_EQ(bicubic_through<3>(grid, {kU, kU}).error().where, "axes[1].at");
    auto d = must(grid_derivatives<3>(grid, {kU, kV}));
    const auto t = must(twists<3>(grid, d, {kU, kV}, {}, Twists::adini));
    EXPECT_EQ(bicubic_through<3>(grid, d, hills(random, 5, 7), {kU, kV}).error().where, "twists");
    d.dv.flat()[3][1] = NAN;
    EXPECT_EQ(bicubic_through<3>(grid, d, t, {kU, kV}).error().where, "dv[3]");
    const std::vector<double> back{0, 1, 1, 2, 3};
    EXPECT_EQ(bicubic_through<3>(grid, {kU, back}).error().where, "axes[1].at[2]");
}

}  // namespace
}  // namespace freiform
