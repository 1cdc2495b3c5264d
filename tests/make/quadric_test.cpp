#include "support/random.hpp"
#include "support/real.hpp"

#include <freiform/make/quadric.hpp>
#include <freiform/query/surface_curvature.hpp>

#include <gtest/gtest.h>
#include <map>

namespace freiform {
namespace {

using test::must;
using test::Random;
using test::Rational;
using test::Real;
using test::real;
using Point = std::array<Real, 3>;

Point point(const Vec<3>& v) { return {Real(v[0]), Real(v[1]), Real(v[2])}; }
Point operator-(const Point& a, const Point& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
Real dot(const Point& a, const Point& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
double to_double(const Real& x) { return x.convert_to<double>(); }

// The point of the stored surface in exact arithmetic.
Point exact_point(const Surface<Hom<3>>& s, const Param<2>& uv) {
    const auto x = test::value_of<Rational>(s, uv);
    return {real(x[0]), real(x[1]), real(x[2])};
}
std::vector<Param<2>> grid(int n) {
    std::vector<Param<2>> all;
    for (int i = 0; i <= n; ++i)
        for (int j = 0; j <= n; ++j) all.push_back({double(i) / n, double(j) / n});
    return all;
}
// Height along the axis and distance from it.
std::array<Real, 2> cylindrical(const Point& p, const Vec<3>& origin, const Vec<3>& axis) {
    const Point d = p - point(origin), n = point(axis);
    const Real z = dot(d, n) / sqrt(dot(n, n)), rest = dot(d, d) - z * z;
    return {z, rest > 0 ? Real(sqrt(rest)) : Real(0)};
}

// Row R28, literally: sphere, cylinder, cone and torus are exact. Integer data in the form without irrational
// numbers satisfy their equations to the last bit, in exact arithmetic and at more places than their degree.
TEST(R28, integer_quadrics_and_tori_satisfy_their_equations_exactly) {
    const Turn whole{.form = EllipseForm::quintic};
    const FoundFrame at{{{1, -2, 3}}};
    const auto ball = must(sphere(at, 5, whole));
    const auto tube = must(cylinder(at, 3, {-1, 2}, whole));
    const auto funnel = must(cone(at, 4, 1, {0, 3}, whole));
    const auto ring = must(torus(at, 3, 1, whole, whole));
    for (const RoundSurface* s : {&ball, &tube, &funnel, &ring}) EXPECT_EQ(s->bound, 0);
    EXPECT_EQ(ball.surface.net().extent(), (Index<2>{6, 4}));
    for (const Param<2>& uv : grid(24)) {
        const auto at_origin = [&](const RoundSurface& s) {
            auto p = test::value_of<Rational>(s.surface, uv);
            p[0] -= 1, p[1] += 2, p[2] -= 3;
            return p;
        };
        auto p = at_origin(ball);
        ASSERT_EQ(p[0] * p[0] + p[1] * p[1] + p[2] * p[2], 25);
        p = at_origin(tube);
        ASSERT_EQ(p[0] * p[0] + p[1] * p[1], 9);
        p = at_origin(funnel);
        ASSERT_EQ(p[0] * p[0] + p[1] * p[1], (4 - p[2]) * (4 - p[2]));
        p = at_origin(ring);
        const Rational across = p[0] * p[0] + p[1] * p[1], sum = across + p[2] * p[2] + 9 - 1;
        ASSERT_EQ(sum * sum, 4 * 9 * across);
    }
}

// Half the sum of squares off the equations, at any place and in every form, against the proven bound.
TEST(R28, surfaces_in_any_place_are_within_their_bounds) {
    Random random(28);
    double worst = 0, largest = 0;
    for (int round = 0; round < 24; ++round) {
        const Vec<3> origin = test::random_coefficient<Vec<3>>(random, 3),
                     axis = test::random_coefficient<Vec<3>>(random, 2);
        const FoundFrame f = must(frame_about(origin, axis));
        const double r = random.real(0.1, 3), h = random.real(0.1, 3), a = random.real(-3, 3);
        const EllipseForm forms[] = {EllipseForm::open, EllipseForm::closed, EllipseForm::quintic};
        const Turn part{{a, a + random.real(0.1, 6)}}, whole{.form = forms[round % 3]},
            turn = round % 4 == 3 ? part : whole;
        const double lat = random.real(-1.5, 1.4);
        const auto check = [&](const Result<RoundSurface>& made, auto&& off) {
            const auto& s = must(made);
            largest = std::max(largest, s.bound);
            for (const Param<2>& uv : grid(5)) {
                const Real error = off(exact_point(s.surface, uv));
                worst = std::max(worst, to_double(abs(error)) / s.bound);
            }
        };
        const auto from_centre = [&](const Point& p) {
            const Point d = p - point(origin);
            return Real(sqrt(dot(d, d)) - Real(r));
        };
        check(sphere(f, r, turn), from_centre);
        check(sphere(f, r, turn, {lat, std::numbers::pi / 2}), from_centre);
        check(sphere(f, r, turn, {-std::numbers::pi / 2, lat}), from_centre);
        check(cylinder(f, r, {a, a + h}, turn),
              [&](const Point& p) { return Real(cylindrical(p, origin, axis)[1] - Real(r)); });
        check(cone(f, r, 0, {0, h}, turn), [&](const Point& p) {
            const auto [z, d] = cylindrical(p, origin, axis);  // distance from the line of the profile
            return Real((d - Real(r) * (1 - z / Real(h))) / sqrt(1 + Real(r) * Real(r) / Real(h) / Real(h)));
        });
        check(torus(f, r + h, r, turn, whole), [&](const Point& p) {
            const auto [z, d] = cylindrical(p, origin, axis);
            const Real x = d - Real(r + h);
            return Real(sqrt(x * x + z * z) - Real(r));
        });
    }
    std::printf("  largest observed / bound %.3f, largest bound %.1e\n", worst, largest);
    EXPECT_LE(worst, 1);
    EXPECT_GT(worst, 0.005);
    EXPECT_LT(largest, 1e-13);
}

TEST(R28, curvatures_are_those_of_the_quadrics) {
    const double r = 2;
    const Turn rational{.form = EllipseForm::quintic};
    for (const Turn& turn : {Turn{}, rational}) {
        const auto ball = must(sphere({}, r, turn));
        const auto tube = must(cylinder({}, r, {0, 1}, turn));
        const auto ring = must(torus({}, 3, 1, turn, turn));
        const double slack = turn.form == EllipseForm::quintic ? 0 : 1e-14;
        for (const Param<2>& uv : grid(7)) {
            if (uv[1] > 0 && uv[1] < 1) {
                const auto c = must(surface_curvature(ball.surface, uv));
                EXPECT_LE(std::abs(c.gauss.value - 1 / (r * r)), c.gauss.bound + slack);
                EXPECT_LE(std::abs(c.mean.value + 1 / r), c.mean.bound + slack);
            }
            const auto c = must(surface_curvature(tube.surface, uv));
            EXPECT_LE(std::abs(c.gauss.value), c.gauss.bound + slack);
            EXPECT_LE(std::abs(c.mean.value + 0.5 / r), c.mean.bound + slack);
            // cos / (r (R + r cos)) with cos from the distance from the axis.
            const Vec<3> p = ring.surface(uv);
            const double d = std::hypot(p[0], p[1]);
            const auto t = must(surface_curvature(ring.surface, uv));
            EXPECT_LE(std::abs(t.gauss.value - (d - 3) / d), t.gauss.bound + 1e-14);
        }
    }
}

TEST(Quadric, poles_and_apices_are_single_points_and_closed_turns_close) {
    const FoundFrame f = must(frame_about({{1, 2, 3}}, {{1, 1, 1}}));
    const auto ball = must(sphere(f, 2));
    const auto part = must(sphere(f, 2, {{0, 1}}, {0.2, std::numbers::pi / 2}));
    const auto funnel = must(cone(f, 2, 0, {0, 1}));
    const auto same_points = [](const Surface<Hom<3>>& s, int side) {
        const auto edge = boundary(s, 1, side);
        for (const auto& p : points(edge))
            if (norm(p - points(edge)[0]) > 1e-15 * 8) return false;
        return true;
    };
    EXPECT_TRUE(same_points(ball.surface, 0) && same_points(ball.surface, 1));
    EXPECT_TRUE(same_points(part.surface, 1) && !same_points(part.surface, 0));
    EXPECT_TRUE(same_points(funnel.surface, 1) && !same_points(funnel.surface, 0));
    // About the origin a pole has no rounding in it at all.
    const auto own = must(sphere({}, 3));
    for (const auto& p : points(boundary(own.surface, 1, 1))) EXPECT_EQ(p, (Vec<3>{{0, 0, 3}}));
    const auto cap = must(sphere({}, 3, {{0, 1}}, {0.2, std::numbers::pi / 2}));
    for (const auto& p : points(boundary(cap.surface, 1, 1))) EXPECT_EQ(p, (Vec<3>{{0, 0, 3}}));
    // A cylinder of radius 1 rounds only the weights of its circle.
    const auto thin = must(cylinder({}, 1, {0, 1}));
    const auto q = exact_point(thin.surface, {0.125, 0.5});
    const double off = to_double(abs(sqrt(q[0] * q[0] + q[1] * q[1]) - 1));
    EXPECT_GT(off, 1e-18);
    EXPECT_LE(off, thin.bound);
    const auto closed = must(torus(f, 2, 1, {.form = EllipseForm::closed}, {.form = EllipseForm::closed}));
    EXPECT_TRUE(closed.surface.basis(0).is_closed() && closed.surface.basis(1).is_closed());
    EXPECT_EQ(closed.surface(0, 0.3), closed.surface(1, 0.3));
    EXPECT_EQ(closed.surface(0.3, 0), closed.surface(0.3, 1));
}

TEST(Quadric, frames_stretch_spheres_to_ellipsoids_and_stand_where_they_are_told) {
    FoundFrame f{{{1, 0, 0}}, {{2, 0, 0}}, {{0, 3, 0}}, {{0, 0, 0.5}}};
    const auto egg = must(sphere(f, 1));
    EXPECT_LT(egg.bound, 2e-14);
    for (const Param<2>& uv : grid(6)) {
        const Point p = exact_point(egg.surface, uv) - point(f.origin);
        const Real off = p[0] * p[0] / 4 + p[1] * p[1] / 9 + 4 * p[2] * p[2] - 1;
        EXPECT_LE(to_double(abs(off)), 1e-15);
    }
    EXPECT_EQ(must(sphere({}, 2)).surface(0, 0.5), (Vec<3>{{2, 0, 0}}));
    EXPECT_EQ(must(sphere({}, 2)).surface(0.25, 0.5), (Vec<3>{{0, 2, 0}}));
    const FoundFrame t = must(frame_about({}, {{0, 0, -3}}, {{1, 5, 7}}));
    EXPECT_NEAR(t.x[1] / t.x[0], 5, 1e-14);
    EXPECT_EQ(t.x[2], 0);
    EXPECT_EQ(t.z, (Vec<3>{{0, 0, -1}}));
    EXPECT_GT(::freiform::dot(cross(t.x, t.y), t.z), 0.99);
    EXPECT_EQ(must(frame_about({}, {{0, 0, 8}})).x, (Vec<3>{{1, 0, 0}}));
}

TEST(Quadric, results_scale_exactly_with_powers_of_two) {
    const FoundFrame f = must(frame_about({{1, 2, 3}}, {{1, 0.5, 0.25}}));
    FoundFrame g = f;
    for (int k : {-300, 40, 300}) {
        for (int i = 0; i < 3; ++i) g.origin[i] = std::scalbn(f.origin[i], k);
        const auto a = must(torus(f, 3, 1)), b = must(torus(g, std::scalbn(3, k), std::scalbn(1, k)));
        EXPECT_NEAR(b.bound / std::scalbn(a.bound, k), 1, 1e-12);
        for (std::size_t i = 0; i < a.surface.net().flat().size(); ++i)
            for (int c = 0; c < 3; ++c)
                ASSERT_EQ(b.surface.net().flat()[i][c], std::scalbn(a.surface.net().flat()[i][c], k));
    }
}

using Key = std::vector<std::array<double, 4>>;
// A boundary curve, whichever way it runs.
template <class C>
Key key_of(const C& curve) {
    Key forward;
    for (const auto& p : curve.net().flat()) forward.push_back(p.c);
    Key backward(forward.rbegin(), forward.rend());
    return std::min(forward, backward);
}
double solid_angle(const Vec<3>& a, const Vec<3>& b, const Vec<3>& c) {
    return 2 * std::atan2(dot(a, cross(b, c)), 1 + dot(a, b) + dot(b, c) + dot(c, a));
}

TEST(SphereInSix, has_no_pole_and_covers_the_sphere_once) {
    const FoundFrame f = must(frame_about({{0.5, 0.25, -1}}, {{1, 2, 3}}));
    const auto s = must(sphere_in_six(f, 1.5));
    std::map<Key, int> edges;
    double covered = 0, worst = 0;
    const Vec<3> axes[6] = {-f.z, f.z, -f.x, f.x, -f.y, f.y};
    for (std::size_t k = 0; k < 6; ++k) {
        const auto& face = s.faces[k];
        EXPECT_LT(test::distance(face(0.5, 0.5), f.origin + 1.5 * axes[k]), 1e-14);
        for (int axis : {0, 1})
            for (int side : {0, 1}) ++edges[key_of(boundary(face, axis, side))];
        const auto at = [&](int i, int j) { return unit(face(i / 8.0, j / 8.0) - f.origin); };
        for (int i = 0; i < 8; ++i)
            for (int j = 0; j < 8; ++j)
                covered += solid_angle(at(i, j), at(i + 1, j), at(i + 1, j + 1)) +
                           solid_angle(at(i, j), at(i + 1, j + 1), at(i, j + 1));
        for (const Param<2>& uv : grid(6)) {
            const Point d = exact_point(face, uv) - point(f.origin);
            worst = std::max(worst, to_double(abs(sqrt(dot(d, d)) - Real(1.5))) / s.bound);
            const auto c = must(surface_curvature(face, uv));  // corners and edges as well
            EXPECT_LE(std::abs(c.gauss.value - 1 / 2.25), c.gauss.bound + 1e-13);
            EXPECT_LE(std::abs(c.mean.value + 1 / 1.5), c.mean.bound + 1e-13);
        }
    }
    EXPECT_EQ(edges.size(), 12u);
    for (const auto& [key, count] : edges) EXPECT_EQ(count, 2);
    EXPECT_NEAR(covered, 4 * std::numbers::pi, 1e-12);
    EXPECT_LE(worst, 1);
    EXPECT_LT(s.bound, 2e-14);
}

// Exact numbers a + b sqrt 2 + c sqrt 3 + d sqrt 6.
struct Surd {
    std::array<Rational, 4> v{};
    Surd(Rational a = 0, Rational b = 0, Rational c = 0, Rational d = 0) : v{a, b, c, d} {}
    friend Surd operator+(Surd x, const Surd& y) {
        for (std::size_t i = 0; i < 4; ++i) x.v[i] += y.v[i];
        return x;
    }
    friend Surd operator-(const Surd& x) { return {-x.v[0], -x.v[1], -x.v[2], -x.v[3]}; }
    friend Surd operator*(const Surd& x, const Surd& y) {
        const auto& [a, b, c, d] = x.v;
        const auto& [e, f, g, h] = y.v;
        return {a * e + 2 * b * f + 3 * c * g + 6 * d * h, a * f + b * e + 3 * (c * h + d * g),
                a * g + c * e + 2 * (b * h + d * f), a * h + d * e + b * g + c * f};
    }
    Real value() const {
        return real(v[0]) + real(v[1]) * sqrt(Real(2)) + real(v[2]) * sqrt(Real(3)) +
               real(v[3]) * sqrt(Real(6));
    }
    bool is_zero() const { return v[0] == 0 && v[1] == 0 && v[2] == 0 && v[3] == 0; }
};

// The octant, found again: the quadratic plane triangle whose edges are the stereographic images of the
// octant's edges, lifted back to the sphere, all in exact numbers.
std::map<std::array<int, 3>, std::array<Surd, 4>> lifted_octant() {
    const Rational half(1, 2), third(1, 3), sixth(1, 6);
    const Surd radius(0, -half, 0, half),  // tan(theta / 2), cos theta = 1 / sqrt 3
        control = radius * Surd(-1, 0, 1), w(0, half / 2, 0, half / 2);  // cos of 15 degrees
    const std::array<Surd, 3> e1{Surd(0, half), Surd(0, -half), Surd()},
        e2{Surd(0, 0, 0, sixth), Surd(0, 0, 0, sixth), Surd(0, 0, 0, -third)},
        d{Surd(0, 0, third), Surd(0, 0, third), Surd(0, 0, third)};
    std::map<std::array<int, 3>, std::array<Surd, 3>> plane;
    const Surd lengthen(0, 0, 0, half);  // 1 / sin theta
    std::array<std::array<Surd, 2>, 3> corner;
    for (std::size_t k = 0; k < 3; ++k) {
        corner[k] = {e1[k] * lengthen, e2[k] * lengthen};
        std::array<int, 3> at{};
        at[k] = 2;
        plane[at] = {corner[k][0] * radius, corner[k][1] * radius, Surd(1)};
    }
    for (std::size_t k = 0; k < 3; ++k) {
        std::array<int, 3> at{1, 1, 1};
        at[k] = 0;
        plane[at] = {-(corner[k][0] * control * w), -(corner[k][1] * control * w), w};
    }
    const auto multinomial = [](const std::array<int, 3>& i) {
        return Rational(binomial(i[0] + i[1] + i[2], i[0]) * binomial(i[1] + i[2], i[1]));
    };
    std::map<std::array<int, 3>, std::array<Surd, 4>> out;
    for (const auto& [i, p] : plane)
        for (const auto& [j, q] : plane) {
            const std::array<int, 3> at{i[0] + j[0], i[1] + j[1], i[2] + j[2]};
            const Surd c(Rational(multinomial(i) * multinomial(j) / multinomial(at)));
            const Surd n = p[0] * q[0] + p[1] * q[1], m = p[2] * q[2], x = Surd(2) * p[0] * q[2],
                       y = Surd(2) * p[1] * q[2], z = m + -n;
            auto& to = out[at];
            for (std::size_t k = 0; k < 3; ++k) to[k] = to[k] + c * (x * e1[k] + y * e2[k] + z * d[k]);
            to[3] = to[3] + c * (m + n);
        }
    return out;
}

TEST(SphereInEight, octants_are_the_projection_lifted_back_in_exact_numbers) {
    const auto exact = lifted_octant();
    ASSERT_EQ(exact.size(), 15u);
    std::map<std::array<int, 3>, Surd> sphere;  // x^2 + y^2 + z^2 - w^2
    const auto multinomial = [](const std::array<int, 3>& i) {
        return Rational(binomial(i[0] + i[1] + i[2], i[0]) * binomial(i[1] + i[2], i[1]));
    };
    for (const auto& [i, p] : exact)
        for (const auto& [j, q] : exact) {
            auto& to = sphere[{i[0] + j[0], i[1] + j[1], i[2] + j[2]}];
            to = to + Surd(multinomial(i) * multinomial(j)) *
                          (p[0] * q[0] + p[1] * q[1] + p[2] * q[2] + -(p[3] * q[3]));
        }
    for (const auto& [i, x] : sphere) EXPECT_TRUE(x.is_zero());
    const auto made = must(sphere_in_eight({}, 1));
    const auto& octant = made.octants[0];
    const double scale = octant.coefficient(0, 0)[3] / to_double(exact.at({4, 0, 0})[3].value());
    for (const auto& [i, p] : exact)
        for (int c = 0; c < 4; ++c)
            EXPECT_NEAR(octant.coefficient(i[1], i[2])[c], scale * to_double(p[std::size_t(c)].value()),
                        4e-14);
}

TEST(SphereInEight, octants_join_to_the_bit_and_have_the_curvature_of_the_sphere) {
    const FoundFrame f = must(frame_about({{0.5, 0.25, -1}}, {{1, 2, 3}}));
    const auto s = must(sphere_in_eight(f, 1.5));
    std::map<Key, int> edges;
    double covered = 0;
    for (std::size_t k = 0; k < 8; ++k) {
        const auto& o = s.octants[k];
        for (int e = 0; e < 3; ++e) ++edges[key_of(boundary(o, e))];
        EXPECT_LT(test::distance(o(0, 0), f.origin + (k & 4 ? -1.5 : 1.5) * f.x), 1e-14);
        const auto at = [&](int i, int j) { return unit(o(i / 8.0, j / 8.0) - f.origin); };
        for (int i = 0; i < 8; ++i)
            for (int j = 0; i + j < 8; ++j) {
                covered += solid_angle(at(i, j), at(i + 1, j), at(i, j + 1));
                if (i + j < 7) covered += solid_angle(at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
                const Param<2> uv{i / 8.0, j / 8.0};
                EXPECT_LE(std::abs(norm(o(uv) - f.origin) - 1.5), s.bound + 2 * o.value_error_bound());
                const auto c = must(surface_curvature(o, uv));
                EXPECT_LE(std::abs(c.gauss.value - 1 / 2.25), c.gauss.bound + 1e-13);
                EXPECT_LE(std::abs(c.mean.value + 1 / 1.5), c.mean.bound + 1e-13);
            }
    }
    EXPECT_EQ(edges.size(), 12u);
    for (const auto& [key, count] : edges) EXPECT_EQ(count, 2);
    EXPECT_NEAR(covered, 4 * std::numbers::pi, 1e-12);
    EXPECT_LT(s.bound, 2e-14);
}

TEST(Quadric, refuses_what_is_no_surface) {
    const double nan = std::numeric_limits<double>::quiet_NaN();
    const auto where = [](const auto& r) {
        return r ? std::string("made") : text(name_of(r.error().kind), " ", r.error().where);
    };
    EXPECT_EQ(where(sphere({}, 0)), "invalid radius");
    EXPECT_EQ(where(sphere({}, nan)), "nonfinite radius");
    EXPECT_EQ(where(sphere({}, 1, {}, {0, 2})), "invalid latitude");
    EXPECT_EQ(where(sphere({}, 1, {}, {0, 0})), "invalid latitude");
    EXPECT_EQ(where(sphere({}, 1, {{0, 7}})), "invalid turn.on");
    EXPECT_EQ(where(sphere({}, 1, {{0, 3}, EllipseForm::closed})), "invalid turn.form");
    EXPECT_EQ(where(cone({}, 0, 0, {0, 1})), "invalid radius_hi");
    EXPECT_EQ(where(cone({}, 1, -1, {0, 1})), "invalid radius_hi");
    EXPECT_EQ(where(cylinder({}, 1, {1, 0})), "invalid height");
    EXPECT_EQ(where(torus({}, -2, 1)), "invalid ring");
    EXPECT_EQ(where(torus({}, 2, 0)), "invalid tube");
    EXPECT_EQ(where(sphere({{}, {{1, 0, 0}}, {{2, 0, 0}}}, 1)), "invalid frame");
    EXPECT_EQ(where(sphere_in_six({{{nan, 0, 0}}}, 1)), "nonfinite frame.origin");
    EXPECT_EQ(where(sphere_in_eight({}, -1)), "invalid radius");
    EXPECT_EQ(where(frame_about({}, {})), "invalid axis");
    EXPECT_EQ(where(frame_about({}, {{0, 0, 1}}, {{0, 0, 2}})), "invalid toward");
    EXPECT_EQ(where(frame_about({}, {{0, nan, 1}})), "nonfinite axis");
    EXPECT_NE(where(sphere({}, 1e308)), "made");
}

}  // namespace
}  // namespace freiform
