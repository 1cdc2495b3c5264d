// Curves of one algebraic curve, folds and cusps: nothing is lost beside an overlap, nothing invented.
#include "plane_curves.hpp"

namespace freiform::test {
namespace {

const Plane kCusp = plane_bezier({{{0, 0}}, {{0, 0}}, {{1, 0}}, {{1, 1}}});

// All four ways to run along the curves: one answer.
template <class Expect>
void each_way(const Plane& a, const Plane& b, Expect&& expect) {
    for (const bool first : {false, true})
        for (const bool second : {false, true}) {
            SCOPED_TRACE(testing::Message() << first << second);
            PlaneAnswer answer = meet(first ? reverse(a, 0) : a, second ? reverse(b, 0) : b);
            const auto turn = [](Interval& t) { t = {1 - t.hi, 1 - t.lo}; };
            for (auto& c : answer.contacts) {
                if (first) c.at[0] = 1 - c.at[0], turn(c.box[0]);
                if (second) c.at[1] = 1 - c.at[1], turn(c.box[1]);
            }
            for (auto& box : answer.undecided) {
                if (first) turn(box[0]);
                if (second) turn(box[1]);
            }
            for (Overlap& o : answer.overlaps) {
                if (first) turn(o.a);
                if (second) turn(o.b);
                o.reversed = o.reversed != (first != second);
            }
            expect(answer);
        }
}
bool covers(const PlaneAnswer& x, double s, double t) {
    const auto in = [&](const auto& box) { return box[0].contains(s) && box[1].contains(t); };
    return std::any_of(x.undecided.begin(), x.undecided.end(), in) ||
           std::any_of(x.contacts.begin(), x.contacts.end(), [&](const auto& c) { return in(c.box); });
}

TEST(IntersectCoincident, a_line_on_a_longer_one_is_an_overlap_and_nothing_else) {
    const Plane lines[][2] = {
        {plane_bezier({{{1.5, -0.5}}, {{1.75, -0.5}}}), plane_bezier({{{1.75, -0.5}}, {{0.625, -0.5}}})},
        {plane_bezier({{{15, 7}}, {{4, -4}}}), plane_bezier({{{4, -4}}, {{5, -3}}})},
        {plane_bezier({{{0, 0}}, {{1000, 0}}}), plane_bezier({{{3, 0}}, {{3.5, 0}}})}};
    for (const auto& [a, b] : lines)
        each_way(a, b, [](const PlaneAnswer& x) {
            EXPECT_EQ(x.overlaps.size(), 1u);
            EXPECT_TRUE(x.contacts.empty() && x.undecided.empty());
        });
}

// Four arcs: joints of pieces are no contacts where the overlap goes on; where the circle is closed, its
// first point is its last one.
TEST(IntersectCoincident, a_circle_on_itself_is_one_overlap_and_meets_itself_at_its_seam_alone) {
    const double w = std::sqrt(0.5);
    const std::vector<Vec<2>> points{{{1, 0}},   {{1, 1}},  {{0, 1}},  {{-1, 1}}, {{-1, 0}},
                                     {{-1, -1}}, {{0, -1}}, {{1, -1}}, {{1, 0}}};
    const auto net = must(make_rational<2>(points, std::vector<double>{1, w, 1, w, 1, w, 1, w, 1}));
    const auto basis = must(BSplineBasis::make(2, {0, 0, 0, 0.25, 0.25, 0.5, 0.5, 0.75, 0.75, 1, 1, 1}));
    const auto circle = must(Curve<Hom<2>>::make({basis}, Net<1, Hom<2>>({9}, net)));
    for (const auto& other : {circle, reverse(circle, 0)}) {
        const auto x = must(intersect(circle, other));
        ASSERT_EQ(x.overlaps.size(), 1u);
        EXPECT_EQ(x.overlaps[0].a, (Interval{0, 1}));
        EXPECT_EQ(x.contacts.size(), 2u);
        for (const auto& c : x.contacts) EXPECT_EQ(c.kind, ContactKind::end);
    }
}

TEST(IntersectCoincident, lines_end_to_end_meet_there_once) {
    each_way(plane_bezier({{{9, 0}}, {{5, 4}}}), plane_bezier({{{16, -7}}, {{9, 0}}}),
             [](const PlaneAnswer& x) {
                 ASSERT_EQ(x.contacts.size(), 1u);
                 EXPECT_EQ(x.contacts[0].kind, ContactKind::end);
                 EXPECT_TRUE(x.contacts[0].is_proven());
                 EXPECT_EQ(x.contacts[0].at, (std::array<double, 2>{0, 1}));
             });
}

// B goes beyond the end of A, turns and comes back over it: the end is met on the way out, too.
TEST(IntersectCoincident, an_end_that_a_fold_passes_twice_is_not_lost_beside_the_overlap) {
    each_way(plane_bezier({{{7, -7}}, {{7, 1}}}), plane_bezier({{{7, 1}}, {{7, 3}}, {{7, -7}}}),
             [](const PlaneAnswer& x) {
                 ASSERT_EQ(x.overlaps.size(), 1u);
                 EXPECT_NEAR(x.overlaps[0].b.lo, 1.0 / 3, 1e-15);
                 EXPECT_TRUE(x.overlaps[0].reversed);
                 ASSERT_EQ(x.contacts.size(), 1u);
                 EXPECT_EQ(x.contacts[0].kind, ContactKind::end);
                 EXPECT_EQ(x.contacts[0].least, 1);
                 EXPECT_TRUE(covers(x, 1, 0));
             });
}

TEST(IntersectCoincident, an_end_at_a_cusp_beside_a_fold_is_where_it_is) {
    const Plane cubic = plane_bezier({{{5, -7}}, {{5, -7}}, {{8, 4}}, {{4, -6}}}),
                fold = plane_bezier({{{8, -7}}, {{9, -7}}, {{5, -7}}});
    each_way(cubic, fold, [](const PlaneAnswer& x) {
        ASSERT_EQ(x.contacts.size(), 1u);
        EXPECT_EQ(x.contacts[0].kind, ContactKind::end);
        EXPECT_EQ(x.contacts[0].at, (std::array<double, 2>{0, 1}));
        EXPECT_EQ(x.contacts[0].least, 1);
    });
}

TEST(IntersectCoincident, an_overlap_may_begin_at_a_cusp) {
    const Plane half = plane_bezier({{{0, 0}}, {{0, 0}}, {{0.25, 0}}, {{0.5, 0.125}}});
    each_way(kCusp, half, [](const PlaneAnswer& x) {
        EXPECT_TRUE(x.undecided.empty());
        ASSERT_EQ(x.overlaps.size(), 1u);
        EXPECT_EQ(x.overlaps[0].a, (Interval{0, 0.5}));
        EXPECT_EQ(x.overlaps[0].b, (Interval{0, 1}));
        EXPECT_FALSE(x.overlaps[0].reversed);
    });
}

// Where a curve turns round no end says so: what is not known is said.
TEST(IntersectCoincident, curves_that_turn_round_on_the_other_are_not_settled_by_their_ends) {
    const Plane fold = plane_bezier({{{2, 0}}, {{7, 0}}, {{3, 0}}});  // x = 2 + 10 t - 9 t^2 <= 4.78
    const auto x_of = [](double t) { return 2 + 10 * t - 9 * t * t; };
    each_way(plane_bezier({{{0, 0}}, {{10, 0}}}), fold, [&](const PlaneAnswer& x) {
        for (double t = 0; t <= 1; t += 0.125) EXPECT_TRUE(covers(x, x_of(t) / 10, t)) << t;
    });
    // x = 20 s (1 - s) <= 5: further than the other fold goes.
    each_way(plane_bezier({{{0, 0}}, {{10, 0}}, {{0, 0}}}), fold, [&](const PlaneAnswer& x) {
        EXPECT_TRUE(x.overlaps.empty());
        for (double t = 0; t <= 1; t += 0.125)
            EXPECT_TRUE(covers(x, 0.5 + 0.5 * std::sqrt(1 - x_of(t) / 5), t)) << t;
    });
    // The parabola there and back.
    const Plane parabola = plane_bezier({{{-1, 1}}, {{0, -1}}, {{1, 1}}}),
                back = plane_bezier({{{0, 0}}, {{0.75, 0}}, {{1, 1.5}}, {{0.75, 0}}, {{0, 0}}});
    each_way(parabola, back, [&](const PlaneAnswer& x) {
        for (double t = 0; t <= 1; t += 0.125) EXPECT_TRUE(covers(x, 0.5 + 1.5 * t * (1 - t), t)) << t;
    });
}

TEST(IntersectCoincident, closed_pieces_have_no_chord_and_are_searched_all_the_same) {
    const Plane a = plane_bezier({{{0, 0}}, {{4, 1}}, {{1, 4}}, {{0, 0}}}),
                b = plane_bezier({{{2, 0}}, {{-1, 1}}, {{2, 4}}, {{2, 0}}});
    // Of degree 7 each, so that integers are out of reach and the search is alone.
    const auto raised = [](Plane c) {
        for (int i = 0; i < 4; ++i) c = must(elevate(c, 0));
        return c;
    };
    const PlaneAnswer plain = meet(a, b), alone = meet(raised(a), raised(b));
    ASSERT_EQ(plain.contacts.size(), 4u);
    ASSERT_EQ(alone.contacts.size(), 4u);
    for (std::size_t i = 0; i < 4; ++i) {
        EXPECT_EQ(alone.contacts[i].kind, ContactKind::crossing);
        EXPECT_NEAR(plain.contacts[i].at[0], alone.contacts[i].at[0], 1e-12);
    }
}

// A smooth loop and the same moved: the beginning of each comes near the end of the other, no root is there.
TEST(IntersectCoincident, ends_that_are_only_near_are_not_proven_to_meet) {
    const Plane loop = plane_bezier({{{0, 0}}, {{1, 0}}, {{0, 3}}, {{-1, 0}}, {{0, 0}}});
    const Plane moved = mapped(loop, [](const Vec<2>& p) { return p + Vec<2>{{0, 1e-5}}; });
    const PlaneAnswer found = meet(loop, moved, 1e-4);
    EXPECT_EQ(found.overlaps.size(), 1u);
    int near = 0;
    for (const auto& c : found.contacts)
        if (c.kind == ContactKind::end) {
            ++near;
            EXPECT_EQ(c.least, 0);
            EXPECT_GT(c.gap, 0.9e-5);
        }
    EXPECT_EQ(near, 2);
}

}  // namespace
}  // namespace freiform::test
