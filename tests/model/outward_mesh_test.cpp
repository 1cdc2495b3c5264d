// Triangles of solids are counter-clockwise seen from outside, whatever a file says of its faces.
#include <freiform/model/swept_solid.hpp>
#include <freiform/model/tessellate.hpp>

#include <algorithm>
#include <gtest/gtest.h>
#include <support/random.hpp>
#include <support/solids.hpp>

namespace freiform::test {
namespace {

// A cube with sides of 4 and a hollow of 1 in its middle, its faces seen from the material.
Model hollow_cube() {
    const auto square = [](double from, double to) {
        const std::vector<Vec<2>> corners{
            {{from, from}}, {{to, from}}, {{to, to}}, {{from, to}}, {{from, from}}};
        return RegionLoops{{must(Curve<Vec<2>>::make({must(BSplineBasis::make(1, {0, 0, 1, 2, 3, 4, 4}))},
                                                     Net<1, Vec<2>>({5}, corners)))}};
    };
    Model m = must(prism(square(0, 4), {{0, 0, 4}}));
    Model inner = must(prism(square(1.5, 2.5), {{0, 0, 1}}));
    const int vertices = int(m.vertices.size()), edges = int(m.edges.size()), faces = int(m.faces.size());
    for (Vertex& v : inner.vertices) {
        v.point[2] += 1.5;
        m.vertices.push_back(v);
    }
    for (Edge& e : inner.edges) {
        e.start += vertices, e.end += vertices;
        e.curve.reset();
        m.edges.push_back(e);
    }
    for (Face& f : inner.faces) {
        for (Loop& l : f.loops)
            for (Coedge& c : l.coedges) c.edge += edges;
        if (auto* s = std::get_if<Extrusion>(&f.surface)) {
            if (auto* line = std::get_if<Line<3>>(&s->profile)) line->origin[2] += 1.5;
        }
        m.faces.push_back(f);
    }
    Shell hollow = inner.shells[0];
    for (FaceUse& u : hollow.faces) u.face += faces, u.reversed = !u.reversed;
    m.shells.push_back(hollow);
    m.bodies[0].shells.push_back(1);
    return m;
}

// Of all triangles, a sixth of it; normals go with them.
double volume_and_check_normals(const Tessellation& t) {
    for (const auto& corner : t.mesh.triangles) {
        const auto at = [&](std::size_t c) {
            return t.mesh.points[std::size_t(t.mesh.vertices[std::size_t(corner[c])].point)];
        };
        const Vec<3> n = cross(at(1) - at(0), at(2) - at(0));
        for (const int v : corner) EXPECT_GT(dot(n, t.mesh.vertices[std::size_t(v)].normal), 0);
    }
    return signed_volume(t.mesh);
}

TEST(OutwardMesh, shells_that_look_the_wrong_way_are_turned_and_named) {
    const Model right = hollow_cube();
    const TessellateOptions how{.tolerance = 0.01};
    for (const int wrong : {0, 1, 2, 3}) {
        SCOPED_TRACE(wrong);
        Model m = right;
        std::vector<int> turned;
        for (const int s : {0, 1})
            if (wrong >> s & 1) {
                for (FaceUse& u : m.shells[std::size_t(s)].faces) u.reversed = !u.reversed;
                turned.push_back(s);
            }
        const auto t = must(tessellate(m, how));
        EXPECT_EQ(t.topology.open_edges, 0);
        EXPECT_EQ(t.topology.misoriented_edges, 0);
        EXPECT_NEAR(volume_and_check_normals(t), 64 - 1, 1e-9);
        EXPECT_EQ(t.turned_shells, turned);
        // Whichever the file names first.
        std::swap(m.bodies[0].shells[0], m.bodies[0].shells[1]);
        EXPECT_NEAR(signed_volume(must(tessellate(m, how)).mesh), 64 - 1, 1e-9);
    }
}

TEST(OutwardMesh, of_sheets_and_open_shells_nothing_is_known) {
    Model ball = sphere({{1, 2, 3}}, 2);
    for (FaceUse& u : ball.shells[0].faces) u.reversed = !u.reversed;
    EXPECT_GT(signed_volume(must(tessellate(ball, {.tolerance = 0.01})).mesh), 0);
    ball.bodies[0].solid = false;
    EXPECT_LT(signed_volume(must(tessellate(ball, {.tolerance = 0.01})).mesh), 0);
    Model open = hollow_cube();
    open.shells[0].faces.pop_back();
    for (FaceUse& u : open.shells[0].faces) u.reversed = true;
    EXPECT_TRUE(must(tessellate(open, {.tolerance = 0.01})).turned_shells.empty());
}

}  // namespace
}  // namespace freiform::test
