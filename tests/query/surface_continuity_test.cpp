#include "support/bezier.hpp"

#include <freiform/query/surface_continuity.hpp>
#include <freiform/query/surface_curvature.hpp>

#include <gtest/gtest.h>
#include <numbers>

namespace freiform {
namespace {

using test::must;
using test::Random;

constexpr SurfaceEdge kU0{0, End::start}, kU1{0, End::end}, kV0{1, End::start}, kV1{1, End::end};

template <class P>
Surface<P> patch(int p, int q, std::vector<P> b, Interval u = {0, 1}, Interval v = {0, 1}) {
    return must(Surface<P>::make({must(BSplineBasis::bezier(p, u)), must(BSplineBasis::bezier(q, v))},
                                 Net<2, P>({p + 1, q + 1}, std::move(b))));
}
template <class P>
Surface<P> random_patch(Random& random, int p, int q, Interval u = {0, 1}, Interval v = {0, 1}) {
    std::vector<P> b;
    for (int i = 0; i <= p; ++i)
        for (int j = 0; j <= q; ++j) {
            const Vec<3> x{{3.0 * i / p + random.real(-0.2, 0.2), 3.0 * j / q + random.real(-0.2, 0.2),
                            random.real(-1, 1)}};
            b.push_back(Space<P>::lift(x, random.real(0.8, 1.25)));
        }
    return patch<P>(p, q, std::move(b), u, v);
}
template <class P>
Surface<P> transposed(const Surface<P>& s) {
    const auto [n, m] = s.net().extent();
    Net<2, P> net({m, n});
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < m; ++j) net.view()({j, i}) = s.net().view()({i, j});
    return must(Surface<P>::make({s.basis(1), s.basis(0)}, std::move(net)));
}

// With other coefficients: f changes the net.
template <class P, class F>
Surface<P> changed(const Surface<P>& s, F&& f) {
    Net<2, P> net = s.net();
    f(net);
    return must(Surface<P>::make(s.bases(), std::move(net)));
}

// The graph of z = f over a rectangle, as exact bicubic.
template <class F>
Surface<Vec<3>> plane(double x0, double x1, F&& z) {
    std::vector<Vec<3>> b;
    for (int i = 0; i <= 1; ++i)
        for (int j = 0; j <= 1; ++j) b.push_back({{i ? x1 : x0, double(j), z(i, j)}});
    return patch<Vec<3>>(1, 1, b);
}

template <class P>
class Halves : public testing::Test {};
using Kinds = testing::Types<Vec<3>, Hom<3>>;
TYPED_TEST_SUITE(Halves, Kinds);

// One polynomial, cut: everything is continuous, whichever edges and directions the halves have.
TYPED_TEST(Halves, meet_with_every_order_in_all_orientations) {
    Random random(3);
    for (int p = 1; p <= 4; ++p)
        for (int q = 1; q <= 3; ++q) {
            const auto whole = random_patch<TypeParam>(random, p, q, {0, 3}, {1, 2});
            const auto a = must(restrict_to(whole, 0, {0, 1.25})), b = must(restrict_to(whole, 0, {1.25, 3}));
            ContinuityOptions options;
            options.roundings = 16;
            const auto j = must(joint(a, kU1, b, kU0, false, options));
            EXPECT_EQ(j.c_order, 3) << p << q;
            EXPECT_EQ(j.g_order, 2) << p << q;
            ASSERT_EQ(j.g.size(), 3u);
            EXPECT_LT(j.g[0].bound, 1e-13);
            EXPECT_LT(j.g[1].bound, 1e-11);
            EXPECT_LT(j.g[2].bound, 1e-9);
            EXPECT_FALSE(j.opposed);
            EXPECT_TRUE(j.singular.empty());
            const auto turned = must(joint(a, kU1, reverse(b, 1), kU0, true, options));
            EXPECT_EQ(turned.c_order, 3);
            EXPECT_EQ(turned.g_order, 2);
            const auto swapped = must(joint(transposed(a), kV1, reverse(b, 0), kU1, false, options));
            EXPECT_EQ(swapped.c_order, 3);
            EXPECT_EQ(swapped.g_order, 2);
        }
}

TYPED_TEST(Halves, meet_so_where_the_neighbour_is_refined_and_of_higher_degree) {
    Random random(4);
    const auto whole = random_patch<TypeParam>(random, 3, 3, {0, 2}, {0, 1});
    const auto a = must(restrict_to(whole, 0, {0, 1}));
    auto b = must(elevate(must(restrict_to(whole, 0, {1, 2})), 1, 2));
    const std::vector<double> knots{0.3, 0.3, 0.7};
    b = must(insert_knots(b, 1, knots));
    auto c = must(insert_knots(a, 1, std::vector<double>{0.1, 0.3, 0.55}));
    ContinuityOptions options;
    options.roundings = 32;
    const auto j = must(joint(c, kU1, b, kU0, false, options));
    EXPECT_EQ(j.c_order, 3);
    EXPECT_EQ(j.g_order, 2);
    EXPECT_LT(j.g[2].bound, 1e-9);
}

TEST(R31, a_fold_is_an_angle_and_a_surface_that_turns_back_has_the_angle_pi) {
    const auto flat = plane(0, 1, [](int, int) { return 0.0; });
    const auto up = plane(1, 2, [](int i, int) { return double(i); });
    const auto j = must(joint(flat, kU1, up, kU0));
    EXPECT_EQ(j.g_order, 0);
    EXPECT_EQ(j.c_order, 0);
    EXPECT_NEAR(j.g[1].size, std::numbers::pi / 4, j.g[1].bound + 1e-15);
    EXPECT_LT(j.g[1].bound, 1e-3);
    EXPECT_EQ(j.g.size(), 2u);
    EXPECT_NEAR(j.c[1].size, 1, 1e-12);
    const auto back = must(joint(flat, kU1, plane(1, 0.25, [](int, int) { return 0.0; }), kU0));
    EXPECT_TRUE(back.opposed);
    EXPECT_EQ(back.g_order, 0);
    EXPECT_NEAR(back.g[1].size, std::numbers::pi, 1e-12);
    const auto apart =
        must(joint(flat, kU1, plane(1, 2, [](int i, int k) { return 0.5 * (1 - i) * k; }), kU0));
    EXPECT_EQ(apart.g_order, -1);
    EXPECT_EQ(apart.c_order, -1);
    EXPECT_NEAR(apart.first_c_jump()->size, 0.5, 1e-12);
    EXPECT_DOUBLE_EQ(apart.first_c_jump()->at, 1);
}

TEST(R31, the_angle_of_a_twisted_neighbour_is_found_where_it_is_largest) {
    // z = (x - 1) f(y), f = 4 y (1 - y): the slope across is f, largest 1 in the middle.
    const auto flat = plane(0, 1, [](int, int) { return 0.0; });
    const auto bump = patch<Vec<3>>(
        1, 2, {{{1, 0, 0}}, {{1, 0.5, 0}}, {{1, 1, 0}}, {{2, 0, 0}}, {{2, 0.5, 2}}, {{2, 1, 0}}});
    const auto j = must(joint(flat, kU1, bump, kU0));
    EXPECT_NEAR(j.g[1].size, std::numbers::pi / 4, j.g[1].bound);
    EXPECT_LT(j.g[1].bound, 1e-3);
    EXPECT_NEAR(j.g[1].at, 0.5, 0.05);
    // The tangent of an eighth is allowed: G1 by the option, and by the distance that it is worth.
    ContinuityOptions options;
    options.angle = 0.786;
    EXPECT_EQ(must(joint(flat, kU1, bump, kU0, false, options)).g_order >= 1, true);
    options.angle = 0.783;
    EXPECT_EQ(must(joint(flat, kU1, bump, kU0, false, options)).g_order, 0);
}

TEST(R31, the_jump_of_curvature_of_two_cylinders) {
    // Quarter cylinder of radius 1, then radius 2, tangent along x = 1, z = 0; weights and speeds differ.
    const double s = std::sqrt(0.5);
    const auto quarter = [&](double r, int side, double speed) {
        // (x, z): from (1 - side r, ..) round the centre (1 - r, 0).
        const std::array<Vec<2>, 3> arc{{{{1, 0}}, {{1, side * r}}, {{1 - r, side * r}}}};
        std::vector<Hom<3>> b;
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 2; ++j)
                b.push_back(weighted(Vec<3>{{arc[std::size_t(i)][0], 3.0 * j, arc[std::size_t(i)][1]}},
                                     std::pow(speed, i) * (i == 1 ? s : 1)));
        return patch<Hom<3>>(2, 1, b);
    };
    const auto same = must(joint(quarter(1, -1, 1), kU0, quarter(1, 1, 1.5), kU0));
    EXPECT_EQ(same.g_order, 2);
    EXPECT_EQ(same.c_order, 0);
    EXPECT_LT(same.g[2].bound, 1e-12);
    const auto other = must(joint(quarter(1, -1, 1), kU0, quarter(2, 1, 1.5), kU0));
    EXPECT_EQ(other.g_order, 1);
    EXPECT_NEAR(other.g[2].size, 0.5, other.g[2].bound);
    EXPECT_LT(other.g[2].bound, 1e-3);
}

// The slow twin: both jumps from curvatures and normals at many places.
TEST(R31, jumps_agree_with_samples_of_the_surfaces) {
    Random random(7);
    for (int round = 0; round < 12; ++round) {
        const auto a = random_patch<Hom<3>>(random, 3, 3);
        // A neighbour with the same tangent planes: B_u = (1 + t) A_u scaled, second derivatives free.
        const auto b = changed(random_patch<Hom<3>>(random, 3, 3), [&](Net<2, Hom<3>>& net) {
            for (int j = 0; j <= 3; ++j) {
                const Hom<3> end = a.net().view()({3, j}), before = a.net().view()({2, j});
                net.view()({0, j}) = end;
                net.view()({1, j}) = end + (round % 2 ? 0.5 : 1.0) * (end - before);
            }
        });
        ContinuityOptions options;
        options.roundings = 8;
        const auto j = must(joint(a, kU1, b, kU0, false, options));
        EXPECT_EQ(j.g_order, 1) << round;
        EXPECT_EQ(j.c_order, round % 2 ? 0 : 1);
        ASSERT_EQ(j.g.size(), 3u);
        double most = 0, jump = 0;
        for (int i = 0; i <= 400; ++i) {
            const double t = i / 400.0;
            const auto ca = must(surface_curvature(a, {1, t})), cb = must(surface_curvature(b, {0, t}));
            // With common tangent planes only the curvature across differs, so the mean does by half of it.
            most = std::max(most, 2 * std::abs(ca.mean.value - cb.mean.value));
            jump = std::max(jump, norm(a.jet<1>({1, t})(1, 0) - b.jet<1>({0, t})(1, 0)));
        }
        EXPECT_LE(most, (j.g[2].size + j.g[2].bound) * (1 + 1e-9));
        EXPECT_GE(most, j.g[2].size - j.g[2].bound - 1e-3 * most);
        EXPECT_LT(j.g[2].bound, 2e-3 * j.g[2].size);
        if (round % 2) {
            EXPECT_LE(jump, (j.c[1].size + j.c[1].bound) * (1 + 1e-12));
            EXPECT_GE(jump, (j.c[1].size - j.c[1].bound) * (1 - 1e-3));
        }
    }
}

TEST(R31, results_scale_with_powers_of_two) {
    Random random(9);
    const auto a = random_patch<Vec<3>>(random, 3, 2);
    const auto b = changed(random_patch<Vec<3>>(random, 3, 2), [&](Net<2, Vec<3>>& net) {
        for (int j = 0; j <= 2; ++j) {
            net.view()({0, j}) = a.net().view()({3, j});
            net.view()({1, j}) = 2.0 * a.net().view()({3, j}) - a.net().view()({2, j});
        }
    });
    const auto larger = [](Net<2, Vec<3>>& net) {
        for (Vec<3>& x : net.flat()) x *= 0x1p40;
    };
    const auto a2 = changed(a, larger), b2 = changed(b, larger);
    const auto one = must(joint(a, kU1, b, kU0)), two = must(joint(a2, kU1, b2, kU0));
    ASSERT_EQ(one.g.size(), 3u);
    EXPECT_EQ(two.g[0].bound, one.g[0].bound * 0x1p40);
    EXPECT_EQ(two.g[1].size, one.g[1].size);
    EXPECT_EQ(two.g[2].size, one.g[2].size * 0x1p-40);
    EXPECT_EQ(two.c[2].size, one.c[2].size * 0x1p40);
}

TEST(R31, a_pole_is_set_aside_and_named) {
    // An eighth of the sphere, twice: they meet along a meridian that ends in the pole.
    const double s = std::sqrt(0.5);
    const auto eighth = [&](bool second) {
        std::vector<Hom<3>> b;
        for (int i = 0; i < 3; ++i)
            for (int j = 0; j < 3; ++j) {
                const double x = i == 2 ? 0 : 1, y = i == 0 ? 0 : 1, r = j == 2 ? 0 : 1, z = j == 0 ? 0 : 1;
                const Vec<3> p = second ? Vec<3>{{-y * r, x * r, z}} : Vec<3>{{x * r, y * r, z}};
                b.push_back(weighted(p, (i == 1 ? s : 1) * (j == 1 ? s : 1)));
            }
        return patch<Hom<3>>(2, 2, b);
    };
    const auto j = must(joint(eighth(false), kU1, eighth(true), kU0));
    EXPECT_EQ(j.g_order, 2);
    ASSERT_EQ(j.singular.size(), 1u);
    EXPECT_DOUBLE_EQ(j.singular[0].hi, 1);
    EXPECT_GT(j.singular[0].lo, 0.99);
    EXPECT_LT(j.g[1].bound, 1e-6);
    // The other edge of the pole is a point: no normal anywhere.
    const auto pole = must(joint(eighth(false), kV1, eighth(true), kV1));
    EXPECT_EQ(pole.g.size(), 1u);
    EXPECT_EQ(pole.g_order, 0);
    ASSERT_EQ(pole.singular.size(), 1u);
    EXPECT_EQ(pole.singular[0], (Interval{0, 1}));
}

TEST(R31, knots_and_seams_of_one_surface) {
    Random random(12);
    std::vector<Vec<3>> b;
    for (int i = 0; i < 7; ++i)
        for (int j = 0; j < 3; ++j) b.push_back({{double(i), double(j), random.real(-1, 1)}});
    const auto basis = must(BSplineBasis::make(3, {0, 0, 0, 0, 1, 2, 2, 3, 3, 3, 3}));
    const auto s =
        must(Surface<Vec<3>>::make({basis, must(BSplineBasis::bezier(2))}, Net<2, Vec<3>>({7, 3}, b)));
    const auto lines = must(continuity(s, 0));
    ASSERT_EQ(lines.size(), 2u);
    EXPECT_EQ(lines[0].at, 1);
    EXPECT_EQ(lines[0].joint.c_order, 2);
    EXPECT_EQ(lines[0].joint.g_order, 2);
    EXPECT_EQ(lines[1].multiplicity, 2);
    EXPECT_EQ(lines[1].joint.c_order, 1);
    EXPECT_EQ(lines[1].joint.g_order, 1);
    // A tube, closed by its basis.
    std::vector<Vec<3>> ring;
    for (int i = 0; i < 6; ++i)
        for (int j = 0; j < 2; ++j) ring.push_back({{std::cos(double(i)), std::sin(double(i)), double(j)}});
    const auto tube = must(Surface<Vec<3>>::make(
        {must(BSplineBasis::periodic(3, {0, 1, 2, 3, 4, 5, 6})), must(BSplineBasis::bezier(1))},
        Net<2, Vec<3>>({6, 2}, ring)));
    const auto seams = must(continuity(tube, 0));
    ASSERT_EQ(seams.size(), 6u);
    EXPECT_TRUE(seams.back().seam);
    for (const auto& l : seams) EXPECT_EQ(l.joint.c_order, 2);
    EXPECT_EQ(arriving(tube, kU0, {}).error().kind, RefusalKind::no_answer);
}

TEST(R31, meetings_of_a_list_of_surfaces_are_found_with_their_edges) {
    Random random(5);
    const auto whole = random_patch<Vec<3>>(random, 3, 3, {0, 2}, {0, 2});
    const auto left = must(restrict_to(whole, 0, {0, 1})), right = must(restrict_to(whole, 0, {1, 2}));
    const auto far = random_patch<Hom<3>>(random, 1, 1);
    const std::vector<SurfaceEdges> all{edges_of(transposed(reverse(right, 1))), edges_of(far),
                                        edges_of(left)};
    const auto found = must(joints(all, 1e-9));
    ASSERT_EQ(found.size(), 1u);
    const SurfaceMeeting& m = found[0].meeting;
    EXPECT_EQ(m.first, 0u);
    EXPECT_EQ(m.second, 2u);
    EXPECT_EQ(m.first_edge, kV0);
    EXPECT_EQ(m.second_edge, kU1);
    EXPECT_TRUE(m.against);
    EXPECT_EQ(found[0].joint.g_order, 2);
    EXPECT_EQ(joints(all, 1, {}, 0).error().kind, RefusalKind::limit);
}

TEST(R31, options_and_edges_that_make_no_sense_are_refused) {
    const auto flat = plane(0, 1, [](int, int) { return 0.0; });
    ContinuityOptions options;
    options.angle = -1;
    EXPECT_EQ(joint(flat, kU1, flat, kU0, false, options).error().where, "angle");
    EXPECT_EQ(joint(flat, SurfaceEdge{2, End::end}, flat, kU0).error().where, "first.edge.axis");
}

}  // namespace
}  // namespace freiform
