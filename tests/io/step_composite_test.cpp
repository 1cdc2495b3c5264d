// Edges on composite and trimmed curves: one edge for each segment, exactly what the file says.
#include <freiform/io/step_read.hpp>

#include <algorithm>
#include <support/random.hpp>
#include <support/refusal.hpp>
#include <support/solids.hpp>
#include <support/step_measures.hpp>
#include <support/step_polygons.hpp>

namespace freiform::test {
namespace {

constexpr double kPlate = 8 - (1 - kPi / 4);

// A plate in z = 0, tolerance 4e-5, which is 1e-5 of its size: #400 goes straight from (0, 0) to (4, 0), and
// #401 back along the curve #20. #41..#44 are segments: up to (4, 1), a quarter of the circle #36 to (3, 2),
// a spline to (0, 2) that is given against its segment, and down again, on a line that is trimmed against
// itself.
std::string plate_file(std::string_view curve, std::string_view sense = ".T.", std::string_view more = "") {
    return flat_file(text(
        "#8=SHAPE_REPRESENTATION('',(#10),#1);\n#10=SHELL_BASED_SURFACE_MODEL('',(#11));\n"
        "#11=OPEN_SHELL('',(#12));\n#12=ADVANCED_FACE('',(#13),#7,.T.);\n#13=FACE_OUTER_BOUND('',#14,.T.);\n"
        "#14=EDGE_LOOP('',(#500,#501));\n#500=ORIENTED_EDGE('',*,*,#400,.T.);\n"
        "#501=ORIENTED_EDGE('',*,*,#401,.T.);\n#400=EDGE_CURVE('front',#200,#201,#39,.T.);\n"
        "#401=EDGE_CURVE('back',#201,#200,#20,",
        sense,
        ");\n#200=VERTEX_POINT('',#50);\n#201=VERTEX_POINT('',#51);\n"
        "#50=CARTESIAN_POINT('',(0.,0.,0.));\n#51=CARTESIAN_POINT('',(4.,0.,0.));\n"
        "#52=CARTESIAN_POINT('',(4.,1.,0.));\n#53=CARTESIAN_POINT('',(3.,2.,0.));\n"
        "#54=CARTESIAN_POINT('',(0.,2.,0.));\n#55=CARTESIAN_POINT('',(3.,1.,0.));\n"
        "#60=DIRECTION('',(1.,0.,0.));\n#61=DIRECTION('',(0.,1.,0.));\n#62=VECTOR('',#60,1.);\n"
        "#63=VECTOR('',#61,1.);\n#39=LINE('',#50,#62);\n#38=LINE('',#50,#63);\n#35=LINE('',#51,#63);\n"
        "#36=CIRCLE('',#37,1.);\n#37=AXIS2_PLACEMENT_3D('',#55,$,$);\n"
        "#31=TRIMMED_CURVE('',#35,(PARAMETER_VALUE(0.)),(PARAMETER_VALUE(1.)),.T.,.PARAMETER.);\n"
        "#32=TRIMMED_CURVE('',#36,(#52,PARAMETER_VALUE(0.)),(#53,PARAMETER_VALUE(1.5707963267948966)),.T.,"
        ".CARTESIAN.);\n"
        "#33=B_SPLINE_CURVE_WITH_KNOTS('',1,(#54,#53),.UNSPECIFIED.,.F.,.F.,(2,2),(0.,1.),.UNSPECIFIED.);\n"
        "#34=TRIMMED_CURVE('',#38,(#54),(#50),.F.,.CARTESIAN.);\n"
        "#41=COMPOSITE_CURVE_SEGMENT(.CONTINUOUS.,.T.,#31);\n"
        "#42=COMPOSITE_CURVE_SEGMENT(.CONT_SAME_GRADIENT.,.T.,#32);\n"
        "#43=COMPOSITE_CURVE_SEGMENT(.CONTINUOUS.,.F.,#33);\n"
        "#44=COMPOSITE_CURVE_SEGMENT(.DISCONTINUOUS.,.T.,#34);\n",
        curve, more));
}
constexpr std::string_view kRow = "#20=COMPOSITE_CURVE('',(#41,#42,#43,#44),.F.);\n";
// The same curve the other way: segments that run against it.
constexpr std::string_view kBackward =
    "#20=COMPOSITE_CURVE('',(#74,#73,#72,#71),.F.);\n#71=COMPOSITE_CURVE_SEGMENT(.CONTINUOUS.,.F.,#31);\n"
    "#72=COMPOSITE_CURVE_SEGMENT(.CONTINUOUS.,.F.,#32);\n#73=COMPOSITE_CURVE_SEGMENT(.CONTINUOUS.,.T.,#33);\n"
    "#74=COMPOSITE_CURVE_SEGMENT(.CONTINUOUS.,.F.,#34);\n";

std::string why(const Model& m) { return m.refused.empty() ? "it says nothing" : m.refused[0].message; }

// Every edge begins and ends at its vertices, up to their tolerance.
void expect_joined(const Model& m) {
    for (const Edge& e : m.edges)
        for (const auto& [t, v] : {std::pair(e.range.lo, e.start), std::pair(e.range.hi, e.end)}) {
            const Vertex& vertex = m.vertices[std::size_t(v)];
            EXPECT_LE(norm(jet<0>(*e.curve, t).value() - vertex.point), vertex.tolerance + 1e-14);
        }
}

// The edge that stands alone is still a wire.
void expect_refused_face(std::string_view file, RefusalKind kind, std::string_view what,
                         const StepReadOptions& options = {}) {
    const Model m = must(read_step(file, options));
    EXPECT_TRUE(m.faces.empty() && m.repairs.empty());
    ASSERT_EQ(m.refused.size(), 1u);
    EXPECT_EQ(name_of(m.refused[0].kind), name_of(kind));
    EXPECT_EQ(m.refused[0].where, "#12 ADVANCED_FACE");
    EXPECT_NE(m.refused[0].message.find(what), std::string::npos) << m.refused[0].message;
}

Model plate(std::string_view curve, std::string_view sense = ".T.", std::string_view more = "",
            bool repair = false) {
    auto m = read_step(plate_file(curve, sense, more), {.repair = repair});
    EXPECT_TRUE(m) << m.error().where << ": " << m.error().message;
    if (!m) return {};
    EXPECT_EQ(m->faces.size(), 1u) << why(*m);
    expect_joined(*m);
    return *m;
}

std::vector<std::string> kinds(const Model& m) {
    std::vector<std::string> all;
    for (const Edge& e : m.edges) all.emplace_back(kind_name(*e.curve));
    return all;
}
const std::vector<std::string> kAsGiven{"line", "line", "circle", "bspline", "line"};

TEST(StepComposite, segments_are_edges_of_their_own_kind_that_share_vertices) {
    const Model m = plate(kRow);
    EXPECT_TRUE(m.refused.empty());
    EXPECT_TRUE(m.approximations.empty()) << m.approximations[0].what;
    EXPECT_EQ(kinds(m), kAsGiven);
    EXPECT_EQ(summary(m).vertices, 5);
    EXPECT_EQ(m.edges[2].range.lo, 0);
    EXPECT_EQ(m.edges[2].range.hi, kPi / 2);
    for (std::size_t k = 1; k < 5; ++k) EXPECT_EQ(m.edges[k].name, "back");
    EXPECT_NEAR(area_of(m), kPlate, 1e-4);
}

TEST(StepComposite, senses_of_edges_and_segments_change_nothing) {
    for (const bool backward : {false, true})
        for (const std::string_view wrapped :
             {"", "COMPOSITE_CURVE_ON_SURFACE", "SURFACE_CURVE", "nested", "complex"}) {
            std::string curve(backward ? kBackward : kRow), more;
            const std::string_view simple = "COMPOSITE_CURVE(";
            if (wrapped == "COMPOSITE_CURVE_ON_SURFACE") {
                curve.replace(4, simple.size() - 1, wrapped);
            } else if (wrapped == "SURFACE_CURVE") {
                curve.replace(0, 3, "#21");
                more = "#20=SURFACE_CURVE('',#21,(),.CURVE_3D.);\n";
            } else if (wrapped == "nested") {  // of which the inner one runs against the outer one
                curve.replace(0, 3, "#21");
                more =
                    "#20=COMPOSITE_CURVE('',(#22),.F.);\n#22=COMPOSITE_CURVE_SEGMENT(.DISCONTINUOUS.,.F.,#21)"
                    ";\n";
            } else if (wrapped == "complex") {
                const std::size_t begin = curve.find("('',") + 4, end = curve.find(";");
                curve.replace(4, end - 4,
                              text("(BOUNDED_CURVE()COMPOSITE_CURVE(", curve.substr(begin, end - begin),
                                   "CURVE()GEOMETRIC_REPRESENTATION_ITEM()REPRESENTATION_ITEM(''))"));
            }
            const Model m = plate(curve, backward != (wrapped == "nested") ? ".F." : ".T.", more);
            SCOPED_TRACE(text(wrapped, backward));
            EXPECT_TRUE(m.approximations.empty()) << m.approximations[0].what;
            EXPECT_EQ(kinds(m), kAsGiven);
            EXPECT_NEAR(area_of(m), kPlate, 1e-4);
        }
}

TEST(StepComposite, faces_on_both_sides_share_the_edges) {
    std::string file = plate_file(kRow, ".T.",
                                  "#82=ADVANCED_FACE('',(#83),#7,.F.);\n#83=FACE_OUTER_BOUND('',#84,.T.);\n"
                                  "#84=EDGE_LOOP('',(#85,#86));\n#85=ORIENTED_EDGE('',*,*,#401,.F.);\n"
                                  "#86=ORIENTED_EDGE('',*,*,#400,.F.);\n");
    const std::string_view shell = "OPEN_SHELL('',(#12))";
    const Model m = must(read_step(file.replace(file.find(shell), shell.size(), "OPEN_SHELL('',(#12,#82))")));
    EXPECT_EQ(summary(m).faces, 2);
    EXPECT_EQ(summary(m).edges, 5);
    EXPECT_EQ(summary(m).open_edges, 0);
    EXPECT_NEAR(area_of(m), 2 * kPlate, 1e-4);
}

TEST(StepComposite, vertices_cut_the_curve_where_they_lie) {
    // It begins at (4, -3), and ends at (-2, 0).
    const Model longer = plate(
        "#20=COMPOSITE_CURVE('',(#71,#42,#43,#44,#72),.F.);\n"
        "#71=COMPOSITE_CURVE_SEGMENT(.CONTINUOUS.,.T.,#73);\n"
        "#72=COMPOSITE_CURVE_SEGMENT(.CONTINUOUS.,.F.,#74);\n"
        "#73=TRIMMED_CURVE('',#35,(PARAMETER_VALUE(-3.)),(PARAMETER_VALUE(1.)),.T.,.PARAMETER.);\n"
        "#74=TRIMMED_CURVE('',#39,(PARAMETER_VALUE(-2.)),(PARAMETER_VALUE(0.)),.T.,.PARAMETER.);\n");
    EXPECT_EQ(kinds(longer), kAsGiven);
    EXPECT_EQ(longer.edges[1].range, (Interval{0, 1}));
    EXPECT_NEAR(area_of(longer), kPlate, 1e-4);
    // It closes along the front edge, and begins in the middle of the circle.
    const Model closed = plate(
        "#20=COMPOSITE_CURVE('',(#71,#43,#44,#73,#41,#72),.F.);\n"
        "#71=COMPOSITE_CURVE_SEGMENT(.CONTINUOUS.,.T.,#75);\n"
        "#72=COMPOSITE_CURVE_SEGMENT(.CONTINUOUS.,.T.,#76);\n"
        "#73=COMPOSITE_CURVE_SEGMENT(.CONTINUOUS.,.T.,#74);\n"
        "#74=TRIMMED_CURVE('',#39,(#50),(#51),.T.,.CARTESIAN.);\n"
        "#75=TRIMMED_CURVE('',#36,(PARAMETER_VALUE(1.)),(#53),.T.,.CARTESIAN.);\n"
        "#76=TRIMMED_CURVE('',#36,(#52),(PARAMETER_VALUE(1.)),.T.,.CARTESIAN.);\n");
    EXPECT_EQ(kinds(closed),
              (std::vector<std::string>{"line", "line", "circle", "circle", "bspline", "line"}));
    EXPECT_EQ(closed.edges[2].range, (Interval{0, 1}));
    EXPECT_NEAR(area_of(closed), kPlate, 1e-4);
}

TEST(StepComposite, a_curve_that_closes_may_be_the_whole_edge) {
    for (const char* sense : {".T.", ".F."}) {
        const Model m = must(read_step(flat_file(text(
            "#8=SHAPE_REPRESENTATION('',(#10),#1);\n#10=SHELL_BASED_SURFACE_MODEL('',(#11));\n"
            "#11=OPEN_SHELL('',(#12));\n#12=ADVANCED_FACE('',(#13),#7,.T.);\n"
            "#13=FACE_OUTER_BOUND('',#14,.T.);\n#14=EDGE_LOOP('',(#15));\n#15=ORIENTED_EDGE('',*,*,#16,",
            sense, ");\n#16=EDGE_CURVE('',#17,#17,#20,", sense,
            ");\n#17=VERTEX_POINT('',#18);\n#18=CARTESIAN_POINT('',(0.,2.,0.));\n"
            "#20=COMPOSITE_CURVE('',(#21,#22),.F.);\n#21=COMPOSITE_CURVE_SEGMENT(.CONTINUOUS.,.T.,#23);\n"
            "#22=COMPOSITE_CURVE_SEGMENT(.CONTINUOUS.,.T.,#24);\n"
            "#23=TRIMMED_CURVE('',#25,(PARAMETER_VALUE(0.)),(PARAMETER_VALUE(4.)),.T.,.PARAMETER.);\n"
            "#24=TRIMMED_CURVE('',#25,(PARAMETER_VALUE(4.)),(PARAMETER_VALUE(0.)),.T.,.PARAMETER.);\n"
            "#25=CIRCLE('',#5,2.);\n"))));
        ASSERT_EQ(m.faces.size(), 1u) << why(m);
        expect_joined(m);
        EXPECT_EQ(m.edges.size(), 3u);
        EXPECT_EQ(m.vertices.size(), 3u);
        EXPECT_NEAR(area_of(m), 4 * kPi, 1e-3);
    }
}

TEST(StepComposite, gaps_within_the_tolerance_are_that_of_their_vertex) {
    std::string file = plate_file(text(kRow, "#77=CARTESIAN_POINT('',(3.00003,1.,0.));\n"));
    file.replace(file.find("('',#55,"), 8, "('',#77,");
    file.replace(file.find("(#53,PAR"), 8, "(PAR");
    file.replace(file.find("(#52,PAR"), 8, "(PAR");
    const Model m = must(read_step(file));
    ASSERT_EQ(m.faces.size(), 1u) << why(m);
    expect_joined(m);
    EXPECT_EQ(std::ranges::count_if(m.vertices,
                                    [](const Vertex& v) { return std::abs(v.tolerance - 3e-5) < 1e-12; }),
              2);
    EXPECT_TRUE(m.refused.empty());
}

TEST(StepComposite, wider_gaps_are_refused_with_the_number_of_the_segment_or_closed_if_asked_for) {
    std::string file =
        plate_file("#20=COMPOSITE_CURVE('',(#41,#42,#43,#44),.F.);\n#77=CARTESIAN_POINT('',(0.,2.02,0.));\n");
    file.replace(file.find("(#54,#53)"), 9, "(#77,#53)");
    expect_refused_face(file, RefusalKind::invalid, "#44 COMPOSITE_CURVE_SEGMENT: begins 0.02");
    expect_refused_face(file, RefusalKind::invalid,
                        "the file says at most 4e-05; a repair (--repair) closes it");
    const Model repaired = must(read_step(file, {.repair = true}));
    ASSERT_EQ(repaired.faces.size(), 1u);
    expect_joined(repaired);
    EXPECT_EQ(repaired.edges.size(), 6u);
    ASSERT_EQ(repaired.repairs.size(), 1u);
    EXPECT_EQ(repaired.repairs[0].where, "#44 COMPOSITE_CURVE_SEGMENT");
    EXPECT_NEAR(repaired.repairs[0].distance, 0.02, 1e-12);
    expect_refused_face(file, RefusalKind::invalid, "begins 0.02", {.repair = true, .repair_limit = 0.01});
}

TEST(StepComposite, segments_that_run_against_their_neighbours_are_turned_and_told) {
    for (const int wrong : {41, 42, 43, 44}) {
        std::string file = plate_file(kRow);
        const std::string name = text("#", wrong, "=COMPOSITE_CURVE_SEGMENT(");
        const std::size_t at = file.find(",.", file.find(name) + name.size()) + 2;
        file[at] = file[at] == 'T' ? 'F' : 'T';
        const Model m = must(read_step(file));
        ASSERT_EQ(m.faces.size(), 1u) << why(m);
        EXPECT_EQ(kinds(m), kAsGiven);
        expect_joined(m);
        EXPECT_EQ(
            times_told(m, text("#", wrong, " COMPOSITE_CURVE_SEGMENT runs against its composite curve")), 1);
        EXPECT_NEAR(area_of(m), kPlate, 1e-4);
    }
    // An edge whose sense is wrong.
    const Model m = plate(kRow, ".F.");
    EXPECT_EQ(times_told(m, "#401 EDGE_CURVE runs against its curve"), 1);
    EXPECT_NEAR(area_of(m), kPlate, 1e-4);
}

TEST(StepComposite, what_contains_itself_or_has_no_end_is_refused_with_its_number) {
    const auto refused = [](std::string_view curve, RefusalKind kind, std::string_view what) {
        expect_refused_face(plate_file(curve), kind, what);
    };
    refused("#20=COMPOSITE_CURVE('',(#41,#71),.F.);\n#71=COMPOSITE_CURVE_SEGMENT(.CONTINUOUS.,.T.,#20);\n",
            RefusalKind::limit, "#20 COMPOSITE_CURVE: contains itself");
    std::string twice;  // each twice the one before
    for (int k = 0; k < 60; ++k)
        twice +=
            text("#", 1000 + k, "=COMPOSITE_CURVE('',(#", 2000 + k, ",#", 2000 + k, "),.F.);\n#", 2000 + k,
                 "=COMPOSITE_CURVE_SEGMENT(.CONTINUOUS.,.T.,#", k == 59 ? 31 : 1001 + k, ");\n");
    refused(text("#20=COMPOSITE_CURVE('',(#70),.F.);\n#70=COMPOSITE_CURVE_SEGMENT(.CONTINUOUS.,.T.,#1000);\n",
                 twice),
            RefusalKind::limit, "#20 COMPOSITE_CURVE: contains itself");
    refused("#20=COMPOSITE_CURVE('',(),.F.);\n", RefusalKind::invalid,
            "#20 COMPOSITE_CURVE: has no segments");
    refused("#20=COMPOSITE_CURVE('',(#71),.F.);\n#71=COMPOSITE_CURVE_SEGMENT(.CONTINUOUS.,.T.,#38);\n",
            RefusalKind::invalid, "#71 COMPOSITE_CURVE_SEGMENT: is a part of a curve without end");
    refused("#20=COMPOSITE_CURVE('',(#71),.F.);\n#71=COMPOSITE_CURVE_SEGMENT(.CONTINUOUS.,.T.,#999);\n",
            RefusalKind::unreadable, "#71 COMPOSITE_CURVE_SEGMENT: its curve is #999");
}

// The curve #20 in a set; points as in plates.
Model wire(std::string_view curve) {
    std::string file = plate_file(curve);
    const std::string_view shell = "#10=SHELL_BASED_SURFACE_MODEL('',(#11))";
    return must(read_step(file.replace(file.find(shell), shell.size(), "#10=GEOMETRIC_CURVE_SET('',(#20))")));
}

TEST(StepComposite, wires_of_segments_share_vertices_and_tell_gaps) {
    const Model m = wire("#20=COMPOSITE_CURVE('outline',(#41,#42,#43,#44),.F.);\n");
    EXPECT_EQ(kinds(m), (std::vector<std::string>{"line", "circle", "bspline", "line"}));
    EXPECT_EQ(m.vertices.size(), 5u);
    EXPECT_EQ(m.edges[0].name, "outline");
    expect_joined(m);
    const Model apart = wire("#20=COMPOSITE_CURVE('',(#41,#43,#44),.F.);\n");
    EXPECT_EQ(apart.edges.size(), 3u);
    EXPECT_EQ(apart.vertices.size(), 5u);
    EXPECT_EQ(times_told(apart, "#43 COMPOSITE_CURVE_SEGMENT begins 1.414"), 1);
}

constexpr std::string_view kPoints =
    "#71=CARTESIAN_POINT('',(1.,0.,0.));\n#72=CARTESIAN_POINT('',(0.,3.,0.));\n"
    "#73=CARTESIAN_POINT('',(-4.,0.,0.));\n#74=CARTESIAN_POINT('',(0.,-3.,0.));\n";

TEST(StepComposite, splines_that_close_are_trimmed_over_the_place_where_they_do) {
    // A closed quadrilateral over [0, 4].
    const std::string closed =
        text(kPoints,
             "#70=B_SPLINE_CURVE_WITH_KNOTS('',1,(#71,#72,#73,#74,#71),.UNSPECIFIED.,.T.,.F.,"
             "(2,1,1,1,2),(0.,1.,2.,3.,4.),.UNSPECIFIED.);\n");
    const auto part = [&](double from, double to, const char* sense) {
        const Model m = wire(text("#20=TRIMMED_CURVE('part',#70,(PARAMETER_VALUE(", from,
                                  ")),(PARAMETER_VALUE(", to, ")),", sense, ",.PARAMETER.);\n", closed));
        EXPECT_EQ(m.edges.size(), 1u);
        return m.edges.at(0);
    };
    const Edge over = part(3, 1, ".T."), back = part(1, 3, ".F.");
    for (const Edge& e : {over, back}) {
        EXPECT_EQ(e.name, "part");
        EXPECT_EQ(e.range, (Interval{3, 5}));
        EXPECT_EQ(jet<0>(*e.curve, 4).value(), (Vec<3>{{1, 0, 0}}));
        EXPECT_EQ(jet<0>(*e.curve, 4.5).value(), (Vec<3>{{0.5, 1.5, 0}}));
    }
    EXPECT_EQ(part(1, 3, ".T.").range, (Interval{1, 3}));
}

TEST(StepComposite, trims_say_which_part_of_a_curve_that_meets_itself_is_the_edge) {
    // A Bezier cubic with a loop, which passes (0, 0) at 0.2 and at 0.8 about; the edge is the loop alone.
    const std::string_view loop =
        "#70=B_SPLINE_CURVE_WITH_KNOTS('',3,(#71,#72,#73,#74),.UNSPECIFIED.,.F.,.F.,(4,4),(0.,1.),."
        "UNSPECIFIED.);\n"
        "#71=CARTESIAN_POINT('',(-1.,0.,0.));\n#72=CARTESIAN_POINT('',(3.,4.,0.));\n"
        "#73=CARTESIAN_POINT('',(-3.,4.,0.));\n#74=CARTESIAN_POINT('',(1.,0.,0.));\n";
    // x = (t - 1/2)(20 (t - 1/2)^2 - 3) vanishes at 1/2 +- sqrt(0.15)
    const double lo = 0.5 - std::sqrt(0.15), hi = 0.5 + std::sqrt(0.15), y = 12 * lo * hi;
    const Model m = must(read_step(flat_file(text(
        "#8=SHAPE_REPRESENTATION('',(#10),#1);\n#10=SHELL_BASED_SURFACE_MODEL('',(#11));\n"
        "#11=OPEN_SHELL('',(#12));\n#12=ADVANCED_FACE('',(#13),#7,.T.);\n#13=FACE_OUTER_BOUND('',#14,.T.);\n"
        "#14=EDGE_LOOP('',(#15));\n#15=ORIENTED_EDGE('',*,*,#16,.T.);\n#16=EDGE_CURVE('',#17,#17,#20,.T.);\n"
        "#17=VERTEX_POINT('',#18);\n#18=CARTESIAN_POINT('',(0.,",
        y, ",0.));\n#20=TRIMMED_CURVE('',#70,(PARAMETER_VALUE(", lo, ")),(PARAMETER_VALUE(", hi,
        ")),.T.,.PARAMETER.);\n", loop))));
    ASSERT_EQ(m.faces.size(), 1u) << why(m);
    ASSERT_EQ(m.edges.size(), 1u);
    EXPECT_EQ(m.edges[0].range, (Interval{lo, hi}));
}

}  // namespace
}  // namespace freiform::test
