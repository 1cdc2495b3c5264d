// A surface beside a quadratic function: bounds of the rest and of its derivatives hold, are useful, and say
// nothing where nothing is known.
#include "support/prepared.hpp"
#include "support/shapes.hpp"

#include <freiform/core/constants.hpp>
#include <freiform/spline/derivative_bounds.hpp>

#include <gtest/gtest.h>

using namespace freiform;
using namespace freiform::test;

namespace {

template <class P>
SurfaceGeometry bumpy(std::mt19937& rng, int p, int q, int pieces, double spread) {
    const auto basis = [&](int degree) {
        std::vector<double> knots(std::size_t(degree) + 1, 0.0);
        for (int k = 1; k < pieces; ++k) knots.push_back(k / double(pieces));
        knots.insert(knots.end(), std::size_t(degree) + 1, 1.0);
        return must(BSplineBasis::make(degree, knots));
    };
    const auto u = basis(p), v = basis(q);
    std::vector<P> c;
    for (int i = 0; i < u.size(); ++i)
        for (int k = 0; k < v.size(); ++k) {
            const Vec<3> at{{i + uniform(rng, -0.2, 0.2), k + uniform(rng, -0.2, 0.2), uniform(rng, -1, 1)}};
            if constexpr (std::same_as<P, Hom<3>>)
                c.push_back(weighted(at, std::exp(uniform(rng, -spread, spread))));
            else
                c.push_back(at);
        }
    return must(Surface<P>::make({u, v}, Net<2, P>({u.size(), v.size()}, c)));
}

// M and its derivatives of order 1 and 2, graded.
std::array<Vec<3>, 6> jet_of(const BoxQuadratic& m, const Param<2>& at) {
    const double du = m.box[0].length(), dv = m.box[1].length(), s = (at[0] - m.box[0].lo) / du,
                 t = (at[1] - m.box[1].lo) / dv;
    const auto& c = m.corner;
    const Vec<3> twist = c[0] - c[1] - c[2] + c[3];
    return {m(s, t),
            1 / du * (c[1] - c[0] + t * twist + (1 - 2 * s) * m.bulge[0]),
            1 / dv * (c[2] - c[0] + s * twist + (1 - 2 * t) * m.bulge[1]),
            -2 / (du * du) * m.bulge[0],
            1 / (du * dv) * twist,
            -2 / (dv * dv) * m.bulge[1]};
}

TEST(QuadraticFit, bounds_hold_at_every_point_of_random_boxes) {
    std::mt19937 rng(31);
    const auto look = [&](const SurfaceGeometry& surface, const std::string& name) {
        const DerivativeQuery<2, 3> query(surface);
        double sharpest[2] = {};
        for (int k = 0; k < 40; ++k) {
            BoxQuadratic m;
            const double part = std::pow(0.5, uniform(rng, 0, 12));
            for (auto& side : m.box) {
                side.lo = uniform(rng, 0, 1 - part);
                side.hi = k % 8 == 0 ? 1 : side.lo + part;
            }
            const auto middle = jet<2>(surface, {m.box[0].middle(), m.box[1].middle()});
            for (int d = 0; d < 2; ++d) {
                const double length = m.box[std::size_t(d)].length();
                m.bulge[std::size_t(d)] = -length * length / 2 * middle.d[d == 0 ? 3 : 5];
            }
            const bool at_corners = k % 3 != 0;
            if (!at_corners)
                for (auto& c : m.corner) c = middle.value() + uniform(rng, -part, part) * middle(1, 0);
            const Vec<3> n = unit(Vec<3>{{uniform(rng, -1, 1), uniform(rng, -1, 1), uniform(rng, -1, 1)}});
            const std::array cuts{1 + k % 2, 1 + k % 4};
            const QuadraticFit fit = query.fit(m, at_corners, n, cuts);
            if (!at_corners) {
                EXPECT_EQ(fit.m.corner, m.corner);
            }
            for (int i = 0; i < 4 && at_corners; ++i) {
                const Param<2> at{i & 1 ? m.box[0].hi : m.box[0].lo, i & 2 ? m.box[1].hi : m.box[1].lo};
                EXPECT_LE(norm(jet<0>(surface, at).value() - fit.m.corner[std::size_t(i)]), 1e-13) << name;
            }
            double largest[2] = {};
            for (int i = 0; i < 60; ++i) {
                const Param<2> at{uniform(rng, m.box[0].lo, m.box[0].hi),
                                  uniform(rng, m.box[1].lo, m.box[1].hi)};
                const auto j = jet<2>(surface, at);
                const auto of_m = jet_of(fit.m, at);
                for (std::size_t s = 0; s < 6; ++s) {
                    const Vec<3> rest = j.d[s] - of_m[s];
                    const double room = 1e-13 * (1 + norm(j.d[s]) + norm(of_m[s])) *
                                        (s > 2   ? 1 / (part * part)
                                         : s > 0 ? 1 / part
                                                 : 1);
                    ASSERT_LE(norm(rest), fit.all[s] * (1 + 1e-12) + room) << name << ", derivative " << s;
                    ASSERT_LE(std::abs(dot(n, rest)), fit.along[s] * (1 + 1e-12) + room) << name << s;
                    if (s == 0) largest[0] = std::max(largest[0], norm(rest));
                    if (s == 3) largest[1] = std::max(largest[1], norm(rest));
                }
            }
            if (part > 0.01 && at_corners) {
                sharpest[0] = std::max(sharpest[0], largest[0] / fit.all[0]);
                sharpest[1] = std::max(sharpest[1], largest[1] / fit.all[3]);
            }
        }
        EXPECT_GT(sharpest[0], 0.2) << name;
        EXPECT_GT(sharpest[1], 0.2) << name;
    };
    for (const int p : {2, 3, 5})
        for (const int q : {1, 2, 3, 4, 7})
            for (const int pieces : {1, 3}) {
                const std::string name = text(p, " x ", q, ", ", pieces, " pieces");
                look(bumpy<Vec<3>>(rng, p, q, pieces, 0), name);
                look(bumpy<Hom<3>>(rng, p, q, pieces, 0.7), "rational " + name);
            }
}

// Few columns, of which rows are one vector, and many are looked at in different ways.
template <class P>
void expect_the_same_with_axes_exchanged(std::mt19937& rng, int p, int q, double spread) {
    const SurfaceGeometry surface = bumpy<P>(rng, p, q, 1, spread);
    const auto& patch = std::get<Surface<P>>(surface);
    std::vector<P> c;
    for (int k = 0; k <= q; ++k)
        for (int i = 0; i <= p; ++i) c.push_back(patch.net().flat()[std::size_t(i * (q + 1) + k)]);
    const SurfaceGeometry exchanged =
        must(Surface<P>::make({patch.basis(1), patch.basis(0)}, Net<2, P>({q + 1, p + 1}, c)));
    const DerivativeQuery<2, 3> one(surface), other(exchanged);
    for (int round = 0; round < 20; ++round) {
        BoxQuadratic m;
        for (auto& side : m.box) {
            side.lo = uniform(rng, 0, 0.7);
            side.hi = round % 4 == 0 ? 1 : side.lo + 0.3;
        }
        for (auto* of : {&m.corner[0], &m.corner[1], &m.corner[2], &m.corner[3], &m.bulge[0], &m.bulge[1]})
            *of = {{uniform(rng, -1, 1), uniform(rng, -1, 1), uniform(rng, -1, 1)}};
        const BoxQuadratic turned{{m.box[1], m.box[0]},
                                  {m.corner[0], m.corner[2], m.corner[1], m.corner[3]},
                                  {m.bulge[1], m.bulge[0]}};
        const bool at_corners = round % 2 == 0;
        const Vec<3> n = unit(Vec<3>{{1, -2, 0.5}});
        const QuadraticFit here = one.fit(m, at_corners, n), there = other.fit(turned, at_corners, n);
        for (const auto& [k, l] : {std::pair{0, 0}, {1, 2}, {2, 1}, {3, 5}, {4, 4}, {5, 3}}) {
            const auto at = std::size_t(k), with = std::size_t(l);
            EXPECT_NEAR(here.all[at] / there.all[with], 1, 1e-9) << p << " x " << q << ", " << k;
            EXPECT_NEAR(here.along[at] / there.along[with], 1, 1e-9) << p << " x " << q << ", " << k;
        }
    }
}
TEST(QuadraticFit, is_the_same_with_axes_exchanged) {
    std::mt19937 rng(35);
    for (const int q : {1, 2, 3})
        for (const int p : {2, 3, 4, 5, 8}) {
            if (q > 1) expect_the_same_with_axes_exchanged<Vec<3>>(rng, p, q, 0);
            expect_the_same_with_axes_exchanged<Hom<3>>(rng, p, q, 0.7);
        }
}

TEST(QuadraticFit, is_exact_where_the_surface_is_quadratic_itself) {
    std::mt19937 rng(32);
    for (int round = 0; round < 20; ++round) {
        // Not u v^2 and u^2 v: no function that is quadratic along each axis and bilinear beside has them.
        std::vector<Vec<3>> c;
        std::array<Vec<3>, 6> of{};
        for (Vec<3>& x : of) x = {{uniform(rng, -1, 1), uniform(rng, -1, 1), uniform(rng, -1, 1)}};
        for (int i = 0; i < 3; ++i)
            for (int k = 0; k < 3; ++k) {
                const double u = i / 2.0, v = k / 2.0, uu = i == 2, vv = k == 2;
                c.push_back(of[0] + u * of[1] + v * of[2] + uu * of[3] + u * v * of[4] + vv * of[5]);
            }
        const auto basis = must(BSplineBasis::make(2, {0, 0, 0, 1, 1, 1}));
        const SurfaceGeometry surface =
            must(Surface<Vec<3>>::make({basis, basis}, Net<2, Vec<3>>({3, 3}, c)));
        const std::array box{Interval{0.25, 0.75}, Interval{0.125, 1}};
        const QuadraticFit fit = DerivativeQuery<2, 3>(surface).fit(
            {box, {}, {-0.25 * of[3], -(0.875 * 0.875) * of[5]}}, true, {});
        EXPECT_LE(fit.all[0], 1e-12);
        for (std::size_t s = 1; s < 6; ++s) EXPECT_LE(fit.all[s], 1e-10);
    }
}

TEST(QuadraticFit, says_nothing_beyond_the_domain_of_what_is_no_spline_and_of_wild_weights) {
    std::mt19937 rng(33);
    const BoxQuadratic m{{Interval{0.5, 1.5}, Interval{0, 1}}, {}, {}};
    const SurfaceGeometry short_one = bumpy<Vec<3>>(rng, 3, 3, 2, 0);
    const DerivativeQuery<2, 3> of_surface(short_one);
    EXPECT_EQ(of_surface.fit(m, true, {}).all[0], kInfinity);
    for (const auto& [name, surface, on] : surfaces_of_every_kind(3)) {
        const DerivativeQuery<2, 3> query(surface);
        const bool spline = query.piece_numbers() > 0;
        EXPECT_EQ(query.fit({on, {}, {}}, true, {}).all[0] < kInfinity, spline) << name;
    }
    const auto basis = must(BSplineBasis::make(1, {0, 0, 1, 1}));
    std::vector<Hom<3>> c;
    for (int i = 0; i < 4; ++i)
        c.push_back(weighted(Vec<3>{{double(i & 1), double(i >> 1), 0}}, i ? 1 : 1e-200));
    const SurfaceGeometry wild = must(Surface<Hom<3>>::make({basis, basis}, Net<2, Hom<3>>({2, 2}, c)));
    const DerivativeQuery<2, 3> of_wild(wild);
    const QuadraticFit fit = of_wild.fit({{Interval{0, 1}, Interval{0, 1}}, {}, {}}, true, {});
    for (std::size_t k = 0; k < 6; ++k) EXPECT_EQ(fit.all[k], kInfinity);
}

// Along an axis of degree 1 blocks have no bulge, which is in the bounds then.
TEST(QuadraticFit, bulges_that_the_surface_cannot_have_are_in_the_bounds) {
    std::mt19937 rng(34);
    const SurfaceGeometry surface = bumpy<Vec<3>>(rng, 1, 1, 1, 0);
    const Vec<3> bulge{{0, 0, 0.5}};
    const QuadraticFit fit = DerivativeQuery<2, 3>(surface).fit(
        {{Interval{0, 1}, Interval{0, 1}}, {}, {bulge, 0.5 * bulge}}, true, Vec<3>{{0, 0, 1}});
    EXPECT_GE(fit.along[0], 0.125 + 0.0625);
    EXPECT_LE(fit.along[0], 0.25);
    EXPECT_GE(fit.along[3], 1);
    EXPECT_GE(fit.along[5], 0.5);
}

}  // namespace
