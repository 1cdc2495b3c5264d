#include "support/polygon_face.hpp"
#include "support/shapes.hpp"
#include "support/solids.hpp"

#include <freiform/core/parallel.hpp>
#include <freiform/make/revolve.hpp>

#include <ctime>
#include <gtest/gtest.h>

using namespace freiform;
using namespace freiform::test;

namespace {

void expect_closed(const Tessellation& t, const char* what) {
    EXPECT_EQ(t.topology.open_edges, 0) << what;
    EXPECT_EQ(t.topology.non_manifold_edges, 0) << what;
    EXPECT_EQ(t.topology.misoriented_edges, 0) << what;
    EXPECT_EQ(t.topology.degenerate_triangles, 0) << what;
    EXPECT_TRUE(t.refused.empty()) << what << ": " << (t.refused.empty() ? "" : t.refused[0].reason.message);
}

struct Solid {
    const char* name;
    Model model;
    double volume;
};
std::vector<Solid> solids() {
    std::vector<Solid> s;
    s.push_back({"sphere", sphere({{1, 2, 3}}, 2), 4.0 / 3 * kPi * 8});
    s.push_back({"torus", torus(3, 1), 2 * kPi * kPi * 3});
    s.push_back({"thin torus", torus(10, 0.01), 2 * kPi * kPi * 10 * 1e-4});
    s.push_back({"cylinder", frustum(1, 1, 2), 2 * kPi});
    s.push_back({"frustum", frustum(2, 1, 3), kPi * 7});
    s.push_back({"cone", frustum(2, 0, 3), kPi * 4});
    return s;
}

TEST(Tessellate, closed_solids_give_closed_meshes_within_the_bound) {
    for (const Solid& s : solids())
        for (double tolerance : {0.5, 0.05, 0.005, 0.0005}) {
            const auto t = tessellate(s.model, {.tolerance = tolerance});
            ASSERT_TRUE(t) << s.name << ": " << t.error().message;
            expect_closed(*t, s.name);
            EXPECT_LE(t->error_bound, tolerance) << s.name;
            EXPECT_LE(t->boundary_gap, 1e-14 * 20) << s.name;
            const double deviation = sampled_deviation(s.model, *t);
            EXPECT_LE(deviation, t->error_bound + t->boundary_gap) << s.name << " within " << tolerance;
            if (tolerance > 0.01) continue;
            EXPECT_GE(deviation, 0.1 * tolerance) << s.name << ": finer than asked for";
            // A closed mesh within the bound has the volume but for area x bound.
            EXPECT_NEAR(signed_volume(t->mesh), s.volume, 0.02 * s.volume + tolerance * 100) << s.name;
        }
}

TEST(Tessellate, normals_are_those_of_the_surface_also_at_poles) {
    const auto model = sphere({{1, 2, 3}}, 2);
    const auto t = tessellate(model, {.tolerance = 0.01});
    ASSERT_TRUE(t);
    for (const MeshVertex& v : t->mesh.vertices) {
        const Vec<3> outward = unit(t->mesh.points[std::size_t(v.point)] - Vec<3>{{1, 2, 3}});
        EXPECT_NEAR(norm(v.normal), 1, 1e-12);
        EXPECT_GT(dot(v.normal, outward), 0.999);
    }
}

TEST(Tessellate, patches_that_share_their_boundary_points_are_joined) {
    // A closed tube in both directions, cut into 3 x 3 patches by restriction: all boundaries are equal to
    // the bit where the cuts agree, so nothing is open.
    std::mt19937 rng(11);
    const auto ring = *BSplineBasis::periodic(3, {0, 1, 2, 3, 4, 5, 6, 7, 8});
    std::vector<Vec<3>> c;
    for (int i = 0; i < 8; ++i)
        for (int j = 0; j < 8; ++j) {
            const double u = i * kPi / 4, v = j * kPi / 4, r = 1 + 0.1 * uniform(rng, -1, 1);
            c.push_back({{(3 + r * std::cos(v)) * std::cos(u), (3 + r * std::cos(v)) * std::sin(u),
                          r * std::sin(v)}});
        }
    ModelBuilder builder("mm");
    ASSERT_TRUE(builder.add(*Surface<Vec<3>>::make({ring, ring}, Net<2, Vec<3>>({8, 8}, c)), "tube"));
    const auto model = std::move(builder).finish();
    ASSERT_TRUE(model);
    EXPECT_TRUE(model->bodies[0].solid);
    const auto t = tessellate(*model, {.tolerance = 0.01});
    ASSERT_TRUE(t);
    expect_closed(*t, "tube");
    EXPECT_LE(sampled_deviation(*model, *t), t->error_bound + t->boundary_gap);
}

TEST(Tessellate, a_cube_of_bilinear_patches_needs_twelve_triangles) {
    ModelBuilder builder;
    const auto corner = [](int i) { return Vec<3>{{double(i & 1), double(i >> 1 & 1), double(i >> 2 & 1)}}; };
    const int quads[6][4] = {{0, 2, 1, 3}, {4, 5, 6, 7}, {0, 1, 4, 5},
                             {2, 6, 3, 7}, {0, 4, 2, 6}, {1, 3, 5, 7}};
    for (const auto& q : quads)
        ASSERT_TRUE(builder.add(*Surface<Vec<3>>::make(
            {*BSplineBasis::bezier(1), *BSplineBasis::bezier(1)},
            Net<2, Vec<3>>({2, 2}, {corner(q[0]), corner(q[1]), corner(q[2]), corner(q[3])}))));
    const auto model = std::move(builder).finish();
    ASSERT_TRUE(model);
    const auto t = tessellate(*model, {.tolerance = 1e-6});
    ASSERT_TRUE(t);
    expect_closed(*t, "cube");
    EXPECT_EQ(t->mesh.triangles.size(), 12u);
    EXPECT_LE(t->error_bound, 1e-13);
    EXPECT_NEAR(std::abs(signed_volume(t->mesh)), 1, 1e-14);
}

TEST(Tessellate, a_narrow_bump_is_not_missed) {
    // One raised coefficient in a flat 24 x 24 spline: sampling on a grid walks past it.
    const auto basis = *BSplineBasis::clamped_uniform(3, 24);
    std::vector<Vec<3>> c;
    for (int i = 0; i < 24; ++i)
        for (int j = 0; j < 24; ++j) c.push_back({{double(i), double(j), i == 13 && j == 7 ? 5.0 : 0.0}});
    ModelBuilder builder;
    ASSERT_TRUE(builder.add(*Surface<Vec<3>>::make({basis, basis}, Net<2, Vec<3>>({24, 24}, c))));
    const auto model = std::move(builder).finish();
    for (double tolerance : {0.5, 0.05}) {
        const auto t = tessellate(*model, {.tolerance = tolerance});
        ASSERT_TRUE(t);
        EXPECT_LE(t->error_bound, tolerance);
        EXPECT_LE(sampled_deviation(*model, *t, 12), t->error_bound);
    }
}

TEST(Tessellate, kinks_of_a_surface_are_met) {
    const auto zigzag = *BSplineBasis::make(1, {0, 0, 0.3, 0.55, 0.9, 1, 1});
    std::vector<Vec<3>> c;
    for (int i = 0; i < 5; ++i)
        for (int j = 0; j < 5; ++j) c.push_back({{double(i), double(j), (i + j) % 2 * 0.7}});
    ModelBuilder builder;
    ASSERT_TRUE(builder.add(*Surface<Vec<3>>::make({zigzag, zigzag}, Net<2, Vec<3>>({5, 5}, c))));
    const auto model = std::move(builder).finish();
    const auto t = tessellate(*model, {.tolerance = 0.01});
    ASSERT_TRUE(t);
    ASSERT_TRUE(t->refused.empty()) << t->refused[0].reason.message;
    EXPECT_LE(sampled_deviation(*model, *t), t->error_bound);
    EXPECT_LT(t->mesh.triangles.size(), 5000u);
}

TEST(Tessellate, trimmed_surfaces_keep_their_holes) {
    std::mt19937 rng(12);
    const auto surface = landscape(rng, 3, 8, 0.1);
    const auto on = surface.domain();
    const double w = on[0].hi, r = w / 5;
    std::vector<std::vector<CurveGeometry<2>>> loops(2);
    const Vec<2> corner[4] = {{{0, 0}}, {{w, 0}}, {{w, w}}, {{0, w}}};
    for (int k = 0; k < 4; ++k)
        loops[0].push_back(*Curve<Vec<2>>::make({*BSplineBasis::bezier(1)},
                                                Net<1, Vec<2>>({2}, {corner[k], corner[(k + 1) % 4]})));
    loops[1].push_back(Conic<2>{ConicKind::ellipse, {{w / 2, w / 2}}, {{r, 0}}, {{0, r}}});
    ModelBuilder builder;
    ASSERT_TRUE(builder.add_trimmed(surface, loops));
    const auto model = std::move(builder).finish();
    ASSERT_TRUE(model) << model.error().where << model.error().message;
    const auto t = tessellate(*model, {.tolerance = 0.002});
    ASSERT_TRUE(t);
    ASSERT_TRUE(t->refused.empty()) << t->refused[0].reason.message;
    EXPECT_LE(t->error_bound, 0.002);
    EXPECT_LE(sampled_deviation(*model, *t), t->error_bound + t->boundary_gap);
    double area = 0;
    for (const auto& tri : t->mesh.triangles) {
        const auto uv = [&](int k) { return t->mesh.vertices[std::size_t(tri[std::size_t(k)])].uv; };
        area += cross(uv(1) - uv(0), uv(2) - uv(0)) / 2;
    }
    EXPECT_NEAR(area, w * w - kPi * r * r, 0.05 * r * r);
    EXPECT_LT(area, w * w - 0.9 * kPi * r * r);
}

TEST(Tessellate, powers_of_two_scale_the_mesh_exactly) {
    const auto plain = tessellate(torus(3, 1), {.tolerance = 0.01});
    ASSERT_TRUE(plain);
    for (int k : {-300, -40, 40, 300}) {
        const auto big =
            tessellate(torus(std::ldexp(3, k), std::ldexp(1, k)), {.tolerance = std::ldexp(0.01, k)});
        ASSERT_TRUE(big) << big.error().message;
        ASSERT_EQ(plain->mesh.triangles, big->mesh.triangles) << k;
        for (std::size_t i = 0; i < plain->mesh.points.size(); ++i)
            for (int d = 0; d < 3; ++d)
                ASSERT_EQ(std::ldexp(plain->mesh.points[i][d], k), big->mesh.points[i][d]) << k;
        EXPECT_EQ(std::ldexp(plain->error_bound, k), big->error_bound);
    }
}

// Alone, so that threads share its tree.
Model cone_face() {
    const auto profile =
        *Curve<Vec<3>>::make({*BSplineBasis::bezier(1)}, Net<1, Vec<3>>({2}, {{{2, 0, 0}}, {{0, 0, 3}}}));
    ModelBuilder builder;
    EXPECT_TRUE(builder.add(revolve(profile, {{}, {{0, 0, 1}}}, 2 * kPi)->surface));
    return *std::move(builder).finish();
}

TEST(Tessellate, any_number_of_threads_gives_the_same_bits) {
    std::mt19937 rng(13);
    ModelBuilder single, several;
    ASSERT_TRUE(single.add(landscape(rng, 3, 8, 0.3)));
    for (const double height : {0.01, 0.3, 0.02, 0.01, 0.2, 0.01})  // threads share the work of some
        ASSERT_TRUE(several.add(landscape(rng, 3, 8, height)));
    for (const auto& [model, tolerance] :
         {std::pair(frustum(2, 1, 3), 2e-4), std::pair(cone_face(), 1e-7),
          std::pair(*std::move(single).finish(), 1e-3), std::pair(*std::move(several).finish(), 2e-4)}) {
        set_max_threads(1);
        const auto one = tessellate(model, {.tolerance = tolerance});
        set_max_threads(4);
        const auto four = tessellate(model, {.tolerance = tolerance});
        set_max_threads(0);
        ASSERT_TRUE(one && four);
        EXPECT_GT(one->mesh.triangles.size(), 500u);
        EXPECT_EQ(one->mesh.points, four->mesh.points);
        EXPECT_EQ(one->mesh.triangles, four->mesh.triangles);
        EXPECT_EQ(one->error_bound, four->error_bound);
    }
}

TEST(Tessellate, refuses_tolerances_that_ask_for_too_much_at_once) {
    const auto model = torus(3, 1);
    for (double tolerance : {1e-9, 1e-20, 1e-300}) {
        const auto start = std::clock();
        const auto t =
            tessellate(model, {.tolerance = tolerance, .max_triangles = 1'000'000, .progress = {}});
        ASSERT_FALSE(t) << tolerance;
        EXPECT_EQ(t.error().kind, RefusalKind::limit) << tolerance;
        EXPECT_NE(t.error().message.find_first_of("0123456789"), std::string::npos);
        EXPECT_LT(double(std::clock() - start) / CLOCKS_PER_SEC, 3);
    }
    EXPECT_EQ(tessellate(model, {.tolerance = 0}).error().kind, RefusalKind::invalid);
    EXPECT_EQ(tessellate(model, {.tolerance = NAN}).error().kind, RefusalKind::nonfinite);
}

Model all_of(const SurfaceGeometry& surface) {
    const auto on = domain(surface);
    return polygon_face(surface, Box<2>{{{on[0].lo, on[1].lo}}, {{on[0].hi, on[1].hi}}});
}

// They were refused after many points had been tried: where nothing is known of an edge, its error was
// nothing.
TEST(Tessellate, offsets_of_splines_of_several_pieces_are_meshed) {
    for (const auto& [height, distance] :
         {std::pair{0.0, 0.3}, {0.2, 0.3}, {0.2, -0.5}, {1.0, 0.2}, {1.0, 1.5}})
        for (const double tolerance : {0.05, 0.005}) {
            const auto base = std::make_shared<const SurfaceGeometry>(rolling(8, height));
            const Model m = all_of(OffsetSurface{base, distance});
            const auto t = *tessellate(m, {.tolerance = tolerance});
            ASSERT_TRUE(t.refused.empty()) << height << " " << distance << t.refused[0].reason.message;
            EXPECT_LE(t.error_bound, tolerance);
            EXPECT_LE(sampled_deviation(m, t), t.error_bound + t.boundary_gap) << height << " " << distance;
        }
}

// First derivatives of such an offset jump where second derivatives of its base do: up to seven times the
// bound were measured.
TEST(Tessellate, offsets_of_surfaces_whose_curvature_jumps_keep_the_bound) {
    const auto basis = *BSplineBasis::make(2, {0, 0, 0, 1, 2, 3, 3, 3});
    std::mt19937 rng(7);
    for (int i = 0; i < 3; ++i) {
        std::vector<Vec<3>> net, row;
        for (int k = 0; k < 25; ++k) net.push_back({{double(k / 5), double(k % 5), uniform(rng, -0.6, 0.6)}});
        for (double turn = 0; row.size() < 5; turn += uniform(rng, -1.2, 1.2))
            row.push_back((row.empty() ? Vec<3>{} : row.back()) +
                          Vec<3>{{std::cos(turn), 0, std::sin(turn)}});
        const Curve<Vec<3>> profile = *Curve<Vec<3>>::make({basis}, Net<1, Vec<3>>({5}, row));
        const SurfaceGeometry both = *Surface<Vec<3>>::make({basis, basis}, Net<2, Vec<3>>({5, 5}, net)),
                              moved = Extrusion{profile, {{0, 1, 0}}},
                              turned = Revolution{profile, {{0, 0, -8}}, {{1, 0, 0}}};
        for (const auto* base : {&both, &moved, &turned})
            for (const double distance : {1.0, -1.0}) {
                const SurfaceGeometry s =
                    OffsetSurface{std::make_shared<const SurfaceGeometry>(*base), distance};
                Box<2> part;
                part.add(Vec<2>{{0, 0}}), part.add(base == &both    ? Vec<2>{{3, 3}}
                                                   : base == &moved ? Vec<2>{{3, 1}}
                                                                    : Vec<2>{{1, 3}});
                const Model m = polygon_face(s, part);
                const auto t = *tessellate(m, {.tolerance = 0.002});
                ASSERT_TRUE(t.refused.empty()) << t.refused[0].reason.message;
                EXPECT_LE(t.error_bound, 0.002);
                EXPECT_LE(sampled_deviation(m, t), t.error_bound + t.boundary_gap) << i << " " << distance;
            }
    }
}

// A face that ends at a knot of its surface, which bends far more beyond it; the parameter curve of the end
// runs `beyond` it.
Model ends_at_a_knot(double beyond, double of_edges = 1e-7, double of_vertices = 0) {
    const std::vector<double> knots{0, 0, 0, 1, 1.01, 1.01, 1.01};
    const double y[] = {0, 0.5, 1, 1.01}, z[] = {0, 0.2, 0.1, 2};
    std::vector<Vec<3>> net, sides[2];
    for (int i = 0; i < 2; ++i)
        for (int k = 0; k < 4; ++k) {
            net.push_back({{double(i), y[k], z[k]}});
            sides[i].push_back(net.back());
        }
    const auto along = *BSplineBasis::make(2, knots);
    Model m;
    Face f;
    f.surface =
        *Surface<Vec<3>>::make({*BSplineBasis::bezier(1), along}, Net<2, Vec<3>>({2, 4}, std::move(net)));
    const Vec<2> corners[] = {{{0, 0}}, {{1, 0}}, {{1, 1}}, {{0, 1}}};
    for (const Vec<2>& c : corners) m.vertices.push_back({jet<0>(f.surface, c.c).value(), of_vertices});
    const auto line = [&](int a, int b) {
        const Vec<3> p = m.vertices[std::size_t(a)].point;
        return Line<3>{p, m.vertices[std::size_t(b)].point - p};
    };
    const auto side = [&](int i) {
        return *Curve<Vec<3>>::make({along}, Net<1, Vec<3>>({4}, std::move(sides[i])));
    };
    m.edges = {{line(0, 1), false, {0, 1}, 0, 1, 0, ""},
               {side(1), false, {0, 1}, 1, 2, 0, ""},
               {line(3, 2), false, {0, 1}, 3, 2, 0, ""},
               {side(0), false, {0, 1}, 0, 3, 0, ""}};
    for (Edge& e : m.edges) e.tolerance = of_edges;
    f.loops = {{{{0, false, Line<2>{{{0, 0}}, {{1, 0}}}},
                 {1, false, Line<2>{{{1, 0}}, {{0, 1}}}},
                 {2, true, Line<2>{{{0, 1 + beyond}}, {{1, 0}}}},
                 {3, true, Line<2>{{{0, 0}}, {{0, 1}}}}}}};
    m.faces = {f};
    m.shells = {{{{0, false}}, false}};
    m.bodies = {{{0}, false, "", {}}};
    return *make_model(std::move(m));
}

TEST(Tessellate, what_is_a_rounding_beyond_a_boundary_does_not_count_along_it) {
    const auto exact = tessellate(ends_at_a_knot(0), {.tolerance = 1e-3});
    ASSERT_TRUE(exact);
    ASSERT_TRUE(exact->refused.empty());
    // An edge is no more accurate than both its ends.
    for (const Model& m : {ends_at_a_knot(1e-15), ends_at_a_knot(1e-13), ends_at_a_knot(1e-9),
                           ends_at_a_knot(2e-9, 1e-10, 1e-7)}) {
        const auto t = tessellate(m, {.tolerance = 1e-3});
        ASSERT_TRUE(t);
        EXPECT_TRUE(t->refused.empty()) << t->refused[0].reason.message;
        EXPECT_EQ(t->mesh.triangles.size(), exact->mesh.triangles.size());
        EXPECT_LE(t->error_bound, 1e-3);
        EXPECT_LE(t->boundary_gap, 1e-7);
    }
}

TEST(Tessellate, a_boundary_that_runs_back_along_itself_is_refused) {
    Model m = frustum(2, 1, 3);
    auto& coedges = m.faces[0].loops[0].coedges;  // of the wall: its seam, there and back
    const Coedge seam = coedges[1];
    coedges = {seam, {seam.edge, !seam.reversed, seam.curve}};
    const auto t = tessellate(m, {.tolerance = 0.01});
    ASSERT_TRUE(t);
    ASSERT_EQ(t->refused.size(), 1u);
    EXPECT_EQ(t->refused[0].face, 0);
    EXPECT_EQ(t->refused[0].reason.kind, RefusalKind::invalid);
    EXPECT_NE(t->refused[0].reason.message.find("encloses nothing"), std::string::npos);
    EXPECT_EQ(t->mesh.parts.size(), 2u);
}

TEST(Tessellate, an_open_loop_is_refused_and_the_other_faces_are_delivered) {
    Model m = frustum(2, 1, 3);
    auto& coedges = m.faces[0].loops[0].coedges;
    coedges[2].curve = segment({0, 2 * kPi}, {{0.3, 1}}, {{2 * kPi, 1}});
    const auto t = tessellate(m, {.tolerance = 0.01});
    ASSERT_TRUE(t);
    ASSERT_EQ(t->refused.size(), 1u);
    EXPECT_EQ(t->refused[0].face, 0);
    EXPECT_EQ(t->refused[0].reason.where, "loops[0][2]");
    EXPECT_NE(t->refused[0].reason.message.find("open"), std::string::npos);
    EXPECT_EQ(t->mesh.parts.size(), 2u);
    EXPECT_GT(t->topology.open_edges, 0);
}

}  // namespace
