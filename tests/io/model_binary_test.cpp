#include <freiform/io/model_binary.hpp>

#include <cstdint>
#include <cstring>
#include <gtest/gtest.h>
#include <limits>
#include <random>

namespace {

using namespace freiform;

template <std::size_t N, class P>
Patch<N, P> patch(std::array<BSplineBasis, N> bases, std::vector<P> net) {
    Index<N> extent{};
    for (std::size_t d = 0; d < N; ++d) extent[d] = bases[d].size();
    return *Patch<N, P>::make(std::move(bases), Net<N, P>(extent, std::move(net)));
}

// A model with every alternative of every type, and with numbers that a careless format loses.
Model everything() {
    constexpr double kTiny = std::numeric_limits<double>::denorm_min();
    const auto bezier = *BSplineBasis::bezier(1);
    const auto closed = *BSplineBasis::periodic(2, {0, 0.1, 0.30000000000000004, 1});
    const std::vector<Vec<3>> two{{{-0.0, kTiny, 1e300}}, {{0.1, 1 / 3.0, -5}}};
    const std::vector<Hom<3>> weighted_two{{{1, 2, 3, 0.1}}, {{4, 5, 6, 1e-8}}};
    Model m;
    m.unit = "mm";
    m.vertices = {{{{1, 2, 3}}, 0.125}, {{{-0.0, kTiny, 2}}, 0}};
    const auto edge = [&](std::optional<CurveGeometry<3>> c) {
        Edge e;
        e.curve = std::move(c);
        e.end = 1, e.start = 0;
        e.range = {0.25, 0.75};
        e.tolerance = 1e-7;
        e.name = "kante \xc3\xa9";
        m.edges.push_back(e);
    };
    edge(Line<3>{{{1, 2, 3}}, {{0, 0, kTiny}}});
    for (ConicKind kind : {ConicKind::ellipse, ConicKind::hyperbola, ConicKind::parabola})
        edge(Conic<3>{kind, {{1, 2, 3}}, {{4, 0, 0}}, {{0, 5, 0}}});
    edge(patch<1, Vec<3>>({bezier}, two));
    edge(patch<1, Hom<3>>({bezier}, weighted_two));
    edge(patch<1, Vec<3>>({closed}, {two[0], two[1], two[0]}));
    edge(std::nullopt);
    m.edges.back().degenerate = true;
    m.edges.back().end = 0;
    const auto face = [&](SurfaceGeometry s) {
        Face f;
        f.surface = std::move(s);
        f.reversed = m.faces.size() % 2 == 0;
        f.tolerance = 1e-3;
        f.name = text("face ", m.faces.size());
        if (f.reversed) f.colour = Colour{0.1, 0.2, 0.3, 0.4};
        f.loops.resize(2);
        f.loops[0].coedges = {{0, false, Line<2>{{{1, 2}}, {{3, 4}}}},
                              {1, true, Conic<2>{ConicKind::ellipse, {{0, 0}}, {{1, 0}}, {{0, -1}}}}};
        f.loops[1].coedges = {{2, false, patch<1, Vec<2>>({bezier}, {{{0, 1}}, {{2, 3}}})},
                              {7, true, patch<1, Hom<2>>({bezier}, {{{0, 1, 1}}, {{2, 3, 2}}})}};
        m.faces.push_back(std::move(f));
    };
    const Extrusion plane{Line<3>{{{0, 0, 0}}, {{1, 0, 0}}}, {{0, 1, 0}}, SurfaceKind::plane};
    face(plane);
    face(Revolution{Conic<3>{ConicKind::ellipse, {{5, 0, 0}}, {{1, 0, 0}}, {{0, 0, 1}}},
                    {{0, 0, 0}},
                    {{0, 0, 1}},
                    SurfaceKind::torus});
    face(patch<2, Vec<3>>({bezier, closed}, {two[0], two[1], two[0], two[1], two[0], two[1]}));
    face(patch<2, Hom<3>>({bezier, bezier},
                          {weighted_two[0], weighted_two[1], weighted_two[1], weighted_two[0]}));
    face(OffsetSurface{std::make_shared<const SurfaceGeometry>(plane), -0.1});
    m.shells = {{{{0, false}, {4, true}}, true}, {{{1, false}}, false}};
    m.bodies = {{{0, 1}, true, "solid", Colour{1, 0, 0, 1}}, {{1}, false, "", std::nullopt}};
    m.layers = {{"walls", "outside"}, {"2", ""}};
    m.faces[1].layers = {0, 1}, m.bodies[0].layers = {1};
    m.edges[1].layers = {1}, m.edges[1].colour = Colour{0, 0.5, 1, 1};
    m.repairs = {{"#14 EDGE_LOOP", "was open", 0.01}};
    m.refused = {{RefusalKind::unsupported, "#12 FACE", "has no counterpart"}, {RefusalKind::io, "", ""}};
    m.approximations = {{"edges[3]", "moved", 1e-5}, {"edges[4]", "sampled", std::nullopt, 2e-5}};
    return m;
}

TEST(ModelBinary, gives_back_every_part_to_the_last_bit) {
    const Model m = everything();
    ASSERT_TRUE(make_model(m).has_value()) << make_model(m).error().where << make_model(m).error().message;
    const std::string bytes = to_binary(m);
    const auto back = from_binary(bytes);
    ASSERT_TRUE(back.has_value()) << back.error().where << ": " << back.error().message;
    EXPECT_EQ(to_binary(*back), bytes);
    EXPECT_EQ(back->unit, m.unit);
    ASSERT_EQ(back->edges.size(), m.edges.size());
    for (std::size_t i = 0; i < m.edges.size(); ++i) {
        EXPECT_EQ(back->edges[i].curve, m.edges[i].curve) << i;
        EXPECT_EQ(back->edges[i].degenerate, m.edges[i].degenerate) << i;
        EXPECT_EQ(back->edges[i].range, m.edges[i].range) << i;
        EXPECT_EQ(back->edges[i].start, m.edges[i].start) << i;
        EXPECT_EQ(back->edges[i].end, m.edges[i].end) << i;
        EXPECT_EQ(back->edges[i].tolerance, m.edges[i].tolerance) << i;
        EXPECT_EQ(back->edges[i].name, m.edges[i].name) << i;
        EXPECT_EQ(back->edges[i].colour, m.edges[i].colour) << i;
        EXPECT_EQ(back->edges[i].layers, m.edges[i].layers) << i;
    }
    ASSERT_EQ(back->faces.size(), m.faces.size());
    for (std::size_t i = 0; i < m.faces.size(); ++i) {
        const Face &a = back->faces[i], &b = m.faces[i];
        EXPECT_EQ(kind_name(a.surface), kind_name(b.surface)) << i;
        EXPECT_EQ(jet<2>(a.surface, {0.3, 0.6}).d, jet<2>(b.surface, {0.3, 0.6}).d) << i;
        EXPECT_EQ(a.reversed, b.reversed) << i;
        EXPECT_EQ(a.tolerance, b.tolerance) << i;
        EXPECT_EQ(a.name, b.name) << i;
        EXPECT_EQ(a.colour, b.colour) << i;
        ASSERT_EQ(a.loops.size(), b.loops.size()) << i;
        for (std::size_t l = 0; l < b.loops.size(); ++l)
            for (std::size_t c = 0; c < b.loops[l].coedges.size(); ++c) {
                EXPECT_EQ(a.loops[l].coedges[c].edge, b.loops[l].coedges[c].edge);
                EXPECT_EQ(a.loops[l].coedges[c].reversed, b.loops[l].coedges[c].reversed);
                EXPECT_EQ(a.loops[l].coedges[c].curve, b.loops[l].coedges[c].curve);
            }
    }
    EXPECT_TRUE(std::signbit(back->vertices[1].point[0]));
    EXPECT_EQ(back->vertices[1].point[1], std::numeric_limits<double>::denorm_min());
    EXPECT_EQ(back->refused, m.refused);
    ASSERT_EQ(back->approximations.size(), 2u);
    EXPECT_EQ(back->approximations[0].bound, 1e-5);
    EXPECT_EQ(back->approximations[1].bound, std::nullopt);
    EXPECT_EQ(back->approximations[1].estimate, 2e-5);
    ASSERT_EQ(back->layers.size(), 2u);
    EXPECT_EQ(back->layers[0].description, "outside");
    EXPECT_EQ(back->faces[1].layers, (std::vector{0, 1}));
    EXPECT_EQ(back->bodies[0].layers, (std::vector{1}));
    ASSERT_EQ(back->repairs.size(), 1u);
    EXPECT_EQ(back->repairs[0].distance, 0.01);
    EXPECT_TRUE(back->bodies[0].solid);
    EXPECT_EQ(back->shells[0].faces[1].face, 4);
    EXPECT_TRUE(back->shells[0].faces[1].reversed);
}

TEST(ModelBinary, refuses_every_truncation_and_every_extension) {
    const std::string bytes = to_binary(everything());
    for (std::size_t n = 0; n < bytes.size(); ++n) {
        const auto back = from_binary(std::string_view(bytes).substr(0, n));
        ASSERT_FALSE(back.has_value()) << n;
        EXPECT_EQ(back.error().where.substr(0, 5), "byte ") << n;
        EXPECT_FALSE(back.error().message.empty()) << n;
    }
    EXPECT_FALSE(from_binary(bytes + '\0').has_value());
}

// Whatever is changed, the answer is a refusal or a model that is as valid as any.
TEST(ModelBinary, survives_changed_bytes) {
    const std::string bytes = to_binary(everything());
    std::mt19937_64 random(1);
    int accepted = 0, refused = 0;
    for (int round = 0; round < 20000; ++round) {
        std::string changed = bytes;
        for (int k = 0; k < 1 + round % 4; ++k) {
            const std::size_t at = random() % changed.size();
            switch (random() % 4) {
                case 0:
                    changed[at] = char(random());
                    break;
                case 1:
                    changed[at] = char(0xff);
                    break;
                case 2:
                    changed.erase(at, 1 + random() % 16);
                    break;
                default:
                    changed.insert(at, 1 + random() % 16, char(random() % 3));
                    break;
            }
        }
        const auto back = from_binary(changed);
        if (back) {
            ++accepted;
            const auto valid = make_model(*back);
            ASSERT_TRUE(valid.has_value()) << round;
            ASSERT_EQ(to_binary(*back), changed) << round;
        } else {
            ++refused;
            ASSERT_FALSE(back.error().message.empty()) << round;
        }
    }
    EXPECT_GT(accepted, 1000);  // changed coordinates and names
    EXPECT_GT(refused, 1000);
}

TEST(ModelBinary, believes_no_count_that_the_bytes_cannot_hold) {
    std::string bytes = to_binary(Model{});
    // After magic, version and the empty unit: the number of vertices.
    const std::uint32_t many = 0xffffffff;
    std::memcpy(bytes.data() + 16, &many, sizeof many);
    const auto back = from_binary(bytes);
    ASSERT_FALSE(back.has_value());
    EXPECT_EQ(back.error().where, "byte 16");
    EXPECT_EQ(back.error().message,
              text("4294967295 items are announced, ", bytes.size() - 20, " bytes are left"));
}

TEST(ModelBinary, does_not_nest_offsets) {
    Model m = everything();
    const auto base = std::make_shared<const SurfaceGeometry>(m.faces[4].surface);
    m.faces[4].surface = OffsetSurface{base, 1};
    EXPECT_FALSE(from_binary(to_binary(m)).has_value());
}

TEST(ModelBinary, tells_another_version_from_damage) {
    std::string bytes = to_binary(Model{});
    ASSERT_TRUE(from_binary(bytes).has_value());
    ++bytes[8];
    ASSERT_FALSE(from_binary(bytes).has_value());
    EXPECT_EQ(from_binary(bytes).error().kind, RefusalKind::unsupported);
}

}  // namespace
