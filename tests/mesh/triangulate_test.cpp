#include "support/constrained_triangulation.hpp"

#include <cmath>
#include <ctime>
#include <gtest/gtest.h>
#include <limits>
#include <map>
#include <numbers>
#include <random>
#include <set>

namespace freiform {

// The exhaustive search behind the walk of `locate`, which no known input needs.
struct TriangulationProbe {
    static Triangulation::Location search(const Triangulation& t, const Vec<2>& p) {
        return t.locate_by_search(p);
    }
};

namespace {

using namespace test;
using Insert = Triangulation::Insert;

TEST(Triangulate, regions_become_constrained_delaunay_triangulations) {
    std::mt19937 random(1);
    for (int k = 0; k < 12; ++k) {
        const Region r = region_number(k, random);
        const Triangulation t = make(r);
        SCOPED_TRACE(text("region ", k, " with ", r.points.size(), " points"));
        ASSERT_NO_FATAL_FAILURE(check_structure(t, r.segments));
        ASSERT_NO_FATAL_FAILURE(check_by_definition(t, r));
    }
}

// Loops of known nesting: the area of the region is the alternating sum of the areas of the loops.
TEST(Triangulate, inside_triangles_have_exactly_the_odd_even_area) {
    std::mt19937 random(2);
    for (int k = 0; k < 8; ++k) {
        const Region r = nested_rings(random);
        const int sign_of_loop[] = {1, -1, 1, -1, -1, 1};
        std::vector<Rational> areas;
        for (std::size_t i = 0; i < r.segments.size(); ++i) {
            if (i == 0 || r.segments[i].a != r.segments[i - 1].b) areas.push_back(0);
            areas.back() += doubled_area(r.points[std::size_t(r.segments[i].a)],
                                         r.points[std::size_t(r.segments[i].b)], {{0, 0}});
        }
        ASSERT_EQ(areas.size(), 6u);
        Rational want = 0;
        for (std::size_t i = 0; i < 6; ++i) want += sign_of_loop[i] * abs(areas[i]);
        EXPECT_EQ(inside_area(make(r)), want);
    }
}

// Many short walls first, then long segments between and along them: walls end inside the crossed region.
TEST(Triangulate, long_segments_through_many_triangles) {
    std::mt19937 random(3);
    int long_ones = 0;
    for (int k = 0; k < 300; ++k) {
        Region r;
        const auto at = [&](int i) { return r.points[std::size_t(i)]; };
        const auto add = [&](int a, int b) {
            for (const auto [c, d] : r.segments)
                if (segments_cross(at(a), at(b), at(c), at(d))) return false;
            for (const Vec<2>& p : r.points)
                if (is_between(at(a), at(b), p)) return false;
            r.segments.push_back({a, b});
            r.segments.push_back({b, a});  // twice: an edge that does not change sides
            return true;
        };
        const int n = 10 + k % 50;
        std::set<std::pair<int, int>> used;
        while (int(r.points.size()) < 2 * n) {
            const int x = int(random() % 1000), y = int(random() % 60), up = 1 + int(random() % 60);
            if (!used.insert({x, y}).second || !used.insert({x, y + up}).second) continue;
            r.points.push_back({{3.0 * x, 3.0 * y}});
            r.points.push_back({{3.0 * x, 3.0 * (y + up)}});
        }
        for (int i = 0; i < n; ++i) add(2 * i, 2 * i + 1);
        for (int i = 0; i < 20; ++i) {
            const int a = int(random() % unsigned(2 * n)), b = int(random() % unsigned(2 * n));
            long_ones += a / 2 != b / 2 && add(a, b);
        }
        const Triangulation t = make(r);
        ASSERT_NO_FATAL_FAILURE(check_structure(t, r.segments)) << "case " << k;
        ASSERT_NO_FATAL_FAILURE(check_by_definition(t, r)) << "case " << k;
    }
    EXPECT_GT(long_ones, 500);
}

// Everything that can be wrong with random segments on a small grid, against the definition of a conflict.
TEST(Triangulate, conflicts_are_found_exactly_when_there_are_some) {
    std::mt19937 random(4);
    int made = 0, refused = 0;
    for (int k = 0; k < 6000; ++k) {
        Region r;
        std::set<std::pair<int, int>> used;
        const int size = 2 + int(random() % 7), loops = 1 + int(random() % 3);
        for (int l = 0; l < loops; ++l) {
            Points loop;
            const int corners = 3 + int(random() % 3);
            while (int(loop.size()) < corners) {
                const int x = int(random() % unsigned(size)), y = int(random() % unsigned(size));
                if (used.size() == std::size_t(size * size)) break;
                if (used.insert({x, y}).second) loop.push_back({{3.0 * x, 3.0 * y}});
            }
            if (loop.size() > 1) r.add_loop(loop);
        }
        std::set<std::pair<int, int>> crossing, through;  // (segment, segment) and (segment, point)
        const auto point = [&](int i) { return r.points[std::size_t(i)]; };
        for (int i = 0; i < int(r.segments.size()); ++i) {
            const auto [a, b] = r.segments[std::size_t(i)];
            for (int j = 0; j < int(r.segments.size()); ++j) {
                const auto [c, d] = r.segments[std::size_t(j)];
                if (segments_cross(point(a), point(b), point(c), point(d))) crossing.insert({i, j});
            }
            for (int p = 0; p < int(r.points.size()); ++p)
                if (is_between(point(a), point(b), point(p))) through.insert({i, p});
        }
        const auto t = Triangulation::attempt(r.points, r.segments);
        ASSERT_EQ(t.has_value(), crossing.empty() && through.empty()) << "case " << k;
        if (t) {
            ++made;
            if (t->size() == 0) continue;
            ASSERT_NO_FATAL_FAILURE(check_structure(*t, r.segments));
            ASSERT_NO_FATAL_FAILURE(check_by_definition(*t, r));
            continue;
        }
        ++refused;
        ASSERT_EQ(t.error().refusal.kind, RefusalKind::invalid);
        ASSERT_FALSE(t.error().conflicts.empty());
        for (const auto& c : t.error().conflicts) {
            ASSERT_EQ(c.other_point, -1);
            if (c.point >= 0)
                ASSERT_TRUE(through.count({c.first_segment, c.point})) << "case " << k;
            else
                ASSERT_TRUE(crossing.count({c.first_segment, c.second_segment})) << "case " << k;
        }
    }
    std::printf("  %d triangulated, %d refused\n", made, refused);
    EXPECT_GT(made, 500);
    EXPECT_GT(refused, 500);
}

TEST(Triangulate, refusals_name_what_is_wrong) {
    const Points square{{{0, 0}}, {{1, 0}}, {{1, 1}}, {{0, 1}}};
    const Segments around{{0, 1}, {1, 2}, {2, 3}, {3, 0}};
    const auto where = [](const Points& p, const Segments& s) {
        const auto t = Triangulation::make(p, s);
        return t ? std::string("made")
                 : text(name_of(t.error().kind), " ", t.error().where, ": ", t.error().message);
    };
    const double nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(where(square, around), "made");
    EXPECT_EQ(where({{{0, 0}}, {{nan, 0}}, {{1, 1}}}, {}), "nonfinite points[1]: (nan, 0) is not finite");
    EXPECT_EQ(where(square, {{0, 4}}), "invalid segments[0]: ends at point 4, but there are 4 points");
    EXPECT_EQ(where(square, {{0, 1}, {2, 2}}), "invalid segments[1]: leads from point 2 to itself");
    EXPECT_EQ(where(square, {{0, 1}, {1, 2}, {2, 3}}),
              "invalid points[0]: the boundary is not closed: an odd number of segments ends here");
    EXPECT_EQ(where({{{0, 0}}, {{1, 0}}, {{0, 0}}, {{-0.0, 0}}}, {}),
              "invalid points[2]: equals points[0], (0, 0); points must be distinct");
    EXPECT_EQ(where(square, {{0, 2}, {2, 3}, {3, 1}, {1, 0}}),
              "invalid segments[2]: crosses segments[0]; segments may meet at their ends only");
    EXPECT_EQ(where({{{0, 0}}, {{2, 0}}, {{2, 2}}, {{1, 1}}}, {{0, 1}, {1, 2}, {2, 0}}),
              "invalid segments[2]: passes through points[3], which must be an end of it");
    const auto t = Triangulation::attempt(Points{{{5, 5}}, {{0, 0}}, {{5, 5}}, {{5, 5}}}, {});
    ASSERT_FALSE(t);
    const std::vector<Triangulation::Conflict> want{{-1, -1, 2, 0}, {-1, -1, 3, 2}};
    EXPECT_EQ(t.error().conflicts, want);
}

TEST(Triangulate, points_on_a_line_have_no_triangles) {
    Points line;
    for (int i = 0; i < 10; ++i) line.push_back({{0.1 * (i * 7 % 10), 0.1 * (i * 7 % 10)}});
    auto t = Triangulation::make(line, Segments{{0, 3}, {3, 0}});  // points 0 and 0.1
    ASSERT_TRUE(t);
    EXPECT_EQ(t->size(), 0);
    EXPECT_EQ(t->insert({{0.5, 0.25}}).status, Insert::outside);
    EXPECT_EQ(t->insert_all(Points{{{0.5, 0.25}}})[0].status, Insert::outside);
    EXPECT_EQ(t->find_edge(0, 3).triangle, -1);
    const auto u = Triangulation::attempt(line, Segments{{0, 6}, {6, 0}});  // 0 to 0.2, through 0.1
    ASSERT_FALSE(u);
    EXPECT_EQ(u.error().conflicts.size(), 2u);
    EXPECT_EQ(u.error().conflicts[0].point, 3);
    EXPECT_EQ(u.error().conflicts[1].point, 3);
    for (std::size_t n : {0u, 1u, 2u}) {
        const auto few = Triangulation::make(Points(line.begin(), line.begin() + std::ptrdiff_t(n)), {});
        ASSERT_TRUE(few);
        EXPECT_EQ(few->size(), 0);
    }
}

TEST(Triangulate, a_segment_given_twice_does_not_change_sides) {
    Region r;
    r.add_loop({{{0, 0}}, {{30, 0}}, {{30, 30}}, {{0, 30}}});
    r.points.push_back({{9, 9}});
    r.points.push_back({{21, 15}});
    r.segments.push_back({4, 5});
    r.segments.push_back({4, 5});
    const Triangulation t = make(r);
    check_structure(t, r.segments);
    EXPECT_EQ(inside_area(t), 2 * 900);
    r.segments.insert(r.segments.end(), r.segments.begin(), r.segments.begin() + 4);
    EXPECT_EQ(inside_area(make(r)), 0);
}

Points grid(int n, double step) {
    Points p;
    for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) p.push_back({{step * i, step * j}});
    return p;
}

Segments frame_of_grid(int n) {
    Segments s;
    for (int i = 0; i + 1 < n; ++i)
        for (const auto& [a, b] : {std::pair{i, i + 1},
                                   {n * i, n * i + n},
                                   {n * n - 1 - i, n * n - 2 - i},
                                   {n - 1 + n * i, 2 * n - 1 + n * i}})
            s.push_back({a, b});
    return s;
}

TEST(Triangulate, grids_whose_points_are_all_on_common_circles) {
    for (const double step : {3.0, 0.1, 1e-300, 0x1p-1074}) {
        const Triangulation t = make({grid(25, step), frame_of_grid(25)});
        ASSERT_NO_FATAL_FAILURE(check_structure(t, frame_of_grid(25)));
        int inside = 0;
        for (int i = 0; i < t.size(); ++i) inside += t.is_inside(i);
        EXPECT_EQ(inside, 2 * 24 * 24);
    }
    // Points on one circle: all 3-4-5 multiples with hypotenuse 5 * 13 * 17 * 29.
    Points circle;
    for (int x = 0; x <= 32045; ++x) {
        const auto y = std::int64_t(std::sqrt(32045.0 * 32045 - double(x) * x));
        if (std::int64_t(x) * x + y * y != 32045LL * 32045) continue;
        for (const double sx : {-1.0, 1.0})
            for (const double sy : {-1.0, 1.0})
                if ((x > 0 || sx > 0) && (y > 0 || sy > 0)) circle.push_back({{sx * x, sy * double(y)}});
    }
    EXPECT_EQ(circle.size(), 324u);
    check_structure(make({circle, {}}), {});
}

// All that a caller can see.
using Picture = std::vector<std::array<int, 4>>;
Picture picture(const Triangulation& t) {
    Picture all;
    for (int i = 0; i < t.size(); ++i)
        all.push_back({t.vertices(i)[0], t.vertices(i)[1], t.vertices(i)[2], t.is_inside(i)});
    return all;
}

Points random_points(std::mt19937& random, int n, double size) {
    std::uniform_real_distribution<double> at(-size, size);
    Points p;
    for (int i = 0; i < n; ++i) {
        const double x = at(random);
        p.push_back({{x, at(random)}});
    }
    return p;
}

TEST(Triangulate, scaling_by_powers_of_two_changes_nothing) {
    std::mt19937 random(6);
    Region r = nested_rings(random);
    Points extra = random_points(random, 500, 200000);
    const auto picture_at = [&](int exponent) {
        const auto scaled = [&](Points p) {
            for (Vec<2>& q : p) q = {{std::scalbn(q[0], exponent), std::scalbn(q[1], exponent)}};
            return p;
        };
        Triangulation t = make({scaled(r.points), r.segments});
        t.insert_all(scaled(Points(extra.begin(), extra.begin() + 400)));
        for (const Vec<2>& p : scaled(Points(extra.begin() + 400, extra.end()))) t.insert(p);
        return picture(t);
    };
    const Picture want = picture_at(0);
    for (const int exponent : {-900, -300, -1, 1, 300, 900})
        EXPECT_EQ(picture_at(exponent), want) << exponent;
}

// The fate of a point by brute force.
Triangulation::Inserted expected_fate(const Triangulation& t, const Region& r, const Vec<2>& p) {
    for (int i = 0; i < int(t.points().size()); ++i)
        if (t.points()[std::size_t(i)] == p) return {Insert::duplicate, i};
    for (const auto [a, b] : r.segments)
        if (is_between(r.points[std::size_t(a)], r.points[std::size_t(b)], p))
            return {Insert::on_segment, -1};
    if (!is_in_region(r, p)) return {Insert::outside, -1};
    return {Insert::done, int(t.points().size())};
}

TEST(Triangulate, insertions_keep_all_invariants_and_report_changes) {
    std::mt19937 random(7);
    Region r;
    r.add_loop({{{0, 0}}, {{60, 0}}, {{60, 60}}, {{0, 60}}});
    r.add_loop({{{21, 21}}, {{36, 21}}, {{30, 45}}});
    Triangulation t = make(r);
    std::map<Insert, int> seen;
    for (int k = 0; k < 1500; ++k) {
        const Vec<2> p{{double(random() % 70) - 4, double(random() % 70) - 4}};
        const int hint = int(random() % unsigned(t.size() + 1)) - 1;
        const auto want = expected_fate(t, r, p);
        const Triangulation before = t;
        const auto got = t.insert(p, hint);
        ASSERT_EQ(got, want) << "point " << p[0] << ", " << p[1];
        ++seen[got.status];
        if (got.status != Insert::done) {
            ASSERT_EQ(picture(t), picture(before));
            continue;
        }
        if (k % 10 == 0) {
            ASSERT_NO_FATAL_FAILURE(check_structure(t, r.segments));
        }
        const std::set<int> changed(t.changed().begin(), t.changed().end());
        ASSERT_EQ(changed.size(), t.changed().size());
        for (int i = 0; i < t.size(); ++i) {
            const bool is_new = i >= before.size();
            ASSERT_TRUE(changed.count(i) || (!is_new && t.vertices(i) == before.vertices(i)));
            ASSERT_TRUE(is_new || (t.stamp(i) > before.stamp(i)) == (changed.count(i) == 1));
        }
    }
    check_by_definition(t, r);
    EXPECT_EQ(seen.size(), 4u);
    for (const auto& [status, count] : seen) EXPECT_GT(count, 10);
}

TEST(Triangulate, walk_and_search_find_the_same) {
    std::mt19937 random(10);
    const Triangulation t = make({grid(9, 3), frame_of_grid(9)});
    using On = Triangulation::Location::On;
    std::map<On, int> seen;
    for (int k = 0; k < 2000; ++k) {
        const Vec<2> p{{double(random() % 60) / 2 - 3, double(random() % 60) / 2 - 3}};
        const auto walked = t.locate(p, int(random() % unsigned(t.size())));
        const auto found = TriangulationProbe::search(t, p);
        ASSERT_EQ(walked.on, found.on);
        ++seen[found.on];
        for (const auto& [on, i, part] : {walked, found}) {
            const auto& v = t.vertices(i);
            const auto point = [&](int c) { return t.points()[std::size_t(v[std::size_t(c % 3)])]; };
            ASSERT_EQ(t.is_infinite(i), on == On::outside);
            for (int c = 0; on == On::face && c < 3; ++c) ASSERT_GT(orient2d(point(c), point(c + 1), p), 0);
            ASSERT_TRUE(on != On::edge || is_between(point(part + 1), point(part + 2), p));
            ASSERT_TRUE(on != On::vertex || point(part) == p);
            if (on == On::outside) {
                const int c = t.corner_of(i, Triangulation::kInfinite);
                ASSERT_GT(orient2d(point(c + 1), point(c + 2), p), 0);
            }
        }
    }
    EXPECT_EQ(seen.size(), 4u);
}

TEST(Triangulate, insert_asks_before_it_changes_anything) {
    Triangulation t = make({grid(2, 1), frame_of_grid(2)});
    int asked = -1;
    const auto got = t.insert({{0.25, 0.5}}, -1, [&](int triangle) {
        asked = triangle;
        return true;
    });
    EXPECT_EQ(got.status, Insert::rejected);
    ASSERT_GE(asked, 0);
    EXPECT_TRUE(t.is_inside(asked));
    EXPECT_EQ(t.points().size(), 4u);
    EXPECT_EQ(t.insert({{std::numeric_limits<double>::infinity(), 0.5}}).status, Insert::outside);
    const auto here = t.locate({{0.5, 0.5}});
    EXPECT_EQ(here.on, Triangulation::Location::On::edge);
    EXPECT_FALSE(t.is_constrained(here.triangle, here.part));
    EXPECT_EQ(t.insert({{0.5, 0.5}}).status, Insert::done);
    check_structure(t, frame_of_grid(2));
}

TEST(Triangulate, insert_all_is_insert_of_each) {
    std::mt19937 random(8);
    const Region r = nested_rings(random);
    Points p = random_points(random, 3000, 320000);
    p.push_back(p[5]);
    p.push_back(r.points[7]);
    p.push_back({{std::numeric_limits<double>::quiet_NaN(), 0}});
    Triangulation t = make(r);
    const Triangulation before = t;
    const auto got = t.insert_all(p);
    ASSERT_EQ(got.size(), p.size());
    const std::set<int> changed(t.changed().begin(), t.changed().end());
    EXPECT_EQ(changed.size(), t.changed().size());
    for (int i = 0; i < t.size(); ++i)
        ASSERT_TRUE(changed.count(i) || (i < before.size() && t.vertices(i) == before.vertices(i)));
    int done = 0;
    for (std::size_t i = 0; i < 3000; ++i) {
        ASSERT_TRUE(got[i].status != Insert::done || t.points()[std::size_t(got[i].vertex)] == p[i]);
        done += got[i].status == Insert::done;
        ASSERT_TRUE(i == 5 || (got[i].status == Insert::done) == is_in_region(r, p[i]));
    }
    EXPECT_EQ(int(t.points().size()) - int(r.points.size()), done + (got[3000].status == Insert::done));
    EXPECT_TRUE((got[3000].status == Insert::duplicate) != (got[5].status == Insert::duplicate) ||
                got[5].status == Insert::outside);
    EXPECT_EQ(got[3001], (Triangulation::Inserted{Insert::duplicate, 7}));
    EXPECT_EQ(got[3002].status, Insert::outside);
    ASSERT_NO_FATAL_FAILURE(check_structure(t, r.segments));
}

TEST(Triangulate, a_hundred_thousand_points) {
    std::mt19937 random(9);
    const auto seconds = [](auto&& f) {
        const std::clock_t begin = std::clock();
        f();
        return double(std::clock() - begin) / CLOCKS_PER_SEC;
    };
    const Points cloud = random_points(random, 100000, 1);
    const Region square{{{{-1, -1}}, {{1, -1}}, {{1, 1}}, {{-1, 1}}}, {{0, 1}, {1, 2}, {2, 3}, {3, 0}}};
    std::optional<Triangulation> t;
    std::printf("  make, random points          %.3f s\n", seconds([&] { t = make({cloud, {}}); }));
    EXPECT_EQ(t->size(), 2 * 100000 - 2);
    t = make(square);
    std::printf("  insert_all, random points    %.3f s\n", seconds([&] { t->insert_all(cloud); }));
    EXPECT_EQ(t->size(), 2 * 100004 - 2);
    std::printf("  make, grid of step 0.1       %.3f s\n", seconds([&] {
                    t = make({grid(316, 0.1), frame_of_grid(316)});
                }));
    EXPECT_EQ(t->size(), 2 * 316 * 316 - 2);
    Points parabola;
    for (int i = 0; i < 100000; ++i) parabola.push_back({{double(i), double(i) * i}});
    std::printf("  make, parabola               %.3f s\n", seconds([&] { t = make({parabola, {}}); }));
    EXPECT_EQ(t->size(), 2 * 100000 - 2);
    Region wheel;
    wheel.add_loop(ring(random, 0, 0, 1e9, 100000, 0.5));
    std::printf("  make, polygon of 1e5 corners %.3f s\n", seconds([&] { t = make(wheel); }));
    EXPECT_EQ(t->size(), 2 * 100000 - 2);
}

}  // namespace
}  // namespace freiform
