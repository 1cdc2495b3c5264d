// Edges that a file has twice, for the two ways through them.
#include <freiform/io/file.hpp>
#include <freiform/io/step_read.hpp>

#include <support/corpus.hpp>
#include <support/refusal.hpp>
#include <support/solids.hpp>
#include <support/step_items.hpp>
#include <support/step_polygons.hpp>

namespace freiform::test {
namespace {

// Rows of a file: vertices at points, straight edges between them, plane faces within those.
struct Rows {
    std::string rows;
    std::vector<Vec<3>> points;

    int vertex(const Vec<3>& p) {
        const int k = int(points.size());
        points.push_back(p);
        rows += text("#", 100 + k, "=CARTESIAN_POINT('',(", p[0], ",", p[1], ",", p[2], "));\n#", 200 + k,
                     "=VERTEX_POINT('',#", 100 + k, ");\n");
        return k;
    }
    void line(int i, int from, int to) {
        const Vec<3> d = points[std::size_t(to)] - points[std::size_t(from)];
        rows += text("#", 300 + i, "=LINE('',#", 100 + from, ",#", 400 + i, ");\n#", 400 + i, "=VECTOR('',#",
                     500 + i, ",1.);\n#", 500 + i, "=DIRECTION('',(", d[0], ",", d[1], ",", d[2], "));\n");
    }
    void edge(int i, int from, int to, int curve) {
        rows += text("#", 600 + i, "=EDGE_CURVE('',#", 200 + from, ",#", 200 + to, ",#", curve, ",.T.);\n");
    }
    void straight(int i, int from, int to) { line(i, from, to), edge(i, from, to, 300 + i); }
    // Uses: the number of an edge plus 1, negative against it.
    void face(int i, std::string_view surface, std::initializer_list<int> uses, bool outer = true) {
        std::string list;
        for (const int u : uses) {
            const int use = 1000 + 50 * i + int(list.size());
            rows +=
                text("#", use, "=ORIENTED_EDGE('',*,*,#", 599 + std::abs(u), u > 0 ? ",.T.);\n" : ",.F.);\n");
            list += text(list.empty() ? "#" : ",#", use);
        }
        rows += text("#", 700 + i, "=ADVANCED_FACE('',(#", 750 + i, "),#", surface, ",.T.);\n#", 750 + i,
                     outer ? "=FACE_OUTER_BOUND('',#" : "=FACE_BOUND('',#", 800 + i, ",.T.);\n#", 800 + i,
                     "=EDGE_LOOP('',(", list, "));\n");
    }
    // On the plane through three vertices, which looks to where those run counter-clockwise.
    void plane(int i, int a, int b, int c) {
        const Vec<3> x = points[std::size_t(b)] - points[std::size_t(a)],
                     z = cross(x, points[std::size_t(c)] - points[std::size_t(a)]);
        rows +=
            text("#", 850 + i, "=PLANE('',#", 900 + i, ");\n#", 900 + i, "=AXIS2_PLACEMENT_3D('',#", 100 + a,
                 ",#", 930 + i, ",#", 960 + i, ");\n#", 930 + i, "=DIRECTION('',(", z[0], ",", z[1], ",",
                 z[2], "));\n#", 960 + i, "=DIRECTION('',(", x[0], ",", x[1], ",", x[2], "));\n");
    }
};

// A can, whose wall runs up along one edge of its seam and down along another.
TEST(StepTwins, two_edges_of_a_seam_are_one) {
    for (const int curves : {302, 303, 57}) {  // the same line, an equal one, a spline
        Rows r;
        r.vertex({{2, 0, 0}}), r.vertex({{2, 0, 3}});
        r.rows +=
            "#50=CIRCLE('',#23,2.);\n#51=CIRCLE('',#52,2.);\n#52=AXIS2_PLACEMENT_3D('',#53,#21,#22);\n"
            "#53=CARTESIAN_POINT('',(0.,0.,3.));\n#54=CYLINDRICAL_SURFACE('',#23,2.);\n"
            "#55=PLANE('',#23);\n#56=PLANE('',#52);\n";
        r.edge(0, 0, 0, 50), r.edge(1, 1, 1, 51);
        r.rows +=
            "#57=B_SPLINE_CURVE_WITH_KNOTS('',1,(#100,#101),.UNSPECIFIED.,.F.,.F.,(2,2),(0.,3.),"
            ".UNSPECIFIED.);\n";
        r.line(2, 0, 1), r.line(3, 0, 1);
        r.edge(2, 0, 1, curves == 57 ? 57 : 302), r.edge(3, 0, 1, curves);
        r.face(0, "54", {1, 3, -2, -4}), r.face(1, "55", {-1}), r.face(2, "56", {2});
        r.rows = replaced(r.rows, "),#55,.T.)", "),#55,.F.)");
        const Model m = items_model("#10",
                                    "#10=MANIFOLD_SOLID_BREP('',#11);\n"
                                    "#11=CLOSED_SHELL('',(#700,#701,#702));\n" +
                                        r.rows);
        EXPECT_EQ(m.edges.size(), 3u);
        ASSERT_EQ(m.approximations.size(), 1u);
        EXPECT_NE(m.approximations[0].what.find("#602 EDGE_CURVE and #603 EDGE_CURVE are the same"),
                  std::string::npos)
            << m.approximations[0].what;
        closed_tessellation(m, 0.01);
    }
}

// A cone on its disc, whose wall runs to the apex along one edge and back along another.
TEST(StepTwins, two_edges_to_an_apex_are_one) {
    Rows r;
    r.vertex({{2, 0, 0}}), r.vertex({{0, 0, -2}});
    r.rows += "#50=CIRCLE('',#23,2.);\n#54=CONICAL_SURFACE('',#23,2.,0.78539816339744831);\n";
    r.edge(0, 0, 0, 50), r.straight(1, 0, 1), r.edge(2, 0, 1, 301);
    r.face(0, "54", {-1, 2, -3}), r.face(1, "7", {1});
    const Model m =
        items_model("#10", "#10=MANIFOLD_SOLID_BREP('',#11);\n#11=CLOSED_SHELL('',(#700,#701));\n" + r.rows);
    const Tessellation made = closed_tessellation(m, 0.01);
    EXPECT_NEAR(signed_volume(made.mesh), 8 * std::numbers::pi / 3, 0.15);
}

// A plate whose loop goes from a corner inwards along one edge and back along another. On each of the two
// stands a triangle; these share the edge, and the plate has it no more. In any order.
TEST(StepTwins, ways_that_enclose_nothing_hang_shells_together) {
    for (const std::string_view order :
         {"#700,#701,#702", "#702,#701,#700", "#701,#700,#702", "#700,#702,#701"}) {
        const bool begins_back = order == "#701,#700,#702";  // the loop begins with the way back
        const bool turned = order == "#700,#702,#701";       // the second edge runs against the curve
        Rows r;
        for (const Vec<3>& p : {Vec<3>{{0, 0, 0}},
                                {{4, 0, 0}},
                                {{4, 4, 0}},
                                {{0, 4, 0}},
                                {{1, 1, 0}},
                                {{2, 0, 2}},
                                {{0, 2, 2}}})
            r.vertex(p);
        for (int k = 0; k < 4; ++k) r.straight(k, k, (k + 1) % 4);
        r.straight(4, 0, 4), r.edge(5, turned ? 4 : 0, turned ? 0 : 4, 304);
        if (turned) r.rows = replaced(r.rows, "#204,#200,#304,.T.", "#204,#200,#304,.F.");
        const int back = turned ? 6 : -6;
        r.straight(6, 4, 5), r.straight(7, 5, 0), r.straight(8, 0, 6), r.straight(9, 6, 4);
        r.plane(0, 0, 1, 2), r.plane(1, 0, 4, 5), r.plane(2, 0, 6, 4);
        if (begins_back)
            r.face(0, "850", {back, 1, 2, 3, 4, 5});
        else
            r.face(0, "850", {1, 2, 3, 4, 5, back});
        r.face(1, "851", {5, 7, 8}), r.face(2, "852", {back, 9, 10});
        const Model m = items_model(
            "#10",
            text("#10=SHELL_BASED_SURFACE_MODEL('',(#11));\n#11=OPEN_SHELL('',(", order, "));\n", r.rows));
        ASSERT_EQ(m.faces.size(), 3u);
        EXPECT_EQ(m.edges.size(), 9u);
        EXPECT_EQ(m.approximations.size(), 1u);
        int shared = 0;
        std::vector<int> uses(m.edges.size(), 0);
        for (const Face& f : m.faces)
            for (const Loop& l : f.loops)
                for (const Coedge& c : l.coedges) uses[std::size_t(c.edge)] += 1;
        for (const int n : uses) shared += n == 2 ? 1 : 0;
        EXPECT_EQ(shared, 1);
        const auto made = tessellate(m, {.tolerance = 0.01});
        EXPECT_TRUE(must(made).refused.empty());
        EXPECT_EQ(made->topology.open_edges, 8);
        EXPECT_EQ(made->topology.misoriented_edges, 0);
        EXPECT_EQ(made->topology.non_manifold_edges, 0);
    }
}

// Halves of a circle between the same vertices, at the same parameters, enclose something.
TEST(StepTwins, other_edges_between_the_same_vertices_stay) {
    Rows r;
    r.vertex({{2, 0, 0}}), r.vertex({{-2, 0, 0}});
    r.rows +=
        "#50=CIRCLE('',#23,2.);\n#51=CIRCLE('',#52,2.);\n#52=AXIS2_PLACEMENT_3D('',#6,#53,#22);\n"
        "#53=DIRECTION('',(0.,0.,-1.));\n";
    r.edge(0, 0, 1, 50), r.edge(1, 0, 1, 51), r.face(0, "7", {1, -2});
    const Model m =
        items_model("#10", "#10=SHELL_BASED_SURFACE_MODEL('',(#11));\n#11=OPEN_SHELL('',(#700));\n" + r.rows);
    EXPECT_EQ(m.edges.size(), 2u);
    EXPECT_TRUE(m.approximations.empty());
    EXPECT_EQ(m.faces.at(0).loops.at(0).coedges.size(), 2u);
}

TEST(StepTwins, a_keyhole_of_two_edges_between_two_shells) {
    FF_CORPUS_OR_SKIP(path, "step_micro/ap214_distinct_edge_keyhole_rejoin.stp");
    const Model m = must(read_step(must(read_file(path.string(), 1 << 22))));
    EXPECT_TRUE(m.refused.empty());
    closed_tessellation(m, 0.01);
}

}  // namespace
}  // namespace freiform::test
