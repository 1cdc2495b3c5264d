#include "run.hpp"

#include <cmath>
#include <nlohmann/json.hpp>

namespace freiform::test {
namespace {

using Json = nlohmann::json;
using Cli = Program;

TEST_F(Cli, implicit_prints_the_equation_of_plane_curves) {
    const std::string parabola = R"({"type":"curve","points":[[0,0],[0.5,0],[1,1]]})";
    const Ran r = run({"implicit", "-", "--at", "0.5,0.25;0.5,0.3;0.5,0.2"}, parabola);
    ASSERT_EQ(r.code, 0) << r.err;
    EXPECT_NE(r.out.find("degree 2"), std::string::npos) << r.out;
    EXPECT_NE(r.out.find("x^2"), std::string::npos) << r.out;
    EXPECT_NE(r.out.find("at 0.5,0.25: zero"), std::string::npos) << r.out;
    const Json j =
        Json::parse(run({"implicit", "-", "--json", "--at", "0.5,0.25;0.5,0.3;0.5,0.2"}, parabola).out);
    const Json& one = j["results"][0];
    EXPECT_EQ(one["degree"], 2);
    EXPECT_EQ(one["traces"], 1);
    EXPECT_EQ(one["bound"], 0);
    double x2 = 0, y1 = 0, others = 0;
    for (const Json& t : one["terms"])
        (t["x"] == 2 && t["y"] == 0   ? x2
         : t["x"] == 0 && t["y"] == 1 ? y1
                                      : others) += std::abs(t["coefficient"].get<double>());
    EXPECT_EQ(x2, y1);
    EXPECT_GT(x2, 0);
    EXPECT_EQ(others, 0);
    EXPECT_EQ(one["signs"][0], 0);
    EXPECT_EQ(one["signs"][1].get<int>() * one["signs"][2].get<int>(), -1);
    EXPECT_EQ(run({"implicit", "-"}, R"({"type":"curve","points":[[0,0,1],[0.5,0,1]]})").code, 1);
    EXPECT_EQ(run({"implicit", "-", "--at", "1"}, parabola).code, 2);
}

TEST_F(Cli, conic_says_what_an_equation_is_and_writes_its_arcs) {
    const Json j = Json::parse(run({"conic", "--equation", "1,0,4,0,0,-4", "--json"}).out);
    EXPECT_EQ(j["type"], "ellipse");
    EXPECT_EQ(j["centre"], Json::parse("[0.0,0.0]"));
    EXPECT_EQ(std::abs(j["x"][0].get<double>()), 2);
    const Ran r = run({"conic", "--equation", "0,1,0,0,0,-1", "--box", "-3,-3,3,3", "-o", "h.json"});
    ASSERT_EQ(r.code, 0) << r.err;
    EXPECT_NE(r.out.find("hyperbola"), std::string::npos);
    EXPECT_NE(r.out.find("2 arcs"), std::string::npos);
    const Json at = Json::parse(run({"eval", "h.json", "--at", "0.3"}).out)["results"];
    ASSERT_EQ(at.size(), 2u);
    for (const Json& p : at) EXPECT_NEAR(p["point"][0].get<double>() * p["point"][1].get<double>(), 1, 1e-14);
    EXPECT_EQ(run({"conic", "--equation", "0,1,0,0,0,-1", "-o", "h.json"}).code, 1);
    EXPECT_NE(run({"conic", "--equation", "1,0,-1,0,0,0"}).out.find("crossing lines"), std::string::npos);
    EXPECT_EQ(run({"conic", "--equation", "1,0,-1"}).code, 2);
    EXPECT_EQ(run({"conic"}).code, 2);
}

TEST_F(Cli, conic_takes_points_and_circles) {
    ASSERT_EQ(run({"conic", "--points", "1,0,5;0,1,5;-1,0,5", "-o", "a.json"}).code, 0);
    const Json p = Json::parse(run({"eval", "a.json", "--at", "0.5"}).out)["results"][0]["point"];
    EXPECT_NEAR(p[1].get<double>(), 1, 1e-15);
    EXPECT_EQ(p[2], 5.0);
    EXPECT_EQ(run({"conic", "--points", "0,0;1,1;2,2"}).code, 3);
    EXPECT_NE(run({"conic", "--points", "5,0;0,5;-5,0;3,4;4,-3"}).out.find("circle"), std::string::npos);
    EXPECT_EQ(run({"conic", "--points", "0,0;1,0;2,0;0,1;0,3"}).code, 1);
    ASSERT_EQ(run({"conic", "--circle", "1,1,2", "--angles", "0,270", "-o", "c.json"}).code, 0);
    const Json e = Json::parse(run({"eval", "c.json", "--at", "1"}).out)["results"][0]["point"];
    EXPECT_NEAR(e[1].get<double>(), -1, 1e-14);
    EXPECT_EQ(run({"conic", "--circle", "1,1,-2"}).code, 2);
}

TEST_F(Cli, conic_through_five_points_in_order_is_the_arc_and_no_more) {
    const std::string half = "5,0;4,3;3,4;0,5;-5,0";
    const Json j = Json::parse(run({"conic", "--points", half, "--in-order", "--json"}).out);
    EXPECT_EQ(j["type"], "circle");
    EXPECT_EQ(j["arcs"], 1);
    EXPECT_EQ(j["at"][0], 0.0);
    EXPECT_EQ(j["at"][4], 1.0);
    EXPECT_LT(j["points_bound"].get<double>(), 1e-13);
    const Ran r = run({"conic", "--points", half, "--in-order", "-o", "half.json"});
    ASSERT_EQ(r.code, 0) << r.err;
    EXPECT_NE(r.out.find("an arc of a circle, passes the points within "), std::string::npos) << r.out;
    const double pi = 3.14159265358979323846;
    EXPECT_NEAR(Json::parse(run({"length", "half.json", "--json"}).out)["value"].get<double>(), 5 * pi,
                1e-12);
    for (std::size_t i = 0; i < 5; ++i) {
        const double at = j["at"][i].get<double>();
        const Json p =
            Json::parse(run({"eval", "half.json", "--at", Json(at).dump()}).out)["results"][0]["point"];
        const double x[] = {5, 4, 3, 0, -5}, y[] = {0, 3, 4, 5, 0};
        EXPECT_NEAR(p[0].get<double>(), x[i], 1e-13) << i;
        EXPECT_NEAR(p[1].get<double>(), y[i], 1e-13) << i;
    }
    // The same circle in another order; three points; a box.
    const Ran other = run({"conic", "--points", "5,0;0,5;-5,0;3,4;4,-3", "--in-order"});
    EXPECT_EQ(other.code, 1);
    EXPECT_NE(other.err.find("passes them in another order"), std::string::npos) << other.err;
    EXPECT_EQ(run({"conic", "--points", "1,0;0,1;-1,0", "--in-order"}).code, 2);
    EXPECT_EQ(run({"conic", "--points", half, "--in-order", "--box", "0,0,1,1"}).code, 2);
    EXPECT_EQ(run({"conic", "--circle", "0,0,1", "--in-order"}).code, 2);
}

TEST_F(Cli, conic_reports_the_bound_and_the_number_of_its_arcs) {
    const Json two = Json::parse(
        run({"conic", "--equation", "0,1,0,0,0,-1", "--box", "-3,-3,3,3", "-o", "h.json", "--json"}).out);
    EXPECT_EQ(two["type"], "hyperbola");
    EXPECT_EQ(two["arcs"], 2);
    EXPECT_GT(two["arc_bound"].get<double>(), 0);
    EXPECT_LT(two["arc_bound"].get<double>(), 1e-13);
    const Ran one = run({"conic", "--circle", "1,1,2", "--angles", "0,270", "-o", "c.json"});
    EXPECT_NE(one.out.find("1 arc within "), std::string::npos) << one.out;
    // An ellipse with the half axes 2 along x and 1 along y: x^2 / 4 + y^2 = 1.
    const Json e = Json::parse(run({"conic", "--equation", "1,0,4,0,0,-4", "--json"}).out);
    EXPECT_NEAR(std::hypot(e["x"][0].get<double>(), e["x"][1].get<double>()), 2, e["bound"].get<double>());
    EXPECT_NEAR(std::hypot(e["y"][0].get<double>(), e["y"][1].get<double>()), 1, e["bound"].get<double>());
}

TEST_F(Cli, implicit_equations_vanish_on_the_curve_and_words_say_what_json_does) {
    // x = t, y = t^2: x^2 - y, up to a factor.
    const std::string parabola = R"({"type":"curve","points":[[0,0],[0.5,0],[1,1]]})";
    const Json one = Json::parse(run({"implicit", "-", "--json"}, parabola).out)["results"][0];
    for (const double t : {0.25, 0.75, 3.0}) {
        double sum = 0, size = 0;
        for (const Json& term : one["terms"]) {
            const double x = term["coefficient"].get<double>() * std::pow(t, term["x"].get<int>()) *
                             std::pow(t * t, term["y"].get<int>());
            sum += x, size += std::abs(x);
        }
        EXPECT_EQ(sum, 0) << t;
        EXPECT_GT(size, 0) << t;
    }
    const std::string words = run({"implicit", "-", "--at", "0.5,0.3;0.5,0.2;0.5,0.25"}, parabola).out;
    const auto place = [&](const char* part) { return words.find(part); };
    EXPECT_NE(place("at 0.5,0.25: zero"), std::string::npos) << words;
    EXPECT_NE(place("at 0.5,0.3: positive") == std::string::npos,
              place("at 0.5,0.3: negative") == std::string::npos);
    EXPECT_NE(place("at 0.5,0.3: positive") == std::string::npos,
              place("at 0.5,0.2: positive") == std::string::npos);
}

}  // namespace
}  // namespace freiform::test
