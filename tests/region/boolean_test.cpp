#include <freiform/region/boolean.hpp>

#include <cstdlib>
#include <gtest/gtest.h>
#include <numbers>
#include <refusal.hpp>
#include <regions.hpp>
#include <sanitizer.hpp>

namespace freiform {
namespace {

using namespace test;

constexpr RegionOperation kAll[] = {RegionOperation::union_of, RegionOperation::intersection,
                                    RegionOperation::difference, RegionOperation::exclusion};
constexpr RegionOptions kFine{.tolerance = 1e-9};

double area(const Path& path) { return signed_area(path).value; }

// All laws for a pair; false where an operation was refused.
bool obeys_laws(const Filled& a, const Filled& b, Random& random, const RegionOptions& options = kFine) {
    const auto ra = region_of(a, options), rb = region_of(b, options);
    if (!ra || !rb) return false;
    const InsideQuery in_a = inside_query(a.path), in_b = inside_query(b.path);
    std::array<double, 4> areas{};
    double size = 0;
    for (const Path* p : {&a.path, &b.path})
        for (const Subpath& s : p->subpaths)
            for (const PathSegment& segment : s.segments)
                for (const Vec<2>& q : segment.points) size = std::max(size, max_abs(q));
    for (const RegionOperation o : kAll) {
        const auto r = combine(a, b, o, options), back = combine(b, a, o, options);
        if (!r || !back) return false;
        EXPECT_LE(r->bound, options.tolerance);
        areas[std::size_t(o)] = area(r->path);
        if (o != RegionOperation::difference)
            EXPECT_NEAR(area(back->path), area(r->path), 1e-9 * (1 + size * size)) << name_of(o);
        const InsideQuery in = inside_query(r->path);
        for (int i = 0; i < 40; ++i) {
            const Vec<2> p{{random.real(-size / 4, size), random.real(-size / 4, size)}};
            const bool wanted =
                is_in(o, is_in(a.rule, in_a.at(p).winding), is_in(b.rule, in_b.at(p).winding));
            EXPECT_EQ(in.at(p).winding, int(wanted)) << name_of(o) << ' ' << p[0] << ' ' << p[1];
        }
    }
    const double whole_a = area(ra->path), whole_b = area(rb->path),
                 slack = 1e-9 * (whole_a + whole_b + size * size * 1e-3);
    EXPECT_NEAR(areas[0], whole_a + whole_b - areas[1], slack);
    EXPECT_NEAR(areas[2], whole_a - areas[1], slack);
    EXPECT_NEAR(areas[3], areas[0] - areas[1], slack);
    return true;
}

// How many pairs: FREIFORM_REGIONS=1000.
int wanted_pairs(int usual) {
    const char* text = std::getenv("FREIFORM_REGIONS");
    return text ? std::atoi(text) : cases(usual);
}

TEST(Combine, random_pairs_obey_the_laws_of_areas_and_points) {
    Random random(1);
    for (int i = 0; i < wanted_pairs(24); ++i) {
        const PathOptions o{.segments = random.integer(2, 4), .lattice = i % 4 == 1, .lines = i % 4 >= 2};
        const Path a = random_path(random, o), b = random_path(random, o);
        EXPECT_TRUE(obeys_laws({a, FillRule(i % 2)}, {b, FillRule(i / 2 % 2)}, random)) << i;
    }
}

Path circle(double x, double y, double r) { return {{ellipse({{x, y}}, r, r)}}; }

TEST(Combine, nasty_pairs_obey_them_too) {
    const Path square{{rectangle(0, 0, 2, 2)}}, disc = circle(0, 0, 1);
    const Path bow{{polygon({{{0, 0}}, {{2, 2}}, {{2, 0}}, {{0, 2}}})}};
    const Path star{{polygon({{{0, 3}}, {{2, -3}}, {{-3, 1}}, {{3, 1}}, {{-2, -3}}})}};
    std::vector<std::pair<Path, Path>> pairs{
        {square, square},
        {square, {{rectangle(2, 0, 4, 2)}}},                      // a common edge
        {square, {{rectangle(2, 1, 4, 3)}}},                      // part of an edge
        {square, {{rectangle(2, 2, 4, 4)}}},                      // a corner
        {square, {{rectangle(0.5, 0.5, 1, 1)}}},                  // nested
        {square, {{rectangle(0, 0, 1, 1)}}},                      // nested with common edges
        {square, {{rectangle(50, 50, 51, 51)}}},                  // far
        {square, {{rectangle(1, 1, 1 + 0x1p-20, 1 + 0x1p-20)}}},  // tiny
        {square, {{polygon({{{0, 0}}, {{2, 2}}, {{0, 2}}, {{2, 2}}, {{0, 0}}})}}},  // there and back
        {square, bow},
        {bow, star},
        {star, star},
        {disc, disc},
        {disc, circle(2, 0, 1)},      // touch from outside
        {disc, circle(0.5, 0, 0.5)},  // from inside
        {disc, circle(1, 0, 1)},
        {disc, {{rectangle(-1, -1, 1, 1)}}},
        {disc, {{rectangle(0, -1, 1, 1)}}},                    // through the joints
        {disc, {{polygon({{{1, 5}}, {{1, -5}}, {{9, 0}}})}}},  // a tangent line
    };
    // A cubic with a loop, with itself, reversed, and with its own chord.
    const Path loop = path_from("M 0 0 C 6 4 -2 4 4 0 Z"), turned = path_from("M 4 0 C -2 4 6 4 0 0");
    pairs.insert(pairs.end(), {{loop, loop}, {loop, turned}, {loop, {{rectangle(0, -1, 4, 0)}}}});
    Random random(2);
    for (std::size_t i = 0; i < pairs.size(); ++i)
        EXPECT_TRUE(obeys_laws({pairs[i].first, FillRule(i % 2)}, {pairs[i].second, FillRule(i % 2)}, random))
            << i;
    // Where coordinates are large, or shapes small, beside the tolerance that there is.
    EXPECT_TRUE(obeys_laws({circle(1e6, 1e6, 1)}, {circle(1e6 + 1, 1e6, 1)}, random, {.tolerance = 1e-6}));
    EXPECT_TRUE(
        obeys_laws({circle(0, 0, 0x1p-30)}, {circle(0x1p-30, 0, 0x1p-30)}, random, {.tolerance = 0x1p-60}));
}

TEST(Combine, copies_that_were_turned_and_turned_back_are_the_same) {
    Random random(3);
    for (int i = 0; i < wanted_pairs(100) / 8; ++i) {
        const Path a = random_path(random, {.segments = 3}), b = moved(moved(a, 0.3, 1, {}), -0.3, 1, {});
        const auto both = combine({a}, {b}, RegionOperation::exclusion, kFine);
        ASSERT_TRUE(both) << i << ' ' << both.error().where << ": " << both.error().message;
        EXPECT_NEAR(area(both->path), 0, 1e-8);
        EXPECT_LE(both->bound, kFine.tolerance);
    }
}

TEST(Combine, polygons_of_small_integers_are_exact) {
    // On the lattice, in directions of multiples of 45 degrees: all corners are multiples of 1/2.
    Random random(4);
    const auto polygon_of = [&] {
        const double x = random.integer(0, 4), y = random.integer(0, 4), s = random.integer(1, 5);
        return random.chance(0.5)
                   ? Path{{rectangle(x, y, x + s, y + random.integer(1, 5))}}
                   : Path{{polygon({{{x, y}}, {{x + s, y + s}}, {{x, y + 2 * s}}, {{x - s, y + s}}})}};
    };
    for (int i = 0; i < 60; ++i) {
        const Path a = polygon_of(), b = polygon_of();
        std::array<double, 4> s{};
        for (const RegionOperation o : kAll) s[std::size_t(o)] = area(must(combine({a}, {b}, o, kFine)).path);
        EXPECT_EQ(s[0] + s[1], area(a) + area(b)) << i;
        EXPECT_EQ(s[2] + s[1], area(a)) << i;
        EXPECT_EQ(s[3] + s[1], s[0]) << i;
    }
}

TEST(Combine, fill_rules_differ_where_a_path_goes_round_twice) {
    const Path star{{polygon({{{0, 3}}, {{2, -3}}, {{-3, 1}}, {{3, 1}}, {{-2, -3}}})}};
    const Region whole = must(region_of({star, FillRule::nonzero}, kFine)),
                 hollow = must(region_of({star, FillRule::evenodd}, kFine));
    EXPECT_EQ(whole.path.subpaths.size(), 1u);
    EXPECT_EQ(whole.path.subpaths[0].segments.size(), 10u);
    EXPECT_EQ(hollow.path.subpaths.size(), 5u);
    EXPECT_GT(area(whole.path), area(hollow.path) + 1);
}

TEST(Combine, what_nothing_crosses_comes_back_with_the_same_numbers) {
    Path a = path_from("M 0.1 0.2 C 0.7 0 1.1 0.3 1 1 Q 0.3 1.3 0.1 0.2 Z");
    a.subpaths[0].segments[1].weight = 0.7;
    const Region r = must(combine({a}, {circle(7, 7, 1)}, RegionOperation::union_of, kFine));
    ASSERT_EQ(r.path.subpaths.size(), 2u);
    for (std::size_t k = 0; k < 2; ++k) {
        EXPECT_EQ(r.path.subpaths[0].segments[k].points, a.subpaths[0].segments[k].points);
        EXPECT_EQ(r.path.subpaths[0].segments[k].weight, a.subpaths[0].segments[k].weight);
    }
}

TEST(Combine, scaling_by_powers_of_two_scales_the_answer_bit_for_bit) {
    Random random(6);
    for (int i = 0; i < 4; ++i) {
        const Path a = random_path(random, {.segments = 3}), b = random_path(random, {.segments = 3});
        const Region at_home = must(combine({a}, {b}, kAll[i], kFine));
        for (const double s : {0x1p-200, 0x1p90}) {
            const Path x = moved(a, 0, s, {}), y = moved(b, 0, s, {});
            const Region there = must(combine({x}, {y}, kAll[i], {.tolerance = s * kFine.tolerance}));
            EXPECT_EQ(there.bound, s * at_home.bound);
            ASSERT_EQ(there.path.subpaths.size(), at_home.path.subpaths.size());
            for (std::size_t k = 0; k < there.path.subpaths.size(); ++k)
                EXPECT_EQ(path_data({{there.path.subpaths[k]}}),
                          path_data(moved({{at_home.path.subpaths[k]}}, 0, s, {})));
        }
    }
}

TEST(Combine, refuses_what_it_cannot_answer) {
    const Path square{{rectangle(0, 0, 1, 1)}};
    Path broken = square;
    broken.subpaths[0].segments[2].points[1] = {{NAN, 0}};
    expect_refusal(combine({square}, {broken}, RegionOperation::union_of, kFine), RefusalKind::nonfinite,
                   "b.subpaths[0].segments[2]");
    expect_refusal(region_of({square}, {.tolerance = 0}), RefusalKind::invalid, "tolerance");
    expect_refusal(region_of({square}, {.tolerance = 1e-15}), RefusalKind::ill_conditioned, "tolerance",
                   "rounding");
    expect_refusal(
        combine({square}, {square}, RegionOperation::union_of, {.tolerance = 1e-9, .max_pairs = 0}),
        RefusalKind::limit, "max_pairs");
    Path heavy = path_from("M 0 0 Q 1 1 2 0 Z");
    heavy.subpaths[0].segments[0].weight = -1;
    expect_refusal(region_of({heavy}, kFine), RefusalKind::unsupported, "a.subpaths[0].segments[0]",
                   "weight");
    EXPECT_TRUE(must(combine({Path{}}, {Path{}}, RegionOperation::union_of, kFine)).path.subpaths.empty());
}

}  // namespace
}  // namespace freiform
