// Lengths of edges: of curves in space, and of parameter curves on surfaces against closed forms and
// polygons.
#include <freiform/model/edge_length.hpp>

#include <gtest/gtest.h>
#include <support/random.hpp>
#include <support/sanitizer.hpp>
#include <support/solids.hpp>

namespace freiform::test {
namespace {

TEST(EdgeLength, of_a_sphere_is_half_a_circle_and_its_poles_have_none) {
    const auto all = must(edge_lengths(sphere({{1, 2, 3}}, 2), 0));
    ASSERT_EQ(all.size(), 3u);
    EXPECT_NEAR(all[0].value, 2 * kPi, all[0].bound + 1e-15);
    EXPECT_LE(all[0].bound, 1e-13);
    for (const int pole : {1, 2}) EXPECT_EQ(all[std::size_t(pole)].value, 0);
}

// One edge without a curve in space, on a face.
Model lone_edge(SurfaceGeometry surface, CurveGeometry<2> curve, Interval on) {
    Model m;
    Face face;
    face.surface = std::move(surface);
    Edge edge;
    edge.range = on;
    edge.start = edge.end = 0;
    face.loops = {{{{0, false, std::move(curve)}}}};
    m.vertices = {{{}, 0}};
    m.edges = {edge};
    m.faces = {face};
    return m;
}

double polygon(const SurfaceGeometry& s, const CurveGeometry<2>& c, Interval on, int n) {
    double sum = 0;
    const auto at = [&](int i) {
        return jet<0>(s, clamped(jet<0>(c, on.lo + on.length() * i / n).value(), limits(s)).c).value();
    };
    for (int i = 0; i < n; ++i) sum += norm(at(i + 1) - at(i));
    return sum;
}

void expect_proven(const Model& m, double accuracy, double most) {
    const auto all = must(edge_lengths(m, accuracy));
    const Face& face = m.faces[0];
    const double lower = polygon(face.surface, face.loops[0].coedges[0].curve, m.edges[0].range, 4000);
    EXPECT_LE(lower, all[0].value + all[0].bound + 1e-12 * lower);
    EXPECT_GE(lower * (1 + 5e-4), all[0].value - all[0].bound);  // corners are cut off
    EXPECT_LE(all[0].bound, most);
}

TEST(EdgeLength, on_surfaces_is_bounded_from_both_sides) {
    const CurveGeometry<3> circle = Conic<3>{ConicKind::ellipse, {}, {{2, 0, 0}}, {{0, 2, 0}}};
    const SurfaceGeometry cylinder = Extrusion{circle, {{0, 0, 1}}, SurfaceKind::cylinder};
    // A helix, a circle, a straight line.
    const auto helix = lone_edge(cylinder, Line<2>{{}, {{1, 1}}}, {0, 3});
    const auto all = must(edge_lengths(helix, 1e-7));
    EXPECT_NEAR(all[0].value, 3 * std::sqrt(5.0), all[0].bound);
    EXPECT_LE(all[0].bound, 1e-7);
    const auto round = must(edge_lengths(lone_edge(cylinder, Line<2>{{{0, 5}}, {{1, 0}}}, {0, 3}), 0));
    EXPECT_NEAR(round[0].value, 6, round[0].bound);
    EXPECT_LE(round[0].bound, 1e-11);
    const Conic<2> ring{ConicKind::ellipse, {{3, 0}}, {{0.5, 0}}, {{0, 0.7}}};
    expect_proven(lone_edge(cylinder, ring, {0, 2 * kPi}), 1e-6, 1e-6);
    expect_proven(lone_edge(cylinder, ring, {0, 2 * kPi}), 0, 1e-5);
    const SurfaceGeometry plane =
        Extrusion{Line<3>{{{1, 1, 1}}, {{2, 0, 0}}}, {{0, 2, 0}}, SurfaceKind::plane};
    expect_proven(lone_edge(plane, ring, {0, 2 * kPi}), 0, 1e-10);
}

TEST(EdgeLength, on_splines_with_kinks_holds_along_across_and_outside_of_them) {
    Random random(5);
    for (int k = 0; k < 2; ++k) {
        const auto u = must(BSplineBasis::make(2, {0, 0, 0, 1, 1, 2, 2, 2}));
        const auto s = random_patch_on<2, Vec<3>>(random, {u, u});
        // Across the kinks, along one but for rounding, along the border and outside by rounding.
        for (const Line<2>& l : {Line<2>{{{0.3, 0.2}}, {{0.7, 0.8}}},
                                 {{{1, 0.1}}, {{1e-17, 1}}},
                                 {{{2 + 1e-15, 0.1}}, {{-1e-17, 1}}},
                                 {{{1.9, 0.1}}, {{0.2, 1}}}})
            expect_proven(lone_edge(s, l, {0, 1.5}), 0, 1e-2);
    }
}

}  // namespace
}  // namespace freiform::test
