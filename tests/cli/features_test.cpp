#include "run.hpp"

#include <cmath>
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
    EXPECT_GT(t["bound"].get<double>(), 0) << "the loops are only sampled";
    EXPECT_LT(t["bound"].get<double>(), 0.1);
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

TEST_F(Features, of_a_cusp_with_bounds_below_the_accuracy) {
    // At t = 1/2 the derivative 3 ((1, 1) / 4 - (1, 0) / 2 + (1, -1) / 4) vanishes.
    const std::string cusp = R"({"type": "curve", "points": [[0,0],[1,1],[0,1],[1,0]]})";
    for (const std::string accuracy : {"", "0.001"}) {
        std::vector<std::string> words{"features", "-", "--json"};
        if (!accuracy.empty()) words.insert(words.end(), {"--accuracy", accuracy});
        const Ran r = run(words, cusp);
        ASSERT_EQ(r.code, 0) << r.err;
        const Json o = Json::parse(r.out)["objects"][0];
        const double wanted = accuracy.empty() ? 1e-9 * std::sqrt(2.0) : 1e-3;
        EXPECT_NEAR(o["accuracy"].get<double>(), wanted, 1e-3 * wanted);
        ASSERT_EQ(o["cusps"].size(), 1u);
        const Json& c = o["cusps"][0];
        EXPECT_LE(c["at"][0].get<double>(), 0.5);
        EXPECT_GE(c["at"][1].get<double>(), 0.5);
        EXPECT_GE(c["bound"].get<double>(), 0);
        EXPECT_LE(c["bound"].get<double>(), wanted * (1 + 1e-9));
        EXPECT_LE(std::hypot(c["point"][0].get<double>() - 0.5, c["point"][1].get<double>() - 0.75),
                  c["bound"].get<double>());
    }
}

TEST_F(Features, a_question_that_is_too_hard_leaves_the_others_their_answers) {
    std::string points = "[0,0]", weights = "1";
    for (int i = 1; i <= 25; ++i)
        points += ",[" + std::to_string(i) + "," + std::to_string(i * i % 7) + "]",
            weights += i % 3 ? ",1" : ",2";
    const Ran r = run({"features", "-", "--json"},
                      R"({"type": "curve", "points": [)" + points + R"(], "weights": [)" + weights + "]}");
    ASSERT_EQ(r.code, 0) << r.err;
    const Json o = Json::parse(r.out)["objects"][0];
    EXPECT_TRUE(o["vertices"].is_null());
    EXPECT_TRUE(o["inflections"].is_array());
}

TEST_F(Bounds, of_triangles_are_tight_and_those_of_several_objects_hold_all) {
    // z = 2 t1 t2, at most 1/2; its control point is at z = 1.
    const std::string triangle = R"({"type": "triangle", "degree": 2,
        "points": [[2,0,0],[1,1,1],[1,0,0],[0,2,0],[0,1,0],[0,0,0]]})";
    const Json one = Json::parse(run({"bounds", "-", "--json"}, triangle).out)["objects"][0];
    EXPECT_NEAR(one["box"]["max"][2].get<double>(), 0.5, 1e-5);
    const auto all = [&](const std::string& objects) {
        return Json::parse(
            run({"bounds", "-", "--json"}, R"({"freiform": 1, "objects": [)" + objects + "]}").out);
    };
    const std::string low = R"({"type": "curve", "points": [[0,0],[1,2],[2,0]]})",
                      far = R"({"type": "curve", "points": [[5,-3],[6,-3],[7,8]]})",
                      deep = R"({"type": "curve", "points": [[0,0,0],[1,2,3]]})";
    const Json two = all(low + "," + far);
    EXPECT_EQ(two["box"]["min"], Json::parse("[0.0,-3.0]"));
    EXPECT_EQ(two["box"]["max"], Json::parse("[7.0,8.0]"));
    EXPECT_EQ(two["bound"], std::max(two["objects"][0]["bound"], two["objects"][1]["bound"]));
    EXPECT_GT(two["bound"].get<double>(), 0);
    EXPECT_TRUE(all(low + "," + deep)["box"].is_null()) << "no box of two and three coordinates";
}

}  // namespace
}  // namespace freiform::test
