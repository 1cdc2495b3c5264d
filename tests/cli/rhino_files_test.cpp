// Files of Rhino and of BezierView, by the program.
#include "run.hpp"

#include <nlohmann/json.hpp>

namespace freiform::test {
namespace {

using Json = nlohmann::json;
using CliRhino = Program;

std::string data_file(const std::string& name) {
    return std::string(FREIFORM_SOURCE_DIR) + "/tests/data/3dm/" + name + ".3dm";
}

TEST_F(CliRhino, solids_become_a_closed_mesh_and_other_files) {
    const std::string solids = data_file("solids_8");
    const Ran mesh = run({"tessellate", solids, "--tolerance", "0.1", "-o", path("x.glb"), "--json"});
    ASSERT_EQ(mesh.code, 0) << mesh.err;
    const Json report = Json::parse(mesh.out);
    EXPECT_EQ(report["faces"], 30);
    EXPECT_EQ(report["open_edges"], 0);
    EXPECT_EQ(report["unit"], "cm");
    EXPECT_LE(report["error_bound"].get<double>(), 0.1);
    ASSERT_EQ(run({"convert", solids, "-o", path("x.step")}).code, 0);
    const Ran back = run({"info", path("x.step"), "--json"});
    ASSERT_EQ(back.code, 0) << back.err;
    EXPECT_EQ(Json::parse(back.out)["objects"][0]["solids"], 7);
    const Ran stdin_too = run({"info", "-", "--json"}, content(solids));
    ASSERT_EQ(stdin_too.code, 0) << stdin_too.err;
    EXPECT_EQ(Json::parse(stdin_too.out)["objects"][0]["faces"], 30);
}

TEST_F(CliRhino, what_is_left_out_is_told) {
    const Ran r =
        run({"tessellate", data_file("sheets_8"), "--tolerance", "0.1", "-o", path("x.stl"), "--json"});
    EXPECT_EQ(r.code, 0) << r.err;  // no face is missing
    const Json refused = Json::parse(r.out)["refused"];
    ASSERT_EQ(refused.size(), 2u);
    EXPECT_EQ(refused[1]["message"], "point: 1 object is left out");
    EXPECT_TRUE(std::filesystem::exists(path("x.stl")));
    const Ran other = run({"convert", data_file("sheets_8"), "-o", path("x.step"), "--json"});
    EXPECT_EQ(other.code, 0) << other.err;
    EXPECT_EQ(Json::parse(other.out)["refused"][1]["message"], refused[1]["message"]) << other.out;
    EXPECT_NE(other.err.find("file is left out: point: 1 object is left out"), std::string::npos)
        << other.err;
    const Ran damaged = run({"info", file("x.3dm", content(data_file("solids_8")).substr(0, 9000))});
    EXPECT_EQ(damaged.code, 3);
    EXPECT_NE(damaged.err.find("x.3dm: byte "), std::string::npos) << damaged.err;
}

TEST_F(CliRhino, patches_of_BezierView_are_surfaces) {
    const Ran r =
        run({"info", file("x.bv", "group 1 lid\n4 1\n0 0 0 0 1 0 1 0 0 1 1 0\n3 1 0 0 0 1 0 0 0 1 0\n"),
             "--json"});
    ASSERT_EQ(r.code, 0) << r.err;
    const Json objects = Json::parse(r.out)["objects"];
    ASSERT_EQ(objects.size(), 2u);
    EXPECT_EQ(objects[0]["type"], "surface");
    EXPECT_EQ(objects[1]["type"], "triangle");
    EXPECT_EQ(objects[0]["name"], "lid");
}

}  // namespace
}  // namespace freiform::test
