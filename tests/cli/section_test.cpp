#include "run.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

namespace freiform::test {
namespace {

using SectionCommand = Program;
using SectionJson = nlohmann::json;

TEST_F(SectionCommand, cuts_the_teapot_into_curves) {
    const Ran r = run({"section", kTeapot, "--plane", "0,0,1,-1", "--tolerance", "1e-3", "--json", "-o",
                       "c.json", "--parameters"});
    ASSERT_EQ(r.code, 0) << r.out << r.err;
    const auto all = SectionJson::parse(r.out);
    ASSERT_FALSE(all["branches"].empty());
    EXPECT_TRUE(all["nodes"].empty() && all["overlaps"].empty());
    for (const auto& b : all["branches"]) {
        EXPECT_LE(b["bound"], 1e-3);
        const std::string curve = std::to_string(b["curve"].get<int>()),
                          parameters = std::to_string(b["curve"].get<int>() + 1);
        const Ran at = run({"eval", "c.json", "--object", curve, "--at", "0"});
        ASSERT_EQ(at.code, 0) << at.err;
        const auto p = SectionJson::parse(at.out)["results"][0]["point"];
        EXPECT_NEAR(p[2].get<double>(), 1, 1e-12);
        const auto uv = SectionJson::parse(run({"eval", "c.json", "--object", parameters, "--at", "0"}).out);
        EXPECT_EQ(uv["results"][0]["point"].size(), 2u);
    }
}

TEST_F(SectionCommand, takes_a_point_and_a_normal) {
    const std::string saddle =
        R"({"type":"surface","degrees":[1,1],"points":[[[-1,-1,1],[-1,1,-1]],[[1,-1,-1],[1,1,1]]]})";
    const Ran r = run({"section", "-", "--plane", "0,0,0,0,0,2", "-o", "c.json", "--json"}, saddle);
    ASSERT_EQ(r.code, 0) << r.err;
    const auto all = SectionJson::parse(r.out);
    EXPECT_EQ(all["branches"].size(), 4u) << r.out;
    ASSERT_EQ(all["nodes"].size(), 1u);
    EXPECT_EQ(all["nodes"][0]["kind"], "crossing");
    const Ran higher = run({"section", "-", "--plane", "7,8,0.5,0,0,-2", "-o", "d.json", "--json"}, saddle);
    EXPECT_EQ(SectionJson::parse(higher.out)["branches"].size(), 2u) << higher.err;
    const Ran at = run({"eval", "d.json", "--object", "0", "--at", "0.1"});
    EXPECT_NEAR(SectionJson::parse(at.out)["results"][0]["point"][2].get<double>(), 0.5, 1e-12) << at.err;
    const Ran nothing = run({"section", "-", "--plane", "0,0,9,0,0,2", "-o", "c.json"}, saddle);
    EXPECT_EQ(nothing.out, "the plane meets nothing\n");
}

TEST_F(SectionCommand, of_a_trimmed_face_ends_where_it_is_trimmed) {
    const std::string half = R"({"name": "half", "type": "trimmed", "surface": {"degrees": [1, 1],
        "points": [[[0,0,0],[0,1,0]],[[1,0,0],[1,1,0]]]}, "loops": [[{"degree": 1, "points": [[0,0],[1,0]]},
        {"degree": 1, "points": [[1,0],[0,1]]}, {"degree": 1, "points": [[0,1],[0,0]]}]]})";
    const Ran r = run({"section", "-", "--plane", "1,0,0,-0.25", "-o", "c.json", "--json"}, half);
    ASSERT_EQ(r.code, 0) << r.out << r.err;
    const auto all = SectionJson::parse(r.out);
    ASSERT_EQ(all["branches"].size(), 1u);
    EXPECT_EQ(all["branches"][0]["closed"], false);
    EXPECT_EQ(all["branches"][0]["faces"], (std::vector<int>{0}));
    const auto length = SectionJson::parse(run({"length", "c.json", "--json"}).out);
    EXPECT_NEAR(length["value"].get<double>(), 0.75, 1e-9);  // not 1: the surface goes on, the face does not
    ASSERT_EQ(run({"section", "-", "--plane", "1,0,0,-0.25", "-o", "c.svg"}, half).code, 0);
    EXPECT_EQ(run({"section", "-", "--plane", "1,0,0,-7", "-o", "d.svg"}, half).code, 1);
}

TEST_F(SectionCommand, of_a_solid_is_closed_and_has_an_area) {
    const std::string model = std::string(FREIFORM_SOURCE_DIR) + "/examples/bracket.step";
    const Ran r = run({"section", model, "--plane", "0,0,1,-5", "-o", "c.json", "--json"});
    ASSERT_EQ(r.code, 0) << r.out << r.err;
    const auto all = SectionJson::parse(r.out);
    EXPECT_EQ(all["models"][0]["open"], 0);
    EXPECT_GT(all["models"][0]["area"].get<double>(), 100);
    for (const auto& b : all["branches"]) EXPECT_EQ(b["closed"], true);
}

TEST_F(SectionCommand, refuses_what_it_does_not_cut) {
    const std::string curve = R"({"type":"curve","points":[[0,0,0],[1,1,1]]})";
    EXPECT_EQ(run({"section", "-", "--plane", "0,0,1,0"}, curve).code, 1);
    EXPECT_EQ(run({"section", kTeapot, "--plane", "0,0,1"}).code, 2);
    EXPECT_NE(run({"section", kTeapot, "--plane", "0,0,0,1"}).err.find("plane"), std::string::npos);
    EXPECT_NE(run({"section", kTeapot, "--plane", "0,0,1,0", "--tolerance", "0"}).err.find("tolerance"),
              std::string::npos);
}

}  // namespace
}  // namespace freiform::test
