#include "region/arcs_join_detail.hpp"

#include <freiform/region/stroke.hpp>

#include <gtest/gtest.h>
#include <region_laws.hpp>
#include <sanitizer.hpp>

namespace freiform {
namespace {

using namespace test;

constexpr RegionOptions kArcsFine{.tolerance = 1e-7};

double covered(const Region& r) { return signed_area(r.path).value; }
Region pen_along(std::string_view data, double width, LineJoin join, double limit = 20) {
    return must(stroked(path_from(data), {.width = width, .miter_limit = limit, .join = join, .dashes = {}},
                        kArcsFine));
}
// Is the tip of the corner in the origin at this point?
void expect_tip(const Region& r, const Vec<2>& tip) {
    const InsideQuery in = inside_query(r.path);
    EXPECT_EQ(in.at(0.9999 * tip).winding, 1) << tip[0] << ' ' << tip[1];
    EXPECT_EQ(in.at(1.0001 * tip).winding, 0) << tip[0] << ' ' << tip[1];
}
// What two discs have in common.
double lens_area(double radius, double distance) {
    const double d = distance;
    return 2 * radius * radius * std::acos(d / (2 * radius)) - d / 2 * std::sqrt(4 * radius * radius - d * d);
}

TEST(ArcsJoin, between_lines_is_a_miter_that_is_clipped) {
    for (const double limit : {1.1, 4.0})
        for (const char* corner : {"M 0 0 H 4 V 4", "M 0 0 H 4 L 1 1", "M 4 4 L 0 0 L 4 5 Z"})
            EXPECT_EQ(covered(pen_along(corner, 0.5, LineJoin::arcs, limit)),
                      covered(pen_along(corner, 0.5, LineJoin::miter_clip, limit)))
                << corner << ' ' << limit;
}

TEST(ArcsJoin, of_two_discs_makes_what_larger_discs_have_in_common) {
    // Two quarters of circles; their sides are quarters of circles about the same centres.
    constexpr double kRadius = 2, kHalf = 0.5;
    const std::string_view lens = "M -2 2 A 2 2 0 0 1 0 0 A 2 2 0 0 1 -2 2 Z";
    const double apart = kRadius * std::sqrt(2.0), outer = lens_area(kRadius + kHalf, apart);
    for (const auto& data : {lens, std::string_view("M -2 2 A 2 2 0 0 0 0 0 A 2 2 0 0 0 -2 2 Z")}) {
        const Region larger =
            must(grown({path_from(data)}, {kHalf, LineJoin::arcs, 20}, {.tolerance = 1e-6}));
        EXPECT_NEAR(covered(larger), outer, 1e-5) << data;
    }
    EXPECT_NEAR(covered(pen_along(lens, 2 * kHalf, LineJoin::arcs)),
                outer - lens_area(kRadius - kHalf, apart), 1e-5);
    const double reach = std::sqrt(2.5 * 2.5 - 2) - std::sqrt(2.0);
    expect_tip(pen_along(lens, 2 * kHalf, LineJoin::arcs), reach * unit(Vec<2>{{1, -1}}));
}

TEST(ArcsJoin, of_a_disc_and_a_line_makes_a_part_of_a_larger_disc) {
    const double r = 2.5, d = 0.5;  // half of a disc, and half a unit behind its diameter
    const Region larger =
        must(grown({path_from("M 2 0 A 2 2 0 0 1 -2 0 Z")}, {0.5, LineJoin::arcs, 20}, {.tolerance = 1e-6}));
    EXPECT_NEAR(covered(larger), r * r * std::acos(-d / r) + d * std::sqrt(r * r - d * d), 1e-5);
}

TEST(ArcsJoin, circles_that_are_apart_grow_until_they_touch) {
    // The sides have radii of 1.5; with r = 1 + sqrt 2 circles touch on the bisector, as far from the corner.
    const double r = 1 + std::sqrt(2.0);
    expect_tip(pen_along("M -2.5 -2.5 A 2.5 2.5 0 0 0 0 0 A 2.5 2.5 0 0 0 2.5 2.5", 2, LineJoin::arcs),
               r * unit(Vec<2>{{1, -1}}));
    // The same on the other side, and the other way round.
    expect_tip(pen_along("M -2.5 2.5 A 2.5 2.5 0 0 1 0 0 A 2.5 2.5 0 0 1 2.5 -2.5", 2, LineJoin::arcs),
               r * unit(Vec<2>{{1, 1}}));
}

TEST(ArcsJoin, a_circle_grows_until_it_touches_the_line) {
    // The side has the radius 2 about (0, -3); one of 3 about (0, -4) touches the line sqrt(3) x + y = 2.
    const Vec<2> along{{0.5, -std::sqrt(0.75)}}, across{{std::sqrt(0.75), 0.5}},
        tip = 3 * across - Vec<2>{{0, 4}};
    for (const char* data : {"M -3 -3 A 3 3 0 0 0 0 0 L -5 8.660254037844386",
                             "M -5 8.660254037844386 L 0 0 A 3 3 0 0 1 -3 -3"}) {
        const InsideQuery in = inside_query(pen_along(data, 2, LineJoin::arcs).path);
        for (const double back : {0.1, 0.3}) {  // where circle and line are back^2 / 6 apart
            EXPECT_EQ(in.at(tip - back * along - 0.1 / 6 * back * back * across).winding, 1) << data;
            EXPECT_EQ(in.at(tip - back * along - 0.9 / 6 * back * back * across).winding, 1) << data;
            EXPECT_EQ(in.at(tip - back * along - 1.1 / 6 * back * back * across).winding, 0) << data;
        }
        EXPECT_EQ(in.at(tip + 0.001 * along - 1e-5 * across).winding, 0) << data;
    }
}

TEST(ArcsJoin, a_circle_in_another_one_grows_as_the_other_one_shrinks) {
    using detail::ArcsJoin, detail::ArcsJoinKind, detail::JoinSide;
    // Edges of radii 4, about (0, 3), and 11 / 9, about (1.15, 1.90): within the first circle.
    const double turn = 2.6;
    const Vec<2> e{{std::sin(turn), -std::cos(turn)}};
    const JoinSide first{{{0, -1}}, {{1, 0}}, 1 / 3.0},  // l = 1/4
        last{e, {{e[1], -e[0]}}, -0.45};                 // l = -0.45 / 0.55
    const ArcsJoin join = detail::arcs_join(first, last, 1000);
    ASSERT_EQ(join.kind, ArcsJoinKind::arcs);
    EXPECT_EQ(join.from_first, join.from_last);
    // The circles through the sides and the tip, with the directions of the sides, have one tangent there.
    const Vec<2> tip = join.from_first;
    const double a = detail::half_turn(first.at, first.direction, tip),
                 b = detail::half_turn(last.at, last.direction, tip);
    const auto direction = [&](const JoinSide& s, double half) {
        return Vec<2>{{std::cos(2 * half) * s.direction[0] - std::sin(2 * half) * s.direction[1],
                       std::sin(2 * half) * s.direction[0] + std::cos(2 * half) * s.direction[1]}};
    };
    EXPECT_NEAR(std::abs(cross(direction(first, a), direction(last, b))), 0, 1e-12);
    const double ra = norm(tip - first.at) / (2 * std::abs(std::sin(a))),
                 rb = norm(tip - last.at) / (2 * std::abs(std::sin(b)));
    EXPECT_NEAR(4 - ra, rb - 0.55 / 0.45, 1e-12);  // by the same change
    EXPECT_GT(4 - ra, 0);
}

TEST(ArcsJoin, is_cut_off_where_the_limit_says) {
    const std::string_view lens = "M -2 2 A 2 2 0 0 1 0 0 A 2 2 0 0 1 -2 2 Z";
    for (const double limit : {1.1, 1.2, 1.25})  // the tip is at 1.29 of half the width
        expect_tip(pen_along(lens, 1, LineJoin::arcs, limit), 0.5 * limit * unit(Vec<2>{{1, -1}}));
    // Sides that run back as they came, with circles apart: a rectangle.
    const std::string_view back = "M -3 -3 A 3 3 0 0 0 0 0 A 3 3 0 0 0 -3 3";
    EXPECT_NEAR(covered(pen_along(back, 2, LineJoin::arcs, 3)),
                covered(pen_along(back, 2, LineJoin::bevel)) + 2 * 3, 1e-5);
}

TEST(ArcsJoin, is_round_where_an_edge_bends_more_than_the_pen) {
    // Edges of radius 0.9 with a pen of half width 1.
    const std::string_view path = "M -1.9 -1.9 A 1.9 1.9 0 0 0 0 0 A 1.9 1.9 0 0 0 1.9 1.9";
    EXPECT_EQ(covered(pen_along(path, 2, LineJoin::arcs)), covered(pen_along(path, 2, LineJoin::round)));
}

TEST(ArcsJoin, covers_the_bevel_and_obeys_the_laws_of_regions) {
    Random random(11);
    int sharper = 0;
    for (int i = 0; i < cases(12); ++i) {
        const Path path{{random_loop(random, {.segments = random.integer(2, 4)})}};
        StrokeStyle style{.width = random.chance(0.5) ? 0.2 : 0.7, .join = LineJoin::arcs, .dashes = {}};
        const RegionOptions options{.tolerance = 1e-4};
        const auto arcs = stroked(path, style, options);
        ASSERT_TRUE(arcs) << i << ' ' << arcs.error().where << ": " << arcs.error().message;
        EXPECT_LE(arcs->bound, options.tolerance);
        style.join = LineJoin::bevel;
        const Region bevel = must(stroked(path, style, options));
        const auto rest =
            combine({bevel.path}, {arcs->path}, RegionOperation::difference, {.tolerance = 1e-3});
        ASSERT_TRUE(rest) << i;
        EXPECT_LT(covered(*rest), 1e-2) << i;
        sharper += int(covered(*arcs) > covered(bevel) + 1e-3);
        const Path other{{random_loop(random, {.segments = 3})}};
        const auto refusal = break_laws({arcs->path}, {other}, random, {.tolerance = 1e-3});
        EXPECT_FALSE(refusal) << i << ' ' << refusal->where << ": " << refusal->message;
    }
    EXPECT_GT(12 * sharper, 5 * cases(12));
}

}  // namespace
}  // namespace freiform
