#include "run.hpp"

#include <nlohmann/json.hpp>

namespace freiform::test {
namespace {

using Json = nlohmann::json;
using LengthCommand = Program;

const std::string kSegment = R"({"type": "curve", "name": "s", "points": [[0,0],[3,4]]})";
const std::string kTwo = R"({"freiform": 1, "unit": "mm", "objects": [
  {"name": "s", "type": "curve", "points": [[0,0],[3,4]]},
  {"type": "surface", "points": [[[0,0,0],[0,1,0]],[[1,0,0],[1,1,0]]]},
  {"name": "t", "type": "curve", "points": [[0,0,0],[0,0,2]]}]})";

TEST_F(LengthCommand, places_are_given_in_the_order_of_the_lengths_that_were_asked_for) {
    const Json r = Json::parse(run({"length", "-", "--at", "2.5,5", "0", "--json"}, kSegment).out);
    const Json at = r["objects"][0]["at"];
    ASSERT_EQ(at.size(), 3u);
    EXPECT_NEAR(at[0]["parameter"].get<double>(), 0.5, 1e-14);
    EXPECT_NEAR(at[1]["point"][1].get<double>(), 4, 1e-14);
    EXPECT_EQ(at[2]["length"], 0);
    EXPECT_NEAR(r["value"].get<double>(), 5, r["bound"].get<double>());
}

TEST_F(LengthCommand, a_part_has_its_own_length) {
    const Json r = Json::parse(run({"length", "-", "--range", "0,0.5", "--json"}, kSegment).out);
    EXPECT_NEAR(r["value"].get<double>(), 2.5, 1e-14);
    EXPECT_FALSE(r["objects"][0].contains("at"));
}

TEST_F(LengthCommand, lengths_of_several_curves_are_summed_and_what_is_no_curve_is_left_out) {
    const Ran r = run({"length", "-"}, kTwo);
    EXPECT_EQ(r.code, 0) << r.err;
    EXPECT_NE(r.out.find("in all: 7 mm"), std::string::npos) << r.out;
    EXPECT_NE(r.err.find("objects[1]: is a surface, not a curve, and left out"), std::string::npos) << r.err;
}

TEST_F(LengthCommand, a_refusal_names_the_object) {
    const Json one = Json::parse(run({"length", "-", "--at", "9", "--json"}, kSegment).out)["error"];
    EXPECT_EQ(one["where"], "standard input: length");
    const Json two = Json::parse(run({"length", "-", "--at", "3", "--json"}, kTwo).out)["error"];
    EXPECT_EQ(two["where"], "objects[2] \"t\": length");
    EXPECT_EQ(run({"length", "-", "--object", "1"}, kTwo).code, 1);
}

TEST_F(LengthCommand, a_curve_by_its_arc_length_comes_with_a_report) {
    const Ran r = run({"length", "-", "--reparametrise", "1e-6", "-o", "even.json"}, kSegment);
    EXPECT_EQ(r.code, 0) << r.err;
    EXPECT_NE(r.out.find("objects[0] \"s\": 1 pieces, within "), std::string::npos) << r.out;
    EXPECT_NEAR(Json::parse(content(path("even.json")))["objects"][0]["knots"].back().get<double>(), 5, 1e-5);
}

}  // namespace
}  // namespace freiform::test
