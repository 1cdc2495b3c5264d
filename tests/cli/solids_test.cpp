#include "run.hpp"

#include <cstring>
#include <nlohmann/json.hpp>
#include <numbers>

namespace freiform::test {
namespace {

using SolidProgram = Program;
using SolidJson = nlohmann::json;

const std::string kRegion = R"({"freiform": 1, "unit": "mm", "objects": [
    {"name": "outer", "type": "curve", "degree": 1, "knots": [0,0,1,2,3,4,4], "points": [[1,0],[5,0],[5,4],[1,4],[1,0]]},
    {"name": "hole", "type": "curve", "degree": 1, "knots": [0,0,1,2,3,3], "points": [[2,1],[4,1],[3,3],[2,1]]},
    {"name": "open", "type": "curve", "degree": 1, "points": [[0,0],[1,1]]}]})";

TEST_F(SolidProgram, of_closed_curves_are_extruded_and_revolved) {
    file("region.json", kRegion);
    const std::string both = file("both.json", [] {
        auto d = SolidJson::parse(kRegion);
        d["objects"].erase(2);
        return d.dump();
    }());
    const Ran prism = run({"extrude", both, "--by", "0,0,2", "--solid", "-o", "a.json", "--json"});
    ASSERT_EQ(prism.code, 0) << prism.err;
    EXPECT_EQ(SolidJson::parse(prism.out)["faces"], 4 + 3 + 2);
    const Ran mesh =
        run({"extrude", both, "--by", "0,0,2", "--solid", "--tolerance", "0.1", "-o", "a.stl", "--json"});
    ASSERT_EQ(mesh.code, 0) << mesh.err;
    EXPECT_EQ(SolidJson::parse(mesh.out)["open_edges"], 0);
    EXPECT_EQ(SolidJson::parse(mesh.out)["solids"], 1);
    const Ran ring = run({"revolve", both, "--axis", "0,0,0,0,1,0", "--solid", "-o", "ring.json", "--json"});
    ASSERT_EQ(ring.code, 0) << ring.err;
    const auto info = SolidJson::parse(run({"info", "ring.json", "--json"}).out)["objects"][0];
    EXPECT_EQ(info["shells"], 2) << info;
    EXPECT_EQ(info["solids"], 1);
    EXPECT_EQ(run({"revolve", both, "--axis", "3,0,0,0,1,0", "--solid"}).code, 3) << "through the region";
    const Ran open = run({"extrude", path("region.json"), "--by", "0,0,2", "--solid"});
    EXPECT_EQ(open.code, 1);
    EXPECT_NE(open.err.find("no closed plane curve"), open.err.npos) << open.err;
    EXPECT_EQ(run({"extrude", both, "--by", "0,0,2", "--solid", "-o", "a.png"}).code, 2);
    // A drawing is a region, too: the plate of the badge.
    const std::string badge = std::string(FREIFORM_SOURCE_DIR) + "/examples/badge.svg";
    EXPECT_EQ(
        run({"extrude", badge, "--object", "plate", "--by", "0,0,2", "--solid", "-o", "plate.glb"}).code, 0);
}

// Without a number the tolerance is the file's, which is finer than numbers so far from zero can tell.
TEST_F(SolidProgram, sews_far_from_zero_as_closely_as_numbers_can_tell) {
    const auto half = [](int from) {
        const auto rows = [&](double x, double z) {
            const std::string at = "[" + std::to_string(300'000 + from + x) + ",",
                              end = "," + std::to_string(z) + "]";
            return "[" + at + "0" + end + "," + at + "1" + end + "]";
        };
        return R"({"type":"surface","degrees":[2,1],"points":[)" + rows(0, 0) + "," + rows(0.5, 0.3) + "," +
               rows(1, 0) + "]}";
    };
    const Ran made = run({"convert", "-", "-o", "far.iges"},
                         R"({"freiform":1,"unit":"m","objects":[)" + half(0) + "," + half(1) + "]}");
    ASSERT_EQ(made.code, 0) << made.err;
    const Ran mesh = run({"tessellate", "far.iges", "--sew", "-o", "far.stl", "--json"});
    if (mesh.code == 5) GTEST_SKIP() << "IGES files are not read here: " << mesh.err;
    ASSERT_EQ(mesh.code, 0) << mesh.err;
    EXPECT_NE(mesh.err.find("as closely as numbers so far from zero can tell"), std::string::npos)
        << mesh.err;
    const auto sewing = SolidJson::parse(mesh.out)["sewing"];
    EXPECT_EQ(sewing["joined"], 1) << sewing;
    EXPECT_LE(sewing["bound"].get<double>(), sewing["tolerance"].get<double>());
    EXPECT_LE(sewing["tolerance"].get<double>(), 0x1p-40 * 300'002);
}

double volume_of_stl(const std::string& bytes);

TEST_F(SolidProgram, of_revolution_turn_clockwise_by_negative_angles) {
    const std::string square = file("square.json", R"({"type":"curve","degree":1,"knots":[0,0,1,2,3,4,4],)"
                                                   R"("points":[[1,0],[2,0],[2,1],[1,1],[1,0]]})");
    for (const char* angle : {"90", "-90"}) {
        SCOPED_TRACE(angle);
        const Ran r =
            run({"revolve", square, "--axis", "0,0,0,0,1,0", "--angle", angle, "--solid", "-o", "q.json"});
        ASSERT_EQ(r.code, 0) << r.err;
        ASSERT_EQ(run({"tessellate", "q.json", "--tolerance", "1e-3", "-o", "q.stl"}).code, 0);
        EXPECT_NEAR(volume_of_stl(content(path("q.stl"))), 3 * std::numbers::pi / 4, 5e-3);
        const auto box = SolidJson::parse(run({"bounds", "q.json", "--json"}).out)["objects"][0]["box"];
        const double far = box["max"][2].get<double>(), near = box["min"][2].get<double>();
        EXPECT_NEAR(*angle == '-' ? far : near, *angle == '-' ? 2 : -2, 1e-5);
    }
    const Ran wrong = run({"revolve", square, "--axis", "0,0,0,0,1,0", "--angle", "720"});
    EXPECT_EQ(wrong.code, 2);
    EXPECT_NE(wrong.err.find("found 720"), wrong.err.npos) << "in degrees: " << wrong.err;
}

// First and last are the same point, and dividing by their weights does not find quite the same numbers; as
// walls in a file, their sides are one seam.
TEST_F(SolidProgram, of_curves_whose_ends_have_different_weights_are_closed) {
    const std::string uneven =
        file("uneven.json", R"({"type":"curve","degree":2,"points":[[0.1,0.3],[1,0],[0.6,1.1],[0.1,0.3]],)"
                            R"("knots":[0,0,0,1,2,2,2],"weights":[0.7,1,1,0.3]})");
    const Ran prism = run({"extrude", uneven, "--by", "0,0,1", "--solid", "-o", "n.json"});
    EXPECT_EQ(prism.code, 0) << prism.err;
    const std::string rail = file("rail.json", R"({"type":"curve","degree":1,"points":[[0,0,0],[0,0,1]]})");
    const std::string profile =
        file("profile.json", R"({"type":"curve","degree":2,"knots":[0,0,0,1,2,2,2],)"
                             R"("points":[[2,0],[-1,2],[-1,-2],[2,0]],"weights":[1,1,1,2]})");
    const Ran made =
        run({"sweep", profile, "--rail", rail, "--solid", "--tolerance", "1e-3", "-o", "z.step"});
    ASSERT_EQ(made.code, 0) << made.err;
    const auto info = SolidJson::parse(run({"info", "z.step", "--json"}).out)["objects"][0];
    EXPECT_EQ(info["faces"], 3) << info;
    EXPECT_EQ(info["refused"].size(), 0u) << info;
    const Ran mesh = run({"tessellate", "z.step", "--tolerance", "1e-3", "-o", "z.stl", "--json"});
    ASSERT_EQ(mesh.code, 0) << mesh.err;
    EXPECT_EQ(SolidJson::parse(mesh.out)["open_edges"], 0);
}

// The curve in the parameters of the wall is needed where its end runs round in one piece.
TEST_F(SolidProgram, whose_walls_are_splines_are_read_again_from_iges) {
    const std::string rail = file("rail.json", R"({"type":"curve","degree":1,"points":[[0,0,0],[0,0,1]]})"),
                      drop = file("drop.json",
                                  R"({"type":"curve","degree":3,"points":[[2,0],[2,2],[0,2],[2,0]]})");
    const Ran made = run({"sweep", drop, "--rail", rail, "--solid", "--tolerance", "1e-3", "-o", "z.iges"});
    ASSERT_EQ(made.code, 0) << made.err;
    const Ran mesh = run({"tessellate", "z.iges", "--tolerance", "1e-3", "-o", "z.stl", "--json"});
    if (mesh.code == 5) GTEST_SKIP() << "IGES files are not read here: " << mesh.err;
    ASSERT_EQ(mesh.code, 0) << mesh.err;
    EXPECT_EQ(SolidJson::parse(mesh.out)["open_edges"], 0);
    EXPECT_LE(SolidJson::parse(mesh.out)["boundary_gap"].get<double>(), 1e-9);
}

double volume_of_stl(const std::string& bytes) {
    double sum = 0;
    for (std::size_t at = 84; at + 50 <= bytes.size(); at += 50) {
        float x[3][3];
        std::memcpy(x, bytes.data() + at + 12, sizeof x);
        const auto d = [&](int a, int b) { return double(x[1][a]) * x[2][b] - double(x[1][b]) * x[2][a]; };
        sum += (x[0][0] * d(1, 2) + x[0][1] * d(2, 0) + x[0][2] * d(0, 1)) / 6;
    }
    return sum;
}

// Half a disc turned about its straight side, written and read again.
TEST_F(SolidProgram, of_regions_that_reach_the_axis_are_closed_and_stay_so) {
    const std::string half = file("half.svg", R"(<svg xmlns="http://www.w3.org/2000/svg"><path d=
        "M 0 -2 A 2 2 0 0 1 0 2 Z"/></svg>)");
    for (const std::string angle : {"360", "-90"})
        for (const std::string ball : {"ball.json", "ball.step", "ball.iges"}) {
            const Ran made =
                run({"revolve", half, "--axis", "0,0,0,0,1,0", "--angle", angle, "--solid", "-o", ball});
            ASSERT_EQ(made.code, 0) << made.err;
            const Ran mesh = run({"tessellate", ball, "--tolerance", "1e-2", "-o", "ball.stl", "--json"});
            if (mesh.code == 5) continue;  // IGES files are not read here
            ASSERT_EQ(mesh.code, 0) << ball << mesh.err;
            EXPECT_EQ(SolidJson::parse(mesh.out)["open_edges"], 0) << ball;
            const double whole = 4 / 3.0 * std::numbers::pi * 8, part = angle == "360" ? 1 : 0.25;
            EXPECT_NEAR(volume_of_stl(content(path("ball.stl"))), part * whole, 0.3) << ball;
        }
}

// A ring of radii 2 and 1 along a straight and along a bent rail: volumes are area times length (Pappus), and
// the triangles' volume says the same within what their bound allows.
TEST_F(SolidProgram, of_regions_along_a_rail_are_watertight) {
    const std::string ring = file("ring.svg", R"(<svg xmlns="http://www.w3.org/2000/svg"><path d=
        "M 2 0 A 2 2 0 1 1 -2 0 A 2 2 0 1 1 2 0 Z M 1 0 A 1 1 0 1 1 -1 0 A 1 1 0 1 1 1 0 Z"/></svg>)");
    const auto rail = [&](const char* points) {
        return file("rail.json", std::string(R"({"freiform": 1, "objects": [{"type": "curve", "degree": 2,
            "points": )") + points + "}]}");
    };
    for (const char* points : {"[[0,0,0],[0,0,5],[0,0,10]]", "[[0,0,0],[0,0,20],[20,0,20]]"}) {
        const std::string along = rail(points);
        const Ran made = run(
            {"sweep", ring, "--rail", along, "--tolerance", "0.02", "--solid", "-o", "pipe.json", "--json"});
        ASSERT_EQ(made.code, 0) << made.err;
        const auto said = SolidJson::parse(made.out);
        EXPECT_EQ(said["solids"], 1);
        EXPECT_EQ(said["faces"], 2 + 2 * 4) << "arcs are two curves each";
        EXPECT_LE(said["wall_bound"].get<double>(), 0.02);
        const Ran mesh = run(
            {"sweep", ring, "--rail", along, "--tolerance", "0.02", "--solid", "-o", "pipe.stl", "--json"});
        ASSERT_EQ(mesh.code, 0) << mesh.err;
        const auto triangles = SolidJson::parse(mesh.out);
        EXPECT_EQ(triangles["open_edges"], 0);
        EXPECT_LE(triangles["error_bound"].get<double>() + triangles["wall_bound"].get<double>(), 0.02);
        EXPECT_LE(triangles["wall_bound"].get<double>(), 0.01) << "triangles have the other half";
        const double length =
            SolidJson::parse(run({"length", along, "--json"}).out)["objects"][0]["value"].get<double>();
        const double expected = 3 * std::numbers::pi * length;
        // The whole boundary, 6 pi times the length and two ends, moved by the tolerance.
        const double most = 0.02 * (6 * std::numbers::pi * length + 6 * std::numbers::pi) * 1.1;
        EXPECT_NEAR(volume_of_stl(content(path("pipe.stl"))), expected, most);
    }
    EXPECT_EQ(run({"sweep", ring, "--rail", "rail.json", "--translate", "--solid"}).code, 2);
    EXPECT_EQ(run({"sweep", ring, "--rail", "rail.json", "--solid"}).code, 2) << "without a tolerance";
    EXPECT_EQ(
        run({"sweep", ring, "--rail", "rail.json", "--tolerance", "0.1", "--solid", "-o", "a.bpt"}).code, 2);
    const Ran tight =
        run({"sweep", ring, "--rail", rail("[[0,0,0],[0,0,2],[2,0,2]]"), "--tolerance", "0.1", "--solid"});
    EXPECT_EQ(tight.code, 1);
    EXPECT_NE(tight.err.find("walls fold"), tight.err.npos) << tight.err;
    const Ran open = run({"sweep", file("region.json", kRegion), "--object", "open", "--rail", "rail.json",
                          "--tolerance", "0.1", "--solid"});
    EXPECT_EQ(open.code, 1);
    EXPECT_NE(open.err.find("no closed plane curve"), open.err.npos) << open.err;
}

TEST_F(SolidProgram, are_written_to_every_format_that_holds_models) {
    auto d = SolidJson::parse(kRegion);
    d["objects"].erase(2);
    const std::string both = file("both.json", d.dump());
    for (const char* name : {"a.iges", "a.igs", "a.step", "a.json"})
        ASSERT_EQ(run({"extrude", both, "--by", "0,0,2", "--solid", "-o", name}).code, 0) << name;
    EXPECT_NE(content(path("a.igs")).find("     186 "), std::string::npos) << "a solid, not its faces";
    auto looks = SolidJson::parse(content(path("a.json")));
    for (auto& body : looks["objects"][0]["bodies"]) body["name"] = "plate";
    const std::string named = file("named.json", looks.dump());
    EXPECT_NE(run({"convert", named, "-o", "named.igs"}).err.find("are not written to IGES"),
              std::string::npos);
    EXPECT_EQ(run({"convert", named, "-o", "named.step"}).err, "");
    for (const char* name : {"b.igs", "b.obj", "b.step"})
        ASSERT_EQ(run({"convert", "a.json", "-o", name}).code, 0) << name;
    EXPECT_EQ(content(path("a.igs")), content(path("b.igs")));
    const Ran info = run({"info", "b.obj", "--json"});
    ASSERT_EQ(info.code, 0) << info.err;
    EXPECT_EQ(SolidJson::parse(info.out)["objects"].size(), 9u) << "a trimmed surface for each face";
    const Ran mesh =
        run({"tessellate", "b.obj", "--sew", "1e-6", "--tolerance", "0.1", "-o", "b.stl", "--json"});
    ASSERT_EQ(mesh.code, 0) << mesh.err;
    EXPECT_EQ(SolidJson::parse(mesh.out)["open_edges"], 0);
}

TEST_F(SolidProgram, are_written_for_other_programs) {
    ASSERT_EQ(run({"convert", kTeapot, "-o", "teapot.obj"}).code, 0);
    ASSERT_EQ(run({"convert", "teapot.obj", "-o", "back.bpt"}).code, 0);
    ASSERT_EQ(run({"convert", kTeapot, "-o", "plain.bpt"}).code, 0);
    EXPECT_EQ(content(path("back.bpt")), content(path("plain.bpt")));
    ASSERT_EQ(run({"convert", kTeapot, "-o", "teapot.step"}).code, 0);
    EXPECT_TRUE(content(path("teapot.step")).starts_with("ISO-10303-21;"));
    const Ran info = run({"info", "teapot.step", "--json"});
    if (info.code == 0) EXPECT_EQ(SolidJson::parse(info.out)["objects"][0]["faces"], 32);
    EXPECT_EQ(run({"convert", kTeapot, "-o", "teapot.xyz"}).code, 2);
    EXPECT_EQ(run({"info", "-"}, "ISO").code, 3);
}

}  // namespace
}  // namespace freiform::test
