// Tight boxes of solids against those that are known, and against many points of their faces.
#include <freiform/core/constants.hpp>
#include <freiform/model/assemble.hpp>
#include <freiform/model/bounds.hpp>
#include <freiform/model/rescale.hpp>

#include <gtest/gtest.h>
#include <support/polygon_face.hpp>
#include <support/refusal.hpp>
#include <support/solids.hpp>

namespace freiform::test {
namespace {

TEST(ModelBounds, of_solids_are_what_geometry_says) {
    struct Known {
        Model model;
        Vec<3> lo, hi;
    };
    for (const Known& k : {Known{sphere({{1, 2, 3}}, 2), {{-1, 0, 1}}, {{3, 4, 5}}},
                           {torus(3, 1), {{-4, -4, -1}}, {{4, 4, 1}}},
                           {frustum(1, 0.5, 2), {{-1, -1, 0}}, {{1, 1, 2}}}}) {
        const auto b = must(tight_box(k.model, 1e-5));
        EXPECT_LE(b.slack, 1e-5);
        for (int i = 0; i < 3; ++i) {
            EXPECT_LE(b.box.lo[i], k.lo[i] + 1e-14) << i;
            EXPECT_GE(b.box.lo[i], k.lo[i] - b.slack - 1e-14) << i;
            EXPECT_GE(b.box.hi[i], k.hi[i] - 1e-14) << i;
            EXPECT_LE(b.box.hi[i], k.hi[i] + b.slack + 1e-14) << i;
        }
    }
}

// A sphere with its cap cut away: the surface goes on, the face does not.
TEST(ModelBounds, end_where_faces_are_trimmed) {
    Model m = sphere({}, 1);
    const double top = 0.4;  // the latitude of the rim
    for (Coedge& c : m.faces[0].loops[0].coedges) {
        const auto cut = [&](Vec<2> p) { return Vec<2>{{p[0], std::min(p[1], top)}}; };
        const Interval on = m.edges[std::size_t(c.edge)].range;
        c.curve = segment(on, cut(jet<0>(c.curve, on.lo).value()), cut(jet<0>(c.curve, on.hi).value()));
    }
    const auto b = must(tight_box(m, 1e-6));
    EXPECT_NEAR(b.box.hi[2], std::sin(top), 1e-6);
    EXPECT_GE(b.box.hi[2], std::sin(top) - 1e-14);
    EXPECT_NEAR(b.box.lo[2], -1, 1e-6);
    EXPECT_NEAR(b.box.hi[0], 1, 1e-6);
}

// A ridge that is highest all around, and one whose highest places the boundary leaves on both sides.
TEST(ModelBounds, of_ridges_are_found) {
    const Curve<Vec<3>> profile = must(Curve<Vec<3>>::make(
        {*BSplineBasis::make(1, {0, 0, 0.7, 1.9, 2.5, 2.5})},
        Net<1, Vec<3>>({4}, {{{1, 0.2, 0}}, {{2, -0.1, 1}}, {{2.6, 0, 0.9}}, {{3, 0, 0}}})));
    const SurfaceGeometry turned = Revolution{profile, {}, {{0, 0, 1}}},
                          tilted = Revolution{profile, {}, unit(Vec<3>{{0.3, -0.2, 1}})};
    for (const SurfaceGeometry* s : {&turned, &tilted}) {
        const std::vector<Vec<2>> corners{{{0.3, 0}}, {{2, 0.4}}, {{5, 0}}, {{4.6, 2.5}}, {{0.9, 2.1}}};
        const auto b = must(tight_box(polygon_face(*s, corners), 1e-6));
        EXPECT_LE(b.slack, 1e-6);
        Box<3> seen;
        for (const Vec<3>& x : places_on(*s, corners, 300)) seen.add(x);
        for (int k = 0; k < 3; ++k) {
            EXPECT_LE(b.box.lo[k], seen.lo[k]);
            EXPECT_GE(b.box.hi[k], seen.hi[k]);
            EXPECT_NEAR(b.box.lo[k], seen.lo[k], 2e-2);
            EXPECT_NEAR(b.box.hi[k], seen.hi[k], 2e-2);
        }
    }
}

TEST(ModelBounds, a_spent_budget_is_said_and_nonsense_is_refused) {
    const Model m = torus(3, 1);
    const auto b = must(tight_box(m, 0, 3));
    EXPECT_GT(b.slack, 1e-6);
    EXPECT_GE(b.box.hi[0], 4);
    EXPECT_LE(b.box.hi[0] - b.slack, 4);
    expect_refusal(tight_box(m, -1), RefusalKind::invalid, "accuracy");
    expect_refusal(tight_box(Model{}, 1), RefusalKind::invalid, "model");
}

// Volume by the divergence theorem.
double volume_of(const ConvexHull<3>& hull) {
    double sum = 0;
    for (const auto& f : hull.facets)
        sum += dot(hull.points[std::size_t(f[0])],
                   cross(hull.points[std::size_t(f[1])], hull.points[std::size_t(f[2])])) /
               6;
    return sum;
}
// How far x is outside.
double outside(const ConvexHull<3>& hull, const Vec<3>& x) {
    double most = -kInfinity;
    for (const auto& f : hull.facets) {
        const Vec<3>& a = hull.points[std::size_t(f[0])];
        const Vec<3> n = cross(hull.points[std::size_t(f[1])] - a, hull.points[std::size_t(f[2])] - a);
        most = std::max(most, dot(unit(n), x - a));
    }
    return most;
}

TEST(ModelHull, of_solids_contains_them_and_is_hardly_larger) {
    const double tolerance = 0.05;
    struct Known {
        Model model;
        double volume, area;  // of the convex hull
    };
    for (const Known& k :
         {Known{sphere({}, 1), 4 * kPi / 3, 4 * kPi},
          {torus(3, 1), kPi * 9 * 2 + 3 * kPi * kPi + 4 * kPi / 3, 2 * 9 * kPi + 6 * kPi * kPi + 4 * kPi},
          {frustum(1, 0.5, 2), 7 * kPi / 6, 1.25 * kPi + 1.5 * kPi * std::sqrt(4.25)}}) {
        const auto hull = must(convex_hull(k.model, tolerance));
        EXPECT_LE(hull.slack, tolerance);
        // Within `slack` of the hull of the solid: no more volume than that of the layer around.
        EXPECT_GE(volume_of(hull), k.volume);
        EXPECT_LE(volume_of(hull), k.volume + 1.2 * hull.slack * k.area);
        for (const Face& f : k.model.faces)
            for (const Loop& l : f.loops)
                for (const Coedge& c : l.coedges)
                    for (int i = 0; i <= 20; ++i) {
                        const Interval on = k.model.edges[std::size_t(c.edge)].range;
                        const double t = clamped(on.lo + on.length() * i / 20, on);
                        const Vec<2> uv = jet<0>(c.curve, t).value();
                        EXPECT_LE(outside(hull, jet<0>(f.surface, uv.c).value()), 1e-14);
                    }
    }
}

// The ball goes on above the rim, the face does not.
TEST(ModelHull, ends_where_faces_are_trimmed) {
    Model m = sphere({}, 1);
    const double top = 0.4;  // the latitude of the rim
    for (Coedge& c : m.faces[0].loops[0].coedges) {
        const auto cut = [&](Vec<2> p) { return Vec<2>{{p[0], std::min(p[1], top)}}; };
        const Interval on = m.edges[std::size_t(c.edge)].range;
        c.curve = segment(on, cut(jet<0>(c.curve, on.lo).value()), cut(jet<0>(c.curve, on.hi).value()));
    }
    const auto hull = must(convex_hull(m, 0.03));
    double highest = -1;
    for (const Vec<3>& p : hull.points) highest = std::max(highest, p[2]);
    EXPECT_GE(highest, std::sin(top));
    EXPECT_LE(highest, std::sin(top) + hull.slack);
    EXPECT_LE(hull.slack, 0.03);
    expect_refusal(convex_hull(m, -1), RefusalKind::invalid, "tolerance");
    expect_refusal(convex_hull(m, 1, 0), RefusalKind::invalid, "max_parts");
    const auto coarse = must(convex_hull(m, 1e-9, 40));
    EXPECT_GT(coarse.slack, 1e-4);
    EXPECT_LE(outside(hull, {{0, 0, -1}}), 1e-14);
    EXPECT_LE(outside(coarse, {{0, 0, -1}}), 1e-14);
}

// A quarter of a bowl over a triangle: the corner of the surface that is cut off is far outside.
TEST(ModelHull, does_not_reach_the_corners_of_surfaces_that_are_cut_off) {
    const auto basis = must(BSplineBasis::bezier(2));
    const auto bowl = must(Surface<Vec<3>>::make({basis, basis}, Net<2, Vec<3>>({3, 3}, {{{0, 0, 0}},
                                                                                         {{0, 0.5, 0}},
                                                                                         {{0, 1, 1}},
                                                                                         {{0.5, 0, 0}},
                                                                                         {{0.5, 0.5, 0}},
                                                                                         {{0.5, 1, 1}},
                                                                                         {{1, 0, 1}},
                                                                                         {{1, 0.5, 1}},
                                                                                         {{1, 1, 2}}})));
    const auto side = [](const Vec<2>& from, const Vec<2>& to) -> CurveGeometry<2> {
        return must(Curve<Vec<2>>::make({must(BSplineBasis::bezier(1))}, Net<1, Vec<2>>({2}, {from, to})));
    };
    const Vec<2> o{}, x{{1, 0}}, y{{0, 1}};
    const std::vector<std::vector<CurveGeometry<2>>> loops{{side(o, x), side(x, y), side(y, o)}};
    ModelBuilder builder;
    EXPECT_TRUE(builder.add_trimmed(bowl, loops));
    const auto hull = must(convex_hull(must(std::move(builder).finish()), 0.05));
    EXPECT_LE(hull.slack, 0.05);
    for (const Vec<3>& p : hull.points) EXPECT_LE(p[0] + p[1], 1 + std::sqrt(2.0) * hull.slack);
    for (int i = 0; i <= 10; ++i)
        for (int j = 0; i + j <= 10; ++j) EXPECT_LE(outside(hull, bowl(i / 10.0, j / 10.0)), 1e-15);
}

TEST(ModelHull, powers_of_two_scale_it) {
    const Model one = frustum(1, 0.5, 2);
    const auto hull = must(convex_hull(one, 0.125)),
               small = must(convex_hull(must(rescaled(one, -100)), 0x1p-103));
    ASSERT_EQ(hull.points.size(), small.points.size());
    EXPECT_EQ(hull.facets, small.facets);
    for (std::size_t i = 0; i < hull.points.size(); ++i)
        EXPECT_EQ(0x1p-100 * hull.points[i], small.points[i]);
    EXPECT_EQ(small.slack, 0x1p-100 * hull.slack);
}

}  // namespace
}  // namespace freiform::test
