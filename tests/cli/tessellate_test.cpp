#include "run.hpp"

#include <freiform/io/file.hpp>
#include <freiform/io/mesh_file.hpp>

#include <filesystem>
#include <nlohmann/json.hpp>
#include <support/step_polygons.hpp>

namespace freiform::test {
namespace {

using Json = nlohmann::json;
using CliMesh = Program;

TEST_F(CliMesh, tessellate_writes_a_mesh_and_reports_what_the_contract_names) {
    for (const char* ending : {"glb", "stl", "obj", "ply"}) {
        const std::string out = file(std::string("teapot.") + ending, "old");
        const Ran r = run({"tessellate", kTeapot, "--tolerance", "0.01", "-o", out, "--json"});
        ASSERT_EQ(r.code, 0) << r.err;
        const Json j = Json::parse(r.out);
        EXPECT_GT(j["triangles"], 1000);
        EXPECT_GT(j["vertices"], 500);
        EXPECT_EQ(j["faces"], 32);
        EXPECT_GT(j["error_bound"], 0);
        EXPECT_LE(j["error_bound"], 0.01);
        EXPECT_LE(j["boundary_gap"], 1e-12);
        EXPECT_EQ(j["non_manifold_edges"], 0);
        EXPECT_EQ(j["degenerate_triangles"], 0);
        EXPECT_TRUE(j["seconds"].is_object());
        EXPECT_EQ(j["refused"], Json::array());
        const auto mesh = read_mesh(out);
        ASSERT_TRUE(mesh) << mesh.error().message;
        EXPECT_EQ(Json(mesh->triangles.size()), j["triangles"]);
        EXPECT_EQ(Json(topology(*mesh).open_edges), j["open_edges"]) << ending;
    }
}

TEST_F(CliMesh, tessellate_makes_quads_where_they_are_asked_for) {
    const std::string out = file("quads.obj", "");
    const Ran r = run({"tessellate", kTeapot, "--tolerance", "0.01", "--quads", "-o", out, "--json"});
    ASSERT_EQ(r.code, 0) << r.err;
    const Json j = Json::parse(r.out);
    EXPECT_GT(j["quads"].get<int>() * 2, j["triangles"].get<int>() * 9 / 10);
    EXPECT_LE(j["error_bound"], 0.01);
    const Ran check = run({"check", out, "--against", kTeapot, "--tolerance", "0.03", "--json"});
    EXPECT_EQ(Json::parse(check.out)["open_edges"], j["open_edges"]);
    EXPECT_EQ(Json::parse(check.out)["verdict"], "within");
    const Ran free = run({"tessellate", kTeapot, "--tolerance", "0.01", "--json"});
    EXPECT_FALSE(Json::parse(free.out).contains("quads"));
}

TEST_F(CliMesh, tessellate_writes_to_standard_output_and_takes_a_default_tolerance) {
    const Ran r = run({"tessellate", kTeapot, "--to", "ply", "-o", "-"});
    ASSERT_EQ(r.code, 0) << r.err;
    EXPECT_TRUE(r.out.starts_with("ply\n"));
    EXPECT_NE(r.err.find("tolerance"), std::string::npos) << "the default is said";
}

TEST_F(CliMesh, tessellate_refuses_before_it_takes_memory) {
    const Ran r = run({"tessellate", kTeapot, "--tolerance", "1e-12", "--max-triangles", "100000", "--json"});
    EXPECT_EQ(r.code, 4);
    const Json e = Json::parse(r.out)["error"];
    EXPECT_EQ(e["kind"], "limit");
    EXPECT_NE(e["message"].get<std::string>().find_first_of("0123456789"), std::string::npos);
    const std::string out = file("kept.stl", "old");
    EXPECT_EQ(run({"tessellate", kTeapot, "--tolerance", "1e-12", "--max-triangles", "1000", "-o", out}).code,
              4);
    EXPECT_EQ(std::filesystem::file_size(out), 3u) << "a file that is there stays";
}

TEST_F(CliMesh, wrong_usage_and_missing_places_are_told_apart) {
    EXPECT_EQ(run({"tessellate"}).code, 2);
    EXPECT_EQ(run({"tessellate", kTeapot, "--tolerance", "x"}).code, 2);
    EXPECT_EQ(run({"tessellate", kTeapot, "--tolerance", "0.1", "-o", "a.xyz"}).code, 2);
    EXPECT_EQ(run({"tessellate", kTeapot, "--tolerance", "0.1", "-o", "/nonexistent/a.stl"}).code, 5);
    EXPECT_EQ(run({"tessellate", "-", "--tolerance", "0.1"}, "nonsense").code, 3);
    EXPECT_EQ(
        run({"tessellate", "-", "--tolerance", "0.1"}, R"({"type": "curve", "points": [[0, 0], [1, 1]]})")
            .code,
        1);
    EXPECT_EQ(run({"tessellate", kTeapot, "--tolerance", "-1"}).code, 2);
    EXPECT_EQ(run({"draw", kTeapot}).code, 2);
    EXPECT_EQ(run({"draw", kTeapot, "-o", "x.png", "--view", "sideways"}).code, 2);
}

TEST_F(CliMesh, trimmed_surfaces_of_a_document_become_meshes) {
    const std::string trimmed = R"({"type": "trimmed",
        "surface": {"degrees": [1, 1], "points": [[[0,0,0],[0,1,0]],[[1,0,0],[1,1,0]]]},
        "loops": [[{"degree": 1, "points": [[0.1,0.1],[0.9,0.1],[0.9,0.9],[0.1,0.9],[0.1,0.1]], "knots": [0,0,1,2,3,4,4]}]]})";
    const Ran r = run({"tessellate", "-", "--tolerance", "0.001", "--json"}, trimmed);
    ASSERT_EQ(r.code, 0) << r.out;
    EXPECT_EQ(Json::parse(r.out)["triangles"], 2) << r.out;
}

// Two squares with a slit between them, as a document.
const std::string kSlit = R"({"objects": [
    {"type": "surface", "degrees": [1, 1], "points": [[[0,0,0],[0,1,0]],[[1,0,0],[1,1,0]]]},
    {"type": "surface", "degrees": [1, 1], "points": [[[1.0001,0,0],[1.0001,1,0]],[[2,0,0],[2,1,0]]]}]})";

TEST_F(CliMesh, tessellate_sews_where_asked_and_names_what_stays_open) {
    const auto said = [&](std::vector<std::string> more) {
        std::vector<std::string> all{"tessellate", "-", "--tolerance", "0.1", "--json"};
        all.insert(all.end(), more.begin(), more.end());
        return run(all, kSlit);
    };
    EXPECT_EQ(Json::parse(said({}).out)["open_edges"], 8);
    const Ran r = said({"--sew", "0.001"});
    ASSERT_EQ(r.code, 0) << r.out;
    const Json j = Json::parse(r.out);
    EXPECT_EQ(j["open_edges"], 6);
    EXPECT_EQ(j["sewing"]["joined"], 1);
    EXPECT_GE(j["sewing"]["bound"], 0.0000999);
    EXPECT_NEAR(j["boundary_gap"], 0.0001, 1e-9);
    ASSERT_EQ(j["sewing"]["remaining_gaps"].size(), 6u);
    for (const Json& gap : j["sewing"]["remaining_gaps"]) {
        EXPECT_EQ(gap["kind"], "no_answer");
        EXPECT_GT(gap["gap"], 0.1);
        EXPECT_TRUE(gap["face"].is_number() && gap["edge"].is_number());
    }
    EXPECT_EQ(Json::parse(said({"--sew", "0.00001"}).out)["sewing"]["joined"], 0);
    const Ran none = said({"--sew"});
    EXPECT_EQ(none.code, 3) << "the document gives no tolerance";
    EXPECT_EQ(
        run({"tessellate", "-", "--sew", "0.001"}, kSlit).out.find("remaining gaps  6") == std::string::npos,
        false);
    EXPECT_EQ(said({"--sew", "x"}).code, 2);
}

// Each of two edges at one place may be off by the tolerance of the file.
TEST_F(CliMesh, tessellate_sews_within_twice_the_tolerance_of_the_file_where_edges_stay_open) {
    const auto sewing = [&](double slit) {
        std::string s =
            "#10=SHELL_BASED_SURFACE_MODEL('',(#11));\n#11=OPEN_SHELL('',(#20,#30));\n"
            "#8=SHAPE_REPRESENTATION('',(#10),#1);\n";
        for (const int face : {20, 30}) {
            const double x = face == 20 ? 0 : 1 + slit;
            s += text("#", face, "=FACE_SURFACE('',(#", face + 1, "),#7,.T.);\n#", face + 1,
                      "=FACE_OUTER_BOUND('',#", face + 2, ",.T.);\n#", face + 2, "=POLY_LOOP('',(#", face + 3,
                      ",#", face + 4, ",#", face + 5, ",#", face + 6, "));\n");
            const double at[4][2] = {{x, 0}, {x + 1, 0}, {x + 1, 1}, {x, 1}};
            for (int k = 0; k < 4; ++k)
                s += text("#", face + 3 + k, "=CARTESIAN_POINT('',(", at[k][0], ",", at[k][1], ",0.));\n");
        }
        const std::string path = file("slit.step", test::flat_file(s));
        const Ran r = run({"tessellate", path, "--tolerance", "0.1", "--sew", "--json"});
        EXPECT_EQ(r.code, 0) << r.out;
        return Json::parse(r.out)["sewing"];
    };
    const double stated = sewing(1e-9)["tolerance"];
    EXPECT_EQ(sewing(0.9 * stated)["tolerance"], stated);
    EXPECT_EQ(sewing(0.9 * stated)["joined"], 1);
    EXPECT_EQ(sewing(1.5 * stated)["tolerance"], 2 * stated);
    EXPECT_EQ(sewing(1.5 * stated)["joined"], 1);
    EXPECT_EQ(sewing(2.5 * stated)["tolerance"], stated);
    EXPECT_EQ(sewing(2.5 * stated)["joined"], 0);
}

TEST_F(CliMesh, tessellate_takes_several_tolerances_and_shapes) {
    const auto single = [&](const char* tolerance) {
        return Json::parse(run({"tessellate", kTeapot, "--tolerance", tolerance, "--json"}).out)["triangles"];
    };
    const std::string out = path("pot-%.ply");
    const Ran r = run({"tessellate", kTeapot, "--tolerance", "0.5,0.05", "-o", out, "--json"});
    ASSERT_EQ(r.code, 0) << r.err;
    const Json runs = Json::parse(r.out)["runs"];
    ASSERT_EQ(runs.size(), 2u);
    EXPECT_EQ(runs[0]["triangles"], single("0.5"));
    EXPECT_EQ(runs[1]["triangles"], single("0.05"));
    EXPECT_TRUE(std::filesystem::exists(path("pot-0.5.ply")) &&
                std::filesystem::exists(path("pot-0.05.ply")));
    EXPECT_EQ(runs[1]["output"], path("pot-0.05.ply"));
    EXPECT_EQ(run({"tessellate", kTeapot, "--tolerance", "0.5,0.05", "-o", path("pot.ply")}).code, 2);

    const Json plain = Json::parse(run({"tessellate", kTeapot, "--tolerance", "0.5", "--json"}).out);
    EXPECT_FALSE(plain.contains("angle_bound"));
    EXPECT_LE(plain["smallest_angles"]["least"], plain["smallest_angles"]["0.5"]);
    const Json turned =
        Json::parse(run({"tessellate", kTeapot, "--tolerance", "0.5", "--angle", "30", "--json"}).out);
    EXPECT_NEAR(turned["angle"].get<double>(), 30, 1e-12);
    EXPECT_GT(turned["triangles"], plain["triangles"]);
    EXPECT_TRUE(turned["angle_exceeded"].is_number() && turned["angle_bound"].is_number());
    const Json round =
        Json::parse(run({"tessellate", kTeapot, "--tolerance", "0.5", "--aspect", "1.5", "--json"}).out);
    EXPECT_GT(round["smallest_angles"]["0.5"], plain["smallest_angles"]["0.5"]);
    EXPECT_EQ(run({"tessellate", kTeapot, "--tolerance", "0.5", "--angle", "-1"}).code, 2);
}

TEST_F(CliMesh, draw_writes_a_picture) {
    const std::string out = file("teapot.png", "");
    const Ran r = run({"draw", kTeapot, "-o", out, "--width", "200", "--height", "150"});
    if (r.code == 3 && r.err.find("install") != std::string::npos) GTEST_SKIP() << r.err;
    ASSERT_EQ(r.code, 0) << r.err;
    const auto png = read_file(out, 1 << 20);
    ASSERT_TRUE(png);
    EXPECT_TRUE(png->starts_with("\x89PNG"));
}

}  // namespace
}  // namespace freiform::test
