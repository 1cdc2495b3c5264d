#include "run.hpp"

#include <freiform/io/file.hpp>
#include <freiform/io/mesh_file.hpp>

#include <nlohmann/json.hpp>

namespace freiform::test {
namespace {

using Json = nlohmann::json;
using CliCheck = Program;

const std::string kTeapot = std::string(FREIFORM_SOURCE_DIR) + "/examples/teapot.bpt";

TEST_F(CliCheck, a_mesh_of_our_own_is_within_what_was_proven_for_it) {
    const std::string mesh = path("teapot.ply");
    const Ran made = run({"tessellate", kTeapot, "--tolerance", "0.05", "-o", mesh, "--json"});
    ASSERT_EQ(made.code, 0) << made.err;
    const Ran r =
        run({"check", mesh, "--against", kTeapot, "--tolerance", "0.05", "--parts", "30000", "--json"});
    ASSERT_EQ(r.code, 0) << r.err << r.out;
    const Json j = Json::parse(r.out), t = Json::parse(made.out);
    EXPECT_LE(j["model_to_mesh"]["measured"],
              t["error_bound"].get<double>() + t["boundary_gap"].get<double>());
    EXPECT_GT(j["model_to_mesh"]["measured"], 0);
    EXPECT_GE(j["model_to_mesh"]["bound"], j["model_to_mesh"]["measured"]);
    EXPECT_EQ(j["verdict"], "within");
    EXPECT_EQ(j["triangles"], t["triangles"]);
    EXPECT_EQ(j["faces"].size(), 32u);
    EXPECT_EQ(j["refused"], Json::array());
    EXPECT_EQ(j["model_to_mesh"]["at"].size(), 3u);
}

TEST_F(CliCheck, a_mesh_that_was_moved_exceeds_the_tolerance_by_the_move) {
    const std::string mesh = path("teapot.stl"), moved = path("moved.ply");
    ASSERT_EQ(run({"tessellate", kTeapot, "--tolerance", "0.05", "-o", mesh}).code, 0);
    auto m = read_mesh(mesh);
    ASSERT_TRUE(m);
    for (Vec<3>& p : m->points) p[2] += 1;
    ASSERT_TRUE(write_mesh(*m, moved));
    const Ran r =
        run({"check", moved, "--against", kTeapot, "--tolerance", "0.05", "--parts", "3000", "--json"});
    ASSERT_EQ(r.code, 0) << r.err;
    const Json j = Json::parse(r.out);
    EXPECT_EQ(j["verdict"], "exceeds");
    EXPECT_GE(j["mesh_to_model"]["measured"], 0.8);  // the lid, straight above
    EXPECT_LE(j["mesh_to_model"]["measured"], 1.06);
    const Ran plain = run({"check", moved, "--against", kTeapot, "--tolerance", "0.05", "--parts", "3000"});
    EXPECT_TRUE(plain.out.starts_with("exceeds 0.05")) << plain.out;
}

TEST_F(CliCheck, usage_and_files_are_told_apart) {
    EXPECT_EQ(run({"check", kTeapot}).code, 2);
    EXPECT_EQ(run({"check", "--against", kTeapot}).code, 2);
    const std::string mesh = file("t.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
    EXPECT_EQ(run({"check", mesh, "--against", kTeapot, "-o", "x.stl"}).code, 2);
    EXPECT_EQ(run({"check", mesh, "--against", kTeapot, "--tolerance", "0"}).code, 2);
    EXPECT_EQ(run({"check", file("bad.stl", "nonsense"), "--against", kTeapot}).code, 3);
    EXPECT_EQ(run({"check", path("none.stl"), "--against", kTeapot}).code, 5);
    EXPECT_EQ(run({"check", mesh, "--against", path("none.json")}).code, 5);
    EXPECT_EQ(run({"check", file("empty.obj", "v 0 0 0\n"), "--against", kTeapot}).code, 3);
}

}  // namespace
}  // namespace freiform::test
