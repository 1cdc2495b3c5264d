// Each kind of entity of curves, surfaces and styles that the reader names, in a file as small as it can be.
#include <freiform/io/step_read.hpp>

#include <numbers>
#include <support/refusal.hpp>
#include <support/step_items.hpp>
#include <support/step_polygons.hpp>

namespace freiform::test {
namespace {

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

// Between knots that few digits have made one there is nothing: functions there are left out, and what ends
// and begins inside a spline at one place is joined.
TEST(StepEntities, knots_that_are_one_leave_out_what_was_between_them) {
    const auto curve = [](std::string_view points, std::string_view knots, std::string_view weights = "") {
        if (weights.empty())
            return only_curve(text("#20=B_SPLINE_CURVE_WITH_KNOTS('',3,(", points, "),.UNSPECIFIED.,.F.,.F.,",
                                   knots, ",.UNSPECIFIED.);\n"));
        return only_curve(
            text("#20=(BOUNDED_CURVE()B_SPLINE_CURVE(3,(", points,
                 "),.UNSPECIFIED.,.F.,.F.)B_SPLINE_CURVE_WITH_KNOTS(", knots,
                 ",.UNSPECIFIED.)CURVE()GEOMETRIC_REPRESENTATION_ITEM()RATIONAL_B_SPLINE_CURVE((", weights,
                 "))REPRESENTATION_ITEM(''));\n"));
    };
    // At both ends: the first and the last two points count for nothing.
    EXPECT_EQ(curve("#36,#30,#31,#32,#33,#34,#30,#36", "(4,1,1,2,4),(0.,0.,0.5,1.,1.)").curve,
              curve("#30,#31,#32,#33,#34", "(4,1,4),(0.,0.5,1.)").curve);
    EXPECT_EQ(curve("#36,#30,#31,#32,#33", "(4,1,4),(0.,0.,1.)", "9.,1.,2.,3.,1.").curve,
              curve("#30,#31,#32,#33", "(4,4),(0.,1.)", "1.,2.,3.,1.").curve);
    // Inside: one corner is left of two.
    EXPECT_EQ(curve("#30,#31,#32,#33,#36,#33,#34,#35,#36", "(4,3,2,4),(0.,0.5,0.5,1.)").curve,
              curve("#30,#31,#32,#33,#34,#35,#36", "(4,3,4),(0.,0.5,1.)").curve);
    // If those two are not one, nothing says where the curve is.
    const std::string jump = item_file(
        "#10",
        "#10=GEOMETRIC_CURVE_SET('',(#20));\n"
        "#20=B_SPLINE_CURVE_WITH_KNOTS('',3,(#30,#31,#32,#33,#36,#34,#34,#35,#36),.UNSPECIFIED.,.F.,.F.,"
        "(4,3,2,4),(0.,0.5,0.5,1.),.UNSPECIFIED.);\n");
    expect_refusal(read_step(jump), RefusalKind::invalid, "#20 B_SPLINE_CURVE_WITH_KNOTS",
                   "has a knot that is repeated more than degree + 1 times, where its pieces are 1.414");
    // Nor if their weights are not: with one or the other it is another curve.
    const auto weights = [](std::string_view w) {
        return item_file("#10",
                         text("#10=GEOMETRIC_CURVE_SET('',(#20));\n#20=(BOUNDED_CURVE()B_SPLINE_CURVE(1,"
                              "(#30,#31,#32,#31,#34),.UNSPECIFIED.,.F.,.F.)B_SPLINE_CURVE_WITH_KNOTS("
                              "(2,1,2,2),(0.,1.,1.,2.),.UNSPECIFIED.)CURVE()GEOMETRIC_REPRESENTATION_ITEM()"
                              "RATIONAL_B_SPLINE_CURVE((",
                              w, "))REPRESENTATION_ITEM(''));\n"));
    };
    EXPECT_TRUE(must(read_step(weights("1.,2.,1.,2.,1."))).approximations.empty());
    const auto uneven = read_step(weights("1.,2.,1.,1.,1."));
    ASSERT_FALSE(uneven);
    EXPECT_NE(uneven.error().message.find("repeated more than degree + 1 times"), std::string::npos);
    // One that is beside it by less than the tolerance is told.
    const Model near = must(read_step(item_file(
        "#10",
        "#10=GEOMETRIC_CURVE_SET('',(#20));\n#40=CARTESIAN_POINT('',(3.00001,1.,0.));\n"
        "#20=B_SPLINE_CURVE_WITH_KNOTS('',3,(#30,#31,#32,#33,#36,#40,#34,#35,#36),.UNSPECIFIED.,.F.,.F.,"
        "(4,3,2,4),(0.,0.5,0.5,1.),.UNSPECIFIED.);\n")));
    ASSERT_EQ(near.approximations.size(), 1u);
    EXPECT_NEAR(near.approximations[0].bound.value_or(0), 1e-5, 1e-12);
}

TEST(StepEntities, surfaces_lose_rows_and_columns_between_knots_that_are_one) {
    const auto surface = [](std::string_view rows, std::string_view knots) {
        return std::get<Surface<Vec<3>>>(
            only_surface(text("#20=B_SPLINE_SURFACE_WITH_KNOTS('',1,1,(", rows,
                              "),.UNSPECIFIED.,.F.,.F.,.F.,", knots,
                              ",.UNSPECIFIED.);\n#50=CARTESIAN_POINT('',(0.,0.,3.));\n"
                              "#51=CARTESIAN_POINT('',(2.,0.,3.));\n#52=CARTESIAN_POINT('',(4.,0.,3.));\n"))
                .surface);
    };
    // A row at an end, a column inside.
    EXPECT_EQ(surface("(#36,#36,#36,#36,#36),(#30,#32,#36,#32,#34),(#50,#51,#31,#51,#52)",
                      "(2,1,2),(2,2,1,2),(0.,0.,1.),(0.,1.,1.,2.)"),
              surface("(#30,#32,#34),(#50,#51,#52)", "(2,2),(2,1,2),(0.,1.),(0.,1.,2.)"));
}

}  // namespace
}  // namespace freiform::test
