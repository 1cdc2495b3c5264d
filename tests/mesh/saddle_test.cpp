// Where a surface is a saddle, what is known of the signs of its second derivatives holds, and the error of
// interpolation is not more than what is said by them.
#include "mesh/curvature_tree_detail.hpp"
#include "support/random.hpp"

#include <freiform/core/constants.hpp>

#include <gtest/gtest.h>

namespace freiform {
namespace {

using test::must;
using test::Random;

template <class P>
SurfaceGeometry waves(Random& random) {
    const auto basis = *BSplineBasis::clamped_uniform(3, 7);
    std::vector<P> c;
    for (int i = 0; i < 7; ++i)
        for (int k = 0; k < 7; ++k) {
            const Vec<3> at{{double(i), double(k), 0.3 * random.real(-1, 1)}};
            if constexpr (std::same_as<P, Hom<3>>)
                c.push_back(weighted(at, random.real(0.7, 1.4)));
            else
                c.push_back(at);
        }
    return must(Surface<P>::make({basis, basis}, Net<2, P>({7, 7}, c)));
}

SurfaceGeometry torus() {
    return Revolution{
        Conic<3>{ConicKind::ellipse, {{4, 0, 1}}, {{1.2, 0, 0}}, {{0, 0, 1.2}}}, {{0, 0, 0}}, {{0, 0, 1}}};
}

TEST(Saddle, signs_hold_within_the_box) {
    Random random(11);
    const Interval half_turn{0.3 * kTwoPi, 0.7 * kTwoPi};
    const struct {
        SurfaceGeometry surface;
        std::array<Interval, 2> on;
    } cases[] = {{waves<Vec<3>>(random), {Interval{0, 4}, Interval{0, 4}}},
                 {waves<Hom<3>>(random), {Interval{0, 4}, Interval{0, 4}}},
                 {torus(), {Interval{0, 6}, half_turn}}};
    for (const auto& c : cases) {
        const DerivativeQuery<2, 3> surface(c.surface);
        int saddles = 0, by_sample = 0;
        for (int k = 0; k < 800; ++k) {
            const double size = std::exp2(-random.integer(1, 6));
            Box<2> box;
            for (int d = 0; d < 2; ++d) {
                const Interval all = c.on[std::size_t(d)];
                box.lo[d] = random.real(all.lo, all.hi - size * all.length());
                box.hi[d] = box.lo[d] + size * all.length();
            }
            const auto middle = jet<2>(c.surface, {box.side(0).middle(), box.side(1).middle()});
            const auto looks_right = [&](const BoxBending& b) {
                if (!b.across.is_saddle()) return false;
                for (int i = 0; i < 30; ++i) {
                    const auto j = jet<2>(
                        c.surface, {random.real(box.lo[0], box.hi[0]), random.real(box.lo[1], box.hi[1])});
                    const double uu = dot(b.n, j(2, 0)), vv = dot(b.n, j(0, 2));
                    EXPECT_GE(uu * b.across.sure_uu, b.across.sure_uu * b.across.sure_uu * (1 - 1e-12));
                    EXPECT_GE(vv * b.across.sure_vv, b.across.sure_vv * b.across.sure_vv * (1 - 1e-12));
                    const double slack = 1 + 1e-12;
                    EXPECT_LE(norm(j(2, 0) - uu * b.n), b.beside.uu * slack);
                    EXPECT_LE(norm(j(1, 1) - dot(b.n, j(1, 1)) * b.n), b.beside.uv * slack);
                    EXPECT_LE(norm(j(0, 2) - vv * b.n), b.beside.vv * slack);
                    // Along another vector.
                    const Vec<3> aside{{random.real(-1, 1), random.real(-1, 1), random.real(-1, 1)}};
                    const Vec<3> m = unit(b.n + 0.4 * aside);
                    const Curvature seen = b.seen_along(norm(m - b.n));
                    EXPECT_LE(std::abs(dot(m, j(2, 0))), seen.uu * slack);
                    EXPECT_LE(std::abs(dot(m, j(1, 1))), seen.uv * slack);
                    EXPECT_LE(std::abs(dot(m, j(0, 2))), seen.vv * slack);
                    EXPECT_GE(dot(m, j(2, 0)) * seen.sure_uu * slack, seen.sure_uu * seen.sure_uu);
                    EXPECT_GE(dot(m, j(0, 2)) * seen.sure_vv * slack, seen.sure_vv * seen.sure_vv);
                }
                return true;
            };
            saddles += looks_right(bending_of(surface, box, true, middle));
            if (!surface.is_twice_smooth({box.side(0), box.side(1)})) continue;
            Variation varies;
            (void)bending_of(surface, box, true, middle, &varies);
            by_sample += looks_right(bending_from_middle(surface, box, true, middle, varies));
        }
        EXPECT_GT(saddles, 40);
        if (!std::holds_alternative<Revolution>(c.surface)) {
            EXPECT_GT(by_sample, 40);
        }
    }
}

// f = (a u^2 + 2 c u v - b v^2) / 2 on triangles in general position: the error is where its gradient
// vanishes, or on a side.
TEST(Saddle, bounds_of_interpolation_hold_and_are_halved) {
    Random random(12);
    double sharpest = 0;
    for (int k = 0; k < 3000; ++k) {
        const double a = random.real(0.01, 2), b = random.real(0.01, 2), c = random.real(-1, 1);
        const auto f = [&](const Vec<2>& x) {
            return (a * x[0] * x[0] + 2 * c * x[0] * x[1] - b * x[1] * x[1]) / 2;
        };
        const Curvature bends{a, std::abs(c), b, a, -b};
        std::array<Vec<2>, 3> t;
        for (Vec<2>& p : t) p = {{random.real(-1, 1), random.real(-1, 1)}};
        double most = 0;
        for (int i = 0; i <= 40; ++i)
            for (int j = 0; i + j <= 40; ++j) {
                const double l = i / 40.0, m = j / 40.0, n = 1 - l - m;
                const double flat = l * f(t[0]) + m * f(t[1]) + n * f(t[2]);
                most = std::max(most, std::abs(f(l * t[0] + m * t[1] + n * t[2]) - flat));
            }
        const double bound = linear_interpolation_bound(bends, t[0], t[1], t[2]);
        EXPECT_GE(bound * (1 + 1e-12), most);
        EXPECT_LE(bound, linear_interpolation_bound({a, std::abs(c), b}, t[0], t[1], t[2]));
        sharpest = std::max(sharpest, most / bound);
    }
    EXPECT_GT(sharpest, 0.9);
    const Curvature saddle{1, 0, 1, 1, -1};
    EXPECT_DOUBLE_EQ(saddle.error({{1, 1}}), 0.125);
    EXPECT_DOUBLE_EQ((Curvature{1, 0, 1}).error({{1, 1}}), 0.25);
    EXPECT_FALSE((Curvature{1, 0, 1, 1, 1}).is_saddle());
}

TEST(Quadratic, error_is_what_samples_find) {
    Random random(13);
    int definite = 0, acute = 0;
    for (int k = 0; k < 4000; ++k) {
        const double tiny = k % 5 == 0 ? std::exp2(-random.real(0, 60)) : 1;  // nearly degenerate
        const double x = random.real(-1, 1), y = random.real(-1, 1), z = tiny * random.real(-1, 1);
        const Quadratic q{x * x + z, x * y, y * y - z};
        const auto f = [&](const Vec<2>& p) {
            return (q.uu * p[0] * p[0] + 2 * q.uv * p[0] * p[1] + q.vv * p[1] * p[1]) / 2;
        };
        std::array<Vec<2>, 3> t;
        for (Vec<2>& p : t) p = {{random.real(-1, 1), random.real(-1, 1)}};
        double most = 0, inside = 0;
        for (int i = 0; i <= 60; ++i)
            for (int j = 0; i + j <= 60; ++j) {
                const double l = i / 60.0, m = j / 60.0, n = 1 - l - m;
                const double flat = l * f(t[0]) + m * f(t[1]) + n * f(t[2]);
                const double off = std::abs(f(l * t[0] + m * t[1] + n * t[2]) - flat);
                most = std::max(most, off);
                if (l * m * n > 0) inside = std::max(inside, off);
            }
        const double said = q.error(t);
        EXPECT_GE(said * (1 + 1e-12), most);
        if (tiny == 1 && std::abs(q.uu * q.vv - q.uv * q.uv) > 1e-6) {
            EXPECT_LE(said, most * 1.01 + 1e-6);
            definite += q.uu * q.vv > q.uv * q.uv;
            acute += inside == most;
        }
    }
    EXPECT_GT(definite, 500);
    EXPECT_GT(acute, 50);
}

TEST(Quadratic, takes_the_better_diagonal) {
    Random random(14);
    for (int k = 0; k < 1000; ++k) {
        const Quadratic q{random.real(-1, 1), random.real(-1, 1), random.real(-1, 1)};
        const Vec<2> size{{random.real(0.1, 1), random.real(0.1, 1)}};
        const bool rising = q.prefers_rising(size);
        EXPECT_EQ(q.halves_error(size), q.error(half_of({{}, size}, rising)));
        EXPECT_LE(q.halves_error(size), q.error(half_of({{}, size}, !rising)) * (1 + 1e-12));
    }
    EXPECT_TRUE((Quadratic{1, 0, 1}).prefers_rising({{1, 1}}));
    EXPECT_FALSE((Quadratic{1, 1, 1}).prefers_rising({{1, 1}}));
    // A cylinder along the diagonal.
    EXPECT_NEAR((Quadratic{1, 1, 1}).halves_error({{1, 1}}), 1.0 / 8, 1e-12);
}

TEST(Saddle, what_is_added_and_included_takes_signs_away) {
    const Curvature saddle{2, 0.5, 3, 1, -2}, rest{1, 1, 1};
    const Curvature less = saddle.plus(0.5, rest);
    EXPECT_EQ(less.sure_uu, 0.5);
    EXPECT_EQ(less.sure_vv, -1.5);
    EXPECT_FALSE(saddle.plus(1, rest).is_saddle());
    Curvature both = saddle;
    both.include({1, 0, 1, 0.25, -4});
    EXPECT_EQ(both.sure_uu, 0.25);
    EXPECT_EQ(both.sure_vv, -2);
    both.include({1, 0, 1, -1, -1});
    EXPECT_EQ(both.sure_uu, 0);
    EXPECT_FALSE(both.is_saddle());
}

// Also of triangles that are turned over, and across a kink.
TEST(TriangleBound, holds_for_triangles_in_any_sense) {
    Random random(23);
    const auto bent = must(Surface<Vec<3>>::make(
        {*BSplineBasis::make(2, {0, 0, 0, 2, 2, 4, 4, 4}), *BSplineBasis::bezier(1, {0, 4})},
        Net<2, Vec<3>>({5, 2}, [&] {
            std::vector<Vec<3>> c;
            for (int i = 0; i < 5; ++i)
                for (int k = 0; k < 2; ++k) c.push_back({{double(i), 4.0 * k, random.real(-1, 1)}});
            return c;
        }())));
    double closest = 0;
    for (const SurfaceGeometry& s : {SurfaceGeometry(bent), waves<Vec<3>>(random), waves<Hom<3>>(random)}) {
        const DerivativeQuery<2, 3> surface(s);
        for (int n = 0; n < 300; ++n) {
            const double size = std::exp2(random.integer(-4, 0));
            const Vec<2> at{{random.real(0, 4 - size), random.real(0, 4 - size)}};
            std::array<Vec<2>, 3> t;
            for (Vec<2>& p : t) p = at + Vec<2>{{random.real(0, size), random.real(0, size)}};
            const double bound = triangle_bound(surface, t);
            double worst = 0;
            for (int i = 0; i <= 12; ++i)
                for (int k = 0; i + k <= 12; ++k) {
                    const double a = i / 12.0, b = k / 12.0, c = 1 - a - b;
                    const Vec<2> uv = a * t[0] + b * t[1] + c * t[2];
                    const auto on = [&](const Vec<2>& p) { return jet<0>(s, p.c).value(); };
                    worst = std::max(worst, norm(on(uv) - (a * on(t[0]) + b * on(t[1]) + c * on(t[2]))));
                }
            EXPECT_LE(worst, bound * (1 + 1e-12) + 1e-15);
            closest = std::max(closest, worst / bound);
        }
        EXPECT_EQ(triangle_bound(surface, {{{{-1, 0}}, {{1, 0}}, {{0, 1}}}}), kInfinity);
    }
    EXPECT_GT(closest, 0.5);
}

}  // namespace
}  // namespace freiform
