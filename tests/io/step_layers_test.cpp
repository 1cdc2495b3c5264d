// Layers of STEP files: read, kept in documents and scenes, written again.
#include <freiform/io/document.hpp>
#include <freiform/io/scene.hpp>
#include <freiform/io/step.hpp>
#include <freiform/io/step_read.hpp>

#include <support/random.hpp>
#include <support/refusal.hpp>
#include <support/step_polygons.hpp>

namespace freiform::test {
namespace {

const std::vector<Corner> kSquare{{0, 0}, {3, 0}, {3, 2}, {0, 2}};

std::vector<std::string> names_of(const Model& m, const std::vector<int>& layers) {
    std::vector<std::string> names;
    for (const int l : layers) names.push_back(m.layers[std::size_t(l)].name);
    return names;
}
using Names = std::vector<std::string>;

Model layered_model(std::string_view assignments) {
    auto m = read_step(polygon_file(kSquare, assignments));
    EXPECT_TRUE(m) << m.error().where << ": " << m.error().message;
    return m ? *m : Model{};
}

TEST(StepLayers, faces_and_bodies_are_on_the_layers_that_name_them_or_their_styles) {
    const Model m = layered_model(
        "#900=PRESENTATION_LAYER_ASSIGNMENT('walls','outside',(#12,#11));\n"
        "#901=PRESENTATION_LAYER_ASSIGNMENT('2','',(#950));\n"
        "#902=PRESENTATION_LAYER_ASSIGNMENT('walls','again',(#12));\n"
        "#903=PRESENTATION_LAYER_ASSIGNMENT('empty hands','',(#6));\n"
        "#950=STYLED_ITEM('',(),#12);\n");
    ASSERT_EQ(m.layers.size(), 3u);
    EXPECT_EQ(m.layers[0].description, "outside");
    ASSERT_EQ(m.faces.size(), 1u);
    EXPECT_EQ(names_of(m, m.faces[0].layers), (Names{"walls", "2"}));
    // The shell is on a layer, and so is the body that it makes.
    ASSERT_EQ(m.bodies.size(), 1u);
    EXPECT_EQ(names_of(m, m.bodies[0].layers), (Names{"walls"}));
    EXPECT_TRUE(m.refused.empty());
}

TEST(StepLayers, what_is_written_is_read_again_the_same) {
    const Model m = layered_model(
        "#900=PRESENTATION_LAYER_ASSIGNMENT('it''s','d',(#12,#10));\n"
        "#901=PRESENTATION_LAYER_ASSIGNMENT('b','',(#10));\n");
    const auto bytes = write_step({"mm", {{"", m}}});
    ASSERT_TRUE(bytes) << bytes.error().message;
    const auto again = read_step(*bytes);
    ASSERT_TRUE(again) << again.error().message;
    ASSERT_EQ(again->layers.size(), 2u);
    EXPECT_EQ(again->layers[0].name, "it's");
    EXPECT_EQ(again->layers[0].description, "d");
    EXPECT_EQ(again->faces.at(0).layers, m.faces.at(0).layers);
    EXPECT_EQ(again->bodies.at(0).layers, m.bodies.at(0).layers);
    EXPECT_EQ(again->bodies.at(0).layers.size(), 2u);
}

TEST(StepLayers, models_that_are_joined_have_layers_of_one_name_once) {
    const Model a = layered_model("#900=PRESENTATION_LAYER_ASSIGNMENT('x','',(#12));\n");
    const Model b = layered_model(
        "#900=PRESENTATION_LAYER_ASSIGNMENT('y','',(#12));\n"
        "#901=PRESENTATION_LAYER_ASSIGNMENT('x','',(#12,#10));\n");
    const auto both = scene_of({"mm", {{"", a}, {"", b}}});
    ASSERT_TRUE(both) << both.error().message;
    ASSERT_EQ(both->layers.size(), 2u);
    EXPECT_EQ(names_of(*both, both->faces.at(0).layers), (Names{"x"}));
    EXPECT_EQ(names_of(*both, both->faces.at(1).layers), (Names{"y", "x"}));
    EXPECT_EQ(names_of(*both, both->bodies.at(1).layers), (Names{"x"}));
}

TEST(StepLayers, layers_that_are_not_there_are_refused_by_their_place_and_items_on_too_many_told) {
    Model m = layered_model("");
    m.faces.at(0).layers = {0};
    expect_refusal(make_model(m), RefusalKind::invalid, "faces[0].layers[0]", "index 0");
    m.faces[0].layers.clear(), m.bodies.at(0).layers = {-1};
    expect_refusal(make_model(m), RefusalKind::invalid, "bodies[0].layers[0]", "index -1");
    m.bodies[0].layers.clear(), m.edges.at(2).layers = {0};
    expect_refusal(make_model(m), RefusalKind::invalid, "edges[2].layers[0]", "index 0");
    std::string many;
    for (int i = 0; i < 100; ++i)
        many += text("#", 1000 + i, "=PRESENTATION_LAYER_ASSIGNMENT('", i, "','',(#12));\n");
    const Model full = layered_model(many);
    EXPECT_EQ(full.layers.size(), 100u);
    EXPECT_EQ(full.faces.at(0).layers.size(), 64u);
    EXPECT_TRUE(full.refused.empty());  // no shape is missing
    ASSERT_EQ(full.approximations.size(), 1u);
    EXPECT_EQ(full.approximations[0].where, "#12 ADVANCED_FACE");
    EXPECT_EQ(full.approximations[0].what, "is on 100 layers; 64 of them are kept");
    EXPECT_EQ(full.approximations[0].bound, 0);
}

TEST(StepLayers, what_is_on_too_many_with_what_it_consists_of_or_is_part_of_is_told) {
    const auto assigned = [](int first, int count, std::string_view item) {
        std::string out;
        for (int i = first; i < first + count; ++i)
            out += text("#", 1000 + i, "=PRESENTATION_LAYER_ASSIGNMENT('", i, "','',(", item, "));\n");
        return out;
    };
    const std::string mapped =
        "#20=SHAPE_REPRESENTATION('',(#21),#1);\n#21=MAPPED_ITEM('',#22,#5);\n#22=REPRESENTATION_MAP(#5,#8);"
        "\n";
    for (const std::string& other : {assigned(40, 30, "#11"), mapped + assigned(40, 30, "#21")}) {
        const Model m = layered_model(assigned(0, 40, "#10") + other);
        ASSERT_EQ(m.bodies.size(), 1u);
        EXPECT_EQ(m.layers.size(), 70u);
        EXPECT_EQ(m.bodies[0].layers.size(), 64u);
        EXPECT_TRUE(m.refused.empty());
        ASSERT_EQ(m.approximations.size(), 1u) << other;
        EXPECT_EQ(m.approximations[0].where, "file");
        EXPECT_TRUE(m.approximations[0].what.starts_with("6 times a layer is left out"))
            << m.approximations[0].what;
        EXPECT_EQ(m.approximations[0].bound, 0);
    }
    EXPECT_TRUE(layered_model(assigned(0, 40, "#10") + assigned(40, 24, "#11")).approximations.empty());
}

TEST(StepLayers, colours_of_faces_and_bodies_are_written_and_read_again_the_same) {
    Model m = layered_model("");
    const auto again = [&] { return *read_step(*write_step({"mm", {{"", m}}})); };
    EXPECT_FALSE(again().faces.at(0).colour);
    EXPECT_FALSE(again().bodies.at(0).colour);
    m.faces.at(0).colour = Colour{0.1, 1.0 / 3, 1, 1};
    const Model face = again();
    ASSERT_TRUE(face.faces.at(0).colour);
    EXPECT_EQ(face.faces[0].colour->r, 0.1);
    EXPECT_EQ(face.faces[0].colour->g, 1.0 / 3);
    EXPECT_EQ(face.faces[0].colour->b, 1);
    EXPECT_FALSE(face.bodies.at(0).colour);
    m.faces[0].colour.reset(), m.bodies.at(0).colour = Colour{0, 0.5, 0.25, 1};
    const Model body = again();
    EXPECT_FALSE(body.faces.at(0).colour);
    ASSERT_TRUE(body.bodies.at(0).colour);
    EXPECT_EQ(body.bodies[0].colour->g, 0.5);
    EXPECT_EQ(body.bodies[0].colour->b, 0.25);
}

// What a curve is drawn with, and what a surface is filled with, are colours of their own.
std::string styled(int id, std::string_view item, std::string_view colour, bool is_curve) {
    const std::string style =
        is_curve ? text("#", id + 2, "=CURVE_STYLE('',#", id + 4, ",POSITIVE_LENGTH_MEASURE(0.5),#", id + 3,
                        ");\n#", id + 4, "=DRAUGHTING_PRE_DEFINED_CURVE_FONT('continuous');\n")
                 : text("#", id + 2, "=SURFACE_STYLE_USAGE(.BOTH.,#", id + 4, ");\n#", id + 4,
                        "=SURFACE_SIDE_STYLE('',(#", id + 5, "));\n#", id + 5, "=SURFACE_STYLE_FILL_AREA(#",
                        id + 6, ");\n#", id + 6, "=FILL_AREA_STYLE('',(#", id + 7, "));\n#", id + 7,
                        "=FILL_AREA_STYLE_COLOUR('',#", id + 3, ");\n");
    return text("#", id, "=STYLED_ITEM('',(#", id + 1, "),", item, ");\n#", id + 1,
                "=PRESENTATION_STYLE_ASSIGNMENT((#", id + 2, "));\n", style, "#", id + 3, "=", colour, ";\n");
}

TEST(StepLayers, edges_have_the_colours_of_curves_and_layers) {
    const Model m = layered_model(styled(900, "#401", "COLOUR_RGB('',0.25,0.5,0.75)", true) +
                                  styled(920, "#402", "DRAUGHTING_PRE_DEFINED_COLOUR('red')", false) +
                                  styled(940, "#12", "DRAUGHTING_PRE_DEFINED_COLOUR('blue')", true) +
                                  "#960=PRESENTATION_LAYER_ASSIGNMENT('rim','',(#400,#12));\n"
                                  "#961=PRESENTATION_LAYER_ASSIGNMENT('styled','',(#900));\n");
    ASSERT_EQ(m.edges.size(), 4u);
    EXPECT_EQ(m.edges[1].colour, (Colour{0.25, 0.5, 0.75, 1}));
    for (const std::size_t i : {0, 2, 3}) EXPECT_FALSE(m.edges[i].colour) << "a fill is no line: " << i;
    EXPECT_FALSE(m.faces.at(0).colour) << "a line is no fill";
    EXPECT_EQ(names_of(m, m.edges[0].layers), (Names{"rim"}));
    EXPECT_EQ(names_of(m, m.edges[1].layers), (Names{"styled"}));
    EXPECT_EQ(names_of(m, m.faces[0].layers), (Names{"rim"}));
    const Model again = *read_step(*write_step({"mm", {{"", m}}}));
    ASSERT_EQ(again.edges.size(), 4u);
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_EQ(again.edges[i].colour, m.edges[i].colour) << i;
        EXPECT_EQ(names_of(again, again.edges[i].layers), names_of(m, m.edges[i].layers)) << i;
    }
    // So do documents and scenes.
    const Model b = layered_model("#960=PRESENTATION_LAYER_ASSIGNMENT('other','',(#400));\n");
    const auto document = read_document(write_document({"mm", {{"", b}, {"", m}}}));
    ASSERT_TRUE(document) << document.error().message;
    const auto both = scene_of(*document);
    ASSERT_TRUE(both) << both.error().message;
    EXPECT_EQ(names_of(*both, both->edges.at(0).layers), (Names{"other"}));
    EXPECT_EQ(names_of(*both, both->edges.at(4).layers), (Names{"rim"}));
    EXPECT_EQ(both->edges.at(5).colour, m.edges[1].colour);
}

TEST(StepLayers, wires_have_the_style_of_their_set_where_they_have_none) {
    const auto file = [](std::string_view more) {
        return flat_file(
            text("#8=SHAPE_REPRESENTATION('',(#10),#1);\n#10=GEOMETRIC_CURVE_SET('',(#20,#30));\n"
                 "#20=CIRCLE('',#5,1.);\n#30=CIRCLE('',#5,2.);\n",
                 more));
    };
    const auto m = read_step(file(styled(900, "#10", "COLOUR_RGB('',0.,1.,0.)", true) +
                                  styled(920, "#30", "COLOUR_RGB('',1.,0.,0.)", true) +
                                  "#960=PRESENTATION_LAYER_ASSIGNMENT('set','',(#10));\n"
                                  "#961=PRESENTATION_LAYER_ASSIGNMENT('one','',(#20));\n"));
    ASSERT_TRUE(m) << m.error().message;
    ASSERT_EQ(m->edges.size(), 2u);
    EXPECT_EQ(m->edges[0].colour, (Colour{0, 1, 0, 1}));
    EXPECT_EQ(m->edges[1].colour, (Colour{1, 0, 0, 1}));
    EXPECT_EQ(names_of(*m, m->edges[0].layers), (Names{"set", "one"}));
    EXPECT_EQ(names_of(*m, m->edges[1].layers), (Names{"set"}));
    const Model again = *read_step(*write_step({"mm", {{"", *m}}}));
    ASSERT_EQ(again.edges.size(), 2u);
    for (std::size_t i = 0; i < 2; ++i) {
        EXPECT_EQ(again.edges[i].colour, m->edges[i].colour) << i;
        EXPECT_EQ(names_of(again, again.edges[i].layers), names_of(*m, m->edges[i].layers)) << i;
    }
}

}  // namespace
}  // namespace freiform::test
