#include "run.hpp"

#include <nlohmann/json.hpp>

namespace freiform::test {
namespace {

using Inside = Program;

TEST_F(Inside, a_trimmed_face_is_asked_by_parameters) {
    const std::string face = file("face.json", R"({"type": "trimmed",
        "surface": {"degrees": [1, 1], "points": [[[0,0,0],[0,1,0]],[[1,0,0],[1,1,0]]]},
        "loops": [[{"degree": 1, "points": [[0.25,0.25],[0.75,0.25]]}, {"degree": 1, "points": [[0.75,0.25],[0.5,0.75]]},
                   {"degree": 1, "points": [[0.5,0.75],[0.25,0.25]]}]]})");
    const Ran r = run({"inside", face, "--points", file("p.csv", "0.5,0.5\n0.1,0.25\n0.5,0.25\n"), "--json"});
    ASSERT_EQ(r.code, 0) << r.out << r.err;
    const auto results = nlohmann::json::parse(r.out)["results"];
    EXPECT_EQ(results[0]["place"], "inside");
    EXPECT_EQ(results[1]["place"], "outside");
    EXPECT_EQ(results[2]["place"], "boundary");
}

TEST_F(Inside, a_closed_curve_is_asked_by_points_and_an_open_one_has_no_inside) {
    const std::string points = file("p.csv", "0 0\n2 0\n");
    const Ran closed = run({"inside", file("c.json", R"({"type": "curve", "degree": 2, "closed": true,
        "points": [[1,1],[-1,1],[-1,-1],[1,-1]]})"),
                            "--points", points});
    EXPECT_EQ(closed.code, 0) << closed.err;
    EXPECT_EQ(closed.out, "inside\noutside\n");
    const Ran open = run({"inside", file("o.json", R"({"type": "curve", "points": [[1,1],[-1,1],[-1,-1]]})"),
                          "--points", points, "--json"});
    EXPECT_EQ(open.code, 1);
    EXPECT_NE(open.out.find("the loop is open"), std::string::npos) << open.out;
    EXPECT_EQ(run({"inside", path("o.json"), "--points", file("q.csv", "1,2,3\n")}).code, 1);
    EXPECT_EQ(run({"inside", path("o.json")}).code, 2);
}

TEST_F(Inside, ends_that_rounding_keeps_apart_are_closed) {
    const std::string points = file("p.csv", "0.5 0.2\n2 0\n");
    for (const char* last : {"[1,-2.4e-16]], \"weights\": [1,2,3,1]", "[1,0]], \"weights\": [0.3,2,3,0.7]"}) {
        const std::string curve =
            std::string(R"({"type": "curve", "points": [[1,0],[1,3],[-4,1],)") + last + "}";
        const Ran r = run({"inside", file("c.json", curve), "--points", points});
        EXPECT_EQ(r.code, 0) << r.err;
        EXPECT_EQ(r.out, "inside\noutside\n");
    }
    const Ran open =
        run({"inside", file("o.json", R"({"type": "curve", "points": [[1,0],[1,3],[-4,1],[1,1e-6]]})"),
             "--points", points});
    EXPECT_EQ(open.code, 1);
}

TEST_F(Inside, a_solid_is_asked_by_points_of_space) {
    const std::string model = std::string(FREIFORM_SOURCE_DIR) + "/examples/bracket.step";
    const Ran r = run({"inside", model, "--points", file("p.csv", "x,y,z\n1e6,0,0\n"), "--json"});
    ASSERT_EQ(r.code, 0) << r.out << r.err;
    const auto results = nlohmann::json::parse(r.out)["results"];
    EXPECT_EQ(results[0]["place"], "outside");
    EXPECT_GT(results[0]["distance_at_least"].get<double>(), 1e5);
}

}  // namespace
}  // namespace freiform::test
