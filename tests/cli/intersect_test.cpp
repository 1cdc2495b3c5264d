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

// The parts of the arch over [3/4, 1/4], backwards, and over [1/2, 3/2], beyond its end.
TEST_F(IntersectCommand, curves_with_a_common_part_overlap_there_and_nowhere_else) {
    const std::string arch = file("arch.json", R"({"type": "curve", "points": [[0,0],[1,2],[3,2],[4,0]]})");
    const auto part = [&](const char* name, const char* points) {
        const Ran r =
            run({"intersect", arch, file(name, R"({"type": "curve", "points": )" + std::string(points) + "}"),
                 "--json"});
        EXPECT_EQ(r.code, 0) << r.err;
        const auto all = nlohmann::json::parse(r.out);
        EXPECT_TRUE(all["points"].empty() && all["possible"].empty()) << r.out;
        EXPECT_EQ(all["overlaps"].size(), 1u) << r.out;
        return all["overlaps"][0];
    };
    using Range = std::vector<double>;
    const auto back = part("back.json", "[[3.09375,1.125],[2.40625,1.625],[1.59375,1.625],[0.90625,1.125]]");
    EXPECT_EQ(back["a"], (Range{0.25, 0.75}));
    EXPECT_EQ(back["b"], (Range{0, 1}));
    EXPECT_EQ(back["reversed"], true);
    EXPECT_EQ(back["gap"], 0.0);
    const auto on = part("on.json", "[[2,1.5],[3.5,1.5],[5,-0.5],[4.5,-4.5]]");
    EXPECT_EQ(on["a"], (Range{0.5, 1}));
    EXPECT_EQ(on["b"], (Range{0, 0.5}));
    EXPECT_EQ(on["reversed"], false);
    EXPECT_NE(run({"intersect", arch, path("on.json")}).out.find("overlap over [0.5, 1] and [0, 0.5]"),
              std::string::npos);
}

// Rectangles of one plane: [0, 2] x [0, 1] and [1, 3] x [1/2, 2].
TEST_F(IntersectCommand, surfaces_that_overlap_say_over_which_parameters) {
    const std::string low = file("low.json", R"({"type": "surface", "degrees": [1, 1],
        "points": [[[0,0,0],[0,1,0]],[[2,0,0],[2,1,0]]]})");
    const std::string high = file("high.json", R"({"type": "surface", "degrees": [1, 1],
        "points": [[[1,0.5,0],[1,2,0]],[[3,0.5,0],[3,2,0]]]})");
    const Ran r = run({"intersect", low, high, "--tolerance", "1e-6", "--json"});
    ASSERT_EQ(r.code, 0) << r.err;
    const auto all = nlohmann::json::parse(r.out);
    EXPECT_TRUE(all["curves"].empty());
    int regions = 0;
    for (const auto& node : all["nodes"]) {
        EXPECT_EQ(node["kind"] == "overlap", !node["overlaps"].empty()) << node;
        for (const auto& o : node["overlaps"]) {
            ++regions;
            EXPECT_LE(o["gap"], 1e-6);
            for (const auto& [side, lo, hi] : {std::tuple("a", std::array{0.5, 0.5}, std::array{1.0, 1.0}),
                                               {"b", std::array{0.0, 0.0}, std::array{0.5, 1.0 / 3}}})
                for (std::size_t d = 0; d < 2; ++d) {
                    double least = 9, most = -9;
                    for (const auto& corner : o[side]) {
                        least = std::min(least, corner[d].get<double>());
                        most = std::max(most, corner[d].get<double>());
                    }
                    EXPECT_NEAR(least, lo[d], 1e-12) << side << d;
                    EXPECT_NEAR(most, hi[d], 1e-12) << side << d;
                }
        }
    }
    EXPECT_GT(regions, 0);
    EXPECT_NE(run({"intersect", low, high}).out.find("overlap at"), std::string::npos);
}

// A box [0, 2] x [0, 1] x [0, 1] of six faces.
class IntersectBox : public IntersectCommand {
protected:
    std::string box() {
        const std::string outline = file("outline.json", R"({"type": "curve", "degree": 1,
            "knots": [0,0,1,2,3,4,4], "points": [[0,0],[2,0],[2,1],[0,1],[0,0]]})");
        EXPECT_EQ(run({"extrude", outline, "--by", "0,0,1", "--solid", "-o", "box.step"}).code, 0);
        return path("box.step");
    }
};

TEST_F(IntersectBox, branches_over_its_faces_are_one_closed_chain) {
    const std::string wall = file("wall.json", R"({"type": "surface", "degrees": [1, 1],
        "points": [[[-1,-1,0.25],[-1,2,0.5]],[[3,-1,0.25],[3,2,0.5]]]})");
    const Ran r = run({"intersect", box(), wall, "--tolerance", "1e-6", "--json"});
    ASSERT_EQ(r.code, 0) << r.err;
    const auto all = nlohmann::json::parse(r.out);
    ASSERT_EQ(all["curves"].size(), 4u);
    ASSERT_EQ(all["chains"].size(), 1u);
    const auto& chain = all["chains"][0];
    EXPECT_EQ(chain["closed"], true);
    EXPECT_LE(chain["gap"], 1e-6);
    // Each begins where the one before it ends.
    std::vector<int> order = chain["curves"];
    ASSERT_EQ(order.size(), 4u);
    const std::vector<int> turned = chain["reversed"];
    using Point = std::array<double, 3>;
    const auto end = [&](int c, bool last) -> Point {
        const auto& points = all["curves"][std::size_t(c)]["curve"]["points"];
        return last != (std::ranges::find(turned, c) != turned.end()) ? points.back() : points.front();
    };
    for (std::size_t i = 0; i < 4; ++i) {
        const Point here = end(order[i], true), next = end(order[(i + 1) % 4], false);
        for (std::size_t d = 0; d < 3; ++d) EXPECT_NEAR(here[d], next[d], 1e-9);
    }
    std::ranges::sort(order);
    EXPECT_EQ(order, (std::vector<int>{0, 1, 2, 3}));
    EXPECT_NE(run({"intersect", box(), wall}).out.find("4 branches are one closed curve"), std::string::npos);
}

// From above through two faces; from inside through one; beside; along the upper face.
TEST_F(IntersectBox, rays_begin_at_their_point_and_overlap_the_face_that_they_run_in) {
    const std::string rays = file("rays.csv",
                                  "px,py,pz,dx,dy,dz\n0.5,0.5,3,0,0,-2\n0.5,0.5,0.5,1,0,0\n"
                                  "5,5,5,1,0,0\n-1,0.5,1,2,0,0\n");
    const auto places = [&](const char* mode) {
        const Ran r = run({"intersect", box(), mode, rays, "--json"});
        EXPECT_EQ(r.code, 0) << r.err;
        const auto all = nlohmann::json::parse(r.out);
        EXPECT_EQ(all["overlaps"].size(), 1u) << r.out;
        EXPECT_EQ(all["overlaps"][0]["ray"], 3);
        EXPECT_NEAR(all["overlaps"][0]["b"][0].get<double>(), 0.5, 1e-9);
        EXPECT_NEAR(all["overlaps"][0]["b"][1].get<double>(), 1.5, 1e-9);
        std::vector<std::vector<double>> at(4);
        for (const auto& p : all["points"]) {
            // Multiples of a half; parameters next to these give the same points.
            const double b = p["b"][0], exact = std::round(2 * b) / 2;
            if (p["proven"]) {
                EXPECT_LE(p["b_box"][0][0].get<double>(), exact) << p;
                EXPECT_GE(p["b_box"][0][1].get<double>(), exact) << p;
            }
            at[p["ray"].get<std::size_t>()].push_back(p["b"][0]);
            EXPECT_EQ(p["kind"], p["ray"] == 3 ? "end" : "crossing") << p;
            EXPECT_EQ(p["proven"], p["ray"] != 3) << p;
        }
        for (auto& list : at) std::ranges::sort(list);
        return at;
    };
    const auto by_rays = places("--rays"), by_lines = places("--lines");
    const auto expect = [](const std::vector<double>& found, const std::vector<double>& at) {
        ASSERT_EQ(found.size(), at.size());
        for (std::size_t i = 0; i < at.size(); ++i) EXPECT_DOUBLE_EQ(found[i], at[i]);
    };
    expect(by_rays[0], {1, 1.5});
    expect(by_rays[1], {1.5});
    expect(by_lines[1], {-0.5, 1.5});
    EXPECT_TRUE(by_rays[2].empty() && by_lines[2].empty());
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
