#include "run.hpp"

#include <nlohmann/json.hpp>

namespace freiform::test {
namespace {

using Json = nlohmann::json;
using Cli = Program;

// A face on [0, 4] x [0, 4] with these polygons as loops, a segment for each side.
std::string face(const std::vector<std::vector<std::string>>& loops) {
    std::string s = R"({"type":"trimmed","surface":{"degrees":[1,1],"knots":[[0,0,4,4],[0,0,4,4]],
        "points":[[[0,0,0],[0,4,0]],[[4,0,0],[4,4,0]]]},"loops":[)";
    for (std::size_t l = 0; l < loops.size(); ++l) {
        s += l > 0 ? ",[" : "[";
        for (std::size_t i = 0; i < loops[l].size(); ++i)
            s += (i > 0 ? "," : "") + std::string("{\"points\":[") + loops[l][i] + "," +
                 loops[l][(i + 1) % loops[l].size()] + "]}";
        s += "]";
    }
    return s + "]}";
}
const std::vector<std::string> kClockwise = {"[0,0]", "[0,4]", "[4,4]", "[4,0]"},
                               kHole = {"[1,1]", "[2,1]", "[2,2]", "[1,2]"};

TEST_F(Cli, convert_turns_loops_by_their_depth_and_says_which) {
    const Ran r =
        run({"convert", "-", "--orient-loops", "-o", "f.json", "--json"}, face({kClockwise, kHole}));
    ASSERT_EQ(r.code, 0) << r.err;
    EXPECT_EQ(Json::parse(r.out)["turned_loops"].size(), 2u) << r.out;
    const Json loops = Json::parse(content(path("f.json")))["objects"][0]["loops"];
    EXPECT_EQ(loops[0][0]["points"], Json::parse("[[0.0,0.0],[4.0,0.0]]"));
    EXPECT_EQ(loops[1][0]["points"], Json::parse("[[1.0,1.0],[1.0,2.0]]"));
    const Ran again = run({"convert", "f.json", "--orient-loops", "-o", "g.json"});
    ASSERT_EQ(again.code, 0) << again.err;
    EXPECT_EQ(content(path("f.json")), content(path("g.json")));
    EXPECT_NE(again.err.find("as they should be"), std::string::npos) << again.err;
}

TEST_F(Cli, loops_that_cross_are_refused_with_the_place_when_they_are_read) {
    const Ran r = run({"info", "-"}, face({{"[0,0]", "[3,3]", "[3,0]", "[0,3]"}}));
    EXPECT_EQ(r.code, 3) << r.out;
    EXPECT_NE(r.err.find("loops[0][0]: crosses loops[0][2] at (1.5"), std::string::npos) << r.err;
}

}  // namespace
}  // namespace freiform::test
