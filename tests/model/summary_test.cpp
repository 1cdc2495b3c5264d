#include "model/face_region_detail.hpp"
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

TEST(Summary, boxes_do_not_care_how_crowded_knots_are) {
    // Ends of blends come with knots at 2^-k of the domain and control points that waver by little: second
    // derivatives there are as large as 1e18, of curves that anybody can see are short.
    Random random(11);
    std::vector<double> knots(4, 0.0);
    for (int k = 36; k > 0; --k) knots.push_back(std::ldexp(1.0, -k));
    knots.insert(knots.end(), 4, 1.0);
    const auto basis = *BSplineBasis::make(3, knots);
    const auto line = *BSplineBasis::bezier(1);
    std::vector<Vec<3>> c, along, turned;
    for (int j = 0; j < 2; ++j)
        for (int i = 0; i < basis.size(); ++i) {
            const double at = std::max(0.0, (i - 36) / double(basis.size() - 37));
            c.push_back({{double(j), at, 0.01 * random.real(-1, 1)}});
            if (j == 0) along.push_back(c.back());
        }
    for (const Vec<3>& p : along)
        for (int j = 0; j < 2; ++j) turned.push_back(p + Vec<3>{{double(j), 0, 0}});
    const auto curve = *Curve<Vec<3>>::make({basis}, Net<1, Vec<3>>({basis.size()}, along));
    const auto surface = *Surface<Vec<3>>::make({line, basis}, Net<2, Vec<3>>({2, basis.size()}, c));
    ModelBuilder builder;
    ASSERT_TRUE(builder.add(surface));
    Model face = *std::move(builder).finish();
    EXPECT_LT(summary(face).box.diagonal(), 1.5);
    for (Edge& e : face.edges) e.curve.reset();
    EXPECT_LT(summary(face).box.diagonal(), 1.5);
    const auto across = *Surface<Vec<3>>::make({basis, line}, Net<2, Vec<3>>({basis.size(), 2}, turned));
    const Extrusion extrusion{curve, {{1, 0, 0}}};
    ModelBuilder other;
    ASSERT_TRUE(other.add(across));
    face = *std::move(other).finish();
    for (Edge& e : face.edges) e.curve.reset();
    for (const SurfaceGeometry& s :
         {SurfaceGeometry(across), SurfaceGeometry(extrusion),
          SurfaceGeometry(OffsetSurface{std::make_shared<SurfaceGeometry>(extrusion), 0.125}),
          SurfaceGeometry(Revolution{curve, {{0, 0, -1}}, {{0, 1, 0}}})}) {
        face.faces[0].surface = s;
        EXPECT_LT(summary(face).box.diagonal(), 3) << kind_name(s);
    }
    // And one of its parameter curves.
    Coedge& side = face.faces[0].loops[0].coedges[0];
    const Interval on = face.edges[std::size_t(side.edge)].range;
    const Vec<2> a = jet<0>(side.curve, on.lo).value(), b = jet<0>(side.curve, on.hi).value();
    std::vector<Vec<2>> uv;
    for (const Vec<3>& p : along)
        uv.push_back(a + p[1] * (b - a) + p[2] * (1 - p[1]) * Vec<2>{{b[1] - a[1], a[0] - b[0]}});
    for (double& k : knots) k = on.lo + on.length() * k;
    side.curve = *Curve<Vec<2>>::make({*BSplineBasis::make(3, knots)}, Net<1, Vec<2>>({basis.size()}, uv));
    const auto rough = FaceRegion::rough(face.faces[0], face.edges);
    ASSERT_TRUE(rough);
    EXPECT_LT(rough->box().diagonal(), 3);
    EXPECT_GE(rough->box().diagonal(), std::sqrt(2.0));
    // The same curve as an edge of a model.
    Model edge;
    edge.vertices.resize(2);
    edge.vertices[0].point = along.front(), edge.vertices[1].point = along.back();
    edge.edges.resize(1);
    edge.edges[0].curve = curve, edge.edges[0].range = {0, 1}, edge.edges[0].end = 1;
    EXPECT_LT(summary(edge).box.diagonal(), 1.1);
    EXPECT_GE(summary(edge).box.hi[1], 1);
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
