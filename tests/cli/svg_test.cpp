#include "run.hpp"

#include <nlohmann/json.hpp>

namespace freiform::test {
namespace {

using SvgProgram = Program;
using SvgJson = nlohmann::json;

TEST_F(SvgProgram, reads_drawings_as_curves_and_writes_them_back) {
    const std::string badge = std::string(FREIFORM_SOURCE_DIR) + "/examples/badge.svg";
    const Ran info = run({"info", badge, "--json"});
    ASSERT_EQ(info.code, 0) << info.err;
    const auto all = SvgJson::parse(info.out);
    EXPECT_EQ(all["unit"], "mm");
    EXPECT_EQ(all["counts"]["curve"], 8);
    EXPECT_EQ(all["objects"][0]["name"], "plate");
    EXPECT_FALSE(all.contains("left_out"));
    // The plate is 72 x 52 with corners of radius 8.
    const auto length = SvgJson::parse(run({"length", badge, "--object", "plate", "--json"}).out);
    EXPECT_NEAR(length["value"].get<double>(), 2 * (72 + 52) - 64 + 16 * 3.14159265358979, 1e-9) << length;
    ASSERT_EQ(run({"convert", badge, "-o", "badge.json"}).code, 0);
    const Ran back = run({"convert", "badge.json", "-o", "badge.svg", "--json"});
    ASSERT_EQ(back.code, 0) << back.err;
    EXPECT_EQ(SvgJson::parse(back.out)["error_bound"], 0.0);
    const auto again = SvgJson::parse(run({"info", "badge.svg", "--json"}).out);
    for (std::size_t i = 0; i < 8; ++i)
        for (const char* side : {"min", "max"})
            for (std::size_t k = 0; k < 2; ++k)
                EXPECT_NEAR(again["objects"][i]["box"][side][k].get<double>(),
                            all["objects"][i]["box"][side][k].get<double>(), 1e-12);
    // From SVG to SVG styles are kept.
    ASSERT_EQ(run({"convert", badge, "-o", "styled.svg"}).code, 0);
    const std::string styled = content(path("styled.svg"));
    EXPECT_NE(styled.find("stroke-dasharray=\"3 1\""), styled.npos) << styled;
    EXPECT_NE(styled.find("fill=\"#e0b020\""), styled.npos);
}

TEST_F(SvgProgram, says_what_it_leaves_out_and_refuses_what_is_damaged) {
    const Ran some = run({"info", "-", "--json"}, "<svg><text id='t'>hi</text><path d='M 0 0 L 1 1'/></svg>");
    ASSERT_EQ(some.code, 0) << some.err;
    EXPECT_EQ(SvgJson::parse(some.out)["left_out"][0]["where"], "line 1: <text id=\"t\">");
    EXPECT_NE(some.err.find("line 1: <text id=\"t\">"), some.err.npos) << some.err;
    const Ran broken = run({"info", "-"}, "<svg><path d='M 0 0");
    EXPECT_EQ(broken.code, 3);
    EXPECT_NE(broken.err.find("this is not XML"), broken.err.npos) << broken.err;
    const Ran solid = run({"convert", kTeapot, "-o", "t.svg"});
    EXPECT_EQ(solid.code, 3);
    EXPECT_NE(solid.err.find("SVG holds plane curves"), solid.err.npos) << solid.err;
}

}  // namespace
}  // namespace freiform::test
