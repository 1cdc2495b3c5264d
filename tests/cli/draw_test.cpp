#include "run.hpp"

#include <nlohmann/json.hpp>

namespace freiform::test {
namespace {

using Json = nlohmann::json;
using Draw = Program;

const std::string kLine = R"({"type": "curve", "degree": 1, "points": [[0,0],[4,2]]})";

Json error_of(const Ran& r) { return Json::parse(r.out, nullptr, false).value("error", Json::object()); }

TEST_F(Draw, curves_become_svg_and_pdf) {
    const Ran svg = run({"draw", kExample, "-o", "c.svg", "--control", "--knots", "--comb", "--construction",
                         "0.4", "--width", "640", "--height", "480"});
    ASSERT_EQ(svg.code, 0) << svg.err;
    EXPECT_EQ(svg.out + svg.err, "");
    const std::string s = content(path("c.svg"));
    EXPECT_NE(s.find("viewBox=\"0 0 640 480\""), std::string::npos);
    for (const char* role : {"curve", "control", "knots", "comb", "construction", "point"})
        EXPECT_NE(s.find(std::string("class=\"") + role + "\""), std::string::npos) << role;
    for (const char* name : {"cubic", "closed", "circle"})
        EXPECT_NE(s.find(std::string("<title>") + name + "</title>"), std::string::npos) << name;
    const Ran pdf = run({"draw", kExample, "-o", "c.pdf"});
    if (pdf.code == 3 && pdf.err.find("libcairo2-dev") != std::string::npos) GTEST_SKIP() << pdf.err;
    EXPECT_EQ(pdf.code, 0) << pdf.err;
    EXPECT_TRUE(content(path("c.pdf")).starts_with("%PDF-1."));
}

TEST_F(Draw, curves_are_explained_by_what_is_asked_for) {
    const Ran r =
        run({"draw",        kExample,    "-o",     "c.svg",        "--object", "cubic",    "--names",
             "b0",          "--tangent", "0.5",    "--osculating", "0.5",      "--hull",   "--box",
             "--hodograph", "--basis",   "--grid", "--legend",     "--title",  "A <cubic>"});
    ASSERT_EQ(r.code, 0) << r.err;
    const std::string s = content(path("c.svg"));
    for (const char* role : {"tangent", "normal", "osculating", "hull", "box", "hodograph", "basis", "grid",
                             "legend", "title", "control", "labels"})
        EXPECT_NE(s.find(std::string("class=\"") + role + "\""), std::string::npos) << role;
    EXPECT_NE(s.find("<title>A &lt;cubic&gt;</title>"), std::string::npos);
    EXPECT_EQ(s.find("nan"), std::string::npos);
    ASSERT_EQ(run({"draw", kExample, "-o", "j.svg", "--object", "closed", "--joints", "--a-frames"}).code, 0);
    for (const char* role : {"joints", "a-frames"})
        EXPECT_NE(content(path("j.svg")).find(std::string("class=\"") + role + "\""), std::string::npos)
            << role;
}

TEST_F(Draw, documents_of_curves_become_png_without_the_renderer) {
    const Ran r = run({"draw", kExample, "-o", "c.png", "--control", "--width", "300", "--height", "200"});
    if (r.code == 3 && r.err.find("libcairo2-dev") != std::string::npos) GTEST_SKIP() << r.err;
    ASSERT_EQ(r.code, 0) << r.err;
    EXPECT_TRUE(content(path("c.png")).starts_with("\x89PNG"));
}

TEST_F(Draw, surfaces_become_lines_in_svg) {
    const Ran r = run({"draw", kTeapot, "-o", "t.svg", "--control", "--view", "30,20"});
    ASSERT_EQ(r.code, 0) << r.err;
    EXPECT_NE(content(path("t.svg")).find("class=\"isolines\""), std::string::npos);
    EXPECT_EQ(content(path("t.svg")).find("class=\"hidden\""), std::string::npos);
    const std::string flat = R"({"freiform": 1, "objects": [
        {"name": "low", "type": "surface", "degrees": [1, 1], "points": [[[0,0,0],[0,2,0]],[[2,0,0],[2,2,0]]]},
        {"name": "high", "type": "surface", "degrees": [1, 1], "points": [[[0,0,1],[0,2,1]],[[2,0,1],[2,2,1]]]}]})";
    ASSERT_EQ(run({"draw", "-", "-o", "h.svg", "--hidden", "--view", "30,60"}, flat).code, 0);
    EXPECT_NE(content(path("h.svg")).find("id=\"low-hidden\""), std::string::npos);
    ASSERT_EQ(run({"draw", "-", "-o", "w.svg", "--wireframe", "--view", "30,60"}, flat).code, 0);
    EXPECT_EQ(content(path("w.svg")).find("class=\"hidden\""), std::string::npos);
}

TEST_F(Draw, surfaces_are_coloured_and_the_range_is_said) {
    // A part of a cylinder of radius 1: mean curvature 1/2 with either sign.
    const std::string pipe = R"({"type": "surface", "degrees": [2, 1],
        "points": [[[1,0,0],[1,0,3]],[[1,1,0],[1,1,3]],[[0,1,0],[0,1,3]]],
        "weights": [[1,1],[0.7071067811865476,0.7071067811865476],[1,1]]})";
    const Ran r = run({"draw", "-", "-o", "p.png", "--colour", "mean", "--json", "--width", "400", "--height",
                       "300", "--isolines", "3", "--control", "--normals", "4"},
                      pipe);
    if (r.code == 3 && r.out.find("libegl") != std::string::npos) GTEST_SKIP() << r.out;
    ASSERT_EQ(r.code, 0) << r.err;
    EXPECT_TRUE(content(path("p.png")).starts_with("\x89PNG"));
    const Json said = Json::parse(r.out, nullptr, false);
    EXPECT_NEAR(std::abs(said.value("least", 0.0)), 0.5, 1e-9) << r.out;
    EXPECT_NEAR(said["range"][1].get<double>(), 0.5, 1e-9);
    EXPECT_EQ(said["range"][0].get<double>(), -said["range"][1].get<double>());
    const Ran asked =
        run({"draw", "-", "-o", "p.png", "--colour", "gauss", "--range", "-2,3", "--json"}, pipe);
    ASSERT_EQ(asked.code, 0) << asked.err;
    EXPECT_EQ(Json::parse(asked.out)["range"], Json::parse("[-2, 3]"));
    for (const char* way : {"error", "normal"})
        EXPECT_EQ(run({"draw", "-", "-o", "p.png", "--colour", way, "--isophotes"}, pipe).code, 0) << way;
}

// Half a tube, 100 times as long as it is wide.
TEST_F(Draw, surfaces_are_drawn_within_less_than_a_pixel_of_what_is_seen_of_them) {
    const std::string tube = R"({"type":"surface","degrees":[2,1],
        "points":[[[1,0,0],[1,0,200]],[[0,3,0],[0,3,200]],[[-1,0,0],[-1,0,200]]]})";
    const auto bound = [&](std::vector<std::string> more) {
        std::vector<std::string> all{"draw", "-", "-o", "t.png", "--colour", "error", "--json"};
        all.insert(all.end(), more.begin(), more.end());
        const Ran r = run(all, tube);
        if (r.code == 3) return -1.0;
        EXPECT_EQ(r.code, 0) << r.err;
        return Json::parse(r.out)["error_bound"].get<double>();
    };
    const double aside = bound({"--view", "front", "--width", "400", "--height", "300"});
    if (aside < 0) GTEST_SKIP() << "no pictures of surfaces here";
    EXPECT_LE(aside, 200 / 270.0 / 4) << "a quarter of a pixel";
    EXPECT_LE(bound({"--view", "top", "--width", "400", "--height", "300"}), 2 / 200.0 / 4);
    EXPECT_LE(bound({"--view", "front", "--width", "1200", "--height", "900"}), aside / 2.5);
    EXPECT_GE(bound({"--view", "top", "--tolerance", "0.1"}), 0.01);
    const Ran few = run({"draw", "-", "-o", "t.png", "--view", "top", "--max-triangles", "20"}, tube);
    EXPECT_EQ(few.code, 0) << few.err;
    EXPECT_NE(few.err.find("which may be seen"), std::string::npos) << few.err;
}

TEST_F(Draw, surfaces_are_drawn_by_shaders_or_the_reason_is_said) {
    const std::string teapot = std::string(FREIFORM_SOURCE_DIR) + "/examples/teapot.bpt";
    const auto drawn = [&](std::vector<std::string> more) {
        std::vector<std::string> arguments{"draw", teapot, "-o", "t.png", "--width", "120", "--height", "90"};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return run(arguments);
    };
    const Ran mesh = drawn({});
    if (mesh.code == 3 && mesh.err.find("libegl") != std::string::npos) GTEST_SKIP() << mesh.err;
    const std::string of_mesh = content(path("t.png"));
    const Ran r = drawn({"--gpu"});
    ASSERT_EQ(r.code, 0) << r.err;
    if (r.err.find("OpenGL") != std::string::npos) GTEST_SKIP() << r.err;
    EXPECT_EQ(r.err, "");
    EXPECT_NE(content(path("t.png")), of_mesh) << "other triangles";
    const Ran edges = drawn({"--gpu", "--edges"});
    EXPECT_EQ(edges.code, 0);
    EXPECT_NE(edges.err.find("drawn as a mesh: --gpu: --edges"), std::string::npos) << edges.err;
    const std::string triangle =
        R"({"type": "triangle", "degree": 2, "points": [[0,0,0],[1,0,0.5],[0,1,0.5],[2,0,0],[1,1,0.5],[0,2,0]]})";
    EXPECT_EQ(run({"draw", "-", "-o", "t.png", "--gpu"}, triangle).code, 0);
}

// Mesa with less than it has, then no driver at all.
TEST_F(Draw, older_drivers_draw_the_mesh_and_none_is_a_reason) {
    const char* mesa = "/usr/share/glvnd/egl_vendor.d/50_mesa.json";
    if (!std::filesystem::exists(mesa)) GTEST_SKIP() << mesa << " is not there";
    const std::vector<std::string> direct{"draw",    kTeapot, "-o",       "d.png", "--gpu",
                                          "--width", "60",    "--height", "45"};
    std::vector<std::string> as_mesh = direct;
    as_mesh[3] = "m.png";
    as_mesh.erase(as_mesh.begin() + 4);
    setenv("__EGL_VENDOR_LIBRARY_FILENAMES", mesa, 1);
    setenv("MESA_GL_VERSION_OVERRIDE", "3.3", 1);
    const Ran mesh = run(as_mesh);
    if (mesh.code == 3) GTEST_SKIP() << mesh.err;
    const Ran older = run(direct);
    EXPECT_EQ(older.code, 0);
    EXPECT_NE(older.err.find("drawn as a mesh: OpenGL: no OpenGL 4.3"), std::string::npos) << older.err;
    EXPECT_EQ(content(path("d.png")), content(path("m.png")));
    std::filesystem::remove(path("d.png"));
    unsetenv("MESA_GL_VERSION_OVERRIDE");
    setenv("__EGL_VENDOR_LIBRARY_FILENAMES", "/nothing.json", 1);
    const Ran none = run(direct);
    EXPECT_EQ(none.code, 3);
    EXPECT_NE(none.err.find("no OpenGL 3.3 without a window; on Debian install"), std::string::npos)
        << none.err;
    EXPECT_FALSE(std::filesystem::exists(path("d.png")));
    unsetenv("__EGL_VENDOR_LIBRARY_FILENAMES");
}

TEST_F(Draw, pictures_of_nothing_are_refused) {
    // A whole sphere without a loop: a face of a model needs one.
    const std::string bare = R"({"type": "model", "faces": [{"surface": {"type": "revolution",
        "profile": {"type": "ellipse", "centre": [0,0,0], "x": [1,0,0], "y": [0,0,1]},
        "origin": [0,0,0], "axis": [0,0,1], "kind": "sphere"}}]})";
    for (const char* to : {"n.png", "n.svg"}) {
        const Ran r = run({"draw", "-", "-o", to, "--json"}, bare);
        if (r.code == 3 && r.out.find("libegl") != std::string::npos) GTEST_SKIP() << r.out;
        EXPECT_EQ(r.code, 1) << to << r.err;
        EXPECT_NE(error_of(r).value("message", "").find("no boundary"), std::string::npos) << r.out;
        EXPECT_FALSE(std::filesystem::exists(path(to)));
    }
}

TEST_F(Draw, an_object_can_be_chosen) {
    ASSERT_EQ(run({"draw", kExample, "-o", "c.svg", "--object", "circle"}).code, 0);
    const std::string s = content(path("c.svg"));
    EXPECT_NE(s.find("<title>circle</title>"), std::string::npos);
    EXPECT_EQ(s.find("<title>cubic</title>"), std::string::npos);
}

TEST_F(Draw, wrong_combinations_are_wrong_usage) {
    for (const std::vector<std::string>& a : std::vector<std::vector<std::string>>{
             {"draw", kExample, "-o", "c.gif"},
             {"draw", kExample},
             {"draw", kExample, "-o", "c.svg", "--zebra"},
             {"draw", kExample, "-o", "c.pdf", "--perspective"},
             {"draw", kExample, "-o", "c.png", "--edges"},
             {"draw", kExample, "-o", "c.svg", "--tolerance", "0.1"},
             {"draw", kExample, "-o", "c.svg", "--view", "askew"},
             {"draw", kExample, "-o", "c.svg", "--width", "0"},
             {"draw", kExample, "-o", "c.svg", "--construction", "middle"},
             {"draw", kExample, "-o", "c.svg", "--names", "Q1"},
             {"draw", kTeapot, "-o", "t.png", "--basis"},
             {"draw", kTeapot, "-o", "t.png", "--range", "0,1"},
             {"draw", kTeapot, "-o", "t.png", "--colour", "green"},
             {"draw", kTeapot, "-o", "t.png", "--colour", "mean", "--range", "1,0"},
             {"draw", kTeapot, "-o", "t.svg", "--colour", "mean"},
             {"draw", kTeapot, "-o", "t.svg", "--isophotes"},
             {"draw", kTeapot, "-o", "t.png", "--comb"}}) {
        const Ran r = run(a);
        EXPECT_EQ(r.code, 2) << a.back() << ": " << r.err;
        EXPECT_FALSE(std::filesystem::exists(path("c.svg")));
    }
}

TEST_F(Draw, questions_without_an_answer_exit_with_1) {
    const Ran outside = run({"draw", "-", "-o", "c.svg", "--construction", "1.5", "--json"}, kLine);
    EXPECT_EQ(outside.code, 1);
    EXPECT_EQ(error_of(outside).value("kind", ""), "out_of_domain");
    EXPECT_NE(error_of(outside).value("message", "").find("[0, 1]"), std::string::npos) << outside.out;
    const Ran four =
        run({"draw", "-", "-o", "c.svg", "--json"},
            R"({"name": "deep", "type": "curve", "degree": 1, "points": [[0,0,0,0],[4,2,1,1]]})");
    EXPECT_EQ(four.code, 1);
    EXPECT_NE(error_of(four).value("where", "").find("deep"), std::string::npos) << four.out;
    EXPECT_NE(error_of(four).value("message", "").find("four coordinates"), std::string::npos) << four.out;
    EXPECT_EQ(run({"draw", kTeapot, "-o", "t.svg", "--construction", "0.5"}).code, 1);
    EXPECT_FALSE(std::filesystem::exists(path("c.svg")));
    EXPECT_EQ(run({"draw", "absent.json", "-o", "c.svg"}).code, 5) << "no such file";
}

TEST_F(Draw, what_is_missing_is_said) {
    const Ran r = run({"draw", "-", "-o", "c.svg"},
                      R"({"freiform": 1, "objects": [{"type": "curve", "degree": 1, "points": [[0,0],[4,2]]},
        {"name": "deep", "type": "curve", "degree": 1, "points": [[0,0,0,0],[4,2,1,1]]}]})");
    EXPECT_EQ(r.code, 0);
    EXPECT_NE(r.err.find("deep"), std::string::npos) << r.err;
    EXPECT_NE(r.err.find("is missing"), std::string::npos) << r.err;
}

}  // namespace
}  // namespace freiform::test
