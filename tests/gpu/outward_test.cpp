#include "gpu/outward_detail.hpp"
#include "support/corpus.hpp"
#include "support/random.hpp"
#include "support/solids.hpp"

#include <freiform/gpu/surfaces.hpp>
#include <freiform/io/read.hpp>
#include <freiform/io/scene.hpp>

#include <algorithm>
#include <gtest/gtest.h>

namespace freiform {
namespace {

// What the records of the faces say.
std::vector<int> sides_of_faces(const Model& model) {
    const auto b =
        test::must(surface_buffers(model, {.edge_tolerance = summary(model).box.diagonal() / 10000}));
    std::vector<int> out;
    for (int f = 0; f < b.face_count; ++f) out.push_back(int(b.texels[std::size_t(b.faces + 3 * f + 2)][2]));
    return out;
}

TriangleMesh mesh_of(const Model& model) {
    return test::must(tessellate(model, {.tolerance = summary(model).box.diagonal() / 300})).mesh;
}

std::vector<int> sides_of(const TriangleMesh& mesh) {
    std::vector<Vec<3>> points = mesh.points;  // about the middle, as they are drawn
    Box<3> box;
    for (const Vec<3>& p : points) box.add(p);
    for (Vec<3>& p : points) p = (1 / max_abs(box.hi - box.lo)) * (p - 0.5 * (box.lo + box.hi));
    return outward_sides(mesh, points, edges(mesh));
}

bool all_are(const std::vector<int>& sides, int side) {
    return !sides.empty() && std::ranges::all_of(sides, [&](int s) { return s == side; });
}

Model inside_out(Model model) {
    for (Face& f : model.faces) f.reversed = !f.reversed;
    return model;
}

std::vector<Model> closed_models() {
    return {test::sphere(Vec<3>{{1e3, 2, 3}}, 0.5),
            test::torus(2, 0.7),
            test::torus(2, 1.9),
            test::frustum(1, 0.6, 1),
            test::frustum(1, 0, 40),
            test::frustum(30, 30, 0.1),
            test::must(
                scene_of(test::must(read_any(std::string(FREIFORM_SOURCE_DIR) + "/examples/bracket.step"))))};
}

TEST(OutwardSides, of_faces_are_those_that_the_volume_of_a_mesh_tells) {
    for (const Model& m : closed_models()) {
        EXPECT_TRUE(all_are(sides_of_faces(m), 1));
        EXPECT_TRUE(all_are(sides_of_faces(inside_out(m)), -1));
        const TriangleMesh mesh = mesh_of(m);
        EXPECT_GT(test::signed_volume(mesh), 0);
        EXPECT_TRUE(all_are(sides_of(mesh), 1));
    }
}

TEST(OutwardSides, are_not_known_where_nothing_is_enclosed) {
    for (Model m : closed_models()) {
        TriangleMesh mesh = mesh_of(m);
        mesh.triangles.pop_back(), mesh.parts.clear();
        EXPECT_TRUE(all_are(sides_of(mesh), 0));
        if (m.faces.size() == 1) continue;
        m.faces.pop_back(), m.shells.clear(), m.bodies.clear();
        EXPECT_TRUE(all_are(sides_of_faces(m), 0));
    }
}

TEST(OutwardSides, of_a_mesh_follow_the_normals_of_its_vertices) {
    TriangleMesh mesh = mesh_of(test::torus(2, 0.7));
    for (MeshVertex& v : mesh.vertices) v.normal = -v.normal;
    EXPECT_TRUE(all_are(sides_of(mesh), -1));
    for (auto& t : mesh.triangles) std::swap(t[0], t[1]);  // now both point inwards
    EXPECT_TRUE(all_are(sides_of(mesh), -1));
    for (MeshVertex& v : mesh.vertices) v.normal = {};
    EXPECT_TRUE(all_are(sides_of(mesh), 0));
}

// One component at a time: two balls, one of them inside out, and a sheet.
TEST(OutwardSides, are_those_of_each_component) {
    Model m = test::sphere(Vec<3>{}, 1);
    const auto append = [&](Model other) {
        const int v = int(m.vertices.size()), e = int(m.edges.size());
        m.vertices.insert(m.vertices.end(), other.vertices.begin(), other.vertices.end());
        for (Edge& edge : other.edges) edge.start += v, edge.end += v, m.edges.push_back(edge);
        for (Face& face : other.faces) {
            for (Loop& loop : face.loops)
                for (Coedge& c : loop.coedges) c.edge += e;
            m.faces.push_back(face);
        }
    };
    append(inside_out(test::sphere(Vec<3>{{5, 0, 0}}, 1)));
    Model sheet = test::frustum(1, 0.5, 1);
    sheet.faces.resize(1);
    append(sheet);
    m.shells.clear(), m.bodies.clear();
    EXPECT_EQ(sides_of_faces(m), (std::vector<int>{1, -1, 0}));
}

// No model of the corpus is told a side that the volume of its mesh denies.
TEST(OutwardSides, of_models_of_the_corpus_agree_with_their_volumes) {
    int known = 0;
    for (const char* name : {"step/linkrods.step", "step/screw.step", "step/conical-surface.step",
                             "step/red_cube_blue_cylinder.step", "step_micro/ap203_toroidal_band.stp"}) {
        FF_CORPUS_OR_SKIP(path, name);
        const auto document = read_any(path.string());
        ASSERT_TRUE(document) << name;
        const Model model = test::must(scene_of(*document));
        const auto b = surface_buffers(model, {.edge_tolerance = summary(model).box.diagonal() / 10000});
        if (!b) continue;
        const std::vector<int> sides = sides_of_faces(model);
        const Tessellation t =
            test::must(tessellate(model, {.tolerance = summary(model).box.diagonal() / 300}));
        const std::vector<int> seen = sides_of(t.mesh);
        for (const MeshPart& part : t.mesh.parts) {
            const int face = part.face;
            if (face < 0 || sides[std::size_t(face)] == 0 || seen[std::size_t(part.first)] == 0) continue;
            ++known;
            EXPECT_EQ(sides[std::size_t(face)], seen[std::size_t(part.first)]) << name << ", face " << face;
        }
    }
    EXPECT_GT(known, 50);
}

}  // namespace
}  // namespace freiform
