#include "run.hpp"

#include <cmath>
#include <iterator>
#include <nlohmann/json.hpp>
#include <sstream>

namespace freiform::test {
namespace {

using Json = nlohmann::json;

const std::string kArc =
    R"({"type":"curve","degree":2,"points":[[1,0,0],[1,1,0],[0,1,0]],"weights":[1,0.7071067811865476,1]})";
const std::string kTwoCurves =
    R"({"objects":[{"name":"a","type":"curve","degree":2,"points":[[0,0,0],[1,1,0],[2,0,0]]},
    {"name":"b","type":"curve","degree":1,"points":[[0,0,2],[2,0,3]]}]})";

class Surfaces : public Program {
protected:
    // The point of object 0 of a file.
    std::vector<double> point(const std::string& name, const std::string& at) const {
        const Ran r = run({"eval", name, "--at", at});
        EXPECT_EQ(r.code, 0) << r.err;
        return r.code == 0 ? Json::parse(r.out)["results"][0]["point"].get<std::vector<double>>()
                           : std::vector<double>(3, NAN);
    }
    Json made(std::vector<std::string> arguments, const std::string& input = "") const {
        arguments.insert(arguments.end(), {"-o", "s.json", "--json"});
        const Ran r = run(arguments, input);
        EXPECT_EQ(r.code, 0) << r.err;
        return r.code == 0 ? Json::parse(r.out) : Json();
    }
};

TEST_F(Surfaces, examples_of_the_help_of_quadric_work) {
    std::istringstream help(run({"quadric", "--help"}).out);
    int examples = 0;
    for (std::string line; std::getline(help, line);) {
        if (!line.starts_with("  freiform ")) continue;
        std::istringstream words(line.substr(11));
        const Ran r = run({std::istream_iterator<std::string>(words), {}});
        EXPECT_EQ(r.code, 0) << line << r.err;
        ++examples;
    }
    EXPECT_GE(examples, 4);
}

TEST_F(Surfaces, extrude_and_ruled_join_curves_by_straight_lines) {
    EXPECT_EQ(made({"extrude", "-", "--by", "0,0,4"}, kTwoCurves)["surfaces"], 2);
    EXPECT_EQ(point("s.json", "0.5,0.25"), (std::vector<double>{1, 0.5, 1}));
    EXPECT_EQ(Json::parse(content(path("s.json")))["objects"][1]["name"], "b");
    EXPECT_LE(made({"ruled", "-"}, kTwoCurves)["bound"].get<double>(), 1e-13);
    EXPECT_EQ(point("s.json", "0.5,0.5"), (std::vector<double>{1, 0.25, 1.25}));
    EXPECT_EQ(run({"ruled", "-", "-o", "s.json"}, kArc).code, 1);
    EXPECT_EQ(run({"extrude", "-", "--by", "0,4", "-o", "s.json"}, kTwoCurves).code, 2);
    EXPECT_EQ(run({"extrude", "-", "--by", "0,0,0", "-o", "s.json"}, kTwoCurves).code, 2);
}

TEST_F(Surfaces, sweep_turns_with_the_rail_or_does_not) {
    file("rail.json", R"({"type":"curve","degree":2,"points":[[0,0,0],[4,0,0],[4,4,0]]})");
    const Json report =
        made({"sweep", "-", "--rail", "rail.json", "--tolerance", "1e-4", "--x", "0,0,1"}, kArc);
    EXPECT_LE(report["bound"].get<double>(), 1e-4);
    EXPECT_GE(report["pieces"], 1);
    // In a plane x of the profile stays its normal z: (1, 0) goes there, all along.
    EXPECT_NEAR(point("s.json", "0,1")[2], 1, 1e-4);
    EXPECT_NEAR(point("s.json", "1,1")[2], 0, 1e-4);
    EXPECT_LE(made({"sweep", "-", "--rail", "rail.json", "--translate"}, kArc)["bound"].get<double>(), 1e-14);
    EXPECT_NEAR(point("s.json", "0,1")[0], 5, 1e-14);
    EXPECT_EQ(run({"sweep", "-", "--rail", "rail.json"}, kArc).code, 2);
    EXPECT_EQ(run({"sweep", "-", "--rail", "rail.json", "--tolerance", "-1"}, kArc).code, 2);
    const Ran high = run({"sweep", "-", "--rail", "rail.json", "--tolerance", "1"},
                         R"({"type":"curve","points":[[0,0,0],[0,1,1]]})");
    EXPECT_EQ(high.code, 1);
    EXPECT_NE(high.err.find("the plane z = 0"), std::string::npos) << high.err;
}

TEST_F(Surfaces, loft_contains_its_sections_and_says_how_smooth_it_is) {
    std::string rings = R"({"objects":[)";
    for (int i = 0; i < 5; ++i)
        rings += (i > 0 ? "," : "") +
                 std::string(R"({"type":"curve","degree":2,"weights":[1,0.7071067811865476,1],"points":[[)") +
                 std::to_string(1 + i % 2) + ",0," + std::to_string(i) + "],[" + std::to_string(1 + i % 2) +
                 "," + std::to_string(1 + i % 2) + "," + std::to_string(i) + "],[0," +
                 std::to_string(1 + i % 2) + "," + std::to_string(i) + "]]}";
    rings += "]}";
    const Json report = made({"loft", "-", "--spacing", "uniform"}, rings);
    EXPECT_EQ(report["continuity"], 2);
    const auto p = point("s.json", "0.3,1");
    EXPECT_NEAR(std::hypot(p[0], p[1]), 2, 1e-13);
    EXPECT_EQ(run({"loft", "-", "--spacing", "steep", "-o", "s.json"}, rings).code, 2);
    EXPECT_EQ(run({"loft", "-", "-o", "s.json"}, kArc).code, 3);
}

TEST_F(Surfaces, coons_fills_four_curves_and_networks) {
    const std::string four = R"({"objects":[)" + kArc + R"(,
        {"type":"curve","degree":2,"points":[[1,0,2],[1,1,2],[0,1,3]]},
        {"type":"curve","points":[[1,0,0],[1,0,2]]},{"type":"curve","points":[[0,1,0],[0,1,3]]}]})";
    const Json report = made({"coons", "-"}, four);
    EXPECT_LE(report["bound"].get<double>(), 1e-12);
    EXPECT_LE(report["corner_gap"].get<double>(), 1e-12);
    const auto p = point("s.json", "0.4,0");
    EXPECT_NEAR(std::hypot(p[0], p[1]), 1, 1e-13);
    EXPECT_NEAR(point("s.json", "1,0.5")[2], 1.5, 1e-13);
    EXPECT_LE(made({"coons", "-", "--at-v", "0,1", "--at-u", "0,1", "--tolerance", "1e-9"}, four)["gap"]
                  .get<double>(),
              1e-12);
    EXPECT_NEAR(point("s.json", "1,0.5")[2], 1.5, 1e-13);
    EXPECT_EQ(run({"coons", "-", "-o", "s.json"}, kTwoCurves).code, 1);
    EXPECT_EQ(run({"coons", "-", "--at-u", "0,1", "-o", "s.json"}, four).code, 2);
}

// z = x y over the unit square: the bicubic blend of its own boundaries and derivatives is the surface
// itself.
TEST_F(Surfaces, coons_blends_derivatives_across_the_boundaries_as_well) {
    const auto curves = [](const char* lower_across) {
        return std::string(R"({"objects":[)") +
               R"({"type":"curve","points":[[0,0,0],[1,0,0]]},{"type":"curve","points":[[0,1,0],[1,1,1]]},
                  {"type":"curve","points":[[0,0,0],[0,1,0]]},{"type":"curve","points":[[1,0,0],[1,1,1]]},
                  {"type":"curve","points":)" +
               lower_across + R"(},{"type":"curve","points":[[0,1,0],[0,1,1]]},
                  {"type":"curve","points":[[1,0,0],[1,0,1]]},{"type":"curve","points":[[1,0,0],[1,0,1]]}]})";
    };
    const Json report = made({"coons", "-", "--bicubic"}, curves("[[0,1,0],[0,1,1]]"));
    EXPECT_LE(report["bound"].get<double>(), 1e-13);
    EXPECT_LE(report["tangent_gap"].get<double>(), 1e-12);
    EXPECT_LE(report["twist_gap"].get<double>(), 1e-12);
    const auto p = point("s.json", "0.25,0.75");
    EXPECT_NEAR(p[0], 0.25, 1e-14);
    EXPECT_NEAR(p[1], 0.75, 1e-14);
    EXPECT_NEAR(p[2], 0.1875, 1e-14);
    // The derivative across the lower boundary leaves its end by another slope than the right boundary has.
    const Ran r = run({"coons", "-", "--bicubic", "-o", "t.json"}, curves("[[0,1,0],[0,1,1.5]]"));
    EXPECT_EQ(r.code, 3);
    EXPECT_NE(r.err.find("upper u, lower v: tangents differ by 0.5"), std::string::npos) << r.err;
    const Json within =
        made({"coons", "-", "--bicubic", "--tangent-tolerance", "1", "--twist-tolerance", "1"},
             curves("[[0,1,0],[0,1,1.5]]"));
    EXPECT_NEAR(within["tangent_gap"].get<double>(), 0.5, 1e-12);
    EXPECT_NEAR(within["twist_gap"].get<double>(), 0.5, 1e-12);
    EXPECT_EQ(run({"coons", "-", "-o", "s.json"}, curves("[[0,1,0],[0,1,1]]")).code, 1);
    EXPECT_EQ(run({"coons", "-", "--twist-tolerance", "1", "-o", "s.json"}, curves("[[0,1,0],[0,1,1]]")).code,
              2);
}

TEST_F(Surfaces, quadric_makes_every_kind_on_its_surface) {
    const auto off = [&](std::vector<std::string> arguments, auto&& implicit,
                         const std::string& at = "0.3,0.6") {
        arguments.insert(arguments.begin(), "quadric");
        EXPECT_LE(made(arguments)["bound"].get<double>(), 1e-13) << arguments[1];
        const auto p = point("s.json", at);
        return std::abs(implicit(p[0], p[1], p[2]));
    };
    const auto ball = [](double x, double y, double z) { return std::hypot(x, y, z) - 2; };
    EXPECT_LE(off({"sphere", "--radius", "2"}, ball), 1e-14);
    EXPECT_LE(off({"cylinder", "--radius", "2", "--height", "3"},
                  [](double x, double y, double) { return std::hypot(x, y) - 2; }),
              1e-14);
    EXPECT_LE(off({"cone", "--radius", "2", "--top", "1", "--height", "3", "--origin", "0,0,1"},
                  [](double x, double y, double z) { return std::hypot(x, y) - (2 - (z - 1) / 3); }),
              1e-14);
    EXPECT_LE(
        off({"torus", "--radius", "3", "--tube", "1", "--angle", "180"},
            [](double x, double y, double z) { return std::hypot(std::hypot(x, y) - 3, z) - 1 + (y < 0); }),
        1e-14);
    EXPECT_LE(off({"ellipsoid", "--radii", "3,2,1", "--form", "quintic"},
                  [](double x, double y, double z) { return x * x / 9 + y * y / 4 + z * z - 1; }),
              1e-14);
    EXPECT_EQ(made({"quadric", "sphere-in-six", "--radius", "2"})["surfaces"], 6);
    EXPECT_EQ(made({"quadric", "sphere-in-eight", "--radius", "2"})["surfaces"], 8);
    EXPECT_EQ(Json::parse(content(path("s.json")))["objects"][7]["type"], "triangle");
    EXPECT_EQ(run({"quadric", "cylinder", "--radius", "2", "-o", "s.json"}).code, 2);
    EXPECT_EQ(run({"quadric", "cube", "--radius", "2", "-o", "s.json"}).code, 2);
    EXPECT_EQ(run({"quadric", "sphere", "--radius", "-2", "-o", "s.json"}).code, 2);
}

TEST_F(Surfaces, eval_shows_the_nets_of_the_construction) {
    const Ran r = run({"eval", "-", "--at", "0.5,0.5", "--construction"},
                      R"({"type":"surface","points":[[[0,0,0],[0,4,0]],[[8,0,0],[8,4,8]]]})");
    ASSERT_EQ(r.code, 0) << r.err;
    const Json levels = Json::parse(r.out)["results"][0]["construction"];
    ASSERT_EQ(levels.size(), 4u);
    EXPECT_EQ(levels[1]["level"], Json::parse("[0,1]"));
    EXPECT_EQ(levels[1]["points"], Json::parse("[[0.0,2.0,0.0],[8.0,2.0,4.0]]"));
    EXPECT_EQ(levels[3]["points"], Json::parse("[[4.0,2.0,2.0]]"));
    EXPECT_EQ(Json::parse(run({"eval", "-", "--at", "0.5", "--construction"}, kArc)
                              .out)["results"][0]["construction"][1]["weights"]
                  .size(),
              2u);
}

}  // namespace
}  // namespace freiform::test
