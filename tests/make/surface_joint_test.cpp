#include "support/random.hpp"

#include <freiform/make/surface_joint.hpp>
#include <freiform/query/surface_continuity.hpp>
#include <freiform/spline/bezier.hpp>

#include <gtest/gtest.h>

namespace freiform {
namespace {

using test::must;
using test::Random;

constexpr SurfaceEdge kU0{0, End::start}, kU1{0, End::end}, kV0{1, End::start}, kV1{1, End::end};

template <class P>
P random_point(Random& random, double x, double y) {
    const double weight = random.real(0.95, 1.05);  // first: compilers differ in the order of arguments
    return Space<P>::lift({{x + random.real(-0.2, 0.2), y + random.real(-0.2, 0.2), random.real(-1, 1)}},
                          weight);
}
template <class P>
Net<2, P> random_net(Random& random, int n, int m, double x0 = 0) {
    Net<2, P> net({n, m});
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < m; ++j) net.view()({i, j}) = random_point<P>(random, x0 + i, j);
    return net;
}
BSplineBasis cubic_with_knots() { return must(BSplineBasis::make(3, {0, 0, 0, 0, 0.5, 1.25, 2, 2, 2, 2})); }
template <class P>
Surface<P> random_surface(Random& random, const BSplineBasis& u, const BSplineBasis& v, double x0 = 0) {
    return must(Surface<P>::make({u, v}, random_net<P>(random, u.size(), v.size(), x0)));
}
ContinuityOptions roundings(double r) {
    ContinuityOptions o;
    o.roundings = r;
    return o;
}

template <class P>
class NextRow : public testing::Test {};
using Kinds = testing::Types<Vec<3>, Hom<3>>;
TYPED_TEST_SUITE(NextRow, Kinds);

TYPED_TEST(NextRow, joins_with_c_k_at_every_edge) {
    Random random(1);
    const auto u = must(BSplineBasis::bezier(3, {0, 2})), v = cubic_with_knots();
    const auto a = random_surface<TypeParam>(random, u, v);
    for (const SurfaceEdge e : {kU0, kU1, kV0, kV1})
        for (int k = 0; k <= 2; ++k) {
            const int columns = a.basis(1 - e.axis).size();
            const auto next = must(
                next_c(a, e, k, NextRows<TypeParam>{{0, 1}, random_net<TypeParam>(random, 2, columns, 3)}));
            EXPECT_EQ(next.basis(0).degree(), k + 2);
            const auto j = must(joint(a, e, next, kU0, false, roundings(4)));
            EXPECT_EQ(j.c_order, k) << e.axis << int(e.end);
            EXPECT_EQ(j.g_order, k);
            // What next_g does with the shape functions of C^k is the same.
            const auto same =
                must(next_g(a, e, ShapeFunctions::parametric(k),
                            NextRows<TypeParam>{{0, 1}, random_net<TypeParam>(random, 1, columns, 3)}));
            const auto twin = must(
                next_c(a, e, k, NextRows<TypeParam>{{0, 1}, random_net<TypeParam>(random, 1, columns, 3)}));
            for (int i = 0; i <= k; ++i)
                for (int c = 0; c < columns; ++c)
                    // The exact number may lie half-way between two doubles.
                    EXPECT_LE(max_abs(same.net().view()({i, c}) - twin.net().view()({i, c})),
                              0x1p-52 * max_abs(twin.net().view()({i, c})));
        }
}

// The formula of the curves: for cubics of equal length P5 = 2 P4 - P3, P6 = P2 + 4 (P4 - P3).
TEST(R31, rows_follow_the_formulas_of_the_curves) {
    Random random(2);
    const auto bezier = must(BSplineBasis::bezier(3));
    Net<2, Vec<3>> net({4, 4});
    for (Vec<3>& x : net.flat())
        for (int c = 0; c < 3; ++c) x[c] = random.integer(-50, 50);
    const auto a = must(Surface<Vec<3>>::make({bezier, bezier}, net));
    const auto b = must(next_c(a, kU1, 2, NextRows<Vec<3>>{{1, 2}, random_net<Vec<3>>(random, 1, 4)}));
    for (int j = 0; j < 4; ++j) {
        const auto p = [&](int i) { return net.view()({i - 1, j}); };
        EXPECT_EQ(b.net().view()({0, j}), p(4));
        EXPECT_EQ(b.net().view()({1, j}), 2.0 * p(4) - p(3));
        EXPECT_EQ(b.net().view()({2, j}), p(2) + 4.0 * (p(4) - p(3)));
    }
}

TYPED_TEST(NextRow, joins_with_g1_and_any_shape_functions) {
    Random random(3);
    const auto u = must(BSplineBasis::bezier(3)), v = cubic_with_knots();
    const auto a = random_surface<TypeParam>(random, u, v);
    struct Case {
        ShapeFunction across, along;
        int degree;
    };
    for (const Case& c : {Case{{0.5}, {}, 3},
                          {{2}, {0.3}, 3},
                          {{1}, {-0.5, 0.5}, 3},
                          {{1, 2}, {0.1}, 4},
                          {{1, 0.5, 2}, {0, 1, 0}, 5}}) {
        const ShapeFunctions shape{{c.across}, {c.along}, {}};
        const auto along = must(next_basis(a, kU1, shape));
        EXPECT_EQ(along.degree(), c.degree);
        const auto b = must(next_g(
            a, kU1, shape, NextRows<TypeParam>{{0, 1}, random_net<TypeParam>(random, 2, along.size(), 4)}));
        const auto j = must(joint(a, kU1, b, kU0, false, roundings(16)));
        EXPECT_EQ(j.g_order, 1) << c.degree;
        EXPECT_LT(j.g[1].bound, 1e-11);
        EXPECT_EQ(j.c_order, 0);
        // B_u = a1 A_u + b1 A_t, with the points' derivatives.
        for (const double x : {0.0, 0.2, 0.37, 0.8, 1.0}) {
            const auto of = [&](const ShapeFunction& f) {
                if (f.empty()) return 0.0;
                std::vector<double> w = f;
                keep_left(Fibre<double>{w.data(), int(w.size())}, x);
                return w.back();
            };
            const auto ja = a.template jet<1>({1, 2 * x}), jb = b.template jet<1>({0, 2 * x});
            EXPECT_LT(norm(jb(1, 0) - (of(c.across) * ja(1, 0) + of(c.along) * ja(0, 1))), 1e-12);
        }
    }
}

TYPED_TEST(NextRow, joins_with_g2_and_any_shape_functions) {
    Random random(4);
    const auto bezier = must(BSplineBasis::bezier(3));
    const auto a = random_surface<TypeParam>(random, bezier, bezier);
    for (const auto& shape : {ShapeFunctions{{{0.5}, {0.7}}, {{0.25}, {1}}, {}},
                              ShapeFunctions{{{1}, {0.5}}, {{0.2, -0.4}, {1, 2}}, {}},
                              ShapeFunctions{{{1, 2}, {0, 1, 3}}, {}, {}}}) {
        const auto along = must(next_basis(a, kV0, shape));
        const auto b = must(next_g(
            a, kV0, shape, NextRows<TypeParam>{{0, 0.5}, random_net<TypeParam>(random, 1, along.size(), 4)}));
        const auto j = must(joint(a, kV0, b, kU0, false, roundings(32)));
        EXPECT_EQ(j.g_order, 2) << along.degree();
        EXPECT_LT(j.g[2].bound, 1e-7);
        EXPECT_EQ(j.c_order, 0);
    }
}

TEST(R31, a_scale_changes_weights_and_no_point) {
    Random random(5);
    const auto bezier = must(BSplineBasis::bezier(2));
    const auto a = random_surface<Hom<3>>(random, bezier, bezier);
    const ShapeFunctions shape{{{1}}, {}, {{0.4, -0.3}}};
    const auto along = must(next_basis(a, kU1, shape));
    EXPECT_EQ(along.degree(), 3);
    const auto b =
        must(next_g(a, kU1, shape, NextRows<Hom<3>>{{0, 1}, random_net<Hom<3>>(random, 1, along.size(), 4)}));
    EXPECT_EQ(must(joint(a, kU1, b, kU0, false, roundings(16))).c_order, 1);
    ShapeFunctions down = shape;
    down.scale = {{-100}};
    const auto refused = next_g(a, kU1, down, NextRows<Hom<3>>{{0, 1}, random_net<Hom<3>>(random, 1, 3, 4)});
    ASSERT_FALSE(refused);
    EXPECT_EQ(refused.error().kind, RefusalKind::no_answer);
}

TYPED_TEST(NextRow, a_neighbour_is_made_to_join_and_keeps_its_other_rows) {
    Random random(6);
    const auto u = must(BSplineBasis::bezier(3)), v = cubic_with_knots();
    const auto a = random_surface<TypeParam>(random, u, v);
    const auto along = must(BSplineBasis::make(2, {0, 0, 0, 0.25, 0.7, 1, 1, 1}));
    const auto across = must(BSplineBasis::make(3, {0, 0, 0, 0, 1, 3, 3, 3, 3}));
    for (const bool at_end : {false, true})
        for (const bool against : {false, true})
            for (const auto& shape :
                 {ShapeFunctions::parametric(1), ShapeFunctions::parametric(2),
                  ShapeFunctions{{{0.5}, {0.1}}, {}, {}}, ShapeFunctions{{{1}}, {{0.2, 0.4}}, {}}}) {
                const auto b = random_surface<TypeParam>(random, along, across, 5);  // its edges on axis 1
                const SurfaceEdge e{1, at_end ? End::end : End::start};
                const auto c = must(rejoined(a, kU1, b, e, against, shape));
                const auto j = must(joint(a, kU1, c, e, against, roundings(64)));
                const int k = int(shape.across.size());
                EXPECT_EQ(j.g_order, k);
                EXPECT_EQ(j.c_order >= k, shape.along.empty() && shape.across[0][0] == 1);
                const auto other = must(joint(b, {1, at_end ? End::start : End::end}, c,
                                              {1, at_end ? End::start : End::end}, false, roundings(64)));
                EXPECT_EQ(other.c_order, 0);  // the far edge is where it was
            }
}

TEST(R31, rows_that_cannot_be_are_refused_by_name) {
    Random random(8);
    const auto u = must(BSplineBasis::bezier(3)), ring = must(BSplineBasis::periodic(3, {0, 1, 2, 3, 4, 5}));
    const auto a = random_surface<Vec<3>>(random, u, u), tube = random_surface<Vec<3>>(random, u, ring);
    const NextRows<Vec<3>> rows{{0, 1}, random_net<Vec<3>>(random, 1, 4)};
    EXPECT_EQ(next_g(a, kU1, {{{-1}}}, rows).error().where, "across[0]");
    EXPECT_EQ(next_g(a, kU1, {{{1}}, {{1}, {2}}}, rows).error().where, "along");
    EXPECT_EQ(next_g(a, kU1, {{{1}}, {}, {{1}}}, rows).error().where, "scale");
    EXPECT_EQ(next_g(a, kU1, {{{1, 2}}}, rows).error().where, "free");
    EXPECT_EQ(next_c(tube, kV1, 1, rows).error().kind, RefusalKind::no_answer);
    EXPECT_EQ(next_g(tube, kU1, {{{1}}, {{1}}}, rows).error().kind, RefusalKind::unsupported);
    const auto kink = must(BSplineBasis::make(3, {0, 0, 0, 0, 1, 1, 1, 2, 2, 2, 2}));
    EXPECT_EQ(next_g(random_surface<Vec<3>>(random, u, kink), kU1, {{{1}}, {{1}}}, rows).error().where,
              "knot 1");
    EXPECT_EQ(rejoined(a, kU1, random_surface<Vec<3>>(random, ring, u), kU0, false, {{{1}}}).error().where,
              "neighbour.edge");
    // C^k joins closed edges as well.
    const auto b = must(next_c(tube, kU1, 1, NextRows<Vec<3>>{{0, 1}, random_net<Vec<3>>(random, 1, 5)}));
    EXPECT_TRUE(b.basis(1).is_closed());
    EXPECT_EQ(must(joint(tube, kU1, b, kU0, false, roundings(8))).c_order, 1);
}

}  // namespace
}  // namespace freiform
