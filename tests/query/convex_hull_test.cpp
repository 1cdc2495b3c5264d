// Hulls and boxes of objects: contain them, and are nearly as small as can be.
#include <freiform/core/constants.hpp>
#include <freiform/poly/predicates.hpp>
#include <freiform/query/oriented_box.hpp>

#include <gtest/gtest.h>
#include <map>
#include <support/random.hpp>
#include <support/refusal.hpp>
#include <support/sanitizer.hpp>

namespace freiform::test {
namespace {

// Closed, convex (exactly), and all points inside or on it.
void expect_hull(std::span<const Vec<3>> points, const std::vector<std::array<int, 3>>& triangles) {
    std::map<std::pair<int, int>, int> edges;
    for (const auto& f : triangles) {
        for (std::size_t k = 0; k < 3; ++k) ++edges[{f[k], f[(k + 1) % 3]}];
        for (const Vec<3>& p : points)
            ASSERT_GE(
                orient3d(points[std::size_t(f[0])], points[std::size_t(f[1])], points[std::size_t(f[2])], p),
                0);
    }
    for (const auto& [edge, n] : edges) {
        EXPECT_EQ(n, 1);
        EXPECT_TRUE(edges.contains({edge.second, edge.first}));
    }
}

TEST(HullTriangles, contain_all_points_and_are_closed_on_grids_and_beside_planes_too) {
    Random random(2);
    for (int k = 0; k < cases(30); ++k) {
        std::vector<Vec<3>> points;
        const int n = k % 3 == 0 ? 8 : 60;
        for (int i = 0; i < n; ++i) {
            Vec<3> p{{random.real(-1, 1), random.real(-1, 1), random.real(-1, 1)}};
            if (k % 3 == 1)
                for (int d = 0; d < 3; ++d) p[d] = std::floor(3 * p[d]);
            if (k % 3 == 2) p[2] = i < 2 ? p[2] : 1e-17 * p[2];
            points.push_back(p);
        }
        expect_hull(points, must(hull_triangles(points)));
    }
    const std::vector<Vec<3>> flat{{{0, 0, 1}}, {{1, 0, 1}}, {{0, 1, 1}}, {{1, 1, 1}}};
    expect_refusal(hull_triangles(flat), RefusalKind::no_answer, "points");
    expect_refusal(hull_triangles(std::vector<Vec<3>>(5)), RefusalKind::no_answer, "points");
    expect_refusal(hull_triangles(std::vector<Vec<3>>{{{kInfinity, 0, 0}}}), RefusalKind::nonfinite,
                   "points[0]");
}

// How far p is outside of the hull: at most 0 inside.
double outside(const ConvexHull<2>& h, const Vec<2>& p) {
    double most = -kInfinity;
    for (const auto& [a, b] : h.facets) {
        const Vec<2> d = h.points[std::size_t(b)] - h.points[std::size_t(a)],
                     r = p - h.points[std::size_t(a)];
        most = std::max(most, orient2d(h.points[std::size_t(a)], h.points[std::size_t(b)], p) >= 0
                                  ? -0.0
                                  : std::abs(d[0] * r[1] - d[1] * r[0]) / norm(d));
    }
    return most;
}
double outside(const ConvexHull<3>& h, const Vec<3>& p) {
    double most = -kInfinity;
    for (const auto& f : h.facets) {
        const Vec<3>&a = h.points[std::size_t(f[0])], &b = h.points[std::size_t(f[1])],
              &c = h.points[std::size_t(f[2])];
        const Vec<3> n = cross(b - a, c - a);
        most = std::max(most, orient3d(a, b, c, p) >= 0 ? -0.0 : std::abs(dot(n, p - a)) / norm(n));
    }
    return most;
}

// The farthest that the samples reach along a.
template <int D>
double reach(const std::vector<Vec<D>>& points, const Vec<D>& a) {
    double most = -kInfinity;
    for (const Vec<D>& p : points) most = std::max(most, dot(a, p));
    return most;
}

template <int D>
void expect_tight(const ConvexHull<D>& hull, const std::vector<Vec<D>>& samples, double tolerance,
                  Random& random) {
    ASSERT_FALSE(hull.facets.empty());
    EXPECT_LE(hull.slack, tolerance);
    for (const Vec<D>& p : samples) ASSERT_EQ(outside(hull, p), 0);
    for (int k = 0; k < 50; ++k) {  // supports of convex sets are as far apart as these
        Vec<D> a;
        for (int d = 0; d < D; ++d) a[d] = random.real(-1, 1);
        a = unit(a);
        EXPECT_LE(reach<D>(hull.points, a), reach<D>(samples, a) + hull.slack + 1e-5);
    }
}

TEST(ConvexHull, of_plane_curves_contains_them_and_is_as_tight_as_it_says) {
    Random random(3);
    for (int k = 0; k < 4; ++k) {
        const auto basis = must(BSplineBasis::make(3, {0, 0, 0, 0, 0.3, 0.5, 0.5, 1, 1, 1, 1}));
        const auto run = [&]<class P>(const Curve<P>& c) {
            const auto query = must(NearestQuery::make(std::array{NearestObject::of(c)}));
            std::vector<Vec<2>> samples;
            for (int i = 0; i <= 1000; ++i) samples.push_back(c(i / 1000.0));
            for (const double tolerance : {0.1, 1e-4})
                expect_tight<2>(must(convex_hull<2>(query, tolerance)), samples, tolerance, random);
        };
        run(random_patch_on<1, Vec<2>>(random, {basis}));
        run(random_patch_on<1, Hom<2>>(random, {basis}));
    }
}

TEST(ConvexHull, of_surfaces_and_flat_objects_in_space_too) {
    Random random(4);
    for (int k = 0; k < 4; ++k) {
        const auto basis = must(BSplineBasis::make(2, {0, 0, 0, 0.4, 1, 1, 1}));
        auto s = random_patch_on<2, Vec<3>>(random, {basis, basis});
        if (k == 3) {  // in a plane but for rounding
            std::vector<Vec<3>> net(s.net().flat().begin(), s.net().flat().end());
            for (Vec<3>& p : net) p[2] = p[0] + 2 * p[1];
            s = must(Surface<Vec<3>>::make(s.bases(), Net<2, Vec<3>>(s.net().extent(), net)));
        }
        const auto query = must(NearestQuery::make(std::array{NearestObject::of(s)}));
        std::vector<Vec<3>> samples;
        for (int i = 0; i <= 40; ++i)
            for (int j = 0; j <= 40; ++j) samples.push_back(s(i / 40.0, j / 40.0));
        const auto hull = must(convex_hull<3>(query, 0.2));
        EXPECT_LE(hull.slack, 0.2);
        for (const Vec<3>& p : samples) ASSERT_EQ(outside(hull, p), 0);
        for (int i = 0; i < 50; ++i) {
            const Vec<3> a = unit(Vec<3>{{random.real(-1, 1), random.real(-1, 1), random.real(-1, 1)}});
            EXPECT_LE(reach<3>(hull.points, a), reach<3>(samples, a) + hull.slack + 0.01);
        }
    }
}

TEST(ConvexHull, of_a_segment_is_as_thick_as_rounding_and_that_of_a_point_too) {
    const auto line = must(Curve<Vec<2>>::make({must(BSplineBasis::bezier(1))},
                                               Net<1, Vec<2>>({2}, {Vec<2>{{0, 0}}, {{3, 1}}})));
    const auto hull =
        must(convex_hull<2>(must(NearestQuery::make(std::array{NearestObject::of(line)})), 1e-9));
    EXPECT_LE(hull.slack, 1e-12);
    for (int i = 0; i <= 10; ++i) EXPECT_EQ(outside(hull, line(i / 10.0)), 0);
    expect_refusal(convex_hull<2>(must(NearestQuery::make(std::array{NearestObject::of(line)})), -1),
                   RefusalKind::invalid, "tolerance");
}

TEST(OrientedBox, of_a_turned_rectangle_is_the_rectangle) {
    for (const double angle : {0.0, 0.3, 1.2}) {
        const auto turn = [&](double x, double y) {
            return Vec<2>{
                {5 + x * std::cos(angle) - y * std::sin(angle), x * std::sin(angle) + y * std::cos(angle)}};
        };
        const auto frame = must(Curve<Vec<2>>::make(
            {must(BSplineBasis::make(1, {0, 0, 1, 2, 3, 4, 4}))},
            Net<1, Vec<2>>({5}, {turn(0, 0), turn(4, 0), turn(4, 1), turn(0, 1), turn(0, 0)})));
        const auto box =
            must(oriented_box<2>(must(NearestQuery::make(std::array{NearestObject::of(frame)})), 0));
        EXPECT_NEAR(box.volume(), 4, 1e-12);
        EXPECT_LE(box.slack, 1e-13);
    }
}

TEST(OrientedBox, encloses_and_leaves_no_more_than_its_slack) {
    Random random(7);
    for (int k = 0; k < 3; ++k) {
        const auto basis = must(BSplineBasis::make(2, {0, 0, 0, 0.4, 1, 1, 1}));
        const auto s = random_patch_on<2, Hom<3>>(random, {basis, basis});
        const auto query = must(NearestQuery::make(std::array{NearestObject::of(s)}));
        const auto box = must(oriented_box<3>(query, 1e-6));
        EXPECT_LE(box.slack, 1e-6);
        std::array<Interval, 3> seen;
        seen.fill({kInfinity, -kInfinity});
        const int n = 40;
        for (int i = 0; i <= n; ++i)
            for (int j = 0; j <= n; ++j) {
                const Vec<3> p = s(double(i) / n, double(j) / n);
                for (std::size_t d = 0; d < 3; ++d) {
                    const double x = dot(box.axes[d], p);
                    ASSERT_TRUE(box.range[d].contains(x));
                    seen[d] = {std::min(seen[d].lo, x), std::max(seen[d].hi, x)};
                    EXPECT_LE(std::abs(dot(box.axes[d], p - box.middle())), box.half()[int(d)]);
                }
            }
        double product = 1;
        for (std::size_t d = 0; d < 3; ++d) {
            EXPECT_NEAR(norm(box.axes[d]), 1, 1e-15);
            EXPECT_NEAR(dot(box.axes[d], box.axes[(d + 1) % 3]), 0, 1e-15);
            EXPECT_LE(seen[d].lo - box.range[d].lo, 1e-2);
            EXPECT_LE(box.range[d].hi - seen[d].hi, 1e-2);
            product *= box.range[d].length();
        }
        EXPECT_EQ(product, box.volume());
    }
}

// The faces of a box of sides 1, 2 and 5 that is turned: the least box is that one, and no coordinate axis
// helps to find it.
class TurnedBox : public testing::Test {
protected:
    static std::array<Vec<3>, 3> axes() {
        const Vec<3> a = unit(Vec<3>{{1, 2, 3}}), b = unit(cross(a, Vec<3>{{0, 0, 1}}));
        return {a, b, cross(a, b)};
    }
    static NearestQuery faces(double scale) {
        const auto turned = axes();
        const std::array sides{1.0, 2.0, 5.0};
        const auto line = must(BSplineBasis::bezier(1));
        std::vector<Surface<Vec<3>>> all;
        for (std::size_t k = 0; k < 3; ++k)
            for (const double at : {0.0, 1.0}) {
                const auto corner = [&](double u, double v) {
                    const Vec<3> p = at * sides[k] * turned[k] +
                                     u * sides[(k + 1) % 3] * turned[(k + 1) % 3] +
                                     v * sides[(k + 2) % 3] * turned[(k + 2) % 3];
                    return scale * (p + Vec<3>{{3, -4, 7}});
                };
                all.push_back(must(Surface<Vec<3>>::make(
                    {line, line},
                    Net<2, Vec<3>>({2, 2}, {corner(0, 0), corner(0, 1), corner(1, 0), corner(1, 1)}))));
            }
        std::vector<NearestObject> objects;
        for (const auto& s : all) objects.push_back(NearestObject::of(s));
        return must(NearestQuery::make(objects));
    }
};

TEST_F(TurnedBox, is_found_with_its_sides_its_middle_and_in_any_unit) {
    const auto turned = axes();
    Vec<3> middle{{3, -4, 7}};
    for (std::size_t k = 0; k < 3; ++k) middle += (k == 0 ? 0.5 : k == 1 ? 1.0 : 2.5) * turned[k];
    for (const double scale : {1.0, 0x1p200, 0x1p-200}) {
        const auto box = must(oriented_box<3>(faces(scale), 0));
        std::array<double, 3> sides{};
        for (std::size_t k = 0; k < 3; ++k) {
            sides[k] = box.range[k].length() / scale;
            EXPECT_LE(std::abs(box.half()[int(k)] / scale - sides[k] / 2), 1e-12);
            EXPECT_GE(box.half()[int(k)], box.range[k].length() / 2);
        }
        std::ranges::sort(sides);
        EXPECT_NEAR(sides[0], 1, 1e-12);
        EXPECT_NEAR(sides[1], 2, 1e-12);
        EXPECT_NEAR(sides[2], 5, 1e-12);
        EXPECT_LE(norm((1 / scale) * box.middle() - middle), 1e-12);
        EXPECT_GE(box.slack, 0);
        EXPECT_LE(box.slack / scale, 1e-12);
    }
    EXPECT_NEAR(must(oriented_box<3>(faces(1), 0)).volume(), 10, 1e-11);
}

TEST(OrientedBox, of_a_flat_object_lies_in_its_plane) {
    const auto square = must(Surface<Vec<3>>::make(
        {must(BSplineBasis::bezier(1)), must(BSplineBasis::bezier(1))},
        Net<2, Vec<3>>({2, 2}, {Vec<3>{{0, 0, 0}}, {{1, 1, 1}}, {{1, -1, 0}}, {{2, 0, 1}}})));
    const auto box =
        must(oriented_box<3>(must(NearestQuery::make(std::array{NearestObject::of(square)})), 0));
    std::array<double, 3> sides{};
    for (std::size_t k = 0; k < 3; ++k) sides[k] = box.range[k].length();
    std::ranges::sort(sides);
    EXPECT_LE(sides[0], 1e-13);
    EXPECT_NEAR(sides[1], std::sqrt(2.0), 1e-13);
    EXPECT_NEAR(sides[2], std::sqrt(3.0), 1e-13);
}

// With little work the box is larger, and its slack says by how much at most.
TEST(OrientedBox, encloses_with_a_slack_that_holds_after_any_work_and_refuses_wrong_numbers) {
    Random random(8);
    const auto basis = must(BSplineBasis::bezier(5));
    const auto s = random_patch_on<2, Hom<3>>(random, {basis, basis});
    const auto query = must(NearestQuery::make(std::array{NearestObject::of(s)}));
    const auto best = must(oriented_box<3>(query, 0));
    double before = kInfinity;
    for (const int parts : {1, 30, 20000}) {
        const auto box = must(oriented_box<3>(query, 0, parts));
        ASSERT_EQ(box.axes, best.axes);
        for (std::size_t d = 0; d < 3; ++d) {
            EXPECT_TRUE(box.range[d].contains(best.range[d].lo + best.slack));
            EXPECT_TRUE(box.range[d].contains(best.range[d].hi - best.slack));
            EXPECT_LE(best.range[d].lo - box.range[d].lo, box.slack);
            EXPECT_LE(box.range[d].hi - best.range[d].hi, box.slack);
        }
        EXPECT_LT(box.slack, before);
        before = box.slack;
    }
    EXPECT_LT(before, 1e-9);
    expect_refusal(oriented_box<3>(query, -1), RefusalKind::invalid, "accuracy");
    expect_refusal(oriented_box<3>(query, std::nan("")), RefusalKind::invalid, "accuracy");
    expect_refusal(oriented_box<3>(query, 0, 0), RefusalKind::invalid, "max_parts");
}

}  // namespace
}  // namespace freiform::test
