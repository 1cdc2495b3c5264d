// Faces that close on themselves: full turns whose two sides coincide become one seam, strips do not.
#include "support/sewn.hpp"
#include "support/solids.hpp"

#include <freiform/model/sew.hpp>

#include <gtest/gtest.h>

using namespace freiform;
using namespace freiform::test;

namespace {

// The same faces, every one with edges and vertices of its own: seams are two edges, and what is closed in
// space is not in the model. Poles stay one vertex.
Model loosened(const Model& whole) {
    Model m = whole;
    m.vertices.clear(), m.edges.clear();
    for (Face& f : m.faces)
        for (Loop& l : f.loops) {
            const std::size_t n = l.coedges.size();
            std::vector<int> corner(n + 1);
            for (std::size_t k = 0; k < n; ++k) {
                const Edge& e = whole.edges[std::size_t(l.coedges[k].edge)];
                const Edge& before = whole.edges[std::size_t(l.coedges[(k + n - 1) % n].edge)];
                const bool same = k > 0 && before.degenerate;
                corner[k] = same ? corner[k - 1] : int(m.vertices.size());
                if (same) continue;
                m.vertices.push_back(whole.vertices[std::size_t(l.coedges[k].reversed ? e.end : e.start)]);
            }
            corner[n] = corner[0];
            for (std::size_t k = 0; k < n; ++k) {
                Edge e = whole.edges[std::size_t(l.coedges[k].edge)];
                const bool back = l.coedges[k].reversed;
                e.start = corner[back ? k + 1 : k], e.end = corner[back ? k : k + 1];
                l.coedges[k].edge = int(m.edges.size());
                m.edges.push_back(std::move(e));
            }
        }
    for (Shell& s : m.shells) s.closed = false;
    for (Body& b : m.bodies) b.solid = false;
    return *make_model(std::move(m));
}

// The side alone, of a frustum whose edges are not shared.
Model wall_of(Model m) {
    m.faces.resize(1), m.shells[0].faces.resize(1);
    m.edges.resize(4), m.vertices.resize(4);
    return m;
}

TEST(SewSeams, faces_that_close_on_themselves_get_seams) {
    struct Case {
        Model whole;
        int open;
        std::size_t edges, vertices;
    };
    for (const Case& c : {Case{frustum(2, 1, 3), 6, 3, 2}, Case{frustum(2, 0, 3), 4, 3, 2},
                          Case{torus(3, 1), 4, 2, 1}, Case{sphere({{1, 2, 3}}, 2), 2, 3, 2}}) {
        const Model loose = loosened(c.whole);
        ASSERT_EQ(summary(loose).open_edges, c.open);
        const auto s = sew(loose, {.tolerance = 1e-6});
        ASSERT_TRUE(s);
        expect_sound(*s, loose);
        EXPECT_TRUE(s->remaining.empty()) << c.edges;
        for (const RemainingGap& g : s->remaining) ADD_FAILURE() << g.reason.where << " " << g.reason.message;
        EXPECT_EQ(s->model.edges.size(), c.edges);
        EXPECT_EQ(s->model.vertices.size(), c.vertices);
        EXPECT_EQ(summary(s->model).seams, summary(c.whole).seams);
        EXPECT_TRUE(s->flipped.empty() && s->twisted.empty());
        EXPECT_TRUE(s->model.shells[0].closed && s->model.bodies[0].solid);
        const auto t = tessellate(s->model, {.tolerance = 0.01});
        ASSERT_TRUE(t);
        EXPECT_EQ(t->topology.open_edges + t->topology.misoriented_edges + t->topology.non_manifold_edges, 0);
        EXPECT_NEAR(signed_volume(t->mesh), signed_volume(tessellate(c.whole, {.tolerance = 0.01})->mesh),
                    0.1);
    }
}

TEST(SewSeams, walls_of_a_full_turn_on_top_of_each_other_get_seams_and_a_common_rim) {
    Model m = wall_of(loosened(frustum(2, 1, 3)));
    const Model upper = wall_of(loosened(frustum(1, 2, 3)));
    const int edges = int(m.edges.size()), vertices = int(m.vertices.size());
    for (Vertex v : upper.vertices) v.point[2] += 3, m.vertices.push_back(v);
    for (Edge e : upper.edges) {
        e.start += vertices, e.end += vertices;
        std::visit(
            [](auto& c) {
                if constexpr (requires { c.origin; })
                    c.origin[2] += 3;
                else if constexpr (requires { c.centre; })
                    c.centre[2] += 3;
            },
            *e.curve);
        m.edges.push_back(e);
    }
    Face wall = upper.faces[0];
    auto& turned = std::get<Revolution>(wall.surface);
    turned.origin[2] += 3, std::get<Line<3>>(turned.profile).origin[2] += 3;
    for (Coedge& c : wall.loops[0].coedges) c.edge += edges;
    m.faces.push_back(wall);
    m.shells[0].faces = {{0, false}, {1, false}};
    const auto loose = make_model(m);
    ASSERT_TRUE(loose) << loose.error().message;
    const auto s = sew(*loose, {.tolerance = 1e-6});
    ASSERT_TRUE(s);
    expect_sound(*s, *loose);
    EXPECT_EQ(s->joined.size(), 3u);
    EXPECT_EQ(summary(s->model).seams, 2);
    EXPECT_EQ(s->remaining.size(), 2u);  // the rims below and above
    const auto t = tessellate(s->model, {.tolerance = 0.01});
    EXPECT_EQ(t->topology.misoriented_edges + t->topology.non_manifold_edges, 0);
    EXPECT_EQ(s->openings.size(), 2u);
}

// The second side of the wall of a frustum at the angle `to` instead of a full turn.
Model short_of_a_turn(double to) {
    Model m = wall_of(loosened(frustum(2, 1, 3)));
    const auto turned = [&](Vec<3> p) { return Vec<3>{{std::cos(to) * p[0], std::sin(to) * p[0], p[2]}}; };
    auto& coedges = m.faces[0].loops[0].coedges;
    for (const std::size_t rim : {0, 2}) m.edges[rim].range.hi = to;
    auto& side = std::get<Line<3>>(*m.edges[1].curve);
    side = {turned(side.origin), turned(side.direction)};
    coedges[1].curve = segment({0, 1}, {{to, 0}}, {{to, 1}});
    for (const int v : {1, 2}) m.vertices[std::size_t(v)].point = turned(m.vertices[std::size_t(v)].point);
    return *make_model(std::move(m));
}

TEST(SewSeams, a_turn_that_falls_short_by_less_than_the_tolerance_is_closed_and_says_by_how_much) {
    const Model loose = short_of_a_turn(2 * kPi - 1e-4);
    const auto s = sew(loose, {.tolerance = 1e-3});
    ASSERT_TRUE(s);
    expect_sound(*s, loose);
    ASSERT_EQ(s->joined.size(), 1u);
    EXPECT_EQ(s->joined[0].faces, (std::vector<int>{0, 0}));
    EXPECT_NEAR(s->joined[0].bound, 2e-4, 1e-6);
    EXPECT_NEAR(s->vertex_moved, 2e-4, 1e-9);
    EXPECT_EQ(s->remaining.size(), 2u);
    const auto apart = sew(loose, {.tolerance = 1e-4});
    EXPECT_TRUE(apart->joined.empty());
    EXPECT_EQ(apart->remaining.size(), 4u);
}

}  // namespace
