// What contradicts itself in a STEP file beyond its tolerance: refused or told, and made right when asked.
#include <freiform/io/file.hpp>
#include <freiform/io/step.hpp>
#include <freiform/io/step_read.hpp>
#include <freiform/model/tessellate.hpp>

#include <algorithm>
#include <support/corpus.hpp>
#include <support/random.hpp>
#include <support/refusal.hpp>
#include <support/solids.hpp>
#include <support/step_polygons.hpp>

namespace freiform::test {
namespace {

const StepReadOptions kRepair{.repair = true};

Model must_repair(const std::string& file, const StepReadOptions& options = kRepair) {
    auto m = read_step(file, options);
    EXPECT_TRUE(m) << m.error().where << ": " << m.error().message;
    return m ? *m : Model{};
}

// The one face of the file is refused; its edges remain.
void expect_refused(const std::string& file, const StepReadOptions& options, RefusalKind kind,
                    std::string_view message) {
    const auto m = read_step(file, options);
    ASSERT_TRUE(m) << m.error().message;
    EXPECT_TRUE(m->faces.empty());
    EXPECT_TRUE(m->repairs.empty());
    ASSERT_EQ(m->refused.size(), 1u);
    expect_refusal(Result<int>(std::unexpected(m->refused[0])), kind, "#12 ADVANCED_FACE", message);
}

// Area as seen from above, and volume.
std::array<double, 2> sums_of(const Model& m) {
    const auto t = tessellate(m, {.tolerance = 1e-2});
    EXPECT_TRUE(t) << t.error().message;
    if (!t) return {};
    EXPECT_TRUE(t->refused.empty());
    double area = 0;
    for (std::size_t i = 0; i < t->mesh.triangles.size(); ++i) {
        const auto [a, b, c] = t->mesh.points_of(i);
        const auto& p = t->mesh.points;
        area += cross(p[std::size_t(b)] - p[std::size_t(a)], p[std::size_t(c)] - p[std::size_t(a)])[2] / 2;
    }
    return {area, signed_volume(t->mesh)};
}

// Of a loop of straight edges, in the parameters.
double turn_of(const Model& m, const Loop& l) {
    double sum = 0;
    Vec<2> first{};
    for (std::size_t k = 0; k < l.coedges.size(); ++k) {
        const Coedge& c = l.coedges[k];
        const Interval on = m.edges[std::size_t(c.edge)].range;
        const Vec<2> a = jet<0>(c.curve, c.reversed ? on.hi : on.lo).value(),
                     b = jet<0>(c.curve, c.reversed ? on.lo : on.hi).value();
        if (k == 0) first = a;
        sum += cross(a - first, b - first);
    }
    return sum;
}

// The third edge, of length 0.01, is missing in the loop.
std::string open_file() {
    return replaced(polygon_file({{0, 0}, {3, 0}, {3, 2}, {2.99, 2}, {0, 2}}), "#501,#502,", "#501,");
}

TEST(StepRepair, an_open_loop_is_refused_and_a_repair_closes_it_with_a_straight_edge) {
    expect_refused(open_file(), {}, RefusalKind::invalid,
                   "#14 EDGE_LOOP: is not closed: its edge 2 ends 0.00999");
    expect_refused(open_file(), {}, RefusalKind::invalid, "--repair");
    const Model m = must_repair(open_file());
    ASSERT_EQ(m.faces.size(), 1u);
    EXPECT_TRUE(m.refused.empty());
    ASSERT_EQ(m.repairs.size(), 1u);
    EXPECT_EQ(m.repairs[0].where, "#14 EDGE_LOOP");
    EXPECT_NE(m.repairs[0].what.find("open behind its edge 2"), std::string::npos) << m.repairs[0].what;
    EXPECT_NEAR(m.repairs[0].distance, 0.01, 1e-12);
    EXPECT_EQ(m.faces[0].loops.at(0).coedges.size(), 5u);
    EXPECT_NEAR(sums_of(m)[0], 6, 1e-9);
}

TEST(StepRepair, gaps_are_closed_up_to_the_limit_that_is_stated) {
    expect_refused(open_file(), {.repair = true, .repair_limit = 0.005}, RefusalKind::invalid,
                   "a repair closes at most 0.005");
    EXPECT_EQ(must_repair(open_file(), {.repair = true, .repair_limit = 0.011}).repairs.size(), 1u);
    // Of its own accord it closes a hundredth of the face.
    const std::string wide =
        replaced(polygon_file({{0, 0}, {3, 0}, {3, 2}, {2.9, 2}, {0, 2}}), "#501,#502,", "#501,");
    expect_refused(wide, kRepair, RefusalKind::invalid, "a repair closes at most 0.036");
    EXPECT_EQ(must_repair(wide, {.repair = true, .repair_limit = 0.11}).repairs.size(), 1u);
}

TEST(StepRepair, faces_with_the_same_gap_share_the_edge_that_closes_it) {
    const std::string two =
        replaced(replaced(open_file(), "OPEN_SHELL('',(#12))", "OPEN_SHELL('',(#12,#812))"), "#8=SHAPE",
                 "#812=ADVANCED_FACE('',(#813),#7,.F.);\n#813=FACE_OUTER_BOUND('',#14,.F.);\n#8=SHAPE");
    const Model m = must_repair(two);
    ASSERT_EQ(m.faces.size(), 2u);
    EXPECT_EQ(m.repairs.size(), 2u);
    EXPECT_EQ(summary(m).open_edges, 0);
    EXPECT_EQ(summary(m).edges, 5);
}

TEST(StepRepair, a_face_that_is_right_is_not_touched) {
    const std::string good = polygon_file({{0, 0}, {3, 0}, {3, 2}, {0, 2}});
    const Model m = must_repair(good);
    EXPECT_TRUE(m.repairs.empty());
    EXPECT_TRUE(m.approximations.empty());
    EXPECT_TRUE(must_repair(good, {}).approximations.empty());
}

TEST(StepRepair, loops_that_run_the_wrong_way_are_told_and_a_repair_turns_them) {
    const std::string wrong =
        replaced(polygon_file({{0, 0}, {3, 0}, {3, 2}, {0, 2}}), "#13=FACE_OUTER_BOUND('',#14,.T.)",
                 "#13=FACE_OUTER_BOUND('',#14,.F.)");
    const Model told = must_repair(wrong, {}), turned = must_repair(wrong);
    ASSERT_EQ(told.approximations.size(), 1u);
    EXPECT_TRUE(told.approximations[0].what.starts_with("#12 ADVANCED_FACE: its loops run the wrong way"));
    EXPECT_TRUE(told.repairs.empty());
    EXPECT_LT(turn_of(told, told.faces.at(0).loops.at(0)), 0);
    ASSERT_EQ(turned.repairs.size(), 1u);
    EXPECT_EQ(turned.repairs[0].where, "#12 ADVANCED_FACE");
    EXPECT_TRUE(turned.approximations.empty());
    EXPECT_GT(turn_of(turned, turned.faces.at(0).loops.at(0)), 0);
    EXPECT_FALSE(turned.faces[0].reversed);
    EXPECT_NEAR(sums_of(turned)[0], 6, 1e-9);
}

TEST(StepRepair, the_faces_beside_say_whether_loops_or_the_normal_are_wrong) {
    const std::string good = must(write_step({"mm", {{"", frustum(2, 1, 3)}}}));
    const double volume = sums_of(must_repair(good))[1];
    EXPECT_GT(volume, 0);
    const std::size_t face = good.rfind("=ADVANCED_FACE(") /* a flat end */;
    const std::size_t sense = good.find(");\n", face) - 3, bound = good.rfind("FACE_OUTER_BOUND(", face);
    const auto flipped = [&](std::size_t at) {
        std::string s = good;
        s.replace(at, 3, s.substr(at, 3) == ".T." ? ".F." : ".T.");
        return s;
    };
    // Its normal against its own loops, which agree with those of the others.
    const std::string inside_out = flipped(sense);
    EXPECT_LT(sums_of(must_repair(inside_out, {}))[1], 0.9 * volume);
    const Model normal = must_repair(inside_out);
    ASSERT_EQ(normal.repairs.size(), 1u);
    EXPECT_NE(normal.repairs[0].what.find("its normal is turned"), std::string::npos)
        << normal.repairs[0].what;
    EXPECT_NEAR(sums_of(normal)[1], volume, 1e-9 * volume);
    // Its loops against its normal.
    const Model loops = must_repair(flipped(good.find(");\n", bound) - 3));
    ASSERT_EQ(loops.repairs.size(), 1u);
    EXPECT_NE(loops.repairs[0].what.find("they are turned"), std::string::npos) << loops.repairs[0].what;
    EXPECT_NEAR(sums_of(loops)[1], volume, 1e-9 * volume);
}

TEST(StepRepair, an_edge_far_beside_its_surface_is_refused_and_a_repair_says_so_in_its_tolerance) {
    const std::string off =
        replaced(polygon_file({{0, 0}, {3, 0}, {3, 2}, {0, 2}}), "#301=LINE('',#101,#601);",
                 "#301=B_SPLINE_CURVE_WITH_KNOTS('',2,(#101,#801,#102),.UNSPECIFIED.,.F.,.F.,(3,3),(0.,1.),."
                 "UNSPECIFIED.);\n"
                 "#801=CARTESIAN_POINT('',(3.,1.,0.3));");
    expect_refused(off, {}, RefusalKind::ill_conditioned, "#401 EDGE_CURVE: lies 0.15");
    const Model m = must_repair(off);
    ASSERT_EQ(m.faces.size(), 1u);
    ASSERT_EQ(m.repairs.size(), 1u);
    EXPECT_EQ(m.repairs[0].where, "#401 EDGE_CURVE");
    EXPECT_NEAR(m.repairs[0].distance, 0.15, 1e-6);
    double widest = 0;
    for (const Edge& e : m.edges) widest = std::max(widest, e.tolerance);
    EXPECT_GE(widest, 0.15);
    EXPECT_LE(widest, 0.31);
    const auto t = tessellate(m, {.tolerance = 1e-2});
    ASSERT_TRUE(t);
    EXPECT_GE(t->boundary_gap, 0.14);
    // What describes another face is none of this one.
    expect_refused(replaced(off, "(3.,1.,0.3)", "(3.,1.,3.)"), kRepair, RefusalKind::ill_conditioned,
                   "beside the surface");
}

TEST(StepRepair, units_and_places_of_an_assembly_scale_what_a_repair_says) {
    // The part is in metres, and so is its gap; the model in millimetres, as its first representation.
    const std::string data = open_file();
    const std::string file =
        replaced(replaced(data, "#8=SHAPE_REPRESENTATION('',(#10),#1)",
                          "#8=SHAPE_REPRESENTATION('',(#10),#61);\n#9=SHAPE_REPRESENTATION('',(#66),#1);\n"
                          "#61=(GEOMETRIC_REPRESENTATION_CONTEXT(3)GLOBAL_UNCERTAINTY_ASSIGNED_CONTEXT((#63))"
                          "GLOBAL_UNIT_ASSIGNED_CONTEXT((#62))REPRESENTATION_CONTEXT('',''));\n"
                          "#62=(LENGTH_UNIT()NAMED_UNIT(*)SI_UNIT($,.METRE.));\n"
                          "#63=UNCERTAINTY_MEASURE_WITH_UNIT(LENGTH_MEASURE(1.E-4),#62,'','');\n"
                          "#64=REPRESENTATION_MAP(#5,#8);\n#65=MAPPED_ITEM('',#64,#5);\n"
                          "#67=SHELL_BASED_SURFACE_MODEL('',(#68));\n#68=OPEN_SHELL('',(#12))"),
                 "(#66)", "(#65,#67)");
    const auto m = read_step(file, kRepair);
    ASSERT_TRUE(m) << m.error().message;
    ASSERT_EQ(m->repairs.size(), 2u);
    std::vector<double> distances{m->repairs[0].distance, m->repairs[1].distance};
    std::ranges::sort(distances);
    const double ratio = distances[1] / distances[0];
    EXPECT_NEAR(ratio, 1000, 1e-6);
    EXPECT_NEAR(distances[0], m->unit == "mm" ? 0.01 : 1e-5, 1e-12);
}

// A program that writes some faces against their normals: 46 faces of a closed solid.
TEST(StepRepair, turned_loops_of_a_real_file_change_neither_its_faces_nor_its_volume) {
    FF_CORPUS_OR_SKIP(path, "step/ec_exhaust-A.stp");
    const std::string bytes = must(read_file(path.string(), 1 << 22));
    const Model plain = must_repair(bytes, {}), repaired = must_repair(bytes);
    EXPECT_EQ(plain.faces.size(), 46u);
    EXPECT_EQ(repaired.faces.size(), 46u);
    EXPECT_TRUE(repaired.refused.empty());
    EXPECT_EQ(repaired.repairs.size(), 6u);
    EXPECT_EQ(std::ranges::count_if(
                  plain.approximations,
                  [](const auto& a) { return a.what.find("the wrong way around it") != a.what.npos; }),
              6);
    const double volume = sums_of(plain)[1];
    EXPECT_NEAR(sums_of(repaired)[1], volume, 1e-6 * std::abs(volume));
}

}  // namespace
}  // namespace freiform::test
