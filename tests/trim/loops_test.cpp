#include "support/sanitizer.hpp"
#include "support/shapes.hpp"
#include "trim/polygons.hpp"

#include <freiform/make/conic.hpp>
#include <freiform/trim/loops.hpp>
#include <freiform/trim/trimmed_surface.hpp>

#include <gtest/gtest.h>
#include <numbers>

namespace freiform {
namespace {

using test::box;
using test::ellipse;
using test::Loop;
using test::Loops;
using test::plane_bezier;
using test::polygon;

constexpr LoopTolerance kExact{0, 1e-9};

std::string refusal_of_loops(const Loops& loops, const LoopTolerance& tolerance = kExact) {
    const auto r = check_loops(loops, tolerance);
    return r ? "accepted" : text(r.error().where, ": ", r.error().message);
}
// The point in a sentence "... at (X, Y), known within B".
Vec<2> place(const std::string& sentence) {
    Vec<2> p{{NAN, NAN}};
    const std::size_t at = sentence.find(" at (");
    if (at != std::string::npos) std::sscanf(sentence.c_str() + at, " at (%lf, %lf), known", &p[0], &p[1]);
    return p;
}
std::size_t contacts(const Loops& loops, const LoopTolerance& tolerance = kExact) {
    const auto r = check_loops(loops, tolerance);
    EXPECT_TRUE(r) << r.error().where << ": " << r.error().message;
    return r ? r->size() : 0;
}

TEST(R27, loops_that_cross_themselves_are_refused_with_the_place) {
    // A bow tie: (0, 0) to (2, 2) crosses (2, 0) to (0, 2) in (1, 1).
    const std::string bow = refusal_of_loops({polygon({{{0, 0}}, {{2, 2}}, {{2, 0}}, {{0, 2}}})});
    EXPECT_TRUE(bow.starts_with("loops[0][0]: crosses loops[0][2] at (")) << bow;
    EXPECT_LE(norm(place(bow) - Vec<2>{{1, 1}}), 1e-9) << bow;
    // A cubic with a loop, closed by a segment: x = 3 t (1-t)(..), crosses itself where x = 0.5.
    const std::string curl = refusal_of_loops(
        {{plane_bezier({{{0, 0}}, {{3, 2}}, {{-2, 2}}, {{1, 0}}}), plane_bezier({{{1, 0}}, {{0, 0}}})}});
    EXPECT_TRUE(curl.starts_with("loops[0][0]: crosses loops[0][0] at (")) << curl;
    EXPECT_NEAR(place(curl)[0], 0.5, 1e-9) << curl;
}

TEST(R27, loops_that_cross_each_other_are_refused_with_the_place) {
    const std::string boxes = refusal_of_loops({box(0, 0, 2, 2), box(1, 1, 3, 3)});
    EXPECT_TRUE(boxes.find("crosses loops[1]") != std::string::npos) << boxes;
    // A circle of radius 5 and a line x = 3: (3, 4) and (3, -4).
    const std::string circle = refusal_of_loops({ellipse({}, {{5, 0}}, {{0, 5}}), box(3, -6, 9, 6)});
    EXPECT_NEAR(place(circle)[0], 3, 1e-9) << circle;
    EXPECT_NEAR(std::abs(place(circle)[1]), 4, 1e-9) << circle;
    EXPECT_EQ(refusal_of_loops({box(0, 0, 4, 4), box(1, 1, 2, 2), box(5, 1, 6, 2)}), "accepted");
}

TEST(R27, loops_that_do_not_close_are_refused_with_the_place) {
    Loop open = box(0, 0, 1, 1);
    open.pop_back();
    const std::string r = refusal_of_loops({box(-1, -1, 3, 3), open});
    EXPECT_TRUE(r.starts_with("loops[1]: the loop is open: from the end of piece 2 at (0, 1)")) << r;
}

TEST(Loops, simple_and_disjoint_ones_have_no_contact) {
    EXPECT_EQ(contacts({box(0, 0, 8, 8), box(1, 1, 2, 2), ellipse({{5, 5}}, {{2, 0}}, {{0, 1}})}), 0u);
    // Sharp and blunt corners, one Bezier piece, two pieces, a spline on a closed basis.
    EXPECT_EQ(contacts({polygon({{{0, 0}}, {{8, 1e-3}}, {{4, 1e-3}}, {{4, 5}}})}), 0u);
    EXPECT_EQ(contacts({{plane_bezier({{{0, 0}}, {{3, 0}}, {{0, 3}}, {{0, 0}}})}}), 0u);
    EXPECT_EQ(contacts({{plane_bezier({{{0, 0}}, {{1, 1}}, {{2, 0}}}),
                         plane_bezier({{{2, 0}}, {{1, -1}}, {{0, 0}}})}}),
              0u);
    const Curve<Vec<2>> ring =
        *Curve<Vec<2>>::make({*BSplineBasis::periodic(3, {0, 1, 2, 3, 4, 5})},
                             Net<1, Vec<2>>({5}, {{{4, 0}}, {{1, 4}}, {{-3, 2}}, {{-3, -2}}, {{1, -4}}}));
    EXPECT_EQ(contacts({{ring}}), 0u);
}

TEST(Loops, many_pieces_cost_little) {
    std::vector<Vec<2>> gear;
    constexpr int kTeeth = 4000;
    for (int i = 0; i < kTeeth; ++i) {
        const double t = 2 * std::numbers::pi * i / kTeeth, r = i % 2 ? 1 : 0.99;
        gear.push_back({{r * std::cos(t), r * std::sin(t)}});
    }
    EXPECT_EQ(contacts({polygon(gear)}, {0, 1e-12}), 0u);
    std::swap(gear[1000], gear[2000]);
    EXPECT_TRUE(refusal_of_loops({polygon(gear)}, {0, 1e-12}).find("crosses") != std::string::npos);
}

TEST(Loops, what_touches_is_a_contact_and_what_crosses_in_a_vertex_a_crossing) {
    // A hole whose corner is on the outer edge, and one whose corner is a vertex of the outer loop.
    EXPECT_EQ(contacts({box(0, 0, 4, 4), polygon({{{0, 2}}, {{1, 1}}, {{1, 3}}})}), 1u);
    EXPECT_EQ(contacts({box(0, 0, 4, 4), polygon({{{0, 0}}, {{2, 1}}, {{1, 2}}})}), 1u);
    // Two triangles tip to tip in one loop, run through so that it does not cross itself; and so that it
    // does.
    const Vec<2> o{}, a{{2, -1}}, b{{2, 1}}, c{{-2, 1}}, d{{-2, -1}};
    EXPECT_EQ(contacts({polygon({o, a, b, o, c, d})}), 1u);
    const std::string eight = refusal_of_loops({polygon({o, a, b, o, d, c})});
    EXPECT_TRUE(eight.find("at (0, 0), known within 0") != std::string::npos) << eight;
    // A corner of one on the edge of the other, and through.
    const std::string through =
        refusal_of_loops({box(0, 0, 4, 4), polygon({{{0, 2}}, {{2, 1}}, {{2, 3}}, {{-1, 2.5}}})});
    EXPECT_TRUE(through.find("crosses loops[1]") != std::string::npos) << through;
    // Circles that touch, inside and outside; numbers that are exact.
    EXPECT_EQ(contacts({ellipse({}, {{2, 0}}, {{0, 2}}), ellipse({{1, 0}}, {{1, 0}}, {{0, 1}})}), 1u);
    EXPECT_EQ(contacts({ellipse({}, {{2, 0}}, {{0, 2}}), ellipse({{3, 0}}, {{1, 0}}, {{0, 1}})}), 1u);
}

TEST(Loops, a_loop_that_goes_round_twice_is_refused_though_its_two_rounds_coincide) {
    std::vector<Vec<2>> twice = {{{0, 0}}, {{2, 0}}, {{2, 2}}, {{0, 2}},
                                 {{0, 0}}, {{2, 0}}, {{2, 2}}, {{0, 2}}};
    const std::string r = refusal_of_loops({polygon(twice)});
    EXPECT_TRUE(r.find("2 times") != std::string::npos) << r;
}

TEST(Loops, gaps_are_no_crossings_and_crossings_within_a_gap_are_not_certain) {
    // The end of each edge overshoots by 1e-12.
    Loop loop = {plane_bezier({{{0, 0}}, {{1 + 1e-12, 0}}}), plane_bezier({{{1, -1e-12}}, {{1, 1}}}),
                 plane_bezier({{{1, 1}}, {{0, 1}}}), plane_bezier({{{0, 1}}, {{0, 0}}})};
    EXPECT_EQ(contacts({loop}, {1e-11, 1e-11}), 0u);
    EXPECT_TRUE(refusal_of_loops({loop}, {0, 1e-11}).find("open") != std::string::npos);
    EXPECT_EQ(refusal_of_loops({loop, box(1 - 1e-13, 0.25, 2, 0.75)}, {1e-11, 1e-13}), "accepted");
    EXPECT_NE(refusal_of_loops({loop, box(1 - 1e-11, 0.25, 2, 0.75)}, {1e-11, 1e-13}), "accepted");
}

TEST(Loops, decisions_scale_with_powers_of_two) {
    for (const double s : {0x1p-300, 0x1p300}) {
        const LoopTolerance t{0, s * 1e-9};
        const Loop tie = polygon({{{0, 0}}, {{2 * s, 2 * s}}, {{2 * s, 0}}, {{0, 2 * s}}});
        EXPECT_FALSE(check_loops(Loops{tie}, t));
        EXPECT_TRUE(
            check_loops(Loops{box(0, 0, s, s), ellipse({{s / 2, s / 2}}, {{s / 4, 0}}, {{0, s / 4}})}, t)
                ->empty());
        EXPECT_FALSE(
            check_loops(Loops{box(0, 0, s, s), ellipse({{s, s / 2}}, {{s / 4, 0}}, {{0, s / 4}})}, t));
    }
}

// Against brute force with exact arithmetic: small whole numbers, many of them on each other's edges.
TEST(Loops, polygons_of_whole_numbers_agree_with_brute_force) {
    std::mt19937 rng(5);
    int crossing = 0, clean = 0;
    for (int round = 0; round < test::cases(2000); ++round) {
        std::vector<Vec<2>> p;
        for (int i = 0; i < 5; ++i) {
            const double x = double(rng() % 7), y = double(rng() % 7);
            p.push_back({{x, y}});
        }
        bool proper = false, touches = false;
        const auto sign = [](double v) { return (v > 0) - (v < 0); };
        const auto side = [&](const Vec<2>& a, const Vec<2>& b, const Vec<2>& c) {
            return sign(cross(b - a, c - a));
        };
        for (std::size_t i = 0; i < 5; ++i) {
            touches = touches || p[i] == p[(i + 1) % 5] ||
                      (side(p[i], p[(i + 1) % 5], p[(i + 2) % 5]) == 0 &&
                       dot(p[(i + 1) % 5] - p[i], p[(i + 2) % 5] - p[(i + 1) % 5]) < 0);
            for (const std::size_t j : {(i + 2) % 5, (i + 3) % 5}) {
                const Vec<2> a = p[i], b = p[(i + 1) % 5], c = p[j], d = p[(j + 1) % 5];
                const int s[4] = {side(a, b, c), side(a, b, d), side(c, d, a), side(c, d, b)};
                if (s[0] * s[1] < 0 && s[2] * s[3] < 0)
                    proper = true;
                else if (s[0] * s[1] <= 0 && s[2] * s[3] <= 0)
                    touches = true;  // or near it: collinear and apart
            }
        }
        const auto r = check_loops(Loops{polygon(p)}, kExact);
        crossing += proper;
        clean += !proper && !touches;
        if (proper) EXPECT_FALSE(r) << round;
        if (!proper && !touches) EXPECT_TRUE(r && r->empty()) << round;
    }
    EXPECT_GT(crossing, test::cases(300));
    EXPECT_GT(clean, test::cases(100));
}

TEST(Loops, orientation_is_repaired_by_depth_and_says_what_it_turned) {
    const auto clockwise = [](double x0, double y0, double x1, double y1) {
        return polygon({{{x0, y0}}, {{x0, y1}}, {{x1, y1}}, {{x1, y0}}});
    };
    const Loops given = {clockwise(0, 0, 16, 16), box(1, 1, 8, 8), box(2, 2, 7, 7),
                         ellipse({{4.5, 4.5}}, {{1, 0}}, {{0, 1}}), clockwise(9, 9, 15, 15)};
    const auto done = orient_loops(given, kExact);
    ASSERT_TRUE(done) << done.error().message;
    EXPECT_EQ(done->depth, (std::vector{0, 1, 2, 3, 1}));
    EXPECT_EQ(done->reversed, (std::vector<std::size_t>{0, 1, 3}));
    const auto before = *InsideQuery::make(given, 0), after = *InsideQuery::make(done->loops, 0);
    std::mt19937 rng(6);
    for (int i = 0; i < 2000; ++i) {
        const double x = test::uniform(rng, -1, 17), y = test::uniform(rng, -1, 17);
        const Inside in = after.at({{x, y}});
        EXPECT_EQ(in.place, before.at({{x, y}}).place);
        EXPECT_EQ(in.winding, in.place == Place::inside ? 1 : 0);
    }
    const auto again = orient_loops(done->loops, kExact);
    EXPECT_TRUE(again->reversed.empty());
    EXPECT_EQ(again->loops, done->loops);
}

TEST(Loops, orientation_of_holes_that_touch_and_of_curves) {
    const Loops given = {
        {plane_bezier({{{0, 0}}, {{4, -6}}, {{8, 0}}}), plane_bezier({{{8, 0}}, {{4, 6}}, {{0, 0}}})},
        polygon({{{0, 0}}, {{3, -1}}, {{3, 1}}})};
    const auto done = orient_loops(given, kExact);
    ASSERT_TRUE(done) << done.error().message;
    EXPECT_EQ(done->depth, (std::vector{0, 1}));
    EXPECT_EQ(done->reversed, (std::vector<std::size_t>{1}));
    EXPECT_EQ(orient_loops({box(0, 0, 1, 1), box(0, 0, 1, 1)}, kExact).error().kind, RefusalKind::no_answer);
    EXPECT_EQ(orient_loops({polygon({{{0, 0}}, {{1, 1}}})}, kExact).error().kind, RefusalKind::no_answer);
}

TEST(Loops, thousands_on_top_of_each_other_are_refused_at_once) {
    const Loops pile(1000, box(0, 0, 1, 1));
    EXPECT_EQ(check_loops(pile, kExact).error().kind, RefusalKind::limit);
}

TEST(Loops, refuses_tolerances_that_are_none) {
    EXPECT_TRUE(refusal_of_loops({box(0, 0, 1, 1)}, {-1, 1}).starts_with("gap: "));
    EXPECT_TRUE(refusal_of_loops({box(0, 0, 1, 1)}, {0, 0}).starts_with("accuracy: "));
    EXPECT_EQ(contacts({}), 0u);
}

TEST(TrimmedSurface, refuses_loops_that_cross) {
    const auto plane =
        *Surface<Vec<3>>::make({*BSplineBasis::bezier(1, {0, 4}), *BSplineBasis::bezier(1, {0, 4})},
                               Net<2, Vec<3>>({2, 2}, {{{0, 0, 0}}, {{0, 4, 0}}, {{4, 0, 0}}, {{4, 4, 0}}}));
    EXPECT_TRUE(TrimmedSurface::make(plane, {box(0, 0, 4, 4), box(0, 1, 1, 2)}));  // touches
    const auto r = TrimmedSurface::make(plane, {box(0, 0, 3, 3), box(2, 1, 4, 2)});
    ASSERT_FALSE(r);
    EXPECT_EQ(r.error().where, "loops[0][1]");
}

}  // namespace
}  // namespace freiform
