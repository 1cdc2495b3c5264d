#include "run.hpp"

#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

namespace freiform::test {
namespace {

using Json = nlohmann::json;
using FlattenCommand = Program;
using LengthCommand = Program;

const std::string kArch = R"({"type": "curve", "degree": 3, "points": [[0,0],[1,2],[3,2],[4,0]]})";

Json parsed(const Ran& r) {
    EXPECT_EQ(r.code, 0) << r.err;
    return Json::parse(r.out, nullptr, false);
}
std::string kind_of(const Ran& r) {
    return Json::parse(r.out, nullptr, false).value("error", Json::object()).value("kind", "");
}

TEST_F(FlattenCommand, polylines_are_json_with_points_parameters_and_the_bound) {
    for (const char* method : {"adaptive", "uniform", "forward", "halving"}) {
        const Json all = parsed(run({"flatten", "-", "--tolerance", "0.01", "--method", method}, kArch));
        ASSERT_EQ(all["objects"].size(), 1u);
        const Json& line = all["objects"][0];
        ASSERT_EQ(line["points"].size(), line["parameters"].size());
        EXPECT_GT(line["points"].size(), 10u);
        EXPECT_LE(line["error_bound"].get<double>(), 0.01);
        EXPECT_EQ(line["points"][0], Json::array({0.0, 0.0}));
        EXPECT_EQ(line["points"].back(), Json::array({4.0, 0.0}));
        EXPECT_EQ(line["parameters"].back(), 1.0);
    }
    const Json three = parsed(run({"flatten", kExample, "--tolerance", "0.1"}));
    ASSERT_EQ(three["objects"].size(), 3u);
    EXPECT_EQ(three["objects"][2]["name"], "circle");
    EXPECT_EQ(three["objects"][1]["closed"], true);
}

TEST_F(FlattenCommand, writes_csv_and_svg) {
    ASSERT_EQ(run({"flatten", kExample, "--tolerance", "0.1", "-o", "c.csv"}).code, 0);
    EXPECT_TRUE(content(path("c.csv")).starts_with("object,parameter,x,y\n0,0,0,0\n"));
    ASSERT_EQ(run({"flatten", kExample, "--segments", "12", "-o", "c.svg"}).code, 0);
    const std::string svg = content(path("c.svg"));
    EXPECT_TRUE(svg.starts_with("<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox="));
    EXPECT_NE(svg.find("Z\"/>"), std::string::npos) << "the closed curve is closed";
    const Ran space = run({"flatten", "-", "--tolerance", "1", "-o", "c3.svg"},
                          R"({"type": "curve", "degree": 1, "points": [[0,0,0],[1,1,1]]})");
    EXPECT_EQ(space.code, 1);
    EXPECT_FALSE(std::filesystem::exists(path("c3.svg")));
}

TEST_F(FlattenCommand, compares_the_methods_at_equal_effort) {
    const Json all = parsed(run({"flatten", "-", "--compare", "16", "--json"}, kArch));
    const Json& rows = all["objects"][0]["methods"];
    ASSERT_EQ(rows.size(), 5u);
    for (const Json& row : rows) EXPECT_LE(row["measured"].get<double>(), row["error_bound"].get<double>());
    EXPECT_NE(run({"flatten", "-", "--compare", "16"}, kArch).out.find("halving, polygons"),
              std::string::npos);
}

TEST_F(FlattenCommand, refuses_with_the_exit_codes_of_the_contract) {
    EXPECT_EQ(run({"flatten", kExample}).code, 2);
    EXPECT_EQ(run({"flatten", kExample, "--tolerance", "0"}).code, 2);
    EXPECT_EQ(run({"flatten", kExample, "--tolerance", "1", "--segments", "4"}).code, 2);
    EXPECT_EQ(run({"flatten", kExample, "--tolerance", "1", "--polygons"}).code, 2);
    EXPECT_EQ(run({"flatten", kExample, "--tolerance", "1", "-o", "c.dxf"}).code, 2);
    const Ran word = run({"flatten", kExample, "--tolerance", "1", "--method", "halfing"});
    EXPECT_EQ(word.code, 2);
    EXPECT_NE(word.err.find("halving"), std::string::npos) << word.err;
    const Ran fine = run({"flatten", kExample, "--tolerance", "1e-15", "--json"});
    EXPECT_EQ(fine.code, 1);
    EXPECT_EQ(kind_of(fine), "ill_conditioned");
    const Ran many = run({"flatten", "-", "--tolerance", "1e-9", "--method", "uniform", "--json"},
                         R"({"type": "curve", "points": [[0,0],[1e7,2e7],[3e7,2e7],[4e7,0]]})");
    EXPECT_EQ(many.code, 1) << many.out;
    EXPECT_EQ(run({"flatten", kTeapot, "--tolerance", "1", "--json"}).code, 1);
    EXPECT_EQ(run({"flatten", "absent.json", "--tolerance", "1"}).code, 5);
}

TEST_F(LengthCommand, prints_lengths_for_people_and_as_json) {
    const Ran text = run({"length", kExample});
    EXPECT_EQ(text.code, 0) << text.err;
    EXPECT_NE(text.out.find("mm (within "), std::string::npos) << text.out;
    EXPECT_NE(text.out.find("in all: "), std::string::npos) << text.out;
    const Json all = parsed(run({"length", kExample, "--json"}));
    EXPECT_NEAR(all["objects"][2]["value"].get<double>(), 32 * std::acos(-1.0), 1e-11);
    double sum = 0;
    for (const Json& o : all["objects"]) sum += o["value"].get<double>();
    EXPECT_NEAR(all["value"].get<double>(), sum, 1e-11);
    EXPECT_LT(all["bound"].get<double>(), 1e-10);
}

TEST_F(LengthCommand, finds_places_at_lengths_and_at_equal_distance) {
    for (const std::vector<std::string>& words : std::vector<std::vector<std::string>>{
             {"length", "-", "--at", "1", "2.5", "--json"}, {"length", "--json", "--at", "1,2.5", "-"}}) {
        const Json all = parsed(run(words, kArch));
        const Json& at = all["objects"][0]["at"];
        ASSERT_EQ(at.size(), 2u);
        const double t = at[1]["parameter"].get<double>();
        const Json back = parsed(run({"length", "-", "--range", "0," + std::to_string(t), "--json"}, kArch));
        EXPECT_NEAR(back["value"].get<double>(), 2.5, 1e-5);
        EXPECT_EQ(at[1]["point"].size(), 2u);
        EXPECT_LT(at[1]["bound"].get<double>(), 1e-12);
    }
    const Json equal = parsed(run({"length", "-", "--equal", "7", "--json"}, kArch));
    EXPECT_EQ(equal["objects"][0]["at"].size(), 8u);
    const Json spaced = parsed(run({"length", "-", "--spacing", "0.5", "--json"}, kArch));
    EXPECT_EQ(spaced["objects"][0]["at"].size(), 11u);  // of 5.268
}

TEST_F(LengthCommand, writes_curves_by_their_arc_length) {
    const Json report =
        parsed(run({"length", kExample, "--reparametrise", "1e-4", "-o", "even.json", "--json"}));
    ASSERT_EQ(report["objects"].size(), 3u);
    for (const Json& o : report["objects"]) EXPECT_LE(o["error_bound"].get<double>(), 1e-4);
    const Json again = parsed(run({"length", path("even.json"), "--json"}));
    for (std::size_t i = 0; i < 3; ++i)
        EXPECT_NEAR(again["objects"][i]["value"].get<double>(), report["objects"][i]["length"].get<double>(),
                    1e-3);
    EXPECT_EQ(run({"length", kExample, "--reparametrise", "-1"}).code, 2);
}

TEST_F(LengthCommand, refuses_with_the_exit_codes_of_the_contract) {
    EXPECT_EQ(run({"length"}).code, 2);
    EXPECT_EQ(run({"length", kExample, "--at", "x"}).code, 2);
    EXPECT_EQ(run({"length", kExample, "--equal", "3", "--spacing", "1"}).code, 2);
    const Ran beyond = run({"length", "-", "--at", "6", "--json"}, kArch);
    EXPECT_EQ(beyond.code, 1);
    EXPECT_EQ(kind_of(beyond), "out_of_domain");
    EXPECT_EQ(run({"length", kTeapot}).code, 1);
}

TEST_F(FlattenCommand, each_method_puts_its_points_where_it_says) {
    const auto parameters = [&](const std::vector<std::string>& more) {
        std::vector<std::string> words{"flatten", "-"};
        words.insert(words.end(), more.begin(), more.end());
        const Json line = parsed(run(words, kArch))["objects"][0];
        EXPECT_EQ(line["segments"].get<std::size_t>() + 1, line["parameters"].size());
        return line["parameters"].get<std::vector<double>>();
    };
    const auto fewest = parameters({"--tolerance", "0.001"});
    for (const std::string method : {"uniform", "forward", "halving"}) {
        const auto t = parameters({"--tolerance", "0.001", "--method", method});
        EXPECT_GT(t.size(), fewest.size()) << method;
        for (std::size_t i = 0; i < t.size(); ++i)
            if (method == "halving")
                EXPECT_EQ(t[i] * 1024, std::floor(t[i] * 1024)) << "a dyadic number";
            else
                EXPECT_NEAR(t[i], double(i) / double(t.size() - 1), 1e-15) << method;
        EXPECT_EQ(parameters({"--segments", "12", "--method", method}).size(), 13u) << method;
    }
    EXPECT_LE(parameters({"--segments", "12"}).size(), 13u);
    EXPECT_GT(parameters({"--segments", "12"}).size(), 10u);
}

TEST_F(FlattenCommand, all_formats_hold_the_same_points_and_y_is_up) {
    const std::vector<std::string> words{"flatten", "-", "--tolerance", "0.1"};
    const auto as = [&](const std::string& format) {
        auto w = words;
        w.insert(w.end(), {"--to", format});
        return run(w, kArch).out;
    };
    const Json line = Json::parse(as("json"))["objects"][0];
    std::istringstream csv(as("csv"));
    std::string row;
    std::getline(csv, row);
    const std::string svg = as("svg");
    std::istringstream path(svg.substr(svg.find("d=\"M") + 4));
    for (std::size_t i = 0; i < line["points"].size(); ++i) {
        const double t = line["parameters"][i], x = line["points"][i][0], y = line["points"][i][1];
        double object = -1, a = -1, b = -1, c = -1;
        char comma = 0;
        csv >> object >> comma >> a >> comma >> b >> comma >> c;
        EXPECT_EQ(std::vector({object, a, b, c}), std::vector({0.0, t, x, y}));
        path >> a >> comma >> b;
        EXPECT_EQ(std::vector({a, b}), std::vector({x, -y})) << "y points down in SVG";
    }
}

TEST_F(LengthCommand, places_are_on_the_curve_at_the_lengths_they_say) {
    const std::string file = this->file("arch.json", kArch);
    const double all = parsed(run({"length", file, "--json"}))["value"];
    const auto ask = [&](const std::string& option, const std::string& value, std::size_t count,
                         double step) {
        const Json places = parsed(run({"length", file, option, value, "--json"}))["objects"][0]["at"];
        ASSERT_EQ(places.size(), count) << option;
        for (std::size_t k = 0; k < count; ++k) {
            const Json& place = places[k];
            EXPECT_NEAR(place["length"].get<double>(), std::min(all, step * double(k)), 1e-12) << option;
            const std::string t = place["parameter"].dump();
            const Json point = parsed(run({"eval", file, "--at", t}))["results"][0]["point"];
            EXPECT_EQ(place["point"], point) << option;
            if (k == 0) continue;
            EXPECT_NEAR(parsed(run({"length", file, "--range", "0," + t, "--json"}))["value"].get<double>(),
                        place["length"].get<double>(), 1e-12)
                << option;
        }
    };
    ask("--at", "0,0.5,1", 3, 0.5);
    ask("--equal", "3", 4, all / 3);
    ask("--spacing", "2", std::size_t(all / 2) + 1, 2);
}

}  // namespace
}  // namespace freiform::test
