#include "support/documents.hpp"

#include <bit>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <nlohmann/json.hpp>
#include <random>

namespace freiform {
namespace {

using Json = nlohmann::ordered_json;
using test::kEverything;
using test::must_read;
using test::must_refuse;

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

TEST(Document, says_where_weights_needed_knots_and_how_far_that_moved_what) {
    // A half circle whose middle control point is at infinity, scaled so that halving is rounded.
    const std::string half = R"("points":[[0.3,0],[0,0.3],[-0.3,0]],"weights":[1,0,1],
        "weighted_points":[[0.3,0],[0,0.3],[-0.3,0]])";
    const auto arc = must_read(text(R"({"type":"curve",)", half, "}"));
    const auto& own = arc.objects.at(0).approximations;
    ASSERT_EQ(own.size(), 1u);
    EXPECT_EQ(own[0].where, "");
    EXPECT_EQ(own[0].what, "1 knot inserted to make all weights positive");
    const auto& curve = std::get<Curve<Hom<2>>>(arc.objects[0].shape);
    ASSERT_TRUE(own[0].bound);
    for (const double t : {0.125, 0.3, 0.7})  // (1 - 2 t, 2 t (1 - t)) / ((1 - t)^2 + t^2), times 0.3
        EXPECT_LE(norm(curve(t) - 0.3 / (1 - 2 * t * (1 - t)) * Vec<2>{{1 - 2 * t, 2 * t * (1 - t)}}),
                  *own[0].bound + 2e-16)
            << t;
    EXPECT_LT(*own[0].bound, 1e-14);
    EXPECT_GT(*own[0].bound, 0);
    // Inside a trimmed surface: a loop of the half circle and its diameter.
    const auto trimmed =
        must_read(text(R"({"type":"trimmed","surface":{"points":[[[-1,-1,0],[-1,1,0]],[[1,-1,0],[1,1,0]]],)",
                       R"("knots":[[-1,-1,1,1],[-1,-1,1,1]],"degrees":[1,1]},"loops":[[{)", half,
                       R"(},{"points":[[-0.3,0],[0.3,0]]}]]})"));
    ASSERT_EQ(trimmed.objects.at(0).approximations.size(), 1u);
    EXPECT_EQ(trimmed.objects[0].approximations[0].where, "loops[0][0]");
    // Signs that are turned change nothing, nor do positive weights.
    EXPECT_TRUE(must_read(R"({"type":"curve","points":[[1,0],[1,1],[0,1]],"weights":[-1,-0.5,-1]})")
                    .objects[0]
                    .approximations.empty());
    const Document again = must_read(write_document(arc));
    EXPECT_TRUE(again.objects[0].approximations.empty());
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

}  // namespace
}  // namespace freiform
