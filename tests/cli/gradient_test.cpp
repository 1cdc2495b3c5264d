#include "run.hpp"

#include <nlohmann/json.hpp>

namespace freiform::test {
namespace {

using GradientProgram = Program;

const std::string kMesh = std::string(FREIFORM_SOURCE_DIR) + "/examples/mesh_gradient.json";

TEST_F(GradientProgram, writes_colours_in_every_form) {
    EXPECT_EQ(run({"gradient", "#000", "#fff", "--space", "srgb"}).out,
              "linear-gradient(90deg, #000000 0%, #ffffff 100%)\n");
    const auto stops =
        nlohmann::json::parse(run({"gradient", "#f00", "#00f", "--space", "oklch", "--json"}).out)["stops"];
    EXPECT_GT(stops.size(), 10u);
    EXPECT_EQ(stops[0]["colour"], "#ff0000");
    EXPECT_EQ(stops.back()["at"], 1.0);
    ASSERT_EQ(
        run({"gradient", "#f00", "#0f08", "#00f", "--at", "0,1,4", "--way", "smooth", "-o", "s.svg"}).code,
        0);
    const std::string svg = content(path("s.svg"));
    EXPECT_NE(svg.find("offset=\"0.25\""), svg.npos) << svg;
    EXPECT_NE(svg.find("stop-opacity"), svg.npos);
    const std::string badge = std::string(FREIFORM_SOURCE_DIR) + "/examples/badge.svg";
    ASSERT_EQ(
        run({"gradient", "#f00", "#00f", "--along", badge, "--object", "plate", "-o", "along.svg"}).code, 0);
    EXPECT_NE(content(path("along.svg")).find("<polyline"), std::string::npos);
    ASSERT_EQ(run({"gradient", "--mesh", kMesh, "-o", "m.svg"}).code, 0);
    EXPECT_NE(content(path("m.svg")).find("<path fill=\"#"), std::string::npos);
}

TEST_F(GradientProgram, refuses_what_is_no_gradient) {
    EXPECT_EQ(run({"gradient"}).code, 2);
    EXPECT_EQ(run({"gradient", "#f00", "#00f", "--at", "0"}).code, 2);
    EXPECT_EQ(run({"gradient", "#f00", "#00f", "-o", "x.gif"}).code, 2);
    EXPECT_EQ(run({"gradient", "#f00", "blue"}).code, 2);
    EXPECT_EQ(run({"gradient", "#f00"}).code, 2);
    EXPECT_EQ(run({"gradient", "--mesh", kTeapot, "-o", "x.svg"}).code, 3);
}

}  // namespace
}  // namespace freiform::test
