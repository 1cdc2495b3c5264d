#include "gpu/scene.hpp"
#include "support/random.hpp"
#include "support/refusal.hpp"
#include "support/solids.hpp"

#include <freiform/gpu/surfaces.hpp>

#include <bit>
#include <cmath>
#include <gtest/gtest.h>
#include <map>

namespace freiform {
namespace {

// A surface over a grid whose heights and weights are random: without folds.
Surface<Hom<3>> hills(test::Random& random, int p, int q, int spans, double height = 0.2) {
    const std::array bases{*BSplineBasis::clamped_uniform(p, p + spans),
                           *BSplineBasis::clamped_uniform(q, q + spans)};
    Net<2, Hom<3>> net({p + spans, q + spans});
    each_index(net.extent(), [&](const Index<2>& at) {
        net.view()(at) = weighted(Vec<3>{{double(at[0]) / (p + spans - 1), double(at[1]) / (q + spans - 1),
                                          random.real(-height, height)}},
                                  random.real(0.5, 2));
    });
    return *Surface<Hom<3>>::make(bases, net);
}

Model model_of(const Surface<Hom<3>>& surface) {
    ModelBuilder builder;
    EXPECT_TRUE(builder.add(surface));
    return *std::move(builder).finish();
}

class Surfaces : public testing::Test {
protected:
    void SetUp() override {
        options_.width = 300, options_.height = 225;
        const auto probe = SurfaceRenderer::make(buffers(test::sphere(Vec<3>{}, 1.0)));
        if (!probe && probe.error().kind == RefusalKind::unavailable) GTEST_SKIP() << probe.error().message;
        ASSERT_TRUE(probe) << probe.error().message;
    }
    static SurfaceBuffers buffers(const Model& model) {
        return test::must(surface_buffers(model, {.edge_tolerance = summary(model).box.diagonal() / 8000}));
    }
    // Of a whole face that is not trimmed: the parameter of a place in one of its pieces.
    static Vec<2> parameter_of(const SurfaceBuffers& b, const std::array<Interval, 2>& on, int piece,
                               const std::array<float, 2>& at) {
        const auto* record = &b.texels[std::size_t(b.pieces + 4 * piece)];
        Vec<2> uv;
        for (const std::size_t d : {std::size_t(0), std::size_t(1)}) {
            const double bow = record[2][d], x = 2.0 * double(at[d]) - 1;
            const double q = bow == 0  ? double(record[1][2 * d + 1]) * at[d]
                             : bow > 0 ? double(record[1][2 * d + 1]) * 2 * std::atan(bow * x)
                                       : double(record[1][2 * d + 1]) * 2 * std::atanh(-bow * x);
            uv[int(d)] = on[d].lo + on[d].length() * (double(record[1][2 * d]) + q);
        }
        return uv;
    }
    struct Off {
        double position = 0, angle = 0;
        int compared = 0;
    };
    // The vertices of face 0 against the processor; its loops are the rectangle `on`.
    Off compare(const Model& model, const std::array<Interval, 2>& on) {
        const SurfaceBuffers b = buffers(model);
        auto renderer = test::must(SurfaceRenderer::make(b));
        Off off;
        for (const SurfaceVertex& v : test::must(renderer.triangles(options_, 1))) {
            if (b.texels[std::size_t(b.pieces + 4 * v.piece)][1] != 0) continue;
            const Vec<2> uv = parameter_of(b, on, v.piece, v.at);
            const Vec<3> p = (1 / b.size) * (jet<0>(model.faces[0].surface, uv.c).value() - b.middle);
            const Vec<3> found{{v.position[0], v.position[1], v.position[2]}},
                n{{v.normal[0], v.normal[1], v.normal[2]}};
            off.position = std::max(off.position, norm(found - p));
            // Of this piece, where a knot lets the normal jump.
            std::array<float, 2> beside = v.at;
            for (float& x : beside) x = std::clamp(x, 0x1p-22f, 1 - 0x1p-22f);
            const Vec<3> expected = normal(model.faces[0].surface, parameter_of(b, on, v.piece, beside).c);
            if (expected != Vec<3>{})
                off.angle = std::max(off.angle, norm(n - (model.faces[0].reversed ? -expected : expected)));
            ++off.compared;
        }
        return off;
    }

    RenderOptions options_;
};

constexpr double kPositions = 2e-6;  // 1e-6 of the box, whose side is 2
constexpr double kNormals = 1e-4;

TEST_F(Surfaces, splines_have_the_points_and_normals_of_the_processor) {
    test::Random random(1);
    for (const auto& [p, q, spans] : {std::array{2, 3, 8}, {10, 10, 1}, {1, 7, 2}}) {
        const Surface<Hom<3>> s = hills(random, p, q, spans);
        const Off off = compare(model_of(s), s.domain());
        EXPECT_LT(off.position, kPositions) << p << " " << q;
        EXPECT_LT(off.angle, kNormals) << p << " " << q;
        EXPECT_GT(off.compared, 5);
    }
}

TEST_F(Surfaces, analytic_surfaces_have_the_points_and_normals_of_the_processor) {
    const double turn = 2 * test::kPi;
    const Off ball = compare(test::sphere(Vec<3>{{1, 2, 3}}, 2.0), {{{0, turn}, {-turn / 4, turn / 4}}});
    const Off ring = compare(test::torus(3.0, 1.0), {{{0, turn}, {0, turn}}});
    const Off cone = compare(test::frustum(1, 0.25, 2), {{{0, turn}, {0, 1}}});
    for (const Off& off : {ball, ring, cone}) {
        EXPECT_LT(off.position, kPositions);
        EXPECT_LT(off.angle, kNormals);
        EXPECT_GT(off.compared, 100);
    }
    // An offset has the normals of its base.
    Model shell = test::torus(3.0, 1.0);
    shell.faces[0].surface =
        OffsetSurface{std::make_shared<const SurfaceGeometry>(shell.faces[0].surface), 0.25};
    for (Edge& e : shell.edges) e.curve.reset();
    const Off off = compare(shell, {{{0, turn}, {0, turn}}});
    EXPECT_LT(off.position, kPositions);
    EXPECT_LT(off.angle, kNormals);
}

TEST_F(Surfaces, normals_at_poles_are_their_limits) {
    const SurfaceBuffers b = buffers(test::sphere(Vec<3>{}, 1.0));
    auto renderer = test::must(SurfaceRenderer::make(b));
    int poles = 0;
    for (const SurfaceVertex& v : test::must(renderer.triangles(options_))) {
        if (std::abs(v.position[2]) < 1 - 1e-6f) continue;
        EXPECT_NEAR(v.normal[2] * v.position[2], 1, 1e-7) << v.at[0] << " " << v.at[1];
        EXPECT_LT(std::hypot(v.normal[0], v.normal[1]), kNormals);
        ++poles;
    }
    EXPECT_GT(poles, 8);
    // A side that is one point, to the bit.
    test::Random random(8);
    const Surface<Hom<3>> hill = hills(random, 2, 3, 2);
    Net<2, Hom<3>> net = hill.net();
    for (int j = 0; j < net.extent()[1]; ++j)
        net.view()({0, j}) = weighted(Vec<3>{{0, 0.5, 0}}, net.view()({0, j}).weight());
    const auto fan = *Surface<Hom<3>>::make(hill.bases(), net);
    const SurfaceBuffers f = buffers(model_of(fan));
    auto drawn = test::must(SurfaceRenderer::make(f));
    poles = 0;
    for (const SurfaceVertex& v : test::must(drawn.triangles(options_, 1))) {
        const Vec<2> uv = parameter_of(f, fan.domain(), v.piece, v.at);
        if (uv[0] != 0 || v.at[1] == 0 || v.at[1] == 1) continue;
        const auto j = fan.jet<2>({0, uv[1]});
        const Vec<3> limit = unit(cross(j(1, 0), j(1, 1)));
        for (std::size_t d = 0; d < 3; ++d) EXPECT_NEAR(v.normal[d], limit[int(d)], kNormals) << uv[1];
        ++poles;
    }
    EXPECT_GT(poles, 3);
}

TEST_F(Surfaces, neighbouring_pieces_have_the_same_points_to_the_bit) {
    test::Random random(2);
    const Surface<Hom<3>> s = hills(random, 3, 2, 4);
    const SurfaceBuffers b = buffers(model_of(s));
    auto renderer = test::must(SurfaceRenderer::make(b));
    ASSERT_EQ(b.tensor_pieces, 16);
    std::map<std::array<int, 3>, std::array<float, 3>> sides;  // piece, side, place along it
    for (const SurfaceVertex& v : test::must(renderer.triangles(options_)))
        for (const std::size_t d : {std::size_t(0), std::size_t(1)})
            for (const int end : {0, 1})
                if (v.at[d] == float(end))
                    sides[{v.piece, int(2 * d) + end, std::bit_cast<int>(v.at[1 - d])}] = v.position;
    int compared = 0;
    for (const auto& [key, position] : sides) {
        const auto [piece, side, along] = key;
        if (side % 2 == 0) continue;
        const int next = side == 1 ? piece + 4 : piece % 4 == 3 ? 16 : piece + 1;
        if (next >= 16) continue;
        const auto other = sides.find({next, side - 1, along});
        ASSERT_NE(other, sides.end()) << piece << " " << side << " " << std::bit_cast<float>(along);
        EXPECT_EQ(position, other->second);
        ++compared;
    }
    EXPECT_GT(compared, 24 * 2);
}

TEST_F(Surfaces, triangles_are_within_the_deviation) {
    test::Random random(3);
    for (const bool perspective : {false, true}) {
        options_.perspective = perspective;
        const Surface<Hom<3>> s = hills(random, 3, 4, 3, 0.6);
        const SurfaceBuffers b = buffers(model_of(s));
        auto renderer = test::must(SurfaceRenderer::make(b));
        for (const double deviation : {4.0, 0.5}) {
            const auto v = test::must(renderer.triangles(options_, deviation));
            const double allowed = deviation / make_scene(b, options_).pixels;
            double most = 0;
            for (std::size_t i = 0; i < v.size(); i += 3) {
                std::array<float, 2> at{};
                Vec<3> middle;
                for (std::size_t k = i; k < i + 3; ++k)
                    for (std::size_t d = 0; d < 3; ++d) {
                        middle[int(d)] += double(v[k].position[d]) / 3;
                        if (d < 2) at[d] += v[k].at[d] / 3;
                    }
                const Vec<2> uv = parameter_of(b, s.domain(), v[i].piece, at);
                most = std::max(most, norm(middle - (1 / b.size) * (s(uv[0], uv[1]) - b.middle)));
            }
            EXPECT_LE(most, allowed);
            EXPECT_GT(most, 0.03 * allowed) << "needlessly fine";
        }
    }
}

// A patch whose second derivatives are all the same: no bound of them is larger than it has to be.
TEST_F(Surfaces, triangles_of_triangular_patches_are_within_the_deviation) {
    std::vector<Hom<3>> net;
    for (const Vec<3>& p :
         {Vec<3>{{0, 0, 0}}, {{1, 0, 0}}, {{0, 1, 0}}, {{2, 0, 1}}, {{1, 1, -1}}, {{0, 2, 1}}})
        net.push_back(weighted(p, 1.0));
    const TriangularFace face{*SimplexPatch<2, Hom<3>>::make(2, net), {}};
    const SurfaceBuffers b =
        test::must(surface_buffers(Model{}, std::span(&face, 1), {.edge_tolerance = 1e-3}));
    auto renderer = test::must(SurfaceRenderer::make(b));
    for (const double deviation : {1.0, 0.02}) {  // the second with more levels than the hardware has
        const auto v = test::must(renderer.triangles(options_, deviation));
        const double allowed = deviation / make_scene(b, options_).pixels;
        double most = 0, area = 0;
        for (std::size_t i = 0; i < v.size(); i += 3) {
            for (std::size_t k = 0; k < 4; ++k) {  // the middles of its sides, its own
                std::array<double, 3> l{1.0 / 3, 1.0 / 3, 1.0 / 3};
                if (k < 3) l = {0.5, 0.5, 0.5}, l[k] = 0;
                Vec<3> flat;
                Param<2> at{};
                for (std::size_t c = 0; c < 3; ++c) {
                    for (std::size_t d = 0; d < 3; ++d) flat[int(d)] += l[c] * double(v[i + c].position[d]);
                    for (std::size_t d = 0; d < 2; ++d) at[d] += l[c] * double(v[i + c].at[d]);
                }
                most = std::max(most, norm(flat - (1 / b.size) * (face.patch(at) - b.middle)));
            }
            area += ((v[i + 1].at[0] - v[i].at[0]) * double(v[i + 2].at[1] - v[i].at[1]) -
                     (v[i + 2].at[0] - v[i].at[0]) * double(v[i + 1].at[1] - v[i].at[1])) /
                    2;
        }
        EXPECT_LE(most, allowed + 1e-6);
        EXPECT_GT(most, 0.3 * allowed) << "needlessly fine";
        EXPECT_NEAR(area, 0.5, 1e-5) << "the whole triangle, once";
    }
}

TEST_F(Surfaces, pieces_that_need_more_than_the_hardware_has_are_cut_into_cells) {
    test::Random random(4);
    const Surface<Hom<3>> s = hills(random, 3, 1, 1, 0.6);
    const SurfaceBuffers b = buffers(model_of(s));
    auto renderer = test::must(SurfaceRenderer::make(b));
    const auto v = test::must(renderer.triangles(options_, 0.02));
    std::map<float, int> places;
    double area = 0;
    for (std::size_t i = 0; i < v.size(); i += 3) {
        for (std::size_t k = i; k < i + 3; ++k) ++places[v[k].at[0]];
        area += ((v[i + 1].at[0] - v[i].at[0]) * double(v[i + 2].at[1] - v[i].at[1]) -
                 (v[i + 2].at[0] - v[i].at[0]) * double(v[i + 1].at[1] - v[i].at[1])) /
                2;
    }
    EXPECT_GT(places.size(), 65u);
    EXPECT_NEAR(area, 1, 1e-5) << "the whole square, once";
}

TEST_F(Surfaces, triangular_patches_are_drawn) {
    test::Random random(5);
    for (const int n : {1, 5, 10}) {
        std::vector<Hom<3>> net;
        for (int row = 0; row <= n; ++row)
            for (int k = 0; k <= row; ++k)
                net.push_back(weighted(Vec<3>{{double(row - k) / n, double(k) / n, random.real(-0.2, 0.2)}},
                                       random.real(0.5, 2)));
        const TriangularFace face{*SimplexPatch<2, Hom<3>>::make(n, net), {}};
        const SurfaceBuffers b =
            test::must(surface_buffers(Model{}, std::span(&face, 1), {.edge_tolerance = 1e-3}));
        auto renderer = test::must(SurfaceRenderer::make(b));
        int compared = 0, seen = 0;
        for (const SurfaceVertex& v : test::must(renderer.triangles(options_, n == 5 ? 0.5 : 6))) {
            if (++seen > 300 && seen % 5 > 0) continue;  // vertices belong to some six triangles
            const Param<2> uv{v.at[0], v.at[1]};
            const Vec<3> p = (1 / b.size) * (face.patch(uv) - b.middle);
            const auto expected = normal(face.patch, {std::min(uv[0], 1 - uv[1]), uv[1]});
            for (std::size_t d = 0; d < 3; ++d) {
                EXPECT_NEAR(v.position[d], p[int(d)], kPositions) << n;
                if (expected) EXPECT_NEAR(v.normal[d], (*expected)[int(d)], kNormals) << n;
            }
            ++compared;
        }
        EXPECT_GE(compared, 3);
    }
}

TEST_F(Surfaces, batches_are_evaluated_by_compute_shaders) {
    test::Random random(6);
    for (const auto& [precision, position, angle] : {std::tuple(ShaderPrecision::single, 2e-6, kNormals),
                                                     std::tuple(ShaderPrecision::twice, 1e-14, 1e-12)}) {
        const Surface<Hom<3>> s = hills(random, 3, 5, 4);
        auto evaluator = SurfaceEvaluator::make(s, precision);
        ASSERT_TRUE(evaluator) << evaluator.error().message;
        const auto at = test::parameters<2>(random, s, 3000);
        std::vector<Vec<3>> points(at.size()), normals(at.size());
        ASSERT_TRUE(evaluator->evaluate(at, points, normals));
        double off = 0, turned = 0;
        for (std::size_t i = 0; i < at.size(); ++i) {
            off = std::max(off, norm(points[i] - s(at[i])));
            turned = std::max(turned, norm(normals[i] - normal(SurfaceGeometry(s), at[i])));
        }
        EXPECT_LT(off, position);
        EXPECT_LT(turned, angle);
        std::vector<Vec<3>> again(at.size());
        ASSERT_TRUE(evaluator->evaluate(at, again, {}));
        EXPECT_EQ(points, again);
    }
}

TEST_F(Surfaces, what_cannot_be_drawn_is_refused) {
    const SurfaceBuffers b = buffers(test::torus(3.0, 1.0));
    auto renderer = test::must(SurfaceRenderer::make(b));
    test::expect_refusal(renderer.draw(options_, 0), RefusalKind::invalid, "deviation");
    test::expect_refusal(renderer.draw(options_, 1e-12), RefusalKind::limit, "deviation");
    options_.edges = true;
    test::expect_refusal(renderer.draw(options_), RefusalKind::unsupported, "edges");
    options_.edges = false;
    options_.painting = Painting::diverging;
    test::expect_refusal(renderer.draw(options_), RefusalKind::unsupported, "painting");
    test::expect_refusal(surface_buffers(Model{}, {.edge_tolerance = 1}), RefusalKind::no_answer, "model");
    test::expect_refusal(surface_buffers(test::torus(3.0, 1.0), {.edge_tolerance = 0}), RefusalKind::invalid,
                         "edge_tolerance");
}

}  // namespace
}  // namespace freiform
