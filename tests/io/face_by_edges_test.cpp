// Faces of edges alone, as files have them whose parameter curves say something else.
#include <freiform/io/face_by_edges.hpp>

#include <support/refusal.hpp>
#include <support/solids.hpp>
#include <support/step_measures.hpp>

namespace freiform::test {
namespace {

// The circles at the ends of a cylinder of radius 2 and height 3.
Model two_circles() {
    Model m;
    for (const double z : {0.0, 3.0}) {
        m.vertices.push_back({{{2, 0, z}}, 1e-7});
        Edge e;
        e.curve = Conic<3>{ConicKind::ellipse, {{0, 0, z}}, {{2, 0, 0}}, {{0, 2, 0}}};
        e.range = {0, 2 * std::numbers::pi};
        e.start = e.end = int(m.edges.size());
        e.tolerance = 1e-7;
        m.edges.push_back(std::move(e));
    }
    return m;
}
const SurfaceGeometry kWall =
    Extrusion{Conic<3>{ConicKind::ellipse, {}, {{2, 0, 0}}, {{0, 2, 0}}}, {{0, 0, 1}}, SurfaceKind::cylinder};

TEST(FaceByEdges, a_wall_between_circles_gets_its_seam) {
    Model m = two_circles();
    const std::vector<std::vector<EdgeUse>> loops{{{0, false}}, {{1, true}}};
    m.faces.push_back(must(face_by_edges(m, kWall, loops, 1e-7)));
    EXPECT_EQ(m.edges.size(), 3u);
    const Model made = in_one_body(std::move(m));
    EXPECT_EQ(summary(made).seams, 1);
    EXPECT_NEAR(area_of(made, 1e-3), 12 * std::numbers::pi, 0.02);
}

// A circle of a sphere of radius 2, at the height 1: the sense in which it is run through says which part.
TEST(FaceByEdges, the_face_lies_on_the_left_of_its_loop) {
    for (const bool reversed : {false, true}) {
        Model m;
        const double r = std::sqrt(3.0);
        m.vertices.push_back({{{r, 0, 1}}, 1e-7});
        Edge e;
        e.curve = Conic<3>{ConicKind::ellipse, {{0, 0, 1}}, {{r, 0, 0}}, {{0, r, 0}}};
        e.range = {0, 2 * std::numbers::pi};
        e.start = e.end = 0;
        e.tolerance = 1e-7;
        m.edges.push_back(std::move(e));
        const SurfaceGeometry ball = Revolution{
            Conic<3>{ConicKind::ellipse, {}, {{2, 0, 0}}, {{0, 0, 2}}}, {}, {{0, 0, 1}}, SurfaceKind::sphere};
        const std::vector<std::vector<EdgeUse>> loops{{{0, reversed}}};
        m.faces.push_back(must(face_by_edges(m, ball, loops, 1e-7)));
        EXPECT_NEAR(area_of(in_one_body(std::move(m)), 1e-3), (reversed ? 12 : 4) * std::numbers::pi, 0.05);
    }
}

TEST(FaceByEdges, what_is_no_face_is_refused_and_leaves_the_model_as_it_was) {
    const auto refused = [](Model m, std::vector<std::vector<EdgeUse>> loops) {
        const std::size_t edges = m.edges.size(), vertices = m.vertices.size();
        const auto made = face_by_edges(m, kWall, loops, 1e-7);
        EXPECT_EQ(m.edges.size(), edges);
        EXPECT_EQ(m.vertices.size(), vertices);
        return made ? Refusal{} : made.error();
    };
    const Refusal alone = refused(two_circles(), {{{0, false}}});
    EXPECT_FALSE(alone.message.empty()) << "one end alone";
    Model crossing = two_circles();  // an ellipse that crosses the other end
    crossing.vertices[1].point = {{2, 0, 1}};
    crossing.edges[1].curve = Conic<3>{ConicKind::ellipse, {}, {{2, 0, 1}}, {{0, 2, 0}}};
    EXPECT_EQ(refused(crossing, {{{0, false}}, {{1, true}}}).message, "the boundary touches itself");
    Model bare = two_circles();
    bare.edges[1].curve.reset();
    EXPECT_EQ(refused(bare, {{{0, false}}, {{1, true}}}).kind, RefusalKind::invalid);
    Model wide = two_circles();
    std::get<Conic<3>>(*wide.edges[1].curve).x = {{3, 0, 0}};
    const Refusal beside = refused(wide, {{{0, false}}, {{1, true}}});
    EXPECT_EQ(beside.kind, RefusalKind::ill_conditioned);
    EXPECT_EQ(beside.where, "edges[1]");
}

}  // namespace
}  // namespace freiform::test
