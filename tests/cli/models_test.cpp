// Questions about a solid model: lengths and joints of edges, nearest faces, the farthest point, oriented
// boxes.
#include "run.hpp"

#include <nlohmann/json.hpp>

namespace freiform::test {
namespace {

using Json = nlohmann::json;

// A unit square in a larger plane, as a trimmed surface: a model of one face.
constexpr const char* kSquare = R"({"type": "trimmed", "surface": {"degrees": [1, 1],
    "points": [[[0,0,0],[0,4,0]],[[4,0,0],[4,4,0]]]},
    "loops": [[{"degree": 1, "knots": [0,0,1,2,3,4,4], "points": [[0.25,0.25],[0.5,0.25],[0.5,0.5],[0.25,0.5],[0.25,0.25]]}]]})";

class ModelQuestions : public Program {
protected:
    const std::string bracket_ = std::string(FREIFORM_SOURCE_DIR) + "/examples/bracket.step";
    Json answer(std::vector<std::string> arguments) {
        arguments.push_back("--json");
        const Ran r = run(arguments);
        EXPECT_EQ(r.code, 0) << r.out << r.err;
        return r.code == 0 ? Json::parse(r.out) : Json();
    }
};

TEST_F(ModelQuestions, a_trimmed_square_has_edges_a_nearest_face_a_farthest_corner_and_a_box) {
    const std::string square = file("square.json", kSquare), at = file("p.csv", "1.5,1.5,2\n");
    const Json length = answer({"length", square});
    EXPECT_NEAR(length["value"].get<double>(), 4, 1e-12);
    EXPECT_LE(length["bound"].get<double>(), 1e-11);
    EXPECT_EQ(length["objects"][0]["edges"].size(), 1u);
    const Json near = answer({"nearest", square, "--points", at, "--k", "3"})["results"][0];
    ASSERT_EQ(near["faces"].size(), 1u);
    EXPECT_EQ(near["faces"][0]["distance"], 2.0);
    EXPECT_FALSE(near.contains("others_lower_bound"));
    EXPECT_EQ(answer({"nearest", square, "--points", at, "--radius", "1"})["results"][0]["faces"].size(), 0u);
    EXPECT_EQ(answer({"nearest", square, "--points", at, "--radius", "2.5"})["results"][0]["faces"].size(),
              1u);
    const Json far =
        answer({"nearest", square, "--points", at, "--farthest", "--accuracy", "1e-6"})["results"][0];
    EXPECT_NEAR(far["distance"].get<double>(), std::sqrt(4.5), 1e-6);
    EXPECT_GE(far["upper_bound"].get<double>(), std::sqrt(4.5));
    const Json box = answer({"bounds", square, "--oriented"})["objects"][0]["oriented_box"];
    EXPECT_NEAR(box["volume"].get<double>(), 0, 1e-9);
    EXPECT_EQ(box["axes"].size(), 3u);
    const Json hull = answer({"bounds", square, "--hull", "1e-3"})["objects"][0]["hull"];
    EXPECT_LE(hull["bound"].get<double>(), 1e-3);
    EXPECT_GE(hull["points"].size(), 4u);
}

TEST_F(ModelQuestions, units_stay_from_file_to_file_and_unknown_ones_are_told) {
    const auto with = [](const std::string& unit) {
        return R"({"freiform":1,"unit":")" + unit +
               R"(","objects":[{"type":"surface","points":[[[0,0,0],[0,8,0]],[[4,0,0],[4,8,0]]]}]})";
    };
    for (const std::string format : {"step", "iges"})
        for (const std::string unit : {"mm", "cm", "dm", "m", "km", "um", "nm", "mil", "inch", "ft"}) {
            const std::string name = "a." + format;
            const Ran written = run({"convert", "-", "-o", name}, with(unit));
            EXPECT_EQ(written.code, 0) << written.err;
            EXPECT_EQ(written.err, "") << unit;
            const Json info = answer({"info", name});
            EXPECT_EQ(info["unit"], unit) << format;
            EXPECT_NEAR(info["objects"][0]["box"]["max"][1].get<double>(), 8, 1e-6) << format << unit;
        }
    const std::string furlong = file("furlong.json", with("furlong"));
    for (const std::string format : {"step", "iges"}) {
        const Ran told = run({"convert", furlong, "-o", "a." + format});
        EXPECT_NE(told.err.find("\"furlong\" is not known"), std::string::npos) << format << told.err;
    }
    // IGES files name what has no number of its own there, known or not.
    EXPECT_EQ(run({"convert", "-", "-o", "a.iges"}, with("nautical mile")).code, 0);
    EXPECT_EQ(answer({"info", "a.iges"})["unit"], "nautical mile");
    std::string iges = content(path("a.iges"));
    const std::string_view nautical = "NAUTICAL MILE";
    ASSERT_NE(iges.find(nautical), std::string::npos);
    iges.replace(iges.find(nautical), nautical.size(), "OLDROYALCUBIT");
    EXPECT_EQ(answer({"info", file("b.iges", iges)})["unit"], "oldroyalcubit");
    const Ran mesh = run({"tessellate", furlong, "--tolerance", "1", "-o", "a.glb"});
    EXPECT_NE(mesh.err.find("\"furlong\" is not known, so the file says m"), std::string::npos) << mesh.err;
}

TEST_F(ModelQuestions, what_they_do_not_answer_says_what_is_accepted) {
    const std::string square = file("square.json", kSquare);
    const Ran places = run({"length", square, "--equal", "3"});
    EXPECT_EQ(places.code, 1);
    EXPECT_NE(places.err.find("--range are for curves"), std::string::npos) << places.err;
    EXPECT_EQ(run({"bounds", square, "--hull", "0"}).code, 2);
    EXPECT_EQ(run({"continuity", square, "--curvature", "-1"}).code, 2);
    const Ran continuity = run({"continuity", square});
    EXPECT_EQ(continuity.code, 1);
    EXPECT_NE(continuity.err.find("the edges of models"), std::string::npos) << continuity.err;
}

TEST_F(ModelQuestions, joints_of_a_part_are_bounded_and_sorted) {
    const Json object = answer({"continuity", bracket_})["objects"][0];
    const Json edges = object["edges"];
    ASSERT_GT(edges.size(), 30u);
    int last = -2, smooth = 0;
    std::size_t bounded = 0;
    for (const Json& e : edges) {
        EXPECT_GE(e["g_at_most"].get<int>(), last);
        last = e["g_at_most"];
        EXPECT_LE(e["g_order"].get<int>(), last);
        for (const char* what : {"gap", "angle"})
            if (const Json& found = e[what]; !found["bound"].is_null()) {  // null: there is none
                EXPECT_LE(found["size"].get<double>(), found["bound"].get<double>());
                ++bounded;
            }
        smooth += last > 0;
    }
    EXPECT_EQ(bounded, 2 * edges.size());
    EXPECT_EQ(object["edges_at_most"]["G1"].get<int>() + object["edges_at_most"]["G2"].get<int>(), smooth);
    const Json length = answer({"length", bracket_});
    EXPECT_LE(length["bound"].get<double>(), 1e-6);
    const Ran plain = run({"continuity", bracket_});
    EXPECT_NE(plain.out.find("worst first\n  edge "), std::string::npos) << plain.out;
}

TEST_F(ModelQuestions, hulls_come_as_numbers_and_as_a_mesh) {
    const std::string curve = file("c.json", R"({"type": "curve", "points": [[0,0],[1,2],[3,2],[4,0]]})");
    const Json hull = answer({"bounds", curve, "--hull", "1e-3", "--oriented"})["objects"][0];
    EXPECT_LE(hull["hull"]["bound"].get<double>(), 1e-3);
    EXPECT_GE(hull["hull"]["points"].size(), 8u);
    EXPECT_NEAR(hull["oriented_box"]["volume"].get<double>(), 6, 1e-6);
    const std::string surface =
        file("s.json", R"({"type": "surface", "points": [[[0,0,0],[0,1,1]],[[1,0,1],[1,1,0]]]})");
    const Ran mesh = run({"bounds", surface, "--hull", "0.01", "-o", path("hull.obj")});
    EXPECT_EQ(mesh.code, 0) << mesh.err;
    EXPECT_NE(mesh.out.find("4 triangles"), std::string::npos) << mesh.out;
    EXPECT_NE(content(path("hull.obj")).find("\nf "), std::string::npos);
    EXPECT_EQ(run({"bounds", curve, "--hull", "0.01", "-o", path("hull.stl")}).code, 1);
}

// Cylinders that end on a free-form face: their loops climb while they turn, which no rational curve does.
TEST_F(ModelQuestions, loops_that_climb_while_they_turn_are_written_to_obj_within_the_tolerance) {
    double last = 1;
    for (const char* tolerance : {"0.1", "0.001", "0.00001"}) {
        const Json r = answer({"convert", bracket_, "--tolerance", tolerance, "-o", "b.obj"});
        const double bound = r["error_bound"].get<double>();
        EXPECT_GT(bound, 0);
        EXPECT_LE(bound, std::stod(tolerance));
        EXPECT_LT(bound, last);
        last = bound;
    }
    // Below what the parameter curves of the file itself are off there are more knots, and the bound says so.
    const Json fine = answer({"convert", bracket_, "--tolerance", "1e-8", "-o", "fine.obj"});
    EXPECT_GT(fine["error_bound"].get<double>(), 1e-6);
    EXPECT_GT(content(path("fine.obj")).size(), content(path("b.obj")).size());
    const Ran said = run({"convert", bracket_, "--tolerance", "0.001", "-o", "b.obj"});
    EXPECT_NE(said.err.find("approximated, no point moved by more than 0.0001"), said.err.npos) << said.err;
    const Ran none = run({"convert", bracket_, "--tolerance", "0", "-o", "none.obj"});
    EXPECT_NE(none.code, 0);
}

// Parameter curves of degree 3 on faces of degrees 5 x 4 and 14 x 3 have images of degrees 27 and 51.
TEST_F(ModelQuestions, a_model_that_obj_took_apart_is_sewn_together_again) {
    ASSERT_EQ(run({"convert", bracket_, "-o", "apart.obj"}).code, 0);
    const Json r =
        answer({"tessellate", "apart.obj", "--tolerance", "0.05", "--sew", "0.001", "-o", "b.stl"});
    EXPECT_EQ(r["sewing"]["remaining_gaps"].size(), 0u) << r["sewing"].dump();
    EXPECT_EQ(r["open_edges"], 0);
    EXPECT_LE(r["sewing"]["bound"].get<double>(), 0.001);
}

}  // namespace
}  // namespace freiform::test
