#include "random.hpp"
#include "refusal.hpp"

#include <freiform/path/simplify.hpp>

#include <algorithm>
#include <cmath>
#include <gtest/gtest.h>

namespace freiform {
namespace {

using test::Random;

Vec<2> on_segment(const PathSegment& s, double t) {
    std::array<Hom<2>, 4> p;
    const auto n = std::size_t(s.degree);
    for (std::size_t i = 0; i <= n; ++i)
        p[i] = weighted(s.points[i], s.degree == 2 && i == 1 ? s.weight : 1.0);
    for (std::size_t r = 1; r <= n; ++r)
        for (std::size_t i = 0; i + r <= n; ++i) p[i] = (1 - t) * p[i] + t * p[i + 1];
    return project(p[0]);
}
std::vector<Vec<2>> samples(const Subpath& s, int each) {
    std::vector<Vec<2>> out;
    for (const PathSegment& x : s.segments)
        for (int k = 0; k <= each; ++k) out.push_back(on_segment(x, double(k) / each));
    return out;
}
double to_polyline(const Vec<2>& p, const std::vector<Vec<2>>& line) {
    double least = INFINITY;
    for (std::size_t i = 0; i + 1 < line.size(); ++i) {
        const Vec<2> d = line[i + 1] - line[i];
        const double c = dot(d, d), t = c > 0 ? std::clamp(dot(p - line[i], d) / c, 0.0, 1.0) : 0;
        least = std::min(least, norm(p - line[i] - t * d));
    }
    return least;
}
// The larger of both directions, by samples.
double distance(const Subpath& a, const Subpath& b) {
    const auto each = [](const Subpath& s) { return std::max(1, 3000 / int(s.segments.size())); };
    const auto p = samples(a, std::min(16, each(a))), q = samples(b, std::min(16, each(b)));
    const auto fine_p = samples(a, each(a)), fine_q = samples(b, each(b));
    double most = 0;
    for (const Vec<2>& x : p) most = std::max(most, to_polyline(x, fine_q));
    for (const Vec<2>& x : q) most = std::max(most, to_polyline(x, fine_p));
    return most;
}
Subpath polyline(const std::vector<Vec<2>>& p, bool closed = false) {
    Subpath s{p[0], {}, closed};
    for (std::size_t i = 0; i + 1 < p.size(); ++i) s.segments.push_back({1, {p[i], p[i + 1]}, 1});
    return s;
}

TEST(Simplify, a_cubic_that_was_cut_is_one_again) {
    Random random(61);
    for (int round = 0; round < 30; ++round) {
        const std::array<Vec<2>, 4> c = {{{{0, 0}},
                                          {{random.real(0.5, 2), random.real(0, 2)}},
                                          {{random.real(2, 3.5), random.real(0, 2)}},
                                          {{4, 0}}}};
        const auto blossom = [&](double r, double s, double t) {
            auto p = c;
            int n = 3;
            for (const double x : {r, s, t}) {
                for (int i = 0; i < n; ++i)
                    p[std::size_t(i)] = (1 - x) * p[std::size_t(i)] + x * p[std::size_t(i) + 1];
                --n;
            }
            return p[0];
        };
        Subpath s{c[0], {}, false};
        double t = 0;
        while (t < 1) {
            const double u = std::min(1.0, t + random.real(0.05, 0.3));
            s.segments.push_back(
                {3, {blossom(t, t, t), blossom(t, t, u), blossom(t, u, u), blossom(u, u, u)}, 1});
            t = u;
        }
        const auto out = *simplified({{s}}, {1e-4});
        ASSERT_EQ(out.after, 1u) << round;
        EXPECT_EQ(out.before, s.segments.size());
        EXPECT_LE(out.bound, 1e-4);
        EXPECT_LE(distance(out.path.subpaths[0], s), out.bound + 2e-6);
    }
}

TEST(Simplify, polygons_of_curves_become_few_cubics_within_the_bound) {
    for (const double tolerance : {1e-2, 1e-3, 1e-4}) {
        std::vector<Vec<2>> p;
        const int n = 600;
        for (int i = 0; i <= n; ++i) {
            const double t = 6.283185307179586 * i / n, r = 2 + 0.4 * std::cos(3 * t);
            p.push_back({{r * std::cos(t), r * std::sin(t)}});
        }
        p.back() = p.front();
        const Subpath s = polyline(p, true);
        const auto out = *simplified({{s}}, {tolerance});
        EXPECT_LE(out.bound, tolerance);
        EXPECT_GT(out.bound, 0.05 * tolerance);
        const double measured = distance(out.path.subpaths[0], s);
        EXPECT_LE(measured, out.bound + 5e-6);  // chords of the samples
        EXPECT_GT(measured, 0.2 * out.bound);
        EXPECT_LT(out.after, tolerance < 1e-3 ? 60u : tolerance < 1e-2 ? 30u : 16u);
        EXPECT_TRUE(out.path.subpaths[0].closed);
        EXPECT_EQ(out.path.subpaths[0].segments.back().back(), p[0]);
        // No corners come into it.
        const auto& all = out.path.subpaths[0].segments;
        for (std::size_t i = 0; i + 1 < all.size(); ++i) {
            ASSERT_EQ(all[i].back(), all[i + 1].front());
            const Vec<2> d = unit(all[i].back() - all[i].points[std::size_t(all[i].degree) - 1]),
                         e = unit(all[i + 1].points[1] - all[i + 1].front());
            EXPECT_LE(std::abs(cross(d, e)), 0.03);
        }
    }
}

TEST(Simplify, corners_stay_and_lines_become_one) {
    std::vector<Vec<2>> p;
    for (int i = 0; i < 10; ++i) p.push_back({{i / 10.0, 0}});
    for (int i = 0; i < 10; ++i) p.push_back({{1, i / 10.0}});
    for (int i = 0; i < 10; ++i) p.push_back({{1 - i / 10.0, 1}});
    for (int i = 0; i <= 10; ++i) p.push_back({{0, 1 - i / 10.0}});
    const auto out = *simplified({{polyline(p, true)}}, {1e-6});
    ASSERT_EQ(out.after, 4u);
    const Vec<2> corners[] = {{{0, 0}}, {{1, 0}}, {{1, 1}}, {{0, 1}}};
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_EQ(out.path.subpaths[0].segments[i].degree, 1);
        EXPECT_EQ(out.path.subpaths[0].segments[i].front(), corners[i]);
    }
}

TEST(Simplify, random_paths_keep_their_bound_and_what_cannot_be_replaced) {
    Random random(62);
    int less = 0;
    for (int round = 0; round < 15; ++round) {
        Subpath s{{{0, 0}}, {}, false};
        Vec<2> at{{0, 0}}, way{{1, 0}};
        for (int i = 0; i < 12; ++i) {  // arcs, quadratics and cubics that go on smoothly
            const double a = random.real(-0.8, 0.8), h = random.real(0.2, 1);
            const Vec<2> next{
                {way[0] * std::cos(a) - way[1] * std::sin(a), way[0] * std::sin(a) + way[1] * std::cos(a)}};
            const Vec<2> b = at + h * way, c = b + h * next;
            if (i % 3 == 0)
                s.segments.push_back({2, {at, b, c}, random.real(0.5, 1)});
            else if (i % 3 == 1)
                s.segments.push_back({2, {at, b, c}, 1});
            else
                s.segments.push_back({3, {at, at + 0.7 * (b - at), c - 0.7 * (c - b), c}, 1});
            at = c, way = next;
        }
        for (const double tolerance : {1e-1, 1e-2, 1e-13}) {
            const auto out = *simplified({{s}}, {tolerance});
            EXPECT_LE(out.bound, tolerance);
            EXPECT_LE(distance(out.path.subpaths[0], s), out.bound + 1e-5);  // chords of the samples
            less += out.after < out.before;
            if (tolerance == 1e-13) {
                ASSERT_EQ(out.after, out.before);
                for (std::size_t i = 0; i < out.after; ++i)
                    EXPECT_EQ(out.path.subpaths[0].segments[i].points, s.segments[i].points);
            }
        }
    }
    EXPECT_GT(less, 25);
}

TEST(Simplify, refuses_and_scales) {
    const Path line{{polyline({{{0, 0}}, {{1, 1}}, {{2, 1}}})}};
    test::expect_refusal(simplified(line, {0}), RefusalKind::invalid, "tolerance");
    test::expect_refusal(simplified(line, {NAN}), RefusalKind::invalid, "tolerance");
    const Path bad{{polyline({{{0, 0}}, {{1, NAN}}})}};
    test::expect_refusal(simplified(bad, {1}), RefusalKind::nonfinite, "subpaths[0].segments[0]");
    EXPECT_EQ(simplified({}, {1})->after, 0u);
    // Dots and points that repeat.
    const Path dots{{{{{1, 2}}, {}, true}, polyline({{{0, 0}}, {{0, 0}}, {{0, 0}}})}};
    EXPECT_EQ(simplified(dots, {1})->path.subpaths.size(), 2u);
}

}  // namespace
}  // namespace freiform
