#include "support/documents.hpp"

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>

namespace freiform {
namespace {

using test::kEverything;
using test::must_read;
using test::must_refuse;
using Json = nlohmann::ordered_json;

// All places of a document: the path as refusals name it, and the pointer.
void each_place(const Json& v, const std::string& path, const Json::json_pointer& at,
                std::vector<std::pair<std::string, Json::json_pointer>>& out) {
    if (!path.empty()) out.emplace_back(path, at);
    if (v.is_object())
        for (const auto& [key, child] : v.items())
            each_place(child, path.empty() ? key : path + "." + key, at / key, out);
    if (v.is_array())
        for (std::size_t i = 0; i < v.size(); ++i)
            each_place(v[i], path + "[" + std::to_string(i) + "]", at / i, out);
}

TEST(DocumentRefusals, name_the_place_of_a_value_of_the_wrong_kind_everywhere) {
    const Json whole = Json::parse(kEverything);
    std::vector<std::pair<std::string, Json::json_pointer>> places;
    each_place(whole, "", Json::json_pointer(), places);
    int cases = 0;
    for (const auto& [path, at] : places)
        for (const Json& wrong :
             {Json(nullptr), Json("?"), Json(true), Json(0.5), Json::object(), Json::array()}) {
            const Json& right = whole[at];
            if (right.type() == wrong.type() || (right.is_number() && wrong.is_number())) continue;
            Json damaged = whole;
            damaged[at] = wrong;
            const auto d = read_document(damaged.dump());
            ASSERT_FALSE(d) << path << " = " << wrong;
            EXPECT_EQ(d.error().where, path) << wrong << ": " << d.error().message;
            EXPECT_NE(d.error().message.find("expected"), std::string::npos) << d.error().message;
            ++cases;
        }
    EXPECT_GT(cases, 1500);
}

TEST(DocumentRefusals, name_unknown_fields_everywhere_and_say_what_was_meant) {
    const Json whole = Json::parse(kEverything);
    std::vector<std::pair<std::string, Json::json_pointer>> places;
    each_place(whole, "", Json::json_pointer(), places);
    places.emplace_back("", Json::json_pointer());
    int cases = 0;
    for (const auto& [path, at] : places) {
        if (!whole[at].is_object()) continue;
        Json damaged = whole;
        damaged[at]["quatsch"] = 1;
        const Refusal r = must_refuse(damaged.dump());
        EXPECT_EQ(r.where, path.empty() ? "quatsch" : path + ".quatsch");
        ++cases;
    }
    EXPECT_GT(cases, 40);
    const Refusal r = must_refuse(R"({"objects": [{"type": "curve", "point": [[0],[1]]}]})");
    EXPECT_EQ(r.where, "objects[0].point");
    EXPECT_NE(r.message.find("did you mean \"points\"?"), std::string::npos) << r.message;
}

TEST(DocumentRefusals, name_missing_fields) {
    const Json whole = Json::parse(kEverything);
    for (const std::string path : {"/objects/0/points",
                                   "/objects/0/degree",
                                   "/objects/0/type",
                                   "/objects/1/degree",
                                   "/objects/3/points",
                                   "/objects/3/degrees",
                                   "/objects/6/points",
                                   "/objects/6/tangents",
                                   "/objects/7/surface",
                                   "/objects/7/loops",
                                   "/objects/7/surface/points",
                                   "/objects/7/loops/1/0/centre",
                                   "/objects/7/loops/1/0/x",
                                   "/objects/8/faces",
                                   "/objects/8/vertices/0/point",
                                   "/objects/8/edges/0/start",
                                   "/objects/8/edges/0/end",
                                   "/objects/8/edges/1/curve/origin",
                                   "/objects/8/edges/1/curve/direction",
                                   "/objects/8/faces/0/surface",
                                   "/objects/8/faces/0/surface/profile",
                                   "/objects/8/faces/0/loops/0/0/edge",
                                   "/objects/8/faces/0/loops/0/0/curve",
                                   "/objects/8/faces/1/surface/axis",
                                   "/objects/8/faces/1/surface/origin",
                                   "/objects/8/faces/2/surface/base",
                                   "/objects/8/faces/2/surface/distance",
                                   "/objects/8/shells/0/faces",
                                   "/objects/8/shells/0/faces/0/face",
                                   "/objects/8/bodies/0/shells",
                                   "/objects/8/refused/0/message",
                                   "/objects/8/approximations/0/bound",
                                   "/objects"}) {
        const Json::json_pointer at(path);
        Json damaged = whole;
        damaged[at.parent_pointer()].erase(at.back());
        const Refusal r = must_refuse(damaged.dump());
        std::string expected;
        for (std::string_view rest = std::string_view(path).substr(1); !rest.empty();) {
            const std::string part(rest.substr(0, rest.find('/')));
            rest.remove_prefix(std::min(rest.size(), part.size() + 1));
            const bool index = part.find_first_not_of("0123456789") == std::string::npos;
            expected += index ? "[" + part + "]" : (expected.empty() ? "" : ".") + part;
        }
        const bool degrees = path == "/objects/3/degrees";
        EXPECT_EQ(r.where, degrees ? expected + "[0]" : expected) << r.message;
        EXPECT_NE(r.message.find("is missing"), std::string::npos) << r.message;
    }
}

TEST(DocumentRefusals, name_contradictions_and_say_what_was_expected) {
    struct Case {
        const char *object, *where, *message;
        RefusalKind kind = RefusalKind::invalid;
    };
    for (
        const Case& c : {
            Case{R"({"type":"curve","degree":2,"points":[[0],[1]]})", "degree",
                 "degree 2 needs 3 points, found 2"},
            {R"({"type":"curve","degree":1,"knots":[0,0,1],"points":[[0],[1]]})", "knots",
             "3 knots for 2 points of degree 1 needs 4"},
            {R"({"type":"curve","degree":1,"knots":[0,0,1,0.5],"points":[[0],[1]]})", "knots[3]",
             "decreases: 1 -> 0.5"},
            {R"({"type":"curve","degree":1,"knots":[0,0,0,1,1],"points":[[0],[1],[2]]})", "knots[0]",
             "repeated"},
            {R"({"type":"curve","degree":1,"knots":[1,1,1,1],"points":[[0],[1]]})", "knots", "is empty"},
            {R"({"type":"curve","degree":1,"knots":[0,0,1,1e999],"points":[[0],[1]]})", "knots[3]", "1.8e308",
             RefusalKind::nonfinite},
            {R"({"type":"curve","degree":-1,"points":[[0],[1]]})", "degree", "at least 0"},
            {R"({"type":"curve","degree":1.5,"points":[[0],[1]]})", "degree", "whole number"},
            {R"({"type":"curve","degree":1e300,"points":[[0],[1]]})", "degree", "whole number"},
            {R"({"type":"curve","degree":26,"knots":[0,0,1,1],"points":[[0],[1]]})", "knots",
             "4 knots for 2 points"},
            {R"({"type":"curve","points":[]})", "points", "is empty"},
            {R"({"type":"curve","points":[[],[]]})", "points[0]", "1 to 4 numbers"},
            {R"({"type":"curve","points":[[1,2,3,4,5],[1,2,3,4,5]]})", "points[0]", "1 to 4 numbers"},
            {R"({"type":"curve","points":[[1,2],[1,2,3]]})", "points[1]",
             "has 3 coordinates, the points before have 2"},
            {R"({"type":"curve","points":[[1,2],[1,1e999]]})", "points[1][1]", "1.8e308",
             RefusalKind::nonfinite},
            {R"({"type":"curve","points":[[0],[1e308]]})", "points[1]", "2^1022", RefusalKind::unsupported},
            {R"({"type":"curve","points":[[0],[1]],"weights":[1]})", "weights", "1 weights for 2 points"},
            {R"({"type":"curve","points":[[0],[1]],"weights":[1,0]})", "weights", "0 at the parameter 1"},
            {R"({"type":"curve","points":[[0],[1]],"weights":[1,-1]})", "weights",
             "between the parameters 0.4999"},
            {R"({"type":"curve","points":[[0],[1e200]],"weights":[1,1e200]})", "points[1][0]",
             "leaves the range", RefusalKind::nonfinite},
            {R"({"type":"curve","points":[[0],[1]],"weights":[1,1e-320]})", "weights[1]", "subnormal",
             RefusalKind::unsupported},
            {R"({"type":"curve","points":[[0],[3]],"weights":[1,2],"weighted_points":[[0],[7]]})",
             "weighted_points[1][0]", "7 is not the point 3 times"},
            {R"({"type":"curve","points":[[0],[3]],"weighted_points":[[0],[6]]})", "weighted_points",
             "needs weights"},
            {R"({"type":"curve","points":[[0],[3]],"weights":[1,2],"weighted_points":[[0]]})",
             "weighted_points", "not of the same shape"},
            {R"({"type":"curve","degree":2,"closed":true,"knots":[0,1,2],"points":[[0],[1],[2]]})", "knots",
             "3 breaks for 3 points, a closed spline needs 4"},
            {R"({"type":"curve","degree":2,"closed":true,"knots":[0,1,0.5,2],"points":[[0],[1],[2]]})",
             "knots[2]", "decreases"},
            {R"({"type":"surface","points":[[[0],[1]],[[0]]]})", "points[1]",
             "has 1 entries, the rows before have 2"},
            {R"({"type":"surface","points":[[[0],[1]],[[0],[1,2]]]})", "points[1][1]", "has 2 coordinates"},
            {R"({"type":"surface","points":[[[0],[1]],[[0],[1e308]]]})", "points[1][1]", "2^1022",
             RefusalKind::unsupported},
            {R"({"type":"surface","points":[[0,0],[1,1]]})", "points[0][0]", "expected a point"},
            {R"({"type":"surface","degrees":[1],"points":[[[0],[1]],[[0],[1]]]})", "degrees",
             "an array of 2"},
            {R"({"type":"surface","degree":1,"points":[[[0],[1]],[[0],[1]]]})", "degree",
             "did you mean \"degrees\"?"},
            {R"({"type":"surface","degrees":[1,2],"points":[[[0],[1]],[[0],[1]]]})", "degrees[1]",
             "needs 3 points"},
            {R"({"type":"surface","degrees":[1,1],"knots":[[0,0,1,1],[0,0,2,1]],"points":[[[0],[1]],[[0],[1]]]})",
             "knots[1][3]", "decreases"},
            {R"({"type":"surface","points":[[[0],[1]],[[0],[1]]],"weights":[[1,1],[1,0]]})", "weights",
             "0 at the parameters (1, 1)"},
            {R"({"type":"triangle","points":[[0],[1],[2]],"weights":[1,1,0]})", "weights[2]", "not positive"},
            {R"({"type":"surface","points":[[[0],[1]],[[0],[1]]],"weights":[[1,1],[1]]})", "weights[1]",
             "has 1 entries"},
            {R"({"type":"triangle","degree":2,"points":[[0],[1],[2]]})", "points", "degree 2 has 6"},
            {R"({"type":"triangle","points":[[0],[1],[2],[3]]})", "points", "4 points, a triangle"},
            {R"({"type":"triangle","degree":26,"points":[[0],[1],[2]]})", "degree", "outside 0..25",
             RefusalKind::unsupported},
            {R"({"type":"hermite","points":[[0]],"tangents":[[0]]})", "points", "at least 2 points"},
            {R"({"type":"hermite","points":[[0],[1]],"tangents":[[0]]})", "tangents",
             "1 tangents for 2 points"},
            {R"({"type":"hermite","points":[[0],[1]],"tangents":[[0],[1,2]]})", "tangents[1]",
             "an array of 1 numbers"},
            {R"({"type":"hermite","points":[[0],[1]],"tangents":[[0],[1]],"parameters":[1,1]})",
             "parameters[1]", "does not increase"},
            {R"({"type":"curves","points":[[0],[1]]})", "type", "did you mean \"curve\"?"},
        }) {
        const Refusal r = must_refuse(std::string(R"({"objects": [{"type":"curve","points":[[0],[1]]}, )") +
                                      c.object + "]}");
        EXPECT_EQ(r.where, std::string("objects[1].") + c.where) << c.object << r.message;
        EXPECT_NE(r.message.find(c.message), std::string::npos) << c.object << "\n" << r.message;
        EXPECT_EQ(r.kind, c.kind) << c.object;
        EXPECT_EQ(must_refuse(c.object).where, c.where);
    }
}

TEST(DocumentRefusals, of_other_things_than_documents) {
    for (const char* text : {"", " ", "7", "[]", "\"x\"", "null", "{}", "{\"objects\": {}}",
                             "{\"freiform\": 2, \"objects\": []}", "\x00\x01\x02", "\xFF\xFE",
                             "{\"objects\": [[]]}", "{\"objects\": [1]}", "NaN", "<xml/>"}) {
        const Refusal r = must_refuse(text);
        EXPECT_FALSE(r.message.empty()) << text;
    }
    EXPECT_EQ(must_refuse("{\"freiform\": 2, \"objects\": []}").where, "freiform");
}

TEST(DocumentRefusals, of_models_whose_parts_do_not_fit) {
    const Json whole = Json::parse(kEverything);
    struct Case {
        const char* at;
        Json value;
        const char* where;
    };
    for (const Case& c : {Case{"/edges/0/start", 7, "edges[0].start"},
                          {"/edges/0/range", {1, 1}, "edges[0].range"},
                          {"/faces/0/loops/0/0/edge", -1, "faces[0].loops[0][0].edge"},
                          {"/faces/0/loops/0", Json::array(), "faces[0].loops[0]"},
                          {"/shells/0/faces/1/face", 3, "shells[0].faces[1]"},
                          {"/bodies/0/shells", {0, 1}, "bodies[0].shells[1]"},
                          {"/faces/0/colour", {1, 2, 0}, "faces[0].colour[1]"},
                          {"/faces/0/colour", {1, 0}, "faces[0].colour"},
                          {"/edges/0/colour", {1, 2, 0}, "edges[0].colour[1]"},
                          {"/edges/0/layers", {9}, "edges[0].layers[0]"},
                          {"/faces/0/tolerance", -1, "faces[0].tolerance"},
                          {"/faces/1/surface/axis", {0, 0, 2}, "faces[1].surface.axis"},
                          {"/faces/0/surface/direction", {0, 0, 0}, "faces[0].surface.direction"},
                          {"/faces/0/surface/kind", "plain", "faces[0].surface.kind"},
                          {"/edges/1/curve/direction", {0, 0, 0}, "edges[1].curve.direction"},
                          {"/edges/1/curve/type", "lines", "edges[1].curve.type"},
                          {"/edges/5/curve/points", Json::parse("[[0,0],[1,1]]"), "edges[5].curve.points"},
                          {"/refused/0/kind", "odd", "refused[0].kind"},
                          {"/faces/2/surface/base",
                           {{"type", "offset"}, {"base", 1}, {"distance", 1}},
                           "faces[2].surface.base.type"}}) {
        Json damaged = whole;
        damaged["objects"][8][Json::json_pointer(c.at)] = c.value;
        const Refusal r = must_refuse(damaged.dump());
        EXPECT_EQ(r.where, std::string("objects[8].") + c.where) << r.message;
    }
}

TEST(DocumentRefusals, of_damaged_text_or_valid_and_never_more) {
    const std::string good = write_document(must_read(kEverything));
    const std::string alphabet = "{}[],:\"0123456789.-+eE \n\xFF";
    std::mt19937 random(21);
    int accepted = 0;
    for (int i = 0; i < 4000; ++i) {
        std::string text = good;
        for (unsigned k = random() % 3 + 1; k > 0; --k) {
            const std::size_t at = random() % text.size();
            switch (random() % 4) {
                case 0:
                    text[at] = alphabet[random() % alphabet.size()];
                    break;
                case 1:
                    text.erase(at, 1 + random() % 20);
                    break;
                case 2:
                    text.insert(at, text.substr(random() % text.size(), random() % 30));
                    break;
                default:
                    if (random() % 20 == 0) text.resize(at + 1);
            }
        }
        const auto d = read_document(text);
        if (!d) {
            ASSERT_FALSE(d.error().message.empty());
            continue;
        }
        ++accepted;
        const std::string once = write_document(*d);
        const auto again = read_document(once);
        ASSERT_TRUE(again) << again.error().where << again.error().message << "\n" << text;
        ASSERT_EQ(write_document(*again), once);
    }
    EXPECT_GT(accepted, 100);
}

}  // namespace
}  // namespace freiform
