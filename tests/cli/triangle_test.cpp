#include "run.hpp"

#include <nlohmann/json.hpp>

namespace freiform::test {
namespace {

using Json = nlohmann::json;

const std::string kTriangle =
    R"({"name": "t", "type": "triangle", "degree": 2, "points": [[0,0,0],[1,0,1],[0,1,1],[2,0,0],[1,1,1],[0,2,0]]})";

class TriangleCommands : public Program {
protected:
    // The point of an object of a document.
    std::vector<double> point(const std::string& document, const std::string& object, const std::string& at) {
        const Ran r = run({"eval", document, "--object", object, "--at", at});
        const Json j = Json::parse(r.out, nullptr, false);
        EXPECT_EQ(r.code, 0) << r.err;
        return j["results"][0]["point"].get<std::vector<double>>();
    }
};

void expect_near(const std::vector<double>& a, const std::vector<double>& b) {
    ASSERT_EQ(a.size(), b.size());
    for (std::size_t i = 0; i < a.size(); ++i) EXPECT_NEAR(a[i], b[i], 1e-14);
}

TEST_F(TriangleCommands, convert_tells_formats_without_triangles_from_wrong_files) {
    for (const char* format : {"step", "iges", "obj", "svg", "bpt"})
        EXPECT_EQ(
            run({"convert", "-", "--to", format}, R"({"type":"triangle","points":[[0,0,0],[1,0,1],[0,1,1]]})")
                .code,
            1)
            << format;
}

TEST_F(TriangleCommands, convert_cuts_triangles_from_a_corner_to_the_opposite_edge) {
    const std::string s = file("t.json", kTriangle);
    struct Case {
        std::string axis, in_a, in_b, at;
    };
    for (const Case& c : {Case{"u", "1,0", "0,0", "0.25,0"},
                          {"v", "0,1", "0,0", "0,0.25"},
                          {"w", "0,1", "1,0", "0.75,0.25"}}) {
        const std::string out = path(c.axis + ".json");
        const Ran r = run({"convert", s, "--split", "0.25", "--axis", c.axis, "-o", out});
        ASSERT_EQ(r.code, 0) << r.err;
        expect_near(point(out, "t.a", c.in_a), point(s, "t", c.at));
        expect_near(point(out, "t.b", c.in_b), point(s, "t", c.at));
    }
    // Both keep the other corner.
    expect_near(point(path("u.json"), "t.a", "0,0"), point(s, "t", "0,0"));
    expect_near(point(path("u.json"), "t.b", "1,0"), point(s, "t", "1,0"));
    expect_near(point(path("v.json"), "t.a", "0,0"), point(s, "t", "0,0"));
}

TEST_F(TriangleCommands, convert_makes_surfaces_of_triangles_and_triangles_of_surfaces) {
    const std::string s = file("t.json", kTriangle);
    ASSERT_EQ(run({"convert", s, "--to-surfaces", "-o", path("three.json")}).code, 0);
    for (const char* part : {"t.0", "t.1", "t.2"})
        expect_near(point(path("three.json"), part, "1,1"),
                    point(s, "t", "0.3333333333333333,0.3333333333333333"));
    expect_near(point(path("three.json"), "t.1", "1,0"), point(s, "t", "0.5,0.5"));
    const std::string patch = file(
        "s.json",
        R"({"name": "s", "type": "surface", "degrees": [1,2], "points": [[[0,0,0],[0,1,0],[0,2,1]],[[1,0,0],[1,1,3],[1,2,0]]]})");
    ASSERT_EQ(run({"convert", patch, "--to-triangles", "-o", path("two.json")}).code, 0);
    expect_near(point(path("two.json"), "s.a", "0.25,0.5"), point(patch, "s", "0.25,0.5"));
    expect_near(point(path("two.json"), "s.b", "0.25,0.5"), point(patch, "s", "0.75,0.5"));
}

TEST_F(TriangleCommands, convert_raises_and_lowers_degrees_and_turns_triangles_over) {
    const std::string s = file("t.json", kTriangle);
    ASSERT_EQ(run({"convert", s, "--elevate", "2", "-o", path("four.json")}).code, 0);
    ASSERT_EQ(
        run({"convert", path("four.json"), "--reduce", "1e-9", "--reverse", "-o", path("back.json")}).code,
        0);
    const Json back = Json::parse(run({"info", path("back.json"), "--json"}).out);
    EXPECT_EQ(back["objects"][0]["degree"], 2);
    expect_near(point(path("back.json"), "t", "0.5,0.125"), point(s, "t", "0.125,0.5"));
    EXPECT_EQ(run({"convert", s, "--insert-knots", "0.5"}).code, 1);
    EXPECT_EQ(run({"convert", s, "--split", "1"}).code, 1);
    EXPECT_EQ(run({"convert", s, "--axis", "v", "--reverse"}).code, 1);
    EXPECT_EQ(run({"convert", "-", "--to-triangles"}, R"({"type": "curve", "points": [[0,0],[1,1]]})").code,
              1);
}

}  // namespace
}  // namespace freiform::test
