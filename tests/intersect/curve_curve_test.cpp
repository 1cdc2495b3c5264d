#include "plane_curves.hpp"

namespace freiform::test {
namespace {

// --- cases whose truth is known
// -----------------------------------------------------------------------------

const Plane kArch = plane_bezier({{{0, 0}}, {{1, 2}}, {{3, 2}}, {{4, 0}}});
Plane cup(double height) { return plane_bezier({{{-1, 1 + height}}, {{0, -1 + height}}, {{1, 1 + height}}}); }
Plane cap() { return plane_bezier({{{-1, -1}}, {{0, 1}}, {{1, -1}}}); }
// A curve with a cusp at 1/2, (1/2, 3/4).
Plane cusp() { return plane_bezier({{{0, 0}}, {{1, 1}}, {{0, 1}}, {{1, 0}}}); }

void expect_nothing_else(const PlaneAnswer& a, std::size_t contacts, std::size_t overlaps) {
    ASSERT_EQ(a.contacts.size(), contacts);
    ASSERT_EQ(a.overlaps.size(), overlaps);
    ASSERT_TRUE(a.undecided.empty());
}

TEST(IntersectCurves, tangent_parabolas_touch_once) {
    const PlaneAnswer a = meet(cup(0), cap());
    ASSERT_NO_FATAL_FAILURE(expect_nothing_else(a, 1, 0));
    EXPECT_EQ(a.contacts[0].kind, ContactKind::tangent);
    EXPECT_TRUE(a.contacts[0].is_proven());
    EXPECT_EQ(a.contacts[0].multiplicity, 2);
    EXPECT_EQ(a.contacts[0].at, (std::array{0.5, 0.5}));
}

// Two cubics of a drawing; rounding over the sine of the angle made the boxes of zeros as wide as 1e-7.
TEST(IntersectCurves, crossings_at_small_angles_are_found_once_and_known_as_exactly_as_others) {
    const Plane a = plane_bezier(
                    {{{55.774, -190.434}}, {{55.774, -190.434}}, {{61.738, -183.999}}, {{59.227, -189.021}}}),
                b = plane_bezier(
                    {{{59.698, -187.373}}, {{59.698, -187.373}}, {{59.502, -186}}, {{55.97, -190.12}}});
    const PlaneAnswer once = meet(a, b);
    ASSERT_NO_FATAL_FAILURE(expect_nothing_else(once, 1, 0));
    EXPECT_TRUE(once.contacts[0].is_proven());
    EXPECT_NEAR(once.contacts[0].at[0], 0.66654015815898, 1e-13);
    EXPECT_LT(once.contacts[0].box[1].length(), 1e-14);
    for (const double d : {1e-9, 1e-10, 1e-11, 1e-12}) {
        const PlaneAnswer two = meet(cup(-d), cap());
        ASSERT_NO_FATAL_FAILURE(expect_nothing_else(two, 2, 0));
        for (const auto& c : two.contacts) EXPECT_LT(c.box[0].length(), 0x1p-38);
    }
}

TEST(IntersectCurves, nearly_tangent_parabolas_meet_twice_or_not) {
    for (const double d : {1e-9, 1e-12, 1e-14}) {
        const PlaneAnswer two = meet(cup(-d), cap());
        ASSERT_NO_FATAL_FAILURE(expect_nothing_else(two, 2, 0));
        for (const auto& c : two.contacts) {
            EXPECT_TRUE(c.is_proven());
            EXPECT_EQ(c.kind, ContactKind::crossing);
        }
        // y = x^2 - d and y = -x^2 up to the rounding of 1 - d: x = sqrt(d / 2).
        EXPECT_NEAR(two.contacts[1].at[0] - two.contacts[0].at[0], std::sqrt(d / 2), 0.02 * std::sqrt(d));
        ASSERT_NO_FATAL_FAILURE(expect_nothing_else(meet(cup(d), cap()), 0, 0));
    }
}

TEST(IntersectCurves, the_same_curve_is_one_overlap) {
    const PlaneAnswer same = meet(kArch, kArch), back = meet(kArch, reverse(kArch, 0));
    ASSERT_NO_FATAL_FAILURE(expect_nothing_else(same, 0, 1));
    EXPECT_EQ(same.overlaps[0].a, (Interval{0, 1}));
    EXPECT_EQ(same.overlaps[0].b, (Interval{0, 1}));
    EXPECT_EQ(same.overlaps[0].gap, 0);
    EXPECT_FALSE(same.overlaps[0].reversed);
    ASSERT_NO_FATAL_FAILURE(expect_nothing_else(back, 0, 1));
    EXPECT_TRUE(back.overlaps[0].reversed);
    const PlaneAnswer higher = meet(kArch, must(elevate(kArch, 0, 2)));
    ASSERT_NO_FATAL_FAILURE(expect_nothing_else(higher, 0, 1));
}

TEST(IntersectCurves, part_of_a_curve_is_an_overlap_with_its_interval) {
    const PlaneAnswer part = meet(kArch, must(restrict_to(kArch, 0, {0.25, 0.75})));
    ASSERT_NO_FATAL_FAILURE(expect_nothing_else(part, 0, 1));
    EXPECT_EQ(part.overlaps[0].a, (Interval{0.25, 0.75}));
    EXPECT_EQ(part.overlaps[0].gap, 0);
    // Parts of both, each with an end of its own; and ends that only touch.
    const Plane left = must(restrict_to(kArch, 0, {0, 0.625})), right = must(restrict_to(kArch, 0, {0.5, 1})),
                last = must(restrict_to(kArch, 0, {0.625, 1}));
    const PlaneAnswer both = meet(left, right);
    ASSERT_NO_FATAL_FAILURE(expect_nothing_else(both, 0, 1));
    EXPECT_EQ(both.overlaps[0].a, (Interval{0.5, 0.625}));
    EXPECT_EQ(both.overlaps[0].b, (Interval{0.5, 0.625}));
    const PlaneAnswer joint = meet(left, last);
    ASSERT_NO_FATAL_FAILURE(expect_nothing_else(joint, 1, 0));
    EXPECT_EQ(joint.contacts[0].kind, ContactKind::end);
    EXPECT_EQ(joint.contacts[0].at, (std::array{0.625, 0.625}));
}

TEST(IntersectCurves, parts_with_rounded_coefficients_overlap_with_a_bound) {
    const PlaneAnswer part = meet(kArch, must(restrict_to(kArch, 0, {0.3, 0.71})));
    ASSERT_NO_FATAL_FAILURE(expect_nothing_else(part, 0, 1));
    EXPECT_NEAR(part.overlaps[0].a.lo, 0.3, 1e-14);
    EXPECT_NEAR(part.overlaps[0].a.hi, 0.71, 1e-14);
    EXPECT_GT(part.overlaps[0].gap, 0);
    EXPECT_LT(part.overlaps[0].gap, 1e-11);
    const Plane moved = mapped(kArch, [](const Vec<2>& p) { return p + Vec<2>{{0, 1e-5}}; });
    ASSERT_NO_FATAL_FAILURE(expect_nothing_else(meet(kArch, moved, 1e-4), 0, 1));
}

TEST(IntersectCurves, lines_that_lie_on_each_other_overlap_whatever_their_parameters) {
    const Plane line = plane_bezier({{{0, 0}}, {{4, 2}}}),
                slow = plane_bezier({{{2, 1}}, {{3, 1.5}}, {{6, 3}}});
    const PlaneAnswer a = meet(line, slow);
    ASSERT_NO_FATAL_FAILURE(expect_nothing_else(a, 0, 1));
    EXPECT_EQ(a.overlaps[0].a, (Interval{0.5, 1}));
    EXPECT_EQ(a.overlaps[0].b.lo, 0);
    EXPECT_NEAR(slow(a.overlaps[0].b.hi)[0], 4, 1e-14);
}

TEST(IntersectCurves, a_line_through_a_cusp_meets_it_once) {
    for (const Plane& line :
         {plane_bezier({{{0, 0.75}}, {{1, 0.75}}}), plane_bezier({{{0.5, 0}}, {{0.5, 1}}}),
          plane_bezier({{{0, 0.25}}, {{1, 1.25}}})}) {
        PlaneAnswer a = meet(cusp(), line);
        std::erase_if(a.contacts, [](const auto& c) { return std::abs(c.at[0] - 0.5) > 1e-3; });
        ASSERT_NO_FATAL_FAILURE(expect_nothing_else(a, 1, 0));
        EXPECT_TRUE(a.contacts[0].is_proven());
        EXPECT_EQ(a.contacts[0].at[0], 0.5);
        EXPECT_GE(a.contacts[0].multiplicity, 2);
    }
    ASSERT_NO_FATAL_FAILURE(
        expect_nothing_else(meet(cusp(), plane_bezier({{{0, 0.75 + 1e-12}}, {{1, 0.75 + 1e-12}}})), 0, 0));
}

// Both are straight along the same line near their tips, over far more of their parameters than they are
// short.
TEST(IntersectCurves, cusps_that_meet_tip_to_tip_meet_there_alone) {
    const auto other = [](double height) {
        return plane_bezier({{{0, height}}, {{1, height - 1}}, {{0, height - 1}}, {{1, height}}});
    };
    const PlaneAnswer a = meet(cusp(), other(1.5));
    ASSERT_NO_FATAL_FAILURE(expect_nothing_else(a, 1, 0));
    for (std::size_t k = 0; k < 2; ++k) {
        EXPECT_TRUE(a.contacts[0].box[k].contains(0.5));
        EXPECT_LT(a.contacts[0].box[k].length(), 1e-6);
    }
    EXPECT_LT(a.contacts[0].gap, 1e-12);
    for (const double gap : {1e-3, 1e-9, 1e-13})
        ASSERT_NO_FATAL_FAILURE(expect_nothing_else(meet(cusp(), other(1.5 + gap)), 0, 0)) << gap;
    // One reaches into the other: the sides of both cross twice.
    ASSERT_NO_FATAL_FAILURE(expect_nothing_else(meet(cusp(), other(1.5 - 1e-3)), 2, 0));
}

TEST(IntersectCurves, two_cubics_cross_nine_times) {
    const PlaneAnswer a = meet(wave(), mirrored(wave()));
    ASSERT_NO_FATAL_FAILURE(expect_nothing_else(a, 9, 0));
    for (const auto& c : a.contacts) EXPECT_TRUE(c.is_proven() && c.kind == ContactKind::crossing);
}

TEST(IntersectCurves, the_unit_of_length_does_not_matter) {
    for (const double s : {1e-9, 1e11}) {
        const PlaneAnswer a = meet(plane_bezier({{{0, 0}}, {{2 * s, 4 * s}}, {{4 * s, 0}}}),
                                   plane_bezier({{{0, 0.7 * s}}, {{4 * s, 1.1 * s}}}));
        ASSERT_NO_FATAL_FAILURE(expect_nothing_else(a, 2, 0));
        for (const auto& c : a.contacts) EXPECT_LT(c.gap, 1e-13 * s);
    }
}

// Powers of two that bring these to 1 are no doubles.
TEST(IntersectCurves, the_smallest_numbers_are_numbers) {
    for (const double unit : {0x1p-1030, 0x1p-1050, 0x1p-1070}) {
        const Plane a = plane_bezier({{{0, 0}}, {{8 * unit, 8 * unit}}}),
                    b = plane_bezier({{{0, 8 * unit}}, {{8 * unit, 0}}});
        const PlaneAnswer found = meet(a, b);
        ASSERT_EQ(found.contacts.size(), 1u) << unit;
        EXPECT_DOUBLE_EQ(found.contacts[0].at[0], 0.5);
        EXPECT_TRUE(found.contacts[0].is_proven());
        EXPECT_EQ(found.contacts[0].point[0], 4 * unit);
        const Plane dot = plane_bezier({{{0, 0}}, {{0, 0}}});
        EXPECT_EQ(meet(a, dot).contacts.size(), 1u) << unit;
    }
}

TEST(IntersectCurves, a_curve_that_is_a_point_meets_a_line_once) {
    const Plane point = plane_bezier({{{1, 1}}, {{1, 1}}, {{1, 1}}, {{1, 1}}});
    const PlaneAnswer a = meet(point, plane_bezier({{{0, 1}}, {{4, 1}}}));
    ASSERT_NO_FATAL_FAILURE(expect_nothing_else(a, 1, 0));
    EXPECT_EQ(a.contacts[0].box[0], (Interval{0, 1}));
    EXPECT_EQ(a.contacts[0].at[1], 0.25);
    ASSERT_NO_FATAL_FAILURE(
        expect_nothing_else(meet(point, plane_bezier({{{0, 1}}, {{4, 1.0000001}}})), 0, 0));
}

TEST(IntersectCurves, numbers_that_are_not_finite_are_refused) {
    const auto nan =
        Plane::make({must(BSplineBasis::bezier(1))}, Net<1, Vec<2>>({2}, {{{0, 0}}, {{NAN, 1}}}));
    ASSERT_FALSE(nan.has_value());
    EXPECT_EQ(nan.error().kind, RefusalKind::nonfinite);
    for (const double bad : {double(NAN), -1.0})
        EXPECT_FALSE(intersect(kArch, kArch, {.accuracy = bad}).has_value());
}

// --- ends, knots
// --------------------------------------------------------------------------------------------

TEST(IntersectCurves, ends_are_said_to_be_ends) {
    const Plane foot = plane_bezier({{{2, 1.5}}, {{2, 4}}});
    const PlaneAnswer tee = meet(kArch, foot);  // begins on the arch
    ASSERT_NO_FATAL_FAILURE(expect_nothing_else(tee, 1, 0));
    EXPECT_EQ(tee.contacts[0].kind, ContactKind::end);
    EXPECT_TRUE(tee.contacts[0].is_proven());
    EXPECT_EQ(tee.contacts[0].at, (std::array{0.5, 0.0}));
    ASSERT_NO_FATAL_FAILURE(
        expect_nothing_else(meet(kArch, plane_bezier({{{2, 1.5 + 0x1p-50}}, {{2, 4}}})), 0, 0));
    const PlaneAnswer through = meet(kArch, plane_bezier({{{2, 1.5 - 0x1p-50}}, {{2, 4}}}));
    ASSERT_NO_FATAL_FAILURE(expect_nothing_else(through, 1, 0));
    EXPECT_EQ(through.contacts[0].kind, ContactKind::crossing);
    const PlaneAnswer corner = meet(kArch, plane_bezier({{{4, 0}}, {{7, 1}}}));
    ASSERT_NO_FATAL_FAILURE(expect_nothing_else(corner, 1, 0));
    EXPECT_EQ(corner.contacts[0].at, (std::array{1.0, 0.0}));
}

TEST(IntersectCurves, a_root_at_a_knot_is_one_root) {
    Random random(4);
    for (int i = 0; i < 40; ++i) {
        Plane c = random_bezier<Vec<2>>(random, 3);
        const Plane line = plane_bezier({c(0.375) - Vec<2>{{0.3, 1}}, c(0.375) + Vec<2>{{0.3, 1}}});
        const std::size_t whole = meet(c, line).contacts.size();
        const double at[] = {0.375, 0.375, 0.375, 0.75};
        c = must(insert_knots(c, 0, std::span(at)));
        EXPECT_EQ(meet(c, line).contacts.size(), whole) << i;
    }
}

TEST(IntersectCurves, the_corner_of_a_polygon_that_touches_is_one_contact) {
    const Plane roof = must(Plane::make({must(BSplineBasis::make(1, {0, 0, 1, 2, 2}))},
                                        Net<1, Vec<2>>({3}, {{{-1, 0}}, {{0, 1}}, {{1, 0}}})));
    const PlaneAnswer touch = meet(roof, plane_bezier({{{-2, 1}}, {{2, 1}}}));
    ASSERT_NO_FATAL_FAILURE(expect_nothing_else(touch, 1, 0));
    EXPECT_EQ(touch.contacts[0].kind, ContactKind::tangent);
    const PlaneAnswer cross = meet(roof, plane_bezier({{{0, -2}}, {{0, 2}}}));
    ASSERT_NO_FATAL_FAILURE(expect_nothing_else(cross, 1, 0));
    EXPECT_EQ(cross.contacts[0].kind, ContactKind::crossing);
    EXPECT_TRUE(cross.contacts[0].is_proven());
}

// Where the domain is far from zero, rounding of the parameter moves points more than that of coordinates.
TEST(IntersectCurves, gaps_are_of_the_parameters_that_are_given) {
    for (const double from : {0.0, 1e3, 1e6}) {
        const Plane far = must(Plane::make({must(BSplineBasis::bezier(1, {from, from + 1}))},
                                           Net<1, Vec<2>>({2}, {Vec<2>{{0, 0}}, Vec<2>{{3e6, 0}}})));
        const Plane across = plane_bezier({{{1234567, -1000}}, {{1234567, 1000}}});
        const PlaneAnswer a = meet(far, across);
        ASSERT_NO_FATAL_FAILURE(expect_nothing_else(a, 1, 0));
        // Exactly: 3e6 (t - from).
        const double apart = std::abs(3e6 * (a.contacts[0].at[0] - from) - 1234567);
        EXPECT_LE(apart, a.contacts[0].gap) << from;
        EXPECT_LE(a.contacts[0].gap, 1e-8 + 2e-9 * from) << "of use";
    }
}

// A closed curve of one control point has all of its domain as its box.
TEST(IntersectCurves, points_have_their_whole_domain_as_box) {
    const Plane point =
        must(Plane::make({must(BSplineBasis::periodic(3, {1, 2}))}, Net<1, Vec<2>>({1}, {Vec<2>{{5, 5}}})));
    const PlaneAnswer a = meet(point, point);
    ASSERT_EQ(a.contacts.size() + a.overlaps.size(), 1u);
    for (const auto& c : a.contacts)
        for (const Interval& box : c.box) EXPECT_EQ(box, (Interval{1, 2}));
}

}  // namespace
}  // namespace freiform::test
