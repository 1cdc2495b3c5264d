#include "run.hpp"

#include <nlohmann/json.hpp>

namespace freiform::test {
namespace {

using Json = nlohmann::json;
using Basis = Program;

const std::string kCubic = R"({"type": "curve", "degree": 3, "points": [[0,0],[1,2],[3,2],[4,0]]})";

TEST_F(Basis, a_cubic_in_powers_hermite_and_lagrange_form) {
    const std::string file = this->file("c.json", kCubic);
    const auto ask = [&](std::vector<std::string> more) {
        more.insert(more.begin(), {"basis", file, "--json", "--to-basis"});
        const Ran r = run(more);
        EXPECT_EQ(r.code, 0) << r.err;
        return Json::parse(r.out).at("results").at(0);
    };
    const Json monomial = ask({"monomial"});
    EXPECT_EQ(monomial["coefficients"], Json::parse("[[-2,0],[3,-6],[3,6],[0,0]]"));
    EXPECT_EQ(monomial["bound"], 0.0);
    EXPECT_EQ(monomial["origin"], 0.0);
    EXPECT_GT(double(monomial["condition"]), 1);
    EXPECT_EQ(ask({"hermite"})["coefficients"], Json::parse("[[0,0],[4,0],[3,6],[3,-6]]"));
    const Json lagrange = ask({"lagrange", "--nodes", "0,0.5,1,2"});
    EXPECT_EQ(lagrange["coefficients"], Json::parse("[[0,0],[2,1.5],[4,0],[2,-12]]"));
    EXPECT_EQ(lagrange["nodes"], Json::parse("[0,0.5,1,2]"));
    EXPECT_EQ(ask({"bernstein"})["coefficients"], Json::parse("[[0,0],[1,2],[3,2],[4,0]]"));
    EXPECT_EQ(ask({"newton", "--nodes", "0,1,0,1"})["coefficients"],
              Json::parse("[[0,0],[4,0],[1,-6],[-2,0]]"));
}

TEST_F(Basis, pieces_of_a_rational_spline_come_one_by_one_in_homogeneous_coordinates) {
    const Ran r = run({"basis", "-", "--json", "--to-basis", "monomial"},
                      R"({"type": "curve", "degree": 2, "knots": [0,0,0,1,2,2,2], "points": [[0],[1],[1],[0]],
                          "weights": [1,2,2,1]})");
    ASSERT_EQ(r.code, 0) << r.err;
    const Json all = Json::parse(r.out)["results"];
    ASSERT_EQ(all.size(), 2u);
    EXPECT_EQ(all[1]["interval"], Json::parse("[1,2]"));
    EXPECT_EQ(all[1]["origin"], 1.0);
    EXPECT_EQ(all[1]["homogeneous"], true);
    EXPECT_EQ(all[1]["coefficients"][2], Json::parse("[2,2]"));
}

TEST_F(Basis, of_high_degree_says_that_powers_are_ill_conditioned) {
    std::string points = "[0]";
    for (int i = 1; i <= 25; ++i) points += ",[" + std::to_string(i % 3) + "]";
    const Ran r =
        run({"basis", "-", "--to-basis", "hermite"}, R"({"type": "curve", "points": [)" + points + "]}");
    ASSERT_EQ(r.code, 0) << r.err;
    EXPECT_NE(r.out.find("may change all digits"), std::string::npos) << r.out;
}

TEST_F(Basis, questions_without_an_answer_and_wrong_usage_have_their_exit_codes) {
    const std::string file = this->file("c.json", kCubic);
    EXPECT_EQ(run({"basis", file}).code, 2);
    EXPECT_EQ(run({"basis", file, "--to-basis", "chebyshev"}).code, 2);
    EXPECT_EQ(run({"basis", file, "--to-basis", "hermite", "--origin", "1"}).code, 2);
    EXPECT_EQ(run({"basis", file, "--to-basis", "monomial", "--nodes", "1,2"}).code, 2);
    const Ran few = run({"basis", file, "--to-basis", "newton", "--nodes", "0,1"});
    EXPECT_EQ(few.code, 1);
    EXPECT_NE(few.err.find("4 are expected"), std::string::npos) << few.err;
    EXPECT_EQ(run({"basis", file, "--to-basis", "lagrange", "--nodes", "0,1,2,1"}).code, 1);
    const Ran even =
        run({"basis", "-", "--to-basis", "hermite"}, R"({"type":"curve","points":[[0],[1],[0]]})");
    EXPECT_EQ(even.code, 1);
    EXPECT_NE(even.err.find("odd"), std::string::npos) << even.err;
    EXPECT_EQ(
        run({"basis", "-", "--to-basis", "monomial"}, R"({"type":"surface","points":[[[0],[1]],[[0],[1]]]})")
            .code,
        1);
}

}  // namespace
}  // namespace freiform::test
