// Models read from STEP files, written and read once more: what a file says of parts of closed curves and
// surfaces.
#include <freiform/io/step.hpp>
#include <freiform/io/step_read.hpp>
#include <freiform/model/tessellate.hpp>

#include <support/refusal.hpp>
#include <support/solids.hpp>
#include <support/step_measures.hpp>
#include <support/step_polygons.hpp>

namespace freiform::test {
namespace {

Model read_again(const Model& m) {
    const Model again = must(read_step(must(write_step(Document{"mm", {{"", m, {}}}}))));
    EXPECT_TRUE(again.refused.empty()) << again.refused[0].where << ": " << again.refused[0].message;
    EXPECT_EQ(again.faces.size(), m.faces.size());
    return again;
}

// A plane face inside of one edge, on a polyline through the points with the parameters 0, 1, .. .
Model face_in(const std::vector<Corner>& points, Corner vertex) {
    std::string s =
        "#8=SHAPE_REPRESENTATION('',(#10),#1);\n#10=SHELL_BASED_SURFACE_MODEL('',(#11));\n"
        "#11=OPEN_SHELL('',(#12));\n#12=ADVANCED_FACE('',(#13),#7,.T.);\n#13=FACE_OUTER_BOUND('',#14,.T.);\n"
        "#14=EDGE_LOOP('',(#15));\n#15=ORIENTED_EDGE('',*,*,#16,.T.);\n#16=EDGE_CURVE('',#17,#17,#18,.T.);\n";
    std::string refs, counts, knots;
    for (std::size_t i = 0; i < points.size(); ++i) {
        const char* comma = i > 0 ? "," : "";
        s += text("#", 100 + i, "=CARTESIAN_POINT('',(", points[i].x, ",", points[i].y, ",0.));\n");
        refs += text(comma, "#", 100 + i), knots += text(comma, i, ".");
        counts += text(comma, i == 0 || i + 1 == points.size() ? 2 : 1);
    }
    s += text("#17=VERTEX_POINT('',#19);\n#19=CARTESIAN_POINT('',(", vertex.x, ",", vertex.y,
              ",0.));\n#18=B_SPLINE_CURVE_WITH_KNOTS('',1,(", refs, "),.UNSPECIFIED.,.F.,.F.,(", counts,
              "),(", knots, "),.UNSPECIFIED.);\n");
    return must(read_step(flat_file(s)));
}

TEST(StepAgain, edges_are_the_parts_of_their_curves_that_they_were) {
    // Round twice, from the middle on.
    Model m = face_in({{0, 0}, {10, 0}, {10, 10}, {0, 10}, {0, 0}}, {10, 10});
    ASSERT_EQ(m.edges.size(), 1u);
    EXPECT_EQ(m.edges[0].range.lo, 2);
    EXPECT_EQ(m.edges[0].range.hi, 6);
    EXPECT_NEAR(area_of(read_again(m)), 100, 1e-9);
    // Open, crosses itself at its vertex.
    auto& edge = m.edges[0];
    const auto basis = must(BSplineBasis::clamped_uniform(1, 6));
    edge.curve = must(Curve<Vec<3>>::make(
        {basis},
        Net<1, Vec<3>>(
            {6}, {{{10, -5, 0}}, {{10, 10, 0}}, {{0, 10, 0}}, {{0, 0, 0}}, {{10, 0, 0}}, {{15, 0, 0}}})));
    const Interval on = basis.domain();
    edge.range = {on.lo + on.length() / 15, on.lo + on.length() * 4 / 5};
    edge.start = edge.end = 0;
    m.vertices[0].point = {{10, 0, 0}};
    m.faces[0].loops[0].coedges[0].curve = must(Curve<Vec<2>>::make(
        {basis}, Net<1, Vec<2>>({6}, {{{10, -5}}, {{10, 10}}, {{0, 10}}, {{0, 0}}, {{10, 0}}, {{15, 0}}})));
    EXPECT_NEAR(area_of(m), 100, 1e-9);
    EXPECT_NEAR(area_of(read_again(m)), 100, 1e-9);
}

// A plane face between an open conic and a chord of it.
Model bow(const Conic<3>& conic, Interval on) {
    const CurveGeometry<3> curve = conic;
    const Vec<3> a = jet<0>(curve, on.lo).value(), b = jet<0>(curve, on.hi).value();
    const auto flat = [](const Vec<3>& v) { return Vec<2>{{v[0], v[1]}}; };
    Model m;
    m.unit = "mm";
    m.vertices = {{a, 0}, {b, 0}};
    Edge arc, chord;
    arc.curve = curve, chord.curve = Line<3>{b, a - b};
    arc.range = on;
    arc.start = chord.end = 0, arc.end = chord.start = 1;
    m.edges = {arc, chord};
    Face f;
    f.surface = Extrusion{Line<3>{{}, {{1, 0, 0}}}, {{0, 1, 0}}, SurfaceKind::plane};
    f.loops = {{{{0, false, Conic<2>{conic.kind, flat(conic.centre), flat(conic.x), flat(conic.y)}},
                 {1, false, Line<2>{flat(b), flat(a - b)}}}}};
    m.faces = {f};
    m.shells = {{{{0, false}}, false}};
    m.bodies = {{{0}, false, "", std::nullopt}};
    return must(make_model(m));
}

// Axes that were turned are at right angles but for rounding; those of x y = 1 need not be by far.
TEST(StepAgain, hyperbolas_and_parabolas_need_not_be_given_by_their_axes) {
    const Vec<3> x{{std::cos(0.7), std::sin(0.7), 0}}, y{{-std::sin(0.7), std::cos(0.7), 0}};
    for (const ConicKind kind : {ConicKind::hyperbola, ConicKind::parabola})
        for (const double skew : {0.0, 1e-15, -1e-9, 0.4, -0.9}) {
            const Model m = bow({kind, {{1, 2, 0}}, 3.0 * x, 2.0 * (y + skew * x)}, {-0.75, 1.25});
            const Model again = read_again(m);
            EXPECT_NEAR(area_of(again, 1e-6), area_of(m, 1e-6), 1e-5) << kind_name(*m.edges[0].curve) << skew;
            EXPECT_LT(norm(again.vertices[0].point - m.vertices[0].point), 1e-14);
            const Edge& e = again.edges[again.edges[0].curve->index() == 1 ? 0 : 1];
            const Conic<3>& c = std::get<Conic<3>>(*m.edges[0].curve);
            for (const double part : {0.0, 0.2, 0.5, 0.8, 1.0}) {
                const double t = e.range.lo + part * e.range.length();
                const Vec<3> p = jet<0>(*e.curve, t).value() - c.centre, n = cross(c.x, c.y);
                const double a = dot(cross(p, c.y), n) / dot(n, n), b = dot(cross(c.x, p), n) / dot(n, n);
                EXPECT_NEAR(kind == ConicKind::parabola ? a - b * b : a * a - b * b - 1, 0, 1e-12) << skew;
            }
        }
}

// A face on the surface #9 between the points #a and #b and those above, #(a + 1) and #(b + 1): along the
// curves #61 and #63, and up.
std::string side_of_tube(int a, int b) {
    return text(
        "#8=SHAPE_REPRESENTATION('',(#10),#1);\n#10=SHELL_BASED_SURFACE_MODEL('',(#11));\n"
        "#11=OPEN_SHELL('',(#12));\n#12=ADVANCED_FACE('',(#13),#9,.T.);\n#13=FACE_OUTER_BOUND('',#14,.T.);\n"
        "#14=EDGE_LOOP('',(#31,#32,#33,#34));\n#31=ORIENTED_EDGE('',*,*,#41,.T.);\n"
        "#32=ORIENTED_EDGE('',*,*,#42,.T.);\n#33=ORIENTED_EDGE('',*,*,#43,.F.);\n"
        "#34=ORIENTED_EDGE('',*,*,#44,.F.);\n#41=EDGE_CURVE('',#51,#52,#61,.T.);\n"
        "#42=EDGE_CURVE('',#52,#54,#62,.T.);\n#43=EDGE_CURVE('',#53,#54,#63,.T.);\n"
        "#44=EDGE_CURVE('',#51,#53,#64,.T.);\n#65=DIRECTION('',(0.,0.,1.));\n#66=VECTOR('',#65,1.);\n"
        "#51=VERTEX_POINT('',#",
        a, ");\n#52=VERTEX_POINT('',#", b, ");\n#53=VERTEX_POINT('',#", a + 1, ");\n#54=VERTEX_POINT('',#",
        b + 1, ");\n#62=LINE('',#", b, ",#66);\n#64=LINE('',#", a, ",#66);\n");
}

// The sides beyond two corners of a square tube, over the place where its surface begins.
TEST(StepAgain, surfaces_are_written_with_one_turn) {
    std::string s = side_of_tube(106, 102);
    constexpr double kSquare[][2] = {{10, 0}, {0, 10}, {-10, 0}, {0, -10}, {10, 0}};
    for (int i = 0; i < 10; ++i)
        s += text("#", 100 + i, "=CARTESIAN_POINT('',(", kSquare[i / 2][0], ",", kSquare[i / 2][1], ",",
                  i % 2, "));\n");
    for (int k = 0; k < 2; ++k)
        s += text("#", 61 + 2 * k, "=B_SPLINE_CURVE_WITH_KNOTS('',1,(#", 106 + k, ",#", 100 + k, ",#",
                  102 + k, "),.UNSPECIFIED.,.F.,.F.,(2,1,2),(0.,1.,2.),.UNSPECIFIED.);\n");
    s +=
        "#9=B_SPLINE_SURFACE_WITH_KNOTS('',1,1,((#100,#101),(#102,#103),(#104,#105),(#106,#107),(#108,#109)),"
        ".UNSPECIFIED.,.T.,.F.,.F.,(2,1,1,1,2),(2,2),(0.,1.,2.,3.,4.),(0.,1.),.UNSPECIFIED.);\n";
    Model m = must(read_step(flat_file(s)));
    ASSERT_EQ(m.faces.size(), 1u);
    const double area = 20 * std::sqrt(2.0);
    auto& surface = std::get<Surface<Vec<3>>>(m.faces[0].surface);
    EXPECT_EQ(surface.domain()[0], (Interval{0, 8})) << "unwound";
    const auto expect_again = [&] {
        EXPECT_NEAR(area_of(m), area, 1e-9);
        const Model again = must(read_step(must(write_step(Document{"mm", {{"", m, {}}}}))));
        ASSERT_EQ(again.faces.size(), 1u);
        EXPECT_NEAR(area_of(again), area, 1e-9);
        EXPECT_EQ(surface.net().flat()[3], std::get<Surface<Vec<3>>>(again.faces[0].surface).net().flat()[3]);
    };
    expect_again();
    // Not clamped, and a quarter longer than one turn.
    std::vector<Vec<3>> net;
    for (int i = 0; i < 12; ++i)
        net.push_back({{kSquare[i / 2 % 4][0], kSquare[i / 2 % 4][1], double(i % 2)}});
    surface = must(Surface<Vec<3>>::make(
        {must(BSplineBasis::make(1, {-1, 0, 1, 2, 3, 4, 5, 5.5})), must(BSplineBasis::make(1, {0, 0, 1, 1}))},
        Net<2, Vec<3>>({6, 2}, net)));
    expect_again();
}

// Quadratic, and not clamped: where its turn ends it is as smooth as elsewhere, and so is its offset.
TEST(StepAgain, splines_that_go_on_beyond_their_ends_stay_smooth_there) {
    std::string s = side_of_tube(112, 114), rims[2], rows;
    constexpr double kSquare[][2] = {{10, 0}, {0, 10}, {-10, 0}, {0, -10}, {5, -5}, {-5, 5}};
    for (int i = 0; i < 16; ++i) {
        const auto& p = kSquare[i < 12 ? i / 2 % 4 : i / 2 - 2];
        const char* comma = i > 1 ? "," : "";
        s += text("#", 100 + i, "=CARTESIAN_POINT('',(", p[0], ",", p[1], ",", i % 2, "));\n");
        if (i < 12) rims[i % 2] += text(comma, "#", 100 + i);
        if (i < 12 && i % 2 == 0) rows += text(comma, "(#", 100 + i, ",#", 101 + i, ")");
    }
    const std::string_view ones = "(1,1,1,1,1,1,1,1,1)", knots = "(-2.,-1.,0.,1.,2.,3.,4.,5.,6.)";
    for (int k = 0; k < 2; ++k)
        s += text("#", 61 + 2 * k, "=B_SPLINE_CURVE_WITH_KNOTS('',2,(", rims[k], "),.UNSPECIFIED.,.T.,.F.,",
                  ones, ",", knots, ",.UNSPECIFIED.);\n");
    s += text("#9=OFFSET_SURFACE('',#67,0.001,.F.);\n#67=B_SPLINE_SURFACE_WITH_KNOTS('',2,1,(", rows,
              "),.UNSPECIFIED.,.T.,.F.,.F.,", ones, ",(2,2),", knots, ",(0.,1.),.UNSPECIFIED.);\n");
    const Model m = must(read_step(flat_file(s)));
    ASSERT_EQ(m.faces.size(), 1u);
    const auto base = [](const Model& of) {
        return std::get<Surface<Vec<3>>>(*std::get<OffsetSurface>(of.faces.at(0).surface).base);
    };
    EXPECT_GT(base(m).domain()[0].hi, 4) << "unwound";
    EXPECT_EQ(base(m).basis(0).multiplicity(4), 1);
    const auto t = must(tessellate(m, {.tolerance = 0.01}));
    EXPECT_TRUE(t.refused.empty()) << t.refused[0].reason.message;
    EXPECT_EQ(base(read_again(m)), base(m));
}

// A cylinder, the vertices of whose rims are not opposite each other: the seam between them is a screw line,
// which has no curve in space.
TEST(StepAgain, seams_between_rims_are_left_to_those_who_read) {
    const Model m = must(read_step(flat_file(
        "#8=ADVANCED_BREP_SHAPE_REPRESENTATION('',(#10),#1);\n#10=MANIFOLD_SOLID_BREP('',#11);\n"
        "#11=CLOSED_SHELL('',(#12,#13,#14));\n#12=ADVANCED_FACE('',(#15,#16),#9,.T.);\n"
        "#13=ADVANCED_FACE('',(#17),#7,.F.);\n#14=ADVANCED_FACE('',(#18),#19,.T.);\n"
        "#9=CYLINDRICAL_SURFACE('',#5,1.);\n#19=PLANE('',#22);\n#20=CARTESIAN_POINT('',(0.,0.,2.));\n"
        "#22=AXIS2_PLACEMENT_3D('',#20,$,$);\n#23=CIRCLE('',#5,1.);\n#24=CIRCLE('',#22,1.);\n"
        "#25=CARTESIAN_POINT('',(1.,0.,0.));\n#26=CARTESIAN_POINT('',(0.6,0.8,2.));\n"
        "#27=VERTEX_POINT('',#25);\n#28=VERTEX_POINT('',#26);\n#29=EDGE_CURVE('',#27,#27,#23,.T.);\n"
        "#30=EDGE_CURVE('',#28,#28,#24,.T.);\n#31=ORIENTED_EDGE('',*,*,#29,.T.);\n"
        "#32=ORIENTED_EDGE('',*,*,#29,.F.);\n#33=ORIENTED_EDGE('',*,*,#30,.T.);\n"
        "#34=ORIENTED_EDGE('',*,*,#30,.F.);\n#35=EDGE_LOOP('',(#31));\n#36=EDGE_LOOP('',(#32));\n"
        "#37=EDGE_LOOP('',(#33));\n#38=EDGE_LOOP('',(#34));\n#15=FACE_BOUND('',#35,.T.);\n"
        "#16=FACE_BOUND('',#38,.T.);\n#17=FACE_OUTER_BOUND('',#36,.T.);\n"
        "#18=FACE_OUTER_BOUND('',#37,.T.);\n")));
    ASSERT_EQ(m.faces.size(), 3u);
    EXPECT_EQ(m.faces[0].loops.size(), 1u);
    const auto volume = [](const Model& solid) {
        EXPECT_TRUE(solid.bodies.at(0).solid);
        const auto t = must(tessellate(solid, {.tolerance = 1e-3}));
        EXPECT_EQ(summary(solid).open_edges, 0);
        return signed_volume(t.mesh);
    };
    EXPECT_NEAR(volume(m), 2 * kPi, 0.01);
    EXPECT_NEAR(volume(read_again(m)), volume(m), 1e-12);
    // Two screw lines that no edge has in common cannot be left out.
    Model slit = m;
    for (Coedge& c : slit.faces[0].loops[0].coedges)
        if (const Edge e = slit.edges[std::size_t(c.edge)]; c.reversed && !e.curve) {
            c.edge = int(slit.edges.size());
            slit.edges.push_back(e);
        }
    const auto refused = write_step(Document{"mm", {{"", slit, {}}}});
    ASSERT_FALSE(refused);
    EXPECT_NE(refused.error().message.find("on spline surfaces alone"), std::string::npos)
        << refused.error().message;
}

// A face in a solid and in a sheet.
TEST(StepAgain, bodies_share_faces) {
    Model m = sphere({}, 1);
    m.bodies.push_back(m.bodies.at(0));
    m.bodies[1].solid = false;
    m.bodies[1].shells = {int(m.shells.size())};
    m.shells.push_back(m.shells.at(0));
    const ModelSummary all = summary(m), again = summary(read_again(m));
    EXPECT_EQ(again.bodies, 2);
    EXPECT_EQ(again.solids, 1);
    EXPECT_EQ(again.shells, 2);
    EXPECT_EQ(again.vertices, all.vertices);
}

}  // namespace
}  // namespace freiform::test
