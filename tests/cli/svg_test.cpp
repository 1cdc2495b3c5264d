#include "run.hpp"

#include <algorithm>
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
    EXPECT_EQ(solid.code, 1) << "the file was read";
    EXPECT_NE(solid.err.find("SVG holds plane curves"), solid.err.npos) << solid.err;
}

// Unless it is said how near, a millionth of the size, whatever the unit.
TEST_F(SvgProgram, approximates_small_and_large_curves_alike) {
    std::size_t segments = 0;
    for (const double size : {1e-9, 1.0, 1e9}) {
        const SvgJson quintic = {{"freiform", 1},
                                 {"objects",
                                  {{{"type", "curve"},
                                    {"degree", 5},
                                    {"points",
                                     {{0, 0},
                                      {size, 2 * size},
                                      {2 * size, -size},
                                      {3 * size, size},
                                      {4 * size, 3 * size},
                                      {5 * size, 0}}}}}}};
        file("quintic.json", quintic.dump());
        const Ran ran = run({"convert", "quintic.json", "-o", "quintic.svg", "--json"});
        ASSERT_EQ(ran.code, 0) << ran.err;
        const double bound = SvgJson::parse(ran.out)["error_bound"].get<double>();
        EXPECT_GT(bound, 1e-8 * size);
        EXPECT_LE(bound, 6.41e-6 * size);
        const std::string svg = content(path("quintic.svg"));
        const auto count = std::size_t(std::ranges::count(svg, 'C'));
        if (segments > 0) EXPECT_EQ(count, segments) << size;
        segments = count;
    }
}

}  // namespace
}  // namespace freiform::test
