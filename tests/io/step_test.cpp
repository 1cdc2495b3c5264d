#include <freiform/io/document.hpp>
#include <freiform/io/file.hpp>
#include <freiform/io/iges.hpp>
#include <freiform/io/read.hpp>
#include <freiform/io/scene.hpp>
#include <freiform/io/step.hpp>
#include <freiform/io/step_read.hpp>
#include <freiform/model/swept_solid.hpp>
#include <freiform/model/tessellate.hpp>

#include <filesystem>
#include <fstream>
#include <sstream>
#include <support/random.hpp>
#include <support/refusal.hpp>
#include <support/regions.hpp>
#include <support/solids.hpp>
#include <support/step_measures.hpp>
#include <unistd.h>

namespace freiform::test {
namespace {

namespace fs = std::filesystem;

class Step : public testing::Test {
protected:
    void SetUp() override {
        if (!fs::exists(FREIFORM_OCCT_BINARY)) GTEST_SKIP() << FREIFORM_OCCT_BINARY << " is not built";
        ::setenv("FREIFORM_OCCT_IMPORT", FREIFORM_OCCT_BINARY, 1);
    }
    // What Open CASCADE understands.
    static Model read_again(const Document& document, bool iges = false) {
        const std::string name =
            (fs::temp_directory_path() / text("freiform-", ::getpid(), iges ? ".iges" : ".step")).string();
        std::ofstream(name, std::ios::binary) << must(iges ? write_iges(document) : write_step(document));
        ReadOptions options;
        options.step_reader = StepReader::occt;
        Document back = must(read_any(name, options));
        fs::remove(name);
        EXPECT_TRUE(back.left_out.empty());
        Model model = std::get<Model>(std::move(back.objects.at(0).shape));
        EXPECT_TRUE(model.refused.empty()) << model.refused[0].message;
        return model;
    }
    static double volume(const Model& model, double tolerance) {
        const auto t = must(tessellate(model, {.tolerance = tolerance}));
        EXPECT_EQ(t.topology.open_edges, 0);
        EXPECT_TRUE(t.refused.empty());
        return signed_volume(t.mesh);
    }
};

RegionLoops ring_region() { return loops_of({{ellipse({{5, 5}}, 2, 2), ellipse({{5.25, 5}}, 1, 0.5)}}); }

TEST_F(Step, control_points_knots_and_weights_come_back_exactly) {
    const Document document = must(read_document(R"({"freiform": 1, "unit": "mm", "objects": [
        {"type": "surface", "degrees": [2, 1], "knots": [[0,0,0,0.3,1,1,1],[0,0,1,1]],
         "points": [[[0.1,0,0.7],[0,1.1,0]],[[1e-3,0.2,1],[1,1,1.3]],[[2,0,0],[2,1,1e5]],[[3,0.1,0],[3,1,1]]]},
        {"type": "surface", "degrees": [1, 2], "knots": [[0,0,1,1],[0,0,0,1,1,1]],
         "points": [[[10,0,0],[10,1,0.1],[10,2,0]],[[11,0,0],[11,1,0.7],[11,2,0]]],
         "weights": [[1,0.7071067811865476,1],[1,0.3,1]]}]})"));
    for (const bool iges : {false, true}) {
        const Model model = read_again(document, iges);
        ASSERT_EQ(model.faces.size(), 2u);
        const auto& plain = std::get<Surface<Vec<3>>>(document.objects[0].shape);
        const auto& rational = std::get<Surface<Hom<3>>>(document.objects[1].shape);
        int found = 0;
        for (const Face& f : model.faces) {
            if (const auto* s = std::get_if<Surface<Vec<3>>>(&f.surface)) {
                EXPECT_EQ(s->net(), plain.net());
                EXPECT_TRUE(std::ranges::equal(s->basis(0).knots(), plain.basis(0).knots()));
                ++found;
            }
            if (const auto* s = std::get_if<Surface<Hom<3>>>(&f.surface)) {
                EXPECT_EQ(s->net(), rational.net());
                ++found;
            }
        }
        EXPECT_EQ(found, 2);
    }
}

TEST_F(Step, curves_come_back_exactly) {
    const Document document = must(read_document(R"({"freiform": 1, "unit": "mm", "objects": [
        {"type": "curve", "degree": 2, "knots": [0,0,0,0.25,1,1,1], "points": [[0.1,1],[1,2.2],[3,1],[4,0]]},
        {"type": "curve", "degree": 2, "points": [[0,0,1],[1,0.3,1],[1,1,1.7]], "weights": [1,0.6,1]}]})"));
    for (const bool iges : {false, true}) {
        const Model model = read_again(document, iges);
        ASSERT_EQ(model.edges.size(), 2u);
        const auto& plain = std::get<Curve<Vec<2>>>(document.objects[0].shape);
        EXPECT_EQ(std::get<Curve<Vec<3>>>(*model.edges[0].curve).net(), in_space(plain).net());
        EXPECT_EQ(std::get<Curve<Hom<3>>>(*model.edges[1].curve).net(),
                  std::get<Curve<Hom<3>>>(document.objects[1].shape).net());
    }
}

class SolidFiles : public Step, public testing::WithParamInterface<bool> {};

TEST_P(SolidFiles, keep_volumes_shells_and_faces) {
    const bool iges = GetParam();
    for (const Vec<3> by : {Vec<3>{{0, 0, 2}}, Vec<3>{{1, 0.5, -2}}}) {
        const Model solid = must(prism(ring_region(), by));
        const Model back = read_again({"mm", {{"plate", solid}}}, iges);
        EXPECT_EQ(back.faces.size(), solid.faces.size());
        EXPECT_EQ(summary(back).solids, 1);
        EXPECT_EQ(summary(back).open_edges, 0);
        EXPECT_NEAR(volume(back, 2e-2), 2 * kPi * (4 - 0.5), 0.5);
    }
    for (const double angle : {1.5, 2 * kPi})
        for (const double side : {1.0, -1.0}) {
            const Model solid =
                must(solid_of_revolution(ring_region(), {{{0, 0, 0}}, {{0, side, 0}}}, angle));
            const Model back = read_again({"mm", {{"ring", solid}}}, iges);
            EXPECT_EQ(summary(back).solids, 1);
            EXPECT_EQ(back.shells.size(), solid.shells.size()) << "a void is a shell of its own";
            EXPECT_NEAR(volume(back, 1e-1), angle * (5 * kPi * 4 - 5.25 * kPi * 0.5), 0.03 * angle * 55)
                << angle;
        }
    EXPECT_NEAR(volume(read_again({"mm", {{"", torus(3.0, 1.0)}}}, iges), 5e-2), 2 * kPi * kPi * 3, 2);
    EXPECT_NEAR(volume(read_again({"mm", {{"", sphere({{1, 2, 3}}, 1)}}}, iges), 1e-2), 4.0 / 3 * kPi, 0.1);
    EXPECT_NEAR(volume(read_again({"mm", {{"", frustum(2, 1, 3)}}}, iges), 1e-2), 7 * kPi, 0.2);
}

INSTANTIATE_TEST_SUITE_P(written, SolidFiles, testing::Bool(),
                         [](const auto& p) { return std::string(p.param ? "iges" : "step"); });

// A rational surface with a knot, a loop with corners and a cubic side, and a circle as a hole.
Document trimmed_sheet() {
    return must(
        read_document(R"({"freiform": 1, "unit": "mm", "objects": [{"name": "sheet", "type": "trimmed",
        "surface": {"type": "surface", "degrees": [2, 3], "knots": [[0,0,0,0.4,1,1,1],[0,0,0,0,1,1,1,1]],
            "points": [[[0,0,0],[0,1,1],[0,2,-1],[0,3,0]],[[1,0,1],[1,1,0],[1,2,2],[1,3,0]],
                       [[2,0,0],[2,1,1],[2,2,-1],[2,3,1]],[[3,0,0],[3,1,1],[3,2,0],[3,3,0]]],
            "weights": [[1,1,1,1],[1,2,1,1],[1,1,0.5,1],[1,1,1,1]]},
        "loops": [[{"degree": 1, "knots": [0,0,1,2,3,3], "points": [[0.1,0.1],[0.9,0.1],[0.9,0.9],[0.1,0.6]]},
                   {"degree": 3, "points": [[0.1,0.6],[0,0.4],[0.2,0.2],[0.1,0.1]]}],
                  [{"degree": 2, "knots": [0,0,0,1,1,2,2,3,3,4,4,4],
                    "points": [[0.6,0.4],[0.6,0.5],[0.5,0.5],[0.4,0.5],[0.4,0.4],[0.4,0.3],[0.5,0.3],[0.6,0.3],[0.6,0.4]],
                    "weights": [1,0.7071067811865476,1,0.7071067811865476,1,0.7071067811865476,1,0.7071067811865476,1]}]]}]})"));
}

TEST_F(Step, trimmed_surfaces_come_back_with_their_boundaries) {
    const Document document = trimmed_sheet();
    const double area = area_of(must(scene_of(document)), 2e-3);
    for (const bool iges : {false, true}) {
        const Model back = read_again(document, iges);
        ASSERT_EQ(back.faces.size(), 1u);
        EXPECT_EQ(back.faces[0].loops.size(), 2u);
        EXPECT_EQ(back.edges.size(), 8u) << "cut at corners";
        EXPECT_NEAR(area_of(back, 2e-3), area, 2e-3 * area);
        for (const Edge& e : back.edges) EXPECT_LE(e.tolerance, iges ? 2e-5 : 1e-6);
    }
}

// Edges and profiles are arcs with the parameters that they have, and loops have their curves in those: what
// reads them has neither to guess which side of a seam the loop is on (of the sphere, which has a window
// across, it took the window for the face) nor to bring edges and curves together.
TEST_F(Step, turned_surfaces_come_back_from_iges_with_what_lies_across_their_seams) {
    for (const auto& [name, size] :
         {std::pair{"window_in_a_sphere", 0.3}, {"quarter_dome", 20.0}, {"slanted_cylinder", 4.0}}) {
        const std::string file = text(FREIFORM_SOURCE_DIR, "/tests/data/step/", name, ".stp");
        const Model model = must(read_step(must(read_file(file, 1 << 20))));
        const Model back = read_again({"mm", {{"", model}}}, true);
        ASSERT_EQ(back.faces.size(), model.faces.size()) << name;
        EXPECT_EQ(back.edges.size(), model.edges.size()) << name;
        const double area = area_of(model, 1e-3 * size);
        EXPECT_NEAR(area_of(back, 1e-3 * size), area, 1e-3 * area) << name;
        const auto mesh = must(tessellate(back, {.tolerance = 1e-3 * size}));
        EXPECT_LE(mesh.boundary_gap, 1e-7 * size) << name;
    }
}

// As surfaces and edges come back as what they are, it takes no more triangles than before.
TEST_F(Step, cylinders_cones_and_ellipses_come_back_from_iges_as_such) {
    const auto tube = [](double angle) {
        return must(solid_of_revolution(loops_of({{rectangle(1, 0, 2, 3)}}), {{}, {{0, 1, 0}}}, angle));
    };
    for (const Model& solid :
         {tube(2 * kPi), tube(2), frustum(2, 1, 3), must(prism(ring_region(), {{0, 0, 2}})),
          must(solid_of_revolution(loops_of({{ellipse({{5, 5}}, 2, 1)}}), {{}, {{0, 1, 0}}}, 2))}) {
        const Model back = read_again({"mm", {{"", solid}}}, true);
        const auto mine = must(tessellate(solid, {.tolerance = 1e-2})),
                   again = must(tessellate(back, {.tolerance = 1e-2}));
        EXPECT_NEAR(double(again.mesh.triangles.size()), double(mine.mesh.triangles.size()),
                    0.1 * double(mine.mesh.triangles.size()));
        EXPECT_EQ(again.topology.open_edges, 0);
        EXPECT_LE(again.boundary_gap, 1e-9);
    }
}

// Both curves of an edge are rational, or both are angles.
TEST_F(Step, circles_in_the_parameters_of_splines_come_back_from_iges_with_their_edges) {
    const Document given = must(read_document(R"({"freiform": 1, "unit": "mm", "objects": [{"type": "model",
        "vertices": [{"point": [1,0,0]}, {"point": [-1,0,0]}],
        "edges": [{"curve": {"type": "ellipse", "centre": [0,0,0], "x": [1,0,0], "y": [0,1,0]},
                   "range": [0,3.141592653589793], "start": 0, "end": 1},
                  {"curve": {"type": "ellipse", "centre": [0,0,0], "x": [1,0,0], "y": [0,1,0]},
                   "range": [3.141592653589793,6.283185307179586], "start": 1, "end": 0}],
        "faces": [{"surface": {"type": "surface", "points": [[[-2,-2,0],[-2,2,0]],[[2,-2,0],[2,2,0]]]}, "loops": [[
            {"edge": 0, "curve": {"type": "ellipse", "centre": [0.5,0.5], "x": [0.25,0], "y": [0,0.25]}},
            {"edge": 1, "curve": {"type": "ellipse", "centre": [0.5,0.5], "x": [0.25,0], "y": [0,0.25]}}]]}],
        "shells": [{"faces": [{"face": 0}]}], "bodies": [{"shells": [0]}]}]})"));
    const auto mesh = must(tessellate(read_again(given, true), {.tolerance = 1e-2}));
    EXPECT_LE(mesh.boundary_gap, 1e-14);
}

TEST_F(Step, offsets_come_back_from_iges_on_their_side) {
    for (const double z : {0.5, -0.5}) {
        const auto edge = [&](int i, const char* from, const char* along) {
            return text(R"({"curve": {"type": "line", "origin": [)", from, ",", z, R"(], "direction": [)",
                        along, R"(,0]}, "range": [0, 1], "start": )", i, R"(, "end": )", (i + 1) % 4, "}");
        };
        const auto use = [&](int i, const char* from, const char* along) {
            return text(R"({"edge": )", i, R"(, "curve": {"type": "line", "origin": [)", from,
                        R"(], "direction": [)", along, "]}}");
        };
        const char* corner[] = {"0,0", "1,0", "1,1", "0,1"};
        const char* way[] = {"1,0", "0,1", "-1,0", "0,-1"};
        std::string vertices, edges, loop;
        for (int i = 0; i < 4; ++i) {
            const char* comma = i > 0 ? "," : "";
            vertices += text(comma, R"({"point": [)", corner[i], ",", z, "]}");
            edges += comma + edge(i, corner[i], way[i]);
            loop += comma + use(i, corner[i], way[i]);
        }
        const Document given = must(read_document(text(
            R"({"freiform": 1, "unit": "mm", "objects": [{"type": "model", "vertices": [)", vertices,
            R"(], "edges": [)", edges, R"(], "faces": [{"surface": {"type": "offset", "distance": )", z,
            R"(, "base": {"type": "surface", "points": [[[0,0,0],[0,1,0]],[[1,0,0],[1,1,0]]]}}, "loops": [[)",
            loop, R"(]]}], "shells": [{"faces": [{"face": 0}]}], "bodies": [{"shells": [0]}]}]})")));
        const Model back = read_again(given, true);
        ASSERT_EQ(back.faces.size(), 1u);
        const auto* offset = std::get_if<OffsetSurface>(&back.faces[0].surface);
        ASSERT_NE(offset, nullptr);
        EXPECT_EQ(offset->distance, z);
        EXPECT_LE(must(tessellate(back, {.tolerance = 1e-2})).boundary_gap, 1e-12);
    }
}

// What gmsh measures of a file: the areas of its faces, their number, the volume, and the box.
std::vector<double> measured_by_gmsh(const std::string& bytes, const std::string& ending) {
    const std::string stem = (fs::temp_directory_path() / text("freiform-gmsh-", ::getpid())).string();
    std::ofstream(stem + ending, std::ios::binary) << bytes;
    std::ofstream(stem + ".geo")
        << "SetFactory(\"OpenCASCADE\");\nv() = ShapeFromFile(\"" << stem << ending
        << "\");\ns() = Surface{:};\nw() = Volume{:};\nsum = 0;\n"
           "For i In {0 : #s()-1}\n m() = Mass Surface{s(i)}; sum = sum + m(0);\nEndFor\n"
           "vol = 0;\nFor i In {0 : #w()-1}\n m() = Mass Volume{w(i)}; vol = vol + m(0);\n"
           "EndFor\nb() = BoundingBox Surface{s()};\n"
           "Printf(\"%.12g %.12g %.12g %.12g %.12g %.12g %.12g %.12g %.12g\", sum, #s(), vol, "
           "b(0), b(1), b(2), b(3), b(4), b(5)) > \""
        << stem << ".txt\";\n";
    EXPECT_EQ(std::system(("gmsh " + stem + ".geo -parse_and_exit >" + stem + ".log 2>&1").c_str()), 0);
    std::ifstream in(stem + ".txt");
    std::vector<double> out;
    for (double x; in >> x;) out.push_back(x);
    for (const char* e : {".geo", ".txt", ".log"}) fs::remove(stem + e);
    fs::remove(stem + ending);
    return out;
}

TEST(StepText, is_measured_by_gmsh_as_it_should) {
    if (std::system("command -v gmsh >/dev/null 2>&1") != 0) GTEST_SKIP() << "gmsh is not installed";
    const Model ring = must(solid_of_revolution(ring_region(), {{{0, 0, 0}}, {{0, 1, 0}}}, 2 * kPi));
    const Document of_one{"mm", {{"ring", ring}}};
    for (const bool iges : {false, true}) {
        const auto of_ring =
            measured_by_gmsh(must(iges ? write_iges(of_one) : write_step(of_one)), iges ? ".igs" : ".step");
        ASSERT_EQ(of_ring.size(), 9u);
        EXPECT_EQ(of_ring[1], double(ring.faces.size()));
        EXPECT_NEAR(of_ring[2], 2 * kPi * (5 * kPi * 4 - 5.25 * kPi * 0.5), 1e-2) << iges;
        EXPECT_NEAR(of_ring[7], 7, 1e-2);  // the ring lies between y = 3 and 7
    }
    // Its areas of trimmed faces are those of a quadrature with 0.3 %.
    const Document sheet = trimmed_sheet();
    const double area = area_of(must(scene_of(sheet)), 2e-3);
    for (const bool iges : {false, true}) {
        const auto m =
            measured_by_gmsh(must(iges ? write_iges(sheet) : write_step(sheet)), iges ? ".igs" : ".step");
        ASSERT_EQ(m.size(), 9u);
        EXPECT_NEAR(m[0], area, 5e-3 * area);
        EXPECT_EQ(m[1], 1);
    }
}

// Fillets on splines of high degree, whose edges readers do not find in the parameters again; three of its
// faces close to rings, and a reader that gives them more than one period makes other programs turn them
// inside out.
TEST_F(Step, of_a_part_with_fillets_is_measured_as_the_part) {
    if (std::system("command -v gmsh >/dev/null 2>&1") != 0) GTEST_SKIP() << "gmsh is not installed";
    const std::string name = std::string(FREIFORM_SOURCE_DIR) + "/examples/bracket.step";
    std::stringstream given;
    given << std::ifstream(name).rdbuf();
    const auto part = measured_by_gmsh(given.str(), ".step");
    ASSERT_EQ(part.size(), 9u);
    for (const StepReader reader : {StepReader::own, StepReader::occt})
        for (const bool iges : {false, true}) {
            ReadOptions options;
            options.step_reader = reader;
            const Document read = must(read_any(name, options));
            const auto m =
                measured_by_gmsh(must(iges ? write_iges(read) : write_step(read)), iges ? ".igs" : ".step");
            ASSERT_EQ(m.size(), 9u);
            const double within = iges ? 1e-3 : 1e-5;
            EXPECT_NEAR(m[0], part[0], within * part[0]) << iges << (reader == StepReader::own);
            EXPECT_EQ(m[1], part[1]);
            EXPECT_NEAR(m[2], part[2], within * part[2]) << iges << (reader == StepReader::own);
        }
}

TEST_F(Step, wires_are_read) {
    Model net;
    net.unit = "mm";
    net.vertices = {{{{0, 0, 0}}, 0}, {{{3, 0, 4}}, 0}};
    const CurveGeometry<3> arc = Conic<3>{ConicKind::ellipse, {{1.5, 0, 2}}, {{-1.5, 0, -2}}, {{0, 1, 0}}};
    net.edges = {{Line<3>{{}, {{0.6, 0, 0.8}}}, false, {0, 5}, 0, 1, 0, ""},
                 {arc, false, {0, kPi}, 0, 1, 0, ""}};
    const Model back = read_again({"mm", {{"", net}}});
    EXPECT_TRUE(back.faces.empty());
    ASSERT_EQ(back.edges.size(), 2u);
    EXPECT_EQ(back.vertices.size(), 2u);
}

TEST_F(Step, units_are_written) {
    const Model cube = must(prism(loops_of({{ellipse({{0, 0}}, 1, 1)}}), {{0, 0, 1}}));
    for (const char* unit : {"mm", "cm", "m", "inch"}) {
        const Model back = read_again({unit, {{"", cube}}});
        EXPECT_EQ(back.unit, unit);
        EXPECT_NEAR(summary(back).box.hi[2], summary(cube).box.hi[2], 1e-6) << unit;
    }
}

TEST(IgesText, is_refused_where_it_cannot_say_it) {
    expect_refusal(write_iges({}), RefusalKind::no_answer, "objects");
    const auto line =
        Curve<Vec<4>>::make({must(BSplineBasis::bezier(1))}, Net<1, Vec<4>>({2}, {Vec<4>{}, Vec<4>{}}));
    expect_refusal(write_iges({"", {{"m", must(line)}}}), RefusalKind::unsupported, "objects[0] \"m\"",
                   "is a curve");
    Model bare = torus(3.0, 1.0);
    bare.faces[0].loops.clear();
    expect_refusal(write_iges({"", {{"m", bare}}}), RefusalKind::unsupported,
                   "objects[0] \"m\".faces[0].loops", "without boundary");
}

TEST(StepText, is_refused_where_it_cannot_say_it) {
    expect_refusal(write_step({}), RefusalKind::no_answer, "objects");
    const Document volume = must(read_document(
        R"({"type": "volume", "degrees": [1,1,1], "points": [[[[0,0,0],[0,0,1]],[[0,1,0],[0,1,1]]],[[[1,0,0],[1,0,1]],[[1,1,0],[1,1,1]]]]})"));
    expect_refusal(write_step(volume), RefusalKind::unsupported, "objects[0]", "is a volume");
}

}  // namespace
}  // namespace freiform::test
