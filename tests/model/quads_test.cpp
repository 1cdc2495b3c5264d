// Quads along parameter lines: where they are, that they are cells, and that mesh and bound are as ever.
#include "support/random.hpp"
#include "support/solids.hpp"
#include "support/trimmed_faces.hpp"

#include <freiform/model/deviation.hpp>

#include <gtest/gtest.h>
#include <set>

using namespace freiform;
using namespace freiform::test;

namespace {

// Closed where the model is, within its bound, of cells whose sides lie along the parameters.
Tessellation expect_quads(const Model& model, double tolerance, const char* what, bool closed) {
    const auto t = tessellate(model, {.tolerance = tolerance, .quads = true});
    EXPECT_TRUE(t) << what;
    if (!t) return {};
    EXPECT_TRUE(t->refused.empty()) << what;
    EXPECT_TRUE(validate(t->mesh)) << what;
    EXPECT_LE(t->error_bound, tolerance) << what;
    EXPECT_EQ(t->topology.non_manifold_edges + t->topology.misoriented_edges, 0) << what;
    EXPECT_EQ(t->topology.degenerate_triangles, 0) << what;
    if (closed) {
        EXPECT_EQ(t->topology.open_edges, 0) << what;
    }
    EXPECT_LE(sampled_deviation(model, *t, 3), t->error_bound + t->boundary_gap) << what;
    int quads = 0;
    for (const MeshPart& part : t->mesh.parts) {
        Box<2> all;
        for (int i = part.first; i < part.first + part.count; ++i)
            for (const int v : t->mesh.triangles[std::size_t(i)])
                all.add(t->mesh.vertices[std::size_t(v)].uv);
        for (int q = 0; q < part.quads; ++q, ++quads) {
            const auto &a = t->mesh.triangles[std::size_t(part.first + 2 * q)],
                       &b = t->mesh.triangles[std::size_t(part.first + 2 * q + 1)];
            const int corners[] = {a[0], a[1], a[2], b[2], a[0]};
            for (int k = 0; k < 4; ++k) {
                const Vec<2> side = t->mesh.vertices[std::size_t(corners[k + 1])].uv -
                                    t->mesh.vertices[std::size_t(corners[k])].uv,
                             size = all.hi - all.lo;
                EXPECT_LE(std::min(std::abs(side[0]) / size[0], std::abs(side[1]) / size[1]), 1e-9) << what;
                EXPECT_GE(std::max(std::abs(side[0]) / size[0], std::abs(side[1]) / size[1]), 1e-6) << what;
            }
        }
    }
    EXPECT_EQ(quads, t->quads) << what;
    return *t;
}
int loose(const Tessellation& t) { return int(t.mesh.triangles.size()) - 2 * t.quads; }

TEST(Quads, fill_rectangles_from_edge_to_edge) {
    for (const double tolerance : {0.1, 0.01}) {
        const auto ring = expect_quads(torus(2, 0.7), tolerance, "torus", true);
        EXPECT_GT(ring.quads, 50);
        EXPECT_EQ(loose(ring), 0);
        // Without quads it takes hardly fewer triangles: cells are as large as the tolerance lets them be.
        const auto free = tessellate(torus(2, 0.7), {.tolerance = tolerance});
        EXPECT_LE(double(ring.mesh.triangles.size()), 1.6 * double(free->mesh.triangles.size()));
    }
    const auto ball = expect_quads(test::sphere({}, 1), 0.01, "sphere", true);
    std::set<int> around;  // the neighbours of the poles
    for (std::size_t i = 0; i < ball.mesh.triangles.size(); ++i) {
        const auto p = ball.mesh.points_of(i);
        for (const int pole : p)
            if (std::abs(std::abs(ball.mesh.points[std::size_t(pole)][2]) - 1) < 1e-12)
                for (const int v : p)
                    if (v != pole) around.insert(v);
    }
    EXPECT_EQ(loose(ball), int(around.size())) << "triangles at the poles only";
}

TEST(Quads, leave_triangles_along_trims) {
    const auto t = expect_quads(frustum(2, 1, 3), 0.01, "frustum", true);
    EXPECT_EQ(2 * t.faces[0].quads, t.faces[0].triangles) << "the wall";
    const auto basis = *BSplineBasis::clamped_uniform(3, 6);
    Random rng(3);
    std::vector<Vec<3>> c;
    for (int i = 0; i < 6; ++i)
        for (int k = 0; k < 6; ++k) c.push_back({{i / 5.0, k / 5.0, rng.real(-0.2, 0.2)}});
    const auto surface = *Surface<Vec<3>>::make({basis, basis}, Net<2, Vec<3>>({6, 6}, c));
    const Vec<2> middle{{surface.domain()[0].middle(), surface.domain()[1].middle()}};
    const double r = 0.4 * surface.domain()[0].length();
    ModelBuilder builder;
    const std::vector<std::vector<CurveGeometry<2>>> loops{
        {Conic<2>{ConicKind::ellipse, middle, {{r, 0}}, {{0, r}}}},
        {Conic<2>{ConicKind::ellipse, middle, {{0, r / 3}}, {{r / 3, 0}}}}};
    ASSERT_TRUE(builder.add_trimmed(surface, loops));
    const auto ring = expect_quads(*std::move(builder).finish(), 0.001, "ring", false);
    EXPECT_GT(ring.quads, 100);
    EXPECT_GT(loose(ring), 20);
}

TEST(Quads, keep_the_bound_on_random_surfaces) {
    Random rng(5);
    for (int round = 0; round < 6; ++round) {
        const auto u = *BSplineBasis::clamped_uniform(2 + round % 2, 5),
                   v = *BSplineBasis::clamped_uniform(3, 6);
        std::vector<Hom<3>> c;
        for (int i = 0; i < 5; ++i)
            for (int k = 0; k < 6; ++k)
                c.push_back(
                    weighted(Vec<3>{{i / 4.0, k / 5.0, rng.real(-0.3, 0.3)}}, std::exp2(rng.real(-1, 1))));
        ModelBuilder builder;
        ASSERT_TRUE(builder.add(*Surface<Hom<3>>::make({u, v}, Net<2, Hom<3>>({5, 6}, c))));
        const auto t = expect_quads(*std::move(builder).finish(), 0.01, "random", false);
        EXPECT_GE(2 * t.quads, 9 * loose(t)) << round;
    }
    TrimmedFaces faces(7);
    for (int i = 0; i < 12; ++i) {
        const auto t = tessellate(faces.next().model, {.tolerance = 0.02, .quads = true});
        ASSERT_TRUE(t) << t.error().message;
        EXPECT_TRUE(validate(t->mesh));
        EXPECT_EQ(t->topology.non_manifold_edges + t->topology.misoriented_edges, 0) << i;
        EXPECT_LE(t->error_bound, 0.02) << i;
    }
}

// Three bilinear faces in a ring; `twisted`: the last is joined to the first the other way round.
Model band(bool twisted) {
    Model m;
    for (int k = 0; k < 3; ++k)
        for (const double z : {-1.0, 1.0}) {
            const double angle = 2 * kPi * k / 3, tilt = (twisted ? kPi : 0) * k / 3;
            const double r = 3 + z * std::sin(tilt);
            m.vertices.push_back({{{r * std::cos(angle), r * std::sin(angle), z * std::cos(tilt)}}, 0});
        }
    const Interval on{0, 1};
    const auto edge = [&](int a, int b) {
        const Vec<3> p = m.vertices[std::size_t(a)].point, q = m.vertices[std::size_t(b)].point;
        m.edges.push_back({Line<3>{p, q - p}, false, on, a, b, 0, ""});
    };
    for (int k = 0; k < 3; ++k) edge(2 * k, 2 * k + 1);
    for (int k = 0; k < 3; ++k)
        for (int side = 0; side < 2; ++side)
            edge(2 * k + side, k < 2 ? 2 * k + 2 + side : twisted ? 1 - side : side);
    for (int k = 0; k < 3; ++k) {
        const bool turned = k == 2 && twisted;
        const int next = (k + 1) % 3;
        const auto at = [&](int v) { return m.vertices[std::size_t(v)].point; };
        Face f;
        f.surface = *Surface<Vec<3>>::make(
            {*BSplineBasis::bezier(1), *BSplineBasis::bezier(1)},
            Net<2, Vec<3>>({2, 2},
                           {at(2 * k), at(2 * k + 1), at(2 * next + turned), at(2 * next + !turned)}));
        const Vec<2> low{{1, turned ? 1.0 : 0.0}}, high{{1, turned ? 0.0 : 1.0}};
        f.loops = {{{{3 + 2 * k, false, segment(on, {{0, 0}}, {{1, 0}})},
                     {next, turned, segment(on, low, high)},
                     {4 + 2 * k, true, segment(on, {{0, 1}}, {{1, 1}})},
                     {k, true, segment(on, {{0, 0}}, {{0, 1}})}}}};
        m.faces.push_back(f);
    }
    return *make_model(std::move(m));
}

TEST(Quads, go_round_bands_twisted_or_not) {
    const auto plain = expect_quads(band(false), 0.001, "band", false);
    EXPECT_EQ(loose(plain), 0);
    const auto twisted = tessellate(band(true), {.tolerance = 0.001, .quads = true});
    ASSERT_TRUE(twisted) << twisted.error().message;
    EXPECT_TRUE(twisted->refused.empty());
    EXPECT_LE(twisted->error_bound, 0.001);
    EXPECT_EQ(twisted->topology.non_manifold_edges, 0);
    EXPECT_GT(twisted->quads, 2 * loose(*twisted)) << "all but one row";
}

// All edges run round the face, so opposite ones run against each other; the surface bends at one corner
// only.
TEST(Quads, end_at_edges_that_run_either_way) {
    Model m;
    std::vector<Vec<3>> c;
    for (int i = 0; i < 7; ++i)
        for (int k = 0; k < 7; ++k) c.push_back({{i / 6.0, k / 6.0, i + k > 9 ? 0.2 * (i + k - 9) : 0.0}});
    const SurfaceGeometry bent = *Surface<Vec<3>>::make({*BSplineBasis::bezier(6), *BSplineBasis::bezier(6)},
                                                        Net<2, Vec<3>>({7, 7}, c));
    const Vec<2> corner[] = {{{0, 0}}, {{1, 0}}, {{1, 1}}, {{0, 1}}, {{0, 0}}};
    Face f;
    f.surface = bent;
    f.loops.emplace_back();
    for (int k = 0; k < 4; ++k) {
        m.vertices.push_back({jet<0>(bent, corner[k].c).value(), 0});
        m.edges.push_back({{}, false, {0, 1}, k, (k + 1) % 4, 0, ""});
        f.loops[0].coedges.push_back({k, false, segment({0, 1}, corner[k], corner[k + 1])});
    }
    m.faces = {f};
    const auto t = expect_quads(*make_model(std::move(m)), 2e-3, "corner", false);
    EXPECT_GT(t.quads, 30);
    EXPECT_EQ(loose(t), 0);
}

TEST(Quads, are_turned_over_with_their_face) {
    for (const bool solid : {false, true}) {
        Model m = torus(2, 0.7);
        m.bodies[0].solid = solid;
        m.faces[0].reversed = true;
        const auto t = tessellate(m, {.tolerance = 0.1, .quads = true});
        ASSERT_TRUE(t);
        EXPECT_TRUE(validate(t->mesh));
        EXPECT_EQ(loose(*t), 0);
        EXPECT_EQ(signed_volume(t->mesh) > 0, solid) << "solids look outwards all the same";
    }
}

TEST(Quads, are_refused_beyond_the_limit) {
    const auto t = tessellate(torus(2, 0.7), {.tolerance = 1e-3, .quads = true, .max_triangles = 2'000});
    ASSERT_FALSE(t);
    EXPECT_EQ(t.error().kind, RefusalKind::limit);
}

}  // namespace
