// Files of triangles, and .obj files, which may hold either.
#include "run.hpp"

#include <nlohmann/json.hpp>

namespace freiform::test {
namespace {

using MeshOrNot = Program;

TEST_F(MeshOrNot, info_says_of_meshes_whether_they_are_closed) {
    ASSERT_EQ(run({"quadric", "sphere", "--radius", "2", "-o", "s.json"}).code, 0);
    for (const char* name : {"s.stl", "s.ply", "s.glb", "s.obj"}) {
        ASSERT_EQ(run({"tessellate", "s.json", "--tolerance", "0.1", "-o", name}).code, 0);
        const Ran r = run({"info", name, "--json"});
        ASSERT_EQ(r.code, 0) << r.err;
        const auto j = nlohmann::json::parse(r.out);
        EXPECT_EQ(j["type"], "mesh");
        EXPECT_GT(j["triangles"].get<int>(), 100);
        EXPECT_EQ(j["non_manifold_edges"], 0);
        EXPECT_NEAR(j["box"]["max"][2].get<double>(), 2, 1e-6) << name;
        const Ran other = run({"bounds", name});
        EXPECT_NE(other.code, 0);
        EXPECT_NE(other.err.find(std::string(name) == "s.obj" ? "no curves" : "not triangles"),
                  std::string::npos)
            << other.err;
    }
    EXPECT_EQ(run({"info", file("noise.obj", "\1\2\3 4\n")}).code, 3);
}

TEST_F(MeshOrNot, curves_in_obj_files_are_drawn_as_curves) {
    ASSERT_EQ(run({"convert", kExample, "-o", "c.obj"}).code, 0);
    const Ran r = run({"draw", "c.obj", "-o", "c.svg"});
    EXPECT_EQ(r.code, 0) << r.err;
    EXPECT_NE(content(path("c.svg")).find("<path"), std::string::npos);
}

}  // namespace
}  // namespace freiform::test
