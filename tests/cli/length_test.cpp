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

TEST_F(LengthCommand, places_on_a_part_are_counted_from_its_beginning_and_inside_it) {
    const auto at = [&](std::vector<std::string> how) {
        how.insert(how.begin(), {"length", "-", "--range", "0.2,0.6", "--json"});
        return Json::parse(run(how, kSegment).out)["objects"][0]["at"];
    };
    const Json thirds = at({"--equal", "4"}), spaced = at({"--spacing", "0.75"}), given = at({"--at", "0.5"});
    ASSERT_EQ(thirds.size(), 5u);
    for (std::size_t i = 0; i < 5; ++i) {
        EXPECT_NEAR(thirds[i]["length"].get<double>(), 0.5 * double(i), 1e-14);
        EXPECT_NEAR(thirds[i]["parameter"].get<double>(), 0.2 + 0.1 * double(i), 1e-14);
        EXPECT_NEAR(thirds[i]["point"][1].get<double>(), 4 * (0.2 + 0.1 * double(i)), 1e-14);
    }
    ASSERT_EQ(spaced.size(), 3u);  // 0, 0.75 and 1.5 of 2
    EXPECT_NEAR(spaced[2]["parameter"].get<double>(), 0.5, 1e-14);
    ASSERT_EQ(given.size(), 1u);
    EXPECT_NEAR(given[0]["parameter"].get<double>(), 0.3, 1e-14);
    EXPECT_EQ(run({"length", "-", "--range", "0.2,0.6", "--at", "2.5"}, kSegment).code, 1);
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
