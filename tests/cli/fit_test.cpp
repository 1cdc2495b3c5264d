#include "run.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

namespace freiform::test {
namespace {

using Json = nlohmann::json;
using Fit = Program;

std::string arc(int count, double turns) {
    std::string s = "x;y\n";
    for (int i = 0; i < count; ++i) {
        const double a = 2 * M_PI * turns * i / (count - 1);
        s += std::to_string(10 * std::cos(a)) + ";" + std::to_string(10 * std::sin(a)) + "\n";
    }
    return s;
}

TEST_F(Fit, says_the_distance_reached_and_writes_a_small_curve) {
    const Ran r = run({"fit", "-", "--tolerance", "0.01", "-o", path("c.json"), "--json"}, arc(200, 0.5));
    ASSERT_EQ(r.code, 0) << r.err;
    const Json j = Json::parse(r.out);
    EXPECT_LE(j["bound"].get<double>(), 0.01);
    EXPECT_LE(j["coefficients"].get<int>(), 7);
    EXPECT_EQ(j["parameters"].size(), 200u);
    EXPECT_GT(j["polyline_bound"].get<double>(), 0);
    const Json c = Json::parse(content(path("c.json")))["objects"][0];
    EXPECT_EQ(c["degree"], 3);
    EXPECT_EQ(c["points"].size(), j["coefficients"].get<std::size_t>());
}

TEST_F(Fit, closes_and_keeps_ends_and_tangents) {
    const Json closed = Json::parse(
        run({"fit", "-", "--tolerance", "0.05", "--closed", "--degree", "4"}, arc(101, 1)).out)["objects"][0];
    EXPECT_EQ(closed["closed"], true);
    EXPECT_EQ(closed["degree"], 4);
    const Json kept = Json::parse(
        run({"fit", "-", "--tolerance", "0.05", "--keep-ends", "--tangents", "0,1;0,-1"}, arc(101, 0.5))
            .out)["objects"][0];
    EXPECT_EQ(kept["points"][0], Json::parse("[10,0]"));
    EXPECT_EQ(kept["points"].back(), Json::parse("[-10,0]"));
    EXPECT_NEAR(kept["points"][1][0].get<double>(), 10, 1e-12);
    EXPECT_GT(kept["points"][1][1].get<double>(), 0) << "the tangent at the start is (0, 1)";
    const Json& last = kept["points"][kept["points"].size() - 2];
    EXPECT_NEAR(last[0].get<double>(), -10, 1e-12);
    EXPECT_GT(last[1].get<double>(), 0) << "the tangent at the end is (0, -1)";
}

TEST_F(Fit, refuses_clearly) {
    const auto expect = [&](const std::vector<std::string>& more, const std::string& input, int code,
                            const std::string& message) {
        std::vector<std::string> all{"fit", "-"};
        all.insert(all.end(), more.begin(), more.end());
        const Ran r = run(all, input);
        EXPECT_EQ(r.code, code) << r.err;
        EXPECT_NE(r.err.find(message), std::string::npos) << r.err;
        EXPECT_EQ(r.out, "");
    };
    expect({}, arc(10, 0.5), 2, "--tolerance");
    expect({"--tolerance", "0"}, arc(10, 0.5), 2, "positive");
    expect({"--tolerance", "-1"}, arc(10, 0.5), 2, "positive");
    expect({"--tolerance", "1"}, "1,1\n", 3, "1 point; a curve needs 2");
    expect({"--tolerance", "1"}, "1,1\n1,1\n1,1\n", 3, "all 3 points are equal");
    expect({"--tolerance", "1"}, "0,0\n1,inf\n", 3, "standard input: line 2");
    expect({"--tolerance", "1e-40"}, arc(10, 0.5), 1, "the closest curve found");
    expect({"--tolerance", "1"}, "[[[0,0],[1,0]],[[0,1],[1,1]]]", 3, "grid of points");
}

TEST_F(Fit, parameters_smoothing_and_bounds_are_those_asked_for) {
    // Far from even steps on a line: kept parameters stay whole numbers all the same.
    const std::string line = "0,0\n1,0\n10,0\n11,0\n50,0\n51,0\n52,0\n90,0\n";
    const auto report = [&](std::vector<std::string> more, const std::string& points) {
        more.insert(more.begin(), {"fit", "-", "--json", "-o", path("c.json"), "--tolerance"});
        const Ran r = run(more, points);
        EXPECT_EQ(r.code, 0) << r.err;
        return Json::parse(r.out, nullptr, false);
    };
    const Json kept = report({"0.5", "--parameters", "uniform", "--keep-parameters"}, line);
    EXPECT_EQ(kept["parameters"], Json::parse("[0,1,2,3,4,5,6,7]"));
    const Json moved = report({"0.5", "--parameters", "uniform"}, line);
    EXPECT_NE(moved["parameters"], kept["parameters"]);
    EXPECT_LE(moved["coefficients"].get<int>(), kept["coefficients"].get<int>());

    // Much smoothing leaves a line; without it the cubic follows the zigzag.
    const std::string zigzag = "0,0\n1,2\n2,1\n3,4\n4,3\n5,5\n6,9\n";
    const auto bend = [&](const std::vector<std::string>& more) {
        (void)report(more, zigzag);
        const Json p = Json::parse(content(path("c.json")))["objects"][0]["points"];
        double most = 0;
        for (std::size_t i = 1; i + 1 < p.size(); ++i)
            most = std::max(most, std::abs(p[i + 1][1].get<double>() - 2 * p[i][1].get<double>() +
                                           p[i - 1][1].get<double>()));
        return most;
    };
    EXPECT_GT(bend({"5"}), 0.1);
    EXPECT_LT(bend({"5", "--smoothing", "1e9"}), 1e-3);

    // The polygon of the points on a circle is away from the curve by its sagitta at least.
    const Json round = report({"0.01"}, arc(21, 0.5));
    EXPECT_GT(round["polyline_bound"].get<double>(), 10 * (1 - std::cos(M_PI / 40)) - 0.02);
}

}  // namespace
}  // namespace freiform::test
