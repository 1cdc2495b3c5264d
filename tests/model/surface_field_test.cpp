#include "support/solids.hpp"

#include <freiform/mesh/level_lines.hpp>
#include <freiform/mesh/refine.hpp>
#include <freiform/model/assemble.hpp>
#include <freiform/model/surface_field.hpp>
#include <freiform/model/surface_lines.hpp>
#include <freiform/model/tessellate.hpp>

#include <cmath>
#include <gtest/gtest.h>

namespace freiform {
namespace {

TriangleMesh mesh_of(const Model& model, double tolerance) {
    auto t = tessellate(model, {.tolerance = tolerance});
    EXPECT_TRUE(t) << t.error().message;
    return std::move(t->mesh);
}

TEST(SurfaceFields, of_a_sphere_are_exact_everywhere_poles_included) {
    for (const double r : {0.5, 3.0}) {
        const Model sphere = test::sphere({{1, 2, 3}}, r);
        const TriangleMesh mesh = refined(mesh_of(sphere, r / 20), r / 3, 100000);
        const std::pair<SurfaceField, double> expected[] = {{SurfaceField::gauss, 1 / r / r},
                                                            {SurfaceField::mean, -1 / r},
                                                            {SurfaceField::greatest, -1 / r},
                                                            {SurfaceField::least, -1 / r}};
        for (const auto& [field, value] : expected) {
            const FieldValues f = surface_field(sphere, mesh, field);
            ASSERT_EQ(f.values.size(), mesh.vertices.size());
            EXPECT_EQ(f.missing, 0);
            EXPECT_GT(f.beside, 0) << "two poles";
            for (const double x : f.values) ASSERT_NEAR(x, value, 1e-8 * std::abs(value)) << int(field);
        }
    }
}

TEST(SurfaceFields, of_a_torus_follow_its_formulas_for_outward_normals) {
    const double R = 2, r = 0.7;
    const Model torus = test::torus(R, r);
    const TriangleMesh mesh = mesh_of(torus, 0.01);
    const FieldValues gauss = surface_field(torus, mesh, SurfaceField::gauss),
                      mean = surface_field(torus, mesh, SurfaceField::mean),
                      greatest = surface_field(torus, mesh, SurfaceField::greatest),
                      least = surface_field(torus, mesh, SurfaceField::least);
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
        const Vec<3>& p = mesh.points[std::size_t(mesh.vertices[i].point)];
        const double rho = std::hypot(p[0], p[1]), along = -(rho - R) / r / rho;
        EXPECT_NEAR(gauss.values[i], -along / r, 1e-9);
        EXPECT_NEAR(mean.values[i], (-1 / r + along) / 2, 1e-9);
        EXPECT_NEAR(greatest.values[i], along, 1e-9);
        EXPECT_NEAR(least.values[i], -1 / r, 1e-9);
    }
}

TEST(SurfaceFields, of_a_surface_seen_from_its_other_side_have_the_other_sign) {
    Model torus = test::torus(2, 0.7);
    torus.bodies[0].solid = false;  // solids look outwards whatever their faces say
    const auto fields = [&](SurfaceField field) {
        const TriangleMesh mesh = mesh_of(torus, 0.05);
        const FieldValues f = surface_field(torus, mesh, field);
        Box<1> range;
        for (const double x : f.values) range.add(Vec<1>{{x}});
        return range.side(0);
    };
    using enum SurfaceField;
    const auto gauss_out = fields(gauss), mean_out = fields(mean), greatest_out = fields(greatest),
               least_out = fields(least);
    torus.faces[0].reversed = !torus.faces[0].reversed;
    const auto near = [](const Interval& a, double lo, double hi) {
        EXPECT_NEAR(a.lo, lo, 1e-9);
        EXPECT_NEAR(a.hi, hi, 1e-9);
    };
    near(fields(gauss), gauss_out.lo, gauss_out.hi);
    near(fields(mean), -mean_out.hi, -mean_out.lo);
    near(fields(greatest), -least_out.hi, -least_out.lo);
    near(fields(least), -greatest_out.hi, -greatest_out.lo);
    EXPECT_GT(greatest_out.hi - least_out.lo, 1) << "they differ";
}

TEST(SurfaceFields, of_a_cylinder_and_its_lids) {
    const Model cylinder = test::frustum(2, 2, 5);
    const TriangleMesh mesh = mesh_of(cylinder, 0.05);
    const FieldValues mean = surface_field(cylinder, mesh, SurfaceField::mean);
    const FieldValues gauss = surface_field(cylinder, mesh, SurfaceField::gauss);
    int round = 0, flat = 0;
    for (std::size_t i = 0; i < mesh.vertices.size(); ++i) {
        EXPECT_NEAR(gauss.values[i], 0, 1e-12);
        const bool lid = std::abs(mesh.vertices[i].normal[2]) > 0.5;
        (lid ? flat : round) += 1;
        EXPECT_NEAR(mean.values[i], lid ? 0 : -0.25, 1e-12);
    }
    EXPECT_GT(round, 10);
    EXPECT_GT(flat, 10);
}

TEST(SurfaceFields, errors_are_0_at_the_vertices_of_the_tessellation_and_within_its_bound_between_them) {
    const Model sphere = test::sphere({{0, 0, 0}}, 1);
    const auto t = tessellate(sphere, {.tolerance = 0.01});
    ASSERT_TRUE(t);
    for (const double x : surface_field(sphere, t->mesh, SurfaceField::error).values) EXPECT_LT(x, 1e-12);
    const TriangleMesh fine = refined(t->mesh, 1, 1'000'000, 2);
    const FieldValues f = surface_field(sphere, fine, SurfaceField::error);
    double most = 0;
    for (std::size_t i = 0; i < f.values.size(); ++i) {
        const double true_distance = 1 - norm(fine.points[std::size_t(fine.vertices[i].point)]);
        EXPECT_GE(f.values[i], true_distance - 1e-12);
        most = std::max(most, f.values[i]);
    }
    EXPECT_LE(most, t->error_bound);
    EXPECT_GT(most, 0.1 * t->error_bound);
}

TEST(UsualRange, leaves_out_a_twentieth_of_the_area_at_either_end) {
    TriangleMesh mesh;  // 1000 triangles of one size with the values 0 .. 999
    std::vector<double> values;
    for (int i = 0; i < 1000; ++i) {
        for (int k = 0; k < 3; ++k) {
            mesh.vertices.push_back({3 * i + k, {}, {}});
            mesh.points.push_back({{double(k == 1), double(k == 2), double(i)}});
            values.push_back((i * 7) % 1000);
        }
        mesh.triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
    }
    EXPECT_NEAR(usual_range(mesh, values).lo, 50, 1);
    EXPECT_NEAR(usual_range(mesh, values).hi, 949, 1);
    for (double& v : values) v = NAN;
    EXPECT_GT(usual_range(mesh, values).lo, usual_range(mesh, values).hi) << "empty";
}

TEST(SurfaceLines, isolines_lie_on_their_parameter_within_the_bound) {
    const Model torus = test::torus(2, 0.7);
    const auto t = tessellate(torus, {.tolerance = 0.004});
    ASSERT_TRUE(t);
    const auto lines = isolines(torus, t->mesh, 3);
    EXPECT_GE(lines.size(), 6u);
    double around = 0, across = 0;
    for (const SurfaceLine& l : lines)
        for (std::size_t i = 1; i < l.points.size(); ++i) {
            const Vec<3> p = l.points[i], q = l.points[i - 1];
            const double rho = std::hypot(p[0], p[1]);
            EXPECT_LE(std::abs(std::hypot(rho - 2, p[2]) - 0.7), t->error_bound + 1e-9);
            (std::abs(p[0] * q[1] - p[1] * q[0]) > 0.3 * rho * norm(p - q) ? around : across) += norm(p - q);
        }
    EXPECT_NEAR(across, 3 * 2 * test::kPi * 0.7, 0.1);
    EXPECT_NEAR(around, 2 * test::kPi * (2 * 2 + 1.3), 0.2);
    EXPECT_TRUE(isolines(torus, t->mesh, 0).empty());
    EXPECT_TRUE(isolines(torus, t->mesh, std::nullopt).empty()) << "not a spline";
}

TEST(SurfaceLines, outlines_of_a_sphere_are_points_of_its_great_circle) {
    const Model sphere = test::sphere({{0, 0, 0}}, 2);
    const TriangleMesh mesh = mesh_of(sphere, 0.05);
    const Vec<3> eye = unit(Vec<3>{{1, -2, 0.7}});
    double length = 0;
    for (const SurfaceLine& l : silhouettes(sphere, mesh, eye))
        for (std::size_t i = 0; i < l.points.size(); ++i) {
            EXPECT_NEAR(norm(l.points[i]), 2, 1e-12);
            EXPECT_NEAR(dot(l.points[i], eye), 0, 1e-9);
            if (i > 0) length += norm(l.points[i] - l.points[i - 1]);
        }
    EXPECT_NEAR(length, 4 * test::kPi, 0.15);
    EXPECT_TRUE(
        silhouettes(test::frustum(1, 1, 2), mesh_of(test::frustum(1, 1, 2), 0.01), {{0, 0, 1}}).empty())
        << "a wall seen edge on";
}

TEST(SurfaceLines, outlines_of_a_cone_run_from_its_circle_to_its_apex) {
    const Model cone = test::frustum(2, 0, 3);
    const TriangleMesh mesh = mesh_of(cone, 0.02);
    const Vec<3> apex{{0, 0, 3}};
    for (int k = 0; k < 40; ++k) {
        const Vec<3> eye = unit(Vec<3>{{std::cos(0.16 * k), std::sin(0.16 * k), 0.02 * (k - 20)}});
        double length = 0;
        int tips = 0;
        for (const SurfaceLine& l : silhouettes(cone, mesh, eye)) {
            for (std::size_t i = 1; i < l.points.size(); ++i) length += norm(l.points[i] - l.points[i - 1]);
            for (const Vec<3>& p : {l.points.front(), l.points.back()}) tips += norm(p - apex) < 1e-12;
        }
        EXPECT_EQ(tips, 2) << k;
        EXPECT_NEAR(length, 2 * std::sqrt(13), 1e-9) << k;
    }
}

TEST(SurfaceLines, a_cone_has_no_sharp_edges_but_its_circle) {
    for (const double tolerance : {0.2, 0.05, 0.01})
        EXPECT_EQ(outlines(mesh_of(test::frustum(2, 0, 3), tolerance), 0.1).size(), 1u)
            << "not its seam either";
}

TEST(SurfaceLines, a_curved_wall_seen_along_its_lines_has_no_outline_made_of_rounding) {
    const Vec<3> along = unit(Vec<3>{{1, -2, 0.7}}), x = unit(cross(along, Vec<3>{{0, 0, 1}})),
                 y = cross(along, x);
    std::vector<Vec<3>> net;
    for (const Vec<2>& p : {Vec<2>{{0, 0}}, {{1, 2}}, {{2, -2}}, {{3, 0.3}}})
        for (const double t : {0.0, 3.0}) net.push_back(p[0] * x + p[1] * y + t * along);
    ModelBuilder builder;
    ASSERT_TRUE(builder.add(*Surface<Vec<3>>::make({*BSplineBasis::bezier(3), *BSplineBasis::bezier(1)},
                                                   Net<2, Vec<3>>({4, 2}, net))));
    const Model wall = *std::move(builder).finish();
    const TriangleMesh mesh = mesh_of(wall, 0.001);
    int rounded = 0;
    for (const MeshVertex& v : mesh.vertices) rounded += dot(v.normal, along) < 0;
    EXPECT_GT(rounded, 0) << "the test is about rounding";
    EXPECT_TRUE(silhouettes(wall, mesh, along).empty());
    EXPECT_FALSE(silhouettes(wall, mesh, x).empty()) << "seen from its end it has some";
}

TEST(SurfaceLines, normals_stand_on_a_grid_of_parameters) {
    const Model sphere = test::sphere({{0, 0, 0}}, 1);
    const auto n = surface_normals(mesh_of(sphere, 0.001), 6);
    EXPECT_EQ(n.size(), 36u);
    for (const SurfaceNormal& s : n) EXPECT_GT(dot(s.normal, s.foot), 0.99);
}

}  // namespace
}  // namespace freiform
