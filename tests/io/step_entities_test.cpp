// Each kind of entity that the reader names, in a file as small as it can be.
#include <freiform/io/step_read.hpp>

#include <cmath>
#include <numbers>
#include <support/random.hpp>
#include <support/refusal.hpp>
#include <support/step_polygons.hpp>

namespace freiform::test {
namespace {

// The items of one representation; #21 is the direction of z, #22 that of x, #24 that of y, #23 the frame at
// the origin, #30.. are the points (0, 0), (1, 2), (2, 0), (3, 1), (4, 0), (5, -1), (6, 0) of z = 0.
std::string item_file(std::string_view items, std::string_view more) {
    std::string s = text("#8=SHAPE_REPRESENTATION('',(", items,
                         "),#1);\n#21=DIRECTION('',(0.,0.,1.));\n#22=DIRECTION('',(1.,0.,0.));\n"
                         "#24=DIRECTION('',(0.,1.,0.));\n#23=AXIS2_PLACEMENT_3D('',#6,#21,#22);\n");
    constexpr double kHeights[] = {0, 2, 0, 1, 0, -1, 0};
    for (int i = 0; i < 7; ++i)
        s += text("#", 30 + i, "=CARTESIAN_POINT('',(", i, ".,", kHeights[i], ".,0.));\n");
    return flat_file(s += more);
}
Model items_model(std::string_view items, std::string_view more) {
    const Model m = must(read_step(item_file(items, more)));
    EXPECT_TRUE(m.refused.empty()) << m.refused[0].where << ": " << m.refused[0].message;
    return m;
}
// Of the one curve #20, or the one surface #20.
Edge only_curve(std::string_view more) {
    const Model m = items_model("#10", text("#10=GEOMETRIC_CURVE_SET('',(#20));\n", more));
    EXPECT_EQ(m.edges.size(), 1u);
    EXPECT_TRUE(m.approximations.empty());
    return m.edges.at(0);
}
Face only_surface(std::string_view more) {
    const Model m = items_model("#10", text("#10=GEOMETRIC_SET('',(#20));\n", more));
    EXPECT_EQ(m.faces.size(), 1u);
    return m.faces.at(0);
}
void expect_near(const Vec<3>& a, const Vec<3>& b) { EXPECT_NEAR(norm(a - b), 0, 1e-14); }
Vec<3> point_at(const Edge& e, double t) { return jet<0>(*e.curve, t).value(); }
Vec<3> point_at(const Face& f, double u, double v) { return jet<0>(f.surface, {u, v}).value(); }

TEST(StepEntities, frames_of_the_plane_need_no_direction) {
    const auto circle = [](std::string_view frame) {
        return std::get<Conic<3>>(
            *only_curve(text("#20=PCURVE('',#7,#40);\n#40=DEFINITIONAL_REPRESENTATION('',(#41),#1);\n"
                             "#41=CIRCLE('',#42,2.);\n#42=AXIS2_PLACEMENT_2D('',#43",
                             frame, ");\n#43=CARTESIAN_POINT('',(1.,0.));\n#44=DIRECTION('',(0.,-3.));\n"))
                 .curve);
    };
    const Vec<3> x{{2, 0, 0}}, y{{0, 2, 0}}, centre{{1, 0, 0}};
    for (const std::string_view none : {",$", ",*", ""})
        EXPECT_EQ(circle(none), (Conic<3>{ConicKind::ellipse, centre, x, y}));
    EXPECT_EQ(circle(",#44"), (Conic<3>{ConicKind::ellipse, centre, -1.0 * y, x}));
}

TEST(StepEntities, curves_of_parameters_are_offset_to_the_left) {
    const auto offset = [](std::string_view basis, std::string_view distance) {
        return item_file("#10",
                         text("#10=GEOMETRIC_CURVE_SET('',(#20));\n#20=PCURVE('',#7,#40);\n"
                              "#40=DEFINITIONAL_REPRESENTATION('',(#41),#1);\n#41=OFFSET_CURVE_2D('',#45,",
                              distance,
                              ",.F.);\n#45=TRIMMED_CURVE('',#48,(PARAMETER_VALUE(0.)),"
                              "(PARAMETER_VALUE(1.)),.T.,.PARAMETER.);\n#48=",
                              basis, ";\n",
                              "#43=CARTESIAN_POINT('',(1.,0.));\n#46=VECTOR('',#47,1.);\n"
                              "#47=DIRECTION('',(0.,1.));\n#42=AXIS2_PLACEMENT_2D('',#43,$);\n"));
    };
    const auto edge = [&](std::string_view basis, std::string_view distance) {
        return must(read_step(offset(basis, distance))).edges.at(0);
    };
    EXPECT_EQ(point_at(edge("LINE('',#43,#46)", "0.25"), 0.5), (Vec<3>{{0.75, 0.5, 0}}));
    EXPECT_EQ(point_at(edge("LINE('',#43,#46)", "-0.25"), 0.5), (Vec<3>{{1.25, 0.5, 0}}));
    const Edge circle = edge("CIRCLE('',#42,2.)", "0.5");
    EXPECT_NEAR(norm(point_at(circle, 0.3) - Vec<3>{{1, 0, 0}}), 1.5, 1e-15);
    const auto ellipse = read_step(offset("ELLIPSE('',#42,2.,1.)", "0.5"));
    ASSERT_FALSE(ellipse);
    EXPECT_NE(ellipse.error().message.find("no line and no circle"), std::string::npos)
        << ellipse.error().where << ": " << ellipse.error().message;
}

TEST(StepEntities, frames_in_space_need_neither_axis_nor_direction) {
    const auto circle = [](std::string_view frame) {
        return std::get<Conic<3>>(
            *only_curve(text("#20=CIRCLE('',#40,1.);\n#40=AXIS2_PLACEMENT_3D('',#6,", frame, ");\n")).curve);
    };
    const Vec<3> x{{1, 0, 0}}, y{{0, 1, 0}}, z{{0, 0, 1}}, o{};
    EXPECT_EQ(circle("$,$"), (Conic<3>{ConicKind::ellipse, o, x, y}));
    EXPECT_EQ(circle("#24,$"), (Conic<3>{ConicKind::ellipse, o, x, -1.0 * z}));
    EXPECT_EQ(circle("#22,$"), (Conic<3>{ConicKind::ellipse, o, y, z})) << "x is along the axis";
    EXPECT_EQ(circle("$,#24"), (Conic<3>{ConicKind::ellipse, o, y, -1.0 * x}));
}

TEST(StepEntities, conics_have_the_parameters_of_the_standard) {
    const auto trim = [](std::string_view basis) {
        return only_curve(
            text("#20=TRIMMED_CURVE('',#25,(PARAMETER_VALUE(-1.)),(PARAMETER_VALUE(0.5)),.T.,"
                 ".PARAMETER.);\n#25=",
                 basis, ";\n"));
    };
    const Edge ellipse = only_curve("#20=ELLIPSE('',#23,3.,2.);\n");
    EXPECT_EQ(kind_name(*ellipse.curve), "ellipse");
    EXPECT_EQ(ellipse.start, ellipse.end);
    expect_near(point_at(ellipse, 1), {{3 * std::cos(1), 2 * std::sin(1), 0}});
    const Edge hyperbola = trim("HYPERBOLA('',#23,3.,2.)");
    EXPECT_EQ(hyperbola.range.lo, -1);
    EXPECT_EQ(hyperbola.range.hi, 0.5);
    expect_near(point_at(hyperbola, 0.5), {{3 * std::cosh(0.5), 2 * std::sinh(0.5), 0}});
    expect_near(point_at(trim("PARABOLA('',#23,3.)"), 0.5), {{3 * 0.25, 2 * 3 * 0.5, 0}});
}

TEST(StepEntities, splines_without_knots_have_those_that_their_types_imply) {
    const auto spline = [](std::string_view type, int degree, std::string_view points) {
        return only_curve(text("#20=", type, "('',", degree, ",(", points, "),.UNSPECIFIED.,.F.,.F.);\n"));
    };
    const Edge bezier = spline("BEZIER_CURVE", 3, "#30,#31,#32,#33");
    EXPECT_EQ(point_at(bezier, 0.5), (Vec<3>{{1.5, (0 + 3 * 2 + 3 * 0 + 1) / 8.0, 0}}));
    const Edge pieces = spline("BEZIER_CURVE", 3, "#30,#31,#32,#33,#34,#35,#36");
    EXPECT_EQ(pieces.range.hi, 2);
    EXPECT_EQ(point_at(pieces, 1), (Vec<3>{{3, 1, 0}}));
    const Edge quasi = spline("QUASI_UNIFORM_CURVE", 2, "#30,#31,#32,#33");
    EXPECT_EQ(quasi.range.hi, 2);
    EXPECT_EQ(point_at(quasi, 1), (Vec<3>{{1.5, 1, 0}})) << "between the points in the middle";
    EXPECT_EQ(point_at(quasi, 2), (Vec<3>{{3, 1, 0}}));
    const Edge uniform = spline("UNIFORM_CURVE", 2, "#30,#31,#32");
    EXPECT_EQ(uniform.range.lo, 0);
    EXPECT_EQ(uniform.range.hi, 1);
    EXPECT_EQ(point_at(uniform, 0), (Vec<3>{{0.5, 1, 0}}));
    EXPECT_EQ(point_at(uniform, 0.5), (Vec<3>{{1, (0 + 6 * 2 + 0) / 8.0, 0}}));
    const auto bare = read_step(item_file(
        "#10",
        "#10=GEOMETRIC_CURVE_SET('',(#20));\n#20=B_SPLINE_CURVE('',2,(#30,#31,#32),.UNSPECIFIED.,.F."
        ",.F.);\n"));
    expect_refusal(bare, RefusalKind::invalid, "#20 B_SPLINE_CURVE", "neither has knots nor implies them");
}

TEST(StepEntities, rational_ones_imply_knots_as_well) {
    const Edge e = only_curve(
        "#20=(BEZIER_CURVE()BOUNDED_CURVE()B_SPLINE_CURVE(2,(#40,#41,#42),.CIRCULAR_ARC.,.F.,.F.)CURVE()"
        "GEOMETRIC_REPRESENTATION_ITEM()RATIONAL_B_SPLINE_CURVE((1.,1.,2.))REPRESENTATION_ITEM(''));\n"
        "#40=CARTESIAN_POINT('',(5.,0.));\n#41=CARTESIAN_POINT('',(5.,5.));\n"
        "#42=CARTESIAN_POINT('',(0.,5.));\n");
    for (int k = 0; k <= 8; ++k) EXPECT_NEAR(norm(point_at(e, k / 8.0)), 5, 1e-14);
    const Face f = only_surface(
        "#20=(BEZIER_SURFACE()BOUNDED_SURFACE()B_SPLINE_SURFACE(2,1,((#40,#50),(#41,#51),(#42,#52)),"
        ".UNSPECIFIED.,.F.,.F.,.F.)GEOMETRIC_REPRESENTATION_ITEM()RATIONAL_B_SPLINE_SURFACE(((1.,1.),(1.,1.),"
        "(2.,2.)))REPRESENTATION_ITEM('')SURFACE());\n"
        "#40=CARTESIAN_POINT('',(5.,0.,0.));\n#41=CARTESIAN_POINT('',(5.,5.,0.));\n"
        "#42=CARTESIAN_POINT('',(0.,5.,0.));\n#50=CARTESIAN_POINT('',(5.,0.,7.));\n"
        "#51=CARTESIAN_POINT('',(5.,5.,7.));\n#52=CARTESIAN_POINT('',(0.,5.,7.));\n");
    const Vec<3> p = point_at(f, 0.3, 0.5);
    EXPECT_NEAR(std::hypot(p[0], p[1]), 5, 1e-14);
    EXPECT_NEAR(p[2], 3.5, 1e-14);
}

TEST(StepEntities, surfaces_without_knots_have_those_that_their_types_imply) {
    const auto surface = [](std::string_view type) {
        return only_surface(text("#20=", type,
                                 "('',2,1,((#30,#40),(#31,#41),(#32,#42),(#33,#43)),.UNSPECIFIED.,.F.,.F.,"
                                 ".F.);\n#40=CARTESIAN_POINT('',(0.,0.,1.));\n#41=CARTESIAN_POINT('',(1.,2.,"
                                 "1.));\n#42=CARTESIAN_POINT('',(2.,0.,1.));\n"
                                 "#43=CARTESIAN_POINT('',(3.,1.,1.));\n"));
    };
    expect_near(point_at(surface("QUASI_UNIFORM_SURFACE"), 1, 0.5), {{1.5, 1, 0.5}});
    expect_near(point_at(surface("UNIFORM_SURFACE"), 1, 0.5), {{1.5, 1, 0.5}});
    EXPECT_EQ(domain(surface("UNIFORM_SURFACE").surface)[0].hi, 2);
    // Four points are no pieces of degree 2.
    expect_refusal(
        read_step(item_file("#10",
                            "#10=GEOMETRIC_SET('',(#20));\n#20=BEZIER_SURFACE('',2,1,((#30,#31),(#32,"
                            "#33),(#34,#35),(#36,#30)),.UNSPECIFIED.,.F.,.F.,.F.);\n")),
        RefusalKind::invalid, "#20 BEZIER_SURFACE", "neither has knots nor implies them");
    const Face bezier =
        only_surface("#20=BEZIER_SURFACE('',1,1,((#30,#31),(#32,#33)),.UNSPECIFIED.,.F.,.F.,.F.);\n");
    EXPECT_EQ(point_at(bezier, 0.5, 0.5), (Vec<3>{{1.5, 0.75, 0}}));
}

TEST(StepEntities, tori_are_turned_circles_also_those_that_meet_themselves) {
    const Face torus = only_surface("#20=TOROIDAL_SURFACE('',#23,5.,2.);\n");
    EXPECT_EQ(kind_name(torus.surface), "torus");
    expect_near(point_at(torus, 0, 0), {{7, 0, 0}});
    expect_near(point_at(torus, 0, std::numbers::pi / 2), {{5, 0, 2}});
    expect_near(point_at(torus, std::numbers::pi / 2, 0), {{0, 7, 0}});
    const Face lemon = only_surface(
        "#20=RECTANGULAR_TRIMMED_SURFACE('',#25,0.,1.,-1.,1.,.T.,.T.);\n"
        "#25=DEGENERATE_TOROIDAL_SURFACE('',#23,1.,2.,.T.);\n");
    expect_near(point_at(lemon, 0, 0), {{3, 0, 0}});
    expect_near(point_at(lemon, 0, 1), {{1 + 2 * std::cos(1), 0, 2 * std::sin(1)}});
}

TEST(StepEntities, swept_surfaces_keep_the_parameters_of_their_curves) {
    const Face turned = only_surface(
        "#20=SURFACE_OF_REVOLUTION('',#25,#26);\n#25=BEZIER_CURVE('',1,(#40,#41),.UNSPECIFIED.,.F.,.F.);\n"
        "#26=AXIS1_PLACEMENT('',#6,#21);\n#40=CARTESIAN_POINT('',(2.,0.,0.));\n"
        "#41=CARTESIAN_POINT('',(4.,0.,6.));\n");
    expect_near(point_at(turned, 0, 0.5), {{3, 0, 3}});
    expect_near(point_at(turned, std::numbers::pi / 2, 1), {{0, 4, 6}});
    const Face drawn = only_surface(
        "#20=RECTANGULAR_TRIMMED_SURFACE('',#25,0.,1.,0.,2.,.T.,.T.);\n"
        "#25=SURFACE_OF_LINEAR_EXTRUSION('',#26,#27);\n"
        "#26=BEZIER_CURVE('',2,(#30,#31,#32),.UNSPECIFIED.,.F.,.F.);\n#27=VECTOR('',#21,3.);\n");
    expect_near(point_at(drawn, 0.5, 2), {{1, 1, 6}});
}

TEST(StepEntities, replicas_of_surfaces_and_solids_are_moved_and_scaled) {
    constexpr std::string_view kOperator =
        "#28=CARTESIAN_TRANSFORMATION_OPERATOR_3D('','',$,$,#36,2.,$);\n";  // from (6, 0, 0), twice as large
    const Face f = only_surface(
        text("#20=SURFACE_REPLICA('',#25,#28);\n#25=SPHERICAL_SURFACE('',#23,5.);\n", kOperator));
    expect_near(point_at(f, 0, 0), {{16, 0, 0}});
    const Model solid = items_model(
        "#10",
        text("#10=SOLID_REPLICA('',#11,#28);\n#11=MANIFOLD_SOLID_BREP('ball',#12);\n"
             "#12=CLOSED_SHELL('',(#13));\n#13=ADVANCED_FACE('',(#14),#16,.T.);\n"
             "#14=FACE_BOUND('',#15,.T.);\n#15=VERTEX_LOOP('',#17);\n#16=SPHERICAL_SURFACE('',#23,5.);\n"
             "#17=VERTEX_POINT('',#18);\n#18=CARTESIAN_POINT('',(0.,0.,-5.));\n",
             kOperator));
    ASSERT_EQ(solid.bodies.size(), 1u);
    EXPECT_TRUE(solid.bodies[0].solid);
    expect_near(solid.vertices.at(0).point, {{6, 0, -10}});
}

TEST(StepEntities, curves_on_surfaces_are_the_curves_in_space_that_they_name) {
    for (const std::string_view kind : {"INTERSECTION_CURVE", "SEAM_CURVE", "SURFACE_CURVE"}) {
        const Edge e =
            only_curve(text("#20=", kind, "('',#25,(#7,#7),.CURVE_3D.);\n#25=CIRCLE('',#23,3.);\n"));
        EXPECT_EQ(kind_name(*e.curve), "circle");
    }
}

constexpr std::string_view kThreeEdges =
    "#50=VERTEX_POINT('',#30);\n#51=VERTEX_POINT('',#32);\n#52=VERTEX_POINT('',#33);\n"
    "#60=EDGE_CURVE('a',#50,#51,#70,.T.);\n#61=EDGE_CURVE('b',#51,#52,#71,.T.);\n"
    "#62=EDGE_CURVE('NONE',#52,#50,#72,.T.);\n#63=ORIENTED_EDGE('',*,*,#60,.T.);\n"
    "#64=ORIENTED_EDGE('',*,*,#61,.T.);\n#65=ORIENTED_EDGE('',*,*,#62,.T.);\n"
    "#70=POLYLINE('',(#30,#32));\n#71=POLYLINE('',(#32,#33));\n#72=POLYLINE('',(#33,#30));\n";

TEST(StepEntities, wires_of_edges_loops_and_segments_are_edges) {
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

// A tetrahedron of POLY_LOOPs, each face on the plane through its corners.
TEST(StepEntities, polyhedra_share_the_edges_between_their_points) {
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
        s += text("#", 100 + k, "=FACE_SURFACE('',(#", 110 + k, "),#", 120 + k, ",.T.);\n#", 110 + k,
                  "=FACE_OUTER_BOUND('',#", 130 + k, ",.T.);\n#", 130 + k, "=POLY_LOOP('',(#",
                  40 + faces[k][0], ",#", 40 + faces[k][1], ",#", 40 + faces[k][2], "));\n#", 120 + k,
                  "=PLANE('',#", 140 + k, ");\n#", 140 + k, "=AXIS2_PLACEMENT_3D('',#", 40 + faces[k][0],
                  ",#", 150 + k, ",#", 160 + k, ");\n#", 150 + k, "=DIRECTION('',(", z[0], ".,", z[1], ".,",
                  z[2], ".));\n#", 160 + k, "=DIRECTION('',(", x[0], ".,", x[1], ".,", x[2], ".));\n");
    }
    const Model m = items_model("#10", s);
    const ModelSummary n = summary(m);
    EXPECT_EQ(n.faces, 4);
    EXPECT_EQ(n.edges, 6);
    EXPECT_EQ(n.vertices, 4);
    EXPECT_EQ(n.open_edges, 0);
    EXPECT_EQ(n.solids, 1);
}

constexpr std::string_view kTwoBalls =
    "#12=CLOSED_SHELL('',(#13));\n#13=ADVANCED_FACE('',(#14),#16,.T.);\n#14=FACE_BOUND('',#15,.T.);\n"
    "#15=VERTEX_LOOP('',#17);\n#16=SPHERICAL_SURFACE('',#23,5.);\n#17=VERTEX_POINT('',#18);\n"
    "#18=CARTESIAN_POINT('',(0.,0.,-5.));\n#112=CLOSED_SHELL('',(#113));\n"
    "#113=ADVANCED_FACE('',(#114),#116,.T.);\n#114=FACE_BOUND('',#115,.T.);\n#115=VERTEX_LOOP('',#117);\n"
    "#116=SPHERICAL_SURFACE('',#23,2.);\n#117=VERTEX_POINT('',#118);\n"
    "#118=CARTESIAN_POINT('',(0.,0.,-2.));\n";

TEST(StepEntities, voids_are_shells_that_are_turned) {
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

TEST(StepEntities, sets_of_faces_are_bodies_and_oriented_faces_uses_of_them) {
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

TEST(StepEntities, a_bounded_surface_is_a_face_within_its_boundary_curves) {
    const Face f = only_surface(
        "#20=CURVE_BOUNDED_SURFACE('',#7,(#40,#50),.F.);\n#40=OUTER_BOUNDARY_CURVE('',(#41),.F.);\n"
        "#41=COMPOSITE_CURVE_SEGMENT(.CONTINUOUS.,.T.,#42);\n#42=CIRCLE('',#23,5.);\n"
        "#50=BOUNDARY_CURVE('',(#51),.F.);\n#51=COMPOSITE_CURVE_SEGMENT(.CONTINUOUS.,.F.,#52);\n"
        "#52=CIRCLE('',#23,2.);\n");
    EXPECT_EQ(f.loops.size(), 2u);
}

TEST(StepEntities, colours_are_numbers_or_names) {
    const auto styled = [](std::string_view kind, std::string_view colour) {
        return must(read_step(polygon_file(
                        {{0, 0}, {3, 0}, {3, 2}},
                        text("#900=STYLED_ITEM('',(#901),#12);\n#901=PRESENTATION_STYLE_ASSIGNMENT((#902));\n"
                             "#902=SURFACE_STYLE_USAGE(.BOTH.,#903);\n#903=SURFACE_SIDE_STYLE('',(#904));\n"
                             "#904=SURFACE_STYLE_FILL_AREA(#905);\n#905=FILL_AREA_STYLE('',(#906));\n"
                             "#906=FILL_AREA_STYLE_COLOUR('',#907);\n#907=",
                             colour, ";\n", kind))))
            .faces.at(0)
            .colour;
    };
    const auto rgb = styled("", "COLOUR_RGB('',0.25,0.5,0.75)");
    ASSERT_TRUE(rgb);
    EXPECT_EQ(rgb->r, 0.25);
    EXPECT_EQ(rgb->g, 0.5);
    EXPECT_EQ(rgb->b, 0.75);
    const auto named = styled("", "DRAUGHTING_PRE_DEFINED_COLOUR('yellow')");
    ASSERT_TRUE(named);
    EXPECT_EQ(named->r, 1);
    EXPECT_EQ(named->g, 1);
    EXPECT_EQ(named->b, 0);
}

TEST(StepEntities, patches_of_a_composite_surface_are_faces) {
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

TEST(StepEntities, parts_of_edges_and_faces_lie_on_what_they_are_parts_of) {
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

TEST(StepEntities, parts_of_themselves_are_refused) {
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
