// Nearest points of solids whose distance is known, of a trimmed face, and against samples of the faces.
#include <freiform/model/nearest.hpp>

#include <gtest/gtest.h>
#include <support/polygon_face.hpp>
#include <support/random.hpp>
#include <support/sanitizer.hpp>
#include <support/solids.hpp>

namespace freiform::test {
namespace {

ModelNearestQuery query_of(Model m) { return must(ModelNearestQuery::make(std::move(m))); }

Vec<3> point_in(Random& random, double reach) {
    return {{random.real(-reach, reach), random.real(-reach, reach), random.real(-reach, reach)}};
}

void expect_proven(const ModelNearest& n, double distance, double within) {
    EXPECT_NEAR(n.distance, distance, within);
    EXPECT_LE(n.lower_bound, distance + 1e-13);
    EXPECT_GE(n.lower_bound, n.distance - within);
}

TEST(ModelNearest, of_a_sphere_is_along_the_radius) {
    const Vec<3> centre{{1, 2, 3}};
    const auto query = query_of(sphere(centre, 2));
    Random random(3);
    for (int k = 0; k < cases(30); ++k) {
        const Vec<3> q = centre + point_in(random, 4);
        const auto n = must(query.nearest(q));
        expect_proven(n, std::abs(norm(q - centre) - 2), 2e-8);
        EXPECT_NEAR(norm(n.point - centre), 2, 1e-13);
    }
    // At the poles, where the parameters are degenerate, and on the seam.
    for (const Vec<3>& d : {Vec<3>{{0, 0, 3}}, Vec<3>{{0, 0, -1}}, Vec<3>{{3, 0, 0}}, Vec<3>{{1, 0, 1}}})
        expect_proven(must(query.nearest(centre + d, {.accuracy = 1e-5})), std::abs(norm(d) - 2), 2e-5);
}

TEST(ModelNearest, from_the_centre_of_a_sphere_the_budget_ends_and_the_bound_holds) {
    const auto query = query_of(sphere({}, 1));
    const auto n = must(query.nearest(Vec<3>{}, {.max_parts = 500}));
    EXPECT_NEAR(n.distance, 1, 1e-14);
    EXPECT_LE(n.lower_bound, 1);
    EXPECT_GE(n.lower_bound, 0.9);
}

// Cut short, the answer is a point of the model that may not be the nearest, and the bound may not be above
// the true distance.
TEST(ModelNearest, what_a_small_budget_proves_is_true_and_its_point_is_on_the_model) {
    Random random(17);
    const auto ball = query_of(sphere({}, 1)), ring = query_of(torus(3, 1));
    const auto from_ball = [](const Vec<3>& x) { return std::abs(norm(x) - 1); };
    const auto from_ring = [](const Vec<3>& x) {
        return std::abs(std::hypot(std::hypot(x[0], x[1]) - 3, x[2]) - 1);
    };
    int cut_short = 0, proven_some = 0;
    const auto check = [&](const ModelNearestQuery& query, auto&& distance, int budget, double reach) {
        const Vec<3> q = point_in(random, reach);
        const auto n = must(query.nearest(q, {.max_parts = budget}));
        ASSERT_GE(n.face, 0);
        EXPECT_LE(distance(n.point), 1e-13);
        EXPECT_NEAR(norm(n.point - q), n.distance, 1e-13);
        EXPECT_LE(n.lower_bound, distance(q) + 1e-13) << budget;
        EXPECT_GE(n.distance, distance(q) - 1e-13);
        cut_short += n.distance > distance(q) + 1e-3;
        proven_some += n.lower_bound > distance(q) / 2;
    };
    const int points = std::max(cases(20), 8);
    for (const int budget : {1, 2, 3, 5, 8, 13, 21})
        for (int k = 0; k < points; ++k) {
            check(ball, from_ball, budget, 3);
            check(ring, from_ring, budget, 5);
        }
    EXPECT_GE(cut_short, points) << "the budgets are no test";
    EXPECT_GE(proven_some, points) << "nothing was proven";
}

TEST(ModelNearest, of_a_torus_is_that_of_its_circle) {
    const auto query = query_of(torus(3, 1));
    Random random(5);
    for (int k = 0; k < cases(20); ++k) {
        const Vec<3> q = point_in(random, 5);
        const double ring = std::hypot(std::hypot(q[0], q[1]) - 3, q[2]);
        expect_proven(must(query.nearest(q)), std::abs(ring - 1), 2e-8);
    }
}

// A square [0, 1]^2 with a triangle cut off: u + v <= 1 is left.
Model half_of_a_square() {
    Model m;
    const auto line = [](Vec<3> a, Vec<3> b) { return CurveGeometry<3>(Line<3>{a, b - a}); };
    const Vec<3> a{}, b{{1, 0, 0}}, c{{0, 1, 0}};
    m.vertices = {{a, 0}, {b, 0}, {c, 0}};
    const Interval on{0, 1};
    m.edges = {{line(a, b), false, on, 0, 1, 0, "low"},
               {line(b, c), false, on, 1, 2, 0, "slant"},
               {line(c, a), false, on, 2, 0, 0, "left"}};
    Face f;
    f.surface = Surface<Vec<3>>::trusted(
        {*BSplineBasis::bezier(1), *BSplineBasis::bezier(1)},
        Net<2, Vec<3>>({2, 2}, {{{0, 0, 0}}, {{0, 1, 0}}, {{1, 0, 0}}, {{1, 1, 0}}}));
    f.loops = {{{{0, false, segment(on, {{0, 0}}, {{1, 0}})},
                 {1, false, segment(on, {{1, 0}}, {{0, 1}})},
                 {2, false, segment(on, {{0, 1}}, {{0, 0}})}}}};
    m.faces = {f};
    return must(make_model(std::move(m)));
}

TEST(ModelNearest, stays_on_what_trimming_leaves) {
    const auto query = query_of(half_of_a_square());
    const auto inside = must(query.nearest(Vec<3>{{0.25, 0.25, 2}}));
    expect_proven(inside, 2, 1e-8);
    EXPECT_EQ(inside.edge, -1);
    EXPECT_NEAR(inside.uv[0], 0.25, 1e-6);
    // Above what was cut off: the foot is on the slant, at (0.5, 0.5).
    const auto off = must(query.nearest(Vec<3>{{1, 1, 1}}));
    expect_proven(off, std::sqrt(1.5), 1e-8);
    EXPECT_EQ(off.edge, 1);
    EXPECT_EQ(off.vertex, -1);
    EXPECT_NEAR(off.t, 0.5, 1e-6);
    const auto corner = must(query.nearest(Vec<3>{{2, -1, 0}}));
    expect_proven(corner, std::sqrt(2.0), 1e-8);
    EXPECT_EQ(corner.vertex, 1);
    Random random(9);
    for (int k = 0; k < cases(30); ++k) {
        const Vec<3> q = point_in(random, 2);
        double least = 1e300;
        for (int i = 0; i <= 100; ++i)
            for (int j = 0; i + j <= 100; ++j)
                least = std::min(least, norm(Vec<3>{{i / 100.0, j / 100.0, 0}} - q));
        const auto n = must(query.nearest(q));
        EXPECT_LE(n.distance, least + 1e-12);
        EXPECT_LE(n.lower_bound, least);
        EXPECT_GE(n.lower_bound, n.distance - 1e-8);
    }
}

// The first part of the surface has no foot and is done; nothing was seen yet when the budget ends.
TEST(ModelNearest, a_budget_of_one_part_still_gives_a_point) {
    const auto query = query_of(half_of_a_square());
    Random random(19);
    int early = 0;
    for (int k = 0; k < 40; ++k) {
        const Vec<3> q = point_in(random, 4);
        const auto n = must(query.nearest(q, {.max_parts = 1})), all = must(query.nearest(q));
        ASSERT_EQ(n.face, 0);
        EXPECT_NEAR(norm(n.point - q), n.distance, 1e-13);
        EXPECT_TRUE(n.point[2] == 0 && n.point[0] >= 0 && n.point[1] >= 0 && n.point[0] + n.point[1] <= 1);
        EXPECT_LE(n.lower_bound, all.distance);
        EXPECT_GE(n.distance, all.lower_bound);
        early += n.distance > all.distance + 1e-3;
    }
    EXPECT_GT(early, 0);
}

// The unit disc, as a circle in the parameters of a square.
TEST(ModelNearest, follows_a_round_boundary) {
    Model m;
    m.vertices = {{{{1, 0, 0}}, 0}};
    const Interval on{0, 2 * kPi};
    m.edges = {{Conic<3>{ConicKind::ellipse, {}, {{1, 0, 0}}, {{0, 1, 0}}}, false, on, 0, 0, 0, "rim"}};
    Face f;
    f.surface = Surface<Vec<3>>::trusted(
        {*BSplineBasis::bezier(1), *BSplineBasis::bezier(1)},
        Net<2, Vec<3>>({2, 2}, {{{-1, -1, 0}}, {{-1, 1, 0}}, {{1, -1, 0}}, {{1, 1, 0}}}));
    f.loops = {{{{0, false, Conic<2>{ConicKind::ellipse, {{0.5, 0.5}}, {{0.5, 0}}, {{0, 0.5}}}}}}};
    m.faces = {f};
    const auto query = query_of(must(make_model(std::move(m))));
    Random random(15);
    for (int k = 0; k < cases(40); ++k) {
        const Vec<3> q = point_in(random, 2);
        const double off = std::max(0.0, std::hypot(q[0], q[1]) - 1);
        const auto n = must(query.nearest(q));
        expect_proven(n, std::hypot(off, q[2]), 2e-8);
        EXPECT_EQ(n.edge >= 0, off > 0);
    }
}

// Parts that the boundary runs through were cut where they bend, never where they are long; a step of
// Newton's that left a narrow part took the other parameter along; kinks were halved towards, and took two
// million parts.
TEST(ModelNearest, is_found_on_ruled_and_folded_surfaces) {
    const auto polygon = [](const std::vector<Vec<3>>& p) -> CurveGeometry<3> {
        std::vector<double> knots{0};
        for (std::size_t i = 0; i < p.size(); ++i) knots.push_back(double(i));
        knots.push_back(double(p.size() - 1));
        const int n = int(p.size());
        return must(Curve<Vec<3>>::make({*BSplineBasis::make(1, knots)}, Net<1, Vec<3>>({n}, p)));
    };
    const Vec<3> z{{0, 0, 1}};
    struct Case {
        SurfaceGeometry surface;
        std::vector<Vec<2>> corners;
        Vec<3> q;
    };
    const Case cases[] = {
        // Rulings, and the foot of the whole surface outside of the face.
        {Revolution{Line<3>{{{0.326, -0.546, 0}}, {{0.385, 0, 0.702}}}, {}, z},
         {{{3.632, 1.139}}, {{3.624, 1.578}}, {{3.379, 1.317}}, {{3.469, 0.682}}, {{3.745, 0.822}}},
         {{-0.956, -0.1045, 1.001}}},
        {Extrusion{Conic<3>{ConicKind::ellipse, {}, {{1, 0, 0}}, {{0, 0, 1}}}, {{0.1, 1, 0.1}}},
         {{{-1, 0}}, {{0.5, 0.6}}, {{2, 0}}, {{1.6, 1.5}}, {{0.2, 1}}},
         {{0.9, 0.2, 0.9}}},
        // Rulings askew to the lines across them.
        {Revolution{Line<3>{{{1.209, -0.481, 0}}, {{-0.37, 0, 0.802}}}, {}, z},
         {{{1.058, 0}}, {{2.946, 0}}, {{2.946, 3.515}}, {{1.058, 3.515}}},
         {{-0.6, 0.2, 1.9}}},
        // A ridge.
        {Revolution{polygon({{{0.88, 0.26, 0.71}}, {{1.57, 0.1, 1.04}}, {{2.3, -0.09, 1.72}}}), {}, z},
         {{{1.6, 0}}, {{6, 0}}, {{6, 2}}, {{1.6, 2}}},
         {{-1.8, -0.7, 0.6}}}};
    for (const Case& c : cases) {
        const auto query = query_of(polygon_face(c.surface, c.corners));
        double least = kInfinity;
        for (const Vec<3>& x : places_on(c.surface, c.corners, 100)) least = std::min(least, norm(x - c.q));
        const auto n = must(query.nearest(c.q, {.max_parts = 2000}));
        EXPECT_LE(n.distance, least);
        EXPECT_GE(n.lower_bound, n.distance - 1e-8);
        EXPECT_GE(n.distance, least - 1e-2);
    }
}

TEST(ModelNearest, scales_and_moves_with_the_model) {
    Random random(11);
    for (const int e : {200, -200}) {
        const double by = std::scalbn(1.0, e);
        const auto query = query_of(sphere({{1, 0, 0}}, 2)), big = query_of(sphere({{by, 0, 0}}, 2 * by));
        for (int k = 0; k < 4; ++k) {
            const Vec<3> q = point_in(random, 4);
            const auto a = must(query.nearest(q)), b = must(big.nearest(by * q));
            EXPECT_NEAR(b.distance / by, a.distance, 1e-13);
            EXPECT_GE(b.lower_bound / by, a.distance - 2e-8);
            EXPECT_LE(b.lower_bound / by, a.distance + 1e-13);
        }
    }
    for (const double far : {1e20, 1e150, 1e300}) {
        const auto n = must(query_of(sphere({}, 1)).nearest(Vec<3>{{far, far / 8, far / 2}}));
        EXPECT_NEAR(n.distance / far, 1.125, 1e-12);
        EXPECT_LE(n.lower_bound, n.distance);
        EXPECT_GE(n.lower_bound, 0.99 * far);
    }
}

TEST(ModelNearest, refuses_nonsense) {
    EXPECT_EQ(ModelNearestQuery::make({}).error().kind, RefusalKind::invalid);
    const auto query = query_of(half_of_a_square());
    const std::array<Vec<3>, 2> points{{{{0, 0, 0}}, {{std::nan(""), 0, 0}}}};
    std::array<ModelNearest, 2> out;
    EXPECT_EQ(query.nearest(points, out).error().where, "points[1]");
    EXPECT_EQ(query.nearest(points[0], {.accuracy = -1}).error().where, "accuracy");
    EXPECT_EQ(query.nearest(points[0], {.accuracy = std::nan("")}).error().where, "accuracy");
    EXPECT_EQ(query.nearest(points[0], {.max_parts = 0}).error().where, "max_parts");
}

}  // namespace
}  // namespace freiform::test
