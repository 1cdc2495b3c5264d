#include "run.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

namespace freiform::test {
namespace {

using Json = nlohmann::json;
using ContinuityCommand = Program;

// Cubics a and b, joined with C1, and c, which is run the other way and leaves a gap of 0.001.
const std::string kPath = R"({"freiform": 1, "unit": "mm", "objects": [
  {"name": "a", "type": "curve", "points": [[0,0],[1,2],[3,2],[4,0]]},
  {"name": "b", "type": "curve", "points": [[4,0],[5,-2],[7,-2],[9,0]]},
  {"name": "c", "type": "curve", "points": [[20,5],[12,4],[10,1],[9,0.001]]}]})";
// Knots of multiplicity 1, 2 and 3.
const std::string kSpline = R"({"type": "curve", "degree": 3, "knots": [0,0,0,0,1,2,2,3,3,3,4,4,4,4],
  "points": [[0,0],[1,2],[3,2],[4,0],[5,1],[6,1],[7,3],[8,8],[9,9],[10,10]]})";

TEST_F(ContinuityCommand, reports_every_inner_knot_with_orders_and_first_jumps) {
    const Ran r = run({"continuity", "-", "--json"}, kSpline);
    ASSERT_EQ(r.code, 0) << r.err;
    const Json knots = Json::parse(r.out)["objects"][0]["knots"];
    ASSERT_EQ(knots.size(), 3u);
    for (int i = 0; i < 3; ++i) {
        EXPECT_EQ(knots[i]["at"], i + 1);
        EXPECT_EQ(knots[i]["multiplicity"], i + 1);
        EXPECT_EQ(knots[i]["c_order"], 2 - i);
        EXPECT_EQ(knots[i]["g_order"], 2 - i);
        EXPECT_EQ(knots[i]["first_c_jump"]["order"], 3 - i);
        EXPECT_FALSE(knots[i]["removable"]);
    }
    // At the triple knot (7, 3), (8, 8), (9, 9) hold the tangents 3 (1, 2) and 3 (1, 5).
    EXPECT_NEAR(knots[2]["first_c_jump"]["size"], 9, 1e-13);
    EXPECT_EQ(knots[2]["first_c_jump"]["unit"], "unit/t");
    EXPECT_NEAR(knots[2]["first_g_jump"]["size"], std::atan(5) - std::atan(2), 1e-13);
    EXPECT_EQ(knots[2]["first_g_jump"]["unit"], "rad");
    EXPECT_LT(knots[2]["first_g_jump"]["bound"], 1e-13);

    const Ran text = run({"continuity", file("s.json", kSpline)});
    EXPECT_EQ(text.code, 0);
    for (const char* part : {"knot 1 x1  C2  G2", "knot 2 x2  C1  G1", "knot 3 x3  C0  G0  C1 by 9 unit/t"})
        EXPECT_NE(text.out.find(part), std::string::npos) << text.out;
}

TEST_F(ContinuityCommand, reports_joints_of_neighbouring_objects) {
    const std::string path = file("path.json", kPath);
    const Json all = Json::parse(run({"continuity", path, "--json"}).out), joints = all["joints"];
    ASSERT_EQ(joints.size(), 2u) << joints;
    EXPECT_EQ(joints[0]["first"], 0);
    EXPECT_EQ(joints[0]["second"], 1);
    EXPECT_EQ(joints[0]["c_order"], 1);
    EXPECT_EQ(joints[0]["g_order"], 1);
    // P'' = 6 (P4 - 2 P3 + P2) = (-6, -12) before, 6 (1, 2) after.
    EXPECT_NEAR(joints[0]["first_c_jump"]["size"], std::hypot(12, 24), 1e-12);
    EXPECT_EQ(joints[0]["first_c_jump"]["unit"], "mm/t^2");
    EXPECT_EQ(joints[1]["second_end"], "end");
    EXPECT_EQ(joints[1]["c_order"], -1);
    EXPECT_NEAR(joints[1]["distance"], 0.001, 1e-15);
    EXPECT_NEAR(joints[1]["first_g_jump"]["size"], 0.001, 1e-15);

    for (const Json& o : {joints[0], joints[1]})
        for (const char* side : {"before", "after"}) EXPECT_EQ(o[side]["tangent"].size(), 2u) << side;
    EXPECT_EQ(joints[1]["first"], 1);
    EXPECT_EQ(joints[1]["first_end"], "end");

    // With a tolerance above the gap it is a joint; with a smaller `gap` none at all.
    const Json loose = Json::parse(run({"continuity", path, "--json", "--tolerance", "0.002"}).out)["joints"];
    EXPECT_EQ(loose[1]["c_order"], 0);
    EXPECT_EQ(Json::parse(run({"continuity", path, "--json", "--gap", "1e-6"}).out)["joints"].size(), 1u);
    // One object alone has no neighbours.
    EXPECT_EQ(Json::parse(run({"continuity", path, "--json", "--object", "b"}).out)["joints"].size(), 0u);
    EXPECT_NE(run({"continuity", path}).out.find("\"a\" end - objects[1] \"b\" start"), std::string::npos);
}

TEST_F(ContinuityCommand, looks_at_knots_of_surfaces_and_says_what_it_leaves_out) {
    const std::string surface =
        R"({"type": "surface", "degrees": [1, 2], "knots": [[0,0,1,2,2],[0,0,0,1,1,1]],
        "points": [[[0,0,0],[0,1,0],[0,2,1]],[[1,0,0],[1,1,3],[1,2,0]],[[2,0,0],[2,1,HEIGHT],[2,2,-1]]]})";
    const auto with = [&](const std::string& height) {
        std::string s = surface;
        return s.replace(s.find("HEIGHT"), 6, height);
    };
    const Json line =
        Json::parse(run({"continuity", "-", "--json"}, with("7")).out)["objects"][0]["axes"][0][0];
    EXPECT_EQ(line["c_order"], 0);
    EXPECT_NEAR(line["first_c_jump"]["size"], 1, 1e-13);  // slopes 3 and 4 of the middle row
    EXPECT_EQ(
        Json::parse(run({"continuity", "-", "--json"}, with("6")).out)["objects"][0]["axes"][0][0]["c_order"],
        1);

    const std::string triangle = R"({"type": "triangle", "degree": 1, "points": [[0,0,0],[1,0,0],[0,1,0]]})";
    const Ran none = run({"continuity", "-", "--json"}, triangle);
    EXPECT_EQ(none.code, 1);
    EXPECT_EQ(Json::parse(none.out)["error"]["kind"], "no_answer");
    const Json both = Json::parse(run({"continuity", "-", "--json"},
                                      R"({"freiform": 1, "objects": [)" + triangle + "," + kSpline + "]}")
                                      .out);
    EXPECT_TRUE(both["objects"][0].contains("skipped"));
    EXPECT_EQ(both["objects"][1]["knots"].size(), 3u);
}

TEST_F(ContinuityCommand, refuses_wrong_options) {
    EXPECT_EQ(run({"continuity", "-", "--tolerance", "-1"}, kSpline).code, 2);
    EXPECT_EQ(run({"continuity", "-", "--tolerance", "x"}, kSpline).code, 2);
    EXPECT_EQ(run({"continuity", "-", "--orders", "26"}, kSpline).code, 2);
    EXPECT_EQ(run({"continuity"}).code, 2);
    EXPECT_EQ(run({"continuity", "-"}, "{").code, 3);
    EXPECT_EQ(run({"continuity", "missing.json"}).code, 5);
    EXPECT_EQ(run({"continuity", "-", "--object", "other"}, kSpline).code, 1);
}

TEST_F(ContinuityCommand, angle_and_orders_are_those_asked_for) {
    // Two lines that turn by two degrees where they meet.
    const double a = 2 * M_PI / 180;
    const std::string lines = file("lines.json", R"({"freiform": 1, "objects": [
        {"type": "curve", "points": [[0,0],[1,0]]},
        {"type": "curve", "points": [[1,0],[)" + std::to_string(1 + std::cos(a)) +
                                                     "," + std::to_string(std::sin(a)) + "]]}]}");
    const auto joint = [&](std::vector<std::string> more) {
        more.insert(more.begin(), {"continuity", lines, "--json"});
        return Json::parse(run(more).out, nullptr, false)["joints"][0];
    };
    EXPECT_EQ(joint({})["g_order"], 0);
    EXPECT_EQ(joint({"--angle", "1.5"})["g_order"], 0);
    EXPECT_GE(joint({"--angle", "2.5"})["g_order"].get<int>(), 1);
    EXPECT_NEAR(joint({})["first_g_jump"]["size"].get<double>(), a, 1e-5);
    EXPECT_EQ(joint({"--orders", "1"})["g_jumps"].size(), 2u);
    EXPECT_EQ(joint({"--orders", "2"})["g_jumps"].size(), 3u);
}

TEST_F(ContinuityCommand, a_seam_is_a_knot_and_a_knot_without_a_jump_can_be_removed) {
    const std::string ring =
        R"({"type": "curve", "degree": 2, "closed": true, "points": [[1,1],[-1,1],[-1,-1],[1,-1]]})";
    const Json all = Json::parse(run({"continuity", "-", "--json"}, ring).out);
    EXPECT_EQ(all["joints"].size(), 0u) << "the seam is not told twice";
    const Json knots = all["objects"][0]["knots"];
    ASSERT_EQ(knots.size(), 4u);
    EXPECT_EQ(std::count_if(knots.begin(), knots.end(), [](const Json& k) { return k["seam"] == true; }), 1);
    const std::string straight = R"({"type": "curve", "degree": 1, "knots": [0,0,1,2,2],
        "points": [[0,0],[1,1],[2,2]]})";
    EXPECT_EQ(
        Json::parse(run({"continuity", "-", "--json"}, straight).out)["objects"][0]["knots"][0]["removable"],
        true);
}

// Two patches, flat on the left and rising on the right, whose common edge is u end of the one and u
// start of the other; and a third that is beside the second along v, run the other way.
TEST_F(ContinuityCommand, reports_joints_of_neighbouring_surfaces) {
    const std::string patches = R"({"freiform": 1, "unit": "mm", "objects": [
      {"name": "left", "type": "surface", "points": [[[0,0,0],[0,2,0]],[[2,0,0],[2,2,0]]]},
      {"name": "right", "type": "surface", "points": [[[2,0,0],[2,2,0]],[[3,0,0],[3,2,0]],[[4,0,1],[4,2,2]]]},
      {"name": "up", "type": "surface", "points": [[[4,2,2],[4,4,5]],[[3,2,0],[3,4,0]],[[2,2,0],[2,4,0]]]},
      {"name": "line", "type": "curve", "points": [[9,9,9],[8,9,9]]}]})";
    const std::string path = file("patches.json", patches);
    const Json all = Json::parse(run({"continuity", path, "--json"}).out)["joints"];
    ASSERT_EQ(all.size(), 2u) << all;
    EXPECT_EQ(all[0]["first"], 0);
    EXPECT_EQ(all[0]["first_edge"], "u end");
    EXPECT_EQ(all[0]["second_edge"], "u start");
    EXPECT_EQ(all[0]["against"], false);
    EXPECT_EQ(all[0]["c_order"], 1);
    EXPECT_EQ(all[0]["g_order"], 1);
    // z = (1 + v) (x - 2)^2 / 4: curvature (1 + v) / 2, largest at v = 1.
    EXPECT_EQ(all[0]["first_g_jump"]["order"], 2);
    EXPECT_NEAR(all[0]["first_g_jump"]["size"], 1, all[0]["first_g_jump"]["bound"].get<double>());
    EXPECT_EQ(all[0]["first_g_jump"]["unit"], "1/mm");
    EXPECT_EQ(all[0]["first_g_jump"]["at"], 1);
    EXPECT_EQ(all[1]["first_edge"], "v end");
    EXPECT_EQ(all[1]["second_edge"], "v start");
    EXPECT_EQ(all[1]["against"], true);
    EXPECT_EQ(all[1]["g_order"], 0);
    const Ran words = run({"continuity", path});
    EXPECT_NE(words.out.find("\"left\" u end - objects[1] \"right\" u start"), std::string::npos)
        << words.out;
    EXPECT_NE(words.out.find("G2 by 1 1/mm at 1"), std::string::npos) << words.out;
    // A millimetre allows all of it.
    const Json wide = Json::parse(run({"continuity", path, "--json", "--tolerance", "3"}).out)["joints"];
    EXPECT_EQ(wide[0]["g_order"], 2);
}

// A floor of one patch, and beside it two of half its width, the second of which goes up at an angle.
TEST_F(ContinuityCommand, finds_surfaces_that_share_a_part_of_an_edge) {
    const std::string path = file("tiles.json", R"({"freiform": 1, "unit": "mm", "objects": [
      {"name": "floor", "type": "surface", "points": [[[0,0,0],[0,2,0]],[[2,0,0],[2,2,0]]]},
      {"name": "near", "type": "surface", "points": [[[2,0,0],[2,1,0]],[[3,0,0],[3,1,0]]]},
      {"name": "far", "type": "surface", "points": [[[2,2,0],[2,1,0]],[[3,2,1],[3,1,1]]]}]})");
    const Json all = Json::parse(run({"continuity", path, "--json"}).out)["joints"];
    ASSERT_EQ(all.size(), 2u) << all;
    EXPECT_EQ(all[0]["whole"], false);
    EXPECT_EQ(all[0]["first_on"], Json::parse("[0.0,0.5]"));
    EXPECT_EQ(all[0]["second_on"], Json::parse("[0.0,1.0]"));
    EXPECT_EQ(all[0]["g_order"], 2);
    EXPECT_EQ(all[1]["first_on"], Json::parse("[0.5,1.0]"));
    EXPECT_EQ(all[1]["against"], true);
    EXPECT_EQ(all[1]["g_order"], 0);
    EXPECT_NEAR(all[1]["first_g_jump"]["size"], std::atan(1.0), 1e-12);
    const Ran words = run({"continuity", path});
    EXPECT_NE(words.out.find("\"floor\" u end [0, 0.5] - objects[1] \"near\" u start [0, 1]"),
              std::string::npos)
        << words.out;
    EXPECT_NE(words.out.find("part of an edge"), std::string::npos) << words.out;
}

}  // namespace
}  // namespace freiform::test
