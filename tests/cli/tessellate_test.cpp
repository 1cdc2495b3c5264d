#include "run.hpp"

#include <freiform/io/file.hpp>
#include <freiform/io/mesh_file.hpp>

#include <filesystem>
#include <nlohmann/json.hpp>

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
    EXPECT_EQ(run({"tessellate", kTeapot, "--tolerance", "-1"}).code, 3);
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
