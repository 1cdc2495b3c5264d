// Demands on single triangles: how far normals turn, and their shape; several tolerances at once.
#include "support/shapes.hpp"
#include "support/solids.hpp"

#include <freiform/mesh/normal_cone.hpp>

#include <gtest/gtest.h>
#include <support/random.hpp>
#include <support/sanitizer.hpp>

using namespace freiform;
using namespace freiform::test;

namespace {

constexpr double kDegree = kPi / 180;

// The largest angle between a triangle and normals of the surface at samples; triangles with `skip` left out.
double sampled_angle(const Model& model, const Tessellation& t) {
    double most = 0;
    for (const MeshPart& part : t.mesh.parts) {
        const Face& face = model.faces[std::size_t(part.face)];
        for (int i = part.first; i < part.first + part.count; ++i) {
            const auto& tri = t.mesh.triangles[std::size_t(i)];
            const Vec<3> m = triangle_normal(t.mesh, std::size_t(i));
            for (int x = 0; x <= 6; ++x)
                for (int y = 0; x + y <= 6; ++y) {
                    const auto uv = [&](int k) {
                        return t.mesh.vertices[std::size_t(tri[std::size_t(k)])].uv;
                    };
                    const Vec<2> at = (1 - (x + y) / 6.0) * uv(0) + (x / 6.0) * uv(1) + (y / 6.0) * uv(2);
                    Vec<3> n = normal(face.surface, at.c);
                    if (face.reversed) n = -n;
                    if (norm(n) > 0.5) most = std::max(most, std::atan2(norm(cross(m, n)), dot(m, n)));
                }
        }
    }
    return most;
}

TEST(TessellateShapes, normals_turn_by_no_more_than_asked_for) {
    std::mt19937 rng(5);
    ModelBuilder builder;
    ASSERT_TRUE(builder.add(landscape(rng, 3, 5, 0.1)));
    const double wanted = 14 * kDegree;
    for (const Model& m : {torus(3, 1), frustum(2, 1, 3), *std::move(builder).finish()}) {
        const double tolerance = summary(m).box.diagonal() / 200;
        const auto t = tessellate(m, {.tolerance = tolerance, .max_angle = wanted});
        ASSERT_TRUE(t) << t.error().message;
        EXPECT_TRUE(t->refused.empty());
        // Triangles between points of the boundary alone may be beyond help.
        EXPECT_LE(t->angle_exceeded, 3);
        EXPECT_GE(t->angle_bound, wanted / 4) << "finer than asked for";
        EXPECT_LE(sampled_angle(m, *t), t->angle_bound);
        if (t->angle_exceeded == 0) {
            EXPECT_LE(t->angle_bound, wanted);
        }
        const auto plain = tessellate(m, {.tolerance = tolerance});
        EXPECT_LT(t->angle_exceeded == 0 ? sampled_angle(m, *t) : 0.0, sampled_angle(m, *plain));
        EXPECT_EQ(plain->angle_bound, 0) << "nothing is claimed";
        if (summary(m).open_edges == 0) {
            EXPECT_EQ(t->topology.open_edges + t->topology.non_manifold_edges, 0);
        }
    }
}

// Beside a seam, the chords of which may be a little longer than the leaves are wide.
TEST(TessellateShapes, normals_turn_as_little_beside_given_sides_at_any_tolerance) {
    const Model m = torus(3, 1);
    for (int i = -20; i <= 20; ++i) {
        const double tolerance = summary(m).box.diagonal() / 200 * (1 + 0.005 * i);
        const auto t = tessellate(m, {.tolerance = tolerance, .max_angle = 14 * kDegree});
        ASSERT_TRUE(t) << t.error().message;
        EXPECT_EQ(t->angle_exceeded, 0) << tolerance;
    }
}

// As large as the model: the angle alone says what the triangles are.
TEST(TessellateShapes, angles_are_kept_within_tolerances_that_are_coarse) {
    std::mt19937 rng(5);
    ModelBuilder builder;
    ASSERT_TRUE(builder.add(landscape(rng, 3, 5, 0.1)));
    for (const Model& m : {torus(3, 1), frustum(2, 1, 3), *std::move(builder).finish()}) {
        std::size_t before = 0;
        for (const double wanted : {20 * kDegree, 10 * kDegree}) {
            const auto t = tessellate(m, {.tolerance = summary(m).box.diagonal(), .max_angle = wanted});
            ASSERT_TRUE(t) << t.error().message;
            EXPECT_LE(t->angle_exceeded, 3);
            EXPECT_LE(sampled_angle(m, *t), t->angle_bound);
            EXPECT_LT(t->mesh.triangles.size(), 30000u);
            EXPECT_GT(t->mesh.triangles.size(), before);
            before = t->mesh.triangles.size();
        }
    }
}

TEST(TessellateShapes, what_has_no_normal_is_reported) {
    const double wanted = 12 * kDegree;
    for (const Model& m : {test::sphere({}, 1), frustum(2, 0, 3)}) {
        const auto t = tessellate(m, {.tolerance = 0.05, .max_angle = wanted});
        ASSERT_TRUE(t);
        EXPECT_GT(t->angle_exceeded, 0) << "at the pole nothing is proven";
        EXPECT_LT(t->angle_exceeded, 200);
        EXPECT_LT(t->mesh.triangles.size(), 8000u);
        EXPECT_NEAR(t->angle_bound, kPi, 1e-12);
        EXPECT_EQ(t->topology.open_edges + t->topology.non_manifold_edges, 0);
    }
}

Model moved_frustum(const Vec<3>& by) {
    Model m = frustum(2, 1, 3);
    for (Vertex& v : m.vertices) v.point += by;
    const auto move = [&](CurveGeometry<3>& c) {
        if (auto* l = std::get_if<Line<3>>(&c)) l->origin += by;
        if (auto* k = std::get_if<Conic<3>>(&c)) k->centre += by;
    };
    for (Edge& e : m.edges) move(*e.curve);
    for (Face& f : m.faces) {
        if (auto* r = std::get_if<Revolution>(&f.surface)) move(r->profile), r->origin += by;
        if (auto* x = std::get_if<Extrusion>(&f.surface)) move(x->profile);
    }
    return m;
}

// Far from the origin nothing is known of normals over lengths that would do: more triangles are of no help.
TEST(TessellateShapes, where_rounding_hides_normals_no_triangles_are_made_for_them) {
    for (const double far : {0.0, 3e5}) {
        const Model m = moved_frustum({{far, -far, far}});
        const auto t = tessellate(m, {.tolerance = 0.001, .max_angle = 10 * kDegree});
        ASSERT_TRUE(t);
        EXPECT_LE(sampled_angle(m, *t), t->angle_bound);
        EXPECT_LT(t->mesh.triangles.size(), 1000u) << far;
        EXPECT_EQ(t->angle_bound > 10 * kDegree, far > 0) << t->angle_bound;
        EXPECT_EQ(t->topology.open_edges + t->topology.non_manifold_edges, 0);
    }
}

TEST(TessellateShapes, sides_that_stay_draw_no_points_towards_them) {
    for (const Model& m : {test::sphere({}, 1), frustum(2, 0, 3)}) {
        const double tolerance = 0.01;
        const auto t = tessellate(m, {.tolerance = tolerance, .max_angle = 2 * kDegree});
        ASSERT_TRUE(t);
        double shortest = tolerance;
        for (const MeshEdge& e : edges(t->mesh))
            shortest =
                std::min(shortest, norm(t->mesh.points[std::size_t(e.a)] - t->mesh.points[std::size_t(e.b)]));
        EXPECT_GT(shortest, tolerance / 100);
        EXPECT_EQ(t->topology.non_manifold_edges + t->topology.degenerate_triangles, 0);
    }
}

TEST(TessellateShapes, cones_of_normals_hold_all_of_them) {
    Random rng(8);
    for (int i = 0; i < cases(40); ++i) {
        std::vector<Vec<3>> c;
        for (int a = 0; a < 5; ++a)
            for (int b = 0; b < 5; ++b) c.push_back({{a / 4.0, b / 4.0, 0.3 * rng.real(-1, 1)}});
        const auto basis = *BSplineBasis::clamped_uniform(3, 5);
        const SurfaceGeometry s = *Surface<Vec<3>>::make({basis, basis}, Net<2, Vec<3>>({5, 5}, c));
        const DerivativeQuery<2, 3> query(s);
        const double end = domain(s)[0].hi, side = rng.real(0, 0.3) * end;
        const Vec<2> at{{rng.real(0, end - side), rng.real(0, end - side)}};
        const Box<2> box{at, at + Vec<2>{{side, side}}};
        const NormalCone cone = normal_cone(query, box);
        const std::array<Vec<2>, 3> uv{at, at + Vec<2>{{side, 0}}, at + Vec<2>{{0, side}}};
        std::array<Vec<3>, 3> corners;
        for (std::size_t k = 0; k < 3; ++k) corners[k] = jet<0>(s, uv[k].c).value();
        const double bound = normal_angle_bound(query, uv, corners);
        const Vec<3> m = unit(cross(corners[1] - corners[0], corners[2] - corners[0]));
        for (int k = 0; k < 60; ++k) {
            double x = rng.real(0, 1), y = rng.real(0, 1);
            const Vec<3> n = normal(s, (at + side * Vec<2>{{x, y}}).c);
            if (cone.angle < kPi) {
                EXPECT_LE(std::atan2(norm(cross(n, cone.axis)), dot(n, cone.axis)), cone.angle);
            }
            if (x + y > 1) x = 1 - x, y = 1 - y;
            const Vec<3> inside = normal(s, (at + side * Vec<2>{{x, y}}).c);
            EXPECT_LE(std::atan2(norm(cross(m, inside)), dot(m, inside)), bound);
        }
    }
    // A fold inside the box has no cone; beside it there is one.
    const auto folded = SurfaceGeometry(*Surface<Vec<3>>::make(
        {*BSplineBasis::make(1, {0, 0, 1, 2, 2}), *BSplineBasis::bezier(1)},
        Net<2, Vec<3>>({3, 2},
                       {{{0, 0, 0}}, {{0, 1, 0}}, {{1, 0, 0}}, {{1, 1, 0}}, {{1, 0, 1}}, {{1, 1, 1}}})));
    const DerivativeQuery<2, 3> fold(folded);
    EXPECT_EQ(normal_cone(fold, {{{0.9, 0.1}}, {{1.1, 0.2}}}).angle, kPi);
    EXPECT_LE(normal_cone(fold, {{{0.9, 0.1}}, {{1, 0.2}}}).angle, 1e-5);
    EXPECT_EQ(normal_angle_bound(fold, {Vec<2>{}, Vec<2>{}, Vec<2>{}}, {}), kPi) << "no area";
}

// The cone of the box, after a look at normals there.
double checked_cone(const DerivativeQuery<2, 3>& query, const Box<2>& box) {
    const NormalCone cone = normal_cone(query, box);
    for (int k = 0; k <= 40; ++k) {
        const double x = k / 40.0, y = (k * 7 % 41) / 40.0;
        const Vec<2> at{{box.lo[0] + x * (box.hi[0] - box.lo[0]), box.lo[1] + y * (box.hi[1] - box.lo[1])}};
        const Vec<3> n = normal(query.geometry(), at.c);
        EXPECT_LE(std::atan2(norm(cross(n, cone.axis)), dot(n, cone.axis)), cone.angle);
    }
    return cone.angle;
}

TEST(TessellateShapes, boxes_without_width_have_cones_at_the_border_too) {
    Random rng(9);
    for (int i = 0; i < cases(20); ++i) {
        std::vector<Vec<3>> c;
        for (int a = 0; a < 5; ++a)
            for (int b = 0; b < 5; ++b) c.push_back({{a / 4.0, b / 4.0, 0.05 * rng.real(-1, 1)}});
        const auto basis = *BSplineBasis::clamped_uniform(3, 5);
        const SurfaceGeometry s = *Surface<Vec<3>>::make({basis, basis}, Net<2, Vec<3>>({5, 5}, c));
        const DerivativeQuery<2, 3> query(s);
        const Interval u = domain(s)[0];
        for (const double v : {u.lo, u.middle(), u.hi}) {
            const double from = rng.real(u.lo, u.lo + 0.9 * u.length()), to = from + 0.1 * u.length();
            EXPECT_LT(checked_cone(query, {{{from, v}}, {{to, v}}}), 1);
            EXPECT_LT(checked_cone(query, {{{v, from}}, {{v, to}}}), 1);
        }
    }
    // Far from the origin values are known to some 1e-10 only; the plane is one all the same.
    const SurfaceGeometry plane = Extrusion{Line<3>{{{1e4, 2e4, 0}}, {{1, 0, 0}}}, {{0, 1, 0}}};
    EXPECT_LT(checked_cone(DerivativeQuery<2, 3>(plane), {{{7, 8}}, {{7 + 1e-5, 8 + 1e-5}}}), 1e-4);
}

TEST(TessellateShapes, the_knots_of_rational_circles_do_not_end_cones) {
    const SurfaceGeometry cone = cone_of_uneven_weights();
    const DerivativeQuery<2, 3> query(cone);
    EXPECT_LT(checked_cone(query, {{{0.95, 0.4}}, {{1.05, 0.5}}}), 0.3);
    EXPECT_LT(checked_cone(query, {{{1, 0.4}}, {{1.1, 0.5}}}), 0.3);
    EXPECT_LT(checked_cone(query, {{{1, 0.4}}, {{1, 0.5}}}), 0.1);
}

TEST(TessellateShapes, an_aspect_makes_triangles_rounder) {
    for (const Model& m : {frustum(2, 1, 3), torus(6, 0.5)}) {
        const auto plain = tessellate(m, {.tolerance = 0.03});
        for (const double aspect : {2.0}) {
            const auto round = tessellate(m, {.tolerance = 0.03, .max_aspect = aspect});
            ASSERT_TRUE(plain && round);
            const auto middle = [](const Tessellation& t) {
                auto a = smallest_angles(t.mesh);
                std::sort(a.begin(), a.end());
                return a[a.size() / 2];
            };
            EXPECT_GT(middle(*round), 1.2 * middle(*plain)) << aspect;
            EXPECT_LE(round->error_bound, 0.03);
            EXPECT_EQ(round->topology.open_edges + round->topology.non_manifold_edges, 0);
            EXPECT_LE(sampled_deviation(m, *round, 2), round->error_bound + round->boundary_gap);
        }
    }
}

TEST(TessellateShapes, smallest_angles_are_those_of_known_triangles) {
    TriangleMesh mesh;
    mesh.points = {{{0, 0, 0}}, {{1, 0, 0}}, {{0, 1, 0}}, {{2, 0, 0}}};
    for (int i = 0; i < 4; ++i) mesh.vertices.push_back({i});
    mesh.triangles = {{0, 1, 2}, {0, 1, 3}, {0, 3, 2}};
    const auto angles = smallest_angles(mesh);
    EXPECT_NEAR(angles[0], kPi / 4, 1e-15);
    EXPECT_EQ(angles[1], 0);
    EXPECT_NEAR(angles[2], std::atan(0.5), 1e-15);
}

TEST(TessellateShapes, several_tolerances_give_what_each_gives) {
    const Model m = frustum(2, 1, 3);
    std::vector<TessellateOptions> all(4);
    all[0].tolerance = 0.1, all[1].tolerance = 1e-3, all[2].tolerance = -1, all[3].tolerance = 0.02;
    const auto together = tessellate(m, all);
    ASSERT_EQ(together.size(), 4u);
    for (const std::size_t i : {0u, 1u, 3u}) {
        const auto alone = tessellate(m, all[i]);
        ASSERT_TRUE(alone && together[i]);
        EXPECT_EQ(alone->mesh.points, together[i]->mesh.points);
        EXPECT_EQ(alone->mesh.triangles, together[i]->mesh.triangles);
        EXPECT_EQ(alone->error_bound, together[i]->error_bound);
    }
    EXPECT_EQ(together[2].error().where, "tolerance");
    EXPECT_TRUE(tessellate(m, std::span<const TessellateOptions>{}).empty());
}

TEST(TessellateShapes, demands_that_are_none_are_refused) {
    const Model m = frustum(2, 1, 3);
    for (const double bad : {0.0, -1.0, double(NAN)}) {
        EXPECT_EQ(tessellate(m, {.tolerance = 0.1, .max_angle = bad}).error().where, "max_angle");
        EXPECT_EQ(tessellate(m, {.tolerance = 0.1, .max_aspect = bad}).error().where, "max_aspect");
    }
}

}  // namespace
