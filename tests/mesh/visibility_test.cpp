#include <freiform/mesh/visibility.hpp>

#include <cmath>
#include <gtest/gtest.h>
#include <random>

namespace freiform {
namespace {

using Corners = std::array<Vec<3>, 3>;

std::vector<Corners> square(double z, double half = 1) {
    const Vec<3> a{{-half, -half, z}}, b{{half, -half, z}}, c{{half, half, z}}, d{{-half, half, z}};
    return {{a, b, c}, {a, d, c}};  // the second one clockwise
}

Vec<3> random_point(std::mt19937& rng) {
    std::uniform_real_distribution<double> in(-1, 1);
    return {{in(rng), in(rng), in(rng)}};
}

// The slow twin: how far inside of a triangle p is in the picture (negative: outside), and behind its plane.
struct Seen {
    double inside, behind;
};
Seen seen(const Vec<3>& p, const Corners& t) {
    const auto side = [&](const Vec<3>& a, const Vec<3>& b, const Vec<3>& q) {
        return ((b[0] - a[0]) * (q[1] - a[1]) - (b[1] - a[1]) * (q[0] - a[0])) /
               std::hypot(b[0] - a[0], b[1] - a[1]);
    };
    const double sign = side(t[0], t[1], t[2]) > 0 ? 1 : -1;
    const double inside =
        std::min({sign * side(t[0], t[1], p), sign * side(t[1], t[2], p), sign * side(t[2], t[0], p)});
    const Vec<3> n = sign * unit(cross(t[1] - t[0], t[2] - t[0]));
    return {inside, dot(n, t[0] - p)};
}

TEST(Occluders, hide_exactly_what_is_behind_them) {
    const Occluders one(square(1), 1e-3);
    const auto h = one.hidden({{-2, 0.25, 0}}, {{2, 0.25, 0}});
    ASSERT_EQ(h.size(), 1u);
    EXPECT_DOUBLE_EQ(h[0].lo, 0.25);
    EXPECT_DOUBLE_EQ(h[0].hi, 0.75);
    EXPECT_TRUE(one.hidden({{-2, 0.25, 2}}, {{2, 0.25, 2}}).empty()) << "in front";
    EXPECT_TRUE(one.hidden({{-2, 1.25, 0}}, {{2, 1.25, 0}}).empty()) << "beside";
    // From before to behind: hidden from tolerance behind the plane on.
    const auto through = one.hidden({{0.5, 0, 2}}, {{0.5, 0.5, 0}});
    ASSERT_EQ(through.size(), 1u);
    EXPECT_NEAR(through[0].lo, 0.5005, 1e-12);
    EXPECT_EQ(through[0].hi, 1);
    EXPECT_EQ(one.hidden({{0, 0, 0}}, {{0, 0, 0}}).size(), 1u) << "a point";
}

TEST(Occluders, do_not_hide_what_runs_on_them_however_obliquely_they_are_seen) {
    std::mt19937 rng(1);
    for (int i = 0; i < 300; ++i) {
        Corners t{random_point(rng), random_point(rng), random_point(rng)};
        const double flat = std::exp2(-(i % 40));
        for (Vec<3>& p : t) p[0] *= flat;
        const Occluders one({t}, 1e-12);
        EXPECT_TRUE(one.hidden(0.5 * (t[0] + t[1]), 0.3 * t[0] + 0.7 * t[2]).empty()) << i;
        EXPECT_TRUE(one.hidden(t[0], t[1]).empty()) << i;
    }
}

TEST(Occluders, agree_with_rays_through_many_points) {
    std::mt19937 rng(2);
    constexpr double kTolerance = 0.01, kRounding = 1e-9;
    std::vector<Corners> triangles;
    for (int i = 0; i < 400; ++i) {
        const Vec<3> at = random_point(rng);
        triangles.push_back({at, at + 0.3 * random_point(rng), at + 0.3 * random_point(rng)});
    }
    const Occluders all(triangles, kTolerance);
    int hidden_points = 0, judged = 0;
    for (int i = 0; i < 100; ++i) {
        const Vec<3> a = random_point(rng), b = random_point(rng);
        const auto parts = all.hidden(a, b);
        for (std::size_t k = 1; k < parts.size(); ++k) EXPECT_LT(parts[k - 1].hi, parts[k].lo);
        for (int k = 0; k <= 200; ++k) {
            const double t = k / 200.0;
            const Vec<3> p = a + t * (b - a);
            bool surely = false, perhaps = false;
            for (const Corners& c : triangles) {
                const Seen s = seen(p, c);
                surely = surely || (s.inside > kRounding && s.behind > kTolerance + kRounding);
                perhaps = perhaps || (s.inside > -kRounding && s.behind > kTolerance - kRounding);
            }
            if (surely != perhaps) continue;
            ++judged;
            const bool hidden = std::ranges::any_of(parts, [&](const Interval& h) { return h.contains(t); });
            hidden_points += hidden;
            ASSERT_EQ(hidden, surely) << i << " " << t;
        }
    }
    EXPECT_GT(judged, 19000);
    EXPECT_GT(hidden_points, 1500);
    EXPECT_LT(hidden_points, judged - 1500);
}

TEST(Occluders, edge_on_and_without_area_hide_nothing) {
    const Vec<3> a{{0, -1, 5}}, b{{0, 1, 5}}, c{{0, 0, 9}};
    const Occluders none({{a, b, c}, {a, a, b}, {a, a, a}}, 0);
    EXPECT_TRUE(none.hidden({{-1, 0, 0}}, {{1, 0, 0}}).empty());
    EXPECT_TRUE(none.hidden({{0, -1, 0}}, {{0, 1, 0}}).empty()) << "below it, along it";
    EXPECT_TRUE(Occluders({}, 0).hidden({{-1, 0, 0}}, {{1, 0, 0}}).empty());
}

TEST(Occluders, scale_with_powers_of_two) {
    std::mt19937 rng(3);
    std::vector<Corners> triangles;
    for (int i = 0; i < 50; ++i)
        triangles.push_back({random_point(rng), random_point(rng), random_point(rng)});
    const Vec<3> a{{-1, -0.9, -1}}, b{{1, 0.8, -0.7}};
    const auto expected = Occluders(triangles, 0x1p-9).hidden(a, b);
    ASSERT_FALSE(expected.empty());
    for (const int e : {-300, -20, 20, 300}) {
        const double s = std::exp2(e);
        auto scaled = triangles;
        for (Corners& t : scaled)
            for (Vec<3>& p : t) p = s * p;
        EXPECT_EQ(Occluders(scaled, 0x1p-9 * s).hidden(s * a, s * b), expected) << e;
    }
}

TEST(SeenParts, cover_the_polyline_in_order) {
    const Occluders one(square(1), 1e-3);
    const std::vector<Vec<3>> line{{{-2, 0, 0}}, {{-0.5, 0.2, 0}}, {{0.5, 0, 0}}, {{2, 0, 0}}};
    const auto parts = seen_parts(one, line);
    ASSERT_EQ(parts.size(), 3u);
    EXPECT_EQ(parts[0].points.front(), line.front());
    EXPECT_EQ(parts[2].points.back(), line.back());
    for (std::size_t i = 0; i < 3; ++i) {
        EXPECT_EQ(parts[i].hidden, i == 1);
        if (i > 0) EXPECT_EQ(parts[i].points.front(), parts[i - 1].points.back());
    }
    EXPECT_EQ(parts[1].points.size(), 4u);
    EXPECT_NEAR(parts[1].points.front()[0], -1, 1e-12);
}

TEST(SeenParts, have_no_specks) {
    // Two squares with a gap below the tolerance: nothing is seen through it.
    auto triangles = square(1);
    for (const Corners& t : square(1)) {
        triangles.push_back(t);
        for (Vec<3>& p : triangles.back()) p[0] += 2.0005;
    }
    const std::vector<Vec<3>> line{{{-2, 0, 0}}, {{4, 0, 0}}};
    EXPECT_EQ(seen_parts(Occluders(triangles, 1e-3), line).size(), 3u);
    EXPECT_EQ(seen_parts(Occluders(triangles, 1e-4), line).size(), 5u);
}

}  // namespace
}  // namespace freiform
