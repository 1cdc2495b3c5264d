#include "run.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

namespace freiform::test {
namespace {

using NearestCommand = Program;

constexpr const char* kTwoObjects = R"({"freiform": 1, "objects": [
    {"name": "line", "type": "curve", "points": [[0,0,0],[4,0,0]]},
    {"name": "roof", "type": "surface", "degrees": [1, 1], "points": [[[0,0,10],[0,4,10]],[[4,0,10],[4,4,10]]]}]})";

TEST_F(NearestCommand, says_object_parameters_point_distance_and_lower_bound) {
    const std::string two = file("two.json", kTwoObjects);
    const Ran r = run({"nearest", two, "--points", file("p.csv", "1,3,4\n1,2,8\n"), "--json"});
    ASSERT_EQ(r.code, 0) << r.out << r.err;
    const auto results = nlohmann::json::parse(r.out)["results"];
    ASSERT_EQ(results.size(), 2u);
    EXPECT_EQ(results[0]["object"], 0);
    EXPECT_EQ(results[0]["parameters"], (std::vector<double>{0.25}));
    EXPECT_EQ(results[0]["distance"], 5.0);
    EXPECT_EQ(results[1]["name"], "roof");
    EXPECT_EQ(results[1]["parameters"], (std::vector<double>{0.25, 0.5}));
    EXPECT_EQ(results[1]["point"], (std::vector<double>{1, 2, 10}));
    for (const auto& one : results) {
        EXPECT_LE(one["lower_bound"], one["distance"]);
        EXPECT_GE(one["lower_bound"].get<double>(), one["distance"].get<double>() - 1e-12);
        EXPECT_LE(one["point_error"].get<double>(), 1e-12);
    }
    const Ran plain = run({"nearest", two, "--object", "line", "--points", path("p.csv")});
    EXPECT_EQ(plain.code, 0);
    EXPECT_NE(plain.out.find("at 0.25, point 1, 0, 0, distance 5, at least 4.99"), std::string::npos)
        << plain.out;
}

TEST_F(NearestCommand, lists_the_nearest_feet_and_how_far_the_others_are) {
    const std::string two = file("two.json", kTwoObjects);
    const std::string at = file("p.csv", "1,3,4\n");
    const Ran r = run({"nearest", two, "--points", at, "--k", "1", "--json"});
    ASSERT_EQ(r.code, 0) << r.out << r.err;
    const auto one = nlohmann::json::parse(r.out)["results"][0];
    ASSERT_EQ(one["feet"].size(), 1u);
    EXPECT_EQ(one["feet"][0]["distance"], 5.0);
    EXPECT_GE(one["others_lower_bound"].get<double>(), 5 - 1e-9);
    EXPECT_LE(one["others_lower_bound"].get<double>(), 6);
    const Ran all = run({"nearest", two, "--points", at, "--k", "5"});
    EXPECT_NE(all.out.find("\"roof\": at 0.25, 0.75"), std::string::npos) << all.out;
    EXPECT_NE(all.out.find("there are no others"), std::string::npos) << all.out;
    EXPECT_EQ(run({"nearest", two, "--points", at, "--k", "0"}).code, 2);
    EXPECT_EQ(run({"nearest", two, "--points", at, "--k", "2", "--farthest"}).code, 2);
}

TEST_F(NearestCommand, distance_of_two_files_says_both_places) {
    const std::string two = file("two.json", kTwoObjects);
    const std::string dot = file("dot.json", R"({"freiform": 1, "objects": [
        {"name": "post", "type": "curve", "points": [[2,2,6],[2,2,7]]}]})");
    const Ran r = run({"distance", two, dot, "--json"});
    ASSERT_EQ(r.code, 0) << r.out << r.err;
    const auto d = nlohmann::json::parse(r.out);
    EXPECT_EQ(d["distance"], 3.0);
    EXPECT_GE(d["lower_bound"].get<double>(), 3 - 1e-7);
    EXPECT_EQ(d["a"]["name"], "roof");
    EXPECT_EQ(d["a"]["parameters"], (std::vector<double>{0.5, 0.5}));
    EXPECT_EQ(d["b"]["parameters"], (std::vector<double>{1}));
    const Ran line = run({"distance", two, dot, "--object-a", "line"});
    EXPECT_NE(line.out.find("distance 6.32455"), std::string::npos) << line.out;
    const std::string plane = file("plane.json", R"({"type": "curve", "points": [[0,0],[1,0]]})");
    EXPECT_EQ(run({"distance", two, plane}).code, 1);
    const std::string half = file("half.json", R"({"type": "trimmed", "surface": {"degrees": [1, 1],
        "points": [[[0,0,0],[0,1,0]],[[1,0,0],[1,1,0]]]}, "loops": [[{"degree": 1, "points": [[0,0],[1,0]]},
        {"degree": 1, "points": [[1,0],[0,1]]}, {"degree": 1, "points": [[0,1],[0,0]]}]]})");
    const std::string tip = file("tip.json", R"({"type": "surface", "degrees": [1, 1],
        "points": [[[1,1,1],[1,1,2]],[[2,2,1],[2,2,2]]]})");
    const Ran trimmed = run({"distance", half, tip, "--json", "--accuracy", "1e-4"});
    ASSERT_EQ(trimmed.code, 0) << trimmed.out << trimmed.err;
    EXPECT_NEAR(nlohmann::json::parse(trimmed.out)["distance"].get<double>(), std::sqrt(1.5), 1e-4);
    EXPECT_LE(nlohmann::json::parse(trimmed.out)["lower_bound"].get<double>(), std::sqrt(1.5));
    EXPECT_EQ(run({"distance", half, dot}).code, 1);  // a curve and a face
    EXPECT_EQ(run({"distance", two}).code, 2);
    EXPECT_EQ(run({"distance", two, dot, "--accuracy", "-1"}).code, 2);
}

TEST_F(NearestCommand, refuses_points_and_objects_that_do_not_go_together) {
    const std::string two = file("two.json", kTwoObjects);
    EXPECT_EQ(run({"nearest", two, "--points", file("p.csv", "1,2\n")}).code, 1);
    EXPECT_EQ(run({"nearest", two}).code, 2);
    EXPECT_EQ(run({"nearest", two, "--points", path("absent.csv")}).code, 5);
    EXPECT_EQ(run({"nearest", two, "--points", path("p.csv"), "--accuracy", "-1"}).code, 2);
    const Ran mixed = run({"nearest", file("mixed.json", R"({"freiform": 1, "objects": [
        {"type": "curve", "points": [[0,0],[1,0]]}, {"type": "curve", "points": [[0,0,0],[1,0,0]]}]})"),
                           "--points", path("p.csv"), "--json"});
    EXPECT_EQ(mixed.code, 1);
    EXPECT_NE(mixed.out.find("--object chooses"), std::string::npos) << mixed.out;
}

constexpr const char* kParabola =
    R"({"freiform": 1, "objects": [{"name": "p", "type": "curve", "points": [[-2,4],[0,-4],[2,4]]}]})";

TEST_F(NearestCommand, says_where_else_is_as_near) {
    const std::string p = file("p.json", kParabola);
    const Ran r = run({"nearest", p, "--points", file("q.csv", "0,2\n1,3\n"), "--json"});
    ASSERT_EQ(r.code, 0) << r.out << r.err;
    const auto results = nlohmann::json::parse(r.out)["results"];
    EXPECT_EQ(results[0]["many"], true);
    EXPECT_EQ(results[0]["complete"], true);
    ASSERT_EQ(results[0]["as_near"].size(), 2u);
    for (const auto& one : results[0]["as_near"]) {
        EXPECT_EQ(one["stretch"], false);
        EXPECT_LE(one["box"][0][0], one["parameters"][0]);
        EXPECT_GE(one["box"][0][1], one["parameters"][0]);
    }
    EXPECT_EQ(results[1]["many"], false);
    EXPECT_FALSE(results[1].contains("as_near"));
    const Ran plain = run({"nearest", p, "--points", path("q.csv")});
    EXPECT_NE(plain.out.find("as near, as far as can be told"), std::string::npos) << plain.out;
}

TEST_F(NearestCommand, lists_what_is_within_a_radius_and_finds_the_farthest) {
    const std::string p = file("p.json", kParabola);
    const std::string q = file("q.csv", "0,2\n");
    const Ran near = run({"nearest", p, "--points", q, "--radius", "1.5", "--json"});
    ASSERT_EQ(near.code, 0) << near.out << near.err;
    const auto within = nlohmann::json::parse(near.out)["results"][0];
    EXPECT_EQ(within["regions"].size(), 2u);
    EXPECT_EQ(run({"nearest", p, "--points", q, "--radius", "1"}).out, "0, 2: 0 regions within 1\n");
    const Ran far = run({"nearest", p, "--points", q, "--farthest", "--json"});
    ASSERT_EQ(far.code, 0) << far.out << far.err;
    const auto farthest = nlohmann::json::parse(far.out)["results"][0];
    EXPECT_NEAR(farthest["distance"].get<double>(), std::sqrt(8.0), 1e-15);  // an end of the parabola
    EXPECT_GE(farthest["upper_bound"], farthest["distance"]);
    EXPECT_EQ(run({"nearest", p, "--points", q, "--farthest", "--radius", "1"}).code, 2);
    EXPECT_EQ(run({"nearest", p, "--points", q, "--radius", "-1"}).code, 2);
}

TEST_F(NearestCommand, keeps_to_what_trimming_leaves) {
    const auto square = [](const std::string& loops) {
        return R"({"freiform": 1, "objects": [{"name": "half", "type": "trimmed", "surface": {"degrees": [1, 1],
            "points": [[[0,0,0],[0,1,0]],[[1,0,0],[1,1,0]]]}, "loops": [)" +
               loops + "]}]}";
    };
    const std::string q = file("q.csv", "1,1,1\n");
    const Ran whole = run({"nearest", file("whole.json", square("")), "--points", q, "--json"});
    ASSERT_EQ(whole.code, 0) << whole.out << whole.err;
    EXPECT_NEAR(nlohmann::json::parse(whole.out)["results"][0]["distance"].get<double>(), 1, 1e-14);
    const std::string half =
        file("half.json",
             square(R"([{"degree": 1, "points": [[0,0],[1,0]]}, {"degree": 1, "points": [[1,0],[0,1]]},
                                {"degree": 1, "points": [[0,1],[0,0]]}])"));
    const Ran r = run({"nearest", half, "--points", q, "--json"});
    ASSERT_EQ(r.code, 0) << r.out << r.err;
    const auto n = nlohmann::json::parse(r.out)["results"][0];
    EXPECT_NEAR(n["distance"].get<double>(), std::sqrt(1.5), 1e-8);
    EXPECT_LE(n["lower_bound"].get<double>(), std::sqrt(1.5) + 1e-14);
    EXPECT_GE(n["lower_bound"].get<double>(), std::sqrt(1.5) - 1e-8);
    EXPECT_EQ(n["edge"], 1);
    EXPECT_NE(run({"nearest", half, "--points", q}).out.find("on edge 1"), std::string::npos);
    EXPECT_EQ(run({"nearest", half, "--points", file("plane.csv", "1,2\n")}).code, 1);
    const Ran open = run({"nearest", half, "--points", q, "--signed"});
    EXPECT_EQ(open.code, 1);
    EXPECT_NE(open.err.find("not a closed body"), std::string::npos) << open.err;
    EXPECT_EQ(run({"nearest", half, "--points", q, "--radius", "1"}).code, 0);
    const std::string curve = file("p.json", kParabola);
    EXPECT_EQ(run({"nearest", curve, "--points", path("plane.csv"), "--signed"}).code, 1);
}

TEST_F(NearestCommand, faces_and_curves_of_one_document_are_asked_together) {
    const std::string both = file("both.json", R"({"freiform": 1, "objects": [
        {"name": "square", "type": "trimmed", "surface": {"degrees": [1, 1],
            "points": [[[0,0,0],[0,1,0]],[[1,0,0],[1,1,0]]]}, "loops": []},
        {"name": "post", "type": "curve", "points": [[5,0,0],[5,0,2]]}]})");
    const Ran r = run({"nearest", both, "--points", file("q.csv", "0.5,0.5,1\n4,0,1\n"), "--json"});
    ASSERT_EQ(r.code, 0) << r.out << r.err;
    const auto results = nlohmann::json::parse(r.out)["results"];
    EXPECT_EQ(results[0]["name"], "square");
    EXPECT_EQ(results[0]["face"], 0);
    EXPECT_EQ(results[1]["name"], "post");
    EXPECT_EQ(results[1]["parameters"], (std::vector<double>{0.5}));
    EXPECT_EQ(results[1]["distance"], 1.0);
    for (const auto& one : results) {
        EXPECT_LE(one["lower_bound"], one["distance"]);
        EXPECT_GE(one["lower_bound"].get<double>(), 1 - 1e-6);
    }
    const std::string plane = file("plane.json", R"({"freiform": 1, "objects": [
        {"type": "trimmed", "surface": {"degrees": [1, 1], "points": [[[0,0,0],[0,1,0]],[[1,0,0],[1,1,0]]]},
         "loops": []}, {"type": "curve", "points": [[5,0],[5,2]]}]})");
    const Ran mixed = run({"nearest", plane, "--points", path("q.csv")});
    EXPECT_EQ(mixed.code, 1);
    EXPECT_NE(mixed.err.find("2 coordinates"), std::string::npos) << mixed.err;
}

TEST_F(NearestCommand, distances_of_solids_have_a_sign_where_asked) {
    const std::string model = std::string(FREIFORM_SOURCE_DIR) + "/examples/bracket.step";
    const Ran r = run({"nearest", model, "--points", file("p.csv", "0,0,0\n30,10,5\n30,10,0\n30,10,0.001\n"),
                       "--signed", "--json"});
    ASSERT_EQ(r.code, 0) << r.out << r.err;
    const auto results = nlohmann::json::parse(r.out)["results"];
    EXPECT_EQ(results[0]["side"], "outside");
    EXPECT_EQ(results[0]["signed_distance"], results[0]["distance"]);
    EXPECT_EQ(results[1]["side"], "inside");
    EXPECT_NEAR(results[1]["signed_distance"].get<double>(), -5, 1e-9);
    EXPECT_EQ(results[2]["side"], "undecided");  // on the surface
    EXPECT_FALSE(results[2].contains("signed_distance"));
    EXPECT_EQ(results[3]["side"], "inside");  // a hundred-thousandth of the size away
}

}  // namespace
}  // namespace freiform::test
