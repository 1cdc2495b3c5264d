#include "support/random.hpp"
#include "support/reference.hpp"
#include "support/triangle.hpp"

#include <freiform/make/triangle_joint.hpp>

#include <gtest/gtest.h>

namespace freiform {
namespace {

using test::must;
using test::Random;
using test::random_triangle;
using test::Rational;

template <class P>
std::vector<P> random_free(Random& random, int count) {
    std::vector<P> out;
    for (int i = 0; i < count; ++i) out.push_back(test::random_coefficient<P>(random, 1, 0, 0.2));
    return out;
}

// Barycentric coordinates of edge `e` at t, and the corner where it begins.
Param<2> on_edge(int edge, double t) {
    std::array<double, 3> b{};
    b[std::size_t((edge + 1) % 3)] = 1 - t, b[std::size_t((edge + 2) % 3)] = t;
    return {b[1], b[2]};
}
const Vec<2> kCorner[3] = {{{0, 0}}, {{1, 0}}, {{0, 1}}};

// Row R29: the neighbour's rows. All derivatives up to the order agree in the common plane of parameters.
template <class P>
void expect_smooth(Random& random, int edge, int order, int degree, int n) {
    auto s = random_triangle<P>(random, degree);
    if constexpr (Space<P>::kRational) {  // weights near 1, so that they stay positive
        std::vector<P> b;
        for (const P& p : s.coefficients()) b.push_back(weighted(project(p), 1 + 0.01 * project(p)[0]));
        s = must(SimplexPatch<2, P>::make(degree, b));
    }
    const Vec<2> x = kCorner[(edge + 1) % 3] + kCorner[(edge + 2) % 3] - 1.25 * kCorner[edge] +
                     0.25 * kCorner[(edge + 1) % 3];
    const auto joined =
        must(next_c(s, edge, order, {x[0], x[1]}, random_free<P>(random, (n - order) * (n - order + 1) / 2)));
    EXPECT_EQ(joined.patch.degree(), n);
    EXPECT_LT(joined.bound, 1e-11);
    // The exact plane of parameters: place of the new triangle's (u, v) in that of the given one.
    const Vec<2> b = kCorner[(edge + 2) % 3] - x, a = kCorner[(edge + 1) % 3] - x;
    for (const double t : {0.0, 0.3, 1.0}) {
        const auto mine = s.derivatives(on_edge(edge, t), order),
                   other = joined.patch.derivatives(on_edge(0, 1 - t), order);
        // Derivatives of the new one by its u and v are those of the given one along b and a.
        for (const auto& o : jet_orders<2>(order)) {
            std::vector<Vec<2>> along(std::size_t(o[0]), b);
            along.insert(along.end(), std::size_t(o[1]), a);
            const auto expected = derivative(s, on_edge(edge, t), std::span<const Vec<2>>(along));
            EXPECT_LT(test::distance(other[jet_slot(o)], expected), 1e-9 * (1 + norm(expected)))
                << edge << " " << order;
        }
        EXPECT_LT(test::distance(mine[0], other[0]), 1e-13);
    }
}

TEST(R29, the_next_triangle_joins_with_all_derivatives_up_to_the_order) {
    Random random(311);
    for (int edge = 0; edge < 3; ++edge)
        for (int order = 0; order <= 3; ++order) {
            expect_smooth<Vec<3>>(random, edge, order, 3, 3);
            expect_smooth<Vec<3>>(random, edge, order, 3, 5);
            expect_smooth<Hom<3>>(random, edge, order, 4, 4);
        }
}

TEST(R29, determined_rows_are_within_their_bound_of_exact_blossoms) {
    Random random(312);
    const auto s = random_triangle<Vec<3>>(random, 5);
    const Param<2> apex{0.75, 0.875};
    const auto joined = must(next_c(s, 0, 3, apex, random_free<Vec<3>>(random, 3)));
    auto net = test::exact_net(s);
    for (int r = 0; r <= 3; ++r) {
        for (int i = 0; i <= 5 - r; ++i)  // i times corner 2 (b), the others corner 3 (a) of the new one
            for (int c = 0; c < 3; ++c) {
                const auto& exact = net[SimplexPatch<2, Vec<1>>::slot(5 - r - i, i)][std::size_t(c)];
                EXPECT_LE(test::gap(joined.patch.coefficient(i, 5 - r - i)[c], exact), joined.bound);
            }
        net = test::exact_step(net, 5 - r, apex);
    }
    EXPECT_LT(joined.bound, 1e-13);
}

TEST(R29, the_next_triangle_has_the_same_tangent_planes_for_all_free_parameters) {
    Random random(313);
    for (int edge = 0; edge < 3; ++edge) {
        const auto s = random_triangle<Vec<3>>(random, 3);
        const TangentChange change{{0.5, 2}, {-0.5, 1}};
        const auto next = must(next_g1(s, edge, change, random_free<Vec<3>>(random, 6)));
        EXPECT_EQ(next.degree(), 4);
        for (int k = 0; k <= 10; ++k) {
            const double t = k / 10.0;
            const auto u = on_edge(edge, t), w = on_edge(0, 1 - t);
            EXPECT_LT(test::distance(s(u), next(w)), 1e-14);
            // Both normals agree in direction and sense.
            const auto mine = normal(s, u), other = normal(next, w);
            if (!mine || !other) continue;
            EXPECT_LT(test::distance(*mine, *other), 1e-10) << edge << " " << t;
            // And the factors are those that were asked for.
            const Vec<2> o = kCorner[edge] - kCorner[(edge + 1) % 3],
                         e = kCorner[(edge + 2) % 3] - kCorner[(edge + 1) % 3];
            const auto d = [&](const auto& p, const Param<2>& at, const Vec<2>& v) {
                return derivative(p, at, std::span<const Vec<2>>(&v, 1));
            };
            const Vec<3> expected = -((1 - t) * 0.5 + t * 2) * d(s, u, o) + ((1 - t) * -0.5 + t) * d(s, u, e);
            // a is corner 3 of the new one, x corner 1.
            EXPECT_LT(test::distance(d(next, w, Vec<2>{{0, -1}}), expected), 1e-12);
        }
    }
    // Constants are C^1.
    const auto s = random_triangle<Vec<3>>(random, 2);
    const auto free = random_free<Vec<3>>(random, 3);
    const auto g = must(next_g1(s, 0, {{0.5, 0.5}, {0.25, 0.25}}, free));
    // o at -0.5, a = corner 2 at 1.25, b = corner 3 at 0.25.
    const auto c = must(next_c(s, 0, 1, {1.25, 0.25}, free));
    for (std::size_t i = 0; i < g.coefficients().size(); ++i)
        EXPECT_LT(test::distance(g.coefficients()[i], c.patch.coefficients()[i]), 1e-14);
}

TEST(NextTriangle, refuses_what_does_not_fit) {
    Random random(314);
    const auto s = random_triangle<Vec<3>>(random, 3);
    const auto where = [](const auto& r) {
        return r ? std::string("made") : text(name_of(r.error().kind), " ", r.error().where);
    };
    const auto free = random_free<Vec<3>>(random, 3);
    EXPECT_EQ(where(next_c(s, 0, 1, {1, 1}, free)), "made");
    EXPECT_EQ(where(next_c(s, 3, 1, {1, 1}, free)), "invalid edge");
    EXPECT_EQ(where(next_c(s, 0, 1, {0.2, 0.2}, free)), "invalid apex");
    EXPECT_EQ(where(next_c(s, 0, 1, {0.5, 0.5}, free)), "invalid apex");
    EXPECT_EQ(where(next_c(s, 0, 1, {std::nan(""), 1}, free)), "invalid apex");
    EXPECT_EQ(where(next_c(s, 0, 0, {1, 1}, free)), "invalid free");
    EXPECT_EQ(where(next_c(s, 0, 1, {1, 1}, random_free<Vec<3>>(random, 4))), "invalid free");
    EXPECT_EQ(where(next_g1(s, 0, {{1, 0}, {0, 0}}, random_free<Vec<3>>(random, 6))), "invalid lambda");
    EXPECT_EQ(where(next_g1(s, 0, {}, free)), "invalid free");
    // Weights that fall beyond the edge fall below 0 behind it.
    const auto h = must(SimplexPatch<2, Hom<3>>::make(1, {{{0, 0, 0, 9}}, {{1, 0, 0, 1}}, {{0, 1, 0, 1}}}));
    EXPECT_EQ(where(next_c(h, 0, 1, {1, 1}, {})), "invalid weights[0]");
}

TEST(R29, point_normal_triangles_interpolate_points_and_normals_and_share_edges_to_the_bit) {
    Random random(315);
    const auto unit_normal = [&](const Vec<3>& p) { return p; };
    const std::array<Vec<3>, 4> p{{{{1, 0.1, 0}}, {{0, 1, 0.2}}, {{0.1, 0, 1}}, {{0.9, 0.8, 1}}}};
    const auto of = [&](int a, int b, int c) {
        const std::array<Vec<3>, 3> at{p[std::size_t(a)], p[std::size_t(b)], p[std::size_t(c)]};
        return must(point_normal_triangle(at, {unit_normal(at[0]), unit_normal(at[1]), unit_normal(at[2])}));
    };
    const auto one = of(0, 1, 2), two = of(3, 2, 1);
    const Param<2> corner[3] = {{0, 0}, {1, 0}, {0, 1}};
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(one.patch(corner[i]), p[i]);
        EXPECT_LT(test::distance(must(normal(one.patch, corner[i])), unit(p[i])), 1e-14);
        EXPECT_LT(test::distance(one.normals(corner[i]), unit(p[i])), 1e-15);
    }
    for (const auto& [a, b] : {std::pair{boundary(one.patch, 0), boundary(two.patch, 0)},
                               {boundary(one.normals, 0), boundary(two.normals, 0)}})
        for (std::size_t i = 0; i < a.net().flat().size(); ++i)
            EXPECT_EQ(a.net().flat()[i], b.net().flat()[a.net().flat().size() - 1 - i]);
    // The formulas of the paper for one edge and the inner point.
    const Vec<3> n0 = unit(p[0]);
    const double w = dot(p[1] - p[0], n0);
    EXPECT_LT(test::distance(one.patch.coefficient(1, 0), (1.0 / 3) * (2 * p[0] + p[1] - w * n0)), 1e-15);
    Vec<3> e{};
    for (const auto& [j, k] : {std::pair{1, 0}, {0, 1}, {2, 0}, {0, 2}, {2, 1}, {1, 2}})
        e += (1.0 / 6) * one.patch.coefficient(j, k);
    const Vec<3> v = (1.0 / 3) * (p[0] + p[1] + p[2]);
    EXPECT_LT(test::distance(one.patch.coefficient(1, 1), e + 0.5 * (e - v)), 1e-15);
    // A flat triangle with its own normals stays the triangle.
    const auto flat = must(point_normal_triangle({{{{0, 0, 0}}, {{3, 0, 0}}, {{0, 3, 0}}}},
                                                 {{{{0, 0, 1}}, {{0, 0, 2}}, {{0, 0, 3}}}}));
    EXPECT_LT(test::distance(flat.patch(0.25, 0.5), Vec<3>{{0.75, 1.5, 0}}), 1e-15);
    EXPECT_EQ(flat.normals(0.25, 0.5), (Vec<3>{{0, 0, 1}}));
    EXPECT_EQ(point_normal_triangle({p[0], p[0], p[1]}, {p[0], p[0], p[1]}).error().where, "points[1]");
    EXPECT_EQ(point_normal_triangle({p[0], p[1], p[2]}, {p[0], {}, p[1]}).error().where, "normals[1]");
}

}  // namespace
}  // namespace freiform
