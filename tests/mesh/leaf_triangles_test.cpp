// Triangles of rectangles with points on their sides, and columns that boxes are cut into.
#include "mesh/curvature_tree_detail.hpp"
#include "mesh/leaf_triangles_detail.hpp"
#include "support/random.hpp"

#include <freiform/core/constants.hpp>

#include <functional>
#include <gtest/gtest.h>
#include <set>

namespace freiform {
namespace {

using test::must;
using test::Random;

std::vector<Vec<2>> rectangle(Random& random, int more) {
    std::array<std::vector<double>, 4> on;
    for (int k = 0; k < more; ++k)
        on[std::size_t(random.integer(0, 3))].push_back(random.integer(1, 1023) / 1024.0);
    const double w = random.real(0.5, 4), h = random.real(0.5, 4);
    std::vector<Vec<2>> out;
    for (std::size_t s = 0; s < 4; ++s) {
        auto& t = on[s];
        t.push_back(0);
        std::sort(t.begin(), t.end());
        t.erase(std::unique(t.begin(), t.end()), t.end());
        for (const double x : t)
            out.push_back(s == 0   ? Vec<2>{{x * w, 0}}
                          : s == 1 ? Vec<2>{{w, x * h}}
                          : s == 2 ? Vec<2>{{(1 - x) * w, h}}
                                   : Vec<2>{{0, (1 - x) * h}});
    }
    return out;
}

double shape(const std::vector<Vec<2>>& p, std::size_t i, std::size_t k, std::size_t j) {
    const Vec<2> a = p[k] - p[i], b = p[j] - p[i], c = p[j] - p[k];
    return cross(a, b) / (dot(a, a) + dot(b, b) + dot(c, c));
}

// Of all triangulations, by trying them.
double best_shape(const std::vector<Vec<2>>& p) {
    const std::function<double(std::size_t, std::size_t)> best = [&](std::size_t i, std::size_t j) {
        if (j - i < 2) return 1.0;
        double most = 0;
        for (std::size_t k = i + 1; k < j; ++k)
            most = std::max(most, std::min({best(i, k), best(k, j), shape(p, i, k, j)}));
        return most;
    };
    return best(0, p.size() - 1);
}

TEST(LeafTriangles, cover_the_rectangle_with_the_best_shapes) {
    Random random(31);
    for (int round = 0; round < 300; ++round) {
        const auto p = rectangle(random, round % 7);
        std::vector<std::array<int, 3>> t;
        ASSERT_TRUE(add_best_triangles(p, t));
        ASSERT_EQ(t.size(), p.size() - 2);
        double area = 0, worst = 1;
        for (const auto& [a, b, c] : t) {
            const double s = shape(p, std::size_t(a), std::size_t(b), std::size_t(c));
            EXPECT_GT(s, 0);
            worst = std::min(worst, s);
            area += cross(p[std::size_t(b)] - p[std::size_t(a)], p[std::size_t(c)] - p[std::size_t(a)]);
        }
        const auto corner = [&](bool high) {
            Vec<2> out = p[0];
            for (const auto& x : p)
                for (int d = 0; d < 2; ++d) out[d] = high ? std::max(out[d], x[d]) : std::min(out[d], x[d]);
            return out;
        };
        const Vec<2> size = corner(true) - corner(false);
        EXPECT_NEAR(area, 2 * size[0] * size[1], 1e-12 * area);
        EXPECT_DOUBLE_EQ(worst, best_shape(p));
    }
}

TEST(LeafTriangles, of_points_on_one_line_there_are_none) {
    std::vector<std::array<int, 3>> t;
    EXPECT_FALSE(add_best_triangles(std::vector<Vec<2>>{{{0, 0}}, {{1, 0}}, {{2, 0}}, {{3, 0}}}, t));
    EXPECT_TRUE(t.empty());
}

// A ring bends evenly: over a range of tolerances its leaves are not many more than the bound asks for,
// whatever multiple of a power of two that is.
TEST(Columns, bring_leaves_near_the_number_that_is_needed) {
    const SurfaceGeometry ring =
        Revolution{Conic<3>{ConicKind::ellipse, {{4, 0, 0}}, {{1, 0, 0}}, {{0, 0, 1}}}, {}, {{0, 0, 1}}};
    const DerivativeQuery<2, 3> surface(ring);
    const std::vector<Vec<2>> polygon{{{0, -1}}, {{3, -1}}, {{3, 1}}, {{0, 1}}};
    const std::vector<std::array<int, 2>> segments{{0, 1}, {1, 2}, {2, 3}, {3, 0}};
    double most = 0, sum = 0;
    constexpr int kTolerances = 16;
    for (int k = 0; k < kTolerances; ++k) {
        const double tolerance = std::exp2(-9 - 4.0 * k / kTolerances);
        const auto tree =
            must(CurvatureTree::make(surface, polygon, segments, {.tolerance = tolerance}, 1'000'000));
        // Half of the error for each direction: cells of 4 tolerance / sqrt(uu vv).
        double needed = 0;
        constexpr int kSteps = 100;
        for (int i = 0; i < kSteps; ++i) {
            const double v = -1 + 2 * (i + 0.5) / kSteps, r = 4 + std::cos(v);
            needed += 3 * (2.0 / kSteps) * std::sqrt(r * std::cos(v)) / (4 * tolerance);
        }
        const Vec<2> mean = tree.mean_leaf();
        const double leaves = 3 * 2 / (mean[0] * mean[1]);
        EXPECT_GT(leaves, 0.9 * needed);
        most = std::max(most, leaves / needed), sum += leaves / needed;
    }
    EXPECT_LT(most, 1.9);
    EXPECT_LT(sum / kTolerances, 1.45);
}

// A bumpy spline with `pieces` that end about as far from each other along each axis, but for one that is
// `narrow` of the others.
DerivativeQuery<2, 3> bumpy(int pieces, double narrow, SurfaceGeometry& surface,
                            std::vector<double>& breaks) {
    test::Random random(23);
    breaks = {0};
    for (int k = 0; k < pieces; ++k)
        breaks.push_back(breaks.back() + (k == pieces / 2 ? narrow : 1) * random.real(0.9, 1.1));
    std::vector<double> knots{0, 0, 0};
    knots.insert(knots.end(), breaks.begin(), breaks.end());
    knots.insert(knots.end(), 3, breaks.back());
    const auto basis = test::must(BSplineBasis::make(3, knots));
    std::vector<Vec<3>> points;
    for (int i = 0; i < basis.size(); ++i)
        for (int k = 0; k < basis.size(); ++k) points.push_back({{1.0 * i, 1.0 * k, random.real(-1, 1)}});
    surface = test::must(
        Surface<Vec<3>>::make({basis, basis}, Net<2, Vec<3>>({basis.size(), basis.size()}, points)));
    return DerivativeQuery<2, 3>(surface);
}
// How many of the breaks leaves end at.
int met_breaks(const DerivativeQuery<2, 3>& surface, const std::vector<double>& breaks, double tolerance) {
    const double a = breaks.front(), b = breaks.back();
    const std::vector<Vec<2>> polygon{{{a, a}}, {{b, a}}, {{b, b}}, {{a, b}}};
    const std::vector<std::array<int, 2>> segments{{0, 1}, {1, 2}, {2, 3}, {3, 0}};
    const auto tree =
        must(CurvatureTree::make(surface, polygon, segments, {.tolerance = tolerance}, 1'000'000));
    std::set<double> ends;
    for (const auto& c : tree.corners()) ends.insert(c.at[0]);
    int met = 0;
    for (std::size_t k = 1; k + 1 < breaks.size(); ++k) met += int(ends.count(breaks[k]));
    return met;
}

TEST(Columns, are_the_pieces_of_a_bumpy_spline) {
    SurfaceGeometry geometry;
    std::vector<double> breaks;
    const DerivativeQuery<2, 3> even = bumpy(11, 1, geometry, breaks);
    EXPECT_EQ(std::vector<double>(even.breaks(0).begin(), even.breaks(0).end()), breaks);
    EXPECT_EQ(met_breaks(even, breaks, 1e-3), 10);
    EXPECT_EQ(met_breaks(even, breaks, 0.5), 0);  // leaves are larger than pieces
}

TEST(Columns, are_no_pieces_where_one_is_narrow) {
    SurfaceGeometry geometry;
    std::vector<double> breaks;
    const DerivativeQuery<2, 3> uneven = bumpy(11, 0.05, geometry, breaks);
    EXPECT_EQ(met_breaks(uneven, breaks, 1e-3), 0);
    const SurfaceGeometry ring =
        Revolution{Conic<3>{ConicKind::ellipse, {{4, 0, 0}}, {{1, 0, 0}}, {{0, 0, 1}}}, {}, {{0, 0, 1}}};
    const DerivativeQuery<2, 3> of_ring(ring);
    EXPECT_TRUE(of_ring.breaks(0).empty());
}

}  // namespace
}  // namespace freiform
