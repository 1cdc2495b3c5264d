// How many triangles are made, and that the fewer they are the bound still holds: by `deviation`, which knows
// nothing of how meshes are made.
#include "support/random.hpp"
#include "support/shapes.hpp"
#include "support/solids.hpp"

#include <freiform/basis/greville.hpp>
#include <freiform/model/deviation.hpp>
#include <freiform/spline/apex.hpp>

#include <gtest/gtest.h>

using namespace freiform;
using namespace freiform::test;

namespace {

// Triangles that a surface of constant curvatures cannot do without: chords of length sqrt(8 r tolerance).
double steps(double angle, double r, double tolerance) { return angle / std::sqrt(8 * tolerance / r); }

TEST(TessellateEconomy, walls_of_cones_are_judged_by_their_chords) {
    for (const double tolerance : {1e-2, 1e-3}) {
        const auto t = tessellate(frustum(2, 1, 3), {.tolerance = tolerance});
        ASSERT_TRUE(t);
        EXPECT_LE(t->error_bound, tolerance);
        EXPECT_EQ(t->topology.open_edges, 0);
        const double around = steps(2 * kPi, 2, tolerance);
        // As many in the caps and in the wall, two for each chord; the upper circle has fewer.
        EXPECT_LE(double(t->mesh.triangles.size()), 2 * (1 + std::sqrt(0.5)) * 1.2 * around) << tolerance;
        const auto d = deviation(frustum(2, 1, 3), t->mesh, {.enough = tolerance, .max_parts = 1'000});
        ASSERT_TRUE(d);
        EXPECT_LE(d->measured, t->error_bound + t->boundary_gap);
        EXPECT_GE(d->measured, 0.3 * tolerance);
        EXPECT_LE(d->mesh_measured, t->error_bound + t->boundary_gap + d->accuracy);
    }
}

// Between an ellipse about the origin and a copy of it, nearer to the apex; moved up if `part` is 1.
Surface<Hom<3>> wall(double lean, double part, double squeeze, double height = 3) {
    const double w = std::sqrt(0.5);
    const double corner[9][2] = {{1, 0},   {1, 1},  {0, 1},  {-1, 1}, {-1, 0},
                                 {-1, -1}, {0, -1}, {1, -1}, {1, 0}};
    const Vec<3> apex{{lean, 0, height}};
    std::vector<Hom<3>> c;
    for (int i = 0; i < 9; ++i) {
        const Vec<3> far{{corner[i][0], squeeze * corner[i][1], 0}};
        for (const Vec<3>& p : {part == 1 ? far + apex : apex + part * (far - apex), far})
            c.push_back(weighted(p, i % 2 ? w : 1.0));
    }
    return *Surface<Hom<3>>::make(
        {*BSplineBasis::make(2, {0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4}), *BSplineBasis::bezier(1)},
        Net<2, Hom<3>>({9, 2}, c));
}

// To the apex, as a spline, leaning, of a curve that is no circle, and with a slanting trim.
TEST(TessellateEconomy, cones_take_few_triangles_up_to_the_apex) {
    const double tolerance = 1e-4, around = steps(2 * kPi, 1, tolerance);
    for (const double part : {0.0, 0.3, 1.0})
        for (const double lean : {0.0, 0.5}) {
            ModelBuilder builder;
            ASSERT_TRUE(builder.add(wall(lean, part, lean > 0 ? 0.7 : 1)));
            const Model m = *std::move(builder).finish();
            const auto t = tessellate(m, {.tolerance = tolerance});
            ASSERT_TRUE(t && t->refused.empty())
                << part << " " << lean << " " << (t ? t->refused[0].reason.message : t.error().message);
            EXPECT_LE(t->error_bound, tolerance);
            EXPECT_LE(double(t->mesh.triangles.size()), 1.3 * (1 + std::sqrt(part)) * around)
                << part << " " << lean;
            const auto d = deviation(m, t->mesh, {.enough = tolerance, .max_parts = 20'000});
            ASSERT_TRUE(d);
            EXPECT_LE(d->measured, t->error_bound + t->boundary_gap);
            EXPECT_GE(d->measured, 0.5 * tolerance);
        }
}

// However flat, splines even down to planes.
TEST(TessellateEconomy, flat_cones_take_as_few_triangles_as_steep_ones) {
    const double tolerance = 1e-4;
    const auto expect_few = [&](const Model& m, double triangles, double height) {
        const auto t = tessellate(m, {.tolerance = tolerance});
        ASSERT_TRUE(t && t->refused.empty()) << height;
        EXPECT_LE(t->error_bound, tolerance);
        EXPECT_LE(double(t->mesh.triangles.size()), triangles) << height;
        const auto d = deviation(m, t->mesh, {.enough = tolerance, .max_parts = 1'000});
        ASSERT_TRUE(d);
        EXPECT_LE(d->measured, t->error_bound + t->boundary_gap);
        if (height > 1) EXPECT_GE(d->measured, 0.3 * tolerance);
    };
    const double inner = 0.1, few = 1.3 * (1 + std::sqrt(inner / 2)) * steps(2 * kPi, 2, tolerance);
    for (const double height : {2.0, 0.4, 0.02}) expect_few(frustum(2, inner, height), 2 * few, height);
    for (const double height : {2.0, 0.3, 1e-3, 0.0}) {
        ModelBuilder builder;
        ASSERT_TRUE(builder.add(wall(0.1, inner, 1, height)));
        expect_few(*std::move(builder).finish(), few, height);
    }
}

CurveGeometry<2> side(Vec<2> a, Vec<2> b) {
    return *Curve<Vec<2>>::make({*BSplineBasis::bezier(1)}, Net<1, Vec<2>>({2}, {a, b}));
}
std::vector<CurveGeometry<2>> polygon(std::vector<Vec<2>> p) {
    std::vector<CurveGeometry<2>> out;
    for (std::size_t i = 0; i < p.size(); ++i) out.push_back(side(p[i], p[(i + 1) % p.size()]));
    return out;
}

// Triangles that turn the other way than the surface, and are higher than the tolerance.
int turned_over(const Model& m, const Tessellation& t, double tolerance) {
    int count = 0;
    for (std::size_t i = 0; i < t.mesh.triangles.size(); ++i) {
        const auto [a, b, c] = t.mesh.points_of(i);
        const auto at = [&](int k) { return t.mesh.points[std::size_t(k)]; };
        const Vec<3> n = cross(at(b) - at(a), at(c) - at(a));
        const double longest = std::max({norm(at(b) - at(a)), norm(at(c) - at(b)), norm(at(a) - at(c))});
        if (norm(n) <= tolerance * longest) continue;
        Vec<2> middle{};
        for (const int v : t.mesh.triangles[i]) middle += (1.0 / 3) * t.mesh.vertices[std::size_t(v)].uv;
        const auto j = jet<1>(m.faces[0].surface, middle.c);
        count += !(dot(n, cross(j.d[1], j.d[2])) > 0);
    }
    return count;
}

// The rectangle from the origin to `to`, less small triangles here and there.
std::vector<std::vector<CurveGeometry<2>>> with_holes(Random& rng, Vec<2> to) {
    std::vector<std::vector<CurveGeometry<2>>> loops{polygon({{}, {{to[0], 0}}, to, {{0, to[1]}}})};
    const int nu = rng.integer(2, 20), nv = rng.integer(1, 8);
    for (int i = 0; i < nu; ++i)
        for (int k = 0; k < nv; ++k) {
            const Vec<2> at{
                {to[0] * (i + rng.real(0.2, 0.8)) / nu, to[1] * (0.1 + k + rng.real(0.1, 0.8)) / (nv + 1)}};
            loops.push_back(polygon({at, at + Vec<2>{{0, 0.01 / nv}}, at + Vec<2>{{0.02 / nu, 0}}}));
        }
    return loops;
}

// Straight sides of the parameter plane bow in space.
TEST(TessellateEconomy, cones_may_be_trimmed_anyhow) {
    const double tolerance = 1e-4, around = steps(2 * kPi, 1, tolerance);
    const std::vector<std::vector<CurveGeometry<2>>> loops{
        polygon({{{0.1, 0.02}}, {{3.8, 0.3}}, {{3.5, 0.9}}, {{0.2, 0.6}}})};
    ModelBuilder builder;
    ASSERT_TRUE(builder.add_trimmed(wall(0.2, 0, 1), loops));
    const Model m = *std::move(builder).finish();
    const auto t = tessellate(m, {.tolerance = tolerance});
    ASSERT_TRUE(t && t->refused.empty());
    EXPECT_LE(t->error_bound, tolerance);
    EXPECT_LE(double(t->mesh.triangles.size()), 3 * around);
    EXPECT_LE(sampled_deviation(m, *t, 6), t->error_bound + t->boundary_gap);
    EXPECT_EQ(turned_over(m, *t, tolerance), 0);
    const auto d = deviation(m, t->mesh, {.enough = tolerance, .max_parts = 20'000});
    ASSERT_TRUE(d);
    EXPECT_LE(d->measured, t->error_bound + t->boundary_gap);
}

// A point between holes may be on one side of a line in the parameter plane, and on the other side of the
// line in space.
TEST(TessellateEconomy, triangles_between_holes_of_cones_do_not_turn_over) {
    // Most of these would have some that do, if nothing was done about it.
    for (const std::uint64_t round : {1, 23, 107, 127, 135, 137, 205, 300, 336}) {
        Random rng(round);
        const double tolerance = std::exp2(rng.real(-11, -5));
        const auto loops = with_holes(rng, {{4, 1}});
        ModelBuilder builder;
        ASSERT_TRUE(builder.add_trimmed(wall(0.2, 0, 1, round % 4 == 1 ? 0.05 : 3), loops));
        const Model m = *std::move(builder).finish();
        const auto t = tessellate(m, {.tolerance = tolerance});
        ASSERT_TRUE(t && t->refused.empty()) << round;
        EXPECT_LE(sampled_deviation(m, *t, 3), t->error_bound + t->boundary_gap) << round;
        EXPECT_EQ(turned_over(m, *t, tolerance), 0) << round;
    }
}

// A face of the surface within these loops of parameters, whose edges have no curves of their own.
Model trimmed(const SurfaceGeometry& surface, const std::vector<std::vector<CurveGeometry<2>>>& loops) {
    Model m;
    Face f;
    f.surface = surface;
    for (const auto& loop : loops) {
        const int first = int(m.vertices.size()), n = int(loop.size());
        Loop l;
        for (int i = 0; i < n; ++i) {
            const auto& c = loop[std::size_t(i)];
            m.vertices.push_back({jet<0>(surface, jet<0>(c, 0).value().c).value(), 0});
            l.coedges.push_back({int(m.edges.size()), false, c});
            m.edges.push_back({{}, false, {0, 1}, first + i, first + (i + 1) % n, 0, ""});
        }
        f.loops.push_back(std::move(l));
    }
    m.faces = {f};
    return m;
}

// Anywhere, near poles, and with long slanting sides, which are no great circles.
TEST(TessellateEconomy, spheres_may_be_trimmed_anyhow) {
    const Revolution sphere{
        Conic<3>{ConicKind::ellipse, {}, {{2, 0, 0}}, {{0, 0, 2}}}, {}, {{0, 0, 1}}, SurfaceKind::sphere};
    for (int round = 0; round < 40; ++round) {
        Random rng(std::uint64_t(round + 1));
        const double tolerance = std::exp2(rng.real(-12, -3)), wide = rng.real(0.2, 6),
                     tall = rng.real(0.1, 1.2);
        const Vec<2> from{{rng.real(0, 6), round % 3 ? rng.real(-1.5, 1.5 - tall) : kPi / 2 - 1e-3 - tall}};
        auto loops = with_holes(rng, {{wide, tall}});
        if (round % 4 == 0)
            loops[0] =
                polygon({{{0, 0}}, {{wide, tall / 4}}, {{0.9 * wide, tall}}, {{0.1 * wide, 0.7 * tall}}}),
            loops.resize(1);
        for (auto& loop : loops)
            for (auto& c : loop) c = translated(c, from);
        const Model m = trimmed(sphere, loops);
        const auto t = tessellate(m, {.tolerance = tolerance});
        ASSERT_TRUE(t && t->refused.empty()) << round;
        EXPECT_LE(t->error_bound, tolerance) << round;
        EXPECT_LE(sampled_deviation(m, *t, 4), t->error_bound + t->boundary_gap) << round;
        EXPECT_EQ(turned_over(m, *t, tolerance), 0) << round;
        double deepest = 2;  // of the mesh
        for (std::size_t i = 0; i < t->mesh.triangles.size(); ++i) {
            const auto [a, b, c] = t->mesh.points_of(i);
            const auto at = [&](int k) { return t->mesh.points[std::size_t(k)]; };
            deepest = std::min(deepest, norm((1.0 / 3) * (at(a) + at(b) + at(c))));
        }
        EXPECT_LE(2 - deepest, t->error_bound) << round;
    }
}

// The curve has a corner, where no chord may reach over.
TEST(TessellateEconomy, cones_of_curves_with_corners_keep_the_bound) {
    std::vector<Vec<3>> c;
    const Vec<3> apex{{1, 1, 3}};
    for (const Vec<3>& far :
         std::vector<Vec<3>>{{{0, 0, 0}}, {{1, -0.4, 0}}, {{2, 0, 0}}, {{2.4, 1, 0}}, {{2, 2, 0}}}) {
        c.push_back(apex + 0.2 * (far - apex));
        c.push_back(far);
    }
    const auto s =
        *Surface<Vec<3>>::make({*BSplineBasis::make(2, {0, 0, 0, 1, 1, 2, 2, 2}), *BSplineBasis::bezier(1)},
                               Net<2, Vec<3>>({5, 2}, c));
    Random rng(2);
    for (int round = 0; round < 20; ++round) {
        ModelBuilder builder;
        ASSERT_TRUE(builder.add_trimmed(s, with_holes(rng, {{2, 1}})));
        const Model m = *std::move(builder).finish();
        const auto t = tessellate(m, {.tolerance = 1e-2});
        ASSERT_TRUE(t && t->refused.empty());
        EXPECT_LE(t->error_bound, 1e-2);
        EXPECT_LE(sampled_deviation(m, *t, 6), t->error_bound + t->boundary_gap) << round;
    }
}

TEST(TessellateEconomy, spheres_of_any_size_take_as_many_triangles) {
    for (const double r : {1e6, 1e-5}) {
        const double tolerance = std::ldexp(r, -7);
        const Model m = test::sphere({}, r);
        const auto t = tessellate(m, {.tolerance = tolerance});
        ASSERT_TRUE(t);
        EXPECT_LE(t->error_bound, tolerance);
        // Equilateral triangles with a circumradius of sqrt(2 r tolerance) have the area 2.6 r tolerance.
        const double least = 4 * kPi * r / (2.6 * tolerance);
        EXPECT_LE(double(t->mesh.triangles.size()), 2.5 * least);
        const double deviation = sampled_deviation(m, *t, 3);
        EXPECT_LE(deviation, t->error_bound + t->boundary_gap);
        EXPECT_GE(deviation, 0.4 * tolerance);
    }
}

// Files with ten digits have poles a little beyond where they are.
TEST(TessellateEconomy, spheres_a_hair_beyond_their_poles_take_as_many_triangles) {
    const Model exact = test::sphere({}, 2);
    Model written = exact;
    for (Coedge& c : written.faces[0].loops[0].coedges) {
        auto& line = std::get<Line<2>>(c.curve);
        const bool pole = written.edges[std::size_t(c.edge)].degenerate;
        if (pole) line.origin[1] *= 1 + 1e-9;
        if (!pole) line.origin[1] *= 1 + 1e-9, line.direction[1] *= 1 + 1e-9;
    }
    for (const double tolerance : {1e-2, 1e-3}) {
        const auto a = tessellate(exact, {.tolerance = tolerance}),
                   b = tessellate(written, {.tolerance = tolerance});
        ASSERT_TRUE(a && b && b->refused.empty());
        EXPECT_LE(b->error_bound, tolerance);
        EXPECT_LE(double(b->mesh.triangles.size()), 1.05 * double(a->mesh.triangles.size()));
        EXPECT_EQ(b->topology.open_edges, 0);
        EXPECT_LE(sampled_deviation(written, *b, 4), b->error_bound + b->boundary_gap);
    }
}

// Rational surfaces move points along themselves; here with poles, kinks in speed, and ends of all kinds.
TEST(TessellateEconomy, bounds_hold_where_points_move_along_the_surface) {
    Random rng(31);
    for (int round = 0; round < 2; ++round) {
        const auto basis = *BSplineBasis::clamped_uniform(round % 2 ? 2 : 3, 6);
        const double bend = rng.real(0.8, 1.5), lean = rng.real(-0.5, 0.5);
        std::vector<Hom<3>> c;
        for (int i = 0; i < 6; ++i)
            for (int k = 0; k < 6; ++k) {
                const double w = std::exp2(rng.real(-0.3, 0.3)), angle = bend * i / 5.0,
                             r = 1 + lean * k / 5.0 + 0.003 * rng.real(-1, 1);
                const double slide = rng.real(-0.02, 0.02);
                c.push_back(weighted(
                    Vec<3>{{r * std::cos(angle + slide), r * std::sin(angle + slide), 0.4 * k + 2 * slide}},
                    w));
            }
        ModelBuilder builder;
        ASSERT_TRUE(builder.add(*Surface<Hom<3>>::make({basis, basis}, Net<2, Hom<3>>({6, 6}, c))));
        const auto model = std::move(builder).finish();
        ASSERT_TRUE(model);
        const double tolerance = std::ldexp(0.004, -2 * round);
        const auto t = tessellate(*model, {.tolerance = tolerance});
        ASSERT_TRUE(t);
        ASSERT_TRUE(t->refused.empty()) << t->refused[0].reason.message;
        EXPECT_LE(t->error_bound, tolerance);
        const double found = sampled_deviation(*model, *t, 4);
        EXPECT_LE(found, t->error_bound + t->boundary_gap) << round;
        EXPECT_GE(found, 0.2 * tolerance) << round;
        const auto d = deviation(*model, t->mesh, {.enough = tolerance, .max_parts = 300});
        ASSERT_TRUE(d);
        EXPECT_LE(d->measured, t->error_bound + t->boundary_gap) << round;
    }
}

// A quarter of a torus tube: arcs of a quarter of a circle, `arcs` of them with double knots between, about
// the z-axis at the distance 3; coordinates are rounded to multiples of `grain`.
Surface<Hom<3>> bow(int arcs, double grain) {
    std::vector<double> knots{0, 0, 0};
    for (int i = 1; i < arcs; ++i) knots.insert(knots.end(), 2, double(i));
    knots.insert(knots.end(), 3, double(arcs));
    const auto along = *BSplineBasis::make(2, knots);
    const double corner[5][2] = {{1, 0}, {1, 1}, {0, 1}, {-1, 1}, {-1, 0}}, w[3] = {1, std::sqrt(0.5), 1};
    std::vector<Hom<3>> c;
    for (int i = 0; i <= 2 * arcs; ++i)
        for (int k = 0; k < 3; ++k) {
            const double r = 3 + corner[k][0];
            const double x = r * corner[i][0], y = r * corner[i][1], turn = 0.3;
            Vec<3> p{{std::cos(turn) * x - std::sin(turn) * y, std::sin(turn) * x + std::cos(turn) * y,
                      corner[k][1]}};
            for (double& at : p.c) at = grain > 0 ? std::round(at / grain) * grain : at;
            c.push_back(weighted(p, w[i % 2] * w[k % 2]));
        }
    return *Surface<Hom<3>>::make({along, *BSplineBasis::bezier(2)}, Net<2, Hom<3>>({2 * arcs + 1, 3}, c));
}

TEST(TessellateEconomy, knots_that_are_kinks_by_the_digits_of_a_file_cost_nothing) {
    const auto triangles = [](const Surface<Hom<3>>& s, double tolerance) {
        ModelBuilder builder;
        EXPECT_TRUE(builder.add(s));
        const Model m = *std::move(builder).finish();
        const auto t = tessellate(m, {.tolerance = tolerance});
        EXPECT_TRUE(t && t->refused.empty());
        EXPECT_LE(t->error_bound, tolerance);
        const double deviation = sampled_deviation(m, *t, 3);
        EXPECT_LE(deviation, t->error_bound + t->boundary_gap);
        EXPECT_GE(deviation, 0.3 * tolerance);
        return double(t->mesh.triangles.size());
    };
    const double one = triangles(bow(1, 0), 1e-3), rounded = triangles(bow(2, 1e-7), 1e-3);
    EXPECT_LE(rounded, 2.3 * one);
    EXPECT_GE(triangles(bow(2, 1e-4), 1e-3), 1.25 * rounded) << "kinks that matter are still kinks";
}

// Lines from a point to points that are on a straight one but for some digits, or that cross a little before
// it: a flat fan.
Surface<Vec<3>> fan(double digits, double beyond) {
    const auto basis = *BSplineBasis::clamped_uniform(3, 8);
    const Vec<3> apex{{1, 1.5, 0}};
    std::mt19937 rng(9);
    std::vector<Vec<3>> c;
    for (int i = 0; i < 8; ++i) {
        Vec<3> p{{2 * greville(basis, i), 0, 0}};
        for (int k = 0; k < 3; ++k) p[k] += digits * uniform(rng, -1, 1);
        c.push_back(p), c.push_back(apex - beyond * (p - apex));
    }
    return *Surface<Vec<3>>::make({basis, *BSplineBasis::bezier(1)}, Net<2, Vec<3>>({8, 2}, c));
}

TEST(TessellateEconomy, flat_fans_of_few_digits_take_a_triangle_for_each_chord) {
    for (const double digits : {0.0, 1e-9, 1e-6, 8e-6}) {
        ModelBuilder builder;
        ASSERT_TRUE(builder.add(fan(digits, 0)));
        const auto t = tessellate(*std::move(builder).finish(), {.tolerance = 1e-3});
        ASSERT_TRUE(t && t->refused.empty());
        EXPECT_LE(t->error_bound, 1e-3);
        EXPECT_LE(t->mesh.triangles.size(), 4u) << digits;
    }
}

TEST(TessellateEconomy, lines_that_cross_just_before_the_end_of_their_row_cross_at_it) {
    for (const double beyond : {1e-12, 1e-8, 1e-6}) {
        const auto apex = apex_of(fan(0, beyond));
        ASSERT_TRUE(apex) << beyond;
        EXPECT_EQ(apex->at, 1) << beyond;
        EXPECT_GE(apex->slip, beyond * 1.4);
        EXPECT_LE(apex->slip, beyond * 6 + 1e-12);
    }
    EXPECT_FALSE(apex_of(fan(0, 1e-2)) && apex_of(fan(0, 1e-2))->at == 1);
}

// What numbers far from zero are rounded by is small beside what surfaces bend: normals are known there.
TEST(TessellateEconomy, far_from_the_origin_there_are_no_more_triangles) {
    std::mt19937 rng(5);
    const Surface<Vec<3>> sheet = landscape(rng, 3, 14, 0.6);
    double size = 0;
    for (const Vec<3>& p : sheet.net().flat()) size = std::max(size, norm(p));
    const auto moved_torus = [](const Vec<3>& by) {
        Model m = torus(10, 2);
        for (Vertex& v : m.vertices) v.point += by;
        for (Edge& e : m.edges) std::get<Conic<3>>(*e.curve).centre += by;
        auto& s = std::get<Revolution>(m.faces[0].surface);
        s.origin += by, std::get<Conic<3>>(s.profile).centre += by;
        return m;
    };
    const auto moved_sheet = [&](const Vec<3>& by) {
        Net<2, Vec<3>> net = sheet.net();
        for (Vec<3>& p : net.flat()) p += by;
        ModelBuilder builder;
        EXPECT_TRUE(builder.add(*Surface<Vec<3>>::make(sheet.bases(), net)));
        return *std::move(builder).finish();
    };
    const auto count = [&](const Model& m, double tolerance) {
        const auto t = tessellate(m, {.tolerance = tolerance});
        EXPECT_TRUE(t && t->refused.empty());
        const auto d = deviation(m, t->mesh, {.enough = tolerance, .max_parts = 40});
        EXPECT_TRUE(d && d->measured <= t->error_bound + t->boundary_gap);
        return double(t->mesh.triangles.size());
    };
    const double here = count(moved_torus({}), 0.05), sheet_here = count(moved_sheet({}), 4e-3 * size);
    for (const double far : {1e3, 1e5}) {
        EXPECT_LT(count(moved_torus(far * Vec<3>{{7, -6, 4}}), 0.05), 1.02 * here) << far;
        EXPECT_LT(count(moved_sheet((0.002 * far * size) * Vec<3>{{7, -6, 4}}), 4e-3 * size),
                  1.02 * sheet_here)
            << far;
    }
}

}  // namespace
