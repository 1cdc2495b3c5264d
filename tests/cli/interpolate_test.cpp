#include "run.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

namespace freiform::test {
namespace {

using Json = nlohmann::json;

class Interpolate : public Program {
protected:
    Json curve(const std::vector<std::string>& arguments, const std::string& input) const {
        std::vector<std::string> all{"interpolate", "-"};
        all.insert(all.end(), arguments.begin(), arguments.end());
        const Ran r = run(all, input);
        EXPECT_EQ(r.code, 0) << r.err;
        return Json::parse(r.out, nullptr, false)["objects"][0];
    }
};

const std::string kPoints = "x,y\n0,0\n1,2\n3,3\n4,1\n";

// R10 by hand, for the four points above.
TEST_F(Interpolate, catmull_rom_gives_the_bezier_points_of_the_text) {
    const Json c = curve({"--ends", "catmull-rom"}, kPoints);
    EXPECT_EQ(c["degree"], 3);
    const double p[][2] = {
        {0, 0}, {0.25, 0.75},       {0.5, 1.5},           {1, 2}, {1.5, 2.5}, {2.5, 3 + 1.0 / 6},
        {3, 3}, {3.5, 2 + 5.0 / 6}, {3.75, 2 - 1.0 / 12}, {4, 1}};
    ASSERT_EQ(c["points"].size(), 10u);
    for (std::size_t i = 0; i < 10; ++i)
        for (std::size_t k = 0; k < 2; ++k) EXPECT_NEAR(c["points"][i][k].get<double>(), p[i][k], 1e-15) << i;
}

TEST_F(Interpolate, ends_degree_and_parameters_are_chosen_by_options) {
    EXPECT_EQ(curve({}, kPoints)["points"].size(), 6u);
    EXPECT_EQ(curve({"--ends", "not-a-knot"}, kPoints)["knots"].size(), 8u);
    EXPECT_EQ(curve({"--ends", "natural", "--degree", "5", "--parameters", "uniform"}, kPoints)["knots"],
              Json::parse("[0,0,0,0,0,0,1,2,3,3,3,3,3,3]"));
    EXPECT_EQ(curve({"--ends", "periodic", "--at", "0,1,2,3,5"}, kPoints)["knots"],
              Json::parse("[0,1,2,3,5]"));
    EXPECT_EQ(curve({"--ends", "periodic"}, kPoints)["closed"], true);
    EXPECT_EQ(curve({"--ends", "akima", "--closed"}, kPoints)["closed"], true);
    const Json clamped =
        curve({"--ends", "clamped", "--tangents", "0,3;3,0", "--parameters", "uniform"}, kPoints);
    EXPECT_EQ(clamped["points"][1], Json::parse("[0,1]"));
    EXPECT_EQ(clamped["points"][4], Json::parse("[3,1]"));
    const Json resting = curve({"--ends", "clamped", "--degree", "5"}, kPoints);  // without --tangents: zero
    const std::size_t n = resting["points"].size();
    for (const std::size_t i : {std::size_t(1), std::size_t(2)})
        EXPECT_EQ(resting["points"][i], Json::parse("[0,0]"));
    for (const std::size_t i : {n - 3, n - 2}) EXPECT_NEAR(resting["points"][i][0].get<double>(), 4, 1e-13);
}

TEST_F(Interpolate, reports_a_bound_and_writes_the_file) {
    const Ran r = run({"interpolate", "-", "-o", path("c.json"), "--json"}, kPoints);
    ASSERT_EQ(r.code, 0) << r.err;
    const Json j = Json::parse(r.out);
    EXPECT_EQ(j["points"], 4);
    EXPECT_EQ(j["coefficients"], Json::parse("[6]"));
    EXPECT_GT(j["bound"].get<double>(), 0);
    EXPECT_LT(j["bound"].get<double>(), 1e-13);
    const double length = j["parameters"][3];
    const Ran e = run({"eval", path("c.json"), "--at", "0;" + std::to_string(length).substr(0, 4)});
    EXPECT_EQ(Json::parse(e.out)["results"][0]["point"], Json::parse("[0,0]"));
    EXPECT_NE(run({"interpolate", "-", "-o", path("d.json")}, kPoints)
                  .out.find("no point is farther from the curve"),
              std::string::npos);
}

TEST_F(Interpolate, grids_become_surfaces) {
    std::string grid = "[";
    for (int i = 0; i < 5; ++i) {
        grid += i ? ",[" : "[";
        for (int j = 0; j < 4; ++j)
            grid += (j ? ",[" : "[") + std::to_string(i) + "," + std::to_string(j) + "," +
                    std::to_string(i * j % 3) + "]";
        grid += "]";
    }
    grid += "]";
    const Json s = curve({"--parameters", "uniform"}, grid);
    EXPECT_EQ(s["type"], "surface");
    EXPECT_EQ(s["points"].size(), 7u);
    EXPECT_EQ(s["points"][0].size(), 6u);
    EXPECT_EQ(curve({"--ends", "periodic,natural"}, grid)["closed"], Json::parse("[true,false]"));
    EXPECT_EQ(curve({"--ends", "catmull-rom"}, grid)["points"].size(), 13u);
}

TEST_F(Interpolate, a_closing_point_that_repeats_the_first_is_not_counted_twice) {
    const Ran r = run({"interpolate", "-", "--ends", "periodic"}, kPoints + "0,0\n");
    ASSERT_EQ(r.code, 0) << r.err;
    EXPECT_EQ(Json::parse(r.out)["objects"][0]["points"].size(), 4u);
    EXPECT_NE(r.err.find("repeats the first"), std::string::npos);
}

TEST_F(Interpolate, refuses_with_the_line) {
    const auto expect = [&](const std::vector<std::string>& more, const std::string& input, int code,
                            const std::string& message) {
        std::vector<std::string> all{"interpolate", "-"};
        all.insert(all.end(), more.begin(), more.end());
        const Ran r = run(all, input);
        EXPECT_EQ(r.code, code) << r.err;
        EXPECT_NE(r.err.find(message), std::string::npos) << r.err;
        EXPECT_EQ(r.out, "");
    };
    expect({}, "x,y\n0,0\n1,1\n1,1\n2,0\n", 3, "standard input: line 4: is the same as line 3");
    expect({}, "x,y\n0,0\n1,nan\n", 3, "standard input: line 3: expected finite numbers");
    expect({}, "1,2\n", 3, "1 point");
    expect({}, "", 3, "0 point");
    expect({"--ends", "not-a-knot"}, "0,0\n1,1\n2,0\n", 3, "need at least 4");
    expect({"--ends", "clamped", "--tangents", "1,0"}, kPoints, 2, "need --tangents");
    expect({"--ends", "clamped", "--tangents", "1,0,0;1,0,0"}, kPoints, 2,
           "has 3 numbers, the points have 2");
    expect({"--ends", "catmul-rom"}, kPoints, 2, "did you mean \"catmull-rom\"");
    expect({"--degree", "0"}, kPoints, 2, "from 1 to 25");
    expect({"--ends", "akima", "--degree", "5"}, kPoints, 2, "degree 3");
    expect({"-o", path("c.stl")}, kPoints, 2, "writes .json, .bpt, .step");
    expect({"--at", "0,1,1,2"}, kPoints, 3, "at[2]");
    EXPECT_EQ(run({"interpolate", path("missing.csv")}).code, 5);
}

// Slopes 0, 0, 0, 4, 2, 3 of the chords: at the fifth point Akima takes (4 + 4 * 2) / 5, the monotone scheme
// the harmonic mean of 4 and 2, that of Fritsch and Carlson their mean.
TEST_F(Interpolate, local_schemes_are_those_of_their_authors) {
    const std::string points = "0,0\n1,0\n2,0\n3,0\n4,4\n5,6\n6,9\n";
    for (const auto& [scheme, slope] :
         {std::pair{"akima", 2.4}, {"monotone", 8 / 3.0}, {"fritsch-carlson", 3.0}}) {
        const Json p = curve({"--ends", scheme, "--parameters", "uniform"}, points)["points"];
        ASSERT_EQ(p.size(), 19u);
        EXPECT_NEAR(p[13][1].get<double>(), 4 + slope / 3, 1e-14) << scheme;
        EXPECT_NEAR(p[11][1].get<double>(), 4 - slope / 3, 1e-14) << scheme;
        for (std::size_t i = 0; i < 10; ++i) EXPECT_EQ(p[i][1], 0.0) << scheme;
    }
}

TEST_F(Interpolate, the_report_holds_the_parameters_of_all_points) {
    const Ran r =
        run({"interpolate", "-", "--parameters", "uniform", "-o", path("c.json"), "--json"}, kPoints);
    ASSERT_EQ(r.code, 0) << r.err;
    EXPECT_EQ(Json::parse(r.out)["parameters"], Json::parse("[0,1,2,3]"));
    const std::string q = "0,0\n0,3\n4,3\n4,2\n";
    const Json chordal = curve({"--at", "0,3,7,8"}, q), given = curve({}, q);
    EXPECT_EQ(given, chordal);
}

// R24.
TEST_F(Interpolate, twists_of_a_grid_are_chosen_and_one_direction_may_be_closed) {
    const std::string grid =
        "[[[0,0,0],[1,0,1],[2,0,0]],[[0,1,2],[1,1,0],[2,1,1]],[[0,2,0],[1,2,3],[2,2,1]]]";
    const Json flat = curve({"--ends", "catmull-rom", "--twists", "zero"}, grid);
    ASSERT_EQ(flat["points"].size(), 7u);
    // b11 = b10 + b01 - b00 without a twist.
    for (std::size_t k = 0; k < 3; ++k) {
        const auto b = [&](int i, int j) { return flat["points"][i][j][k].get<double>(); };
        EXPECT_NEAR(b(4, 4), b(4, 3) + b(3, 4) - b(3, 3), 1e-15);
        EXPECT_NEAR(b(1, 1), b(1, 0) + b(0, 1) - b(0, 0), 1e-15);
    }
    const Json tensor = curve({"--ends", "catmull-rom"}, grid);
    EXPECT_NE(tensor["points"][4][4], flat["points"][4][4]);
    EXPECT_EQ(tensor["points"][3][4], flat["points"][3][4]);
    const Json tube = curve({"--ends", "catmull-rom-periodic,catmull-rom", "--twists", "adini"}, grid);
    EXPECT_EQ(tube["points"].size() == 9u || tube["points"].size() == 10u, true) << tube["points"].size();
    EXPECT_EQ(tube["points"][0].size(), 7u);
    EXPECT_EQ(run({"interpolate", "-", "--twists", "adini"}, grid).code, 2);
    EXPECT_EQ(run({"interpolate", "-", "--ends", "catmull-rom", "--twists", "coons"}, grid).code, 2);
}

}  // namespace
}  // namespace freiform::test
