#include "support/random.hpp"
#include "support/solids.hpp"

#include <freiform/query/bounds.hpp>

#include <gtest/gtest.h>

using namespace freiform;
using namespace freiform::test;

namespace {

TEST(Summary, boxes_contain_the_model_and_little_more) {
    const struct {
        const char* name;
        Model model;
        Vec<3> lo, hi;
    } cases[] = {{"sphere", sphere({{1, 2, 3}}, 2), {{-1, 0, 1}}, {{3, 4, 5}}},
                 {"torus", torus(3, 1), {{-4, -4, -1}}, {{4, 4, 1}}},
                 {"frustum", frustum(2, 1, 3), {{-2, -2, 0}}, {{2, 2, 3}}}};
    for (const auto& c : cases) {
        const Box<3> box = summary(c.model).box;
        for (int i = 0; i < 3; ++i) {
            EXPECT_LE(box.lo[i], c.lo[i]) << c.name;
            EXPECT_GE(box.hi[i], c.hi[i]) << c.name;
            EXPECT_NEAR(box.lo[i], c.lo[i], 0.02 * norm(c.hi - c.lo)) << c.name;
            EXPECT_NEAR(box.hi[i], c.hi[i], 0.02 * norm(c.hi - c.lo)) << c.name;
        }
    }
}

TEST(Summary, boxes_of_faces_with_many_bumps_contain_little_more) {
    Random random(8);
    const auto basis = *BSplineBasis::clamped_uniform(3, 20);
    std::vector<Hom<3>> c;
    for (int i = 0; i < 20; ++i)
        for (int k = 0; k < 20; ++k)
            c.push_back(
                weighted(Vec<3>{{i / 19.0, k / 19.0, 0.1 * random.real(-1, 1)}}, random.real(0.5, 2)));
    const auto surface = *Surface<Hom<3>>::make({basis, basis}, Net<2, Hom<3>>({20, 20}, c));
    ModelBuilder builder;
    ASSERT_TRUE(builder.add(surface));
    const Box<3> box = summary(*std::move(builder).finish()).box;
    const Box<3> tight = tight_box(surface, 1e-6)->box;
    for (int i = 0; i < 3; ++i) {
        EXPECT_LE(box.lo[i], tight.lo[i] + 1e-6);
        EXPECT_GE(box.hi[i], tight.hi[i] - 1e-6);
        EXPECT_NEAR(box.lo[i], tight.lo[i], 0.02);
        EXPECT_NEAR(box.hi[i], tight.hi[i], 0.02);
    }
}

TEST(Summary, boxes_leave_out_what_the_boundary_cuts_off) {
    // A triangle of a surface whose corner beside it is far away, and the bottom of a bowl.
    const auto line = *BSplineBasis::bezier(1), cubic = *BSplineBasis::bezier(3),
               square = *BSplineBasis::bezier(2);
    const auto far = *Surface<Vec<3>>::make({line, cubic}, Net<2, Vec<3>>({2, 4}, {{{0, 0, 0}},
                                                                                   {{0, 1, 1}},
                                                                                   {{0, 2, -1}},
                                                                                   {{0, 3, 0}},
                                                                                   {{50, 0, 0}},
                                                                                   {{1, 1, 1}},
                                                                                   {{1, 2, -1}},
                                                                                   {{1, 3, 0}}}));
    std::vector<Vec<3>> c;
    for (int i = 0; i < 3; ++i)
        for (int k = 0; k < 3; ++k) c.push_back({{i / 2.0, k / 2.0, 4.0 * ((i != 1) + (k != 1))}});
    const auto bowl = *Surface<Vec<3>>::make({square, square}, Net<2, Vec<3>>({3, 3}, c));
    const Vec<2> corner[3] = {{{0, 0}}, {{0.1, 1}}, {{0, 1}}};
    std::vector<CurveGeometry<2>> triangle,
        round{Conic<2>{ConicKind::ellipse, {{0.5, 0.5}}, {{0.1, 0}}, {{0, 0.1}}}};
    for (int k = 0; k < 3; ++k)
        triangle.push_back(
            *Curve<Vec<2>>::make({line}, Net<1, Vec<2>>({2}, {corner[k], corner[(k + 1) % 3]})));
    const auto check = [](const Surface<Vec<3>>& surface, const std::vector<CurveGeometry<2>>& loop,
                          auto inside) {
        ModelBuilder builder;
        const std::vector<std::vector<CurveGeometry<2>>> loops{loop};
        ASSERT_TRUE(builder.add_trimmed(surface, loops));
        const auto m = std::move(builder).finish();
        ASSERT_TRUE(m);
        Box<3> inner;
        for (int i = 0; i <= 60; ++i)
            for (int k = 0; k <= 63; ++k)
                inner.add(jet<0>(SurfaceGeometry(surface), inside(i / 60.0, k / 63.0).c).value());
        const Box<3> box = summary(*m).box;
        for (int i = 0; i < 3; ++i) {
            EXPECT_LE(box.lo[i], inner.lo[i] + 1e-12);
            EXPECT_GE(box.hi[i], inner.hi[i] - 1e-12);
            EXPECT_GE(box.lo[i], inner.lo[i] - 0.03 * inner.diagonal());
            EXPECT_LE(box.hi[i], inner.hi[i] + 0.03 * inner.diagonal());
        }
    };
    check(far, triangle, [](double s, double t) { return Vec<2>{{0.1 * s * t, s}}; });
    check(bowl, round, [](double s, double t) {
        return Vec<2>{{0.5 + 0.1 * s * std::cos(2 * kPi * t), 0.5 + 0.1 * s * std::sin(2 * kPi * t)}};
    });
}

TEST(Summary, counts_what_the_model_has) {
    const ModelSummary s = summary(sphere({}, 1));
    EXPECT_EQ(s.faces, 1);
    EXPECT_EQ(s.edges, 3);
    EXPECT_EQ(s.degenerate_edges, 2);
    EXPECT_EQ(s.seams, 1);
    EXPECT_EQ(s.open_edges, 0);
    EXPECT_EQ(s.solids, 1);
    Model open = frustum(1, 1, 1);
    open.faces.pop_back();
    open.shells[0].faces.pop_back();
    EXPECT_EQ(summary(open).open_edges, 1);
}

TEST(MakeModel, refuses_what_would_lead_out_of_the_arrays) {
    const auto where = [](auto change) {
        Model m = sphere({}, 1);
        change(m);
        const auto made = make_model(std::move(m));
        return made ? std::string("accepted") : made.error().where;
    };
    EXPECT_EQ(where([](Model&) {}), "accepted");
    EXPECT_EQ(where([](Model& m) { m.edges[0].end = 7; }), "edges[0].end");
    EXPECT_EQ(where([](Model& m) { m.edges[0].range = {1, 1}; }), "edges[0].range");
    EXPECT_EQ(where([](Model& m) { m.edges[1].end = 1; }), "edges[1]");
    EXPECT_EQ(where([](Model& m) { m.vertices[1].point[2] = NAN; }), "vertices[1]");
    EXPECT_EQ(where([](Model& m) { m.vertices[1].tolerance = -1; }), "vertices[1].tolerance");
    EXPECT_EQ(where([](Model& m) { m.faces[0].loops[0].coedges[2].edge = -1; }), "faces[0].loops[0][2].edge");
    EXPECT_EQ(where([](Model& m) { m.faces[0].loops[0].coedges.clear(); }), "faces[0].loops[0]");
    EXPECT_EQ(where([](Model& m) { m.shells[0].faces[0].face = 1; }), "shells[0].faces[0]");
    EXPECT_EQ(where([](Model& m) { m.bodies[0].shells[0] = 3; }), "bodies[0].shells[0]");
}

}  // namespace
