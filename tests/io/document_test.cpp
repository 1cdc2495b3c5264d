#include <freiform/io/document.hpp>

#include <bit>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <random>

namespace freiform {
namespace {

using Json = nlohmann::ordered_json;

// One object of every type, with every field.
const char* const kEverything = R"({"freiform": 1, "unit": "mm", "objects": [
  {"name": "c", "type": "curve", "degree": 2, "knots": [0,0,0,0.5,1,1,1], "points": [[0,0],[1,2],[3,2],[4,0]],
   "weights": [1,0.5,2,1], "closed": false},
  {"type": "curve", "degree": 2, "closed": true, "knots": [0,1,2,4], "points": [[0,0,0],[1,0,0],[0,1,5]]},
  {"type": "curve", "points": [[0.25],[-3]]},
  {"type": "surface", "degrees": [1,2], "knots": [[0,0,1,1],[0,0,0,1,1,1]], "closed": [false,false],
   "points": [[[0,0,0],[0,1,0],[0,2,0]],[[1,0,0],[1,1,1],[1,2,0]]], "weights": [[1,2,1],[1,1,3]]},
  {"type": "volume", "degrees": [1,1,1], "knots": [[0,0,1,1],[0,0,1,1],[0,0,1,1]],
   "points": [[[[0,0,0],[0,0,1]],[[0,1,0],[0,1,1]]],[[[1,0,0],[1,0,1]],[[1,1,0],[1,1,1]]]]},
  {"type": "triangle", "degree": 1, "points": [[0,0,0],[1,0,0],[0,1,0]], "weights": [1,2,3]},
  {"type": "hermite", "points": [[0,0],[1,1],[2,0]], "tangents": [[3,0],[3,3],[0,-3]], "parameters": [0,1,3]},
  {"name": "t", "type": "trimmed", "surface": {"degrees": [1,1], "points": [[[0,0,0],[0,1,0]],[[1,0,0],[1,1,0]]]},
   "loops": [[{"degree": 1, "points": [[0,0],[1,0]]}, {"points": [[1,0],[1,1],[0,0]]}],
             [{"type": "ellipse", "centre": [0.7,0.2], "x": [0.1,0], "y": [0,0.1]}]]},
  {"name": "m", "type": "model", "unit": "inch",
   "vertices": [{"point": [1,0,0], "tolerance": 0.5}, {"point": [1,0,2]}, {"point": [0,0,2]}],
   "edges": [{"curve": {"type": "ellipse", "centre": [0,0,0], "x": [1,0,0], "y": [0,1,0]}, "range": [0,6.25],
              "start": 0, "end": 0, "tolerance": 0.125, "name": "e"},
             {"curve": {"type": "line", "origin": [1,0,0], "direction": [0,0,1]}, "range": [0,2], "start": 0, "end": 1},
             {"degenerate": true, "range": [0,1], "start": 2, "end": 2},
             {"curve": {"type": "hyperbola", "centre": [0,0,0], "x": [1,0,0], "y": [0,1,0]}, "range": [0,1], "start": 0, "end": 1},
             {"curve": {"type": "parabola", "centre": [0,0,0], "x": [1,0,0], "y": [0,1,0]}, "range": [0,1], "start": 0, "end": 1},
             {"curve": {"degree": 1, "points": [[0,0,0],[1,2,3]]}, "range": [0,1], "start": 0, "end": 1}],
   "faces": [{"surface": {"type": "extrusion", "profile": {"type": "line", "origin": [0,0,0], "direction": [1,0,0]},
                          "direction": [0,1,0], "kind": "plane"}, "reversed": true, "tolerance": 1, "name": "f",
              "colour": [1,0.5,0,1],
              "loops": [[{"edge": 0, "reversed": true,
                          "curve": {"type": "ellipse", "centre": [0,0], "x": [1,0], "y": [0,1]}}]]},
             {"surface": {"type": "revolution", "profile": {"type": "line", "origin": [1,0,0], "direction": [0,0,1]},
                          "origin": [0,0,0], "axis": [0,0,1], "kind": "cylinder"}},
             {"surface": {"type": "offset", "base": {"degrees": [1,1],
                          "points": [[[0,0,0],[0,1,0]],[[1,0,0],[1,1,0]]]}, "distance": -2}}],
   "shells": [{"faces": [{"face": 0}, {"face": 1, "reversed": true}], "closed": true}],
   "bodies": [{"shells": [0], "solid": true, "name": "b", "colour": [0,0,0,0.5]}],
   "refused": [{"kind": "unsupported", "where": "#12", "message": "why"}],
   "approximations": [{"where": "#13", "what": "a curve", "bound": 1e-9},
                      {"where": "", "what": "another", "estimate": 0.25}]}
]})";

Document must_read(std::string_view text) {
    auto d = read_document(text);
    EXPECT_TRUE(d) << d.error().where << ": " << d.error().message;
    return d ? *d : Document{};
}
Refusal must_refuse(std::string_view text) {
    const auto d = read_document(text);
    EXPECT_FALSE(d) << text;
    return d ? Refusal{} : d.error();
}

TEST(Document, takes_weights_that_are_not_positive_where_there_is_no_pole) {
    // A half circle: the middle control point is at infinity, in the direction (0, 1).
    const Document d = must_read(R"({"type":"curve","points":[[1,0],[0,1],[-1,0]],"weights":[1,0,1],
        "weighted_points":[[1,0],[0,1],[-1,0]]})");
    const auto& half = std::get<Curve<Hom<2>>>(d.objects.at(0).shape);
    EXPECT_EQ(weights(half), (std::vector<double>{1, 0.5, 0.5, 1}));
    EXPECT_NEAR(norm(half(0.3)), 1, 1e-15);
    EXPECT_TRUE(d.objects[0].given_points.empty());
    // All negative: the same curve.
    const Document n = must_read(R"({"type":"curve","points":[[1,0],[1,1],[0,1]],"weights":[-1,-0.5,-1]})");
    EXPECT_EQ(weights(std::get<Curve<Hom<2>>>(n.objects.at(0).shape)), (std::vector<double>{1, 0.5, 1}));
    EXPECT_EQ(must_refuse(R"({"type":"curve","points":[[1,0],[0,1],[-1,0]],"weights":[1,0,1],
        "weighted_points":[[1,0],[0,2],[-1,0]]})")
                  .where,
              "weighted_points[1][1]");
}

TEST(Document, has_one_of_every_type) {
    const Document d = must_read(kEverything);
    ASSERT_EQ(d.objects.size(), 9u);
    EXPECT_EQ(d.unit, "mm");
    const char* const types[] = {"curve",    "curve", "curve",   "surface", "volume",
                                 "triangle", "curve", "trimmed", "model"};
    for (std::size_t i = 0; i < 9; ++i) EXPECT_EQ(type_name(d.objects[i].shape), types[i]);
    EXPECT_EQ(d.objects[0].name, "c");
    const auto& curve = std::get<Curve<Hom<2>>>(d.objects[0].shape);
    EXPECT_EQ(curve.net().flat()[2], (Hom<2>{{6, 4, 2}}));
    EXPECT_TRUE(std::get<Curve<Vec<3>>>(d.objects[1].shape).basis().is_closed());
    const auto& surface = std::get<Surface<Hom<3>>>(d.objects[3].shape);
    EXPECT_EQ(project(surface.net().view()({1, 1})), (Vec<3>{{1, 1, 1}}));
    EXPECT_EQ(surface.net().view()({0, 1}).weight(), 2);
    const auto& triangle = std::get<Triangle<Hom<3>>>(d.objects[5].shape);
    EXPECT_EQ(triangle.coefficient(0, 1), (Hom<3>{{0, 3, 0, 3}}));
    const auto& model = std::get<Model>(d.objects[8].shape);
    EXPECT_EQ(model.unit, "inch");
    EXPECT_EQ(kind_name(model.faces[0].surface), "plane");
    EXPECT_EQ(kind_name(model.faces[2].surface), "offset");
    EXPECT_EQ(kind_name(*model.edges[0].curve), "circle");
    EXPECT_EQ(model.faces[0].colour, (Colour{1, 0.5, 0, 1}));
    EXPECT_TRUE(model.shells[0].faces[1].reversed);
    EXPECT_EQ(model.refused[0], (Refusal{RefusalKind::unsupported, "#12", "why"}));
}

TEST(Document, reads_what_it_writes_and_writes_the_same_again) {
    const std::string once = write_document(must_read(kEverything)), twice = write_document(must_read(once));
    EXPECT_EQ(once, twice);
    // Everything that was given is there, in other words or the same.
    const Json in = Json::parse(kEverything), out = Json::parse(once);
    for (const int i : {0, 3, 5, 8})
        for (const auto& [key, value] : in["objects"][i].items()) {
            if (key == "closed" || key == "faces") continue;
            if (key == "edges") continue;
            EXPECT_EQ(out["objects"][i][key], value) << i << key;
        }
    EXPECT_EQ(out["objects"][8]["faces"][0]["surface"], in["objects"][8]["faces"][0]["surface"]);
    using Unordered = nlohmann::json;
    EXPECT_EQ(Unordered(out["objects"][8]["faces"][0]), Unordered(in["objects"][8]["faces"][0]));
    EXPECT_EQ(out["objects"][8]["edges"][0], in["objects"][8]["edges"][0]);
    EXPECT_EQ(out["objects"][7]["loops"][1], in["objects"][7]["loops"][1]);
}

TEST(Document, may_be_one_object_alone) {
    const Document d = must_read(R"({"type": "curve", "name": "x", "points": [[0,0],[1,1]]})");
    ASSERT_EQ(d.objects.size(), 1u);
    EXPECT_EQ(d.objects[0].name, "x");
    EXPECT_EQ(must_refuse(R"({"type": "curve", "points": [[0,0],[1]]})").where, "points[1]");
    EXPECT_TRUE(must_read(R"({"objects": []})").objects.empty());
}

// --- bits ---

double any_double(std::mt19937_64& random) {
    for (;;) {
        const double x =
            random() % 8 == 0 ? std::array{0.0, -0.0, 5e-324, 2.2250738585072014e-308, 0x1p1021}[random() % 5]
            : random() % 2 == 0 ? std::ldexp(double(std::int64_t(random())), int(random() % 80) - 40)
                                : std::bit_cast<double>(random());
        if (std::abs(x) < 0x1p1022) return x;
    }
}

template <std::size_t N>
BSplineBasis any_basis(std::mt19937_64& random) {
    const int degree = int(random() % 4), size = degree + 1 + int(random() % (N == 3 ? 2 : 4));
    const bool closed = random() % 3 == 0;
    for (;;) {
        std::vector<double> t(std::size_t(closed ? size + 1 : size + degree + 1));
        const double scale = std::ldexp(1.0, int(random() % 600) - 300);
        for (double& x : t) x = scale * double(std::int32_t(random()));
        std::sort(t.begin(), t.end());
        auto b = closed ? BSplineBasis::periodic(degree, t) : BSplineBasis::make(degree, t);
        if (b) return *b;
    }
}

template <class P>
P any_coefficient(std::mt19937_64& random) {
    for (;;) {
        P p;
        for (double& c : p.c) c = any_double(random);
        if constexpr (Space<P>::kRational) {
            p[P::kCoords - 1] = std::ldexp(1 + double(random() % 1000) / 997, int(random() % 40) - 20);
            bool fits = true;
            for (int i = 0; i < Space<P>::kDim; ++i) fits = fits && std::abs(project(p)[i]) < 0x1p1022;
            if (!fits) continue;
        }
        return p;
    }
}

template <class P>
bool same_bits(std::span<const P> a, std::span<const P> b) {
    if (a.size() != b.size()) return false;
    for (std::size_t i = 0; i < a.size(); ++i)
        for (int c = 0; c < P::kCoords; ++c)
            if (std::bit_cast<std::uint64_t>(a[i][c]) != std::bit_cast<std::uint64_t>(b[i][c])) return false;
    return true;
}

template <std::size_t N, class P>
void round_trip_patch(std::mt19937_64& random) {
    auto bases = [&]<std::size_t... I>(std::index_sequence<I...>) {
        return std::array<BSplineBasis, N>{((void)I, any_basis<N>(random))...};
    }
    (std::make_index_sequence<N>{});
    Index<N> extent{};
    for (std::size_t d = 0; d < N; ++d) extent[d] = bases[d].size();
    Net<N, P> net(extent);
    for (P& p : net.flat()) p = any_coefficient<P>(random);
    const auto patch = Patch<N, P>::make(bases, net);
    ASSERT_TRUE(patch) << patch.error().message;
    const std::string text = write_document({"", {{"", *patch, {}}}});
    const auto again = read_document(text);
    ASSERT_TRUE(again) << again.error().where << again.error().message << text;
    const auto* back = std::get_if<Patch<N, P>>(&again->objects.at(0).shape);
    ASSERT_TRUE(back);
    EXPECT_EQ(back->bases(), patch->bases()) << text;
    EXPECT_TRUE(same_bits<P>(back->net().flat(), patch->net().flat())) << text;
    EXPECT_EQ(write_document(*again), text);
}

template <class P>
void round_trip_triangle(std::mt19937_64& random) {
    const int n = int(random() % 5);
    std::vector<P> net(std::size_t((n + 1) * (n + 2) / 2));
    for (P& p : net) p = any_coefficient<P>(random);
    const auto triangle = Triangle<P>::make(n, net);
    ASSERT_TRUE(triangle) << triangle.error().message;
    const auto again = read_document(write_document({"", {{"", *triangle, {}}}}));
    ASSERT_TRUE(again) << again.error().where << again.error().message;
    const auto* back = std::get_if<Triangle<P>>(&again->objects.at(0).shape);
    ASSERT_TRUE(back);
    EXPECT_TRUE(same_bits<P>(back->coefficients(), triangle->coefficients()));
}

template <int D>
void round_trips(std::mt19937_64& random) {
    round_trip_patch<1, Vec<D>>(random), round_trip_patch<1, Hom<D>>(random);
    round_trip_patch<2, Vec<D>>(random), round_trip_patch<2, Hom<D>>(random);
    round_trip_patch<3, Vec<D>>(random), round_trip_patch<3, Hom<D>>(random);
    round_trip_triangle<Vec<D>>(random), round_trip_triangle<Hom<D>>(random);
}

TEST(Document, round_trips_every_bit_of_every_type) {
    std::mt19937_64 random(11);
    for (int i = 0; i < 60 && !HasFailure(); ++i)
        round_trips<1>(random), round_trips<2>(random), round_trips<3>(random), round_trips<4>(random);
}

TEST(Document, gives_rational_points_back_as_they_were_given) {
    std::mt19937_64 random(12);
    const auto some = [&](double scale) { return scale * double(random() % 1'000'000'007) / 1'000'000'007; };
    for (int i = 0; i < 300; ++i) {
        Json points = Json::array(), weights = Json::array();
        for (int k = 0; k < 4; ++k) {
            points.push_back({some(10), some(1e-3), some(1e6)});
            weights.push_back(some(2) + 1e-3);
        }
        const Json object = {{"type", "curve"}, {"points", points}, {"weights", weights}};
        const Json out = Json::parse(write_document(must_read(object.dump())));
        EXPECT_EQ(out["objects"][0]["points"], points);
        EXPECT_EQ(out["objects"][0]["weights"], weights);
        EXPECT_FALSE(out["objects"][0].contains("weighted_points"));
    }
}

TEST(Document, prefers_given_points_only_where_they_fit) {
    Document d = must_read(R"({"type": "curve", "points": [[0.1],[0.3]], "weights": [0.7,0.7]})");
    auto& curve = std::get<Curve<Hom<1>>>(d.objects[0].shape);
    auto net = curve.net();
    net.flat()[1] = weighted(Vec<1>{{0.5}}, 0.7);
    d.objects[0].shape = *Curve<Hom<1>>::make(curve.bases(), net);
    EXPECT_EQ(Json::parse(write_document(d))["objects"][0]["points"], Json::parse("[[0.1],[0.5]]"));
}

TEST(Document, reads_every_example_of_its_description) {
    std::ifstream in(std::string(FREIFORM_SOURCE_DIR) + "/docs/document.md");
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    const std::string begin = "```json\n", end = "```";
    int examples = 0;
    for (std::size_t at = text.find(begin); at != std::string::npos; at = text.find(begin, at)) {
        at += begin.size();
        const std::string example = text.substr(at, text.find(end, at) - at);
        const Document d = must_read(example);
        EXPECT_EQ(d.objects.size(), 1u) << example;
        EXPECT_EQ(write_document(must_read(write_document(d))), write_document(d));
        ++examples;
    }
    EXPECT_EQ(examples, 9);
}

// --- hermite ---

TEST(Document, hermite_is_the_cubic_of_the_course) {
    const Document d =
        must_read(R"({"type": "hermite", "points": [[0,0],[4,0]], "tangents": [[3,6],[3,-6]]})");
    const auto& c = std::get<Curve<Vec<2>>>(d.objects[0].shape);
    EXPECT_EQ(points(c), (std::vector<Vec<2>>{{{0, 0}}, {{1, 2}}, {{3, 2}}, {{4, 0}}}));
    EXPECT_EQ(c.basis(), *BSplineBasis::bezier(3));
}

TEST(Document, hermite_splines_have_the_points_and_tangents_given) {
    const Document d = must_read(
        R"({"type": "hermite", "points": [[0,0],[1,2],[5,1]], "tangents": [[1,0],[2,2],[0,-3]], "parameters": [1,2,5]})");
    const auto& c = std::get<Curve<Vec<2>>>(d.objects[0].shape);
    const double at[] = {1, 2, 5};
    const Vec<2> p[] = {{{0, 0}}, {{1, 2}}, {{5, 1}}}, r[] = {{{1, 0}}, {{2, 2}}, {{0, -3}}};
    for (int i = 0; i < 3; ++i) {
        const auto j = c.jet<1>(at[i]);
        EXPECT_LT(norm(j.d[0] - p[i]), 1e-14);
        EXPECT_LT(norm(j.d[1] - r[i]), 1e-13);
    }
}

// --- refusals ---

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

TEST(Document, refuses_a_value_of_the_wrong_kind_at_every_place_and_names_it) {
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

TEST(Document, refuses_unknown_fields_everywhere_and_says_what_was_meant) {
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

TEST(Document, refuses_missing_fields_and_names_them) {
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

TEST(Document, refuses_contradictions_and_says_what_was_expected) {
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

TEST(Document, refuses_other_things_than_documents) {
    for (const char* text : {"", " ", "7", "[]", "\"x\"", "null", "{}", "{\"objects\": {}}",
                             "{\"freiform\": 2, \"objects\": []}", "\x00\x01\x02", "\xFF\xFE",
                             "{\"objects\": [[]]}", "{\"objects\": [1]}", "NaN", "<xml/>"}) {
        const Refusal r = must_refuse(text);
        EXPECT_FALSE(r.message.empty()) << text;
    }
    EXPECT_EQ(must_refuse("{\"freiform\": 2, \"objects\": []}").where, "freiform");
}

TEST(Document, refuses_models_whose_parts_do_not_fit) {
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

TEST(Document, damaged_text_is_refused_or_valid_and_never_more) {
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
