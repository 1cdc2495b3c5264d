// Each kind of entity of topology that the reader names, in a file as small as it can be.
#include <freiform/io/step_read.hpp>

#include <support/refusal.hpp>
#include <support/solids.hpp>
#include <support/step_items.hpp>
#include <support/step_polygons.hpp>

namespace freiform::test {
namespace {

constexpr std::string_view kThreeEdges =
    "#50=VERTEX_POINT('',#30);\n#51=VERTEX_POINT('',#32);\n#52=VERTEX_POINT('',#33);\n"
    "#60=EDGE_CURVE('a',#50,#51,#70,.T.);\n#61=EDGE_CURVE('b',#51,#52,#71,.T.);\n"
    "#62=EDGE_CURVE('NONE',#52,#50,#72,.T.);\n#63=ORIENTED_EDGE('',*,*,#60,.T.);\n"
    "#64=ORIENTED_EDGE('',*,*,#61,.T.);\n#65=ORIENTED_EDGE('',*,*,#62,.T.);\n"
    "#70=POLYLINE('',(#30,#32));\n#71=POLYLINE('',(#32,#33));\n#72=POLYLINE('',(#33,#30));\n";

TEST(StepTopology, wires_of_edges_loops_and_segments_are_edges) {
    for (const std::string_view wires :
         {"#10=EDGE_BASED_WIREFRAME_MODEL('',(#11));\n#11=CONNECTED_EDGE_SET('',(#60,#61,#62));\n",
          "#10=SHELL_BASED_WIREFRAME_MODEL('',(#11,#12));\n#11=WIRE_SHELL('',(#13));\n"
          "#13=EDGE_LOOP('',(#63,#64,#65));\n#12=VERTEX_SHELL('',#14);\n#14=VERTEX_LOOP('',#50);\n"}) {
        const Model m = items_model("#10", text(wires, kThreeEdges));
        ASSERT_EQ(m.edges.size(), 3u);
        EXPECT_EQ(m.edges[0].name, "a");
        EXPECT_EQ(m.edges[1].name, "b");
        EXPECT_EQ(m.edges[2].name, "");
    }
    const Model m = items_model(
        "#10", text("#10=GEOMETRIC_CURVE_SET('',(#80,#30));\n#80=COMPOSITE_CURVE('',(#81,#82),.F.);\n"
                    "#81=COMPOSITE_CURVE_SEGMENT(.CONTINUOUS.,.T.,#70);\n"
                    "#82=COMPOSITE_CURVE_SEGMENT(.DISCONTINUOUS.,.T.,#71);\n",
                    kThreeEdges));
    EXPECT_EQ(m.edges.size(), 2u);
}

// A tetrahedron of POLY_LOOPs, each face on the plane through its corners, or all on that of the first.
std::string tetrahedron(bool one_plane) {
    const double corners[4][3] = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
    const int faces[4][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};
    std::string s = "#10=FACETED_BREP('',#11);\n#11=CLOSED_SHELL('',(#100,#101,#102,#103));\n";
    for (int k = 0; k < 4; ++k)
        s += text("#", 40 + k, "=CARTESIAN_POINT('',(", corners[k][0], ".,", corners[k][1], ".,",
                  corners[k][2], ".));\n");
    for (int k = 0; k < 4; ++k) {
        const auto at = [&](int c) {
            const double* p = corners[faces[k][c]];
            return Vec<3>{{p[0], p[1], p[2]}};
        };
        const Vec<3> x = at(1) - at(0), z = cross(x, at(2) - at(0));
        s += text("#", 100 + k, "=FACE_SURFACE('',(#", 110 + k, "),#", one_plane ? 120 : 120 + k, ",.T.);\n#",
                  110 + k, "=FACE_OUTER_BOUND('',#", 130 + k, ",.T.);\n#", 130 + k, "=POLY_LOOP('',(#",
                  40 + faces[k][0], ",#", 40 + faces[k][1], ",#", 40 + faces[k][2], "));\n#", 120 + k,
                  "=PLANE('',#", 140 + k, ");\n#", 140 + k, "=AXIS2_PLACEMENT_3D('',#", 40 + faces[k][0],
                  ",#", 150 + k, ",#", 160 + k, ");\n#", 150 + k, "=DIRECTION('',(", z[0], ".,", z[1], ".,",
                  z[2], ".));\n#", 160 + k, "=DIRECTION('',(", x[0], ".,", x[1], ".,", x[2], ".));\n");
    }
    return s;
}
void expect_tetrahedron(const Model& m) {
    const ModelSummary n = summary(m);
    EXPECT_EQ(n.faces, 4);
    EXPECT_EQ(n.edges, 6);
    EXPECT_EQ(n.vertices, 4);
    EXPECT_EQ(n.open_edges, 0);
    EXPECT_EQ(n.solids, 1);
}

TEST(StepTopology, polyhedra_share_the_edges_between_their_points) {
    const Model m = items_model("#10", tetrahedron(false));
    expect_tetrahedron(m);
    EXPECT_TRUE(m.approximations.empty());
}

TEST(StepTopology, planes_that_polygons_miss_are_those_through_their_corners_and_told) {
    const std::string good = tetrahedron(true);
    // With the first bound said to run the other way, and its polygon told the other way: the same face.
    const std::string turned =
        replaced(replaced(good, "#110=FACE_OUTER_BOUND('',#130,.T.)", "#110=FACE_OUTER_BOUND('',#130,.F.)"),
                 "(#40,#42,#41)", "(#41,#42,#40)");
    for (const std::string& file : {good, turned}) {
        const Model m = items_model("#10", file);
        expect_tetrahedron(m);
        ASSERT_EQ(m.approximations.size(), 4u);
        EXPECT_NE(m.approximations[1].what.find("#101 FACE_SURFACE"), std::string::npos)
            << m.approximations[1].what;
        EXPECT_NE(m.approximations[1].what.find("#120 PLANE"), std::string::npos);
        const Tessellation made = closed_tessellation(m, 0.01);
        EXPECT_TRUE(made.turned_shells.empty());
        EXPECT_NEAR(signed_volume(made.mesh), 1.0 / 6, 1e-12);
    }
}

// Corners that are in no plane do not say which plane is meant.
TEST(StepTopology, polygons_that_are_in_no_plane_are_taken_on_that_of_the_file_if_it_is_near) {
    for (const double off : {0.01, 5.0}) {
        const auto m = read_step(item_file(
            "#10", text("#10=OPEN_SHELL('',(#50));\n#50=FACE_SURFACE('',(#51),#7,.T.);\n"
                        "#51=FACE_BOUND('',#52,.T.);\n#52=POLY_LOOP('',(#60,#61,#62,#63));\n"
                        "#60=CARTESIAN_POINT('',(0.,0.,",
                        off, "));\n#61=CARTESIAN_POINT('',(3.,0.,0.));\n#62=CARTESIAN_POINT('',(3.,3.,", off,
                        "));\n#63=CARTESIAN_POINT('',(0.,3.,0.));\n")));
        if (off < 1) {
            ASSERT_EQ(must(m).faces.size(), 1u);
            ASSERT_EQ(m->approximations.size(), 4u);
            for (const Approximation& a : m->approximations)
                EXPECT_NE(a.what.find("beside #50 FACE_SURFACE; the file says"), std::string::npos) << a.what;
        } else {
            ASSERT_TRUE(!m || m->faces.empty());
            EXPECT_NE((m ? m->refused.at(0) : m.error()).message.find("beside the surface"),
                      std::string::npos);
        }
    }
}

constexpr std::string_view kTwoBalls =
    "#12=CLOSED_SHELL('',(#13));\n#13=ADVANCED_FACE('',(#14),#16,.T.);\n#14=FACE_BOUND('',#15,.T.);\n"
    "#15=VERTEX_LOOP('',#17);\n#16=SPHERICAL_SURFACE('',#23,5.);\n#17=VERTEX_POINT('',#18);\n"
    "#18=CARTESIAN_POINT('',(0.,0.,-5.));\n#112=CLOSED_SHELL('',(#113));\n"
    "#113=ADVANCED_FACE('',(#114),#116,.T.);\n#114=FACE_BOUND('',#115,.T.);\n#115=VERTEX_LOOP('',#117);\n"
    "#116=SPHERICAL_SURFACE('',#23,2.);\n#117=VERTEX_POINT('',#118);\n"
    "#118=CARTESIAN_POINT('',(0.,0.,-2.));\n";

TEST(StepTopology, voids_are_shells_that_are_turned) {
    for (const bool forward : {false, true}) {
        const Model m = items_model(
            "#10", text("#10=BREP_WITH_VOIDS('',#12,(#19));\n#19=ORIENTED_CLOSED_SHELL('',*,#112,",
                        forward ? ".T." : ".F.", ");\n", kTwoBalls));
        ASSERT_EQ(m.bodies.size(), 1u);
        ASSERT_EQ(m.bodies[0].shells.size(), 2u);
        EXPECT_TRUE(m.bodies[0].solid);
        EXPECT_FALSE(m.shells[0].faces.at(0).reversed);
        EXPECT_EQ(m.shells[1].faces.at(0).reversed, !forward);
    }
}

TEST(StepTopology, sets_of_faces_are_bodies_and_oriented_faces_uses_of_them) {
    const Model m = items_model(
        "#10", text("#10=FACE_BASED_SURFACE_MODEL('both',(#41,#42));\n#41=CONNECTED_FACE_SET('',(#43));\n"
                    "#42=ORIENTED_OPEN_SHELL('',*,#45,.F.);\n#45=OPEN_SHELL('',(#113));\n"
                    "#43=ORIENTED_FACE('',*,#13,.F.);\n",
                    kTwoBalls));
    ASSERT_EQ(m.bodies.size(), 2u);
    EXPECT_EQ(m.bodies[0].name, "both");
    EXPECT_FALSE(m.bodies[0].solid);
    ASSERT_EQ(m.shells.size(), 2u);
    EXPECT_TRUE(m.shells[0].faces.at(0).reversed);
    EXPECT_TRUE(m.shells[1].faces.at(0).reversed);
}

TEST(StepTopology, a_bounded_surface_is_a_face_within_its_boundary_curves) {
    const Face f = only_surface(
        "#20=CURVE_BOUNDED_SURFACE('',#7,(#40,#50),.F.);\n#40=OUTER_BOUNDARY_CURVE('',(#41),.F.);\n"
        "#41=COMPOSITE_CURVE_SEGMENT(.CONTINUOUS.,.T.,#42);\n#42=CIRCLE('',#23,5.);\n"
        "#50=BOUNDARY_CURVE('',(#51),.F.);\n#51=COMPOSITE_CURVE_SEGMENT(.CONTINUOUS.,.F.,#52);\n"
        "#52=CIRCLE('',#23,2.);\n");
    EXPECT_EQ(f.loops.size(), 2u);
}

TEST(StepTopology, patches_of_a_composite_surface_are_faces) {
    const auto file = [](std::string_view rows) {
        return item_file("#10",
                         text("#10=GEOMETRIC_SET('',(#40));\n#40=RECTANGULAR_COMPOSITE_SURFACE('both',", rows,
                              ");\n#41=SURFACE_PATCH(#43,.CONTINUOUS.,.CONTINUOUS.,.T.,.T.);\n"
                              "#42=SURFACE_PATCH(#44,.CONTINUOUS.,.CONTINUOUS.,.T.,.F.);\n"
                              "#43=RECTANGULAR_TRIMMED_SURFACE('first',#7,0.,1.,0.,2.,.T.,.T.);\n"
                              "#44=RECTANGULAR_TRIMMED_SURFACE('second',#7,1.,3.,0.,2.,.T.,.T.);\n"));
    };
    const Model m = must(read_step(file("((#41),(#42))")));
    EXPECT_TRUE(m.refused.empty()) << m.refused[0].where << ": " << m.refused[0].message;
    ASSERT_EQ(m.faces.size(), 2u);
    EXPECT_EQ(m.faces[0].name, "first");
    EXPECT_EQ(m.faces[1].name, "second");
    const auto bad = read_step(file("(#41,#42)"));
    ASSERT_FALSE(bad) << "not a list of lists";
    const auto odd = read_step(file("((#40),(#10))"));
    EXPECT_TRUE(!odd || !odd->refused.empty()) << "a surface of itself";
}

// A rectangle whose lower side is a part of a longer edge, in the upper half of a square that is a face.
const std::string kParts = [] {
    std::string s = polygon_file(
        {{0, 0}, {4, 0}, {4, 2}, {0, 2}},
        "#800=CARTESIAN_POINT('',(1.,0.,0.));\n#801=VERTEX_POINT('',#800);\n"
        "#802=CARTESIAN_POINT('',(3.,0.,0.));\n#803=VERTEX_POINT('',#802);\n"
        "#804=CARTESIAN_POINT('',(3.,1.,0.));\n#805=VERTEX_POINT('',#804);\n"
        "#806=CARTESIAN_POINT('',(1.,1.,0.));\n#807=VERTEX_POINT('',#806);\n"
        "#810=SUBEDGE('',#801,#803,#811);\n#811=SUBEDGE('',#200,#803,#400);\n"
        "#812=EDGE_CURVE('',#803,#805,#820,.T.);\n#820=LINE('',#802,#821);\n#821=VECTOR('',#822,1.);\n"
        "#822=DIRECTION('',(0.,1.,0.));\n"
        "#813=EDGE_CURVE('',#805,#807,#823,.T.);\n#823=LINE('',#804,#824);\n#824=VECTOR('',#825,1.);\n"
        "#825=DIRECTION('',(-1.,0.,0.));\n"
        "#814=EDGE_CURVE('',#801,#807,#826,.T.);\n#826=LINE('',#800,#821);\n"
        "#830=ORIENTED_EDGE('',*,*,#810,.T.);\n#831=ORIENTED_EDGE('',*,*,#812,.T.);\n"
        "#832=ORIENTED_EDGE('',*,*,#813,.T.);\n#833=ORIENTED_EDGE('',*,*,#814,.F.);\n"
        "#840=EDGE_LOOP('',(#830,#831,#832,#833));\n#841=FACE_OUTER_BOUND('',#840,.T.);\n"
        "#842=SUBFACE('part',(#841),#12);\n");
    return s;
}();

std::string with_shell_of(std::string file, std::string_view face) {
    const std::string_view shell = "OPEN_SHELL('',(#12))";
    file.replace(file.find(shell), shell.size(), text("OPEN_SHELL('',(", face, "))"));
    return file;
}

TEST(StepTopology, parts_of_edges_and_faces_lie_on_what_they_are_parts_of) {
    const Model m = must(read_step(with_shell_of(kParts, "#842")));
    ASSERT_TRUE(m.refused.empty()) << m.refused[0].where << ": " << m.refused[0].message;
    ASSERT_EQ(m.faces.size(), 1u);
    EXPECT_EQ(m.faces[0].name, "part");
    EXPECT_EQ(kind_name(m.faces[0].surface), "plane");
    ASSERT_EQ(m.faces[0].loops.size(), 1u);
    ASSERT_EQ(m.faces[0].loops[0].coedges.size(), 4u);
    const Edge& lower = m.edges.at(std::size_t(m.faces[0].loops[0].coedges[0].edge));
    EXPECT_EQ(lower.range.length(), 2);
    EXPECT_EQ(m.vertices.at(std::size_t(lower.start)).point, (Vec<3>{{1, 0, 0}}));
    EXPECT_EQ(m.vertices.at(std::size_t(lower.end)).point, (Vec<3>{{3, 0, 0}}));
}

TEST(StepTopology, parts_of_themselves_are_refused) {
    for (const auto& [from, to, where] : {std::array{"'',#200,#803,#400", "'',#200,#803,#810", "SUBEDGE"},
                                          std::array{"(#841),#12", "(#841),#842", "SUBFACE"}}) {
        std::string file = with_shell_of(kParts, "#842,#12");
        file.replace(file.find(from), std::string_view(from).size(), to);
        const Model m = must(read_step(file));
        EXPECT_EQ(m.faces.size(), 1u) << "the other face is there";
        ASSERT_EQ(m.refused.size(), 1u);
        EXPECT_NE((m.refused[0].where + m.refused[0].message).find(where), std::string::npos)
            << m.refused[0].where << ": " << m.refused[0].message;
        EXPECT_NE(m.refused[0].message.find("of itself"), std::string::npos) << m.refused[0].message;
    }
}

}  // namespace
}  // namespace freiform::test
