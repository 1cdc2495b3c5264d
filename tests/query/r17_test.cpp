// Row R17: convex hull, also local, of B-splines; end point and end tangent; affine invariance; variation
// diminishing. Each as it stands in the row, on random curves of every degree.
#include <freiform/poly/predicates.hpp>
#include <freiform/query/bounds.hpp>
#include <freiform/query/crossings.hpp>
#include <freiform/query/hull.hpp>

#include <gtest/gtest.h>
#include <support/random.hpp>

namespace freiform::test {
namespace {

// How far x is outside the hull, at most `rounding` for points inside.
double outside(const std::vector<Vec<2>>& points, const Vec<2>& x) {
    const auto hull = must(convex_hull(points));
    double most = -1e300;
    for (std::size_t i = 0; i < hull.size(); ++i) {
        const Vec<2>&a = points[std::size_t(hull[i])], &b = points[std::size_t(hull[(i + 1) % hull.size()])];
        most = std::max(most, -cross(b - a, x - a) / norm(b - a));
    }
    return most;
}

TEST(R17, a_bezier_curve_lies_in_the_hull_of_its_control_points) {
    Random random(171);
    for (int n = 2; n <= 25; ++n) {
        const auto c = random_patch_on<1, Hom<2>>(random, {must(BSplineBasis::bezier(n))});
        const auto control = points(c);
        for (int i = 0; i <= 50; ++i) EXPECT_LE(outside(control, c(i / 50.0)), 1e-13);
    }
}

TEST(R17, a_b_spline_lies_in_the_hull_of_the_degree_plus_one_points_of_each_span) {
    Random random(172);
    for (int k = 0; k < 30; ++k) {
        const auto ends = k % 3 == 0 ? Ends::closed : k % 3 == 1 ? Ends::clamped : Ends::unclamped;
        const auto c = random_patch<1, Vec<2>>(random, 5, {ends, 5});
        const int p = c.basis().degree();
        if (p < 2) continue;
        const auto control = points(c);
        double covered = 0;
        for (const LocalHull& h : local_hulls(c.basis())) {
            std::vector<Vec<2>> own;
            for (int i = 0; i <= p; ++i) own.push_back(control[std::size_t(h.first + i) % control.size()]);
            for (int i = 0; i <= 20; ++i) EXPECT_LE(outside(own, c(h.on.lo + h.on.length() * i / 20)), 1e-12);
            covered += h.on.length();
        }
        EXPECT_NEAR(covered, c.basis().domain().length(), 1e-12);
    }
}

TEST(R17, ends_are_the_end_points_and_tangents_point_along_the_first_and_last_leg) {
    Random random(173);
    for (int n = 1; n <= 25; ++n) {
        const auto c = random_patch_on<1, Hom<3>>(random, {must(BSplineBasis::bezier(n))});
        const auto p = points(c);
        const auto w = weights(c);
        const auto a = c.jet<1>(0.0), b = c.jet<1>(1.0);
        const std::size_t m = std::size_t(n);
        EXPECT_LE(distance(a.value(), p[0]), 1e-15);
        EXPECT_LE(distance(b.value(), p[m]), 1e-15);
        // C'(0) = n w_1 / w_0 (P_1 - P_0)
        EXPECT_LE(distance(a.d[1], (n * w[1] / w[0]) * (p[1] - p[0])), 1e-12 * n);
        EXPECT_LE(distance(b.d[1], (n * w[m - 1] / w[m]) * (p[m] - p[m - 1])), 1e-12 * n);
    }
}

TEST(R17, an_affine_map_of_the_control_points_maps_the_curve) {
    Random random(174);
    for (int k = 0; k < 40; ++k) {
        const auto c = random_patch<1, Hom<2>>(random, 6, {k % 2 ? Ends::closed : Ends::clamped, 4});
        double m[2][3];
        for (auto& row : m)
            for (double& x : row) x = random.real(-2, 2);
        auto net = c.net();
        for (auto& h : net.flat()) {
            const Hom<2> old = h;
            for (int i : {0, 1}) h[i] = m[i][0] * old[0] + m[i][1] * old[1] + m[i][2] * old.weight();
        }
        const auto mapped = must(Curve<Hom<2>>::make(c.bases(), net));
        for (const double u : parameters(random, c.basis(), 10)) {
            const auto x = c(u), y = mapped(u);
            for (int i : {0, 1}) EXPECT_NEAR(y[i], m[i][0] * x[0] + m[i][1] * x[1] + m[i][2], 1e-12);
        }
    }
}

TEST(R17, no_line_crosses_a_curve_more_often_than_its_control_polygon) {
    Random random(175);
    int most = 0;
    for (int k = 0; k < 2000; ++k) {
        const bool closed = k % 3 == 0;
        const auto c =
            random_patch<1, Hom<2>>(random, k % 40 == 0 ? 20 : 5, {closed ? Ends::closed : Ends::clamped, 4});
        const Vec<2> normal{{random.real(-1, 1), random.real(-1, 1)}};
        const double offset = random.real(-0.5, 0.5);
        int curve = 0, polygon = 0;
        for (const auto& h : must(crossings(c, normal, offset, 1e-9)))
            curve += h.kind == CrossingKind::crossing;
        const auto p = points(c);
        const std::size_t legs = closed ? p.size() : p.size() - 1;
        for (std::size_t i = 0; i < legs; ++i)
            polygon += (dot(normal, p[i]) + offset) * (dot(normal, p[(i + 1) % p.size()]) + offset) < 0;
        EXPECT_LE(curve, polygon);
        EXPECT_EQ((polygon - curve) % 2, 0);
        most = std::max(most, curve);
    }
    EXPECT_GE(most, 4);
}

TEST(R17, no_plane_crosses_a_space_curve_more_often_than_its_control_polygon) {
    Random random(176);
    int most = 0;
    for (int k = 0; k < 500; ++k) {
        const auto c = random_patch<1, Vec<3>>(random, 6, {Ends::clamped, 4});
        const Vec<3> normal{{random.real(-1, 1), random.real(-1, 1), random.real(-1, 1)}};
        int curve = 0, polygon = 0;
        for (const auto& h : must(crossings(c, normal, 0.2, 1e-9))) curve += h.kind == CrossingKind::crossing;
        const auto p = points(c);
        for (std::size_t i = 0; i + 1 < p.size(); ++i)
            polygon += (dot(normal, p[i]) + 0.2) * (dot(normal, p[i + 1]) + 0.2) < 0;
        EXPECT_LE(curve, polygon);
        EXPECT_EQ((polygon - curve) % 2, 0);
        most = std::max(most, curve);
    }
    EXPECT_GE(most, 3);
}

}  // namespace
}  // namespace freiform::test
