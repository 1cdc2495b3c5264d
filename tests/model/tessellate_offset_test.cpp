// Faces on offsets, which splines stand for while they are meshed: what comes out is of the offset.
#include <freiform/make/offset_spline.hpp>
#include <freiform/model/tessellate.hpp>

#include <cmath>
#include <support/polygon_face.hpp>
#include <support/shapes.hpp>
#include <support/solids.hpp>

namespace freiform::test {
namespace {

SurfaceGeometry offset(const SurfaceGeometry& base, double by) {
    return OffsetSurface{std::make_shared<const SurfaceGeometry>(base), by};
}
Model whole(const SurfaceGeometry& s, double part = 1) {
    const auto on = domain(s);
    return polygon_face(s, Box<2>{{{on[0].lo, on[1].lo}},
                                  {{on[0].lo + part * on[0].length(), on[1].lo + part * on[1].length()}}});
}
SurfaceGeometry wave() {
    std::vector<Vec<3>> row;
    for (int i = 0; i < 8; ++i) row.push_back({{double(i), 0, std::sin(1.3 * i)}});
    const auto c = *Curve<Vec<3>>::make({*BSplineBasis::clamped_uniform(3, 8)}, Net<1, Vec<3>>({8}, row));
    return Extrusion{c, {{0.6, 0.8, 0}}};
}

TEST(TessellateOffset, takes_about_the_triangles_of_the_base) {
    for (const double by : {0.3, -0.3, 0.001}) {
        const SurfaceGeometry base = rolling(8, 0.5);
        for (const double tolerance : {1e-2, 1e-3}) {
            const auto own = must(tessellate(whole(base), {.tolerance = tolerance}));
            const Model m = whole(offset(base, by));
            const auto t = must(tessellate(m, {.tolerance = tolerance}));
            EXPECT_LT(t.mesh.triangles.size(), 1.25 * double(own.mesh.triangles.size())) << by;
            EXPECT_LE(t.error_bound, tolerance);
            EXPECT_LE(sampled_deviation(m, t), t.error_bound + t.boundary_gap);
            EXPECT_GE(sampled_deviation(m, t), 0.6 * t.error_bound);
        }
    }
}

TEST(TessellateOffset, offsets_of_extrusions_of_splines_too) {
    const Model m = polygon_face(offset(wave(), 0.2), Box<2>{{{0, -1}}, {{5, 1}}});
    const Model own = polygon_face(wave(), Box<2>{{{0, -1}}, {{5, 1}}});
    const auto t = must(tessellate(m, {.tolerance = 1e-3})),
               base = must(tessellate(own, {.tolerance = 1e-3}));
    EXPECT_LE(sampled_deviation(m, t), t.error_bound + t.boundary_gap);
    EXPECT_LT(t.mesh.triangles.size(), 1.5 * double(base.mesh.triangles.size()));
}

TEST(TessellateOffset, corners_inside_and_normals_are_those_of_the_offset) {
    const SurfaceGeometry s = offset(rolling(8, 0.5), 0.3);
    const Model m = whole(s, 0.8);
    const auto t = must(tessellate(m, {.tolerance = 1e-2}));
    std::size_t inside = 0;
    for (const MeshVertex& v : t.mesh.vertices) {
        const Vec<3> p = t.mesh.points[std::size_t(v.point)];
        const double off = norm(p - jet<0>(s, v.uv.c).value());
        const bool is_inside = 0 < v.uv[0] && v.uv[0] < 4 && 0 < v.uv[1] && v.uv[1] < 4;
        EXPECT_LE(off, is_inside ? 1e-13 : 1e-4);
        EXPECT_NEAR(norm(v.normal - normal(s, v.uv.c)), 0, 1e-12);
        inside += is_inside;
    }
    EXPECT_GT(inside, 100u);
    // The model has no gaps, and none is told.
    EXPECT_LT(t.boundary_gap, 1e-12);
}

TEST(TessellateOffset, normals_are_bounded_as_they_are_given) {
    const SurfaceGeometry s = offset(rolling(6, 0.5), 0.2);
    const auto t = must(tessellate(whole(s), {.tolerance = 0.1, .max_angle = 0.2}));
    EXPECT_EQ(t.angle_exceeded, 0);
    EXPECT_LE(t.angle_bound, 0.2);
    double most = 0;
    for (std::size_t i = 0; i < t.mesh.triangles.size(); ++i) {
        const auto p = t.mesh.points_of(i);
        const auto at = [&](std::size_t k) { return t.mesh.points[std::size_t(p[k])]; };
        const Vec<3> n = unit(cross(at(1) - at(0), at(2) - at(0)));
        for (const int v : t.mesh.triangles[i])
            most = std::max(most, std::acos(dot(n, normal(s, t.mesh.vertices[std::size_t(v)].uv.c))));
    }
    EXPECT_LE(most, t.angle_bound);
    EXPECT_GT(most, 0.05);
}

// A wall below the side v = 0, where the offset keeps to the plane y = 0. The edge between them has no curve
// in space, so it is where the offset has it: both follow it nearer than splines stand for offsets.
TEST(TessellateOffset, edges_that_are_images_of_the_offset_stay_there) {
    const SurfaceGeometry base = [] {
        std::vector<Vec<3>> net;
        for (int i = 0; i < 6; ++i)
            for (int k = 0; k < 4; ++k)
                net.push_back({{double(i), double(k), std::sin(1.3 * i) + (k > 1 ? 0.3 * k : 0)}});
        return SurfaceGeometry(*Surface<Vec<3>>::make(
            {*BSplineBasis::clamped_uniform(3, 6), *BSplineBasis::clamped_uniform(3, 4)},
            Net<2, Vec<3>>({6, 4}, net)));
    }();
    const SurfaceGeometry s = offset(base, 0.2);
    const auto fine = must(offset_spline(std::get<OffsetSurface>(s), domain(base), 1e-9));
    const auto side = iso(fine.surface, 1, 0.0);
    std::vector<Vec<2>> net;
    for (const Vec<3>& p : side.net().flat()) net.push_back({{p[0], p[2]}});
    Model m = whole(s);
    Face wall;
    wall.surface = Extrusion{Line<3>{{}, {{1, 0, 0}}}, {{0, 0, 1}}, SurfaceKind::plane};
    const Vec<2> a = net.front(), b = net.back(), c{{b[0], -3}}, d{{a[0], -3}};
    const auto vertex = [&](const Vec<2>& p) {
        m.vertices.push_back({{{p[0], 0, p[1]}}, 1e-9});
        return int(m.vertices.size()) - 1;
    };
    const int at_c = vertex(c), at_d = vertex(d);
    Loop loop;
    loop.coedges.push_back(
        {0, true, Curve<Vec<2>>::trusted({side.basis()}, Net<1, Vec<2>>({int(net.size())}, net))});
    const auto add = [&](int from, int to, const Vec<2>& p, const Vec<2>& q) {
        loop.coedges.push_back({int(m.edges.size()), false, Line<2>{p, q - p}});
        m.edges.push_back({{}, false, {0, 1}, from, to, 1e-9, ""});
    };
    add(0, at_d, a, d), add(at_d, at_c, d, c), add(at_c, 1, c, b);
    m.edges[0].range = side.domain()[0];
    auto& own = m.faces[0].loops[0].coedges[0].curve;
    own = Line<2>{{{0, 0}}, {{1, 0}}};
    wall.loops = {loop};
    m.faces.push_back(wall);
    m.shells[0].faces.push_back({1, true});
    // With a curve, it is not to be seen that the spline is beside it.
    for (const bool has_curve : {false, true}) {
        if (has_curve) m.edges[0].curve = side;
        const Model given = must(make_model(m));
        const auto t = must(tessellate(given, {.tolerance = 1e-2}));
        ASSERT_TRUE(t.refused.empty()) << t.refused[0].reason.message;
        EXPECT_LT(t.boundary_gap, 1e-8) << has_curve;
        EXPECT_LE(t.error_bound, 1e-2);
        EXPECT_LE(sampled_deviation(given, t), t.error_bound + t.boundary_gap);
    }
}

}  // namespace
}  // namespace freiform::test
