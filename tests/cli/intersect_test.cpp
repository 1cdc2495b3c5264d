#include "run.hpp"

#include <nlohmann/json.hpp>

namespace freiform::test {
namespace {

using IntersectCommand = Program;

constexpr const char* kArches = R"({"freiform": 1, "objects": [
    {"name": "arch", "type": "curve", "points": [[0,0],[1,2],[3,2],[4,0]]},
    {"name": "high", "type": "curve", "points": [[0,9],[1,9]]}]})";

// z = x^2 + y^2 over [-1, 1]^2.
constexpr const char* kBowl = R"({"type": "surface", "points": [
    [[-1,-1,2],[-1,0,0],[-1,1,2]], [[0,-1,0],[0,0,-2],[0,1,0]], [[1,-1,2],[1,0,0],[1,1,2]]]})";

TEST_F(IntersectCommand, surfaces_meet_in_curves) {
    const std::string bowl = file("bowl.json", kBowl);
    const std::string level = file("level.json", R"({"type": "surface", "points": [
        [[-2,-2,0.25],[-2,2,0.25]], [[2,-2,0.25],[2,2,0.25]]]})");
    const Ran r =
        run({"intersect", bowl, level, "--tolerance", "1e-6", "--json", "--curves", path("c.json")});
    ASSERT_EQ(r.code, 0) << r.out << r.err;
    const auto all = nlohmann::json::parse(r.out);
    ASSERT_EQ(all["curves"].size(), 1u) << r.out;
    const auto& c = all["curves"][0];
    EXPECT_EQ(c["closed"], true);
    EXPECT_LE(c["bound"], 1e-6);
    EXPECT_EQ(c["curve"]["points"][0].size(), 3u);
    EXPECT_EQ(c["a"]["points"][0].size(), 2u);
    EXPECT_EQ(c["b"]["knots"].back(), c["curve"]["knots"].back());
    EXPECT_TRUE(all["nodes"].empty());
    const Ran length = run({"length", path("c.json"), "--json"});
    ASSERT_EQ(length.code, 0) << length.err;
    EXPECT_NEAR(nlohmann::json::parse(length.out)["objects"][0]["value"].get<double>(), 3.14159265, 1e-4);
    const Ran plain = run({"intersect", bowl, level});
    EXPECT_NE(plain.out.find("closed branch"), std::string::npos) << plain.out;
}

TEST_F(IntersectCommand, lists_points_with_their_kind_and_parameters) {
    const std::string a = file("a.json", kArches);
    const std::string b = file("b.json", R"({"type": "curve", "points": [[2,0],[2,3]], "weights": [1, 2]})");
    const Ran r = run({"intersect", a, b, "--json"});
    ASSERT_EQ(r.code, 0) << r.out << r.err;
    const auto all = nlohmann::json::parse(r.out);
    ASSERT_EQ(all["points"].size(), 1u) << r.out;
    const auto& p = all["points"][0];
    EXPECT_EQ(p["kind"], "crossing");
    EXPECT_EQ(p["proven"], true);
    EXPECT_EQ(p["objects"], (std::vector<int>{0, 0}));
    EXPECT_NEAR(p["a"][0], 0.5, 1e-15);
    EXPECT_NEAR(p["b"][0], 1.0 / 3, 1e-15);
    EXPECT_NEAR(p["point"][1], 1.5, 1e-15);
    EXPECT_TRUE(all["overlaps"].empty() && all["possible"].empty());
    const Ran plain = run({"intersect", a, b, "--object-a", "high"});
    EXPECT_EQ(plain.code, 0);
    EXPECT_EQ(plain.out, "no intersection\n");
}

TEST_F(IntersectCommand, lists_overlaps_as_intervals) {
    const std::string a = file("a.json", kArches);
    const Ran r = run({"intersect", a, a, "--object-a", "arch", "--object-b", "arch", "--json"});
    ASSERT_EQ(r.code, 0) << r.out << r.err;
    const auto all = nlohmann::json::parse(r.out);
    ASSERT_EQ(all["overlaps"].size(), 1u) << r.out;
    EXPECT_EQ(all["overlaps"][0]["a"], (std::vector<double>{0, 1}));
    EXPECT_EQ(all["overlaps"][0]["gap"], 0.0);
    EXPECT_TRUE(all["points"].empty());
}

TEST_F(IntersectCommand, lines_meet_the_teapot) {
    const std::string ray = file("ray.json", R"({"type": "curve", "points": [[0.3,0.2,-9],[0.3,0.2,9]]})");
    const Ran r = run({"intersect", ray, kTeapot, "--json"}),
              back = run({"intersect", kTeapot, ray, "--json"});
    ASSERT_EQ(r.code, 0) << r.out << r.err;
    const auto all = nlohmann::json::parse(r.out), swapped = nlohmann::json::parse(back.out);
    ASSERT_FALSE(all["points"].empty());
    EXPECT_EQ(all["points"].size(), swapped["points"].size());
    for (const auto& p : all["points"]) {
        EXPECT_EQ(p["a"].size(), 1u);
        EXPECT_EQ(p["b"].size(), 2u);
        EXPECT_LT(p["gap"], 1e-12);
        EXPECT_NEAR(p["point"][0], 0.3, 1e-15);
    }
}

// The triangle over [1/4, 3/4] of the plane z = 0, and an upright plane through x = 1/2: from the base to the
// tip.
TEST_F(IntersectCommand, trimmed_faces_are_cut_off_at_their_loops) {
    const std::string face =
        file("face.json", R"({"type": "trimmed", "surface": {"type": "surface", "degrees": [1, 1],
        "points": [[[0,0,0],[0,1,0]],[[1,0,0],[1,1,0]]]},
        "loops": [[{"degree": 1, "points": [[0.25,0.25],[0.75,0.25]]}, {"degree": 1, "points": [[0.75,0.25],[0.5,0.75]]},
                   {"degree": 1, "points": [[0.5,0.75],[0.25,0.25]]}]]})");
    const std::string wall = file("wall.json", R"({"type": "surface", "degrees": [1, 1],
        "points": [[[0.5,-1,-1],[0.5,-1,1]],[[0.5,2,-1],[0.5,2,1]]]})");
    for (const bool swapped : {false, true}) {
        const Ran r = swapped ? run({"intersect", wall, face, "--tolerance", "1e-6", "--json"})
                              : run({"intersect", face, wall, "--tolerance", "1e-6", "--json"});
        ASSERT_EQ(r.code, 0) << r.out << r.err;
        const auto all = nlohmann::json::parse(r.out);
        ASSERT_EQ(all["curves"].size(), 1u) << r.out;
        const auto& c = all["curves"][0];
        EXPECT_EQ(c["kind"], "crossing");
        ASSERT_EQ(all["chains"].size(), 1u);
        EXPECT_EQ(all["chains"][0]["curves"], (std::vector<int>{0}));
        EXPECT_EQ(all["chains"][0]["closed"], false);
        EXPECT_EQ(c["faces"], (std::vector<int>{0, 0}));
        EXPECT_EQ(c["ends"], (std::vector<int>{-3, -3}));
        for (const auto& trim : c["trims"]) EXPECT_EQ(trim[0], swapped ? 1 : 0);
        const auto& points = c["curve"]["points"];
        const double y0 = points.front()[1], y1 = points.back()[1];
        EXPECT_NEAR(std::min(y0, y1), 0.25, 1e-9);
        EXPECT_NEAR(std::max(y0, y1), 0.75, 1e-9);
    }
}

// The triangle of above; rays through it, beside it, through its base, and away from it.
TEST_F(IntersectCommand, curves_lines_and_rays_meet_faces) {
    const std::string face =
        file("face.json", R"({"type": "trimmed", "surface": {"type": "surface", "degrees": [1, 1],
        "points": [[[0,0,0],[0,1,0]],[[1,0,0],[1,1,0]]]},
        "loops": [[{"degree": 1, "points": [[0.25,0.25],[0.75,0.25]]}, {"degree": 1, "points": [[0.75,0.25],[0.5,0.75]]},
                   {"degree": 1, "points": [[0.5,0.75],[0.25,0.25]]}]]})");
    const std::string rays =
        file("rays.csv",
             "px,py,pz,dx,dy,dz\n0.5,0.5,2,0,0,-1\n0.1,0.5,2,0,0,-1\n0.5,0.25,2,0,0,-1\n0.5,0.5,2,0,0,1\n");
    const auto all = nlohmann::json::parse(run({"intersect", face, "--rays", rays, "--json"}).out);
    ASSERT_EQ(all["points"].size(), 2u) << all;
    const auto &first = all["points"][0], &edge = all["points"][1];
    EXPECT_EQ(first["ray"], 0);
    EXPECT_EQ(first["face"], 0);
    EXPECT_EQ(first["kind"], "crossing");
    EXPECT_EQ(first["proven"], true);
    EXPECT_NEAR(first["b"][0].get<double>(), 2, 1e-15);
    EXPECT_NEAR(first["a"][1].get<double>(), 0.5, 1e-15);
    EXPECT_EQ(edge["ray"], 2);
    EXPECT_EQ(edge["kind"], "end");
    EXPECT_TRUE(edge.contains("edge"));
    const auto lines = nlohmann::json::parse(run({"intersect", face, "--lines", rays, "--json"}).out);
    EXPECT_EQ(lines["points"].size(), 3u);
    const std::string wire = file("wire.json", R"({"type": "curve", "points": [[0.5,0.4,-1],[0.5,0.4,1]]})");
    for (const bool swapped : {false, true}) {
        const auto met = nlohmann::json::parse(swapped ? run({"intersect", face, wire, "--json"}).out
                                                       : run({"intersect", wire, face, "--json"}).out);
        ASSERT_EQ(met["points"].size(), 1u) << met;
        EXPECT_NEAR(met["points"][0][swapped ? "b" : "a"][0].get<double>(), 0.5, 1e-15);
        EXPECT_EQ(met["points"][0]["face"], 0);
    }
    const Ran bad = run({"intersect", face, "--rays", file("bad.csv", "1,2,3,0,0\n")});
    EXPECT_EQ(bad.code, 3);
    EXPECT_NE(bad.err.find("line 1"), std::string::npos) << bad.err;
    EXPECT_EQ(run({"intersect", face, "--rays", file("none.csv", "1,2,3,0,0,0\n")}).code, 3);
    EXPECT_EQ(run({"intersect", wire, "--rays", rays}).code, 1);
    EXPECT_EQ(run({"intersect", face, face, "--rays", rays}).code, 2);
}

TEST_F(IntersectCommand, says_what_is_not_answered) {
    const std::string a = file("a.json", kArches);
    const std::string bowl = file("bowl.json", kBowl);
    const Ran two = run({"intersect", bowl, bowl, "--json"});
    EXPECT_EQ(two.code, 0);
    EXPECT_EQ(nlohmann::json::parse(two.out)["nodes"][0]["kind"], "overlap");
    EXPECT_EQ(run({"intersect", bowl, bowl, "--tolerance", "0"}).code, 3);
    EXPECT_EQ(run({"intersect", a, kTeapot}).code, 1);
    EXPECT_EQ(run({"intersect", a}).code, 2);
    EXPECT_EQ(run({"intersect", a, a, "--tolerance", "-1"}).code, 2);
    EXPECT_EQ(
        run({"intersect", a, file("nan.json", R"({"type": "curve", "points": [[0,0],[1e999,0]]})")}).code, 3);
}

}  // namespace
}  // namespace freiform::test
