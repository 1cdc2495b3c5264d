#include "run.hpp"

#include <array>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

namespace freiform::test {
namespace {

using AnimateProgram = Program;
using AnimateJson = nlohmann::json;

const std::string kWay = R"({"freiform": 1, "objects": [{"name": "way", "type": "curve", "degree": 3,
    "points": [[0,0],[1,2],[3,2],[4,0]]}]})";

std::vector<std::vector<double>> table(const std::string& csv) {
    std::istringstream lines(csv);
    std::string line;
    std::getline(lines, line);
    std::vector<std::vector<double>> out;
    while (std::getline(lines, line)) {
        std::istringstream cells(line);
        out.emplace_back();
        for (std::string cell; std::getline(cells, cell, ',');) out.back().push_back(std::stod(cell));
    }
    return out;
}

TEST_F(AnimateProgram, moves_along_a_curve) {
    file("way.json", kWay);
    const Ran ran =
        run({"animate", "way.json", "--speed", "2", "--acceleration", "1", "--jerk", "4", "--rate", "50"});
    ASSERT_EQ(ran.code, 0) << ran.err;
    const auto rows = table(ran.out);
    ASSERT_GT(rows.size(), 100u);
    EXPECT_EQ(rows.front()[1], 0);
    EXPECT_NEAR(rows.back()[4], 4, 1e-9);
    EXPECT_NEAR(rows.back()[2], 0, 1e-9);
    double way = 0;
    for (std::size_t i = 1; i < rows.size(); ++i) {
        way += std::hypot(rows[i][4] - rows[i - 1][4], rows[i][5] - rows[i - 1][5]);
        EXPECT_NEAR(way, rows[i][1], 1e-3);
        EXPECT_LE(rows[i][2], 2 + 1e-9);
        EXPECT_LE(std::abs(rows[i][3]), 1 + 1e-9);
        EXPECT_LE(rows[i][11], 2e-8);
    }
    const auto said = AnimateJson::parse(run({"animate", "way.json", "--duration", "5", "--json"}).out);
    EXPECT_EQ(said["duration"], 5.0);
    EXPECT_NEAR(said["speed"].get<double>() * 5, said["length"]["value"].get<double>(), 1e-9);
}

// The acceleration across the way from three places each, whose second difference is off by the change of it.
TEST_F(AnimateProgram, is_slow_where_the_way_bends) {
    file("way.json", kWay);
    const auto rows_of = [&](std::vector<std::string> more) {
        std::vector<std::string> words{"animate",        "way.json", "--speed", "2",
                                       "--acceleration", "1",        "--rate",  "100"};
        words.insert(words.end(), more.begin(), more.end());
        const Ran ran = run(words);
        EXPECT_EQ(ran.code, 0) << ran.err;
        return table(ran.out);
    };
    const auto most_across = [](const std::vector<std::vector<double>>& rows) {
        double most = 0;
        for (std::size_t i = 1; i + 2 < rows.size(); ++i) {
            const double dt = rows[i][0] - rows[i - 1][0];
            std::array<double, 2> v{}, a{};
            for (std::size_t k = 0; k < 2; ++k) {
                v[k] = (rows[i + 1][4 + k] - rows[i - 1][4 + k]) / (2 * dt);
                a[k] = (rows[i + 1][4 + k] - 2 * rows[i][4 + k] + rows[i - 1][4 + k]) / (dt * dt);
            }
            const double speed = std::hypot(v[0], v[1]);
            if (speed > 0.1) most = std::max(most, std::abs(v[0] * a[1] - v[1] * a[0]) / speed);
        }
        return most;
    };
    const auto free = rows_of({}), limited = rows_of({"--across", "0.5"});
    EXPECT_GT(most_across(free), 1);
    EXPECT_LT(most_across(limited), 0.51);
    EXPECT_GT(most_across(limited), 0.4);
    EXPECT_GT(limited.back()[0], free.back()[0]);
    EXPECT_NEAR(limited.back()[4], 4, 1e-9);
    // With the jerk limited, too: column 3 is the acceleration along the way.
    const auto smooth = rows_of({"--across", "0.5", "--jerk", "2"});
    EXPECT_LT(most_across(smooth), 0.51);
    EXPECT_GT(smooth.back()[0], limited.back()[0]);
    const auto most_jerk = [](const std::vector<std::vector<double>>& rows) {
        double most = 0;
        for (std::size_t i = 1; i < rows.size(); ++i)
            most = std::max(most, std::abs(rows[i][3] - rows[i - 1][3]) / (rows[i][0] - rows[i - 1][0]));
        return most;
    };
    EXPECT_LT(most_jerk(smooth), 2.001);
    EXPECT_GT(most_jerk(limited), 20);
}

TEST_F(AnimateProgram, writes_pictures_that_move_and_gltf_that_it_reads_back) {
    file("way.json", kWay);
    ASSERT_EQ(run({"animate", "way.json", "--speeds", "1,3,1", "--facing", "upright", "-o", "m.html"}).code,
              0);
    const std::string html = content(path("m.html"));
    EXPECT_NE(html.find("<animateMotion"), html.npos);
    EXPECT_NE(html.find("rotate=\"auto\""), html.npos);
    ASSERT_EQ(run({"animate", "way.json", "--duration", "2", "-o", "m.svg"}).code, 0);
    ASSERT_EQ(
        run({"animate", "way.json", "--duration", "2", "--facing", "least-turning", "-o", "m.glb"}).code, 0);
    const Ran sampled = run({"animate", "m.glb", "--rate", "10"});
    ASSERT_EQ(sampled.code, 0) << sampled.err;
    EXPECT_NE(sampled.out.find("way,translation,2,4,"), sampled.out.npos) << sampled.out;
    const auto said = AnimateJson::parse(run({"animate", "m.glb", "--json"}).out);
    EXPECT_EQ(said["animations"][0]["channels"][1]["path"], "rotation");
    EXPECT_EQ(said["animations"][0]["channels"][0]["interpolation"], "CUBICSPLINE");
}

TEST_F(AnimateProgram, eases_and_reads_keys) {
    const auto ease =
        AnimateJson::parse(run({"ease", "--bezier", "0.42,0,0.58,1", "--at", "0.5", "--json"}).out);
    EXPECT_NEAR(ease["values"][0]["value"].get<double>(), 0.5, 1e-15);
    EXPECT_LT(ease["values"][0]["bound"].get<double>(), 1e-14);
    EXPECT_EQ(run({"ease", "--bezier", "1.5,0,0,1"}).code, 2);
    file("keys.json", R"({"outside": "hold", "keys": [{"time": 0, "value": [0, 1], "next": "step"},
        {"time": 1, "value": [2, 1], "next": "bezier", "after": {"time": 1.5, "value": [2, 1]}},
        {"time": 2, "value": [4, 3], "before": {"time": 1.5, "value": [4, 3]}}]})");
    const auto keys =
        AnimateJson::parse(run({"ease", "--keys", "keys.json", "--at", "0.9,1.5,3", "--json"}).out);
    EXPECT_EQ(keys["samples"][0]["value"], (std::vector<double>{0, 1}));
    EXPECT_NEAR(keys["samples"][1]["value"][0].get<double>(), 3, 1e-14);
    EXPECT_EQ(keys["samples"][2]["value"], (std::vector<double>{4, 3}));
    file("smooth.json", R"({"tangents": {}, "keys": [{"time": 0, "value": 0}, {"time": 1, "value": 1},
        {"time": 2, "value": 4}]})");
    const auto rows = table(run({"ease", "--keys", "smooth.json", "--rate", "2"}).out);
    ASSERT_EQ(rows.size(), 5u);
    EXPECT_NEAR(rows[1][1], 0.375, 1e-15);  // tangents 1 and 2: (0 + 1) / 2 + (1 - 2) / 8
    for (const auto& [keys_text, where] :
         {std::pair{R"({"keys": [{"time": 0, "value": [0, 1]}, {"time": 1, "value": 2}]})", "line 1"},
          {R"({"keys": [{"time": 0, "value": 1, "next": "jump"}]})", "line 1"},
          {R"({"keys": [{"time": 1, "value": 1}, {"time": 1, "value": 2}]})", "keys[1].time"}}) {
        file("bad.json", keys_text);
        const Ran bad = run({"ease", "--keys", "bad.json"});
        EXPECT_EQ(bad.code, 3);
        EXPECT_NE(bad.err.find(where), bad.err.npos) << bad.err;
    }
}

TEST_F(AnimateProgram, refuses_what_it_cannot_move_along) {
    file("way.json", kWay);
    EXPECT_EQ(run({"animate", "way.json"}).code, 2);
    EXPECT_EQ(run({"animate", "way.json", "--duration", "1", "--speed", "2"}).code, 2);
    EXPECT_EQ(run({"animate", "way.json", "--duration", "1", "--rate", "1e9"}).code, 4);
    EXPECT_EQ(run({"animate", "way.json", "--speeds", "1,-1,1"}).code, 3);
    file("m.gltf", "{\"asset\": {\"version\": \"2.0\"}}");
    EXPECT_EQ(run({"animate", "m.gltf"}).code, 1);
    EXPECT_EQ(run({"animate", "m.gltf", "--rate", "0"}).code, 2);
    file("dot.json", R"({"type": "curve", "degree": 1, "points": [[1,1],[1,1]]})");
    const Ran dot = run({"animate", "dot.json", "--duration", "1"});
    EXPECT_EQ(dot.code, 1);
    EXPECT_NE(dot.err.find("no length"), dot.err.npos) << dot.err;
    EXPECT_EQ(run({"animate", kTeapot, "--duration", "1"}).code, 2);
}

}  // namespace
}  // namespace freiform::test
