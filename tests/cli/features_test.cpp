#include "run.hpp"

#include <nlohmann/json.hpp>

namespace freiform::test {
namespace {

using Json = nlohmann::json;
using Bounds = Program;
using Features = Program;

const std::string kLoop = R"({"type": "curve", "points": [[0,0],[8,3],[-5,3],[3,0]]})";

TEST_F(Bounds, are_tight_for_curves_and_surfaces) {
    const Ran r = run({"bounds", "-", "--json"}, R"({"type": "curve", "points": [[0,0],[1,2],[2,0]]})");
    ASSERT_EQ(r.code, 0) << r.err;
    const Json all = Json::parse(r.out), o = all["objects"][0];
    EXPECT_EQ(o["box"]["min"], Json::parse("[0.0,0.0]"));
    EXPECT_NEAR(o["box"]["max"][1].get<double>(), 1, 1e-11);
    EXPECT_GE(o["box"]["max"][1].get<double>(), 1);
    EXPECT_LT(o["bound"].get<double>(), 1e-11);
    EXPECT_EQ(all["box"], o["box"]);

    const Ran teapot =
        run({"bounds", std::string(FREIFORM_SOURCE_DIR) + "/examples/teapot.bpt", "--accuracy", "1e-5"});
    EXPECT_EQ(teapot.code, 0);
    EXPECT_NE(teapot.out.find("all: [-3, 3.43407"), std::string::npos) << teapot.out;
    const Ran trimmed = run({"bounds", "-", "--json"}, R"({"type": "trimmed",
        "surface": {"type": "surface", "degrees": [1,1], "points": [[[0,0,0],[0,4,0]],[[4,0,0],[4,4,0]]]},
        "loops": [[{"degree": 1, "points": [[0.25,0.25],[0.5,0.25],[0.5,0.75],[0.25,0.25]],
                    "knots": [0,0,1,2,3,3]}]]})");
    ASSERT_EQ(trimmed.code, 0) << trimmed.err;
    const Json t = Json::parse(trimmed.out)["objects"][0];
    EXPECT_NEAR(t["box"]["min"][0].get<double>(), 1, 1e-6);
    EXPECT_NEAR(t["box"]["max"][1].get<double>(), 3, 1e-6);
}

TEST_F(Features, of_a_loop_are_all_there) {
    const Ran r = run({"features", "-", "--json"}, kLoop);
    ASSERT_EQ(r.code, 0) << r.err;
    const Json o = Json::parse(r.out)["objects"][0];
    EXPECT_EQ(o["self_intersections"].size(), 1u);
    EXPECT_EQ(o["self_intersections"][0]["kind"], "crossing");
    EXPECT_NEAR(o["self_intersections"][0]["point"][0].get<double>(), 1.5, 1e-7);
    EXPECT_EQ(o["cusps"].size(), 0u);
    EXPECT_EQ(o["inflections"].size(), 0u);
    EXPECT_EQ(o["extrema_x"].size(), 2u);
    EXPECT_EQ(o["extrema_y"][0]["kind"], "maximum");
    EXPECT_GE(o["vertices"].size(), 1u);
    const Ran people = run({"features", "-"}, kLoop);
    EXPECT_NE(people.out.find("inflections: none"), std::string::npos) << people.out;
    EXPECT_NE(people.out.find("extrema_y: maximum at 0.5"), std::string::npos) << people.out;
}

TEST_F(Features, crossings_with_lines_and_planes) {
    const Ran r = run({"features", "-", "--line", "0,1,-2.25", "--json"}, kLoop);
    ASSERT_EQ(r.code, 0) << r.err;
    const Json c = Json::parse(r.out)["objects"][0]["crossings"];  // y = 9 t (1 - t) touches 2.25
    ASSERT_EQ(c.size(), 1u);
    EXPECT_EQ(c[0]["kind"], "tangent");
    EXPECT_EQ(c[0]["multiplicity"], 2);
    const Ran plane = run({"features", "-", "--plane", "0,0,1,-0.5", "--json"},
                          R"({"type": "curve", "points": [[0,0,0],[1,2,1]]})");
    EXPECT_NEAR(Json::parse(plane.out)["objects"][0]["crossings"][0]["at"][0].get<double>(), 0.5, 1e-8);
}

TEST_F(Features, refuse_what_they_cannot_answer) {
    EXPECT_EQ(run({"features", "-", "--line", "1,2"}, kLoop).code, 2);
    EXPECT_EQ(run({"features", "-", "--plane", "1,2,3,4"}, kLoop).code, 1);
    EXPECT_EQ(run({"features", "-", "--accuracy", "0"}, kLoop).code, 2);
    EXPECT_EQ(run({"features", std::string(FREIFORM_SOURCE_DIR) + "/examples/teapot.bpt"}).code, 1);
    EXPECT_EQ(run({"bounds", "-", "--accuracy", "-1"}, kLoop).code, 2);
}

}  // namespace
}  // namespace freiform::test
