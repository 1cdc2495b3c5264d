#include "run.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

namespace freiform::test {
namespace {

using Json = nlohmann::json;
using Cli = Program;

const std::string kSide = R"({"name":"side","type":"curve","points":[[2,0,0],[2,0,3]]})";

TEST_F(Cli, revolve_makes_a_cylinder_of_a_line) {
    const Ran r = run({"revolve", "-", "--axis", "0,0,0,0,0,2", "-o", "c.json"}, kSide);
    ASSERT_EQ(r.code, 0) << r.err;
    EXPECT_NE(r.out.find("1 surface within "), std::string::npos) << r.out;
    const Json surface = Json::parse(content(path("c.json")))["objects"][0];
    EXPECT_EQ(surface["knots"][0].size(), surface["points"].size() + 3);  // open: also for other programs
    EXPECT_EQ(surface["points"].front(), surface["points"].back());
    const Json e = Json::parse(run({"eval", "c.json", "--at", "0,0;0.25,0.5;0.3,1"}).out)["results"];
    EXPECT_EQ(e[0]["point"], Json::parse("[2.0,0.0,0.0]"));
    EXPECT_NEAR(e[1]["point"][1].get<double>(), 2, 1e-15);
    EXPECT_NEAR(std::hypot(e[2]["point"][0].get<double>(), e[2]["point"][1].get<double>()), 2, 1e-15);
    EXPECT_NEAR(e[2]["point"][2].get<double>(), 3, 1e-15);
    ASSERT_EQ(run({"revolve", "-", "--axis", "0,0,0,0,0,2", "--closed", "-o", "c.json"}, kSide).code, 0);
    EXPECT_EQ(Json::parse(content(path("c.json")))["objects"][0]["points"].size(), 8u);
}

TEST_F(Cli, revolve_takes_an_angle_in_degrees_and_a_tolerance) {
    const Ran r = run({"revolve", "-", "--axis", "0,0,0,0,0,1", "--angle", "-90", "--polynomial", "1e-3",
                       "-o", "c.json", "--json"},
                      kSide);
    ASSERT_EQ(r.code, 0) << r.err;
    const Json report = Json::parse(r.out);
    EXPECT_EQ(report["surfaces"], 1);
    EXPECT_EQ(report["pieces"], Json::parse("[1]"));
    EXPECT_LE(report["bound"].get<double>(), 1e-3);
    EXPECT_GT(report["bound"].get<double>(), 5e-4);
    const Json e = Json::parse(run({"eval", "c.json", "--at", "1,0"}).out)["results"];
    EXPECT_NEAR(e[0]["point"][1].get<double>(), -2, 1e-15);
}

// A quarter circle of radius 2 becomes half a ball.
TEST_F(Cli, revolve_makes_polynomial_surfaces_of_rational_curves_too) {
    const std::string arc =
        R"({"type":"curve","points":[[2,0],[2,2],[0,2]],"weights":[1,0.70710678118654757,1]})";
    const Ran r =
        run({"revolve", "-", "--axis", "0,0,0,0,1,0", "--polynomial", "1e-4", "-o", "c.json", "--json"}, arc);
    ASSERT_EQ(r.code, 0) << r.err;
    const double bound = Json::parse(r.out)["bound"].get<double>();
    EXPECT_LE(bound, 1e-4);
    EXPECT_FALSE(Json::parse(content(path("c.json")))["objects"][0].contains("weights"));
    const Json e = Json::parse(run({"eval", "c.json", "--at", "0.1,0.3;0.55,0.5;0.9,0.9"}).out)["results"];
    for (const Json& p : e) {
        const auto x = p["point"].get<std::vector<double>>();
        EXPECT_NEAR(std::hypot(std::hypot(x[0], x[1]), x[2]), 2, bound);
    }
}

TEST_F(Cli, revolve_says_what_is_wrong) {
    EXPECT_EQ(run({"revolve", "-", "--axis", "0,0,0,0,0", "-o", "c.json"}, kSide).code, 2);
    EXPECT_EQ(run({"revolve", "-", "-o", "c.json"}, kSide).code, 2);
    EXPECT_EQ(run({"revolve", "-", "--axis", "0,0,0,0,0,0", "-o", "c.json"}, kSide).code, 2);
    EXPECT_EQ(run({"revolve", "-", "--axis", "2,0,0,0,0,1", "-o", "c.json"}, kSide).code, 1);
    EXPECT_EQ(run({"revolve", "-", "--axis", "0,0,0,0,0,1", "--angle", "400", "-o", "c.json"}, kSide).code,
              2);
    const Ran r = run({"revolve", "-", "--axis", "0,0,0,0,0,1", "-o", "c.json"},
                      R"({"type":"surface","points":[[[0,0,0],[0,1,0]],[[1,0,0],[1,1,0]]]})");
    EXPECT_EQ(r.code, 1);
    EXPECT_NE(r.err.find("is a surface"), std::string::npos) << r.err;
}

}  // namespace
}  // namespace freiform::test
