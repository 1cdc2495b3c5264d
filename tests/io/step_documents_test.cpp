// Assemblies whose parts are in other files.
#include "step_assembly.hpp"
#include "step_items.hpp"

#include <gtest/gtest.h>
#include <map>

namespace freiform {
namespace {

using namespace test;

const std::vector<Corner> kTriangle{{0, 0}, {4, 0}, {0, 3}};
const std::string kInches =
    "#900=(CONVERSION_BASED_UNIT('INCH',#901)LENGTH_UNIT()NAMED_UNIT(#902));\n"
    "#901=LENGTH_MEASURE_WITH_UNIT(LENGTH_MEASURE(25.4),#2);\n#902=DIMENSIONAL_EXPONENTS(1.,0.,0.,0.,0.,0.,0."
    ");\n";

std::string replaced(std::string s, std::string_view from, std::string_view to) {
    const std::size_t at = s.find(from);
    EXPECT_NE(at, s.npos) << from;
    return s.replace(at, from.size(), to);
}
std::string inch_triangle() {
    return replaced(polygon_file(kTriangle, kInches), "CONTEXT((#2))", "CONTEXT((#900))");
}

// Files by their paths, and how often each was asked for.
struct Folder {
    std::map<std::string, std::string> files;
    std::map<std::string, int> asked = {};

    StepReadOptions options() {
        StepReadOptions out;
        out.open = [this](const std::string& path) -> Result<std::string> {
            ++asked[path];
            const auto at = files.find(path);
            if (at == files.end()) return refuse(RefusalKind::io, path, "there is no such file");
            return at->second;
        };
        return out;
    }
    Result<Model> read(const std::string& path) { return read_step(files.at(path), options()); }
};

std::vector<Vec<3>> points_of(const Model& m) {
    std::vector<Vec<3>> out;
    for (const Vertex& v : m.vertices) out.push_back(v.point);
    return out;
}
void expect_points(const Model& m, const std::vector<Vec<3>>& wanted) {
    const auto points = points_of(m);
    ASSERT_EQ(points.size(), wanted.size());
    for (std::size_t i = 0; i < wanted.size(); ++i) EXPECT_NEAR(norm(points[i] - wanted[i]), 0, 1e-12) << i;
}
void expect_no_refusals(const Model& m) {
    for (const Refusal& r : m.refused) ADD_FAILURE() << r.where << ": " << r.message;
}

TEST(StepDocuments, PartsAreWhereTheAssemblyHasThem) {
    for (const Link link : {Link::property, Link::reference, Link::definition}) {
        Folder f{{{"part.stp", polygon_file(kTriangle)},
                  {"whole.stp", assembly({{.file = "part.stp", .place = "10.,0.,0.", .link = link},
                                          {.file = "part.stp",
                                           .place = "0.,0.,5.",
                                           .z = "1.,0.,0.",
                                           .x = "0.,1.,0.",
                                           .link = link}})}}};
        const Model m = must(f.read("whole.stp"));
        expect_no_refusals(m);
        expect_points(m, {{10, 0, 0}, {14, 0, 0}, {10, 3, 0}, {0, 0, 5}, {0, 4, 5}, {0, 0, 8}});
        EXPECT_EQ(m.faces.size(), 2u);
        ASSERT_EQ(m.bodies.size(), 2u);
        EXPECT_EQ(m.bodies[0].name, "part 0");
        EXPECT_EQ(m.bodies[1].name, "part 1");
        EXPECT_EQ(f.asked["part.stp"], 1);
    }
}

TEST(StepDocuments, UnitsAreThoseOfEachFile) {
    // Inches in millimetres, also where the assembly says inches of the part and the file millimetres.
    Folder f{{{"inch.stp", inch_triangle()},
              {"mm.stp", polygon_file(kTriangle)},
              {"whole.stp", assembly({{.file = "inch.stp", .place = "1.,0.,0."},
                                      {.file = "mm.stp", .place = "2.,0.,0."}})}}};
    const Model m = must(f.read("whole.stp"));
    expect_no_refusals(m);
    EXPECT_EQ(m.unit, "mm");
    const double s = 25.4;
    expect_points(m, {{1, 0, 0}, {1 + 4 * s, 0, 0}, {1, 3 * s, 0}, {2, 0, 0}, {6, 0, 0}, {2, 3, 0}});
    EXPECT_GT(m.edges[3].tolerance, 0);
    EXPECT_NEAR(m.edges[0].tolerance, s * m.edges[3].tolerance, 1e-15);

    f.files["whole.stp"] =
        assembly({{.file = "mm.stp", .place = "2.,0.,0.", .context = "#903"}},
                 kInches +
                     "#903=(GEOMETRIC_REPRESENTATION_CONTEXT(3)"
                     "GLOBAL_UNIT_ASSIGNED_CONTEXT((#900))REPRESENTATION_CONTEXT('',''));\n");
    const Model in_inches = must(f.read("whole.stp"));
    EXPECT_EQ(in_inches.unit, "inch");  // that of the first representation with a shape
    expect_points(in_inches, {{2 / s, 0, 0}, {6 / s, 0, 0}, {2 / s, 3 / s, 0}});
}

TEST(StepDocuments, AssembliesInFoldersAreInEachOther) {
    Folder f{{{"sub/part.stp", polygon_file(kTriangle)},
              {"sub/inner.stp", assembly({{.file = "part.stp", .place = "0.,10.,0."},
                                          {.file = "./part.stp", .place = "0.,20.,0."}})},
              {"whole.stp", assembly({{.file = "sub\\inner.stp", .place = "100.,0.,0."},
                                      {.file = "sub/part.stp", .place = "0.,0.,1."},
                                      {.file = "sub/inner.stp", .place = "200.,0.,0."}})}}};
    const Model m = must(f.read("whole.stp"));
    expect_no_refusals(m);
    ASSERT_EQ(m.bodies.size(), 5u);
    const auto points = points_of(m);
    ASSERT_EQ(points.size(), 15u);
    const std::vector<Vec<3>> first{{100, 10, 0}, {100, 20, 0}, {0, 0, 1}, {200, 10, 0}, {200, 20, 0}};
    for (std::size_t i = 0; i < first.size(); ++i) EXPECT_NEAR(norm(points[3 * i] - first[i]), 0, 1e-12) << i;
    // What has a name in its own file keeps it.
    EXPECT_EQ(m.bodies[0].name, "part 0");
    EXPECT_EQ(m.bodies[1].name, "part 1");
    EXPECT_EQ(m.bodies[2].name, "part 1");
    for (const auto& [path, times] : f.asked) EXPECT_EQ(times, 1) << path;
    EXPECT_EQ(f.asked.size(), 2u);
}

TEST(StepDocuments, OnlyFilesBesideAndBelowAreAskedFor) {
    for (const char* name : {"/etc/part.stp", "C:\\\\parts\\\\part.stp", "../../part.stp", "a/../../part.stp",
                             "file:///x/part.stp", ".\\\\part.stp"}) {
        Folder f{{{"part.stp", polygon_file(kTriangle)},
                  {"whole.stp", assembly({{.file = name, .place = "0.,0.,0."}})}}};
        EXPECT_EQ(must(f.read("whole.stp")).faces.size(), 1u) << name;
        EXPECT_EQ(f.asked.size(), 1u) << name;
    }
}

TEST(StepDocuments, FilesOfFoldersThatAreNotThereLieBesideTheOneThatNamesThem) {
    Folder f{{{"a/part.stp", polygon_file(kTriangle)},
              {"a/inner.stp", assembly({{.file = "parts\\\\part.stp", .place = "0.,0.,1."}})},
              {"whole.stp", assembly({{.file = "a/inner.stp", .place = "0.,0.,0."}})}}};
    const Model m = must(f.read("whole.stp"));
    expect_no_refusals(m);
    EXPECT_EQ(m.faces.size(), 1u);
    EXPECT_EQ(f.asked.count("a/parts/part.stp"), 1u);  // rather there
    EXPECT_EQ(f.asked.count("part.stp"), 0u);
    f.files["a/parts/part.stp"] = "ISO-10303-21;\nHEADER;";
    EXPECT_EQ(must(f.read("whole.stp")).faces.size(), 1u);
    f.files.erase("a/part.stp");
    const auto broken = f.read("whole.stp");
    ASSERT_FALSE(broken);
    EXPECT_NE(broken.error().message.find("'a/parts/part.stp': "), std::string::npos)
        << broken.error().message;
}

TEST(StepDocuments, NameOfTheDocumentWhereTheFileHasNone) {
    // The name that is assigned comes first.
    Folder f{{{"part.stp", polygon_file(kTriangle)},
              {"whole.stp", assembly({{.file = "part.stp", .place = "0.,0.,0.", .document = "DOC-0815"}})}}};
    EXPECT_EQ(must(f.read("whole.stp")).faces.size(), 1u);
    EXPECT_EQ(f.asked.count("DOC-0815"), 0u);
    // Another one is tried where there is no such file.
    f.files["whole.stp"] = assembly({{.file = "part 7", .place = "0.,0.,0.", .document = "part.stp"}});
    const Model m = must(f.read("whole.stp"));
    expect_no_refusals(m);
    EXPECT_EQ(m.faces.size(), 1u);
    // Told is what is wrong with the one that is there.
    f.files["part.stp"] = "ISO-10303-21;\nHEADER;";
    for (const bool first : {true, false}) {
        f.files["whole.stp"] = assembly({{.file = first ? "part.stp" : "part 7",
                                          .place = "0.,0.,0.",
                                          .document = first ? "DOC-0815" : "part.stp"}});
        const auto broken = f.read("whole.stp");
        ASSERT_FALSE(broken);
        EXPECT_EQ(broken.error().kind, RefusalKind::unreadable);
        EXPECT_NE(broken.error().message.find("'part.stp': "), std::string::npos) << broken.error().message;
    }
}

TEST(StepDocuments, WhatIsNotThereIsTold) {
    const std::string own = assembly(
        {{.file = "far.stp", .place = "0.,0.,0."}, {.file = "far.stp", .place = "1.,0.,0."}}, "", "");
    // Nothing else: the whole is refused, with the name.
    const auto none = read_step(own);
    ASSERT_FALSE(none);
    EXPECT_EQ(none.error().kind, RefusalKind::unsupported);
    EXPECT_EQ(none.error().where, "#10020 DOCUMENT_FILE");
    EXPECT_NE(none.error().message.find("'far.stp': no other file is at hand"), std::string::npos)
        << none.error().message;

    // Beside others: the rest is there.
    Folder f{{{"near.stp", polygon_file(kTriangle)},
              {"broken.stp", "ISO-10303-21;\nHEADER;"},
              {"native.prt", std::string("\0\1\2", 3)},
              {"empty.stp", flat_file("")},
              {"whole.stp", assembly({{.file = "near.stp", .place = "0.,0.,0."},
                                      {.file = "far.stp", .place = "1.,0.,0."},
                                      {.file = "broken.stp", .place = "2.,0.,0."},
                                      {.file = "native.prt", .place = "3.,0.,0."},
                                      {.file = "empty.stp", .place = "4.,0.,0."}})}}};
    const Model m = must(f.read("whole.stp"));
    EXPECT_EQ(m.faces.size(), 1u);
    ASSERT_EQ(m.refused.size(), 4u);
    const struct {
        RefusalKind kind;
        const char *where, *file, *why;
    } wanted[] = {{RefusalKind::io, "#20020", "'far.stp'", "there is no such file"},
                  {RefusalKind::unreadable, "#30020", "'broken.stp'", "ends"},
                  {RefusalKind::unreadable, "#40020", "'native.prt'", "ISO-10303-21"},
                  {RefusalKind::no_answer, "#50020", "'empty.stp'", "no faces and no curves"}};
    for (std::size_t i = 0; i < 4; ++i) {
        const Refusal& r = m.refused[i];
        EXPECT_EQ(r.kind, wanted[i].kind) << r.message;
        EXPECT_TRUE(r.where.starts_with(wanted[i].where)) << r.where;
        EXPECT_NE(r.message.find(wanted[i].file), std::string::npos) << r.message;
        EXPECT_NE(r.message.find(wanted[i].why), std::string::npos) << r.message;
    }
}

TEST(StepDocuments, WhatIsToldInAFileNamesIt) {
    // A face that is refused, a curve that bounds none, and a layer.
    const std::string more =
        "#800=GEOMETRIC_CURVE_SET('',(#803));\n#803=POLYLINE('',(#100,#101));\n#9=SHAPE_REPRESENTATION('',(#"
        "800),#1);\n"
        "#801=PRESENTATION_LAYER_ASSIGNMENT('inner','of the part',(#12));\n"
        "#802=PRESENTATION_LAYER_ASSIGNMENT('both','',(#12));\n"
        "#820=SHELL_BASED_SURFACE_MODEL('',(#821));\n#821=OPEN_SHELL('',(#822));\n"
        "#822=ADVANCED_FACE('',(#13),#823,.T.);\n#823=BLOCK('',#5,1.,1.,1.);\n";
    Folder f{{{"part.stp", replaced(polygon_file(kTriangle, more), "(#10)", "(#10,#820)")},
              {"whole.stp", assembly({{.file = "part.stp", .place = "0.,0.,0."}})}}};
    const Model m = must(f.read("whole.stp"));
    EXPECT_EQ(m.faces.size(), 1u);
    ASSERT_EQ(m.refused.size(), 2u);
    EXPECT_TRUE(m.refused[0].where.starts_with("part.stp: #822 ADVANCED_FACE")) << m.refused[0].where;
    EXPECT_EQ(m.refused[1].where, "file");  // no face is missing
    EXPECT_TRUE(m.refused[1].message.starts_with("part.stp: ")) << m.refused[1].message;
    ASSERT_EQ(m.layers.size(), 2u);
    EXPECT_EQ(m.layers[0].name, "inner");
    EXPECT_EQ(m.layers[0].description, "of the part");
    EXPECT_EQ(m.faces[0].layers, (std::vector{0, 1}));
}

// What was mended, approximated and repaired in a part, in the unit of the assembly; its colours stay.
TEST(StepDocuments, WhatWasDoneToAFileNamesIt) {
    const std::string colour =
        "#830=STYLED_ITEM('',(#831),#12);\n#831=PRESENTATION_STYLE_ASSIGNMENT((#832));\n"
        "#832=SURFACE_STYLE_USAGE(.BOTH.,#833);\n#833=SURFACE_SIDE_STYLE('',(#834));\n"
        "#834=SURFACE_STYLE_FILL_AREA(#835);\n#835=FILL_AREA_STYLE('',(#836));\n"
        "#836=FILL_AREA_STYLE_COLOUR('',#837);\n#837=COLOUR_RGB('',1.,0.,0.);\n";
    std::string gaping = polygon_file({{0, 0}, {3, 0}, {3, 2}, {2.99, 2}, {0, 2}}, colour + kInches);
    gaping.erase(gaping.find("#502,"), 5);
    Folder f{{{"gaping.stp", replaced(gaping, "CONTEXT((#2))", "CONTEXT((#900))")},
              {"turned.stp", replaced(polygon_file(kTriangle), "#401,.T.", "#401,.F.")},
              {"short.stp", replaced(polygon_file(kTriangle), "#101=CARTESIAN_POINT('',(4,0,0.))",
                                     "#101=CARTESIAN_POINT('',(4.,0.0002,0.))")},
              {"inner.stp", assembly({{.file = "gaping.stp", .place = "0.,0.,0."}})},
              {"whole.stp", assembly({{.file = "inner.stp", .place = "0.,0.,0."},
                                      {.file = "turned.stp", .place = "0.,0.,1."},
                                      {.file = "short.stp", .place = "0.,0.,2."}})}}};
    StepReadOptions options = f.options();
    options.repair = true;
    const Model m = must(read_step(f.files.at("whole.stp"), options));
    expect_no_refusals(m);
    ASSERT_EQ(m.repairs.size(), 1u);
    EXPECT_EQ(m.repairs[0].where, "inner.stp: gaping.stp: #14 EDGE_LOOP");
    EXPECT_NEAR(m.repairs[0].distance, 0.01 * 25.4, 1e-9);
    ASSERT_EQ(m.faces.size(), 3u);
    EXPECT_EQ(m.faces[0].colour.has_value(), true);
    EXPECT_EQ(m.faces[1].colour.has_value(), false);
    int of_turned = 0, of_short = 0;
    for (const Approximation& a : m.approximations) {
        of_turned += a.where.starts_with("turned.stp: ") || a.what.starts_with("turned.stp: ");
        of_short += a.where.starts_with("edges[") && a.what.starts_with("short.stp: #40");
    }
    EXPECT_GE(of_turned, 1);
    EXPECT_EQ(of_short, 2);  // that end beside their vertex
}

TEST(StepDocuments, LayersOfTheSameNameAreOne) {
    const auto part = [](std::string_view one, std::string_view two) {
        return polygon_file(kTriangle, text("#801=PRESENTATION_LAYER_ASSIGNMENT('", one,
                                            "','',(#12));\n#802=PRESENTATION_LAYER_ASSIGNMENT('", two,
                                            "','',(#12,#400));\n"));
    };
    // Read first inside another file, which numbers layers in its own way.
    Folder f{{{"a.stp", part("x", "y")},
              {"b.stp", part("y", "z")},
              {"inner.stp",
               assembly({{.file = "b.stp", .place = "0.,0.,0."}, {.file = "a.stp", .place = "0.,0.,0."}})},
              {"whole.stp",
               assembly({{.file = "inner.stp", .place = "0.,0.,0."}, {.file = "a.stp", .place = "0.,0.,0."}},
                        "#801=PRESENTATION_LAYER_ASSIGNMENT('x','',(#5));\n")}}};
    const Model m = must(f.read("whole.stp"));
    expect_no_refusals(m);
    std::vector<std::string> names;
    for (const Layer& l : m.layers) names.push_back(l.name);
    EXPECT_EQ(names, (std::vector<std::string>{"x", "y", "z"}));
    ASSERT_EQ(m.faces.size(), 3u);
    EXPECT_EQ(m.faces[0].layers, (std::vector{1, 2}));  // b
    EXPECT_EQ(m.faces[1].layers, (std::vector{0, 1}));  // a
    EXPECT_EQ(m.faces[2].layers, (std::vector{0, 1}));
    EXPECT_EQ(m.edges[0].layers, (std::vector{2}));
    EXPECT_EQ(m.edges[6].layers, (std::vector{1}));
}

TEST(StepDocuments, APartThatHasItsShapeKeepsIt) {
    Folder f{{{"drawing.stp", polygon_file({{0, 0}, {9, 0}, {0, 9}})},
              {"whole.stp", assembly({{.file = "drawing.stp", .place = "0.,0.,2.", .items = ",#700"}},
                                     "#700=GEOMETRIC_CURVE_SET('',(#701));\n#701=POLYLINE('',(#6,#702));\n"
                                     "#702=CARTESIAN_POINT('',(1.,0.,0.));\n")}}};
    const Model m = must(f.read("whole.stp"));
    expect_no_refusals(m);
    EXPECT_TRUE(m.faces.empty());
    EXPECT_EQ(m.edges.size(), 1u);
    EXPECT_TRUE(f.asked.empty());
}

TEST(StepDocuments, WhatContainsItselfIsRefused) {
    Folder f{{{"near.stp", polygon_file(kTriangle)},
              {"a.stp",
               assembly({{.file = "near.stp", .place = "0.,0.,0."}, {.file = "b.stp", .place = "1.,0.,0."}})},
              {"b.stp", assembly({{.file = "near.stp", .place = "2.,0.,0."},
                                  {.file = "a.stp", .place = "3.,0.,0."}})}}};
    const Model m = must(f.read("a.stp"));
    expect_points(m, {{0, 0, 0}, {4, 0, 0}, {0, 3, 0}, {3, 0, 0}, {7, 0, 0}, {3, 3, 0}});
    ASSERT_EQ(m.refused.size(), 1u);
    EXPECT_EQ(m.refused[0].kind, RefusalKind::invalid);
    EXPECT_EQ(m.refused[0].where, "b.stp: #20020 DOCUMENT_FILE");
    EXPECT_NE(m.refused[0].message.find("'a.stp': contains itself"), std::string::npos);
}

TEST(StepDocuments, TowersEndAtTheLimits) {
    // Each file has the next one twice: 2^40 places of one face.
    Folder f;
    for (int i = 0; i < 40; ++i) {
        const std::string next = i == 39 ? "near.stp" : text(i + 1, ".stp");
        f.files[text(i, ".stp")] =
            assembly({{.file = next, .place = "1.,0.,0."}, {.file = next, .place = "2.,0.,0."}});
    }
    f.files["near.stp"] = polygon_file(kTriangle);
    const auto deep = f.read("0.stp");
    ASSERT_FALSE(deep);
    EXPECT_EQ(deep.error().kind, RefusalKind::limit);
    EXPECT_NE(deep.error().message.find("nested too deep"), std::string::npos) << deep.error().message;

    StepReadOptions little = f.options();
    little.memory_bytes = 1 << 24;
    const auto large = read_step(f.files.at("20.stp"), little);
    ASSERT_FALSE(large);
    EXPECT_EQ(large.error().kind, RefusalKind::limit);
    EXPECT_NE(large.error().message.find("16777216 bytes"), std::string::npos) << large.error().message;
}

}  // namespace
}  // namespace freiform
