#include "support/random.hpp"
#include "support/shapes.hpp"
#include "support/solids.hpp"

#include <freiform/core/parallel.hpp>
#include <freiform/model/deviation.hpp>
#include <freiform/model/swept_solid.hpp>

#include <gtest/gtest.h>

using namespace freiform;
using namespace freiform::test;

namespace {

TriangleMesh mesh_of(std::vector<Vec<3>> points, std::vector<std::array<int, 3>> triangles) {
    TriangleMesh m;
    m.points = std::move(points);
    for (std::size_t i = 0; i < m.points.size(); ++i) m.vertices.push_back({int(i), {}, {}});
    m.triangles = std::move(triangles);
    return m;
}

// The corners on the axes at distance r.
TriangleMesh octahedron(double r) {
    return mesh_of({{{r, 0, 0}}, {{0, r, 0}}, {{-r, 0, 0}}, {{0, -r, 0}}, {{0, 0, r}}, {{0, 0, -r}}},
                   {{0, 1, 4}, {1, 2, 4}, {2, 3, 4}, {3, 0, 4}, {1, 0, 5}, {2, 1, 5}, {3, 2, 5}, {0, 3, 5}});
}

// [0, 1]^2 at z = 0, with a round hole of this radius in the middle; none for
// 0.
Model plate(double hole) {
    Model m;
    const Vec<3> at[4] = {{{0, 0, 0}}, {{1, 0, 0}}, {{1, 1, 0}}, {{0, 1, 0}}};
    Face f;
    f.surface = Extrusion{Line<3>{{}, {{1, 0, 0}}}, {{0, 1, 0}}, SurfaceKind::plane};
    f.loops.resize(1);
    for (int i = 0; i < 4; ++i) {
        const Vec<3> from = at[i], to = at[(i + 1) % 4];
        m.vertices.push_back({from, 0});
        m.edges.push_back({Line<3>{from, to - from}, false, {0, 1}, i, (i + 1) % 4, 0, ""});
        f.loops[0].coedges.push_back({i, false, segment({0, 1}, {{from[0], from[1]}}, {{to[0], to[1]}})});
    }
    if (hole > 0) {
        m.vertices.push_back({{{0.5 + hole, 0.5, 0}}, 0});
        m.edges.push_back({Conic<3>{ConicKind::ellipse, {{0.5, 0.5, 0}}, {{hole, 0, 0}}, {{0, hole, 0}}},
                           false,
                           {0, 2 * kPi},
                           4,
                           4,
                           0,
                           ""});
        f.loops.push_back(
            {{{4, true, Conic<2>{ConicKind::ellipse, {{0.5, 0.5}}, {{hole, 0}}, {{0, hole}}}}}});
    }
    m.faces = {f};
    m.shells = {{{{0, false}}, false}};
    m.bodies = {{{0}, false, "", {}}};
    return *make_model(std::move(m));
}
TriangleMesh square(double z) {
    return mesh_of({{{0, 0, z}}, {{1, 0, z}}, {{1, 1, z}}, {{0, 1, z}}}, {{0, 1, 2}, {0, 2, 3}});
}

// Over the unit square, with a bump under about a fiftieth of it.
Surface<Vec<3>> bump(double control_height) {
    const auto basis = *BSplineBasis::clamped_uniform(3, 24);
    std::vector<Vec<3>> c;
    for (int i = 0; i < 24; ++i)
        for (int j = 0; j < 24; ++j)
            c.push_back({{i / 23.0, j / 23.0, i == 13 && j == 7 ? control_height : 0.0}});
    return *Surface<Vec<3>>::make({basis, basis}, Net<2, Vec<3>>({24, 24}, c));
}
Model one_face_each(const std::vector<Surface<Vec<3>>>& surfaces) {
    ModelBuilder builder;
    for (const auto& s : surfaces) EXPECT_TRUE(builder.add(s));
    return std::move(builder).finish().value();
}

TEST(Deviation, of_an_octahedron_from_its_sphere_is_known) {
    const double known = 1 - 1 / std::sqrt(3.0);  // at the middles of its triangles
    for (const double r : {1.0, 0.001, 4096.0}) {
        const auto d = deviation(test::sphere({}, r), octahedron(r), {});
        ASSERT_TRUE(d) << d.error().message;
        EXPECT_LE(d->measured, known * r * (1 + 1e-12));
        EXPECT_GE(d->measured, known * r * 0.98);
        EXPECT_GE(d->bound, known * r);
        EXPECT_LE(d->bound, known * r * 1.11);
        EXPECT_NEAR(norm(d->faces[0].at), r, 1e-12 * r);
        EXPECT_NEAR(d->mesh_measured, known * r, 2 * d->accuracy);
        EXPECT_LE(d->accuracy, d->measured / 8);
    }
}

TEST(Deviation, of_a_mesh_beside_a_plane_is_the_shift) {
    const auto d = deviation(plate(0), square(-0.25), {});
    ASSERT_TRUE(d);
    EXPECT_NEAR(d->measured, 0.25, 1e-15);
    EXPECT_GE(d->bound, 0.25);
    EXPECT_LE(d->bound, 0.25 * 1.1000001);
    EXPECT_NEAR(d->mesh_measured, 0.25, 1e-15);
}

TEST(Deviation, a_hole_that_the_mesh_fills_is_seen_from_the_mesh_alone) {
    const auto d = deviation(plate(0.2), square(0), {.enough = 0.01, .max_parts = 20'000});
    ASSERT_TRUE(d);
    EXPECT_LE(d->measured, 1e-15);
    EXPECT_LE(d->bound, 0.01);
    EXPECT_LE(d->mesh_measured, 0.2 + 1e-12);
    EXPECT_GE(d->mesh_measured, 0.15) << "within " << d->accuracy;
}

TEST(Deviation, a_triangle_that_is_missing_is_seen_from_the_model) {
    const auto d = deviation(plate(0), mesh_of({{{0, 0, 0}}, {{1, 0, 0}}, {{1, 1, 0}}}, {{0, 1, 2}}), {});
    ASSERT_TRUE(d);
    EXPECT_LE(d->measured,
              std::sqrt(0.5) + 1e-15);  // the corner (0, 1) from the diagonal
    EXPECT_GE(d->measured, 0.98 * std::sqrt(0.5));
    EXPECT_GE(d->bound, std::sqrt(0.5));
    EXPECT_LE(d->mesh_measured, 1e-15);
}

TEST(Deviation, a_narrow_bump_under_a_flat_mesh_is_found) {
    const auto surface = bump(0.01);
    const auto model = one_face_each({surface});
    double height = 0;
    const auto on = surface.domain();
    for (int i = 0; i <= 400; ++i)
        for (int j = 0; j <= 400; ++j)
            height = std::max(
                height, surface(on[0].lo + on[0].length() * i / 400, on[1].lo + on[1].length() * j / 400)[2]);
    const auto d = deviation(model, square(0), {.max_parts = 30'000});
    ASSERT_TRUE(d);
    EXPECT_GE(d->measured, 0.9 * height);
    EXPECT_GE(d->bound, height);
    EXPECT_LE(d->bound, 1.15 * height);
}

TEST(Deviation, agrees_with_what_the_tessellation_proves) {
    const Model models[] = {test::sphere({{1, 2, 3}}, 2), test::torus(3, 1), frustum(2, 0, 3), plate(0.3)};
    for (const Model& m : models)
        for (const double tolerance : {0.05, 0.02}) {
            const auto t = tessellate(m, {.tolerance = tolerance});
            ASSERT_TRUE(t);
            const auto d = deviation(m, t->mesh, {.enough = tolerance, .max_parts = 40'000});
            ASSERT_TRUE(d) << d.error().message;
            EXPECT_LE(d->measured, t->error_bound + t->boundary_gap);
            EXPECT_GE(d->bound, d->measured);
            EXPECT_LE(d->bound, tolerance * 1.0000001) << "proven from the outside too";
            EXPECT_LE(d->mesh_measured, t->error_bound + t->boundary_gap + d->accuracy);
        }
}

TEST(Deviation, a_tolerance_just_above_what_is_measured_is_decided) {
    const double enough = 1.02 * (1 - 1 / std::sqrt(3.0));
    const auto d = deviation(test::sphere({}, 1), octahedron(1), {.enough = enough});
    ASSERT_TRUE(d);
    EXPECT_LE(d->bound, enough);
}

TEST(Deviation, what_easy_faces_leave_is_spent_on_the_others) {
    const double enough = 0.0053;  // the bump is 0.0044 high
    TriangleMesh mesh = square(0);
    for (Vec<3>& p : mesh.points) p = 3.0 * p - Vec<3>{{1, 1, 0}};
    const auto linear = *BSplineBasis::clamped_uniform(1, 2);
    const auto flat = *Surface<Vec<3>>::make(
        {linear, linear}, Net<2, Vec<3>>({2, 2}, {{{0, 0, 0}}, {{0, 1, 0}}, {{1, 0, 0}}, {{1, 1, 0}}}));
    std::vector<Surface<Vec<3>>> surfaces{bump(0.01)};
    const auto alone = deviation(one_face_each(surfaces), mesh, {.enough = enough, .max_parts = 1000});
    ASSERT_TRUE(alone);
    ASSERT_LE(alone->bound, enough);
    surfaces.resize(20, flat);
    std::vector<MeshDeviation> all;
    for (const int threads : {1, 3}) {
        set_max_threads(threads);
        double last = 0;
        const auto tell = [&](double p) {
            if (threads > 1) return true;
            EXPECT_GE(p, last);
            EXPECT_LE(p, 1);
            last = p;
            return true;
        };
        all.push_back(*deviation(one_face_each(surfaces), mesh,
                                 {.enough = enough, .max_parts = 1000 + 20, .progress = tell}));
    }
    set_max_threads(0);
    EXPECT_LE(all[0].bound, enough);
    EXPECT_EQ(all[0].bound, all[1].bound);
    EXPECT_EQ(all[0].parts, all[1].parts);
}

TEST(Deviation, does_not_depend_on_the_number_of_threads) {
    const Model m = frustum(2, 1, 3);
    const auto t = tessellate(m, {.tolerance = 0.05});
    std::vector<MeshDeviation> all;
    for (const int threads : {1, 3}) {
        set_max_threads(threads);
        all.push_back(*deviation(m, t->mesh, {.max_parts = 3000}));
    }
    set_max_threads(0);
    EXPECT_EQ(all[0].measured, all[1].measured);
    EXPECT_EQ(all[0].bound, all[1].bound);
    EXPECT_EQ(all[0].mesh_measured, all[1].mesh_measured);
    EXPECT_EQ(all[0].parts, all[1].parts);
}

TEST(Deviation, work_is_limited_and_the_bound_stays_one) {
    const double known = 1 - 1 / std::sqrt(3.0);
    double last = INFINITY;
    for (const std::size_t parts : {1u, 100u, 1000u, 20000u}) {
        const auto d = deviation(test::sphere({}, 1), octahedron(1), {.max_parts = parts});
        ASSERT_TRUE(d);
        EXPECT_GE(d->bound, known);
        EXPECT_LE(d->bound, last);
        last = d->bound;
    }
    EXPECT_LE(last, 1.11 * known);
}

TEST(Deviation, refuses_what_has_no_answer) {
    EXPECT_EQ(deviation(plate(0), TriangleMesh{}, {}).error().where, "mesh");
    EXPECT_EQ(deviation(Model{}, square(0), {}).error().where, "model");
    EXPECT_EQ(deviation(plate(0), square(0), {.enough = NAN}).error().where, "enough");
    EXPECT_EQ(deviation(plate(0), square(0), {.progress = [](double) { return false; }}).error().kind,
              RefusalKind::limit);
    EXPECT_FALSE(distances_from_model(plate(0), {}, 0));
}

TEST(Deviation, distances_of_points_are_within_the_accuracy) {
    const std::vector<Vec<3>> points{{{0.5, 0.5, 0}}, {{0.5, 0.5, 2}}, {{0.1, 0.1, -1}}, {{2, 0.5, 0}}};
    const double hole = 0.3, accuracy = 0.01;
    const auto d = distances_from_model(plate(hole), points, accuracy);
    ASSERT_TRUE(d);
    const double known[] = {hole, std::hypot(hole, 2), 1, 1};
    for (std::size_t i = 0; i < 4; ++i) EXPECT_NEAR((*d)[i], known[i], accuracy) << i;
}

// Flat faces with straight edges need few parts, however they lie.
TEST(Deviation, is_known_exactly_and_soon_where_mesh_and_model_are_the_same) {
    const std::vector<Vec<2>> corners{{{0, 0}}, {{3, 0.5}}, {{2, 1}}, {{2.5, 2}}, {{0.3, 1.7}}};
    std::vector<CurveGeometry<2>> loop;
    for (std::size_t k = 0; k < corners.size(); ++k)
        loop.push_back(
            must(Curve<Vec<2>>::make({must(BSplineBasis::bezier(1))},
                                     Net<1, Vec<2>>({2}, {corners[k], corners[(k + 1) % corners.size()]}))));
    const Model m = must(prism({loop}, {{0.3, 0.2, 1}}));
    const MeshDeviation d = must(deviation(m, must(tessellate(m, {.tolerance = 1e-2})).mesh, {}));
    EXPECT_LE(d.bound, 1e-9);
    EXPECT_LE(d.mesh_measured, 1e-9);
    EXPECT_LE(d.overhang, 1e-5);
    EXPECT_LE(d.parts, 20000u);
}

// Such as blends of files whose splines go on beyond their faces and are wild there: what the whole surface
// does says nothing about how closely the boundary has to be known.
TEST(Deviation, is_bounded_closely_where_the_surface_is_wild_beyond_the_face) {
    const auto v = must(BSplineBasis::make(3, {0, 0, 0, 0, 0.25, 0.5, 0.75, 0.9999, 1, 1, 1, 1}));
    const double y[] = {0, 0.1, 0.25, 0.5, 0.75, 0.9, 1, 1e9};
    Net<2, Vec<3>> net({2, 8});
    for (int i = 0; i < 2; ++i)
        for (int j = 0; j < 8; ++j) net.view()({i, j}) = {{double(i), y[j], 0.1 * y[j] * (j < 7) * i}};
    const auto surface = must(Surface<Vec<3>>::make({must(BSplineBasis::make(1, {0, 0, 1, 1})), v}, net));
    std::vector<Vec<2>> loop;
    constexpr int kPoints = 40;
    for (int k = 0; k <= kPoints; ++k) {
        const double a = 2 * kPi * k / kPoints, r = 0.25 + 0.05 * std::cos(5 * a);
        loop.push_back({{0.5 + r * std::cos(a), 0.35 + r * std::sin(a)}});
    }
    std::vector<double> knots(4, 0.0);
    for (int k = 1; k <= kPoints - 3; ++k) knots.push_back(double(k) / (kPoints - 2));
    knots.insert(knots.end(), 4, 1.0);
    const CurveGeometry<2> boundary =
        must(Curve<Vec<2>>::make({must(BSplineBasis::make(3, knots))}, Net<1, Vec<2>>({kPoints + 1}, loop)));
    ModelBuilder builder;
    must(builder.add_trimmed(surface, std::vector<std::vector<CurveGeometry<2>>>{{boundary}}));
    const Model m = must(std::move(builder).finish());
    const auto t = must(tessellate(m, {.tolerance = 1e-3}));
    ASSERT_TRUE(t.refused.empty());
    const MeshDeviation d = must(deviation(m, t.mesh, {.max_parts = 20000}));
    EXPECT_LE(d.measured, t.error_bound + t.boundary_gap);
    EXPECT_LE(d.bound, 1.2 * d.measured);
}

}  // namespace
