// STEP files that need a decision: repairs that are asked for, triangles instead of faces, layers.
#include "run.hpp"

#include <freiform/io/step.hpp>

#include <nlohmann/json.hpp>
#include <support/step_assembly.hpp>
#include <sys/stat.h>

namespace freiform::test {
namespace {

using Json = nlohmann::json;
using CliStep = Program;

// A square with a gap of 0.01 in its boundary.
std::string gaping_file() {
    std::string s = polygon_file({{0, 0}, {3, 0}, {3, 2}, {2.99, 2}, {0, 2}});
    return s.erase(s.find("#502,"), 5);
}

TEST_F(CliStep, repair_is_asked_for_and_says_what_it_did) {
    const std::string open = file("open.step", gaping_file());
    const Ran without = run({"info", open, "--json"});
    ASSERT_EQ(without.code, 0) << without.err;
    const Json model = Json::parse(without.out)["objects"][0];
    EXPECT_EQ(model["faces"], 0);
    ASSERT_EQ(model["refused"].size(), 1u);
    const std::string message = model["refused"][0]["message"];
    EXPECT_NE(message.find("#14 EDGE_LOOP"), std::string::npos) << message;
    EXPECT_NE(message.find("--repair"), std::string::npos) << message;
    EXPECT_FALSE(model.contains("repairs"));

    const Ran r = run({"info", open, "--repair", "--json"});
    ASSERT_EQ(r.code, 0) << r.err;
    EXPECT_NE(r.err.find("repaired #14 EDGE_LOOP"), std::string::npos) << r.err;
    const Json repairs = Json::parse(r.out)["objects"][0]["repairs"];
    ASSERT_EQ(repairs.size(), 1u);
    EXPECT_EQ(repairs[0]["where"], "#14 EDGE_LOOP");
    EXPECT_NEAR(repairs[0]["distance"].get<double>(), 0.01, 1e-12);

    const Ran mesh =
        run({"tessellate", open, "--repair", "--tolerance", "0.1", "-o", path("open.stl"), "--json"});
    ASSERT_EQ(mesh.code, 0) << mesh.err;
    EXPECT_EQ(Json::parse(mesh.out)["repairs"].size(), 1u);
    EXPECT_NE(mesh.err.find("repaired #14 EDGE_LOOP"), std::string::npos) << mesh.err;

    // A document keeps it.
    ASSERT_EQ(run({"convert", open, "--repair", "-o", path("open.json")}).code, 0);
    EXPECT_EQ(Json::parse(content(path("open.json")))["objects"][0]["repairs"].size(), 1u);

    const Ran narrow = run({"info", open, "--repair", "--repair-limit", "0.001", "--json"});
    EXPECT_EQ(Json::parse(narrow.out)["objects"][0]["faces"], 0);
    EXPECT_EQ(run({"info", open, "--repair", "--repair-limit", "0"}).code, 2);
    // Nothing that was asked for is silently not done.
    EXPECT_EQ(run({"info", open, "--repair-limit", "0.1"}).code, 2);
    EXPECT_EQ(run({"info", open, "--repair", "--reader", "occt"}).code, 2);
}

TEST_F(CliStep, a_mesh_without_the_faces_that_were_refused_ends_with_1_and_says_so) {
    // A square, and a face around three of its sides.
    std::string s = polygon_file({{0, 0}, {3, 0}, {3, 2}, {0, 2}},
                                 "#20=ADVANCED_FACE('',(#21),#7,.T.);\n#21=FACE_OUTER_BOUND('',#22,.T.);\n"
                                 "#22=EDGE_LOOP('',(#500,#501,#502));\n");
    s.replace(s.find("(#12)"), 5, "(#12,#20)");
    const std::string part = file("part.step", s),
                      whole = file("whole.step", polygon_file({{0, 0}, {3, 0}, {3, 2}}));
    const Ran r = run({"tessellate", part, "--tolerance", "0.1", "-o", path("part.stl"), "--json"});
    EXPECT_EQ(r.code, 1);
    EXPECT_NE(r.err.find("without one face that was refused: #20 ADVANCED_FACE: "), std::string::npos)
        << r.err;
    const Json j = Json::parse(r.out);
    EXPECT_EQ(j["triangles"], 2);
    EXPECT_EQ(j["refused"].size(), 1u);
    EXPECT_FALSE(j.contains("error"));
    EXPECT_EQ(Json::parse(run({"info", path("part.stl"), "--json"}).out)["triangles"], 2);
    const Ran piped = run({"tessellate", part, "--tolerance", "0.1", "--to", "ply", "-o", "-"});
    EXPECT_EQ(piped.code, 1);
    EXPECT_TRUE(piped.out.starts_with("ply\n"));
    EXPECT_NE(piped.err.find("refused"), std::string::npos) << piped.err;
    EXPECT_EQ(run({"tessellate", whole, "--tolerance", "0.1"}).code, 0);
    // So do other files, which have no room for what was refused; documents have.
    for (const bool has_room : {false, true}) {
        const Ran other = run({"convert", part, "-o", path(has_room ? "part.json" : "part.iges"), "--json"});
        EXPECT_EQ(other.code, has_room ? 0 : 1);
        EXPECT_EQ(Json::parse(other.out)["refused"][0]["message"], j["refused"][0]["message"]) << other.out;
        EXPECT_NE(other.err.find("#20 ADVANCED_FACE is left out: "), std::string::npos) << other.err;
    }
    EXPECT_EQ(run({"convert", whole, "-o", path("whole.iges")}).code, 0);
    // Curves that bound no face are left out, and nothing is missing in the mesh.
    std::string lines = polygon_file({{0, 0}, {3, 0}, {3, 2}},
                                     "#30=GEOMETRIC_CURVE_SET('',(#31));\n#31=POLYLINE('',(#100,#101));\n");
    lines.replace(lines.find("(#10)"), 5, "(#10,#30)");
    const Ran beside = run({"tessellate", file("lines.step", lines), "--tolerance", "0.1", "--json"});
    EXPECT_EQ(beside.code, 0) << beside.err;
    EXPECT_EQ(Json::parse(beside.out)["refused"].size(), 1u) << beside.out;
}

TEST_F(CliStep, a_file_of_triangles_alone_is_a_mesh) {
    const std::string mesh =
        file("mesh.step", flat_file("#8=TESSELLATED_SHAPE_REPRESENTATION('',(#10),#1);\n"
                                    "#10=TESSELLATED_SHELL('',(#11),$);\n"
                                    "#11=TRIANGULATED_FACE('f',#20,3,(),$,(),((1,2,3)));\n"
                                    "#20=COORDINATES_LIST('',3,((0.,0.,0.),(1.,0.,0.),(0.,1.,0.)));\n"));
    const Ran info = run({"info", mesh, "--json"});
    ASSERT_EQ(info.code, 0) << info.err << info.out;
    const Json j = Json::parse(info.out);
    EXPECT_EQ(j["type"], "mesh");
    EXPECT_EQ(j["triangles"], 1);
    EXPECT_EQ(j["open_edges"], 3);
    ASSERT_EQ(run({"draw", mesh, "-o", path("mesh.png"), "--view", "top"}).code, 0);
    const Ran other = run({"tessellate", mesh, "--tolerance", "0.1", "-o", path("m.stl")});
    EXPECT_EQ(other.code, 1);
    EXPECT_NE(other.err.find("info, draw and check"), std::string::npos) << other.err;
    for (const std::string name : {"c.stl", "c.ply", "c.glb", "c.obj"}) {
        const Ran made = run({"convert", mesh, "-o", name, "--json"});
        ASSERT_EQ(made.code, 0) << made.err;
        EXPECT_EQ(Json::parse(made.out)["triangles"], 1);
        EXPECT_EQ(Json::parse(run({"info", name, "--json"}).out)["triangles"], 1);
    }
    EXPECT_EQ(run({"convert", "c.stl", "-o", "again.ply"}).code, 0);
    EXPECT_EQ(run({"convert", mesh, "--elevate", "1", "-o", "c.stl"}).code, 2);
    const Ran no_mesh = run({"convert", mesh, "-o", "c.json"});
    EXPECT_EQ(no_mesh.code, 1);
    EXPECT_NE(no_mesh.err.find("convert writes them as .stl"), std::string::npos) << no_mesh.err;
    const std::string bad = file("bad.step", flat_file("#8=TESSELLATED_SHAPE_REPRESENTATION('',(#11),#1);\n"
                                                       "#11=TRIANGULATED_FACE('f',#20,1,(),$,(),((1,2,3)));\n"
                                                       "#20=COORDINATES_LIST('',1,((0.,0.,0.)));\n"));
    const Ran lies = run({"info", bad});
    EXPECT_EQ(lies.code, 3);
    EXPECT_NE(lies.err.find("#11 TRIANGULATED_FACE"), std::string::npos) << lies.err;
}

TEST_F(CliStep, info_says_what_lies_on_each_layer) {
    const std::string layered =
        file("layers.step",
             polygon_file({{0, 0}, {3, 0}, {3, 2}},
                          "#900=PRESENTATION_LAYER_ASSIGNMENT('walls','outside',(#12,#10,#400));\n"));
    const Ran r = run({"info", layered, "--json"});
    ASSERT_EQ(r.code, 0) << r.err;
    const Json layers = Json::parse(r.out)["objects"][0]["layers"];
    ASSERT_EQ(layers.size(), 1u);
    EXPECT_EQ(
        layers[0],
        Json::parse(R"({"name": "walls", "description": "outside", "faces": 1, "bodies": 1, "edges": 1})"));
    EXPECT_NE(
        run({"info", layered}).out.find("layer    walls (outside): bodies 1, faces by themselves 1, edges 1"),
        std::string::npos);
}

TEST_F(CliStep, parts_of_an_assembly_are_read_from_the_files_beside_it) {
    const std::string whole =
        file("whole.stp", assembly({{.file = "PART.STP", .place = "0.,0.,0."},
                                    {.file = "parts\\\\Plate.stp", .place = "0.,0.,5."}}));
    std::filesystem::create_directory(path("parts"));
    file("part.stp", polygon_file({{0, 0}, {4, 0}, {0, 3}}));  // other letters than the assembly has
    file("parts/Plate.stp", polygon_file({{0, 0}, {2, 0}, {2, 1}, {0, 1}}));
    for (const std::string& name : {whole, std::string("whole.stp")}) {
        const Ran r = run({"info", name, "--json"});
        ASSERT_EQ(r.code, 0) << r.err;
        const Json model = Json::parse(r.out)["objects"][0];
        EXPECT_EQ(model["faces"], 2);
        EXPECT_EQ(model["refused"].size(), 0u) << model["refused"].dump();
    }
    const Ran mesh = run({"tessellate", whole, "--tolerance", "0.1", "-o", path("whole.stl"), "--json"});
    ASSERT_EQ(mesh.code, 0) << mesh.err;
    EXPECT_EQ(Json::parse(mesh.out)["triangles"], 3);

    // One part is not there: the rest is, and the exit code says so.
    std::filesystem::remove(path("part.stp"));
    const Ran without = run({"tessellate", whole, "--tolerance", "0.1", "-o", path("whole.stl"), "--json"});
    EXPECT_EQ(without.code, 1);
    EXPECT_EQ(Json::parse(without.out)["triangles"], 2);
    EXPECT_NE(without.err.find("its shape is in the file 'PART.STP'"), std::string::npos) << without.err;

    // A pipe that nobody writes to is not waited for.
    ASSERT_EQ(::mkfifo(path("part.stp").c_str(), 0600), 0);
    const Ran pipe = run({"info", whole, "--json"});
    EXPECT_EQ(pipe.code, 0);
    EXPECT_NE(pipe.out.find("it is no file with bytes of its own"), std::string::npos) << pipe.out;

    // Standard input has no folder.
    const Ran piped = run({"info", "-", "--json"}, content(whole));
    EXPECT_EQ(piped.code, 3);
    EXPECT_NE(piped.out.find("'PART.STP': no other file is at hand"), std::string::npos) << piped.out;
}

}  // namespace
}  // namespace freiform::test
