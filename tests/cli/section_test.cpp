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
