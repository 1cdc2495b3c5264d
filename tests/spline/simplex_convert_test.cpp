#include "support/random.hpp"
#include "support/reference.hpp"
#include "support/triangle.hpp"

#include <freiform/spline/simplex_convert.hpp>

#include <gtest/gtest.h>

namespace freiform {
namespace {

using test::must;
using test::Random;
using test::random_triangle;
using test::Rational;
using Place = std::array<Rational, 2>;

const Rational kPlaces[][2] = {
    {0, 0}, {1, 0}, {0, 1}, {1, 1}, {Rational(1, 3), Rational(2, 7)}, {Rational(5, 8), Rational(1, 2)}};

std::vector<Rational> at_double(const Surface<Vec<3>>& s, double u, double v) {
    return test::value_of<Rational>(s, Param<2>{u, v});
}
std::vector<Rational> at_double(const Surface<Hom<2>>& s, double u, double v) {
    return test::value_of<Rational>(s, Param<2>{u, v});
}
const double kGrid[] = {0, 0.25, 0.625, 1};

// `place` says where in the triangle (u, v) of the surface is, in exact numbers.
template <class P, class F>
double largest_distance(const Surface<P>& surface, const SimplexPatch<2, P>& s, F&& place) {
    double worst = 0;
    for (const double u : kGrid)
        for (const double v : kGrid)
            worst = std::max(worst, test::distance(at_double(surface, u, v),
                                                   test::exact_point(s, place(Rational(u), Rational(v)))));
    return worst;
}

template <class P>
void expect_surfaces(Random& random, int n) {
    const auto s = random_triangle<P>(random, n);
    const auto one = to_surface(s);
    EXPECT_LE(largest_distance(one.parts[0], s,
                               [](const Rational& u, const Rational& v) {
                                   return Place{u * (1 - v), u * v};
                               }),
              one.bound);
    EXPECT_LT(one.bound, 1e-12);
    const Param<2> centre{1.0 / 3, 1.0 / 3};
    const auto three = must(to_three_surfaces(s, centre));
    EXPECT_LT(three.bound, 1e-11);
    const Place corner[3] = {{0, 0}, {1, 0}, {0, 1}}, middle{Rational(centre[0]), Rational(centre[1])};
    for (std::size_t i = 0; i < 3; ++i) {
        const Place &a = corner[i], &next = corner[(i + 1) % 3], &before = corner[(i + 2) % 3];
        const auto place = [&](const Rational& u, const Rational& v) {
            Place x;
            for (std::size_t d = 0; d < 2; ++d)
                x[d] = (1 - u) * (1 - v) * a[d] + u * (1 - v) * (a[d] + next[d]) / 2 +
                       (1 - u) * v * (a[d] + before[d]) / 2 + u * v * middle[d];
            return x;
        };
        EXPECT_LE(largest_distance(three.parts[i], s, place), three.bound);
        // The side at u = 1 is the side at v = 1 of the next.
        const auto mine = boundary(three.parts[i], 0, 1), other = boundary(three.parts[(i + 1) % 3], 1, 1);
        EXPECT_EQ(mine.net(), other.net()) << "to the bit";
    }
}

TEST(R29, a_triangle_is_one_surface_with_a_pole_or_three_without) {
    Random random(301);
    for (int n : {1, 2, 3, 5}) {
        expect_surfaces<Vec<3>>(random, n);
        expect_surfaces<Hom<2>>(random, n);
    }
    expect_surfaces<Vec<3>>(random, 9);
}

template <class P>
void expect_triangles(Random& random, int m, int n) {
    const auto s = must(Surface<P, Bernstein>::make({*Bernstein::make(m), *Bernstein::make(n)},
                                                    test::random_net<2, P>(random, {m + 1, n + 1})));
    const auto two = must(to_triangles(s));
    EXPECT_LT(two.bound, 1e-12);
    for (const auto& uv : kPlaces) {
        if (uv[0] + uv[1] > 1) continue;
        // Weights of the tensor patch by its definition.
        for (const bool upper : {false, true}) {
            const Rational u = upper ? Rational(1 - uv[0]) : uv[0], v = upper ? Rational(1 - uv[1]) : uv[1];
            std::vector<Rational> h(std::size_t(P::kCoords), Rational(0));
            const auto power = [](const Rational& x, int k) {
                Rational p(1);
                while (k-- > 0) p *= x;
                return p;
            };
            for (int i = 0; i <= m; ++i)
                for (int j = 0; j <= n; ++j) {
                    const Rational w = Rational(binomial(m, i) * binomial(n, j)) * power(u, i) *
                                       power(1 - u, m - i) * power(v, j) * power(1 - v, n - j);
                    for (int c = 0; c < P::kCoords; ++c)
                        h[std::size_t(c)] += w * Rational(s.net().view()({i, j})[c]);
                }
            if (Space<P>::kRational) {
                for (std::size_t c = 0; c + 1 < h.size(); ++c) h[c] /= h.back();
                h.pop_back();
            }
            EXPECT_LE(test::distance(test::exact_point(two.parts[upper], {uv[0], uv[1]}), h), two.bound);
        }
    }
    const auto a = boundary(two.parts[0], 0), b = boundary(two.parts[1], 0);
    for (int i = 0; i <= m + n; ++i)
        EXPECT_EQ(a.net().flat()[std::size_t(i)], b.net().flat()[std::size_t(m + n - i)]) << "the diagonal";
}

TEST(R29, a_tensor_patch_is_two_triangles_along_its_diagonal) {
    Random random(302);
    for (const auto& [m, n] : {std::pair{1, 1}, {2, 1}, {3, 3}, {2, 5}, {0, 2}, {12, 13}}) {
        expect_triangles<Vec<3>>(random, m, n);
        expect_triangles<Hom<2>>(random, m, n);
    }
    const auto big = must(Surface<Vec<1>, Bernstein>::make({*Bernstein::make(13), *Bernstein::make(13)},
                                                           Net<2, Vec<1>>({14, 14})));
    EXPECT_EQ(to_triangles(big).error().kind, RefusalKind::unsupported);
}

TEST(R29, a_triangle_is_split_from_an_edge_to_the_opposite_corner) {
    Random random(303);
    const auto s = random_triangle<Hom<3>>(random, 4);
    const Vec<2> corner[3] = {{{0, 0}}, {{1, 0}}, {{0, 1}}};
    for (int edge = 0; edge < 3; ++edge) {
        const auto two = split_edge(s, edge, 0.375);
        const std::size_t from = std::size_t((edge + 1) % 3), to = std::size_t((edge + 2) % 3);
        Vec<2> low[3] = {corner[0], corner[1], corner[2]}, high[3] = {corner[0], corner[1], corner[2]};
        low[to] = high[from] = 0.625 * corner[from] + 0.375 * corner[to];
        for (const Param<2>& t : {Param<2>{0.2, 0.3}, Param<2>{0, 0}, Param<2>{0.5, 0.5}, Param<2>{0, 1}}) {
            const auto in = [&](const Vec<2>* c) {
                const Vec<2> x = (1 - t[0] - t[1]) * c[0] + t[0] * c[1] + t[1] * c[2];
                return Param<2>{x[0], x[1]};
            };
            EXPECT_LT(test::distance(two[0](t), s(in(low))), 1e-14);
            EXPECT_LT(test::distance(two[1](t), s(in(high))), 1e-14);
        }
        // They share the cut to the bit: of the first it is the edge opposite of `from`.
        const auto a = boundary(two[0], int(from)), b = boundary(two[1], int(to));
        for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(a.net().flat()[i], b.net().flat()[4 - i]);
    }
    const auto back = reversed(s);
    EXPECT_LT(test::distance(back(0.125, 0.5), s(0.5, 0.125)), 1e-15);
    EXPECT_EQ(reversed(back), s);
}

TEST(ReduceDegree, undoes_an_elevation_and_says_what_is_missing_where_there_is_none) {
    Random random(304);
    for (int n : {1, 2, 3, 6, 12}) {
        const auto s = random_triangle<Vec<3>>(random, n);
        const auto back = must(reduce_degree(must(elevate(s)), 1e-12));
        EXPECT_EQ(back.patch.degree(), n);
        EXPECT_LT(back.bound, 1e-13);
        for (std::size_t i = 0; i < s.coefficients().size(); ++i)
            EXPECT_LT(test::distance(back.patch.coefficients()[i], s.coefficients()[i]), 1e-12);
    }
    const auto r = random_triangle<Hom<3>>(random, 4);
    const auto lower = reduce_degree(r, 1e-9);
    ASSERT_FALSE(lower.has_value());
    EXPECT_EQ(lower.error().kind, RefusalKind::no_answer);
    const auto rough = must(reduce_degree(must(elevate(r)), 1e-9));
    double worst = 0;
    for (const auto& uv : kPlaces)
        if (uv[0] + uv[1] <= 1)
            worst = std::max(worst, test::distance(test::exact_point(rough.patch, {uv[0], uv[1]}),
                                                   test::exact_point(must(elevate(r)), {uv[0], uv[1]})));
    EXPECT_LE(worst, rough.bound);
    // Nearly of degree 2: within the bound, which is not far from the distance.
    auto s = must(elevate(random_triangle<Vec<3>>(random, 2)));
    std::vector<Vec<3>> b(s.coefficients().begin(), s.coefficients().end());
    b[4][2] += 1e-3;
    const auto bent = must(SimplexPatch<2, Vec<3>>::make(3, b));
    const auto flat = must(reduce_degree(bent, 1e-3));
    worst = 0;
    for (int i = 0; i <= 8; ++i)
        for (int j = 0; i + j <= 8; ++j)
            worst = std::max(worst, test::distance(bent(i / 8.0, j / 8.0), flat.patch(i / 8.0, j / 8.0)));
    EXPECT_LE(worst, flat.bound);
    EXPECT_GT(worst, flat.bound / 10);
    EXPECT_EQ(flat.patch.coefficient(0, 0), bent.coefficient(0, 0));
    EXPECT_EQ(reduce_degree(random_triangle<Vec<2>>(random, 1), 1).error().where, "degree");
}

TEST(ToThreeSurfaces, refuses_centres_that_are_not_inside) {
    Random random(305);
    const auto s = random_triangle<Vec<3>>(random, 2);
    for (const Param<2>& c :
         {Param<2>{0, 0.5}, Param<2>{0.5, 0.5}, Param<2>{1, 1}, Param<2>{std::nan(""), 0.1}})
        EXPECT_EQ(to_three_surfaces(s, c).error().kind, RefusalKind::out_of_domain);
}

}  // namespace
}  // namespace freiform
